#include "adaptmesh/core/mesher/collapse.hpp"

#include <algorithm>

namespace adaptmesh {

namespace {

constexpr double GOOD_QUALITY = 0.6;  // no new triangle worse than this, unless ...
constexpr double QUALITY_KEPT = 0.6;  // ... this share of the old worst is kept

}  // namespace

bool Collapser::try_collapse(Index from, Index to) {
    if (mesh_.vertices[from].held_by != FREE || !mesh_.topology.ball(from, around_)) return false;
    const Vertex& target = mesh_.vertices[to];
    double worst_old = 1, worst_new = 1;
    for (Place place : around_) {
        const Triangle& T = mesh_.triangle(place.triangle);
        const Index p = T.v[next(place.slot)], q = T.v[prev(place.slot)];
        worst_old = std::min(worst_old, mesh_.quality(place.triangle));
        if (p == to || q == to) continue;
        const double quality = MetricMesh::quality(target, mesh_.vertices[p], mesh_.vertices[q]);
        worst_new = std::min(worst_new, quality);
        if (!mesh_.is_positive(to, p, q)) return false;
        if (inherited_length(from, to, p) > LONGEST_UNIT) return false;
    }
    if (worst_new < GOOD_QUALITY && worst_new < QUALITY_KEPT * worst_old) return false;
    for (Place place : around_) {
        const Index p = mesh_.triangle(place.triangle).v[next(place.slot)];
        if (p != to) mesh_.corrections.set(to, p, mesh_.corrections.of(from, p));
    }
    mesh_.topology.collapse(around_, from, to);
    return true;
}

// The edge to p is corrected like that of the vertex that goes: they are near each other.
double Collapser::inherited_length(Index from, Index to, Index p) const {
    return mesh_.corrections.of(from, p) *
           MetricMesh::length(mesh_.vertices[to], mesh_.vertices[p]);
}

}  // namespace adaptmesh
