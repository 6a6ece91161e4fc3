// Topology of a triangulation: triangles, their neighbours, and the moves that change them.
//
// This file knows no coordinates (the predicates decide *whether* to move; this file moves) and it
// is the only writer of adjacency.
//
// Local numbering. Triangle (v0, v1, v2) is counter-clockwise; edge i lies opposite vertex i and
// runs from v[next(i)] to v[prev(i)]; n[i] is the neighbour across it:
//
//                 v2
//                 /\                     .
//          e1   /    \   e0              .
//             /        \                 .
//          v0 ---------- v1
//                 e2
//
// A neighbour is an *edge code*: which triangle, which of its slots, and whether the edge is
// locked (a constraint, never flipped). NONE (-1) is the outside; its lock bit is set, so the
// border of the triangulation counts as locked without being asked about.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace adaptmesh {

using Index = std::int32_t;

constexpr Index NONE = -1;
constexpr Index GHOST = -1;  // the vertex at infinity, while a triangulation has one
constexpr Index DEAD = -2;   // first vertex of a triangle that has vanished

constexpr int next(int i) {
    return i == 2 ? 0 : i + 1;
}
constexpr int prev(int i) {
    return i == 0 ? 2 : i - 1;
}

constexpr Index LOCK_BIT = 4;
constexpr Index edge_code(Index triangle, int slot) {
    return triangle << 3 | slot;
}
constexpr Index triangle_of(Index code) {
    return code >> 3;
}
constexpr int slot_of(Index code) {
    return code & 3;
}
constexpr bool is_locked(Index code) {
    return (code & LOCK_BIT) != 0;
}

// 2^28 triangles: what an edge code of 31 bits can number.
constexpr Index MAX_TRIANGLES = Index(1) << 28;
constexpr Index MAX_VERTICES = MAX_TRIANGLES / 2;

// Every change of a triangle sets all bits of its `pending`; who has looked at it clears its own.
enum Pending : std::uint32_t {
    TO_MEASURE = 1,
    TO_IMPROVE = 2,
    TO_ADVANCE = 4,
    TO_SWAP = 8,
    TO_SMOOTH = 16,
    CHANGED = 31
};

struct Triangle {
    Index v[3];
    Index n[3];
    std::uint32_t stamp : 27;   // visit mark of searches, see Triangulation::new_stamp
    std::uint32_t pending : 5;  // who has not yet seen its last change, see Pending
    Index label;                // region, or a mark of the algorithm at work

    int slot_of_vertex(Index vertex) const { return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2; }
};

// A triangle and the slot in it: of an edge, or of a vertex.
struct Place {
    Index triangle;
    int slot;
};

class Triangulation {
  public:
    std::vector<Triangle> triangles;

    Index triangle_count() const { return Index(triangles.size()); }
    Index vertex_count() const { return Index(triangle_at_.size()) - 1; }
    Index living_vertex_count() const { return vertex_count() - collapsed_; }

    // One triangle that has the vertex (which one is not promised); NONE for a vertex without any.
    Index triangle_at(Index vertex) const { return triangle_at_[vertex + 1]; }
    void set_triangle_at(Index vertex, Index triangle) { triangle_at_[vertex + 1] = triangle; }

    Index add_vertex() {
        triangle_at_.push_back(NONE);
        return vertex_count() - 1;
    }
    void reserve(Index vertices) {
        triangle_at_.reserve(vertices + 1);
        triangles.reserve(2 * std::size_t(vertices) + 2);
    }

    Index add_triangle(Index a, Index b, Index c) {
        triangles.push_back({{a, b, c}, {NONE, NONE, NONE}, 0, CHANGED, 0});
        const Index k = triangle_count() - 1;
        for (Index vertex : {a, b, c}) set_triangle_at(vertex, k);
        return k;
    }

    // Makes `code` the neighbour across edge `slot` of triangle `t`, and back; the lock bit of
    // `code` is kept on both sides.
    void link(Index t, int slot, Index code) {
        triangles[t].n[slot] = code;
        if (code != NONE) {
            triangles[triangle_of(code)].n[slot_of(code)] = edge_code(t, slot) | (code & LOCK_BIT);
        }
    }

    void lock(Place edge) {
        const Index code = triangles[edge.triangle].n[edge.slot];
        if (code != NONE) link(edge.triangle, edge.slot, code | LOCK_BIT);
    }

