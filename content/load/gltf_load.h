#pragma once

#include "content/load/gltf_scene.h"
#include "content/load/image_load.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

// glTF 2.0, as .gltf with its files or as .glb, from anybody: every size, index, offset and count
// is checked before it is used, a file can name only files under its own folder, and one line says
// what is wrong: "file: meshes[2].primitives[0].attributes.POSITION: found X, expected Y".
//
// Understood: nodes, meshes of all index types as triangles, strips and fans, vertex colors, two uv
// sets, normalized and sparse accessors, metal-rough materials, textures, samplers, perspective
// cameras, KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_unlit,
// KHR_mesh_quantization, KHR_texture_transform, skeletons, skins of any number of joints a vertex,
// morph targets, clips of all of them, and our components in extras.limn of a node. Left out, with
// a warning: points and lines, orthographic cameras, textures without an image we can read, morph
// targets of texture coordinates and colors.
//
// Missing normals are made with a crease angle of 50 degrees instead of flat, as the specification
// has it: models without normals are mostly organic scans and low-poly animals, which gain, and
// boxes stay boxes. Missing tangents: content/bake/tangents.h.
//
// The way of a file: gltf_file.h (container and URIs) -> gltf_schema.h (every value has the right
// type and every index a target) -> tinygltf (structs; it never sees a URI or an image) ->
// gltf_accessor.h, gltf_material.h, gltf_mesh.h, gltf_deform.h, gltf_node.h, gltf_animation.h,
// gltf_extras.h -> GltfScene.

/// What a file may cost.
struct GltfLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;  ///< of each file
    std::uint64_t max_values = std::uint64_t{1}
                               << 28;  ///< numbers read from accessors, all together
    std::uint64_t max_pixels = std::uint64_t{1} << 28;  ///< of all images together
    std::size_t max_json_values = 4'000'000;            ///< numbers, strings ... in the JSON
    std::uint32_t max_depth = 256;                      ///< nodes in each other
    ImageLimits image;
};

/// Loads `path`. Components of extras.limn must be registered (ecs/components/all.h). Logs the
/// warnings.
[[nodiscard]] Result<GltfScene> load_gltf(const std::string& path, const GltfLimits& limits = {});

/// The same from memory. `file` begins the messages; other files are looked for under `folder`, or
/// not at all when it is empty: then naming one is an error.
[[nodiscard]] Result<GltfScene> parse_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits = {});

}  // namespace limn
