#pragma once

#include "content/load/json_document.h"
#include "ecs/any_component.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// JSON into components and back, for every type that has visit_fields; level files, extras.limn of
// glTF, the inspector and --set all come through here.
//
//     number         a number, within the field's range; for an angle "45deg" too
//     bool           true, false
//     enum           the enumerator's name: "inverse_square"
//     vector         an array of its length
//     color          linear [r, g, b] or [r, g, b, a], or "#rrggbb", "#rrggbbaa" in sRGB; without
//     a, alpha stays rotation       [x, y, z, w], or [yaw, pitch, roll] in degrees: about y, then
//     x, then z (R = Ry Rx Rz) matrix         an array of its elements, column after column; Affine
//     row after row entity, asset  its name, or null for none struct         an object; fields that
//     it does not name keep their values list           an array; it replaces the list
//
// Nothing is guessed: an unknown field, a wrong type, a number out of range is an error that names
// the place and, where one is near, the name that was meant. What the fields do not say is checked
// here for the few types that need it: a scale is not 0, a cone's inner angle is at most its outer
// one.

/// Whose names a file may use for assets and entities. Empty functions know no names.
struct FindNames {
    /// Index of the asset `name` of `kind`: "mesh", "image", "material".
    std::function<std::optional<std::uint32_t>(std::string_view kind, std::string_view name)> asset;
    /// `at` is where the name stands, for those who can only say later whether it exists.
    std::function<std::optional<Entity>(std::string_view name, SourcePosition at)> entity;
    /// All names of a kind ("entity" is one): for "did you mean".
    std::function<std::vector<std::string_view>(std::string_view kind)> all;
};

/// The other way, for writing. A name that is empty is written as null.
struct GiveNames {
    std::function<std::string(std::string_view kind, std::uint32_t index)> asset;
    std::function<std::string(Entity entity)> entity;
};

/// Where a value belongs, for messages: "FILE:LINE:COLUMN: PATH: found X, expected Y".
struct JsonPlace {
    std::string_view file;
    std::string path;  ///< `entity "lamp": point_light`; grows by the field's name
};

/// The error about `at`; without a PATH when that is empty.
[[nodiscard]] Error error_at(
    const JsonPlace& place, SourcePosition at, std::string_view found, std::string_view expected);

/// Sets the fields that the object `json` names; the others stay. `object` is of type `info`. After
/// an error some may be set: work on a copy.
[[nodiscard]] Status read_component(
    const JsonValue& json, const ComponentInfo& info, void* object, const JsonPlace& place,
    const FindNames& names);

/// Defaults, then the fields that `json` names.
[[nodiscard]] Result<AnyComponent> read_component(
    const JsonValue& json, const ComponentInfo& info, const JsonPlace& place,
    const FindNames& names);

/// The same for a type of the program: `read_struct(json, material, place, names)`.
template <typename T>
[[nodiscard]] Status
read_struct(const JsonValue& json, T& object, const JsonPlace& place, const FindNames& names) {
    return read_component(json, component_info<T>(), &object, place, names);
}

/// One field: `field` points at it.
[[nodiscard]] Status read_field(
    const JsonValue& json, const FieldInfo& info, void* field, const JsonPlace& place,
    const FindNames& names);

/// All fields of `object`, so that reading them into any value of the type gives `object`.
[[nodiscard]] JsonValue
write_component(const ComponentInfo& info, const void* object, const GiveNames& names);
[[nodiscard]] JsonValue
write_field(const FieldInfo& info, const void* field, const GiveNames& names);

/// Calls `visit` with every asset id in the value, and its kind.
void for_each_asset(
    const std::vector<FieldInfo>& fields, void* object,
    const std::function<void(std::string_view kind, std::uint32_t& index)>& visit);

/// Rotation of [yaw, pitch, roll] in degrees: about y, then x, then z of the rotated frame.
[[nodiscard]] Quat rotation_from_degrees(const Vec3& yaw_pitch_roll);

}  // namespace limn
