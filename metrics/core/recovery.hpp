// Gradients and Hessians at the vertices of a mesh, from values there: around each vertex a
// quadratic is fitted to the values of its neighbours, and theirs, by least squares.
//
//           o---o---o
//          / \ / \ / \       two rings around v: enough of them, and on all sides,
//         o---o---o---o      for six coefficients; at the border, where they may
//        / \ / \ / \ / \     lie on too few lines, a third ring is added, a
//       o---o---v---o---o    fourth, ...
//
// The fit is made in a frame in which the scatter of the neighbours is round, so that thin
// triangles fit as well as others; and by Householder reflections, whose triangle tells how well
// the neighbours determine the coefficients.
//
// A round frame is one up to a rotation, and which one it is depends on the axes. So nothing is
// decided by single columns: rotations of the frame mix s with t, and s²/2, s t / sqrt 2, t²/2 with
// each other, by orthogonal matrices, which leave the Frobenius norms of the two blocks of the
// triangle and of their inverses as they are.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/large_fans.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

struct Derivatives {
    double dx, dy;
    Tensor hessian;
};

// A symmetric 3 x 3 matrix.
class Symmetric3 {
  public:
    double& at(std::size_t i, std::size_t j) { return i >= j ? a_[i][j] : a_[j][i]; }

    // x of least norm with (this) x = right, as if eigenvalues below `least` were zero, which
    // directions count for nothing. By Jacobi's rotations; what `at` gives is lost.
    void solve_truncated(const double* right, double least, double* x) {
        double vectors[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // columns
        for (int sweep = 0; sweep < 12; ++sweep) {
            for (std::size_t p = 0; p < 2; ++p) {
                for (std::size_t q = p + 1; q < 3; ++q) rotate(p, q, vectors);
            }
        }
        x[0] = x[1] = x[2] = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(at(k, k) > least)) continue;
            double along = 0;
            for (std::size_t i = 0; i < 3; ++i) along += vectors[i][k] * right[i];
            for (std::size_t i = 0; i < 3; ++i) x[i] += vectors[i][k] * along / at(k, k);
        }
    }

  private:
    void rotate(std::size_t p, std::size_t q, double (&vectors)[3][3]) {
        if (at(p, q) == 0) return;
        const double theta = (at(q, q) - at(p, p)) / (2 * at(p, q));
        const double t = std::copysign(1 / (std::abs(theta) + std::hypot(theta, 1.0)), theta);
        const double c = 1 / std::hypot(t, 1.0), s = t * c;
        at(p, p) -= t * at(p, q), at(q, q) += t * at(p, q), at(p, q) = 0;
        const std::size_t r = 3 - p - q;
        const double rp = at(r, p), rq = at(r, q);
        at(r, p) = c * rp - s * rq, at(r, q) = s * rp + c * rq;
        for (double (&row)[3] : vectors) {
            const double vp = row[p], vq = row[q];
            row[p] = c * vp - s * vq, row[q] = s * vp + c * vq;
        }
    }

    double a_[3][3] = {};
};

class QuadraticFit {
  public:
    // points: n pairs; values: one for each. Both are kept as they are and must live on.
    QuadraticFit(const double* points, const double* values, const Adjacency& mesh)
        : points_(points),
          values_(values),
          mesh_(mesh),
          fans_(points, mesh),
          seen_(mesh.size(), -1) {}

    // False if the points that can be reached from the vertex do not determine a quadratic.
    bool at(Index vertex, Derivatives& out) {
        stencil_.assign(1, vertex);
        seen_[vertex] = vertex;
        std::size_t ring = 0;  // where the outermost ring starts
        std::size_t near = 0;  // how many vertices are in two rings, or so
        for (int rings = 1;; ++rings) {
            const bool grown = add_ring(vertex, ring);
            if (rings < 2 && grown) continue;
            if (rings == 2 || near < NEAR) near = stencil_.size();
            const double determined = stencil_.size() < COEFFICIENTS ? 0 : fit(vertex, out);
            if (determined > WELL) return true;
            if (!grown) {
                if (determined > BARELY && determined < HARDLY)
                    fit_least_curved(vertex, HARDLY, out);
                return determined > BARELY;
            }
            if (stencil_.size() > LARGEST) {
                stencil_.resize(near);
                return fit_least_curved(vertex, WELL, out);
            }
        }
    }

  private:
    static constexpr std::size_t COEFFICIENTS = 6, LINEAR = 3;
    static constexpr std::size_t LARGEST = 60;         // stencils are not given more rings
    static constexpr std::size_t NEAR = 8;             // what makes two rings enough, if need be
    static constexpr std::ptrdiff_t LARGEST_FAN = 64;  // of many neighbours every k-th is enough
    // How well the coefficients are determined, from 0 to about 0.5: enough; so little that
    // rounding of coordinates would show, by the square of it, in curvatures that are then left
    // out; and too little.
    static constexpr double WELL = 0.03, HARDLY = 1e-3, BARELY = 1e-6;

