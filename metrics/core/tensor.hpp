// The algebra of 2x2 symmetric positive definite tensors, in closed form.
//
// A tensor M measures a vector e by the length sqrt(e' M e); its unit ball is an ellipse whose half
// axes are the two sizes h_i = 1 / sqrt(lambda_i), along the eigenvectors.
//
// Accuracy. The small eigenvalue of an anisotropic tensor is never computed as a difference of
// large numbers: it is det / lambda_max, the determinant is computed with the rounding errors of
// its two products, and other sums have terms of one sign. What remains is the rounding of the
// stored entries themselves, which at 45 degrees blurs the small eigenvalue by 1e-16 lambda_max;
// along the axes nothing is lost.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace metrics {

struct Tensor {
    double a, b, c;  // m11, m12, m22

    // The quadratic form: the squared length of (dx, dy).
    double q(double dx, double dy) const { return a * dx * dx + 2 * b * dx * dy + c * dy * dy; }
};

inline Tensor operator+(Tensor s, Tensor t) {
    return {s.a + t.a, s.b + t.b, s.c + t.c};
}
inline Tensor operator-(Tensor s, Tensor t) {
    return {s.a - t.a, s.b - t.b, s.c - t.c};
}
inline Tensor operator*(double k, Tensor t) {
    return {k * t.a, k * t.b, k * t.c};
}

inline Tensor from_size(double h) {
    const double m = 1 / (h * h);
    return {m, 0, m};
}

// x * y minus its rounded value, exactly, by Dekker's splitting of each factor into two halves.
inline double product_error(double x, double y) {
    const double cut_x = 0x1.0000002p27 * x, cut_y = 0x1.0000002p27 * y;
    const double x1 = cut_x - (cut_x - x), x2 = x - x1;
    const double y1 = cut_y - (cut_y - y), y2 = y - y1;
    return x2 * y2 - (((x * y - x1 * y1) - x2 * y1) - x1 * y2);
}

// u * v - x * y, to nearly full precision even where the two products cancel.
inline double product_difference(double u, double v, double x, double y) {
    const double first = u * v, second = x * y, difference = first - second;
    if (std::fabs(difference) > 0.25 * std::fabs(first)) return difference;
    return difference + (product_error(u, v) - product_error(x, y));
}

// The determinant of the entries as they are stored.
inline double exact_det(Tensor t) {
    return product_difference(t.a, t.c, t.b, t.b);
}

// Beyond this share of its diagonal product, a determinant is nothing but the rounding of entries.
constexpr double DET_RESOLUTION = 0x1p-53;

// Finite, positive definite to double precision, and of a determinant that a double can hold.
inline bool is_metric(Tensor t) {
    const double det = exact_det(t);  // NaN fails each test
    return t.a > 0 && t.c > 0 && det > DET_RESOLUTION * (t.a * t.c) &&
           t.a * t.c <= std::numeric_limits<double>::max();
}

// The determinant, not below its resolution: results of this algebra that rounding has made
// singular are still metrics. What is_metric has accepted is never changed by that.
inline double det(Tensor t) {
    return std::max(exact_det(t), DET_RESOLUTION * (t.a * t.c));
}

inline double sqrt_det(Tensor t) {
    return std::sqrt(det(t));
}

// The length of (dx, dy), as a sum of squares: not lost to rounding along the thinnest ellipse.
inline double length(Tensor t, double dx, double dy) {
    if (t.a < t.c) return length({t.c, t.b, t.a}, dy, dx);
    const double along = t.a * dx + t.b * dy;
    return std::sqrt((along * along + det(t) * dy * dy) / t.a);
}

// The same to nearly all digits for the entries as they are stored, also where the two products of
// the first square cancel: what loses the ratio of the sizes in units of rounding above.
inline double exact_length(Tensor t, double dx, double dy) {
    if (t.a < t.c) return exact_length({t.c, t.b, t.a}, dy, dx);
    const double along = product_difference(t.a, dx, -t.b, dy);
    return std::sqrt((along * along + det(t) * dy * dy) / t.a);
}

struct Direction {
    double x, y;
};

// The traceless part ((d, b), (b, -d)) has the eigenvalues -r and r, whatever the mean of the
// diagonal; log, exp and the spectrum are functions of it.
struct Deviator {
    double mean, d, b, r;

    explicit Deviator(Tensor t)
        : mean(0.5 * (t.a + t.c)), d(0.5 * (t.a - t.c)), b(t.b), r(std::sqrt(d * d + b * b)) {}

