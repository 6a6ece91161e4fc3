// Analytic metrics, and boundaries cut to unit in them: for runs of the mesher without Python.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "adaptmesh/core/mesher/boundary_cuts.hpp"
#include "adaptmesh/core/mesher/edge_sampler.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"

namespace sanitize {

using namespace adaptmesh;

using Metric = std::function<Tensor(Point)>;

// A size along an angle, and one across it.
inline Tensor sizes(double along, double across, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double a = 1 / (along * along), b = 1 / (across * across);
    return {a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c};
}

// For domains in the unit square: coarse and fine, graded, broken, slanted, turning.
inline const std::vector<Metric>& metrics_of_unit_square() {
    static const std::vector<Metric> all = {
        [](Point) { return sizes(0.15, 0.15, 0); },
        [](Point) { return sizes(1e6, 1e6, 0); },
        [](Point p) { return metrics::from_size(1e-4 + 0.4 * std::hypot(p.x - 0.3, p.y - 0.4)); },
        [](Point p) { return metrics::from_size(p.x < 0.51 ? 0.05 : 1e9); },
        [](Point) { return sizes(0.5, 0.01, 0.4); },
        [](Point p) { return sizes(0.3, 0.05, std::atan2(p.y - 0.5, p.x - 0.5)); },
        [](Point p) { return sizes(0.3, 0.06, 1e3 * p.x); },
    };
    return all;
}

// Where points are.
struct Frame {
    Point low;
    double side;      // of the box around them
    bool is_far;      // from the origin, so that coordinates are rounded
    double rounding;  // a few units in the last place of coordinates

    explicit Frame(const std::vector<Point>& points) : low(points.front()) {
        Point high = low;
        double largest = 0;
        for (Point p : points) {
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
        }
        side = std::max(high.x - low.x, high.y - low.y);
        is_far = largest > 1e3 * side;
        rounding = 0x1p-49 * largest;
    }

    Point in_unit_square(Point p) const { return {(p.x - low.x) / side, (p.y - low.y) / side}; }
};

// Whether their box is not too small or large for products of lengths.
inline bool has_extent(const std::vector<Point>& points) {
    if (points.empty()) return false;
    const double side = Frame(points).side;
    return side > 1e-60 && side < 1e60;
}

// A metric of the unit square, moved to where the points are.
class MovedMetric {
  public:
    MovedMetric(const Metric& metric, const std::vector<Point>& points)
        : metric_(metric), frame_(points) {}

    // Sizes beyond that cannot be held by a tensor.
    bool is_defined() const { return frame_.side > 1e-60 && frame_.side < 1e60; }

    Tensor at(Point p) const {
        return (1 / (frame_.side * frame_.side)) * metric_(frame_.in_unit_square(p));
    }

    MetricField field() const {
        return [this](const std::vector<Point>& points, std::vector<Tensor>& tensors) {
            tensors.clear();
            for (Point p : points) tensors.push_back(at(p));
        };
    }

  private:
    const Metric& metric_;
    Frame frame_;
};

// The sub-edges of a triangulation as the pieces of a boundary, cut into unit parts.
inline BoundaryCuts unit_boundary(const std::vector<Point>& points,
                                  const std::vector<Segment>& segments,
                                  const std::vector<SubEdge>& sub_edges,
                                  const MovedMetric& metric) {
    BoundaryCuts out{points, evaluate(metric.field(), points), segments, {}, {}, {}, {}, {}, {}};
    for (std::size_t i = 0; i < segments.size(); ++i) out.owners.push_back(Index(i));
    EdgeSampler sampler(0.125, INFINITY, 0.0);
    for (const SubEdge& e : sub_edges) {
        out.pieces.push_back({e.a, e.b, e.segment, false});
        sampler.add(points[e.a], out.tensors[e.a], points[e.b], out.tensors[e.b]);
    }
    sampler.measure(metric.field());
    for (Index p = 0; p < sampler.edge_count(); ++p) {
        std::vector<FieldPoint> cuts;
        sampler.cut(p, Index(unit_parts(sampler.lengths()[p])), cuts);
        for (const FieldPoint& cut : cuts) {
            out.cuts.push_back(cut.at);
            out.cut_pieces.push_back(p);
        }
    }
    out.cut_tensors = evaluate(metric.field(), out.cuts);
    return out;
}

}  // namespace sanitize
