#include "ecs/components/rendering.h"
#include "render/graph/frame_graph.h"
#include "render/material/shading_fields.h"
#include "render/material/shading_models.h"
#include "render/variant.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::test::shading_models_test {
namespace {

std::set<std::string> definitions_of(std::initializer_list<ShadingModel> models) {
    ShadingModelSet set = 0;
    for (const ShadingModel model : models) {
        set |= 1u << stored_number(model);
    }
    Variant variant;
    add_shading_models(variant, set);
    std::set<std::string> names;
    for (const gpu::ShaderDefine& define : variant.definitions()) {
        names.insert(define.name);
    }
    return names;
}

Material colored(ShadingModel model) {
    return {
        .shading = model,
        .base_color = {0.8f, 0.5f, 0.3f, 1},
        .metalness = 0.3f,
        .roughness = 0.4f,
        .specular = {0.3f, 0.4f, 0.5f},
        .shininess = 12};
}

/// Every model of the table.
const std::vector<std::optional<ShadingModel>> kAllModels = [] {
    std::vector<std::optional<ShadingModel>> models;
    for (const ShadingModelRow& row : kShadingModels) {
        models.emplace_back(row.model);
    }
    return models;
}();

constexpr int kFirstBall = 266;  // a column
constexpr int kBallRow = 80;

/// Balls in a row under a lamp, one for each model, with something to reflect; the first is visible
/// around pixel kFirstBall, the others 12 pixels apart. A gap for each nullopt.
class Balls : public Scene {
  public:
    explicit Balls(const std::vector<std::optional<ShadingModel>>& models) {
        const MeshId ball = add(make_ball(16));
        for (std::size_t i = 0; i < models.size(); ++i) {
            if (models[i]) {
                const float x = -5.4f + 1.2f * static_cast<float>(i);
                place(
                    ball, add(colored(*models[i])),
                    affine_from({x, 0, 0}, {1, 0, 0, 0}, Vec3(0.55f)));
            }
        }
        shine(PointLight{.intensity = 30, .radius = 0}, at({1, 2, 3}));
        world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0.1f, 0.2f, 0.3f}});
    }
    gpu::FloatImage picture(LightMethod method) {
        world.insert_resource(Rendering{method});
        return radiance(look({0, 0, 8}, {0, 0, 0}, 640, 160));  // 10 pixels per meter
    }
};

/// The square of side 2 with one material, under a lamp.
gpu::FloatImage lit_square(const Material& material, std::size_t materials_before) {
    Scene scene;
    for (std::size_t i = 0; i < materials_before; ++i) {
        scene.add(colored(ShadingModel::Phong));
    }
    scene.place(scene.add(make_square()), scene.add(material), at({0, 0, 0}));
    scene.shine(PointLight{.intensity = 4, .radius = 0}, at({0.3f, 0.2f, 1}));
    return scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 16, 16));
}

}  // namespace

TEST_CASE("shading models: every row has its file, and every file its row") {
    std::set<std::string> rows;
    for (const ShadingModelRow& row : kShadingModels) {
        rows.insert(std::string("shade_") + row.name + ".glsl");
    }
    rows.insert(std::string("shade_") + kLayeredRow.name + ".glsl");
    std::set<std::string> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(LIMN_SOURCE_DIR "/render/shaders")) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("shade_")) {
            files.insert(name);
        }
    }
    CHECK(rows == files);
}

TEST_CASE("shading models: a program has the models of the level's materials, and no others") {
    CHECK(definitions_of({ShadingModel::Pbr}).empty());
    CHECK(
        definitions_of({ShadingModel::Pbr, ShadingModel::Unlit})
        == std::set<std::string>{"SHADE_UNLIT"});
    CHECK(
        definitions_of({ShadingModel::Pbr, ShadingModel::Skin})
        == std::set<std::string>{"MATERIAL_RECORDS", "SHADE_SKIN"});
}

TEST_CASE(
    "shading models: models with the same lobe are lit together, others separately"
    * technique("deferred.light-pass")) {
    ShadingModelSet all = 0;
    ShadingModelSet lobes = 0;
    for (const ShadingModelRow& a : kShadingModels) {
        for (const ShadingModelRow& b : kShadingModels) {
            CHECK(
                (lobe_number(a.model) == lobe_number(b.model))
                == (std::string_view(a.lobe) == b.lobe));
        }
        all |= 1u << stored_number(a.model);
        lobes |= 1u << lobe_number(a.model);
    }
    CHECK(lobes_of(all) == lobes);
    CHECK(
        lobes_of(1u << stored_number(ShadingModel::Unlit)) == 1u << lobe_number(ShadingModel::Pbr));
}

TEST_CASE("shading models: each looks the same lit deferred, forward or light by light") {
    Balls balls(kAllModels);
    const gpu::FloatImage clustered = balls.picture(LightMethod::Clustered);
    for (const LightMethod method :
         {LightMethod::FullScreen, LightMethod::Volumes, LightMethod::ObjectMajor,
          LightMethod::LightMajor}) {
        CAPTURE(static_cast<int>(method));
        const gpu::FloatImage other = balls.picture(method);
        float worst = 0;
        for (std::size_t i = 0; i < other.pixels.size(); ++i) {
            const float a = clustered.pixels[i];
            worst = std::max(worst, std::abs(a - other.pixels[i]) / (0.05f + a));
        }
        CHECK(worst <= 1e-3f);
    }
}

