// The sites of the final optimisation: stars of the mesh that may be replaced by others.
//
//      r2----r1           the ball of a                  c
//      / \  / \           free vertex                   / \         the quadrilateral around an
//    r3---v----r0                                      a---d        edge (b, c), as a star from b
//      \ /  \ /                                         \ /
//      r4----r5                                          b
#pragma once

#include <vector>

#include "adaptmesh/core/mesher/metric_field.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/star.hpp"
#include "adaptmesh/core/mesher/worst_places.hpp"

namespace adaptmesh {

struct Site {
    // Corners of the polygon around an edge: the star is from the first, a flip makes it one from
    // the last.
    static constexpr int KEPT = 0, FLIPPED = 3;

    std::vector<Place> places;  // the ball of a vertex; or an edge, as seen from both its sides
    std::vector<Index> polygon;
    Star now;
    std::vector<Star> others;  // that might take its place

    bool is_ball() const { return now.corner == Star::INSIDE; }
};

std::vector<Site> sites_at(const WorstPlaces& places, const MetricMesh& mesh);

// Measures the edges of the sites that have not been measured yet.
void measure_sites(const std::vector<Site>& sites, const MetricMesh& mesh, Measures& measures,
                   const MetricField& metric);

// The star of a site as it is.
StarMeasure measured_now(const Site& site, const MetricMesh& mesh, const Measures& measures);

// For edges of sites and of what might take their place: finer detail may pass unseen, and of
// longer edges the length does not matter.
EdgeSampler final_sampler();

}  // namespace adaptmesh
