// Bytes into the glTF loader, without a file system: whatever they are, there is a scene or one
// line.

#include "content/load/gltf/gltf_layers.h"
#include "content/load/gltf/gltf_load.h"
#include "ecs/components/all.h"

#include <cmath>
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

void check_deformations(const limn::MeshData& mesh) {
    const std::size_t count = mesh.positions.size();
    const limn::SkinWeights& skin = mesh.skin;
    if (!skin.empty()) {
        require(skin.first.size() == count + 1 && skin.first.front() == 0);
        require(skin.first.back() == skin.joints.size());
        require(skin.joints.size() == skin.weights.size());
        for (std::size_t v = 0; v < count; ++v) {
            float sum = 0;
            for (std::uint32_t i = skin.first[v]; i < skin.first[v + 1]; ++i) {
                require(i == skin.first[v] || skin.joints[i - 1] < skin.joints[i]);
                require(skin.weights[i] > 0);
                sum += skin.weights[i];
            }
            require(std::abs(sum - 1.0f) < 1e-4f);
        }
    }
    for (const limn::VertexRegion& region : mesh.regions) {
        require(region.weights.size() == count);
        require(region.across.empty() || region.across.size() == count);
        for (const float weight : region.weights) {
            require(weight >= 0 && weight <= 1);
        }
        for (const limn::Vec3& across : region.across) {
            const float length = glm::length(across);
            require(length == 0 || std::abs(length - 1.0f) < 1e-3f);
        }
    }
    for (const limn::MorphTarget& morph : mesh.morphs) {
        const std::size_t moving = morph.vertices.size();
        require(morph.positions.size() == moving);
        require(morph.normals.empty() || morph.normals.size() == moving);
        require(morph.tangents.empty() || morph.tangents.size() == moving);
        for (std::size_t i = 0; i < moving; ++i) {
            require(morph.vertices[i] < count);
            require(i == 0 || morph.vertices[i - 1] < morph.vertices[i]);
            for (int k = 0; k < 3; ++k) {
                require(std::isfinite(morph.positions[i][k]));
                require(morph.normals.empty() || std::isfinite(morph.normals[i][k]));
                require(morph.tangents.empty() || std::isfinite(morph.tangents[i][k]));
            }
        }
    }
}

void check_characters(const limn::GltfScene& scene) {
    const std::size_t joints = scene.skeleton.joints.size();
    require(joints == 0 || limn::check_skeleton(scene.skeleton).ok());
    for (const limn::SkinData& skin : scene.skins) {
        require(limn::check_skin(skin, joints).ok());
    }
    for (const limn::ClipData& clip : scene.clips) {
        require(limn::check_clip(clip, joints, scene.morph_weights.size()).ok());
    }
    for (const limn::MeshData& mesh : scene.meshes) {
        check_deformations(mesh);
    }
    for (const limn::GltfNode& node : scene.nodes) {
        for (const limn::GltfPart& part : node.parts) {
            const limn::MeshData& mesh = scene.meshes[part.mesh];
            if (node.first_morph >= 0) {
                const auto first = static_cast<std::size_t>(node.first_morph);
                require(first + mesh.morphs.size() <= scene.morph_weights.size());
            }
            if (node.skin >= 0) {
                const auto skin = static_cast<std::size_t>(node.skin);
                require(skin < scene.skins.size());
                for (const std::uint16_t joint : mesh.skin.joints) {
                    require(joint < scene.skins[skin].joints.size());
                }
            }
        }
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
    check_characters(scene);
    for (const limn::Material& material : scene.materials) {
        for (limn::TextureSlot limn::Material::*const slot : limn::kGltfSlots) {
            const std::uint32_t index = (material.*slot).image.index;
            require(index == limn::kNoAsset || index < scene.images.size());
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
