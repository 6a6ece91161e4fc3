// Which side of a line, in or out of a circle: the exact sign of a determinant, for all finite
// doubles, from the subnormal ones to 1e308.
//
// Cocircular points must be cocircular whichever triangle asks, or an algorithm that trusts the
// answers contradicts itself and may never end. So every answer is exact, by the cheapest of
//
//   filter     the determinant in doubles, if it exceeds a bound of its error;
//   few bits   the determinant in doubles again, where it has no error: integer grids, on which
//              every test is degenerate and the filter useless;
//   refined    the determinant in pairs of doubles, if it exceeds a much smaller bound: points
//              collinear or cocircular but for the rounding of their coordinates;
//   exact      integers (exact_predicates.hpp).
//
// The scheme of growing effort, and the way to derive the bounds, are those of Shewchuk (1997),
// Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. Other than
// there, the incircle determinant is written with two angles (see incircle), and the last stage is
// in integers instead of expansions, for integers know neither overflow nor underflow.
//
// Throughout u = 2^-53: fl(x op y) = (x op y)(1 + d) with |d| <= u; a product may besides lose
// 2^-1075 by underflow, sums never do. Rounding is to nearest and subnormals are kept (the default
// floating-point environment).
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "adaptmesh/core/geometry/error_free.hpp"
#include "adaptmesh/core/geometry/exact_predicates.hpp"
#include "adaptmesh/core/geometry/point.hpp"

#if defined(_MSC_VER)
#define ADAPTMESH_NOINLINE __declspec(noinline)
#else
#define ADAPTMESH_NOINLINE __attribute__((noinline))
#endif

