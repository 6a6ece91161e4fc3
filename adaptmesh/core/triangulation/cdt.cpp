#include "adaptmesh/core/triangulation/cdt.hpp"

#include <utility>
#include <vector>

#include "adaptmesh/core/triangulation/carve.hpp"
#include "adaptmesh/core/triangulation/constrain.hpp"
#include "adaptmesh/core/triangulation/delaunay.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

ConstrainedTriangulation triangulate(const std::vector<Point>& points,
                                     const std::vector<Segment>& segments,
                                     const CarveOptions& options, Monitor& monitor,
                                     Triangulation* outside) {
    ConstrainedTriangulation out;
    std::vector<Index> duplicate_of;
    out.triangulation = delaunay(points, duplicate_of, monitor);
    for (Index i = 0; i < Index(points.size()); ++i) {
        if (duplicate_of[i] != i)
            throw InputError(InputFault::duplicate_points, duplicate_of[i], i, points[i]);
    }
    out.sub_edges = constrain(out.triangulation, points, segments, monitor);
    carve(out.triangulation, points, out.sub_edges, options, monitor, outside);
    return out;
}

}  // namespace adaptmesh
