#include "render/environment/cube_map.h"
#include "render/gpu/readback.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <random>

namespace limn::test::cube_map_test {
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
    CHECK(point.st.x == test::near(st.x));
    CHECK(point.st.y == test::near(st.y));
}

}  // namespace

TEST_CASE(
    "cube_map: the axes are the centers of faces 0 to 5, other directions match OpenGL"
    * technique("env.cube-addressing")) {
    const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int face = 0; face < kCubeFaces; ++face) {
        check_point(axes[face], face, {0.5f, 0.5f});
    }
    check_point({0.5f, 0.25f, -1}, 5, {0.25f, 0.375f});
    check_point({1, 0.5f, 0.25f}, 0, {0.375f, 0.25f});
    check_point({-0.2f, -0.8f, 0.4f}, 3, {0.375f, 0.25f});
    check_point({0, 0, 0}, 4, {0.5f, 0.5f});
}

TEST_CASE(
    "cube_map: the length of a direction is irrelevant, and every point has a direction"
    * technique("env.cube-addressing")) {
    for (const Vec3& d : random_directions(200)) {
        const CubePoint point = cube_point(d);
        const CubePoint scaled = cube_point(16.0f * d);
        CHECK(scaled.face == point.face);
        CHECK(scaled.st == point.st);
        CHECK(glm::distance(glm::normalize(cube_direction(point)), glm::normalize(d)) < 1e-6f);
    }
}

TEST_CASE(
    "cube_map: texels of a face add up to a sixth of the sphere, at any resolution"
    * technique("env.capture")) {
    for (const int size : {1, 2, 7, 32}) {
        double sum = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                sum += cube_texel_solid_angle(size, x, y);
            }
        }
        CHECK(sum == test::near(4 * 3.14159265358979 / 6).epsilon(1e-12));
    }
    CHECK(cube_texel_solid_angle(32, 16, 16) > 4 * cube_texel_solid_angle(32, 0, 0));
}

TEST_CASE_FIXTURE(
    RenderTest,
    "cube_map: the hardware samples the same texel" * technique("env.cube-addressing")) {
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

TEST_CASE("cube_map: a face's camera is a rotation that renders each texel where it is stored") {
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

}  // namespace limn::test::cube_map_test
