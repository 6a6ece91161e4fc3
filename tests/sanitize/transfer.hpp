// Two meshes laid over each other, without Python: for runs under sanitizers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "adaptmesh/core/geometry/accurate_area.hpp"
#include "adaptmesh/core/transfer/exact_location.hpp"
#include "adaptmesh/core/transfer/field_bounds.hpp"
#include "adaptmesh/core/transfer/moments.hpp"
#include "adaptmesh/core/transfer/overlay.hpp"
#include "adaptmesh/core/triangulation/triangulation.hpp"

namespace sanitize {

using namespace adaptmesh;

// Points, triangles and areas as arrays.
struct FlatMesh {
    std::vector<Point> points;
    std::vector<std::int32_t> triangles;
    std::vector<double> areas;

    FlatMesh(const std::vector<Point>& at, const std::vector<std::int32_t>& corners)
        : points(at), triangles(corners) {
        for (std::size_t t = 0; t < triangles.size(); t += 3) {
            areas.push_back(0.5 * twice_area(points[triangles[t]], points[triangles[t + 1]],
                                             points[triangles[t + 2]]));
        }
    }

    // Without ghosts.
    FlatMesh(const std::vector<Point>& at, const Triangulation& mesh)
        : FlatMesh(at, real_triangles(mesh)) {}

    // Every triangle cut into four, at the midpoints of its edges.
    FlatMesh refined() const {
        std::vector<Point> at = points;
        std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
        const auto middle = [&](std::int32_t a, std::int32_t b) {
            const auto [found, is_new] = middles.emplace(std::minmax(a, b), at.size());
            if (is_new) {
                at.push_back({0.5 * (at[a].x + at[b].x), 0.5 * (at[a].y + at[b].y)});
            }
            return found->second;
        };
        std::vector<std::int32_t> out;
        for (std::size_t t = 0; t < triangles.size(); t += 3) {
            const std::int32_t a = triangles[t], b = triangles[t + 1], c = triangles[t + 2];
            const std::int32_t p = middle(b, c), q = middle(c, a), r = middle(a, b);
            out.insert(out.end(), {a, r, q, r, b, p, q, p, c, p, q, r});
        }
        return {at, out};
    }

    bool is_valid() const {
        for (double area : areas) {
            if (!(area > 1e-250)) return false;
        }
        return !areas.empty();
    }

    metrics::Locator locator() const {
        return {&points[0].x, points.size(), triangles.data(), areas.size()};
    }

  private:
    static std::vector<std::int32_t> real_triangles(const Triangulation& mesh) {
        std::vector<std::int32_t> out;
        for (const Triangle& t : mesh.triangles) {
            if ((t.v[0] | t.v[1] | t.v[2]) >= 0) out.insert(out.end(), {t.v[0], t.v[1], t.v[2]});
        }
        return out;
    }
};

}  // namespace sanitize
