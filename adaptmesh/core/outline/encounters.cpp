#include "adaptmesh/core/outline/encounters.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/constrain.hpp"
#include "metrics/core/boxtree.hpp"

namespace adaptmesh {

namespace {

class EncounterSearch {
  public:
    EncounterSearch(const std::vector<Point>& points, const std::vector<Segment>& segments,
                    double tolerance)
        : points_(points), segments_(segments), tolerance_(tolerance) {}

    Encounters find(const bool* is_unseen, std::size_t max_crossings, Monitor& monitor) {
        std::vector<metrics::Box> boxes;
        boxes.reserve(segments_.size());
        for (const Segment& s : segments_) boxes.push_back(box_around(s));
        const metrics::BoxTree tree(boxes);
        for (Index i = 0; i < Index(segments_.size()) && found_.crossings.size() <= max_crossings;
             ++i) {
            if (!is_unseen[i]) continue;
            monitor.poll(i);
            tree.matching([&](const metrics::Box& box) { return box.meets(boxes[i]); },
                          [&](Index j) {
                              if (i < j || (i != j && !is_unseen[j])) compare(i, j, boxes);
                              return found_.crossings.size() > max_crossings;
                          });
        }
        sort_out(found_.near);
        sort_out(found_.crossings);
        return std::move(found_);
    }

  private:
    metrics::Box box_around(const Segment& s) const {
        metrics::Box box;
        for (Point p : {points_[s.a], points_[s.b]}) {
            box.include(p.x - tolerance_, p.y - tolerance_);
            box.include(p.x + tolerance_, p.y + tolerance_);
        }
        return box;
    }

    void compare(Index i, Index j, const std::vector<metrics::Box>& boxes) {
        const Segment s = segments_[i], t = segments_[j];
        for (Index v : {t.a, t.b}) note_near(i, v, boxes[i]);
        for (Index v : {s.a, s.b}) note_near(j, v, boxes[j]);
        const bool is_apart = s.a != t.a && s.a != t.b && s.b != t.a && s.b != t.b;
        if (is_apart && is_between(s, t) && is_between(t, s))
            found_.crossings.push_back(std::minmax(i, j));
    }

    void note_near(Index segment, Index v, const metrics::Box& box) {
        const Segment s = segments_[segment];
        const Point p = points_[v];
        if (v != s.a && v != s.b && box.contains(p.x, p.y) &&
            divides(p, points_[s.a], points_[s.b]))
            found_.near.push_back({segment, v});
    }

    bool divides(Point p, Point a, Point b) const {
        const Point u{b.x - a.x, b.y - a.y}, w{p.x - a.x, p.y - a.y};
        const double length2 = u.x * u.x + u.y * u.y;
        if (length2 == 0) return false;
        const double t = std::clamp((u.x * w.x + u.y * w.y) / length2, 0.0, 1.0);
        const Point foot = t < 0.5 ? Point{a.x + t * u.x, a.y + t * u.y}
                                   : Point{b.x - (1 - t) * u.x, b.y - (1 - t) * u.y};
        const double length = std::hypot(u.x, u.y);
        return std::hypot(p.x - foot.x, p.y - foot.y) <= tolerance_ &&
               std::hypot(w.x, w.y) < length && std::hypot(p.x - b.x, p.y - b.y) < length;
    }

    // Whether the ends of t are strictly on different sides of the line of s.
    bool is_between(const Segment& s, const Segment& t) const {
        const Point a = points_[s.a], b = points_[s.b];
        return orient2d(a, b, points_[t.a]) * orient2d(a, b, points_[t.b]) < 0;
    }

    static void sort_out(std::vector<IndexPair>& pairs) {
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    }

    const std::vector<Point>& points_;
    const std::vector<Segment>& segments_;
    double tolerance_;
    Encounters found_;
};

}  // namespace

Encounters find_encounters(const std::vector<Point>& points, const std::vector<Segment>& segments,
                           double tolerance, const bool* is_unseen, std::size_t max_crossings,
                           Monitor& monitor) {
    return EncounterSearch(points, segments, tolerance).find(is_unseen, max_crossings, monitor);
}

}  // namespace adaptmesh
