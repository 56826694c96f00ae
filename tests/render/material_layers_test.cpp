#include "bench/oracles/layers_oracle.h"
#include "bench/oracles/light_oracle.h"
#include "ecs/components/rendering.h"
#include "render/environment/sheen_albedo.h"
#include "render/graph/frame_graph.h"
#include "render/material/material_layers.h"
#include "render/material/shading_models.h"
#include "render/variant.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace limn::test::material_layers_test {
namespace {

using oracle::DVec3;

constexpr int kSide = 24;
const DVec3 kEye = {0, 0, 1};
const DVec3 kUp = {0, 0, 1};
constexpr Vec3 kLamp = {0.5f, 0.4f, 0.6f};
const PointLight kLight = {.color = {1, 0.8f, 0.6f}, .intensity = 0.8f, .radius = 0};

/// A material with layers, by name.
struct Layered {
    const char* name;
    Material material;
};

std::vector<Layered> all_layers() {
    const Material plastic = {.base_color = {0.6f, 0.4f, 0.3f, 1}, .roughness = 0.45f};
    const Material metal = {
        .base_color = {0.9f, 0.7f, 0.5f, 1}, .metalness = 1, .roughness = 0.35f};
    std::vector<Layered> all = {{"weight", plastic}, {"tint", plastic},      {"index", plastic},
                                {"coat", plastic},   {"sheen", plastic},     {"brushed", metal},
                                {"turned", metal},   {"film", plastic},      {"heat", metal},
                                {"all", plastic},    {"half metal", plastic}};
    all[0].material.specular_weight = 0.25f;
    all[1].material.specular_tint = {1, 0.5f, 8};
    all[2].material.refractive_index = 2.4f;
    all[3].material.clearcoat = 0.8f;
    all[3].material.clearcoat_roughness = 0.25f;
    all[4].material.sheen = {0.7f, 0.8f, 0.3f};
    all[4].material.sheen_roughness = 0.5f;
    all[5].material.anisotropy = 0.7f;
    all[6].material.anisotropy = 0.5f;
    all[6].material.anisotropy_rotation = 0.7f;
    all[7].material.iridescence = 1;
    all[8].material.iridescence = 0.8f;
    all[8].material.iridescence_index = 1.8f;
    all[8].material.iridescence_thickness = {100, 550};
    Material& every = all[9].material;
    every.specular_weight = 0.7f;
    every.specular_tint = {0.6f, 1, 0.8f};
    every.clearcoat = 0.6f;
    every.clearcoat_roughness = 0.3f;
    every.sheen = {0.3f, 0.2f, 0.4f};
    every.sheen_roughness = 0.7f;
    every.anisotropy = 0.4f;
    every.anisotropy_rotation = -0.4f;
    every.iridescence = 0.5f;
    all[10].material = every;
    all[10].material.metalness = 0.5f;
    all.push_back({"silk", plastic});  // smooth sheen
    all.back().material.sheen = {1, 1, 1};
    all.back().material.sheen_roughness = 0.15f;
    return all;
}

oracle::LayeredMaterial oracle_of(const Material& m) {
    const double turn = m.anisotropy_rotation;
    return {
        .albedo = DVec3(m.base_color),
        .metalness = m.metalness,
        .roughness = m.roughness,
        .index = m.refractive_index,
        .specular_weight = m.specular_weight,
        .specular_tint = DVec3(m.specular_tint),
        .coat = m.clearcoat,
        .coat_roughness = m.clearcoat_roughness,
        .sheen = DVec3(m.sheen),
        .sheen_roughness = m.sheen_roughness,
        .anisotropy = m.anisotropy,
        .along = {std::cos(turn), std::sin(turn), 0},
        .iridescence = m.iridescence,
        .film_index = m.iridescence_index,
        .film_thickness = m.iridescence_thickness.y};
}

/// A square of side 2 under a lamp, viewed from 1 m.
struct Plate : Scene {
    Plate() : square(add(make_square())) {}
    gpu::FloatImage picture(const Material& material, int side = kSide) {
        world.clear();
        place(square, add(material), at({0, 0, 0}));
        shine(kLight, at(kLamp));
        return radiance(look(Vec3(kEye), {0, 0, 0}, side, side));
    }
    MeshId square;
};

/// The plate by the oracle, at the center of a pixel.
DVec3 expected_at(const oracle::LayeredMaterial& material, int x, int y) {
    const auto to_plate = [](int i) { return 2 * (i + 0.5) / kSide - 1; };
    const DVec3 point = {to_plate(x), -to_plate(y), 0};
    const DVec3 to_camera = glm::normalize(kEye - point);
    const oracle::Arriving light = oracle::arrive(kLight, DVec3(kLamp), point, kUp);
    const oracle::LayerAlbedos albedos = oracle::layer_albedos(material, to_camera.z, 1024);
    const double sheen_light =
        material.sheen == DVec3(0)
            ? 0
            : oracle::sheen_albedo(light.to_light.z, material.sheen_roughness, 64);
    return std::numbers::pi * light.color
           * oracle::reflect_layers(
               material, albedos, sheen_light, kUp, kUp, to_camera, light.to_light);
}

/// Two texels, side by side.
ImageData two_texels(const std::array<std::uint8_t, 8>& texels, bool srgb = false) {
    return {
        .name = "halves",
        .width = 2,
        .height = 1,
        .srgb = srgb,
        .pixels = std::vector<std::uint8_t>(texels.begin(), texels.end())};
}

TextureSlot crisp(ImageId image) {
    return {.image = image, .wrap_u = Wrap::Clamp, .nearest = true};
}

}  // namespace

