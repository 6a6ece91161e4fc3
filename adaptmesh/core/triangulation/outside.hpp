// What lies around the domain, triangulated out to a box, while its border is cut.
//
// A cut is rounded, so it is a little off its edge. Towards the inside, the triangles beside the
// edge tell whether it still fits. Towards the outside nothing would: there, across a slit or a
// needle-thin hole, or beyond a notch, may be another part of the border.
//
//      +-----------------+        the triangles of the outside stay positive, as those inside do;
//      |\   _______    / |        the border of the box never changes. A map of a disc that keeps
//      | \ /domain \  /  |        all triangles positive, and its border in place, is one to one:
//      |  |   ___   |    |        so no two edges of the border cross, and no two points are one.
//      |  |  /___\  |    |
//      |  |_______ / ----|        Outside triangles are kept Delaunay (in the Euclidean plane): a
//      +-----------------+        sliver could refuse a cut that nothing hides.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/fans.hpp"
#include "adaptmesh/core/triangulation/insert.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

class Outside {
  public:
    Outside() = default;

    // From what a constrained triangulation of points has outside of the domain, with its ghosts.
    Outside(Triangulation outside, const std::vector<Point>& points);

    // Whether the border edge from a to b, as the outside has it on its left, can be cut at p.
    bool takes(Index a, Index b, Point p) const;

    // Cuts that edge at p, where the mesh gets this vertex.
    void cut(Index a, Index b, Index vertex, Point p);

  private:
    // The number here of a vertex of the mesh: the same for those that were there first.
    Index number(Index vertex) const {
        return vertex < first_box_ ? vertex : number_[vertex - first_box_];
    }

    Place find(Index a, Index b) const { return fans_.find_edge(topology_, number(a), number(b)); }

    // Lawson's flips. Only those at the box are needed: the rest is Delaunay already.
    void make_delaunay();

    Triangulation topology_;
    std::vector<Point> points_;
    Index first_box_ = 0;
    std::vector<Index> number_;  // of the vertices of the mesh from first_box_ on
    Fans fans_;
    std::vector<Place> doubtful_;
};

}  // namespace adaptmesh
