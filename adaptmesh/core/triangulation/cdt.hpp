// Points and segments in, the constrained Delaunay triangulation of the domain out.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/carve.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

struct ConstrainedTriangulation {
    Triangulation triangulation;     // of the domain only; labels are region numbers
    std::vector<SubEdge> sub_edges;  // its locked edges, by segment and along each
};

// The domain is what the segments enclose, without holes. Vertex numbers are those of the points.
// Anything wrong with the input is an InputError; nothing is repaired. `outside` gets the rest of
// the triangulation, with the ghosts, if it is given.
ConstrainedTriangulation triangulate(const std::vector<Point>& points,
                                     const std::vector<Segment>& segments,
                                     const CarveOptions& options, Monitor& monitor,
                                     Triangulation* outside = nullptr);

}  // namespace adaptmesh
