#include "adaptmesh/core/mesher/smooth.hpp"

#include <algorithm>
#include <cmath>

namespace adaptmesh {

namespace {

// The cost of a ball: (l - 1/l)^2, steepened far from unit, over its edges, and (1/Q - 1)^2 over
// its triangles.
struct BallCost {
    static constexpr double QUALITY_WEIGHT = 0.3;
    static constexpr double STEEPENING = 4.0;
    static constexpr double HOPELESS = 3.0;

    static double edge(double length) {
        const double u = length - 1 / length;
        return u * u * (1 + STEEPENING * u * u);
    }
    // Grows but slowly where it is hopeless: beside a jump of the metric no triangle is good, and
    // the edges must not suffer for it.
    static double triangle(double inverse_quality) {
        const double u = inverse_quality - 1;
        return QUALITY_WEIGHT *
               (u < HOPELESS ? u * u : HOPELESS * HOPELESS * (1 + 2 * std::log(u / HOPELESS)));
    }
};

class Smoother {
  public:
    explicit Smoother(MetricMesh& mesh)
        : mesh_(mesh), logs_(mesh.vertices.size(), Tensor{NAN, NAN, NAN}) {}

    // Moves a free vertex towards the mean of the apexes that would make the triangles of its ball
    // equilateral, as far as the cost of the ball falls; returns whether it moved.
    bool move_to_ideal(Index v) {
        if (!gather(v)) return false;
        const Vertex old = mesh_.vertices[v];
        find_flatness(old);
        Point step = step_to_ideal(old);
        const double size = std::sqrt(old.metric.q(step.x, step.y));
        if (size < SHORTEST_STEP) return false;
        gather_corrections(v);
        const double cost = cost_with_flatness(old);
        if (size > LONGEST_STEP)
            step = {step.x * LONGEST_STEP / size, step.y * LONGEST_STEP / size};
        for (double share : {1.0, 0.4, 0.16}) {
            if (try_move(v, {old.at.x + share * step.x, old.at.y + share * step.y}, cost))
                return true;
        }
        return false;
    }

    // Of the vertex last moved; one of them twice.
    const std::vector<Index>& neighbours() const { return sides_; }

    // Looks around in six directions, `step` metric units away, and takes the first that lowers the
    // cost; then once more with half the step. For the few vertices where the ideal is of no help.
    bool search_around(Index v, double step) {
        if (!gather(v)) return false;
        gather_corrections(v);
        bool moved = false;
        double cost = cost_at(mesh_.vertices[v]);
        for (int round = 0; round < 2; ++round, step *= 0.5) {
            const Vertex here = mesh_.vertices[v];
            for (int k = 0; k < 6; ++k) {
                const double angle = (k + 0.5 * round) * SIXTH_OF_TURN;
                const Point d = unit_ball_point(here.metric, std::cos(angle), std::sin(angle));
                if (try_move(v, {here.at.x + step * d.x, here.at.y + step * d.y}, cost)) {
                    cost = cost_at(mesh_.vertices[v]);
                    moved = true;
                    break;
                }
            }
        }
        return moved;
    }

  private:
    static constexpr double SIXTH_OF_TURN = 1.0471975511965977;  // pi / 3; M_PI is not standard
    static constexpr double SHORTEST_STEP = 0.03;                // not worth it, in metric units
    static constexpr double LONGEST_STEP = 0.5;
    static constexpr double WORTHWHILE = 0.9999;  // the cost must fall at least to this share
    static constexpr double FLATTEST = 1e6;       // 1 / Q from which on a place is refused

    // The ball of v: sides_[i], sides_[i + 1] are the ends of the edge opposite v in triangle i.
    bool gather(Index v) {
        if (mesh_.vertices[v].held_by != FREE) return false;
        if (mesh_.topology.triangle_at(v) == NONE || !mesh_.topology.ball(v, places_)) return false;
        sides_.clear();
        for (Place p : places_) sides_.push_back(mesh_.triangle(p.triangle).v[next(p.slot)]);
        sides_.push_back(sides_.front());
        start_ = mesh_.vertices[v].at;
        start_log_ = log_of(v);
        return true;
    }

    void gather_corrections(Index v) {
        corrections_.clear();
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i)
            corrections_.push_back(mesh_.corrections.of(v, sides_[i]));
    }

    // Finds 1 / Q of the triangles with the vertex at p; false if one is flat or turned over.
    bool find_flatness(const Vertex& p) {
        flatness_.clear();
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i) {
            const Vertex &a = mesh_.vertices[sides_[i]], &b = mesh_.vertices[sides_[i + 1]];
            const double flatness = MetricMesh::inverse_quality(p, a, b);
            if (!(flatness > 0 && flatness < FLATTEST)) return false;
            flatness_.push_back(flatness);
        }
        return true;
    }

