#include "adaptmesh/core/transfer/overlay.hpp"

#include <cstddef>
#include <vector>

#include "adaptmesh/core/transfer/exact_location.hpp"
#include "adaptmesh/core/transfer/overlap.hpp"
#include "metrics/core/locator.hpp"

namespace adaptmesh {

Overlay::Overlay(const Locator& older, const double* old_areas, const Locator& newer,
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

metrics::Location Overlay::place_of(Index k) const {
    const Triangle3 t = newer(k);
    return place_of(
        {(t.at[0].x + t.at[1].x + t.at[2].x) / 3, (t.at[0].y + t.at[1].y + t.at[2].y) / 3});
}

Triangle3 Overlay::triangle_of(const Locator& mesh, const std::vector<double>& areas, Index t) {
    Triangle3 out;
    for (int i = 0; i < 3; ++i) {
        const Locator::Vertex& v = mesh.vertex(mesh.corner(t, i));
        out.at[i] = {v.x, v.y};
    }
    out.area = areas[t];
    return out;
}

void Overlay::find_old_under(Index k) {
    const Triangle3 newer = this->newer(k);
    const bool at_border = !spread_from(place_of(k).triangle, k, newer);
    at_border_.push_back(at_border);
    if (!at_border) return;
    metrics::Box box;
    for (const Point& p : newer.at) box.include(p.x, p.y);
    old_.near(box, [&](Index t) { spread_from(t, k, newer); });
}

bool Overlay::spread_from(Index start, Index k, const Triangle3& newer) {
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

bool Overlay::try_add(Index t, Index k, const Triangle3& newer) {
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

}  // namespace adaptmesh
