// Lines between two vertices.
#pragma once

#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

struct Segment {
    Index a, b;
};

// A locked edge, directed as the segment it is a piece of.
struct SubEdge {
    Index a, b;
    Index segment;
    bool is_boundary = false;  // has the outside on one side; known after carving
};

}  // namespace adaptmesh
