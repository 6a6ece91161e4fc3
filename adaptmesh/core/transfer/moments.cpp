#include "adaptmesh/core/transfer/moments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adaptmesh/core/transfer/lagrange.hpp"
#include "adaptmesh/core/transfer/overlay.hpp"

namespace adaptmesh {

namespace {

// What the extension of a field may not exceed: for each column the least and the largest value.
struct Bounds {
    std::vector<double> low, high;
};

// Moments on one new triangle, of all columns at once.
template <typename Degree>
class LocalMoments {
    static constexpr int N = Degree::NODES;
    using Matrix = std::array<std::array<double, N>, N>;

  public:
    // A smaller share of the triangle, if it is covered, is so by rounding.
    static constexpr double SOME = 1e-9;

    explicit LocalMoments(std::size_t columns)
        : columns_(columns), nodal_(N * columns), moments_(N * columns), extension_(N * columns) {}

    void clear() {
        std::fill(moments_.begin(), moments_.end(), 0.0);
        covered_ = {};
    }

    // The old field on an old triangle, from the values at its nodes.
    void take(const double* values, const std::int32_t* nodes) {
        for (int j = 0; j < N; ++j) {
            const double* row = values + std::size_t(nodes[j]) * columns_;
            std::copy(row, row + columns_, nodal_.begin() + j * columns_);
        }
    }

    // Adds the field taken, on a part of the new triangle.
    void add(const Overlap& part) {
        part.for_each_triangle([&](double area, const Corner& a, const Corner& b, const Corner& c) {
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
                add_point(area * q.weight, u, phi);
            }
        });
    }

    // Notes a part of the new triangle as covered; only `extend` needs to know.
    void cover(const Overlap& part) {
        part.for_each_triangle([&](double area, const Corner& a, const Corner& b, const Corner& c) {
            for (const RulePoint& q : Degree::RULE) {
                double in_new[3];
                for (int i = 0; i < 3; ++i) {
                    in_new[i] =
                        q.at[0] * a.in_new[i] + q.at[1] * b.in_new[i] + q.at[2] * c.in_new[i];
                }
                add_products(area * q.weight, in_new, covered_);
            }
        });
    }

    double covered_area() const {
        double sum = 0;
        for (const auto& row : covered_) {
            for (double m : row) sum += m;
        }
        return sum;
    }

    // Extends the field from the part that is covered.
    void extend_from_covered() {
        extension_ = moments_;
        solve(covered_, extension_);
    }

    // Extends the polynomial taken, of an old triangle, by the coordinates in it of the corners.
    void extend_polynomial(const double corners[3][3]) {
        for (int i = 0; i < N; ++i) {
            double in_old[3], u[N];
            for (int k = 0; k < 3; ++k) {
                in_old[k] = 0;
                for (int j = 0; j < 3; ++j) in_old[k] += Degree::AT[i][j] * corners[j][k];
            }
            Degree::basis(in_old, u);
            for (std::size_t c = 0; c < columns_; ++c) {
                extension_[i * columns_ + c] = field_taken(u, c);
            }
        }
    }

    // Extends by the polynomial that has at node i the value at `place` of the field taken.
    void extend_to_node(int i, const metrics::Location& place) {
        double u[N];
        Degree::basis(place.weight, u);
        for (std::size_t c = 0; c < columns_; ++c) {
            extension_[i * columns_ + c] = field_taken(u, c);
        }
    }

    // Draws the extension towards a value within bounds, as far as it has to be to keep them: the
    // mean over what is covered, or if that is next to nothing, the field taken at `place`.
    void bound_extension(const Bounds& bounds, const metrics::Location& place, double area) {
        const double covered = covered_area();
        double u[N];
        Degree::basis(place.weight, u);
        for (std::size_t c = 0; c < columns_; ++c) {
            double inside = 0;
            for (int i = 0; i < N; ++i) inside += moments_[i * columns_ + c];
            inside = covered > SOME * area ? inside / covered : field_taken(u, c);
            double at_nodes[N], control[N], share = 1;
            for (int i = 0; i < N; ++i) at_nodes[i] = extension_[i * columns_ + c];
            Degree::control_values(at_nodes, control);
            for (double value : control) {
                const double room = (value > inside ? bounds.high[c] : bounds.low[c]) - inside;
                if (std::fabs(value - inside) > std::fabs(room)) {
                    share = std::min(share, room / (value - inside));
                }
            }
            share = std::max(share, 0.0);
            for (int i = 0; i < N; ++i) {
                extension_[i * columns_ + c] = inside + share * (at_nodes[i] - inside);
            }
        }
    }

