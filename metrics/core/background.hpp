// The control space carried by a mesh: log tensors at the vertices, linear on each triangle.
#pragma once

#include <cstddef>
#include <vector>

#include "metrics/core/locator.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

class Background : public Locator {
  public:
    // As for Locator; logs: n packed log tensors.
    Background(const double* points, const double* logs, std::size_t n, const Index* triangles,
               std::size_t m)
        : Locator(points, n, triangles, m) {
        logs_.reserve(n);
        for (std::size_t i = 0; i < n; ++i)
            logs_.push_back({logs[3 * i], logs[3 * i + 1], logs[3 * i + 2]});
    }

    Tensor value(const Location& place) const {
        return exp_tensor(place.weight[0] * logs_[corner(place.triangle, 0)] +
                          place.weight[1] * logs_[corner(place.triangle, 1)] +
                          place.weight[2] * logs_[corner(place.triangle, 2)]);
    }

  private:
    std::vector<Tensor> logs_;
};

}  // namespace metrics
