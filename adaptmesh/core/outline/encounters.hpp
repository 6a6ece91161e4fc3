// Where segments come near each other: points that lie on them, or nearly, and crossings.
//
//     a___v___b   near: v is nearer than the tolerance to the segment ab, and divides it
//                 into shorter ones
//
//     a___x___b   crossing: ab and cd cross between their ends, by exact signs
//        /
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"

namespace adaptmesh {

using IndexPair = std::pair<Index, Index>;

struct Encounters {
    std::vector<IndexPair> near;       // segments, and the points that lie on each, or nearly
    std::vector<IndexPair> crossings;  // pairs of segments, the lower number first
};

// Compares pairs of segments of which one at least is unseen; stops after `max_crossings`.
Encounters find_encounters(const std::vector<Point>& points, const std::vector<Segment>& segments,
                           double tolerance, const bool* is_unseen, std::size_t max_crossings,
                           Monitor& monitor);

}  // namespace adaptmesh
