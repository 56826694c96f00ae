// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "tests/render/shader_eval.h"
#include "tests/support.h"

#include <glm/geometric.hpp>

#include <string>
#include <vector>

namespace limn::test::inflate_test {
namespace {

/// Where the vertices go, by the function that draws them; normals are `stretch` long.
std::vector<Vec3> inflate_vertices(const MeshData& mesh, float distance, float stretch = 1) {
    std::vector<Vec4> inputs;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        inputs.emplace_back(mesh.positions[i], distance);
        inputs.emplace_back(stretch * mesh.normals[i], 0);
    }
    const std::vector<Vec4> moved = evaluate_shader(
        "#include \"lib/inflate.glsl\"\n",
        "y.xyz = i % 2u == 0u ? inflate(x.xyz, inputs[i + 1u].xyz, x.w) : vec3(0.0);", inputs);
    std::vector<Vec3> positions;
    for (std::size_t i = 0; i < moved.size(); i += 2) {
        positions.emplace_back(moved[i]);
    }
    return positions;
}

/// A cube of half side 1: a vertex a face and corner, or one a corner with the mean normal.
MeshData make_cube(bool shared_corners) {
    MeshData mesh;
    mesh.name = "cube";
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            Vec3 n(0);
            n[axis] = side;
            Vec3 u(0);
            u[(axis + 1) % 3] = 1;
            const Vec3 v = glm::cross(n, u);
            const auto first = static_cast<std::uint32_t>(mesh.positions.size());
            for (const Vec2& c : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
                const Vec3 p = n + c.x * u + c.y * v;
                mesh.positions.push_back(p);
                mesh.normals.push_back(shared_corners ? glm::normalize(p) : n);
            }
            for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
                mesh.indices.push_back(first + i);
            }
        }
    }
    mesh.bounds = {{-1, -1, -1}, {1, 1, 1}};
    return mesh;
}

/// Largest distance between vertices that were at the same position.
float widest_gap(const MeshData& mesh, const std::vector<Vec3>& moved) {
    float widest = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            if (mesh.positions[i] == mesh.positions[j]) {
                widest = std::max(widest, glm::distance(moved[i], moved[j]));
            }
        }
    }
    return widest;
}

const Material kMatte = {
    .shading = ShadingModel::Unlit, .double_sided = true, .base_color = {1, 1, 1, 1}};

struct InflateScene : ShadowTest {
    Entity ball(float scale, const Inflate* inflate) {
        const Entity entity =
            place(sphere, white, affine_from({0.2f, 0.1f, 0}, {1, 0, 0, 0}, Vec3(scale)));
        if (inflate != nullptr) {
            world.add(entity, *inflate);
        }
        return entity;
    }
    const MeshId sphere = add(make_ball(96));
};

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "inflate: every vertex of a unit ball moved by 0.2 is 1.2 away" * technique("shade.inflate")) {
    const MeshData ball = make_ball(24);
    for (const float stretch : {1.0f, 0.01f, 30.0f}) {  // normals of any length
        for (const Vec3& p : inflate_vertices(ball, 0.2f, stretch)) {
            CHECK(std::abs(glm::length(p) - 1.2f) <= 1e-6f);
        }
    }
    for (const Vec3& p : inflate_vertices(ball, -0.25f)) {
        CHECK(std::abs(glm::length(p) - 0.75f) <= 1e-6f);
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "inflate: a distance of 0 keeps every bit of a position" * technique("shade.inflate")) {
    MeshData ball = make_ball(24);
    ball.normals[7] = {0, 0, 0};
    CHECK(inflate_vertices(ball, 0) == ball.positions);
    CHECK(inflate_vertices(ball, 0.5f)[7] == ball.positions[7]);  // without a normal: nowhere to go
}

TEST_CASE_FIXTURE(
    RenderTest,
    "inflate: a cube's faces separate by f sqrt 2, with averaged normals they stay together"
        * technique("shade.inflate")) {
    const MeshData split = make_cube(false);
    REQUIRE(split.positions.size() == 24);
    for (const float f : {0.1f, 0.5f, -0.2f}) {
        CHECK(
            widest_gap(split, inflate_vertices(split, f))
            == test::near(std::abs(f) * std::sqrt(2.0)).epsilon(1e-5));
        const MeshData shared = make_cube(true);
        CHECK(widest_gap(shared, inflate_vertices(shared, f)) == 0);
    }
}

TEST_CASE_FIXTURE(InflateScene, "inflate: a ball of 1 inflated by 0.2 looks like a ball of 1.2") {
    const RenderView view = look({0, 0, 2.2f}, {0, 0, 0}, 96, 96);
    for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend}) {
        world.resource<Assets>().materials[white.index].alpha_mode = mode;
        ++world.resource<Assets>().material_version;
        world.insert_resource(Environment{.sky = SkyKind::Gradient, .visible = false});
        const Inflate more = {.distance = 0.2f};
        const Entity large = ball(1.2f, nullptr);
        const gpu::FloatImage want = radiance(view);
        const gpu::FloatImage normals = aov(view, "normal");
        const gpu::FloatImage depth = aov(view, "depth");
        world.destroy(large);
        const Entity swollen = ball(1, &more);
        CHECK(largest_difference(radiance(view), want) < 1e-3f);
        CHECK(largest_difference(aov(view, "normal"), normals) < 1e-3f);
        // Positions differ by rounding, which hardware snaps to other 1/256 of a pixel.
        const float bound = shared_device().caps().software ? 1e-4f : 1e-3f;
        CHECK(largest_difference(aov(view, "depth"), depth) < bound);
        // By 0 it is the mesh as it is, bit for bit.
        world.get<Inflate>(swollen).distance = 0;
        const gpu::FloatImage same = radiance(view);
        world.remove<Inflate>(swollen);
        CHECK(radiance(view).pixels == same.pixels);
        CHECK(largest_difference(same, want) > 0.1f);
        world.destroy(swollen);
    }
}

