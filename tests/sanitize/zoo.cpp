// The core over degenerate inputs, to be run under sanitizers. From the root of the project:
//
//   cmake -S . -B build/sanitize -DADAPTMESH_SANITIZE=ON && cmake --build build/sanitize
//   build/sanitize/zoo
//
// Prints what it ran; a failed check or a sanitizer ends it with an error. To add a part of the
// core: write a function that runs it on one Input and checks the outcome, and add it to PARTS.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "adaptmesh/core/edit/load.hpp"
#include "adaptmesh/core/mesher/generate.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "adaptmesh/core/validate/border_sweep.hpp"
#include "tests/sanitize/final_stage.hpp"
#include "tests/sanitize/mesher.hpp"
#include "tests/sanitize/transfer.hpp"

using namespace adaptmesh;

namespace {

Monitor monitor(20000, 1000);  // of all runs

struct Input {
    std::string name;
    std::vector<Point> points;
    std::vector<Segment> segments;
    CarveOptions options;
};

// ---- What must hold ----

void require(bool holds, const Input& input, const char* what) {
    if (holds) return;
    std::printf("FAILED on %s: %s\n", input.name.c_str(), what);
    std::exit(1);
}

bool is_ghost(const Triangle& T) {
    return (T.v[0] | T.v[1] | T.v[2]) < 0;
}

// Neighbours agree about their edge and its lock, triangles are counter-clockwise.
void check_mesh(const Triangulation& mesh, const Input& input) {
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle& T = mesh.triangles[t];
        for (int i = 0; i < 3; ++i) {
            const Index code = T.n[i];
            if (code == NONE) continue;
            const Triangle& U = mesh.triangles[triangle_of(code)];
            const int j = slot_of(code);
            require(U.n[j] == (edge_code(t, i) | (code & LOCK_BIT)), input, "links are mutual");
            require(U.v[next(j)] == T.v[prev(i)] && U.v[prev(j)] == T.v[next(i)], input,
                    "neighbours share the edge");
        }
        if (is_ghost(T)) continue;
        require(orient2d(input.points[T.v[0]], input.points[T.v[1]], input.points[T.v[2]]) > 0,
                input, "triangles are counter-clockwise");
    }
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        const Index t = mesh.triangle_at(v);
        if (t == NONE) continue;
        const Triangle& T = mesh.triangles[t];
        require(T.v[T.slot_of_vertex(v)] == v, input, "triangle_at has the vertex");
    }
}

// ---- The parts of the core ----

