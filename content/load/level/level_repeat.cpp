#include "content/load/level/level_repeat.h"

#include "ecs/base/hash.h"
#include "ecs/base/rng.h"
#include "ecs/base/text.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

constexpr std::string_view kByNames[] = {"random", "x", "y", "z", "radius", "angle", "index"};
constexpr std::string_view kVariationKeys[] = {"by", "from", "to", "pick", "noise", "times"};

/// The numbers of `from` or `to`, one per lane of the field. Validated by reading them into a copy
/// of the component.
Result<std::vector<double>> read_lanes(
    const JsonValue& json, const Variation& variation, const AnyComponent& component,
    const JsonLocation& location, const NameResolver& names) {
    const FieldInfo& field = *variation.field;
    std::vector<double> lanes;
    if (field.type == FieldType::Quat) {
        if (json.items.size() != 3) {
            return unexpected(json, location, "angles [yaw, pitch, roll] in degrees");
        }
        FieldInfo angle;
        angle.meta = {.unit = "deg", .min = -1e6, .max = 1e6};
        angle.type = FieldType::Double;
        lanes.resize(json.items.size());
        for (std::size_t i = 0; i < lanes.size(); ++i) {
            LIMN_TRY(read_field(json.items[i], angle, &lanes[i], item_in(location, i), names));
        }
        return lanes;
    }
    AnyComponent scratch = component;
    void* const data = static_cast<std::byte*>(scratch.data()) + variation.offset;
    LIMN_TRY(read_field(json, field, data, location, names));
    for (int lane = 0; lane < number_count(field.type); ++lane) {
        lanes.push_back(get_number(field, data, lane));
    }
    return lanes;
}

Status read_picks(
    const JsonValue& json, const AnyComponent& component, const JsonLocation& location,
    const NameResolver& names, Variation& variation) {
    if (json.kind != JsonKind::Array || json.items.empty()) {
        return unexpected(json, location, "an array of values");
    }
    for (const JsonValue& item : json.items) {
        AnyComponent& pick = variation.picks.emplace_back(component);
        void* const data = static_cast<std::byte*>(pick.data()) + variation.offset;
        LIMN_TRY(read_field(item, *variation.field, data, location, names));
    }
    return Done{};
}

Status read_options(const JsonValue& json, const JsonLocation& location, Variation& variation) {
    if (const JsonValue* const by = json.find("by")) {
        const auto name = std::find(std::begin(kByNames), std::end(kByNames), by->text);
        if (by->kind != JsonKind::String || name == std::end(kByNames)) {
            return unexpected(
                *by, location,
                fmt::format("one of {}", fmt::join(kByNames, " "))
                    + did_you_mean(by->text, kByNames));
        }
        variation.by = static_cast<VaryBy>(name - std::begin(kByNames));
    }
    if (const JsonValue* const noise = json.find("noise")) {
        variation.noise = static_cast<float>(LIMN_TRY(expect_number(*noise, 0.0, 1.0, location)));
    }
    if (const JsonValue* const times = json.find("times")) {
        variation.times = static_cast<float>(LIMN_TRY(expect_number(*times, 0.001, 1e6, location)));
    }
    return Done{};
}

/// Resolves "sway.phase" to a component and its field.
Status find_varied_field(
    const JsonMember& member, std::span<const AnyComponent> components,
    const JsonLocation& location, Variation& variation, const AnyComponent*& component) {
    const std::size_t dot = std::min(member.key.find('.'), member.key.size());
    const std::string_view name = std::string_view(member.key).substr(0, dot);
    std::vector<std::string_view> present;
    for (const AnyComponent& candidate : components) {
        present.emplace_back(candidate.info().name);
        if (candidate.info().name == name) {
            component = &candidate;
        }
    }
    if (component == nullptr) {
        return error_at(
            location, member.at, "the component " + in_quotes(name),
            fmt::format("one that the entity has: {}", fmt::join(present, " "))
                + did_you_mean(name, present));
    }
    AnyComponent scratch = *component;
    const Result<FieldRef> field = field_at(
        scratch.info(), scratch.data(),
        std::string_view(member.key).substr(std::min(dot + 1, member.key.size())));
    if (!field || field->field->shape != FieldShape::One) {
        return error_at(
            location, member.at, "the field " + in_quotes(member.key),
            field ? "a field that is not a list"
                  : "a field of the component: " + field.error().message);
    }
    variation.component = scratch.info().id;
    variation.field = field->field;
    variation.offset = static_cast<std::uint32_t>(
        static_cast<std::byte*>(field->element) - static_cast<std::byte*>(scratch.data()));
    variation.name_hash = name_hash(member.key);
    return Done{};
}

