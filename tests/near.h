#pragma once

#include <doctest/doctest.h>

namespace limn::test {

/// `value` within a relative tolerance, 1e-5 unless .epsilon() says otherwise. A bare
/// doctest::Approx adds 1 to the size of what it compares, so that small numbers pass whatever they
/// are; where a number may be 0, give the size that errors are relative to: near(x).scale(size).
inline doctest::Approx near(double value) {
    return doctest::Approx(value).scale(0);
}

}  // namespace limn::test
