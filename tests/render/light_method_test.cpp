#include "ecs/components/projector.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "render/gpu/gpu_query.h"
#include "render/light/light_objects.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>
#include <random>

namespace limn::test::light_method_test {
namespace {

constexpr LightMethod kMethods[] = {
    LightMethod::Clustered, LightMethod::FullScreen, LightMethod::Volumes, LightMethod::ObjectMajor,
    LightMethod::LightMajor};
constexpr int kWidth = 160;
constexpr int kHeight = 90;

float srgb(float linear) {
    linear = std::clamp(linear, 0.0f, 1.0f);
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

class Methods : public Scene {
  public:
    Entity ground;  ///< the floor of place_objects()

    void use(LightMethod method) { world.insert_resource(Rendering{method}); }

    gpu::FloatImage picture(LightMethod method, const RenderView& view) {
        use(method);
        return radiance(view);
    }

    /// Samples that pass all tests of a frame.
    std::uint64_t samples(LightMethod method, const RenderView& view) {
        use(method);
        draw(view);  // compiled, uploaded
        gpu::GpuQuery query("samples", GL_SAMPLES_PASSED);
        query.begin();
        draw(view);
        query.end();
        return query.wait();
    }
    int draws(LightMethod method, const RenderView& view) {
        use(method);
        draw(view);
        device().reset_stats();
        draw(view);
        return device().stats().draws;
    }

    /// A room of unlike things: a floor, balls of all shading models, a leaf with holes.
    void place_objects() {
        const MeshId square = add(make_square());
        const MeshId ball = add(make_ball(12));
        const MaterialId stone =
            add(Material{.base_color = {0.7f, 0.6f, 0.5f, 1}, .roughness = 0.7f});
        ground = place(square, stone, affine_from({0, 0, 0}, {1, 0, 0, 0}, {12, 12, 1}));
        const MaterialId kinds[] = {
            add(Material{.base_color = {0.9f, 0.7f, 0.3f, 1}, .metalness = 1, .roughness = 0.3f}),
            add(Material{.shading = ShadingModel::Blinn, .specular = {0.4f, 0.4f, 0.4f}}),
            add(Material{.shading = ShadingModel::Phong, .shininess = 20}),
            add(Material{.base_color = {0.2f, 0.5f, 0.8f, 1}, .emission = {0.1f, 0, 0}})};
        for (int i = 0; i < 12; ++i) {
            const Vec3 p = {
                -5.0f + 2 * static_cast<float>(i % 6), 3.0f * static_cast<float>(i / 6), 1};
            place(ball, kinds[i % 4], affine_from(p, {1, 0, 0, 0}, Vec3(0.8f)));
        }
        world.insert_resource(Environment{
            .sky = SkyKind::Uniform, .zenith = {0.05f, 0.06f, 0.08f}, .visible = false});
    }
    /// Point lights, spots narrow and wide, a sun, one without an end.
    void light(int count) {
        std::mt19937 random(4);
        std::uniform_real_distribution<float> unit(-1, 1);
        const auto color = [&] {
            return Vec3(0.6f) + 0.4f * Vec3(unit(random), unit(random), unit(random));
        };
        for (int i = 0; i < count; ++i) {
            const Vec3 p = {6 * unit(random), 4 * unit(random), 1.5f + unit(random)};
            if (i % 3 == 2) {
                const Affine aimed = look_at(p, {p.x + unit(random), p.y + unit(random), -1});
                shine(
                    SpotLight{
                        .color = color(),
                        .intensity = 3,
                        .radius = 4,
                        .outer_angle = radians(i % 2 == 0 ? 25.0f : 75.0f)},
                    aimed);
            } else {
                shine(
                    PointLight{.color = color(), .intensity = 1.5f, .radius = 1.5f + unit(random)},
                    at(p));
            }
        }
        shine(DirectionalLight{.illuminance = 0.3f}, look_at({0, 0, 0}, {0.2f, 0.3f, -1}));
        shine(PointLight{.intensity = 0.5f, .radius = 0}, at({0, 0, 5}));
    }
    [[nodiscard]] RenderView from_aside() const {
        return look({0, -7, 4}, {0, 0, 0.5f}, kWidth, kHeight);
    }
    /// Only a floor, of side 80, in the plane z = 0.
    void floor() {
        place(
            add(make_square()),
            add(Material{.shading = ShadingModel::Blinn, .specular = {0, 0, 0}}),
            affine_from({0, 0, 0}, {1, 0, 0, 0}, {40, 40, 1}));
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    Methods, "light methods: all five make the same image"
                 * technique("deferred.light-volume, engine.depth-first, engine.light-loops, "
                             "light.structure-object-major")) {
    place_objects();
    light(40);
    // From aside, from within the lights, with a light before the near plane.
    for (const RenderView& view : {from_aside(), look({0.2f, -1, 1}, {0, 3, 1}, kWidth, kHeight)}) {
        const gpu::FloatImage clustered = picture(LightMethod::Clustered, view);
        float brightest = 0;
        for (const float value : clustered.pixels) {
            brightest = std::max(brightest, value);
        }
        CHECK(brightest > 0.5f);
        for (const LightMethod method : kMethods) {
            CAPTURE(static_cast<int>(method));
            const gpu::FloatImage other = picture(method, view);
            float worst_float = 0;
            float worst_shown = 0;
            for (std::size_t i = 0; i < clustered.pixels.size(); ++i) {
                const float a = clustered.pixels[i];
                const float b = other.pixels[i];
                worst_float = std::max(worst_float, std::abs(a - b) / (0.05f + a));
                worst_shown = std::max(worst_shown, std::abs(srgb(a) - srgb(b)));
            }
            CHECK(worst_float <= 1e-3f);
            CHECK(worst_shown <= 1 / 255.0f);
        }
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: images of single lights add up to that of all"
                 * technique("light.structure-light-major")) {
    place_objects();
    const RenderView view = from_aside();
    world.resource<Environment>().intensity = 0;
    const Entity lamps[] = {
        shine(PointLight{.intensity = 4, .radius = 4}, at({-2, 0, 2})),
        shine(PointLight{.color = {1, 0.3f, 0}, .intensity = 4, .radius = 5}, at({2, 1, 2})),
        shine(SpotLight{.intensity = 9}, look_at({0, -4, 5}, {0, 0, 0}))};
    constexpr int kAll = -1;
    constexpr int kNone = 3;
    const auto switch_on = [&](int only) {
        for (int i = 0; i < 3; ++i) {
            const bool on = only == kAll || only == i;
            if (i < 2) {
                world.get<PointLight>(lamps[i]).enabled = on;
            } else {
                world.get<SpotLight>(lamps[i]).enabled = on;
            }
        }
    };
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        switch_on(kNone);
        const gpu::FloatImage dark = picture(method, view);
        switch_on(kAll);
        const gpu::FloatImage all = picture(method, view);
        std::vector<float> sum(all.pixels.size(), 0.0f);
        for (int i = 0; i < 3; ++i) {
            switch_on(i);
            const gpu::FloatImage one = picture(method, view);
            int unlit = 0;  // emissive pixels that this light does not reach
            for (std::size_t p = 0; p < sum.size(); p += static_cast<std::size_t>(all.channels)) {
                unlit += dark.pixels[p] > 0 && one.pixels[p] == dark.pixels[p] ? 1 : 0;
            }
            CHECK(unlit > 10);
            std::transform(sum.begin(), sum.end(), one.pixels.begin(), sum.begin(), std::plus<>());
        }
        float worst = 0;
        float brightest = 0;
        int emissive = 0;
        for (std::size_t i = 0; i < sum.size(); i += static_cast<std::size_t>(all.channels)) {
            for (std::size_t c = 0; c < 3; ++c) {
                // Some balls shine by themselves: that is in each of the three images.
                const float emission = dark.pixels[i + c];
                CHECK((emission == 0 || (c == 0 && std::abs(emission - 0.1f) < 1e-3f)));
                emissive += emission > 0 ? 1 : 0;
                worst = std::max(worst, std::abs(sum[i + c] - 2 * emission - all.pixels[i + c]));
                brightest = std::max(brightest, all.pixels[i + c]);
            }
        }
        CHECK(emissive > 100);
        CHECK(brightest > 0.5f);
        CHECK(worst < 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: shadows and projected images are the same in all five"
                 * technique("light.structure-object-major")) {
    place_objects();
    ImageData stripes;
    stripes.width = 8;
    stripes.height = 8;
    for (int i = 0; i < 64; ++i) {
        stripes.pixels.insert(
            stripes.pixels.end(), {255, static_cast<std::uint8_t>(i % 2 * 255), 80, 255});
    }
    world.add(ground, NoShadow{});  // volumes want closed meshes
    const Entity spot = shine(
        SpotLight{.intensity = 30, .outer_angle = radians(50.0f)},
        look_at({-3, -6, 6}, {0, 0, 0.5f}));
    world.add(spot, Projector{.image = add(std::move(stripes)), .width = radians(80.0f)});
    const Entity lamp = shine(PointLight{.intensity = 8, .radius = 9}, at({2, 1.5f, 2.5f}));
    const Entity sun = shine(DirectionalLight{}, look_at({0, 0, 0}, {0.4f, 0.5f, -1}));
    const RenderView view = from_aside();
    const gpu::FloatImage without = picture(LightMethod::Clustered, view);
    for (const ShadowMethod method :
         {ShadowMethod::Map, ShadowMethod::Volume, ShadowMethod::Hybrid}) {
        CAPTURE(static_cast<int>(method));
        for (const Entity light : {spot, lamp, sun}) {
            world.remove<Shadow>(light);
            world.add(light, Shadow{.method = method, .resolution = 256});
        }
        const gpu::FloatImage clustered = picture(LightMethod::Clustered, view);
        CHECK(largest_difference(clustered, without) > 0.1f);
        for (const LightMethod other : kMethods) {
            CAPTURE(static_cast<int>(other));
            CHECK(largest_difference(clustered, picture(other, view)) < 2e-3f);
        }
    }
}

TEST_CASE_FIXTURE(
    Methods,
    "light methods: surfaces in one place are lit once" * technique("engine.light-loops")) {
    // Two floors, and more lights than a stencil has numbers.
    floor();
    place(
        add(make_square()), add(Material{.base_color = {0.9f, 0.2f, 0.1f, 1}}),
        affine_from({1, 0, 0}, {1, 0, 0, 0}, {39, 40, 1}));
    for (int i = 0; i < 300; ++i) {
        const auto angle = static_cast<float>(i);
        shine(
            PointLight{.intensity = 0.05f, .radius = 4},
            at({2 * std::cos(angle), 2 * std::sin(angle), 1}));
    }
    const RenderView view = look({0, 0, 3}, {0, 0, 0}, 32, 32);
    const gpu::FloatImage clustered = picture(LightMethod::Clustered, view);
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(clustered, picture(method, view)) < 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: broken lights are left out, odd ones draw the same in all") {
    place_objects();
    light(6);
    const RenderView view = from_aside();
    const gpu::FloatImage good = picture(LightMethod::Clustered, view);
    const Vec3 up = {0, 0, 2};
    shine(PointLight{.color = {NAN, 1, 1}}, at(up));
    shine(PointLight{.radius = NAN}, at(up));
    shine(PointLight{.radius = 1e-30f}, at(up));
    shine(PointLight{}, at({NAN, 0, 0}));
    shine(SpotLight{.inner_angle = NAN}, look_at(up, {0, 0, 0}));
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(good, picture(method, view)) < 2e-3f);
    }
    // Endless, everywhere at once, in a ball, with its cones the wrong way round or none.
    shine(PointLight{.intensity = 0.1f, .radius = -3}, at(up));
    shine(PointLight{.intensity = 0.1f, .radius = 1e30f}, at(up));
    shine(PointLight{.intensity = 0.1f, .radius = 2}, at({-5, 0, 1}));
    shine(
        SpotLight{.intensity = 0.1f, .inner_angle = 1, .outer_angle = 0.3f},
        look_at(up, {0, 0, 0}));
    shine(SpotLight{.intensity = 0.1f, .outer_angle = 0}, look_at(up, {0, 0, 0}));
    shine(SpotLight{.intensity = 0.1f, .outer_angle = 9}, look_at(up, {0, 0, 0}));
    shine(SpotLight{.intensity = 0.1f, .radius = 0}, look_at(up, {0, 0, 0}));
    const gpu::FloatImage odd = picture(LightMethod::Clustered, view);
    for (const float value : odd.pixels) {
        REQUIRE(std::isfinite(value));
    }
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(odd, picture(method, view)) < 2e-3f);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: where a light is shadowed the others alone light"
                 * technique("light.structure-light-major")) {
    floor();
    place(add(make_ball(12)), add(Material{}), affine_from({0, 0, 1}, {1, 0, 0, 0}, Vec3(0.5f)));
    const Entity above = shine(PointLight{.intensity = 20, .radius = 20}, at({0, 0, 3}));
    shine(PointLight{.intensity = 5, .radius = 20}, at({-3, 0, 3}));
    world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {0.1f, 0.1f, 0.1f}, .visible = false});
    world.add(above, Shadow{.filter = ShadowFilter::Hard});
    const RenderView view = look({0, -2, 1}, {0, 0, 0.2f});
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        world.get<PointLight>(above).enabled = true;
        const gpu::FloatImage both = picture(method, view);
        world.get<PointLight>(above).enabled = false;
        const gpu::FloatImage one = picture(method, view);
        // Under the ball, in the middle of its shadow; and beside it.
        const Vec3 shadowed = rgb_at(both, 32, 36);
        CHECK(glm::distance(shadowed, rgb_at(one, 32, 36)) < 1e-5f);
        CHECK(rgb_at(both, 60, 50).x > 1.5f * rgb_at(one, 60, 50).x);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: object-major draws each object once, whatever the lights"
                 * technique("engine.light-loops, light.structure-object-major")) {
    place_objects();
    const RenderView view = from_aside();
    light(3);
    const int few = draws(LightMethod::ObjectMajor, view);
    light(30);
    CHECK(draws(LightMethod::ObjectMajor, view) == few);
    // Depth and light of every run, and what every frame draws.
    CHECK(few <= draws(LightMethod::Clustered, view) + 8);
}

TEST_CASE_FIXTURE(
    Methods, "light methods: light-major draws the objects that each light reaches"
                 * technique("engine.light-loops, light.structure-light-major")) {
    // A row of balls 4 m apart, each a mesh of its own: a draw each.
    for (int i = 0; i < 5; ++i) {
        place(add(make_ball(6)), add(Material{}), at({4.0f * static_cast<float>(i) - 8, 0, 0}));
    }
    const RenderView view = look({0, 0, 12}, {0, 0, 0}, kWidth, kHeight);
    const int none = draws(LightMethod::LightMajor, view);
    const Entity lamp = shine(PointLight{.radius = 2}, at({0, 0, 2.5f}));
    CHECK(draws(LightMethod::LightMajor, view) == none + 1);  // reaches the middle one alone
    world.get<PointLight>(lamp).radius = 4;                   // and its neighbors
    CHECK(draw(view).statistics.lit_objects == 3);
    world.get<PointLight>(lamp).radius = 0;  // all
    CHECK(draw(view).statistics.lit_objects == 5);
}

TEST_CASE_FIXTURE(
    Methods, "light methods: a full-screen light costs every surface pixel, a volume its own"
                 * technique("deferred.light-volume")) {
    floor();
    const RenderView view = look({0, 0, 10}, {0, 0, 0}, 64, 64);
    const std::uint64_t screen = samples(LightMethod::FullScreen, view);
    const std::uint64_t volumes = samples(LightMethod::Volumes, view);
    const Entity lamp = shine(PointLight{.radius = 5}, at({0, 0, 2}));
    CHECK(samples(LightMethod::FullScreen, view) == screen + 64 * 64);

    // A disc of radius sqrt(25 - 4) where the ball cuts the floor, wrapped by up to 17 %.
    const double pixels_a_meter = 64 / 20.0;
    const double area = kPi * 21 * square(pixels_a_meter);
    const auto lit = static_cast<double>(samples(LightMethod::Volumes, view) - volumes);
    // The sides that pass the depth test count as well: twice the ball's projection at most.
    CHECK(lit > area);
    CHECK(lit < 4 * area * square(1.18) * square(10.0 / 7));

    for (const Vec3& nowhere : {Vec3(500, 0, 2), Vec3(0, 0, 40), Vec3(0, 300, 2)}) {
        world.get<WorldTransform>(lamp).world = at(nowhere);
        CHECK(samples(LightMethod::Volumes, view) == volumes);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light volumes: the lit disc has the radius where ball and plane meet"
                 * technique("light.volume-stencil")) {
    floor();
    const RenderView view = look({0, 0, 10}, {0, 0, 0}, 200, 200);  // 10 pixels a meter
    const Entity lamp =
        shine(PointLight{.radius = 5, .attenuation = {.falloff = Falloff::None}}, at({0, 0, 2}));
    const auto lit_pixels = [&] {
        const gpu::FloatImage image = picture(LightMethod::Volumes, view);
        int lit = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const Vec3 p = {
                    (static_cast<float>(x) - 99.5f) / 10, (static_cast<float>(y) - 99.5f) / 10, -2};
                const bool on = rgb_at(image, x, y).x > 0;
                if (std::abs(glm::length(p) - 5) > 0.01f) {
                    CHECK(on == (glm::length(p) < 5));  // |P - center| <= r
                }
                lit += on ? 1 : 0;
            }
        }
        return lit;
    };
    CHECK(lit_pixels() == test::near(65.973 * 100).epsilon(0.01));
    world.get<WorldTransform>(lamp).world = at({0, 0, 5.01f});
    const gpu::FloatImage dark = picture(LightMethod::Volumes, view);
    CHECK(*std::max_element(dark.pixels.begin(), dark.pixels.end()) <= 1);  // alpha alone
    CHECK(rgb_at(dark, 100, 100) == Vec3(0));
}

