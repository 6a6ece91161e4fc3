// Segments in the plane: the nearest of them, and the size that spreads from them.
//
//                x           nearest point p = a + share (b - a), share in [0, 1]
//                |           a point is a segment whose ends are the same
//        a ------p---- b
//
// Exact to rounding: distances are to segments, not to samples of them. Constant after
// construction: any number of threads may ask at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "metrics/core/boxtree.hpp"

namespace metrics {

// The point of a segment that is nearest, or least in another sense.
struct OnSegment {
    std::int32_t segment;
    double share;  // of the way from a to b
    double x, y;
};

class Segments {
  public:
    // ends: count times ax, ay, bx, by.
    Segments(const double* ends, std::size_t count);

    std::size_t size() const { return segments_.size(); }

    // `hint`: a segment that is probably near, -1 for none; it changes the time taken only.
    OnSegment nearest(double x, double y, std::int32_t hint = -1) const;

    // Makes ready for `encloses`, for segments of closed rings: `left` is the lowest x of the ring
    // of each. What is left of a ring crosses an even number of its segments, and asks for none:
    //
    //      x -->   ring box:  [left ... ]      without the bound, a row of many rings would be
    //                                          asked one by one
    void prepare_rings(const double* left);

    // Whether an odd number of the segments cross the ray from (x, y) to the right: for the
    // segments of closed rings, whether the point is inside. Ends belong to what is above them.
    bool encloses(double x, double y) const;

  private:
    friend class Spreading;

    struct Segment {
        double ax, ay, bx, by;
        double length() const { return std::hypot(bx - ax, by - ay); }
    };

    OnSegment at(std::int32_t i, double share) const;

    OnSegment foot(std::int32_t i, double x, double y) const;

    std::vector<Segment> segments_;
    BoxTree tree_, rings_;
};

// Sizes at the ends of segments, linear along them, that grow with the distance: at x the least of
// h(p) + growth |x - p| over all points p of all segments. So it changes by no more than growth per
// unit of length anywhere off the segments.
class Spreading {
  public:
    // sizes: at both ends of each segment.
    Spreading(const Segments& segments, const double* sizes, double growth)
        : segments_(segments), sizes_(sizes, sizes + 2 * segments.size()), growth_(growth) {
        std::vector<double> smaller(segments.size());
        for (std::size_t i = 0; i < smaller.size(); ++i) {
            smaller[i] = std::min(sizes_[2 * i], sizes_[2 * i + 1]);
        }
        minima_ = segments_.tree_.minima(smaller);
    }

    // The size, and the segment that it comes from; `hint` as for Segments::nearest.
    std::pair<double, std::int32_t> at(double x, double y, std::int32_t hint = -1) const {
        const auto cost = [&](std::int32_t i) { return from_segment(i, x, y); };
        const std::int32_t best =
            segments_.tree_.nearest_weighted(x, y, growth_, minima_, cost, hint);
        return {from_segment(best, x, y), best};
    }

  private:
    // Along the segment, s from a and q off it, h + growth * distance is
    //     h_a + m s + growth sqrt((s - s0)^2 + q^2),
    // convex in s, and least at s0 - q m / sqrt(growth^2 - m^2); where the size itself changes
    // faster than growth, |m| >= growth, at the end where it is smaller.
    double from_segment(std::int32_t i, double x, double y) const {
        const Segments::Segment& s = segments_.segments_[i];
        const double length = s.length(), h0 = sizes_[2 * i], h1 = sizes_[2 * i + 1];
        double share = 0;
        if (length > 0) {
            const double tx = (s.bx - s.ax) / length, ty = (s.by - s.ay) / length;
            const double s0 = (x - s.ax) * tx + (y - s.ay) * ty;
            const double q = std::fabs((x - s.ax) * ty - (y - s.ay) * tx);
            const double m = (h1 - h0) / length, rest = growth_ * growth_ - m * m;
            if (rest > 0) {
                share = (s0 - q * m / std::sqrt(rest)) / length;
            } else {
                share = m > 0 ? 0 : 1;
            }
        }
        const OnSegment place = segments_.at(i, share);
        const double size = h0 + place.share * (h1 - h0);
        return size + growth_ * std::hypot(place.x - x, place.y - y);
    }

    Segments segments_;
    std::vector<double> sizes_;
    double growth_;
    std::vector<std::vector<double>> minima_;
};

}  // namespace metrics
