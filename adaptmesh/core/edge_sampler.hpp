// How long is an edge, and where are its unit points, when the metric is known only by asking?
//
// The metric may be a function of Python, which answers fastest for whole arrays of points. So the
// sampler *asks in rounds*: it asks for the metric at the midpoints of all chords it is not sure
// of, splits the chords that still disagree with their halves, and so on until none is left. Then
// every edge is a row of pieces, each with its length and the speed |e|_M at both ends.
//
//        A-----------------B      chord: length by its ends, l(A, B)
//        A--------M--------B      with the metric at M: l(A, M) + l(M, B); if both agree -> two
//                                 pieces, else two chords, asked about in the next round
//
// A length by its ends takes the geometric mean of the metrics there for the metric half way. That
// of two thin ellipses turned against each other is nearly round, and lengths in it are far too
// small: where the axes turn, a chord and its halves can agree on a third of the true length. The
// speeds at the ends still do: see `by_speeds`.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "adaptmesh/core/metric_field.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/point.hpp"
#include "adaptmesh/core/triangulation.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

// How many parts bring an edge of this length nearest to unit: n parts up to sqrt(n (n + 1)), where
// n parts are as much too long as n + 1 are too short. Ties by rounding go to fewer.
inline double unit_parts(double length) {
    const double l = length * (1 - 1e-9);
    return std::max(1.0, std::floor(0.5 * (1 + std::sqrt(1 + 4 * l * l))));
}

// A point at a unit distance along an edge, with the metric interpolated there.
struct FieldPoint {
    Point at;
    Tensor metric;
    double t;  // where on the edge, from 0 at its start to 1 at its end
};

class EdgeSampler {
  public:
    // More chords at once would be a mesh of millions of vertices, and a gigabyte of memory.
    static constexpr std::size_t MAX_CHORDS = 8'000'000;
    // A chord is trusted when its own length and that of its halves agree to this share (the
    // halves are then right to about a tenth of it), if ...
    static constexpr double AGREEMENT = 0.05;
    // Shorter ones are trusted as they are: they cannot change the count of points.
    static constexpr double SHORTEST_CHORD = 0.05;
    // From a thousandth of the edge on, chords may be longer than asked for.
    static constexpr int FINE_DEPTH = 10;
    static constexpr double LONGEST_FINE_CHORD = 4.0;
    // Axes turn where a length by the ends is less than that by the speeds by more than this share,
    // which is 2/3 at the most between equal speeds. With less, meshes of layers that bend, which
    // are measured well by the ends, would change.
    static constexpr double TURNED = 0.46;
    static constexpr int DEEPEST = 1000;    // the end of halving doubles
    static constexpr double UNSEEN = 0.02;  // share of an edge, see moments()

    // ... and it is no longer than `longest_chord`: finer detail can pass unseen between samples.
    // Edges shorter than `uncut_below` will not be cut: only their lengths are kept. Of edges
    // longer than `longest_edge` nobody wants to know how long they are: they are not looked at
    // closer.
    EdgeSampler(double longest_chord, double longest_edge, double uncut_below)
        : longest_chord_(longest_chord), longest_edge_(longest_edge), uncut_below_(uncut_below) {}

    // Forgets all edges, but keeps their memory.
    void clear() {
        edges_.clear(), lengths_.clear();
        chords_.clear();
        pieces_.clear(), first_.clear();
    }

    void reserve(std::size_t n) { edges_.reserve(n), chords_.reserve(n), lengths_.reserve(n); }

    void add(Point a, const Tensor& metric_a, Point b, const Tensor& metric_b) {
        const Index edge = Index(edges_.size());
        edges_.push_back({a, {b.x - a.x, b.y - a.y}});
        chords_.push_back(chord(edge, 0, {0.0, metric_a, metrics::sqrt_det(metric_a)},
                                {1.0, metric_b, metrics::sqrt_det(metric_b)}));
        lengths_.push_back(0.0);
    }

    Index edge_count() const { return Index(edges_.size()); }

    // Measures all edges. More chords than `max_chords` in one round are TooManyVertices.
    void measure(const MetricField& metric, std::size_t max_chords = MAX_CHORDS) {
        std::vector<Chord> chords;
        std::vector<Point> midpoints;
        while (!chords_.empty()) {
            chords.swap(chords_);
            chords_.clear();
            midpoints.clear();
            for (const Chord& c : chords)
                midpoints.push_back(point(c.edge, 0.5 * (c.from.t + c.to.t)));
            if (chords.size() > max_chords) throw TooManyVertices(midpoints[chords.size() / 2]);
            split(chords, evaluate(metric, midpoints));
        }
        finish();
    }

    // Metric length of each edge, once all are measured.
    const std::vector<double>& lengths() const { return lengths_; }

