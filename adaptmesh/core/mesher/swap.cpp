#include "adaptmesh/core/mesher/swap.hpp"

#include <algorithm>

namespace adaptmesh {

namespace {

// Anisotropic Delaunay: the edge goes if d lies inside the circle of (a, b, c) in the metric of the
// quadrilateral, the sum of those of its vertices (Borouchaki and George 1997 weigh the circles of
// the vertices one by one; the sign for their sum costs a fraction and meshes alike).
struct DelaunayCriterion {
    // In-circle values within this share of the rounding-free zero are ties: never flipped, so two
    // edges that are equally good do not change places for ever.
    static constexpr double MARGIN = 1e-9;

    static bool wants_flip(const MetricMesh& mesh, const Quad& q) {
        const Vertex &a = mesh.vertices[q.a], &b = mesh.vertices[q.b];
        const Vertex &c = mesh.vertices[q.c], &d = mesh.vertices[q.d];
        const Tensor sum = (a.metric + b.metric) + (c.metric + d.metric);
        return MetricMesh::in_circle(sum, a.at, b.at, c.at, d.at, MARGIN);
    }
};

// The worst of the two triangles gets better.
struct QualityCriterion {
    static constexpr double GAIN = 1.001;
    double only_below = 1.0;  // edges whose triangles are better than this are left alone

    bool wants_flip(const MetricMesh& mesh, const Quad& q) const {
        const Vertex &a = mesh.vertices[q.a], &b = mesh.vertices[q.b];
        const Vertex &c = mesh.vertices[q.c], &d = mesh.vertices[q.d];
        const double now = std::min(MetricMesh::quality(a, b, c), MetricMesh::quality(d, c, b));
        if (now >= only_below) return false;
        const double then = std::min(MetricMesh::quality(a, b, d), MetricMesh::quality(d, c, a));
        return then > 0 && then > GAIN * now;
    }
};

// Flips the edge if the criterion wants it and it can be done.
template <typename Criterion>
bool try_flip(MetricMesh& mesh, Place edge, const Criterion& criterion) {
    if (is_locked(mesh.triangle(edge.triangle).n[edge.slot])) return false;
    const Quad q = quad_around(mesh.topology, edge);
    if (!criterion.wants_flip(mesh, q)) return false;
    if (!mesh.is_positive(q.a, q.b, q.d) || !mesh.is_positive(q.d, q.c, q.a)) return false;
    mesh.topology.flip(edge);
    return true;
}

// Whether the triangle across an edge of t is yet to be looked at in this pass, and the edge then.
bool comes_later(const Triangulation& topology, Index t, int slot) {
    const Index across = topology.triangles[t].n[slot];
    if (is_locked(across) || triangle_of(across) < t) return false;
    return topology.triangles[triangle_of(across)].pending & TO_SWAP;
}

// Flips the edges of changed triangles, and of those that the flips change, until (nearly) nothing
// changes.
template <typename Criterion>
void swap_changed(MetricMesh& mesh, const Criterion& criterion, int max_passes, Monitor& monitor) {
    for (int pass = 0; pass < max_passes; ++pass) {
        Index flips = 0;
        const Index n = mesh.topology.triangle_count();
        for (Index t = 0; t < n; ++t) {
            monitor.poll(t);
            Triangle& T = mesh.topology.triangles[t];
            if (!(T.pending & TO_SWAP) || mesh.topology.is_dead(t)) continue;
            T.pending &= ~TO_SWAP;
            // The slots of t mean other edges after a flip, which marks it for the next pass.
            for (int slot = 0; slot < 3; ++slot) {
                if (comes_later(mesh.topology, t, slot)) continue;
                if (try_flip(mesh, {t, slot}, criterion)) {
                    ++flips;
                    break;
                }
            }
        }
        if (flips <= n / 1000) break;
    }
}

}  // namespace

void legalise_around(MetricMesh& mesh, Index p, std::vector<Index>& around) {
    // With a metric that changes from point to point the flips need not come to an end by
    // themselves; far above what an insertion ever takes (about six).
    constexpr int MOST_FLIPS = 1000;
    int flips = 0;
    while (!around.empty()) {
        const Index t = around.back();
        around.pop_back();
        const int slot = mesh.triangle(t).slot_of_vertex(p);
        if (flips >= MOST_FLIPS || mesh.triangle(t).v[slot] != p) continue;
        const Index u = triangle_of(mesh.triangle(t).n[slot]);
        if (!try_flip(mesh, {t, slot}, DelaunayCriterion{})) continue;
        ++flips;
        around.push_back(t);
        around.push_back(u);
    }
}

Index put_on_edge(MetricMesh& mesh, Place edge, const Vertex& vertex, std::vector<Index>& around) {
    const Index across = mesh.triangle(edge.triangle).n[edge.slot];
    const Index v = mesh.add_vertex(vertex);
    const auto added = mesh.topology.split_edge(edge, v);
    around.assign({edge.triangle, added[0]});
    if (across != NONE) around.insert(around.end(), {triangle_of(across), added[1]});
    legalise_around(mesh, v, around);
    return v;
}

void swap_to_delaunay(MetricMesh& mesh, int max_passes, Monitor& monitor) {
    swap_changed(mesh, DelaunayCriterion{}, max_passes, monitor);
}

void swap_for_quality(MetricMesh& mesh, double below, Monitor& monitor) {
    constexpr int MAX_PASSES = 3;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (!mesh.topology.is_dead(t) && mesh.quality(t) < below)
            mesh.topology.triangles[t].pending |= TO_SWAP;
    }
    swap_changed(mesh, QualityCriterion{below}, MAX_PASSES, monitor);
}

}  // namespace adaptmesh
