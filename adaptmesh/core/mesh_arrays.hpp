// A mesh as arrays for Python.
#pragma once

#include "adaptmesh/core/bindings.hpp"
#include "adaptmesh/core/metric_mesh.hpp"

// (points, triangles, labels, constrained edges, their segments) of a mesh that is compact.
inline nb::tuple arrays_of(const adaptmesh::MetricMesh& mesh) {
    using adaptmesh::Index;
    std::vector<adaptmesh::Point> points;
    for (const adaptmesh::Vertex& v : mesh.vertices) points.push_back(v.at);
    std::vector<Index> corners, labels, edges, segments;
    for (const adaptmesh::Triangle& t : mesh.topology.triangles) {
        corners.insert(corners.end(), t.v, t.v + 3);
        labels.push_back(t.label);
    }
    for (const adaptmesh::SubEdge& e : mesh.constrained) {
        edges.insert(edges.end(), {e.a, e.b});
        segments.push_back(e.segment);
    }
    const std::size_t m = labels.size(), k = segments.size();
    return nb::make_tuple(to_numpy(points), to_numpy(std::move(corners), {m, 3}),
                          to_numpy(std::move(labels), {m}), to_numpy(std::move(edges), {k, 2}),
                          to_numpy(std::move(segments), {k}));
}
