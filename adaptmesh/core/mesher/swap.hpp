// Swapping: when to flip an edge of a metric mesh.
//
// A flip is proposed by a criterion and carried out only if both new triangles are positive by
// exact orientation; locked edges are never flipped.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// The four vertices around edge `slot` of a triangle:
//
//         c
//        / \            the edge is (b, c); flipped it becomes (a, d)
//       a   d
//        \ /
//         b
struct Quad {
    Index a, b, c, d;
};

inline Quad quad_around(const Triangulation& topology, Place edge) {
    const Triangle& T = topology.triangles[edge.triangle];
    const Index across = T.n[edge.slot];
    return {T.v[edge.slot], T.v[next(edge.slot)], T.v[prev(edge.slot)],
            topology.triangles[triangle_of(across)].v[slot_of(across)]};
}

// Flips the edges opposite vertex p, which was put into the mesh, and those the flips bring there,
// until they are Delaunay in the metric. `around` holds the triangles of p; it is used up.
void legalise_around(MetricMesh& mesh, Index p, std::vector<Index>& around);

// Puts a vertex on an edge, and flips around it; returns its number. `around` is scratch.
Index put_on_edge(MetricMesh& mesh, Place edge, const Vertex& vertex, std::vector<Index>& around);

// Flips the edges of changed triangles, and of those that the flips change, until (nearly) all are
// Delaunay in the metric.
void swap_to_delaunay(MetricMesh& mesh, int max_passes, Monitor& monitor);

// Flips edges beside triangles of lesser quality than this where the worse of the two gets better.
void swap_for_quality(MetricMesh& mesh, double below, Monitor& monitor);

}  // namespace adaptmesh
