#include "content/bake/wrinkle_model.h"
#include "systems/faces/wrinkle_fold.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/render/wrinkle_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace limn::test::wrinkle_test {
namespace {

/// The factor of the slopes of the map with which the normal was drawn.
float drawn_factor(const gpu::FloatImage& normal) {
    const Vec3 n = rgb_at(normal, normal.width / 2, normal.height / 2);
    return n.y / n.z / -WrinkleScene::map_slope().y;
}

}  // namespace

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle pass: strengths match the CPU"
        * technique("face.strain, wrinkle.compression.factor, wrinkle.compression.intensity, "
                    "wrinkle.natural-width, wrinkle.smoothing")) {
    Result<oracle::SkinReadback> readback = oracle::SkinReadback::create(device());
    REQUIRE(readback);
    Random random(5, 0, 0, 0);
    const WrinkleSurface base = {.lambda = 1.1f, .beta = 3, .slack = 0.01f};
    std::vector<WrinkleSurface> surfaces;
    for (const WrinkleMethod method :
         {WrinkleMethod::Bump, WrinkleMethod::Sphere, WrinkleMethod::Alpha,
          WrinkleMethod::Directional, WrinkleMethod::Isometric}) {
        surfaces.push_back(base);
        surfaces.back().method = method;
    }
    surfaces.push_back(base);
    surfaces.back().method = WrinkleMethod::Bump;
    surfaces.back().narrowing = 0.4f;
    for (const WrinkleDriver driver :
         {WrinkleDriver::Chord, WrinkleDriver::Edge, WrinkleDriver::Strain,
          WrinkleDriver::Radial}) {
        surfaces.push_back(base);
        surfaces.back().method = WrinkleMethod::Bump;
        surfaces.back().driver = driver;
        surfaces.back().mean_length = true;
        surfaces.back().center = {1, 0.2f, 0};
        surfaces.back().radius = 1.3f;
        surfaces.back().activation = 0.7f;
    }
    for (const std::size_t i : {5u, 6u, 7u, 8u}) {  // narrowing, and the drivers that measure
        surfaces.push_back(surfaces[i]);
        surfaces.back().smoothing = 1.5f;
        surfaces.back().lambda = 0.5f;  // wrinkles at rest: little is compressed on the mean
    }
    for (const WrinkleSurface& requested : surfaces) {
        const WrinkleMethod method = requested.method;
        MeshData tube = make_tube(24, 12, 1);
        add_morphs(tube, 1, 1, 0.03f, random);
        const Entity entity = skin(std::move(tube), requested, 1);
        const oracle::SkinReadbackVertices found =
            readback->run(world, std::vector<Entity>{entity})[0];
        const WrinkleState& state = world.get<WrinkleState>(entity);
        const WrinkleSurface& surface = world.get<WrinkleSurface>(entity);
        const std::vector<float> ratio = vertex_compression(state.rests, found.positions);
        const int component = method == WrinkleMethod::Sphere        ? 1
                              : method == WrinkleMethod::Alpha       ? 2
                              : method == WrinkleMethod::Directional ? 3
                                                                     : 0;
        REQUIRE(found.wrinkles.size() == ratio.size());
        int strong = 0;
        for (std::size_t v = 0; v < ratio.size(); ++v) {
            const float strength =
                method == WrinkleMethod::Isometric ? fold_strength(
                    state.folds, fold_excess(ratio[v], surface.slack, surface.share))
                : surface.driver == WrinkleDriver::Radial
                    ? 1.0f
                    : std::max(wrinkle_intensity(ratio[v], surface.lambda, surface.beta), 0.0f);
            Vec4 expected = {0, 0, 0, 0};
            expected[component] = state.mask[v] * surface.activation * strength;
            CHECK(glm::length(found.wrinkles[v] - expected) <= 1e-3f * std::max(strength, 1.0f));
            strong += expected[component] > 0.1f ? 1 : 0;
        }
        CHECK(strong > 3);
        readback->forget();
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle pass: skin that folds at rest counts as compressed by as much"
                      * technique("wrinkle.resting")) {
    Result<oracle::SkinReadback> readback = oracle::SkinReadback::create(device());
    REQUIRE(readback);
    const auto strength = [&](const WrinkleSurface& surface, float shortening, float age) {
        const Entity entity = square(surface, shortening);
        world.get<MorphWeights>(entity) = {{shortening, age}, {shortening, age}};
        const float found = readback->run(world, std::vector<Entity>{entity})[0].wrinkles[0].x;
        readback->forget();
        world.destroy(entity);
        return found;
    };
    for (const WrinkleMethod method : {WrinkleMethod::Isometric, WrinkleMethod::Bump}) {
        const WrinkleSurface young = {.method = method, .lambda = 1};
        WrinkleSurface old = young;
        old.resting = {{"all", 0.2f}};
        old.resting_shape = "age";
        CHECK(strength(young, 0, 0) <= 1e-6f);
        CHECK(strength(old, 0, 0) <= 1e-6f);
        CHECK(strength(young, 0.2f, 0) > 0.1f);
        CHECK(strength(old, 0, 1) == near(strength(young, 0.2f, 0)).epsilon(1e-3));
        CHECK(strength(old, 0, 0.5f) == near(strength(young, 0.1f, 0)).epsilon(1e-3));
        const float both = 1 - std::sqrt(rested_ratio(0.9f * 0.9f, 0.2f));
        CHECK(both == near(1 - 0.9 * 0.8));
        CHECK(strength(old, 0.1f, 1) == near(strength(young, both, 0)).epsilon(1e-3));
        CHECK(strength(old, 0, 7) == strength(old, 0, 1));
        old.resting_shape = "nobody";
        CHECK(strength(old, 0, 1) <= 1e-6f);
        old.resting_shape = "";
        CHECK(strength(old, 0, 0) == near(strength(young, 0.2f, 0)).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle pass: strains in the tangent frame match the CPU" * technique("face.strain")) {
    Result<oracle::SkinReadback> readback = oracle::SkinReadback::create(device());
    REQUIRE(readback);
    Random random(6, 0, 0, 0);
    MeshData tube = make_tube(24, 12, 1);
    add_morphs(tube, 1, 1, 0.03f, random);
    for (std::size_t v = 0; v < tube.tangents.size(); v += 2) {
        tube.tangents[v].w = -tube.tangents[v].w;
    }
    for (std::size_t v = 0; v < tube.tangents.size(); ++v) {  // slanted
        const Vec3 t = tube.tangents[v];
        const Vec3 slanted = 0.8f * t + 0.6f * glm::cross(tube.normals[v], t);
        tube.tangents[v] = Vec4(slanted, tube.tangents[v].w);
    }
    const Entity entity = skin(std::move(tube), {.method = WrinkleMethod::StrainView}, 1);
    const oracle::SkinReadbackVertices found = readback->run(world, std::vector<Entity>{entity})[0];
    const WrinkleState& state = world.get<WrinkleState>(entity);
    REQUIRE(state.rests.size() == 3);
    REQUIRE(state.frames.size() == found.positions.size());
    std::vector<std::vector<float>> lengths;
    for (const WrinkleRest& rest : state.rests) {
        lengths.push_back(vertex_compression({&rest, 1}, found.positions));
    }
    float strongest = 0;
    for (std::size_t v = 0; v < found.positions.size(); ++v) {
        const SkinStrain strain = strain_of_tensor(
            tensor_of_ratios(lengths[0][v], lengths[1][v], lengths[2][v]), state.frames[v].x,
            state.frames[v].y);
        const Vec4 expected = {strain.uu, strain.vv, strain.uv, 1};
        CHECK(glm::length(found.wrinkles[v] - expected) <= 2e-3f);
        strongest = std::max(strongest, std::abs(strain.uv));
    }
    CHECK(strongest > 0.05f);
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle pass: compressed skin is shown red, stretched skin blue, any other gray"
                      * technique("face.strain")) {
    material.wrinkle_texture = {};  // not needed
    const auto color = [&](float weight) {
        const Entity entity = square({.method = WrinkleMethod::StrainView}, weight);
        const gpu::FloatImage albedo = aov(view, "albedo");
        world.destroy(entity);
        return rgb_at(albedo, 2, 16);  // between two crosses
    };
    const Vec3 rest = color(0);
    CHECK(rest.x == near(rest.z).epsilon(1e-2));
    const Vec3 compressed = color(0.3f);
    CHECK(compressed.x > 5 * compressed.z);
    const Vec3 stretched = color(-0.3f);
    CHECK(stretched.z > 5 * stretched.x);
}

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle pass: slopes are scaled, lifted, or keep the length of skin"
        * technique("wrinkle.compression.interp-bump, wrinkle.compression.normal-fit, "
                    "wrinkle.compression.skin-model")) {
    const float ratio = 0.8f * 0.8f;
    const float intensity = wrinkle_intensity(ratio, 1, 4);
    CHECK(intensity == near(0.712663));

    const Entity bump = square({.method = WrinkleMethod::Bump, .lambda = 1}, 0.2f);
    CHECK(drawn_factor(aov(view, "normal")) == near(intensity).epsilon(2e-3));
    world.destroy(bump);

    // x and y of the unit normal times the intensity, lifted to the sphere.
    const Entity sphere = square({.method = WrinkleMethod::Sphere, .lambda = 1}, 0.2f);
    const Vec3 unit = glm::normalize(Vec3(-map_slope(), 1.0f));
    const float y = intensity * unit.y;
    CHECK(
        drawn_factor(aov(view, "normal"))
        == near(y / std::sqrt(1 - y * y) / -map_slope().y).epsilon(2e-3));
    world.destroy(sphere);

    // The one slope of the map times the factor is as long as the skin was.
    square({.method = WrinkleMethod::Isometric, .slack = 0, .share = 1}, 0.2f);
    const float slope = drawn_factor(aov(view, "normal")) * map_slope().y;
    CHECK(std::sqrt(1 + slope * slope) == near(1 / 0.8).epsilon(3e-3));
}

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle pass: shading darkens the lit pixel, highlights and all, whatever the light"
        * technique("wrinkle.compression.alpha-directional, wrinkle.compression.alpha-shading")) {
    // Glossy skin in white light and the light of a sky: of its color alone, little would be left.
    material.base_color = {0.05f, 0.04f, 0.03f, 1};
    material.roughness = 0.4f;
    world.insert_resource(Environment{.sky = SkyKind::Gradient, .intensity = 0.4f});
    const float intensity = wrinkle_intensity(0.64f, 1, 4);
    const float full = 1 - intensity * -map_slope().y;
    for (const ShadingModel model : {ShadingModel::Pbr, ShadingModel::Blinn, ShadingModel::Skin}) {
        material.shading = model;
        for (const Vec3& light : {Vec3(0, 0.2f, 1), Vec3(1, -1, 1)}) {
            const Entity lamp = shine(DirectionalLight{}, look_at(light, {0, 0, 0}));
            const auto darkening = [&](WrinkleMethod method, bool upside_down) {
                material.wrinkle_texture.image = upside_down ? add(ImageData{
                                                     .name = "down",
                                                     .width = 1,
                                                     .height = 1,
                                                     .pixels = {128, 256 - kSlopeByte, 240, 255}})
                                                             : slope_map();
                const auto lit = [&](WrinkleMethod drawn) {
                    const Entity entity = square({.method = drawn, .lambda = 1}, 0.2f);
                    const Vec3 pixel = rgb_at(radiance(view), 16, 16);
                    world.destroy(entity);
                    return pixel;
                };
                const Vec3 ratio = lit(method) / lit(WrinkleMethod::None);
                CHECK(ratio.x == near(ratio.z).epsilon(4e-3));
                return ratio.y;
            };
            CHECK(darkening(WrinkleMethod::Alpha, false) == near(full).epsilon(4e-3));
            CHECK(darkening(WrinkleMethod::Alpha, true) == near(full).epsilon(4e-3));
            CHECK(darkening(WrinkleMethod::Directional, true) == near(full).epsilon(4e-3));
            CHECK(darkening(WrinkleMethod::Directional, false) == near(1).epsilon(4e-3));
            world.destroy(lamp);
        }
    }
    // Skin that emits light has no room for it: its color is darkened.
    material.emission = {0.2f, 0.1f, 0};
    square({.method = WrinkleMethod::Alpha, .lambda = 1}, 0.2f);
    CHECK(rgb_at(aov(view, "albedo"), 16, 16).x / 0.05f == near(full).epsilon(2e-2));
}

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle pass: at rest, stretched, or without a method skin has no wrinkles"
        * technique("face.wrinkle-options, wrinkle.compression.alpha-shading, "
                    "wrinkle.compression.integration, wrinkle.compression.interp-bump")) {
    shine(DirectionalLight{}, look_at({1, 2, 3}, {0, 0, 0}));
    const auto pixels = [&](const WrinkleSurface& surface, float weight, bool with) {
        const Entity entity = square(surface, weight);
        if (!with) {
            world.remove<WrinkleSurface>(entity);
        }
        std::vector<float> result = radiance(view).pixels;
        world.destroy(entity);
        return result;
    };
    for (const WrinkleMethod method :
         {WrinkleMethod::Bump, WrinkleMethod::Sphere, WrinkleMethod::Alpha,
          WrinkleMethod::Isometric}) {
        CHECK(pixels({.method = method}, 0, true) == pixels({.method = method}, 0, false));
        CHECK(pixels({.method = method}, -0.3f, true) == pixels({.method = method}, -0.3f, false));
        CHECK(pixels({.method = method}, 0.3f, true) != pixels({.method = method}, 0.3f, false));
    }
    CHECK(
        pixels({.method = WrinkleMethod::None}, 0.3f, true)
        == pixels({.method = WrinkleMethod::None}, 0.3f, false));
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle pass: a model's slopes are its polynomial of the strain, of any degree"
                      * technique("face.wrinkle-model")) {
    // The square becomes 0.8 as high; the map's bitangent points up.
    const Vec3 strain = {0, -0.2f, 0};
    Random random(4, 0, 0, 0);
    std::vector<WrinklePose> poses;
    for (int i = 0; i < 40; ++i) {
        const Vec3 at = {
            0.5f * random.uniform() - 0.25f, 0.5f * random.uniform() - 0.25f,
            0.5f * random.uniform() - 0.25f};
        poses.push_back(
            {std::vector<Vec3>(16, at),
             std::vector<Vec2>(
                 16, Vec2(at.y + 8 * at.y * at.y, 0.3f * at.x - 60 * at.y * at.y * at.y))});
    }
    for (int degree = 1; degree <= 3; ++degree) {
        const WrinkleModel model = fit_wrinkle_model(4, poses, {.degree = degree});
        material.wrinkle_texture.image = add(pack_wrinkle_model(model));
        const auto slope_at = [&](float weight) {
            const Entity entity = square({.method = WrinkleMethod::Model}, weight);
            const Vec3 n = rgb_at(aov(view, "normal"), 16, 16);
            world.destroy(entity);
            return Vec2(-n.x / n.z, -n.y / n.z);
        };
        const Vec2 expected = modeled_slope(model, 5, strain);
        CHECK(glm::length(expected) > 0.1f);
        CHECK(glm::distance(slope_at(0.2f), expected) < 4e-3f);
        CHECK(slope_at(0) == Vec2(0));
        // Beyond the poses it is clamped.
        CHECK(glm::distance(slope_at(0.9f), slope_at(0.5f)) < 1e-6f);
    }
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle pass: a flat map raises nothing, however compressed"
                      * technique("wrinkle.compression.map")) {
    shine(DirectionalLight{}, look_at({1, 2, 3}, {0, 0, 0}));
    material.wrinkle_texture.image =
        add(ImageData{.name = "flat", .width = 1, .height = 1, .pixels = {128, 128, 255, 255}});
    const auto pixels = [&](WrinkleMethod method) {
        const Entity entity = square({.method = method, .lambda = 0.5f}, 0.6f);
        std::vector<float> result = radiance(view).pixels;
        world.destroy(entity);
        return result;
    };
    const std::vector<float> none = pixels(WrinkleMethod::None);
    for (const WrinkleMethod method :
         {WrinkleMethod::Alpha, WrinkleMethod::Directional, WrinkleMethod::Bump,
          WrinkleMethod::Sphere, WrinkleMethod::Isometric, WrinkleMethod::Blend}) {
        CHECK(pixels(method) == none);
    }
}

