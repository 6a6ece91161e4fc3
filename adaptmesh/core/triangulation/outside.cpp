#include "adaptmesh/core/triangulation/outside.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/fans.hpp"
#include "adaptmesh/core/triangulation/insert.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

namespace {

// Numbers of the corners of a box relative to the first, counter-clockwise.
constexpr Index LOWER_LEFT = 0, LOWER_RIGHT = 1, UPPER_RIGHT = 2, UPPER_LEFT = 3;

// The corners of a box that holds all points strictly inside.
std::vector<Point> box_around(const std::vector<Point>& points) {
    constexpr double FAR = std::numeric_limits<double>::max();
    Point low = points[0], high = points[0];
    for (Point p : points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double margin = std::min(std::max(high.x - low.x, high.y - low.y), FAR);
    const auto below = [&](double x) {
        return std::max(std::min(x - margin, std::nextafter(x, -FAR)), -FAR);
    };
    const auto above = [&](double x) {
        return std::min(std::max(x + margin, std::nextafter(x, FAR)), FAR);
    };
    const double left = below(low.x), right = above(high.x);
    const double bottom = below(low.y), top = above(high.y);
    return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

// The corner of a box that is farthest to the left of the vector from p to q.
Index farthest_left(Point p, Point q) {
    if (p.x < q.x) return p.y < q.y ? UPPER_LEFT : p.y == q.y ? UPPER_LEFT : UPPER_RIGHT;
    if (p.x > q.x) return p.y > q.y ? LOWER_RIGHT : p.y == q.y ? LOWER_RIGHT : LOWER_LEFT;
    return p.y < q.y ? LOWER_LEFT : UPPER_RIGHT;
}

// Replaces the ghosts by triangles to the corners of a box, the four vertices from `box` on:
//
//      3-------------2         Each ghost gets the corner that is farthest beyond its edge. Where
//      |\    .-'    /|         the next one around the hull has another, triangles from their
//      | \ q-------p |         common vertex to the sides of the box lie between.
//      |  /         \|
//
void replace_ghosts(Triangulation& mesh, const std::vector<Point>& points, Index box) {
    const auto corner = [&](Index ghost) {
        const Triangle& T = mesh.triangles[ghost];
        const int i = T.slot_of_vertex(GHOST);
        return farthest_left(points[T.v[next(i)]], points[T.v[prev(i)]]);
    };
    std::vector<Index> ghosts;
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& T = mesh.triangles[t];
        if (T.v[0] == GHOST || T.v[1] == GHOST || T.v[2] == GHOST) ghosts.push_back(t);
    }
    std::vector<Index> corners;
    for (Index g : ghosts) corners.push_back(corner(g));
    // The ghost (GHOST, p, q) meets the next one, clockwise around the hull, in its edge at q.
    for (std::size_t k = 0; k < ghosts.size(); ++k) {
        const int i = mesh.triangles[ghosts[k]].slot_of_vertex(GHOST);
        const Index q = mesh.triangles[ghosts[k]].v[prev(i)];
        const Index beyond = mesh.triangles[ghosts[k]].n[next(i)];
        const Index last = corner(triangle_of(beyond));
        Place before{ghosts[k], next(i)};
        for (Index c = corners[k]; c != last; c = (c + 3) % 4) {
            const Index t = mesh.add_triangle(q, box + (c + 3) % 4, box + c);
            mesh.triangles[t].label = mesh.triangles[ghosts[k]].label;
            mesh.link(t, 1, edge_code(before.triangle, before.slot));
            before = {t, 2};
        }
        mesh.link(before.triangle, before.slot, beyond);
    }
    for (std::size_t k = 0; k < ghosts.size(); ++k) {
        Triangle& T = mesh.triangles[ghosts[k]];
        T.v[T.slot_of_vertex(GHOST)] = box + corners[k];
        mesh.set_triangle_at(box + corners[k], ghosts[k]);
    }
    mesh.set_triangle_at(GHOST, NONE);
}

}  // namespace

Outside::Outside(Triangulation outside, const std::vector<Point>& points)
    : topology_(std::move(outside)), points_(points), first_box_(Index(points.size())) {
    for (Point corner : box_around(points)) {
        points_.push_back(corner);
        topology_.add_vertex();
    }
    replace_ghosts(topology_, points, first_box_);
    fans_ = Fans(topology_);
    for (const Fans::Copy& c : fans_.copies()) {
        points_.resize(topology_.vertex_count());
        points_[c.vertex] = points_[c.original];
    }
    make_delaunay();
}

bool Outside::takes(Index a, Index b, Point p) const {
    const Place edge = find(a, b);
    if (edge.triangle == NONE) return false;
    const Triangle& T = topology_.triangles[edge.triangle];
    const Point apex = points_[T.v[edge.slot]];
    return orient2d(apex, points_[T.v[next(edge.slot)]], p) > 0 &&
           orient2d(apex, p, points_[T.v[prev(edge.slot)]]) > 0;
}

void Outside::cut(Index a, Index b, Index vertex, Point p) {
    const Place edge = find(a, b);
    const Index v = topology_.add_vertex();
    points_.push_back(p);
    if (Index(number_.size()) <= vertex - first_box_) number_.resize(vertex - first_box_ + 1);
    number_[vertex - first_box_] = v;
    const Index half = topology_.split_edge(edge, v)[0];
    doubtful_.push_back({edge.triangle, 2});
    doubtful_.push_back({half, 1});
    legalise(topology_, [this](Index k) { return points_[k]; }, p, doubtful_);
}

void Outside::make_delaunay() {
    const auto at = [this](Index v) { return points_[v]; };
    for (Index t = 0; t < topology_.triangle_count(); ++t) {
        for (int slot = 0; slot < 3; ++slot) doubtful_.push_back({t, slot});
    }
    while (!doubtful_.empty()) {
        const Place edge = doubtful_.back();
        doubtful_.pop_back();
        const Triangle& T = topology_.triangles[edge.triangle];
        if (is_locked(T.n[edge.slot])) continue;
        const Index u = triangle_of(T.n[edge.slot]);
        if (!conflicts(topology_.triangles[u], at, points_[T.v[edge.slot]])) continue;
        topology_.flip(edge);
        for (Index k : {edge.triangle, u}) {
            doubtful_.push_back({k, 0});
            doubtful_.push_back({k, 2});
        }
    }
}

}  // namespace adaptmesh
