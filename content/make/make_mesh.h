#pragma once

#include "content/make/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <span>
#include <string>
#include <string_view>

namespace limn {

// The meshes that a level may ask for by name: {"make": "teapot", "divisions": 12}. The parameters
// of a kind are a plain struct with visit_fields; whoever reads files copies the defaults, sets
// fields through ecs/field_access.h (which refuses unknown names and numbers out of range) and
// calls `make`.
//
//     const MeshKind* kind = find_mesh_kind("teapot");
//     TeapotShape shape;                        // or bytes of kind->parameters->size
//     MeshData mesh = kind->make(&shape, assets);
//
// From C++, call make_teapot(TeapotShape{...}) directly.

struct MeshKind {
    const char* name;                 ///< as a level writes it
    const char* doc;                  ///< one line
    const ComponentInfo* parameters;  ///< fields, defaults, how to construct and destroy
    /// What parameters name is looked up in `assets`.
    MeshData (*make)(const void* parameters, const Assets& assets);
    MeshRig (*make_rig)(const void* parameters) = nullptr;  ///< of a mesh that joints move
};

/// All kinds, by name.
[[nodiscard]] std::span<const MeshKind> mesh_kinds();

/// nullptr if there is none.
[[nodiscard]] const MeshKind* find_mesh_kind(std::string_view name);

/// "" or " (did you mean teapot?)", to end a message about an unknown kind.
[[nodiscard]] std::string mesh_kind_suggestion(std::string_view name);

}  // namespace limn
