#include "ecs/components/rendering.h"
#include "render/environment/cube_map.h"
#include "render/light/normalization_cube.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace limn::test::normalization_cube_test {
namespace {

constexpr Normalization kCubes[] = {Normalization::CubeBytes, Normalization::CubeFloats};

/// unit_vector() of each, by a cube of `size`.
std::vector<glm::dvec3>
looked_up(Normalization source, const std::vector<Vec3>& vectors, int size = kNormalizationSize) {
    const gpu::Texture cube = make_normalization_texture(source, size);
    shared_device().invalidate_state();
    shared_device().bind_texture(38, cube);
    std::vector<Vec4> inputs;
    for (const Vec3& v : vectors) {
        inputs.emplace_back(v, 0);
    }
    const std::string name =
        source == Normalization::CubeBytes ? "NORMALIZATION_CUBE_BYTES" : "NORMALIZATION_CUBE";
    const std::vector<Vec4> found = evaluate_shader(
        "#define " + name + "\n#include \"lib/normalization.glsl\"\n",
        "    y.xyz = unit_vector(x.xyz);\n", inputs);
    std::vector<glm::dvec3> result;
    for (const Vec4& value : found) {
        result.emplace_back(value);
    }
    return result;
}

/// Directions from the centers of texels, of lengths 0.1 .. 10.
std::vector<Vec3> texel_directions(int size) {
    std::vector<Vec3> directions;
    for (int i = 0; i < 6 * size * size; i += 5) {
        const int texel = i % (size * size);
        const auto at = [&](int k) {
            return (static_cast<float>(k) + 0.5f) / static_cast<float>(size);
        };
        const float length = std::exp2(static_cast<float>(i % 7) - 3);
        directions.push_back(
            length
            * cube_direction(
                {.face = i / (size * size), .st = {at(texel % size), at(texel / size)}}));
    }
    return directions;
}

/// Directions all around, on a spiral.
std::vector<Vec3> spread_directions(int count) {
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        const float z = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(count);
        const float angle = 2.399963f * static_cast<float>(i);
        const float r = std::sqrt(1 - z * z);
        directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return directions;
}

double degrees_between(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "normalization cube: at texel centers bytes are off by 0.39 degrees at most, floats by 1e-3"
        * technique("env.normalise-cube")) {
    const std::vector<Vec3> directions = texel_directions(kNormalizationSize);
    for (const Normalization source : kCubes) {
        const std::vector<glm::dvec3> found = looked_up(source, directions);
        double angle = 0;
        double distance = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const glm::dvec3 exact = glm::normalize(glm::dvec3(directions[i]));
            angle = std::max(angle, degrees_between(found[i], exact));
            distance = std::max(distance, glm::length(found[i] - exact));
        }
        CAPTURE(angle);
        CAPTURE(distance);
        if (source == Normalization::CubeBytes) {
            CHECK(angle <= 0.39);
            CHECK(angle > 0.2);  // bytes they are
        } else {
            CHECK(distance <= 1e-3);
        }
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "normalization cube: between texels, too, and across edges, vectors are nearly unit"
                    * technique("env.normalise-cube")) {
    const std::vector<Vec3> directions = spread_directions(5000);
    const std::vector<glm::dvec3> found = looked_up(Normalization::CubeFloats, directions);
    double worst = 0;
    double worst_at_edges = 0;  // of the cube, where texels of two faces do not line up
    for (std::size_t i = 0; i < found.size(); ++i) {
        Vec3 sizes = glm::abs(directions[i]);
        std::sort(&sizes.x, &sizes.x + 3);
        const bool at_edge = sizes.y > (1 - 1.0f / kNormalizationSize) * sizes.z;
        double& largest = at_edge ? worst_at_edges : worst;
        largest = std::max(largest, glm::length(found[i] - glm::dvec3(directions[i])));
    }
    // Between texels of 1/32 a chord is short by 1/8192; half floats are off by 1/4096.
    CHECK(worst < 1e-3);
    CHECK(worst_at_edges > 1e-3);
    CHECK(worst_at_edges < 5e-3);
    const std::vector<glm::dvec3> coarse = looked_up(Normalization::CubeFloats, directions, 4);
    double shortest = 1;
    for (const glm::dvec3& v : coarse) {
        shortest = std::min(shortest, glm::length(v));
    }
    CHECK(shortest < 0.98);
}

TEST_CASE_FIXTURE(
    RenderTest, "normalization cube: lengths do not matter, and opposite vectors stay opposite"
                    * technique("env.normalise-cube")) {
    const std::vector<Vec3> directions = texel_directions(16);
    std::vector<Vec3> longer;
    std::vector<Vec3> opposite;
    for (const Vec3& v : directions) {
        longer.push_back(5.0f * v);
        opposite.push_back(-v);
    }
    for (const Normalization source : kCubes) {
        const std::vector<glm::dvec3> found = looked_up(source, directions, 16);
        const std::vector<glm::dvec3> of_longer = looked_up(source, longer, 16);
        const std::vector<glm::dvec3> of_opposite = looked_up(source, opposite, 16);
        double largest = 0;
        double largest_sum = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            largest = std::max(largest, glm::length(found[i] - of_longer[i]));
            largest_sum = std::max(largest_sum, glm::length(found[i] + of_opposite[i]));
        }
        CHECK(largest < 1e-4);
        CHECK(largest_sum < 1e-4);
    }
}

TEST_CASE_FIXTURE(
    Scene, "normalization cube: bumps lit through floats are as computed, through bytes banded"
               * technique("env.normalise-cube")) {
    ImageData map = {.name = "bumps", .width = 2, .height = 2, .pixels = {}};
    map.pixels = {160, 128, 251, 255, 128, 100, 252, 255, 110, 140, 253, 255, 128, 128, 255, 255};
    Material bumpy = {.shading = ShadingModel::Blinn, .base_color = {0.6f, 0.4f, 0.3f, 1}};
    bumpy.specular = {0.4f, 0.4f, 0.4f};
    bumpy.shininess = 60;
    bumpy.normal_texture = {.image = add(std::move(map)), .nearest = true, .scale = {8, 4}};
    place(add(make_ball(32)), add(bumpy), at({0, 0, 0}));
    shine(PointLight{.intensity = 6, .radius = 0}, at({0.9f, 1.2f, 1.4f}));
    const auto with = [&](Normalization normalization) {
        world.insert_resource(
            Rendering{.shading = ShadingRate::BumpVertex, .normalization = normalization});
        return radiance(look({0, 0, 2}, {0, 0, 0}));
    };
    const gpu::FloatImage computed = with(Normalization::Computed);
    const float brightest = *std::max_element(computed.pixels.begin(), computed.pixels.end());
    REQUIRE(brightest > 0.3f);
    CHECK(largest_difference(with(Normalization::CubeFloats), computed) < 0.03f * brightest);
    const float banded = largest_difference(with(Normalization::CubeBytes), computed);
    CHECK(banded > 0.03f * brightest);
    CHECK(banded < 0.5f * brightest);
}

}  // namespace limn::test::normalization_cube_test
