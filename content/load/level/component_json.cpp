#include "content/load/level/component_json.h"

#include "content/load/level/color_names.h"
#include "content/load/level/level_hints.h"
#include "ecs/base/srgb.h"
#include "ecs/base/text.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

// Techniques: anim.euler, engine.param-desc

namespace limn {

namespace {

std::vector<std::string_view> names_of(const std::vector<FieldInfo>& fields) {
    std::vector<std::string_view> names;
    for (const FieldInfo& field : fields) {
        names.emplace_back(field.name);
    }
    return names;
}

/// "a number 0 .. 10 m".
std::string expected_number(const FieldInfo& info, std::string_view noun) {
    const std::string range = range_text(info.meta);
    return range.empty() ? std::string(noun) : fmt::format("{} {}", noun, range);
}

/// A unit of a number string, converted to a field's unit: "45deg" in a field in radians.
struct WrittenUnit {
    std::string_view field;
    std::string_view written;
    double factor;
};
constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr WrittenUnit kWrittenUnits[] = {
    {"rad", "deg", kDegree},
    {"rad", "rad", 1},
    {"deg", "deg", 1},
    {"deg", "rad", 1 / kDegree},
    {"rad/s", "deg/s", kDegree},
    {"rad/s", "rad/s", 1},
    {"rad/s", "rpm", 6 * kDegree},
    {"m", "km", 1000},
    {"m", "cm", 0.01},
    {"m", "mm", 0.001},
    {"m", "m", 1},
    {"m/s", "km/h", 1 / 3.6},
    {"m/s", "kn", 1852.0 / 3600},
    {"m/s", "m/s", 1},
    {"s", "ms", 0.001},
    {"s", "min", 60},
    {"s", "s", 1},
    {"lx", "klx", 1000},
    {"lx", "lx", 1},
    {"cd", "cd", 1},
    {"EV", "EV", 1}};

/// The unit of "45deg" or "2 m", and the number converted to the field's unit.
struct WrittenNumber {
    double number;
    const WrittenUnit* unit;
};

/// nullopt for other strings.
std::optional<WrittenNumber> number_with_unit(std::string_view text, std::string_view field_unit) {
    double number = 0.0;
    const char* const end = text.data() + text.size();
    const std::from_chars_result parsed = std::from_chars(text.data(), end, number);
    if (parsed.ec != std::errc() || !std::isfinite(number)) {
        return std::nullopt;
    }
    std::string_view unit(parsed.ptr, static_cast<std::size_t>(end - parsed.ptr));
    unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
    for (const WrittenUnit& known : kWrittenUnits) {
        if (known.field == field_unit && known.written == unit) {
            return WrittenNumber{number * known.factor, &known};
        }
    }
    return std::nullopt;
}

/// ` or a string like "2cm"`; empty if the field's unit has no alternatives.
std::string or_with_unit(std::string_view field_unit) {
    for (const WrittenUnit& known : kWrittenUnits) {
        if (known.field == field_unit) {
            return fmt::format(
                " or a string like \"{}{}\"", known.factor < 1 ? 45 : 2, known.written);
        }
    }
    return "";
}

/// The range of a field as "a number -180 .. 180 deg", in the unit of what was found.
std::string expected_in_unit(FieldMeta meta, const WrittenUnit& unit) {
    for (double* const limit : {&meta.min, &meta.max}) {
        if (*limit != 0 && std::isfinite(*limit)) {  // five digits, enough for limits such as pi
            *limit /= unit.factor;
            const double digits = std::pow(10, 4 - std::floor(std::log10(std::abs(*limit))));
            *limit = std::round(*limit * digits) / digits;
        }
    }
    const std::string name(unit.written);
    meta.unit = name.c_str();
    return "a number " + range_text(meta);
}

struct ComponentReader {
    const NameResolver& names;

