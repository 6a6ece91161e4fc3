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

#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/geometry/point.hpp"

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

    double area() const;

    // Barycentric coordinates of a point in a triangle, negative where it is beyond an edge.
    static void weigh(const Triangle3& triangle, Point p, double weights[3]);

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
    static bool is_shifted_left(Point a, Point b, int shift);

    static void find_sides(const Triangle3& of, const Triangle3& corners, int shift, int edge,
                           Sides& sides);

    // Whether an edge of one has the other triangle on its outer side.
    bool is_apart();

    void find_portions();

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

    Corner old_corner(int v) const;

    Corner new_corner(int v) const;

    // Barycentric coordinates of corner `v` of the other triangle, at `p` and inside.
    static void weigh_inside(const Triangle3& triangle, Point p, const Sides& sides, int v,
                             double weights[3]);

    Corner crossing(int old_edge, int new_edge) const;

    // Where `edge` of a triangle crosses edge `across` of the other; `sides` are those of the
    // corners of the first. Its ends are on different sides, and not both on the line: edges of one
    // line are thought shifted apart.
    static void cut(const Triangle3& triangle, int edge, const Triangle3& other, int across,
                    const Sides& sides, double weights[3]);

    static constexpr int NONE_CROSSED = -1;

    const Triangle3 &old_, &new_;
    Sides old_sides_, new_sides_;  // of the old corners, of the new corners
    bool old_edge_inside_[3] = {false, false, false};
    int count_ = 0;
    Corner begin_[6], end_[6];
};

}  // namespace adaptmesh
