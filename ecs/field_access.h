#pragma once

#include "ecs/reflect.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace limn {

// Type-erased access to component fields: for level files, the inspector, `--set path=value`. An
// element is one number, vector, string ... ; a field that is an Array or List has several, others
// exactly one. Errors say what was found and what was expected; the caller prepends file and
// position.

/// The element a path refers to.
struct FieldRef {
    const FieldInfo* field = nullptr;
    void* element = nullptr;
};

/// Pointer to the field in its enclosing struct.
[[nodiscard]] inline void* field_ptr(void* around, const FieldInfo& field) {
    return static_cast<char*>(around) + field.offset;
}
[[nodiscard]] inline const void* field_ptr(const void* around, const FieldInfo& field) {
    return static_cast<const char*>(around) + field.offset;
}

/// Current number of elements of the field at `data`, and pointers to them.
[[nodiscard]] std::size_t element_count(const FieldInfo& field, const void* data);
[[nodiscard]] void* element_ptr(const FieldInfo& field, void* data, std::size_t index);
[[nodiscard]] const void* element_ptr(const FieldInfo& field, const void* data, std::size_t index);

/// The field of that name, or nullptr. An old name (FieldMeta::renamed) is found with a warning.
[[nodiscard]] const FieldInfo*
find_field(const std::vector<FieldInfo>& fields, std::string_view name);
/// The same for an enumerator: its value, or nullopt.
[[nodiscard]] std::optional<std::uint64_t>
find_enumerator(const FieldInfo& field, std::string_view name);
/// "" or " (did you mean radius?)".
[[nodiscard]] std::string
field_suggestion(const std::vector<FieldInfo>& fields, std::string_view name);

/// Resolves a dot-separated path of names and indices: "attenuation.linear", "keys.2.time". An
/// Array or List needs an index, except at the end of the path: there the result is its first
/// element, or null if it is empty.
[[nodiscard]] Result<FieldRef>
field_at(const ComponentInfo& info, void* component, std::string_view path);

/// Number of components of an element: 1 for Float, 3 for Vec3 ... ; 0 for types that are not
/// numeric, which includes Bool, Enum, Entity and Asset.
[[nodiscard]] int number_count(FieldType type);

/// Component `lane` of the element; column-major for matrices, row-major for Affine.
[[nodiscard]] double get_number(const FieldInfo& field, const void* element, int lane = 0);
/// Fails if the value is not finite, out of the range of field or type, or not an integer where
/// one is required.
[[nodiscard]] Status set_number(const FieldInfo& field, void* element, double value, int lane = 0);
/// Sets all number_count() components, or none.
[[nodiscard]] Status
set_numbers(const FieldInfo& field, void* element, std::span<const double> values);

/// The enumerator's name; "?" if it has none.
[[nodiscard]] std::string_view get_enum(const FieldInfo& field, const void* element);
[[nodiscard]] Status set_enum(const FieldInfo& field, void* element, std::string_view name);
[[nodiscard]] std::uint64_t get_unsigned(const FieldInfo& field, const void* element);

/// Whether two elements have the same value.
[[nodiscard]] bool equal_elements(const FieldInfo& field, const void* a, const void* b);

/// Checks ranges, finiteness, enumerators and bools of all fields, including nested ones. Error:
/// "attenuation.linear: found -1, expected 0 or more 1/m".
[[nodiscard]] Status validate_fields(const std::vector<FieldInfo>& fields, const void* around);
[[nodiscard]] inline Status validate_fields(const ComponentInfo& info, const void* component) {
    return validate_fields(info.fields, component);
}

/// The valid range: "0 .. 10 m", "0 or more"; "" without limits.
[[nodiscard]] std::string range_text(const FieldMeta& meta);
/// The expected type: "number", "3 numbers", "true or false", "one of a b c", "list of 3 numbers".
[[nodiscard]] std::string type_text(const FieldInfo& field);
/// The element for display: "0.5", "[0, 1, 0]", "smooth", "entity 3 v1", "\"text\"".
[[nodiscard]] std::string value_text(const FieldInfo& field, const void* element);

}  // namespace limn
