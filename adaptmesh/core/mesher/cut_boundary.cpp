#include "adaptmesh/core/mesher/cut_boundary.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "adaptmesh/core/mesher/swap.hpp"

namespace adaptmesh {

namespace {

class BoundaryCutter {
  public:
    BoundaryCutter(MetricMesh& mesh, Outside& outside) : mesh_(mesh), outside_(outside) {}

    std::vector<char> cut(const BoundaryCuts& boundary, Monitor& monitor) {
        std::vector<char> is_made(boundary.cuts.size(), false);
        const std::vector<std::size_t> first = boundary.first_cuts();
        std::vector<Part> parts;  // grows on the way
        for (std::size_t p = 0; p < boundary.pieces.size(); ++p)
            parts.push_back(
                {p, boundary.pieces[p].a, boundary.pieces[p].b, first[p], first[p + 1]});
        for (std::size_t i = 0; i < parts.size(); ++i) {
            monitor.poll(i);
            const Part part = parts[i];
            const Index segment = boundary.pieces[part.piece].segment;
            const std::size_t middle = (part.first + part.last) / 2;
            const bool has_cuts = part.first < part.last;
            const Index v = has_cuts ? split(part, boundary.vertex_at(middle)) : NONE;
            if (v != NONE) {
                is_made[middle] = true;
                parts.push_back({part.piece, part.a, v, part.first, middle});
                parts.push_back({part.piece, v, part.b, middle + 1, part.last});
            } else if (has_cuts && part.tries < MAX_TRIES) {
                parts.push_back(part);
                ++parts.back().tries;
            } else {
                mesh_.constrained.push_back({part.a, part.b, segment});
            }
        }
        return is_made;
    }

  private:
    static constexpr int MAX_TRIES = 3;

    // The part of a piece between two vertices, and the cuts that belong there: from `first` on,
    // `last` not included.
    struct Part {
        std::size_t piece;
        Index a, b;
        std::size_t first, last;
        int tries = 0;
    };

    // The edge of a part, as the triangle of the mesh on its left has it, or as that on its right;
    // and its ends as the triangle across has them.
    struct Edge {
        Place place;
        Index across, from, to;
    };

    Edge edge_of(const Part& part) const {
        Index from = part.b, to = part.a;
        Place place = mesh_.find_edge(part.a, part.b);
        if (place.triangle == NONE) {
            std::swap(from, to);
            place = mesh_.find_edge(part.b, part.a);
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

    Index split(const Part& part, Vertex cut) {
        const Edge edge = edge_of(part);
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
    std::vector<Index> around_;
};

}  // namespace

std::vector<char> cut_boundary(MetricMesh& mesh, Outside& outside, const BoundaryCuts& boundary,
                               Monitor& monitor) {
    return BoundaryCutter(mesh, outside).cut(boundary, monitor);
}

}  // namespace adaptmesh
