// What the star of a vertex would measure with its kernel elsewhere, before the metric there is
// known: read from its own polygon, P1 and log-Euclidean, and corrected by what was measured of the
// star as it is.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/star.hpp"

namespace adaptmesh {

class StarModel {
  public:
    // Of the star of a vertex inside its polygon, whose spokes and sides have been measured.
    StarModel(const MetricMesh& mesh, const Measures& measures, const std::vector<Index>& polygon,
              Index kernel)
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

    // Where the worst triangle would be best, without an edge that is no more unit: looks around in
    // eight directions, and goes on from the best place with ever smaller steps.
    Point best_place() const {
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

  private:
    static constexpr double FIRST_STEP = 0.24, LAST_STEP = 0.02;  // in metric lengths
    static constexpr int DIRECTIONS = 8;
    static constexpr double TURN = 6.283185307179586;

    const Vertex& corner(int i) const { return mesh_.vertices[polygon_[i % polygon_.size()]]; }

    double flat_area(Point p, int i) const {
        const Point a = corner(i).at, b = corner(i + 1).at;
        return 0.5 * ((a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x));
    }

    double density(const Vertex& p, int i) const {
        return std::cbrt(p.sqrt_det * corner(i).sqrt_det * corner(i + 1).sqrt_det);
    }

    // The worst quality with the kernel at p; not positive where it must not be.
    double worst_at(Point at) const {
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

    double length(const Vertex& p, int i) const {
        return length_ratio_[i] * MetricMesh::length(p, corner(i));
    }

    // In the triangle of the star that holds p; false outside.
    bool log_metric(Point p, Tensor& out) const {
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
