// What the checks of a mesh ask of the core, as Python sees it.
#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/validate/border_sweep.hpp"

namespace {

using namespace adaptmesh;

auto sweep_border_arrays(const Points& points_in, const IndexPairs& edges_in) {
    const std::vector<Point> points = to_points(points_in);
    const std::vector<Segment> edges = to_segments(edges_in);
    BorderSweep found;
    {
        nb::gil_scoped_release release;
        PythonMonitor monitor;
        found = sweep_border(points, edges, monitor);
    }
    return std::make_tuple(std::make_tuple(found.first, found.second),
                           column(std::move(found.layers)));
}

}  // namespace

void bind_validate(nb::module_& m) {
    m.def("sweep_border", &sweep_border_arrays, nb::arg("points"), nb::arg("edges"),
          "((e, f), layers): two border edges that have more in common than an end, or (-1, -1); "
          "and, if there are none, how many triangles lie on the left of each edge. Edges have the "
          "mesh on their left; their points are distinct and finite. Exact, n log n.");
}
