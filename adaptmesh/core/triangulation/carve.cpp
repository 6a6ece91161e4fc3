#include "adaptmesh/core/triangulation/carve.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/point.hpp"
#include "adaptmesh/core/monitor.hpp"
#include "adaptmesh/core/triangulation/constrain.hpp"
#include "adaptmesh/core/triangulation/edge_map.hpp"
#include "adaptmesh/core/triangulation/input_error.hpp"
#include "adaptmesh/core/triangulation/locate.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace adaptmesh {

namespace {

class Carver {
  public:
    Carver(Triangulation& mesh, const std::vector<Point>& points, std::vector<SubEdge>& sub_edges)
        : mesh_(mesh), points_(points), sub_edges_(sub_edges), lookup_(sub_edges) {}

    // Sets the label of every triangle to its component.
    void find_components(Monitor& monitor) {
        constexpr Index UNSEEN = -1;
        for (Triangle& t : mesh_.triangles) t.label = UNSEEN;
        Index count = 0;
        flood(mesh_.triangle_at(GHOST), count++);
        for (Index t = 0; t < mesh_.triangle_count(); ++t) {
            monitor.poll(t);
            if (mesh_.triangles[t].label == UNSEEN) flood(t, count++);
        }
        is_removed_.assign(count, false);
        is_removed_[0] = true;
        region_.assign(count, 0);
        find_sides();
    }

    // Finds the component of each region seed: one that has any is never a hole by nesting.
    void place_seeds(const std::vector<Point>& seeds) {
        seeds_ = &seeds;
        seed_component_.clear();
        for (std::size_t k = 0; k < seeds.size(); ++k) {
            seed_component_.push_back(
                component_at(seeds[k], Index(k), InputFault::region_seed_on_segment));
        }
    }

    void remove_holes(const std::vector<Point>& holes) {
        for (std::size_t k = 0; k < holes.size(); ++k) {
            const Index component = component_at(holes[k], Index(k), InputFault::hole_on_segment);
            if (component == 0)
                throw InputError(InputFault::hole_outside, Index(k), NONE, holes[k]);
            is_removed_[component] = true;
        }
    }

    // Components are in the domain and in holes by turns, from outside inwards over the fewest
    // locked edges: one is in the domain if a removed one is next to it on the way to the outside,
    // or if it has a region seed. Only edges between two components count: a segment that ends
    // inside a component separates nothing.
    void remove_nested(bool certain) {
        const Index count = Index(is_removed_.size());
        std::vector<std::vector<Index>> adjacent(count);
        for (const auto& [left, right] : sides_) {
            if (left == right) continue;
            adjacent[left].push_back(right);
            adjacent[right].push_back(left);
        }
        std::vector<char> is_solid(count, false);
        for (Index component : seed_component_) is_solid[component] = component != 0;
        std::vector<Index> depth(count, NONE), queue = {0};
        depth[0] = 0;
        for (std::size_t head = 0; head < queue.size(); ++head) {
            const Index from = queue[head];
            for (Index to : adjacent[from]) {
                if (depth[to] == NONE) {
                    depth[to] = depth[from] + 1;
                    queue.push_back(to);
                }
                if (depth[to] > depth[from] && !is_solid[from]) is_solid[to] = true;
            }
        }
        if (certain) check_certain(is_solid);
        for (Index k = 0; k < count; ++k) is_removed_[k] = is_removed_[k] || !is_solid[k];
    }

    void number_regions() {
        for (std::size_t k = 0; k < seed_component_.size(); ++k) {
            const Index component = seed_component_[k];
            const Point seed = (*seeds_)[k];
            if (is_removed_[component])
                throw InputError(InputFault::region_seed_outside, Index(k), NONE, seed);
            Index& region = region_[component];
            if (region != 0)
                throw InputError(InputFault::two_seeds_one_region, region - 1, Index(k), seed);
            region = Index(k) + 1;
        }
    }

