// Editing a mesh that is already there, as Python sees it.
#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/bindings/mesh_arrays.hpp"
#include "adaptmesh/core/edit/load.hpp"
#include "adaptmesh/core/edit/recut.hpp"
#include "adaptmesh/core/edit/zone.hpp"
#include "adaptmesh/core/mesher/generate.hpp"
#include "adaptmesh/core/mesher/measure_edges.hpp"

using namespace adaptmesh;

namespace {

void load_mesh(MetricMesh* self, const Points& points, const Tensors& tensors,
               const IndexTriples& triangles, const Indices& labels, const IndexPairs& edges,
               const Indices& held_by) {
    expect_rows(tensors.shape(0), points.shape(0), "tensors");
    expect_rows(held_by.shape(0), points.shape(0), "held_by");
    expect_rows(labels.shape(0), triangles.shape(0), "labels");
    std::vector<Vertex> vertices;
    const std::vector<Point> at = to_points(points);
    const std::vector<Tensor> metric = to_tensors(tensors);
    for (std::size_t i = 0; i < at.size(); ++i)
        vertices.push_back(Vertex::make(at[i], metric[i], held_by(i)));
    std::vector<std::array<Index, 3>> corners;
    for (std::size_t t = 0; t < triangles.shape(0); ++t)
        corners.push_back({triangles(t, 0), triangles(t, 1), triangles(t, 2)});
    nb::gil_scoped_release release;
    new (self)
        MetricMesh(load(std::move(vertices), corners, to_indices(labels), to_segments(edges)));
}

auto points_of(const MetricMesh& mesh) {
    std::vector<Point> points;
    for (const Vertex& v : mesh.vertices) points.push_back(v.at);
    return rows(points);
}

void measure(MetricMesh& mesh, const nb::callable& metric) {
    nb::gil_scoped_release release;
    measure_changed_edges(mesh, metric_of(metric));
}

auto edges_of(const MetricMesh& mesh) {
    EdgeList list = edge_list(mesh);
    return std::make_tuple(rows<2>(std::move(list.ends)), column(std::move(list.lengths)),
                           flags(std::move(list.is_constrained)));
}

auto corners(const MetricMesh& mesh, double quality) {
    std::vector<Index> corners = corners_below(mesh, quality);
    return column(std::move(corners));
}

Index hold(MetricMesh& mesh, const Flags& in_zone) {
    expect_rows(in_zone.shape(0), mesh.vertices.size(), "in_zone");
    return hold_all_but(mesh, to_flags(in_zone));
}

void refill_zone(MetricMesh& mesh, const Points& sample_points, const Tensors& sample_tensors,
                 const nb::callable& metric, PythonMonitor& monitor) {
    expect_rows(sample_tensors.shape(0), sample_points.shape(0), "sample_tensors");
    const Samples samples{to_points(sample_points), to_tensors(sample_tensors)};
    nb::gil_scoped_release release;
    refill(mesh, samples, metric_of(metric), monitor);
}

auto recut_lines(MetricMesh& mesh, const Indices& first_stop, const Indices& stops,
                 const Values& stop_places, const Indices& first_cut, const Points& cuts,
                 const Tensors& tensors, const Values& cut_places, const Indices& segments) {
    const std::size_t n = segments.shape(0);
    expect_rows(first_stop.shape(0), n + 1, "first_stop");
    expect_rows(first_cut.shape(0), n + 1, "first_cut");
    expect_rows(stop_places.shape(0), stops.shape(0), "places of stops");
    expect_rows(tensors.shape(0), cuts.shape(0), "tensors");
    expect_rows(cut_places.shape(0), cuts.shape(0), "places of cuts");
    const std::vector<Point> at = to_points(cuts);
    const std::vector<Tensor> metric = to_tensors(tensors);
    std::vector<Index> now, begins = {0};
    std::vector<double> places;
    {
        nb::gil_scoped_release release;
        for (std::size_t s = 0; s < n; ++s) {
            std::vector<Stop> polyline;
            for (Index i = first_stop(s); i < first_stop(s + 1); ++i)
                polyline.push_back({stop_places(i), stops(i), true});
            std::vector<Vertex> made;
            for (Index i = first_cut(s); i < first_cut(s + 1); ++i)
                made.push_back(Vertex::make(at[i], metric[i], segments(s)));
            recut(mesh, polyline, made, cut_places.data() + first_cut(s));
            for (const Stop& stop : polyline) {
                now.push_back(stop.vertex);
                places.push_back(stop.place);
            }
            begins.push_back(Index(now.size()));
        }
    }
    return std::make_tuple(column(std::move(now)), column(std::move(places)),
                           column(std::move(begins)));
}

auto finished(MetricMesh& mesh, const IndexPairs& edges, const Indices& segments) {
    expect_rows(segments.shape(0), edges.shape(0), "segments");
    mesh.constrained.clear();
    for (std::size_t i = 0; i < segments.shape(0); ++i)
        mesh.constrained.push_back({edges(i, 0), edges(i, 1), segments(i)});
    mesh.compact();
    return arrays_of(mesh);
}

}  // namespace

void bind_edit(nb::module_& m) {
    m.attr("FREE") = FREE;
    m.attr("FIXED") = FIXED;
    nb::class_<MetricMesh>(m, "MetricMesh", "A mesh with a metric, to be edited in place.")
        .def("__init__", &load_mesh, nb::arg("points"), nb::arg("tensors"), nb::arg("triangles"),
             nb::arg("labels"), nb::arg("edges"), nb::arg("held_by"),
             "A mesh: the label of each triangle, its constrained edges, and what holds each "
             "vertex (FREE, FIXED, or the number of a segment).")
        .def("points", &points_of)
        .def("measure", &measure, nb::arg("metric"),
             "Measures the edges that have changed with the exact metric.")
        .def("edges", &edges_of, "All edges (e, 2), their lengths, whether they are constrained.")
        .def("corners_below", &corners, nb::arg("quality"))
        .def("hold_all_but", &hold, nb::arg("in_zone"),
             "Holds the vertices outside of a zone; returns how many inside are free.")
        .def("refill", &refill_zone, nb::arg("sample_points"), nb::arg("sample_tensors"),
             nb::arg("metric"), nb::arg("monitor"),
             "Removes the free vertices, and fills the mesh again.")
        .def("recut", &recut_lines, nb::arg("first_stop"), nb::arg("stops"), nb::arg("stop_places"),
             nb::arg("first_cut"), nb::arg("cuts"), nb::arg("tensors"), nb::arg("cut_places"),
             nb::arg("segments"),
             "Discretises polylines of the boundary again. Polyline s has the stops from "
             "first_stop[s] on, its ends and the vertices between that go, and the cuts from "
             "first_cut[s] on; places give their order along it. Returns the vertices of all "
             "polylines as they are now, their places, and where each polyline begins.")
        .def("finished", &finished, nb::arg("edges"), nb::arg("segments"),
             "As `generate` returns it; with its constrained edges and the segment of each.");
}
