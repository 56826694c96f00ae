#pragma once

#include <doctest/doctest.h>

namespace limn {

/// Names the techniques that a test case is about, by the ids of TECHNIQUES.md, which is made of
/// them: TEST_CASE("water: it is wet" * technique("water.wetness, water.flow")). doctest prints
/// them where the test fails.
using technique = doctest::description;

}  // namespace limn
