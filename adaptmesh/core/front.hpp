// Points ahead of a front: unit triangles are built on the edges that bound what is done, layer
// after layer, from the constraints inwards.
//
// The front is a list of directed edges; each has a finished triangle (or a constraint) on its
// right and looks to its left:
//
//          c                P
//         / \              / \         if the triangle (a, b, c) ahead has short sides, it is
//        /   \    or      /   \        accepted, and (c, b), (a, c) join the front; else the
//       a --- b          a --- b       point P that makes a unit triangle is wanted
//
// Like the sampler, the front asks in rounds: the place of P depends on the metric at P. It is
// guessed with the metric expected there, the metric is evaluated, for a whole layer at once, and
// the place found anew; if that is next to the one before, P stays where the metric is known, and
// else it moves and is asked about again.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/point_inserter.hpp"

namespace adaptmesh {

struct FrontOptions {
    double accept = 1.35;    // a triangle ahead with no longer side is kept as it is
    double spacing = 0.8;    // a point nearer than this to a vertex is refused
    double target = 1.0;     // length of the sides to be made, before book-keeping
    double lowest = 0.6;     // height of the new triangle, at least and ...
    double highest = 1.26;   // ... at most
    double taken = 0.75;     // one that is expected to be nearer is not even asked about
    double settled = 0.01;   // a point that would move less than this stays where it is
    double unsettled = 0.1;  // so few of a layer stay, too, where their metric is known
    int trials = 3;          // how often a point is asked about, at most
};

class Front {
  public:
    Front(MetricMesh& mesh, const FrontOptions& options) : mesh_(mesh), options_(options) {
        for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
            const Triangle& T = mesh.triangle(t);
            for (int slot = 0; slot < 3; ++slot) {
                if (is_locked(T.n[slot])) edges_.push_back({T.v[next(slot)], T.v[prev(slot)]});
            }
        }
    }

    // Accepts what it can, and finds where points are wanted: how many.
    template <typename Poll>
    std::size_t advance(Poll& poll) {
        for (const Wanted& w : wanted_) last_wanted_[w.edge.a] = last_wanted_[w.edge.b] = NONE;
        last_wanted_.resize(mesh_.vertices.size(), NONE);
        wanted_.clear();
        books_.age();
        for (std::size_t i = 0; i < edges_.size(); ++i) {  // grows on the way
            if (i % 1024 == 0) poll();
            consider(edges_[i]);
        }
        edges_.clear();
        trial_ = 0;
        open_.resize(wanted_.size());
        for (std::size_t i = 0; i < open_.size(); ++i) open_[i] = i;
        return wanted_.size();
    }

    // Where the metric is wanted next; empty when all points have their place.
    std::vector<double> wanted() const {
        std::vector<double> out;
        out.reserve(2 * open_.size());
        for (std::size_t i : open_) out.push_back(wanted_[i].at.x), out.push_back(wanted_[i].at.y);
        return out;
    }
    std::size_t wanted_count() const { return open_.size(); }

    // The metrics at the wanted places: settles the points, or finds them anew.
    template <typename TensorAt>
    void feed(TensorAt&& tensor_at) {
        ++trial_;
        moves_.clear();
        for (std::size_t k = 0; k < open_.size(); ++k) {
            Wanted& w = wanted_[open_[k]];
            w.metric = tensor_at(k);
            if (trial_ == options_.trials) continue;
            const Point better = apex(w.edge, w.metric);
            const double x = better.x - w.at.x, y = better.y - w.at.y;
            if (w.metric.q(x, y) >= options_.settled * options_.settled)
                moves_.push_back({open_[k], better});
        }
        open_.clear();
        if (double(moves_.size()) <= options_.unsettled * double(wanted_.size())) return;
        for (const Move& move : moves_) {
            Wanted& w = wanted_[move.wanted];
            w.at = move.to;
            if (is_in_sight(w))
                open_.push_back(move.wanted);
            else
                w.near = NONE;
        }
    }

