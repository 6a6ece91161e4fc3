// Editing a part of a mesh: what is held, and how the rest is emptied, to be filled again.
#pragma once

#include <cstdint>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// The living edges, each once, with their lengths, and whether they are constrained.
struct EdgeList {
    std::vector<Index> ends;
    std::vector<double> lengths;
    std::vector<std::uint8_t> is_constrained;
};

EdgeList edge_list(const MetricMesh& mesh);

// The corners of the triangles of less quality than this.
std::vector<Index> corners_below(const MetricMesh& mesh, double quality);

// Of the vertices that nothing else holds, those in the zone become free, and the others are held.
// Returns how many are free.
Index hold_all_but(MetricMesh& mesh, const std::vector<char>& is_in_zone);

// Removes free vertices where that can be done.
void remove_free(MetricMesh& mesh, Monitor& monitor);

}  // namespace adaptmesh
