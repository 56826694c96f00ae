// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/env_probe.h"
#include "ecs/hierarchy.h"
#include "render/environment/cube_map.h"
#include "tests/near.h"

#include <glm/geometric.hpp>

namespace limn::test::env_probe_render_test {
namespace {

const Material kMirror = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0};

/// A square of side 2 `size` that faces `toward` from `center`.
Affine wall_at(const Vec3& center, const Vec3& toward, float size) {
    const Vec3 right = any_perpendicular(toward);
    const Vec3 up = glm::cross(toward, right);
    Affine pose;
    for (int i = 0; i < 3; ++i) {
        pose.row[i] = {size * right[i], size * up[i], toward[i], center[i]};
    }
    return pose;
}

/// Color of each wall of the room, in the order of a cube map's faces.
const Vec3 kWallColors[kCubeFaces] = {{1, 0, 0}, {0, 1, 1}, {0, 1, 0},
                                      {1, 0, 1}, {0, 0, 1}, {1, 1, 0}};

struct ProbeScene : Scene {
    Entity wall(const Vec3& color, const Affine& pose) {
        return place(
            square,
            add(Material{
                .shading = ShadingModel::Unlit,
                .double_sided = true,
                .base_color = Vec4(color, 1)}),
            pose);
    }
    /// A cube of half side `half` about the origin, a color a wall.
    void room(float half) {
        for (int face = 0; face < kCubeFaces; ++face) {
            const Vec3 outward = cube_direction({face, {0.5f, 0.5f}});
            wall(kWallColors[face], wall_at(half * outward, -outward, half));
        }
    }
    Entity ball(const Material& material, const EnvProbe* probe, const Vec3& position = {0, 0, 0}) {
        const Entity entity = place(sphere, add(material), at(position));
        if (probe != nullptr) {
            world.add(entity, *probe);
        }
        return entity;
    }
    const MeshId square = add(make_square());
    const MeshId sphere = add(make_ball(48));
};

/// Mean difference relative to the mean of `b`.
double relative_difference(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    double scale = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        sum += std::abs(a.pixels[i] - b.pixels[i]);
        scale += b.pixels[i];
    }
    return sum / scale;
}

}  // namespace

TEST_CASE_FIXTURE(
    ProbeScene, "env_probe: in a room of six colors a mirror shows each where its wall is"
                    * technique("env.capture")) {
    room(5);
    const EnvProbe probe = {.radius = 2, .resolution = 64};
    ball(kMirror, &probe);
    for (int face = 0; face < kCubeFaces; ++face) {
        // The center of the ball reflects the wall behind the camera.
        const Vec3 axis = cube_direction({face, {0.5f, 0.5f}});
        const gpu::FloatImage image = radiance(look(3.0f * axis, {0, 0, 0}, 33, 33));
        CAPTURE(face);
        CHECK(glm::distance(rgb_at(image, 16, 16), kWallColors[face]) < 0.02f);
    }
    // Off axis too: the mirrored ray's wall, not its mirror image.
    const gpu::FloatImage image = radiance(look({0, 0, 3}, {0, 0, 0}, 128, 128));
    CHECK(glm::distance(rgb_at(image, 64 + 20, 64), kWallColors[0]) < 0.05f);
    CHECK(glm::distance(rgb_at(image, 64 - 20, 64), kWallColors[1]) < 0.05f);
    CHECK(glm::distance(rgb_at(image, 64, 64 - 20), kWallColors[2]) < 0.05f);
    CHECK(glm::distance(rgb_at(image, 64, 64 + 20), kWallColors[3]) < 0.05f);
}

