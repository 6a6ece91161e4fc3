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

#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/transfer/exact_location.hpp"
#include "adaptmesh/core/transfer/overlap.hpp"
#include "metrics/core/locator.hpp"

namespace adaptmesh {

using metrics::Locator;

class Overlay {
  public:
    using Index = metrics::Index;

    // The meshes, which have to outlive this, and the areas of their triangles.
    Overlay(const Locator& older, const double* old_areas, const Locator& newer,
            const double* new_areas, Monitor& monitor);

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
    metrics::Location place_of(Index k) const;
    metrics::Location place_of(Point p) const { return ExactLocator(old_).locate(p); }

    Triangle3 older(Index t) const { return triangle_of(old_, old_areas_, t); }
    Triangle3 newer(Index k) const { return triangle_of(new_, new_areas_, k); }

  private:
    static Triangle3 triangle_of(const Locator& mesh, const std::vector<double>& areas, Index t);

    void find_old_under(Index k);

    // Adds what overlaps and hangs together with old triangle `start`. False if that is nothing, or
    // if the border of the old mesh was met.
    bool spread_from(Index start, Index k, const Triangle3& newer);

    bool try_add(Index t, Index k, const Triangle3& newer);

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