    // r + d and r - d, both without cancellation: their product is b^2.
    double r_plus_d() const { return d >= 0 ? r + d : b * b / (r - d); }
    double r_minus_d() const { return d <= 0 ? r - d : b * b / (r + d); }

    // The unit eigenvector of the larger eigenvalue, mean + r.
    Direction direction() const {
        if (r == 0) return {1, 0};
        const double x = d >= 0 ? r + d : b, y = d >= 0 ? b : r - d;
        const double norm = std::sqrt(x * x + y * y);
        return {x / norm, y / norm};
    }
};

// Eigenvalues, and the unit eigenvector (x, y) of the larger one; (-y, x) is the other's.
struct Spectrum {
    double low, high, x, y;
};

inline Spectrum spectrum(Tensor t) {
    const Deviator dev(t);
    const double high = dev.mean + dev.r;
    if (dev.r == 0) return {high, high, 1, 0};
    const Direction axis = dev.direction();
    return {det(t) / high, high, axis.x, axis.y};
}

// A result with these eigenvalues that is still a metric after its entries are rounded. Rounding
// can take away a determinant that is about DET_RESOLUTION of the product of the diagonal; it is
// then raised by as little as makes it visible. What no input can have either is left, to be
// refused.
inline Tensor held(Tensor t, double low, double high) {
    if (low > 0x1p-49 * high || low * high < 0.25 * DET_RESOLUTION * (t.a * t.c)) return t;
    const int tries = 8;
    double raise = DET_RESOLUTION * std::min(t.a, t.c);
    for (int k = 0; k < tries && !is_metric(t); ++k, raise *= 2) {
        t = {t.a + raise, t.b, t.c + raise};
    }
    return t;
}

inline Tensor from_spectrum(Spectrum s) {
    const Tensor t{s.high * s.x * s.x + s.low * s.y * s.y, (s.high - s.low) * s.x * s.y,
                   s.high * s.y * s.y + s.low * s.x * s.x};
    return held(t, std::min(s.low, s.high), std::max(s.low, s.high));  // powers below 0 swap them
}

inline Tensor power(Tensor t, double exponent) {
    const Spectrum s = spectrum(t);
    return from_spectrum({std::pow(s.low, exponent), std::pow(s.high, exponent), s.x, s.y});
}

// The same axes with the eigenvalues brought into [low, high], and then the smaller one raised to
// the larger one over `ratio`; the very same tensor if nothing is to be done.
inline Tensor limited(Tensor t, double low, double high, double ratio) {
    const Spectrum s = spectrum(t);
    if (low <= s.low && s.high <= high && s.high <= ratio * s.low) return t;
    const auto clip = [=](double value) { return std::min(std::max(value, low), high); };
    const double larger = clip(s.high);
    return from_spectrum({std::max(clip(s.low), larger / ratio), larger, s.x, s.y});
}

// |H| of any symmetric H: the same axes, the eigenvalues without their signs and not below `floor`.
inline Tensor absolute(Tensor t, double floor) {
    const double det = exact_det(t);
    const double sign = t.a + t.c < 0 ? -1 : 1;
    const Deviator dev(sign * t);
    const double high = dev.mean + dev.r;  // of both eigenvalues the larger in magnitude
    if (high <= floor) return {floor, 0, floor};
    const double low = std::fabs(det) / high;
    if (det >= 0 && low >= floor) return sign * t;
    const Direction axis = dev.direction();
    return from_spectrum({std::max(low, floor), high, axis.x, axis.y});
}

// log M = (ln det M) / 2 I + artanh(r / mean) / r (M - mean I)
inline Tensor log_tensor(Tensor t) {
    const Deviator dev(t);
    const double determinant = det(t);
    const double half_log_det = 0.5 * std::log(determinant);
    const double z = dev.r / dev.mean;
    double slope;  // artanh(z) / r
    if (z < 1e-4) {
        slope = (1 + z * z / 3) / dev.mean;
    } else if (z < 0.5) {
        slope = std::atanh(z) / dev.r;
    } else {  // artanh loses what distinguishes z from 1; the ratio of the eigenvalues does not
        const double high = dev.mean + dev.r;
        slope = 0.5 * std::log(high / (determinant / high)) / dev.r;
    }
    return {half_log_det + slope * dev.d, slope * dev.b, half_log_det - slope * dev.d};
}

