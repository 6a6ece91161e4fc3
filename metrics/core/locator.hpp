// Where a point is in a mesh of triangles: the one that has it, and its barycentric coordinates
// there.
//
// A look-up walks from a triangle that the caller remembers to the one that has the point, each
// step across the edge that the point lies furthest behind; without a hint, from a triangle that
// nested grids have for the place. In a mesh with holes and corners a walk may end at the border
// with the point still beyond; and on a mesh that is not Delaunay it may go in circles. So a walk
// is only ever an attempt, which nearly always succeeds: when it meets the border or has gone
// MAX_STEPS steps, a tree of boxes gives the definite answer, which triangle has the point, or, for
// a point outside, which border edge is nearest.
//
// Constant after construction: any number of threads may look up at once.
#pragma once

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

// Where a point is: its triangle and its barycentric coordinates there, none negative. For a point
// outside, those of the nearest point of the border, and how far away that is.
struct Location {
    Index triangle;
    double weight[3];
    double outside = 0;
};

class Locator {
  public:
    static constexpr Index NO_TRIANGLE = -1;

    struct Vertex {
        double x, y;
    };

    // points: n pairs (x, y); triangles: m counter-clockwise triples.
    // Throws std::invalid_argument where the triangles are not a mesh.
    Locator(const double* points, std::size_t n, const Index* triangles, std::size_t m) {
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

    Index triangle_count() const { return Index(triangles_.size()); }
    const Vertex& vertex(Index v) const { return vertices_[v]; }
    Index corner(Index triangle, int i) const { return triangles_[triangle].v[i]; }

    // The triangle across the edge opposite corner `edge`, or NO_TRIANGLE.
    Index neighbour(Index triangle, int edge) const { return triangles_[triangle].n[edge]; }

    // Of the box around the mesh.
    double diagonal() const {
        const Box box = triangle_tree_.bounds();
        return std::hypot(box.x1 - box.x0, box.y1 - box.y0);
    }

    // Calls visit(triangle) for each triangle whose box meets a box.
    template <typename Visit>
    void near(const Box& box, Visit visit) const {
        triangle_tree_.matching([&](const Box& b) { return b.meets(box); },
                                [&](Index t) { return visit(t), false; });
    }

    // `hint` is where to start from: -1, or any number that is not a triangle, when nothing is
    // known.
    Location locate(double x, double y, Index hint) const {
        Location place;
        const bool known = hint >= 0 && hint < triangle_count();
        if (walk(x, y, known ? hint : seeds_.near(x, y), place) || search(x, y, place))
            return place;
        return nearest_on_border(x, y);
    }

  private:
    static constexpr int MAX_STEPS = 64;
    // A point in no triangle, by this little in barycentric coordinates, fell between two of them
    // by rounding.
    static constexpr double ROUNDING = 1e-9;

    // Edge i lies opposite vertex i, and neighbour n[i] across it.
    struct Triangle {
        Index v[3], n[3];
    };

    struct Side {
        Index triangle;
        int edge;
    };

    // Twice the area of the triangle (point, v[i + 1], v[i + 2]): negative where the point is
    // behind edge i. The same edge seen from its other triangle gives exactly the opposite number,
    // so no walk turns back on its last step.
    void areas(const Triangle& t, double x, double y, double w[3]) const {
        const Vertex &p = vertices_[t.v[0]], &q = vertices_[t.v[1]], &r = vertices_[t.v[2]];
        const double px = p.x - x, py = p.y - y;
        const double qx = q.x - x, qy = q.y - y;
        const double rx = r.x - x, ry = r.y - y;
        w[0] = qx * ry - qy * rx;
        w[1] = rx * py - ry * px;
        w[2] = px * qy - py * qx;
    }

    static Location inside(Index triangle, const double w[3]) {
        Location place{triangle, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
        const double p = std::max(w[0], 0.0), q = std::max(w[1], 0.0), r = std::max(w[2], 0.0);
        const double sum = p + q + r;
        if (sum > 0) {
            // Divided, not scaled: at a vertex its weight is exactly 1.
            place.weight[0] = p / sum, place.weight[1] = q / sum, place.weight[2] = r / sum;
        }
        return place;
    }

    bool walk(double x, double y, Index start, Location& place) const {
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

    // Among the triangles whose boxes have the point: the one that has it best.
    bool search(double x, double y, Location& place) const {
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

    Location nearest_on_border(double x, double y) const {
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

    // How far along a side its point nearest to (x, y) is, and the squared distance to it.
    double share_of_side(Side side, double x, double y, double& squared_distance) const {
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

    void find_neighbours(const Index* triangles) {
        const EdgeSides sides(triangles, triangles_.size(), vertices_.size());
        sides.for_each_edge([&](Index low, Index high, const auto* side, const auto* end) {
            if (end - side > 1) join(low, high, side[0].side, side[1].side, end - side);
        });
    }

    // The vertex that side i of triangle t runs from, counter-clockwise.
    Index start(Index t, int i) const { return triangles_[t].v[(i + 1) % 3]; }

    void join(Index low, Index high, Index here, Index there, std::ptrdiff_t count) {
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

    void prepare_searches() {
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

    void include(Box& box, Index t, int corner) const {
        const Vertex& vertex = vertices_[triangles_[t].v[corner]];
        box.include(vertex.x, vertex.y);
    }

    std::vector<Vertex> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<Side> border_;
    BoxTree triangle_tree_, border_tree_;
    SeedGrid seeds_;
};

}  // namespace metrics
