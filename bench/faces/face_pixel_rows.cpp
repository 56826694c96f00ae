#include "bench/faces/face_drawing.h"
#include "bench/faces/face_rows.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/wrinkle.h"
#include "ecs/query.h"
#include "render/render_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

// A cheek and a forehead that fill the image, as plain PBR and as skin that wrinkles. The cost of a
// pixel is the slope between two image sizes, in which the cost per frame, for vertices and
// shadows, cancels. Times are summed over all threads, since a software OpenGL uses several.

namespace limn::bench {
namespace {

constexpr IVec2 kSmall = {320, 180};
constexpr IVec2 kLarge = {960, 540};
constexpr double kPixelLimit = 1.25;  ///< of wrinkled skin without diffusion to plain PBR

struct Look {
    std::string name;
    ShadingModel shading;
    bool wrinkles;
    bool diffusion;
    double limit;
};

/// The first is the reference for the others.
const Look kLooks[] = {
    {"plain PBR with a normal map", ShadingModel::Pbr, false, false, 0},
    {"PBR that wrinkles", ShadingModel::Pbr, true, false, kPixelLimit},
    {"skin that wrinkles, no diffusion", ShadingModel::Subsurface, true, false, kPixelLimit},
    {"skin that wrinkles, diffusion", ShadingModel::Subsurface, true, true, 0}};

/// Sets the skin of the level to `look`.
void dress(Stage& stage, const Look& look) {
    auto& assets = stage.world.resource<Assets>();
    for (Material& material : assets.materials) {
        if (material.shading != ShadingModel::Subsurface) {
            continue;
        }
        material.shading = look.shading;
        if (look.shading == ShadingModel::Pbr) {
            material.pigments = Pigments::None;
            material.base_color = {0.6f, 0.4f, 0.3f, 1};
        }
        if (!look.diffusion) {
            material.scatter = {0, 0, 0};
        }
        if (!look.wrinkles) {
            material.wrinkle_texture = {};
        }
    }
    ++assets.material_version;
    stage.world.query<WrinkleSurface>().each([&](WrinkleSurface& surface) {
        surface.method = look.wrinkles ? surface.method : WrinkleMethod::None;
    });
}

Result<Drawing> make_drawing(const Look& look) {
    Drawing drawing;
    drawing.stage =
        LIMN_TRY(open_stage("portrait", {.show = {.technique = "wrinkle.compression.face-model"}}));
    drawing.headless = LIMN_TRY(create_headless_renderer());
    Stage& stage = *drawing.stage;
    dress(stage, look);
    step_stage(stage);
    step_stage(stage);
    const Affine eye = look_at({0, 1.555f, 0.2f}, {0, 1.555f, 0});
    stage.world.get<WorldTransform>(stage.scene.camera).world = eye;
    stage.world.get<PreviousWorldTransform>(stage.scene.camera).world = eye;
    warm_up_world(drawing.headless, stage.world, stage.scene.camera, kLarge);
    return drawing;
}

/// Time of a pixel, as that of a million of them [ms].
Result<double> time_of_pixels(const Look& look, int repeats) {
    Drawing drawing = LIMN_TRY(make_drawing(look));
    double small = INFINITY;
    double large = INFINITY;
    for (int i = 0; i < repeats; ++i) {
        small = std::min(small, drawing.draw(kSmall));
        large = std::min(large, drawing.draw(kLarge));
    }
    return (large - small) * 1e6 / static_cast<double>(kLarge.x * kLarge.y - kSmall.x * kSmall.y);
}

}  // namespace

Status add_pixel_rows(FaceBench& bench) {
    const int repeats = std::min(bench.repeats, 15);
    double plain = 0;
    for (const Look& look : kLooks) {
        const double time = LIMN_TRY(time_of_pixels(look, repeats));
        plain = plain == 0 ? time : plain;
        bench.add(FaceRow{
            fmt::format("1e6 pixels, {}", look.name), time, plain, "plain PBR", look.limit, true});
    }
    return Done{};
}

}  // namespace limn::bench
