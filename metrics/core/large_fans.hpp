// The neighbours of hubs, vertices with very many of them, in the order of their directions. Sorted
// when first asked for.
//
//          c   b
//           \ /         from any direction the nearest is found by bisection,
//      d --- w --- a    and its neighbours on both sides follow in turn
//           / \              .
//          e   f
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "metrics/core/adjacency.hpp"

namespace metrics {

class LargeFans {
  public:
    LargeFans(const double* points, const Adjacency& mesh) : points_(points), mesh_(mesh) {}

    class Fan {
      public:
        Fan(const double* points, Index hub, Adjacency::Range neighbours)
            : x_(points[2 * hub]), y_(points[2 * hub + 1]) {
            for (const Index w : neighbours) {
                by_angle_.emplace_back(angle(points[2 * w], points[2 * w + 1]), w);
            }
            std::sort(by_angle_.begin(), by_angle_.end());
        }

        std::size_t size() const { return by_angle_.size(); }
        Index vertex(std::ptrdiff_t place) const { return by_angle_[std::size_t(place)].second; }

        // The place of the neighbour whose direction from the hub is nearest to that of (x, y).
        std::ptrdiff_t nearest(double x, double y) const {
            const double wanted = angle(x, y);
            const auto after = std::lower_bound(by_angle_.begin(), by_angle_.end(),
                                                std::pair<double, Index>(wanted, 0));
            const std::ptrdiff_t n = std::ptrdiff_t(size());
            const std::ptrdiff_t next = (after - by_angle_.begin()) % n, last = (next + n - 1) % n;
            return gap(next, wanted) <= gap(last, wanted) ? next : last;
        }

      private:
        double angle(double x, double y) const { return std::atan2(y - y_, x - x_); }

        double gap(std::ptrdiff_t place, double wanted) const {
            constexpr double TURN = 6.283185307179586;
            return std::fabs(std::remainder(by_angle_[std::size_t(place)].first - wanted, TURN));
        }

        double x_, y_;
        std::vector<std::pair<double, Index>> by_angle_;
    };

    const Fan& of(Index hub) {
        const auto found = fans_.find(hub);
        if (found != fans_.end()) return found->second;
        return fans_.emplace(hub, Fan(points_, hub, mesh_.of(hub))).first->second;
    }

  private:
    const double* points_;
    const Adjacency& mesh_;
    std::unordered_map<Index, Fan> fans_;
};

}  // namespace metrics
