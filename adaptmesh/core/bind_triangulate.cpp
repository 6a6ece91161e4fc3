#include <cstring>

#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/delaunay.hpp"

namespace {

using namespace adaptmesh;

std::vector<Point> to_points(const Points& array) {
    static_assert(sizeof(Point) == 2 * sizeof(double));
    std::vector<Point> points(array.shape(0));
    if (!points.empty()) std::memcpy(points.data(), array.data(), points.size() * sizeof(Point));
    return points;
}

nb::tuple delaunay_arrays(const Points& array) {
    const std::vector<Point> points = to_points(array);
    std::vector<Index> corners, duplicate_of;
    {
        nb::gil_scoped_release release;
        SignalPoll poll;
        const Triangulation mesh = delaunay(points, duplicate_of, poll);
        corners.reserve(3 * mesh.triangles.size());
        for (const Triangle& t : mesh.triangles) {
            if ((t.v[0] | t.v[1] | t.v[2]) >= 0) corners.insert(corners.end(), t.v, t.v + 3);
        }
    }
    const std::size_t m = corners.size() / 3, n = points.size();
    return nb::make_tuple(to_numpy(std::move(corners), {m, 3}), to_numpy(std::move(duplicate_of), {n}));
}

}  // namespace

void bind_triangulate(nb::module_& m) {
    m.def("delaunay", &delaunay_arrays, nb::arg("points"));
}
