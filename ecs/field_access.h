#pragma once

#include "ecs/reflect.h"

#include <span>
#include <string>
#include <string_view>

namespace limn {

// Reading and writing fields of components whose type is known at run time only: for level files,
// the inspector, `--set path=value`. A pointer to an element is to one number, vector, string ... ;
// a field that is an Array or List has several, the others exactly one. What is refused says what
// was found and what was expected; the caller puts file and place before it.

/// The element a path leads to.
struct FieldRef {
    const FieldInfo* field = nullptr;
    void* element = nullptr;
};

/// Where the field is in the struct around it.
[[nodiscard]] inline void* field_ptr(void* around, const FieldInfo& field) {
    return static_cast<char*>(around) + field.offset;
}
[[nodiscard]] inline const void* field_ptr(const void* around, const FieldInfo& field) {
    return static_cast<const char*>(around) + field.offset;
}

/// How many elements the field at `data` holds now, and where.
[[nodiscard]] std::size_t element_count(const FieldInfo& field, const void* data);
[[nodiscard]] void* element_ptr(const FieldInfo& field, void* data, std::size_t index);
[[nodiscard]] const void* element_ptr(const FieldInfo& field, const void* data, std::size_t index);

/// The field of that name, or nullptr.
[[nodiscard]] const FieldInfo*
find_field(const std::vector<FieldInfo>& fields, std::string_view name);
/// "" or " (did you mean radius?)".
[[nodiscard]] std::string
field_suggestion(const std::vector<FieldInfo>& fields, std::string_view name);

/// Follows names and indices with dots between them: "attenuation.linear", "keys.2.time". A field
/// with several elements needs an index, unless it is the end of the path: then the result is its
/// first element, or null if it has none.
[[nodiscard]] Result<FieldRef>
field_at(const ComponentInfo& info, void* component, std::string_view path);

/// How many numbers an element consists of: 1 for Float, 3 for Vec3 ... ; 0 for what is not made of
/// numbers. Bool, Enum, Entity and Asset are not.
[[nodiscard]] int number_count(FieldType type);

/// Number `lane` of the element; of matrices, column by column, of Affine, row by row.
[[nodiscard]] double get_number(const FieldInfo& field, const void* element, int lane = 0);
/// Refuses what is not finite, outside min .. max or of the type, or no integer where one is
/// needed.
[[nodiscard]] Status set_number(const FieldInfo& field, void* element, double value, int lane = 0);
/// All number_count() of them, or none.
[[nodiscard]] Status
set_numbers(const FieldInfo& field, void* element, std::span<const double> values);

/// The enumerator's name; "?" if it has none.
[[nodiscard]] std::string_view get_enum(const FieldInfo& field, const void* element);
[[nodiscard]] Status set_enum(const FieldInfo& field, void* element, std::string_view name);
[[nodiscard]] std::uint64_t get_unsigned(const FieldInfo& field, const void* element);

/// Whether two elements have the same value.
[[nodiscard]] bool equal_elements(const FieldInfo& field, const void* a, const void* b);

/// Ranges, finiteness, enumerators and the bytes of bools in all fields, nested ones too:
/// "attenuation.linear: found -1, expected 0 or more 1/m".
[[nodiscard]] Status validate_fields(const std::vector<FieldInfo>& fields, const void* around);
[[nodiscard]] inline Status validate_fields(const ComponentInfo& info, const void* component) {
    return validate_fields(info.fields, component);
}

/// "0 .. 10 m", "0 or more", "" without limits and unit.
[[nodiscard]] std::string range_text(const FieldMeta& meta);
/// "number", "3 numbers", "true or false", "one of a b c", "list of 3 numbers" ...: what to expect.
[[nodiscard]] std::string type_text(const FieldInfo& field);
/// The element for a person: "0.5", "[0, 1, 0]", "smooth", "entity 3 v1", "\"text\"".
[[nodiscard]] std::string value_text(const FieldInfo& field, const void* element);

}  // namespace limn
