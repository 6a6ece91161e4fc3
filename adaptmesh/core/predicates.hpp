// Which side of a line, in or out of a circle: the exact sign of a determinant, for all finite
// doubles, subnormal to 1e308.
//
// Cocircular points must count as cocircular whichever triangle asks, or an algorithm that trusts
// the answers contradicts itself and never ends. So every answer is exact, by the cheapest of
//
//   1. filter       the determinant in doubles, believed if it exceeds a bound on its error;
//   2. short        differences without rounding error and, for incircle, of few enough bits that
//                   two products decide exactly: integer grids, where every test is degenerate;
//   3. refined      the determinant in pairs of doubles, again with an error bound: points that
//                   are cocircular but for the rounding of their coordinates;
//   4. exact        in integers, at any exponent.
//
// Stage 1 is inline, the others are calls. The scheme of growing effort is Shewchuk's (1997),
// Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates; the incircle
// determinant is in the form of two angles (see incircle below) instead of his three by three.
//
// Throughout, u = 2^-53 is the rounding unit: fl(x op y) = (x op y)(1 + d), |d| <= u, plus, for
// products only, an underflow of at most 2^-1075. The floating-point environment is the default
// one: round to nearest, subnormals kept.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "adaptmesh/core/error_free.hpp"
#include "adaptmesh/core/integer.hpp"
#include "adaptmesh/core/point.hpp"

#if defined(_MSC_VER)
#define ADAPTMESH_NOINLINE __declspec(noinline)
#else
#define ADAPTMESH_NOINLINE __attribute__((noinline))
#endif

