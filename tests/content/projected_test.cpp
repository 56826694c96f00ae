#include "content/make/models/projected.h"
#include "content/make/models/shapes.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace limn::projected_test {
namespace {

using test::near;

constexpr Bounds kBox = {{-2, -1, -3}, {2, 3, 3}};
constexpr Vec3 kMiddle = {0, 1, 0};

Vec2 uv_at(Wrapping wrapping, const Vec3& p) {
    return wrapped_uv(wrapping, WrapDirection::Position, kBox, p, {0, 1, 0}, {0, 1, 0});
}

/// A ball mapped anew.
MeshData mapped_ball(Wrapping wrapping, WrapDirection direction = WrapDirection::Position) {
    Assets assets;
    assets.meshes.push_back(make_sphere({.radius = 1, .segments = 48, .rings = 24}));
    return make_projected({MeshId{0}, wrapping, direction}, assets);
}

}  // namespace

TEST_CASE(
    "projected: points of a cylinder at one angle share u, and v runs down its height"
    * technique("tex.two-part-mapping")) {
    for (const float angle : {-3.0f, -1.0f, 0.0f, 0.7f, 2.9f}) {
        const float u = angle / (2 * kPi) + 0.5f;
        for (const float y : {-1.0f, 0.3f, 3.0f}) {
            for (const float r : {0.1f, 1.0f, 2.0f}) {
                const Vec2 uv =
                    uv_at(Wrapping::Cylinder, {r * std::sin(angle), y, r * std::cos(angle)});
                CHECK(uv.x == near(u).epsilon(1e-6));
                CHECK(uv.y == near((3 - y) / 4).scale(1).epsilon(1e-6));
            }
        }
    }
}

TEST_CASE(
    "projected: u is in [0, 1), v in [0, 1]; poles of a sphere have u 0.5"
    * technique("tex.two-part-mapping")) {
    for (int i = 0; i < 4000; ++i) {
        const auto t = static_cast<float>(i);
        const Vec3 d = {
            std::sin(1.7f * t) * std::sin(0.3f * t), std::cos(0.3f * t),
            std::cos(1.7f * t) * std::sin(0.3f * t)};
        for (const Wrapping wrapping : {Wrapping::Cylinder, Wrapping::Sphere}) {
            const Vec2 uv = uv_at(wrapping, kMiddle + 0.9f * d);
            CHECK(uv.x >= 0);
            CHECK(uv.x < 1);
            CHECK(uv.y >= 0);
            CHECK(uv.y <= 1);
        }
    }
    CHECK(uv_at(Wrapping::Sphere, kMiddle + Vec3(0, 1, 0)) == Vec2(0.5f, 0));
    CHECK(uv_at(Wrapping::Sphere, kMiddle - Vec3(0, 1, 0)) == Vec2(0.5f, 1));
    CHECK(uv_at(Wrapping::Sphere, kMiddle) == Vec2(0.5f, 0.5f));
    CHECK(uv_at(Wrapping::Cylinder, kMiddle + Vec3(0, 0, -1)).x < 1);
    CHECK(uv_at(Wrapping::Sphere, kMiddle + Vec3(-0.0f, 0, -1)).x < 1);
}

TEST_CASE(
    "projected: no triangle spans more than half of the image"
    * technique("tex.two-part-mapping")) {
    for (const Wrapping wrapping : {Wrapping::Cylinder, Wrapping::Sphere}) {
        for (const WrapDirection direction : {WrapDirection::Position, WrapDirection::Normal}) {
            const MeshData mesh = mapped_ball(wrapping, direction);
            float widest = 0;
            for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
                const float a = mesh.uvs[mesh.indices[i]].x;
                const float b = mesh.uvs[mesh.indices[i + 1]].x;
                const float c = mesh.uvs[mesh.indices[i + 2]].x;
                widest = std::max(widest, std::max({a, b, c}) - std::min({a, b, c}));
            }
            CHECK(widest <= 0.5f);
            CHECK(widest <= 1.01f / 48);  // of a ball with 48 segments
        }
    }
}

TEST_CASE(
    "projected: the mesh keeps its shape, and its image is upright and not mirrored"
    * technique("tex.two-part-mapping")) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 48, .rings = 24});
    for (const Wrapping wrapping : {Wrapping::Box, Wrapping::Cylinder, Wrapping::Sphere}) {
        const MeshData mesh = mapped_ball(wrapping);
        REQUIRE(mesh.indices.size() == ball.indices.size());
        for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
            CHECK(mesh.positions[mesh.indices[i]] == ball.positions[ball.indices[i]]);
            CHECK(mesh.normals[mesh.indices[i]] == ball.normals[ball.indices[i]]);
        }
        CHECK(mesh.tangents.size() == mesh.positions.size());
        // Upright on the sides; unmirrored everywhere but at poles without an area of image.
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            if (std::abs(mesh.positions[v].y) < 0.6f) {
                CHECK(mesh.tangents[v].w == 1);
            }
        }
    }
}

TEST_CASE(
    "projected: a ball around its center is mapped as by its own longitude and latitude"
    * technique("tex.two-part-mapping")) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 48, .rings = 24});
    const MeshData mesh = mapped_ball(Wrapping::Sphere);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (std::abs(mesh.positions[mesh.indices[i]].y) > 0.999f) {
            continue;  // poles, whose u is a choice
        }
        const Vec2 d = mesh.uvs[mesh.indices[i]] - ball.uvs[ball.indices[i]];
        CHECK(d.x - std::round(d.x) == near(0).scale(1).epsilon(1e-5));
        CHECK(d.y == near(0).scale(1).epsilon(1e-5));
    }
}

TEST_CASE("projected: without a mesh it is empty") {
    CHECK(make_projected({}, Assets()).positions.empty());
}

}  // namespace limn::projected_test
