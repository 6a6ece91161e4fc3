#include "metrics/core/locator.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "metrics/core/boxtree.hpp"
#include "metrics/core/edge_sides.hpp"
#include "metrics/core/seedgrid.hpp"

namespace metrics {

Locator::Locator(const double* points, std::size_t n, const Index* triangles, std::size_t m) {
    if (m == 0) throw std::invalid_argument("there are no triangles");
    vertices_.reserve(n);
    for (std::size_t i = 0; i < n; ++i) vertices_.push_back({points[2 * i], points[2 * i + 1]});
    triangles_.reserve(m);
    for (std::size_t t = 0; t < m; ++t) {
        const Index* v = triangles + 3 * t;
        triangles_.push_back({{v[0], v[1], v[2]}, {NO_TRIANGLE, NO_TRIANGLE, NO_TRIANGLE}});
    }
    find_neighbours(triangles);
    prepare_searches();
}

Location Locator::locate(double x, double y, Index hint) const {
    Location place;
    const bool known = hint >= 0 && hint < triangle_count();
    if (walk(x, y, known ? hint : seeds_.near(x, y), place) || search(x, y, place)) return place;
    return nearest_on_border(x, y);
}

void Locator::areas(const Triangle& t, double x, double y, double w[3]) const {
    const Vertex &p = vertices_[t.v[0]], &q = vertices_[t.v[1]], &r = vertices_[t.v[2]];
    const double px = p.x - x, py = p.y - y;
    const double qx = q.x - x, qy = q.y - y;
    const double rx = r.x - x, ry = r.y - y;
    w[0] = qx * ry - qy * rx;
    w[1] = rx * py - ry * px;
    w[2] = px * qy - py * qx;
}

Location Locator::inside(Index triangle, const double w[3]) {
    Location place{triangle, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    const double p = std::max(w[0], 0.0), q = std::max(w[1], 0.0), r = std::max(w[2], 0.0);
    const double sum = p + q + r;
    if (sum > 0) {
        // Divided, not scaled: at a vertex its weight is exactly 1.
        place.weight[0] = p / sum, place.weight[1] = q / sum, place.weight[2] = r / sum;
    }
    return place;
}

bool Locator::walk(double x, double y, Index start, Location& place) const {
    for (int step = 0; step < MAX_STEPS; ++step) {
        const Triangle& t = triangles_[start];
        double w[3];
        areas(t, x, y, w);
        Index onward = NO_TRIANGLE;
        double furthest = 0;
        bool behind = false;
        for (int i = 0; i < 3; ++i) {
            behind |= w[i] < 0;
            if (w[i] < furthest && t.n[i] != NO_TRIANGLE) furthest = w[i], onward = t.n[i];
        }
        if (!behind) {
            place = inside(start, w);
            return true;
        }
        if (onward == NO_TRIANGLE) return false;
        start = onward;
    }
    return false;
}

bool Locator::search(double x, double y, Location& place) const {
    double best = -ROUNDING;
    bool found = false;
    triangle_tree_.containing(x, y, [&](Index t) {
        double w[3];
        areas(triangles_[t], x, y, w);
        const double least = std::min({w[0], w[1], w[2]}) / (w[0] + w[1] + w[2]);
        if (least >= best) best = least, found = true, place = inside(t, w);
        return best >= 0;
    });
    return found;
}

Location Locator::nearest_on_border(double x, double y) const {
    double share = 0, distance = 0;
    const Index nearest = border_tree_.nearest(x, y, [&](Index side) {
        share_of_side(border_[side], x, y, distance);
        return distance;
    });
    const Side side = border_[nearest];
    share = share_of_side(side, x, y, distance);
    Location place{side.triangle, {0, 0, 0}, std::sqrt(distance)};
    place.weight[(side.edge + 1) % 3] = 1 - share;
    place.weight[(side.edge + 2) % 3] = share;
    return place;
}

double Locator::share_of_side(Side side, double x, double y, double& squared_distance) const {
    const Triangle& t = triangles_[side.triangle];
    const Vertex& p = vertices_[t.v[(side.edge + 1) % 3]];
    const Vertex& q = vertices_[t.v[(side.edge + 2) % 3]];
    const double ex = q.x - p.x, ey = q.y - p.y;
    const double projection = ((x - p.x) * ex + (y - p.y) * ey) / (ex * ex + ey * ey);
    const double share = std::min(std::max(projection, 0.0), 1.0);
    const double dx = p.x + share * ex - x, dy = p.y + share * ey - y;
    squared_distance = dx * dx + dy * dy;
    return share;
}

void Locator::find_neighbours(const Index* triangles) {
    const EdgeSides sides(triangles, triangles_.size(), vertices_.size());
    sides.for_each_edge([&](Index low, Index high, const auto* side, const auto* end) {
        if (end - side > 1) join(low, high, side[0].side, side[1].side, end - side);
    });
}

void Locator::join(Index low, Index high, Index here, Index there, std::ptrdiff_t count) {
    const Index t = here / 3, u = there / 3;
    const int i = here % 3, j = there % 3;
    if (count > 2 || start(t, i) == start(u, j)) {
        throw std::invalid_argument(
            "triangles " + std::to_string(t) + " and " + std::to_string(u) +
            " overlap at the edge (" + std::to_string(low) + ", " + std::to_string(high) +
            "): they lie on the same side of it, or it has more than two triangles");
    }
    triangles_[t].n[i] = u;
    triangles_[u].n[j] = t;
}

void Locator::prepare_searches() {
    std::vector<Box> boxes, border_boxes;
    boxes.reserve(triangles_.size());
    for (Index t = 0; t < triangle_count(); ++t) {
        Box box;
        for (int i = 0; i < 3; ++i) {
            include(box, t, i);
            if (triangles_[t].n[i] != NO_TRIANGLE) continue;
            Box side;
            include(side, t, (i + 1) % 3), include(side, t, (i + 2) % 3);
            border_.push_back({t, i});
            border_boxes.push_back(side);
        }
        boxes.push_back(box);
    }
    triangle_tree_ = BoxTree(boxes);
    border_tree_ = BoxTree(border_boxes);
    seeds_ = SeedGrid(boxes);
}

}  // namespace metrics
