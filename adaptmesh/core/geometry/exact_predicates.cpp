#include "adaptmesh/core/geometry/exact_predicates.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <limits>

#include "adaptmesh/core/geometry/integer.hpp"

namespace adaptmesh::detail {

namespace {

// The parts of a finite double: x = +-mantissa 2^exponent.
struct Parts {
    bool negative;
    std::uint64_t mantissa;
    int exponent;
};

Parts parts(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    const std::uint64_t hidden = std::uint64_t(1) << 52;
    const bool negative = (bits >> 63) != 0;
    const int biased = int((bits >> 52) & 0x7ff);
    const std::uint64_t fraction = bits & (hidden - 1);
    if (biased == 0) return {negative, fraction, -1074};  // zero or subnormal
    return {negative, fraction | hidden, biased - 1075};
}

// An exponent e such that all coordinates are multiples of 2^e. Zeros, multiples of anything,
// have no say: theirs is -1074.
int common_exponent(std::initializer_list<Point> points) {
    int exponent = 1024;
    for (Point p : points) {
        if (p.x != 0) exponent = std::min(exponent, parts(p.x).exponent);
        if (p.y != 0) exponent = std::min(exponent, parts(p.y).exponent);
    }
    return exponent;
}

struct IntegerVector {
    Integer x, y;
};

Integer scaled(double x, int exponent) {
    const Parts p = parts(x);
    return Integer(p.negative, p.mantissa, p.mantissa == 0 ? 0 : p.exponent - exponent);
}
IntegerVector scaled(Point p, int exponent) {
    return {scaled(p.x, exponent), scaled(p.y, exponent)};
}

IntegerVector operator-(const IntegerVector& v, const IntegerVector& w) {
    return {v.x - w.x, v.y - w.y};
}
Integer cross(const IntegerVector& v, const IntegerVector& w) {
    return v.x * w.y - v.y * w.x;
}
Integer dot(const IntegerVector& v, const IntegerVector& w) {
    return v.x * w.x + v.y * w.y;
}

}  // namespace

int orient2d_exact(Point a, Point b, Point c) {
    const int e = common_exponent({a, b, c});
    const IntegerVector origin = scaled(c, e);
    return cross(scaled(a, e) - origin, scaled(b, e) - origin).sign();
}

int incircle_exact(Point a, Point b, Point c, Point d) {
    const int e = common_exponent({a, b, c, d});
    const IntegerVector A = scaled(a, e), B = scaled(b, e), C = scaled(c, e), D = scaled(d, e);
    const IntegerVector u = A - C, v = B - C, s = A - D, t = B - D;
    return (cross(s, t) * dot(u, v) - dot(s, t) * cross(u, v)).sign();
}

double twice_area_exact(Point a, Point b, Point c) {
    const int e = common_exponent({a, b, c});
    const IntegerVector origin = scaled(c, e);
    const Integer area = cross(scaled(a, e) - origin, scaled(b, e) - origin);
    const double value = area.times_power_of_two(2 * e);
    // Never zero by underflow: the sign is exact.
    return value != 0 ? value : area.sign() * std::numeric_limits<double>::denorm_min();
}

}  // namespace adaptmesh::detail
