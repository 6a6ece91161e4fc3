#include "adaptmesh/core/edit/zone.hpp"

#include <algorithm>

namespace adaptmesh {

namespace {

// Removes free vertices: each is pulled into that neighbour for which the worst new triangle is
// best. One that no neighbour can take (its ball is not star-shaped about any) may go in another
// round, when its neighbours have.
class Remover {
  public:
    explicit Remover(MetricMesh& mesh) : mesh_(mesh) {}

    void remove_free(Monitor& monitor) {
        std::vector<Index> left;
        for (Index v = 0; v < Index(mesh_.vertices.size()); ++v) {
            if (mesh_.vertices[v].held_by == FREE && mesh_.topology.triangle_at(v) != NONE)
                left.push_back(v);
        }
        std::size_t item = 0;
        const auto is_gone = [&](Index v) {
            monitor.poll(item++);
            return try_remove(v);
        };
        for (int round = 0; round < ROUNDS && !left.empty(); ++round) {
            const auto end = std::remove_if(left.begin(), left.end(), is_gone);
            if (end == left.end()) break;
            left.erase(end, left.end());
        }
    }

  private:
    static constexpr int ROUNDS = 5;

    bool try_remove(Index v) {
        if (!mesh_.topology.ball(v, ball_)) return false;
        Index best = NONE;
        double best_quality = 0;
        for (Place place : ball_) {
            const Index to = mesh_.triangle(place.triangle).v[next(place.slot)];
            const double quality = worst_after(to);
            if (quality > best_quality && is_positive_after(to)) best = to, best_quality = quality;
        }
        if (best == NONE) return false;
        mesh_.topology.collapse(ball_, v, best);
        return true;
    }

    // Calls visit(p, q) for the sides of the ball that do not end at a vertex.
    template <typename Visit>
    void for_each_side_without(Index to, Visit visit) const {
        for (Place place : ball_) {
            const Triangle& T = mesh_.triangle(place.triangle);
            const Index p = T.v[next(place.slot)], q = T.v[prev(place.slot)];
            if (p != to && q != to) visit(p, q);
        }
    }

    double worst_after(Index to) const {
        double worst = 1;
        for_each_side_without(to, [&](Index p, Index q) {
            worst = std::min(worst, MetricMesh::quality(mesh_.vertices[to], mesh_.vertices[p],
                                                        mesh_.vertices[q]));
        });
        return worst;
    }

    bool is_positive_after(Index to) const {
        bool positive = true;
        for_each_side_without(
            to, [&](Index p, Index q) { positive = positive && mesh_.is_positive(to, p, q); });
        return positive;
    }

    MetricMesh& mesh_;
    std::vector<Place> ball_;
};

}  // namespace

EdgeList edge_list(const MetricMesh& mesh) {
    EdgeList out;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (mesh.topology.is_dead(t)) continue;
        const Triangle& T = mesh.triangle(t);
        for (int slot = 0; slot < 3; ++slot) {
            if (T.n[slot] != NONE && triangle_of(T.n[slot]) > t) continue;
            const Index a = T.v[next(slot)], b = T.v[prev(slot)];
            out.ends.push_back(a), out.ends.push_back(b);
            out.lengths.push_back(mesh.length(a, b));
            out.is_constrained.push_back(is_locked(T.n[slot]));
        }
    }
    return out;
}

std::vector<Index> corners_below(const MetricMesh& mesh, double quality) {
    std::vector<Index> out;
    for (Index t = 0; t < mesh.topology.triangle_count(); ++t) {
        if (mesh.topology.is_dead(t) || mesh.quality(t) >= quality) continue;
        out.insert(out.end(), mesh.triangle(t).v, mesh.triangle(t).v + 3);
    }
    return out;
}

Index hold_all_but(MetricMesh& mesh, const std::vector<char>& is_in_zone) {
    Index free = 0;
    for (Index v = 0; v < Index(mesh.vertices.size()); ++v) {
        Vertex& vertex = mesh.vertices[v];
        if (vertex.held_by != FREE && vertex.held_by != HELD) continue;
        if (mesh.topology.triangle_at(v) == NONE) continue;
        vertex.held_by = is_in_zone[v] ? FREE : HELD;
        free += vertex.held_by == FREE;
    }
    return free;
}

void remove_free(MetricMesh& mesh, Monitor& monitor) {
    Remover(mesh).remove_free(monitor);
    mesh.drop_dead_triangles();
}

}  // namespace adaptmesh
