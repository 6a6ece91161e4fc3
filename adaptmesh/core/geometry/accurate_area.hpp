// Twice the signed area of a triangle with a small *relative* error, however thin it is.
//
// In doubles, the area is off by the rounding of the products it is the difference of. Beside them
// the area of a thin triangle is small; and the area of three points of a slanted line, which
// rounding moved off it, is nothing but error. A ratio of such areas is then any number at all. So
// where products cancel the area is computed again, with the means of predicates.hpp: in pairs of
// doubles, and if they cancel too, in integers.
#pragma once

#include <cmath>
#include <limits>

#include "adaptmesh/core/geometry/predicates.hpp"

namespace adaptmesh {

// Twice an area in doubles. Its error is below 4u (magnitude + TINY), see orient2d.
struct RoundedArea {
    double value, magnitude;

    // Whether the sign is known.
    bool has_sign() const { return std::fabs(value) > 4 * detail::U * (magnitude + detail::TINY); }
};

// Of values with these magnitudes, a sum of this size has a relative error below 2^-47.
inline bool is_accurate(double magnitude, double size) {
    return magnitude <= 16 * size;
}

// With a and b exchanged, exactly the opposite.
inline RoundedArea rounded_twice_area(Point a, Point b, Point c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    return {left - right, std::fabs(left) + std::fabs(right)};
}

namespace detail {

// Where the products of `rounded` nearly cancel.
double twice_area_after_cancellation(Point a, Point b, Point c, double rounded);

}  // namespace detail

// Positive if abc is counter-clockwise; the sign is exact, the relative error below 2^-46 unless
// the area underflows.
inline double twice_area(Point a, Point b, Point c) {
    const RoundedArea area = rounded_twice_area(a, b, c);
    if (is_accurate(area.magnitude + detail::TINY, std::fabs(area.value))) return area.value;
    return detail::twice_area_after_cancellation(a, b, c, area.value);
}

}  // namespace adaptmesh