/// A map whose first layer has the slope of `slope_map`, and whose second one that along u.
ImageData layered_map() {
    return {
        .name = "layers", .width = 1, .height = 1, .pixels = {128, kSlopeByte, kSlopeByte, 128}};
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle overlap: slopes of both layers add up, each scaled by its strength"
                      * technique("wrinkle.compression.overlap")) {
    MeshData mesh = make_square();
    MorphTarget& smaller = mesh.morphs.emplace_back();
    for (std::uint32_t v = 0; v < 4; ++v) {
        smaller.vertices.push_back(v);
        smaller.positions.push_back(mesh.positions[v] * Vec3{-0.5f, -1, 0});
    }
    const float length = std::sqrt(127.0f * 127.0f - 60.0f * 60.0f);
    const float slope = 60 / length;  // of each layer, whose z follows from x and y
    material.wrinkle_texture.image = add(layered_map());
    const auto drawn = [&](WrinkleSurface surface) {
        surface.second_turned = true;
        surface.lambda = 1;
        const Entity entity = skin(mesh, surface, 0.2f);
        const Vec3 n = rgb_at(aov(view, "normal"), 16, 16);
        world.destroy(entity);
        return Vec2(n.x / n.z, n.y / n.z);
    };
    const float high = wrinkle_intensity(0.64f, 1, 4);
    const float low = wrinkle_intensity(0.81f, 1, 4);
    const Vec2 summed = drawn({.method = WrinkleMethod::Bump});
    CHECK(summed.x == near(low * slope).epsilon(3e-3));
    CHECK(summed.y == near(high * slope).epsilon(3e-3));

    // Independent, the second one covers the first: less of it remains, and in between it is
    // flatter.
    const Vec2 covered =
        drawn({.method = WrinkleMethod::Bump, .combine = WrinkleCombine::Independent});
    const Vec3 first = glm::normalize(Vec3(0, slope, 1));
    const Vec3 second = glm::normalize(Vec3(slope, 0, 1));
    const Vec3 n = glm::mix(glm::mix(Vec3(0, 0, 1), first, high), second, low);
    CHECK(covered.x == near(n.x / n.z).epsilon(3e-3));
    CHECK(covered.y == near(n.y / n.z).epsilon(3e-3));
    CHECK(covered.y < 0.8f * summed.y);
}

