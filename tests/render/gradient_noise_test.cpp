#include "ecs/base/gradient_noise.h"
#include "ecs/components/light.h"
#include "render/light/light_list.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/common.hpp>

#include <bit>
#include <cmath>
#include <random>

namespace limn::test::gradient_noise_test {
namespace {

/// Points within +-`range` along each axis.
std::vector<Vec3> random_points(int count, float range, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(-range, range);
    std::vector<Vec3> all;
    for (int i = 0; i < count; ++i) {
        const float x = any(random);
        const float y = any(random);
        all.emplace_back(x, y, any(random));
    }
    return all;
}

}  // namespace

TEST_CASE(
    "noise: a million samples stay within 0 and 1 and approach both" * technique("shade.noise")) {
    Vec3 least(1);
    Vec3 most(0);
    for (const Vec3& p : random_points(400'000, 1000, 1)) {
        const Vec3 values = {noise(p.x), noise(Vec2(p), 3), noise(p, 4)};
        least = glm::min(least, values);
        most = glm::max(most, values);
        const float rough = noise(p, 5, 4);
        CHECK((rough >= 0 && rough <= 1));
    }
    for (int i = 0; i < 3; ++i) {
        CHECK(least[i] >= 0);
        CHECK(most[i] <= 1);
        CHECK(least[i] < 0.15f);
        CHECK(most[i] > 0.85f);
    }
}

TEST_CASE(
    "noise: at lattice points it is one half, for any seed and number of octaves"
    * technique("shade.noise")) {
    for (int x = -5; x <= 5; ++x) {
        for (int y = -5; y <= 5; ++y) {
            const auto seed = static_cast<std::uint32_t>(x * 31 + y);
            CHECK(noise(static_cast<float>(x), seed, 2) == 0.5f);
            CHECK(noise(Vec2(x, y), seed, 3) == 0.5f);
            CHECK(noise(Vec3(x, y, x - y), seed, 4) == 0.5f);
        }
    }
}

TEST_CASE(
    "noise: it is continuous, also across cell borders, and differs between seeds"
    * technique("shade.noise")) {
    for (const Vec3& p : random_points(2000, 50, 2)) {
        const Vec3 on_border = {std::floor(p.x), p.y, p.z};
        for (const Vec3& at : {p, on_border}) {
            for (const float e : {1e-2f, 1e-3f, 1e-4f}) {
                // Its steepest slope is below 4.
                const Vec3 near = at + Vec3(e, 0, 0);
                CHECK(std::abs(noise(near) - noise(at)) <= 4 * e + 1e-5f);
                CHECK(std::abs(noise(Vec2(near)) - noise(Vec2(at))) <= 4 * e + 1e-5f);
                CHECK(std::abs(noise(near.x) - noise(at.x)) <= 4 * e + 1e-5f);
            }
        }
    }
    int same = 0;
    for (const Vec3& p : random_points(1000, 50, 3)) {
        same += std::abs(noise(p, 1) - noise(p, 2)) < 0.01f ? 1 : 0;
    }
    CHECK(same < 100);
}

TEST_CASE(
    "noise: NaN, infinity and numbers without fractional bits give one half"
    * technique("shade.noise")) {
    for (const float x : {NAN, INFINITY, -INFINITY, 1e30f, -1e10f, 0x1p23f}) {
        CHECK(noise(x) == 0.5f);
        CHECK(noise(Vec2(0.3f, x), 1, 2) == 0.5f);
        CHECK(noise(Vec3(0.3f, 0.4f, x), 1, 5) == 0.5f);
    }
    CHECK(noise(0x1p22f + 0.5f) != 0.5f);
}

TEST_CASE_FIXTURE(
    RenderTest, "noise: CPU and GPU agree to 1e-5, and each is repeatable to the bit"
                    * technique("shade.noise, shade.stdlib")) {
    std::vector<Vec4> inputs;
    for (const float range : {3.0f, 1000.0f, 80'000.0f}) {
        for (const Vec3& p : random_points(1500, range, 4)) {
            inputs.emplace_back(p, static_cast<float>(inputs.size() % 5 + 1));
        }
    }
    inputs.emplace_back(NAN, NAN, NAN, 1);
    inputs.emplace_back(1e30f, -1e30f, INFINITY, 2);
    const std::string before = "#include \"lib/noise.glsl\"\n";
    const std::string body = "uint seed = 77u; int octaves = int(x.w);\n"
                             "y.x = noise(x.x, seed, octaves); y.y = noise(x.xy, seed, octaves);\n"
                             "y.z = noise(x.xyz, seed, octaves);";
    const std::vector<Vec4> gpu = evaluate_shader(before, body, inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Vec3 p = Vec3(inputs[i]);
        const int octaves = static_cast<int>(inputs[i].w);
        CAPTURE(i);
        CHECK(std::abs(gpu[i].x - noise(p.x, 77, octaves)) <= 1e-5f);
        CHECK(std::abs(gpu[i].y - noise(Vec2(p), 77, octaves)) <= 1e-5f);
        CHECK(std::abs(gpu[i].z - noise(p, 77, octaves)) <= 1e-5f);
    }
    CHECK(evaluate_shader(before, body, inputs) == gpu);
    CHECK(noise(0.3f) == noise(0.3f));
}

TEST_CASE(
    "noise: a flame flickers within its amplitude, smoothly, and no two alike"
    * technique("shade.noise")) {
    const LightPulse one = {
        .function = {.wave = Wave::Noise, .base = 1, .amplitude = 0.3f, .frequency = 1.91f}};
    LightPulse other = one;
    other.function.phase = 1.5f;
    float least = 2;
    float most = 0;
    double apart = 0;
    float last = pulse_factor(one, 0);
    for (int i = 1; i <= 3600; ++i) {
        const double time = i / 60.0;
        const float factor = pulse_factor(one, time);
        CHECK(std::abs(factor - last) < 0.2f);  // of two images
        least = std::min(least, factor);
        most = std::max(most, factor);
        apart += std::abs(factor - pulse_factor(other, time));
        last = factor;
    }
    CHECK(least >= 0.7f);
    CHECK(most <= 1.3f);
    CHECK(most - least > 0.3f);
    CHECK(apart / 3600 > 0.03);
    CHECK(pulse_factor(one, 17.25) == pulse_factor(one, 17.25));
}

}  // namespace limn::test::gradient_noise_test