TEST_CASE("shading models: another value of a field changes only the models that read it") {
    Balls balls(kAllModels);
    auto& assets = balls.world.resource<Assets>();
    const std::vector<Material> materials = assets.materials;
    const ImageId half = balls.add(
        ImageData{.name = "half", .width = 1, .height = 1, .pixels = {128, 128, 128, 255}});
    const std::pair<const char*, std::function<void(Material&)>> changes[] = {
        {"base_color", [](Material& m) { m.base_color.y = 0.2f; }},
        {"emission",
         [](Material& m) {
             m.emission = {1, 0, 0};
         }},
        {"metalness", [](Material& m) { m.metalness = 0.8f; }},
        {"roughness", [](Material& m) { m.roughness = 0.8f; }},
        {"metal_rough_texture", [half](Material& m) { m.metal_rough_texture.image = half; }},
        {"specular",
         [](Material& m) {
             m.specular = {0.9f, 0.1f, 0.1f};
         }},
        {"shininess", [](Material& m) { m.shininess = 60; }},
        {"skin_color",
         [](Material& m) {
             m.skin_color = {0.1f, 0.6f, 0.2f};
         }},
        {"wide_rim", [](Material& m) { m.wide_rim = true; }},
        {"roughness_across", [](Material& m) { m.roughness_across = 0.7f; }},
        {"scale_tilt", [](Material& m) { m.scale_tilt = 0.3f; }},
        {"hair_scatter", [](Material& m) { m.hair_scatter = 0.1f; }},
        {"clearcoat", [](Material& m) { m.clearcoat = 1; }},
        {"sheen",
         [](Material& m) {
             m.sheen = {1, 1, 1};
         }},
        {"specular_weight", [](Material& m) { m.specular_weight = 0; }},
        {"anisotropy", [](Material& m) { m.anisotropy = 1; }},
        {"iridescence", [](Material& m) { m.iridescence = 1; }},
    };
    // Something that a rough surface mirrors otherwise than a smooth one.
    balls.world.insert_resource(Environment{.sky = SkyKind::Gradient});
    const gpu::FloatImage plain = balls.picture(LightMethod::Clustered);
    for (const auto& one : changes) {
        const std::string field = one.first;
        assets.materials = materials;
        std::for_each(assets.materials.begin(), assets.materials.end(), one.second);
        ++assets.material_version;
        const gpu::FloatImage changed = balls.picture(LightMethod::Clustered);
        for (std::size_t i = 0; i < std::size(kShadingModels); ++i) {
            float difference = 0;
            const int middle = kFirstBall + 12 * static_cast<int>(i);
            for (int y = 0; y < plain.height; ++y) {
                for (int x = middle - 4; x < middle + 4; ++x) {  // perspective draws balls out
                    const Vec3 apart = rgb_at(plain, x, y) - rgb_at(changed, x, y);
                    difference = std::max(difference, glm::length(apart));
                }
            }
            CAPTURE(field);
            CAPTURE(std::string(kShadingModels[i].name));
            CAPTURE(difference);
            CHECK((difference > 1e-3f) == reads_field(kShadingModels[i].model, field));
        }
    }
}

TEST_CASE("shading models: no two look alike") {
    std::set<std::vector<float>> looks;
    for (const ShadingModelRow& row : kShadingModels) {
        looks.insert(Balls({row.model}).picture(LightMethod::Clustered).pixels);
    }
    CHECK(looks.size() == std::size(kShadingModels));
}

TEST_CASE("shading models: no model affects the others") {
    const gpu::FloatImage all = Balls(kAllModels).picture(LightMethod::Clustered);
    for (std::size_t i = 0; i < kAllModels.size(); ++i) {
        CAPTURE(kShadingModels[i].name);
        std::vector<std::optional<ShadingModel>> alone(kAllModels.size());
        alone[i] = kAllModels[i];
        const gpu::FloatImage one = Balls(alone).picture(LightMethod::Clustered);
        const int x = kFirstBall + 12 * static_cast<int>(i);
        for (int y = kBallRow - 3; y < kBallRow + 3; ++y) {
            for (int c = 0; c < 3; ++c) {
                CHECK(one.at(x, y, c) > 0.01f);
                CHECK(one.at(x, y, c) == test::near(all.at(x, y, c)).epsilon(1e-4));
            }
        }
    }
}

TEST_CASE_FIXTURE(
    Scene, "shading models: only those that read records store the material"
               * technique("deferred.gbuffer")) {
    const MeshId square = add(make_square());
    place(square, add(Material{}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    draw(view);
    CHECK(!frame_graph(shared_renderer()).find("gbuffer.material").valid());
    add(colored(ShadingModel::Blinn));
    draw(view);
    CHECK(frame_graph(shared_renderer()).find("gbuffer.material").valid());
}

TEST_CASE("shading models: the record is found however many materials there are") {
    const Material shiny = colored(ShadingModel::Blinn);
    const gpu::FloatImage first = lit_square(shiny, 0);
    CHECK(first.at(8, 8, 0) > 0.1f);
    CHECK(lit_square(shiny, 70000).pixels == first.pixels);
}

}  // namespace limn::test::shading_models_test
