// Meshes before and after the final optimisation, judged by sums over many samples of the metric.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include "adaptmesh/core/mesher/cut_boundary.hpp"
#include "adaptmesh/core/mesher/final_optimisation.hpp"
#include "adaptmesh/core/mesher/generate.hpp"
#include "adaptmesh/core/mesher/optimise.hpp"
#include "adaptmesh/core/placements/along_edges.hpp"
#include "adaptmesh/core/placements/front.hpp"
#include "tests/sanitize/input.hpp"
#include "tests/sanitize/mesher.hpp"

namespace sanitize {

namespace {

const std::vector<Point>& unit_square() {
    static const std::vector<Point> corners = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    return corners;
}

// The unit square, filled and optimised, but for the last stage.
MetricMesh unfinished_square(const MovedMetric& metric, Monitor& monitor) {
    const std::vector<Segment> sides = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    Triangulation outside;
    const auto triangulated = triangulate(unit_square(), sides, {}, monitor, &outside);
    const BoundaryCuts boundary =
        unit_boundary(unit_square(), sides, triangulated.sub_edges, metric);
    MetricMesh mesh;
    mesh.topology = triangulated.triangulation;
    for (std::size_t i = 0; i < 4; ++i)
        mesh.vertices.push_back(Vertex::make(boundary.points[i], boundary.tensors[i], FIXED));
    Outside around(outside, unit_square());
    cut_boundary(mesh, around, boundary, monitor);
    place_ahead_of_front(mesh, metric.field(), monitor);
    place_along_edges(mesh, metric.field(), monitor);
    optimise(mesh, metric.field(), monitor);
    return mesh;
}

// By the midpoint rule with many points.
double sampled_length(const MovedMetric& metric, Point p, Point q) {
    constexpr int SAMPLES = 200;
    double sum = 0;
    for (int k = 0; k < SAMPLES; ++k) {
        const double t = (k + 0.5) / SAMPLES;
        const Tensor m = metric.at({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y)});
        sum += std::sqrt(m.q(q.x - p.x, q.y - p.y)) / SAMPLES;
    }
    return sum;
}

// 4 sqrt(3) area / (sum of squared sides), the area from samples in a grid.
double sampled_quality(const MovedMetric& metric, Point a, Point b, Point c) {
    constexpr int SAMPLES = 40;
    double density = 0;
    int count = 0;
    for (int i = 0; i < SAMPLES; ++i) {
        for (int j = 0; i + j < SAMPLES; ++j, ++count) {
            const double s = (i + 1.0 / 3) / SAMPLES, t = (j + 1.0 / 3) / SAMPLES;
            const Tensor m = metric.at(
                {a.x + s * (b.x - a.x) + t * (c.x - a.x), a.y + s * (b.y - a.y) + t * (c.y - a.y)});
            density += std::sqrt(m.a * m.c - m.b * m.b);
        }
    }
    const double area =
        0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) * density / count;
    const double u = sampled_length(metric, a, b), v = sampled_length(metric, b, c),
                 w = sampled_length(metric, c, a);
    return 4 * std::sqrt(3.0) * area / (u * u + v * v + w * w);
}

struct Judgement {
    double share_off_unit, worst_quality;
};

Judgement judged(const MetricMesh& mesh, const MovedMetric& metric) {
    int edges = 0, off = 0;
    double worst = 1;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (mesh.topology.is_dead(t)) continue;
        const Triangle& T = mesh.triangle(t);
        const Point a = mesh.at(T.v[0]), b = mesh.at(T.v[1]), c = mesh.at(T.v[2]);
        worst = std::min(worst, sampled_quality(metric, a, b, c));
        for (int slot = 0; slot < 3; ++slot, ++edges) {
            const double length =
                sampled_length(metric, mesh.at(T.v[next(slot)]), mesh.at(T.v[prev(slot)]));
            off += length < std::sqrt(0.5) || length > std::sqrt(2.0);
        }
    }
    return {double(off) / edges, worst};
}

