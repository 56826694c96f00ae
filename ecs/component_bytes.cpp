#include "ecs/component_bytes.h"

#include "ecs/base/hash.h"

#include <algorithm>
#include <string>

namespace limn {

namespace {

/// Whether the field has a fixed size: contains neither strings nor lists.
bool is_flat(const FieldInfo& field) {
    return field.shape != FieldShape::List && field.type != FieldType::String
           && std::all_of(field.fields.begin(), field.fields.end(), is_flat);
}

bool is_flat(const ComponentInfo& info) {
    return info.value_bytes == ValueBytes::All
           || std::all_of(info.fields.begin(), info.fields.end(), [](const FieldInfo& f) {
                  return is_flat(f);
              });
}

/// Whether some byte patterns are not valid values of the type.
bool has_invalid_bytes(const std::vector<FieldInfo>& fields) {
    return std::any_of(fields.begin(), fields.end(), [](const FieldInfo& field) {
        return field.type == FieldType::Bool || field.type == FieldType::Enum
               || has_invalid_bytes(field.fields);
    });
}

/// Consecutive bytes of a value.
struct ByteRun {
    std::uint32_t offset;
    std::uint32_t size;
};

void add_runs(
    const std::vector<FieldInfo>& fields, std::uint32_t base, std::vector<ByteRun>& runs) {
    for (const FieldInfo& field : fields) {
        for (std::uint32_t i = 0; i < field.count; ++i) {
            const std::uint32_t offset = base + field.offset + i * field.size;
            if (field.type == FieldType::Struct) {
                add_runs(field.fields, offset, runs);
            } else if (!runs.empty() && runs.back().offset + runs.back().size == offset) {
                runs.back().size += field.size;
            } else {
                runs.push_back({offset, field.size});
            }
        }
    }
}

std::vector<ByteRun> runs_of(const ComponentInfo& info) {
    std::vector<ByteRun> runs;
    add_runs(info.fields, 0, runs);
    return runs;
}

std::size_t min_bytes_of(const std::vector<FieldInfo>& fields);

std::size_t min_bytes_of_element(const FieldInfo& field) {
    switch (field.type) {
    case FieldType::String:
        return sizeof(std::uint32_t);
    case FieldType::Struct:
        return min_bytes_of(field.fields);
    default:
        return field.size;
    }
}

std::size_t min_bytes_of(const std::vector<FieldInfo>& fields) {
    std::size_t sum = 0;
    for (const FieldInfo& field : fields) {
        sum += field.shape == FieldShape::List ? sizeof(std::uint32_t)
                                               : field.count * min_bytes_of_element(field);
    }
    return sum;
}

void write_fields(const std::vector<FieldInfo>& fields, const void* around, ByteWriter& out) {
    for (const FieldInfo& field : fields) {
        const void* const data = field_ptr(around, field);
        const std::size_t count = element_count(field, data);
        if (field.shape == FieldShape::List) {
            out.value(static_cast<std::uint32_t>(count));
        }
        if (count == 0) {
            continue;
        }
        if (field.type != FieldType::String && field.type != FieldType::Struct) {
            out.bytes(element_ptr(field, data, 0), count * field.size);
            continue;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const void* const element = element_ptr(field, data, i);
            if (field.type == FieldType::String) {
                out.text(*static_cast<const std::string*>(element));
            } else {
                write_fields(field.fields, element, out);
            }
        }
    }
}

/// Whether the bytes of a bool or enum are a valid value.
bool is_valid(const FieldInfo& field, const std::byte* bytes) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes, std::min<std::size_t>(field.size, sizeof value));
    return field.type == FieldType::Bool ? value <= 1
                                         : field.values.empty() || value < field.values.size();
}

