// How long is an edge, and where are its unit points, when the metric is known only by asking?
//
// The metric may be a function of Python, which answers fastest for whole arrays of points. So the
// sampler *asks in rounds*: it asks for the metric at the midpoints of all chords it is not sure
// of, splits the chords that still disagree with their halves, and so on until none is left. Then
// every edge is a row of pieces, each with its length and the speed |e|_M at both ends.
// See chord.hpp for when a chord is trusted.
#pragma once

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
    static constexpr double UNSEEN = 0.02;  // share of an edge, see moments()

    // Chords are no longer than `longest_chord`: finer detail can pass unseen between samples.
    // Edges shorter than `uncut_below` will not be cut: only their lengths are kept. Of edges
    // longer than `longest_edge` nobody wants to know how long they are: they are not looked at
    // closer.
    EdgeSampler(double longest_chord, double longest_edge, double uncut_below)
        : rule_{longest_chord}, longest_edge_(longest_edge), uncut_below_(uncut_below) {}

    // Forgets all edges, but keeps their memory.
    void clear();

    void reserve(std::size_t n) { edges_.reserve(n), chords_.reserve(n), lengths_.reserve(n); }

    void add(Point a, const Tensor& metric_a, Point b, const Tensor& metric_b) {
        const Index edge = Index(edges_.size());
        edges_.push_back({a, {b.x - a.x, b.y - a.y}});
        const Station from = station(0.0, metric_a), to = station(1.0, metric_b);
        chords_.push_back({edge, 0, from, to, length_by_ends(from, to, edges_.back().vector)});
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

    ChordRule rule_;
    double longest_edge_;
    double uncut_below_;
    std::vector<Edge> edges_;
    std::vector<Chord> chords_;    // to be asked about
    std::vector<Chord> pieces_;    // trusted
    std::vector<Index> first_;     // of each edge, in pieces_
    std::vector<double> lengths_;  // of what is trusted
};

}  // namespace adaptmesh
