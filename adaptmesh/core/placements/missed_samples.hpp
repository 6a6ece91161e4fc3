// Points where the metric is far finer than the mesh knows: features that no edge has met.
//
// A layer thinner than an edge can pass between all the places where edges were measured; the
// quadrature of the complexity has looked elsewhere, and closely where the metric is large.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// Points where the metric was evaluated before the mesh was made.
struct Samples {
    std::vector<Point> points;
    std::vector<Tensor> tensors;
};

// Puts samples into the mesh whose density is far above that of the corners of their triangle.
// Returns how many it took.
Index insert_missed_samples(MetricMesh& mesh, const Samples& samples, Monitor& monitor);

}  // namespace adaptmesh
