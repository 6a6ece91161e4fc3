// What carries fields from mesh to mesh, as Python sees it.
#include "adaptmesh/core/bindings.hpp"
#include "metrics/core/locator.hpp"

using metrics::Locator;

namespace {

void make_locator(Locator* self, const Points& points, const IndexTriples& triangles) {
    nb::gil_scoped_release release;
    new (self) Locator(points.data(), points.shape(0), triangles.data(), triangles.shape(0));
}

nb::tuple locate(const Locator& locator, const Points& points) {
    const std::size_t n = points.shape(0);
    std::vector<std::int32_t> triangles(n);
    std::vector<double> weights(3 * n), distances(n);
    {
        nb::gil_scoped_release release;
        for (std::size_t i = 0; i < n; ++i) {
            const metrics::Location place =
                locator.locate(points(i, 0), points(i, 1), Locator::NO_TRIANGLE);
            triangles[i] = place.triangle;
            std::copy(place.weight, place.weight + 3, weights.begin() + 3 * i);
            distances[i] = place.outside;
        }
    }
    return nb::make_tuple(to_numpy(std::move(triangles), {n}), to_numpy(std::move(weights), {n, 3}),
                          to_numpy(std::move(distances), {n}));
}

}  // namespace

void bind_transfer(nb::module_& m) {
    nb::class_<Locator>(m, "Locator")
        .def("__init__", &make_locator, nb::arg("points"), nb::arg("triangles"))
        .def("locate", &locate, nb::arg("points"),
             "Triangles (k,), barycentric coordinates (k, 3), distances from the mesh (k,).");
}
