// Discretising a part of a boundary polyline again, in a mesh that is already there.
//
//     a----o-----o--o----b        a part of a polyline, with vertices o between,
//     a----o--n--o--on---b        gets its new vertices n first,
//     a-------n------n---b        and then each o is pulled into its nearer neighbour
//
// Places along the polyline (numbers that grow from a to b) give the order; nothing here knows
// whether it is straight.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"

namespace adaptmesh {

// A vertex of a polyline of the boundary, and where on it.
struct Stop {
    double place;
    Index vertex;
    bool is_old;
};

// `polyline` begins and ends with the vertices that stay; the others are old. The cuts are in
// order. Cuts and removals that would make a triangle that is none are left out.
void recut(MetricMesh& mesh, std::vector<Stop>& polyline, const std::vector<Vertex>& cuts,
           const double* places);

}  // namespace adaptmesh
