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
// The cuts of a curve are off the chord that they divide:
//
//          .--m--.                .-m-.       m takes the place of the chord's middle if the two
//        a---------b      ->     a     b      triangles beside ab, bent, are four positive ones
//         \       /                \  |  /
//
#pragma once

#include <cstdint>
#include <vector>

#include "adaptmesh/core/constrain.hpp"
#include "adaptmesh/core/metric_mesh.hpp"
#include "adaptmesh/core/swap.hpp"

namespace adaptmesh {

// A constrained edge to be cut, and its cuts in order from a to b.
struct Piece {
    Index a, b;
    Index segment;
    std::vector<Vertex> cuts;
};

class OutlineCutter {
  public:
    explicit OutlineCutter(MetricMesh& mesh) : mesh_(mesh) {}

    // Returns the constrained edges. A cut that would make a triangle that is not positive (on a
    // straight edge by rounding, on a curve because something hides it from its chord) is tried
    // again after the others; if that does not help it is left out, and what it would have cut
    // stays whole.
    template <typename Poll>
    std::vector<SubEdge> cut(const std::vector<Piece>& pieces, Poll& poll) {
        is_complete.assign(pieces.size(), 1);
        std::vector<SubEdge> whole;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const Piece& p = pieces[i];
            spans_.push_back({i, p.a, p.b, 0, Index(p.cuts.size()), 0});
        }
        for (std::size_t i = 0; i < spans_.size(); ++i) {  // grows on the way
            if (i % 1024 == 0) poll();
            const Span s = spans_[i];
            const Piece& piece = pieces[s.piece];
            const Index middle = (s.first + s.last) / 2;
            const Index v = s.first < s.last ? split(s, piece.cuts[middle]) : NONE;
            if (v != NONE) {
                spans_.push_back({s.piece, s.a, v, s.first, middle, 0});
                spans_.push_back({s.piece, v, s.b, middle + 1, s.last, 0});
            } else if (s.first < s.last && s.tries < MOST_TRIES) {
                spans_.push_back({s.piece, s.a, s.b, s.first, s.last, s.tries + 1});
            } else {
                whole.push_back({s.a, s.b, piece.segment});
                if (s.first < s.last) is_complete[s.piece] = 0;
            }
        }
        return whole;
    }

    std::vector<std::uint8_t> is_complete;  // whether all cuts of a piece were made

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

    Index split(const Span& span, const Vertex& cut) {
        Place place = mesh_.topology.find_edge(span.a, span.b);
        if (place.triangle == NONE) place = mesh_.topology.find_edge(span.b, span.a);
        if (place.triangle == NONE || !mesh_.stays_positive(place, cut.at)) return NONE;
        const Index across = mesh_.triangle(place.triangle).n[place.slot];
        if (across != NONE && !mesh_.stays_positive({triangle_of(across), slot_of(across)}, cut.at))
            return NONE;
        return put_on_edge(mesh_, place, cut, around_);
    }

    MetricMesh& mesh_;
    std::vector<Span> spans_;
    std::vector<Index> around_;
};

}  // namespace adaptmesh