TEST_CASE_FIXTURE(
    Methods, "light volumes: nothing is lit where nothing is; a camera inside sees as from outside"
                 * technique("deferred.light-volume, light.volume-stencil")) {
    const RenderView empty = look({0, 0, 10}, {0, 0, 0}, 64, 64);
    shine(PointLight{.radius = 5}, at({0, 0, 2}));
    const gpu::FloatImage nothing = picture(LightMethod::Volumes, empty);
    CHECK(*std::max_element(nothing.pixels.begin(), nothing.pixels.end()) == 0);
    floor();
    for (const Vec3& eye :
         {Vec3(0, 0, 4), Vec3(0.1f, 0, 0.3f), Vec3(0, 0, 7.02f), Vec3(-3, 0, 1)}) {
        const RenderView view = look(eye, {0.5f, 0.2f, 0}, 64, 64);
        CHECK(
            largest_difference(
                picture(LightMethod::Volumes, view), picture(LightMethod::FullScreen, view))
            < 1e-3f);
    }
}

TEST_CASE_FIXTURE(
    Methods, "depth first: overlapping squares are lit once a pixel, in any order"
                 * technique("engine.depth-first, shade.z-prepass")) {
    const MeshId square = add(make_square());
    const MaterialId plain = add(Material{});
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    shine(PointLight{}, at({0, 0, 0.5f}));
    const std::uint64_t background = samples(LightMethod::LightMajor, view);
    // Each covers the whole image; depth takes them from near to far, or from far to near.
    for (int i = 0; i < 4; ++i) {
        const float z = -0.1f * static_cast<float>(i);
        place(square, plain, affine_from({0, 0, z}, {1, 0, 0, 0}, {2, 2, 1}));
    }
    const std::uint64_t several = samples(LightMethod::LightMajor, view) - background;
    // Depth once to four times; then surroundings and one light, once each.
    CHECK(several >= 3 * 32 * 32);
    CHECK(several <= 6 * 32 * 32);
    CHECK((several - 2 * 32 * 32) % (32 * 32) == 0);
    const std::uint64_t object_major = samples(LightMethod::ObjectMajor, view) - background;
    CHECK(several - object_major == 32 * 32);  // one pass less
    CHECK(
        largest_difference(
            picture(LightMethod::LightMajor, view), picture(LightMethod::Clustered, view))
        < 1e-3f);
}

