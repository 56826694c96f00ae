#include "render/cube_map.h"
#include "render/gpu/readback.h"
#include "tests/render/shader_eval.h"

#include <glm/geometric.hpp>

#include <random>

namespace limn::test {
namespace {

std::vector<Vec3> random_directions(int count) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        directions.emplace_back(normal(random), normal(random), normal(random));
    }
    return directions;
}

void check_point(const Vec3& direction, int face, const Vec2& st) {
    const CubePoint point = cube_point(direction);
    CHECK(point.face == face);
    CHECK(point.st.x == doctest::Approx(st.x));
    CHECK(point.st.y == doctest::Approx(st.y));
}

}  // namespace

TEST_CASE("cube_map: the axes are the middles of faces 0 to 5, other directions where OpenGL's "
          "table has them") {
    const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < kCubeFaces; ++face) {
        check_point(axes[face], face, {0.5f, 0.5f});
    }
    check_point({0.5f, 0.25f, -1}, 5, {0.25f, 0.375f});
    check_point({1, 0.5f, 0.25f}, 0, {0.375f, 0.25f});
    check_point({-0.2f, -0.8f, 0.4f}, 3, {0.375f, 0.25f});
    check_point({0, 0, 0}, 4, {0.5f, 0.5f});
}

TEST_CASE("cube_map: the length of a direction does not count, and every point has its direction") {
    for (const Vec3& d : random_directions(200)) {
        const CubePoint point = cube_point(d);
        const CubePoint scaled = cube_point(16.0f * d);
        CHECK(scaled.face == point.face);
        CHECK(scaled.st == point.st);
        CHECK(glm::distance(glm::normalize(cube_direction(point)), glm::normalize(d)) < 1e-6f);
    }
}

TEST_CASE("cube_map: a face is a sixth of the sphere, whatever its texels") {
    for (const int size : {1, 2, 7, 32}) {
        double sum = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                sum += cube_texel_solid_angle(size, x, y);
            }
        }
        CHECK(sum == doctest::Approx(4 * 3.14159265358979 / 6).epsilon(1e-12));
    }
    CHECK(cube_texel_solid_angle(32, 16, 16) > 4 * cube_texel_solid_angle(32, 0, 0));
}

TEST_CASE_FIXTURE(RenderTest, "cube_map: the hardware finds the same texel") {
    constexpr int kSize = 8;
    gpu::Texture cube(
        "cube",
        {.format = GL_RGBA32F, .width = kSize, .height = kSize, .target = GL_TEXTURE_CUBE_MAP});
    cube.set_filter(GL_NEAREST, GL_NEAREST);
    for (int face = 0; face < kCubeFaces; ++face) {
        std::vector<Vec4> texels;
        for (int i = 0; i < kSize * kSize; ++i) {
            texels.emplace_back(face, i % kSize, i / kSize, 0);
        }
        cube.upload<Vec4>(texels, GL_RGBA, GL_FLOAT, 0, face);
    }
    std::vector<Vec4> directions;
    for (const Vec3& d : random_directions(500)) {
        directions.emplace_back(d, 0);
    }
    device().bind_texture(3, cube);
    const std::vector<Vec4> texels = evaluate_shader(
        "layout(binding = 3) uniform samplerCube cube;", "y = textureLod(cube, x.xyz, 0.0);",
        directions);
    for (std::size_t i = 0; i < directions.size(); ++i) {
        const CubePoint point = cube_point(Vec3(directions[i]));
        const Vec2 texel = float{kSize} * point.st;
        if (glm::distance(texel, glm::round(texel)) > 1e-3f) {  // else between two
            CHECK(texels[i].x == point.face);
            CHECK(texels[i].y == std::floor(texel.x));
            CHECK(texels[i].z == std::floor(texel.y));
        }
    }
}

