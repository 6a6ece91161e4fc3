// Smoothing: free vertices move to where the edges of their ball are unit and its triangles
// equilateral, in the metric.
//
// While a vertex moves, the metric it would have is read from its own ball: P1 and log-Euclidean
// on the triangles around the place it started from. The caller evaluates the metric again,
// exactly, where vertices have come to rest.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// Moves each vertex around which something has changed since the last call towards the mean of the
// apexes that would make the triangles of its ball equilateral: the others would stay where they
// stayed then. Returns how many moved.
Index smooth_changed(MetricMesh& mesh, Monitor& monitor);

// Looks around vertices in six directions, `step` metric units away and then half as far, for the
// few where the ideal place is of no help. Returns how many moved.
Index search_around(MetricMesh& mesh, const std::vector<Index>& vertices, double step,
                    Monitor& monitor);

}  // namespace adaptmesh