TEST_CASE_FIXTURE(
    ProbeScene, "env_probe: a probe of nothing but the sky changes nothing, not even at seams"
                    * technique("env.capture")) {
    for (const SkyKind sky : {SkyKind::Gradient, SkyKind::Studio}) {
        for (const bool visible : {true, false}) {
            world.insert_resource(Environment{.sky = sky, .visible = visible});
            for (const float roughness : {0.25f, 0.6f, 1.0f}) {
                Material material = kMirror;
                material.roughness = roughness;
                const RenderView view = look({1.2f, 1.0f, 1.4f}, {0, 0, 0}, 96, 96);
                const Entity plain = ball(material, nullptr);
                const gpu::FloatImage want = radiance(view);
                world.destroy(plain);
                const EnvProbe probe = {.radius = 2, .resolution = 128};
                const Entity probed = ball(material, &probe);
                CAPTURE(static_cast<int>(sky));
                CAPTURE(roughness);
                // The studio's lamps are small and bright: its own map is the less exact one.
                CHECK(
                    relative_difference(radiance(view), want)
                    < (sky == SkyKind::Studio ? 0.04 : 0.008));
                world.destroy(probed);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    ProbeScene, "env_probe: diffuse surfaces get the irradiance of the captured cube map") {
    // Half of what surrounds the ball is red, half is black.
    wall({1, 0, 0}, wall_at({0, 0, 40}, {0, 0, -1}, 4000));
    const EnvProbe probe = {.radius = 2, .resolution = 64};
    ball({.base_color = {1, 1, 1, 1}, .roughness = 1}, &probe);
    const gpu::FloatImage toward = radiance(look({0, 0, 3}, {0, 0, 0}, 32, 32));
    const gpu::FloatImage away = radiance(look({0, 0, -3}, {0, 0, 0}, 32, 32));
    CHECK(toward.at(16, 16, 0) == test::near(1).epsilon(0.1));
    CHECK(toward.at(16, 16, 1) < 0.01f);
    CHECK(away.at(16, 16, 0) < 0.1f);
}

TEST_CASE_FIXTURE(
    ProbeScene,
    "env_probe: the capture excludes its entity and the descendants" * technique("env.capture")) {
    room(5);
    const EnvProbe probe = {.radius = 2, .resolution = 64};
    const Entity mirror = ball(kMirror, &probe);
    const RenderView view = look({0, 0, 1.5f}, {0, 0, 0}, 33, 33);
    const Vec3 wall_color = rgb_at(radiance(view), 16, 16);
    // Behind the camera, between it and the wall.
    const Entity screen = wall({0.5f, 0.5f, 0.5f}, wall_at({0, 0, 3}, {0, 0, -1}, 1));
    const Entity part = world.create(Parent{mirror});
    world.add(screen, Parent{part});
    world.remove<EnvProbe>(mirror);
    (void)radiance(view);  // forgets what it saw
    world.add(mirror, probe);
    CHECK(glm::distance(rgb_at(radiance(view), 16, 16), wall_color) < 0.02f);
    world.remove<Parent>(screen);
    world.remove<EnvProbe>(mirror);
    (void)radiance(view);
    world.add(mirror, probe);
    CHECK(glm::distance(rgb_at(radiance(view), 16, 16), Vec3(0.5f)) < 0.02f);
}

TEST_CASE_FIXTURE(
    ProbeScene, "env_probe: in a box a mirror shows the point of the wall that its ray hits"
                    * technique("env.capture")) {
    room(4);
    // A plane mirror off the center, and a probe in it: without the box, the view from there.
    const Vec3 place_of_mirror = {0, -3, 0};
    place(square, add(kMirror), wall_at(place_of_mirror, {0, 1, 0}, 2));
    const auto wrong_share = [&](const EnvProbe& probe) {
        const Entity entity = world.create(probe, WorldTransform{at({0, 0, 0})});
        const Vec3 eye = {0, 0, 3.5f};
        const RenderView view = look(eye, {0, -3, -0.5f}, 128, 128);
        const gpu::FloatImage image = radiance(view);
        const Mat4 world_from_clip = glm::inverse(view.clip_from_world);
        int wrong = 0;
        int all = 0;
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                const Vec2 ndc = {
                    (static_cast<float>(x) + 0.5f) / 64 - 1,
                    1 - (static_cast<float>(y) + 0.5f) / 64};
                const Vec4 far = world_from_clip * Vec4(ndc, 0.5f, 1);
                const Vec3 ray = Vec3(far) / far.w - eye;
                const float t = (place_of_mirror.y - eye.y) / ray.y;
                const Vec3 p = eye + t * ray;
                if (t < 0 || std::abs(p.x) > 1.9f || std::abs(p.z) > 1.9f) {
                    continue;
                }
                const Vec3 d = {ray.x, -ray.y, ray.z};
                // First of the walls that the ray meets.
                float nearest = INFINITY;
                int axis = 0;
                for (int i = 0; i < 3; ++i) {
                    const float distance = ((d[i] > 0 ? 4 : -4) - p[i]) / d[i];
                    if (distance < nearest) {
                        nearest = distance;
                        axis = i;
                    }
                }
                const Vec3 want = kWallColors[2 * axis + (d[axis] < 0 ? 1 : 0)];
                wrong += glm::distance(rgb_at(image, x, y), want) > 0.5f;
                ++all;
            }
        }
        world.destroy(entity);
        REQUIRE(all > 1000);
        return static_cast<double>(wrong) / all;
    };
    const double far = wrong_share({.radius = 6, .resolution = 128});
    const double box = wrong_share({.box = {4, 4, 4}, .resolution = 128});
    CAPTURE(far);
    CAPTURE(box);
    CHECK(box < 0.02);
    CHECK(far > 0.1);
}

TEST_CASE_FIXTURE(
    ProbeScene, "env_probe: it fades out smoothly, and smaller probes take precedence") {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0, 0, 1}});
    const auto shell = [&](const Vec3& color, float radius) {
        return place(
            sphere,
            add(Material{
                .shading = ShadingModel::Unlit,
                .double_sided = true,
                .base_color = Vec4(color, 1)}),
            affine_from({0, 40, 0}, {1, 0, 0, 0}, Vec3(radius)));
    };
    const Entity outer = world.create(
        EnvProbe{.radius = 4, .fade = 0.5f, .resolution = 32}, WorldTransform{at({0, 40, 0})});
    const Entity inner = world.create(
        EnvProbe{.radius = 1, .fade = 0.5f, .resolution = 32}, WorldTransform{at({0, 40, 0})});
    shell({1, 0, 0}, 10);
    world.add(shell({0, 1, 0}, 8), Parent{outer});  // only the inner one sees it
    // Nobody says that they should look again when they are moved to where they are looked for.
    (void)radiance(look({0, 0, 2}, {0, 0, 0}, 8, 8));
    place(sphere, add(kMirror), at({0, 0, 0}));
    Vec3 last(-1);
    for (int i = 0; i <= 140; ++i) {
        const float x = 0.05f * static_cast<float>(i);
        world.get<WorldTransform>(outer).world = at({x, 0, -1});
        world.get<WorldTransform>(inner).world = at({x, 0, -1});
        const gpu::FloatImage image = radiance(look({0, 0, -3}, {0, 0, 0}, 1, 1));
        const Vec3 color = rgb_at(image, 0, 0);
        CAPTURE(x);
        if (x < 0.95f) {
            CHECK(color.y > 0.9f);
        } else if (x > 1.55f && x < 3.95f) {
            CHECK(color.x > 0.9f);
        } else if (x > 6.05f) {
            CHECK(color.z > 0.9f);
        }
        if (last.x >= 0) {
            CHECK(glm::distance(color, last) < 0.25f);
        }
        last = color;
    }
}

}  // namespace limn::test::env_probe_render_test