// exp A = e^mean (cosh r I + sinh r / r (A - mean I)), written as low I + s (r I + deviator) with
// s = e^mean sinh r / r: every term of the diagonal is positive.
inline Tensor exp_tensor(Tensor t) {
    const Deviator dev(t);
    const double scale = std::exp(dev.mean);
    if (dev.r < 0.3) {
        const double r2 = dev.r * dev.r;
        const double s =
            scale * (1 + r2 / 6 * (1 + r2 / 20 * (1 + r2 / 42 * (1 + r2 / 72 * (1 + r2 / 110)))));
        const double cosh = scale * std::cosh(dev.r);
        return {cosh + s * dev.d, s * dev.b, cosh - s * dev.d};
    }
    const double stretch = std::exp(dev.r);
    const double low = scale / stretch, high = scale * stretch;
    const double s = 0.5 * (high - low) / dev.r;
    return held({low + s * dev.r_plus_d(), s * dev.b, low + s * dev.r_minus_d()}, low, high);
}

// Weighted log-Euclidean mean of two; of more: exp_tensor of the weighted sum of the logs.
inline Tensor log_mean(Tensor s, Tensor t, double weight_of_t) {
    return exp_tensor((1 - weight_of_t) * log_tensor(s) + weight_of_t * log_tensor(t));
}

// sqrt(A² + B²) of any symmetric A and B.
//
// The positive factor in the polar decomposition of the 4 x 2 matrix of their rows: with its Gram
// matrix G, of which d² is the determinant, it is (G + d I) / sqrt(trace G + 2 d). By the formula
// of Cauchy and Binet d² is the sum of the squared minors, none of which is lost to rounding.
inline Tensor hypot(Tensor s, Tensor t) {
    const double scale = std::max({std::fabs(s.a), std::fabs(s.b), std::fabs(s.c), std::fabs(t.a),
                                   std::fabs(t.b), std::fabs(t.c)});
    if (scale == 0) return {0, 0, 0};
    s = (1 / scale) * s, t = (1 / scale) * t;
    const double rows[4][2] = {{s.a, s.b}, {s.b, s.c}, {t.a, t.b}, {t.b, t.c}};
    double minors = 0;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < i; ++j) {
            const double minor = product_difference(rows[i][0], rows[j][1], rows[i][1], rows[j][0]);
            minors += minor * minor;
        }
    }
    const double d = std::sqrt(minors), off = s.b * s.b + t.b * t.b;
    const Tensor gram{s.a * s.a + t.a * t.a + off, s.b * (s.a + s.c) + t.b * (t.a + t.c),
                      s.c * s.c + t.c * t.c + off};
    const double factor = scale / std::sqrt(gram.a + gram.c + 2 * d);
    return {factor * (gram.a + d), factor * gram.b, factor * (gram.c + d)};
}

// Metric length of the edge (dx, dy) from a point with metric s to one with metric t: Simpson's
// rule with the geometric mean of the two as the metric half way. root_s, root_t are sqrt_det(s),
// sqrt_det(t), which a caller may keep. With r = root_s root_t the determinant of
// s / root_s + t / root_t is 2 + (mixed discriminant) / r, where the quotient is at least 2; the
// mean is (root_t s + root_s t) / sqrt(2 r + mixed discriminant).
inline double length(Tensor s, double root_s, Tensor t, double root_t, double dx, double dy) {
    const double q_s = std::max(s.q(dx, dy), 0.0), q_t = std::max(t.q(dx, dy), 0.0);
    const double twice = 2 * (root_s * root_t);
    const double mixed = s.a * t.c + s.c * t.a - 2 * s.b * t.b;
    const double q_mid = (root_t * q_s + root_s * q_t) / std::sqrt(twice + std::max(twice, mixed));
    return (std::sqrt(q_s) + 4 * std::sqrt(q_mid) + std::sqrt(q_t)) * (1.0 / 6);
}

// Simultaneous reduction: the basis in which s is the identity and t diagonal.
//
// With s = L L' and N = L^-1 t L^-T = low vv' + high ww', the rows of the inverse basis are Lv and
// Lw: s = (Lv)(Lv)' + (Lw)(Lw)' and t = low (Lv)(Lv)' + high (Lw)(Lw)'.
//
// Each entry of N has nearly full precision for the entries of s and t as stored: the first is a
// quotient, the second a difference of products computed with their errors, and the last follows
// from the determinant without a subtraction. L starts from the larger diagonal entry of s, so that
// it has no entry above its diagonal ones.
struct Reduction {
    double low, high;
    Direction at_low, at_high;  // Lv, Lw
    double area;                // of the parallelogram from at_low to at_high, signed