    Status read_fields(
        const JsonValue& json, const std::vector<FieldInfo>& fields, void* object,
        const JsonLocation& at) const {
        LIMN_TRY(expect(json, JsonKind::Object, at, "an object with the fields to set"));
        for (const JsonMember& member : json.members) {
            const FieldInfo* const field = find_field(fields, member.key);
            if (field == nullptr) {
                const std::vector<std::string_view> known = names_of(fields);
                return error_at(
                    at, member.at, "the field " + in_quotes(member.key),
                    (known.empty() ? "none" : fmt::format("one of {}", fmt::join(known, " ")))
                        + where_it_belongs(member.key, did_you_mean(member.key, known)));
            }
            LIMN_TRY(read_shape(
                member.value, *field, field_ptr(object, *field), location_in(at, member.key)));
        }
        return Done{};
    }

    Status read_shape(
        const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& at) const {
        if (info.shape == FieldShape::One) {
            return read_one(json, info, field, at);
        }
        const bool is_list = info.shape == FieldShape::List;
        if (json.kind != JsonKind::Array || (!is_list && json.items.size() != info.count)) {
            return unexpected(
                json, at, is_list ? "an array" : fmt::format("an array of {}", info.count));
        }
        if (is_list) {
            info.list.resize(field, 0);  // elements start from their defaults
            info.list.resize(field, json.items.size());
        }
        for (std::size_t i = 0; i < json.items.size(); ++i) {
            LIMN_TRY(read_one(json.items[i], info, element_ptr(info, field, i), item_in(at, i)));
        }
        return Done{};
    }

    Status read_one(
        const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& at) const {
        switch (info.type) {
        case FieldType::Bool:
            LIMN_TRY(expect(json, JsonKind::Bool, at, "true or false"));
            *static_cast<bool*>(field) = json.truth;
            return Done{};
        case FieldType::Int:
        case FieldType::UInt:
            return read_integer(json, info, field, at);
        case FieldType::Double:
            return read_scalar(json, info, at, *static_cast<double*>(field));
        case FieldType::Float:
        case FieldType::Vec2:
        case FieldType::Vec3:
        case FieldType::Vec4:
        case FieldType::Mat3:
        case FieldType::Mat4:
        case FieldType::Affine:
            return read_floats(
                json, info, {static_cast<float*>(field), info.size / sizeof(float)}, at);
        case FieldType::Quat:
            return read_rotation(json, info, *static_cast<Quat*>(field), at);
        case FieldType::IVec2:
        case FieldType::IVec3: {
            const std::size_t count = info.size / sizeof(int);
            if (json.kind != JsonKind::Array || json.items.size() != count) {
                return unexpected(json, at, fmt::format("an array of {} integers", count));
            }
            FieldInfo element = info;
            element.type = FieldType::Int;
            element.size = sizeof(int);
            for (std::size_t i = 0; i < count; ++i) {
                LIMN_TRY(read_integer(
                    json.items[i], element, static_cast<int*>(field) + i, item_in(at, i)));
            }
            return Done{};
        }
        case FieldType::String:
            LIMN_TRY(expect(json, JsonKind::String, at, "a string"));
            *static_cast<std::string*>(field) = json.text;
            return Done{};
        case FieldType::Enum:
            return read_enum(json, info, field, at);
        case FieldType::Entity:
        case FieldType::Asset:
            return read_name(json, info, field, at);
        case FieldType::Struct:
            return read_fields(json, info.fields, field, at);
        }
        return Done{};
    }