namespace adaptmesh {

namespace detail {

int orient2d_slow(Point a, Point b, Point c);
int incircle_slow(Point a, Point b, Point c, Point d);

constexpr double ROUNDING = 0x1p-53;  // u
constexpr double TINY = 0x1p-1000;    // above what any underflow takes

}  // namespace detail

// The sign of the area of abc: +1 counter-clockwise, -1 clockwise, 0 on one line.
//
//          c
//         / \            | ax-cx  ay-cy |
//        /   \     sign  | bx-cx  by-cy |
//       a-----b
//
// Filter: a difference has one rounding, a product of two of them three; the last subtraction
// commits u |det|. So the error is at most 3u (|left| + |right|) + u |det| + O(u^2), and
// |det| > 4u (|left| + |right|) decides, the spare u being for the O(u^2) and for the rounding of
// the bound itself. Two underflows are below 2^-1074, and the product in the bound may underflow
// too: 2^-1000 covers all. Overflow makes the bound infinite or NaN, and nothing exceeds that.
inline int orient2d(Point a, Point b, Point c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    const double error = 4 * detail::ROUNDING * (std::fabs(left) + std::fabs(right)) + detail::TINY;
    if (det > error) return 1;
    if (-det > error) return -1;
    return detail::orient2d_slow(a, b, c);
}

// Whether d is in the circle through abc: +1 strictly inside, 0 on it, -1 outside, for abc
// counter-clockwise; the opposite for abc clockwise. For abc on one line, the sign of the same
// determinant.
//
//           c             The chord ab is seen from c under the angle C, from d under D, and d is
//          /C\            inside if D > C, that is sin(D - C) > 0. With sin and cos as cross and
//         / d \           dot products of u = a-c, v = b-c and s = a-d, t = b-d,
//        / /D\ \          .
//       a-------b         det = (s x t)(u . v) - (s . t)(u x v),
//
// which is the usual three by three determinant, but cheaper. It holds on both sides of ab.
//
// Filter: as above, each of the four factors, s x t say, is off by at most 4u times its magnitude
// |sx ty| + |sy tx|; a product of two of them by 9u, the determinant by 10u, times the same
// expression in magnitudes; 12u leave room for O(u^2). Underflow in a factor is at most 2^-1074,
// and a magnitude raised by 2^-1000 covers it, as 4u 2^-1000 exceeds it; underflow of the products
// of factors is covered by the last term, overflow as above.
inline int incircle(Point a, Point b, Point c, Point d) {
    const double ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
    const double sx = a.x - d.x, sy = a.y - d.y, tx = b.x - d.x, ty = b.y - d.y;

    const double ux_vx = ux * vx, uy_vy = uy * vy, ux_vy = ux * vy, uy_vx = uy * vx;
    const double sx_tx = sx * tx, sy_ty = sy * ty, sx_ty = sx * ty, sy_tx = sy * tx;
    const double det = (sx_ty - sy_tx) * (ux_vx + uy_vy) - (sx_tx + sy_ty) * (ux_vy - uy_vx);

    constexpr double tiny = detail::TINY;
    const double cross_d = std::fabs(sx_ty) + std::fabs(sy_tx) + tiny;
    const double cross_c = std::fabs(ux_vy) + std::fabs(uy_vx) + tiny;
    const double dot_d = std::fabs(sx_tx) + std::fabs(sy_ty) + tiny;
    const double dot_c = std::fabs(ux_vx) + std::fabs(uy_vy) + tiny;
    const double error = 12 * detail::ROUNDING * (cross_d * dot_c + dot_d * cross_c) + tiny;
    if (det > error) return 1;
    if (-det > error) return -1;
    return detail::incircle_slow(a, b, c, d);
}

namespace detail {

inline int sign(double x) {
    return (x > 0) - (x < 0);
}

// Coordinates for which stages 2 and 3 neither overflow nor underflow. All are integer multiples
// of 2^-252, so all their products of up to four differences, rounded or not, whole or in parts,
// are integer multiples of 2^-1008, above the subnormals; and all stay below 2^900.
inline bool is_ordinary(double x) {
    const double size = std::fabs(x);
    return (size == 0) | ((size >= 0x1p-200) & (size <= 0x1p200));
}
inline bool is_ordinary(Point p) {
    return is_ordinary(p.x) & is_ordinary(p.y);
}

// ---- Stages 2 and 3: pairs of doubles ----

struct Vector {
    Two x, y;
};

inline Vector operator-(Point p, Point q) {
    return {two_difference(p.x, q.x), two_difference(p.y, q.y)};
}

inline bool is_exact(Vector v) {
    return (v.x.lo == 0) & (v.y.lo == 0);
}

// sign(p - q), exactly. Rounding is monotone: the rounded products are never in the wrong order.
inline int compare(Two p, Two q) {
    return p.hi != q.hi ? sign(p.hi - q.hi) : sign(p.lo - q.lo);
}

// Pairs as approximate numbers, for stage 3. Let pairs x stand for X with |x.hi| <= M, |x.lo| <=
// alpha u M and error |x.hi + x.lo - X| <= beta u^2 M, up to O(u^3). A difference of coordinates
// has M = |hi|, alpha = 1, beta = 0. Then
//
//   product  alpha = 1 + a1 + a2,  beta = b1 + b2 + a1 a2 + 1 + 3 (a1 + a2),  M = M1 M2:
//            low parts are products rounded (a1 + a2), summed (a1 + a2), summed again
//            (1 + a1 + a2), and lo lo (a1 a2) is left out;
//   sum      alpha = 1 + a,        beta = b + 1 + 2 a,                        M = M1 + M2.
//
//                            alpha   beta
//   product of differences     3       8
//   cross, dot                 4      15        orient2d: 15 u^2 M
//   product of those           9      71
//   sum of those              10      90        incircle: 90 u^2 M
//
// The bounds below are 16 u^2 and 96 u^2: room for O(u^3), for the rounding of M and of hi + lo.
inline Two operator*(Two x, Two y) {
    const Two p = two_product(x.hi, y.hi);
    return {p.hi, p.lo + (x.hi * y.lo + x.lo * y.hi)};
}
inline Two operator+(Two x, Two y) {
    const Two s = two_sum(x.hi, y.hi);
    return {s.hi, s.lo + (x.lo + y.lo)};
}

// A sum of two products, with M.
struct Bounded {
    Two value;
    double magnitude;
};

inline Bounded cross(Vector v, Vector w) {
    return {v.x * w.y + -(v.y * w.x), std::fabs(v.x.hi * w.y.hi) + std::fabs(v.y.hi * w.x.hi)};
}
inline Bounded dot(Vector v, Vector w) {
    return {v.x * w.x + v.y * w.y, std::fabs(v.x.hi * w.x.hi) + std::fabs(v.y.hi * w.y.hi)};
}

// ---- Stage 4: integers ----

// The parts of a finite double: x = +-mantissa 2^exponent.
struct Parts {
    bool negative;
    std::uint64_t mantissa;
    int exponent;
};

inline Parts parts(double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    const int biased = int(bits >> 52 & 0x7ff);
    const std::uint64_t fraction = bits & ((std::uint64_t(1) << 52) - 1);
    const bool negative = bits >> 63 != 0;
    if (biased == 0) return {negative, fraction, -1074};
    return {negative, fraction | std::uint64_t(1) << 52, biased - 1075};
}

// A power of two of which all coordinates that are not zero are multiples; zeros would take it
// down to 2^-1074 for nothing.
inline void lower_exponent(int& exponent, Point p) {
    if (p.x != 0) exponent = std::min(exponent, parts(p.x).exponent);
    if (p.y != 0) exponent = std::min(exponent, parts(p.y).exponent);
}

// x / 2^exponent.
inline Integer scaled(double x, int exponent) {
    const Parts p = parts(x);
    return Integer(p.negative, p.mantissa, p.mantissa == 0 ? 0 : p.exponent - exponent);
}

struct IntegerVector {
    Integer x, y;