TEST_CASE_FIXTURE(
    Methods, "depth first: lighting leaves the depth as it was" * technique("shade.z-prepass")) {
    place_objects();
    light(12);
    const RenderView view = from_aside();
    use(LightMethod::Clustered);
    const gpu::FloatImage depth = aov(view, "depth");
    for (const LightMethod method : kMethods) {
        use(method);
        CHECK(largest_difference(depth, aov(view, "depth")) == 0);
    }
}

TEST_CASE_FIXTURE(
    Methods, "light methods: holes, mirrored and turned surfaces are the same in all"
                 * technique("engine.depth-first, shade.z-prepass")) {
    ImageData image;
    image.width = 8;
    image.height = 8;
    for (int i = 0; i < 64; ++i) {
        const bool hole = (i / 2 + i / 16) % 2 == 0;
        image.pixels.insert(
            image.pixels.end(), {255, 200, 100, static_cast<std::uint8_t>(hole ? 0 : 255)});
    }
    Material leaf;
    leaf.base_color_texture.image = add(std::move(image));
    leaf.alpha_mode = AlphaMode::Mask;
    leaf.double_sided = true;
    place(add(make_square()), add(leaf), affine_from({0, 0, 0.5f}, {1, 0, 0, 0}, {-1, 1, 1}));
    place_objects();
    light(12);
    const RenderView view = from_aside();
    const gpu::FloatImage clustered = picture(LightMethod::Clustered, view);
    for (const LightMethod method : kMethods) {
        CAPTURE(static_cast<int>(method));
        CHECK(largest_difference(clustered, picture(method, view)) < 2e-3f);
    }
}

