// A mesh as arrays for Python.
#pragma once

#include "adaptmesh/core/bindings/arrays.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"

// (points, triangles, labels, constrained edges, their segments) of a mesh that is compact.
inline auto arrays_of(const adaptmesh::MetricMesh& mesh) {
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
    return std::make_tuple(rows(points), rows<3>(std::move(corners)), column(std::move(labels)),
                           rows<2>(std::move(edges)), column(std::move(segments)));
}
