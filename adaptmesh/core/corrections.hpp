// What edges know of their true length.
//
// The closed form (metrics::length) sees the metric at the two ends only. Where the true length has
// been measured, the edge keeps its ratio to the closed form. The ratio belongs to the two ends: it
// survives small moves of them; an edge that a flip makes has none (1).
#pragma once

#include "adaptmesh/core/edge_table.hpp"

namespace adaptmesh {

class Corrections {
  public:
    double of(Index a, Index b) const {
        const double* ratio = ratios_.find(a, b);
        return ratio ? *ratio : 1.0;
    }
    bool knows(Index a, Index b) const { return ratios_.find(a, b); }
    void set(Index a, Index b, double ratio) { ratios_.set(a, b, ratio); }

  private:
    EdgeTable<double> ratios_;
};

}  // namespace adaptmesh
