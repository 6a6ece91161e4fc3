#include "adaptmesh/core/validate/border_sweep.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/constrain.hpp"

namespace adaptmesh {

namespace {

bool is_left_of(Point a, Point b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
}

// A border edge from its left to its right end.
struct SweptEdge {
    Index left, right;
    bool points_right;  // the mesh is above it
};

class BorderSweeper {
  public:
    // The edges join different points. Two points in one place count as edges that meet.
    BorderSweeper(const std::vector<Point>& points, const std::vector<Segment>& edges)
        : points_(points), order_(Below{this}) {
        for (const Segment& e : edges) {
            const bool right = is_left_of(points[e.a], points[e.b]);
            edges_.push_back({right ? e.a : e.b, right ? e.b : e.a, right});
        }
        place_.resize(edges.size(), order_.end());
        above_.resize(edges.size(), 0);
        found_.layers.resize(edges.size(), 0);
    }

    BorderSweep run(Monitor& monitor) {
        // all ends from left to right; at one point, first the edges that end there
        std::vector<std::pair<Index, Index>> events;  // point, edge
        for (Index e = 0; e < Index(edges_.size()); ++e) {
            events.push_back({edges_[e].left, e});
            events.push_back({edges_[e].right, e});
        }
        std::sort(events.begin(), events.end(), [&](const auto& a, const auto& b) {
            if (a.first == b.first) return a.second < b.second;
            return is_left_of(points_[a.first], points_[b.first]);
        });
        std::vector<Index> ending, starting;
        for (std::size_t i = 0, steps = 0; i < events.size() && found_.first == NONE; ++steps) {
            monitor.poll(steps);
            const Index v = events[i].first;
            if (i > 0 && !is_left_of(points_[events[i - 1].first], points_[v])) {
                report(events[i - 1].second, events[i].second);  // two points in one place
                break;
            }
            ending.clear(), starting.clear();
            for (; i < events.size() && events[i].first == v; ++i) {
                const Index e = events[i].second;
                (edges_[e].right == v ? ending : starting).push_back(e);
            }
            pass(v, ending, starting);
        }
        return std::move(found_);
    }

  private:
    struct Below {
        using is_transparent = void;
        const BorderSweeper* sweep;

        bool operator()(Index s, Index t) const { return sweep->is_below(s, t); }
        bool operator()(Index s, Point p) const { return sweep->side(s, p) > 0; }
    };
    using Order = std::set<Index, Below>;

    // 1 if p is above the edge, -1 below, 0 on its line.
    int side(Index e, Point p) const {
        return orient2d(points_[edges_[e].left], points_[edges_[e].right], p);
    }

    // Of two edges that the line meets: the one that starts later is beside the other where it
    // does.
    bool is_below(Index s, Index t) const {
        const Point s_left = points_[edges_[s].left], t_left = points_[edges_[t].left];
        if (edges_[s].left == edges_[t].left) return side(s, points_[edges_[t].right]) > 0;
        if (is_left_of(s_left, t_left)) return side(s, t_left) > 0;
        return side(t, s_left) < 0;
    }

    void pass(Index v, const std::vector<Index>& ending, std::vector<Index>& starting) {
        auto next = order_.end();
        if (ending.empty()) {
            next = order_.lower_bound(points_[v]);
        } else {
            next = place_[ending.front()];
            while (next != order_.end() && edges_[*next].right == v) ++next;
        }
        for (Index e : ending) order_.erase(place_[e]);
        if (next != order_.end() && side(*next, points_[v]) == 0) {
            return report(*next, ending.empty() ? starting.front() : ending.front());
        }
        std::sort(starting.begin(), starting.end(),
                  [&](Index s, Index t) { return side(s, points_[edges_[t].right]) > 0; });
        const bool has_lower = next != order_.begin();
        const Index lower = has_lower ? *std::prev(next) : NONE;
        const Index upper = next != order_.end() ? *next : NONE;
        Index layers = has_lower ? above_[lower] : 0, last = lower;
        for (Index e : starting) {
            test(last, e);
            last = e;
            found_.layers[e] = edges_[e].points_right ? layers + 1 : layers;
            layers += edges_[e].points_right ? 1 : -1;
            above_[e] = layers;
            place_[e] = order_.insert(next, e);
        }
        test(last, upper);
    }

    void test(Index s, Index t) {
        if (s == NONE || t == NONE || found_.first != NONE) return;
        if (have_more_than_an_end(edges_[s], edges_[t])) report(s, t);
    }

    void report(Index s, Index t) { found_.first = std::min(s, t), found_.second = std::max(s, t); }

    bool have_more_than_an_end(const SweptEdge& s, const SweptEdge& t) const {
        const Point a = points_[s.left], b = points_[s.right];
        const Point c = points_[t.left], d = points_[t.right];
        const int ab_c = orient2d(a, b, c), ab_d = orient2d(a, b, d);
        const int cd_a = orient2d(c, d, a), cd_b = orient2d(c, d, b);
        if (ab_c * ab_d < 0 && cd_a * cd_b < 0) return true;
        return (ab_c == 0 && is_inside(s, t.left)) || (ab_d == 0 && is_inside(s, t.right)) ||
               (cd_a == 0 && is_inside(t, s.left)) || (cd_b == 0 && is_inside(t, s.right));
    }

    // Whether a point on the line of an edge lies between its ends.
    bool is_inside(const SweptEdge& e, Index v) const {
        return is_left_of(points_[e.left], points_[v]) && is_left_of(points_[v], points_[e.right]);
    }

    const std::vector<Point>& points_;
    std::vector<SweptEdge> edges_;
    Order order_;                         // of the edges that the line meets
    std::vector<Order::iterator> place_;  // of each of them in it
    std::vector<Index> above_;            // layers above each
    BorderSweep found_;
};

}  // namespace

BorderSweep sweep_border(const std::vector<Point>& points, const std::vector<Segment>& edges,
                         Monitor& monitor) {
    return BorderSweeper(points, edges).run(monitor);
}

}  // namespace adaptmesh
