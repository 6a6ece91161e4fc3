// Integrals over edges and triangles of a metric whose logarithm is linear between the vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "metrics/core/tensor.hpp"

namespace metrics {

// Gauss and Legendre's eight points on [0, 1], symmetric about the middle.
constexpr int GAUSS_PAIRS = 4;
constexpr double GAUSS_FROM_MIDDLE[GAUSS_PAIRS] = {0.091717321247824902, 0.26276620495816449,
                                                   0.39833323870681337, 0.48014492824876812};
constexpr double GAUSS_WEIGHT[GAUSS_PAIRS] = {0.18134189168918099, 0.15685332293894364,
                                              0.11119051722668724, 0.050614268145188130};

// The length of (dx, dy) where the logarithm of the metric changes linearly from one end to the
// other.
inline double length_by_quadrature(Tensor log_start, Tensor log_end, double dx, double dy) {
    const Tensor middle = 0.5 * (log_start + log_end), change = log_end - log_start;
    double sum = 0;
    for (int k = 0; k < GAUSS_PAIRS; ++k) {
        const Tensor step = GAUSS_FROM_MIDDLE[k] * change;
        sum += GAUSS_WEIGHT[k] * (length(exp_tensor(middle - step), dx, dy) +
                                  length(exp_tensor(middle + step), dx, dy));
    }
    return sum;
}

// (e^b - e^a) / (b - a) for a <= b.
inline double exponential_slope(double a, double b) {
    const double gap = b - a;
    return std::exp(a) * (gap < 1e-8 ? 1 + gap / 2 : std::expm1(gap) / gap);
}

// The integral of exp(f) over the triangle of area 1/2, f linear with these values at the corners:
// the second divided difference of exp. Where they differ little, by the series of the complete
// symmetric polynomials h_k / (k + 2)! in the differences from their mean, of which
// h_k = p2 h_(k-2) + p3 h_(k-3), as h_1 = 0.
inline double mean_exponential(double low, double middle, double high) {
    if (low > middle) std::swap(low, middle);
    if (middle > high) std::swap(middle, high);
    if (low > middle) std::swap(low, middle);
    if (high - low > 1) {
        return (exponential_slope(middle, high) - exponential_slope(low, middle)) / (high - low);
    }
    constexpr int LAST = 15;
    const double mean = (low + middle + high) / 3;
    low -= mean, middle -= mean, high -= mean;
    const double p2 = -(low * middle + middle * high + high * low), p3 = low * middle * high;
    double before[3] = {1, 0, p2};  // h_(k-3), h_(k-2), h_(k-1)
    double factorial = 24, sum = 0.5 + p2 / factorial;
    for (int k = 3; k <= LAST; ++k) {
        const double next = p2 * before[1] + p3 * before[0];
        before[0] = before[1], before[1] = before[2], before[2] = next;
        factorial *= k + 2;
        sum += next / factorial;
    }
    return std::exp(mean) * sum;
}

}  // namespace metrics
