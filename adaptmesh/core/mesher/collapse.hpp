// Collapsing: a vertex at the end of a short edge is pulled into the other end.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"

namespace adaptmesh {

class Collapser {
  public:
    explicit Collapser(MetricMesh& mesh) : mesh_(mesh) {}

    // Pulls `from` into `to` if every check passes; the edge between them must exist. Only free
    // vertices vanish: the new triangles then cover the ball of `from` exactly, so that being
    // positive is all they need.
    bool try_collapse(Index from, Index to);

  private:
    double inherited_length(Index from, Index to, Index p) const;

    MetricMesh& mesh_;
    std::vector<Place> around_;
};

}  // namespace adaptmesh