    // Appends the neighbours of the vertices from `ring` on; false if there are no new ones.
    bool add_ring(Index vertex, std::size_t& ring) {
        const std::size_t end = stencil_.size();
        for (; ring < end; ++ring) {
            const Index w = stencil_[ring];
            const Adjacency::Range fan = mesh_.of(w);
            if (fan.size() <= LARGEST_FAN || w == vertex) {
                for (const Index u : fan) add(vertex, u);
            } else {
                add_some(vertex, fans_.of(w));
            }
        }
        return stencil_.size() > end;
    }

    void add(Index vertex, Index w) {
        if (seen_[w] == vertex) return;
        seen_[w] = vertex;
        stencil_.push_back(w);
    }

    // Every k-th neighbour of a hub, to both sides from the direction in which the vertex is: the
    // same ones whatever the axes and the numbers of vertices.
    void add_some(Index vertex, const LargeFans::Fan& fan) {
        const std::ptrdiff_t n = std::ptrdiff_t(fan.size()), stride = 1 + n / LARGEST_FAN;
        const std::ptrdiff_t start = fan.nearest(points_[2 * vertex], points_[2 * vertex + 1]);
        add(vertex, fan.vertex((start + n) % n));
        for (std::ptrdiff_t k = stride; 2 * k <= n; k += stride) {
            add(vertex, fan.vertex((start + k) % n));
            add(vertex, fan.vertex((start + n - k) % n));
        }
    }

    // Fits to the stencil; returns how well it is determined.
    double fit(Index vertex, Derivatives& out) {
        if (!fill_rows(vertex)) return 0;
        for (std::size_t j = 0; j < COEFFICIENTS; ++j) reflect(j);
        const double determined =
            std::min(1 / (std::sqrt(double(stencil_.size())) * inverse_norm(0)),
                     1 / (spread_ * inverse_norm(LINEAR)));
        if (!(determined > BARELY)) return 0;
        double c[COEFFICIENTS];
        for (std::size_t j = COEFFICIENTS; j-- > 0;) solve_for(j, c);
        put_derivatives(c, out);
        return determined;
    }

    // The Frobenius norm of the inverse of the 3 x 3 block of the triangle from row and column j
    // on, with the middle column of the quadratic terms weighted.
    double inverse_norm(std::size_t j) {
        const double w = j == LINEAR ? WEIGHT[1] : 1;
        const double a = entry(j, j), b = w * entry(j, j + 1), c = entry(j, j + 2);
        const double d = w * entry(j + 1, j + 1), e = entry(j + 1, j + 2), f = entry(j + 2, j + 2);
        if (a == 0 || d == 0 || f == 0) return std::numeric_limits<double>::infinity();
        const double p = b / (a * d), q = e / (d * f), r = (b * e - c * d) / (a * d * f);
        return std::sqrt(1 / (a * a) + 1 / (d * d) + 1 / (f * f) + p * p + q * q + r * r);
    }

