#pragma once

#include "content/load/files/json_document.h"
#include "ecs/any_component.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/reflect.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Converts JSON to components and back, for every type that has LIMN_FIELDS. Used by level files,
// extras.limn of glTF, the inspector and --set.
//
//     number         a number within the field's range, in its unit, or a string with a
//                    unit: "45deg", "30rpm", "2cm", "36km/h", "8kn", "200ms", "5min", "10klx"
//     bool           true, false
//     enum           the enumerator's name: "inverse_square"
//     vector         an array of its length
//     color          linear [r, g, b] or [r, g, b, a], or "#rrggbb", "#rrggbbaa" in sRGB, or
//                    short "#rgb", "#rgba", or a color of CSS: "orange"; without alpha, the field
//                    keeps its own
//     rotation       [x, y, z, w], or [yaw, pitch, roll] in degrees, or with a unit, about y, then
//                    x, then z (R = Ry Rx Rz)
//     matrix         an array of its elements, column-major; Affine row-major
//     entity, asset  its name, or null for none
//     struct         an object; fields that it does not name keep their values
//     list           an array; it replaces the list
//
// Nothing is guessed: an unknown field, a wrong type or a number out of range is an error that
// gives the position and suggests the most similar name. Constraints beyond the range of a field
// are checked for the few types that have them: a nonzero scale, a cone's inner angle at most its
// outer one.

/// Resolves names of assets and entities. An empty function resolves none.
struct NameResolver {
    // `at` is the position of the name, for the error of a resolver that defers the lookup.
    /// Index of the asset `name` of `kind`: "mesh", "image", "material".
    std::function<std::optional<std::uint32_t>(
        std::string_view kind, std::string_view name, SourcePosition at)>
        asset;
    std::function<std::optional<Entity>(std::string_view name, SourcePosition at)> entity;
    /// All names of a kind ("entity" is one), for "did you mean".
    std::function<std::vector<std::string_view>(std::string_view kind)> all;
};

/// The inverse, for writing. An empty name is written as null.
struct NameProvider {
    std::function<std::string(std::string_view kind, std::uint32_t index)> asset;
    std::function<std::string(Entity entity)> entity;
};

/// Location of a value, for messages: "FILE:LINE:COLUMN: PATH: found X, expected Y".
struct JsonLocation {
    std::string_view file;
    std::string path;  ///< `entity "lamp": point_light`; field names are appended
};

/// The error at position `at`; an empty PATH is omitted.
[[nodiscard]] Error error_at(
    const JsonLocation& location, SourcePosition at, std::string_view found,
    std::string_view expected);

/// The error that `json` is not what is expected.
[[nodiscard]] Error
unexpected(const JsonValue& json, const JsonLocation& location, std::string_view expected);

/// The locations of a member and an item of the value at `location`.
[[nodiscard]] JsonLocation location_in(const JsonLocation& location, std::string_view key);
[[nodiscard]] JsonLocation item_in(const JsonLocation& location, std::size_t index);

/// Fails unless `json` is of `kind`, which the message calls `expected`.
[[nodiscard]] Status expect(
    const JsonValue& json, JsonKind kind, const JsonLocation& location, std::string_view expected);

/// Fails unless `json` is an object with no keys but `known`.
[[nodiscard]] Status expect_keys(
    const JsonValue& json, const JsonLocation& location, std::span<const std::string_view> known,
    std::string_view expected = "an object");

/// Fails unless `json` is a number within the range, or a string with a number and a unit
/// compatible with `unit`.
[[nodiscard]] Result<double> expect_number(
    const JsonValue& json, double min, double max, const JsonLocation& location,
    std::string_view unit = "");

/// What is wrong with the values of fields together: "found a scale of 0, expected ..."; or "".
[[nodiscard]] std::string constraint_error(const ComponentInfo& info, const void* object);

/// Sets the fields that the JSON object names and keeps the others. `object` is of type `info`. On
/// an error some fields may already be set: work on a copy.
[[nodiscard]] Status read_component(
    const JsonValue& json, const ComponentInfo& info, void* object, const JsonLocation& location,
    const NameResolver& names);

/// A default component with the fields that `json` names set.
[[nodiscard]] Result<AnyComponent> read_component(
    const JsonValue& json, const ComponentInfo& info, const JsonLocation& location,
    const NameResolver& names);

/// The same for a type known at compile time: `read_struct(json, material, location, names)`.
template <typename T>
[[nodiscard]] Status read_struct(
    const JsonValue& json, T& object, const JsonLocation& location, const NameResolver& names) {
    return read_component(json, component_info<T>(), &object, location, names);
}

/// Reads one field; `field` points at its value.
[[nodiscard]] Status read_field(
    const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& location,
    const NameResolver& names);

/// Writes all fields of `object`; reading them into any value of the type restores `object`:
/// rotations, which are written in degrees, to 1e-6 rad, all else to the bit.
[[nodiscard]] JsonValue
write_component(const ComponentInfo& info, const void* object, const NameProvider& names);
[[nodiscard]] JsonValue
write_field(const FieldInfo& info, const void* field, const NameProvider& names);

/// The units in which a number of a field in `field_unit` may be written, as in "45deg".
[[nodiscard]] std::vector<std::string_view> written_units(std::string_view field_unit);

/// Calls `visit` with the kind and index of every asset id in `object`.
void for_each_asset(
    const std::vector<FieldInfo>& fields, void* object,
    const std::function<void(std::string_view kind, std::uint32_t& index)>& visit);

/// The component of the type `id`, or null.
[[nodiscard]] AnyComponent* find_in(std::span<AnyComponent> components, ComponentId id);
template <typename T>
[[nodiscard]] T* find_in(std::span<AnyComponent> components) {
    AnyComponent* const found = find_in(components, component_id<T>);
    return found != nullptr ? &found->as<T>() : nullptr;
}

/// Rotation of [yaw, pitch, roll] in degrees: about y, then x, then z of the rotated frame.
[[nodiscard]] Quat rotation_from_degrees(const Vec3& yaw_pitch_roll);
/// Its inverse; of several equal rotations the one with |pitch| <= 90.
[[nodiscard]] Vec3 degrees_from_rotation(const Quat& q);

}  // namespace limn
