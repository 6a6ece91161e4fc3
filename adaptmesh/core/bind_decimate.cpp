// Points left out of chains of edges, as Python sees it.
#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/decimate.hpp"

namespace {

using namespace adaptmesh;

std::vector<PackedTensor> to_tensors(const Tensors& array) {
    std::vector<PackedTensor> tensors(array.shape(0));
    for (std::size_t i = 0; i < tensors.size(); ++i)
        tensors[i] = {array(i, 0), array(i, 1), array(i, 2)};
    return tensors;
}

nb::tuple decimate_arrays(const Points& points, const Tensors& tensors, const IndexPairs& ends,
                          const Indices& kind, double share) {
    std::vector<ChainEdge> edges(ends.shape(0));
    for (std::size_t e = 0; e < edges.size(); ++e) {
        edges[e].from = ends(e, 0);
        edges[e].to = ends(e, 1);
        edges[e].kind = kind(e);
    }
    std::vector<std::int32_t> left, source, passed;
    std::vector<std::int64_t> starts{0};
    {
        Decimation decimation(to_points(points), to_tensors(tensors), std::move(edges), share);
        nb::gil_scoped_release release;
        decimation.run(SignalPoll());
        for (std::size_t e = 0; e < decimation.edges().size(); ++e) {
            const ChainEdge& edge = decimation.edges()[e];
            if (!edge.is_left) continue;
            left.insert(left.end(), {edge.from, edge.to});
            source.push_back(std::int32_t(e));
            decimation.for_passed(edge, [&](std::int32_t v) { passed.push_back(v); });
            starts.push_back(std::int64_t(passed.size()));
        }
    }
    const std::size_t n = source.size(), m = passed.size();
    return nb::make_tuple(to_numpy(std::move(left), {n, 2}), to_numpy(std::move(source), {n}),
                          to_numpy(std::move(passed), {m}), to_numpy(std::move(starts), {n + 1}));
}

}  // namespace

void bind_decimate(nb::module_& m) {
    m.def("decimate", &decimate_arrays, nb::arg("points"), nb::arg("tensors"), nb::arg("edges"),
          nb::arg("kind"), nb::arg("share"),
          "(edges, source, passed, starts): the edges that are left, the first of those that each "
          "replaces, and the points that edge e passes by, passed[starts[e]:starts[e + 1]].");
}
