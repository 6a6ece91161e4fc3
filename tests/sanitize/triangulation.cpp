// Delaunay triangulations, constrained and not.
#include <random>
#include <vector>

#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "adaptmesh/core/triangulation/delaunay.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"
#include "adaptmesh/core/validate/border_sweep.hpp"
#include "tests/sanitize/input.hpp"

namespace sanitize {

void run_delaunay(const Input& input) {
    std::vector<Index> duplicate_of;
    const Triangulation mesh = delaunay(input.points, duplicate_of, monitor());
    check_mesh(mesh, input);
    // Every point is found where it is, from anywhere.
    const auto at = [&input](Index v) { return input.points[v]; };
    for (std::size_t i = 0; i < input.points.size(); ++i) {
        const Index start = Index(i) % mesh.triangle_count();
        const Location found = locate(mesh, at, input.points[i], start);
        require(found.where == Where::on_vertex, input, "a point is at a vertex");
        require(mesh.triangles[found.triangle].v[found.slot] == duplicate_of[i], input,
                "a point is at its own vertex");
    }
}

namespace {

// Flips edges at random, so that nothing of Delaunay is left for a walk to rely on.
void scramble(Triangulation& mesh, const Input& input, std::mt19937& random) {
    const auto side = [&input](Index a, Index b, Index c) {
        return orient2d(input.points[a], input.points[b], input.points[c]);
    };
    for (Index k = 0; k < 6 * mesh.triangle_count(); ++k) {
        const Place edge{Index(random() % mesh.triangles.size()), int(random() % 3)};
        const Triangle& T = mesh.triangles[edge.triangle];
        const Index code = T.n[edge.slot];
        if (is_locked(code) || is_ghost(T) || is_ghost(mesh.triangles[triangle_of(code)])) continue;
        const Index a = T.v[edge.slot], b = T.v[next(edge.slot)], c = T.v[prev(edge.slot)];
        const Index d = mesh.triangles[triangle_of(code)].v[slot_of(code)];
        if (side(a, b, d) > 0 && side(a, d, c) > 0) mesh.flip(edge);
    }
}

// The walk's answer is true: p is in or on what it names, or beyond a wall.
void check_location(const Triangulation& mesh, const Input& input, Point p, Location found,
                    Walls walls) {
    const Triangle& T = mesh.triangles[found.triangle];
    require(!is_ghost(T), input, "a location is in a real triangle");
    const auto at = [&input](Index v) { return input.points[v]; };
    int side[3];
    for (int i = 0; i < 3; ++i) side[i] = detail::side_of_edge(T, i, at, p);
    const int s = found.slot;
    switch (found.where) {
        case Where::in_triangle:
            require(side[0] > 0 && side[1] > 0 && side[2] > 0, input, "in the triangle");
            break;
        case Where::on_edge:
            require(side[s] == 0 && side[next(s)] > 0 && side[prev(s)] > 0, input, "on the edge");
            break;
        case Where::on_vertex:
            require(at(T.v[s]).x == p.x && at(T.v[s]).y == p.y, input, "on the vertex");
            break;
        case Where::outside:
            require(side[s] < 0 && detail::is_wall(mesh, T.n[s], walls), input, "beyond a wall");
            break;
    }
}

}  // namespace

void run_locate(const Input& input) {
    std::mt19937 random(5);
    std::vector<Index> duplicate_of;
    Triangulation hull = delaunay(input.points, duplicate_of, monitor());
    scramble(hull, input, random);
    Triangulation domain =
        triangulate(input.points, input.segments, input.options, monitor()).triangulation;
    scramble(domain, input, random);

    const auto at = [&input](Index v) { return input.points[v]; };
    for (int k = 0; k < 300; ++k) {
        const Point a = input.points[random() % input.points.size()];
        const Point b = input.points[random() % input.points.size()];
        const Point p{a.x / 2 + b.x / 2, a.y / 2 + b.y / 2};  // in the hull, but for rounding
        Location found = locate(hull, at, p, Index(random() % hull.triangles.size()));
        check_location(hull, input, p, found, Walls::border);
        if (found.where == Where::outside) {
            found = detail::locate_by_search(hull, at, p, found);
            require(found.where == Where::outside, input,
                    "a walk in a convex hull finds the point");
        }
        for (Walls walls : {Walls::border, Walls::locked_edges}) {
            const Index start = Index(random() % domain.triangles.size());
            check_location(domain, input, p, locate(domain, at, p, start, walls), walls);
        }
    }
}

namespace {

// The border of a mesh crosses itself nowhere, and one triangle lies on the left of each edge.
void check_border(const Triangulation& mesh, const Input& input) {
    std::vector<Segment> border;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            if (t.n[i] == NONE) border.push_back({t.v[(i + 1) % 3], t.v[(i + 2) % 3]});
        }
    }
    const BorderSweep found = sweep_border(input.points, border, monitor());
    require(found.first == NONE, input, "no two border edges cross");
    for (Index layers : found.layers) require(layers == 1, input, "one triangle inside an edge");
}

}  // namespace

void run_triangulate(const Input& input) {
    const ConstrainedTriangulation out =
        triangulate(input.points, input.segments, input.options, monitor());
    check_mesh(out.triangulation, input);
    std::size_t locked = 0, border = 0;
    for (const Triangle& t : out.triangulation.triangles) {
        for (Index code : t.n) (code == NONE ? border : locked) += is_locked(code);
    }
    std::size_t boundary = 0;
    for (const SubEdge& e : out.sub_edges) boundary += e.is_boundary;
    require(border == boundary, input, "the border is the boundary edges");
    require(locked == 2 * (out.sub_edges.size() - boundary), input,
            "the other sub-edges are locked");
    check_border(out.triangulation, input);
}

}  // namespace sanitize
