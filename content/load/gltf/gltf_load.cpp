#include "content/load/gltf/gltf_load.h"

#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>

namespace limn {

namespace {

/// Smallest joint count of the skins that draw each mesh; 0 = it is not skinned.
std::vector<std::size_t> common_joints(const GltfDocument& document) {
    std::vector<std::size_t> counts(document.model.meshes.size(), 0);
    for (const tinygltf::Node& node : document.model.nodes) {
        if (node.mesh >= 0 && node.skin >= 0) {
            const std::size_t joints = item_at(document.model.skins, node.skin).joints.size();
            std::size_t& count = counts[static_cast<std::size_t>(node.mesh)];
            count = count == 0 ? joints : std::min(count, joints);
        }
    }
    return counts;
}

/// The parts of a mesh; `uses_default` is set if one has no material.
Result<std::vector<GltfPart>> build_parts(
    GltfDocument& document, std::size_t mesh, std::size_t joints, GltfScene& scene,
    bool& uses_default) {
    const auto default_material = static_cast<std::uint32_t>(document.model.materials.size());
    const std::vector<tinygltf::Primitive>& primitives = document.model.meshes[mesh].primitives;
    std::vector<GltfPart> parts;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        std::optional<MeshData> data = LIMN_TRY(build_mesh(document, mesh, i, joints));
        if (data) {
            const int material = primitives[i].material;
            uses_default = uses_default || material < 0;
            parts.push_back(
                {static_cast<std::uint32_t>(scene.meshes.size()),
                 material >= 0 ? static_cast<std::uint32_t>(material) : default_material});
            scene.meshes.push_back(*std::move(data));
        }
    }
    return parts;
}

/// Builds all meshes; drops the default material unless something uses it. A bad mesh matters only
/// if a node of the scene uses it.
GltfParts build_meshes(GltfDocument& document, GltfScene& scene) {
    const std::vector<std::size_t> joints = common_joints(document);
    bool uses_default = false;
    GltfParts parts(joints.size());
    for (std::size_t mesh = 0; mesh < parts.size(); ++mesh) {
        if (find_bad_part(document, "meshes", mesh) != nullptr) {
            continue;
        }
        const std::size_t before = scene.meshes.size();
        Result<std::vector<GltfPart>> built =
            build_parts(document, mesh, joints[mesh], scene, uses_default);
        if (built) {
            parts[mesh] = *std::move(built);
            continue;
        }
        scene.meshes.resize(before);
        const std::string part = fmt::format("meshes[{}]", mesh);
        document.bad_parts.emplace(part, built.error().message.substr(document.file.size() + 2));
        warn_of_loss(document, built.error(), part + " is left out");
    }
    if (!uses_default) {
        scene.materials.pop_back();
    }
    return parts;
}

Result<GltfScene> parse(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits, const std::string& variant) {
    GltfDocument document = LIMN_TRY(open_gltf(bytes, file, folder, limits));
    GltfScene scene;
    scene.name = std::filesystem::path(file).stem().string();
    LIMN_TRY(choose_variant(document, variant, scene));
    LIMN_TRY(build_materials(document, scene));
    const GltfParts parts = build_meshes(document, scene);
    LIMN_TRY(build_nodes(document, parts, scene));
    LIMN_TRY(build_animations(document, scene));
    LIMN_TRY(read_extras(document, scene));
    scene.warnings = std::move(document.warnings);
    return scene;
}

}  // namespace

Result<GltfScene> parse_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits, const std::string& variant) {
    try {
        return parse(bytes, file, folder, limits, variant);
    } catch (const std::exception& exception) {  // out of memory, or thrown by a library
        return fail("{}: cannot be loaded: {}", file, exception.what());
    }
}

Result<GltfScene> load_gltf(
    const std::string& path, const GltfLimits& limits, const LoadOptions& options,
    const std::string& variant) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, limits.max_bytes));
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    GltfScene scene =
        LIMN_TRY(parse_gltf(bytes, path, folder.empty() ? "." : folder.string(), limits, variant));
    LIMN_TRY(report_load_warnings(path, scene.warnings, options));
    return scene;
}

}  // namespace limn
