#pragma once

#include "ecs/archetype.h"
#include "ecs/base/bytes.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

namespace limn {

// Serialization of component values for snapshots and hashes: without padding, with the contents
// of strings and lists. Types without padding are copied whole, others field by field. Types with
// padding or a destructor but no LIMN_FIELDS cannot be serialized.

[[nodiscard]] inline bool is_serializable(const ComponentInfo& info) {
    return info.value_bytes != ValueBytes::Opaque;
}

/// Appends an array of `count` values.
void write_values(const ComponentInfo& info, const void* first, std::size_t count, ByteWriter& out);

/// Overwrites an array of `count` constructed values. Returns false if the bytes end too early or
/// hold invalid values (a bool of 2, an unknown enumerator); the result is then valid but
/// unspecified.
[[nodiscard]] bool
read_values(const ComponentInfo& info, void* first, std::size_t count, ByteReader& in);

/// The same for `count` rows of an archetype's column; a split component is written, read and
/// hashed as structs, not as lanes.
void write_rows(const Column& column, std::uint32_t first, std::uint32_t count, ByteWriter& out);
[[nodiscard]] bool
read_rows(Column& column, std::uint32_t first, std::uint32_t count, ByteReader& in);

/// Whether every byte belongs to the value and any bytes are a valid value: no checks are needed.
[[nodiscard]] bool accepts_any_bytes(const ComponentInfo& info);

/// Minimum serialized size of a value [bytes].
[[nodiscard]] std::size_t min_serialized_size(const ComponentInfo& info);

/// Hash of what write_values would write; fast for types without padding.
[[nodiscard]] std::uint64_t
hash_values(const ComponentInfo& info, const void* first, std::size_t count, std::uint64_t seed);
/// The same for rows, at most one chunk.
[[nodiscard]] std::uint64_t
hash_rows(const Column& column, std::uint32_t first, std::uint32_t count, std::uint64_t seed);

/// Identifies the serialized layout of the type: hash of names, types and sizes of its fields.
[[nodiscard]] std::uint64_t layout_hash(const ComponentInfo& info);

/// Calls call(Entity&) for every Entity in these fields of the component, at any depth.
template <typename Call>
void for_each_entity(std::span<const FieldInfo> fields, void* around, const Call& call) {
    for (const FieldInfo& field : fields) {
        if (field.type != FieldType::Entity && field.type != FieldType::Struct) {
            continue;
        }
        void* const data = field_ptr(around, field);
        const std::size_t count = element_count(field, data);
        for (std::size_t i = 0; i < count; ++i) {
            void* const element = element_ptr(field, data, i);
            if (field.type == FieldType::Entity) {
                call(*static_cast<Entity*>(element));
            } else {
                for_each_entity(field.fields, element, call);
            }
        }
    }
}

}  // namespace limn