  private:
    Status read_scalar(
        const JsonValue& json, const FieldInfo& info, const JsonLocation& at,
        double& number) const {
        const std::string_view unit = info.meta.unit;
        const std::optional<WrittenNumber> with_unit =
            json.kind == JsonKind::String ? number_with_unit(json.text, unit) : std::nullopt;
        if (json.kind != JsonKind::Number && !with_unit) {
            return unexpected(json, at, expected_number(info, "a number") + or_with_unit(unit));
        }
        const double read = with_unit ? with_unit->number : json.number;
        if (!(read >= info.meta.min && read <= info.meta.max)) {
            if (with_unit) {
                return unexpected(json, at, expected_in_unit(info.meta, *with_unit->unit));
            }
            const double as_degrees = read * kDegree;
            const bool seems_degrees =
                unit == "rad" && as_degrees >= info.meta.min && as_degrees <= info.meta.max;
            const bool seems_byte = info.meta.color && read > info.meta.max && read <= 255.0;
            return unexpected(
                json, at,
                expected_number(info, "a number")
                    + (seems_degrees ? fmt::format(" (for degrees write \"{}deg\")", json.text)
                       : seems_byte  ? " (for 0 .. 255 write \"#rrggbb\")"
                                     : std::string()));
        }
        number = read;
        return Done{};
    }

    Status read_floats(
        const JsonValue& json, const FieldInfo& info, std::span<float> floats,
        const JsonLocation& at) const {
        const auto read_float = [&](const JsonValue& item, float& out,
                                    const JsonLocation& where) -> Status {
            double number = 0.0;
            LIMN_TRY(read_scalar(item, info, where, number));
            if (std::abs(number) > static_cast<double>(std::numeric_limits<float>::max())) {
                return unexpected(item, where, "a number that fits 32-bit floating point");
            }
            out = static_cast<float>(number);
            return Done{};
        };
        if (floats.size() == 1) {
            return read_float(json, floats[0], at);
        }
        if (info.meta.color && json.kind == JsonKind::String) {
            return read_color(json, floats, at);
        }
        const bool without_alpha = info.meta.color && floats.size() == 4 && json.items.size() == 3;
        if (json.kind != JsonKind::Array
            || (json.items.size() != floats.size() && !without_alpha)) {
            return unexpected(
                json, at,
                info.meta.color ? expected_color(floats)
                                : fmt::format("an array of {} numbers", floats.size()));
        }
        for (std::size_t i = 0; i < json.items.size(); ++i) {
            LIMN_TRY(read_float(json.items[i], floats[i], item_in(at, i)));
        }
        return Done{};
    }

    Status read_integer(
        const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& at) const {
        const bool is_signed = info.type == FieldType::Int;
        const unsigned bits = 8 * info.size;
        const std::uint64_t high = (~std::uint64_t{0} >> (64 - bits)) >> (is_signed ? 1 : 0);
        const std::string expected = expected_number(info, "an integer");
        std::uint64_t magnitude = 0;
        bool is_negative = false;
        bool good = json.kind == JsonKind::Number;
        if (good) {
            std::string_view digits = json.text;
            is_negative = digits.starts_with('-');
            digits.remove_prefix(is_negative ? 1 : 0);
            const char* const end = digits.data() + digits.size();
            const std::from_chars_result parsed = std::from_chars(digits.data(), end, magnitude);
            good = parsed.ec == std::errc() && parsed.ptr == end;
        }
        // Two's complement: the negative range is larger by one.
        good = good && magnitude <= high + (is_signed && is_negative ? 1 : 0)
               && (is_signed || !is_negative || magnitude == 0) && json.number >= info.meta.min
               && json.number <= info.meta.max;
        if (!good) {
            const bool is_limited = std::isfinite(info.meta.min) && std::isfinite(info.meta.max);
            const std::string width =
                is_limited ? std::string() : fmt::format(" of {} bits", bits - (is_signed ? 1 : 0));
            return unexpected(json, at, expected + width);
        }
        const std::uint64_t value = is_negative ? ~magnitude + 1 : magnitude;
        std::memcpy(field, &value, info.size);  // little-endian
        return Done{};
    }

