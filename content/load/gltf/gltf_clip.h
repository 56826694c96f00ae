#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace limn {

// Adds an animation to a glTF file without changing anything else in it: meshes, images, lights and
// extensions are kept, whether this engine reads them or not.

/// A morph target.
struct GltfShape {
    std::string name;
    std::string action_unit;  ///< of FACS, "AU12" or a half "AU12_L"; or ""
};

/// A node with morph targets.
struct GltfFaceNode {
    std::uint32_t node = 0;  ///< index in the file
    std::vector<GltfShape> shapes;
};

/// The parts of a file that an animated face needs.
struct GltfFace {
    std::vector<GltfFaceNode> nodes;
    /// Node that turns the head: one named "head", or else the root of a file without skins that
    /// has only one.
    std::optional<std::uint32_t> head;
    Quat head_rotation{1, 0, 0, 0};  ///< at rest
};

/// Keys at common times for weights and the head.
struct GltfFaceClip {
    std::string name;
    std::vector<float> times;  ///< [s], increasing
    /// For each of GltfFace::nodes: rows of as many weights as it has shapes, one row per time.
    std::vector<std::vector<float>> weights;
    std::vector<Quat> head_rotations;  ///< one per time; ignored without a head
};

/// Fails with one line when the file is broken, as load_gltf does, or has no morph targets.
[[nodiscard]] Result<GltfFace> read_gltf_face(const std::string& path);

/// The file `path` as a .glb that holds everything it refers to, with the clip as its first
/// animation. `face` must be the file's.
[[nodiscard]] Result<std::vector<std::byte>>
add_face_clip(const std::string& path, const GltfFace& face, const GltfFaceClip& clip);

}  // namespace limn