TEST_CASE(
    "visibility sets: a light's objects are those whose boxes meet its sphere, in order"
    * technique("engine.visibility-sets")) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<BoxBlock> blocks(2);
    std::vector<Bounds> boxes;
    for (int i = 0; i < 1500; ++i) {
        const Vec3 c = 20.0f * Vec3(unit(random), unit(random), unit(random));
        const Vec3 h = Vec3(1.1f) + Vec3(unit(random), unit(random), unit(random));
        BoxBlock& block = blocks[i / kCullBlock];
        const int k = i % kCullBlock;
        block.set(k, c, h);
        boxes.push_back({c - h, c + h});
    }
    for (int n = 0; n < 50; ++n) {
        const LightRange light = {
            20.0f * Vec3(unit(random), unit(random), unit(random)), 4 + 3 * unit(random)};
        std::vector<std::uint32_t> found;
        append_objects_of_light(light, blocks, 1500, found);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            const Vec3 nearest = glm::clamp(light.center, boxes[i].min, boxes[i].max);
            if (glm::distance(nearest, light.center) <= light.radius) {
                expected.push_back(i);
            }
        }
        CHECK(found == expected);
    }
}

TEST_CASE_FIXTURE(
    Methods, "visibility sets: a light lights of what is seen what it reaches, and nothing else"
                 * technique("engine.visibility-sets")) {
    // A row of balls 4 m apart; the camera sees the middle ones.
    const MeshId ball = add(make_ball(6));
    const MaterialId plain = add(Material{});
    constexpr int kBalls = 21;
    const auto x_of = [](int i) { return 4.0f * static_cast<float>(i - kBalls / 2); };
    for (int i = 0; i < kBalls; ++i) {
        place(ball, plain, at({x_of(i), 0, 0}));
    }
    const RenderView view = look({0, 0, 15}, {0, 0, 0}, kWidth, kHeight);
    use(LightMethod::LightMajor);
    const Entity lamp = shine(PointLight{}, at({0, 0, 0}));
    for (const float radius : {2.0f, 4.0f, 11.0f, 30.0f, 100.0f}) {
        for (const float x : {0.0f, 13.0f, 26.0f, 33.0f}) {
            world.get<PointLight>(lamp).radius = radius;
            world.get<WorldTransform>(lamp).world = at({x, 0, 0});
            // V, the light's objects and I, by hand: the pyramid's sides are 26.67 m away at the
            // balls' middles, in a plane of slope 16 / 9, and the balls' boxes reach 1 m farther.
            int seen = 0;
            int lit = 0;
            const bool light_seen = (x - 15 * 16 / 9.0f) / std::hypot(1.0f, 16 / 9.0f) < radius;
            for (int i = 0; i < kBalls; ++i) {
                const bool visible = std::abs(x_of(i)) - 1 < 28.4f;
                const float gap = std::max(std::abs(x_of(i) - x) - 1, 0.0f);
                seen += visible ? 1 : 0;
                lit += visible && light_seen && gap <= radius ? 1 : 0;
            }
            const FrameStatistics found = draw(view).statistics;
            CAPTURE(radius);
            CAPTURE(x);
            CHECK(found.visible_instances == seen);
            CHECK(found.lit_objects == lit);
        }
    }
}

