#include "content/app/commands/import_command.h"

#include "content/app/commands/progress.h"
#include "content/load/faces/ict_facekit.h"
#include "content/load/faces/makehuman.h"
#include "content/load/faces/marker_import.h"
#include "content/load/gltf/gltf_write.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <memory>

namespace limn {

Status run_import(const ImportOptions& options) {
    if (options.head && options.kind != "markers") {
        return fail("--head: found {}, expected markers", options.kind);
    }
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    std::unique_ptr<Progress> progress;
    const ImportProgress show = [&](int done, int total) {
        if (progress == nullptr) {
            progress = std::make_unique<Progress>("file", total);
        }
        progress->update(done);
    };
    const MarkerSurface surface = options.head ? make_head_marker_surface() : MarkerSurface{};
    const GltfScene scene = LIMN_TRY(
        options.kind == "markers" ? import_markers(options.in, options.head ? &surface : nullptr)
        : options.kind == "makehuman" ? import_makehuman(options.in, show)
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
    if (options.kind == "markers") {
        fmt::print(
            "{}: {} markers, {} triangles, {:.2f} s\n", options.out, vertices,
            skin.indices.size() / 3, scene.clips[0].duration);
        return Done{};
    }
    fmt::print(
        "{}: {} parts, {} vertices, {} shapes, {} regions{}\n", options.out, scene.meshes.size(),
        vertices, skin.morphs.size(), skin.regions.size(), joints);
    return Done{};
}

}  // namespace limn
