#include "render/graph/frame_graph.h"
#include "tests/render/shadow_fixture.h"

#include <array>
#include <random>

namespace limn::test {
namespace {

using oracle::DVec3;

/// A spot at the origin that shines along -z with the same light everywhere in its cone.
SpotLight even_spot(float outer) {
    return {
        .intensity = 10,
        .radius = 0,
        .attenuation = {.falloff = Falloff::None},
        .inner_angle = outer,
        .outer_angle = outer};
}

DVec3 place_of(const Affine& a) {
    return {a.row[0].w, a.row[1].w, a.row[2].w};
}

/// Size of a texel of the light's first view at `distance` from it [m].
double texel_at(const Shadow& shadow, float half_angle, double distance) {
    return 2 * std::tan(half_angle) * distance / (shadow.resolution - 4);
}

/// The directions of a spiral over the upper half of the sphere, down to a few degrees.
std::vector<Vec3> light_directions(int count) {
    std::vector<Vec3> directions;
    for (int i = 0; i < count; ++i) {
        const float y = 0.06f + 0.93f * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        const float angle = 2.39996f * static_cast<float>(i);
        const float r = std::sqrt(1 - y * y);
        directions.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    }
    return directions;
}

/// A ball on a floor.
struct BallScene : ShadowTest {
    BallScene() {
        put(make_plane({.size = {8, 8}}), {0, 0, 0});
        put(make_sphere({.radius = 0.5f, .segments = 48, .rings = 24}), {0, 0.5f, 0});
    }
    [[nodiscard]] RenderView view() const { return look({1.4f, 1.6f, 1.8f}, {0, 0.2f, 0}, 96, 96); }
};

}  // namespace

TEST_CASE_FIXTURE(
    ShadowTest,
    "shadow map: a square before the light shades twice its size at twice its distance") {
    put(make_plane({.size = {0.5f, 0.5f}}), {0, -1, 0});
    put(make_plane({.size = {6, 6}}), {0, -2, 0});
    const Shadow shadow = {.filter = ShadowFilter::Hard, .resolution = 256};
    const Affine pose = look_at({0, 0, 0}, {0, -1, 0});
    const Entity lamp = shine(even_spot(radians(45.0f)), pose);
    world.add(lamp, shadow);
    const double texel = texel_at(shadow, radians(45.0f), 2);
    int dark = 0;
    for (const Receiver& r : receivers(lamp, look({2.2f, -1.2f, 0}, {0, -2, 0}, 128, 128))) {
        if (!r.there || r.position.y > -1.9) {
            continue;
        }
        const double edge = std::max(std::abs(r.position.x), std::abs(r.position.z)) - 0.5;
        if (std::abs(edge) > texel) {
            CHECK(r.seen == doctest::Approx(edge < 0 ? 0 : 1));
        }
        dark += r.seen < 0.5 ? 1 : 0;
    }
    CHECK(dark > 100);
}

TEST_CASE_FIXTURE(
    ShadowTest,
    "shadow map: a lone plane has no acne up to 60 degrees; without a bias it has at 45") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    const RenderView view = look({0, 2, 0.01f}, {0, 0, 0}, 96, 96);
    const auto dark_pixels = [&](float slope, const Shadow& shadow) {
        const Vec3 from = {3 * std::sin(slope), 3 * std::cos(slope), 0};
        const Entity lamp = shine(even_spot(radians(30.0f)), look_at(from, {0, 0, 0}));
        world.add(lamp, shadow);
        int dark = 0;
        for (const Receiver& r : receivers(lamp, view)) {
            dark += r.there && r.seen < 0.999 ? 1 : 0;
        }
        world.destroy(lamp);
        return dark;
    };
    for (const ShadowFilter filter :
         {ShadowFilter::Hard,
          ShadowFilter::Bilinear,
          ShadowFilter::Soft,
          ShadowFilter::ContactHardening}) {
        for (const float slope : {0.0f, 15.0f, 30.0f, 45.0f, 60.0f, 75.0f, 85.0f}) {
            CAPTURE(static_cast<int>(filter));
            CAPTURE(slope);
            CHECK(dark_pixels(radians(slope), {.filter = filter, .resolution = 128}) == 0);
        }
    }
    const Shadow unbiased = {.filter = ShadowFilter::Hard, .resolution = 128, .bias = 0};
    CHECK(dark_pixels(radians(45.0f), unbiased) > 500);
}

TEST_CASE_FIXTURE(
    BallScene,
    "shadow map: over 64 directions neither acne nor a shadow off its caster by 2 texels") {
    WrongPixels all;
    const oracle::ShadowScene rays(world);
    for (const Vec3& toward : light_directions(64)) {
        const Affine pose = look_at(6.0f * toward, {0, 0.2f, 0});
        const Shadow shadow = {.filter = ShadowFilter::Bilinear, .resolution = 256};
        const Entity lamp = shine(even_spot(radians(20.0f)), pose);
        world.add(lamp, shadow);
        const DVec3 from = place_of(pose);
        const WrongPixels wrong = wrong_pixels(
            receivers(lamp, view()),
            2 * texel_at(shadow, radians(20.0f), 6),
            [&](const DVec3& p) { return glm::normalize(from - p); },
            [&](const DVec3& p) { return rays.blocked(p, from); });
        CAPTURE(toward.y);
        CHECK(wrong.acne == 0);
        CHECK(wrong.floating == 0);
        all.count += wrong.count;
        world.destroy(lamp);
    }
    CHECK(all.count > 100000);
}

