// A triangulation whose vertices carry a position and a metric, and what is measured on it.
//
// Lengths are closed form: Simpson's rule with the metrics of the two ends and, half way, their
// geometric mean (metrics::length), corrected where the true length was measured. Quality is that
// of the mean metric of the three vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/mesher/length_corrections.hpp"
#include "adaptmesh/core/triangulation/fans.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"
#include "metrics/core/tensor.hpp"

namespace adaptmesh {

using metrics::Tensor;

// What holds a vertex: nothing, everything, only that it is not to be edited for now, or the
// segment (its number) it may slide along.
constexpr Index FREE = -1;
constexpr Index FIXED = -2;
constexpr Index HELD = -3;

// Unit edges are those between 1/sqrt(2) and sqrt(2), both included whatever the rounding: a grid
// of squares of side one is a unit mesh.
constexpr double SHORTEST_UNIT = 0.70710678118654752 * (1 - 1e-9);
constexpr double LONGEST_UNIT = 1.4142135623730950 * (1 + 1e-9);

inline bool is_unit(double length) {
    return length >= SHORTEST_UNIT && length <= LONGEST_UNIT;
}

// No vertex is put where the triangles it makes would on average have less than this metric area, a
// third of the unit triangle's. Where the metric turns within an edge, straight edges stay long
// however many vertices there are; this keeps the mesh from growing without end.
constexpr double LEAST_AREA = 0.3 * 0.43301270189221932;

// How far an edge is from unit, as a ratio of at least 1.
inline double ratio_to_unit(double length) {
    return std::max(length, 1 / length);
}

struct Vertex {
    Point at;
    Tensor metric;
    double sqrt_det;
    Index held_by;

    static Vertex make(Point at, const Tensor& metric, Index held_by = FREE) {
        return {at, metric, metrics::sqrt_det(metric), held_by};
    }
};

class MetricMesh {
  public:
    Triangulation topology;
    std::vector<Vertex> vertices;
    Corrections corrections;
    std::vector<Index> interpolated;   // vertices whose metric is still to be evaluated
    std::vector<SubEdge> constrained;  // edges on the lines of the domain, when these have been cut
    Fans fans;

    // Gives each part of the mesh its own vertex where parts touch in one; `compact` undoes it.
    void take_fans_apart();

    // The edge from a to b, or that between copies of them, as an edge of the triangle on its left.
    Place find_edge(Index a, Index b) const { return fans.find_edge(topology, a, b); }

    Index add_vertex(const Vertex& vertex) {
        vertices.push_back(vertex);
        return topology.add_vertex();
    }

    // Puts a vertex elsewhere in its ball, with the metric interpolated there.
    void move_vertex(Index v, const Vertex& moved, const std::vector<Place>& ball) {
        vertices[v] = moved;
        interpolated.push_back(v);
        for (Place p : ball) topology.triangles[p.triangle].pending = CHANGED;
    }

    const Point& at(Index v) const { return vertices[v].at; }
    const Triangle& triangle(Index t) const { return topology.triangles[t]; }

    double length(Index a, Index b) const {
        return corrections.of(a, b) * length(vertices[a], vertices[b]);
    }
    static double length(const Vertex& a, const Vertex& b) {
        return metrics::length(a.metric, a.sqrt_det, b.metric, b.sqrt_det, b.at.x - a.at.x,
                               b.at.y - a.at.y);
    }

    double quality(Index t) const {
        const Triangle& T = triangle(t);
        return quality(vertices[T.v[0]], vertices[T.v[1]], vertices[T.v[2]]);
    }

    // 4 sqrt(3) area / (sum of squared sides), measured in the mean metric: 1 for the unit
    // equilateral triangle; not positive for one that is flat or turned over.
    static double quality(const Vertex& a, const Vertex& b, const Vertex& c) {
        return 1 / inverse_quality(a, b, c);
    }

    // The determinant is that of a sum that is itself rounded: there is no point in computing it
    // with the rounding errors of its products.
    static double inverse_quality(const Vertex& a, const Vertex& b, const Vertex& c) {
        const double ux = b.at.x - a.at.x, uy = b.at.y - a.at.y;
        const double vx = c.at.x - a.at.x, vy = c.at.y - a.at.y;
        const double area2 = ux * vy - uy * vx;
        const Tensor m = a.metric + b.metric + c.metric;
        const double sides = m.q(ux, uy) + m.q(vx, vy) + m.q(vx - ux, vy - uy);
        const double diagonal = m.a * m.c;
        const double det = std::max(diagonal - m.b * m.b, metrics::DET_RESOLUTION * diagonal);
        return sides / (2 * std::sqrt(3.0) * area2 * std::sqrt(det));
    }