TEST_CASE(
    "material layers: the picture is that of the formulas in double precision"
    * technique("shade.clear-coat, shade.sheen, shade.dielectric-specular, "
                "shade.anisotropic-specular, shade.thin-film")) {
    Plate plate;
    for (const Layered& layered : all_layers()) {
        const gpu::FloatImage image = plate.picture(layered.material);
        const oracle::LayeredMaterial material = oracle_of(layered.material);
        double brightest = 0;
        double worst = 0;
        for (int y = 2; y < kSide; y += 5) {
            for (int x = 1; x < kSide; x += 4) {
                const DVec3 want = expected_at(material, x, y);
                for (int c = 0; c < 3; ++c) {
                    brightest = std::max(brightest, want[c]);
                    worst = std::max(worst, std::abs(want[c] - image.at(x, y, c)));
                }
            }
        }
        CAPTURE(layered.name);
        CHECK(brightest > 0.1);
        CHECK(worst < 4e-3 * brightest);
    }
}

TEST_CASE("material layers: each looks the same lit deferred, forward or light by light") {
    Plate plate;
    for (const Layered& layered : all_layers()) {
        CAPTURE(layered.name);
        const auto by = [&](LightMethod method) {
            plate.world.insert_resource(Rendering{method});
            return plate.picture(layered.material);
        };
        const gpu::FloatImage clustered = by(LightMethod::Clustered);
        for (const LightMethod method :
             {LightMethod::FullScreen, LightMethod::Volumes, LightMethod::ObjectMajor,
              LightMethod::LightMajor}) {
            CAPTURE(static_cast<int>(method));
            CHECK(largest_difference(by(method), clustered) < 1e-3f);
        }
    }
}

TEST_CASE("material layers: without layers materials keep their programs, targets and pixels") {
    CHECK(layers_of(Material{}) == 0);
    Variant variant;
    add_layers(variant, 0);
    CHECK(variant.definitions().empty());

    Plate plate;
    Material plain = {.base_color = {0.6f, 0.4f, 0.3f, 1}, .roughness = 0.45f};
    const gpu::FloatImage before = plate.picture(plain);
    CHECK(!frame_graph(shared_renderer()).find("gbuffer.layers").valid());
    CHECK(!frame_graph(shared_renderer()).find("gbuffer.material").valid());

    // Factors of layers that are absent, and their maps.
    const ImageId image = plate.add(two_texels({9, 99, 0, 70, 50, 9, 200, 3}));
    plain.clearcoat_roughness = 0.5f;
    plain.sheen_roughness = 0.5f;
    plain.anisotropy_rotation = 1;
    plain.iridescence_index = 2;
    for (TextureSlot Material::*const slot :
         {&Material::clearcoat_texture, &Material::clearcoat_roughness_texture,
          &Material::clearcoat_normal_texture, &Material::sheen_texture,
          &Material::sheen_roughness_texture, &Material::anisotropy_texture,
          &Material::iridescence_texture, &Material::iridescence_thickness_texture}) {
        plain.*slot = crisp(image);
    }
    CHECK(layers_of(plain) == 0);
    CHECK(plate.picture(plain).pixels == before.pixels);

    plain.clearcoat = 1;
    CHECK(layers_of(plain) == kCoatLayer);
    CHECK(plate.picture(plain).pixels != before.pixels);
    CHECK(frame_graph(shared_renderer()).find("gbuffer.layers").valid());
    plain.shading = ShadingModel::Blinn;
    CHECK(layers_of(plain) == 0);
}

