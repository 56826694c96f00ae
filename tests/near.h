#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>

namespace limn::test {

/// A value with a tolerance, for ==: 1e-5 of the larger of the two compared, unless epsilon() says
/// otherwise. Where the value may be 0, scale() is the size that errors are relative to.
/// doctest::Approx always adds 1 to that size, so that small numbers pass whatever they are.
class Near {
  public:
    explicit Near(double value) : value_(value) {}

    Near epsilon(double fraction) const {
        Near copy = *this;
        copy.epsilon_ = fraction;
        return copy;
    }
    Near scale(double size) const {
        Near copy = *this;
        copy.scale_ = size;
        return copy;
    }

    friend bool operator==(double found, const Near& expected) {
        const double larger = std::max(std::abs(found), std::abs(expected.value_));
        return std::abs(found - expected.value_) <= expected.epsilon_ * (expected.scale_ + larger);
    }
    friend std::ostream& operator<<(std::ostream& out, const Near& expected) {
        return out << "near " << expected.value_;
    }

  private:
    double value_;
    double epsilon_ = 1e-5;
    double scale_ = 0;
};

inline Near near(double value) {
    return Near(value);
}

}  // namespace limn::test
