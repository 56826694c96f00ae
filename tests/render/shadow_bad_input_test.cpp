#include "ecs/base/log.h"
#include "ecs/components/shadow_volume.h"
#include "tests/render/shadow_fixture.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>

// What levels and programs get wrong about shadows, by every method: images stay finite, and what
// is not wrong is drawn as if the rest were not there.

namespace limn::test::shadow_bad_input_test {
namespace {

using oracle::DVec3;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr ShadowMethod kMethods[] = {ShadowMethod::Map, ShadowMethod::Volume, ShadowMethod::Hybrid};
constexpr Vec3 kLamp = {0.9f, 2.6f, 0.7f};

const char* name_of(ShadowMethod method) {
    return method == ShadowMethod::Map      ? "map"
           : method == ShadowMethod::Volume ? "volume"
                                            : "hybrid";
}

/// A box over a slab, both closed.
struct BoxScene : ShadowTest {
    BoxScene() {
        put(make_box({.size = {5, 0.2f, 5}}), {0, -0.1f, 0});
        cube = add(make_box({.size = {0.7f, 0.7f, 0.7f}}));
        place(cube, white, at({0, 0.8f, 0}));
    }
    [[nodiscard]] RenderView view() const { return look({1.2f, 2.2f, 1.9f}, {0, 0.2f, 0}, 80, 60); }
    /// A lamp of each kind; the sun comes from where the others are.
    std::vector<Entity> shine_all(const Shadow& shadow, const Affine& pose) {
        const std::vector<Entity> lights = {
            shine(PointLight{.radius = 0}, pose),
            shine(SpotLight{.radius = 0, .outer_angle = radians(40.0f)}, pose),
            shine(DirectionalLight{}, pose)};
        for (const Entity light : lights) {
            world.add(light, shadow);
        }
        return lights;
    }
    void check_finite() {
        int broken = 0;
        for (const float value : radiance(view()).pixels) {
            broken += std::isfinite(value) ? 0 : 1;
        }
        CHECK(broken == 0);
    }
    /// With the shadow of a point light at kLamp.
    double agreement_of(Entity light) {
        const oracle::ShadowScene rays(world);
        return agreement(receivers(light, view()), [&](const DVec3& p) {
            return rays.blocked(p, DVec3(kLamp));
        });
    }