    IntegerVector(Point p, Point q, int exponent)
        : x(scaled(p.x, exponent) - scaled(q.x, exponent)),
          y(scaled(p.y, exponent) - scaled(q.y, exponent)) {}
};

inline Integer cross(const IntegerVector& v, const IntegerVector& w) {
    return v.x * w.y - v.y * w.x;
}
inline Integer dot(const IntegerVector& v, const IntegerVector& w) {
    return v.x * w.x + v.y * w.y;
}

ADAPTMESH_NOINLINE inline int orient2d_exact(Point a, Point b, Point c) {
    int exponent = 1024;
    for (Point p : {a, b, c}) lower_exponent(exponent, p);
    return cross(IntegerVector(a, c, exponent), IntegerVector(b, c, exponent)).sign();
}

ADAPTMESH_NOINLINE inline int incircle_exact(Point a, Point b, Point c, Point d) {
    int exponent = 1024;
    for (Point p : {a, b, c, d}) lower_exponent(exponent, p);
    const IntegerVector u(a, c, exponent), v(b, c, exponent);
    const IntegerVector s(a, d, exponent), t(b, d, exponent);
    return (cross(s, t) * dot(u, v) - dot(s, t) * cross(u, v)).sign();
}

// ---- Stages 2 to 4 ----

ADAPTMESH_NOINLINE inline int orient2d_slow(Point a, Point b, Point c) {
    if (!(is_ordinary(a) & is_ordinary(b) & is_ordinary(c))) return orient2d_exact(a, b, c);
    const Vector v = a - c, w = b - c;
    if (is_exact(v) & is_exact(w)) {
        return compare(two_product(v.x.hi, w.y.hi), two_product(v.y.hi, w.x.hi));
    }
    const Bounded det = cross(v, w);
    const double value = det.value.hi + det.value.lo;
    if (std::fabs(value) > 16 * ROUNDING * ROUNDING * det.magnitude) return sign(value);
    return orient2d_exact(a, b, c);
}

// Whether all are multiples of a common power of two below 2^26 times it.
//
// With 2^e <= largest < 2^(e+1), numbers of that size are rounded to multiples of 2^(e-25) by
// adding and subtracting 1.5 2^52 2^(e-25), whose last bit is just that.
inline bool is_short(const double (&values)[8]) {
    double largest = 0;
    for (double x : values) largest = std::max(largest, std::fabs(x));
    std::uint64_t bits;
    std::memcpy(&bits, &largest, sizeof bits);
    bits &= std::uint64_t(0x7ff) << 52;
    double power;
    std::memcpy(&power, &bits, sizeof power);
    const double magic = power * 0x1.8p27;
    bool all = true;
    for (double x : values) all &= (x + magic) - magic == x;
    return all;
}

// Short differences: their products are below 2^52 units, sums of two of those at most 2^53, so
// the four factors are exact.
inline int incircle_short(const double (&d)[8]) {
    const double ux = d[0], uy = d[1], vx = d[2], vy = d[3];
    const double sx = d[4], sy = d[5], tx = d[6], ty = d[7];
    return compare(two_product(sx * ty - sy * tx, ux * vx + uy * vy),
                   two_product(sx * tx + sy * ty, ux * vy - uy * vx));
}

ADAPTMESH_NOINLINE inline int incircle_slow(Point a, Point b, Point c, Point d) {
    if (!(is_ordinary(a) & is_ordinary(b) & is_ordinary(c) & is_ordinary(d))) {
        return incircle_exact(a, b, c, d);
    }
    const Vector u = a - c, v = b - c, s = a - d, t = b - d;
    if (is_exact(u) & is_exact(v) & is_exact(s) & is_exact(t)) {
        const double heads[8] = {u.x.hi, u.y.hi, v.x.hi, v.y.hi, s.x.hi, s.y.hi, t.x.hi, t.y.hi};
        if (is_short(heads)) return incircle_short(heads);
    }
    const Bounded cross_c = cross(u, v), dot_c = dot(u, v), cross_d = cross(s, t),
                  dot_d = dot(s, t);
    const Two det = cross_d.value * dot_c.value + -(dot_d.value * cross_c.value);
    const double magnitude =
        cross_d.magnitude * dot_c.magnitude + dot_d.magnitude * cross_c.magnitude;
    const double value = det.hi + det.lo;
    if (std::fabs(value) > 96 * ROUNDING * ROUNDING * magnitude) return sign(value);
    return incircle_exact(a, b, c, d);
}

}  // namespace detail

}  // namespace adaptmesh
