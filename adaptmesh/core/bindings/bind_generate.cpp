// Making a mesh of a boundary and a metric, as Python sees it.
#include "adaptmesh/core/mesher/generate.hpp"

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/bindings/exceptions.hpp"
#include "adaptmesh/core/bindings/mesh_arrays.hpp"

using namespace adaptmesh;

namespace {

void make_boundary(BoundaryCuts* self, const Points& points, const Tensors& tensors,
                   const IndexPairs& segments, const Indices& owners, const IndexPairs& pieces,
                   const Indices& piece_segments, const Flags& is_chord, const Points& cuts,
                   const Tensors& cut_tensors, const Indices& cut_pieces,
                   const IndexTriples& ties) {
    expect_rows(tensors.shape(0), points.shape(0), "tensors");
    expect_rows(owners.shape(0), segments.shape(0), "owners");
    expect_rows(piece_segments.shape(0), pieces.shape(0), "piece_segments");
    expect_rows(is_chord.shape(0), pieces.shape(0), "is_chord");
    expect_rows(cut_tensors.shape(0), cuts.shape(0), "cut_tensors");
    expect_rows(cut_pieces.shape(0), cuts.shape(0), "cut_pieces");
    new (self) BoundaryCuts{to_points(points),
                            to_tensors(tensors),
                            to_segments(segments),
                            to_indices(owners),
                            {},
                            to_points(cuts),
                            to_tensors(cut_tensors),
                            to_indices(cut_pieces),
                            {}};
    for (std::size_t p = 0; p < pieces.shape(0); ++p)
        self->pieces.push_back({pieces(p, 0), pieces(p, 1), piece_segments(p), is_chord(p)});
    for (std::size_t k = 0; k < ties.shape(0); ++k)
        self->ties.push_back({ties(k, 0), ties(k, 1), ties(k, 2) != 0});
}

auto generate_arrays(const BoundaryCuts& boundary, const Points& holes, const Points& seeds,
                     bool nesting, const Points& sample_points, const Tensors& sample_tensors,
                     Placement placement, const nb::callable& metric, PythonMonitor& monitor) {
    expect_rows(sample_tensors.shape(0), sample_points.shape(0), "sample_tensors");
    const CarveOptions carve{to_points(holes), to_points(seeds), nesting};
    const Samples samples{to_points(sample_points), to_tensors(sample_tensors)};
    MetricMesh mesh;
    {
        nb::gil_scoped_release release;
        mesh = generate(boundary, carve, samples, placement, metric_of(metric), monitor);
    }
    return arrays_of(mesh);
}

// TooManyVertices as a Python exception with args () or (x, y).
void bind_too_many_vertices(nb::module_& m) {
    static PyObject* const type = new_exception(
        m, "TooManyVertices",
        "A mesh needs more vertices than allowed; args (x, y), near which many are, or none.");
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const TooManyVertices& e) {
            const nb::tuple args = e.near ? nb::make_tuple(e.near->x, e.near->y) : nb::make_tuple();
            PyErr_SetObject(type, args.ptr());
        }
    });
}

}  // namespace

void bind_generate(nb::module_& m) {
    m.attr("MAX_VERTICES") = MAX_VERTICES;
    bind_too_many_vertices(m);

    nb::enum_<Placement>(m, "Placement")
        .value("front", Placement::front)
        .value("edges", Placement::edges);

    nb::class_<PythonMonitor>(m, "Monitor", "Limits the vertices of a mesh, and reports progress.")
        .def(nb::init<Index, Index, nb::callable>(), nb::arg("max_vertices"),
             nb::arg("expected_vertices"), nb::arg("progress"),
             "progress(stage, fraction) is called with how much of all the work is done.");

    nb::class_<BoundaryCuts>(m, "BoundaryCuts", "Lines of a domain, cut into unit pieces.")
        .def("__init__", &make_boundary, nb::arg("points"), nb::arg("tensors"), nb::arg("segments"),
             nb::arg("owners"), nb::arg("pieces"), nb::arg("piece_segments"), nb::arg("is_chord"),
             nb::arg("cuts"), nb::arg("cut_tensors"), nb::arg("cut_pieces"), nb::arg("ties"),
             "See core/mesher/boundary_cuts.hpp; ties are (piece, image, is_reversed).");

    m.def("generate", &generate_arrays, nb::arg("boundary"), nb::arg("holes"), nb::arg("seeds"),
          nb::arg("nesting"), nb::arg("sample_points"), nb::arg("sample_tensors"),
          nb::arg("placement"), nb::arg("metric"), nb::arg("monitor"),
          "(points, triangles, labels, edges, segments): a mesh, its constrained edges and the "
          "segment of the domain that each lies on. `metric` is called with (n, 2) points and "
          "returns (n, 3) packed metrics.");
}
