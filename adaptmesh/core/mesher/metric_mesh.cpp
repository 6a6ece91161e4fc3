#include "adaptmesh/core/mesher/metric_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/mesher/length_corrections.hpp"
#include "adaptmesh/core/triangulation/fans.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

void MetricMesh::take_fans_apart() {
    fans = Fans(topology);
    vertices.resize(topology.vertex_count());
    for (const Fans::Copy& c : fans.copies()) vertices[c.vertex] = vertices[c.original];
}

void MetricMesh::compact() {
    drop_dead_triangles();
    std::vector<Index> original(vertices.size());
    std::iota(original.begin(), original.end(), 0);
    for (const Fans::Copy& c : fans.copies()) {
        original[c.vertex] = c.original;
        if (topology.triangle_at(c.original) == NONE)
            topology.set_triangle_at(c.original, topology.triangle_at(c.vertex));
    }
    std::vector<Index> name(vertices.size(), NONE);
    Index kept = 0;
    for (Index v = 0; v < Index(vertices.size()); ++v) {
        if (topology.triangle_at(v) == NONE) continue;
        if (original[v] != v) {  // a copy, which comes after its original
            name[v] = name[original[v]];
            continue;
        }
        vertices[kept] = vertices[v];
        name[v] = kept++;
    }
    fans = Fans();
    vertices.resize(kept);
    topology.drop_vertices(name, kept);
    for (SubEdge& e : constrained) e.a = name[e.a], e.b = name[e.b];
}

}  // namespace adaptmesh
