#pragma once

#include "content/load/gltf/gltf_write.h"

#include <doctest/doctest.h>

#include <string>
#include <utility>

namespace limn::test {

/// Makes the first mesh of `scene`, which has no nodes or materials yet, a node with a weight of 0
/// for each of its morph targets, and writes it.
inline void write_one_mesh(const std::string& path, GltfScene& scene, std::string node_name) {
    scene.materials.emplace_back();
    GltfNode node;
    node.name = std::move(node_name);
    node.first_morph = 0;
    node.parts = {{0, 0}};
    scene.nodes.push_back(std::move(node));
    scene.morph_weights.assign(scene.meshes[0].morphs.size(), 0.0f);
    const Status saved = save_glb(path, scene);
    REQUIRE_MESSAGE(saved.ok(), (saved ? std::string() : saved.error().message));
}

}  // namespace limn::test
