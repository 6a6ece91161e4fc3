#include "adaptmesh/core/mesher/proposals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "adaptmesh/core/mesher/star_model.hpp"

namespace adaptmesh {

namespace {

constexpr int DIRECTIONS = 4;
constexpr double TWO_PI = 6.283185307179586;
constexpr std::size_t MAX_COLLAPSES = 4;

// Adds proposals to sites. The metric at new kernels is unknown yet: that of the site is taken.
class Proposer {
  public:
    Proposer(const MetricMesh& mesh, const Measures& measures, const Aim& aim)
        : mesh_(mesh), measures_(measures), aim_(aim) {}

    void propose_all(Site& site) const {
        if (!site.is_ball()) {
            constexpr int flipped = Site::FLIPPED;
            propose(site, {mesh_.vertices[site.polygon[flipped]], site.polygon[flipped], flipped});
            propose_split(site);
        } else if (aim_.goal == Aim::Goal::best_worst) {
            propose_best_place(site);
        } else {
            propose_collapses(site);
            propose_moves(site);
        }
    }

  private:
    void propose(Site& site, const Star& star) const {
        if (StarView(site.polygon, star).is_proper(mesh_)) site.others.push_back(star);
    }

    void propose_at(Site& site, Point at) const {
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) return;
        propose(site, {Vertex::make(at, site.now.kernel.metric), NONE, Star::INSIDE});
    }

    void propose_split(Site& site) const {
        const Index b = site.polygon[Site::KEPT], c = site.polygon[2];
        const Measured edge = measures_.of(b, c);
        if (edge.length <= LONGEST_UNIT) return;
        const Point p = mesh_.at(b), q = mesh_.at(c);
        propose_at(site, {p.x + edge.middle * (q.x - p.x), p.y + edge.middle * (q.y - p.y)});
    }

    // Into the corners at the ends of the shortest spokes.
    void propose_collapses(Site& site) const {
        std::vector<std::pair<double, int>> spokes;
        for (int i = 0; i < int(site.polygon.size()); ++i)
            spokes.push_back({measures_.of(site.now.vertex, site.polygon[i]).length, i});
        std::sort(spokes.begin(), spokes.end());
        if (spokes.size() > MAX_COLLAPSES) spokes.resize(MAX_COLLAPSES);
        for (auto [length, corner] : spokes) {
            const Index v = site.polygon[corner];
            if (length < 1) propose(site, {mesh_.vertices[v], v, corner});
        }
    }

    // In some directions, turned a little from round to round, a share of the way to the polygon:
    // beside a jump the metric at the vertex does not tell how far that is.
    void propose_moves(Site& site) const {
        const double step = aim_.step;
        const Vertex v = site.now.kernel;
        const MetricMesh::Frame f(v.metric, v.sqrt_det);
        for (int k = 0; k < DIRECTIONS; ++k) {
            const double angle = TWO_PI * k / DIRECTIONS + step;
            const double y = std::sin(angle) / f.l22, x = (std::cos(angle) - f.l21 * y) / f.l11;
            const double reach = step * distance_to(site.polygon, v.at, x, y);
            propose_at(site, {v.at.x + reach * x, v.at.y + reach * y});
        }
    }

    // Where the worst triangle would be best as far as can be told.
    void propose_best_place(Site& site) const {
        const Point from = site.now.kernel.at;
        const Point to = StarModel(mesh_, measures_, site.polygon, site.now.vertex).best_place();
        if (to.x == from.x && to.y == from.y) return;
        propose_at(site, to);
        propose_at(site, {0.5 * (from.x + to.x), 0.5 * (from.y + to.y)});
    }

    // From p along the vector (x, y) to the polygon, in lengths of it.
    double distance_to(const std::vector<Index>& polygon, Point p, double x, double y) const {
        double nearest = INFINITY;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Point a = mesh_.at(polygon[i]), b = mesh_.at(polygon[(i + 1) % polygon.size()]);
            const double ex = b.x - a.x, ey = b.y - a.y;
            const double speed = x * ey - y * ex;  // towards the line of the side, from its left
            if (speed > 0)
                nearest = std::min(nearest, ((a.x - p.x) * ey - (a.y - p.y) * ex) / speed);
        }
        return nearest;
    }

    const MetricMesh& mesh_;
    const Measures& measures_;
    const Aim& aim_;
};

// Calls visit(star) for the proposals whose kernel is not a vertex.
template <typename Visit>
void for_each_new_kernel(std::vector<Site>& sites, const Visit& visit) {
    for (Site& site : sites) {
        for (Star& star : site.others) {
            if (star.vertex == NONE) visit(star);
        }
    }
}

}  // namespace

void propose(std::vector<Site>& sites, const MetricMesh& mesh, const Measures& measures,
             const Aim& aim, const MetricField& metric, Monitor& monitor) {
    const Proposer proposer(mesh, measures, aim);
    std::size_t item = 0;
    const auto is_good = [&](const Site& site) {
        monitor.poll(item++);
        return aim.is_met_by(measured_now(site, mesh, measures));
    };
    sites.erase(std::remove_if(sites.begin(), sites.end(), is_good), sites.end());
    for (Site& site : sites) {
        monitor.poll(item++);
        proposer.propose_all(site);
    }
    std::vector<Point> kernels;
    for_each_new_kernel(sites, [&](const Star& star) { kernels.push_back(star.kernel.at); });
    const std::vector<Tensor> tensors = evaluate(metric, kernels);
    auto tensor = tensors.begin();
    for_each_new_kernel(sites,
                        [&](Star& star) { star.kernel = Vertex::make(star.kernel.at, *tensor++); });
}

EdgeSampler measured_proposals(std::vector<Site>& sites, const MetricMesh& mesh,
                               const MetricField& metric) {
    EdgeSampler sampler = final_sampler();
    for (Site& site : sites) {
        for (Star& star : site.others) {
            star.proposal = sampler.edge_count();
            const StarView view(site.polygon, star);
            for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i) {
                const Vertex& rim = mesh.vertices[view.rim(i)];
                sampler.add(star.kernel.at, star.kernel.metric, rim.at, rim.metric);
            }
        }
    }
    sampler.measure(metric);
    return sampler;
}

}  // namespace adaptmesh
