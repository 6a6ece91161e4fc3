#include "adaptmesh/core/transfer/exact_location.hpp"

#include <algorithm>
#include <cmath>

#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/geometry/point.hpp"
#include "metrics/core/locator.hpp"

namespace adaptmesh {

metrics::Location ExactLocator::locate(Point p) const {
    const metrics::Location found = mesh_.locate(p.x, p.y, metrics::Locator::NO_TRIANGLE);
    if (found.outside > 0) return found;
    metrics::Index t = found.triangle;
    for (int step = 0; step < MAX_STEPS; ++step) {
        double areas[3];
        const int behind = find_areas(t, p, areas);
        if (behind == NO_EDGE) return with_weights(t, areas);
        const metrics::Index next = mesh_.neighbour(t, behind);
        if (next == metrics::Locator::NO_TRIANGLE) return nearest_on(t, behind, p);
        t = next;
    }
    return found;  // it goes in circles, in triangles that are not Delaunay
}

Point ExactLocator::corner(metrics::Index t, int i) const {
    const metrics::Locator::Vertex& v = mesh_.vertex(mesh_.corner(t, i % 3));
    return {v.x, v.y};
}

int ExactLocator::find_areas(metrics::Index t, Point p, double areas[3]) const {
    double sum = 0, magnitude = 0;
    int behind = NO_EDGE;
    for (int i = 0; i < 3; ++i) {
        RoundedArea area = rounded_twice_area(corner(t, i + 1), corner(t, i + 2), p);
        if (!area.has_sign()) {
            area.value = twice_area(corner(t, i + 1), corner(t, i + 2), p);
            area.magnitude = std::fabs(area.value);
        }
        areas[i] = area.value;
        sum += area.value, magnitude += area.magnitude;
        const bool is_inner = mesh_.neighbour(t, i) != metrics::Locator::NO_TRIANGLE;
        if (area.value < 0 && (behind == NO_EDGE || is_inner)) behind = i;
    }
    if (behind == NO_EDGE && !is_accurate(magnitude, sum)) {
        for (int i = 0; i < 3; ++i) {
            areas[i] = twice_area(corner(t, i + 1), corner(t, i + 2), p);
        }
    }
    return behind;
}

metrics::Location ExactLocator::with_weights(metrics::Index t, const double areas[3]) {
    const double sum = areas[0] + areas[1] + areas[2];
    // Divided, not scaled: at a vertex its weight is exactly 1.
    return {t, {areas[0] / sum, areas[1] / sum, areas[2] / sum}};
}

metrics::Location ExactLocator::nearest_on(metrics::Index t, int edge, Point p) const {
    const Point a = corner(t, edge + 1), b = corner(t, edge + 2);
    const double x = b.x - a.x, y = b.y - a.y;
    const double along = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    const double share = std::min(std::max(along, 0.0), 1.0);
    metrics::Location place{t, {0, 0, 0}};
    place.weight[(edge + 1) % 3] = 1 - share;
    place.weight[(edge + 2) % 3] = share;
    return place;
}

}  // namespace adaptmesh
