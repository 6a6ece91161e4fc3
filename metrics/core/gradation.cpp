#include "metrics/core/gradation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "metrics/core/adjacency.hpp"
#include "metrics/core/tensor.hpp"

namespace metrics {

namespace {

// What one vertex allows around it: its spectrum is wanted for each of its edges.
class Source {
  public:
    Source(Tensor m, const Gradation& rule) : m_(m), spectrum_(spectrum(m)), rule_(rule) {}

    // Makes the metric at the other end of the edge (dx, dy) finer if it has to be; true if it had.
    bool refine(Tensor& other, double dx, double dy) const {
        if (rule_.law == GradationLaw::h_correction) return correct(other, dx, dy);
        if (is_finer(other, m_)) return false;
        const double in_metric = 1 + rule_.log_beta * length(m_, dx, dy);
        const double step = rule_.log_beta * std::sqrt(dx * dx + dy * dy);
        if (is_finer(other, share_left(spectrum_.low, in_metric, step) * m_)) return false;
        const Tensor bound = allowed(in_metric, step);
        const double slack = 1 + rule_.tolerance;
        if (!(Reduction(other, bound).high > slack * slack)) return false;
        other = intersect(other, bound);
        return true;
    }

  private:
    // What is allowed at the other end of an edge, from the growth of sizes along it in the metric
    // and its length times ln(beta).
    Tensor allowed(double in_metric, double step) const {
        const auto [low, high, x, y] = spectrum_;
        return from_spectrum({low * share_left(low, in_metric, step),
                              high * share_left(high, in_metric, step), x, y});
    }

    // How much of an eigenvalue is left.
    //
    // Metric-space growth: all sizes grow by the same factor, 1 + l ln(beta), with l the length of
    // the edge in the metric here. Mixed-space growth: metric growth to 7/8, and to 1/8 physical
    // growth, h + |e| ln(beta) for each size h by itself, which makes an ellipse rounder with the
    // distance. Of sizes; so of eigenvalues it is the fourth root. The smaller eigenvalue keeps the
    // larger share.
    double share_left(double eigenvalue, double in_metric, double step) const {
        if (rule_.law == GradationLaw::metric) return 1 / (in_metric * in_metric);
        const double in_space = 1 + step * std::sqrt(eigenvalue);
        return std::sqrt(std::sqrt(in_metric / in_space)) / (in_metric * in_metric);
    }

    // Whether s allows nothing that t does not, certainly: s - t is positive definite by more than
    // rounding. It need not tell of all that are, but it is quick, and nearly all edges pass.
    static bool is_finer(Tensor s, Tensor t) {
        const double a = s.a - t.a, c = s.c - t.c, b = s.b - t.b;
        return a > 0 && c > 0 && a * c - b * b > 0x1p-49 * ((s.a + t.a) * (s.c + t.c));
    }

    // H-correction. With h = |e| / a here and |e| / b there, and the length l = (a - b) / ln(a / b)
    // of an edge along which sizes change geometrically, the H-shock is (a / b)^(1 / l). If it is
    // above beta, the other metric is multiplied so that it is beta.
    bool correct(Tensor& other, double dx, double dy) const {
        const double a = length(m_, dx, dy), b = length(other, dx, dy);
        if (!(a > b)) return false;
        const double ratio = std::log(a / b);
        const double allowed = largest_ratio(rule_.log_beta * a);
        if (!(ratio > allowed + std::log1p(rule_.tolerance))) return false;
        other = std::exp(2 * (ratio - allowed)) * other;
        return true;
    }

    // x > 0 with x^2 = k (1 - exp(-x)): the logarithm of a / b for the H-shock beta, k = a
    // ln(beta). The difference of both sides is convex and not negative at the start, so that
    // Newton's method falls to the root.
    static double largest_ratio(double k) {
        double x = std::min(k, std::sqrt(k));
        for (int step = 0; step < 60; ++step) {
            const double value = x * x + k * std::expm1(-x), slope = 2 * x - k * std::exp(-x);
            const double next = x - value / slope;
            if (!(next < x * (1 - 1e-15))) break;
            x = next;
        }
        return x;
    }

    Tensor m_;
    Spectrum spectrum_;
    const Gradation& rule_;
};

// When a vertex is to speak: the smallest ellipse first, then the shortest edges.
struct Turn {
    double smallness, shortness;
    Index vertex;

    Turn(Index v, Tensor m, double edge_squares)
        : smallness(to_digits(det(m))), shortness(-to_digits(edge_squares)), vertex(v) {}

    bool operator<(const Turn& other) const {  // the queue has the largest on top
        return std::tie(smallness, shortness, vertex) <
               std::tie(other.smallness, other.shortness, other.vertex);
    }

  private:
    // The logarithm, to what rounding leaves alone.
    static double to_digits(double x) { return std::round(std::log(x) * 1e9); }
};

// For each vertex the sum of the squares of its edges.
std::vector<double> sums_of_squares(const double* points, const Adjacency& mesh) {
    std::vector<double> out(mesh.size(), 0.0);
    for (std::size_t p = 0; p < mesh.size(); ++p) {
        for (const Index q : mesh.of(Index(p))) {
            const double dx = points[2 * q] - points[2 * p];
            const double dy = points[2 * q + 1] - points[2 * p + 1];
            out[p] += dx * dx + dy * dy;
        }
    }
    return out;
}

}  // namespace

void grade(const double* points, Tensor* tensors, const Adjacency& mesh, const Gradation& rule) {
    const std::vector<double> squares = sums_of_squares(points, mesh);
    const auto turn = [&](Index v) { return Turn(v, tensors[v], squares[v]); };
    std::vector<Turn> all;
    all.reserve(mesh.size());
    for (std::size_t v = 0; v < mesh.size(); ++v) all.push_back(turn(Index(v)));
    std::priority_queue<Turn> queue({}, std::move(all));
    std::vector<char> waiting(mesh.size(), 1);
    while (!queue.empty()) {
        const Index p = queue.top().vertex;
        queue.pop();
        if (!waiting[p]) continue;  // it has spoken since, with a smaller ellipse
        waiting[p] = 0;
        const Source source(tensors[p], rule);
        for (const Index q : mesh.of(p)) {
            const double dx = points[2 * q] - points[2 * p];
            const double dy = points[2 * q + 1] - points[2 * p + 1];
            if (!source.refine(tensors[q], dx, dy)) continue;
            waiting[q] = 1;
            queue.push(turn(q));
        }
    }
}

}  // namespace metrics
