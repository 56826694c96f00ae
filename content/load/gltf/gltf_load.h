#pragma once

#include "content/load/files/image_load.h"
#include "content/load/files/load_warnings.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace limn {

// Loads untrusted glTF 2.0 files, .gltf or .glb: every size, index, offset and count is checked
// before it is used, a file can reference only files under its own folder, and an error is one
// line: "file: meshes[2].primitives[0].attributes.POSITION: found X, expected Y".
//
// Supported: nodes, meshes of all index types as triangles, strips and fans, vertex colors, two uv
// sets, normalized and sparse accessors, metal-rough materials, textures, samplers, perspective and
// orthographic cameras, KHR_lights_punctual, KHR_materials_emissive_strength, KHR_materials_unlit,
// KHR_materials_transmission, KHR_materials_ior and KHR_materials_volume of transmissive materials,
// KHR_materials_variants, KHR_materials_pbrSpecularGlossiness
// (gltf_glossiness.h), KHR_mesh_quantization, KHR_texture_transform, EXT_mesh_gpu_instancing,
// EXT_meshopt_compression, EXT_texture_webp, MSFT_texture_dds (BC5 and BC7), points and lines
// (gltf_strokes.h), skeletons, skins with any number of joints per vertex, morph targets with their
// action units, named regions of vertices (surface.h), animation clips, our components in
// extras.limn of a node, and relief in those of a material (gltf_material_extras.h). Ignored with a
// warning: lights of unknown type, bytes after a GLB, textures in unsupported image formats, morph
// targets of texture coordinates and colors, other extensions unless they are required.
//
// A bad part costs that part and a warning (load_warnings.h): an image its textures, a channel its
// movement, a skin or an attribute itself; factors are clamped; bad normals and tangents are
// recomputed. Parts that nothing drawn needs may be bad. Rejected: files that are not glTF, buffers
// that are missing or too short, positions and indices out of range, node graphs with cycles.
//
// Missing normals are generated with a crease angle of 50 degrees, not flat as the specification
// demands: models without normals are mostly organic scans and low-poly animals, which look better
// smooth, and boxes keep their edges. Missing tangents: content/bake/tangents.h.
//
// Data flow: gltf_schema.cpp (types and ranges of all values and indices in the JSON) -> tinygltf,
// with the bytes of file_uri.h (gltf_file.cpp) -> gltf_document.h (accessors) -> gltf_material.cpp,
// gltf_mesh.cpp, gltf_deform.cpp, gltf_node.cpp, gltf_animation.cpp, gltf_extras.cpp -> GltfScene.

/// Limits on untrusted files.
struct GltfLimits {
    std::uint64_t max_bytes = std::uint64_t{1} << 30;   ///< of each file
    std::uint64_t max_values = std::uint64_t{1} << 28;  ///< numbers read from all accessors
    std::uint64_t max_pixels = std::uint64_t{1} << 28;  ///< of all images together
    std::size_t max_json_values = 4'000'000;            ///< numbers, strings ... in the JSON
    std::uint32_t max_depth = 256;                      ///< of the node hierarchy
    ImageLimits image;
};

/// Loads `path`. Components of extras.limn must be registered (ecs/components/all.h). `variant`: of
/// its materials, by name; "" is the default. Reports the warnings; see load_warnings.h.
[[nodiscard]] Result<GltfScene> load_gltf(
    const std::string& path, const GltfLimits& limits = {}, const LoadOptions& options = {},
    const std::string& variant = {});

/// The same from memory. `file` is the prefix of messages; URIs are resolved under `folder`, and if
/// that is empty, a reference to another file is an error.
[[nodiscard]] Result<GltfScene> parse_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits = {}, const std::string& variant = {});

}  // namespace limn
