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

#include "adaptmesh/core/predicates.hpp"

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

// x - y for products of two doubles, nearly equal.
inline double difference_of_products(Two x, Two y) {
    const Two low = two_difference(x.lo, y.lo);
    return ((x.hi - y.hi) + low.hi) + low.lo;
}

inline double twice_area_exact(Point a, Point b, Point c) {
    const int e = common_exponent({a, b, c});
    const IntegerVector origin = scaled(c, e);
    const Integer area = cross(scaled(a, e) - origin, scaled(b, e) - origin);
    const double value = area.times_power_of_two(2 * e);
    // Never zero by underflow: the sign is exact.
    return value != 0 ? value : area.sign() * std::numeric_limits<double>::denorm_min();
}

ADAPTMESH_NOINLINE inline double twice_area_after_cancellation(Point a, Point b, Point c,
                                                               double rounded) {
    const double largest = largest_difference(a, b, c);
    if (on_grid<26>(largest, {a.x, a.y, b.x, b.y, c.x, c.y})) return rounded;
    if (!(is_ordinary(a) & is_ordinary(b) & is_ordinary(c))) return twice_area_exact(a, b, c);

    const TwoVector v(a, c), w(b, c);
    const double magnitude = cross_magnitude(v, w);
    if (magnitude == 0) return 0;  // of ordinary numbers: both products have a factor zero
    const double value =
        v.is_double() & w.is_double()
            ? difference_of_products(two_product(v.x.hi, w.y.hi), two_product(v.y.hi, w.x.hi))
            : [&] {
                  const Two area = cross(v, w);
                  return area.hi + area.lo;
              }();
    // The error is below 16 u^2 M, and so relative to this value below 2^-47.
    if (std::fabs(value) > 0x1p-55 * magnitude) return value;
    return twice_area_exact(a, b, c);
}

}  // namespace detail

// Positive if abc is counter-clockwise; the sign is exact, the relative error below 2^-46 unless
// the area underflows.
inline double twice_area(Point a, Point b, Point c) {
    const RoundedArea area = rounded_twice_area(a, b, c);
    if (is_accurate(area.magnitude + detail::TINY, std::fabs(area.value))) return area.value;
    return detail::twice_area_after_cancellation(a, b, c, area.value);
}

}  // namespace adaptmesh
