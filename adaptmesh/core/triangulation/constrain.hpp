// Makes segments edges of a Delaunay triangulation, which becomes a constrained Delaunay one.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// Locks the segments in a Delaunay triangulation with ghosts of all their vertices; afterwards it
// is constrained Delaunay. Returns the locked edges, in the order of the segments and along each:
// one per segment, or more if other vertices lie exactly on it. Faults if segments cross or
// overlap.
std::vector<SubEdge> constrain(Triangulation& mesh, const std::vector<Point>& points,
                               const std::vector<Segment>& segments, Monitor& monitor);

}  // namespace adaptmesh