    // Exchanges the diagonal of the quadrilateral around edge `e` of triangle t.
    //
    //         c                    c
    //        /|\                  / \            t = (a, b, c), u = (d, c, b) become
    //       / | \                / u \           t = (a, b, d), u = (d, c, a);
    //      a t|u d    ->        a-----d          the new edge is slot 1 of both.
    //       \ | /                \ t /
    //        \|/                  \ /
    //         b                    b
    void flip(Place edge) {
        const Index t = edge.triangle;
        Triangle& T = triangles[t];
        const int e = edge.slot;
        const Index u = triangle_of(T.n[e]);
        const int f = slot_of(T.n[e]);
        Triangle& U = triangles[u];

        const Index a = T.v[e], b = T.v[next(e)], c = T.v[prev(e)], d = U.v[f];
        const Index ca = T.n[next(e)], ab = T.n[prev(e)];
        const Index bd = U.n[next(f)], dc = U.n[prev(f)];

        T.v[0] = a, T.v[1] = b, T.v[2] = d;
        U.v[0] = d, U.v[1] = c, U.v[2] = a;
        T.pending = U.pending = CHANGED;
        link(t, 0, bd);
        link(t, 2, ab);
        link(u, 0, ca);
        link(u, 2, dc);
        link(t, 1, edge_code(u, 1));
        set_triangle_at(b, t), set_triangle_at(c, u);  // a and d are in both
    }

    // Puts vertex p strictly inside triangle t:
    //
    //            c
    //           /|\              t = (a, b, c) becomes
    //          / | \             t = (p, b, c), the two new ones are
    //         / .p. \            (p, c, a) and (p, a, b), returned in that order.
    //        /.     .\           Slot 0 of each is the edge opposite p.
    //       a---------b
    std::array<Index, 2> split_triangle(Index t, Index p) {
        const Triangle old = triangles[t];
        const Index a = old.v[0], b = old.v[1], c = old.v[2];
        const Index t1 = add_triangle(p, c, a);
        const Index t2 = add_triangle(p, a, b);
        Triangle& T = triangles[t];
        T.v[0] = p;
        T.pending = CHANGED;
        triangles[t1].label = triangles[t2].label = old.label;
        link(t1, 0, old.n[1]);
        link(t2, 0, old.n[2]);
        link(t, 1, edge_code(t1, 2));
        link(t1, 1, edge_code(t2, 2));
        link(t2, 1, edge_code(t, 2));
        return {t1, t2};
    }

    // Puts vertex p on edge `e` of triangle t. The two halves inherit the lock of the edge.
    //
    //         c                    c
    //        /|\                  /|\            t = (a, b, c) becomes (a, b, p), t2 = (a, p, c);
    //       / | \                /t2|u\          across, u = (d, c, b) becomes (d, c, p),
    //      a t|u d    ->        a---p---d        u2 = (d, p, b). The edge opposite p is slot 2 in
    //       \ | /                \ t|u2/         t and u, slot 1 in t2 and u2.
    //        \|/                  \|/
    //         b                    b            Returns {t2, u2}; u2 = NONE on the border.
    std::array<Index, 2> split_edge(Place edge, Index p) {
        const Index t = edge.triangle;
        const int e = edge.slot;
        const Triangle old = triangles[t];
        const Index a = old.v[e], b = old.v[next(e)], c = old.v[prev(e)];
        const Index across = old.n[e];
        const Index lock = across == NONE ? 0 : across & LOCK_BIT;

        const Index t2 = add_triangle(a, p, c);
        Triangle& T = triangles[t];
        T.v[0] = a, T.v[1] = b, T.v[2] = p;
        T.n[0] = NONE;
        T.pending = CHANGED;
        triangles[t2].label = old.label;
        link(t, 2, old.n[prev(e)]);
        link(t2, 1, old.n[next(e)]);
        link(t, 1, edge_code(t2, 2));
        set_triangle_at(a, t), set_triangle_at(b, t), set_triangle_at(c, t2), set_triangle_at(p, t);
        if (across == NONE) return {t2, NONE};

        const Index u = triangle_of(across);
        const int f = slot_of(across);
        const Triangle far = triangles[u];
        const Index d = far.v[f];
        const Index u2 = add_triangle(d, p, b);
        Triangle& U = triangles[u];
        U.v[0] = d, U.v[1] = c, U.v[2] = p;
        U.pending = CHANGED;
        triangles[u2].label = far.label;
        link(u, 2, far.n[prev(f)]);
        link(u2, 1, far.n[next(f)]);
        link(u, 1, edge_code(u2, 2));
        link(u, 0, edge_code(t2, 0) | lock);
        link(u2, 0, edge_code(t, 0) | lock);
        set_triangle_at(d, u), set_triangle_at(b, t), set_triangle_at(p, t);
        return {t2, u2};
    }