    // Puts the points into the mesh, each with the metric there; new edges join the front, in the
    // order of the old ones. Returns how many took place.
    //
    // The points go in from coarse to fine along the front. Where a void lies ahead, the triangles
    // that reach across it are shared by the points of the layer; one after the other, each point
    // would take nearly all of those of the point before:
    //
    //      \    |    /  .-'             \   |    \   |    \   |
    //       .---.---.-'- - -             .---.----.---.----.---.
    //      one after the other           every other, then those between
    template <typename Poll>
    Index insert(Poll& poll) {
        PointInserter inserter(mesh_, options_.spacing);
        const auto put_in = [&](std::size_t first, std::size_t step) {
            for (std::size_t i = first, done = 0; i < wanted_.size(); i += step, ++done) {
                if (done % 1024 == 0) poll();
                Wanted& w = wanted_[i];
                if (w.near == NONE) continue;  // out of sight
                if (inserter.insert(w.at, w.metric, w.near) == PointInserter::Outcome::inserted)
                    w.vertex = Index(mesh_.vertices.size()) - 1;
            }
        };
        put_in(0, COARSEST);
        for (std::size_t step = COARSEST; step > 1; step /= 2) put_in(step / 2, step);

        Index inserted = 0;
        for (const Wanted& w : wanted_) {
            if (w.vertex == NONE) continue;
            ++inserted;
            edges_.push_back(w.edge);
            edges_.push_back({w.vertex, w.edge.b});
            edges_.push_back({w.edge.a, w.vertex});
        }
        return inserted;
    }

  private:
    static constexpr std::size_t COARSEST = 32;  // of every so many points one goes in first

    struct Edge {
        Index a, b;
    };
    struct Wanted {
        Edge edge;
        Point at;
        Index near;     // the triangle it lies in, NONE if it is out of sight
        Tensor metric;  // at the place, as soon as it is known; until then what is expected
        Index vertex;   // that it has become, or NONE
    };

    struct Move {
        std::size_t wanted;
        Point to;
    };

    // Triangles accepted of late, and how many unit triangles their metric area is worth. Where the
    // metric grows finer ahead of the front, sides are on average above the target; where it is
    // curved, unit sides enclose less than a unit triangle. Both would show in the count.
    class Books {
      public:
        void age() { made_ *= MEMORY, worth_ *= MEMORY; }
        void enter(double area) { made_ += 1, worth_ += area / (0.25 * std::sqrt(3.0)); }
        double correction() const {
            return made_ < FEWEST ? 1 : std::min(std::max(made_ / worth_, 1 / MOST), MOST);
        }

      private:
        static constexpr double MEMORY = 0.95;  // share of the account that outlives a layer
        static constexpr double FEWEST = 20;    // triangles before the account is heeded
        static constexpr double MOST = 1.07;
        double made_ = 0, worth_ = 0;
    };

    double metric_area(Index t) const {
        double density = 0;
        for (Index v : mesh_.triangle(t).v) density += mesh_.vertices[v].sqrt_det;
        return mesh_.euclidean_area(t) * density / 3;
    }

    void consider(Edge e) {
        if (has_asked(e)) return;
        const Place place = mesh_.topology.find_edge(e.a, e.b);
        if (place.triangle == NONE) return;
        Triangle& T = mesh_.topology.triangles[place.triangle];
        if (!(T.fresh & TO_ADVANCE)) return;
        const Index c = T.v[place.slot];
        if (mesh_.length(e.b, c) < options_.accept && mesh_.length(c, e.a) < options_.accept) {
            T.fresh &= ~TO_ADVANCE;
            books_.enter(metric_area(place.triangle));
            edges_.push_back({c, e.b});
            edges_.push_back({e.a, c});
            return;
        }
        const Tensor ahead = expected_metric(e, T.n[place.slot]);
        Wanted w{e, apex(e, ahead), place.triangle, ahead, NONE};
        if (is_wanted_already(w) || !is_in_sight(w) || is_at_corner(w)) return;
        last_wanted_[e.a] = last_wanted_[e.b] = Index(wanted_.size());
        wanted_.push_back(w);
    }

    // An edge may come twice in a layer, on its own and as a side of a triangle that is accepted.
    bool has_asked(Edge e) const {
        const Index k = last_wanted_[e.a];
        return k != NONE && wanted_[k].edge.a == e.a && wanted_[k].edge.b == e.b;
    }