    // Adds the extension on what is not covered of the new triangle.
    void fill(double area) {
        Matrix missing = {};
        for (const RulePoint& q : Degree::RULE) add_products(area * q.weight, q.at, missing);
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j < N; ++j) {
                const double m = missing[i][j] - covered_[i][j];
                for (std::size_t c = 0; c < columns_; ++c) {
                    moments_[i * columns_ + c] += m * extension_[j * columns_ + c];
                }
            }
        }
    }

    void store(double* out, const std::int32_t* nodes) const {
        for (int i = 0; i < N; ++i) {
            double* row = out + std::size_t(nodes[i]) * columns_;
            for (std::size_t c = 0; c < columns_; ++c) row[c] += moments_[i * columns_ + c];
        }
    }

  private:
    double field_taken(const double u[N], std::size_t column) const {
        double value = 0;
        for (int j = 0; j < N; ++j) value += u[j] * nodal_[j * columns_ + column];
        return value;
    }

    void add_point(double weight, const double u[N], const double phi[N]) {
        for (std::size_t c = 0; c < columns_; ++c) {
            const double value = weight * field_taken(u, c);
            for (int i = 0; i < N; ++i) moments_[i * columns_ + c] += phi[i] * value;
        }
    }

    static void add_products(double weight, const double* at, Matrix& matrix) {
        double phi[N];
        Degree::basis(at, phi);
        for (int i = 0; i < N; ++i) {
            for (int j = 0; j < N; ++j) matrix[i][j] += weight * phi[i] * phi[j];
        }
    }

    // Gaussian elimination; the matrix is symmetric and positive definite. The right-hand sides
    // become the solutions.
    void solve(Matrix m, std::vector<double>& right) const {
        const auto subtract = [&](int i, int from, double factor) {
            for (std::size_t c = 0; c < columns_; ++c) {
                right[i * columns_ + c] -= factor * right[from * columns_ + c];
            }
        };
        for (int k = 0; k < N; ++k) {
            for (int i = k + 1; i < N; ++i) {
                const double factor = m[i][k] / m[k][k];
                for (int j = k; j < N; ++j) m[i][j] -= factor * m[k][j];
                subtract(i, k, factor);
            }
        }
        for (int k = N - 1; k >= 0; --k) {
            for (int i = k + 1; i < N; ++i) subtract(k, i, m[k][i]);
            for (std::size_t c = 0; c < columns_; ++c) right[k * columns_ + c] /= m[k][k];
        }
    }

    std::size_t columns_;
    std::vector<double> nodal_, moments_, extension_;
    Matrix covered_;
};

// Moments on all new triangles.
template <typename Degree>
class Moments {
    static constexpr int N = Degree::NODES;
    static constexpr double HEIGHTS = 4;
    // The share to be covered for an extension from there: a mean can be of any part.
    static constexpr double ENOUGH = N == 1 ? LocalMoments<Degree>::SOME : 0.5;

  public:
    Moments(const Overlay& overlay, const OldField& field, double reach)
        : overlay_(overlay),
          values_(field.values),
          columns_(field.columns),
          old_nodes_(field.nodes),
          reach_(reach),
          bounds_(field.bounds),
          local_(field.columns) {}

    void add_to(double* out, const std::int32_t* new_nodes, Monitor& monitor) {
        for (std::int32_t k = 0; k < overlay_.new_mesh().triangle_count(); ++k) {
            monitor.poll(k);
            add_common_parts(k);
            if (overlay_.is_at_border(k)) extend(k);
            local_.store(out, new_nodes + std::size_t(k) * N);
        }
    }

