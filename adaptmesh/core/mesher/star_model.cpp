#include "adaptmesh/core/mesher/star_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/star.hpp"

namespace adaptmesh {

StarModel::StarModel(const MetricMesh& mesh, const Measures& measures,
                     const std::vector<Index>& polygon, Index kernel)
    : mesh_(mesh), polygon_(polygon), start_(mesh.vertices[kernel]) {
    start_log_ = metrics::log_tensor(start_.metric);
    const int n = int(polygon.size());
    for (int i = 0; i < n; ++i) {
        const Vertex& a = corner(i);
        const double measured = measures.of(kernel, polygon[i]).length;
        logs_.push_back(metrics::log_tensor(a.metric));
        was_unit_.push_back(is_unit(measured));
        length_ratio_.push_back(measured / MetricMesh::length(start_, a));
    }
    for (int i = 0; i < n; ++i) {
        const Index a = polygon[i], b = polygon[(i + 1) % n];
        sides_.push_back(measures.of(a, b).length);
        const Measured ka = measures.of(kernel, a), kb = measures.of(kernel, b);
        const double area =
            metric_area(flat_area(start_.at, i), ka, measures.of(a, b), kb.reversed());
        area_ratio_.push_back(area / (flat_area(start_.at, i) * density(start_, i)));
    }
}

Point StarModel::best_place() const {
    const MetricMesh::Frame f(start_.metric, start_.sqrt_det);
    Point best = start_.at;
    double best_worst = worst_at(best);
    for (double step = FIRST_STEP; step > LAST_STEP; step *= 0.5) {
        const Point here = best;
        for (int k = 0; k < DIRECTIONS; ++k) {
            const double angle = TURN * k / DIRECTIONS;
            const double y = std::sin(angle) / f.l22;
            const double x = (std::cos(angle) - f.l21 * y) / f.l11;
            const Point p{here.x + step * x, here.y + step * y};
            const double worst = worst_at(p);
            if (worst > best_worst) best = p, best_worst = worst;
        }
    }
    return best;
}

double StarModel::flat_area(Point p, int i) const {
    const Point a = corner(i).at, b = corner(i + 1).at;
    return 0.5 * ((a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x));
}

double StarModel::worst_at(Point at) const {
    Tensor log;
    if (!log_metric(at, log)) return 0;
    const Vertex p = Vertex::make(at, metrics::exp_tensor(log));
    const int n = int(polygon_.size());
    double worst = 1;
    const double first = length(p, 0);
    double right = first;
    for (int i = 0; i < n && worst > 0; ++i) {
        const double left = i + 1 < n ? length(p, i + 1) : first;
        if (was_unit_[i] && !is_unit(right)) return 0;
        const double area = area_ratio_[i] * flat_area(at, i) * density(p, i);
        worst = std::min(worst, quality(area, right, sides_[i], left));
        right = left;
    }
    return worst;
}

bool StarModel::log_metric(Point p, Tensor& out) const {
    for (int i = 0; i < int(polygon_.size()); ++i) {
        const Point a = corner(i).at, b = corner(i + 1).at;
        const double ax = a.x - start_.at.x, ay = a.y - start_.at.y;
        const double bx = b.x - start_.at.x, by = b.y - start_.at.y;
        const double px = p.x - start_.at.x, py = p.y - start_.at.y;
        const double area = ax * by - ay * bx;
        const double wa = (px * by - py * bx) / area, wb = (ax * py - ay * px) / area;
        if (!(wa >= 0 && wb >= 0 && wa + wb <= 1)) continue;
        out = (1 - wa - wb) * start_log_ + wa * logs_[i] + wb * logs_[(i + 1) % logs_.size()];
        return true;
    }
    return false;
}

}  // namespace adaptmesh
