// Vertices where parts of a triangulation touch, taken apart: each fan of triangles gets its own.
//
//      \ fan /                  \ fan /
//       \   /                    \   /
//        \ /                      \ /
//     ----v----        ->          v          v keeps one fan, w is a copy of it with the other
//        / \                       w
//       /   \                     / \         .
//      / fan \                   / fan \      .
//
// Whoever turns around a vertex then meets all of its triangles, and every edge can be found.
#pragma once

#include <algorithm>
#include <vector>

#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

class Fans {
  public:
    struct Copy {
        Index vertex, original;
    };

    Fans() = default;

    // Takes the fans of a triangulation without ghosts apart. Copies are the last vertices.
    explicit Fans(Triangulation& mesh) {
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

    // By their originals.
    const std::vector<Copy>& copies() const { return copies_; }

    // As Triangulation::find_edge, for vertices that may have copies.
    Place find_edge(const Triangulation& mesh, Index a, Index b) const {
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

  private:
    // A vertex and its copies.
    std::vector<Index> all_of(Index v) const {
        std::vector<Index> out = {v};
        const auto is_before = [](const Copy& c, Index original) { return c.original < original; };
        auto c = std::lower_bound(copies_.begin(), copies_.end(), v, is_before);
        for (; c != copies_.end() && c->original == v; ++c) out.push_back(c->vertex);
        return out;
    }

    std::vector<Copy> copies_;
};

}  // namespace adaptmesh