bool are_same(const MetricMesh& a, const MetricMesh& b) {
    const auto same_place = [](const Vertex& v, const Vertex& w) {
        return v.at.x == w.at.x && v.at.y == w.at.y;
    };
    const auto same_corners = [](const Triangle& t, const Triangle& u) {
        return std::equal(t.v, t.v + 3, u.v);
    };
    const auto &v = a.vertices, &w = b.vertices;
    const auto &t = a.topology.triangles, &u = b.topology.triangles;
    return std::equal(v.begin(), v.end(), w.begin(), w.end(), same_place) &&
           std::equal(t.begin(), t.end(), u.begin(), u.end(), same_corners);
}

void expect(bool holds, const char* what) {
    if (holds) return;
    std::printf("FAILED in the final optimisation: %s\n", what);
    std::exit(1);
}

MetricMesh finished(MetricMesh mesh, const MovedMetric& metric, Monitor& monitor) {
    final_optimisation(mesh, metric.field(), monitor);
    return mesh;
}

// Anisotropic along a sine wave, `scale` times coarser: axes turn within an edge where it bends.
Tensor ridge(Point p, double scale) {
    constexpr double PI = 3.141592653589793;
    const double t = p.y - 0.5 - 0.2 * std::sin(2 * PI * p.x);
    const double slope = -0.4 * PI * std::cos(2 * PI * p.x), norm = std::hypot(slope, 1);
    const double fine = std::pow(0.004 + 0.1 * t * t, -2), coarse = std::pow(0.08, -2);
    const double a = slope / norm, b = 1 / norm, extra = std::max(fine - coarse, 0.0);
    const Tensor m{coarse + extra * a * a, extra * a * b, coarse + extra * b * b};
    return (1 / (scale * scale)) * m;
}

}  // namespace

void check_final_optimisation() {
    Monitor& monitor = sanitize::monitor();
    const Metric jump = [](Point p) {
        return metrics::from_size(std::hypot(p.x - 0.45, p.y - 0.55) < 0.2 ? 0.008 : 0.4);
    };
    const Metric smooth = [](Point p) {
        return metrics::from_size(0.01 + 0.05 * std::hypot(p.x, p.y));
    };
    const Metric turning = [](Point p) { return sizes(0.05, 0.01, 100 * p.x); };
    {
        const MovedMetric metric(jump, unit_square());
        const MetricMesh before = unfinished_square(metric, monitor);
        const Judgement then = judged(finished(before, metric, monitor), metric);
        expect(then.share_off_unit < 0.3 * judged(before, metric).share_off_unit,
               "most edges that were off unit beside a jump are unit");
    }
    {
        const MovedMetric metric(smooth, unit_square());
        const MetricMesh before = unfinished_square(metric, monitor);
        expect(are_same(before, finished(before, metric, monitor)),
               "what fits a smooth metric is left as it is");
    }
    {
        const MovedMetric metric(turning, unit_square());
        const MetricMesh before = unfinished_square(metric, monitor);
        expect(judged(before, metric).share_off_unit > 0.05, "this metric is too much for edges");
        expect(are_same(before, finished(before, metric, monitor)),
               "where most edges are off unit nothing is tried");
    }
    double gains = 0, off_before = 0, off_after = 0;
    for (double scale : {0.8, 1.0, 1.2, 1.5, 1.8, 2.2}) {
        const Metric field = [scale](Point p) { return ridge(p, 1 / scale); };
        const MovedMetric metric(field, unit_square());
        MetricMesh mesh = unfinished_square(metric, monitor);
        Measures measures;
        make_unit(mesh, measures, metric.field(), monitor);
        const Judgement before = judged(mesh, metric);
        lift_worst(mesh, measures, metric.field(), monitor);
        const Judgement after = judged(mesh, metric);
        expect(after.worst_quality > before.worst_quality, "the worst triangle gets better");
        gains += after.worst_quality - before.worst_quality;
        off_before += before.share_off_unit, off_after += after.share_off_unit;
    }
    expect(gains > 6 * 0.03, "the worst triangles get better by a good deal");
    expect(off_after <= off_before, "edges are not given up for them");
}

}  // namespace sanitize
