#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn {

// Writes scenes as glTF 2.0, binary form: nodes, meshes, sparse morph targets with their action
// units, vertex regions, skins, clips with their contacts and events, materials and images, as PNG.
// load_gltf reads an equal scene, numbers to the bit, when meshes have their vertices in the order
// in which triangles use them, and normals and tangents; but the parts of a node with several are
// named after the node.
//
// Morph targets and regions are sparse: dense ones are ten times the size for faces.

/// The bytes of a .glb. Fails on what is not written: images of floats, lights, cameras,
/// components, morph weights of clips, other shading models than pbr and unlit. Of the textures,
/// those of the core of glTF are written: base color, metalness and roughness, normal, occlusion,
/// emission.
[[nodiscard]] Result<std::vector<std::byte>> write_glb(const GltfScene& scene);

/// The bytes of write_glb into a file, which appears complete or not at all.
[[nodiscard]] Status save_glb(const std::string& path, const GltfScene& scene);

}  // namespace limn
