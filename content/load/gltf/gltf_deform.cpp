#include "content/load/gltf/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string_view>
#include <utility>

// Techniques: char.morph-target, char.skin-limits

namespace limn {

namespace {

constexpr std::size_t kInfluences = 4;  ///< influences per vertex of one set
constexpr double kMaxDeviation = 1e-3;  ///< of a sum of weights from 1
/// Lower bound of weights of 0 after rounding.
constexpr float kMinWeight = -1e-3f;
constexpr std::string_view kRegion = "_REGION_";
constexpr std::string_view kAcross = "_ACROSS_";
constexpr std::size_t kMaxRegions = 256;
/// [m]; same as for positions.
constexpr float kLargestOffset = 1e9f;

using Influence = std::pair<std::uint16_t, double>;

/// One JOINTS_n with its WEIGHTS_n.
struct InfluenceSet {
    std::string joints_where;
    std::string weights_where;
    std::vector<float> joints;
    std::vector<float> weights;
};

/// Reads an attribute; `is_finite`: fails on numbers that are not finite.
Result<std::vector<float>> read_attribute(
    GltfDocument& document, const GltfVertices& vertices, int accessor, int width,
    const std::string& where, bool is_finite = true) {
    const auto read = is_finite ? read_floats : read_any_floats;
    std::vector<float> values = LIMN_TRY(read(document, accessor, width, where));
    if (values.size() != vertices.count * static_cast<std::size_t>(width)) {
        return fail(
            "{}: found {} elements, expected as many as POSITION has, {}", where,
            values.size() / static_cast<std::size_t>(width), vertices.count);
    }
    return values;
}

Result<std::vector<InfluenceSet>>
read_influence_sets(GltfDocument& document, const GltfVertices& vertices) {
    const std::map<std::string, int>& attributes = vertices.primitive.attributes;
    std::vector<InfluenceSet> sets;
    for (int n = 0;; ++n) {
        const std::string names[] = {fmt::format("JOINTS_{}", n), fmt::format("WEIGHTS_{}", n)};
        const auto joints = attributes.find(names[0]);
        const auto weights = attributes.find(names[1]);
        if (joints == attributes.end() && weights == attributes.end()) {
            return sets;
        }
        if (joints == attributes.end() || weights == attributes.end()) {
            return fail(
                "{}.attributes: found {} alone, expected {} and {}", vertices.where,
                names[joints == attributes.end() ? 1 : 0], names[0], names[1]);
        }
        InfluenceSet set;
        set.joints_where = fmt::format("{}.attributes.{}", vertices.where, names[0]);
        set.weights_where = fmt::format("{}.attributes.{}", vertices.where, names[1]);
        const int type = item_at(document.model.accessors, joints->second).componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
            && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
            return fail(
                "{}: accessors[{}].componentType: found {}, expected 5121 or 5123",
                set.joints_where, joints->second, type);
        }
        set.joints = LIMN_TRY(
            read_attribute(document, vertices, joints->second, kInfluences, set.joints_where));
        set.weights = LIMN_TRY(read_attribute(
            document, vertices, weights->second, kInfluences, set.weights_where, false));
        sets.push_back(std::move(set));
    }
}

/// Vertices whose weights had to be changed: how many, and the first.
struct ChangedWeights {
    std::size_t count = 0;
    std::uint32_t vertex = 0;
    double sum = 0;

    void add(std::uint32_t changed, double found) {
        if (count++ == 0) {
            vertex = changed;
            sum = found;
        }
    }
};

void append_influences(SkinWeights& skin, std::vector<Influence>& influences, double sum) {
    std::sort(influences.begin(), influences.end());
    const std::size_t begin = skin.joints.size();
    for (const auto& [joint, weight] : influences) {
        const auto normalized = static_cast<float>(weight / sum);
        if (normalized == 0.0f) {  // negligible next to the others
            continue;
        }
        if (skin.joints.size() > begin && skin.joints.back() == joint) {
            skin.weights.back() += normalized;
        } else {
            skin.joints.push_back(joint);
            skin.weights.push_back(normalized);
        }
    }
}

/// Invalid influences: how many, and the first.
struct BadInfluences {
    std::size_t count = 0;
    std::string first;

