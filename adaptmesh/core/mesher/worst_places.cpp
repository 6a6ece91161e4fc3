#include "adaptmesh/core/mesher/worst_places.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adaptmesh/core/mesher/star.hpp"

namespace adaptmesh {

namespace {

void add_corners(WorstPlaces& out, const Triangle& t) {
    for (Index v : t.v) out.is_centre[v] = 1;
}

void add_edge(WorstPlaces& out, const MetricMesh& mesh, Place edge) {
    const Index across = mesh.triangle(edge.triangle).n[edge.slot];
    if (is_locked(across)) return;
    out.edges.push_back(std::min(edge_code(edge.triangle, edge.slot), across));
}

WorstPlaces nowhere(const MetricMesh& mesh) {
    return {{}, std::vector<char>(mesh.vertices.size(), 0)};
}

void sort_edges(WorstPlaces& out) {
    std::sort(out.edges.begin(), out.edges.end());
    out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
}

// The quality of a triangle as far as the mesh knows it: with lengths that were measured, and the
// density sqrt(det M) of the corners in the geometric mean. The determinant of their mean metric,
// which is good enough for comparing triangles with each other, is far too large where axes turn
// from corner to corner: a bad triangle would pass for a good one.
double estimated_quality(const MetricMesh& mesh, Index t) {
    const auto& v = mesh.triangle(t).v;
    const double density = std::cbrt(mesh.vertices[v[0]].sqrt_det * mesh.vertices[v[1]].sqrt_det *
                                     mesh.vertices[v[2]].sqrt_det);
    return quality(density * mesh.euclidean_area(t), mesh.length(v[0], v[1]),
                   mesh.length(v[1], v[2]), mesh.length(v[2], v[0]));
}

// Whether estimated_quality can be so low: a quicker look, with the sides in the mean metric of the
// corners, which are not far from their lengths.
bool may_be_below(const MetricMesh& mesh, Index t, double quality) {
    constexpr double SAFETY = 1.5;
    const auto& v = mesh.triangle(t).v;
    const Vertex &a = mesh.vertices[v[0]], &b = mesh.vertices[v[1]], &c = mesh.vertices[v[2]];
    const double ux = b.at.x - a.at.x, uy = b.at.y - a.at.y;
    const double vx = c.at.x - a.at.x, vy = c.at.y - a.at.y;
    const Tensor m = a.metric + b.metric + c.metric;
    const double sides = m.q(ux, uy) + m.q(vx, vy) + m.q(vx - ux, vy - uy);
    const double area = 6 * std::sqrt(3.0) * (ux * vy - uy * vx);
    const double bound = SAFETY * quality * sides;
    return area * area * area * (a.sqrt_det * b.sqrt_det * c.sqrt_det) < bound * bound * bound;
}

}  // namespace

WorstPlaces take_changed_off_unit(MetricMesh& mesh, double min_quality) {
    WorstPlaces out = nowhere(mesh);
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        const Triangle& T = mesh.triangle(t);
        if (!(T.pending & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        const bool is_bad = mesh.quality(t) < min_quality;
        for (int slot = 0; slot < 3; ++slot) {
            const Index across = T.n[slot];
            const bool is_seen = across != NONE && triangle_of(across) < t &&
                                 (mesh.triangle(triangle_of(across)).pending & TO_IMPROVE);
            if (!is_bad && (is_seen || is_unit(mesh.length(T.v[next(slot)], T.v[prev(slot)]))))
                continue;
            add_corners(out, T);
            if (across != NONE)
                out.is_centre[mesh.triangle(triangle_of(across)).v[slot_of(across)]] = 1;
            add_edge(out, mesh, {t, slot});
        }
    }
    for (Triangle& t : mesh.topology.triangles) t.pending &= ~TO_IMPROVE;
    sort_edges(out);
    return out;
}

WorstPlaces take_changed_worst(MetricMesh& mesh, double below, std::size_t max_triangles) {
    constexpr double NOT_MUCH = 0.1;
    std::vector<std::pair<double, Index>> bad;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        Triangle& T = mesh.topology.triangles[t];
        if (!(T.pending & TO_IMPROVE) || mesh.topology.is_dead(t)) continue;
        const double quality = may_be_below(mesh, t, below) ? estimated_quality(mesh, t) : 1.0;
        if (quality < below)
            bad.push_back({quality, t});
        else
            T.pending &= ~TO_IMPROVE;
    }
    std::sort(bad.begin(), bad.end());
    while (!bad.empty() && bad.back().first > bad.front().first + NOT_MUCH) bad.pop_back();
    if (bad.size() > max_triangles) bad.resize(max_triangles);
    for (auto [quality, t] : bad) mesh.topology.triangles[t].pending &= ~TO_IMPROVE;
    WorstPlaces out = nowhere(mesh);
    for (auto [quality, t] : bad) {
        add_corners(out, mesh.triangle(t));
        for (int slot = 0; slot < 3; ++slot) add_edge(out, mesh, {t, slot});
    }
    sort_edges(out);
    return out;
}

}  // namespace adaptmesh
