// Vertices where parts of a triangulation touch, taken apart: each fan of triangles gets its own.
//
//      \ fan /                  \ fan /
//       \   /                    \   /
//        \ /                      \ /
//     ----v----        ->          v          v keeps one fan, w is a copy of it with the other
//        / \                       w
//       /   \                     / \         .
//      / fan \                   / fan \      .
//
// Whoever turns around a vertex then meets all of its triangles, and every edge can be found.
#pragma once

#include <algorithm>
#include <vector>

#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

class Fans {
  public:
    struct Copy {
        Index vertex, original;
    };

    Fans() = default;

    // Takes the fans of a triangulation without ghosts apart. Copies are the last vertices.
    explicit Fans(Triangulation& mesh);

    // By their originals.
    const std::vector<Copy>& copies() const { return copies_; }

    // As Triangulation::find_edge, for vertices that may have copies.
    Place find_edge(const Triangulation& mesh, Index a, Index b) const;

  private:
    // A vertex and its copies.
    std::vector<Index> all_of(Index v) const;

    std::vector<Copy> copies_;
};

}  // namespace adaptmesh