Result<Variation> read_variation(
    const JsonMember& member, std::span<const AnyComponent> components, const JsonLocation& outer,
    const NameResolver& names) {
    const JsonLocation location = location_in(outer, member.key);
    Variation variation;
    const AnyComponent* component = nullptr;
    LIMN_TRY(find_varied_field(member, components, location, variation, component));
    LIMN_TRY(expect_keys(member.value, location, kVariationKeys));
    LIMN_TRY(read_options(member.value, location, variation));
    const JsonValue* const pick = member.value.find("pick");
    const JsonValue* const from = member.value.find("from");
    const JsonValue* const to = member.value.find("to");
    if ((pick != nullptr) == (from != nullptr) || (from != nullptr) != (to != nullptr)) {
        return error_at(location, member.value.at, "other keys", "either pick, or from and to");
    }
    if (pick != nullptr) {
        LIMN_TRY(read_picks(*pick, *component, location, names, variation));
        return variation;
    }
    if (number_count(variation.field->type) == 0) {
        return error_at(
            location, member.value.at, "from and to", "pick, since the field is not numeric");
    }
    for (const auto& [json, lanes] :
         {std::pair(from, &variation.from), std::pair(to, &variation.to)}) {
        *lanes = LIMN_TRY(read_lanes(*json, variation, *component, location, names));
    }
    return variation;
}

/// Position of a copy in the grid.
struct Cell {
    IVec3 at;
    Vec3 parameter;  ///< 0 .. 1 along each axis; 0 if there is only one copy
};

Cell cell_of(const RepeatGrid& grid, std::uint64_t index) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto count = static_cast<std::uint64_t>(grid.count[axis]);
        cell.at[axis] = static_cast<int>(index % count);
        index /= count;
        cell.parameter[axis] =
            count > 1 ? static_cast<float>(cell.at[axis]) / static_cast<float>(count - 1) : 0.0f;
    }
    return cell;
}

/// Offset from the center of the grid to the cell, in copies.
Vec3 from_center(const RepeatGrid& grid, const Cell& cell) {
    return Vec3(cell.at) - 0.5f * Vec3(grid.count - IVec3(1));
}

/// The parameter of the copy before noise, 0 .. 1; for VaryBy::Random one per lane.
float parameter_of(
    const Variation& variation, const RepeatGrid& grid, const Cell& cell, std::uint64_t index,
    float random) {
    switch (variation.by) {
    case VaryBy::Random:
        return random;
    case VaryBy::X:
        return cell.parameter.x;
    case VaryBy::Y:
        return cell.parameter.y;
    case VaryBy::Z:
        return cell.parameter.z;
    case VaryBy::Radius: {
        const Vec3 extent = 0.5f * Vec3(grid.count - IVec3(1)) * grid.spacing;
        const float farthest = glm::length(extent);
        return farthest > 0.0f ? glm::length(from_center(grid, cell) * grid.spacing) / farthest
                               : 0.0f;
    }
    case VaryBy::Angle: {
        const Vec3 d = from_center(grid, cell) * grid.spacing;
        return std::atan2(d.x, d.z) / (2.0f * kPi) + 0.5f;
    }
    case VaryBy::Index: {
        const double last = static_cast<double>(grid.count.x) * grid.count.y * grid.count.z - 1.0;
        return last > 0.0 ? static_cast<float>(static_cast<double>(index) / last) : 0.0f;
    }
    }
    return 0.0f;
}

float with_noise_and_times(const Variation& variation, float t, float random) {
    t = std::clamp(t + variation.noise * (random - 0.5f), 0.0f, 1.0f);
    if (variation.times == 1.0f) {
        return t;
    }
    const float turns = t * variation.times;
    return turns - std::floor(turns);
}

