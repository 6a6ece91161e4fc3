// The boundary and the inner lines of a domain, and the points that cut them into unit pieces.
//
//      points and segments are triangulated first;      A===o===o===B===C    A, B, C: points
//      then cuts o are put on the pieces between them                        AB, BC: pieces
//
// A piece is a segment of the domain, or a part of one between points that lie on it, or a chord
// that stands for a part of a curve, whose cuts are off it.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "adaptmesh/core/triangulation/segment.hpp"

namespace adaptmesh {

struct BoundaryCuts {
    struct Piece {
        Index a, b;
        Index segment;  // of the domain, that it lies on; of a chord one of its curve
        bool is_chord;  // each of its cuts must be made
    };

    // A piece whose cuts have to correspond to those of another, where boundaries are periodic.
    struct Tie {
        Index piece, image;
        bool is_reversed;
    };

    std::vector<Point> points;
    std::vector<Tensor> tensors;
    std::vector<Segment> segments;  // constrained edges between the points
    std::vector<Index> owners;      // the segment of the domain that each is; see Piece::segment

    std::vector<Piece> pieces;  // each in the direction in which it is cut
    std::vector<Point> cuts;
    std::vector<Tensor> cut_tensors;
    std::vector<Index> cut_pieces;  // ascending; the cuts of a piece are in order

    std::vector<Tie> ties;

    Vertex vertex_at(std::size_t cut) const {
        return Vertex::make(cuts[cut], cut_tensors[cut], pieces[cut_pieces[cut]].segment);
    }

    // The cuts of piece p are those from first_cuts()[p] to first_cuts()[p + 1].
    std::vector<std::size_t> first_cuts() const;

    // What to try next, when these of the cuts could be made; false if that is enough.
    //
    // A chord must have all of its cuts, and is divided at them; of cuts that are tied both are
    // made, or none. Other edges stay longer than unit where there is no room for a cut.
    bool mend(const std::vector<char>& is_made);

    // A fault of the points and segments, which are those of a valid domain, but rounded: as one of
    // the lines of the domain, which come too near each other there.
    InputError in_the_domain(const InputError& fault) const;

  private:
    void divide(const std::vector<char>& chords);
    std::vector<char> torn_ties(const std::vector<char>& is_made) const;
};

}  // namespace adaptmesh
