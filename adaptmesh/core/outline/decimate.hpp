// Points of chains of edges left out, one at a time, so that nothing is swept over.
//
//        v               Leaving out v replaces two edges by one. If no other point lies in the
//      /   \             triangle (a, v, b), by exact signs, the new edge meets nothing: an edge
//    a ..... b           through the triangle would have to cross one of the old ones, or the new
//                        one twice. So nothing crosses, and nothing changes sides.
//
// Points go in the order of how far that moves the chain, the least first (Visvalingam and Whyatt).
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

using metrics::Tensor;

// An edge, directed as the first of those that it replaces, and the points that it passes by.
struct ChainEdge {
    std::int32_t from, to;
    std::int32_t kind;                   // a point is left out only between two of one kind
    std::int32_t first = -1, last = -1;  // of the points passed by
    std::int32_t passed = 0;
    bool is_left = true;
};

struct Decimated {
    std::vector<std::pair<std::int32_t, std::int32_t>> edges;  // that are left
    std::vector<std::int32_t> source;        // of each the first of those that it replaces
    std::vector<std::int32_t> passed;        // the points that edge e passes by are those from
    std::vector<std::int64_t> starts = {0};  // starts[e] to starts[e + 1]
};

// Edges meet only at points. `share` is how far a point may lie off the edge that replaces its own,
// as a length in the metric at that point.
Decimated decimate(std::vector<Point> points, std::vector<Tensor> tensors,
                   std::vector<ChainEdge> edges, double share, Monitor& monitor);

}  // namespace adaptmesh
