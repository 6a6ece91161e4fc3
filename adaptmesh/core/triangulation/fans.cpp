#include "adaptmesh/core/triangulation/fans.hpp"

#include <algorithm>
#include <vector>

#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

Fans::Fans(Triangulation& mesh) {
    std::vector<char> has_fan(mesh.vertex_count(), false);
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
        for (int slot = 0; slot < 3; ++slot) {
            // The border edge from v on, whose triangle is on its left, begins a fan of v.
            if (mesh.triangles[t].n[slot] != NONE) continue;
            const Index v = mesh.triangles[t].v[next(slot)];
            if (v >= Index(has_fan.size())) continue;  // a copy already
            if (has_fan[v]) {
                copies_.push_back({mesh.move_fan({t, next(slot)}), v});
            } else {
                has_fan[v] = true;
                mesh.set_triangle_at(v, t);
            }
        }
    }
    std::stable_sort(copies_.begin(), copies_.end(),
                     [](const Copy& c, const Copy& d) { return c.original < d.original; });
}

Place Fans::find_edge(const Triangulation& mesh, Index a, Index b) const {
    const Place place = mesh.find_edge(a, b);
    if (place.triangle != NONE || copies_.empty()) return place;
    for (Index from : all_of(a)) {
        for (Index to : all_of(b)) {
            const Place other = mesh.find_edge(from, to);
            if (other.triangle != NONE) return other;
        }
    }
    return place;
}

std::vector<Index> Fans::all_of(Index v) const {
    std::vector<Index> out = {v};
    const auto is_before = [](const Copy& c, Index original) { return c.original < original; };
    auto c = std::lower_bound(copies_.begin(), copies_.end(), v, is_before);
    for (; c != copies_.end() && c->original == v; ++c) out.push_back(c->vertex);
    return out;
}

}  // namespace adaptmesh
