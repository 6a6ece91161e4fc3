// Which proposals of the final optimisation are put into the mesh.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/proposals.hpp"

namespace adaptmesh {

// Puts the best proposals in, most gain first, as long as their sites do not overlap; `proposed`
// are the measured edges that they would make. Returns how many.
Index accept_best(const std::vector<Site>& sites, const EdgeSampler& proposed, const Aim& aim,
                  MetricMesh& mesh, Measures& measures);

}  // namespace adaptmesh
