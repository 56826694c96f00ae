#pragma once

#include "ecs/archetype.h"
#include "ecs/base/bytes.h"
#include "ecs/field_access.h"
#include "ecs/reflect.h"

namespace limn {

// The value of a component as bytes, for snapshots and hashes: without padding, with the contents
// of strings and lists. Types without padding are copied as they are, others field by field. What
// is neither (no visit_fields, but padding or a destructor) has no bytes.

[[nodiscard]] inline bool has_bytes(const ComponentInfo& info) {
    return info.value_bytes != ValueBytes::Opaque;
}

/// Appends `count` neighbors.
void write_values(const ComponentInfo& info, const void* first, std::size_t count, ByteWriter& out);

/// Fills `count` living neighbors. False: the bytes end too early or hold what the type cannot (a
/// bool of 2, an enumerator that is none); the values are then valid but arbitrary.
[[nodiscard]] bool
read_values(const ComponentInfo& info, void* first, std::size_t count, ByteReader& in);

/// The same for `count` rows of a column of an archetype; the lanes of a split component are
/// written, read and hashed as the structs that they make up.
void write_rows(const Column& column, std::uint32_t first, std::uint32_t count, ByteWriter& out);
[[nodiscard]] bool
read_rows(Column& column, std::uint32_t first, std::uint32_t count, ByteReader& in);

/// Whether its values are all their bytes, and all bytes are values: they may be copied unseen.
[[nodiscard]] bool takes_any_bytes(const ComponentInfo& info);

/// No value is written in fewer bytes.
[[nodiscard]] std::size_t least_bytes(const ComponentInfo& info);

/// Of what write_values would write; quick where there is no padding.
[[nodiscard]] std::uint64_t
hash_values(const ComponentInfo& info, const void* first, std::size_t count, std::uint64_t seed);
/// The same of rows, a chunk at most.
[[nodiscard]] std::uint64_t
hash_rows(const Column& column, std::uint32_t first, std::uint32_t count, std::uint64_t seed);

/// Tells apart what write_values of two programs would write for this type: names, types and sizes
/// of the fields.
[[nodiscard]] std::uint64_t layout_hash(const ComponentInfo& info);

/// Calls call(Entity&) for every entity that the component names, at any depth.
template <typename Call>
void for_each_entity(const std::vector<FieldInfo>& fields, void* around, const Call& call) {
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