TEST_CASE_FIXTURE(
    Methods, "visibility sets: what is not seen itself still casts its shadow"
                 * technique("engine.visibility-sets")) {
    floor();
    const RenderView view = look({0, 0, 3}, {0, 0, 0}, 32, 32);
    const Entity lamp = shine(PointLight{.intensity = 30, .radius = 30}, at({12, 0, 4}));
    world.add(lamp, Shadow{});
    use(LightMethod::LightMajor);
    const gpu::FloatImage lit = radiance(view);
    // Between light and image, beside what the camera sees.
    place(add(make_ball(12)), add(Material{}), at({6, 0, 2}));
    CHECK(draw(view).statistics.visible_instances == 1);
    CHECK(rgb_at(radiance(view), 16, 16).x < 0.1f * rgb_at(lit, 16, 16).x);
}

TEST_CASE(
    "visibility sets: objects' lists of lights say the same as lights' lists of objects"
    * technique("engine.visibility-sets")) {
    const LightObjects found = {
        .lights = {2, 3, 7}, .begin = {0, 3, 3, 5}, .objects = {0, 2, 4, 2, 3}};
    ObjectLights lists;
    list_lights_of_objects(found, 5, lists);
    const std::vector<std::vector<layout::uint>> expected = {{2}, {}, {2, 7}, {7}, {2}};
    for (std::size_t i = 0; i < 5; ++i) {
        const layout::uvec2 list = lists.lists[i];
        const std::span of = std::span(lists.lights).subspan(list.x, list.y);
        CHECK(std::vector(of.begin(), of.end()) == expected[i]);
    }
}

