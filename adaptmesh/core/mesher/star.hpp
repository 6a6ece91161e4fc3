// A polygon of the mesh filled with triangles from one point, its kernel. Every operator of the
// optimiser replaces one star by another on the same polygon:
//
//      r2----r1        move, collapse: the polygon is the rim of the ball of a vertex; the new
//      / \  / \                        kernel is elsewhere inside, or one of its corners
//    r3---k----r0      flip:           the polygon is the quadrilateral around an edge; the kernel
//      \ /  \ /                        goes from one corner to the next
//      r4----r5        split:          the same quadrilateral; the kernel goes inside
//
// Stars are judged by the exact metric along their spokes and sides, not by its values at the ends:
// this is what counts where the metric jumps or turns within an edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "adaptmesh/core/geometry/proper_triangle.hpp"
#include "adaptmesh/core/mesher/edge_sampler.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/triangulation/edge_map.hpp"

namespace adaptmesh {

// How bad edges and triangles are. Among edges the aim is that few are off unit: so one that is far
// off costs but little more than one that is just off.
struct StarCost {
    static constexpr double OFF_UNIT = 2.0;
    static constexpr double FAR_OFF = 2.0;
    static constexpr double QUALITY_WEIGHT = 0.3;
    static constexpr double HOPELESS = 4;

    static double edge(double length) {
        const double ratio = ratio_to_unit(length), within = std::min(ratio, LONGEST_UNIT);
        const double u = within - 1 / within;
        return u * u * (1 + 4 * u * u) + off_unit(ratio);
    }
    // The part of an edge's cost that is for not being unit.
    static double off_unit(double ratio) {
        return ratio <= LONGEST_UNIT ? 0 : OFF_UNIT + FAR_OFF * std::log(ratio / LONGEST_UNIT);
    }
    static double triangle(double quality) {
        const double u = 1 / std::max(quality, 1e-12) - 1;
        return QUALITY_WEIGHT *
               (u < HOPELESS ? u * u : HOPELESS * HOPELESS * (1 + 0.25 * std::log(u / HOPELESS)));
    }
};

// What the exact metric says of an edge, from one end to the other.
struct Measured {
    double length;
    std::array<double, 2> moments;  // EdgeSampler::moments
    double middle;                  // EdgeSampler::middle

    Measured reversed() const { return {length, {moments[1], moments[0]}, 1 - middle}; }
    static Measured of(const EdgeSampler& sampler, Index e) {
        return {sampler.lengths()[e], sampler.moments(e), sampler.middle(e)};
    }
};

// What was measured of the edges of the mesh, with the exact metric at their ends where they are
// now. Who moves an end measures its edges again.
class Measures {
  public:
    bool knows(Index a, Index b) const { return table_.find(a, b); }
    Measured of(Index a, Index b) const {
        const Measured& m = *table_.find(a, b);
        return a < b ? m : m.reversed();
    }
    void set(Index a, Index b, const Measured& m) { table_.set(a, b, a < b ? m : m.reversed()); }

  private:
    EdgeMap<Measured> table_;
};

// The metric area of a triangle with corners k, a, b, from what was measured along its sides:
// sqrt(det M) is integrated over thin triangles along the two sides at a corner, in the mean. Where
// the metric jumps that depends on the corner, and the least counts: of a thin fine strip at one
// side the corner opposite knows best.
inline double metric_area(double area, const Measured& ka, const Measured& ab, const Measured& bk) {
    const auto seen_from = [](const Measured& out, const Measured& in) {
        return out.moments[0] + in.moments[1];
    };
    return 0.5 * area * std::min(seen_from(ka, bk), std::min(seen_from(ab, ka), seen_from(bk, ab)));
}

inline double quality(double metric_area, double side1, double side2, double side3) {
    const double squares = side1 * side1 + side2 * side2 + side3 * side3;
    return std::min(1.0, 4 * std::sqrt(3.0) * metric_area / squares);
}

struct Star {
    static constexpr int INSIDE = -1;

    Vertex kernel;
    Index vertex;        // the number of the kernel; NONE if it is not in the mesh
    int corner;          // of the polygon, where the kernel is; or INSIDE
    Index proposal = 0;  // number of its first spoke among those proposed
};

// A star on its polygon, whose corners are counter-clockwise. The rim are the ends of all edges
// from the kernel, in order; a corner of the polygon has its two sides for the first and last.
class StarView {
  public:
    StarView(const std::vector<Index>& corners, const Star& star)
        : corners_(corners), star_(star), is_inside_(star.corner == Star::INSIDE) {}

    int triangle_count() const { return size() - (is_inside_ ? 0 : 2); }
    // Triangle i is that of the kernel, rim(i) and rim(i + 1).
    Index rim(int i) const { return corners_[(star_.corner + 1 + i) % size()]; }
    int first_spoke() const { return is_inside_ ? 0 : 1; }
    int end_of_spokes() const { return is_inside_ ? size() : size() - 2; }

    bool is_proper(const MetricMesh& mesh) const {
        for (int i = 0; i < triangle_count(); ++i) {
            if (!is_proper_triangle(star_.kernel.at, mesh.at(rim(i)), mesh.at(rim(i + 1))))
                return false;
        }
        return true;
    }

  private:
    int size() const { return int(corners_.size()); }

    const std::vector<Index>& corners_;
    const Star& star_;
    bool is_inside_;
};

struct StarMeasure {
    static constexpr double ERROR = 0.01;  // of lengths as measured

    double cost = 0;
    double area = 0;
    double worst_quality = 1;
    double off_unit = 0;         // cost of spokes for not being unit
    double nearly_off_unit = 0;  // what it would be if all were longer, or shorter, by the error
};

// `edge_to(i)` is what was measured from the kernel to rim(i).
template <typename EdgeTo>
StarMeasure measure(const MetricMesh& mesh, const Measures& sides, const StarView& star, Point at,
                    const EdgeTo& edge_to) {
    StarMeasure out;
    for (int i = star.first_spoke(); i < star.end_of_spokes(); ++i) {
        const double length = edge_to(i).length, ratio = ratio_to_unit(length);
        out.cost += StarCost::edge(length);
        out.off_unit += StarCost::off_unit(ratio);
        out.nearly_off_unit += StarCost::off_unit((1 + StarMeasure::ERROR) * ratio);
    }
    Measured left = edge_to(0);
    for (int i = 0; i < star.triangle_count(); ++i) {
        const Measured right = left, across = sides.of(star.rim(i), star.rim(i + 1));
        left = edge_to(i + 1);
        const Point a = mesh.at(star.rim(i)), b = mesh.at(star.rim(i + 1));
        const double flat = 0.5 * ((a.x - at.x) * (b.y - at.y) - (a.y - at.y) * (b.x - at.x));
        const double area = metric_area(flat, right, across, left.reversed());
        const double q = quality(area, right.length, across.length, left.length);
        out.area += area;
        out.cost += StarCost::triangle(q);
        out.worst_quality = std::min(out.worst_quality, q);
    }
    return out;
}

}  // namespace adaptmesh