namespace adaptmesh {

namespace detail {

constexpr double U = 0x1p-53;

// Covers underflow: added to a sum of products of size, say, p, it makes any multiple k u of
// (p + TINY) exceed k u p + 2^-1074. Not smaller, for k u TINY is not to be subnormal: slow.
constexpr double TINY = 0x1p-900;

// Evaluates all conditions: cheaper than a branch for each where they nearly always hold.
template <class... Conditions>
bool all(Conditions... conditions) {
    return (static_cast<int>(conditions) & ...);
}

int orient2d_unfiltered(Point a, Point b, Point c, double det);
int incircle_unfiltered(Point a, Point b, Point c, Point d, double det);

}  // namespace detail

// The sign of the area of abc: 1 counter-clockwise, -1 clockwise, 0 on one line.
//
//          c
//         / \         det = | ax-cx  ay-cy |
//        /   \              | bx-cx  by-cy |
//       a-----b
//
// Bound: a difference is rounded once, so each product is off by 3u of itself; the last
// subtraction adds u |det|. Hence the error is below 3u (|left| + |right| + TINY) + u |det|, up to
// O(u^2), and |det| above 4u (...) decides; the fourth u leaves room for the rest and for the
// rounding of the bound. After overflow the bound is infinite or NaN and nothing exceeds it.
inline int orient2d(Point a, Point b, Point c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double det = left - right;
    const double bound = 4 * detail::U * (std::fabs(left) + std::fabs(right) + detail::TINY);
    if (det > bound) return 1;
    if (-det > bound) return -1;
    return detail::orient2d_unfiltered(a, b, c, det);
}

// Whether d lies in the circle through abc, for abc counter-clockwise: 1 strictly inside, 0 on it,
// -1 outside. For abc clockwise the opposite, on one line the sign of the same determinant.
//
//           c             c sees the chord ab under the angle C, d sees it under D, and d is inside
//          / \            if sin(D - C) > 0. In cross and dot products of u = a-c, v = b-c and
//         / d \           s = a-d, t = b-d this is
//        / . . \          .
//       a-------b         det = (s x t)(u . v) - (s . t)(u x v) > 0,
//
// on either side of ab. It is the usual three by three determinant, in fewer operations.
//
// Bound: as above, s x t is off by 4u of its magnitude |sx ty| + |sy tx| + TINY, and so are the
// other factors; the products by 4u + 4u + u, and the last subtraction adds u |det|. 12u leave
// room for the rest. The last TINY is for underflow of the products of factors.
inline int incircle(Point a, Point b, Point c, Point d) {
    const double ux = a.x - c.x, uy = a.y - c.y, vx = b.x - c.x, vy = b.y - c.y;
    const double sx = a.x - d.x, sy = a.y - d.y, tx = b.x - d.x, ty = b.y - d.y;
    const double ux_vx = ux * vx, uy_vy = uy * vy, ux_vy = ux * vy, uy_vx = uy * vx;
    const double sx_tx = sx * tx, sy_ty = sy * ty, sx_ty = sx * ty, sy_tx = sy * tx;
    const double det = (sx_ty - sy_tx) * (ux_vx + uy_vy) - (sx_tx + sy_ty) * (ux_vy - uy_vx);

    using detail::TINY;
    const double cross_st = std::fabs(sx_ty) + std::fabs(sy_tx) + TINY;
    const double cross_uv = std::fabs(ux_vy) + std::fabs(uy_vx) + TINY;
    const double dot_st = std::fabs(sx_tx) + std::fabs(sy_ty) + TINY;
    const double dot_uv = std::fabs(ux_vx) + std::fabs(uy_vy) + TINY;
    const double bound = 12 * detail::U * (cross_st * dot_uv + dot_st * cross_uv) + TINY;
    if (det > bound) return 1;
    if (-det > bound) return -1;
    return detail::incircle_unfiltered(a, b, c, d, det);
}

namespace detail {

inline int sign(double x) {
    return (x > 0) - (x < 0);
}

// ---- Few bits ----

// Without branches: which one is larger cannot be foreseen.
inline double larger(double x, double y) {
    return x > y ? x : y;
}

// The largest coordinate of p - r and q - r, in absolute value.
inline double largest_difference(Point p, Point q, Point r) {
    return larger(larger(std::fabs(p.x - r.x), std::fabs(p.y - r.y)),
                  larger(std::fabs(q.x - r.x), std::fabs(q.y - r.y)));
}

// Whether the coordinates lie on a grid of which `largest`, the largest of the differences taken,
// has less than 2^BITS steps. Then the differences are exact, and integers of BITS bits times g.
//
// With 2^e <= largest < 2^(e+1) the step is g = 2^(e+1-BITS). Adding and subtracting `magic`, 1.5
// times 2^53 g, rounds x to a multiple of 2g; or of g, if x < -2^52 g makes the sum smaller than
// 2^53 g; or of less, but only if x < -2^53 g, which is itself a multiple of 2g. So x + magic -
// magic == x only if x is a multiple of g. The range of `largest` keeps products of four integers
// times g from overflow and underflow.
template <int BITS, int N>
bool on_grid(double largest, const double (&coordinates)[N]) {
    if (!((largest >= 0x1p-200) & (largest <= 0x1p200))) return false;
    std::uint64_t bits;
    std::memcpy(&bits, &largest, sizeof bits);
    bits &= std::uint64_t(0x7ff) << 52;
    double power;  // 2^e
    std::memcpy(&power, &bits, sizeof power);
    const double magic = power * (0x1.8p54 / double(std::uint64_t(1) << BITS));
    bool all = true;
    for (double x : coordinates) all &= (x + magic) - magic == x;
    return all;
}

// Whether the four are two pairs of equal numbers.
inline bool in_pairs(double a, double b, double c, double d) {
    return ((a == b) & (c == d)) | ((a == c) & (b == d)) | ((a == d) & (b == c));
}

// ---- Refined: pairs of doubles ----

// Coordinates with which nothing below overflows or underflows: they are multiples of 2^-252, so
// products of up to four differences, rounded or not, whole or in parts, are multiples of 2^-1008
// and not subnormal; and they stay below 2^900.
inline bool is_ordinary(double x) {
    const double size = std::fabs(x);
    return (size == 0) | ((size >= 0x1p-200) & (size <= 0x1p200));
}
inline bool is_ordinary(Point p) {
    return all(is_ordinary(p.x), is_ordinary(p.y));
}

// Let a pair x stand for the number X, with |x.hi| <= M, |x.lo| <= k u M and an error
// |x.hi + x.lo - X| <= m u^2 M, all up to O(u) relative. A difference of coordinates has M = |hi|,
// k = 1, m = 0. The operators below then have
//
//   x * y   M = Mx My    k = 1 + kx + ky    m = mx + my + kx ky + 1 + 3 (kx + ky)
//   x + y   M = Mx + My  k = 1 + kx         m = mx + 1 + 2 kx                      (kx = ky)
//
// (in the product, kx ky is the product of low parts left out; low parts times high parts are
// rounded, added and added once more). Therefore
//
//                                k    m
//   product of differences       3    8
//   cross, dot                   4   15
//   product of two of those      9   71
//   sum of two of those         10   90
//
// and 16 u^2 M decides orient2d, 96 u^2 M incircle, with room for O(u^3) and roundings of M.
inline Two operator*(Two x, Two y) {
    const Two p = two_product(x.hi, y.hi);
    return {p.hi, p.lo + (x.hi * y.lo + x.lo * y.hi)};
}
inline Two operator+(Two x, Two y) {
    const Two s = two_sum(x.hi, y.hi);
    return {s.hi, s.lo + (x.lo + y.lo)};
}

struct TwoVector {
    Two x, y;

