// Where in a triangulation is a point? By walking towards it.
#pragma once

#include <cstdint>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

enum class Where { in_triangle, on_edge, on_vertex, outside };

// `slot` is that of the edge or vertex of `triangle` the point is on. Outside: the way from
// `triangle` to the point leads out over the wall at edge `slot`.
struct Location {
    Where where;
    Index triangle;
    int slot;

    Place place() const { return {triangle, slot}; }
};

// What a walk does not cross: the end of the triangulation (no neighbour, or a ghost), and, if
// asked, the locked edges.
enum class Walls { border, locked_edges };

namespace detail {

// The walk through triangles, as a coin: which of the edges to try first. Walks that always prefer
// the same edge can circle for ever in a triangulation that is not Delaunay; a walk that tosses
// leaves every circle in the end (Devillers, Pion, Teillaud 2002). Same seed, same way.
class Coin {
  public:
    int toss() {
        state_ = state_ * 1664525u + 1013904223u;
        return int(state_ >> 31);
    }

  private:
    std::uint32_t state_ = 1;
};

inline bool is_wall(const Triangulation& mesh, Index code, Walls walls) {
    if (code == NONE || (walls == Walls::locked_edges && is_locked(code))) return true;
    return mesh.triangles[triangle_of(code)].v[slot_of(code)] == GHOST;
}

// The point is in or on triangle t; its sides with respect to the edges tell on what.
inline Location within(Index t, const int (&side)[3]) {
    for (int i = 0; i < 3; ++i) {
        if (side[next(i)] == 0 && side[prev(i)] == 0) return {Where::on_vertex, t, i};
    }
    for (int i = 0; i < 3; ++i) {
        if (side[i] == 0) return {Where::on_edge, t, i};
    }
    return {Where::in_triangle, t, 0};
}

template <typename At>
int side_of_edge(const Triangle& T, int slot, const At& at, Point p) {
    return orient2d(at(T.v[next(slot)]), at(T.v[prev(slot)]), p);
}

// Every triangle looked at, for the walk that lost its way.
template <typename At>
Location locate_by_search(const Triangulation& mesh, const At& at, Point p, Location lost) {
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& T = mesh.triangles[t];
        if (T.v[0] == GHOST || T.v[1] == GHOST || T.v[2] == GHOST) continue;
        int side[3];
        for (int i = 0; i < 3; ++i) side[i] = side_of_edge(T, i, at, p);
        if (side[0] >= 0 && side[1] >= 0 && side[2] >= 0) return within(t, side);
    }
    return lost;
}

}  // namespace detail

// Walks from triangle `start` to the point p, from each triangle over an edge that has p strictly
// beyond it. at(v) is the Point of vertex v. In a domain that is not convex, `outside` says that
// the walk met a wall with p beyond it, not that p is in no triangle at all.
template <typename At>
Location locate(const Triangulation& mesh, const At& at, Point p, Index start,
                Walls walls = Walls::border) {
    Index t = start;
    for (int i = 0; i < 3; ++i) {  // step in from a ghost
        if (mesh.triangles[start].v[i] == GHOST) t = triangle_of(mesh.triangles[start].n[i]);
    }
    detail::Coin coin;
    int entered = NONE;  // the edge we came over: p is on this side of it
    int wall = NONE;
    for (Index steps = 0; steps <= mesh.triangle_count(); ++steps) {
        const Triangle& T = mesh.triangles[t];
        int side[3] = {1, 1, 1};
        const int first = entered != NONE ? entered : 0;
        const int turn = 1 + coin.toss();  // the other two edges in either order
        Index way = NONE;
        wall = NONE;
        for (int k = 0, i = first; k < 3; ++k, i = (i + turn) % 3) {
            if (i == entered) continue;
            side[i] = detail::side_of_edge(T, i, at, p);
            if (side[i] >= 0) continue;
            if (detail::is_wall(mesh, T.n[i], walls)) {
                wall = i;
            } else {
                way = T.n[i];
                break;
            }
        }
        if (way != NONE) {
            t = triangle_of(way);
            entered = slot_of(way);
        } else if (wall != NONE) {
            return {Where::outside, t, wall};
        } else {
            return detail::within(t, side);
        }
    }
    return detail::locate_by_search(mesh, at, p, {Where::outside, t, wall});
}

}  // namespace adaptmesh