TEST_CASE("material layers: a surface without them looks the same beside one that has them") {
    Plate plate;
    const Material plain = {.base_color = {0.6f, 0.4f, 0.3f, 1}, .roughness = 0.45f};
    const gpu::FloatImage alone = plate.picture(plain);
    for (const Layered& layered : all_layers()) {
        plate.add(layered.material);
    }
    CHECK(largest_difference(plate.picture(plain), alone) < 1e-5f);
}

TEST_CASE(
    "material layers: a layer with a map of zeros is not there"
    * technique("shade.clear-coat, shade.sheen, shade.thin-film")) {
    Plate plate;
    const Material plain = {.base_color = {0.6f, 0.4f, 0.3f, 1}, .roughness = 0.45f};
    const gpu::FloatImage without = plate.picture(plain);
    Material covered = plain;
    covered.clearcoat = 1;
    covered.sheen = {1, 1, 1};
    covered.sheen_roughness = 0.5f;
    covered.iridescence = 1;
    covered.anisotropy = 1;
    const TextureSlot zeros = crisp(plate.add(two_texels({128, 128, 0, 0, 128, 128, 0, 0})));
    const TextureSlot black = crisp(plate.add(two_texels({0, 0, 0, 0, 0, 0, 0, 0}, true)));
    covered.clearcoat_texture = black;
    covered.sheen_texture = black;
    covered.iridescence_texture = black;
    covered.anisotropy_texture = zeros;
    CHECK(largest_difference(plate.picture(covered), without) < 2e-3f);
}

TEST_CASE(
    "material layers: the strength of the coat's normal map is that of its slope"
    * technique("shade.clear-coat")) {
    Plate plate;
    Material coated = {
        .base_color = {0, 0, 0, 1}, .roughness = 0.9f, .clearcoat = 1, .clearcoat_roughness = 0.5f};
    const gpu::FloatImage flat = plate.picture(coated);
    // Half the slope of a texel is another texel: (0.6, 0, 0.8) leans by 3/4, and (3/8, 0, 1) by
    // 3/8.
    const TextureSlot steep =
        crisp(plate.add(two_texels({204, 128, 230, 255, 204, 128, 230, 255})));
    const TextureSlot half = crisp(plate.add(two_texels({173, 128, 247, 255, 173, 128, 247, 255})));
    coated.clearcoat_normal_texture = half;
    const gpu::FloatImage leaning = plate.picture(coated);
    CHECK(largest_difference(leaning, flat) > 0.01f);
    coated.clearcoat_normal_texture = steep;
    coated.clearcoat_normal_scale = 0.5f;
    CHECK(
        largest_difference(plate.picture(coated), leaning)
        < 0.1f * largest_difference(leaning, flat));
    coated.clearcoat_normal_scale = 0;
    CHECK(largest_difference(plate.picture(coated), flat) < 1e-3f);
}

