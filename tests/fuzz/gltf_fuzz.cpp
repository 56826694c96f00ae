// Bytes into the glTF loader, without a file system: whatever they are, there is a scene or one
// line.

#include "content/load/gltf_load.h"
#include "ecs/components/all.h"

#include <cstdlib>
#include <span>

namespace {

constexpr limn::GltfLimits kLimits = {
    .max_bytes = 1 << 20,
    .max_values = 1 << 16,
    .max_pixels = 1 << 14,
    .max_json_values = 1 << 14,
    .max_depth = 64,
    .image = {.max_size = 128, .max_pixels = 1 << 14},
};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

/// What everybody who gets a scene relies on.
void check_scene(const limn::GltfScene& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const limn::GltfNode& node = scene.nodes[i];
        require(node.parent < static_cast<std::int32_t>(i));
        for (const limn::GltfPart& part : node.parts) {
            require(part.mesh < scene.meshes.size() && part.material < scene.materials.size());
        }
    }
    for (const limn::MeshData& mesh : scene.meshes) {
        const std::size_t count = mesh.positions.size();
        require(
            mesh.normals.size() == count && mesh.tangents.size() == count
            && mesh.uvs.size() == count);
        require(mesh.uvs1.empty() || mesh.uvs1.size() == count);
        require(mesh.colors.empty() || mesh.colors.size() == count);
        require(mesh.indices.size() % 3 == 0);
        for (const std::uint32_t index : mesh.indices) {
            require(index < count);
        }
        for (std::size_t v = 0; v < count; ++v) {
            for (int k = 0; k < 3; ++k) {
                require(std::isfinite(mesh.positions[v][k]) && std::isfinite(mesh.normals[v][k]));
                require(std::isfinite(mesh.tangents[v][k]));
            }
        }
    }
    for (const limn::Material& material : scene.materials) {
        for (const limn::TextureSlot* slot :
             {&material.base_color_texture,
              &material.metal_rough_texture,
              &material.normal_texture,
              &material.occlusion_texture,
              &material.emission_texture}) {
            require(slot->image.index == limn::kNoAsset || slot->image.index < scene.images.size());
        }
    }
    (void)limn::find_bounds(scene);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    limn::register_all_components();  // for extras.limn
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    const limn::Result<limn::GltfScene> scene = limn::parse_gltf(bytes, "fuzz.glb", "", kLimits);
    if (scene) {
        check_scene(*scene);
    } else {
        require(scene.error().message.find('\n') == std::string::npos);
    }
    return 0;
}
