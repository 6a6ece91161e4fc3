// What cleans outlines, as Python sees it.
#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/decimate.hpp"
#include "adaptmesh/core/encounters.hpp"

namespace {

using namespace adaptmesh;

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
        PythonMonitor monitor;
        nb::gil_scoped_release release;
        decimation.run(monitor);
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

nb::object to_pairs(const std::vector<IndexPair>& pairs) {
    std::vector<std::int32_t> flat;
    flat.reserve(2 * pairs.size());
    for (auto [i, j] : pairs) flat.push_back(i), flat.push_back(j);
    return to_numpy(std::move(flat), {pairs.size(), 2});
}

nb::tuple encounters_arrays(const Points& points_in, const IndexPairs& segments_in,
                            const Flags& is_unseen, double tolerance, std::size_t most) {
    const std::vector<Point> points = to_points(points_in);
    const std::vector<Segment> segments = to_segments(segments_in);
    Encounters encounters(points, segments, tolerance);
    {
        PythonMonitor monitor;
        nb::gil_scoped_release release;
        encounters.find(is_unseen.data(), most, monitor);
    }
    return nb::make_tuple(to_pairs(encounters.near()), to_pairs(encounters.crossings()));
}

}  // namespace

void bind_outlines(nb::module_& m) {
    m.def(
        "encounters", &encounters_arrays, nb::arg("points"), nb::arg("segments"),
        nb::arg("is_unseen"), nb::arg("tolerance"), nb::arg("most_crossings"),
        "(near, crossings): pairs (segment, point) where the point divides the segment, as far as "
        "the tolerance goes; and pairs of segments that cross, by exact signs. Only pairs of "
        "which one is unseen are compared; a few more than `most_crossings` at most are found.");
    m.def("decimate", &decimate_arrays, nb::arg("points"), nb::arg("tensors"), nb::arg("edges"),
          nb::arg("kind"), nb::arg("share"),
          "(edges, source, passed, starts): the edges that are left, the first of those that each "
          "replaces, and the points that edge e passes by, passed[starts[e]:starts[e + 1]].");
}