void apply_variation(
    const Variation& variation, const Repeat& repeat, std::uint64_t index,
    AnyComponent& component) {
    Random random(repeat.grid.seed, index, variation.name_hash, 0);
    const Cell cell = cell_of(repeat.grid, index);
    const FieldInfo& field = *variation.field;
    void* const data = static_cast<std::byte*>(component.data()) + variation.offset;
    const auto draw = [&] {
        const float t = parameter_of(variation, repeat.grid, cell, index, random.uniform());
        return with_noise_and_times(variation, t, random.uniform());
    };
    const float t = draw();
    if (!variation.picks.empty()) {
        const auto count = variation.picks.size();
        const auto pick =
            std::min(static_cast<std::size_t>(t * static_cast<float>(count)), count - 1);
        const AnyComponent& source = variation.picks[pick];
        copy_field(field, data, static_cast<const std::byte*>(source.data()) + variation.offset);
        return;
    }
    const bool is_per_lane = variation.by == VaryBy::Random && !field.meta.color;
    std::vector<double> lanes(variation.from.size());
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const double weight = static_cast<double>(lane > 0 && is_per_lane ? draw() : t);
        lanes[lane] = variation.from[lane] + (variation.to[lane] - variation.from[lane]) * weight;
    }
    if (field.type == FieldType::Quat) {
        *static_cast<Quat*>(data) = rotation_from_degrees(Vec3(lanes[0], lanes[1], lanes[2]));
        return;
    }
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
        const bool is_whole = field.type == FieldType::Int || field.type == FieldType::UInt
                              || field.type == FieldType::IVec2 || field.type == FieldType::IVec3;
        const double value = is_whole ? std::round(lanes[lane]) : lanes[lane];
        // An interpolation of two values in range is in range as well.
        (void)set_number(field, data, value, static_cast<int>(lane)).ok();
    }
}

void move_copy(const Repeat& repeat, std::uint64_t index, std::span<AnyComponent> components) {
    auto* const transform = find_in<Transform>(components);
    if (transform == nullptr) {
        return;
    }
    const RepeatGrid& grid = repeat.grid;
    const Cell cell = cell_of(grid, index);
    Vec3 offset = (grid.centered ? from_center(grid, cell) : Vec3(cell.at)) * grid.spacing;
    if (grid.radius > 0.0f) {
        const float angle =
            2.0f * kPi * static_cast<float>(cell.at.x) / static_cast<float>(grid.count.x);
        offset.x = grid.radius * std::sin(angle);
        offset.z += grid.radius * std::cos(angle);
        transform->rotation = glm::angleAxis(angle, Vec3(0, 1, 0)) * transform->rotation;
    }
    Random random(grid.seed, index, name_hash("jitter"), 0);
    for (int axis = 0; axis < 3; ++axis) {
        offset[axis] += grid.jitter[axis] * random.uniform(-1.0f, 1.0f);
    }
    transform->position += offset;
    if (auto* const sway = find_in<Sway>(components)) {
        sway->center += offset;
    }
}

}  // namespace

std::uint64_t repeat_count(const Repeat& repeat) {
    return static_cast<std::uint64_t>(repeat.grid.count.x)
           * static_cast<std::uint64_t>(repeat.grid.count.y)
           * static_cast<std::uint64_t>(repeat.grid.count.z);
}

Result<Repeat> read_repeat(
    const JsonValue& json, std::span<const AnyComponent> components, const JsonLocation& location,
    const NameResolver& names) {
    Repeat repeat;
    LIMN_TRY(expect(json, JsonKind::Object, location, "an object"));
    JsonValue grid = json;
    std::erase_if(grid.members, [](const JsonMember& member) { return member.key == "vary"; });
    LIMN_TRY(read_struct(grid, repeat.grid, location, names));
    const JsonValue* const vary = json.find("vary");
    if (vary == nullptr) {
        return repeat;
    }
    const JsonLocation inner = location_in(location, "vary");
    LIMN_TRY(expect(*vary, JsonKind::Object, inner, "an object"));
    for (const JsonMember& member : vary->members) {
        repeat.variations.push_back(LIMN_TRY(read_variation(member, components, inner, names)));
    }
    return repeat;
}

void apply_repeat(const Repeat& repeat, std::uint64_t index, std::span<AnyComponent> components) {
    for (const Variation& variation : repeat.variations) {
        if (AnyComponent* const component = find_in(components, variation.component)) {
            apply_variation(variation, repeat, index, *component);
        }
    }
    move_copy(repeat, index, components);
}

}  // namespace limn
