#include <nanobind/stl/string.h>

#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/triangulate.hpp"

namespace {

using namespace adaptmesh;

nb::tuple delaunay_arrays(const Points& array) {
    const std::vector<Point> points = to_points(array);
    std::vector<Index> corners, duplicate_of;
    {
        nb::gil_scoped_release release;
        PythonMonitor monitor;
        const Triangulation mesh = delaunay(points, duplicate_of, monitor);
        corners.reserve(3 * mesh.triangles.size());
        for (const Triangle& t : mesh.triangles) {
            if ((t.v[0] | t.v[1] | t.v[2]) >= 0) corners.insert(corners.end(), t.v, t.v + 3);
        }
    }
    const std::size_t m = corners.size() / 3, n = points.size();
    return nb::make_tuple(to_numpy(std::move(corners), {m, 3}),
                          to_numpy(std::move(duplicate_of), {n}));
}

nb::tuple triangulate_arrays(const Points& points_in, const IndexPairs& segments_in,
                             const Points& holes, const Points& seeds, bool nesting, bool certain) {
    const std::vector<Point> points = to_points(points_in);
    const std::vector<Segment> segments = to_segments(segments_in);
    const CarveOptions options{to_points(holes), to_points(seeds), nesting, certain};

    std::vector<Index> corners, labels, ends, segment_of;
    std::vector<std::uint8_t> is_boundary;
    {
        nb::gil_scoped_release release;
        PythonMonitor monitor;
        const ConstrainedTriangulation out = triangulate(points, segments, options, monitor);
        for (const Triangle& t : out.triangulation.triangles) {
            corners.insert(corners.end(), t.v, t.v + 3);
            labels.push_back(t.label);
        }
        for (const SubEdge& e : out.sub_edges) {
            ends.insert(ends.end(), {e.a, e.b});
            segment_of.push_back(e.segment);
            is_boundary.push_back(e.is_boundary);
        }
    }
    const std::size_t m = labels.size(), q = segment_of.size();
    return nb::make_tuple(to_numpy(std::move(corners), {m, 3}), to_numpy(std::move(labels), {m}),
                          to_numpy(std::move(ends), {q, 2}), to_numpy(std::move(segment_of), {q}),
                          to_numpy_flags(std::move(is_boundary)));
}

// Fault as a Python exception with args (kind, i, j, x, y).
void bind_fault(nb::module_& m) {
    // Never released: it must outlive the interpreter's last exception.
    static PyObject* const type = PyErr_NewExceptionWithDoc(
        "adaptmesh._core.Fault",
        "Input that cannot be triangulated; args (kind, i, j, x, y), see adaptmesh/core/fault.hpp.",
        nullptr, nullptr);
    m.attr("Fault") = nb::handle(type);
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const Fault& f) {
            const nb::tuple args = nb::make_tuple(f.kind, f.i, f.j, f.at.x, f.at.y);
            PyErr_SetObject(type, args.ptr());
        }
    });
}

}  // namespace

void bind_triangulate(nb::module_& m) {
    bind_fault(m);
    m.def("delaunay", &delaunay_arrays, nb::arg("points"),
          "(triangles, duplicate_of): the Delaunay triangulation; each point's own number, or that "
          "of the first point equal to it.");
    m.def("triangulate", &triangulate_arrays, nb::arg("points"), nb::arg("segments"),
          nb::arg("holes"), nb::arg("seeds"), nb::arg("nesting"), nb::arg("certain") = false,
          "(triangles, labels, sub_edges, sub_edge_segment, sub_edge_is_boundary): the constrained "
          "Delaunay triangulation of the domain that the segments enclose; label 1 + k for the "
          "region of seed k, 0 without a seed.");
}
