#include "render/geometry/mesh_pool.h"
#include "render/light/light_list.h"
#include "render/shadow/shadow_list.h"
#include "render/skinning/deformed_list.h"
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"
#include "tests/technique.h"

#include <array>
#include <random>

namespace limn::test::shadow_map_test {
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

DVec3 position_in(const Affine& a) {
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
    "shadow map: a square in front of the light shadows twice its size at twice its distance"
        * technique("shadow.map")) {
    put(make_plane({.size = {0.5f, 0.5f}}), {0, -1, 0});
    put(make_plane({.size = {6, 6}}), {0, -2, 0});
    const Shadow shadow = {.filter = ShadowFilter::Hard, .resolution = 256};
    const Affine pose = look_at({0, 0, 0}, {0, -1, 0});
    const Entity lamp = shine(even_spot(radians(45.0f)), pose);
    world.add(lamp, shadow);
    const double texel = texel_at(shadow, radians(45.0f), 2);
    int dark = 0;
    for (const Receiver& r : receivers(lamp, look({2.2f, -1.2f, 0}, {0, -2, 0}, 128, 128))) {
        if (!r.valid || r.position.y > -1.9) {
            continue;
        }
        const double edge = std::max(std::abs(r.position.x), std::abs(r.position.z)) - 0.5;
        if (std::abs(edge) > texel) {
            CHECK(r.visibility == test::near(edge < 0 ? 0 : 1));
        }
        dark += r.visibility < 0.5 ? 1 : 0;
    }
    CHECK(dark > 100);
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a plane has no acne up to 60 degrees; without the bias it has at 45"
                    * technique("shadow.map")) {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    const RenderView view = look({0, 2, 0.01f}, {0, 0, 0}, 96, 96);
    const auto dark_pixels = [&](float slope, const Shadow& shadow) {
        const Vec3 from = {3 * std::sin(slope), 3 * std::cos(slope), 0};
        const Entity lamp = shine(even_spot(radians(30.0f)), look_at(from, {0, 0, 0}));
        world.add(lamp, shadow);
        int dark = 0;
        for (const Receiver& r : receivers(lamp, view)) {
            dark += r.valid && r.visibility < 0.999 ? 1 : 0;
        }
        world.destroy(lamp);
        return dark;
    };
    for (const ShadowFilter filter :
         {ShadowFilter::Hard, ShadowFilter::Bilinear, ShadowFilter::Soft,
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
    BallScene, "shadow map: over 64 directions neither acne nor a shadow detached by 2 texels"
                   * technique("shadow.map")) {
    WrongPixels all;
    const oracle::ShadowScene rays(world);
    for (const Vec3& toward : light_directions(64)) {
        const Affine pose = look_at(6.0f * toward, {0, 0.2f, 0});
        const Shadow shadow = {.filter = ShadowFilter::Bilinear, .resolution = 256};
        const Entity lamp = shine(even_spot(radians(20.0f)), pose);
        world.add(lamp, shadow);
        const DVec3 from = position_in(pose);
        const WrongPixels wrong = wrong_pixels(
            receivers(lamp, view()), 2 * texel_at(shadow, radians(20.0f), 6),
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

TEST_CASE_FIXTURE(
    BallScene,
    "shadow map: points outside a spot's cone are not in its shadow" * technique("shadow.map")) {
    const Affine pose = look_at({0, 3, 0}, {0, 0, 0});
    const Entity lamp = shine(even_spot(radians(8.0f)), pose);
    world.add(lamp, Shadow{.filter = ShadowFilter::Hard, .resolution = 64});
    // A second lamp, without shadows, shows the rest.
    shine(PointLight{.radius = 0}, at({2, 3, 2}));
    for (const Receiver& r : receivers(lamp, view())) {
        const DVec3 down = r.position - DVec3(0, 3, 0);
        const double angle = std::atan2(glm::length(DVec3(down.x, 0, down.z)), -down.y);
        if (r.valid && angle > radians(9.0f)) {
            CHECK(r.visibility == test::near(1));
        }
    }
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: moving the whole scene changes nothing" * technique("shadow.map")) {
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
        different += std::abs(here[i].visibility - there[i].visibility) > 0.02 ? 1 : 0;
    }
    CHECK(different < 10);  // of 4096: rounding at edges
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a shadow edge is at its geometric position, within a texel's diagonal"
                    * technique("shadow.map-aliasing")) {
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
            [&](const DVec3& p) { return glm::normalize(position_in(pose) - p); },
            [&](const DVec3& p) { return rays.blocked(p, position_in(pose)); });
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

TEST_CASE_FIXTURE(
    BallScene, "shadow map: an entity with NoShadow casts none" * technique("shadow.selection")) {
    const Entity lamp = shine(even_spot(radians(30.0f)), look_at({1, 4, 1}, {0, 0, 0}));
    world.add(lamp, Shadow{});
    const auto dark = [&] {
        int count = 0;
        for (const Receiver& r : receivers(lamp, view())) {
            count += r.valid && r.visibility < 0.5 ? 1 : 0;
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

TEST_CASE_FIXTURE(
    ShadowTest,
    "shadow map: the AOV of its texels matches the geometry" * technique("shadow.map-aliasing")) {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    const RenderView view = look({0.3f, 2.5f, 1.5f}, {0, 0, 0}, 64, 64);
    const auto texels = [&] { return aov(view, "shadow_texels"); };
    for (const float value : texels().pixels) {
        REQUIRE((value == 0 || value == 1));  // alpha; no maps
    }
    const Affine pose = look_at({1, 3, 1}, {0, 0, -0.3f});
    const Entity lamp = shine(even_spot(radians(30.0f)), pose);
    const Vec3 right = {pose.row[0].x, pose.row[1].x, pose.row[2].x};
    const Vec3 axis = -Vec3(pose.row[0].z, pose.row[1].z, pose.row[2].z);
    for (const int resolution : {64, 256}) {
        world.add(lamp, Shadow{.resolution = resolution});
        const ShadowView map =
            make_spot_view({1, 3, 1}, axis, radians(30.0f), 0.05f, resolution, 2, right);
        const gpu::FloatImage image = texels();
        for (const IVec2& pixel : {IVec2(32, 32), IVec2(20, 36), IVec2(36, 24)}) {
            const Vec2 ndc = {
                (static_cast<float>(pixel.x) + 0.5f) / 32 - 1,
                1 - (static_cast<float>(pixel.y) + 0.5f) / 32};
            const Affine& eye = view.world_from_camera;
            const Vec3 ray = transform_vector(eye, {ndc.x, ndc.y, -1});
            const Vec3 point = Vec3(0.3f, 2.5f, 1.5f) + ray * (2.5f / -ray.y);
            CAPTURE(pixel.x);
            CHECK(
                image.at(pixel.x, pixel.y, 0)
                == test::near(texels_per_pixel(map, view, point, {0, 1, 0})).epsilon(0.01));
        }
        CHECK(image.at(1, 1, 0) == 0);  // beyond the cone
    }
}

// ---- point lights
// ------------------------------------------------------------------------------------

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a ring of casters around a point light has no gap at face seams"
                    * technique("shadow.map-omni")) {
    // A tube around the light: its shadow on the wall behind it must close.
    put(make_cylinder({.radius = 0.5f, .height = 0.4f, .caps = false}), {0, 0, 0});
    put(make_cylinder({.radius = 2, .height = 3, .segments = 128, .caps = false}), {0, 0, 0});
    const Entity lamp = shine(PointLight{.radius = 0}, at({0, 0, 0}));
    for (const ShadowFilter filter : {ShadowFilter::Bilinear, ShadowFilter::Soft}) {
        world.add(lamp, Shadow{.filter = filter, .resolution = 128});
        const double texel = 2 * 2.0 / 120;  // on the wall
        int dark = 0;
        for (const Vec3& toward :
             {Vec3(1, 0, 1), Vec3(-1, 0, 1), Vec3(1, 0, -0.2f), Vec3(-1, 0, -1)}) {
            const auto all = receivers(lamp, look({0, 1.0f, 0}, glm::normalize(toward), 96, 96));
            for (const Receiver& r : all) {
                const double radius = std::hypot(r.position.x, r.position.z);
                if (!r.valid || radius < 1.9) {
                    continue;
                }
                const double edge = std::abs(r.position.y) - 0.2 * radius / 0.5;
                if (std::abs(edge) > 4 * texel) {
                    CHECK(r.visibility == test::near(edge < 0 ? 0 : 1));
                    dark += edge < 0 ? 1 : 0;
                }
            }
        }
        CHECK(dark > 500);
    }
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: six faces agree with ray casts on 98 % of the pixels"
                    * technique("shadow.map-omni")) {
    put(make_plane({.size = {6, 6}}), {0, 0, 0});
    for (const Vec3& position :
         {Vec3(1, 0.4f, 0.3f), Vec3(-0.8f, 0.5f, 0.9f), Vec3(0.1f, 0.3f, -1)}) {
        put(make_box({.size = {0.3f, 0.8f, 0.3f}}), position);
    }
    const oracle::ShadowScene rays(world);
    const Entity lamp = shine(PointLight{.radius = 0}, at({0, 1, 0}));
    world.add(lamp, Shadow{.resolution = 256});
    const auto all = receivers(lamp, look({0.5f, 3, 2}, {0, 0, 0}, 128, 128));
    CHECK(agreement(all, [&](const DVec3& p) { return rays.blocked(p, {0, 1, 0}); }) >= 0.98);
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: rotated by 90 degrees six faces give the same image"
                    * technique("shadow.map-omni")) {
    const MeshId floor = add(make_box({.size = {6, 0.2f, 6}}));
    const MeshId post = add(make_box({.size = {0.3f, 0.8f, 0.5f}}));
    const auto picture = [&](const Quat& turn) {
        const auto turned = [&](const Vec3& p) { return affine_from(turn * p, turn, {1, 1, 1}); };
        const std::vector<Entity> made = {
            place(floor, white, turned({0, -1, 0})), place(post, white, turned({1, -0.5f, 0.3f})),
            place(post, white, turned({-0.8f, -0.5f, 0.9f})),
            shine(PointLight{.radius = 0}, at({0, 0, 0}))};
        world.add(made.back(), Shadow{.filter = ShadowFilter::Hard, .resolution = 128});
        RenderView view = look({0.5f, 2, 2}, {0, -1, 0}, 64, 64);
        const Affine pose = affine_from({0, 0, 0}, turn, {1, 1, 1}) * view.world_from_camera;
        view = make_render_view(
            {.fov_y = radians(90.0f), .near = 0.05f}, pose, pose, {.width = 64, .height = 64});
        const auto all = receivers(made.back(), view);
        for (const Entity entity : made) {
            world.destroy(entity);
        }
        return all;
    };
    const auto straight = picture({1, 0, 0, 0});
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        const auto turned = picture(glm::angleAxis(0.5f * kPi, axis));
        int different = 0;
        int dark = 0;
        for (std::size_t i = 0; i < straight.size(); ++i) {
            different += std::abs(straight[i].visibility - turned[i].visibility) > 0.01 ? 1 : 0;
            dark += straight[i].visibility < 0.5 ? 1 : 0;
        }
        CAPTURE(axis.x);
        CAPTURE(axis.y);
        CHECK(dark > 100);
        CHECK(different <= 8);  // of 4096: rounding where texels end
    }
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a wide spot uses six faces and lights the inside of its cone") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    put(make_box({.size = {0.4f, 0.4f, 0.4f}}), {1.2f, 0.2f, 0});
    const oracle::ShadowScene rays(world);
    const Entity lamp = shine(even_spot(radians(85.0f)), look_at({0, 1, 0}, {0, 0, 0}));
    world.add(lamp, Shadow{.resolution = 256});
    const auto all = receivers(lamp, look({1, 3, 2}, {1, 0, 0}, 96, 96));
    CHECK(agreement(all, [&](const DVec3& p) { return rays.blocked(p, {0, 1, 0}); }) >= 0.98);
}

// ---- suns
// ------------------------------------------------------------------------------------

namespace {

/// Columns on a floor, in the sun.
struct ColumnScene : ShadowTest {
    ColumnScene() {
        put(make_plane({.size = {60, 60}}), {0, 0, 0});
        const MeshId column = add(make_cylinder({.radius = 0.3f, .height = 3, .segments = 24}));
        for (int i = 0; i < 12; ++i) {
            place(
                column, white,
                at({static_cast<float>(i % 4) * 3 - 4, 1.5f, -static_cast<float>(i / 4) * 5}));
        }
        sun = shine(DirectionalLight{}, look_at(to_sun, {0, 0, 0}));
    }
    [[nodiscard]] RenderView view(const Vec3& shift = {0, 0, 0}) const {
        return look(Vec3(0.5f, 2.5f, 6) + shift, Vec3(0, 0.5f, -3) + shift, 128, 128);
    }

    Vec3 to_sun = glm::normalize(Vec3(0.7f, 0.9f, 0.4f));
    Entity sun;
};

}  // namespace

TEST_CASE_FIXTURE(ColumnScene, "shadow map: cascades agree with ray casts on 98 % of the pixels") {
    const oracle::ShadowScene rays(world);
    for (const int cascades : {1, 3, 4}) {
        world.add(sun, Shadow{.resolution = 512, .cascades = cascades, .distance = 25});
        const auto all = receivers(sun, view());
        CAPTURE(cascades);
        CHECK(
            agreement(
                all,
                [&](const DVec3& p) {
                    // Beyond the distance nothing is in shadow.
                    const double along =
                        glm::dot(p - DVec3(0.5, 2.5, 6), glm::normalize(DVec3(-0.5, -2, -9)));
                    return along < 24 && rays.blocked_toward(p, DVec3(to_sun));
                })
            >= 0.98);
    }
}

TEST_CASE_FIXTURE(
    ColumnScene, "shadow map: edges do not shimmer: texels keep their value when the camera moves"
                     * technique("shadow.map")) {
    // From straight above, moved by whole pixels of the floor: a quarter of a texel each.
    constexpr int kSize = 128;
    const auto from = [&](int pixels) {
        const float x = 12.0f / kSize * static_cast<float>(pixels);
        return look({x, 6, -4}, {x, 0, -4.0001f}, kSize, kSize);
    };
    for (const ShadowFilter filter : {ShadowFilter::Hard, ShadowFilter::Soft}) {
        world.add(sun, Shadow{.filter = filter, .resolution = 64, .cascades = 1, .distance = 8});
        const auto before = receivers(sun, from(0));
        int edges = 0;
        for (int step = 1; step <= 5; ++step) {
            const auto after = receivers(sun, from(step));
            for (int y = 0; y < kSize; ++y) {
                for (int x = step; x < kSize; ++x) {
                    const Receiver& there = before[static_cast<std::size_t>(y * kSize + x)];
                    const Receiver& here = after[static_cast<std::size_t>(y * kSize + x - step)];
                    if (!there.valid || !here.valid
                        || glm::distance(there.position, here.position) > 1e-3) {
                        continue;  // a column, viewed from elsewhere
                    }
                    const Receiver& left = before[static_cast<std::size_t>(y * kSize + x - 1)];
                    edges += std::abs(there.visibility - left.visibility) > 0.05 ? 1 : 0;
                    CHECK(here.visibility == test::near(there.visibility).epsilon(0.01));
                }
            }
        }
        CHECK(edges > 200);
    }
}

TEST_CASE_FIXTURE(ColumnScene, "shadow map: cascades blend into each other without a step") {
    // A floor half covered by a roof far above it: its shadow's edge must cross the splits whole,
    // and no pixel away from it may notice them.
    world.add(
        sun,
        Shadow{.filter = ShadowFilter::Soft, .resolution = 512, .cascades = 4, .distance = 30});
    const oracle::ShadowScene rays(world);
    const auto all = receivers(sun, view());
    const WrongPixels wrong = wrong_pixels(
        all, 0.3, [&](const DVec3&) { return DVec3(to_sun); },
        [&](const DVec3& p) { return rays.blocked_toward(p, DVec3(to_sun)); });
    CHECK(wrong.acne == 0);
    CHECK(wrong.floating == 0);
}

// ---- alpha-tested and moving casters
// ------------------------------------------------------------------------------------

namespace {

/// Squares of 8 x 8 pixels, opaque and not in turns.
ImageData checkerboard(int cells) {
    ImageData image;
    image.width = image.height = 8 * cells;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const bool opaque = (x / 8 + y / 8) % 2 == 0;
            image.pixels.insert(
                image.pixels.end(), {255, 255, 255, opaque ? std::uint8_t{255} : std::uint8_t{0}});
        }
    }
    return image;
}

}  // namespace

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a lattice shadows half of its footprint, in agreement with ray casts"
                    * technique("shadow.map-alpha")) {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    const MaterialId grid = add(Material{
        .shading = ShadingModel::Blinn,
        .alpha_mode = AlphaMode::Mask,
        .double_sided = true,
        .base_color = {1, 1, 1, 1},
        .specular = {0, 0, 0},
        .base_color_texture = {.image = add(checkerboard(4))}});
    place(add(make_plane({.size = {2, 2}})), grid, at({0, 1.5f, 0}));
    const oracle::ShadowScene rays(world);
    const Affine pose = look_at({0.3f, 5, 0.2f}, {0, 0, 0});
    const Entity lamp = shine(even_spot(radians(25.0f)), pose);
    world.add(lamp, Shadow{.resolution = 512});
    const auto all = receivers(lamp, look({0, 1.2f, 2.6f}, {0, 0, 0}, 128, 128));
    CHECK(
        agreement(all, [&](const DVec3& p) { return rays.blocked(p, position_in(pose)); }) >= 0.98);
    // Inside its footprint on the floor half is dark.
    double dark = 0;
    int count = 0;
    for (const Receiver& r : all) {
        const DVec3 on_grid = r.position + (1.5 / 5) * (position_in(pose) - r.position);
        if (r.valid && r.position.y < 0.01 && std::abs(on_grid.x) < 1 && std::abs(on_grid.z) < 1) {
            dark += 1 - r.visibility;
            ++count;
        }
    }
    REQUIRE(count > 1000);
    CHECK(dark / count == test::near(0.5).epsilon(0.1));
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: a fan's shadow rotates with it, and repeats with its blades"
                    * technique("shadow.map-alpha")) {
    put(make_plane({.size = {4, 4}}), {0, 0, 0});
    const MeshId blade = add(make_box({.size = {0.8f, 0.02f, 0.2f}}));
    std::vector<Entity> blades;
    const auto turn = [&](float angle) {
        for (const Entity entity : blades) {
            world.destroy(entity);
        }
        blades.clear();
        for (int i = 0; i < 3; ++i) {
            const float a = angle + 2 * kPi * static_cast<float>(i) / 3;
            const Quat rotation = {std::cos(0.5f * a), 0, std::sin(0.5f * a), 0};
            blades.push_back(place(
                blade, white,
                affine_from({0.5f * std::cos(a), 1, -0.5f * std::sin(a)}, rotation, {1, 1, 1})));
        }
    };
    const Affine pose = look_at({0, 3, 0}, {0, 0, 0});
    const Entity lamp = shine(even_spot(radians(40.0f)), pose);
    world.add(lamp, Shadow{.resolution = 512});
    const RenderView view = look({0, 0.8f, 1.2f}, {0, 0, -0.2f}, 96, 96);
    turn(0.3f);
    const oracle::ShadowScene rays(world);
    const auto first = receivers(lamp, view);
    CHECK(
        agreement(first, [&](const DVec3& p) { return rays.blocked(p, position_in(pose)); })
        >= 0.98);
    turn(0.3f + 2 * kPi / 3);
    const auto same = receivers(lamp, view);
    turn(0.3f + kPi / 3);
    const auto other = receivers(lamp, view);
    int changed = 0;
    int moved = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        changed += first[i].valid && same[i].valid
                           && std::abs(first[i].visibility - same[i].visibility) > 0.1
                       ? 1
                       : 0;
        moved += first[i].valid && other[i].valid
                         && std::abs(first[i].visibility - other[i].visibility) > 0.1
                     ? 1
                     : 0;
    }
    CHECK(changed < 20);
    CHECK(moved > 300);
}

// ---- what is drawn again
// ------------------------------------------------------------------------------------

TEST_CASE_FIXTURE(
    ShadowTest,
    "shadow map: only views in which a caster moved are redrawn" * technique("shadow.map")) {
    put(make_plane({.size = {20, 4}}), {0, 0, 0});
    const MeshId box = add(make_box({.size = {0.4f, 0.4f, 0.4f}}));
    std::vector<Entity> boxes;
    std::vector<Entity> lamps;
    for (int i = 0; i < 4; ++i) {
        const float x = 4 * static_cast<float>(i) - 6;
        boxes.push_back(place(box, white, at({x, 0.5f, 0})));
        lamps.push_back(shine(even_spot(radians(25.0f)), look_at({x, 3, 0}, {x, 0, 0})));
        world.add(lamps.back(), Shadow{.resolution = 64});
    }
    const Entity point = shine(PointLight{.radius = 1.5f}, at({-6, 1.5f, 0}));
    world.add(point, Shadow{.resolution = 64});
    const RenderView view = look({0, 5, 8}, {0, 0, 0}, 32, 32);
    const auto drawn = [&](const RenderView& moved) {
        return draw(moved).statistics.shadow_views_drawn;
    };
    draw(view);
    CHECK(draw(view).statistics.shadow_views == 10);
    CHECK(drawn(view) == 0);
    CHECK(drawn(look({1, 4, 8}, {0, 1, 0}, 32, 32)) == 0);  // the camera does not count
    const auto move = [&](Entity entity, const Vec3& to) {
        world.get<WorldTransform>(entity).world = at(to);
        world.get<PreviousWorldTransform>(entity).world = at(to);
    };
    move(boxes[2], {2, 0.6f, 0.1f});
    CHECK(drawn(view) == 1);
    CHECK(drawn(view) == 0);
    move(boxes[0], {-6, 0.6f, 0.1f});  // under a spot and the point light: the face below it alone
    CHECK(drawn(view) == 2);
    world.get<WorldTransform>(lamps[3]).world = look_at({6, 3, 0.1f}, {6, 0, 0});
    CHECK(drawn(view) == 1);
    world.get<MeshInstance>(boxes[1]).material = MaterialId{};
    CHECK(drawn(view) == 1);
    world.destroy(boxes[1]);
    CHECK(drawn(view) == 1);
    world.get<SpotLight>(lamps[0]).intensity = 3;  // is no matter of the map
    CHECK(drawn(view) == 0);
    // What a view never saw does not count.
    place(box, white, at({0, 0.5f, 30}));
    CHECK(drawn(view) == 0);
}

TEST_CASE_FIXTURE(
    ColumnScene, "shadow map: a cascade is redrawn when a caster in it moves, the others are not") {
    world.add(sun, Shadow{.resolution = 128, .cascades = 3, .distance = 25});
    const MeshId box = add(make_box({.size = {0.3f, 0.3f, 0.3f}}));
    const Entity near = place(box, white, at({0.5f, 1.5f, 5}));
    const Entity center_box = place(box, white, at({0, 0.5f, -8}));
    const Entity far = place(box, white, at({0, 0.5f, -26}));
    const auto drawn = [&](const RenderView& moved) {
        return draw(moved).statistics.shadow_views_drawn;
    };
    draw(view());
    CHECK(draw(view()).statistics.shadow_views == 3);
    CHECK(drawn(view()) == 0);
    const auto move = [&](Entity entity, const Vec3& to) {
        world.get<WorldTransform>(entity).world = at(to);
        world.get<PreviousWorldTransform>(entity).world = at(to);
    };
    move(far, {0.1f, 0.5f, -26});
    CHECK(drawn(view()) == 1);
    move(center_box, {0.1f, 0.5f, -8});
    CHECK(drawn(view()) == 2);
    move(near, {0.6f, 1.5f, 5});  // the balls about the slices are one in the other
    CHECK(drawn(view()) == 3);
    CHECK(drawn(view()) == 0);

    // Texels stay where they are on the ground: twenty steps of a tenth of the finest texel cross
    // at most two of them along each axis.
    int again = 0;
    for (int i = 1; i <= 20; ++i) {
        again += drawn(view({0.004f * static_cast<float>(i), 0, 0}));
    }
    CHECK(again > 0);
    CHECK(again <= 3 * 3 * 2);  // of 60
    CHECK(drawn(view({1, 0, 1})) == 3);
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow map: culling casters by the light's range does not change the image") {
    put(make_plane({.size = {8, 8}}), {0, 0, 0});
    std::mt19937 random(7);
    std::uniform_real_distribution<float> along(-3, 3);
    const MeshId box = add(make_box({.size = {0.3f, 0.3f, 0.3f}}));
    for (int i = 0; i < 60; ++i) {
        place(box, white, at({along(random), 0.3f, along(random)}));
    }
    const RenderView view = look({0, 4, 3}, {0, 0, 0}, 96, 96);
    const Entity lamp = shine(
        PointLight{.radius = 2, .attenuation = {.falloff = Falloff::Smooth}}, at({0, 1.2f, 0}));
    world.add(lamp, Shadow{.resolution = 128});
    const oracle::ShadowScene rays(world);
    const auto all = receivers(lamp, view);
    CHECK(agreement(all, [&](const DVec3& p) { return rays.blocked(p, {0, 1.2, 0}); }) >= 0.97);
}

// ---- bad input
// ------------------------------------------------------------------------------------

TEST_CASE("shadow map: invalid settings are replaced by valid ones") {
    const Shadow cleaned = sanitize(
        {.resolution = -5,
         .source_size = std::nanf(""),
         .cascades = 99,
         .distance = -1,
         .bias = INFINITY});
    CHECK(cleaned.resolution == 16);
    CHECK(cleaned.source_size == 0);
    CHECK(cleaned.cascades == kMaxCascades);
    CHECK(cleaned.distance == 40);
    CHECK(cleaned.bias == 1);
    CHECK(sanitize({.resolution = 300}).resolution == 512);
    CHECK(sanitize({.resolution = 0}).resolution == 16);
    CHECK(sanitize({.resolution = 1'000'000'000}).resolution == 4096);
    CHECK(sanitize({.cascades = 0}).cascades == 1);
    CHECK(sanitize({.distance = std::nanf("")}).distance == 40);
}

TEST_CASE_FIXTURE(
    BallScene, "shadow map: invalid lights and a light inside a caster give finite images") {
    const auto finite = [&] {
        const gpu::FloatImage image = radiance(view());
        for (const float value : image.pixels) {
            if (!std::isfinite(value)) {
                return false;
            }
        }
        return true;
    };
    const float nan = std::nanf("");
    for (const Shadow& shadow :
         {Shadow{.resolution = -1, .source_size = 0},
          Shadow{.filter = ShadowFilter::ContactHardening, .source_size = nan},
          Shadow{.filter = ShadowFilter::Soft, .distance = nan, .bias = nan},
          Shadow{.source_size = 1e9f, .cascades = -3}}) {
        const Entity point = shine(PointLight{}, at({0, 0.5f, 0}));  // in the ball
        const Entity spot = shine(SpotLight{.outer_angle = nan}, look_at({0, 3, 0}, {0, 0, 0}));
        const Entity sun = shine(DirectionalLight{}, look_at({0, 3, 0}, {0, 0, 0}));
        for (const Entity light : {point, spot, sun}) {
            world.add(light, shadow);
        }
        CHECK(finite());
        for (const Entity light : {point, spot, sun}) {
            world.destroy(light);
        }
    }
    // From inside the ball no light comes out.
    const Entity inside = shine(PointLight{}, at({0, 0.5f, 0}));
    world.add(inside, Shadow{.source_size = 0.1f});
    for (const Receiver& r : receivers(inside, view())) {
        if (r.valid && r.position.y < 0.001 && std::hypot(r.position.x, r.position.z) > 0.3) {
            CHECK(r.visibility < 0.5);
        }
    }
}

TEST_CASE_FIXTURE(ShadowTest, "shadow map: lights that do not fit into the atlas cast no shadow") {
    put(make_plane({.size = {4, 4}}), {0, 0, 0});
    std::vector<Entity> lamps;
    for (int i = 0; i < 2; ++i) {  // twelve faces of 4096 are three atlases
        lamps.push_back(shine(PointLight{}, at({0, 1 + static_cast<float>(i), 0})));
        world.add(lamps.back(), Shadow{.resolution = 4096});
    }
    ShadowCollector collector;
    LightList lights;
    ShadowList shadows;
    gpu::RingBuffer ring(device().caps(), "test", 1 << 16);
    MeshPool meshes;
    MaterialPool materials(device(), 1);
    materials.update(world.resource<Assets>(), true);
    DeformedList shapes(1 << 27);
    FrameData frame;
    frame.world = &world;
    frame.assets_identity = 1;
    frame.ring = &ring;
    frame.meshes = &meshes;
    frame.materials = &materials;
    frame.shapes = &shapes;
    RenderItems items;
    items.update(world, meshes, materials, shapes, 1);
    frame.items = &items;
    ViewData view;
    view.camera = look({0, 1, 1}, {0, 0, 0});
    const auto collect = [&] {
        collect_lights(world, 1, lights);
        ring.begin_frame();
        collector.begin_frame();
        collector.collect(frame, view, {}, lights, shadows);
        ring.end_frame();
    };
    collect();
    CHECK(shadows.unserved == 2);  // six faces of 4096 have no room even alone
    CHECK(shadows.records.empty());
    CHECK_FALSE(lights.shadows);
    // One that has room is served all the same.
    world.get<Shadow>(lamps[1]).resolution = 512;
    collect();
    CHECK(shadows.unserved == 1);
    CHECK(shadows.records.size() == 6);
}

}  // namespace limn::test::shadow_map_test
