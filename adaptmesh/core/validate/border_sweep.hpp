// A plane sweep over the border of a mesh: does it cross itself, and how many triangles lie beside
// it? After Shamos and Hoey (1976), Geometric Intersection Problems; n log n, every decision exact.
//
// A line goes over the plane from left to right. The edges it meets are kept in order from below to
// above; two of them can only cross where they have become neighbours::
//
//       \ |  /                 At a vertex the edges that end there leave the order, and those
//     ---\| /---  above        that start there take their place, sorted by angle. What comes to
//         v------              stand side by side is tested.
//     ---/|\----  below
//       / | \                  Points of the same x are passed from below to above, as by a line
//         |                    that leans a little; vertical edges need no special case then.
//
// Edges have the mesh on their left. The layers over a point of the plane, that is the number of
// triangles that contain it, change by one from edge to edge: going up, they grow where an edge
// points to the right and shrink where it points to the left.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

struct BorderSweep {
    Index first = NONE, second = NONE;  // two edges that have more in common than an end, or NONE
    std::vector<Index> layers;          // on the left of each edge, if no two cross
};

BorderSweep sweep_border(const std::vector<Point>& points, const std::vector<Segment>& edges,
                         Monitor& monitor);

}  // namespace adaptmesh
