// Sums and products of doubles without error: a pair hi + lo that *is* the result.
//
// hi is the rounded result, lo what rounding threw away, |lo| <= u |hi| with u = 2^-53. The
// algorithms are Knuth's TwoSum and Dekker's product with Veltkamp's splitting; proofs in Shewchuk
// (1997), Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates,
// Theorems 7, 17 and 18. They hold in round-to-nearest double arithmetic that nobody fuses,
// reorders or keeps in wider registers, as long as nothing overflows and no product underflows.
#pragma once

#include <cfloat>
#include <limits>

#if defined(__FAST_MATH__) || defined(_M_FP_FAST)
#error "adaptmesh: the predicates are wrong with fast math"
#endif

namespace adaptmesh {

static_assert(std::numeric_limits<double>::is_iec559 && FLT_EVAL_METHOD == 0,
              "the predicates need IEEE double arithmetic without extended registers");

struct Two {
    double hi, lo;
};

inline Two operator-(Two x) {
    return {-x.hi, -x.lo};
}

inline Two two_sum(double a, double b) {
    const double hi = a + b;
    const double b_part = hi - a;
    const double a_part = hi - b_part;
    return {hi, (a - a_part) + (b - b_part)};
}

inline Two two_difference(double a, double b) {
    return two_sum(a, -b);
}

// Two halves of at most 26 bits each, the sign of the lower one being the 53rd.
inline Two split(double a) {
    const double c = 134217729.0 * a;  // 2^27 + 1
    const double hi = c - (c - a);
    return {hi, a - hi};
}

inline Two two_product(double a, double b) {
    const double hi = a * b;
    const Two s = split(a), t = split(b);
    const double lo = s.lo * t.lo - (((hi - s.hi * t.hi) - s.lo * t.hi) - s.hi * t.lo);
    return {hi, lo};
}

}  // namespace adaptmesh
