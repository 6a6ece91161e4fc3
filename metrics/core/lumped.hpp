// Derivatives at the vertices by linear finite elements with the mass matrix lumped: what they are
// on triangles, tested with the hat function of each vertex.
//
//        .---.---.       The hat of v is 1 at v and falls to 0 at its neighbours. On a triangle
//       / \ / \ /        around v its gradient, the slope, is the edge opposite v, turned by a
//      .---v---.         right angle, over twice the area.
//     / \ / \ /
//    .---.---.
//
// All sums are over the triangles around a vertex, and the mass is a third of their area.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

struct Slope {
    double x, y;
};

// Calls visit(corners, area, slopes, gradient) for each triangle, with the gradient of the function
// that has these values at the vertices.
template <typename Visit>
void for_each_gradient(const double* points, const Index* triangles, std::size_t m,
                       const double* values, Visit visit) {
    for (std::size_t t = 0; t < m; ++t) {
        const Index* v = triangles + 3 * t;
        const double *p = points + 2 * v[0], *q = points + 2 * v[1], *r = points + 2 * v[2];
        const double doubled = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        const Slope slopes[3] = {{(q[1] - r[1]) / doubled, (r[0] - q[0]) / doubled},
                                 {(r[1] - p[1]) / doubled, (p[0] - r[0]) / doubled},
                                 {(p[1] - q[1]) / doubled, (q[0] - p[0]) / doubled}};
        // The slopes add up to zero: a constant is not there to be lost in rounding.
        const double along_q = values[v[1]] - values[v[0]], along_r = values[v[2]] - values[v[0]];
        const Slope gradient{along_q * slopes[1].x + along_r * slopes[2].x,
                             along_q * slopes[1].y + along_r * slopes[2].y};
        visit(v, 0.5 * doubled, slopes, gradient);
    }
}

// The L2 projection of the gradient: its mean around each vertex, weighted by area. Pairs.
inline void project_gradient(const double* points, std::size_t n, const Index* triangles,
                             std::size_t m, const double* values, double* out) {
    std::vector<double> area(n, 0.0);
    std::fill(out, out + 2 * n, 0.0);
    for_each_gradient(points, triangles, m, values,
                      [&](const Index* v, double a, const Slope*, Slope g) {
                          for (int i = 0; i < 3; ++i) {
                              area[v[i]] += a;
                              out[2 * v[i]] += a * g.x, out[2 * v[i] + 1] += a * g.y;
                          }
                      });
    for (std::size_t i = 0; i < n; ++i) out[2 * i] /= area[i], out[2 * i + 1] /= area[i];
}

// Second derivatives by Green's formula, H_ij = -(integral of d_i u d_j hat) / (integral of hat),
// made symmetric. At the border, where the hat is not zero all around, it does not hold.
inline std::vector<Tensor> green_hessians(const double* points, std::size_t n,
                                          const Index* triangles, std::size_t m,
                                          const double* values) {
    std::vector<double> area(n, 0.0);
    std::vector<Tensor> out(n, Tensor{0, 0, 0});
    for_each_gradient(points, triangles, m, values,
                      [&](const Index* v, double a, const Slope* s, Slope g) {
                          for (int i = 0; i < 3; ++i) {
                              area[v[i]] += a;
                              const double xy = 0.5 * (g.x * s[i].y + g.y * s[i].x);
                              out[v[i]] = out[v[i]] + a * Tensor{g.x * s[i].x, xy, g.y * s[i].y};
                          }
                      });
    for (std::size_t i = 0; i < n; ++i) out[i] = (-3 / area[i]) * out[i];
    return out;
}

}  // namespace metrics
