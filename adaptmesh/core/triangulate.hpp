// Points and segments in, the constrained Delaunay triangulation of the domain out.
#pragma once

#include <utility>
#include <vector>

#include "adaptmesh/core/carve.hpp"
#include "adaptmesh/core/constrain.hpp"
#include "adaptmesh/core/delaunay.hpp"
#include "adaptmesh/core/fault.hpp"
#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

struct ConstrainedTriangulation {
    Triangulation triangulation;     // of the domain only; labels are region numbers
    std::vector<SubEdge> sub_edges;  // its locked edges, by segment and along each
};

// The domain is what the segments enclose, without holes. Vertex numbers are those of the points.
// Anything wrong with the input is a Fault; nothing is repaired. `outside` gets the rest of the
// triangulation, with the ghosts, if it is given.
inline ConstrainedTriangulation triangulate(const std::vector<Point>& points,
                                            const std::vector<Segment>& segments,
                                            const CarveOptions& options, Monitor& monitor,
                                            Triangulation* outside = nullptr) {
    ConstrainedTriangulation out;
    std::vector<Index> duplicate_of;
    out.triangulation = delaunay(points, duplicate_of, monitor);
    for (Index i = 0; i < Index(points.size()); ++i) {
        if (duplicate_of[i] != i) throw Fault("duplicate_points", duplicate_of[i], i, points[i]);
    }
    out.sub_edges = constrain(out.triangulation, points, segments, monitor);
    carve(out.triangulation, points, out.sub_edges, options, monitor, outside);
    return out;
}

}  // namespace adaptmesh
