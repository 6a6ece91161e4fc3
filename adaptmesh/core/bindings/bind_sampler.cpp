// Measuring and cutting straight lines by the metric, as Python sees it.
#include <algorithm>
#include <cmath>

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/bindings/callbacks.hpp"
#include "adaptmesh/core/mesher/edge_sampler.hpp"

using namespace adaptmesh;

namespace {

// The metric is looked at this closely along lines of the domain, in metric length: a layer that
// meets the boundary between two looks would be missed there for good.
constexpr double LONGEST_CHORD = 0.125;

void measure_edges(EdgeSampler* self, const Points& points, const Tensors& tensors,
                   const IndexPairs& edges, const nb::callable& metric, Index max_vertices) {
    expect_rows(tensors.shape(0), points.shape(0), "tensors");
    const std::vector<Point> at = to_points(points);
    const std::vector<Tensor> metric_at = to_tensors(tensors);
    const double max_chords =
        std::min(max_vertices * 2 / LONGEST_CHORD, double(EdgeSampler::MAX_CHORDS));
    EdgeSampler sampler(LONGEST_CHORD, INFINITY, 0.0);
    for (std::size_t i = 0; i < edges.shape(0); ++i) {
        const Index a = edges(i, 0), b = edges(i, 1);
        sampler.add(at[a], metric_at[a], at[b], metric_at[b]);
    }
    {
        nb::gil_scoped_release release;
        sampler.measure(metric_of(metric), std::size_t(max_chords));
    }
    new (self) EdgeSampler(std::move(sampler));
}

auto lengths(const EdgeSampler& sampler) {
    std::vector<double> lengths = sampler.lengths();
    return column(std::move(lengths));
}

// What cuts every edge into unit pieces: shares of it from its start, and the edge of each.
auto cut_to_unit(const EdgeSampler& sampler) {
    std::vector<FieldPoint> cuts;
    std::vector<double> shares;
    std::vector<Index> edges;
    for (Index e = 0; e < sampler.edge_count(); ++e) {
        cuts.clear();
        sampler.cut(e, Index(unit_parts(sampler.lengths()[e])), cuts);
        for (const FieldPoint& p : cuts) shares.push_back(p.t);
        edges.insert(edges.end(), cuts.size(), e);
    }
    return std::make_tuple(column(std::move(shares)), column(std::move(edges)));
}

template <int Columns>
using Triples = nb::ndarray<const double, nb::shape<-1, 3, Columns>, nb::c_contig, nb::device::cpu>;

// Exactly, as there are few of them, and metrics along walls are the thinnest.
ChordLength chord_length(const Tensor& from, const Tensor& to, Point v) {
    const double start = metrics::exact_length(from, v.x, v.y);
    const double end = metrics::exact_length(to, v.x, v.y);
    return {metrics::exact_length(from, to, v.x, v.y), length_by_speeds(start, end)};
}

// Chords of curves, by their ends and the points of the curves half way, halved once more.
auto halve_chords(const Triples<2>& points, const Triples<3>& tensors, const Values& lengths,
                  const Flags& by_speeds, int depth) {
    const std::size_t n = points.shape(0);
    expect_rows(tensors.shape(0), n, "tensors");
    expect_rows(lengths.shape(0), n, "lengths");
    expect_rows(by_speeds.shape(0), n, "by_speeds");
    const ChordRule rule{LONGEST_CHORD};
    std::vector<double> halves(2 * n);
    std::vector<std::uint8_t> are_by_speeds(n), are_trusted(n);
    for (std::size_t i = 0; i < n; ++i) {
        const auto length = [&](int from, int to) {
            const auto metric = [&](int k) {
                return Tensor{tensors(i, k, 0), tensors(i, k, 1), tensors(i, k, 2)};
            };
            const Point v{points(i, to, 0) - points(i, from, 0),
                          points(i, to, 1) - points(i, from, 1)};
            return chord_length(metric(from), metric(to), v);
        };
        const Halves h = rule.halve({lengths(i), length(0, 2).by_speeds}, length(0, 1),
                                    length(1, 2), by_speeds(i), depth);
        halves[2 * i] = h.first, halves[2 * i + 1] = h.second;
        are_by_speeds[i] = h.are_by_speeds, are_trusted[i] = h.are_trusted;
    }
    return std::make_tuple(rows<2>(std::move(halves)), flags(std::move(are_by_speeds)),
                           flags(std::move(are_trusted)));
}

}  // namespace

void bind_sampler(nb::module_& m) {
    m.attr("LONGEST_CHORD") = LONGEST_CHORD;
    m.def("halve_chords", &halve_chords, nb::arg("points"), nb::arg("tensors"), nb::arg("lengths"),
          nb::arg("by_speeds"), nb::arg("depth"),
          "Halve chords: the lengths of the halves, whether by speeds, and whether trusted.");
    nb::class_<EdgeSampler>(m, "MeasuredEdges", "Straight edges, measured with the exact metric.")
        .def("__init__", &measure_edges, nb::arg("points"), nb::arg("tensors"), nb::arg("edges"),
             nb::arg("metric"), nb::arg("max_vertices"),
             "Edges (k, 2) between points with these metrics; if they are longer than so many "
             "vertices, by far, that is TooManyVertices.")
        .def("lengths", &lengths)
        .def("cut", &cut_to_unit,
             "What cuts the edges into unit pieces: shares of an edge, and the edge of each.");
}
