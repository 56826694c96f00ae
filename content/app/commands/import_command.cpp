#include "content/app/commands/import_command.h"

#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/import_markers.h"
#include "content/app/commands/progress.h"
#include "content/load/faces/face_model.h"
#include "content/load/faces/ict_facekit.h"
#include "content/load/faces/makehuman.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/motion/motion_scene.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace limn {
namespace {

Status import_bvh(const ImportOptions& options) {
    BvhImport import;
    LIMN_TRY(set_recipe_fields(options.assignments, import));
    const GltfScene scene = LIMN_TRY(load_bvh_scene(options.in, import));
    LIMN_TRY(save_glb(options.out, scene));
    const std::vector<Affine> rest = find_rest_joints(scene.skeleton);
    Bounds box;
    for (std::size_t j = 1; j < rest.size(); ++j) {
        grow(box, transform_point(rest[j], Vec3(0)));
    }
    const bool has_clip = !scene.clips.empty();
    const std::size_t keys = has_clip ? scene.clips[0].sheets[0].times.size() : 0;
    fmt::print(
        "{}: {} joints, {:.2f} m high, {}\n", options.out, rest.size() - 1, box.max.y - box.min.y,
        keys == 1
            ? "one key: a pose, no motion"
            : fmt::format("{} keys, {:.2f} s", keys, has_clip ? scene.clips[0].duration : 0.0f));
    return Done{};
}

Result<GltfScene> import_face_model(const std::string& path) {
    return make_face_model_scene(
        std::filesystem::path(path).stem().string(), LIMN_TRY(load_face_model(path)));
}

}  // namespace

Status run_import(const ImportOptions& options) {
    if (options.kind == "markers") {
        return import_marker_take(options);
    }
    for (const auto& [option, is_set] :
         {std::pair{"--head", options.head}, std::pair{"--onto", !options.onto.empty()},
          std::pair{"--map", !options.map.empty()}, std::pair{"--patches", options.patches},
          std::pair{"--library", !options.library.empty()},
          std::pair{"--text", !options.text.empty()}, std::pair{"--sound", !options.sound.empty()},
          std::pair{"--labels", !options.labels.empty()}}) {
        if (is_set) {
            return fail("{}: found {}, expected markers", option, options.kind);
        }
    }
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    if (options.kind == "bvh") {
        return import_bvh(options);
    }
    if (!options.assignments.empty()) {
        return fail("--set: found {}, expected bvh", options.kind);
    }
    std::unique_ptr<Progress> progress;
    const ImportProgress show = [&](int done, int total) {
        if (progress == nullptr) {
            progress = std::make_unique<Progress>("file", total);
        }
        progress->update(done);
    };
    const GltfScene scene = LIMN_TRY(
        options.kind == "makehuman"    ? import_makehuman(options.in, show)
        : options.kind == "face-model" ? import_face_model(options.in)
                                       : import_ict_facekit(options.in, show));
    LIMN_TRY(save_glb(options.out, scene));
    progress.reset();

    std::size_t vertices = 0;
    for (const MeshData& mesh : scene.meshes) {
        vertices += mesh.positions.size();
    }
    const MeshData& skin = scene.meshes[0];
    std::string joints;
    if (!scene.skeleton.joints.empty()) {
        joints = fmt::format(", {} joints", scene.skeleton.joints.size() - 1);
    }
    fmt::print(
        "{}: {} parts, {} vertices, {} shapes, {} regions{}\n", options.out, scene.meshes.size(),
        vertices, skin.morphs.size(), skin.regions.size(), joints);
    return Done{};
}

}  // namespace limn