    double cost_with_flatness(const Vertex& p) const {
        if (flatness_.size() + 1 < sides_.size()) return INFINITY;
        double cost = 0;
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i) {
            const double length = MetricMesh::length(p, mesh_.vertices[sides_[i]]);
            cost += BallCost::triangle(flatness_[i]) + BallCost::edge(corrections_[i] * length);
        }
        return cost;
    }

    double cost_at(const Vertex& p) { return find_flatness(p) ? cost_with_flatness(p) : INFINITY; }

    // For each edge (a, b) of the ball the apex of the equilateral triangle on it, in the mean
    // metric M: the middle plus sqrt(3)/2 |ab| along the M-orthogonal w, where |w|_M = sqrt(det M)
    // |ab|_M; bad triangles pull harder.
    Point step_to_ideal(const Vertex& p) const {
        double x = 0, y = 0, weights = 0;
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i) {
            const Vertex &a = mesh_.vertices[sides_[i]], &b = mesh_.vertices[sides_[i + 1]];
            const Tensor m = (1.0 / 3) * (a.metric + b.metric + p.metric);
            const double ex = b.at.x - a.at.x, ey = b.at.y - a.at.y;
            const double wx = -(m.b * ex + m.c * ey), wy = m.a * ex + m.b * ey;
            // A side of length 1 is the aim, whatever the length of (a, b).
            const double height = 0.5 * std::sqrt(3.0) / std::sqrt(m.q(wx, wy));
            const double weight = i < flatness_.size() ? std::min(flatness_[i], 1e3) : 1e3;
            x += weight * (0.5 * (a.at.x + b.at.x) + height * wx);
            y += weight * (0.5 * (a.at.y + b.at.y) + height * wy);
            weights += weight;
        }
        return {x / weights - p.at.x, y / weights - p.at.y};
    }

    bool try_move(Index v, Point to, double cost) {
        Tensor log;
        if (!log_metric(to, log)) return false;
        const Vertex moved = Vertex::make(to, metrics::exp_tensor(log));
        if (!(cost_at(moved) < WORTHWHILE * cost) || !is_positive_from(to)) return false;
        mesh_.move_vertex(v, moved, places_);
        logs_[v] = log;
        return true;
    }

    bool is_positive_from(Point p) const {
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i) {
            if (orient2d(p, mesh_.at(sides_[i]), mesh_.at(sides_[i + 1])) <= 0) return false;
        }
        return true;
    }

    // P1 interpolation of log M in the ball as it was before the vertex moved; false outside it.
    bool log_metric(Point p, Tensor& out) {
        for (std::size_t i = 0; i + 1 < sides_.size(); ++i) {
            const Point a = mesh_.at(sides_[i]), b = mesh_.at(sides_[i + 1]);
            const double ax = a.x - start_.x, ay = a.y - start_.y;
            const double bx = b.x - start_.x, by = b.y - start_.y;
            const double px = p.x - start_.x, py = p.y - start_.y;
            const double area = ax * by - ay * bx;
            const double wa = (px * by - py * bx) / area, wb = (ax * py - ay * px) / area;
            if (!(wa >= 0 && wb >= 0 && wa + wb <= 1)) continue;
            out = (1 - wa - wb) * start_log_ + wa * log_of(sides_[i]) + wb * log_of(sides_[i + 1]);
            return true;
        }
        return false;
    }

    // Logarithms are taken when first asked for, and kept.
    const Tensor& log_of(Index v) {
        if (std::isnan(logs_[v].a)) logs_[v] = metrics::log_tensor(mesh_.vertices[v].metric);
        return logs_[v];
    }

    // The vector of metric length one that the frame of the metric turns (c, s) into: with
    // M = L L', it is L'^-1 (c, s).
    static Point unit_ball_point(const Tensor& m, double c, double s) {
        const double l11 = std::sqrt(m.a), l21 = m.b / l11, l22 = metrics::sqrt_det(m) / l11;
        const double y = s / l22;
        return {(c - l21 * y) / l11, y};
    }

    MetricMesh& mesh_;
    std::vector<Tensor> logs_;
    std::vector<Place> places_;
    std::vector<Index> sides_;
    std::vector<double> flatness_;     // 1 / Q of the triangles, up to the first that is refused
    std::vector<double> corrections_;  // of the edges from the vertex to the first of each side
    Point start_{};
    Tensor start_log_{};
};

}  // namespace

Index smooth_changed(MetricMesh& mesh, Monitor& monitor) {
    std::vector<char> is_due(mesh.vertices.size(), 0);
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        Triangle& T = mesh.topology.triangles[t];
        if (!(T.pending & TO_SMOOTH) || mesh.topology.is_dead(t)) continue;
        T.pending &= ~TO_SMOOTH;
        for (Index v : T.v) is_due[v] = 1;
    }
    Smoother smoother(mesh);
    Index moved = 0;
    for (Index v = 0; v < Index(mesh.vertices.size()); ++v) {
        monitor.poll(v);
        if (!is_due[v] || !smoother.move_to_ideal(v)) continue;
        ++moved;
        for (Index w : smoother.neighbours()) is_due[w] = 1;  // those before v, in the next pass
    }
    return moved;
}

Index search_around(MetricMesh& mesh, const std::vector<Index>& vertices, double step,
                    Monitor& monitor) {
    Smoother smoother(mesh);
    Index moved = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        monitor.poll(i);
        moved += smoother.search_around(vertices[i], step);
    }
    return moved;
}

}  // namespace adaptmesh
