#include "adaptmesh/core/geometry/accurate_area.hpp"

#include <cmath>

#include "adaptmesh/core/geometry/exact_predicates.hpp"

namespace adaptmesh::detail {

namespace {

// x - y for products of two doubles, nearly equal.
double difference_of_products(Two x, Two y) {
    const Two low = two_difference(x.lo, y.lo);
    return ((x.hi - y.hi) + low.hi) + low.lo;
}

}  // namespace

double twice_area_after_cancellation(Point a, Point b, Point c, double rounded) {
    const double largest = largest_difference(a, b, c);
    if (on_grid<26>(largest, {a.x, a.y, b.x, b.y, c.x, c.y})) return rounded;
    if (!all(is_ordinary(a), is_ordinary(b), is_ordinary(c))) return twice_area_exact(a, b, c);

    const TwoVector v(a, c), w(b, c);
    const double magnitude = cross_magnitude(v, w);
    if (magnitude == 0) return 0;  // of ordinary numbers: both products have a factor zero
    const double value =
        all(v.is_double(), w.is_double())
            ? difference_of_products(two_product(v.x.hi, w.y.hi), two_product(v.y.hi, w.x.hi))
            : [&] {
                  const Two area = cross(v, w);
                  return area.hi + area.lo;
              }();
    // The error is below 16 u^2 M, and so relative to this value below 2^-47.
    if (std::fabs(value) > 0x1p-55 * magnitude) return value;
    return twice_area_exact(a, b, c);
}

}  // namespace adaptmesh::detail
