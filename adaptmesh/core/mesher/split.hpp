// Splitting: a long edge gets a vertex in its metric middle.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/swap.hpp"

namespace adaptmesh {

class Splitter {
  public:
    explicit Splitter(MetricMesh& mesh) : mesh_(mesh) {}

    // Splits an edge of this length that is not locked; the new vertex is the last one.
    bool try_split(Place edge, double length);

  private:
    double inherited_length(const Vertex& p, const Vertex& opposite, Index o, const Quad& q) const;

    MetricMesh& mesh_;
    std::vector<Index> around_;
};

}  // namespace adaptmesh