    void add(const std::string& where, const std::string& found, std::uint32_t vertex) {
        if (count++ == 0) {
            first = fmt::format("{}: found {} in element {}", where, found, vertex);
        }
    }
};

/// The influences of vertex `vertex` of the file, without zero weights.
void gather_influences(
    const std::vector<InfluenceSet>& sets, std::uint32_t vertex, std::size_t joints,
    std::vector<Influence>& influences, BadInfluences& bad) {
    influences.clear();
    for (const InfluenceSet& set : sets) {
        for (std::size_t i = kInfluences * vertex; i < kInfluences * (vertex + std::size_t{1});
             ++i) {
            const float weight = set.weights[i];
            if (weight < kMinWeight || !std::isfinite(weight)) {
                bad.add(set.weights_where, fmt::format("the weight {}", weight), vertex);
                continue;
            }
            // A tiny weight would vanish, and its sum with it, in the division below.
            if (!(weight > 1e-9f)) {
                continue;
            }
            if (set.joints[i] >= static_cast<float>(joints)) {
                bad.add(
                    set.joints_where,
                    fmt::format("joint {} of a skin of {}", set.joints[i], joints), vertex);
                continue;
            }
            influences.emplace_back(static_cast<std::uint16_t>(set.joints[i]), weight);
        }
    }
}

/// Displacements of one target at all vertices of the primitive; empty where it has none.
struct Differences {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<float> tangents;
};

Vec3 vector_at(const std::vector<float>& values, std::size_t element) {
    return values.empty()
               ? Vec3(0)
               : Vec3(values[3 * element], values[3 * element + 1], values[3 * element + 2]);
}

/// Normalizes; unit vectors are unchanged to the bit.
Vec3 unit_or_zero(const Vec3& direction) {
    const float length = glm::length(direction);
    return std::abs(length - 1.0f) < 1e-6f ? direction : normalize_or(direction, Vec3(0));
}

std::string in_lower_case(std::string_view name) {
    std::string lower(name);
    for (char& letter : lower) {
        letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    return lower;
}

MorphTarget keep_displaced(const Differences& all, std::span<const std::uint32_t> used) {
    MorphTarget target;
    for (std::size_t i = 0; i < used.size(); ++i) {
        const Vec3 position = vector_at(all.positions, used[i]);
        const Vec3 normal = vector_at(all.normals, used[i]);
        const Vec3 tangent = vector_at(all.tangents, used[i]);
        if (position == Vec3(0) && normal == Vec3(0) && tangent == Vec3(0)) {
            continue;
        }
        target.vertices.push_back(static_cast<std::uint32_t>(i));
        target.positions.push_back(position);
        if (!all.normals.empty()) {
            target.normals.push_back(normal);
        }
        if (!all.tangents.empty()) {
            target.tangents.push_back(tangent);
        }
    }
    return target;
}

/// Sets differences of used vertices that are larger than any position to 0, with a warning.
void drop_large(
    GltfDocument& document, const GltfVertices& vertices, std::vector<float>& values,
    const std::string& where) {
    std::size_t count = 0;
    for (const std::uint32_t vertex : vertices.used) {
        const std::span<float> numbers = std::span(values).subspan(3 * std::size_t{vertex}, 3);
        const auto bad =
            std::ranges::find_if(numbers, [](float x) { return !(std::abs(x) <= kLargestOffset); });
        if (bad == numbers.end()) {
            continue;
        }
        if (count++ == 0) {
            document.warnings.push_back(fmt::format(
                "{}: found {} in element {}, expected at most {}; such elements do not move", where,
                *bad, vertex, kLargestOffset));
        }
        std::ranges::fill(numbers, 0.0f);
    }
}

Differences read_differences(
    GltfDocument& document, const GltfVertices& vertices, const std::map<std::string, int>& source,
    const std::string& where) {
    Differences all;
    for (const auto& [name, accessor] : source) {
        std::vector<float>* const target = name == "POSITION"  ? &all.positions
                                           : name == "NORMAL"  ? &all.normals
                                           : name == "TANGENT" ? &all.tangents
                                                               : nullptr;
        const std::string here = fmt::format("{}.{}", where, name);
        if (target == nullptr) {
            document.warnings.push_back(here + " is ignored");
            continue;
        }
        Result<std::vector<float>> values =
            read_attribute(document, vertices, accessor, 3, here, false);
        if (!values) {
            warn_of_loss(document, values.error(), "it is left out");
            continue;
        }
        if (target != &all.normals) {  // which build_mesh recomputes
            drop_large(document, vertices, *values, here);
        }
        *target = *std::move(values);
    }
    return all;
}

/// One driver of a target of `targets`; `where` is that of `source`.
Result<ShapeDriver> read_driver(
    const JsonValue& source, std::span<const MorphTarget> targets, const JsonValue& driven,
    const std::string& where) {
    const JsonValue& name = source["target"];
    const auto target = std::ranges::find(targets, name.text, &MorphTarget::name);
    if (name.kind != JsonKind::String || target == targets.end()) {
        return fail(
            "{}.target: found {}, expected the name of a morph target", where, describe(name));
    }
    if (driven.find(target->name) != nullptr) {
        return fail(
            "{}.target: found {}, expected a morph target without drivers", where, describe(name));
    }
    const JsonValue* const peak = source.find("peak");
    if (peak != nullptr
        && (peak->kind != JsonKind::Number || !(peak->number > 0 && peak->number <= 1))) {
        return fail(
            "{}.peak: found {}, expected a number above 0 and at most 1", where, describe(*peak));
    }
    return ShapeDriver{
        static_cast<std::uint16_t>(target - targets.begin()),
        peak != nullptr ? static_cast<float>(peak->number) : 1.0f};
}

Status read_drivers(
    const JsonValue& drivers, const std::string& where, std::vector<MorphTarget>& targets) {
    for (const JsonMember& member : drivers.members) {
        const auto driven = std::ranges::find(targets, member.key, &MorphTarget::name);
        if (driven == targets.end()) {
            return fail(
                "{}: found {}, expected names of morph targets", where, in_quotes(member.key));
        }
        for (std::size_t i = 0; i < member.value.items.size(); ++i) {
            driven->drivers.push_back(LIMN_TRY(read_driver(
                member.value.items[i], targets, drivers,
                fmt::format("{}.{}[{}]", where, member.key, i))));
        }
    }
    return Done{};
}

}  // namespace

Result<SkinWeights>
read_skin_weights(GltfDocument& document, const GltfVertices& vertices, std::size_t joints) {
    const std::vector<InfluenceSet> sets = LIMN_TRY(read_influence_sets(document, vertices));
    SkinWeights skin;
    if (sets.empty()) {
        return skin;
    }
    ChangedWeights loose;  // no weight at all
    ChangedWeights off;    // did not sum to 1
    BadInfluences bad;
    std::vector<Influence> influences;
    for (const std::uint32_t vertex : vertices.used) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        gather_influences(sets, vertex, joints, influences, bad);
        double sum = 0;
        for (const auto& [joint, weight] : influences) {
            sum += weight;
        }
        if (influences.empty()) {
            loose.add(vertex, 0);
            influences = {{std::uint16_t{0}, 1.0}};
            sum = 1;
        } else if (std::abs(sum - 1.0) > kMaxDeviation) {
            off.add(vertex, sum);
        }
        append_influences(skin, influences, sum);
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    const std::string& where = sets[0].weights_where;
    if (bad.count > 0) {
        document.warnings.push_back(
            fmt::format("{}; {} such influences are left out", bad.first, bad.count));
    }
    if (off.count > 0) {
        document.warnings.push_back(fmt::format(
            "{}: the weights of {} vertices do not sum to 1 and were scaled; of element {} the "
            "sum is {:.4g}",
            where, off.count, off.vertex, off.sum));
    }
    if (loose.count > 0) {
        document.warnings.push_back(fmt::format(
            "{}: {} vertices have no weight and follow the first joint; the first is element {}",
            where, loose.count, loose.vertex));
    }
    return skin;
}

Result<std::vector<MorphTarget>>
read_morph_targets(GltfDocument& document, const GltfVertices& vertices, const JsonValue& extras) {
    const std::vector<JsonValue>& names = extras["targetNames"].items;
    const std::vector<JsonValue>& units = extras["actionUnits"].items;
    std::vector<MorphTarget> targets;
    for (const std::map<std::string, int>& source : vertices.primitive.targets) {
        const std::size_t i = targets.size();
        const Differences all = read_differences(
            document, vertices, source, fmt::format("{}.targets[{}]", vertices.where, i));
        targets.push_back(keep_displaced(all, vertices.used));
        targets.back().name = i < names.size() ? names[i].text : fmt::format("target {}", i);
        targets.back().action_unit = i < units.size() ? units[i].text : "";
    }
    const std::string mesh = vertices.where.substr(0, vertices.where.find(".primitives"));
    LIMN_TRY(read_drivers(extras["targetDrivers"], mesh + ".extras.targetDrivers", targets));
    return targets;
}

Result<std::vector<VertexRegion>>
read_regions(GltfDocument& document, const GltfVertices& vertices) {
    std::vector<VertexRegion> regions;
    const std::map<std::string, int>& attributes = vertices.primitive.attributes;
    for (const auto& [attribute, accessor] : attributes) {
        const std::string here = fmt::format("{}.attributes.{}", vertices.where, attribute);
        if (attribute.starts_with(kAcross)
            && !attributes.contains(std::string(kRegion) + attribute.substr(kAcross.size()))) {
            document.warnings.push_back(here + " is ignored: there is no region of that name");
        }
        if (!attribute.starts_with(kRegion)) {
            continue;
        }
        if (regions.size() == kMaxRegions) {
            return fail("{}: found more regions, expected at most {}", here, kMaxRegions);
        }
        VertexRegion region;
        region.name = in_lower_case(attribute.substr(kRegion.size()));
        const std::vector<float> weights =
            LIMN_TRY(read_attribute(document, vertices, accessor, 1, here));
        for (const std::uint32_t vertex : vertices.used) {
            region.weights.push_back(std::clamp(weights[vertex], 0.0f, 1.0f));
        }
        const std::string other = std::string(kAcross) + attribute.substr(kRegion.size());
        if (const auto across = attributes.find(other); across != attributes.end()) {
            const std::vector<float> values = LIMN_TRY(read_attribute(
                document, vertices, across->second, 3,
                fmt::format("{}.attributes.{}", vertices.where, other)));
            for (const std::uint32_t vertex : vertices.used) {
                region.across.push_back(unit_or_zero(vector_at(values, vertex)));
            }
        }
        regions.push_back(std::move(region));
    }
    return regions;
}

}  // namespace limn
