#include "adaptmesh/core/mesher/passes.hpp"

#include <algorithm>
#include <vector>

#include "adaptmesh/core/mesher/collapse.hpp"
#include "adaptmesh/core/mesher/smooth.hpp"
#include "adaptmesh/core/mesher/split.hpp"

namespace adaptmesh {

namespace {

// An interior edge by its ends; they outlive the triangles beside it.
struct MeasuredEdge {
    double length;
    Index a, b;
};

// The interior edges of triangles to improve, whose length is chosen.
template <typename IsChosen>
std::vector<MeasuredEdge> edges_with_length(const MetricMesh& mesh, const IsChosen& is_chosen) {
    std::vector<MeasuredEdge> out;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        const Triangle& T = mesh.triangle(t);
        if (!(T.pending & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        for (int slot = 0; slot < 3; ++slot) {
            if (is_locked(T.n[slot])) continue;
            const Index across = triangle_of(T.n[slot]);  // sees the edge too if it is to improve
            if (across > t && (mesh.triangle(across).pending & TO_IMPROVE)) continue;
            const Index a = T.v[next(slot)], b = T.v[prev(slot)];
            const double length = mesh.length(a, b);
            if (is_chosen(length)) out.push_back({length, a, b});
        }
    }
    return out;
}

// Vertices that touch what is outside the band, around which something has changed.
std::vector<Index> take_vertices_outside(MetricMesh& mesh, const Band& band) {
    std::vector<char> is_outside(mesh.vertices.size(), 0);
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        Triangle& T = mesh.topology.triangles[t];
        if (!(T.pending & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        T.pending &= ~TO_IMPROVE;
        bool outside = mesh.quality(t) < band.min_quality;
        for (int slot = 0; slot < 3 && !outside; ++slot) {
            const double length = mesh.length(T.v[next(slot)], T.v[prev(slot)]);
            outside = length < band.shortest || length > band.longest;
        }
        if (outside) is_outside[T.v[0]] = is_outside[T.v[1]] = is_outside[T.v[2]] = 1;
    }
    std::vector<Index> out;
    for (Index v = 0; v < Index(is_outside.size()); ++v) {
        if (is_outside[v]) out.push_back(v);
    }
    return out;
}

}  // namespace

Index collapse_short_edges(MetricMesh& mesh, Monitor& monitor) {
    auto edges = edges_with_length(mesh, [&](double l) { return l < SHORTEST_UNIT; });
    std::sort(edges.begin(), edges.end(), [](auto& e, auto& f) { return e.length < f.length; });
    Collapser collapser(mesh);
    Index collapsed = 0, tried = 0;
    for (const MeasuredEdge& e : edges) {
        monitor.poll(++tried);
        if (mesh.topology.triangle_at(e.a) == NONE || mesh.topology.triangle_at(e.b) == NONE)
            continue;
        if (mesh.topology.find_edge(e.a, e.b).triangle == NONE) continue;
        collapsed += collapser.try_collapse(e.a, e.b) || collapser.try_collapse(e.b, e.a);
    }
    return collapsed;
}

Index split_long_edges(MetricMesh& mesh, Monitor& monitor) {
    auto edges = edges_with_length(mesh, [&](double l) { return l > LONGEST_UNIT; });
    std::sort(edges.begin(), edges.end(), [](auto& e, auto& f) { return e.length > f.length; });
    Splitter splitter(mesh);
    Index split = 0, tried = 0;
    for (const MeasuredEdge& e : edges) {
        monitor.poll(++tried);
        const Place place = mesh.topology.find_edge(e.a, e.b);
        if (place.triangle != NONE) split += splitter.try_split(place, e.length);
    }
    return split;
}

Index search_outside(const Band& band, MetricMesh& mesh, double step, Monitor& monitor) {
    return search_around(mesh, take_vertices_outside(mesh, band), step, monitor);
}

}  // namespace adaptmesh
