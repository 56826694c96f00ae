#pragma once

#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>

namespace limn {

// The built-in head as a model with its shapes: `limn export head -o head.glb`, and the face of
// `limn speak --face head`.

/// Whether it is a name of make_head_scene.
[[nodiscard]] bool is_head_name(std::string_view name);

/// "head": skin, eyes, teeth and the inside of the mouth; "portrait": with hair.
[[nodiscard]] Result<GltfScene> make_head_scene(std::string_view name);

struct ExportOptions {
    std::string name;  ///< head or portrait
    std::string out;   ///< .glb
};

/// `limn export`: writes the head as a .glb, completely or not at all.
[[nodiscard]] Status run_export(const ExportOptions& options);

}  // namespace limn