TEST_CASE_FIXTURE(InflateScene, "inflate: the background is visible through gaps") {
    const auto holes = [&](bool shared_corners) {
        world.clear();
        const Entity cube = place(add(make_cube(shared_corners)), add(kMatte), at({0, 0, 0}));
        world.add(cube, Inflate{.distance = 0.3f});
        // Along a diagonal the front corner is at the center: the three faces have separated from
        // it. The corner behind is hidden by none of them, either.
        const gpu::FloatImage image = radiance(look({2.4f, 2.4f, 2.4f}, {0, 0, 0}, 65, 65));
        return image.at(32, 32, 0) == 0;
    };
    CHECK(holes(false));
    CHECK_FALSE(holes(true));
}

TEST_CASE_FIXTURE(
    InflateScene, "inflate: a mesh that grows into the image is drawn, a NaN distance is not") {
    const Entity entity = ball(1, nullptr);
    world.get<WorldTransform>(entity).world = at({4.2f, 0, 0});
    world.get<PreviousWorldTransform>(entity).world = at({4.2f, 0, 0});
    const RenderView view = look({0, 0, 2}, {0, 0, 0}, 32, 32);
    CHECK(draw(view).statistics.visible_instances == 0);
    world.add(entity, Inflate{.distance = 2.5f});
    CHECK(draw(view).statistics.visible_instances == 1);
    CHECK(aov(view, "depth").at(31, 16, 0) < kNoDepth);
    world.get<Inflate>(entity).distance = NAN;
    CHECK(draw(view).statistics.visible_instances == 0);
}

TEST_CASE_FIXTURE(
    InflateScene,
    "inflate: the shadow matches the drawn mesh, and grows with it" * technique("shade.inflate")) {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0, 0, 0}});
    MeshData floor = make_square();
    place(add(std::move(floor)), white, affine_from({0, 0, -3}, {1, 0, 0, 0}, {5, 5, 1}));
    const Entity light =
        shine(SpotLight{.intensity = 40, .radius = 30, .outer_angle = 0.8f}, at({0.5f, 0.3f, 5}));
    world.add(light, Shadow{.method = ShadowMethod::Map, .resolution = 512});
    const RenderView view = look({0, -3.5f, 1}, {0, 0, -2}, 96, 96);
    const Entity large = ball(1.2f, nullptr);
    const gpu::FloatImage want = radiance(view);
    world.destroy(large);
    const Entity swollen = ball(1, nullptr);
    const auto wrong = [&] {
        const gpu::FloatImage image = radiance(view);
        int different = 0;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            different += std::abs(image.pixels[i] - want.pixels[i]) > 0.05f ? 1 : 0;
        }
        return different;
    };
    CHECK(wrong() > 200);
    world.add(swollen, Inflate{.distance = 0.2f});
    CHECK(wrong() < 20);
    world.get<Inflate>(swollen).distance = 0;  // the map is drawn again
    CHECK(wrong() > 200);
}

TEST_CASE_FIXTURE(
    InflateScene, "inflate: a light with shadow volumes gets a shadow map instead, logged once") {
    ball(1, nullptr);
    const Entity swollen = ball(0.5f, nullptr);
    world.add(swollen, Inflate{});
    const Entity light = shine(PointLight{.intensity = 50, .radius = 15}, at({0.2f, 4, 0.3f}));
    world.add(light, Shadow{.method = ShadowMethod::Volume});
    const std::vector<std::string> messages = messages_of([&] {
        (void)radiance(look({0, 0, 3}, {0, 0, 0}));
        (void)radiance(look({0, 0, 3}, {0, 0, 0}));
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("ball is inflated") != std::string::npos);
}

}  // namespace limn::test::inflate_test
