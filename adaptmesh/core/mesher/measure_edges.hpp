// Metric lengths of the edges of a mesh that have changed, measured with the exact metric.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/edge_sampler.hpp"
#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"

namespace adaptmesh {

// Chords of interior edges may be so long: there are many edges, crossing each other, and new ones
// in each round.
constexpr double LONGEST_CHORD = 4.0;

// Edges of a mesh, and what was measured of them.
struct MeasuredEdges {
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

// Calls visit(a, b) for the interior edges that appeared since the last call, and forgets that they
// did. An edge is new only if both its triangles are.
template <typename Visit>
void for_each_changed_edge(MetricMesh& mesh, const Visit& visit) {
    auto& triangles = mesh.topology.triangles;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (!(triangles[t].pending & TO_MEASURE) || mesh.topology.is_dead(t)) continue;
        for (int slot = 0; slot < 3; ++slot) {
            const Index across = triangles[t].n[slot];
            if (is_locked(across) || triangle_of(across) > t) continue;  // each edge is met twice
            if (!(triangles[triangle_of(across)].pending & TO_MEASURE)) continue;
            visit(triangles[t].v[next(slot)], triangles[t].v[prev(slot)]);
        }
    }
    for (Triangle& t : triangles) t.pending &= ~TO_MEASURE;
}

// Lets the mesh know the measured length of an edge, or the lengths of all.
void note_length(MetricMesh& mesh, Index a, Index b, double length);
void note_lengths(MetricMesh& mesh, const MeasuredEdges& edges);

// Measures the edges that have changed, those aside that are well within unit by their ends where
// these have told the truth of every edge; roughly, if they are far from unit.
void measure_changed_edges(MetricMesh& mesh, const MetricField& metric);

// Evaluates the metric at the vertices that have an interpolated one.
void evaluate_interpolated(MetricMesh& mesh, const MetricField& metric);

}  // namespace adaptmesh
