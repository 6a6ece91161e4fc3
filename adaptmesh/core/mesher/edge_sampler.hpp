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

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"
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
    void clear();

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
    void measure(const MetricField& metric, std::size_t max_chords = MAX_CHORDS);

    // Metric length of each edge, once all are measured.
    const std::vector<double>& lengths() const { return lengths_; }

    // Appends the points that cut an edge in `parts` at equal metric shares.
    void cut(Index e, Index parts, std::vector<FieldPoint>& out) const;

    // Where on an edge, from 0 at its start to 1 at its end, half of its length is reached.
    double middle(Index e) const;

    // The integrals of 2 t s and 2 (1 - t) s along an edge, with s = sqrt(det M) and t from 0 at
    // its start to 1 at its end: means of s over a thin triangle with its tip at the start, or at
    // the end. Without both ends: a strip that thin beside a jump is not seen by a quadrature with
    // few points, and area that lies in it is worth nothing to who uses one.
    std::array<double, 2> moments(Index e) const;

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

    Halved halve(const Chord& c, const Tensor& metric) const;

    // Halves chords, those of each edge in a row, with the metrics at their midpoints.
    void split(const std::vector<Chord>& chords, const std::vector<Tensor>& middles);

    // Keeps the halves, or has them asked about; `estimate` is what the edge is now thought to be.
    void keep(const Halved& h, double estimate);

    Point point(Index edge, double t) const {
        const Edge& e = edges_[edge];
        return {e.from.x + t * e.vector.x, e.from.y + t * e.vector.y};
    }

    // Pieces come in the order in which they were trusted: brought together by edges, and sorted
    // along each.
    void finish();

    // The size is taken to be geometric along a piece: with r the ratio of the speeds at its ends,
    // the share s of its length is reached at log(1 + s (r - 1)) / log r.
    double share_in_piece(const Chord& p, double share) const;

    FieldPoint point_in_piece(const Chord& p, double share) const;

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