    // Whether a neighbour along the front wants a point in about the same place: only the first of
    // them would be put in.
    bool is_wanted_already(const Wanted& w) const {
        const Vertex p = Vertex::make(w.at, w.metric);
        const auto is_near = [&](Index k) {
            if (k == NONE) return false;
            const Wanted& other = wanted_[k];
            return MetricMesh::length(p, Vertex::make(other.at, other.metric)) < options_.taken;
        };
        return is_near(last_wanted_[w.edge.a]) || is_near(last_wanted_[w.edge.b]);
    }

    // Whether there is a vertex already in about the same place.
    bool is_at_corner(const Wanted& w) const {
        const Vertex p = Vertex::make(w.at, w.metric);
        for (Index v : mesh_.triangle(w.near).v) {
            if (MetricMesh::length(p, mesh_.vertices[v]) < options_.taken) return true;
        }
        return false;
    }

    // The metric expected ahead of an edge, as far as vertex d is behind it: that of its middle and
    // as much more again as the middle has more than d, if that is a metric not far from it.
    //
    //            b
    //          / | .
    //         d  |   P         behind: the edge as d's triangle sees it
    //          \ | .
    //            a
    Tensor expected_metric(Edge e, Index behind) const {
        const Tensor middle = 0.5 * (mesh_.vertices[e.a].metric + mesh_.vertices[e.b].metric);
        if (is_locked(behind)) return middle;
        const Index d = mesh_.triangle(triangle_of(behind)).v[slot_of(behind)];
        const Tensor ahead = 2.0 * middle - mesh_.vertices[d].metric;
        const double det = ahead.a * ahead.c - ahead.b * ahead.b;
        const double known = middle.a * middle.c - middle.b * middle.b;
        const bool is_near = ahead.a > 0 && det > 0.25 * known && det < 4 * known;
        return is_near ? ahead : middle;
    }

    // Whether the point lies in the domain, and no constraint hides it from its edge: the metric is
    // asked for nowhere else.
    bool is_in_sight(Wanted& w) const {
        if (!std::isfinite(w.at.x) || !std::isfinite(w.at.y)) return false;
        const Location where = locate(
            mesh_.topology, [this](Index v) { return mesh_.at(v); }, w.at, w.near,
            Walls::locked_edges);
        w.near = where.triangle;
        return where.where == Where::in_triangle || where.where == Where::on_edge;
    }

    // The middle of (a, b) plus the height along the M-orthogonal w of e, for sides of the target
    // length; M is the mean of the metrics at a, b and the apex. Of M only the shape gives w its
    // direction: it is scaled so that huge and tiny sizes neither overflow nor vanish.
    Point apex(Edge edge, const Tensor& ahead) const {
        const Tensor sum = mesh_.vertices[edge.a].metric + mesh_.vertices[edge.b].metric + ahead;
        const double scale = 1 / (sum.a + sum.c);
        const Tensor m = scale * sum;
        const Point a = mesh_.at(edge.a), b = mesh_.at(edge.b);
        const double ex = b.x - a.x, ey = b.y - a.y;
        const double wx = -(m.b * ex + m.c * ey), wy = m.a * ex + m.b * ey;
        const double length = mesh_.length(edge.a, edge.b);
        const double target = options_.target * books_.correction();
        const double square = target * target - 0.25 * length * length;
        const double height =
            std::min(std::max(std::sqrt(std::max(square, 0.0)), options_.lowest), options_.highest);
        const double share = height * std::sqrt(3 * scale / m.q(wx, wy));
        return {0.5 * (a.x + b.x) + share * wx, 0.5 * (a.y + b.y) + share * wy};
    }

    MetricMesh& mesh_;
    FrontOptions options_;
    Books books_;
    std::vector<Edge> edges_;
    std::vector<Wanted> wanted_;
    std::vector<std::size_t> open_;   // those of wanted_ that are asked about
    std::vector<Move> moves_;         // of those that have not settled
    std::vector<Index> last_wanted_;  // by an edge at each vertex
    int trial_ = 0;
};

}  // namespace adaptmesh