    static std::string expected_color(std::span<const float> floats) {
        return floats.size() == 4
                   ? R"([r, g, b], [r, g, b, a], "#rrggbb", "#rrggbbaa" or a name such as "orange")"
                   : R"([r, g, b], "#rrggbb", "#rgb" or a name such as "orange")";
    }

    Status
    read_color(const JsonValue& json, std::span<float> floats, const JsonLocation& at) const {
        std::string text = json.text;
        const std::optional<std::uint32_t> named = find_color(text);
        if (text.starts_with('#') && text.size() <= 5) {  // "#f80" is "#ff8800"
            std::string doubled = "#";
            for (const char digit : text.substr(1)) {
                doubled.append(2, digit);
            }
            text = doubled;
        }
        const std::size_t digits = text.size() - 1;
        std::uint32_t code = named.value_or(0);
        bool good = text.starts_with('#') && (digits == 6 || (digits == 8 && floats.size() == 4));
        if (good) {
            const char* const end = text.data() + text.size();
            const std::from_chars_result parsed = std::from_chars(text.data() + 1, end, code, 16);
            good = parsed.ec == std::errc() && parsed.ptr == end;
        }
        if (!good && !named) {
            return unexpected(
                json, at, expected_color(floats) + did_you_mean(json.text, color_names()));
        }
        if (!named && digits == 8) {
            floats[3] = static_cast<float>(code & 0xff) / 255.0f;
            code >>= 8;
        }
        for (int i = 0; i < 3; ++i) {
            floats[i] =
                linear_from_srgb(static_cast<float>((code >> (16 - 8 * i)) & 0xff) / 255.0f);
        }
        return Done{};
    }

    Status read_rotation(
        const JsonValue& json, const FieldInfo& info, Quat& q, const JsonLocation& at) const {
        const bool is_euler = json.kind == JsonKind::Array && json.items.size() == 3;
        if (!is_euler && (json.kind != JsonKind::Array || json.items.size() != 4)) {
            return unexpected(
                json, at, "a quaternion [x, y, z, w] or angles [yaw, pitch, roll] in degrees");
        }
        FieldInfo plain = info;
        plain.meta = {.unit = is_euler ? "deg" : ""};
        float v[4] = {};
        LIMN_TRY(read_floats(json, plain, {v, json.items.size()}, at));
        if (is_euler) {
            q = rotation_from_degrees({v[0], v[1], v[2]});
            return Done{};
        }
        const float largest =
            std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), std::abs(v[3])});
        if (largest == 0.0f) {
            return error_at(at, json.at, "a quaternion of length 0", "a nonzero one");
        }
        // Scaled by the largest component first, so that no square overflows.
        const Vec4 scaled(v[0] / largest, v[1] / largest, v[2] / largest, v[3] / largest);
        const Vec4 unit = scaled / std::sqrt(glm::dot(scaled, scaled));
        q = Quat(unit.w, unit.x, unit.y, unit.z);
        return Done{};
    }

    Status read_enum(
        const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& at) const {
        const std::optional<std::uint64_t> value =
            json.kind == JsonKind::String ? find_enumerator(info, json.text) : std::nullopt;
        if (!value) {
            const std::string hint = json.kind == JsonKind::String
                                         ? did_you_mean(json.text, info.values)
                                         : std::string();
            return unexpected(
                json, at, fmt::format("one of {}", fmt::join(info.values, " ")) + hint);
        }
        std::memcpy(field, &*value, info.size);  // little-endian
        return Done{};
    }

    Status read_name(
        const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& at) const {
        const bool is_entity = info.type == FieldType::Entity;
        const std::string kind = is_entity ? "entity" : info.asset;
        if (json.kind != JsonKind::String && json.kind != JsonKind::Null) {
            FieldInfo one = info;
            one.shape = FieldShape::One;
            return unexpected(json, at, "the " + type_text(one) + ", or null");
        }
        bool found = false;
        if (is_entity) {
            Entity& entity = *static_cast<Entity*>(field);
            std::optional<Entity> named = Entity{};
            if (json.kind == JsonKind::String) {
                named = names.entity ? names.entity(json.text, json.at) : std::nullopt;
            }
            found = named.has_value();
            entity = named.value_or(Entity{});
        } else {
            std::optional<std::uint32_t> index = std::numeric_limits<std::uint32_t>::max();
            if (json.kind == JsonKind::String) {
                index = names.asset ? names.asset(kind, json.text, json.at) : std::nullopt;
            }
            found = index.has_value();
            const std::uint32_t value = index.value_or(0);
            std::memcpy(field, &value, sizeof(value));
        }
        if (!found) {
            const std::vector<std::string_view> all =
                names.all ? names.all(kind) : std::vector<std::string_view>();
            return error_at(
                at, json.at, fmt::format("the {} {}", kind, in_quotes(json.text)),
                (all.empty() ? "none, since no names of that kind exist here" : "an existing name")
                    + did_you_mean(json.text, all));
        }
        return Done{};
    }
};

