#include "metrics/core/segments.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "metrics/core/boxtree.hpp"

namespace metrics {

Segments::Segments(const double* ends, std::size_t count) {
    std::vector<Box> boxes(count);
    segments_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double* p = ends + 4 * i;
        segments_.push_back({p[0], p[1], p[2], p[3]});
        boxes[i].include(p[0], p[1]), boxes[i].include(p[2], p[3]);
    }
    tree_ = BoxTree(boxes);
}

OnSegment Segments::nearest(double x, double y, std::int32_t hint) const {
    const auto squared_distance = [&](std::int32_t i) {
        const OnSegment place = foot(i, x, y);
        const double dx = place.x - x, dy = place.y - y;
        return dx * dx + dy * dy;
    };
    return foot(tree_.nearest(x, y, squared_distance, hint), x, y);
}

void Segments::prepare_rings(const double* left) {
    std::vector<Box> boxes(segments_.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Segment& s = segments_[i];
        boxes[i].include(left[i], s.ay), boxes[i].include(s.bx, s.by);
        boxes[i].include(s.ax, s.ay);
    }
    rings_ = BoxTree(boxes);
}

bool Segments::encloses(double x, double y) const {
    bool odd = false;
    const auto reached = [x, y](const Box& box) {
        return box.y0 <= y && y < box.y1 && box.x0 <= x && x <= box.x1;
    };
    rings_.matching(reached, [&](std::int32_t i) {
        const Segment& s = segments_[i];
        const double rise = s.by - s.ay;
        const double side = (s.bx - s.ax) * (y - s.ay) - (x - s.ax) * rise;
        odd ^= rise > 0 ? side > 0 : side < 0;
        return false;
    });
    return odd;
}

OnSegment Segments::at(std::int32_t i, double share) const {
    const Segment& s = segments_[i];
    if (share <= 0) return {i, 0, s.ax, s.ay};
    if (share >= 1) return {i, 1, s.bx, s.by};
    return {i, share, s.ax + share * (s.bx - s.ax), s.ay + share * (s.by - s.ay)};
}

OnSegment Segments::foot(std::int32_t i, double x, double y) const {
    const Segment& s = segments_[i];
    const double ex = s.bx - s.ax, ey = s.by - s.ay;
    const double square = ex * ex + ey * ey;
    const double along = (x - s.ax) * ex + (y - s.ay) * ey;
    return at(i, square > 0 ? along / square : 0);
}

}  // namespace metrics
