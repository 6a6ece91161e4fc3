// The common part of a triangle of one mesh and a triangle of another.
//
// It is convex, and bounded by the portion of each old edge inside the new triangle and of each new
// edge inside the old one:
//
//          /\            Each portion is known by itself: it begins at the end of its edge, if that
//     ____/__\____       is inside the other triangle, and else where another edge is crossed;
//     \  /    \  /       exact signs tell which. So no polygon is ever sorted or clipped, and in
//      \/______\/        whatever order the portions come, triangles from one fixed corner to each
//      /\      /\        of them make up the part.
//     ‾‾‾‾\‾‾/‾‾‾‾
//          \/
//
// Corners are kept as barycentric coordinates in both triangles. A crossing is computed from the
// two edges alone, symmetrically in their ends: the four parts that meet there have the same point,
// to the last bit, and so the parts of a triangle add up to it.
//
// The new mesh is thought shifted by an infinitely small vector (e, e^2) (Edelsbrunner and Muecke,
// Simulation of simplicity, ACM Transactions on Graphics 9, 1990): then no vertex lies on an edge
// of the other mesh, and no two edges on one line. Common edges and vertices give parts without
// area.
#pragma once

#include <cmath>

#include "adaptmesh/core/point.hpp"
#include "adaptmesh/core/predicates.hpp"

namespace adaptmesh {

struct Triangle3 {
    Point at[3];
};

struct Corner {
    double in_old[3], in_new[3];
};

class Overlap {
  public:
    // Both counter-clockwise.
    Overlap(const Triangle3& older, const Triangle3& newer) : old_(older), new_(newer) {
        if (!is_apart()) find_portions();
    }

    bool empty() const { return count_ == 0; }

    // Whether edge i of the old triangle, opposite its corner i, runs through the new one.
    bool has_old_edge(int i) const { return old_edge_inside_[i]; }

    // Calls visit(share, a, b, c) for the triangles that make up the part: their corners, and their
    // area as a share of the old triangle.
    template <typename Visit>
    void for_each_triangle(Visit visit) const {
        for (int k = 1; k < count_; ++k) {
            const Corner &a = begin_[0], &b = begin_[k], &c = end_[k];
            const double share = (b.in_old[1] - a.in_old[1]) * (c.in_old[2] - a.in_old[2]) -
                                 (b.in_old[2] - a.in_old[2]) * (c.in_old[1] - a.in_old[1]);
            if (share != 0) visit(share, a, b, c);
        }
    }

    double share_of_old() const {
        double sum = 0;
        for_each_triangle([&](double share, auto&...) { sum += share; });
        return sum;
    }

  private:
    static constexpr int after(int i) { return i == 2 ? 0 : i + 1; }

    // On which side of the edges of one triangle the corners of the other are, by edge and corner:
    // exact signs, and twice the areas in floating point, which is as accurate as they need to be.
    struct Sides {
        bool in[3][3];
        double area[3][3];
        bool all_out(int edge) const { return !(in[edge][0] || in[edge][1] || in[edge][2]); }
        bool inside(int corner) const { return in[0][corner] && in[1][corner] && in[2][corner]; }
    };