TEST_CASE_FIXTURE(RenderTest, "normalise_cube: a cube of unit vectors makes any vector unit") {
    constexpr int kSize = 64;
    for (const bool floats : {true, false}) {
        gpu::Texture cube(
            "unit vectors", {.format = static_cast<GLenum>(floats ? GL_RGBA32F : GL_RGBA8),
                             .width = kSize,
                             .height = kSize,
                             .target = GL_TEXTURE_CUBE_MAP});
        cube.set_filter(GL_LINEAR, GL_LINEAR);
        std::vector<Vec4> centers;
        for (int face = 0; face < kCubeFaces; ++face) {
            std::vector<Vec4> texels;
            for (int i = 0; i < kSize * kSize; ++i) {
                const Vec2 st = (Vec2(i % kSize, i / kSize) + 0.5f) / float{kSize};
                const Vec3 unit = glm::normalize(cube_direction({face, st}));
                texels.emplace_back(0.5f * unit + 0.5f, 1);
                if (i % 7 == 0) {
                    centers.emplace_back(unit, 0);
                }
            }
            cube.upload<Vec4>(texels, GL_RGBA, GL_FLOAT, 0, face);
        }
        const auto look_up = [&](const std::vector<Vec4>& vectors) {
            device().bind_texture(3, cube);
            return evaluate_shader(
                "layout(binding = 3) uniform samplerCube cube;",
                "y.xyz = 2.0 * textureLod(cube, x.xyz, 0.0).xyz - 1.0;", vectors);
        };
        const double most = floats ? 1e-3 : 0.39 * 3.14159265358979 / 180;
        const std::vector<Vec4> found = look_up(centers);
        std::vector<Vec4> longer;
        std::vector<Vec4> opposite;
        for (std::size_t i = 0; i < centers.size(); ++i) {
            const glm::dvec3 a = Vec3(found[i]);
            const glm::dvec3 b = Vec3(centers[i]);
            CHECK(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) <= most);
            longer.push_back(5.0f * centers[i]);
            opposite.push_back(-centers[i]);
        }
        const std::vector<Vec4> of_longer = look_up(longer);
        const std::vector<Vec4> of_opposite = look_up(opposite);
        for (std::size_t i = 0; i < centers.size(); ++i) {
            CHECK(glm::distance(of_longer[i], found[i]) < 1e-4f);
            // A code of 8 bits has no middle: half a step either way.
            CHECK(glm::distance(of_opposite[i], -found[i]) < (floats ? 1e-4f : 0.015f));
        }
        // Between the centers of texels, over seams too, filtering leaves it nearly so.
        std::vector<Vec4> any;
        for (const Vec3& d : random_directions(300)) {
            any.emplace_back(3.0f * d, 0);
        }
        const std::vector<Vec4> between = look_up(any);
        for (std::size_t i = 0; i < any.size(); ++i) {
            CHECK(glm::distance(glm::normalize(Vec3(any[i])), Vec3(between[i])) < 0.02f);
        }
    }
}

TEST_CASE("cube_map: a face's camera is a rotation that sees each texel where it is stored") {
    const Vec3 eye = {3, -2, 5};
    for (int face = 0; face < kCubeFaces; ++face) {
        const Affine pose = cube_face_pose(face, eye);
        const Vec3 right = transform_vector(pose, {1, 0, 0});
        const Vec3 up = transform_vector(pose, {0, 1, 0});
        const Vec3 back = transform_vector(pose, {0, 0, 1});
        CHECK(glm::cross(right, up) == back);  // not a mirror image
        CHECK(transform_point(pose, {0, 0, 0}) == eye);
        CHECK(cube_direction({face, {0.5f, 0.5f}}) == -back);
        // The image's columns run right and its rows, in OpenGL, up.
        CHECK(cube_direction({face, {0.75f, 0.5f}}) == -back + 0.5f * right);
        CHECK(cube_direction({face, {0.5f, 0.75f}}) == -back + 0.5f * up);
    }
}

}  // namespace limn::test