    // Every locked edge has to have a part of the domain on one side at least. One that has not is
    // part of a boundary that is open somewhere, lies in a hole, or parts two of them. The vertex
    // named is a loose end if there is one.
    //
    //      open_boundary         open_hole: in one hole, or between two (or one and the outside)
    //   outside _____|            +-------+         +-------+
    //          |     |outside     | hole  |         | hole  |
    //          |_____|            |  ---- |         |_______|
    //                             +-------+         | hole  |
    void check_open_boundary() const {
        const auto is_open = [](Index left, Index right) { return left == 0 && right == 0; };
        const SubEdge* leak = first_line(InputFault::open_boundary, is_open);
        if (leak != nullptr) throw line_fault(InputFault::open_boundary, *leak);
    }

    void check_lines_in_holes() const {
        const auto is_lost = [this](Index left, Index right) {
            return is_removed_[left] && is_removed_[right];
        };
        const SubEdge* lost = first_line(InputFault::open_hole, is_lost);
        check_not_empty();
        if (lost != nullptr) throw line_fault(InputFault::open_hole, *lost);
    }

    void check_not_empty() const {
        if (std::all_of(is_removed_.begin(), is_removed_.end(), [](bool gone) { return gone; })) {
            throw InputError(InputFault::empty_domain);
        }
    }

    // Points that no segment uses have to be in the domain.
    void check_points() const {
        std::vector<char> is_used(mesh_.vertex_count(), false);
        for (const SubEdge& e : sub_edges_) is_used[e.a] = is_used[e.b] = true;
        for (Index v = 0; v < mesh_.vertex_count(); ++v) {
            const Index t = mesh_.triangle_at(v);
            if (is_used[v] || t == NONE || !is_removed_[mesh_.triangles[t].label]) continue;
            throw InputError(InputFault::point_outside, v, NONE, points_[v]);
        }
    }

    // What is not of the domain, ghosts included.
    Triangulation outside() const {
        Triangulation out = mesh_;
        out.keep_triangles([this](const Triangle& t) { return is_removed_[t.label]; });
        return out;
    }

    // Leaves only the domain: no ghosts, NONE beyond the border, regions as labels.
    void compact() {
        for (std::size_t k = 0; k < sub_edges_.size(); ++k) {
            sub_edges_[k].is_boundary =
                is_removed_[sides_[k].first] || is_removed_[sides_[k].second];
        }
        mesh_.keep_triangles([this](const Triangle& t) { return !is_removed_[t.label]; });
        for (Triangle& t : mesh_.triangles) t.label = region_[t.label];
    }

  private:
    Triangulation& mesh_;
    const std::vector<Point>& points_;
    std::vector<SubEdge>& sub_edges_;
    const EdgeNumbers lookup_;
    std::vector<char> is_removed_;                // of each component
    std::vector<Index> region_;                   // of each component, 0 without a seed
    std::vector<std::pair<Index, Index>> sides_;  // the components beside each sub-edge
    const std::vector<Point>* seeds_ = nullptr;
    std::vector<Index> seed_component_;  // of each region seed
    std::vector<Index> stack_;
    Index last_found_ = 0;

    InputError line_fault(InputFault kind, const SubEdge& e) const {
        return InputError(kind, e.a, e.segment, points_[e.a]);
    }

    // The first line that is wrong, by the components beside it; one with a loose end is a fault.
    template <typename IsWrong>
    const SubEdge* first_line(InputFault fault, const IsWrong& is_wrong) const {
        std::vector<Index> degree(mesh_.vertex_count(), 0);
        for (const SubEdge& e : sub_edges_) ++degree[e.a], ++degree[e.b];
        const SubEdge* first = nullptr;
        for (std::size_t k = 0; k < sub_edges_.size(); ++k) {
            if (!is_wrong(sides_[k].first, sides_[k].second)) continue;
            const SubEdge& e = sub_edges_[k];
            for (Index v : {e.a, e.b}) {
                if (degree[v] == 1) throw InputError(fault, v, e.segment, points_[v]);
            }
            if (first == nullptr) first = &e;
        }
        return first;
    }