TEST_CASE(
    "material layers: in a white furnace no surface is brighter than its surroundings"
    * technique("shade.clear-coat, shade.sheen, shade.dielectric-specular, "
                "shade.anisotropic-specular, shade.thin-film")) {
    Scene scene;
    scene.world.insert_resource(
        Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}, .visible = true});
    const MeshId ball = scene.add(make_ball(32));
    for (Layered& layered : all_layers()) {
        CAPTURE(layered.name);
        layered.material.base_color = {1, 1, 1, 1};
        const Entity entity = scene.place(ball, scene.add(layered.material), at({0, 0, 0}));
        const gpu::FloatImage image = scene.radiance(scene.look({0, 0, 2}, {0, 0, 0}, 32, 32));
        float high = 0;
        float low = INFINITY;
        for (std::size_t i = 0; i < image.pixels.size(); ++i) {
            if (i % 4 != 3) {
                high = std::max(high, image.pixels[i]);
                low = std::min(low, image.pixels[i]);
            }
        }
        CHECK(high < 1.01f);
        CHECK(
            low
            > (layered.material.iridescence > 0 || layered.material.sheen != Vec3(0)  ? 0.3f
               : layered.material.specular_tint.x != layered.material.specular_tint.y ? 0.6f
                                                                                      : 0.98f));
        scene.world.destroy(entity);
    }
}

TEST_CASE(
    "material layers: light by light, too, no surface returns more than it receives"
    * technique("shade.clear-coat, shade.sheen, shade.thin-film")) {
    for (const Layered& layered : all_layers()) {
        oracle::LayeredMaterial white = oracle_of(layered.material);
        white.albedo = DVec3(1);
        for (const double n_v : {0.2, 0.7}) {
            CAPTURE(layered.name);
            CAPTURE(n_v);
            const DVec3 sum = oracle::layers_furnace(white, n_v, 64);
            CHECK(std::max({sum.x, sum.y, sum.z}) < 1.03);
            CHECK(std::min({sum.x, sum.y, sum.z}) > 0.3);
        }
    }
}

TEST_CASE(
    "material layers: a clear coat dims what is below it by what it reflects"
    * technique("shade.clear-coat")) {
    Scene scene;  // without light
    Material lamp = {.base_color = {0, 0, 0, 1}, .roughness = 1, .emission = {2, 2, 2}};
    lamp.clearcoat = 0.75f;
    lamp.clearcoat_roughness = 0.5f;
    scene.place(scene.add(make_square()), scene.add(lamp), at({0, 0, 0}));
    for (const LightMethod method :
         {LightMethod::Clustered, LightMethod::FullScreen, LightMethod::ObjectMajor}) {
        scene.world.insert_resource(Rendering{method});
        const gpu::FloatImage image = scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 17, 17));
        for (const int x : {8, 0}) {
            const double slope = 2 * (x + 0.5) / 17 - 1;
            const double cosine = 1 / std::sqrt(1 + slope * slope);
            const double coat = 0.75 * (0.04 + 0.96 * std::pow(1 - cosine, 5));
            CHECK(image.at(x, 8, 0) == test::near(2 * (1 - coat)).epsilon(2e-3));
        }
    }
}

TEST_CASE(
    "material layers: maps are factors, texel by texel"
    * technique("shade.clear-coat, shade.sheen, shade.dielectric-specular, shade.thin-film")) {
    struct Map {
        const char* name;
        TextureSlot Material::*slot;
        std::array<std::uint8_t, 4> texel;      ///< of the right half; the left one is white
        std::function<void(Material&)> change;  ///< that is the same
        bool srgb = false;
    };
    const float half = 128 / 255.0f;
    const Map maps[] = {
        {"coat",
         &Material::clearcoat_texture,
         {128, 255, 255, 255},
         [half](Material& m) { m.clearcoat *= half; }},
        {"coat roughness",
         &Material::clearcoat_roughness_texture,
         {255, 128, 255, 255},
         [half](Material& m) { m.clearcoat_roughness *= half; }},
        {"sheen",
         &Material::sheen_texture,
         {255, 0, 255, 255},
         [](Material& m) { m.sheen.y = 0; },
         true},
        {"sheen roughness",
         &Material::sheen_roughness_texture,
         {255, 255, 255, 128},
         [half](Material& m) { m.sheen_roughness *= half; }},
        {"weight",
         &Material::specular_weight_texture,
         {255, 255, 255, 128},
         [half](Material& m) { m.specular_weight *= half; }},
        {"tint",
         &Material::specular_tint_texture,
         {0, 255, 255, 255},
         [](Material& m) { m.specular_tint.x = 0; },
         true},
        {"film",
         &Material::iridescence_texture,
         {128, 255, 255, 255},
         [half](Material& m) { m.iridescence *= half; }},
        {"thickness",
         &Material::iridescence_thickness_texture,
         {255, 128, 255, 255},
         [half](Material& m) {
             const Vec2& t = m.iridescence_thickness;
             m.iridescence_thickness.y = t.x + half * (t.y - t.x);
         }}};
    Plate plate;
    Material base = all_layers()[9].material;
    base.specular_weight = 1;
    base.specular_tint = {1, 1, 1};
    base.iridescence = 0.4f;
    for (const Map& map : maps) {
        CAPTURE(map.name);
        Material mapped = base;
        const std::array<std::uint8_t, 4>& t = map.texel;
        mapped.*map.slot =
            crisp(plate.add(two_texels({255, 255, 255, 255, t[0], t[1], t[2], t[3]}, map.srgb)));
        Material changed = base;
        map.change(changed);
        const gpu::FloatImage image = plate.picture(mapped);
        const gpu::FloatImage left = plate.picture(base);
        const gpu::FloatImage right = plate.picture(changed);
        float distance = 0;
        float apart = 0;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                const gpu::FloatImage& same = x < kSide / 2 ? left : right;
                const gpu::FloatImage& other = x < kSide / 2 ? right : left;
                for (int c = 0; c < 3; ++c) {
                    distance = std::max(distance, std::abs(image.at(x, y, c) - same.at(x, y, c)));
                    apart = std::max(apart, std::abs(image.at(x, y, c) - other.at(x, y, c)));
                }
            }
        }
        CHECK(distance < 5e-3f);
        CHECK(apart > 4 * distance);
    }
}

