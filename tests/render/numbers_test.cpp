#include "tests/render/shader_eval.h"

#include <limits>

namespace limn::numbers_test {
namespace {

using Limits = std::numeric_limits<float>;

TEST_CASE_FIXTURE(test::RenderTest, "numbers: NaN and infinity are detected, whatever their sign") {
    const std::vector<float> values = {
        0.0f,
        -1.0f,
        Limits::denorm_min(),
        Limits::max(),
        -Limits::max(),
        Limits::infinity(),
        -Limits::infinity(),
        Limits::quiet_NaN(),
        -Limits::quiet_NaN()};
    std::vector<Vec4> inputs;
    for (const float value : values) {
        inputs.push_back(Vec4(value, 1, 1, 1));
    }
    const std::vector<Vec4> classified = test::evaluate_shader(
        "#include \"lib/numbers.glsl\"\n",
        "y = vec4(is_finite(x.yxz), is_infinite(x.x), is_nan(x.x), is_nan(x.xyz).x);", inputs);
    for (std::size_t i = 0; i < values.size(); ++i) {
        INFO(values[i]);
        CHECK(classified[i].x == (std::isfinite(values[i]) ? 1.0f : 0.0f));
        CHECK(classified[i].y == (std::isinf(values[i]) ? 1.0f : 0.0f));
        CHECK(classified[i].z == (std::isnan(values[i]) ? 1.0f : 0.0f));
        CHECK(classified[i].w == classified[i].z);
    }
}

TEST_CASE_FIXTURE(test::RenderTest, "numbers: NaN and infinite motion becomes zero") {
    const float nan = Limits::quiet_NaN();
    const float inf = Limits::infinity();
    const std::vector<Vec4> moved = test::evaluate_shader(
        "#include \"lib/motion.glsl\"\n#include \"lib/velocity.glsl\"\n",
        "y = vec4(bounded_motion(x.xy, 10.0), velocity_from(x.xy, vec3(0.0, 0.0, 1.0), "
        "vec2(100.0)));",
        {Vec4(nan, 0, 0, 0), Vec4(0, inf, 0, 0), Vec4(-nan, inf, 0, 0), Vec4(3, 4, 0, 0)});
    CHECK(moved[0] == Vec4(0));
    CHECK(moved[1] == Vec4(0));
    CHECK(moved[2] == Vec4(0));
    CHECK(moved[3] == Vec4(3, 4, 1.5, 2));
}

TEST_CASE_FIXTURE(test::RenderTest, "numbers: radiance for half floats is clamped to their range") {
    // The profile of a GPU defines it for all shaders.
    const std::string radiance = "#include \"lib/radiance.glsl\"\n";
    const std::string half = "#undef HALF_FLOATS\n#define HALF_FLOATS\n" + radiance;
    const std::string full = "#undef HALF_FLOATS\n" + radiance;
    const std::string body = "y.xyz = storable(x.xyz);";
    const Vec4 bright(1, 1e9f, Limits::infinity(), 0);
    CHECK(test::evaluate_shader(half, body, {bright})[0] == Vec4(1, 65504, 65504, 0));
    CHECK(test::evaluate_shader(full, body, {bright})[0] == bright);
    const Vec4 broken(Limits::quiet_NaN(), 1, -Limits::quiet_NaN(), 0);
    CHECK(test::evaluate_shader(half, body, {broken})[0] == Vec4(0, 1, 0, 0));
}

}  // namespace
}  // namespace limn::numbers_test
