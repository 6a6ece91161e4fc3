// Makes segments edges of a Delaunay triangulation, which becomes a constrained Delaunay one.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "adaptmesh/core/edge_lookup.hpp"
#include "adaptmesh/core/fault.hpp"
#include "adaptmesh/core/insert.hpp"
#include "adaptmesh/core/point.hpp"
#include "adaptmesh/core/poll.hpp"
#include "adaptmesh/core/predicates.hpp"
#include "adaptmesh/core/triangulation.hpp"

namespace adaptmesh {

struct Segment {
    Index a, b;
};

// A locked edge, directed as the segment it is a piece of.
struct SubEdge {
    Index a, b;
    Index segment;
    bool is_boundary = false;  // has the outside on one side; known after carving
};

namespace detail {

// Adds segments one at a time to a triangulation that stays constrained Delaunay in between.
class Constrainer {
  public:
    Constrainer(Triangulation& mesh, const std::vector<Point>& points,
                const std::vector<Segment>& segments)
        : mesh_(mesh), points_(points), segments_(segments) {}

    std::vector<SubEdge> sub_edges;

    void check() const {
        for (std::size_t i = 0; i < segments_.size(); ++i) {
            const Segment s = segments_[i];
            for (Index v : {s.a, s.b}) {
                if (v < 0 || v >= mesh_.vertex_count())
                    throw Fault("segment_out_of_range", Index(i), v);
            }
            if (s.a == s.b) throw Fault("degenerate_segment", Index(i), s.a, points_[s.a]);
        }
    }

    // Most segments are edges already: one look at all edges. Returns the numbers of the others.
    std::vector<Index> lock_present() {
        const EdgeLookup lookup(segments_);
        const auto [i, j] = lookup.doubled();
        if (i != NONE) throw Fault("overlapping_segments", i, j, points_[segments_[i].a]);

        std::vector<char> is_end(mesh_.vertex_count(), false), is_present(segments_.size(), false);
        for (Segment s : segments_) is_end[s.a] = is_end[s.b] = true;
        for (Index t = 0; t < mesh_.triangle_count(); ++t) {
            for (int slot = 0; slot < 3; ++slot) {
                const Triangle& T = mesh_.triangles[t];
                const Index a = T.v[next(slot)], b = T.v[prev(slot)];
                if (a > b || a == GHOST || !is_end[a] || !is_end[b]) continue;
                const Index segment = lookup.find(a, b);
                if (segment == NONE) continue;
                is_present[segment] = true;
                lock({t, slot}, segments_[segment].a, segments_[segment].b, segment);
            }
        }
        std::vector<Index> missing;
        for (std::size_t k = 0; k < segments_.size(); ++k) {
            if (!is_present[k]) missing.push_back(Index(k));
        }
        return missing;
    }

    // From vertex to vertex along the segment; each stretch is an edge, or is made one.
    void recover(Index segment) {
        const Index goal = segments_[segment].b;
        for (Index from = segments_[segment].a; from != goal;) {
            const Ahead ahead = look_ahead(from, goal);
            Place edge = ahead.place;
            if (ahead.crosses) edge = make_edge(ahead.place, from, segment);
            const Triangle& T = mesh_.triangles[edge.triangle];
            const Index to =
                T.v[next(edge.slot)] == from ? T.v[prev(edge.slot)] : T.v[next(edge.slot)];
            lock(edge, from, to, segment);
            if (ahead.crosses) restore_delaunay();
            from = to;
        }
    }

  private:
    // What lies ahead of a vertex on its way: the first edge of the way (crosses = false), or the
    // edge that the way crosses first.
    struct Ahead {
        bool crosses;
        Place place;
    };

    Triangulation& mesh_;
    const std::vector<Point>& points_;
    const std::vector<Segment>& segments_;
    std::vector<Place> ball_, doubtful_;
    std::vector<Index> left_, right_;

    int side(Index a, Index b, Index v) const {
        return orient2d(points_[a], points_[b], points_[v]);
    }

