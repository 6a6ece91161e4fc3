// Field points along edges (Borouchaki and George): every edge longer than unit is cut at equal
// metric shares, and the points that keep their distance from the mesh are put into it.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "adaptmesh/core/edge_sampler.hpp"
#include "adaptmesh/core/hilbert.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/point_inserter.hpp"

namespace adaptmesh {

// Closed-form lengths that are right to this share are left as they are.
constexpr double WORTH_CORRECTING = 0.01;

// Of interior edges: there are many, crossing each other, and new ones in each sweep.
constexpr double LONGEST_CHORD = 4.0;

// Longer ones are cut into about so many parts, and what is left of them in the next sweep.
constexpr double LONGEST_EDGE = 16;

// Edges within these lengths are well within unit; see is_known.
constexpr double SHORTEST_KNOWN = 0.85;
constexpr double LONGEST_KNOWN = 1.2;

// Edges handed out for measuring.
struct EdgesToMeasure {
    EdgeSampler sampler;
    std::vector<Index> a, b;  // their ends

    void reserve(std::size_t n) { sampler.reserve(n), a.reserve(n), b.reserve(n); }

    void add(const MetricMesh& mesh, Index start, Index end) {
        a.push_back(start);
        b.push_back(end);
        const Vertex &from = mesh.vertices[start], &to = mesh.vertices[end];
        sampler.add(from.at, from.metric, to.at, to.metric);
    }
};

// Whether an edge need not be measured (again) because nothing will be decided by it: it is well
// within unit by its ends, and these have told the truth of every edge that was measured there.
inline bool is_known(const MetricMesh& mesh, Index a, Index b) {
    if (mesh.corrections.any_at(a) || mesh.corrections.any_at(b)) return false;
    const double length = MetricMesh::length(mesh.vertices[a], mesh.vertices[b]);
    return length > SHORTEST_KNOWN && length < LONGEST_KNOWN;
}

// The interior edges that appeared since the last call. With `to_cut` all, and they can be cut from
// that length on; without, those that are not known, only to be measured, and roughly if they are
// far from unit.
inline EdgesToMeasure take_fresh_edges(MetricMesh& mesh, double to_cut) {
    const bool can_be_cut = to_cut < INFINITY;
    const double longest = can_be_cut ? LONGEST_EDGE : LONGEST_CHORD;
    EdgesToMeasure out{EdgeSampler(LONGEST_CHORD, longest, to_cut), {}, {}};
    auto& triangles = mesh.topology.triangles;
    if (can_be_cut) {
        const auto fresh = std::count_if(triangles.begin(), triangles.end(),
                                         [](const Triangle& t) { return t.fresh & TO_MEASURE; });
        out.reserve(3 * std::size_t(fresh) / 2);
    }
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (!(triangles[t].fresh & TO_MEASURE) || mesh.topology.is_dead(t)) continue;
        for (int slot = 0; slot < 3; ++slot) {
            const Index across = triangles[t].n[slot];
            // An edge is new only if both its triangles are; each edge is met twice.
            if (is_locked(across) || triangle_of(across) > t) continue;
            if (!(triangles[triangle_of(across)].fresh & TO_MEASURE)) continue;
            const Index a = triangles[t].v[next(slot)], b = triangles[t].v[prev(slot)];
            if (can_be_cut || !is_known(mesh, a, b)) out.add(mesh, a, b);
        }
    }
    for (Triangle& t : triangles) t.fresh &= ~TO_MEASURE;
    return out;
}

// Lets the mesh know the measured length of an edge.
inline void note_length(MetricMesh& mesh, Index a, Index b, double length) {
    const double ratio = length / MetricMesh::length(mesh.vertices[a], mesh.vertices[b]);
    if (std::abs(ratio - 1) > WORTH_CORRECTING || mesh.corrections.knows(a, b))
        mesh.corrections.set(a, b, ratio);
}

inline void correct_lengths(MetricMesh& mesh, const EdgesToMeasure& edges) {
    for (std::size_t i = 0; i < edges.a.size(); ++i)
        note_length(mesh, edges.a[i], edges.b[i], edges.sampler.lengths()[i]);
}

// Puts points into the mesh where their metric is far finer than the triangle they lie in knows:
// features that no edge has met. Returns how many it took.
template <typename TensorAt, typename Poll>
Index insert_where_finer(MetricMesh& mesh, const std::vector<Point>& points, TensorAt&& tensor_at,
                         double ratio, double spacing, Poll& poll) {
    PointInserter inserter(mesh, spacing);
    Index inserted = 0, tried = 0, near = 0;
    for (Index i : hilbert_order(points)) {
        if (++tried % 1024 == 0) poll();
        const Vertex p = Vertex::make(points[i], tensor_at(i));
        near = locate(mesh.topology, [&](Index v) { return mesh.at(v); }, p.at, near).triangle;
        double known = 0;
        for (Index v : mesh.triangle(near).v) known = std::max(known, mesh.vertices[v].sqrt_det);
        if (p.sqrt_det < ratio * known) continue;
        inserted += inserter.insert(p.at, p.metric, near) == PointInserter::Outcome::inserted;
    }
    return inserted;
}

// Puts field points into the mesh along the measured edges from length `long_edge` on, up to
// `most_vertices` in all; returns how many it took, or NONE if there is no room. An edge that the
// points of others have made vanish is passed over: what took its place is measured in the next
// sweep.
template <typename Poll>
Index insert_along_edges(MetricMesh& mesh, const EdgesToMeasure& edges, double long_edge,
                         double spacing, Index most_vertices, Poll& poll) {
    PointInserter inserter(mesh, spacing);
    std::vector<FieldPoint> points;
    Index inserted = 0;
    for (Index e = 0; e < edges.sampler.edge_count(); ++e) {
        if (e % 1024 == 0) poll();
        const double length = edges.sampler.lengths()[e];
        if (length < long_edge) continue;
        const Place place = mesh.topology.find_edge(edges.a[e], edges.b[e]);
        if (place.triangle == NONE) continue;
        if (mesh.topology.living_vertex_count() >= most_vertices) return NONE;
        points.clear();
        edges.sampler.cut(e, Index(unit_parts(std::min(length, LONGEST_EDGE))), points);
        Index near = place.triangle;
        for (const FieldPoint& p : points) {
            if (inserter.insert(p.at, p.metric, near) != PointInserter::Outcome::inserted) continue;
            mesh.stale.push_back(Index(mesh.vertices.size()) - 1);
            ++inserted;
        }
    }
    return inserted;
}

}  // namespace adaptmesh