    // Pulls vertex `from` into vertex `to`, a neighbour of it: the triangles on their edge vanish,
    // the others around `from` get `to` for a corner. `around` is the ball of `from`.
    //
    //        q---r                q---r          (from, p, to) and (from, to, q) vanish: the edges
    //       / \ / \              / \ / \         (p, to) and (p, from) become one, so do (q, to)
    //      s--from-to    ->     s----to          and (q, from), locked if either was.
    //       \ / \ /              \ / \ /
    //        t---p                t---p          Vanished triangles are dead until they are
    //        dropped.
    void collapse(const std::vector<Place>& around, Index from, Index to) {
        for (Place place : around) {
            Triangle& T = triangles[place.triangle];
            const int i = place.slot;
            const bool is_next = T.v[next(i)] == to;
            if (!is_next && T.v[prev(i)] != to) {
                T.v[i] = to;
                T.pending = CHANGED;
                continue;
            }
            const Index opposite_from = T.n[i];
            const Index opposite_to = T.n[is_next ? next(i) : prev(i)];
            const Index side = T.v[is_next ? prev(i) : next(i)];
            join(opposite_from, opposite_to);
            const Index left = opposite_from != NONE ? opposite_from : opposite_to;
            if (left != NONE) {
                set_triangle_at(side, triangle_of(left));
                set_triangle_at(to, triangle_of(left));
            }
            T.v[0] = DEAD;
        }
        set_triangle_at(from, NONE);
        ++collapsed_;
        for (Place place : around) {
            if (!is_dead(place.triangle)) set_triangle_at(to, place.triangle);
        }
    }

    bool is_dead(Index t) const { return triangles[t].v[0] == DEAD; }

    // The triangles around a vertex, counter-clockwise, each with the slot of the vertex in it;
    // starts at the border if the vertex is on it. Returns whether the ball is closed.
    //
    //   turning counter-clockwise about v leaves a triangle by the edge to its prev vertex, which
    //   is opposite next(slot); clockwise by the edge opposite prev(slot).
    bool ball(Index vertex, std::vector<Place>& places) const {
        const Index home = triangle_at(vertex);
        if (turn_around(vertex, home, places)) return true;
        Index start = home;  // the border was met: begin again at its other end
        while (true) {
            const Triangle& T = triangles[start];
            const Index code = T.n[prev(T.slot_of_vertex(vertex))];
            if (code == NONE) break;
            start = triangle_of(code);
        }
        turn_around(vertex, start, places);
        return false;
    }

    // The edge from a to b as an edge of the triangle on its left; triangle NONE if there is none.
    // Turns around both ends by turns, so that a vertex of many triangles costs no more than its
    // neighbour of few. Where parts of the triangulation touch in a vertex, one of them is seen;
    // see fans.hpp.
    Place find_edge(Index a, Index b) const {
        Turn turns[2] = {{a, triangle_at(a)}, {b, triangle_at(b)}};
        for (int i = 0;; i = 1 - i) {
            if (turns[i].at == NONE) return {NONE, 0};  // all of its triangles were looked at
            const Triangle& T = triangles[turns[i].at];
            const int slot = T.slot_of_vertex(turns[i].vertex);
            if (i == 0 && T.v[next(slot)] == b) return {turns[i].at, prev(slot)};
            if (i == 1 && T.v[prev(slot)] == a) return {turns[i].at, next(slot)};
            turn_on(turns[i], T, slot);
        }
    }

    // Gives the fan of triangles that begins at the border with this one, at the vertex in this
    // slot and counter-clockwise, a vertex of its own for the one it has; returns its number.
    Index move_fan(Place first) {
        const Index old = triangles[first.triangle].v[first.slot], copy = add_vertex();
        for (Place at = first;;) {
            Triangle& T = triangles[at.triangle];
            T.v[at.slot] = copy;
            set_triangle_at(copy, at.triangle);
            const Index code = T.n[next(at.slot)];
            if (code == NONE) return copy;
            at.triangle = triangle_of(code);
            at.slot = triangles[at.triangle].slot_of_vertex(old);
        }
    }

