// Which triangles of two meshes overlap (Farrell and Maddison: Conservative interpolation between
// volume meshes by local Galerkin projection. Computer Methods in Applied Mechanics and Engineering
// 200, 2011): for each new triangle, the old one that has its centroid, and from there over every
// old edge that runs through it, until no more is found.
//
// A new triangle is convex, and where the old mesh covers it, the old triangles in it hang
// together. Where the border of the old mesh runs through it (the chords of a curve differ, or a
// hole is there), they may not; then a tree of boxes names all that could be met.
#pragma once

#include <cstddef>
#include <vector>

#include "adaptmesh/core/exact_location.hpp"
#include "adaptmesh/core/overlap.hpp"
#include "metrics/core/locator.hpp"

namespace adaptmesh {

using metrics::Locator;

class Overlay {
  public:
    using Index = metrics::Index;

    // The meshes, which have to outlive this, and the areas of their triangles.
    Overlay(const Locator& older, const double* old_areas, const Locator& newer,
            const double* new_areas, Monitor& monitor)
        : old_(older),
          new_(newer),
          old_areas_(old_areas, old_areas + older.triangle_count()),
          new_areas_(new_areas, new_areas + newer.triangle_count()),
          found_for_(older.triangle_count(), -1) {
        first_.push_back(0);
        for (Index k = 0; k < new_.triangle_count(); ++k) {
            monitor.poll(k);
            find_old_under(k);
            first_.push_back(olds_.size());
        }
    }

    const Locator& old_mesh() const { return old_; }
    const Locator& new_mesh() const { return new_; }

    // The pairs of new triangle k are first()[k] to first()[k + 1]: the old triangles, and the
    // areas that they have in common with k.
    const std::vector<std::size_t>& first() const { return first_; }
    const std::vector<Index>& olds() const { return olds_; }
    const std::vector<double>& areas() const { return areas_; }

    // Whether the border of the old mesh runs through a new triangle, or past it.
    bool is_at_border(Index k) const { return at_border_[k]; }

    // Where the centroid of a new triangle lies in the old mesh, or nearest to it.
    metrics::Location place_of(Index k) const {
        const Triangle3 t = newer(k);
        return place_of(
            {(t.at[0].x + t.at[1].x + t.at[2].x) / 3, (t.at[0].y + t.at[1].y + t.at[2].y) / 3});
    }
    metrics::Location place_of(Point p) const { return ExactLocator(old_).locate(p); }

    Triangle3 older(Index t) const { return triangle_of(old_, old_areas_, t); }
    Triangle3 newer(Index k) const { return triangle_of(new_, new_areas_, k); }

  private:
    static Triangle3 triangle_of(const Locator& mesh, const std::vector<double>& areas, Index t) {
        Triangle3 out;
        for (int i = 0; i < 3; ++i) {
            const Locator::Vertex& v = mesh.vertex(mesh.corner(t, i));
            out.at[i] = {v.x, v.y};
        }
        out.area = areas[t];
        return out;
    }

    void find_old_under(Index k) {
        const Triangle3 newer = this->newer(k);
        const bool at_border = !spread_from(place_of(k).triangle, k, newer);
        at_border_.push_back(at_border);
        if (!at_border) return;
        metrics::Box box;
        for (const Point& p : newer.at) box.include(p.x, p.y);
        old_.near(box, [&](Index t) { spread_from(t, k, newer); });
    }

    // Adds what overlaps and hangs together with old triangle `start`. False if that is nothing, or
    // if the border of the old mesh was met.
    bool spread_from(Index start, Index k, const Triangle3& newer) {
        if (found_for_[start] == k) return true;
        bool is_covered = try_add(start, k, newer);
        while (!waiting_.empty()) {
            const Index next = waiting_.back();
            waiting_.pop_back();
            if (next == Locator::NO_TRIANGLE)
                is_covered = false;
            else if (found_for_[next] != k)
                try_add(next, k, newer);
        }
        return is_covered;
    }

    bool try_add(Index t, Index k, const Triangle3& newer) {
        const Triangle3 older = this->older(t);
        const Overlap overlap(older, newer);
        if (overlap.empty()) return false;
        found_for_[t] = k;
        const double area = overlap.area();
        if (area != 0) olds_.push_back(t), areas_.push_back(area);
        for (int i = 0; i < 3; ++i) {
            if (overlap.has_old_edge(i)) waiting_.push_back(old_.neighbour(t, i));
        }
        return true;
    }

    const Locator &old_, &new_;
    const std::vector<double> old_areas_, new_areas_;
    std::vector<std::size_t> first_;
    std::vector<Index> olds_;
    std::vector<double> areas_;
    std::vector<bool> at_border_;
    std::vector<Index> found_for_;  // of each old triangle, the last new one it was found for
    std::vector<Index> waiting_;
};

}  // namespace adaptmesh