JsonValue write_floats(const FieldInfo& info, const void* field) {
    const auto* floats = static_cast<const float*>(field);
    std::vector<JsonValue> items;
    for (std::size_t i = 0; i < info.size / sizeof(float); ++i) {
        items.push_back(json_of(floats[i]));
    }
    return items.size() == 1 ? items[0] : json_array(std::move(items));
}

JsonValue write_integer(const FieldInfo& info, const void* field) {
    std::uint64_t value = 0;
    std::memcpy(&value, field, info.size);
    if (info.type == FieldType::UInt) {
        return json_of(value);
    }
    const unsigned unused = 64 - 8 * info.size;  // sign bits come back with the shift
    return json_of(static_cast<std::int64_t>(value << unused) >> unused);
}

JsonValue
write_fields(const std::vector<FieldInfo>& fields, const void* object, const NameProvider& names) {
    JsonValue json = json_object();
    for (const FieldInfo& field : fields) {
        json.members.push_back(
            {field.name, {}, write_field(field, field_ptr(object, field), names)});
    }
    return json;
}

JsonValue write_name(const std::string& name) {
    return name.empty() ? JsonValue() : json_of(std::string_view(name));
}

JsonValue write_one(const FieldInfo& info, const void* field, const NameProvider& names) {
    switch (info.type) {
    case FieldType::Bool:
        return json_of(*static_cast<const bool*>(field));
    case FieldType::Int:
    case FieldType::UInt:
        return write_integer(info, field);
    case FieldType::Double:
        return json_of(*static_cast<const double*>(field));
    case FieldType::IVec2:
    case FieldType::IVec3: {
        JsonValue json = json_array();
        for (std::size_t i = 0; i < info.size / sizeof(int); ++i) {
            json.items.push_back(json_of(std::int64_t{static_cast<const int*>(field)[i]}));
        }
        return json;
    }
    case FieldType::Quat: {
        // With few decimals, if they give the same bits.
        const Quat& q = *static_cast<const Quat*>(field);
        const Vec3 exact = degrees_from_rotation(q);
        const Vec3 rounded = glm::round(exact * 1e3f) / 1e3f;
        const Vec3 angles = rotation_from_degrees(rounded) == q ? rounded : exact;
        return json_array({json_of(angles.x), json_of(angles.y), json_of(angles.z)});
    }
    case FieldType::String:
        return json_of(std::string_view(*static_cast<const std::string*>(field)));
    case FieldType::Enum: {
        std::uint64_t index = 0;
        std::memcpy(&index, field, info.size);
        return index < info.values.size() ? json_of(info.values[index]) : JsonValue();
    }
    case FieldType::Entity:
        return write_name(names.entity ? names.entity(*static_cast<const Entity*>(field)) : "");
    case FieldType::Asset: {
        std::uint32_t index = 0;
        std::memcpy(&index, field, sizeof(index));
        return write_name(names.asset ? names.asset(info.asset, index) : "");
    }
    case FieldType::Struct:
        return write_fields(info.fields, field, names);
    default:
        return write_floats(info, field);
    }
}

}  // namespace