    // For v on the line through `from` and `goal`: is it on the side of goal?
    bool is_ahead(Index from, Index goal, Index v) const {
        const Point f = points_[from], g = points_[goal], p = points_[v];
        return f.x != g.x ? (f.x < g.x) == (f.x < p.x) : (f.y < g.y) == (f.y < p.y);
    }

    Ahead look_ahead(Index from, Index goal) {
        mesh_.ball(from, ball_);
        for (const auto [t, i] : ball_) {
            const Index right = mesh_.triangles[t].v[next(i)], left = mesh_.triangles[t].v[prev(i)];
            if (right == GHOST || left == GHOST) continue;
            const int at_right = side(from, goal, right), at_left = side(from, goal, left);
            if (at_right == 0 && is_ahead(from, goal, right)) return {false, {t, prev(i)}};
            if (at_left == 0 && is_ahead(from, goal, left)) return {false, {t, next(i)}};
            if (at_right < 0 && at_left > 0) return {true, {t, i}};
        }
        throw std::logic_error("a segment leaves its first vertex between two triangles");
    }

    void lock(Place edge, Index from, Index to, Index segment) {
        if (is_locked(mesh_.triangles[edge.triangle].n[edge.slot])) {
            throw pair_fault("overlapping_segments", segment, segment_at(from, to), points_[from]);
        }
        mesh_.lock(edge);
        sub_edges.push_back({from, to, segment});
    }

    static Fault pair_fault(const char* kind, Index segment, Index other, Point at) {
        return Fault(kind, std::min(segment, other), std::max(segment, other), at);
    }

    // Only asked on the way to a fault.
    Index segment_at(Index a, Index b) const {
        for (const SubEdge& e : sub_edges) {
            if ((e.a == a && e.b == b) || (e.a == b && e.b == a)) return e.segment;
        }
        return NONE;
    }

    // Turns the triangles along the way from `from`, over edge `crossed`, to the next vertex on
    // the way so that the way is an edge; returns it.
    //
    // First every crossed edge is flipped, in order, whether its quadrilateral is convex or not.
    // That leaves all of the triangles fanned out around `from`, some of them inside out, and the
    // way as an edge between the fan of the vertices on its left and that on its right:
    //
    //         l1    l2                 l1____l2
    //        / \   / | \              / \   _/ \                .
    //      l0   \ /  |  \           l0  _\_/ _  \               .
    //     /  \   /\  |   to   ->    /|_/_/__-  - to             .
    //   from  \ /  \ |  /         from -----__---/              .
    //      \__r0____r1_/             \__r0____r1_/
    //
    Place make_edge(Place crossed, Index from, Index segment) {
        const Index goal = segments_[segment].b;
        left_.clear(), right_.clear(), doubtful_.clear();
        for (Index t = crossed.triangle;;) {
            const int i = mesh_.triangles[t].slot_of_vertex(from);
            const Index code = mesh_.triangles[t].n[i];
            if (is_locked(code)) throw crossing(segment, {t, i});
            const Index u = triangle_of(code);
            const Index apex = mesh_.triangles[u].v[slot_of(code)];
            mesh_.flip({t, i});  // t = (from, right, apex), u = (apex, left, from)
            const int apex_side = side(from, goal, apex);
            if (apex_side <= 0) right_.push_back(t);
            if (apex_side >= 0) left_.push_back(u);
            if (apex_side == 0) {
                for (Index k : left_) doubt(k);
                for (Index k : right_) doubt(k);
                unfold(from, left_, 1);
                unfold(from, right_, -1);
                return mesh_.find_edge(from, apex, ball_);
            }
            t = apex_side > 0 ? t : u;
        }
    }

