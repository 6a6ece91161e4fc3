// Stars that might take the place of the sites of the final optimisation: a vertex moved, pulled
// into a neighbour or put on an edge, an edge flipped.
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/sites.hpp"
#include "adaptmesh/core/monitor.hpp"

namespace adaptmesh {

// What the changes are for: to give stars the least cost, or to make their worst triangles better.
struct Aim {
    enum class Goal { least_cost, best_worst } goal;
    double min_quality;  // triangles of this quality are good enough
    double step;         // how far vertices are moved, as a share of the way to their polygon

    // Whether a star is to be left alone.
    bool is_met_by(const StarMeasure& m) const {
        return m.worst_quality >= min_quality && (goal == Goal::best_worst || m.off_unit == 0);
    }
};

// Adds to each site what might take its place, with the metric there; drops those that are good.
void propose(std::vector<Site>& sites, const MetricMesh& mesh, const Measures& measures,
             const Aim& aim, const MetricField& metric, Monitor& monitor);

// Measures the edges that the proposals would make; Star::proposal tells where they are.
EdgeSampler measured_proposals(std::vector<Site>& sites, const MetricMesh& mesh,
                               const MetricField& metric);

}  // namespace adaptmesh
