// What cleans outlines, as Python sees it.
#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/outline/decimate.hpp"
#include "adaptmesh/core/outline/encounters.hpp"

namespace {

using namespace adaptmesh;

auto to_pairs(const std::vector<IndexPair>& pairs) {
    std::vector<std::int32_t> flat;
    flat.reserve(2 * pairs.size());
    for (auto [i, j] : pairs) flat.push_back(i), flat.push_back(j);
    return rows<2>(std::move(flat));
}

auto decimate_arrays(const Points& points, const Tensors& tensors, const IndexPairs& ends,
                     const Indices& kind, double share) {
    std::vector<ChainEdge> edges(ends.shape(0));
    for (std::size_t e = 0; e < edges.size(); ++e) {
        edges[e].from = ends(e, 0);
        edges[e].to = ends(e, 1);
        edges[e].kind = kind(e);
    }
    Decimated out;
    {
        PythonMonitor monitor;
        std::vector<Point> at = to_points(points);
        std::vector<metrics::Tensor> metric = to_tensors(tensors);
        nb::gil_scoped_release release;
        out = decimate(std::move(at), std::move(metric), std::move(edges), share, monitor);
    }
    return std::make_tuple(to_pairs(out.edges), column(std::move(out.source)),
                           column(std::move(out.passed)), column(std::move(out.starts)));
}

auto encounters_arrays(const Points& points_in, const IndexPairs& segments_in,
                       const Flags& is_unseen, double tolerance, std::size_t max_crossings) {
    const std::vector<Point> points = to_points(points_in);
    const std::vector<Segment> segments = to_segments(segments_in);
    Encounters found;
    {
        PythonMonitor monitor;
        nb::gil_scoped_release release;
        found =
            find_encounters(points, segments, tolerance, is_unseen.data(), max_crossings, monitor);
    }
    return std::make_tuple(to_pairs(found.near), to_pairs(found.crossings));
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