    // Turns a fan around `from`, some of whose triangles are inside out, into a triangulation of
    // the polygon between its outer vertices l0 l1 ... and the edge at its end. Every vertex of
    // that polygon sees the edge, and so Graham's scan triangulates it (Toussaint, Avis 1982): go
    // along the vertices, and cut off the last but one as long as it is a convex corner. A cut is
    // a flip of its edge to `from`:
    //
    //       mid___old               mid___old           `turn` is 1 for the fan on the left of the
    //       /  \   |                / ___/ |            edge (drawn), its triangles in clockwise
    //     new   \  |      ->      new      |            order, and -1 for its mirror image.
    //       \__  \ |                \___   |
    //          `--from                  `--from
    void unfold(Index from, const std::vector<Index>& fan, int turn) {
        int uncut = 0;  // vertices before `mid` that were not convex when they were looked at
        for (Index t : fan) {
            for (;;) {
                const Triangle& T = mesh_.triangles[t];
                const int i = T.slot_of_vertex(from);
                const int newest = turn > 0 ? next(i) : prev(i);
                const Index mid = T.v[turn > 0 ? prev(i) : next(i)];
                const Index across = T.n[newest];
                const Index old =
                    uncut > 0 ? mesh_.triangles[triangle_of(across)].v[slot_of(across)] : from;
                if (side(T.v[newest], mid, old) * turn <= 0) {
                    ++uncut;
                    break;
                }
                if (uncut == 0) break;  // the triangle (newest, mid, from) is itself the cut
                const Index u = triangle_of(across);
                mesh_.flip({t, newest});
                if (turn > 0) t = u;  // the triangle of `from`, see Triangulation::flip
                --uncut;
            }
        }
    }

    void doubt(Index t) {
        for (int slot = 0; slot < 3; ++slot) doubtful_.push_back({t, slot});
    }

    // Lawson's flips over the doubtful edges, until every edge that is not locked is Delaunay.
    void restore_delaunay() {
        const auto at = [this](Index v) { return points_[v]; };
        while (!doubtful_.empty()) {
            const Place edge = doubtful_.back();
            doubtful_.pop_back();
            const Index code = mesh_.triangles[edge.triangle].n[edge.slot];
            if (is_locked(code)) continue;
            const Index u = triangle_of(code);
            const Index apex = mesh_.triangles[edge.triangle].v[edge.slot];
            if (!conflicts(mesh_.triangles[u], at, points_[apex])) continue;
            mesh_.flip(edge);
            for (Index k : {edge.triangle, u}) {
                doubtful_.push_back({k, 0});
                doubtful_.push_back({k, 2});
            }
        }
    }

    Fault crossing(Index segment, Place edge) const {
        const Triangle& T = mesh_.triangles[edge.triangle];
        const Index c = T.v[next(edge.slot)], d = T.v[prev(edge.slot)];
        const Point p = points_[segments_[segment].a], q = points_[segments_[segment].b];
        const Point r = points_[c], s = points_[d];
        const double ux = q.x - p.x, uy = q.y - p.y, wx = s.x - r.x, wy = s.y - r.y;
        const double t = ((r.x - p.x) * wy - (r.y - p.y) * wx) / (ux * wy - uy * wx);
        const Point meet{p.x + t * ux, p.y + t * uy};
        return pair_fault("crossing_segments", segment, segment_at(c, d), meet);
    }
};

}  // namespace detail

// Locks the segments in a Delaunay triangulation with ghosts of all their vertices; afterwards it
// is constrained Delaunay. Returns the locked edges, in the order of the segments and along each:
// one per segment, or more if other vertices lie exactly on it. Faults if segments cross or
// overlap.
template <typename Poll>
std::vector<SubEdge> constrain(Triangulation& mesh, const std::vector<Point>& points,
                               const std::vector<Segment>& segments, Poll& poll) {
    detail::Constrainer work(mesh, points, segments);
    work.check();
    std::size_t done = 0;
    for (Index segment : work.lock_present()) {
        if (++done % POLL_EVERY == 0) poll();
        work.recover(segment);
    }
    std::stable_sort(work.sub_edges.begin(), work.sub_edges.end(),
                     [](const SubEdge& e, const SubEdge& f) { return e.segment < f.segment; });
    return std::move(work.sub_edges);
}

}  // namespace adaptmesh
