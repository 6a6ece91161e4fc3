// What carries fields from mesh to mesh, as Python sees it.
#include <nanobind/stl/optional.h>

#include <optional>

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/transfer/exact_location.hpp"
#include "adaptmesh/core/transfer/field_bounds.hpp"
#include "adaptmesh/core/transfer/moments.hpp"
#include "adaptmesh/core/transfer/overlay.hpp"
#include "metrics/core/locator.hpp"

using adaptmesh::Overlay;
using metrics::Locator;

namespace {

using Numbers = nb::ndarray<const double, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;
using Nodes = nb::ndarray<const std::int32_t, nb::shape<-1, -1>, nb::c_contig, nb::device::cpu>;

void make_locator(Locator* self, const Points& points, const IndexTriples& triangles) {
    nb::gil_scoped_release release;
    new (self) Locator(points.data(), points.shape(0), triangles.data(), triangles.shape(0));
}

auto locate(const Locator& locator, const Points& points) {
    const std::size_t n = points.shape(0);
    std::vector<std::int32_t> triangles(n);
    std::vector<double> weights(3 * n), distances(n);
    {
        nb::gil_scoped_release release;
        const adaptmesh::ExactLocator exact(locator);
        for (std::size_t i = 0; i < n; ++i) {
            const metrics::Location place = exact.locate({points(i, 0), points(i, 1)});
            triangles[i] = place.triangle;
            std::copy(place.weight, place.weight + 3, weights.begin() + 3 * i);
            distances[i] = place.outside;
        }
    }
    return std::make_tuple(column(std::move(triangles)), rows<3>(std::move(weights)),
                           column(std::move(distances)));
}

// Accurate areas of triangles whose corners are rows x0, y0, x1, y1, x2, y2.
auto triangle_areas(const Numbers& corners) {
    std::vector<double> areas(corners.shape(0));
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const double* p = corners.data() + 6 * i;
        areas[i] = 0.5 * adaptmesh::twice_area({p[0], p[1]}, {p[2], p[3]}, {p[4], p[5]});
    }
    return column(std::move(areas));
}

void make_overlay(Overlay* self, const Locator& older, const Values& old_areas,
                  const Locator& newer, const Values& new_areas) {
    PythonMonitor monitor;
    nb::gil_scoped_release release;
    new (self) Overlay(older, old_areas.data(), newer, new_areas.data(), monitor);
}

auto pairs(const Overlay& overlay) {
    const auto& first = overlay.first();
    std::vector<std::int64_t> starts(first.begin(), first.end());
    std::vector<std::int32_t> olds = overlay.olds();
    std::vector<double> areas = overlay.areas();
    return std::make_tuple(column(std::move(starts)), column(std::move(olds)),
                           column(std::move(areas)));
}

auto moments(const Overlay& overlay, const Numbers& values, const Nodes& old_nodes,
             const Nodes& new_nodes, std::size_t size, double reach,
             const std::optional<Numbers>& low, const std::optional<Numbers>& high) {
    const adaptmesh::BoundsOnTriangles bounds{low ? low->data() : nullptr,
                                              high ? high->data() : nullptr};
    const std::size_t columns = values.shape(1);
    std::vector<double> out(size * columns, 0.0);
    {
        PythonMonitor monitor;
        nb::gil_scoped_release release;
        const adaptmesh::OldField field{values.data(), columns, old_nodes.data(), bounds};
        adaptmesh::add_moments(overlay, field, reach, new_nodes.data(), new_nodes.shape(1),
                               out.data(), monitor);
    }
    return to_numpy<Table<double>>(std::move(out), {size, columns});
}

auto ranges(const Overlay& overlay, const Numbers& low, const Numbers& high, const Nodes& nodes,
            std::size_t size) {
    const std::size_t columns = low.shape(1);
    std::vector<double> least(size * columns, INFINITY), most(size * columns, -INFINITY);
    {
        nb::gil_scoped_release release;
        adaptmesh::ranges(overlay, low.data(), high.data(), columns, nodes.data(), nodes.shape(1),
                          least.data(), most.data());
    }
    return std::make_tuple(to_numpy<Table<double>>(std::move(least), {size, columns}),
                           to_numpy<Table<double>>(std::move(most), {size, columns}));
}

}  // namespace

void bind_transfer(nb::module_& m) {
    nb::class_<Locator>(m, "Locator")
        .def("__init__", &make_locator, nb::arg("points"), nb::arg("triangles"))
        .def("locate", &locate, nb::arg("points"),
             "Triangles (k,), barycentric coordinates (k, 3), distances from the mesh (k,).");
    m.def(
        "triangle_areas", &triangle_areas, nb::arg("corners"),
        "Areas (m,) of triangles with corners (m, 6), to a small relative error if they are thin.");
    nb::class_<Overlay>(m, "Overlay", "Which triangles of two meshes overlap.")
        .def("__init__", &make_overlay, nb::arg("older"), nb::arg("old_areas"), nb::arg("newer"),
             nb::arg("new_areas"), nb::keep_alive<1, 2>(), nb::keep_alive<1, 4>())
        .def("pairs", &pairs,
             "First pair of each new triangle (m + 1,), old triangles, areas in common.")
        .def("moments", &moments, nb::arg("values"), nb::arg("old_nodes"), nb::arg("new_nodes"),
             nb::arg("size"), nb::arg("reach"), nb::arg("low").none(), nb::arg("high").none(),
             "Integrals (size, k) of columns (n, k) with each new basis function; where the old "
             "mesh "
             "does not cover the new one, within bounds (m, k) of the old triangles, or None.")
        .def("ranges", &ranges, nb::arg("low"), nb::arg("high"), nb::arg("nodes"), nb::arg("size"),
             "Least and largest of (m, k) on the old triangles around new nodes, both (size, k).");
}
