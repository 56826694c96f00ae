#include "content/app/commands/make_command.h"

#include "content/app/commands/model_scene.h"
#include "content/load/gltf/gltf_write.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>

namespace limn {

Status run_make(const MakeOptions& options) {
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    const std::string name = std::filesystem::path(options.out).stem().string();
    const GltfScene scene =
        LIMN_TRY(make_model_scene({options.kind, name, options.parts, options.assignments}));
    std::size_t triangles = 0;
    for (const MeshData& mesh : scene.meshes) {
        triangles += mesh.indices.size() / 3;
    }
    LIMN_TRY(save_glb(options.out, scene));
    std::string rigged;
    if (!scene.skins.empty()) {
        rigged = fmt::format(
            ", {} joints, {} clips", scene.skeleton.joints.size() - 1, scene.clips.size());
    }
    fmt::print(
        "{}: {} meshes, {} triangles{}\n", options.out, scene.meshes.size(), triangles, rigged);
    return Done{};
}

}  // namespace limn
