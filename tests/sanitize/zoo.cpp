// The core over degenerate inputs, to be run under sanitizers. From the root of the project:
//
//   cmake -S . -B build/sanitize -DADAPTMESH_SANITIZE=ON && cmake --build build/sanitize
//   build/sanitize/zoo
//
// Prints what it ran; a failed check or a sanitizer ends it with an error. To add a part of the
// core: write a function that runs it on one Input and checks the outcome, and add it to PARTS.
#include <cstdio>
#include <cstdlib>

#include "adaptmesh/core/geometry/predicates.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "tests/sanitize/input.hpp"

namespace sanitize {

void require(bool holds, const Input& input, const char* what) {
    if (holds) return;
    std::printf("FAILED on %s: %s\n", input.name.c_str(), what);
    std::exit(1);
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

}  // namespace sanitize

namespace {

using namespace sanitize;

constexpr void (*PARTS[])(const Input&) = {
    run_delaunay, run_locate,   run_triangulate,    run_mesher,   run_edit,    run_encounters,
    run_decimate, run_transfer, run_carried_metric, run_recovery, run_segments};

Input moved(Input input, double scale, double offset) {
    const auto move = [=](Point& p) { p = {p.x * scale + offset, p.y * scale + offset}; };
    for (Point& p : input.points) move(p);
    for (Point& p : input.options.holes) move(p);
    for (Point& p : input.options.region_seeds) move(p);
    return input;
}

}  // namespace

int main() {
    check_final_optimisation();
    int meshes = 0, faults = 0, too_large = 0;
    for (const Input& original : inputs()) {
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