    // Where a line between two parts of the domain ends on the border of a hole, that hole may as
    // well be a part of the domain, like the middle one of nine squares.
    void check_certain(const std::vector<char>& is_solid) const {
        std::vector<char> is_at_hole(mesh_.vertex_count(), false);
        for (std::size_t k = 0; k < sub_edges_.size(); ++k) {
            for (Index side : {sides_[k].first, sides_[k].second}) {
                if (side == 0 || is_solid[side]) continue;
                is_at_hole[sub_edges_[k].a] = is_at_hole[sub_edges_[k].b] = true;
            }
        }
        for (std::size_t k = 0; k < sub_edges_.size(); ++k) {
            const auto [left, right] = sides_[k];
            if (left == right || !is_solid[left] || !is_solid[right]) continue;
            for (Index v : {sub_edges_[k].a, sub_edges_[k].b}) {
                if (is_at_hole[v])
                    throw InputError(InputFault::uncertain_hole, v, sub_edges_[k].segment,
                                     points_[v]);
            }
        }
    }

    void flood(Index start, Index component) {
        mesh_.triangles[start].label = component;
        stack_.push_back(start);
        while (!stack_.empty()) {
            const Index t = stack_.back();
            stack_.pop_back();
            for (Index code : mesh_.triangles[t].n) {
                if (is_locked(code)) continue;
                Triangle& beyond = mesh_.triangles[triangle_of(code)];
                if (beyond.label == component) continue;
                beyond.label = component;
                stack_.push_back(triangle_of(code));
            }
        }
    }

    void find_sides() {
        sides_.assign(sub_edges_.size(), {NONE, NONE});
        for (const Triangle& t : mesh_.triangles) {
            for (int slot = 0; slot < 3; ++slot) {
                const Index a = t.v[next(slot)], b = t.v[prev(slot)];
                if (!is_locked(t.n[slot]) || a > b) continue;
                const Index right = mesh_.triangles[triangle_of(t.n[slot])].label;
                sides_[lookup_.find(a, b)] = {t.label, right};
            }
        }
    }

    // The component that point p is in; on a segment it is in none, which is a fault.
    Index component_at(Point p, Index number, InputFault fault_on_segment) {
        const auto at = [this](Index v) { return points_[v]; };
        const Location where = locate(mesh_, at, p, last_found_);
        if (where.where == Where::outside) return 0;
        last_found_ = where.triangle;
        const Triangle& T = mesh_.triangles[where.triangle];
        std::vector<Place> edges;
        if (where.where == Where::on_edge) edges.push_back(where.place());
        if (where.where == Where::on_vertex) {
            mesh_.ball(T.v[where.slot], edges);
            for (Place& e : edges) e.slot = next(e.slot);
        }
        const Index segment = lowest_segment(edges);
        if (segment != NONE) throw InputError(fault_on_segment, number, segment, p);
        return T.label;
    }

    // Of the segments that have one of the edges; NONE if none is locked.
    Index lowest_segment(const std::vector<Place>& edges) const {
        Index lowest = NONE;
        for (const auto [t, slot] : edges) {
            const Triangle& T = mesh_.triangles[t];
            if (!is_locked(T.n[slot])) continue;
            const Index edge = lookup_.find(T.v[next(slot)], T.v[prev(slot)]);
            const Index segment = sub_edges_[edge].segment;
            lowest = lowest == NONE ? segment : std::min(lowest, segment);
        }
        return lowest;
    }
};

}  // namespace

void carve(Triangulation& mesh, const std::vector<Point>& points, std::vector<SubEdge>& sub_edges,
           const CarveOptions& options, Monitor& monitor, Triangulation* outside) {
    Carver work(mesh, points, sub_edges);
    work.find_components(monitor);
    work.check_open_boundary();
    work.place_seeds(options.region_seeds);
    work.remove_holes(options.holes);
    if (options.nesting) work.remove_nested(options.certain);
    work.check_lines_in_holes();
    work.number_regions();
    work.check_points();
    if (outside != nullptr) *outside = work.outside();
    work.compact();
}

}  // namespace adaptmesh