void run_delaunay(const Input& input) {
    std::vector<Index> duplicate_of;
    const Triangulation mesh = delaunay(input.points, duplicate_of, monitor);
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

void run_locate(const Input& input) {
    std::mt19937 random(5);
    std::vector<Index> duplicate_of;
    Triangulation hull = delaunay(input.points, duplicate_of, monitor);
    scramble(hull, input, random);
    Triangulation domain =
        triangulate(input.points, input.segments, input.options, monitor).triangulation;
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

// The border of a mesh crosses itself nowhere, and one triangle lies on the left of each edge.
void check_border(const Triangulation& mesh, const Input& input) {
    std::vector<Segment> border;
    for (const Triangle& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            if (t.n[i] == NONE) border.push_back({t.v[(i + 1) % 3], t.v[(i + 2) % 3]});
        }
    }
    const BorderSweep found = sweep_border(input.points, border, monitor);
    require(found.first == NONE, input, "no two border edges cross");
    for (Index layers : found.layers) require(layers == 1, input, "one triangle inside an edge");
}

void run_triangulate(const Input& input) {
    const ConstrainedTriangulation out =
        triangulate(input.points, input.segments, input.options, monitor);
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

// The mesh, with one metric after the other from input to input: the constrained edges are there,
// and none of them has vanished.
void run_mesher(const Input& input) {
    static std::size_t turn = 0;
    const auto& all = sanitize::metrics_of_unit_square();
    const auto sub_edges =
        triangulate(input.points, input.segments, input.options, monitor).sub_edges;
    const sanitize::MovedMetric metric(all[++turn % all.size()], input.points);
    if (!metric.is_defined()) return;
    const BoundaryCuts boundary =
        sanitize::unit_boundary(input.points, input.segments, sub_edges, metric);
    const Samples samples{input.points, boundary.tensors};

    for (Placement placement : {Placement::front, Placement::edges}) {
        const MetricMesh mesh =
            generate(boundary, input.options, samples, placement, metric.field(), monitor);
        Input result{input.name + ", meshed", {}, {}, {}};
        for (const Vertex& v : mesh.vertices) result.points.push_back(v.at);
        check_mesh(mesh.topology, result);
        std::set<std::pair<Index, Index>> locked;
        for (const EdgeSide& s : sides_of(mesh.topology)) {
            const Triangle& T = mesh.triangle(triangle_of(s.code));
            if (is_locked(T.n[slot_of(s.code)])) locked.insert({s.low, s.high});
        }
        for (const SubEdge& e : mesh.constrained) {
            require(locked.count(std::minmax(e.a, e.b)) == 1, result,
                    "constrained edges are locked edges");
        }
    }
}

// The parts of each new triangle add up to it, and each vertex is found in the old mesh.
void check_overlay(const sanitize::FlatMesh& older, const sanitize::FlatMesh& newer,
                   const Input& input) {
    if (!older.is_valid() || !newer.is_valid()) return;
    const metrics::Locator old_mesh = older.locator(), new_mesh = newer.locator();
    const Overlay overlay(old_mesh, older.areas.data(), new_mesh, newer.areas.data(), monitor);
    double area = 0;
    for (std::size_t k = 0; k < newer.areas.size(); ++k) {
        double covered = 0;
        for (std::size_t i = overlay.first()[k]; i < overlay.first()[k + 1]; ++i) {
            covered += overlay.areas()[i];
        }
        area += newer.areas[k];
        require(overlay.is_at_border(Index(k)) ||
                    std::fabs(covered - newer.areas[k]) <= 1e-12 * newer.areas[k],
                input, "parts of a new triangle add up to it");
    }

    const std::vector<double> ones(older.points.size(), 1.0);
    std::vector<double> out(newer.points.size(), 0.0);
    Moments<Linear> moments(overlay, ones.data(), 1, older.triangles.data(), 0.25, {});
    moments.add_to(out.data(), newer.triangles.data(), monitor);
    double sum = 0;
    for (double moment : out) sum += moment;
    require(std::fabs(sum - area) <= 1e-10 * area, input, "the moments of 1 are the area");

    const ExactLocator locator(old_mesh);
    for (std::int32_t v : newer.triangles) {
        const metrics::Location place = locator.locate(newer.points[v]);
        for (double weight : place.weight) {
            require(weight >= 0 && weight <= 1, input, "barycentric coordinates are from 0 to 1");
        }
    }
}

void run_transfer(const Input& input) {
    std::vector<Index> duplicate_of;
    const Triangulation hull = delaunay(input.points, duplicate_of, monitor);
    const Triangulation domain =
        triangulate(input.points, input.segments, input.options, monitor).triangulation;
    const sanitize::FlatMesh whole(input.points, hull), part(input.points, domain);
    const sanitize::FlatMesh fine = part.refined();
    check_overlay(whole, part, input);
    check_overlay(part, fine, input);
    check_overlay(fine, part, input);
    check_overlay(fine, whole, input);
}

constexpr void (*PARTS[])(const Input&) = {run_delaunay, run_locate, run_triangulate, run_mesher,
                                           run_transfer};

// ---- The inputs ----

using Shape = std::vector<Point>;

Shape grid(int nx, int ny, double step) {
    Shape out;
    for (int y = 0; y < ny; ++y) {
        for (int x = 0; x < nx; ++x) out.push_back({x * step, y * step});
    }
    return out;
}

Shape circle(int n, double radius) {
    Shape out;
    for (int k = 0; k < n; ++k) {
        const double angle = 2 * 3.141592653589793 * k / n;
        out.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return out;
}

Shape random_lattice(int n, int side, unsigned seed) {
    std::mt19937 random(seed);
    Shape out;
    for (int k = 0; k < n; ++k) {
        const double x = random() % side, y = random() % side;
        out.push_back({x, y});
    }
    return out;
}

Shape clusters(int n, double spread) {
    Shape out = random_lattice(n, 4, 1);
    std::mt19937 random(2);
    for (Point& p : out) p.x += spread * (random() % 1000), p.y += spread * (random() % 1000);
    return out;
}

Shape line(int n, Point step, Point extra) {
    Shape out = {extra};
    for (int k = 0; k < n; ++k) out.push_back({k * step.x, k * step.y});
    return out;
}

Shape parabola(int n) {
    Shape out;
    for (int k = -n; k <= n; ++k) out.push_back({double(k), double(k) * k});
    return out;
}

// A closed polygon through the last `count` points of the input.
void close_ring(Input& input, Index count) {
    const Index first = Index(input.points.size()) - count;
    for (Index k = 0; k < count; ++k) {
        input.segments.push_back({first + k, first + (k + 1) % count});
    }
}

void add_ring(Input& input, const Shape& corners) {
    input.points.insert(input.points.end(), corners.begin(), corners.end());
    close_ring(input, Index(corners.size()));
}

// Segments of random lattice points, in a frame: crossing, overlapping, touching, or none of it.
Input random_segments(unsigned seed) {
    std::mt19937 random(seed);
    Input input{"random segments " + std::to_string(seed), {}, {}, {}};
    for (Point p : random_lattice(30, 9, seed)) {
        const auto same = [p](Point q) { return p.x == q.x && p.y == q.y; };
        if (std::none_of(input.points.begin(), input.points.end(), same)) input.points.push_back(p);
    }
    const Index n = Index(input.points.size());
    for (unsigned k = 0; k < seed % 8; ++k) {
        input.segments.push_back({Index(random() % n), Index(random() % n)});
    }
    add_ring(input, {{-1, -1}, {10, -1}, {10, 10}, {-1, 10}});
    input.options.nesting = seed % 2 == 0;
    return input;
}

std::vector<Input> zoo() {
    std::vector<Input> out = {
        {"nothing", {}, {}, {}},
        {"one point", {{1, 1}}, {}, {}},
        {"one place", Shape(9, {1, 1}), {}, {}},
        {"line", line(40, {1, 1}, {50, 50}), {}, {}},
        {"line and a point", line(60, {1, 0}, {20.3, 4}), {}, {}},
        {"slope and a point", line(60, {0.1, 0.3}, {2, 6.1}), {}, {}},
        {"grid", grid(20, 15, 1), {}, {}},
        {"grid of 0.1", grid(20, 15, 0.1), {}, {}},
        {"circle", circle(200, 1), {}, {}},
        {"lattice with duplicates", random_lattice(400, 12, 3), {}, {}},
        {"clusters", clusters(300, 1e-15), {}, {}},
        {"parabola", parabola(80), {}, {}},
        {"infinite", {{0, 0}, {1, 0}, {0, INFINITY}}, {}, {}},
        {"huge and tiny", {{1e308, -1e308}, {-1e308, 1e308}, {5e-324, 0}, {0, 1e-300}}, {}, {}},
    };
    for (Input& input : std::vector<Input>(out)) {
        if (input.points.size() < 3) continue;
        input.name += ", in a ring";
        add_ring(input, circle(30, 1000));
        out.push_back(input);
    }
    Input rings{"nested rings", {}, {}, {{}, {}, true}};
    for (int k = 1; k <= 6; ++k) add_ring(rings, circle(5 * k, k));
    out.push_back(rings);
    rings.name += " with holes and regions";
    rings.options = {{{0, 0}, {0, 2.5}}, {{0, 1.5}, {0, 5.5}}, false};
    out.push_back(rings);
    Input comb{"comb", {{-1, 0}, {101, 0}}, {{0, 1}}, {}};
    for (int k = 0; k < 100; ++k) comb.points.push_back({double(k), k % 2 == 0 ? 0.01 : -0.01});
    add_ring(comb, circle(12, 300));
    out.push_back(comb);
    Input slit{"slit an ulp wide", {}, {}, {}};
    add_ring(slit, {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0.2 + 9e-16}, {1, 0.9234}, {0, 0.2}});
    out.push_back(slit);
    Input touching{"squares that touch", {}, {}, {{}, {}, true}};
    touching.points = grid(4, 4, 1);
    for (Index k : {0, 2, 5, 8, 10}) {
        for (auto [i, j] : {std::pair{0, 1}, {1, 5}, {5, 4}, {4, 0}})
            touching.segments.push_back({k + i, k + j});
    }
    out.push_back(touching);
    for (unsigned seed = 0; seed < 300; ++seed) out.push_back(random_segments(seed));
    return out;
}

Input moved(Input input, double scale, double offset) {
    const auto move = [=](Point& p) { p = {p.x * scale + offset, p.y * scale + offset}; };
    for (Point& p : input.points) move(p);
    for (Point& p : input.options.holes) move(p);
    for (Point& p : input.options.region_seeds) move(p);
    return input;
}

}  // namespace

int main() {
    sanitize::check_final_optimisation(monitor);
    int meshes = 0, faults = 0, too_large = 0;
    for (const Input& original : zoo()) {
        for (double scale : {1e-9, 1.0, 1e9}) {
            for (double offset : {0.0, 1e6}) {
                const Input input = moved(original, scale, offset);
                for (auto part : PARTS) {
                    try {
                        part(input);
                        ++meshes;
                    } catch (const InputError&) {
                        ++faults;
                    } catch (const TooManyVertices&) {
                        ++too_large;
                    }
                }
            }
        }
    }
    std::printf("%d runs, %d inputs refused, %d meshes too large\n", meshes, faults, too_large);
}