    // Gives vertex v the number name[v]; `name` is a permutation. The ghost keeps its own.
    void rename_vertices(const std::vector<Index>& name) {
        for (Triangle& t : triangles) {
            for (Index& v : t.v) {
                if (v != GHOST) v = name[v];
            }
        }
        std::vector<Index> renamed(triangle_at_.size());
        renamed[0] = triangle_at_[0];
        for (Index v = 0; v < vertex_count(); ++v) renamed[name[v] + 1] = triangle_at_[v + 1];
        triangle_at_.swap(renamed);
    }

    // Gives vertex v the number name[v] < kept; those with name NONE have no triangle and vanish.
    // Numbers keep their order.
    void drop_vertices(const std::vector<Index>& name, Index kept) {
        for (Triangle& t : triangles) {
            for (Index& v : t.v) v = name[v];
        }
        for (Index v = 0; v < vertex_count(); ++v) {
            if (name[v] != NONE) set_triangle_at(name[v], triangle_at(v));
        }
        triangle_at_.resize(kept + 1);
        collapsed_ = 0;
    }

    // Drops the triangles that `keep` refuses. Their place becomes NONE in those that stay, and a
    // vertex left without triangles has none.
    template <typename Keep>
    void keep_triangles(const Keep& keep) {
        std::vector<Index> moved_to(triangles.size(), NONE);
        Index kept = 0;
        for (Index t = 0; t < triangle_count(); ++t) {
            if (keep(triangles[t])) moved_to[t] = kept++;
        }
        std::fill(triangle_at_.begin(), triangle_at_.end(), NONE);
        for (Index t = 0; t < triangle_count(); ++t) {
            if (moved_to[t] == NONE) continue;
            Triangle T = triangles[t];
            for (Index& code : T.n) {
                if (code == NONE) continue;
                const Index beyond = moved_to[triangle_of(code)];
                code = beyond == NONE ? NONE : edge_code(beyond, slot_of(code)) | (code & LOCK_BIT);
            }
            triangles[moved_to[t]] = T;
            for (Index v : T.v) set_triangle_at(v, moved_to[t]);
        }
        triangles.resize(kept);
    }

    // A visit mark no triangle bears.
    std::uint32_t new_stamp() {
        if (++stamp_ == std::uint32_t(1) << 27) {  // wrapped
            for (Triangle& t : triangles) t.stamp = 0;
            stamp_ = 1;
        }
        return stamp_;
    }

  private:
    // A walk around a vertex: counter-clockwise from one of its triangles, and on from there
    // clockwise if that ends at the border.
    struct Turn {
        Index vertex, start;
        Index at = start;
        bool is_clockwise = false;
    };

    // To the next triangle, NONE after the last; T is the one at hand, with the vertex in the slot.
    void turn_on(Turn& turn, const Triangle& T, int slot) const {
        Index code = T.n[turn.is_clockwise ? prev(slot) : next(slot)];
        if (code == NONE && !turn.is_clockwise) {
            turn.is_clockwise = true;
            const Triangle& S = triangles[turn.start];
            code = S.n[prev(S.slot_of_vertex(turn.vertex))];
        }
        turn.at = code == NONE ? NONE : triangle_of(code);
        if (turn.at == turn.start) turn.at = NONE;
    }

    // The triangles around a vertex counter-clockwise from one of them; false if that ends at the
    // border.
    bool turn_around(Index vertex, Index start, std::vector<Place>& places) const {
        places.clear();
        for (Index k = start;;) {
            const Triangle& T = triangles[k];
            const int i = T.slot_of_vertex(vertex);
            places.push_back({k, i});
            const Index code = T.n[next(i)];
            if (code == NONE) return false;
            k = triangle_of(code);
            if (k == start) return true;
        }
    }

    // Two triangles become neighbours across the edges with these codes, each as its own triangle
    // sees the other: code g is the edge of triangle_of(g) that faced what is now gone.
    void join(Index g, Index h) {
        const Index lock = (g | h) & LOCK_BIT;
        if (g != NONE) triangles[triangle_of(g)].n[slot_of(g)] = h == NONE ? NONE : h | lock;
        if (h != NONE) triangles[triangle_of(h)].n[slot_of(h)] = g == NONE ? NONE : g | lock;
    }

    std::vector<Index> triangle_at_ = {NONE};  // shifted by one: the ghost vertex has a place too
    std::uint32_t stamp_ = 0;
    Index collapsed_ = 0;  // vertices that are gone but still have a number
};

}  // namespace adaptmesh
