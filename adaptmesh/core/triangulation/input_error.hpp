// What can be wrong with the points and segments handed in: thrown, and worded on the Python side.
#pragma once

#include <exception>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

enum class InputFault {      // i, j                              at
    too_few_points,          // number of points                  -
    not_finite,              // point                             its coordinates
    all_collinear,           // -                                 -
    too_many_points,         // number of points                  -
    duplicate_points,        // the two points                    where they are
    segment_out_of_range,    // segment, the vertex it names      -
    degenerate_segment,      // segment, its one vertex           where it is
    overlapping_segments,    // the two segments                  a point of the overlap
    crossing_segments,       // the two segments                  where they cross
    open_boundary,           // vertex, a segment through it      the vertex
    open_hole,               // the same, in a hole               the vertex
    uncertain_hole,          // its vertex, a segment from there  the vertex
    hole_outside,            // hole seed                         the seed
    hole_on_segment,         // hole seed, segment                the seed
    region_seed_outside,     // region seed                       the seed
    region_seed_on_segment,  // region seed, segment              the seed
    two_seeds_one_region,    // the two region seeds              the second seed
    point_outside,           // point                             its coordinates
    empty_domain,            // -                                 -
    lines_too_near,          // two segments of a valid domain    where they meet, rounded
};

struct InputError : std::exception {
    InputFault kind;
    Index i, j;
    Point at;

    explicit InputError(InputFault kind, Index i = NONE, Index j = NONE, Point at = {0.0, 0.0})
        : kind(kind), i(i), j(j), at(at) {}

    const char* what() const noexcept override { return "points and segments are not a domain"; }
};

}  // namespace adaptmesh
