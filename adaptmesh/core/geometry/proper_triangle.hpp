// Which triangles an operator may make.
#pragma once

#include <algorithm>
#include <cmath>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"

namespace adaptmesh {

// Whether abc is positive, and higher than its corners are rounded. Cuts of a straight segment are
// off it by rounding, so that three of them can be a positive triangle, of quality 1e-16:
//
//     a-------b-------c      it cuts b off from the inside, and all that ends in b
//      \_____________/
//
inline bool is_proper_triangle(Point a, Point b, Point c) {
    constexpr double ROUNDING = 0x1p-50;  // four units in the last place
    if (orient2d(a, b, c) <= 0) return false;
    const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    const double longest = std::max({std::abs(ux), std::abs(uy), std::abs(vx), std::abs(vy)});
    const double at = std::max(std::abs(a.x), std::abs(a.y)) + longest;
    return ux * vy - uy * vx > ROUNDING * at * longest;
}

}  // namespace adaptmesh
