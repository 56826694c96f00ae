#include "ecs/field_access.h"

#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <set>

// Techniques: engine.param-access, engine.param-desc

namespace limn {

namespace {

template <typename T>
T load_lane(const void* from, int lane = 0) {
    T value;
    std::memcpy(
        &value, static_cast<const char*>(from) + sizeof(T) * static_cast<std::size_t>(lane),
        sizeof value);
    return value;
}

template <typename T>
void store(void* to, T value, int lane = 0) {
    std::memcpy(
        static_cast<char*>(to) + sizeof(T) * static_cast<std::size_t>(lane), &value, sizeof value);
}

std::int64_t get_signed(const FieldInfo& field, const void* element) {
    switch (field.size) {
    case 1:
        return load_lane<std::int8_t>(element);
    case 2:
        return load_lane<std::int16_t>(element);
    case 4:
        return load_lane<std::int32_t>(element);
    default:
        return load_lane<std::int64_t>(element);
    }
}

void set_unsigned(const FieldInfo& field, void* element, std::uint64_t value) {
    std::memcpy(element, &value, field.size);  // little-endian: the low bytes come first
}

/// Warns once for each old name; `renamed` identifies the field.
void warn_renamed(const char* renamed, std::string_view old_name, std::string_view new_name) {
    static std::mutex mutex;
    static std::set<std::pair<const char*, std::string>> warned;
    const std::lock_guard lock(mutex);
    if (warned.emplace(renamed, old_name).second) {
        log_warn("{} is renamed to {}; the next version rejects the old name", old_name, new_name);
    }
}

bool is_integer(FieldType type) {
    return type == FieldType::Int || type == FieldType::UInt || type == FieldType::IVec2
           || type == FieldType::IVec3;
}

/// Smallest and largest value of the type that a double represents exactly.
std::pair<double, double> type_range(const FieldInfo& field) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    switch (field.type) {
    case FieldType::Int: {
        const double limit =
            std::min(std::ldexp(1.0, static_cast<int>(field.size) * 8 - 1), kExact);
        return {-limit, limit < kExact ? limit - 1 : limit};
    }
    case FieldType::UInt: {
        const double limit = std::min(std::ldexp(1.0, static_cast<int>(field.size) * 8), kExact);
        return {0, limit < kExact ? limit - 1 : limit};
    }
    case FieldType::IVec2:
    case FieldType::IVec3:
        return {-2147483648.0, 2147483647.0};
    case FieldType::Double:
        return {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    default:
        return {-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    }
}

/// Whether `value` is in the field's range. For float fields the limits, like 0.1, are rounded to
/// float too.
bool in_range(const FieldInfo& field, double value) {
    if (field.type == FieldType::Double || is_integer(field.type)) {
        return value >= field.meta.min && value <= field.meta.max;
    }
    const auto x = static_cast<float>(value);
    return x >= static_cast<float>(field.meta.min) && x <= static_cast<float>(field.meta.max);
}

std::string expected_number(const FieldInfo& field) {
    const std::string range = range_text(field.meta);
    const char* const noun = is_integer(field.type) ? "a whole number" : "a number";
    return range.empty() ? noun : range;
}

Status check_number(const FieldInfo& field, double value) {
    const auto [low, high] = type_range(field);
    if (!std::isfinite(value) || value < low || value > high || !in_range(field, value)
        || (is_integer(field.type) && value != std::floor(value))) {
        return fail("found {}, expected {}", value, expected_number(field));
    }
    return Done{};
}

Status validate_element(const FieldInfo& field, const void* element) {
    switch (field.type) {
    case FieldType::Bool: {
        const auto byte = load_lane<std::uint8_t>(element);
        if (byte > 1) {
            return fail("{}: found {}, expected true or false", field.name, byte);
        }
        return Done{};
    }
    case FieldType::Enum: {
        const std::uint64_t value = get_unsigned(field, element);
        if (value >= field.values.size()) {
            return fail("{}: found {}, expected {}", field.name, value, type_text(field));
        }
        return Done{};
    }
    case FieldType::Struct: {
        const Status status = validate_fields(field.fields, element);
        if (!status) {
            return fail("{}.{}", field.name, status.error().message);
        }
        return Done{};
    }
    case FieldType::Int:
    case FieldType::UInt: {
        // Beyond 2^53 a double is not exact, so the type's own limits are not checked here.
        const double value = get_number(field, element);
        if (!in_range(field, value)) {
            return fail("{}: found {}, expected {}", field.name, value, expected_number(field));
        }
        return Done{};
    }
    default:
        for (int lane = 0; lane < number_count(field.type); ++lane) {
            const Status status = check_number(field, get_number(field, element, lane));
            if (!status) {
                return fail("{}: {}", field.name, status.error().message);
            }
        }
        return Done{};
    }
}

/// Removes and returns the first step of a path.
std::string_view take_step(std::string_view& path) {
    const std::size_t dot = std::min(path.find('.'), path.size());
    const std::string_view step = path.substr(0, dot);
    path.remove_prefix(std::min(dot + 1, path.size()));
    return step;
}

/// A limit as people write it: 0.1 where it is the float nearest to that.
std::string limit_text(double limit) {
    const float as_float = static_cast<float>(limit);
    return as_float == limit ? format_text("{}", as_float) : format_text("{}", limit);
}

}  // namespace

std::size_t element_count(const FieldInfo& field, const void* data) {
    switch (field.shape) {
    case FieldShape::One:
        return 1;
    case FieldShape::Array:
        return field.count;
    case FieldShape::List:
        return field.list.size(data);
    }
    return 0;
}

void* element_ptr(const FieldInfo& field, void* data, std::size_t index) {
    char* const first =
        static_cast<char*>(field.shape == FieldShape::List ? field.list.data(data) : data);
    return first + index * field.size;
}

const void* element_ptr(const FieldInfo& field, const void* data, std::size_t index) {
    return element_ptr(field, const_cast<void*>(data), index);
}

const FieldInfo* find_field(const std::vector<FieldInfo>& fields, std::string_view name) {
    for (const FieldInfo& field : fields) {
        if (field.name == name) {
            return &field;
        }
    }
    for (const FieldInfo& field : fields) {
        const std::vector<std::string_view> old_names = detail::split_words(field.meta.renamed);
        if (std::find(old_names.begin(), old_names.end(), name) != old_names.end()) {
            warn_renamed(field.meta.renamed, name, field.name);
            return &field;
        }
    }
    return nullptr;
}

std::optional<std::uint64_t> find_enumerator(const FieldInfo& field, std::string_view name) {
    const auto index = [&field](std::string_view value) -> std::optional<std::uint64_t> {
        const auto found = std::find(field.values.begin(), field.values.end(), value);
        return found == field.values.end()
                   ? std::nullopt
                   : std::optional(std::uint64_t(found - field.values.begin()));
    };
    if (const auto found = index(name)) {
        return found;
    }
    for (const std::string_view word : detail::split_words(field.meta.renamed)) {
        const std::size_t equals = word.find('=');
        if (equals != std::string_view::npos && word.substr(0, equals) == name) {
            warn_renamed(field.meta.renamed, name, word.substr(equals + 1));
            return index(word.substr(equals + 1));
        }
    }
    return std::nullopt;
}

std::string field_suggestion(const std::vector<FieldInfo>& fields, std::string_view name) {
    std::vector<std::string> names;
    for (const FieldInfo& field : fields) {
        names.emplace_back(field.name);
    }
    const std::string nearest = nearest_name(name, names);
    return nearest.empty() ? "" : " (did you mean " + nearest + "?)";
}

Result<FieldRef> field_at(const ComponentInfo& info, void* component, std::string_view path) {
    const std::vector<FieldInfo>* fields = &info.fields;
    void* around = component;
    FieldRef ref;
    std::string_view rest = path;
    do {
        const std::string_view name = take_step(rest);
        const FieldInfo* const field = find_field(*fields, name);
        if (field == nullptr) {
            return fail("{}: no field \"{}\"{}", info.name, name, field_suggestion(*fields, name));
        }
        void* const data = field_ptr(around, *field);
        std::size_t index = 0;
        if (field->shape != FieldShape::One && !rest.empty()) {
            const std::string_view step = take_step(rest);
            const auto [end, error] =
                std::from_chars(step.data(), step.data() + step.size(), index);
            if (error != std::errc{} || end != step.data() + step.size()
                || index >= element_count(*field, data)) {
                return fail(
                    "{}: {}: found index \"{}\", expected less than {}", info.name, field->name,
                    step, element_count(*field, data));
            }
        }
        const bool is_there = index < element_count(*field, data);
        ref = {field, is_there ? element_ptr(*field, data, index) : nullptr};
        fields = &field->fields;
        around = ref.element;
        if (!rest.empty() && field->type != FieldType::Struct) {
            return fail("{}: {} has no fields, found \"{}\"", info.name, field->name, rest);
        }
    } while (!rest.empty());
    return ref;
}

int number_count(FieldType type) {
    switch (type) {
    case FieldType::Int:
    case FieldType::UInt:
    case FieldType::Float:
    case FieldType::Double:
        return 1;
    case FieldType::Vec2:
    case FieldType::IVec2:
        return 2;
    case FieldType::Vec3:
    case FieldType::IVec3:
        return 3;
    case FieldType::Vec4:
    case FieldType::Quat:
        return 4;
    case FieldType::Mat3:
        return 9;
    case FieldType::Mat4:
        return 16;
    case FieldType::Affine:
        return 12;
    case FieldType::Bool:
    case FieldType::String:
    case FieldType::Enum:
    case FieldType::Entity:
    case FieldType::Asset:
    case FieldType::Struct:
        return 0;
    }
    return 0;
}

double get_number(const FieldInfo& field, const void* element, int lane) {
    LIMN_CHECK(lane >= 0 && lane < number_count(field.type));
    switch (field.type) {
    case FieldType::Int:
        return static_cast<double>(get_signed(field, element));
    case FieldType::UInt:
        return static_cast<double>(get_unsigned(field, element));
    case FieldType::Double:
        return load_lane<double>(element);
    case FieldType::IVec2:
    case FieldType::IVec3:
        return load_lane<std::int32_t>(element, lane);
    default:
        return double{load_lane<float>(element, lane)};
    }
}

Status set_number(const FieldInfo& field, void* element, double value, int lane) {
    LIMN_CHECK(lane >= 0 && lane < number_count(field.type));
    if (Status status = check_number(field, value); !status) {
        return status;
    }
    switch (field.type) {
    case FieldType::Int:
        set_unsigned(field, element, static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
        break;
    case FieldType::UInt:
        set_unsigned(field, element, static_cast<std::uint64_t>(value));
        break;
    case FieldType::Double:
        store(element, value);
        break;
    case FieldType::IVec2:
    case FieldType::IVec3:
        store(element, static_cast<std::int32_t>(value), lane);
        break;
    default:
        store(element, static_cast<float>(value), lane);
        break;
    }
    return Done{};
}

Status set_numbers(const FieldInfo& field, void* element, std::span<const double> values) {
    if (values.size() != static_cast<std::size_t>(number_count(field.type))) {
        return fail("found {} numbers, expected {}", values.size(), number_count(field.type));
    }
    for (const double value : values) {
        if (Status status = check_number(field, value); !status) {
            return status;
        }
    }
    for (std::size_t lane = 0; lane < values.size(); ++lane) {
        if (Status status = set_number(field, element, values[lane], static_cast<int>(lane));
            !status) {
            return status;
        }
    }
    return Done{};
}

std::uint64_t get_unsigned(const FieldInfo& field, const void* element) {
    std::uint64_t value = 0;
    std::memcpy(&value, element, std::min<std::size_t>(field.size, sizeof value));
    return value;
}

std::string_view get_enum(const FieldInfo& field, const void* element) {
    const std::uint64_t value = get_unsigned(field, element);
    return value < field.values.size() ? field.values[value] : "?";
}

Status set_enum(const FieldInfo& field, void* element, std::string_view name) {
    const std::optional<std::uint64_t> value = find_enumerator(field, name);
    if (!value) {
        const std::string nearest = nearest_name(name, field.values);
        return fail(
            "found \"{}\", expected {}{}", name, type_text(field),
            nearest.empty() ? "" : " (did you mean " + nearest + "?)");
    }
    set_unsigned(field, element, *value);
    return Done{};
}

bool equal_elements(const FieldInfo& field, const void* a, const void* b) {
    if (field.type == FieldType::String) {
        return *static_cast<const std::string*>(a) == *static_cast<const std::string*>(b);
    }
    if (field.type != FieldType::Struct) {
        return std::memcmp(a, b, field.size) == 0;
    }
    return std::all_of(field.fields.begin(), field.fields.end(), [a, b](const FieldInfo& inner) {
        const void* const inner_a = field_ptr(a, inner);
        const void* const inner_b = field_ptr(b, inner);
        const std::size_t count = element_count(inner, inner_a);
        if (count != element_count(inner, inner_b)) {
            return false;
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (!equal_elements(
                    inner, element_ptr(inner, inner_a, i), element_ptr(inner, inner_b, i))) {
                return false;
            }
        }
        return true;
    });
}

Status validate_fields(const std::vector<FieldInfo>& fields, const void* around) {
    for (const FieldInfo& field : fields) {
        const void* const data = field_ptr(around, field);
        const std::size_t count = element_count(field, data);
        for (std::size_t i = 0; i < count; ++i) {
            if (Status status = validate_element(field, element_ptr(field, data, i)); !status) {
                return status;
            }
        }
    }
    return Done{};
}

std::string range_text(const FieldMeta& meta) {
    const bool has_min = meta.min > -INFINITY;
    const bool has_max = meta.max < INFINITY;
    const std::string unit = *meta.unit == '\0' ? "" : std::string(" ") + meta.unit;
    if (has_min && has_max) {
        return format_text("{} .. {}{}", limit_text(meta.min), limit_text(meta.max), unit);
    }
    if (has_min) {
        return format_text("{} or more{}", limit_text(meta.min), unit);
    }
    if (has_max) {
        return format_text("{} or less{}", limit_text(meta.max), unit);
    }
    return "";
}

std::string type_text(const FieldInfo& field) {
    std::string text;
    switch (field.type) {
    case FieldType::Bool:
        text = "true or false";
        break;
    case FieldType::Int:
    case FieldType::UInt:
        text = "whole number";
        break;
    case FieldType::String:
        text = "text";
        break;
    case FieldType::Enum:
        text = format_text("one of {}", field.meta.values);
        break;
    case FieldType::Entity:
        text = "name of an entity";
        break;
    case FieldType::Asset:
        text = format_text(
            "name of {} {}", std::strchr("aeiou", field.asset[0]) != nullptr ? "an" : "a",
            field.asset);
        break;
    case FieldType::Struct:
        text = "object";
        break;
    default: {
        const int numbers = number_count(field.type);
        text = numbers == 1 ? "number" : format_text("{} numbers", numbers);
    }
    }
    switch (field.shape) {
    case FieldShape::One:
        return text;
    case FieldShape::Array:
        return format_text("{} times {}", field.count, text);
    case FieldShape::List:
        return format_text("list of {}", text);
    }
    return text;
}

std::string value_text(const FieldInfo& field, const void* element) {
    switch (field.type) {
    case FieldType::Bool:
        return load_lane<std::uint8_t>(element) != 0 ? "true" : "false";
    case FieldType::String:
        return format_text("\"{}\"", *static_cast<const std::string*>(element));
    case FieldType::Enum:
        return std::string(get_enum(field, element));
    case FieldType::Entity: {
        const auto entity = load_lane<Entity>(element);
        return entity.is_null() ? "none"
                                : format_text("entity {} v{}", entity.index, entity.generation);
    }
    case FieldType::Asset: {
        const auto index = load_lane<std::uint32_t>(element);
        return index == 0xffffffffu ? "none" : format_text("{} {}", field.asset, index);
    }
    case FieldType::Struct: {
        std::string text = "{";
        for (const FieldInfo& inner : field.fields) {
            const void* const data = field_ptr(element, inner);
            text += text.size() > 1 ? ", " : "";
            text += format_text("{}: ", inner.name);
            text += inner.shape == FieldShape::One
                        ? value_text(inner, data)
                        : format_text("{} elements", element_count(inner, data));
        }
        return text + "}";
    }
    case FieldType::Int:
        return format_text("{}", get_signed(field, element));
    case FieldType::UInt:
        return format_text("{}", get_unsigned(field, element));
    default:
        break;
    }
    const int numbers = number_count(field.type);
    std::string text = numbers > 1 ? "[" : "";
    for (int lane = 0; lane < numbers; ++lane) {
        text += lane > 0 ? ", " : "";
        // Print floats as float: 0.1, not 0.10000000149011612.
        const double number = get_number(field, element, lane);
        text += field.type == FieldType::Double ? format_text("{}", number)
                                                : format_text("{}", static_cast<float>(number));
    }
    return numbers > 1 ? text + "]" : text;
}

}  // namespace limn
