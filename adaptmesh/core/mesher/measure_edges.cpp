#include "adaptmesh/core/mesher/measure_edges.hpp"

#include <algorithm>
#include <cmath>

namespace adaptmesh {

namespace {

// Closed-form lengths that are right to this share are left as they are.
constexpr double WORTH_CORRECTING = 0.01;

// Edges within these lengths are well within unit.
constexpr double SHORTEST_KNOWN = 0.85, LONGEST_KNOWN = 1.2;

bool is_known(const MetricMesh& mesh, Index a, Index b) {
    if (mesh.corrections.any_at(a) || mesh.corrections.any_at(b)) return false;
    const double length = MetricMesh::length(mesh.vertices[a], mesh.vertices[b]);
    return length > SHORTEST_KNOWN && length < LONGEST_KNOWN;
}

}  // namespace

void note_length(MetricMesh& mesh, Index a, Index b, double length) {
    const double ratio = length / MetricMesh::length(mesh.vertices[a], mesh.vertices[b]);
    if (std::abs(ratio - 1) > WORTH_CORRECTING || mesh.corrections.knows(a, b))
        mesh.corrections.set(a, b, ratio);
}

void note_lengths(MetricMesh& mesh, const MeasuredEdges& edges) {
    for (std::size_t i = 0; i < edges.a.size(); ++i)
        note_length(mesh, edges.a[i], edges.b[i], edges.sampler.lengths()[i]);
}

void measure_changed_edges(MetricMesh& mesh, const MetricField& metric) {
    MeasuredEdges edges{EdgeSampler(LONGEST_CHORD, LONGEST_CHORD, INFINITY), {}, {}};
    for_each_changed_edge(mesh, [&](Index a, Index b) {
        if (!is_known(mesh, a, b)) edges.add(mesh, a, b);
    });
    edges.sampler.measure(metric);
    note_lengths(mesh, edges);
}

void evaluate_interpolated(MetricMesh& mesh, const MetricField& metric) {
    std::vector<Index>& vertices = mesh.interpolated;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Point> points;
    for (Index v : vertices) points.push_back(mesh.at(v));
    const std::vector<Tensor> tensors = evaluate(metric, points);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Vertex& v = mesh.vertices[vertices[i]];
        v = Vertex::make(v.at, tensors[i], v.held_by);
    }
    vertices.clear();
}

}  // namespace adaptmesh