TEST_CASE("visibility sets: draws of lights take neighbors of equal mesh together and no others") {
    // Two runs: meshes of 3 and 2 instances, then one of 4.
    const DrawCommand commands[] = {{6, 3, 0, 0, 0}, {9, 2, 6, 0, 3}, {12, 4, 15, 0, 5}};
    InstanceList list;
    list.command_values = commands;
    list.opaque = {
        {.first_command = 0, .command_count = 2}, {.first_command = 2, .command_count = 1}};
    const LightObjects found = {
        .lights = {0, 1}, .begin = {0, 5, 6}, .objects = {0, 2, 3, 4, 8, 1}};
    LightDraws draws;
    list_draws_of_lights(found, list, draws);
    REQUIRE(draws.runs.size() == 3);
    CHECK(draws.runs[0].command_count == 3);  // 0; 2; 3 and 4 as one
    CHECK(draws.runs[1].run == 1);
    CHECK(draws.runs[2].light == 1);
    REQUIRE(draws.commands.size() == 5);
    CHECK(draws.commands[1].base_instance == 2);
    CHECK(draws.commands[1].instance_count == 1);
    CHECK(draws.commands[2].base_instance == 3);
    CHECK(draws.commands[2].instance_count == 2);
    CHECK(draws.commands[2].count == 9);
    CHECK(draws.commands[3].base_instance == 8);
    CHECK(draws.commands[4].base_instance == 1);
}

}  // namespace limn::test::light_method_test
