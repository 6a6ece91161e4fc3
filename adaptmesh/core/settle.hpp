// The last rounds: what is still off is changed only if the change, measured, is for the better.
//
// A site is a star of the mesh with an edge that is not unit, or a bad triangle. In each round
//
//   1. the sites are measured with the exact metric,
//   2. stars that might take their place are thought of, and measured as well,
//   3. those that gain most are put in, as long as their sites do not overlap.
//
// So a change is judged by the very numbers that it makes.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "adaptmesh/core/edges.hpp"
#include "adaptmesh/core/faults.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/star.hpp"
#include "adaptmesh/core/star_model.hpp"
#include "adaptmesh/core/swap.hpp"

namespace adaptmesh {

struct Site {
    std::vector<Place> places;  // the ball of a vertex; or an edge, as seen from both its sides
    std::vector<Index> polygon;
    Star now;
    std::vector<Star> others;

    bool is_ball() const { return now.corner == Star::INSIDE; }
};

class Settler {
  public:
    Settler(MetricMesh& mesh, double least_quality) : mesh_(mesh), least_quality_(least_quality) {}

    // Finds the sites around what has changed, to be given the least cost; how many. Some of their
    // edges want to be measured.
    std::size_t find_sites() {
        aim_ = Aim::least_cost;
        return find_sites(take_changed_faults(mesh_, least_quality_));
    }

    // Finds the sites around the worst triangles, whose quality is to be raised.
    std::size_t find_worst(double below, std::size_t most) {
        if (aim_ != Aim::best_worst) {
            for (Triangle& t : mesh_.topology.triangles) t.fresh |= TO_IMPROVE;
        }
        aim_ = Aim::best_worst;
        floor_ = below;
        return find_sites(take_changed_worst(mesh_, below, most));
    }

    // Measures first the edges of sites, and then the spokes of proposals.
    EdgeSampler& sampler() { return sampler_; }

    // Thinks of stars that might replace those that are bad. The metric is wanted at their kernels.
    template <typename Poll>
    std::vector<double> propose(double step, Poll& poll) {
        keep_measures();
        std::vector<double> wanted;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < sites_.size(); ++i) {
            if (i % 1024 == 0) poll();
            Site& site = sites_[i];
            const StarMeasure now = measured_now(site);
            if (is_good(now)) continue;
            if (site.is_ball() && aim_ == Aim::best_worst) {
                propose_best_place(site);
            } else if (site.is_ball()) {
                propose_collapses(site);
                propose_moves(site, step);
            } else {
                propose(site,
                        {mesh_.vertices[site.polygon[FLIPPED]], site.polygon[FLIPPED], FLIPPED});
                propose_split(site);
            }
            for (const Star& s : site.others) {
                if (s.vertex == NONE)
                    wanted.push_back(s.kernel.at.x), wanted.push_back(s.kernel.at.y);
            }
            if (kept != i) sites_[kept] = std::move(site);
            ++kept;
        }
        sites_.resize(kept);
        return wanted;
    }

