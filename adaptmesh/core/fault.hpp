// What can be wrong with the points and segments handed in: thrown, and worded on the Python side.
#pragma once

#include <exception>
#include <string>

#include "adaptmesh/core/point.hpp"
#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

// kind                   i, j                                   x, y
// ---------------------  -------------------------------------  ------------------------------
// too_few_points         number of points                       -
// not_finite             point                                  its coordinates
// all_collinear          -                                      -
// too_many_points        number of points                       -
// duplicate_points       the two points                         where they are
// segment_out_of_range   segment, the vertex it names           -
// degenerate_segment     segment, its one vertex                where it is
// overlapping_segments   the two segments                       a common point of the overlap
// crossing_segments      the two segments                       where they cross
// open_boundary          vertex, a segment through it           the vertex
// open_hole              the same, in a hole or between two     the vertex
// uncertain_hole         its vertex, a segment from there       the vertex
// hole_outside           hole seed                              the seed
// hole_on_segment        hole seed, segment                     the seed
// region_seed_outside    region seed                            the seed
// region_seed_on_segment region seed, segment                   the seed
// two_seeds_one_region   the two region seeds                   the second seed
// point_outside          point                                  its coordinates
// empty_domain           -                                      -
struct Fault : std::exception {
    std::string kind;
    Index i, j;
    Point at;

    explicit Fault(std::string kind, Index i = NONE, Index j = NONE, Point at = {0.0, 0.0})
        : kind(std::move(kind)), i(i), j(j), at(at) {}

    const char* what() const noexcept override { return kind.c_str(); }
};

}  // namespace adaptmesh