    // Turned about, an edge gives exactly the opposite area.
    static double twice_area(Point a, Point b, Point c) {
        return (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
    }

    // Whether c is left of a -> b; on the line, as if it were shifted by shift * (e, e^2).
    static bool is_left(Point a, Point b, Point c, int shift) {
        int sign = 0;
        if ((c.x != a.x || c.y != a.y) && (c.x != b.x || c.y != b.y)) sign = orient2d(a, b, c);
        if (sign != 0) return sign > 0;
        if (a.y != b.y) return (a.y > b.y) == (shift > 0);
        return (b.x > a.x) == (shift > 0);
    }

    static void find_sides(const Triangle3& of, const Triangle3& corners, int shift, int edge,
                           Sides& sides) {
        const Point a = of.at[after(edge)], b = of.at[after(after(edge))];
        for (int j = 0; j < 3; ++j) {
            sides.in[edge][j] = is_left(a, b, corners.at[j], shift);
            sides.area[edge][j] = twice_area(a, b, corners.at[j]);
        }
    }

    // Whether an edge of one has the other triangle on its outer side.
    bool is_apart() {
        for (int i = 0; i < 3; ++i) {
            find_sides(old_, new_, +1, i, new_sides_);
            if (new_sides_.all_out(i)) return true;
            find_sides(new_, old_, -1, i, old_sides_);
            if (old_sides_.all_out(i)) return true;
        }
        return false;
    }

    void find_portions() {
        for (int i = 0; i < 3; ++i) {
            old_edge_inside_[i] = add_portion(
                i, old_sides_, new_sides_, [&](int v) { return old_corner(v); },
                [&](int j) { return crossing(i, j); });
        }
        for (int j = 0; j < 3; ++j) {
            add_portion(
                j, new_sides_, old_sides_, [&](int v) { return new_corner(v); },
                [&](int i) { return crossing(i, j); });
        }
    }

    // The portion of edge i of one triangle inside the other. `own`: the sides of its corners, of
    // the edges of the other; `across`: those of the other's corners, of its edges.
    template <typename CornerAt, typename Crossing>
    bool add_portion(int i, const Sides& own, const Sides& across, CornerAt corner_at,
                     Crossing crossing_with) {
        const int a = after(i), b = after(a);
        int entered = NONE_CROSSED, left = NONE_CROSSED;
        for (int j = 0; j < 3; ++j) {
            const bool crosses = own.in[j][a] != own.in[j][b] &&
                                 across.in[i][after(j)] != across.in[i][after(after(j))];
            if (crosses) (own.in[j][a] ? left : entered) = j;
        }
        const bool begins_inside = own.inside(a);
        if (!begins_inside && entered == NONE_CROSSED) return false;
        begin_[count_] = begins_inside ? corner_at(a) : crossing_with(entered);
        end_[count_] = own.inside(b) ? corner_at(b) : crossing_with(left);
        ++count_;
        return true;
    }

    Corner old_corner(int v) const {
        Corner out{{0, 0, 0}, {}};
        out.in_old[v] = 1;
        weigh(old_sides_, v, out.in_new);
        return out;
    }

    Corner new_corner(int v) const {
        Corner out{{}, {0, 0, 0}};
        out.in_new[v] = 1;
        weigh(new_sides_, v, out.in_old);
        return out;
    }

    // Barycentric coordinates of a corner inside the other triangle.
    static void weigh(const Sides& sides, int corner, double weights[3]) {
        double sum = 0;
        for (int i = 0; i < 3; ++i) sum += weights[i] = std::fmax(sides.area[i][corner], 0.0);
        for (int i = 0; i < 3; ++i) weights[i] = sum > 0 ? weights[i] / sum : 1.0 / 3;
    }

    Corner crossing(int old_edge, int new_edge) const {
        Corner out{{0, 0, 0}, {0, 0, 0}};
        cut(old_sides_.area[new_edge], old_edge, out.in_old);
        cut(new_sides_.area[old_edge], new_edge, out.in_new);
        return out;
    }

    // Where an edge crosses the line that its triangle's corners have these areas with. Its ends
    // are on different sides, the exact signs have it; so only the magnitudes count.
    static void cut(const double areas[3], int edge, double weights[3]) {
        const int a = after(edge), b = after(a);
        const double at_a = std::fabs(areas[a]), at_b = std::fabs(areas[b]), sum = at_a + at_b;
        weights[a] = sum > 0 ? at_b / sum : 0.5;
        weights[b] = sum > 0 ? at_a / sum : 0.5;
    }

    static constexpr int NONE_CROSSED = -1;

    const Triangle3 &old_, &new_;
    Sides old_sides_, new_sides_;  // of the old corners, of the new corners
    bool old_edge_inside_[3] = {false, false, false};
    int count_ = 0;
    Corner begin_[6], end_[6];
};

}  // namespace adaptmesh