/// The same for all elements at `bytes`, including nested flat fields.
bool are_valid(const FieldInfo& field, const std::byte* bytes, std::size_t count) {
    if (field.type == FieldType::Bool || field.type == FieldType::Enum) {
        for (std::size_t i = 0; i < count; ++i) {
            if (!is_valid(field, bytes + i * field.size)) {
                return false;
            }
        }
    } else if (field.type == FieldType::Struct) {
        for (std::size_t i = 0; i < count; ++i) {
            for (const FieldInfo& inner : field.fields) {
                if (!are_valid(inner, bytes + i * field.size + inner.offset, inner.count)) {
                    return false;
                }
            }
        }
    }
    return true;
}

bool read_fields(const std::vector<FieldInfo>& fields, void* around, ByteReader& in);

/// Plain elements are validated before they are copied: a bool of 2 must never be in memory.
bool read_plain(const FieldInfo& field, void* first, std::size_t count, ByteReader& in) {
    const std::span<const std::byte> bytes = in.bytes(count * field.size);
    if (in.failed() || !are_valid(field, bytes.data(), count)) {
        return false;
    }
    if (!bytes.empty()) {
        std::memcpy(first, bytes.data(), bytes.size());
    }
    return true;
}

bool read_fields(const std::vector<FieldInfo>& fields, void* around, ByteReader& in) {
    for (const FieldInfo& field : fields) {
        void* const data = field_ptr(around, field);
        if (field.shape == FieldShape::List) {
            const std::uint32_t count =
                in.count(std::max<std::size_t>(min_bytes_of_element(field), 1));
            if (in.failed()) {
                return false;
            }
            field.list.resize(data, count);
        }
        const std::size_t count = element_count(field, data);
        if (field.type != FieldType::String && field.type != FieldType::Struct) {
            if (!read_plain(field, element_ptr(field, data, 0), count, in)) {
                return false;
            }
            continue;
        }
        for (std::size_t i = 0; i < count; ++i) {
            void* const element = element_ptr(field, data, i);
            if (field.type == FieldType::String) {
                *static_cast<std::string*>(element) = in.text();
            } else if (!read_fields(field.fields, element, in)) {
                return false;
            }
        }
    }
    return !in.failed();
}

/// Calls call(values, count) for the rows of a split component, up to a chunk at a time.
template <typename Call>
void each_gathered(
    const Column& column, std::uint32_t first, std::uint32_t count, const Call& call) {
    thread_local std::vector<std::uint32_t> values;  // keeps its memory from call to call
    values.resize(kChunkRows * column.info->size / kLaneBytes);
    for (std::uint32_t row = 0; row < count; row += kChunkRows) {
        const std::uint32_t some = std::min(count - row, kChunkRows);
        gather_values(&column, first + row, some, values.data());
        call(values.data(), some);
    }
}

std::uint64_t layout_of(const std::vector<FieldInfo>& fields, std::uint64_t hash) {
    for (const FieldInfo& field : fields) {
        hash = hash_combine(hash, hash_text(field.name));
        hash = hash_combine(hash, static_cast<std::uint64_t>(field.type));
        hash = hash_combine(hash, static_cast<std::uint64_t>(field.shape));
        hash = hash_combine(
            hash,
            field.type == FieldType::String || field.type == FieldType::Struct ? 0 : field.size);
        hash = hash_combine(hash, field.count);
        hash = hash_combine(hash, hash_text(field.meta.values));
        hash = layout_of(field.fields, hash_combine(hash, field.fields.size()));
    }
    return hash;
}

}  // namespace

void write_values(
    const ComponentInfo& info, const void* first, std::size_t count, ByteWriter& out) {
    LIMN_CHECK_NOTE(is_serializable(info), info.name.c_str());
    if (info.is_tag || count == 0) {
        return;
    }
    const char* value = static_cast<const char*>(first);
    if (info.value_bytes == ValueBytes::All) {
        out.bytes(value, count * info.size);
    } else if (is_flat(info)) {
        const std::vector<ByteRun> runs = runs_of(info);
        for (std::size_t i = 0; i < count; ++i, value += info.size) {
            for (const ByteRun run : runs) {
                out.bytes(value + run.offset, run.size);
            }
        }
    } else {
        for (std::size_t i = 0; i < count; ++i, value += info.size) {
            write_fields(info.fields, value, out);
        }
    }
}