  private:
    void add_common_parts(std::int32_t k) {
        const Triangle3 newer = overlay_.newer(k);
        const bool is_at_border = overlay_.is_at_border(k);
        local_.clear();
        for (std::size_t i = overlay_.first()[k]; i < overlay_.first()[k + 1]; ++i) {
            const std::int32_t t = overlay_.olds()[i];
            const Triangle3 older = overlay_.older(t);
            const Overlap part(older, newer);
            take(t);
            local_.add(part);
            if (is_at_border) local_.cover(part);
        }
    }

    void take(std::int32_t t) { local_.take(values_, old_nodes_ + std::size_t(t) * N); }

    void extend(std::int32_t k) {
        const Triangle3 newer = overlay_.newer(k);
        const metrics::Location place = overlay_.place_of(k);
        double corners[3][3];
        if (local_.covered_area() >= ENOUGH * newer.area) {
            local_.extend_from_covered();
        } else if (is_near(newer, overlay_.older(place.triangle), place.outside, corners)) {
            take(place.triangle);
            local_.extend_polynomial(corners);
        } else {
            interpolate_at_nearest(newer);
        }
        if (bounds_.low != nullptr) {
            take(place.triangle);
            local_.bound_extension(bounds_of(k, place.triangle), place, newer.area);
        }
        local_.fill(newer.area);
    }

    void interpolate_at_nearest(const Triangle3& newer) {
        for (int i = 0; i < N; ++i) {
            Point node{0, 0};
            for (int j = 0; j < 3; ++j) {
                node.x += Degree::AT[i][j] * newer.at[j].x;
                node.y += Degree::AT[i][j] * newer.at[j].y;
            }
            const metrics::Location place = overlay_.place_of(node);
            take(place.triangle);
            local_.extend_to_node(i, place);
        }
    }

    // Whether a polynomial on `older` may be extended over `newer`: whose centroid is outside by at
    // most a share of the longest edge of both, and no corner by too many heights of `older`. Gives
    // the barycentric coordinates of the corners.
    bool is_near(const Triangle3& newer, const Triangle3& older, double outside,
                 double corners[3][3]) const {
        double lowest = 0;
        for (int i = 0; i < 3; ++i) {
            Overlap::weigh(older, newer.at[i], corners[i]);
            for (int j = 0; j < 3; ++j) lowest = std::min(lowest, corners[i][j]);
        }
        return lowest >= -HEIGHTS &&
               outside <= reach_ * std::max(longest_edge(newer), longest_edge(older));
    }

    static double longest_edge(const Triangle3& t) {
        const auto length = [&](int i, int j) {
            return std::hypot(t.at[j].x - t.at[i].x, t.at[j].y - t.at[i].y);
        };
        return std::max({length(0, 1), length(1, 2), length(2, 0)});
    }

    // Of the field on all old triangles that overlap new triangle k, or if there are none, on the
    // one nearest.
    Bounds bounds_of(std::int32_t k, std::int32_t nearest) const {
        Bounds out{std::vector<double>(columns_, INFINITY),
                   std::vector<double>(columns_, -INFINITY)};
        const auto include = [&](std::int32_t t) {
            for (std::size_t c = 0; c < columns_; ++c) {
                out.low[c] = std::min(out.low[c], bounds_.low[std::size_t(t) * columns_ + c]);
                out.high[c] = std::max(out.high[c], bounds_.high[std::size_t(t) * columns_ + c]);
            }
        };
        const std::size_t begin = overlay_.first()[k], end = overlay_.first()[k + 1];
        for (std::size_t i = begin; i < end; ++i) include(overlay_.olds()[i]);
        if (begin == end) include(nearest);
        return out;
    }

    const Overlay& overlay_;
    const double* values_;
    std::size_t columns_;
    const std::int32_t* old_nodes_;
    double reach_;
    BoundsOnTriangles bounds_;
    LocalMoments<Degree> local_;
};

}  // namespace

void add_moments(const Overlay& overlay, const OldField& field, double reach,
                 const std::int32_t* new_nodes, std::size_t nodes_per_triangle, double* out,
                 Monitor& monitor) {
    const auto add = [&](auto degree) {
        Moments<decltype(degree)>(overlay, field, reach).add_to(out, new_nodes, monitor);
    };
    if (nodes_per_triangle == 1)
        add(Constant());
    else if (nodes_per_triangle == 3)
        add(Linear());
    else
        add(Quadratic());
}

}  // namespace adaptmesh
