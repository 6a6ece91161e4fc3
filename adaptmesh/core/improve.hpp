// Passes over what is not yet unit: collapse short edges, split long ones, search better places for
// the vertices of what remains.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "adaptmesh/core/collapse.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/smooth.hpp"
#include "adaptmesh/core/split.hpp"
#include "adaptmesh/core/swap.hpp"

namespace adaptmesh {

// An interior edge by its ends; they outlive the triangles beside it.
struct MeasuredEdge {
    double length;
    Index a, b;
};

// The interior edges of triangles to improve, whose length `wanted` takes.
template <typename Wanted>
std::vector<MeasuredEdge> edges_with_length(const MetricMesh& mesh, const Wanted& wanted) {
    std::vector<MeasuredEdge> out;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        const Triangle& T = mesh.triangle(t);
        if (!(T.fresh & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        for (int slot = 0; slot < 3; ++slot) {
            if (is_locked(T.n[slot])) continue;
            const Index across = triangle_of(T.n[slot]);  // sees the edge too if it is to improve
            if (across > t && (mesh.triangle(across).fresh & TO_IMPROVE)) continue;
            const Index a = T.v[next(slot)], b = T.v[prev(slot)];
            const double length = mesh.length(a, b);
            if (wanted(length)) out.push_back({length, a, b});
        }
    }
    return out;
}

// Shortest first; returns how many vertices vanished.
template <typename Poll>
Index collapse_short_edges(MetricMesh& mesh, const CollapseOptions& options, Poll& poll) {
    auto edges = edges_with_length(mesh, [&](double l) { return l < SHORTEST_UNIT; });
    std::sort(edges.begin(), edges.end(), [](auto& e, auto& f) { return e.length < f.length; });
    Collapser collapser(mesh, options);
    Index collapsed = 0, tried = 0;
    for (const MeasuredEdge& e : edges) {
        if (++tried % 1024 == 0) poll();
        if (mesh.topology.triangle_at(e.a) == NONE || mesh.topology.triangle_at(e.b) == NONE)
            continue;
        if (mesh.topology.find_edge(e.a, e.b).triangle == NONE) continue;
        collapsed += collapser.try_collapse(e.a, e.b) || collapser.try_collapse(e.b, e.a);
    }
    return collapsed;
}

// Longest first; returns how many vertices were added.
template <typename Poll>
Index split_long_edges(MetricMesh& mesh, const SplitOptions& options, Poll& poll) {
    auto edges = edges_with_length(mesh, [&](double l) { return l > LONGEST_UNIT; });
    std::sort(edges.begin(), edges.end(), [](auto& e, auto& f) { return e.length > f.length; });
    Splitter splitter(mesh, options);
    Index split = 0, tried = 0;
    for (const MeasuredEdge& e : edges) {
        if (++tried % 1024 == 0) poll();
        const Place place = mesh.topology.find_edge(e.a, e.b);
        if (place.triangle != NONE) split += splitter.try_split(place, e.length);
    }
    return split;
}

// What counts as nearly unit: vertices that touch only such edges and triangles are left alone.
struct ActiveBand {
    double shortest = 0.8;
    double longest = 1.25;
    double least_quality = 0.6;
};

// The active vertices around which something has changed since the last call.
inline std::vector<Index> take_active_vertices(MetricMesh& mesh, const ActiveBand& band) {
    std::vector<char> is_active(mesh.vertices.size(), 0);
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        Triangle& T = mesh.topology.triangles[t];
        if (!(T.fresh & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        T.fresh &= ~TO_IMPROVE;
        bool active = mesh.quality(t) < band.least_quality;
        for (int slot = 0; slot < 3 && !active; ++slot) {
            const double length = mesh.length(T.v[next(slot)], T.v[prev(slot)]);
            active = length < band.shortest || length > band.longest;
        }
        if (active) is_active[T.v[0]] = is_active[T.v[1]] = is_active[T.v[2]] = 1;
    }
    std::vector<Index> out;
    for (Index v = 0; v < Index(is_active.size()); ++v) {
        if (is_active[v]) out.push_back(v);
    }
    return out;
}

template <typename Poll>
Index search_active(MetricMesh& mesh, const ActiveBand& band, double step, Poll& poll) {
    const std::vector<Index> active = take_active_vertices(mesh, band);
    Smoother smoother(mesh);
    Index moved = 0;
    for (std::size_t i = 0; i < active.size(); ++i) {
        if (i % 1024 == 0) poll();
        moved += smoother.search_around(active[i], step);
    }
    return moved;
}

}  // namespace adaptmesh