    // Appends the points that cut an edge in `parts` at equal metric shares.
    void cut(Index e, Index parts, std::vector<FieldPoint>& out) const {
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

    // Where on an edge, from 0 at its start to 1 at its end, half of its length is reached.
    double middle(Index e) const {
        double goal = 0.5 * lengths_[e];
        Index piece = first_[e];
        while (piece + 1 < first_[e + 1] && pieces_[piece].length < goal)
            goal -= pieces_[piece++].length;
        const Chord& p = pieces_[piece];
        return p.from.t + share_in_piece(p, std::min(1.0, goal / p.length)) * (p.to.t - p.from.t);
    }

    // The integrals of 2 t s and 2 (1 - t) s along an edge, with s = sqrt(det M) and t from 0 at
    // its start to 1 at its end: means of s over a thin triangle with its tip at the start, or at
    // the end. Without both ends: a strip that thin beside a jump is not seen by a quadrature with
    // few points, and area that lies in it is worth nothing to who uses one.
    std::array<double, 2> moments(Index e) const {
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

  private:
    struct Edge {
        Point from;
        Point vector;
    };
    struct Station {  // a point on an edge, and the metric there
        double t;
        Tensor metric;
        double sqrt_det;
    };
    struct Chord {
        Index edge;
        int depth;
        Station from, to;
        double length;
        bool is_by_speeds = false;  // as are all parts of it
    };

    struct Halved {
        Chord left, right;
        double length;
        bool is_trusted;
    };

    Chord chord(Index edge, int depth, const Station& from, const Station& to) const {
        const Point v = edges_[edge].vector;
        const double dt = to.t - from.t;
        return {edge, depth, from, to,
                metrics::length(from.metric, from.sqrt_det, to.metric, to.sqrt_det, dt * v.x,
                                dt * v.y)};
    }

    // The length of a chord is that of its vector at the metric there.
    double speed(const Chord& c, const Station& at) const {
        const Point v = edges_[c.edge].vector;
        return (c.to.t - c.from.t) * std::sqrt(std::max(at.metric.q(v.x, v.y), 0.0));
    }

    // Simpson's rule with the geometric mean of the two speeds half way: the same as by the metrics
    // at the ends where the edge lies along their common axes, and never less.
    static double by_speeds(double start, double end) {
        return (start + 4 * std::sqrt(start * end) + end) * (1.0 / 6);
    }

    static bool is_turned(double by_ends, double by_speeds) {
        return by_speeds - by_ends > TURNED * by_speeds;
    }

    Halved halve(const Chord& c, const Tensor& metric) const {
        const Station middle{0.5 * (c.from.t + c.to.t), metric, metrics::sqrt_det(metric)};
        Chord left = chord(c.edge, c.depth + 1, c.from, middle);
        Chord right = chord(c.edge, c.depth + 1, middle, c.to);
        double whole = c.length, halves = left.length + right.length;
        const double start = speed(c, c.from), half_way = speed(c, middle), end = speed(c, c.to);
        const double whole_by_speeds = by_speeds(start, end);
        const double first = 0.5 * by_speeds(start, half_way);
        const double second = 0.5 * by_speeds(half_way, end);
        if (c.is_by_speeds || is_turned(whole, whole_by_speeds) ||
            is_turned(halves, first + second)) {
            whole = whole_by_speeds, halves = first + second;
            left.length = first, right.length = second;
            left.is_by_speeds = right.is_by_speeds = true;
        }
        const bool agree = std::abs(whole - halves) <= AGREEMENT * halves;
        const double longest = c.depth < FINE_DEPTH ? longest_chord_ : LONGEST_FINE_CHORD;
        return {left, right, halves,
                (agree && halves <= longest) || halves <= SHORTEST_CHORD || c.depth >= DEEPEST};
    }

    // Halves chords, those of each edge in a row, with the metrics at their midpoints.
    void split(const std::vector<Chord>& chords, const std::vector<Tensor>& middles) {
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

    // Keeps the halves, or has them asked about; `estimate` is what the edge is now thought to be.
    void keep(const Halved& h, double estimate) {
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

    Point point(Index edge, double t) const {
        const Edge& e = edges_[edge];
        return {e.from.x + t * e.vector.x, e.from.y + t * e.vector.y};
    }

    // Pieces come in the order in which they were trusted: brought together by edges, and sorted
    // along each.
    void finish() {
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

    // The size is taken to be geometric along a piece: with r the ratio of the speeds at its ends,
    // the share s of its length is reached at log(1 + s (r - 1)) / log r.
    double share_in_piece(const Chord& p, double share) const {
        const Point v = edges_[p.edge].vector;
        const double r = std::sqrt(p.to.metric.q(v.x, v.y) / p.from.metric.q(v.x, v.y));
        return std::abs(r - 1) < 1e-6 ? share : std::log1p(share * (r - 1)) / std::log(r);
    }

    FieldPoint point_in_piece(const Chord& p, double share) const {
        const double s = share_in_piece(p, share), t = p.from.t + s * (p.to.t - p.from.t);
        return {point(p.edge, t), metrics::log_mean(p.from.metric, p.to.metric, s), t};
    }

    double longest_chord_;
    double longest_edge_;
    double uncut_below_;
    std::vector<Edge> edges_;
    std::vector<Chord> chords_;    // to be asked about
    std::vector<Chord> pieces_;    // trusted
    std::vector<Index> first_;     // of each edge, in pieces_
    std::vector<double> lengths_;  // of what is trusted
};

}  // namespace adaptmesh
