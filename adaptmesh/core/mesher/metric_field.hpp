// The metric, as the core asks for it: of whole arrays of points at once, between its rounds.
#pragma once

#include <functional>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

using metrics::Tensor;

// Sets the second to the metrics at the points, in their order. May throw, which ends the work.
// Calls are few and large, never from within a loop over triangles: the function may be one of
// Python, which answers fastest for whole arrays.
using MetricField = std::function<void(const std::vector<Point>&, std::vector<Tensor>&)>;

// Nothing is asked if there are no points.
inline std::vector<Tensor> evaluate(const MetricField& metric, const std::vector<Point>& points) {
    std::vector<Tensor> tensors;
    if (!points.empty()) metric(points, tensors);
    return tensors;
}

}  // namespace adaptmesh
