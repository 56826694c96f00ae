#pragma once

#include "content/load/gltf_scene.h"
#include "content/load/json_document.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace limn {

// Writes scenes as glTF 2.0, binary form: nodes, meshes, sparse morph targets with their action
// units, vertex regions, skins, clips and materials. load_gltf reads an equal scene, numbers to the
// bit, when meshes have their vertices in the order in which triangles use them, and normals and
// tangents; but the parts of a node with several are named after the node.
//
// Our own writer, since the reader is: libraries write morph targets and attributes dense, which is
// ten times the size for faces.

/// The bytes of a .glb. Fails on what is not written: images, lights, cameras, components, keys of
/// clips other than linear translations, other shading models than pbr and unlit.
[[nodiscard]] Result<std::vector<std::byte>> write_glb(const GltfScene& scene);

/// The container: `root` with the one buffer `bytes`, whose size must be a multiple of four. Fails
/// where it is too large for a .glb; `name` is the prefix of the message.
[[nodiscard]] Result<std::vector<std::byte>>
pack_glb(JsonValue root, std::span<const std::byte> bytes, const std::string& name);

/// The bytes of write_glb into a file, which appears complete or not at all.
[[nodiscard]] Status save_glb(const std::string& path, const GltfScene& scene);

}  // namespace limn
