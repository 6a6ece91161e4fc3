// Where a point is in a mesh, by exact signs, and its barycentric coordinates without cancellation.
//
// The locator of metrics decides in doubles, in which a point can lie in the triangle next to its
// own, or, on a slanted border, outside. Its distance from there is of the order of rounding; but
// the barycentric coordinates of a thin triangle change by a multiple of that. A few more steps, by
// exact signs, lead to the triangle that has the point.
#pragma once

#include <algorithm>
#include <cmath>

#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/geometry/point.hpp"
#include "metrics/core/locator.hpp"

namespace adaptmesh {

class ExactLocator {
  public:
    explicit ExactLocator(const metrics::Locator& mesh) : mesh_(mesh) {}

    // As from the locator: for a point outside, the nearest point of the border. Of a point that
    // is outside by rounding the distance is given as 0.
    metrics::Location locate(Point p) const;

  private:
    static constexpr int MAX_STEPS = 16;
    static constexpr int NO_EDGE = -1;

    Point corner(metrics::Index t, int i) const;

    // Twice the areas that the point spans with the edges; and an edge it is behind, one with a
    // triangle across rather than one of the border.
    int find_areas(metrics::Index t, Point p, double areas[3]) const;

    static metrics::Location with_weights(metrics::Index t, const double areas[3]);

    metrics::Location nearest_on(metrics::Index t, int edge, Point p) const;

    const metrics::Locator& mesh_;
};

}  // namespace adaptmesh
