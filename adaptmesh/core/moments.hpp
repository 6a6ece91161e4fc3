// Moments of an old field: its integrals against each basis function of the new mesh.
//
//     b_i = sum over new triangles K, old triangles T of   integral over K and T of  phi_i u
//
// On the common part of K and T both are polynomials; a rule that is exact for their product gives
// the exact moments. Where K is not covered by the old mesh (the chords of a curved boundary
// differ), u is taken to be its mean over the part that is, or, where none is, its value at the
// nearest point of the border: so constants stay what they are.
#pragma once

#include <cstddef>
#include <vector>

#include "adaptmesh/core/overlay.hpp"

namespace adaptmesh {

// The Lagrange basis of degree 0, 1, 2 at barycentric coordinates: the vertices, then the midpoint
// of the edge opposite each. `RULE` integrates products of two of them exactly on a triangle:
// barycentric coordinates, and weights that add up to 1.
struct RulePoint {
    double at[3], weight;
};

struct Constant {
    static constexpr int NODES = 1;
    static void basis(const double*, double* out) { out[0] = 1; }
    static constexpr RulePoint RULE[] = {{{1. / 3, 1. / 3, 1. / 3}, 1}};
    static constexpr double INTEGRALS[] = {1};  // over a triangle of area 1
};

struct Linear {
    static constexpr int NODES = 3;
    static void basis(const double* l, double* out) {
        for (int i = 0; i < 3; ++i) out[i] = l[i];
    }
    static constexpr RulePoint RULE[] = {
        {{0, 0.5, 0.5}, 1. / 3}, {{0.5, 0, 0.5}, 1. / 3}, {{0.5, 0.5, 0}, 1. / 3}};
    static constexpr double INTEGRALS[] = {1. / 3, 1. / 3, 1. / 3};
};

struct Quadratic {
    static constexpr int NODES = 6;
    static void basis(const double* l, double* out) {
        for (int i = 0; i < 3; ++i) out[i] = l[i] * (2 * l[i] - 1);
        out[3] = 4 * l[1] * l[2], out[4] = 4 * l[2] * l[0], out[5] = 4 * l[0] * l[1];
    }
    // Degree 4, six points (Dunavant, International Journal for Numerical Methods in Engineering
    // 21, 1985).
    static constexpr double A = 0.44594849091596488632, B = 0.09157621350977074346;
    static constexpr double U = 0.22338158967801146570, V = 0.10995174365532186764;
    static constexpr RulePoint RULE[] = {{{1 - 2 * A, A, A}, U}, {{A, 1 - 2 * A, A}, U},
                                         {{A, A, 1 - 2 * A}, U}, {{1 - 2 * B, B, B}, V},
                                         {{B, 1 - 2 * B, B}, V}, {{B, B, 1 - 2 * B}, V}};
    static constexpr double INTEGRALS[] = {0, 0, 0, 1. / 3, 1. / 3, 1. / 3};
};

// Moments on one new triangle, of all columns at once.
template <typename Degree>
class LocalMoments {
    static constexpr int N = Degree::NODES;

  public:
    explicit LocalMoments(std::size_t columns)
        : columns_(columns), nodal_(N * columns), moments_(N * columns) {}

    void clear() {
        std::fill(moments_.begin(), moments_.end(), 0.0);
        std::fill(covered_, covered_ + N, 0.0);
    }

    // The old field on an old triangle, from the values at its nodes.
    void take(const double* values, const std::int32_t* nodes) {
        for (int j = 0; j < N; ++j) {
            const double* row = values + std::size_t(nodes[j]) * columns_;
            std::copy(row, row + columns_, nodal_.begin() + j * columns_);
        }
    }