    // Whoever walks through all triangles need not look out for dead ones then.
    void drop_dead_triangles() {
        topology.keep_triangles([](const Triangle& t) { return t.v[0] != DEAD; });
    }

    // Drops dead triangles and the vertices that are left without any, and makes copies one with
    // their originals; numbers the rest in their order.
    void compact();

    double euclidean_area(Index t) const {
        const Triangle& T = triangle(t);
        const Point a = at(T.v[0]), b = at(T.v[1]), c = at(T.v[2]);
        return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    }

    // Whether the two triangles that a vertex at p on an edge makes of this one are positive.
    bool stays_positive(Place edge, Point p) const {
        const Triangle& T = triangle(edge.triangle);
        const Point a = at(T.v[edge.slot]), b = at(T.v[next(edge.slot)]);
        const Point c = at(T.v[prev(edge.slot)]);
        return orient2d(a, b, p) > 0 && orient2d(a, p, c) > 0;
    }

    bool is_positive(Index a, Index b, Index c) const { return orient2d(at(a), at(b), at(c)) > 0; }

    // Whether point d lies inside the circle through the counter-clockwise a, b, c in the constant
    // metric m. With the angles over the chord bc at a and d it does if cot A + cot D < 0; in
    // products with m and areas,
    //
    //           c
    //          /|\         u = b - a, v = c - a,  s = c - d, t = b - d
    //         a | d
    //          \|/         (u' m v) (s x t) + (s' m t) (u x v) < 0
    //           b
    //
    // `margin`, relative to the size of the terms, keeps ties apart. What is nearer to a tie, or
    // blurred by cancellation under slanted anisotropy, is decided in the frame of m.
    static bool in_circle(const Tensor& m, Point a, Point b, Point c, Point d, double margin) {
        const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
        const double sx = c.x - d.x, sy = c.y - d.y, tx = b.x - d.x, ty = b.y - d.y;
        const double at_a = ux * vy - uy * vx, at_d = sx * ty - sy * tx;
        const double uv_x = m.a * (ux * vx), uv_y = m.c * (uy * vy), uv = m.b * (ux * vy + uy * vx);
        const double st_x = m.a * (sx * tx), st_y = m.c * (sy * ty), st = m.b * (sx * ty + sy * tx);
        const double sum = at_d * (uv_x + uv_y + uv) + at_a * (st_x + st_y + st);
        const double size = std::abs(at_d) * (std::abs(uv_x) + std::abs(uv_y) + std::abs(uv)) +
                            std::abs(at_a) * (std::abs(st_x) + std::abs(st_y) + std::abs(st));
        if (std::abs(sum) > margin * size) return sum < 0;
        return in_circle(Frame(m), a, b, c, d, margin);
    }

    // L' of a metric m = L L'.
    struct Frame {
        double l11, l21, l22;
        explicit Frame(const Tensor& m) : Frame(m, metrics::sqrt_det(m)) {}
        Frame(const Tensor& m, double root)
            : l11(std::sqrt(m.a)), l21(m.b / l11), l22(root / l11) {}
    };

    // With m = L L' and u = L' (coordinates relative to d), the sign of the usual
    //
    //     | xa ya xa^2+ya^2 |
    //     | xb yb xb^2+yb^2 |      a sum of squares loses far less to cancellation under slanted
    //     | xc yc xc^2+yc^2 |      anisotropy than the products of m do.
    static bool in_circle(const Frame& f, Point a, Point b, Point c, Point d, double margin) {
        const auto image = [&](Point p) {
            const double dx = p.x - d.x, dy = p.y - d.y;
            return Point{f.l11 * dx + f.l21 * dy, f.l22 * dy};
        };
        const Point u = image(a), v = image(b), w = image(c);
        const double tu = (u.x * u.x + u.y * u.y) * (v.x * w.y - v.y * w.x);
        const double tv = (v.x * v.x + v.y * v.y) * (w.x * u.y - w.y * u.x);
        const double tw = (w.x * w.x + w.y * w.y) * (u.x * v.y - u.y * v.x);
        return tu + tv + tw > margin * (std::abs(tu) + std::abs(tv) + std::abs(tw));
    }
};

}  // namespace adaptmesh
