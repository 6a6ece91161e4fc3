// Where the final optimisation is to work: at edges that are not unit and at bad triangles.
#pragma once

#include <cstddef>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"

namespace adaptmesh {

struct WorstPlaces {
    std::vector<Index> edges;     // codes, each seen from one side
    std::vector<char> is_centre;  // of each vertex, whether its ball is to be worked on
};

// Of what has changed since the last call: edges that are not unit and those of triangles below a
// quality, and the corners of all triangles beside them.
WorstPlaces take_changed_off_unit(MetricMesh& mesh, double min_quality);

// Of what has changed, or was passed over, since the last call: the worst triangle if it is below a
// quality, and others that are not much better, so many at most; with their edges and corners.
WorstPlaces take_changed_worst(MetricMesh& mesh, double below, std::size_t max_triangles);

}  // namespace adaptmesh