    TwoVector(Point p, Point q) : x(two_difference(p.x, q.x)), y(two_difference(p.y, q.y)) {}
    bool is_double() const { return (x.lo == 0) & (y.lo == 0); }
};

inline Two cross(TwoVector v, TwoVector w) {
    return v.x * w.y + -(v.y * w.x);
}
inline Two dot(TwoVector v, TwoVector w) {
    return v.x * w.x + v.y * w.y;
}

// Their M.
inline double cross_magnitude(TwoVector v, TwoVector w) {
    return std::fabs(v.x.hi * w.y.hi) + std::fabs(v.y.hi * w.x.hi);
}
inline double dot_magnitude(TwoVector v, TwoVector w) {
    return std::fabs(v.x.hi * w.x.hi) + std::fabs(v.y.hi * w.y.hi);
}

// sign(x - y) for products x, y without error: rounding never reverses their order.
inline int compare(Two x, Two y) {
    return x.hi != y.hi ? sign(x.hi - y.hi) : sign(x.lo - y.lo);
}

// ---- From the filter on ----

// 26 bits: products have 52, their difference 53.
ADAPTMESH_NOINLINE inline int orient2d_unfiltered(Point a, Point b, Point c, double det) {
    if (on_grid<26>(largest_difference(a, b, c), {a.x, a.y, b.x, b.y, c.x, c.y})) return sign(det);

    if (!all(is_ordinary(a), is_ordinary(b), is_ordinary(c))) return orient2d_exact(a, b, c);
    const TwoVector v(a, c), w(b, c);
    if (all(v.is_double(), w.is_double())) {
        return compare(two_product(v.x.hi, w.y.hi), two_product(v.y.hi, w.x.hi));
    }
    const Two refined = cross(v, w);
    const double value = refined.hi + refined.lo;
    if (std::fabs(value) > 16 * U * U * cross_magnitude(v, w)) return sign(value);
    return orient2d_exact(a, b, c);
}

// 12 bits: products of differences have 24, cross and dot 25, products of those 50, det 51.
ADAPTMESH_NOINLINE inline int incircle_unfiltered(Point a, Point b, Point c, Point d, double det) {
    const double largest = larger(largest_difference(a, b, c), largest_difference(a, b, d));
    if (on_grid<12>(largest, {a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y})) return sign(det);

    // The corners of an axis-parallel rectangle, or two pairs of equal points: det = 0. The cells
    // of any grid are such, and too costly for the last stage.
    if (all(in_pairs(a.x, b.x, c.x, d.x), in_pairs(a.y, b.y, c.y, d.y))) return 0;

    if (!all(is_ordinary(a), is_ordinary(b), is_ordinary(c), is_ordinary(d))) {
        return incircle_exact(a, b, c, d);
    }
    const TwoVector u(a, c), v(b, c), s(a, d), t(b, d);
    const Two refined = cross(s, t) * dot(u, v) + -(dot(s, t) * cross(u, v));
    const double magnitude =
        cross_magnitude(s, t) * dot_magnitude(u, v) + dot_magnitude(s, t) * cross_magnitude(u, v);
    const double value = refined.hi + refined.lo;
    if (std::fabs(value) > 96 * U * U * magnitude) return sign(value);
    return incircle_exact(a, b, c, d);
}

}  // namespace detail

}  // namespace adaptmesh