Error error_at(
    const JsonLocation& location, SourcePosition at, std::string_view found,
    std::string_view expected) {
    std::string line = location_text(location.file, at);
    if (!location.path.empty()) {
        line += ": " + location.path;
    }
    return fail("{}: found {}, expected {}", line, found, expected);
}

Error unexpected(const JsonValue& json, const JsonLocation& location, std::string_view expected) {
    return error_at(location, json.at, describe(json), expected);
}

JsonLocation item_in(const JsonLocation& location, std::size_t index) {
    return {location.file, fmt::format("{}[{}]", location.path, index)};
}

JsonLocation location_in(const JsonLocation& location, std::string_view key) {
    return {
        location.file,
        location.path.empty() ? std::string(key) : fmt::format("{}.{}", location.path, key)};
}

Status expect(
    const JsonValue& json, JsonKind kind, const JsonLocation& location, std::string_view expected) {
    return json.kind == kind ? Status(Done{}) : unexpected(json, location, expected);
}

Status expect_keys(
    const JsonValue& json, const JsonLocation& location, std::span<const std::string_view> known,
    std::string_view expected) {
    LIMN_TRY(expect(json, JsonKind::Object, location, expected));
    for (const JsonMember& member : json.members) {
        if (std::find(known.begin(), known.end(), member.key) == known.end()) {
            return error_at(
                location, member.at, "the key " + in_quotes(member.key),
                fmt::format("one of {}", fmt::join(known, " ")) + did_you_mean(member.key, known));
        }
    }
    return Done{};
}

Result<double> expect_number(
    const JsonValue& json, double min, double max, const JsonLocation& location,
    std::string_view unit) {
    const std::optional<WrittenNumber> written =
        json.kind == JsonKind::String ? number_with_unit(json.text, unit) : std::nullopt;
    const double number = written ? written->number : json.number;
    const bool is_number = written || json.kind == JsonKind::Number;
    if (written && (number < min || number > max)) {
        return unexpected(
            json, location, expected_in_unit({.min = min, .max = max}, *written->unit));
    }
    if (!is_number || number < min || number > max) {
        return unexpected(
            json, location,
            fmt::format("a number {} .. {}{}{}", min, max, unit.empty() ? "" : " ", unit)
                + or_with_unit(unit));
    }
    return number;
}

std::string constraint_error(const ComponentInfo& info, const void* object) {
    if (&info == &component_info<Transform>()) {
        const Vec3 scale = static_cast<const Transform*>(object)->scale;
        if (scale.x == 0.0f || scale.y == 0.0f || scale.z == 0.0f) {
            return "found a scale of 0, expected a nonzero scale along each axis";
        }
    }
    if (&info == &component_info<SpotLight>()) {
        const auto* light = static_cast<const SpotLight*>(object);
        if (light->inner_angle > light->outer_angle) {
            return fmt::format(
                "found an inner_angle {} above the outer_angle {}, expected at most that",
                light->inner_angle, light->outer_angle);
        }
    }
    if (&info == &component_info<Environment>()) {
        const auto* environment = static_cast<const Environment*>(object);
        if (environment->sky == SkyKind::Panorama && environment->panorama.index == kNoAsset) {
            return "found a panorama sky without the image \"panorama\", expected both";
        }
    }
    return "";
}

Status read_component(
    const JsonValue& json, const ComponentInfo& info, void* object, const JsonLocation& location,
    const NameResolver& names) {
    LIMN_TRY(ComponentReader{names}.read_fields(json, info.fields, object, location));
    if (const std::string problem = constraint_error(info, object); !problem.empty()) {
        return fail("{}: {}: {}", location_text(location.file, json.at), location.path, problem);
    }
    return Done{};
}

