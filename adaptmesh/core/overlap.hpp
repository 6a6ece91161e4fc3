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
// Corners are kept as barycentric coordinates in both triangles. Where edges cross, these are two
// ratios of areas, one for each edge, and they have to be of one and the same point. Exact signs
// find a crossing also where edges lie on one line but for rounding: on slanted borders and lines
// that both meshes have, and where one mesh has an edge that the other has in two. The areas there
// are as small as their own rounding, and ratios of them would be of points anywhere on the edges.
// So all areas are computed with small relative errors (accurate_area.hpp): then both ratios are
// those of the true crossing, and in barycentric coordinates all errors are of the order of
// rounding, however thin the triangles.
//
// A crossing is computed from the two edges alone, symmetrically in their ends: the four parts that
// meet there have the same point, to the last bit. The area of a part is that in the smaller of the
// triangles, so that its error is small beside both.
//
// The new mesh is thought shifted by an infinitely small vector (e, e^2) (Edelsbrunner and Muecke,
// Simulation of simplicity, ACM Transactions on Graphics 9, 1990): then no vertex lies on an edge
// of the other mesh, and no two edges on one line. Common edges and vertices give parts without
// area.
#pragma once

#include <cmath>

#include "adaptmesh/core/accurate_area.hpp"
#include "adaptmesh/core/point.hpp"

namespace adaptmesh {

// Counter-clockwise corners, and the area.
struct Triangle3 {
    Point at[3];
    double area;
};

struct Corner {
    double in_old[3], in_new[3];
};

class Overlap {
  public:
    Overlap(const Triangle3& older, const Triangle3& newer) : old_(older), new_(newer) {
        if (!is_apart()) find_portions();
    }

    bool empty() const { return count_ == 0; }

    // Whether edge i of the old triangle, opposite its corner i, runs through the new one.
    bool has_old_edge(int i) const { return old_edge_inside_[i]; }

    // Calls visit(area, a, b, c) for the triangles that make up the part: their areas and corners.
    template <typename Visit>
    void for_each_triangle(Visit visit) const {
        const bool in_old = old_.area <= new_.area;
        for (int k = 1; k < count_; ++k) {
            const Corner &a = begin_[0], &b = begin_[k], &c = end_[k];
            const double area = in_old ? old_.area * share(a.in_old, b.in_old, c.in_old)
                                       : new_.area * share(a.in_new, b.in_new, c.in_new);
            if (area != 0) visit(area, a, b, c);
        }
    }

    double area() const {
        double sum = 0;
        for_each_triangle([&](double area, auto&...) { sum += area; });
        return sum;
    }

    // Barycentric coordinates of a point in a triangle, negative where it is beyond an edge.
    static void weigh(const Triangle3& triangle, Point p, double weights[3]) {
        const double whole = 2 * triangle.area;
        for (int i = 0; i < 3; ++i) {
            const Point a = triangle.at[after(i)], b = triangle.at[after(after(i))];
            weights[i] = twice_area(a, b, p) / whole;
        }
    }

  private:
    // The area of abc, as a share of the triangle in which these are their coordinates.
    static double share(const double a[3], const double b[3], const double c[3]) {
        return (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]);
    }

    static constexpr int after(int i) { return i == 2 ? 0 : i + 1; }

    // On which side of the edges of one triangle the corners of the other are, by edge and corner:
    // exact signs, and twice the areas as far as the signs needed them.
    struct Sides {
        bool in[3][3];
        RoundedArea area[3][3];
        bool all_out(int edge) const { return !(in[edge][0] || in[edge][1] || in[edge][2]); }
        bool inside(int corner) const { return in[0][corner] && in[1][corner] && in[2][corner]; }
    };

    // Whether points left of a -> b are those that a shift by shift * (e, e^2) takes there from it.
    static bool is_shifted_left(Point a, Point b, int shift) {
        if (a.y != b.y) return (a.y > b.y) == (shift > 0);
        return (b.x > a.x) == (shift > 0);
    }

    static void find_sides(const Triangle3& of, const Triangle3& corners, int shift, int edge,
                           Sides& sides) {
        const Point a = of.at[after(edge)], b = of.at[after(after(edge))];
        for (int j = 0; j < 3; ++j) {
            RoundedArea area = rounded_twice_area(a, b, corners.at[j]);
            if (!area.has_sign()) {
                area.value = twice_area(a, b, corners.at[j]);
                area.magnitude = std::fabs(area.value);
            }
            sides.area[edge][j] = area;
            sides.in[edge][j] = area.value != 0 ? area.value > 0 : is_shifted_left(a, b, shift);
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
        weigh_inside(new_, old_.at[v], old_sides_, v, out.in_new);
        return out;
    }

    Corner new_corner(int v) const {
        Corner out{{}, {0, 0, 0}};
        out.in_new[v] = 1;
        weigh_inside(old_, new_.at[v], new_sides_, v, out.in_old);
        return out;
    }

    // Barycentric coordinates of corner `v` of the other triangle, at `p` and inside.
    static void weigh_inside(const Triangle3& triangle, Point p, const Sides& sides, int v,
                             double weights[3]) {
        double sum = 0, magnitude = 0;
        for (int i = 0; i < 3; ++i) {
            sum += weights[i] = std::fmax(sides.area[i][v].value, 0.0);
            magnitude += sides.area[i][v].magnitude;
        }
        if (!is_accurate(magnitude, sum)) {
            weigh(triangle, p, weights);
            sum = weights[0] + weights[1] + weights[2];
        }
        for (int i = 0; i < 3; ++i) weights[i] /= sum;
    }

    Corner crossing(int old_edge, int new_edge) const {
        Corner out{{0, 0, 0}, {0, 0, 0}};
        cut(old_, old_edge, new_, new_edge, old_sides_, out.in_old);
        cut(new_, new_edge, old_, old_edge, new_sides_, out.in_new);
        return out;
    }

    // Where `edge` of a triangle crosses edge `across` of the other; `sides` are those of the
    // corners of the first. Its ends are on different sides, and not both on the line: edges of one
    // line are thought shifted apart.
    static void cut(const Triangle3& triangle, int edge, const Triangle3& other, int across,
                    const Sides& sides, double weights[3]) {
        const int a = after(edge), b = after(a);
        const RoundedArea &from_a = sides.area[across][a], &from_b = sides.area[across][b];
        double at_a = std::fabs(from_a.value), at_b = std::fabs(from_b.value);
        if (!is_accurate(from_a.magnitude + from_b.magnitude, at_a + at_b)) {
            const Point p = other.at[after(across)], q = other.at[after(after(across))];
            at_a = std::fabs(twice_area(p, q, triangle.at[a]));
            at_b = std::fabs(twice_area(p, q, triangle.at[b]));
        }
        weights[a] = at_b / (at_a + at_b);
        weights[b] = at_a / (at_a + at_b);
    }

    static constexpr int NONE_CROSSED = -1;

    const Triangle3 &old_, &new_;
    Sides old_sides_, new_sides_;  // of the old corners, of the new corners
    bool old_edge_inside_[3] = {false, false, false};
    int count_ = 0;
    Corner begin_[6], end_[6];
};

}  // namespace adaptmesh
