// The order of points along a Hilbert curve: neighbours in the order are neighbours in the plane.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// The numbers of the points in the order of a Hilbert curve through their bounding square. A cell
// that holds a crowd gets a curve of its own, so that clusters of any scale are ordered. Equal
// points keep the order of their numbers.
std::vector<Index> hilbert_order(const std::vector<Point>& points);

}  // namespace adaptmesh
