#include "content/load/gltf_load.h"

#include "content/load/atomic_file.h"
#include "content/load/gltf_animation.h"
#include "content/load/gltf_document.h"
#include "content/load/gltf_extras.h"
#include "content/load/gltf_material.h"
#include "content/load/gltf_mesh.h"
#include "content/load/gltf_node.h"
#include "ecs/base/log.h"

#include <algorithm>
#include <exception>
#include <filesystem>

namespace limn {

namespace {

constexpr std::size_t kMaxWarnings = 10;  ///< that are logged

/// All meshes; the default material stays only where something uses it.
Result<GltfParts> build_meshes(GltfDocument& document, GltfScene& scene) {
    const auto default_material = static_cast<std::uint32_t>(scene.materials.size() - 1);
    bool uses_default = false;
    GltfParts parts(document.model.meshes.size());
    for (std::size_t mesh = 0; mesh < parts.size(); ++mesh) {
        const std::vector<tinygltf::Primitive>& primitives = document.model.meshes[mesh].primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            Result<std::optional<MeshData>> data = build_mesh(document, mesh, i);
            if (!data) {
                return data.error();
            }
            if (data->has_value()) {
                const int material = primitives[i].material;
                uses_default = uses_default || material < 0;
                parts[mesh].push_back(
                    {static_cast<std::uint32_t>(scene.meshes.size()),
                     material >= 0 ? static_cast<std::uint32_t>(material) : default_material});
                scene.meshes.push_back(std::move(**data));
            }
        }
    }
    if (!uses_default) {
        scene.materials.pop_back();
    }
    return parts;
}

Result<GltfScene> parse(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits) {
    Result<GltfDocument> document = open_gltf(bytes, file, folder, limits);
    if (!document) {
        return document.error();
    }
    GltfScene scene;
    scene.name = std::filesystem::path(file).stem().string();
    if (Status status = build_materials(*document, scene); !status) {
        return status.error();
    }
    const Result<GltfParts> parts = build_meshes(*document, scene);
    if (!parts) {
        return parts.error();
    }
    if (Status status = build_nodes(*document, *parts, scene); !status) {
        return status.error();
    }
    if (Status status = build_animations(*document, scene); !status) {
        return status.error();
    }
    if (Status status = read_extras(*document, scene); !status) {
        return status.error();
    }
    scene.warnings = std::move(document->warnings);
    return scene;
}

}  // namespace

Result<GltfScene> parse_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits) {
    try {
        return parse(bytes, file, folder, limits);
    } catch (const std::exception& exception) {  // memory, and what libraries throw
        return fail("{}: cannot be loaded: {}", file, exception.what());
    }
}

Result<GltfScene> load_gltf(const std::string& path, const GltfLimits& limits) {
    const Result<std::vector<std::byte>> bytes = read_file(path, limits.max_bytes);
    if (!bytes) {
        return bytes.error();
    }
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    Result<GltfScene> scene =
        parse_gltf(*bytes, path, folder.empty() ? "." : folder.string(), limits);
    if (scene) {
        const std::size_t shown = std::min(scene->warnings.size(), kMaxWarnings);
        for (std::size_t i = 0; i < shown; ++i) {
            log_warn("{}", scene->warnings[i]);
        }
        if (scene->warnings.size() > shown) {
            log_warn("{}: {} more warnings", path, scene->warnings.size() - shown);
        }
    }
    return scene;
}

}  // namespace limn
