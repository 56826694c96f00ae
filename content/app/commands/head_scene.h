#pragma once

#include "content/app/commands/command_values.h"
#include "content/load/gltf/gltf_scene.h"
#include "ecs/base/result.h"

#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The built-in head and people as models with their shapes: `limn export head -o head.glb`,
// `limn export person -o person.glb`, and the face of `limn speak --face head`.

/// Whether it is a name of make_head_scene.
[[nodiscard]] bool is_head_name(std::string_view name);

/// "head": skin, eyes, teeth and the inside of the mouth; "portrait": with hair.
[[nodiscard]] Result<GltfScene> make_head_scene(std::string_view name);

/// A dressed person with the materials of skin, eyes, hair, cloth and leather. `assignments`: of
/// its parameters (person.h).
[[nodiscard]] Result<GltfScene> make_person_scene(const std::vector<Assignment>& assignments);

struct ExportOptions {
    std::string name;                          ///< head, portrait or person
    std::string out;                           ///< .glb
    std::vector<Assignment> assignments = {};  ///< FIELD=VALUE of a person
};

/// `limn export`: writes the model as a .glb, completely or not at all.
[[nodiscard]] Status run_export(const ExportOptions& options);

}  // namespace limn
