#include "adaptmesh/core/edit/recut.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "adaptmesh/core/geometry/proper_triangle.hpp"
#include "adaptmesh/core/mesher/metric_mesh.hpp"
#include "adaptmesh/core/mesher/swap.hpp"

namespace adaptmesh {

namespace {

class Recutter {
  public:
    explicit Recutter(MetricMesh& mesh) : mesh_(mesh) {}

    void recut(std::vector<Stop>& polyline, const std::vector<Vertex>& cuts, const double* places) {
        bool complete = true;
        for (std::size_t i = 0; i < cuts.size(); ++i)
            complete &= try_cut(polyline, cuts[i], places[i]);
        for (std::size_t i = 1; i + 1 < polyline.size();) {
            if (polyline[i].is_old && try_remove(polyline, i, complete))
                polyline.erase(polyline.begin() + std::ptrdiff_t(i));
            else
                ++i;
        }
    }

  private:
    bool try_cut(std::vector<Stop>& polyline, const Vertex& cut, double place) {
        const auto after = std::upper_bound(polyline.begin(), polyline.end(), place,
                                            [](double p, const Stop& s) { return p < s.place; });
        if (after == polyline.begin() || after == polyline.end()) return false;
        const Index a = (after - 1)->vertex, b = after->vertex;
        Place edge = mesh_.find_edge(a, b);
        if (edge.triangle == NONE) edge = mesh_.find_edge(b, a);
        if (edge.triangle == NONE || !mesh_.stays_positive(edge, cut.at)) return false;
        const Index across = mesh_.triangle(edge.triangle).n[edge.slot];
        if (across != NONE && !mesh_.stays_positive({triangle_of(across), slot_of(across)}, cut.at))
            return false;
        const Index v = put_on_edge(mesh_, edge, cut, around_);
        polyline.insert(after, {place, v, false});
        return true;
    }

    // With all cuts made, what goes leaves no edge too long.
    bool try_remove(const std::vector<Stop>& polyline, std::size_t i, bool complete) {
        const Stop &before = polyline[i - 1], &here = polyline[i], &beyond = polyline[i + 1];
        if (!complete && MetricMesh::length(mesh_.vertices[before.vertex],
                                            mesh_.vertices[beyond.vertex]) > LONGEST_UNIT)
            return false;
        const bool is_nearer_before = here.place - before.place < beyond.place - here.place;
        const Index nearer = is_nearer_before ? before.vertex : beyond.vertex;
        const Index farther = is_nearer_before ? beyond.vertex : before.vertex;
        return try_pull(here.vertex, nearer) || try_pull(here.vertex, farther);
    }

    // Pulls a vertex of the outline into its neighbour on it. Its ball is open at the border of the
    // domain, and closed on an inner line.
    bool try_pull(Index from, Index to) {
        mesh_.topology.ball(from, ball_);
        for (Place place : ball_) {
            const Triangle& T = mesh_.triangle(place.triangle);
            const Index p = T.v[next(place.slot)], q = T.v[prev(place.slot)];
            if (p != to && q != to) {
                if (!is_proper_triangle(mesh_.at(to), mesh_.at(p), mesh_.at(q))) return false;
            } else if (is_ear(T, place.slot, p == to)) {
                return false;
            }
        }
        mesh_.topology.collapse(ball_, from, to);
        return true;
    }

    // A triangle that hangs on the mesh by the edge that would vanish alone.
    static bool is_ear(const Triangle& T, int slot, bool to_is_next) {
        return T.n[slot] == NONE && T.n[to_is_next ? next(slot) : prev(slot)] == NONE;
    }

    MetricMesh& mesh_;
    std::vector<Place> ball_;
    std::vector<Index> around_;
};

}  // namespace

void recut(MetricMesh& mesh, std::vector<Stop>& polyline, const std::vector<Vertex>& cuts,
           const double* places) {
    Recutter(mesh).recut(polyline, cuts, places);
}

}  // namespace adaptmesh
