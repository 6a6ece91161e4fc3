#include "adaptmesh/core/triangulation/constrain.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/edge_map.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "adaptmesh/core/triangulation/insert.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

namespace {

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
                    throw InputError(InputFault::segment_out_of_range, Index(i), v);
            }
            if (s.a == s.b)
                throw InputError(InputFault::degenerate_segment, Index(i), s.a, points_[s.a]);
        }
    }

    // Most segments are edges already: one look at all edges. Returns the numbers of the others.
    std::vector<Index> lock_present() {
        const EdgeNumbers lookup(segments_);
        const auto [i, j] = lookup.doubled();
        if (i != NONE)
            throw InputError(InputFault::overlapping_segments, i, j, points_[segments_[i].a]);

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
    std::vector<Place> doubtful_;
    std::vector<Index> left_, right_;

    int slot_in(Index t, Index vertex) const { return mesh_.triangles[t].slot_of_vertex(vertex); }

    int side(Index a, Index b, Index v) const {
        return orient2d(points_[a], points_[b], points_[v]);
    }

    // For v on the line through `from` and `goal`: is it on the side of goal?
    bool is_ahead(Index from, Index goal, Index v) const {
        const Point f = points_[from], g = points_[goal], p = points_[v];
        return f.x != g.x ? (f.x < g.x) == (f.x < p.x) : (f.y < g.y) == (f.y < p.y);
    }

    // Turns around `from`, towards the goal from where it starts: around a hub of many segments
    // that is seldom far.
    Ahead look_ahead(Index from, Index goal) const {
        const Index start = mesh_.triangle_at(from);
        const Index left_of_start = mesh_.triangles[start].v[prev(slot_in(start, from))];
        const bool turn_left = left_of_start == GHOST || side(from, left_of_start, goal) > 0;
        Index t = start;
        do {
            const Triangle& T = mesh_.triangles[t];
            const int i = slot_in(t, from);
            const Index right = T.v[next(i)], left = T.v[prev(i)];
            if (right != GHOST && left != GHOST) {
                const int at_right = side(from, goal, right), at_left = side(from, goal, left);
                if (at_right == 0 && is_ahead(from, goal, right)) return {false, {t, prev(i)}};
                if (at_left == 0 && is_ahead(from, goal, left)) return {false, {t, next(i)}};
                if (at_right < 0 && at_left > 0) return {true, {t, i}};
            }
            t = triangle_of(T.n[turn_left ? next(i) : prev(i)]);
        } while (t != start);
        throw std::logic_error("a segment leaves its first vertex between two triangles");
    }

    void lock(Place edge, Index from, Index to, Index segment) {
        if (is_locked(mesh_.triangles[edge.triangle].n[edge.slot])) {
            throw pair_fault(InputFault::overlapping_segments, segment, segment_at(from, to),
                             points_[from]);
        }
        mesh_.lock(edge);
        sub_edges.push_back({from, to, segment});
    }

    static InputError pair_fault(InputFault kind, Index segment, Index other, Point at) {
        return InputError(kind, std::min(segment, other), std::max(segment, other), at);
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
    // First every crossed edge is flipped, in order, whether its quadrilateral is convex or not
    // (as Shewchuk's Triangle does). That leaves the triangles fanned out around `from`, the way
    // as an edge between a fan on its left and one on its right, and some triangles inside out:
    //
    //           l0                         l0
    //         / | \ \                    /    \                 .
    //       /   |  \   \               /         \              .
    //    from --+---+-- to   ->     from --------- to
    //       \   |    \  /              \ \___     /
    //         \ |     \/                 \   \__ /
    //           r0----r1                  r0---- r1
    //
    // Then each fan is unfolded.
    Place make_edge(Place crossed, Index from, Index segment) {
        const Index goal = segments_[segment].b;
        left_.clear(), right_.clear();
        Index t = crossed.triangle;
        for (int apex_side = 1; apex_side != 0;) {
            const Place edge{t, slot_in(t, from)};
            const Index code = mesh_.triangles[t].n[edge.slot];
            if (is_locked(code)) throw crossing(segment, edge);
            const Index u = triangle_of(code);
            const Index apex = mesh_.triangles[u].v[slot_of(code)];
            mesh_.flip(edge);  // t = (from, right, apex), u = (apex, left, from)
            apex_side = side(from, goal, apex);
            if (apex_side <= 0) right_.push_back(t);
            if (apex_side >= 0) left_.push_back(u);
            if (apex_side < 0) t = u;
        }
        for (Index k : left_) doubt(k);
        for (Index k : right_) doubt(k);
        unfold(from, right_, Fan::right);
        const Index last = unfold(from, left_, Fan::left);
        return {last, prev(slot_in(last, from))};
    }

    enum class Fan { left, right };

    // Turns a fan around `from`, whose triangles may be inside out, into a triangulation of the
    // polygon between its outer vertices and the edge at its end. Every vertex of that polygon
    // sees the edge, and so Graham's scan triangulates it (Toussaint and Avis 1982): go along the
    // vertices and cut off the last but one, `mid`, as long as it is a convex corner. A cut is a
    // flip of the edge from `mid` to `from`. Returns the triangle of `from` at the end.
    //
    //       mid___old               mid___old
    //       /  \   |                / ___/ |         a fan on the left, its triangles clockwise;
    //     new   \  |      ->      new      |         one on the right is the mirror image
    //       \__  \ |                \___   |
    //          `--from                  `--from
    Index unfold(Index from, const std::vector<Index>& fan, Fan which) {
        int uncut = 0;  // vertices between `mid` and the start that were not convex in their turn
        Index t = NONE;
        for (Index following : fan) {
            t = following;
            while (uncut > 0 && is_corner(from, t, which, false)) {
                const Place edge = edge_to_mid(from, t, which);
                const Index u = triangle_of(mesh_.triangles[t].n[edge.slot]);
                mesh_.flip(edge);
                if (which == Fan::left) t = u;  // the one at `from`, see Triangulation::flip
                --uncut;
            }
            // The first vertex needs no flip: (new, mid, from) is what is cut off.
            const bool cut_off = uncut == 0 && is_corner(from, t, which, true);
            if (!cut_off) ++uncut;
        }
        return t;
    }

    // The edge from `mid` to `from` in triangle t of a fan: opposite `new`.
    Place edge_to_mid(Index from, Index t, Fan which) const {
        const int i = slot_in(t, from);
        return {t, which == Fan::left ? next(i) : prev(i)};
    }

    // Is `mid` convex, between `new` and `old`? The first vertex of a fan has `from` for old.
    bool is_corner(Index from, Index t, Fan which, bool mid_is_first) const {
        const Place edge = edge_to_mid(from, t, which);
        const Triangle& T = mesh_.triangles[t];
        const Index code = T.n[edge.slot];
        const Index old = mid_is_first ? from : mesh_.triangles[triangle_of(code)].v[slot_of(code)];
        const bool left = which == Fan::left;
        const Index mid = T.v[left ? next(edge.slot) : prev(edge.slot)];
        return side(T.v[edge.slot], mid, old) == (left ? 1 : -1);
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

    InputError crossing(Index segment, Place edge) const {
        const Triangle& T = mesh_.triangles[edge.triangle];
        const Index c = T.v[next(edge.slot)], d = T.v[prev(edge.slot)];
        const Point p = points_[segments_[segment].a], q = points_[segments_[segment].b];
        const Point r = points_[c], s = points_[d];
        const double ux = q.x - p.x, uy = q.y - p.y, wx = s.x - r.x, wy = s.y - r.y;
        const double t = ((r.x - p.x) * wy - (r.y - p.y) * wx) / (ux * wy - uy * wx);
        const Point meet{p.x + t * ux, p.y + t * uy};
        return pair_fault(InputFault::crossing_segments, segment, segment_at(c, d), meet);
    }
};

}  // namespace

std::vector<SubEdge> constrain(Triangulation& mesh, const std::vector<Point>& points,
                               const std::vector<Segment>& segments, Monitor& monitor) {
    Constrainer work(mesh, points, segments);
    work.check();
    std::size_t done = 0;
    for (Index segment : work.lock_present()) {
        monitor.poll(++done);
        work.recover(segment);
    }
    std::stable_sort(work.sub_edges.begin(), work.sub_edges.end(),
                     [](const SubEdge& e, const SubEdge& f) { return e.segment < f.segment; });
    return std::move(work.sub_edges);
}

}  // namespace adaptmesh
