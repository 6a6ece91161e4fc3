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
    bool at(Index vertex, Derivatives& out);

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
    bool add_ring(Index vertex, std::size_t& ring);

    void add(Index vertex, Index w);

    // Every k-th neighbour of a hub, to both sides from the direction in which the vertex is: the
    // same ones whatever the axes and the numbers of vertices.
    void add_some(Index vertex, const LargeFans::Fan& fan);

    // Fits to the stencil; returns how well it is determined.
    double fit(Index vertex, Derivatives& out);

    // The Frobenius norm of the inverse of the 3 x 3 block of the triangle from row and column j
    // on, with the middle column of the quadratic terms weighted.
    double inverse_norm(std::size_t j);

    // Of all quadratics that fit best, the one with the least curvature: where the mesh is one
    // triangle thick, far and wide, nothing tells how the function bends across.
    //
    // The norm of the curvature is that of x = (c3, sqrt2 c4, c5), the Frobenius norm of the
    // Hessian in the round frame. The triangle of the last three columns, A x = b, is solved
    // without the directions in which A is less than `share` of what it could be.
    bool fit_least_curved(Index vertex, double share, Derivatives& out);

    // The rows (1, s, t, s²/2, s t, t²/2 | u) of the stencil in its round frame; false if it lies
    // on one line.
    bool fill_rows(Index vertex);

    // The mean square of y - (l21 / l11) x, as what is left of y once it is taken point by point:
    // as the difference of two means it is lost where the stencil is thin at an angle.
    double scatter_across(double x0, double y0) const;

    // Coefficient j from row j of the triangle, where those after it are known.
    void solve_for(std::size_t j, double* c);

    // From the round frame back: d = L s, so that the gradient is L^-T c and the Hessian
    // L^-T ((c3, c4), (c4, c5)) L^-1.
    void put_derivatives(const double* c, Derivatives& out) const;

    // Householder's reflection of column j onto its first entry below the triangle, applied to the
    // columns after it. Returns the magnitude of that entry.
    //
    // With x the column, t the entry it becomes and v = x - t e_j, what is taken from a column y is
    // v (v' y) / (v' x), and v' y = x' y - t y_j. Whole rows are worked on, which vectorises.
    double reflect(std::size_t j);

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
