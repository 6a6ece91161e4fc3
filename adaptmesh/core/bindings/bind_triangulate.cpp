// Delaunay triangulations, constrained or not, as Python sees them.
#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/bindings/exceptions.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "adaptmesh/core/triangulation/delaunay.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"

namespace {

using namespace adaptmesh;

auto delaunay_arrays(const Points& array) {
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
    return std::make_tuple(rows<3>(std::move(corners)), column(std::move(duplicate_of)));
}

auto triangulate_arrays(const Points& points_in, const IndexPairs& segments_in, const Points& holes,
                        const Points& seeds, bool nesting, bool certain) {
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
    return std::make_tuple(rows<3>(std::move(corners)), column(std::move(labels)),
                           rows<2>(std::move(ends)), column(std::move(segment_of)),
                           flags(std::move(is_boundary)));
}

// InputError as a Python exception with args (kind, i, j, x, y).
void bind_input_error(nb::module_& m) {
    nb::enum_<InputFault>(m, "InputFault", "What can be wrong with points and segments.")
        .value("too_few_points", InputFault::too_few_points)
        .value("not_finite", InputFault::not_finite)
        .value("all_collinear", InputFault::all_collinear)
        .value("too_many_points", InputFault::too_many_points)
        .value("duplicate_points", InputFault::duplicate_points)
        .value("segment_out_of_range", InputFault::segment_out_of_range)
        .value("degenerate_segment", InputFault::degenerate_segment)
        .value("overlapping_segments", InputFault::overlapping_segments)
        .value("crossing_segments", InputFault::crossing_segments)
        .value("open_boundary", InputFault::open_boundary)
        .value("open_hole", InputFault::open_hole)
        .value("uncertain_hole", InputFault::uncertain_hole)
        .value("hole_outside", InputFault::hole_outside)
        .value("hole_on_segment", InputFault::hole_on_segment)
        .value("region_seed_outside", InputFault::region_seed_outside)
        .value("region_seed_on_segment", InputFault::region_seed_on_segment)
        .value("two_seeds_one_region", InputFault::two_seeds_one_region)
        .value("point_outside", InputFault::point_outside)
        .value("empty_domain", InputFault::empty_domain)
        .value("lines_too_near", InputFault::lines_too_near);
    static PyObject* const type =
        new_exception(m, "InputError",
                      "Input that cannot be triangulated; args (kind, i, j, x, y): see "
                      "core/triangulation/input_error.hpp.");
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const InputError& f) {
            const nb::tuple args = nb::make_tuple(nb::cast(f.kind), f.i, f.j, f.at.x, f.at.y);
            PyErr_SetObject(type, args.ptr());
        }
    });
}

}  // namespace

void bind_triangulate(nb::module_& m) {
    bind_input_error(m);
    m.def("delaunay", &delaunay_arrays, nb::arg("points"),
          "(triangles, duplicate_of): the Delaunay triangulation; each point's own number, or that "
          "of the first point equal to it.");
    m.def("triangulate", &triangulate_arrays, nb::arg("points"), nb::arg("segments"),
          nb::arg("holes"), nb::arg("seeds"), nb::arg("nesting"), nb::arg("certain") = false,
          "(triangles, labels, sub_edges, sub_edge_segment, sub_edge_is_boundary): the constrained "
          "Delaunay triangulation of the domain that the segments enclose; label 1 + k for the "
          "region of seed k, 0 without a seed.");
}