TEST_CASE("material layers: a clear coat has normals of its own" * technique("shade.clear-coat")) {
    Plate plate;
    Material coated = {.base_color = {0, 0, 0, 1}, .roughness = 1, .specular_weight = 0};
    coated.clearcoat = 1;
    coated.clearcoat_roughness = 0.3f;
    const auto brightest_x = [&](const Material& material) {
        const gpu::FloatImage image = plate.picture(material);
        int found = 0;
        for (int x = 0; x < kSide; ++x) {
            found = image.at(x, 7, 0) > image.at(found, 7, 0) ? x : found;
        }
        return found;
    };
    const int flat = brightest_x(coated);
    const ImageId slope = plate.add(two_texels({168, 128, 248, 255, 168, 128, 248, 255}));
    Material base = coated;
    base.normal_texture = crisp(slope);
    CHECK(brightest_x(base) == flat);  // the normals of the base are not the coat's
    coated.clearcoat_normal_texture = crisp(slope);
    CHECK(brightest_x(coated) < flat - 2);  // a slope to the right mirrors the lamp farther left
}

TEST_CASE(
    "material layers: the map of anisotropy turns and weakens the stretch"
    * technique("shade.anisotropic-specular, shade.anisotropy-map")) {
    Plate plate;
    Material metal = {.base_color = {0.9f, 0.7f, 0.5f, 1}, .metalness = 1, .roughness = 0.35f};
    metal.anisotropy = 0.8f;
    const gpu::FloatImage along = plate.picture(metal);
    Material turned = metal;
    turned.anisotropy_rotation = 0.5f * kPi;
    const gpu::FloatImage across = plate.picture(turned);
    CHECK(largest_difference(along, across) > 0.1f);
    const auto mapped = [&](const std::array<std::uint8_t, 3>& t) {
        Material material = metal;
        material.anisotropy_texture =
            crisp(plate.add(two_texels({t[0], t[1], t[2], 255, t[0], t[1], t[2], 255})));
        return plate.picture(material);
    };
    const float close = 1e-3f * *std::max_element(along.pixels.begin(), along.pixels.end());
    const auto turned_by = [&](float rotation) {
        turned.anisotropy_rotation = rotation;
        return plate.picture(turned);
    };
    const float off = std::atan(1 / 255.0f);  // 127.5 of 255 is 0
    CHECK(largest_difference(mapped({255, 128, 255}), turned_by(off)) < close);
    CHECK(largest_difference(mapped({0, 128, 255}), turned_by(-off)) < close);  // T and -T
    CHECK(largest_difference(mapped({128, 255, 255}), turned_by(0.5f * kPi - off)) < close);
    Material weak = metal;
    weak.anisotropy *= 128 / 255.0f;
    weak.anisotropy_rotation = off;
    CHECK(largest_difference(mapped({255, 128, 128}), plate.picture(weak)) < close);
}

