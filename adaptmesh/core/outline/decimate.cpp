#include "adaptmesh/core/outline/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <tuple>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "metrics/core/boxtree.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

namespace {

class Decimation {
  public:
    // Edges meet only at points. `share` is how far a point may lie off the edge that replaces its
    // own, as a length in the metric at that point.
    Decimation(std::vector<Point> points, std::vector<Tensor> tensors, std::vector<ChainEdge> edges,
               double share)
        : points_(std::move(points)),
          tensors_(std::move(tensors)),
          edges_(std::move(edges)),
          share_(share),
          tree_(boxes_of(points_)),
          is_left_(points_.size(), true),
          after_(points_.size(), NONE),
          beside_(points_.size()) {
        for (std::int32_t e = 0; e < std::int32_t(edges_.size()); ++e) {
            beside_[edges_[e].from].push_back(e);
            beside_[edges_[e].to].push_back(e);
        }
    }

    Decimated run(Monitor& monitor) {
        for (std::int32_t v = 0; v < std::int32_t(points_.size()); ++v) consider(v);
        for (std::size_t i = 0; !queue_.empty(); ++i) {
            monitor.poll(i);
            const Candidate c = queue_.top();
            queue_.pop();
            if (is_current(c) && sweeps_over_nothing(c)) leave_out(c);
        }
        return what_is_left();
    }

  private:
    static constexpr std::int32_t NONE = -1;

    // Calls visit(v) for each point that an edge passes by.
    template <typename Visit>
    void for_passed(const ChainEdge& edge, Visit visit) const {
        for (std::int32_t v = edge.first; v != NONE; v = v == edge.last ? NONE : after_[v])
            visit(v);
    }

    Decimated what_is_left() const {
        Decimated out;
        for (std::size_t e = 0; e < edges_.size(); ++e) {
            const ChainEdge& edge = edges_[e];
            if (!edge.is_left) continue;
            out.edges.push_back({edge.from, edge.to});
            out.source.push_back(std::int32_t(e));
            for_passed(edge, [&](std::int32_t v) { out.passed.push_back(v); });
            out.starts.push_back(std::int64_t(out.passed.size()));
        }
        return out;
    }

    // A point that may be left out, between the edges from a and to b. Of equal displacements the
    // one with fewer points to look at goes first: so a straight line is halved, not eaten up.
    struct Candidate {
        double off;
        std::int32_t passed, v, a, b;

        bool operator>(const Candidate& other) const {
            return std::tie(off, passed, v, a, b) >
                   std::tie(other.off, other.passed, other.v, other.a, other.b);
        }
    };

    static std::vector<metrics::Box> boxes_of(const std::vector<Point>& points) {
        std::vector<metrics::Box> boxes(points.size());
        for (std::size_t v = 0; v < points.size(); ++v) boxes[v].include(points[v].x, points[v].y);
        return boxes;
    }

    std::int32_t other_end(std::int32_t e, std::int32_t v) const {
        return edges_[e].from == v ? edges_[e].to : edges_[e].from;
    }

    bool are_joined(std::int32_t a, std::int32_t b) const {
        return std::any_of(beside_[a].begin(), beside_[a].end(),
                           [&](std::int32_t e) { return other_end(e, a) == b; });
    }

    void consider(std::int32_t v) {
        if (beside_[v].size() != 2) return;
        const std::int32_t first = beside_[v][0], second = beside_[v][1];
        const std::int32_t a = other_end(first, v), b = other_end(second, v);
        if (edges_[first].kind != edges_[second].kind || are_joined(a, b)) return;
        // Along a chain of one kind all edges have to point the same way.
        if ((edges_[first].to == v) != (edges_[second].from == v)) return;
        if (std::min(length(a, v), length(v, b)) >= 1) return;
        double off = squared_offset(v, a, b);
        for (std::int32_t e : {first, second})
            for_passed(edges_[e],
                       [&](std::int32_t p) { off = std::max(off, squared_offset(p, a, b)); });
        off = std::sqrt(off);
        if (off <= share_)
            queue_.push({off, edges_[first].passed + edges_[second].passed, v, a, b});
    }