    // The metrics at the wanted points; then the spokes of the proposals want to be measured.
    template <typename TensorAt>
    void set_kernels(TensorAt&& tensor_at) {
        sampler_.clear();
        std::size_t next_kernel = 0;
        for (Site& site : sites_) {
            for (Star& s : site.others) {
                if (s.vertex == NONE)
                    s.kernel = Vertex::make(s.kernel.at, tensor_at(next_kernel++));
                s.proposal = sampler_.edge_count();
                const StarView view(site.polygon, s);
                for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i)
                    add_edge(s.kernel, mesh_.vertices[view.rim(i)]);
            }
        }
    }

    // Puts the best in, most gain first; returns how many.
    Index accept() {
        struct Gain {
            double value;
            Index site, star;
        };
        std::vector<Gain> gains;
        for (Index i = 0; i < Index(sites_.size()); ++i) {
            const Site& site = sites_[i];
            const StarMeasure now = measured_now(site);
            Gain best{least_gain(now), i, NONE};
            for (Index k = 0; k < Index(site.others.size()); ++k) {
                const StarMeasure then = measured(site, site.others[k]);
                const bool is_split = !site.is_ball() && site.others[k].vertex == NONE;
                if (is_split && then.area < 4 * LEAST_AREA) continue;
                const double value = gain(now, then);
                if (value > best.value) best = {value, i, k};
            }
            if (best.star != NONE) gains.push_back(best);
        }
        std::stable_sort(gains.begin(), gains.end(),
                         [](const Gain& g, const Gain& h) { return g.value > h.value; });
        const std::uint32_t stamp = mesh_.topology.new_stamp();
        Index changes = 0;
        for (const Gain& g : gains)
            changes += put_in(sites_[g.site], sites_[g.site].others[g.star], stamp);
        return changes;
    }

  private:
    static constexpr int HELD = 0, FLIPPED = 3;   // corners of a quadrilateral, see add_quad
    static constexpr double LONGEST_CHORD = 0.6;  // finer detail may pass unseen
    static constexpr double LONGEST_EDGE = 4;     // of longer ones the length does not matter
    static constexpr double WORTHWHILE = 0.01;    // the least share of the cost to be gained
    static constexpr int DIRECTIONS = 4;
    static constexpr double TWO_PI = 6.283185307179586;
    static constexpr std::size_t MOST_COLLAPSES = 4;

    template <typename T>
    static void sort_out(std::vector<T>& items) {
        std::sort(items.begin(), items.end());
        items.erase(std::unique(items.begin(), items.end()), items.end());
    }

    // What the changes are for.
    enum class Aim { least_cost, best_worst };

    std::size_t find_sites(const Faults& faults) {
        sites_.clear();
        unmeasured_.clear();
        for (Index code : faults.edges) add_quad({triangle_of(code), slot_of(code)});
        for (Index v = 0; v < Index(faults.is_centre.size()); ++v) {
            if (faults.is_centre[v]) add_ball(v);
        }
        sort_out(unmeasured_);
        sampler_.clear();
        for (auto [a, b] : unmeasured_) add_edge(mesh_.vertices[a], mesh_.vertices[b]);
        return sites_.size();
    }

    bool is_good(const StarMeasure& m) const {
        if (aim_ == Aim::best_worst) return m.worst_quality >= floor_;
        return m.off_unit == 0 && m.worst_quality >= least_quality_;
    }

    // What is gained by a change, and how much that must be at least.
    double gain(const StarMeasure& now, const StarMeasure& then) const {
        if (aim_ == Aim::least_cost) return now.cost - then.cost;
        return then.nearly_off_unit > now.off_unit ? 0 : then.worst_quality - now.worst_quality;
    }
    double least_gain(const StarMeasure& now) const {
        return WORTHWHILE * (aim_ == Aim::least_cost ? now.cost : 1);
    }

    // --- measuring ---------------------------------------------------------------------------

    void add_edge(const Vertex& a, const Vertex& b) {
        sampler_.add(a.at, a.metric, b.at, b.metric);
    }

    void keep_measures() {
        for (std::size_t i = 0; i < unmeasured_.size(); ++i) {
            const auto [a, b] = unmeasured_[i];
            measures_.set(a, b, Measured::of(sampler_, Index(i)));
        }
    }

    StarMeasure measured_now(const Site& site) const {
        const StarView view(site.polygon, site.now);
        return measure(mesh_, measures_, view, site.now.kernel.at,
                       [&](int i) { return measures_.of(site.now.vertex, view.rim(i)); });
    }

    StarMeasure measured(const Site& site, const Star& star) const {
        const StarView view(site.polygon, star);
        return measure(mesh_, measures_, view, star.kernel.at, [&](int i) {
            const bool is_spoke = i >= view.first_spoke() && i < view.end_of_spokes();
            if (is_spoke) return Measured::of(sampler_, star.proposal + i - view.first_spoke());
            // Of a closed rim the first once more, or a side.
            if (star.vertex == NONE) return Measured::of(sampler_, star.proposal);
            return measures_.of(star.vertex, view.rim(i));
        });
    }

    // --- sites -------------------------------------------------------------------------------

    //         c
    //        / \            the edge (b, c) of (a, b, c): a star from b, which a flip
    //       a   d           replaces by one from a
    //        \ /
    //         b
    void add_quad(Place edge) {
        const Quad q = quad_around(mesh_.topology, edge);
        const Index across = mesh_.triangle(edge.triangle).n[edge.slot];
        const Place far{triangle_of(across), slot_of(across)};
        add_site({{edge, far}, {q.b, q.d, q.c, q.a}, {mesh_.vertices[q.b], q.b, HELD}, {}});
    }

    void add_ball(Index v) {
        Site site{{}, {}, {mesh_.vertices[v], v, Star::INSIDE}, {}};
        if (mesh_.vertices[v].held_by != FREE || mesh_.topology.triangle_at(v) == NONE ||
            !mesh_.topology.ball(v, site.places))
            return;
        for (Place p : site.places)
            site.polygon.push_back(mesh_.triangle(p.triangle).v[next(p.slot)]);
        add_site(std::move(site));
    }

    void add_site(Site site) {
        const auto want = [&](Index a, Index b) {
            if (!measures_.knows(a, b)) unmeasured_.push_back(std::minmax(a, b));
        };
        const StarView view(site.polygon, site.now);
        for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i)
            want(site.now.vertex, view.rim(i));
        for (std::size_t i = 0; i < site.polygon.size(); ++i)
            want(site.polygon[i], site.polygon[(i + 1) % site.polygon.size()]);
        sites_.push_back(std::move(site));
    }

    // --- proposals ---------------------------------------------------------------------------

    void propose(Site& site, const Star& star) {
        if (StarView(site.polygon, star).is_proper(mesh_)) site.others.push_back(star);
    }

    void propose_at(Site& site, Point at) {
        if (!std::isfinite(at.x) || !std::isfinite(at.y)) return;
        propose(site, {Vertex::make(at, site.now.kernel.metric), NONE, Star::INSIDE});
    }

    void propose_split(Site& site) {
        const Index b = site.polygon[HELD], c = site.polygon[2];
        const Measured edge = measures_.of(b, c);
        if (edge.length <= LONGEST_UNIT) return;
        const Point p = mesh_.at(b), q = mesh_.at(c);
        propose_at(site, {p.x + edge.middle * (q.x - p.x), p.y + edge.middle * (q.y - p.y)});
    }

    // Into the corners at the ends of the shortest spokes.
    void propose_collapses(Site& site) {
        std::vector<std::pair<double, int>> spokes;
        for (int i = 0; i < int(site.polygon.size()); ++i)
            spokes.push_back({measures_.of(site.now.vertex, site.polygon[i]).length, i});
        std::sort(spokes.begin(), spokes.end());
        if (spokes.size() > MOST_COLLAPSES) spokes.resize(MOST_COLLAPSES);
        for (auto [length, corner] : spokes) {
            const Index v = site.polygon[corner];
            if (length < 1) propose(site, {mesh_.vertices[v], v, corner});
        }
    }

    // In some directions, turned a little from round to round, a share of the way to the polygon:
    // beside a jump the metric at the vertex does not tell how far that is.
    void propose_moves(Site& site, double step) {
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
    void propose_best_place(Site& site) {
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

    // --- changes -----------------------------------------------------------------------------

    // Unless the site overlaps one that is done: then it is to be looked at again.
    bool put_in(const Site& site, const Star& star, std::uint32_t stamp) {
        auto& triangles = mesh_.topology.triangles;
        const auto is_done = [&](Place p) { return triangles[p.triangle].stamp == stamp; };
        if (std::any_of(site.places.begin(), site.places.end(), is_done)) {
            for (Place p : site.places) triangles[p.triangle].fresh |= TO_IMPROVE;
            return false;
        }
        for (Place p : site.places) triangles[p.triangle].stamp = stamp;
        const Index kernel = change(site, star, stamp);
        const StarView view(site.polygon, star);
        for (int i = view.first_spoke(); i < view.end_of_spokes(); ++i) {
            const Measured m = Measured::of(sampler_, star.proposal + i - view.first_spoke());
            measures_.set(kernel, view.rim(i), m);
            note_length(mesh_, kernel, view.rim(i), m.length);
        }
        return true;
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
            for (Place p : site.places) topology.triangles[p.triangle].fresh = CHANGED;
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

    MetricMesh& mesh_;
    double least_quality_;
    Aim aim_ = Aim::least_cost;
    double floor_ = 0;
    Measures measures_;
    std::vector<Site> sites_;
    std::vector<std::pair<Index, Index>> unmeasured_;
    EdgeSampler sampler_{LONGEST_CHORD, LONGEST_EDGE, 0.0};
};

}  // namespace adaptmesh
