// Drives the mesher as adaptmesh/generate.py does, without Python: for runs under sanitizers.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "adaptmesh/core/edges.hpp"
#include "adaptmesh/core/front.hpp"
#include "adaptmesh/core/improve.hpp"
#include "adaptmesh/core/outline.hpp"
#include "adaptmesh/core/smooth.hpp"
#include "adaptmesh/core/swap.hpp"
#include "adaptmesh/core/triangulate.hpp"

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

// A metric, moved to where the points are.
class MovedMetric {
  public:
    MovedMetric(const Metric& metric, const std::vector<Point>& points) : metric_(metric) {
        low_ = points.front();
        Point high = low_;
        for (Point p : points) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        side_ = std::max(high.x - low_.x, high.y - low_.y);
    }

    // Sizes beyond that cannot be held by a tensor.
    bool is_defined() const { return side_ > 1e-60 && side_ < 1e60; }

    Tensor operator()(Point p) const {
        const Point unit = {(p.x - low_.x) / side_, (p.y - low_.y) / side_};
        return (1 / (side_ * side_)) * metric_(unit);
    }

  private:
    const Metric& metric_;
    Point low_{};
    double side_ = 0;
};

class MesherRun {
  public:
    MesherRun(const ConstrainedTriangulation& outline, const Triangulation& outside,
              const std::vector<Point>& points, const MovedMetric& metric)
        : metric_(metric) {
        mesh.topology = outline.triangulation;
        for (Point p : points) mesh.vertices.push_back(Vertex::make(p, metric_(p), FIXED));
        mesh.take_fans_apart();
        swap(200);
        cut_outline(outline.sub_edges, Outside(outside, points));
    }

    MetricMesh mesh;
    std::vector<SubEdge> constrained;

    void fill_ahead_of_front() {
        Front front(mesh, {});
        while (front.advance(poll_)) {
            while (front.wanted_count() > 0) front.feed(at_points(front.wanted()));
            front.insert(poll_);
        }
    }

    void fill_along_edges() {
        constexpr double LONG_EDGE = 1.45, SPACING = 0.75;
        Index inserted = 0;
        do {
            const EdgesToMeasure edges = measure_fresh_edges(LONG_EDGE);
            inserted = insert_along_edges(mesh, edges, LONG_EDGE, SPACING, MOST_VERTICES, poll_);
            refresh();
        } while (inserted > 0);
    }

    void improve() {
        swap(5);
        for (int k = 0; k < 2; ++k) {
            smooth_changed(mesh, poll_);
            refresh();
            swap(5);
        }
        for (int k = 0; k < 4; ++k) {
            measure_fresh_edges(INFINITY);
            collapse_short_edges(mesh, {}, poll_);
            split_long_edges(mesh, {}, poll_);
            refresh();
            swap(5);
            search_active(mesh, {}, 0.12, poll_);
            refresh();
            swap(5);
        }
        for (Triangle& t : mesh.topology.triangles) t.fresh |= TO_SWAP;
        swap_changed(mesh, QualityCriterion{0.5}, 3, poll_);
        const std::vector<Index> name = mesh.compact();
        for (SubEdge& e : constrained) e.a = name[e.a], e.b = name[e.b];
    }

  private:
    static constexpr Index MOST_VERTICES = 20000;

    void swap(int passes) { swap_changed(mesh, DelaunayCriterion{}, passes, poll_); }

    std::function<Tensor(std::size_t)> at_points(std::vector<double> xy) const {
        return [this, xy](std::size_t i) { return metric_({xy[2 * i], xy[2 * i + 1]}); };
    }

    void measure(EdgeSampler& sampler) const {
        while (sampler.wanted_count()) sampler.feed(at_points(sampler.wanted()));
    }

    EdgesToMeasure measure_fresh_edges(double to_cut) {
        EdgesToMeasure edges = take_fresh_edges(mesh, to_cut);
        measure(edges.sampler);
        correct_lengths(mesh, edges);
        return edges;
    }

    void cut_outline(const std::vector<SubEdge>& sub_edges, Outside outside) {
        EdgeSampler sampler(0.125, INFINITY, 0);
        for (const SubEdge& e : sub_edges) {
            const Vertex &a = mesh.vertices[e.a], &b = mesh.vertices[e.b];
            sampler.add(a.at, a.metric, b.at, b.metric);
        }
        measure(sampler);
        std::vector<Piece> pieces;
        std::size_t n_cuts = 0;
        for (std::size_t i = 0; i < sub_edges.size(); ++i) {
            const SubEdge& e = sub_edges[i];
            pieces.push_back({e.a, e.b, e.segment, n_cuts, {}});
            std::vector<FieldPoint> cuts;
            sampler.cut(Index(i), Index(unit_parts(sampler.lengths()[i])), cuts);
            for (const FieldPoint& p : cuts)
                pieces.back().cuts.push_back(Vertex::make(p.at, metric_(p.at), e.segment));
            n_cuts += cuts.size();
        }
        constrained = OutlineCutter(mesh, outside).cut(pieces, poll_);
    }

    void refresh() {
        for (Index v : mesh.stale)
            mesh.vertices[v] =
                Vertex::make(mesh.at(v), metric_(mesh.at(v)), mesh.vertices[v].held_by);
        mesh.stale.clear();
    }

    const MovedMetric& metric_;
    NoPoll poll_;
};

}  // namespace sanitize
