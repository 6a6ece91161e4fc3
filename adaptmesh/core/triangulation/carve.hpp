// From a constrained triangulation of everything to that of the domain: outside and holes removed,
// regions numbered.
//
// All of it is about *components*: sets of triangles connected over edges that are not locked.
// Component 0 is the outside, the one of the ghosts.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

struct CarveOptions {
    std::vector<Point> holes;         // a point in each hole
    std::vector<Point> region_seeds;  // a point in each named region
    bool nesting = false;  // closed loops inside the domain are holes, loops in these not
    bool certain = false;  // with nesting: refuse holes of which it is not certain that they are
};

// Leaves of a constrained triangulation with ghosts the domain that its locked edges enclose: what
// the outside or a hole reaches over unlocked edges is removed. `sub_edges` are the locked edges,
// as `constrain` returned them, all of which have to be in the domain or bound it: is_boundary is
// set in those that bound it.
// Labels become 1 + the number of the region seed, 0 where there is none. Vertex numbers stay; a
// vertex of no triangle has triangle_at NONE. Where two parts of the domain meet in one vertex
// only, `ball` of that vertex sees one of them. `outside` gets what is removed, if it is given.
void carve(Triangulation& mesh, const std::vector<Point>& points, std::vector<SubEdge>& sub_edges,
           const CarveOptions& options, Monitor& monitor, Triangulation* outside = nullptr);

}  // namespace adaptmesh
