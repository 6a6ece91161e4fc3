// What the parts of the core are run on, and what must hold of the outcome.
#pragma once

#include <string>
#include <vector>

#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/carve.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"

namespace sanitize {

using namespace adaptmesh;

struct Input {
    std::string name;
    std::vector<Point> points;
    std::vector<Segment> segments;
    CarveOptions options;
};

// Degenerate and ordinary ones.
std::vector<Input> inputs();

// Of all runs: meshes are small.
inline Monitor& monitor() {
    static Monitor small(20000, 1000);
    return small;
}

// Ends the program unless it holds.
void require(bool holds, const Input& input, const char* what);

inline bool is_ghost(const Triangle& T) {
    return (T.v[0] | T.v[1] | T.v[2]) < 0;
}

// Neighbours agree about their edge and its lock, triangles are counter-clockwise.
void check_mesh(const Triangulation& mesh, const Input& input);

// The parts of the core. An input that a part refuses is an InputError, or TooManyVertices.
void run_delaunay(const Input& input);
void run_locate(const Input& input);
void run_triangulate(const Input& input);
void run_mesher(const Input& input);
void run_edit(const Input& input);
void run_encounters(const Input& input);
void run_decimate(const Input& input);
void run_transfer(const Input& input);
void run_carried_metric(const Input& input);
void run_recovery(const Input& input);
void run_segments(const Input& input);

// The last stage of the mesher, on metrics of the unit square.
void check_final_optimisation();

}  // namespace sanitize
