// Cutting the boundary: unit points are put on the constrained edges, coarse to fine.
//
// The triangulation is metric Delaunay before and after each point, so that each costs a few flips.
// (Triangulating all of them at once, for the Euclidean plane, would leave edges between boundaries
// thousands of units off under a slanted anisotropic metric, each flip bringing them one step
// nearer.)
//
//        a-----------------------b        the middle cut first, then those of both halves, of all
//        a-----------m-----------b        pieces in turn
//        a-----m-----m-----m-----b
//
// The cuts of a curve are off the chord that they divide, and all cuts are rounded:
//
//          .--m--.                .-m-.       m takes the place of the chord's middle if the two
//        a---------b      ->     a     b      triangles beside ab, bent, are four positive ones
//         \       /                \  |  /
//
// On the border of the domain one of the two is a triangle of the outside, see outside.hpp.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/boundary_cuts.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/outside.hpp"

namespace adaptmesh {

// Puts the cuts of a boundary on its pieces; returns of each whether it could be made. The mesh
// gets to know its constrained edges.
//
// A cut that would make a triangle that is not positive (on a straight edge by rounding, on a curve
// because something hides it from its chord) is tried again after the others; if that does not help
// it is left out, and what it would have cut stays whole.
std::vector<char> cut_boundary(MetricMesh& mesh, Outside& outside, const BoundaryCuts& boundary,
                               Monitor& monitor);

}  // namespace adaptmesh
