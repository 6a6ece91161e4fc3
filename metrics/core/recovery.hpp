// Gradients and Hessians at the vertices of a mesh, from values there: around each vertex a
// quadratic is fitted to the values of its neighbours, and theirs, by least squares.
//
//           o---o---o
//          / \ / \ / \       two rings around v: enough of them, and on all sides,
//         o---o---o---o      for six coefficients; at the border, where they may
//        / \ / \ / \ / \     lie on too few lines, a third ring is added, a
//       o---o---v---o---o    fourth, ...
//
// The fit is made in the frame in which the scatter of the neighbours is round, so that thin
// triangles fit as well as others; and by Householder reflections, whose triangle tells how well
// the neighbours determine the coefficients.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

struct Derivatives {
    double dx, dy;
    Tensor hessian;
};

class QuadraticFit {
  public:
    // points: n pairs; values: one for each. Both are kept as they are and must live on.
    QuadraticFit(const double* points, const double* values, const Adjacency& mesh)
        : points_(points), values_(values), mesh_(mesh), seen_(mesh.size(), -1) {}

    // False if the points that can be reached from the vertex do not determine a quadratic.
    bool at(Index vertex, Derivatives& out) {
        stencil_.assign(1, vertex);
        seen_[vertex] = vertex;
        std::size_t ring = 0;  // where the outermost ring starts
        for (int rings = 1;; ++rings) {
            const bool grown = add_ring(vertex, ring);
            if (rings < 2 && grown) continue;
            const double determined = stencil_.size() < COEFFICIENTS ? 0 : fit(vertex, out);
            if (determined > WELL) return true;
            if (!grown || stencil_.size() > LARGEST) return determined > BARELY;
        }
    }

  private:
    static constexpr std::size_t COEFFICIENTS = 6;
    static constexpr std::size_t LARGEST = 600;        // stencils are not given more rings
    static constexpr std::ptrdiff_t LARGEST_FAN = 64;  // of many neighbours every k-th is enough
    // The smallest diagonal entry of the triangle of columns of length 1: enough, and too little.
    static constexpr double WELL = 0.08, BARELY = 1e-6;

    // Appends the neighbours of the vertices from `ring` on; false if there are no new ones.
    bool add_ring(Index vertex, std::size_t& ring) {
        const std::size_t end = stencil_.size();
        for (; ring < end; ++ring) {
            const Adjacency::Range fan = mesh_.of(stencil_[ring]);
            const std::ptrdiff_t stride = 1 + fan.size() / LARGEST_FAN;
            for (std::ptrdiff_t i = 0; i < fan.size(); i += stride) {
                const Index w = fan.begin()[i];
                if (seen_[w] == vertex) continue;
                seen_[w] = vertex;
                stencil_.push_back(w);
            }
        }
        return stencil_.size() > end;
    }

    // Fits to the stencil; returns how well it is determined, from 0 to 1.
    double fit(Index vertex, Derivatives& out) {
        const std::size_t m = stencil_.size();
        const double x0 = points_[2 * vertex], y0 = points_[2 * vertex + 1], u0 = values_[vertex];
        double xx = 0, xy = 0, yy = 0;
        for (const Index w : stencil_) {
            const double dx = points_[2 * w] - x0, dy = points_[2 * w + 1] - y0;
            xx += dx * dx, xy += dx * dy, yy += dy * dy;
        }
        const double l11 = std::sqrt(xx / double(m)), l21 = xy / double(m) / l11;
        const double l22 = std::sqrt(std::max(yy / double(m) - l21 * l21, 0.0));
        if (!(l11 > 0 && l22 > 0)) return 0;  // all on one line

        rows_.resize(m * COLUMNS);
        double length[COEFFICIENTS] = {};
        for (std::size_t i = 0; i < m; ++i) {
            const Index w = stencil_[i];
            const double s = (points_[2 * w] - x0) / l11;
            const double t = (points_[2 * w + 1] - y0 - l21 * s) / l22;
            const double row[COLUMNS] = {1, s, t, s * s / 2, s * t, t * t / 2, values_[w] - u0};
            std::copy(row, row + COLUMNS, &rows_[i * COLUMNS]);
            for (std::size_t j = 0; j < COEFFICIENTS; ++j) length[j] += row[j] * row[j];
        }
        double determined = 1;
        for (std::size_t j = 0; j < COEFFICIENTS; ++j) {
            if (length[j] == 0) return 0;  // as s t for points on the axes only
            determined = std::min(determined, reflect(j, m) / std::sqrt(length[j]));
        }
        if (!(determined > BARELY)) return 0;

        double c[COEFFICIENTS];
        for (std::size_t j = COEFFICIENTS; j-- > 0;) {
            double rest = entry(j, COEFFICIENTS);
            for (std::size_t k = j + 1; k < COEFFICIENTS; ++k) rest -= entry(j, k) * c[k];
            c[j] = rest / entry(j, j);
        }
        // From the round frame back: d = L s, so that the gradient is L^-T c and the Hessian
        // L^-T ((c3, c4), (c4, c5)) L^-1.
        out.dy = c[2] / l22;
        out.dx = (c[1] - l21 * out.dy) / l11;
        const double k = l21 / l22;
        const double a = c[3] - 2 * k * c[4] + k * k * c[5], b = c[4] - k * c[5];
        out.hessian = {a / (l11 * l11), b / (l11 * l22), c[5] / (l22 * l22)};
        return determined;
    }

    // Householder's reflection of column j onto its first entry below the triangle, applied to the
    // columns after it. Returns the magnitude of that entry.
    double reflect(std::size_t j, std::size_t m) {
        double norm = 0;
        for (std::size_t i = j; i < m; ++i) norm += entry(i, j) * entry(i, j);
        norm = std::sqrt(norm);
        if (norm == 0) return 0;
        const double pivot = entry(j, j), target = pivot > 0 ? -norm : norm;
        entry(j, j) = pivot - target;
        const double scale = 1 / (target * entry(j, j));  // -2 / |v|^2
        for (std::size_t k = j + 1; k < COLUMNS; ++k) {
            double product = 0;
            for (std::size_t i = j; i < m; ++i) product += entry(i, j) * entry(i, k);
            product *= scale;
            for (std::size_t i = j; i < m; ++i) entry(i, k) += product * entry(i, j);
        }
        entry(j, j) = target;
        return norm;
    }

    double& entry(std::size_t i, std::size_t j) { return rows_[i * COLUMNS + j]; }

    static constexpr std::size_t COLUMNS = COEFFICIENTS + 1;  // the last is the right-hand side

    const double* points_;
    const double* values_;
    const Adjacency& mesh_;
    std::vector<Index> seen_;  // the last vertex whose stencil had this one
    std::vector<Index> stencil_;
    std::vector<double> rows_;
};

}  // namespace metrics