    // Of all quadratics that fit best, the one with the least curvature: where the mesh is one
    // triangle thick, far and wide, nothing tells how the function bends across.
    //
    // The norm of the curvature is that of x = (c3, sqrt2 c4, c5), the Frobenius norm of the
    // Hessian in the round frame. The triangle of the last three columns, A x = b, is solved
    // without the directions in which A is less than `share` of what it could be.
    bool fit_least_curved(Index vertex, double share, Derivatives& out) {
        if (!fill_rows(vertex)) return false;
        for (std::size_t j = 0; j < LINEAR; ++j) reflect(j);
        const std::size_t m = stencil_.size();
        if (!(1 / inverse_norm(0) > BARELY * std::sqrt(double(m)))) return false;
        Symmetric3 square{};
        double right[3] = {};
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t i = LINEAR; i < m; ++i) {
                const double left = WEIGHT[a] * entry(i, LINEAR + a);
                right[a] += left * entry(i, COEFFICIENTS);
                for (std::size_t b = 0; b <= a; ++b) {
                    square.at(a, b) += left * WEIGHT[b] * entry(i, LINEAR + b);
                }
            }
        }
        double x[3];
        square.solve_truncated(right, share * share * spread_ * spread_, x);
        double c[COEFFICIENTS] = {0, 0, 0, x[0], WEIGHT[1] * x[1], x[2]};
        for (std::size_t j = LINEAR; j-- > 0;) solve_for(j, c);
        put_derivatives(c, out);
        return true;
    }

    // The rows (1, s, t, s²/2, s t, t²/2 | u) of the stencil in its round frame; false if it lies
    // on one line.
    bool fill_rows(Index vertex) {
        const std::size_t m = stencil_.size();
        const double x0 = points_[2 * vertex], y0 = points_[2 * vertex + 1], u0 = values_[vertex];
        double xx = 0, xy = 0, yy = 0;
        for (const Index w : stencil_) {
            const double dx = points_[2 * w] - x0, dy = points_[2 * w + 1] - y0;
            xx += dx * dx, xy += dx * dy, yy += dy * dy;
        }
        l11_ = std::sqrt(xx / double(m)), l21_ = xy / double(m) / l11_;
        double rest = yy / double(m) - l21_ * l21_;
        if (rest < 1e-8 * yy / double(m)) rest = scatter_across(x0, y0);
        l22_ = std::sqrt(rest);
        if (!(l11_ > 0 && l22_ > 0)) return false;

        rows_.resize(m * COLUMNS);
        const double per_l11 = 1 / l11_, per_l22 = 1 / l22_;
        double* row = rows_.data();
        for (const Index w : stencil_) {
            const double s = (points_[2 * w] - x0) * per_l11;
            const double t = (points_[2 * w + 1] - y0 - l21_ * s) * per_l22;
            row[0] = 1, row[1] = s, row[2] = t, row[3] = s * s / 2, row[4] = s * t;
            row[5] = t * t / 2, row[6] = values_[w] - u0, row[7] = 0;
            row += COLUMNS;
        }
        double squares = 0;
        for (std::size_t i = 0; i < m; ++i) {
            const double half = entry(i, 3) + entry(i, 5);  // of the squared distance in the frame
            squares += half * half;
        }
        spread_ = std::sqrt(squares);
        return true;
    }

    // The mean square of y - (l21 / l11) x, as what is left of y once it is taken point by point:
    // as the difference of two means it is lost where the stencil is thin at an angle.
    double scatter_across(double x0, double y0) const {
        double sum = 0;
        for (const Index w : stencil_) {
            const double dx = points_[2 * w] - x0, dy = points_[2 * w + 1] - y0;
            const double across = product_difference(dy, l11_, l21_, dx) / l11_;
            sum += across * across;
        }
        return sum / double(stencil_.size());
    }

    // Coefficient j from row j of the triangle, where those after it are known.
    void solve_for(std::size_t j, double* c) {
        double rest = entry(j, COEFFICIENTS);
        for (std::size_t k = j + 1; k < COEFFICIENTS; ++k) rest -= entry(j, k) * c[k];
        c[j] = rest / entry(j, j);
    }

    // From the round frame back: d = L s, so that the gradient is L^-T c and the Hessian
    // L^-T ((c3, c4), (c4, c5)) L^-1.
    void put_derivatives(const double* c, Derivatives& out) const {
        out.dy = c[2] / l22_;
        out.dx = (c[1] - l21_ * out.dy) / l11_;
        const double k = l21_ / l22_;
        const double a = c[3] - 2 * k * c[4] + k * k * c[5], b = c[4] - k * c[5];
        out.hessian = {a / (l11_ * l11_), b / (l11_ * l22_), c[5] / (l22_ * l22_)};
    }

    // Householder's reflection of column j onto its first entry below the triangle, applied to the
    // columns after it. Returns the magnitude of that entry.
    //
    // With x the column, t the entry it becomes and v = x - t e_j, what is taken from a column y is
    // v (v' y) / (v' x), and v' y = x' y - t y_j. Whole rows are worked on, which vectorises.
    double reflect(std::size_t j) {
        const std::size_t m = stencil_.size();
        double product[COLUMNS] = {};  // of the column with each
        for (std::size_t i = j; i < m; ++i) {
            const double *y = &rows_[i * COLUMNS], x = y[j];
            for (std::size_t k = 0; k < COLUMNS; ++k) product[k] += x * y[k];
        }
        if (product[j] == 0) return 0;
        const double norm = std::sqrt(product[j]), target = entry(j, j) > 0 ? -norm : norm;
        const double scale = 1 / (product[j] - target * entry(j, j));
        for (std::size_t k = 0; k < COLUMNS; ++k) {
            product[k] = k <= j ? 0 : (product[k] - target * entry(j, k)) * scale;
        }
        entry(j, j) -= target;
        for (std::size_t i = j; i < m; ++i) {
            double *y = &rows_[i * COLUMNS], v = y[j];
            for (std::size_t k = 0; k < COLUMNS; ++k) y[k] -= product[k] * v;
        }
        entry(j, j) = target;
        return norm;
    }

    double& entry(std::size_t i, std::size_t j) { return rows_[i * COLUMNS + j]; }

    // After the coefficients the right-hand side, and one that makes their number even.
    static constexpr std::size_t COLUMNS = COEFFICIENTS + 2;

    // Of the quadratic terms, with which their norm does not depend on the frame.
    static constexpr double WEIGHT[3] = {1, 0.70710678118654752, 1};

    const double* points_;
    const double* values_;
    const Adjacency& mesh_;
    LargeFans fans_;
    std::vector<Index> seen_;  // the last vertex whose stencil had this one
    std::vector<Index> stencil_;
    std::vector<double> rows_;
    double spread_;           // Frobenius norm of the weighted quadratic terms
    double l11_, l21_, l22_;  // of the frame
};

}  // namespace metrics
