// Cutting the outline: unit points are put on the constrained edges, coarse to fine.
//
// The triangulation is metric Delaunay before and after each point, so that each costs a few flips.
// (Triangulating all of them at once, for the Euclidean plane, would leave edges between boundaries
// thousands of units off under a slanted anisotropic metric, each flip bringing them one step
// nearer.)
//
//        a-----------------------b        the middle cut first, then those of both halves, of all
//        a-----------m-----------b        pieces in turn
//        a-----m-----m-----m-----b
//
// The cuts of a curve are off the chord that they divide, and all cuts are rounded:
//
//          .--m--.                .-m-.       m takes the place of the chord's middle if the two
//        a---------b      ->     a     b      triangles beside ab, bent, are four positive ones
//         \       /                \  |  /
//
// On the border of the domain one of the two is a triangle of the outside, see outside.hpp.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "adaptmesh/core/constrain.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/outside.hpp"
#include "adaptmesh/core/swap.hpp"

namespace adaptmesh {

// A constrained edge to be cut, and its cuts in order from a to b; the first of them has number
// `first_cut` among those of all pieces.
struct Piece {
    Index a, b;
    Index segment;
    std::size_t first_cut;
    std::vector<Vertex> cuts;
};

class OutlineCutter {
  public:
    OutlineCutter(MetricMesh& mesh, Outside& outside) : mesh_(mesh), outside_(outside) {}

    // Returns the constrained edges. A cut that would make a triangle that is not positive (on a
    // straight edge by rounding, on a curve because something hides it from its chord) is tried
    // again after the others; if that does not help it is left out, and what it would have cut
    // stays whole.
    template <typename Poll>
    std::vector<SubEdge> cut(const std::vector<Piece>& pieces, Poll& poll) {
        std::vector<SubEdge> whole;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& p = pieces[i];
            is_made.resize(is_made.size() + p.cuts.size(), 0);
            spans_.push_back({i, p.a, p.b, 0, Index(p.cuts.size()), 0});
        }
        for (std::size_t i = 0; i < spans_.size(); ++i) {  // grows on the way
            if (i % 1024 == 0) poll();
            const Span s = spans_[i];
            const Piece& piece = pieces[s.piece];
            const Index middle = (s.first + s.last) / 2;
            const Index v = s.first < s.last ? split(s, piece.cuts[middle]) : NONE;
            if (v != NONE) {
                is_made[piece.first_cut + middle] = 1;
                spans_.push_back({s.piece, s.a, v, s.first, middle, 0});
                spans_.push_back({s.piece, v, s.b, middle + 1, s.last, 0});
            } else if (s.first < s.last && s.tries < MOST_TRIES) {
                spans_.push_back({s.piece, s.a, s.b, s.first, s.last, s.tries + 1});
            } else {
                whole.push_back({s.a, s.b, piece.segment});
            }
        }
        return whole;
    }

    std::vector<std::uint8_t> is_made;  // of each cut, whether it was made

  private:
    // The part of a piece between two vertices, and the cuts that belong there: from `first` on,
    // `last` not included.
    struct Span {
        std::size_t piece;
        Index a, b;
        Index first, last;
        int tries;
    };
    static constexpr int MOST_TRIES = 3;

    // The edge of a span, as the triangle of the mesh on its left has it, or as that on its right;
    // and its ends as the triangle across has them.
    struct Edge {
        Place place;
        Index across, from, to;
    };

    Edge edge_of(const Span& span) const {
        Index from = span.b, to = span.a;
        Place place = mesh_.find_edge(span.a, span.b);
        if (place.triangle == NONE) {
            std::swap(from, to);
            place = mesh_.find_edge(span.b, span.a);
        }
        const Index across =
            place.triangle == NONE ? NONE : mesh_.triangle(place.triangle).n[place.slot];
        return {place, across, from, to};
    }

    bool takes(const Edge& e, Point p) const {
        if (!mesh_.stays_positive(e.place, p)) return false;
        if (e.across == NONE) return outside_.takes(e.from, e.to, p);
        return mesh_.stays_positive({triangle_of(e.across), slot_of(e.across)}, p);
    }

    Index split(const Span& span, Vertex cut) {
        const Edge edge = edge_of(span);
        if (edge.place.triangle == NONE) return NONE;
        for (Point p : roundings(cut.at)) {
            if (!takes(edge, p)) continue;
            cut.at = p;
            const Index v = put_on_edge(mesh_, edge.place, cut, around_);
            if (edge.across == NONE) outside_.cut(edge.from, edge.to, v, p);
            return v;
        }
        return NONE;
    }

    // A point, and those around it whose coordinates are rounded otherwise.
    static std::array<Point, 9> roundings(Point p) {
        const double left = std::nextafter(p.x, -INFINITY), right = std::nextafter(p.x, INFINITY);
        const double below = std::nextafter(p.y, -INFINITY), above = std::nextafter(p.y, INFINITY);
        return {p,
                {left, p.y},
                {right, p.y},
                {p.x, below},
                {p.x, above},
                {left, below},
                {right, below},
                {left, above},
                {right, above}};
    }

    MetricMesh& mesh_;
    Outside& outside_;
    std::vector<Span> spans_;
    std::vector<Index> around_;
};

}  // namespace adaptmesh
