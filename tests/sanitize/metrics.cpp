// The core of metrics: fields at vertices, and segments.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "adaptmesh/core/triangulation/cdt.hpp"
#include "metrics/core/adjacency.hpp"
#include "metrics/core/background.hpp"
#include "metrics/core/edge_sides.hpp"
#include "metrics/core/gradation.hpp"
#include "metrics/core/lumped.hpp"
#include "metrics/core/nodal.hpp"
#include "metrics/core/recovery.hpp"
#include "metrics/core/segments.hpp"
#include "tests/sanitize/input.hpp"
#include "tests/sanitize/mesher.hpp"
#include "tests/sanitize/transfer.hpp"

namespace sanitize {

namespace {

// The domain of an input, its vertices those of triangles.
FlatMesh domain_of(const Input& input) {
    const Triangulation mesh =
        triangulate(input.points, input.segments, input.options, monitor()).triangulation;
    std::vector<std::int32_t> number(input.points.size(), -1), corners;
    std::vector<Point> points;
    for (const Triangle& t : mesh.triangles) {
        for (Index v : t.v) {
            if (number[v] < 0) {
                number[v] = std::int32_t(points.size());
                points.push_back(input.points[v]);
            }
            corners.push_back(number[v]);
        }
    }
    return {points, corners};
}

bool is_near(Tensor s, Tensor t, double share) {
    const double size = std::abs(t.a) + std::abs(t.c);
    return std::abs(s.a - t.a) + std::abs(s.b - t.b) + std::abs(s.c - t.c) <= share * size;
}

}  // namespace

// Interpolated at a vertex a metric is what it is there; what has been graded is left as it is when
// it is graded again; lengths and areas of one tensor are those in it.
void run_carried_metric(const Input& input) {
    const FlatMesh mesh = domain_of(input);
    if (!mesh.is_valid() || !has_extent(mesh.points)) return;
    const auto& all = metrics_of_unit_square();
    const MovedMetric metric(all[2], mesh.points);
    if (!metric.is_defined()) return;
    std::vector<Tensor> tensors = evaluate(metric.field(), mesh.points);
    std::vector<double> logs;
    for (const Tensor& m : tensors) {
        const Tensor log = metrics::log_tensor(m);
        logs.insert(logs.end(), {log.a, log.b, log.c});
    }
    const std::size_t n = mesh.points.size(), m = mesh.areas.size();
    const metrics::Background background(&mesh.points[0].x, logs.data(), n, mesh.triangles.data(),
                                         m);
    for (std::size_t v = 0; v < n; ++v) {
        const metrics::Location place = background.locate(mesh.points[v].x, mesh.points[v].y, -1);
        if (*std::max_element(place.weight, place.weight + 3) < 1) continue;  // beside a needle
        require(is_near(background.value(place), tensors[v], 1e-6), input,
                "a vertex has its own metric");
    }

    const metrics::Adjacency neighbours(mesh.triangles.data(), m, n);
    for (auto law : {metrics::GradationLaw::metric, metrics::GradationLaw::mixed,
                     metrics::GradationLaw::h_correction}) {
        std::vector<Tensor> graded = tensors;
        const metrics::Gradation rule{law, std::log(1.5), 1e-3};
        metrics::grade(&mesh.points[0].x, graded.data(), neighbours, rule);
        std::vector<Tensor> again = graded;
        metrics::grade(&mesh.points[0].x, again.data(), neighbours, rule);
        for (std::size_t v = 0; v < n; ++v) {
            require(is_near(again[v], graded[v], 1e-12), input, "graded is graded");
            require(metrics::det(graded[v]) >= (1 - 1e-9) * metrics::det(tensors[v]), input,
                    "grading makes finer");
        }
    }

    std::size_t edges = 0, sides = 0;
    metrics::EdgeSides(mesh.triangles.data(), m, n)
        .for_each_edge([&](Index a, Index b, const auto* first, const auto* end) {
            ++edges, sides += std::size_t(end - first);
            const double dx = mesh.points[b].x - mesh.points[a].x;
            const double dy = mesh.points[b].y - mesh.points[a].y;
            const Tensor log = metrics::log_tensor(tensors[a]);
            const double length = metrics::length_by_quadrature(log, log, dx, dy);
            const double expected = std::sqrt(tensors[a].q(dx, dy));
            require(std::abs(length - expected) <= 1e-6 * expected, input,
                    "in one metric a length is the length in it");
        });
    require(sides == 3 * m && edges < sides, input, "every side is on one edge");
    require(std::abs(metrics::mean_exponential(0.3, 0.3, 0.3) - 0.5 * std::exp(0.3)) < 1e-14, input,
            "the mean of a constant is the constant");
}

// Derivatives are finite; on grids those of a quadratic are exact.
void run_recovery(const Input& input) {
    const FlatMesh mesh = domain_of(input);
    if (!mesh.is_valid() || !has_extent(mesh.points)) return;
    const std::size_t n = mesh.points.size(), m = mesh.areas.size();
    const Frame frame(mesh.points);
    std::vector<double> values;
    for (Point p : mesh.points) {
        const Point q = frame.in_unit_square(p);
        values.push_back(1 + 2 * q.x - 3 * q.y + q.x * q.x - q.x * q.y + 2 * q.y * q.y);
    }
    const double scale = 1 / (frame.side * frame.side);
    const Tensor hessian{2 * scale, -1 * scale, 4 * scale};
    const bool is_grid = input.name == "framed grid" && !frame.is_far;

    const metrics::Adjacency neighbours(mesh.triangles.data(), m, n);
    metrics::QuadraticFit fit(&mesh.points[0].x, values.data(), neighbours);
    for (std::size_t v = 0; v < n; ++v) {
        metrics::Derivatives d{};
        if (!fit.at(Index(v), d)) continue;
        require(std::isfinite(d.dx) && std::isfinite(d.dy) && std::isfinite(d.hessian.a), input,
                "derivatives are finite");
        if (is_grid)
            require(is_near(d.hessian, hessian, 1e-4), input, "a quadratic has its own Hessian");
    }
    std::vector<double> gradients(2 * n);
    metrics::project_gradient(&mesh.points[0].x, n, mesh.triangles.data(), m, values.data(),
                              gradients.data());
    const auto by_green =
        metrics::green_hessians(&mesh.points[0].x, n, mesh.triangles.data(), m, values.data());
    require(by_green.size() == n, input, "every vertex has a Hessian");
}

// The nearest point is that of all segments, and sizes that spread from their ends are no larger
// than from any end.
void run_segments(const Input& input) {
    if (!has_extent(input.points) || input.segments.empty()) return;
    std::vector<double> ends, sizes, left;
    const Frame frame(input.points);
    for (Segment s : input.segments) {
        for (Index v : {s.a, s.b}) {
            const Point p = input.points[v];
            ends.insert(ends.end(), {p.x, p.y});
            sizes.push_back((0.1 + 0.01 * (v % 7)) * frame.side);
        }
        left.push_back(frame.low.x);
    }
    metrics::Segments segments(ends.data(), input.segments.size());
    constexpr double GROWTH = 0.3;
    const metrics::Spreading spreading(segments, sizes.data(), GROWTH);
    segments.prepare_rings(left.data());
    require(!segments.encloses(frame.low.x + 3 * frame.side, frame.low.y), input,
            "what is to the right of all is in none");
    std::mt19937 random(7);
    for (int k = 0; k < 50; ++k) {
        const double x = frame.low.x + frame.side * (random() % 1000) / 1000.0;
        const double y = frame.low.y + frame.side * (random() % 1000) / 1000.0;
        const metrics::OnSegment found = segments.nearest(x, y);
        const double distance = std::hypot(found.x - x, found.y - y),
                     slack = 1e-9 * frame.side + frame.rounding;
        const double size = spreading.at(x, y).first;
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            const double to_end = std::hypot(ends[2 * i] - x, ends[2 * i + 1] - y);
            require(distance <= to_end + slack, input, "nothing is nearer than the nearest");
            require(size <= sizes[i] + GROWTH * to_end + slack, input,
                    "a size is not larger than it spreads");
        }
    }
}

}  // namespace sanitize
