// Two meshes laid over each other, and fields carried from one to the other.
#include "tests/sanitize/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "adaptmesh/core/transfer/exact_location.hpp"
#include "adaptmesh/core/transfer/field_bounds.hpp"
#include "adaptmesh/core/transfer/moments.hpp"
#include "adaptmesh/core/transfer/overlay.hpp"
#include "adaptmesh/core/triangulation/cdt.hpp"
#include "adaptmesh/core/triangulation/delaunay.hpp"
#include "tests/sanitize/input.hpp"

namespace sanitize {

namespace {

// Nodes of a field of one degree, each of one triangle.
std::vector<std::int32_t> own_nodes(const FlatMesh& mesh, std::size_t per_triangle) {
    std::vector<std::int32_t> out(mesh.areas.size() * per_triangle);
    std::iota(out.begin(), out.end(), 0);
    return out;
}

// The moments of 1 add up to the area, whatever the degree, with bounds and without.
void check_moments(const FlatMesh& older, const FlatMesh& newer, const Overlay& overlay,
                   double area, const Input& input) {
    const std::vector<double> bounds(older.areas.size(), 1.0);
    for (std::size_t nodes : {1, 3, 6}) {
        const std::vector<std::int32_t> old_nodes = own_nodes(older, nodes);
        const std::vector<std::int32_t> new_nodes = own_nodes(newer, nodes);
        const std::vector<double> ones(old_nodes.size(), 1.0);
        for (const double* bound : {static_cast<const double*>(nullptr), bounds.data()}) {
            std::vector<double> out(new_nodes.size(), 0.0);
            const OldField field{ones.data(), 1, old_nodes.data(), {bound, bound}};
            add_moments(overlay, field, 0.25, new_nodes.data(), nodes, out.data(), monitor());
            const double sum = std::accumulate(out.begin(), out.end(), 0.0);
            require(std::fabs(sum - area) <= 1e-10 * area, input, "the moments of 1 are the area");
        }
    }
}

// Around each new node a field lies between values that it has.
void check_bounds(const FlatMesh& older, const FlatMesh& newer, const Overlay& overlay,
                  const Input& input) {
    std::vector<double> low(older.areas.size());
    std::iota(low.begin(), low.end(), 0.0);
    std::vector<double> least(newer.points.size(), INFINITY), most(newer.points.size(), -INFINITY);
    ranges(overlay, low.data(), low.data(), 1, newer.triangles.data(), 3, least.data(),
           most.data());
    for (std::int32_t v : newer.triangles) {
        require(least[v] >= 0 && least[v] <= most[v] && most[v] < double(low.size()), input,
                "bounds are values of the field");
    }
}

// The parts of each new triangle add up to it, and each vertex is found in the old mesh.
void check_overlay(const FlatMesh& older, const FlatMesh& newer, const Input& input) {
    if (!older.is_valid() || !newer.is_valid()) return;
    const metrics::Locator old_mesh = older.locator(), new_mesh = newer.locator();
    const Overlay overlay(old_mesh, older.areas.data(), new_mesh, newer.areas.data(), monitor());
    double area = 0;
    for (std::size_t k = 0; k < newer.areas.size(); ++k) {
        double covered = 0;
        for (std::size_t i = overlay.first()[k]; i < overlay.first()[k + 1]; ++i) {
            covered += overlay.areas()[i];
        }
        area += newer.areas[k];
        require(overlay.is_at_border(Index(k)) ||
                    std::fabs(covered - newer.areas[k]) <= 1e-12 * newer.areas[k],
                input, "parts of a new triangle add up to it");
    }

    check_moments(older, newer, overlay, area, input);
    check_bounds(older, newer, overlay, input);

    const ExactLocator locator(old_mesh);
    for (std::int32_t v : newer.triangles) {
        const metrics::Location place = locator.locate(newer.points[v]);
        for (double weight : place.weight) {
            require(weight >= 0 && weight <= 1, input, "barycentric coordinates are from 0 to 1");
        }
    }
}

}  // namespace

void run_transfer(const Input& input) {
    std::vector<Index> duplicate_of;
    const Triangulation hull = delaunay(input.points, duplicate_of, monitor());
    const Triangulation domain =
        triangulate(input.points, input.segments, input.options, monitor()).triangulation;
    const FlatMesh whole(input.points, hull), part(input.points, domain);
    const FlatMesh fine = part.refined();
    check_overlay(whole, part, input);
    check_overlay(part, fine, input);
    check_overlay(fine, part, input);
    check_overlay(fine, whole, input);
}

}  // namespace sanitize
