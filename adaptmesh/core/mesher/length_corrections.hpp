// What edges know of their true length.
//
// The closed form (metrics::length) sees the metric at the two ends only. Where the true length has
// been measured, the edge keeps its ratio to the closed form. The ratio belongs to the two ends: it
// survives small moves of them; an edge that a flip makes has none (1).
#pragma once

#include <algorithm>
#include <vector>

#include "adaptmesh/core/triangulation/edge_map.hpp"

namespace adaptmesh {

class Corrections {
  public:
    double of(Index a, Index b) const {
        const double* ratio = find(a, b);
        return ratio ? *ratio : 1.0;
    }
    bool knows(Index a, Index b) const { return find(a, b); }
    // Whether any edge of the vertex was found to be off: where none was, the ends tell all.
    bool any_at(Index v) const { return std::size_t(v) < is_end_.size() && is_end_[v]; }

    void set(Index a, Index b, double ratio) {
        const std::size_t n = std::size_t(std::max(a, b)) + 1;
        if (is_end_.size() < n) is_end_.resize(n, 0);
        is_end_[a] = is_end_[b] = 1;
        ratios_.set(a, b, ratio);
    }

  private:
    // Nearly all edges are known by their ends to have none: the table is far away in memory.
    const double* find(Index a, Index b) const {
        return any_at(a) && any_at(b) ? ratios_.find(a, b) : nullptr;
    }

    EdgeMap<double> ratios_;
    std::vector<char> is_end_;  // of an edge in the table
};

}  // namespace adaptmesh
