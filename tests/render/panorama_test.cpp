#include "render/environment/panorama.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <random>

namespace limn::test::panorama_test {
namespace {

constexpr float kHalfAngle = radians(45.0f);

bool near(const Vec2& a, const Vec2& b) {
    return glm::distance(a, b) < 1e-5f;
}

}  // namespace

TEST_CASE(
    "panorama: an angular map has the zenith at the center and the horizon halfway out"
    * technique("env.angular-map")) {
    CHECK(near(angular_uv({0, 1, 0}), {0.5f, 0.5f}));
    CHECK(near(angular_uv({1, 0, 0}), {0.75f, 0.5f}));
    CHECK(near(angular_uv({0, 0, 1}), {0.5f, 0.75f}));
    CHECK(near(angular_uv({-1, 0, 0}), {0.25f, 0.5f}));
    CHECK(near(angular_uv(glm::normalize(Vec3(1, 1, 0))), {0.625f, 0.5f}));
    CHECK(near(angular_uv(glm::normalize(Vec3(1, -1, 0))), {0.875f, 0.5f}));
    CHECK(near(angular_uv(glm::normalize(Vec3(1, 1, 1))), {0.60751f, 0.60751f}));
}

TEST_CASE(
    "panorama: in an angular map the distance from the center is the angle from the zenith"
    * technique("env.angular-map")) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 100; ++i) {
        const Vec3 d = glm::normalize(Vec3(normal(random), normal(random), normal(random)));
        const float radius = glm::distance(angular_uv(d), Vec2(0.5f));
        CHECK(radius == test::near(std::acos(d.y) / (2 * kPi)).epsilon(1e-4));
    }
    // Straight down is the whole rim; what little is left of x and z chooses the point.
    CHECK(glm::distance(angular_uv({1e-6f, -1, 0}), {1, 0.5f}) < 1e-5f);
    CHECK(std::isfinite(angular_uv({0, -1, 0}).x));
}

TEST_CASE(
    "panorama: a cylinder has -z at the center, its half angle at the edge, and no seam"
    * technique("env.panorama")) {
    CHECK(near(cylindrical_uv({0, 0, -1}, kHalfAngle), {0.5f, 0.5f}));
    CHECK(near(cylindrical_uv({1, 0, 0}, kHalfAngle), {0.75f, 0.5f}));
    CHECK(cylindrical_uv({0, 1, -1}, kHalfAngle).y == test::near(1));
    CHECK(cylindrical_uv({0, std::tan(0.3f), -1}, 0.3f).y == test::near(1));
    CHECK(cylindrical_uv({0, 5, -1}, kHalfAngle).y == 1);
    CHECK(cylindrical_uv({0, -5, -1}, kHalfAngle).y == 0);
    const float left = cylindrical_uv({-1e-6f, 0.2f, 1}, kHalfAngle).x;
    const float right = cylindrical_uv({1e-6f, 0.2f, 1}, kHalfAngle).x;
    CHECK(std::abs(right - left) == test::near(1));  // the same point of an image that repeats
}

TEST_CASE("panorama: longitude and latitude are linear in the image") {
    CHECK(near(equirectangular_uv({0, 0, -1}), {0.5f, 0.5f}));
    CHECK(near(equirectangular_uv({1, 0, 0}), {0.75f, 0.5f}));
    CHECK(near(equirectangular_uv({-1, 0, 0}), {0.25f, 0.5f}));
    CHECK(near(equirectangular_uv({0, 1, -1}), {0.5f, 0.75f}));
    CHECK(equirectangular_uv({0, -3, 0}).y == test::near(0).scale(1));
}

TEST_CASE_FIXTURE(
    RenderTest, "panorama: the GPU's mappings equal the CPU's" * technique("env.angular-map")) {
    std::mt19937 random(4);
    std::normal_distribution<float> normal;
    std::vector<Vec4> inputs = {
        {0, 1, 0, 0}, {0, -1, 0, 1}, {0, 1, 0, 1}, {0, -1, 0, 0}, {0, 1, 0, 2}};
    for (int i = 0; i < 300; ++i) {
        inputs.emplace_back(normal(random), normal(random), normal(random), i % 3);
    }
    const std::vector<Vec4> got = evaluate_shader(
        "#include \"lib/panorama.glsl\"", "y.xy = panorama_uv(int(x.w), x.xyz, 0.785398163);",
        inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const auto mapping = static_cast<PanoramaMapping>(static_cast<int>(inputs[i].w));
        const Vec2 want = panorama_uv(mapping, Vec3(inputs[i]), kHalfAngle);
        CAPTURE(i);
        CHECK(glm::distance(Vec2(got[i].x, got[i].y), want) < 2e-5f);
    }
}

}  // namespace limn::test::panorama_test