    MeshId cube;
};

std::vector<std::string> warnings_of(const std::function<void()>& action) {
    static std::vector<std::string> warnings;
    warnings.clear();
    set_log_sink([](LogLevel, std::string_view message) { warnings.emplace_back(message); });
    action();
    set_log_sink(nullptr);
    return warnings;
}

}  // namespace

TEST_CASE_FIXTURE(
    BoxScene,
    "shadow input: casters without a finite position cast nothing, others are unaffected") {
    const Affine pose = look_at(kLamp, {0, 0, 0});
    const MeshId open_mesh = add(make_plane({}));
    for (const ShadowMethod method : kMethods) {
        CAPTURE(name_of(method));
        const std::vector<Entity> lights = shine_all({.method = method, .resolution = 128}, pose);
        const gpu::FloatImage before = radiance(view());
        std::vector<Entity> broken;
        const Quat turned = {kNan, 0, 0, 1};
        for (const Affine& nowhere :
             {at({kNan, 1, 0}), at({0, kInfinity, 0}), affine_from({0, 1.5f, 0}, turned, {1, 1, 1}),
              affine_from({0, 1.5f, 0}, {1, 0, 0, 0}, {kNan, 1, 1}),
              affine_from({0, 1.5f, 0}, {1, 0, 0, 0}, {1e38f, 1e38f, 1e38f}),
              affine_from({0, 1.5f, 0}, {1, 0, 0, 0}, {0, 0, 0})}) {
            broken.push_back(place(cube, white, nowhere));
        }
        broken.push_back(place(open_mesh, white, at({0, kNan, 0})));
        broken.push_back(place(MeshId{12345}, white, at({0, 1.5f, 0})));
        CHECK(largest_difference(radiance(view()), before) == 0);
        for (const Entity entity : broken) {
            world.destroy(entity);
        }
        for (const Entity light : lights) {
            world.destroy(light);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "shadow input: a light radius of 0, negative or infinite has shadows, NaN no light") {
    const gpu::FloatImage dark = radiance(view());
    for (const ShadowMethod method : kMethods) {
        for (const float radius : {0.0f, -3.0f, kInfinity}) {
            CAPTURE(name_of(method));
            CAPTURE(radius);
            const Entity light = shine(PointLight{.radius = radius}, at(kLamp));
            world.add(light, Shadow{.method = method, .resolution = 256});
            check_finite();
            CHECK(agreement_of(light) >= (method == ShadowMethod::Map ? 0.98 : 0.995));
            world.destroy(light);
        }
        // No number, or so small that it reaches nothing.
        for (const float radius : {kNan, 1e-30f, 1e-3f}) {
            const Entity light = shine(PointLight{.radius = radius}, at(kLamp));
            world.add(light, Shadow{.method = method, .resolution = 256});
            CHECK(largest_difference(radiance(view()), dark) == 0);
            world.destroy(light);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "shadow input: lights without a finite position or direction break no image") {
    for (const ShadowMethod method : kMethods) {
        for (const Affine& pose :
             {at({kNan, 1, 0}), at({0, -kInfinity, 0}),
              affine_from(kLamp, {kNan, 0, 1, 0}, {1, 1, 1}),
              affine_from(kLamp, {1, 0, 0, 0}, {0, 0, 0})}) {
            CAPTURE(name_of(method));
            const std::vector<Entity> lights =
                shine_all({.method = method, .resolution = 64}, pose);
            check_finite();
            for (const Entity light : lights) {
                world.destroy(light);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene,
    "shadow input: a light inside, on or at a corner of a caster lights nothing behind it") {
    for (const ShadowMethod method : kMethods) {
        CAPTURE(name_of(method));
        // Within the box nothing leaves it.
        Entity light = shine(PointLight{.radius = 0}, at({0.1f, 0.9f, -0.1f}));
        world.add(light, Shadow{.method = method, .resolution = 128, .source_size = 0});
        int lit = 0;
        for (const Receiver& r : receivers(light, view())) {
            lit += r.valid && r.visibility > 0.5 ? 1 : 0;
        }
        CHECK(lit == 0);
        world.destroy(light);
        for (const Vec3& position : {Vec3(0, 1.15f, 0), Vec3(0.35f, 1.15f, 0.35f)}) {
            light = shine(PointLight{.radius = 0}, at(position));
            world.add(light, Shadow{.method = method, .resolution = 128});
            check_finite();
            world.destroy(light);
        }
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "shadow input: lights near an open mesh are reported once and get correct maps") {
    MeshData lid = make_plane({.size = {0.8f, 0.8f}});
    lid.name = "an open lid";
    put(std::move(lid), {0.9f, 1.2f, 0.2f});
    for (const ShadowMethod method : {ShadowMethod::Volume, ShadowMethod::Hybrid}) {
        CAPTURE(name_of(method));
        const Entity light = shine(PointLight{.radius = 0}, at(kLamp));
        world.add(light, Shadow{.method = method, .resolution = 256});
        const std::vector<std::string> warnings = warnings_of([&] {
            radiance(view());
            radiance(view());
        });
        if (method == ShadowMethod::Volume) {
            REQUIRE(warnings.size() == 1);
            CHECK(warnings[0].find("an open lid") != std::string::npos);
        } else {
            CHECK(warnings.empty());  // it was said before
        }
        CHECK(draw(view()).statistics.shadow_views == 6);
        CHECK(agreement_of(light) >= 0.98);
        world.destroy(light);
    }
}

TEST_CASE_FIXTURE(
    BoxScene, "shadow input: invalid volume settings give (almost) infinite volumes") {
    for (const Extrusion extrusion :
         {Extrusion::Infinite, Extrusion::Constant, Extrusion::Radius, Extrusion::Plane}) {
        for (const float number : {kNan, -1.0f, kInfinity}) {
            const Entity light = shine(PointLight{.radius = number}, at(kLamp));
            world.add(light, Shadow{.method = ShadowMethod::Volume});
            world.add(
                light, ShadowVolume{
                           .kind = VolumeKind::PerTriangle,
                           .extrusion = extrusion,
                           .distance = number,
                           .cap_bias = number});
            CAPTURE(number);
            CAPTURE(static_cast<int>(extrusion));
            check_finite();
            world.destroy(light);
        }
    }
}

}  // namespace limn::test::shadow_bad_input_test
