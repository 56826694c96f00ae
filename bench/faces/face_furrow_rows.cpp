#include "bench/faces/face_drawing.h"
#include "bench/faces/face_rows.h"
#include "content/app/panels/furrow_edits.h"
#include "ecs/base/text.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "render/geometry/culling.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Table 6.1 of Y. Bando, "Human Skin Simulation by Generating Wrinkles along Vector Fields", 2001:
// frames per second at 512 x 512 of a hand, a foot and an arm, by Blinn's model and two fitted
// BRDFs, on an Athlon of 1 GHz with a GeForce. His machine and ours have nothing in common but the
// ratios of the models to Blinn's, which are printed beside his.

namespace limn::bench {
namespace {

constexpr IVec2 kImage = {512, 512};  ///< as in the table

struct Figure {
    const char* body;
    const char* number;
    std::array<double, 3> fps;  ///< by Blinn, BRDF 1, BRDF 2
};

constexpr Figure kFigures[] = {
    {"hand", "6.1", {19.0, 14.8, 14.3}},
    {"foot", "6.2", {18.2, 18.2, 16.0}},
    {"arm", "6.3", {10.5, 6.2, 5.3}}};

constexpr std::array kModels = {
    FurrowReflection::Own, FurrowReflection::Brdf1, FurrowReflection::Brdf2};
constexpr std::array kModelNames = {"Blinn", "BRDF 1", "BRDF 2"};

/// Fills the view with a body, and returns its material; nullptr: the level lacks it.
Material* face_body(Stage& stage, const char* body) {
    World& world = stage.world;
    auto& assets = world.resource<Assets>();
    Material* material = nullptr;
    world.query<const Name, const MeshInstance, const WorldTransform>().each(
        [&](const Name& name, const MeshInstance& instance, const WorldTransform& transform) {
            if (name.text != body || instance.material.index >= assets.materials.size()) {
                return;
            }
            material = &assets.materials[instance.material.index];
            const Bounds box =
                transform_bounds(transform.world, assets.meshes[instance.mesh.index].bounds);
            const Vec3 front = center(box) + Vec3(0, 0, 3.2f * half_extent(box).y + 0.05f);
            const Affine eye = look_at(front, center(box));
            world.get<WorldTransform>(stage.scene.camera).world = eye;
            world.get<PreviousWorldTransform>(stage.scene.camera).world = eye;
        });
    return material;
}

}  // namespace

Status add_furrow_rows(FaceBench& bench) {
    Drawing drawing;
    drawing.stage = LIMN_TRY(open_stage("furrows", {}));
    drawing.headless = LIMN_TRY(create_headless_renderer());
    step_stage(*drawing.stage);
    step_stage(*drawing.stage);
    for (const Figure& figure : kFigures) {
        std::array<double, kModels.size()> times{};
        times.fill(INFINITY);
        for (int i = 0; i < std::min(bench.repeats, 15); ++i) {
            for (std::size_t m = 0; m < kModels.size(); ++m) {
                Material* const material = face_body(*drawing.stage, figure.body);
                if (material == nullptr) {
                    return fail("furrows: found no entity {} with a material", figure.body);
                }
                FurrowLook look = furrow_look_of(*material);
                look.reflection = kModels[m];
                set_furrow_look(*material, look);
                ++drawing.stage->world.resource<Assets>().material_version;
                (void)drawing.draw(kImage);  // compiles and uploads
                times[m] = std::min(times[m], drawing.draw(kImage));
            }
        }
        for (std::size_t m = 0; m < kModels.size(); ++m) {
            bench.add(FaceRow{
                fmt::format(
                    "{} {}, {} ({:.1f} fps there, ratio {:.2f})", figure.body, figure.number,
                    kModelNames[m], figure.fps[m], figure.fps[0] / figure.fps[m]),
                times[m], times[0], "Blinn", 0, true});
        }
    }
    return Done{};
}

}  // namespace limn::bench