TEST_CASE_FIXTURE(
    WrinkleScene,
    "wrinkle overlap: one layer is as without a second one, and two halves equal a whole"
        * technique("wrinkle.compression.overlap")) {
    // Only across the first layer's wrinkles: the second one stays flat.
    material.wrinkle_texture.image = add(layered_map());
    const auto drawn = [&](const WrinkleSurface& surface) {
        const Entity entity = square(surface, 0.2f);
        const Vec3 n = rgb_at(aov(view, "normal"), 16, 16);
        world.destroy(entity);
        return Vec2(n.x / n.z, n.y / n.z);
    };
    const float slope = 60 / std::sqrt(127.0f * 127.0f - 60.0f * 60.0f);
    const Vec2 single = drawn({.method = WrinkleMethod::Bump, .second_turned = true, .lambda = 1});
    CHECK(single.x == 0);
    CHECK(single.y == near(wrinkle_intensity(0.64f, 1, 4) * slope).epsilon(3e-3));
    // Two identical layers at half their strength are one at its whole.
    material.wrinkle_texture.image = add(ImageData{
        .name = "twins", .width = 1, .height = 1, .pixels = {128, kSlopeByte, 128, kSlopeByte}});
    const Vec2 halves = drawn(
        {.method = WrinkleMethod::Bump,
         .second_regions = {"all"},
         .lambda = 1,
         .activation = 0.5f});
    CHECK(halves.y == near(single.y).epsilon(3e-3));
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle overlap: alpha darkens by one layer and then the other"
                      * technique("wrinkle.compression.overlap")) {
    MeshData mesh = make_square();
    MorphTarget& smaller = mesh.morphs.emplace_back();
    for (std::uint32_t v = 0; v < 4; ++v) {
        smaller.vertices.push_back(v);
        smaller.positions.push_back(mesh.positions[v] * Vec3{-1, -1, 0});
    }
    material.wrinkle_texture.image = add(layered_map());
    const Entity face =
        skin(mesh, {.method = WrinkleMethod::Alpha, .second_turned = true, .lambda = 1}, 0.2f);
    const float dark =
        1 - wrinkle_intensity(0.64f, 1, 4) * 60 / std::sqrt(127.0f * 127.0f - 60.0f * 60.0f);
    shine(DirectionalLight{}, look_at({0, 1, 2}, {0, 0, 0}));
    const float shaded = rgb_at(radiance(view), 16, 16).x;
    world.get<WrinkleSurface>(face).method = WrinkleMethod::None;
    CHECK(shaded / rgb_at(radiance(view), 16, 16).x == near(dark * dark).epsilon(6e-3));
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle options: a photograph keeps its light, a normal map follows the lamp"
                      * technique("face.wrinkle-options")) {
    const auto brightness = [&](WrinkleMethod method, const Vec3& light) {
        const Entity lamp = shine(DirectionalLight{}, look_at(light, {0, 0, 0}));
        const Entity entity = square({.method = method, .lambda = 1}, 0.2f);
        const float wrinkled = rgb_at(radiance(view), 16, 16).x;
        world.destroy(entity);
        const Entity smooth = square({.method = WrinkleMethod::None}, 0.2f);
        const float flat = rgb_at(radiance(view), 16, 16).x;
        world.destroy(smooth);
        world.destroy(lamp);
        return wrinkled / flat;
    };
    // The slope faces up or down, and so do the lamps.
    const float photo_up = brightness(WrinkleMethod::Photo, {0, 1, 1});
    const float photo_down = brightness(WrinkleMethod::Photo, {0, -1, 1});
    CHECK(photo_up == near(photo_down).epsilon(5e-3));  // gloss is not painted
    const float bump_up = brightness(WrinkleMethod::Bump, {0, 1, 1});
    const float bump_down = brightness(WrinkleMethod::Bump, {0, -1, 1});
    CHECK(bump_up > 1.1f);
    CHECK(bump_down < 0.9f);
    CHECK(photo_up > 1.1f);  // its light was above
    // In full, it is the light of the normal in that lamp.
    const float slope = -map_slope().y;
    const float painted = (1 + slope) / std::sqrt(1 + slope * slope);
    const float strength = wrinkle_intensity(0.64f, 1, 4);
    CHECK(photo_up == near(1 + strength * (painted - 1)).epsilon(1e-2));
}

TEST_CASE_FIXTURE(
    WrinkleScene, "wrinkle pass: across the fold only; along it nothing happens"
                      * technique("wrinkle.compression.direction")) {
    MeshData mesh = make_square();
    MorphTarget& narrow = mesh.morphs.emplace_back();
    narrow.name = "narrow";
    for (std::uint32_t v = 0; v < 4; ++v) {
        narrow.vertices.push_back(v);
        narrow.positions.push_back(mesh.positions[v] * Vec3{-1, 0, 0});
    }
    skin(std::move(mesh), {.method = WrinkleMethod::Bump}, 0.3f);
    CHECK(drawn_factor(aov(view, "normal")) == 0);
}

}  // namespace limn::test::wrinkle_test
