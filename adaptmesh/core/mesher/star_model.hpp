// What the star of a vertex would measure with its kernel elsewhere, before the metric there is
// known: read from its own polygon, P1 and log-Euclidean, and corrected by what was measured of the
// star as it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/star.hpp"

namespace adaptmesh {

class StarModel {
  public:
    // Of the star of a vertex inside its polygon, whose spokes and sides have been measured.
    StarModel(const MetricMesh& mesh, const Measures& measures, const std::vector<Index>& polygon,
              Index kernel);

    // Where the worst triangle would be best, without an edge that is no more unit: looks around in
    // eight directions, and goes on from the best place with ever smaller steps.
    Point best_place() const;

  private:
    static constexpr double FIRST_STEP = 0.24, LAST_STEP = 0.02;  // in metric lengths
    static constexpr int DIRECTIONS = 8;
    static constexpr double TURN = 6.283185307179586;

    const Vertex& corner(int i) const { return mesh_.vertices[polygon_[i % polygon_.size()]]; }

    double flat_area(Point p, int i) const;

    double density(const Vertex& p, int i) const {
        return std::cbrt(p.sqrt_det * corner(i).sqrt_det * corner(i + 1).sqrt_det);
    }

    // The worst quality with the kernel at p; not positive where it must not be.
    double worst_at(Point at) const;

    double length(const Vertex& p, int i) const {
        return length_ratio_[i] * MetricMesh::length(p, corner(i));
    }

    // In the triangle of the star that holds p; false outside.
    bool log_metric(Point p, Tensor& out) const;

    const MetricMesh& mesh_;
    const std::vector<Index>& polygon_;
    const Vertex start_;
    Tensor start_log_;
    std::vector<Tensor> logs_;          // of the metrics at the corners of the polygon
    std::vector<char> was_unit_;        // of spokes
    std::vector<double> length_ratio_;  // of spokes, what was measured to the closed form
    std::vector<double> area_ratio_;    // of triangles
    std::vector<double> sides_;         // lengths of the polygon's sides
};

}  // namespace adaptmesh
