#include "adaptmesh/core/mesher/edge_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/mesher/chord.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

void EdgeSampler::clear() {
    edges_.clear(), lengths_.clear();
    chords_.clear();
    pieces_.clear(), first_.clear();
}

void EdgeSampler::measure(const MetricField& metric, std::size_t max_chords) {
    std::vector<Chord> chords;
    std::vector<Point> midpoints;
    while (!chords_.empty()) {
        chords.swap(chords_);
        chords_.clear();
        midpoints.clear();
        for (const Chord& c : chords) midpoints.push_back(point(c.edge, 0.5 * (c.from.t + c.to.t)));
        if (chords.size() > max_chords) throw TooManyVertices(midpoints[chords.size() / 2]);
        split(chords, evaluate(metric, midpoints));
    }
    finish();
}

void EdgeSampler::cut(Index e, Index parts, std::vector<FieldPoint>& out) const {
    const double share = lengths_[e] / parts;
    Index piece = first_[e];
    double before = 0, here = pieces_[piece].length;
    for (Index i = 1; i < parts; ++i) {
        const double goal = i * share;
        while (before + here < goal && piece + 1 < first_[e + 1]) {
            before += here;
            here = pieces_[++piece].length;
        }
        out.push_back(point_in_piece(pieces_[piece], std::min(1.0, (goal - before) / here)));
    }
}

double EdgeSampler::middle(Index e) const {
    double goal = 0.5 * lengths_[e];
    Index piece = first_[e];
    while (piece + 1 < first_[e + 1] && pieces_[piece].length < goal)
        goal -= pieces_[piece++].length;
    const Chord& p = pieces_[piece];
    return p.from.t + share_in_piece(p, std::min(1.0, goal / p.length)) * (p.to.t - p.from.t);
}

std::array<double, 2> EdgeSampler::moments(Index e) const {
    double total = 0, from_start = 0;
    for (Index i = first_[e]; i < first_[e + 1]; ++i) {
        const Chord& p = pieces_[i];
        const double t0 = std::max(p.from.t, UNSEEN), t1 = std::min(p.to.t, 1 - UNSEEN),
                     dt = (t1 - t0) / 6;
        if (!(dt > 0)) continue;
        const double s0 = p.from.sqrt_det, s1 = p.to.sqrt_det;
        const double middle = 4 * std::sqrt(s0 * s1);
        total += dt * (s0 + middle + s1);
        from_start += dt * (t0 * s0 + 0.5 * (t0 + t1) * middle + t1 * s1);
    }
    total /= 1 - 2 * UNSEEN, from_start /= 1 - 2 * UNSEEN;
    return {2 * from_start, 2 * (total - from_start)};
}

EdgeSampler::Halved EdgeSampler::halve(const Chord& c, const Tensor& metric) const {
    const Station middle = station(0.5 * (c.from.t + c.to.t), metric);
    const Point v = edges_[c.edge].vector;
    const double dt = c.to.t - c.from.t, half = 0.5 * dt;
    const double start = dt * speed(c.from, v), half_way = dt * speed(middle, v),
                 end = dt * speed(c.to, v);
    const Point w{half * v.x, half * v.y};
    const Halves h =
        rule_.halve({c.length, length_by_speeds(start, end)},
                    {length_by_ends(c.from, middle, w), 0.5 * length_by_speeds(start, half_way)},
                    {length_by_ends(middle, c.to, w), 0.5 * length_by_speeds(half_way, end)},
                    c.is_by_speeds, c.depth);
    return {{c.edge, c.depth + 1, c.from, middle, h.first, h.are_by_speeds},
            {c.edge, c.depth + 1, middle, c.to, h.second, h.are_by_speeds},
            h.first + h.second,
            h.are_trusted};
}

void EdgeSampler::split(const std::vector<Chord>& chords, const std::vector<Tensor>& middles) {
    std::vector<Halved> halves;  // of the edge at hand
    for (std::size_t i = 0; i < chords.size();) {
        const Index edge = chords[i].edge;
        double estimate = lengths_[edge];
        halves.clear();
        for (; i < chords.size() && chords[i].edge == edge; ++i) {
            halves.push_back(halve(chords[i], middles[i]));
            estimate += halves.back().length;
        }
        for (const Halved& h : halves) keep(h, estimate);
    }
}

void EdgeSampler::keep(const Halved& h, double estimate) {
    const Index edge = h.left.edge;
    const bool measured_enough = h.is_trusted || estimate > longest_edge_;
    if (measured_enough) {
        lengths_[edge] += h.length;
        // Most edges are trusted at once, and will not be cut.
        if (h.left.depth == 1 && h.length < uncut_below_) return;
    }
    auto& kept = measured_enough ? pieces_ : chords_;
    kept.push_back(h.left);
    kept.push_back(h.right);
}

void EdgeSampler::finish() {
    first_.assign(edges_.size() + 1, 0);
    for (const Chord& p : pieces_) ++first_[p.edge + 1];
    for (std::size_t e = 0; e < edges_.size(); ++e) first_[e + 1] += first_[e];
    std::vector<Index> free(first_.begin(), first_.end() - 1);
    std::vector<Chord> sorted(pieces_.size());
    for (const Chord& p : pieces_) sorted[free[p.edge]++] = p;
    pieces_.swap(sorted);
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        std::sort(pieces_.begin() + first_[e], pieces_.begin() + first_[e + 1],
                  [](const Chord& p, const Chord& q) { return p.from.t < q.from.t; });
    }
}

double EdgeSampler::share_in_piece(const Chord& p, double share) const {
    const Point v = edges_[p.edge].vector;
    const double r = std::sqrt(p.to.metric.q(v.x, v.y) / p.from.metric.q(v.x, v.y));
    return std::abs(r - 1) < 1e-6 ? share : std::log1p(share * (r - 1)) / std::log(r);
}

FieldPoint EdgeSampler::point_in_piece(const Chord& p, double share) const {
    const double s = share_in_piece(p, share), t = p.from.t + s * (p.to.t - p.from.t);
    return {point(p.edge, t), metrics::log_mean(p.from.metric, p.to.metric, s), t};
}

}  // namespace adaptmesh
