// Integers as long as the exact predicates can ever need; no allocation, no overflow.
//
// A finite double is an integer multiple of 2^-1074 below 2^1024, so a coordinate scaled to an
// integer has at most 2098 bits, a difference of two 2099, a sum of two products of differences
// 4199, and the incircle determinant, a sum of two products of those, 8399.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace adaptmesh {

class Integer {
  public:
    // mantissa * 2^shift with the sign given; mantissa below 2^53.
    Integer(bool negative, std::uint64_t mantissa, int shift) : negative_(negative), size_(0) {
        for (; size_ < shift / 32; ++size_) limbs_[size_] = 0;
        const int rest = shift % 32;
        limbs_[size_++] = Limb(mantissa << rest);
        limbs_[size_++] = Limb(mantissa << rest >> 32);
        limbs_[size_++] = rest == 0 ? 0 : Limb(mantissa >> (64 - rest));
        trim();
    }

    int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

    // This integer times 2^exponent, correct to the last bit but one; the three highest limbs have
    // at least 65 bits.
    double times_power_of_two(int exponent) const {
        double sum = 0;
        for (int i = std::max(size_ - 3, 0); i < size_; ++i) {
            sum += std::ldexp(double(limbs_[i]), 32 * i + exponent);
        }
        return negative_ ? -sum : sum;
    }

    friend Integer operator+(const Integer& a, const Integer& b) {
        return signed_sum(a, b, b.negative_);
    }
    friend Integer operator-(const Integer& a, const Integer& b) {
        return signed_sum(a, b, !b.negative_);
    }

    friend Integer operator*(const Integer& a, const Integer& b) {
        Integer product;
        product.negative_ = a.negative_ != b.negative_;
        product.size_ = a.size_ + b.size_;
        for (int i = 0; i < product.size_; ++i) product.limbs_[i] = 0;
        for (int i = 0; i < a.size_; ++i) {
            std::uint64_t carry = 0;  // the sum below is at most 2^64 - 1
            for (int j = 0; j < b.size_; ++j) {
                carry += std::uint64_t(a.limbs_[i]) * b.limbs_[j] + product.limbs_[i + j];
                product.limbs_[i + j] = Limb(carry);
                carry >>= 32;
            }
            product.limbs_[i + b.size_] = Limb(carry);
        }
        product.trim();
        return product;
    }

  private:
    using Limb = std::uint32_t;
    static constexpr int CAPACITY = 8399 / 32 + 4;  // and a few limbs that trim() takes away

    Integer() {}  // the operators fill it in; clearing all the limbs would cost more than they do

    static Integer signed_sum(const Integer& a, const Integer& b, bool b_negative) {
        if (a.negative_ == b_negative) return magnitude_sum(a, b, a.negative_);
        if (magnitude_less(a, b)) return magnitude_difference(b, a, b_negative);
        return magnitude_difference(a, b, a.negative_);
    }

    static bool magnitude_less(const Integer& a, const Integer& b) {
        if (a.size_ != b.size_) return a.size_ < b.size_;
        int i = a.size_ - 1;
        while (i >= 0 && a.limbs_[i] == b.limbs_[i]) --i;
        return i >= 0 && a.limbs_[i] < b.limbs_[i];
    }

    static Integer magnitude_sum(const Integer& a, const Integer& b, bool negative) {
        const Integer& longer = a.size_ < b.size_ ? b : a;
        const Integer& shorter = a.size_ < b.size_ ? a : b;
        Integer sum;
        sum.negative_ = negative;
        std::uint64_t carry = 0;
        for (int i = 0; i < longer.size_; ++i) {
            carry += longer.limbs_[i];
            if (i < shorter.size_) carry += shorter.limbs_[i];
            sum.limbs_[i] = Limb(carry);
            carry >>= 32;
        }
        sum.limbs_[longer.size_] = Limb(carry);
        sum.size_ = longer.size_ + 1;
        sum.trim();
        return sum;
    }

    // |large| - |small|, not negative.
    static Integer magnitude_difference(const Integer& large, const Integer& small, bool negative) {
        Integer difference;
        difference.negative_ = negative;
        std::uint64_t borrow = 0;
        for (int i = 0; i < large.size_; ++i) {
            std::uint64_t value = std::uint64_t(large.limbs_[i]) - borrow;
            if (i < small.size_) value -= small.limbs_[i];
            difference.limbs_[i] = Limb(value);
            borrow = value >> 63;  // below zero it wrapped around
        }
        difference.size_ = large.size_;
        difference.trim();
        return difference;
    }

    void trim() {
        while (size_ > 0 && limbs_[size_ - 1] == 0) --size_;
    }

    bool negative_;
    int size_;  // limbs in use, least significant first, the last one not zero; 0 is zero
    Limb limbs_[CAPACITY];
};

}  // namespace adaptmesh
