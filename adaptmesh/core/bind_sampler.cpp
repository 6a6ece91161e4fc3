// Measuring and cutting straight lines by the metric, as Python sees it.
#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/edge_sampler.hpp"

using namespace adaptmesh;

namespace {

void feed(EdgeSampler& sampler, const Tensors& tensors) {
    expect_rows(tensors.shape(0), sampler.wanted_count(), "tensors at the wanted points");
    nb::gil_scoped_release release;
    sampler.feed([&](std::size_t i) { return tensor_in(tensors, i); });
}

nb::object wanted(const EdgeSampler& sampler) {
    const std::size_t n = sampler.wanted_count();
    return to_numpy(sampler.wanted(), {n, 2});
}

// Straight lines between two points each, to be cut into unit pieces.
EdgeSampler sampler_of(const Points& starts, const Tensors& start_tensors, const Points& ends,
                       const Tensors& end_tensors, double longest_chord) {
    const std::size_t n = starts.shape(0);
    expect_rows(start_tensors.shape(0), n, "start tensors");
    expect_rows(ends.shape(0), n, "ends");
    expect_rows(end_tensors.shape(0), n, "end tensors");
    EdgeSampler sampler(longest_chord, INFINITY, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        sampler.add({starts(i, 0), starts(i, 1)}, tensor_in(start_tensors, i),
                    {ends(i, 0), ends(i, 1)}, tensor_in(end_tensors, i));
    }
    return sampler;
}

// Points that cut every edge into unit pieces, and the edge of each.
nb::tuple cut_to_unit(const EdgeSampler& sampler) {
    std::vector<FieldPoint> cuts;
    std::vector<double> points;
    std::vector<Index> edges;
    for (Index e = 0; e < sampler.edge_count(); ++e) {
        cuts.clear();
        sampler.cut(e, Index(unit_parts(sampler.lengths()[e])), cuts);
        for (const FieldPoint& p : cuts) points.push_back(p.at.x), points.push_back(p.at.y);
        edges.insert(edges.end(), cuts.size(), e);
    }
    const std::size_t n = edges.size();
    return nb::make_tuple(to_numpy(std::move(points), {n, 2}), to_numpy(std::move(edges), {n}));
}

}  // namespace

void bind_sampler(nb::module_& m) {
    nb::class_<EdgeSampler>(m, "EdgeSampler",
                            "Measures edges by asking for the metric, and cuts them.")
        .def("wanted", &wanted, "Points (n, 2) where the metric is wanted next; none: done.")
        .def("feed", &feed, nb::arg("tensors"), "The metric (n, 3) at the wanted points.")
        .def("lengths",
             [](const EdgeSampler& s) {
                 auto lengths = s.lengths();
                 const std::size_t n = lengths.size();
                 return to_numpy(std::move(lengths), {n});
             })
        .def("cut", &cut_to_unit,
             "Points that cut the edges into unit pieces, the edge of each, the parts of each "
             "edge.");
    m.def("edge_sampler", &sampler_of, nb::arg("starts"), nb::arg("start_tensors"), nb::arg("ends"),
          nb::arg("end_tensors"), nb::arg("longest_chord"));
}