bool read_values(const ComponentInfo& info, void* first, std::size_t count, ByteReader& in) {
    LIMN_CHECK_NOTE(is_serializable(info), info.name.c_str());
    if (info.is_tag || count == 0) {
        return true;
    }
    char* value = static_cast<char*>(first);
    if (info.value_bytes != ValueBytes::All) {
        for (std::size_t i = 0; i < count; ++i, value += info.size) {
            if (!read_fields(info.fields, value, in)) {
                return false;
            }
        }
        return true;
    }
    const std::span<const std::byte> bytes = in.bytes(count * info.size);
    if (in.failed()) {
        return false;
    }
    if (has_invalid_bytes(info.fields)) {
        for (std::size_t i = 0; i < count; ++i) {
            for (const FieldInfo& field : info.fields) {
                if (!are_valid(field, bytes.data() + i * info.size + field.offset, field.count)) {
                    return false;
                }
            }
        }
    }
    if (!bytes.empty()) {
        std::memcpy(value, bytes.data(), bytes.size());
    }
    return true;
}

void write_rows(const Column& column, std::uint32_t first, std::uint32_t count, ByteWriter& out) {
    if (column.info->storage != Storage::Split) {
        write_values(*column.info, column.at(first), count, out);
        return;
    }
    each_gathered(column, first, count, [&](const void* values, std::size_t some) {
        write_values(*column.info, values, some, out);
    });
}

bool read_rows(Column& column, std::uint32_t first, std::uint32_t count, ByteReader& in) {
    if (column.info->storage != Storage::Split) {
        return read_values(*column.info, column.at(first), count, in);
    }
    std::vector<std::uint32_t> values(kChunkRows * column.info->size / kLaneBytes);
    for (std::uint32_t row = 0; row < count; row += kChunkRows) {
        const std::uint32_t some = std::min(count - row, kChunkRows);
        gather_values(&column, first + row, some, values.data());
        if (!read_values(*column.info, values.data(), some, in)) {
            return false;
        }
        scatter_values(&column, first + row, some, values.data());
    }
    return true;
}

bool accepts_any_bytes(const ComponentInfo& info) {
    return info.value_bytes == ValueBytes::All && !has_invalid_bytes(info.fields);
}

std::size_t min_serialized_size(const ComponentInfo& info) {
    return info.value_bytes == ValueBytes::All ? info.size : min_bytes_of(info.fields);
}

std::uint64_t
hash_values(const ComponentInfo& info, const void* first, std::size_t count, std::uint64_t seed) {
    if (info.value_bytes == ValueBytes::All) {
        return hash_bytes(first, count * info.size, seed);
    }
    thread_local ByteWriter scratch;  // keeps its memory from call to call
    scratch.clear();
    write_values(info, first, count, scratch);
    return hash_bytes(scratch.data(), scratch.size(), seed);
}

std::uint64_t
hash_rows(const Column& column, std::uint32_t first, std::uint32_t count, std::uint64_t seed) {
    if (column.info->storage != Storage::Split) {
        return hash_values(*column.info, column.at(first), count, seed);
    }
    LIMN_CHECK(count <= kChunkRows);
    std::uint64_t hash = hash_bytes(nullptr, 0, seed);
    each_gathered(column, first, count, [&](const void* values, std::size_t some) {
        hash = hash_values(*column.info, values, some, seed);
    });
    return hash;
}

std::uint64_t layout_hash(const ComponentInfo& info) {
    const std::uint64_t kind = hash_combine(
        static_cast<std::uint64_t>(info.value_bytes),
        info.is_tag                       ? 1
        : info.storage == Storage::Shared ? 2  // one value, not one per row
                                          : 0);
    return layout_of(
        info.fields, hash_combine(kind, info.value_bytes == ValueBytes::All ? info.size : 0));
}

}  // namespace limn
