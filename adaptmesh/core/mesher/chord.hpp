// How long is a chord of a line, when the metric is known at its ends and half way?
//
//        A-----------------B      by the metrics at its ends, l(A, B)
//        A--------M--------B      with the metric at M: l(A, M) + l(M, B); if both agree, the
//                                 halves are trusted, else they are to be halved themselves
//
// A length by its ends takes the geometric mean of the metrics there for the metric half way. That
// of two thin ellipses turned against each other is nearly round, and lengths in it are far too
// small: where the axes turn, a chord and its halves can agree on a third of the true length. The
// speeds at the ends still do: see `length_by_speeds`.
#pragma once

#include <algorithm>
#include <cmath>

#include "adaptmesh/core/geometry/point.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

using metrics::Tensor;

// A point on a line, and the metric there.
struct Station {
    double t;
    Tensor metric;
    double sqrt_det;
};

inline Station station(double t, const Tensor& metric) {
    return {t, metric, metrics::sqrt_det(metric)};
}

// The length of a vector between two stations, by the metrics there.
inline double length_by_ends(const Station& from, const Station& to, Point v) {
    return metrics::length(from.metric, from.sqrt_det, to.metric, to.sqrt_det, v.x, v.y);
}

// Its length in the metric of one.
inline double speed(const Station& at, Point v) {
    return std::sqrt(std::max(at.metric.q(v.x, v.y), 0.0));
}

// Simpson's rule with the geometric mean of the two speeds half way: the same as by the metrics at
// the ends where the vector lies along their common axes, and never less.
inline double length_by_speeds(double start, double end) {
    return (start + 4 * std::sqrt(start * end) + end) * (1.0 / 6);
}

// A length both ways.
struct ChordLength {
    double by_ends, by_speeds;
};

// The two halves of a chord.
struct Halves {
    double first, second;  // their lengths
    bool are_by_speeds;    // as are all parts of them
    bool are_trusted;
};

// When the lengths of halves are trusted.
struct ChordRule {
    // A chord is trusted when its own length and that of its halves agree to this share (the
    // halves are then right to about a tenth of it), if ...
    static constexpr double AGREEMENT = 0.05;
    // Shorter ones are trusted as they are: they cannot change the count of points.
    static constexpr double SHORTEST_CHORD = 0.05;
    // From a thousandth of the line on, chords may be longer than asked for.
    static constexpr int FINE_DEPTH = 10;
    static constexpr double LONGEST_FINE_CHORD = 4.0;
    // Axes turn where a length by the ends is less than that by the speeds by more than this share,
    // which is 2/3 at the most between equal speeds. With less, meshes of layers that bend, which
    // are measured well by the ends, would change.
    static constexpr double TURNED = 0.46;
    static constexpr int DEEPEST = 1000;  // the end of halving doubles

    // ... and it is no longer than this: finer detail can pass unseen between samples.
    double longest_chord;

    // Of a chord of this length, halved so often before, and the lengths of its halves.
    Halves halve(ChordLength whole, ChordLength first, ChordLength second, bool is_by_speeds,
                 int depth) const {
        is_by_speeds =
            is_by_speeds || is_turned(whole.by_ends, whole.by_speeds) ||
            is_turned(first.by_ends + second.by_ends, first.by_speeds + second.by_speeds);
        const Halves out{is_by_speeds ? first.by_speeds : first.by_ends,
                         is_by_speeds ? second.by_speeds : second.by_ends, is_by_speeds, false};
        const double length = is_by_speeds ? whole.by_speeds : whole.by_ends;
        const double halves = out.first + out.second;
        const bool agree = std::abs(length - halves) <= AGREEMENT * halves;
        const double longest = depth < FINE_DEPTH ? longest_chord : LONGEST_FINE_CHORD;
        return {out.first, out.second, is_by_speeds,
                (agree && halves <= longest) || halves <= SHORTEST_CHORD || depth >= DEEPEST};
    }

  private:
    static bool is_turned(double by_ends, double by_speeds) {
        return by_speeds - by_ends > TURNED * by_speeds;
    }
};

}  // namespace adaptmesh
