#include "adaptmesh/core/triangulation/delaunay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/hilbert.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "adaptmesh/core/triangulation/insert.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

namespace {

void check_points(const std::vector<Point>& points) {
    if (points.size() > std::size_t(MAX_TRIANGLES) / 2 - 2) {
        throw InputError(InputFault::too_many_points, Index(points.size()));
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Point p = points[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y))
            throw InputError(InputFault::not_finite, Index(i), NONE, p);
    }
    if (points.size() < 3) throw InputError(InputFault::too_few_points, Index(points.size()));
}

// The triangle (a, b, c) and its three ghosts:
//
//       \     /
//        \   /             Ghost i lies across edge i of the triangle and has the ghost vertex in
//     1    c    0          its slot 0. Two ghosts share the edge from a corner out to infinity.
//         / \              .
//        / t \             .
//   ----a-----b----
//          2
void first_triangle(Triangulation& mesh, Index a, Index b, Index c) {
    const Index v[3] = {a, b, c};
    const Index t = mesh.add_triangle(a, b, c);
    Index ghost[3];
    for (int i = 0; i < 3; ++i) {
        ghost[i] = mesh.add_triangle(GHOST, v[prev(i)], v[next(i)]);
        mesh.link(t, i, edge_code(ghost[i], 0));
    }
    // Ghost i is (GHOST, v[prev(i)], v[next(i)]). Its edge 1, at v[next(i)], is edge 2 of the ghost
    // across the other side at that corner, which is side prev(i).
    for (int i = 0; i < 3; ++i) mesh.link(ghost[i], 1, edge_code(ghost[prev(i)], 2));
}

// Three points of `points` that span a triangle; faults if there are none.
std::array<Index, 3> spanning_triple(const std::vector<Point>& points) {
    const Index count = Index(points.size());
    const Point a = points[0];
    Index j = 1;
    while (j < count && points[j].x == a.x && points[j].y == a.y) ++j;
    for (Index k = j + 1; k < count; ++k) {
        const int turn = orient2d(a, points[j], points[k]);
        if (turn > 0) return {0, j, k};
        if (turn < 0) return {0, k, j};
    }
    throw InputError(InputFault::all_collinear);
}

// The order of insertion: the whole curve at a stride, then again at finer and finer ones. The
// coarse rounds spread over everything, so that no order of the input (a line, a circle, a
// parabola) lets a point see more than a few others, and each round walks along the curve.
template <typename Visit>
void coarse_to_fine(Index count, const Visit& visit) {
    constexpr Index RATIO = 8;
    Index stride = 1;
    while (stride < count / 64) stride *= RATIO;
    for (Index i = 0; i < count; i += stride) visit(i);
    for (; stride > 1; stride /= RATIO) {
        const Index step = stride / RATIO;
        for (Index i = step; i < count; i += step) {
            if (i % stride != 0) visit(i);
        }
    }
}

}  // namespace

Triangulation delaunay(const std::vector<Point>& points, std::vector<Index>& duplicate_of,
                       Monitor& monitor) {
    check_points(points);
    // All work is on copies of the points in the order of the curve: near in the plane is near in
    // memory. The vertices are renamed at the end.
    std::vector<Index> name = hilbert_order(points);
    std::vector<Point> sorted(points.size());
    for (std::size_t i = 0; i < name.size(); ++i) sorted[i] = points[name[i]];
    const auto at = [&sorted](Index v) { return sorted[v]; };
    const Index count = Index(points.size());

    Triangulation mesh;
    mesh.reserve(count);
    for (Index v = 0; v < count; ++v) mesh.add_vertex();
    const auto [a, b, c] = spanning_triple(sorted);
    first_triangle(mesh, a, b, c);

    std::vector<std::pair<Index, Index>> doubles;  // a point, and the vertex in its place
    std::vector<Place> scratch;
    Index home = 0;
    std::size_t done = 0;
    coarse_to_fine(count, [&, a = a, b = b, c = c](Index v) {
        if (v == a || v == b || v == c) return;
        monitor.poll(++done);
        const Location where = locate(mesh, at, sorted[v], home);
        if (where.where == Where::on_vertex) {
            doubles.push_back({v, mesh.triangles[where.triangle].v[where.slot]});
            return;
        }
        insert_vertex(mesh, at, v, where, scratch);
        home = mesh.triangle_at(v);
    });

    duplicate_of.resize(points.size());
    for (Index i = 0; i < count; ++i) duplicate_of[i] = i;
    // Of equal points the one with the lowest number is the vertex, whichever was inserted.
    for (const auto& [v, vertex] : doubles) {
        if (name[v] < name[vertex]) std::swap(name[v], name[vertex]);
    }
    for (const auto& [v, vertex] : doubles) duplicate_of[name[v]] = name[vertex];
    mesh.rename_vertices(name);
    return mesh;
}

}  // namespace adaptmesh
