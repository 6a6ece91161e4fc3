// The mesher as Python sees it: see mesher.hpp.
#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/mesher.hpp"

using namespace adaptmesh;

void bind_mesher(nb::module_& m) {
    nb::class_<EdgesToMeasure>(m, "EdgesToMeasure").def_ro("sampler", &EdgesToMeasure::sampler);

    nb::class_<Settler>(m, "Settler", "Changes what is off where the change, measured, is better.")
        .def_prop_ro("sampler", &Settler::sampler, nb::rv_policy::reference_internal);

    nb::class_<Front>(m, "Front", "Builds unit triangles from the constraints inwards.")
        .def("wanted",
             [](const Front& front) {
                 const std::size_t n = front.wanted_count();
                 return to_numpy(front.wanted(), {n, 2});
             })
        .def("feed", [](Front& front, const Tensors& tensors) {
            expect_rows(tensors.shape(0), front.wanted_count(), "tensors at the wanted points");
            front.feed([&](std::size_t i) { return tensor_in(tensors, i); });
        });

    nb::class_<Mesher>(m, "Mesher", "A metric mesh and the stages that improve it, in place.")
        .def(nb::init<const Points&, const Tensors&, const IndexPairs&, const Points&,
                      const Points&, bool>(),
             nb::arg("points"), nb::arg("tensors"), nb::arg("segments"), nb::arg("holes"),
             nb::arg("seeds"), nb::arg("nesting"))
        .def(nb::init<const Points&, const Tensors&, const IndexTriples&, const Indices&,
                      const IndexPairs&, const Indices&>(),
             nb::arg("points"), nb::arg("tensors"), nb::arg("triangles"), nb::arg("labels"),
             nb::arg("edges"), nb::arg("held_by"))
        .def("recut", &Mesher::recut, nb::arg("first_stop"), nb::arg("stops"),
             nb::arg("stop_places"), nb::arg("first_cut"), nb::arg("cuts"), nb::arg("tensors"),
             nb::arg("cut_places"), nb::arg("segments"))
        .def("set_constrained", &Mesher::set_constrained, nb::arg("edges"), nb::arg("segments"))
        .def("edges", &Mesher::edges)
        .def("corners_below", &Mesher::corners_below, nb::arg("quality"))
        .def("hold_all_but", &Mesher::hold_all_but, nb::arg("in_zone"))
        .def("remove_free", &Mesher::remove_free, nb::arg("rounds"))
        .def("cut_outline", &Mesher::cut_outline, nb::arg("ends"), nb::arg("segments"),
             nb::arg("cuts"), nb::arg("tensors"), nb::arg("piece"))
        .def_prop_ro("vertex_count", &Mesher::vertex_count)
        .def("fresh_edges", &Mesher::fresh_edges, nb::arg("uncut_below"))
        .def("insert_along_edges", &Mesher::insert_along_edges, nb::arg("edges"),
             nb::arg("long_edge"), nb::arg("spacing"), nb::arg("most_vertices"))
        .def("insert_where_finer", &Mesher::insert_where_finer, nb::arg("points"),
             nb::arg("tensors"), nb::arg("ratio"), nb::arg("spacing"))
        .def("front", &Mesher::front, nb::arg("accept"), nb::arg("spacing"), nb::arg("target"),
             nb::arg("settled"), nb::arg("trials"), nb::keep_alive<0, 1>())
        .def("advance", &Mesher::advance, nb::arg("front"))
        .def("insert_ahead", &Mesher::insert_ahead, nb::arg("front"))
        .def("swap", &Mesher::swap, nb::arg("most_passes") = 5)
        .def("swap_worst", &Mesher::swap_worst, nb::arg("below"))
        .def("smooth", &Mesher::smooth)
        .def("collapse_short_edges", &Mesher::collapse_short_edges)
        .def("split_long_edges", &Mesher::split_long_edges)
        .def("search_active", &Mesher::search_active, nb::arg("shortest"), nb::arg("longest"),
             nb::arg("least_quality"), nb::arg("step"))
        .def("settler", &Mesher::settler, nb::arg("least_quality"), nb::keep_alive<0, 1>())
        .def("find_sites", &Mesher::find_sites, nb::arg("settler"))
        .def("find_worst", &Mesher::find_worst, nb::arg("settler"), nb::arg("below"),
             nb::arg("most"))
        .def("propose", &Mesher::propose, nb::arg("settler"), nb::arg("step"))
        .def("set_kernels", &Mesher::set_kernels, nb::arg("settler"), nb::arg("tensors"))
        .def("accept", &Mesher::accept, nb::arg("settler"))
        .def("correct_lengths", &Mesher::correct_lengths, nb::arg("edges"))
        .def("compact", &Mesher::compact)
        .def("points", &Mesher::points)
        .def("stale_points", &Mesher::stale_points)
        .def("set_stale_metrics", &Mesher::set_stale_metrics, nb::arg("tensors"))
        .def("triangles", &Mesher::triangles)
        .def("labels", &Mesher::labels)
        .def("constrained_edges", &Mesher::constrained_edges);
    m.attr("FREE") = FREE;
    m.attr("FIXED") = FIXED;
    m.attr("MAX_VERTICES") = MAX_TRIANGLES / 2;
}