TEST_CASE(
    "material layers: a highlight is as long across a turned plate as along the first"
    * technique("shade.anisotropic-specular")) {
    // A lamp behind the camera: a symmetric highlight, whose image turns with the direction.
    Scene scene;
    const MeshId square = scene.add(make_square());
    Material metal = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0.3f};
    metal.anisotropy = 0.8f;
    const auto picture = [&](float rotation) {
        scene.world.clear();
        metal.anisotropy_rotation = rotation;
        scene.place(square, scene.add(metal), at({0, 0, 0}));
        scene.shine(kLight, at({0, 0, 1}));
        return scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 25, 25));
    };
    const gpu::FloatImage along = picture(0);
    const gpu::FloatImage across = picture(0.5f * kPi);
    CHECK(along.at(22, 12, 0) > 2 * along.at(12, 22, 0));
    for (int y = 0; y < 25; ++y) {
        for (int x = 0; x < 25; ++x) {
            CHECK(across.at(y, x, 0) == test::near(along.at(x, y, 0)).epsilon(0.01));
        }
    }
}

TEST_CASE(
    "material layers: the table of sheen is the sum over all directions"
    * technique("shade.sheen")) {
    constexpr int kSize = 64;
    const std::vector<float> table = make_sheen_albedo(kSize);
    for (const int y : {20, 32, 63}) {
        for (int x = 1; x < kSize; x += 9) {
            const double n_v = x / double(kSize - 1);
            const double want = oracle::sheen_albedo(n_v, y / double(kSize - 1), 256);
            CHECK(std::abs(table[y * kSize + x] - want) < 5e-3);
        }
    }
}

TEST_CASE(
    "material layers: camera and lamp may change places"
    * technique("shade.sheen, shade.anisotropic-specular")) {
    // Without layers that depend on the camera alone; rough enough to lose little light.
    Scene scene;
    const MeshId square = scene.add(make_square());
    Material metal = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0.3f};
    metal.anisotropy = 0.5f;
    metal.anisotropy_rotation = 0.3f;
    Material velvet = {.base_color = {0, 0, 0, 1}, .roughness = 1, .specular_weight = 0};
    velvet.sheen = {1, 1, 1};
    velvet.sheen_roughness = 0.9f;
    const Vec3 a = glm::normalize(Vec3(0.9f, 0.2f, 1)) * 2.0f;
    const Vec3 b = glm::normalize(Vec3(-0.6f, -0.3f, 1)) * 2.0f;
    for (const Material& material : {metal, velvet}) {
        const auto seen = [&](const Vec3& eye, const Vec3& lamp) {
            scene.world.clear();
            scene.place(square, scene.add(material), at({0, 0, 0}));
            scene.shine(PointLight{.intensity = 1, .radius = 0}, at(lamp));
            return scene.radiance(scene.look(eye, {0, 0, 0}, 15, 15)).at(7, 7, 0) / lamp.z;
        };
        CHECK(seen(a, b) > 1e-3f);
        CHECK(seen(a, b) == test::near(seen(b, a)).epsilon(0.02));
    }
}

TEST_CASE(
    "material layers: films without thickness and very thick ones have no colors"
    * technique("shade.thin-film")) {
    const DVec3 f0 = {0.04, 0.04, 0.04};
    Plate plate;
    Material filmed = {.base_color = {0.6f, 0.4f, 0.3f, 1}, .roughness = 0.45f};
    const gpu::FloatImage bare = plate.picture(filmed);
    filmed.iridescence = 1;
    filmed.iridescence_thickness = {0, 0};
    CHECK(largest_difference(plate.picture(filmed), bare) < 1e-4f);
    const DVec3 thick = oracle::thin_film(0.8, 1.3, 9000, f0);
    CHECK(std::abs(thick.x - thick.z) < 1e-3);
    const DVec3 soap = oracle::thin_film(0.8, 1.33, 400, f0);
    CHECK(std::abs(soap.x - soap.z) > 5e-3);
}

}  // namespace limn::test::material_layers_test
