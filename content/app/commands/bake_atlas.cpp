#include "content/app/commands/bake_atlas.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/bake/scene_atlas.h"
#include "content/game/game.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/scene_mesh.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <string>

// Techniques: engine.texture-atlas

namespace limn {

struct AtlasRecipe {
    int max_size = 8192;
    float gutter = 16;
};

LIMN_FIELDS(AtlasRecipe) {
    LIMN_FIELD(max_size, "width and height of an atlas at most", "px", 16, 16384);
    LIMN_FIELD(gutter, "around each texture, of 512 pixels of its cell", "px", 0, 128);
}

namespace {

/// What glTF files of ours do not have is left out, with a line each.
void drop_unwritten(const std::string& path, GltfScene& scene) {
    for (GltfNode& node : scene.nodes) {
        if (node.has_camera || node.light.index() != 0 || !node.components.empty()) {
            log_warn(
                "{}: node {}: its camera, light or components are left out", path,
                in_quotes(node.name));
        }
        node.has_camera = false;
        node.light = {};
        node.components.clear();
    }
    if (!scene.variants.empty()) {
        log_warn("{}: variants of materials are left out", path);
        scene.variants.clear();
    }
}

}  // namespace

Status bake_atlas(const BakeOptions& options) {
    AtlasRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    register_game_components();
    GltfScene scene = LIMN_TRY(load_model_scene(options.in));
    drop_unwritten(options.in, scene);
    const SceneAtlasReport report =
        merge_materials(scene, {.max_size = recipe.max_size, .gutter = recipe.gutter});
    for (const std::string& line : report.notes) {
        log_warn("{}: {}", options.in, line);
    }
    if (report.materials == report.materials_before) {
        return fail(
            "{}: found no two materials that differ only in their textures, expected some",
            options.in);
    }
    LIMN_TRY(save_glb(options.out, scene));
    fmt::print(
        "{}: {} materials instead of {}, {} images instead of {}\n", options.out, report.materials,
        report.materials_before, report.images, report.images_before);
    return Done{};
}

}  // namespace limn
