#include "metrics/core/recovery.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/large_fans.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

bool QuadraticFit::at(Index vertex, Derivatives& out) {
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
            if (determined > BARELY && determined < HARDLY) fit_least_curved(vertex, HARDLY, out);
            return determined > BARELY;
        }
        if (stencil_.size() > LARGEST) {
            stencil_.resize(near);
            return fit_least_curved(vertex, WELL, out);
        }
    }
}

bool QuadraticFit::add_ring(Index vertex, std::size_t& ring) {
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

void QuadraticFit::add(Index vertex, Index w) {
    if (seen_[w] == vertex) return;
    seen_[w] = vertex;
    stencil_.push_back(w);
}

void QuadraticFit::add_some(Index vertex, const LargeFans::Fan& fan) {
    const std::ptrdiff_t n = std::ptrdiff_t(fan.size()), stride = 1 + n / LARGEST_FAN;
    const std::ptrdiff_t start = fan.nearest(points_[2 * vertex], points_[2 * vertex + 1]);
    add(vertex, fan.vertex((start + n) % n));
    for (std::ptrdiff_t k = stride; 2 * k <= n; k += stride) {
        add(vertex, fan.vertex((start + k) % n));
        add(vertex, fan.vertex((start + n - k) % n));
    }
}

double QuadraticFit::fit(Index vertex, Derivatives& out) {
    if (!fill_rows(vertex)) return 0;
    for (std::size_t j = 0; j < COEFFICIENTS; ++j) reflect(j);
    const double determined = std::min(1 / (std::sqrt(double(stencil_.size())) * inverse_norm(0)),
                                       1 / (spread_ * inverse_norm(LINEAR)));
    if (!(determined > BARELY)) return 0;
    double c[COEFFICIENTS];
    for (std::size_t j = COEFFICIENTS; j-- > 0;) solve_for(j, c);
    put_derivatives(c, out);
    return determined;
}

double QuadraticFit::inverse_norm(std::size_t j) {
    const double w = j == LINEAR ? WEIGHT[1] : 1;
    const double a = entry(j, j), b = w * entry(j, j + 1), c = entry(j, j + 2);
    const double d = w * entry(j + 1, j + 1), e = entry(j + 1, j + 2), f = entry(j + 2, j + 2);
    if (a == 0 || d == 0 || f == 0) return std::numeric_limits<double>::infinity();
    const double p = b / (a * d), q = e / (d * f), r = (b * e - c * d) / (a * d * f);
    return std::sqrt(1 / (a * a) + 1 / (d * d) + 1 / (f * f) + p * p + q * q + r * r);
}

bool QuadraticFit::fit_least_curved(Index vertex, double share, Derivatives& out) {
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

bool QuadraticFit::fill_rows(Index vertex) {
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

double QuadraticFit::scatter_across(double x0, double y0) const {
    double sum = 0;
    for (const Index w : stencil_) {
        const double dx = points_[2 * w] - x0, dy = points_[2 * w + 1] - y0;
        const double across = product_difference(dy, l11_, l21_, dx) / l11_;
        sum += across * across;
    }
    return sum / double(stencil_.size());
}

void QuadraticFit::solve_for(std::size_t j, double* c) {
    double rest = entry(j, COEFFICIENTS);
    for (std::size_t k = j + 1; k < COEFFICIENTS; ++k) rest -= entry(j, k) * c[k];
    c[j] = rest / entry(j, j);
}

void QuadraticFit::put_derivatives(const double* c, Derivatives& out) const {
    out.dy = c[2] / l22_;
    out.dx = (c[1] - l21_ * out.dy) / l11_;
    const double k = l21_ / l22_;
    const double a = c[3] - 2 * k * c[4] + k * k * c[5], b = c[4] - k * c[5];
    out.hessian = {a / (l11_ * l11_), b / (l11_ * l22_), c[5] / (l22_ * l22_)};
}

double QuadraticFit::reflect(std::size_t j) {
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

}  // namespace metrics
