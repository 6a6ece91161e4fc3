#pragma once
#include "adaptmesh/core/delaunay.hpp"
namespace adaptmesh {
struct SubEdge { Index a, b, segment; bool boundary; };
struct ConstrainedTriangulation { Triangulation triangulation; std::vector<SubEdge> sub_edges; };
template <typename Poll>
ConstrainedTriangulation triangulate(const std::vector<Point>&, const std::vector<std::array<Index,2>>&, const std::vector<Point>&, const std::vector<Point>&, bool, Poll&) { return {}; }
}
