#include "adaptmesh/core/mesher/acceptance.hpp"

#include <algorithm>

#include "adaptmesh/core/mesher/measure_edges.hpp"

namespace adaptmesh {

namespace {

constexpr double WORTHWHILE = 0.01;  // the least share of the cost, or the quality, to be gained

struct Gain {
    double value;
    Index site, star;
};

class Acceptance {
  public:
    Acceptance(const EdgeSampler& proposed, const Aim& aim, MetricMesh& mesh, Measures& measures)
        : proposed_(proposed),
          is_least_cost_(aim.goal == Aim::Goal::least_cost),
          mesh_(mesh),
          measures_(measures) {}

    // The best proposal for a site; star NONE if none is worthwhile.
    Gain best_gain(const Site& site, Index number) const {
        const StarMeasure now = measured_now(site, mesh_, measures_);
        Gain best{least_gain(now), number, NONE};
        for (Index k = 0; k < Index(site.others.size()); ++k) {
            const StarMeasure then = measured(site, site.others[k]);
            const bool is_split = !site.is_ball() && site.others[k].vertex == NONE;
            if (is_split && then.area < 4 * LEAST_AREA) continue;
            const double value = gain(now, then);
            if (value > best.value) best = {value, number, k};
        }
        return best;
    }

    // Puts a star in the place of a site, unless that overlaps one that is done: then it is to be
    // looked at again.
    bool put_in(const Site& site, const Star& star, std::uint32_t stamp) {
        auto& triangles = mesh_.topology.triangles;
        const auto is_done = [&](Place p) { return triangles[p.triangle].stamp == stamp; };
        if (std::any_of(site.places.begin(), site.places.end(), is_done)) {
            for (Place p : site.places) triangles[p.triangle].pending |= TO_IMPROVE;
            return false;
        }
        for (Place p : site.places) triangles[p.triangle].stamp = stamp;
        const Index kernel = change(site, star, stamp);
        const StarView view(site.polygon, star);
        for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i) {
            const Measured m = Measured::of(proposed_, star.proposal + i - view.first_spoke());
            measures_.set(kernel, view.rim(i), m);
            note_length(mesh_, kernel, view.rim(i), m.length);
        }
        return true;
    }

  private:
    // What is gained by a change, and how much that must be at least.
    double gain(const StarMeasure& now, const StarMeasure& then) const {
        if (is_least_cost_) return now.cost - then.cost;
        return then.nearly_off_unit > now.off_unit ? 0 : then.worst_quality - now.worst_quality;
    }
    double least_gain(const StarMeasure& now) const {
        return WORTHWHILE * (is_least_cost_ ? now.cost : 1);
    }

    // What a star would measure in the place of its site.
    StarMeasure measured(const Site& site, const Star& star) const {
        const StarView view(site.polygon, star);
        return measure(mesh_, measures_, view, star.kernel.at, [&](int i) {
            const bool is_spoke = i >= view.first_spoke() && i < view.end_of_spokes();
            if (is_spoke) return Measured::of(proposed_, star.proposal + i - view.first_spoke());
            // Of a closed rim the first once more, or a side.
            if (star.vertex == NONE) return Measured::of(proposed_, star.proposal);
            return measures_.of(star.vertex, view.rim(i));
        });
    }

    // Returns the number of the kernel.
    Index change(const Site& site, const Star& star, std::uint32_t stamp) {
        Triangulation& topology = mesh_.topology;
        if (site.is_ball() && star.vertex != NONE) {
            topology.collapse(site.places, site.now.vertex, star.vertex);
            return star.vertex;
        }
        if (site.is_ball()) {
            mesh_.vertices[site.now.vertex] = star.kernel;
            for (Place p : site.places) topology.triangles[p.triangle].pending = CHANGED;
            return site.now.vertex;
        }
        if (star.vertex != NONE) {
            topology.flip(site.places[0]);
            return star.vertex;
        }
        const Index v = mesh_.add_vertex(star.kernel);
        for (Index t : topology.split_edge(site.places[0], v)) topology.triangles[t].stamp = stamp;
        return v;
    }

    const EdgeSampler& proposed_;
    bool is_least_cost_;
    MetricMesh& mesh_;
    Measures& measures_;
};

}  // namespace

Index accept_best(const std::vector<Site>& sites, const EdgeSampler& proposed, const Aim& aim,
                  MetricMesh& mesh, Measures& measures) {
    Acceptance work(proposed, aim, mesh, measures);
    std::vector<Gain> gains;
    for (Index i = 0; i < Index(sites.size()); ++i) {
        const Gain best = work.best_gain(sites[i], i);
        if (best.star != NONE) gains.push_back(best);
    }
    std::stable_sort(gains.begin(), gains.end(),
                     [](const Gain& g, const Gain& h) { return g.value > h.value; });
    const std::uint32_t stamp = mesh.topology.new_stamp();
    Index changes = 0;
    for (const Gain& g : gains)
        changes += work.put_in(sites[g.site], sites[g.site].others[g.star], stamp);
    return changes;
}

}  // namespace adaptmesh
