// The predicates in integer arithmetic: right for all finite doubles, slow and simple.
//
// What predicates.hpp falls back on when nothing cheaper decides. Coordinates are divided by a
// power of two that makes them integers, which scales the determinants and keeps their signs.
#pragma once

#include "adaptmesh/core/geometry/point.hpp"

namespace adaptmesh::detail {

int orient2d_exact(Point a, Point b, Point c);
int incircle_exact(Point a, Point b, Point c, Point d);

// The sign is exact, and it is rounded once.
double twice_area_exact(Point a, Point b, Point c);

}  // namespace adaptmesh::detail
