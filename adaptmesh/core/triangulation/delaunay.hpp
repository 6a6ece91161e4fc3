// The Delaunay triangulation of points, exactly, in expected time close to linear.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// The Delaunay triangulation of the points, with ghosts: every edge of the hull has a triangle
// with vertex GHOST on its other side. Vertex numbers are those of the points. A point equal to
// one with a lower number has no triangle; `duplicate_of` says which that is (its own number for
// all others).
//
// Incremental insertion, Lawson's flips (Lawson 1977), exact predicates; of points on one circle
// any triangulation counts as Delaunay.
Triangulation delaunay(const std::vector<Point>& points, std::vector<Index>& duplicate_of,
                       Monitor& monitor);

}  // namespace adaptmesh