    bool is_current(const Candidate& c) const {
        const auto& edges = beside_[c.v];
        return is_left_[c.v] && edges.size() == 2 && other_end(edges[0], c.v) == c.a &&
               other_end(edges[1], c.v) == c.b && !are_joined(c.a, c.b);
    }

    double length(std::int32_t a, std::int32_t b) const {
        const Tensor &m = tensors_[a], &n = tensors_[b];
        const double x = points_[b].x - points_[a].x, y = points_[b].y - points_[a].y;
        return std::sqrt(0.5 * (m.a + n.a) * x * x + (m.b + n.b) * x * y +
                         0.5 * (m.c + n.c) * y * y);
    }

    // Of a point from the edge ab, in the metric at the point.
    double squared_offset(std::int32_t p, std::int32_t a, std::int32_t b) const {
        const Tensor& m = tensors_[p];
        const auto dot = [&m](Point u, Point w) {
            return m.a * u.x * w.x + m.b * (u.x * w.y + u.y * w.x) + m.c * u.y * w.y;
        };
        const Point u{points_[b].x - points_[a].x, points_[b].y - points_[a].y};
        const Point w{points_[p].x - points_[a].x, points_[p].y - points_[a].y};
        const double t = std::clamp(dot(u, w) / dot(u, u), 0.0, 1.0);
        const Point off{w.x - t * u.x, w.y - t * u.y};
        return dot(off, off);
    }

    // Whether no other point lies in the triangle avb, its sides included.
    bool sweeps_over_nothing(const Candidate& c) const {
        const Point a = points_[c.a], v = points_[c.v], b = points_[c.b];
        metrics::Box around;
        for (Point p : {a, v, b}) around.include(p.x, p.y);
        bool is_clear = true;
        tree_.matching([&](const metrics::Box& box) { return box.meets(around); },
                       [&](std::int32_t p) {
                           if (!is_left_[p] || p == c.a || p == c.v || p == c.b) return false;
                           const Point q = points_[p];
                           const auto [least, most] = std::minmax(
                               {orient2d(a, v, q), orient2d(v, b, q), orient2d(b, a, q)});
                           is_clear = least < 0 && most > 0;
                           return !is_clear;
                       });
        return is_clear;
    }

    // The edge of a runs to b from now on, and that of b is no more.
    void leave_out(const Candidate& c) {
        const std::int32_t e = beside_[c.v][0], gone = beside_[c.v][1];
        ChainEdge &kept = edges_[e], &other = edges_[gone];
        (kept.from == c.v ? kept.from : kept.to) = c.b;
        pass(kept, c.v, c.v, 1);
        if (other.passed) pass(kept, other.first, other.last, other.passed);
        other.is_left = false;
        is_left_[c.v] = false;
        std::replace(beside_[c.b].begin(), beside_[c.b].end(), gone, e);
        consider(c.a);
        consider(c.b);
    }

    void pass(ChainEdge& edge, std::int32_t first, std::int32_t last, std::int32_t count) {
        if (edge.passed)
            after_[edge.last] = first;
        else
            edge.first = first;
        edge.last = last;
        edge.passed += count;
    }

    std::vector<Point> points_;
    std::vector<Tensor> tensors_;
    std::vector<ChainEdge> edges_;
    double share_;
    metrics::BoxTree tree_;
    std::vector<char> is_left_;
    std::vector<std::int32_t> after_;  // the next of the points that the same edge passes by
    std::vector<std::vector<std::int32_t>> beside_;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<Candidate>> queue_;
};

}  // namespace

Decimated decimate(std::vector<Point> points, std::vector<Tensor> tensors,
                   std::vector<ChainEdge> edges, double share, Monitor& monitor) {
    return Decimation(std::move(points), std::move(tensors), std::move(edges), share).run(monitor);
}

}  // namespace adaptmesh
