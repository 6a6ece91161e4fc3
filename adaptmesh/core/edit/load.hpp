// A mesh that is already there, made into one that can be edited.
#pragma once

#include <array>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"

namespace adaptmesh {

// Throws std::invalid_argument where triangles are not a mesh. `locked` are constrained edges.
MetricMesh load(std::vector<Vertex> vertices, const std::vector<std::array<Index, 3>>& triangles,
                const std::vector<Index>& labels, const std::vector<Segment>& locked);

}  // namespace adaptmesh
