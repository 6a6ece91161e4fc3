// Puts one vertex into a (constrained) Delaunay triangulation: split, then flip until Delaunay.
#pragma once

#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

// Is p strictly inside the circumcircle of triangle T? The circle of a ghost triangle is the open
// half plane beyond its hull edge.
template <typename At>
bool conflicts(const Triangle& T, const At& at, Point p) {
    if ((T.v[0] | T.v[1] | T.v[2]) >= 0) return incircle(at(T.v[0]), at(T.v[1]), at(T.v[2]), p) > 0;
    const int ghost = T.slot_of_vertex(GHOST);
    return orient2d(at(T.v[next(ghost)]), at(T.v[prev(ghost)]), p) > 0;
}

// Makes the triangulation Delaunay again after vertex p was put in: `opposite` holds the edges
// opposite p that are in doubt. Each flip brings two new ones:
//
//         c                    c
//        /|\                  / \         Only edges opposite p can be wrong, and each flip
//       / | \                / u \        gives p one more neighbour, so this ends.
//      p t|u d    ->        p-----d
//       \ | /                \ t /
//        \|/                  \ /
//         b                    b
template <typename At>
void legalise(Triangulation& mesh, const At& at, Point p, std::vector<Place>& opposite) {
    while (!opposite.empty()) {
        Place edge = opposite.back();
        opposite.pop_back();
        for (;;) {
            const Index code = mesh.triangles[edge.triangle].n[edge.slot];
            if (is_locked(code)) break;
            const Index u = triangle_of(code);
            if (!conflicts(mesh.triangles[u], at, p)) break;
            mesh.flip(edge);
            opposite.push_back({u, 2});
            edge.slot = 0;  // go on with t, u waits
        }
    }
}

// Puts vertex v at the place that `locate` found for it: not on_vertex, and outside only if there
// are ghosts. Locked edges stay, split if v is on them. `scratch` is empty before and after.
template <typename At>
void insert_vertex(Triangulation& mesh, const At& at, Index v, Location where,
                   std::vector<Place>& scratch) {
    if (where.where == Where::on_edge) {
        const Index across = mesh.triangles[where.triangle].n[where.slot];
        const auto [t2, u2] = mesh.split_edge(where.place(), v);
        scratch.push_back({where.triangle, 2});
        scratch.push_back({t2, 1});
        if (u2 != NONE) {
            scratch.push_back({triangle_of(across), 2});
            scratch.push_back({u2, 1});
        }
    } else {
        Index t = where.triangle;
        if (where.where == Where::outside) t = triangle_of(mesh.triangles[t].n[where.slot]);
        const auto [t1, t2] = mesh.split_triangle(t, v);
        scratch.push_back({t, 0});
        scratch.push_back({t1, 0});
        scratch.push_back({t2, 0});
    }
    legalise(mesh, at, at(v), scratch);
}

}  // namespace adaptmesh