    Reduction(Tensor s, Tensor t) {
        const bool turned = s.a < s.c;
        if (turned) s = {s.c, s.b, s.a}, t = {t.c, t.b, t.a};
        const double root = sqrt_det(s), det_n = det(t) / det(s);
        const double n11 = t.a / s.a;
        const double n12 = product_difference(s.a, t.b, s.b, t.a) / (s.a * root);
        const Deviator dev({n11, n12, (det_n + n12 * n12) / n11});
        high = dev.mean + dev.r;
        low = std::min(det_n / high, high);
        const Direction w = dev.direction();
        const double l11 = std::sqrt(s.a), l21 = s.b / l11, l22 = root / l11;
        at_high = {l11 * w.x, l21 * w.x + l22 * w.y};
        at_low = {-l11 * w.y, l22 * w.x - l21 * w.y};
        area = turned ? root : -root;
        if (turned) at_high = {at_high.y, at_high.x}, at_low = {at_low.y, at_low.x};
    }

    // The basis itself, L^-T v and L^-T w: each has the product 1 with its own row of the inverse
    // and 0 with the other.
    Direction basis_low() const { return {at_high.y / area, -at_high.x / area}; }
    Direction basis_high() const { return {-at_low.y / area, at_low.x / area}; }

    // at_low at_low' k + at_high at_high' m
    Tensor combined(double k, double m) const { return k * square(at_low) + m * square(at_high); }

    static Tensor square(Direction v) { return {v.x * v.x, v.x * v.y, v.y * v.y}; }
};

// The geometric mean A#B, half way on the geodesic from A to B; where they commute, (AB)^(1/2).
// With the square roots a, b of the determinants it is sqrt(a b / det G) G, where G = A / a + B /
// b.
//
// det G is 2 + (a / b) trace(A^-1 B), with the trace from the reduction: as the difference of the
// products of the entries of G it would be lost where both ellipses are thin and alike.
struct GeometricMean {
    double of_s, of_t;  // what each counts for

    GeometricMean(Tensor s, Tensor t) {
        const double root_s = sqrt_det(s), root_t = sqrt_det(t);
        const Reduction r(s, t);
        const double det_sum = 2 + (root_s / root_t) * (r.low + r.high);
        const double factor = std::sqrt(root_s * root_t / det_sum);
        of_s = factor / root_s, of_t = factor / root_t;
    }
};

inline Tensor geometric_mean(Tensor s, Tensor t) {
    const GeometricMean mean(s, t);
    return mean.of_s * s + mean.of_t * t;
}

// As the length of an edge above, to nearly all digits for the entries as they are stored.
inline double exact_length(Tensor s, Tensor t, double dx, double dy) {
    const GeometricMean mean(s, t);
    const double at_s = exact_length(s, dx, dy), at_t = exact_length(t, dx, dy);
    const double middle = std::sqrt(mean.of_s * at_s * at_s + mean.of_t * at_t * at_t);
    return (at_s + 4 * middle + at_t) * (1.0 / 6);
}

// Equal but for rounding, which the reduction of a thin ellipse would magnify.
inline bool nearly_equal(Tensor s, Tensor t) {
    const Tensor difference = t - s;
    const double blur = 0x1p-51 * (s.a + s.c);
    return std::fabs(difference.a) <= blur && std::fabs(difference.b) <= blur &&
           std::fabs(difference.c) <= blur;
}

// The largest ellipse inside both unit ellipses: in the basis of the reduction, the larger of each
// pair of eigenvalues. s itself where t allows more, and t where s does.
inline Tensor intersect(Tensor s, Tensor t) {
    if (nearly_equal(s, t)) return s;
    const Reduction r(s, t);
    if (r.high <= 1) return s;
    if (r.low >= 1) return t;
    return s + (r.high - 1) * Reduction::square(r.at_high);
}

// The smallest ellipse around both unit ellipses: the smaller of each pair of eigenvalues. Dual to
// the intersection: the inverse of the intersection of the inverses.
inline Tensor unite(Tensor s, Tensor t) {
    if (nearly_equal(s, t)) return s;
    const Reduction r(s, t);
    if (r.high <= 1) return t;
    if (r.low >= 1) return s;
    return r.combined(r.low, 1);
}

}  // namespace metrics