    void add(const Overlap& part, double old_area) {
        part.for_each_triangle(
            [&](double share, const Corner& a, const Corner& b, const Corner& c) {
                for (const RulePoint& q : Degree::RULE) {
                    double in_old[3], in_new[3], u[N], phi[N];
                    for (int i = 0; i < 3; ++i) {
                        in_old[i] =
                            q.at[0] * a.in_old[i] + q.at[1] * b.in_old[i] + q.at[2] * c.in_old[i];
                        in_new[i] =
                            q.at[0] * a.in_new[i] + q.at[1] * b.in_new[i] + q.at[2] * c.in_new[i];
                    }
                    Degree::basis(in_old, u);
                    Degree::basis(in_new, phi);
                    add_point(share * old_area * q.weight, u, phi);
                }
            });
    }

    double covered() const {
        double sum = 0;
        for (double m : covered_) sum += m;
        return sum;
    }

    // What the old mesh leaves uncovered of a new triangle of this area; `place` is where its
    // centroid lies in the old mesh, whose field there was taken.
    void fill(double area, const metrics::Location& place) {
        const double covered = this->covered();
        double missing[N];
        for (int i = 0; i < N; ++i) missing[i] = area * Degree::INTEGRALS[i] - covered_[i];
        double u[N];
        Degree::basis(place.weight, u);
        for (std::size_t c = 0; c < columns_; ++c) {
            double beyond = 0;
            for (int j = 0; j < N; ++j) {
                beyond += covered > 0 ? moments_[j * columns_ + c] / covered
                                      : u[j] * nodal_[j * columns_ + c];
            }
            for (int i = 0; i < N; ++i) moments_[i * columns_ + c] += beyond * missing[i];
        }
    }

    void store(double* out, const std::int32_t* nodes) const {
        for (int i = 0; i < N; ++i) {
            double* row = out + std::size_t(nodes[i]) * columns_;
            for (std::size_t c = 0; c < columns_; ++c) row[c] += moments_[i * columns_ + c];
        }
    }

  private:
    void add_point(double weight, const double u[N], const double phi[N]) {
        for (int i = 0; i < N; ++i) covered_[i] += weight * phi[i];
        for (std::size_t c = 0; c < columns_; ++c) {
            double value = 0;
            for (int j = 0; j < N; ++j) value += u[j] * nodal_[j * columns_ + c];
            value *= weight;
            for (int i = 0; i < N; ++i) moments_[i * columns_ + c] += phi[i] * value;
        }
    }

    std::size_t columns_;
    std::vector<double> nodal_, moments_;
    double covered_[N];
};

// values: rows of `columns` numbers at the old nodes; nodes: of each triangle; out: such rows for
// the new nodes, zero at first.
template <typename Degree, typename Poll>
void moments(const Overlay& overlay, const double* values, std::size_t columns,
             const std::int32_t* old_nodes, const std::int32_t* new_nodes, double* out,
             Poll& poll) {
    constexpr int N = Degree::NODES;
    LocalMoments<Degree> local(columns);
    for (std::int32_t k = 0; k < overlay.new_mesh().triangle_count(); ++k) {
        if (k % 1024 == 0) poll();
        const Triangle3 newer = Overlay::triangle_of(overlay.new_mesh(), k);
        local.clear();
        for (std::size_t i = overlay.first()[k]; i < overlay.first()[k + 1]; ++i) {
            const std::int32_t t = overlay.olds()[i];
            const Triangle3 older = Overlay::triangle_of(overlay.old_mesh(), t);
            local.take(values, old_nodes + std::size_t(t) * N);
            local.add(Overlap(older, newer), Overlay::area(older));
        }
        const double area = Overlay::area(newer);
        // Nothing is missing but by rounding where the borders coincide: then not to conserve
        // would be worse.
        if (overlay.is_at_border(k) && area - local.covered() > Overlay::rounding(newer)) {
            const metrics::Location place = overlay.place_of(k);
            local.take(values, old_nodes + std::size_t(place.triangle) * N);
            local.fill(area, place);
        }
        local.store(out, new_nodes + std::size_t(k) * N);
    }
}

}  // namespace adaptmesh