Result<AnyComponent> read_component(
    const JsonValue& json, const ComponentInfo& info, const JsonLocation& location,
    const NameResolver& names) {
    AnyComponent component(info);
    LIMN_TRY(read_component(json, info, component.data(), location, names));
    return component;
}

Status read_field(
    const JsonValue& json, const FieldInfo& info, void* field, const JsonLocation& location,
    const NameResolver& names) {
    return ComponentReader{names}.read_shape(json, info, field, location);
}

std::vector<std::string_view> written_units(std::string_view field_unit) {
    std::vector<std::string_view> units;
    for (const WrittenUnit& known : kWrittenUnits) {
        if (known.field == field_unit) {
            units.push_back(known.written);
        }
    }
    return units;
}

JsonValue
write_component(const ComponentInfo& info, const void* object, const NameProvider& names) {
    return write_fields(info.fields, object, names);
}

JsonValue write_field(const FieldInfo& info, const void* field, const NameProvider& names) {
    if (info.shape == FieldShape::One) {
        return write_one(info, field, names);
    }
    JsonValue json = json_array();
    for (std::size_t i = 0; i < element_count(info, field); ++i) {
        json.items.push_back(write_one(info, element_ptr(info, field, i), names));
    }
    return json;
}

void for_each_asset(
    const std::vector<FieldInfo>& fields, void* object,
    const std::function<void(std::string_view, std::uint32_t&)>& visit) {
    for (const FieldInfo& info : fields) {
        if (info.type != FieldType::Asset && info.type != FieldType::Struct) {
            continue;
        }
        void* const data = field_ptr(object, info);
        for (std::size_t i = 0; i < element_count(info, data); ++i) {
            void* const element = element_ptr(info, data, i);
            if (info.type == FieldType::Struct) {
                for_each_asset(info.fields, element, visit);
                continue;
            }
            std::uint32_t index = 0;
            std::memcpy(&index, element, sizeof(index));
            visit(info.asset, index);
            std::memcpy(element, &index, sizeof(index));
        }
    }
}

AnyComponent* find_in(std::span<AnyComponent> components, ComponentId id) {
    const auto found =
        std::find_if(components.begin(), components.end(), [id](const AnyComponent& c) {
            return c.info().id == id;
        });
    return found == components.end() ? nullptr : &*found;
}

Quat rotation_from_degrees(const Vec3& yaw_pitch_roll) {
    // In double, so that multiples of 90 degrees give nearly exact matrices.
    const auto about = [](double angle_deg, int axis) {
        const double half = angle_deg * (3.14159265358979323846 / 360.0);
        glm::dquat q(std::cos(half), 0.0, 0.0, 0.0);
        q[axis] = std::sin(half);
        return q;
    };
    const glm::dquat q = about(static_cast<double>(yaw_pitch_roll.x), 1)
                         * about(static_cast<double>(yaw_pitch_roll.y), 0)
                         * about(static_cast<double>(yaw_pitch_roll.z), 2);
    return Quat(glm::normalize(q));
}

Vec3 degrees_from_rotation(const Quat& q) {
    const glm::dmat3 r = glm::mat3_cast(glm::normalize(glm::dquat(q)));  // r[column][row]
    const double level = std::hypot(r[2][0], r[2][2]);                   // cosine of the pitch
    const bool is_vertical = level < 1e-9;  // yaw and roll turn about one axis: all is yaw
    const double yaw = is_vertical ? std::atan2(-r[0][2], r[0][0]) : std::atan2(r[2][0], r[2][2]);
    const double pitch = std::atan2(-r[2][1], level);
    const double roll = is_vertical ? 0 : std::atan2(r[0][1], r[1][1]);
    return Vec3(glm::degrees(glm::dvec3(yaw, pitch, roll))) + Vec3(0.0f);  // -0 becomes 0
}

}  // namespace limn
