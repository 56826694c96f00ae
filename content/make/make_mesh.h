#pragma once

#include "content/make/find_kind.h"
#include "content/make/models/creature.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <span>

namespace limn {

// Procedural meshes that a level requests by name: {"make": "teapot", "divisions": 12}. The
// parameters of a kind are a plain struct with visit_fields; a reader copies the defaults, sets
// fields through ecs/field_access.h (which rejects unknown names and numbers out of range) and
// calls `make`.
//
//     const MeshKind* kind = find_kind(mesh_kinds(), "teapot");
//     TeapotShape shape;                        // or bytes of kind->parameters->size
//     MeshData mesh = kind->make(&shape, assets);
//
// From C++, call make_teapot(TeapotShape{...}) directly.

struct MeshKind {
    const char* name;                 ///< as in levels
    const char* doc;                  ///< one line
    const ComponentInfo* parameters;  ///< fields, defaults, how to construct and destroy
    /// Asset ids in the parameters index `assets`.
    MeshData (*make)(const void* parameters, const Assets& assets);
    MeshRig (*make_rig)(const void* parameters) = nullptr;  ///< null: not skinned
};

/// All kinds, by name.
[[nodiscard]] std::span<const MeshKind> mesh_kinds();

}  // namespace limn