TEST_CASE_FIXTURE(BallScene, "shadow map: what a spot does not reach is not in its shadow") {
    const Affine pose = look_at({0, 3, 0}, {0, 0, 0});
    const Entity lamp = shine(even_spot(radians(8.0f)), pose);
    world.add(lamp, Shadow{.filter = ShadowFilter::Hard, .resolution = 64});
    // A second lamp, without shadows, shows the rest.
    shine(PointLight{.radius = 0}, at({2, 3, 2}));
    for (const Receiver& r : receivers(lamp, view())) {
        const DVec3 down = r.position - DVec3(0, 3, 0);
        const double angle = std::atan2(glm::length(DVec3(down.x, 0, down.z)), -down.y);
        if (r.there && angle > radians(9.0f)) {
            CHECK(r.seen == doctest::Approx(1));
        }
    }
}

TEST_CASE_FIXTURE(ShadowTest, "shadow map: moving all of it together changes nothing") {
    const MeshId floor = add(make_plane({.size = {6, 6}}));
    const MeshId box = add(make_box({.size = {0.5f, 0.8f, 0.5f}}));
    const auto picture = [&](const Vec3& by) {
        const Entity ground = place(floor, white, at(by));
        const Entity caster = place(box, white, at(by + Vec3(0, 0.4f, 0)));
        const Entity lamp =
            shine(even_spot(radians(30.0f)), look_at(by + Vec3(1, 3, 1), by + Vec3(0, 0.2f, 0)));
        world.add(lamp, Shadow{.resolution = 256});
        const auto all = receivers(lamp, look(by + Vec3(0, 2, 2), by + Vec3(0, 0, 0), 64, 64));
        for (const Entity entity : {ground, caster, lamp}) {
            world.destroy(entity);
        }
        return all;
    };
    const auto here = picture({0, 0, 0});
    const auto there = picture({16, -8, 32});
    int different = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        different += std::abs(here[i].seen - there[i].seen) > 0.02 ? 1 : 0;
    }
    CHECK(different < 10);  // of 4096: rounding at edges
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: an edge is where the geometry says, to a texel's diagonal") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    put(make_box({.size = {1, 1, 1}}), {0, 0.5f, 0});
    const Affine pose = look_at({3, 4, 2}, {0, 0, 0});
    const oracle::ShadowScene rays(world);
    for (const int resolution : {128, 512}) {
        const Shadow shadow = {.filter = ShadowFilter::Hard, .resolution = resolution};
        const Entity lamp = shine(even_spot(radians(25.0f)), pose);
        world.add(lamp, shadow);
        const WrongPixels wrong = wrong_pixels(
            receivers(lamp, look({0, 4, 3}, {0, 0, 0}, 128, 128)),
            1.4142 * texel_at(shadow, radians(25.0f), 5.4),
            [&](const DVec3& p) { return glm::normalize(place_of(pose) - p); },
            [&](const DVec3& p) { return rays.blocked(p, place_of(pose)); });
        CAPTURE(resolution);
        CHECK(wrong.acne <= 1);
        CHECK(wrong.floating <= 1);
        world.destroy(lamp);
    }
}

TEST_CASE_FIXTURE(ShadowTest, "shadow map: blended surfaces receive shadows and cast none") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    const MaterialId glass = add(Material{
        .shading = ShadingModel::Blinn,
        .alpha_mode = AlphaMode::Blend,
        .base_color = {1, 1, 1, 0.5f},
        .specular = {0, 0, 0}});
    const Entity pane = place(add(make_plane({.size = {2, 2}})), glass, at({0, 0.5f, 0}));
    const Entity lamp = shine(even_spot(radians(40.0f)), look_at({0, 4, 0}, {0, 0, 0}));
    world.add(lamp, Shadow{.resolution = 256});
    const RenderView view = look({0, 3, 0.01f}, {0, 0, 0}, 64, 64);
    const Shadow shadow = world.get<const Shadow>(lamp);
    const gpu::FloatImage with_pane = radiance(view);
    world.remove<Shadow>(lamp);
    CHECK(largest_difference(with_pane, radiance(view)) < 1e-3f);  // no shadow of the pane
    world.add(lamp, shadow);

    const Entity caster = put(make_box({.size = {0.5f, 0.1f, 0.5f}}), {0, 2, 0});
    const gpu::FloatImage shaded = radiance(look({0, 1.2f, 1.2f}, {0, 0.5f, 0}, 64, 64));
    world.destroy(caster);
    const gpu::FloatImage lit = radiance(look({0, 1.2f, 1.2f}, {0, 0.5f, 0}, 64, 64));
    CHECK(rgb_at(lit, 32, 32).x > 0.1f);
    CHECK(rgb_at(shaded, 32, 32).x < 0.5f * rgb_at(lit, 32, 32).x);
    world.destroy(pane);
}

TEST_CASE_FIXTURE(BallScene, "shadow map: a light sees no caster that was told to cast none") {
    const Entity lamp = shine(even_spot(radians(30.0f)), look_at({1, 4, 1}, {0, 0, 0}));
    world.add(lamp, Shadow{});
    const auto dark = [&] {
        int count = 0;
        for (const Receiver& r : receivers(lamp, view())) {
            count += r.there && r.seen < 0.5 ? 1 : 0;
        }
        return count;
    };
    CHECK(dark() > 40);
    std::vector<Entity> casters;
    world.query<const MeshInstance>().each(
        [&](Entity entity, const MeshInstance&) { casters.push_back(entity); });
    for (const Entity entity : casters) {
        world.add(entity, NoShadow{});
    }
    CHECK(dark() == 0);
}

}  // namespace limn::test
