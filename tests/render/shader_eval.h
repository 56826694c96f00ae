#pragma once

#include "bench/oracles/shader_values.h"
#include "tests/render/render_fixture.h"

#include <string>
#include <utility>
#include <vector>

namespace limn::test {

/// oracle::evaluate_shader on the tests' device.
inline std::vector<Vec4> evaluate_shader(
    const std::string& before, const std::string& body, const std::vector<Vec4>& inputs) {
    Result<std::vector<Vec4>> found =
        oracle::evaluate_shader(shared_device(), before, body, inputs);
    REQUIRE_MESSAGE(found.ok(), (found ? "" : found.error().message));
    return std::move(*found);
}

}  // namespace limn::test
