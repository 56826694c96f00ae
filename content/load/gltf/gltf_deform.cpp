#include "content/load/gltf/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

namespace limn {

namespace {

constexpr std::size_t kInfluences = 4;  ///< influences per vertex of one set
constexpr double kMaxDeviation = 1e-3;  ///< of a sum of weights from 1
/// What a weight of 0 may become by rounding.
constexpr float kMinWeight = -1e-3f;
constexpr std::string_view kRegion = "_REGION_";
constexpr std::string_view kAcross = "_ACROSS_";
constexpr std::size_t kMaxRegions = 256;
/// [m]; same as for positions.
constexpr float kLargestOffset = 1e9f;

using Influence = std::pair<std::uint16_t, double>;

/// One JOINTS_n with its WEIGHTS_n.
struct InfluenceSet {
    std::string joints_place;
    std::string weights_place;
    std::vector<float> joints;
    std::vector<float> weights;
};

Result<std::vector<float>> read_attribute(
    GltfDocument& document, const GltfVertices& vertices, int accessor, int width,
    const std::string& place) {
    std::vector<float> values = LIMN_TRY(read_floats(document, accessor, width, place));
    if (values.size() != vertices.count * static_cast<std::size_t>(width)) {
        return fail(
            "{}: found {} elements, expected as many as POSITION has, {}", place,
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
                "{}.attributes: found {} alone, expected {} and {}", vertices.place,
                names[joints == attributes.end() ? 1 : 0], names[0], names[1]);
        }
        InfluenceSet set;
        set.joints_place = fmt::format("{}.attributes.{}", vertices.place, names[0]);
        set.weights_place = fmt::format("{}.attributes.{}", vertices.place, names[1]);
        const int type = item_at(document.model.accessors, joints->second).componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
            && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) {
            return fail(
                "{}: accessors[{}].componentType: found {}, expected 5121 or 5123",
                set.joints_place, joints->second, type);
        }
        set.joints = LIMN_TRY(
            read_attribute(document, vertices, joints->second, kInfluences, set.joints_place));
        set.weights = LIMN_TRY(
            read_attribute(document, vertices, weights->second, kInfluences, set.weights_place));
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
        const auto share = static_cast<float>(weight / sum);
        if (share == 0.0f) {  // negligible next to the others
            continue;
        }
        if (skin.joints.size() > begin && skin.joints.back() == joint) {
            skin.weights.back() += share;
        } else {
            skin.joints.push_back(joint);
            skin.weights.push_back(share);
        }
    }
}

/// The influences of vertex `vertex` of the file, without zero weights.
Status gather_influences(
    const std::vector<InfluenceSet>& sets, std::uint32_t vertex, std::size_t joints,
    std::vector<Influence>& influences) {
    influences.clear();
    for (const InfluenceSet& set : sets) {
        for (std::size_t i = kInfluences * vertex; i < kInfluences * (vertex + std::size_t{1});
             ++i) {
            const float weight = set.weights[i];
            if (weight < kMinWeight) {
                return fail(
                    "{}: found {} in element {}, expected at least 0", set.weights_place, weight,
                    vertex);
            }
            // A tiny weight would vanish, and its sum with it, in the division below.
            if (!(weight > 1e-9f)) {
                continue;
            }
            if (set.joints[i] >= static_cast<float>(joints)) {
                return fail(
                    "{}: found joint {} in element {}, expected one of the {} of the skin",
                    set.joints_place, set.joints[i], vertex, joints);
            }
            influences.emplace_back(static_cast<std::uint16_t>(set.joints[i]), weight);
        }
    }
    return Done{};
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

/// Unit vectors to the bit as they are.
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

Result<Differences> read_differences(
    GltfDocument& document, const GltfVertices& vertices, const std::map<std::string, int>& source,
    const std::string& place) {
    Differences all;
    for (const auto& [name, accessor] : source) {
        std::vector<float>* const target = name == "POSITION"  ? &all.positions
                                           : name == "NORMAL"  ? &all.normals
                                           : name == "TANGENT" ? &all.tangents
                                                               : nullptr;
        const std::string here = fmt::format("{}.{}", place, name);
        if (target == nullptr) {
            document.warnings.push_back(here + " is ignored");
            continue;
        }
        std::vector<float> values = LIMN_TRY(read_attribute(document, vertices, accessor, 3, here));
        const auto large = std::find_if(values.begin(), values.end(), [](float value) {
            return std::abs(value) > kLargestOffset;
        });
        if (large != values.end()) {
            return fail(
                "{}: found {} in element {}, expected at most {}", here, *large,
                (large - values.begin()) / 3, kLargestOffset);
        }
        *target = std::move(values);
    }
    return all;
}

/// One driver of a target of `targets`; `place` is that of `source`.
Result<ShapeDriver> read_driver(
    const JsonValue& source, std::span<const MorphTarget> targets, const JsonValue& driven,
    const std::string& place) {
    const JsonValue& name = source["target"];
    const auto target = std::ranges::find(targets, name.text, &MorphTarget::name);
    if (name.kind != JsonKind::String || target == targets.end()) {
        return fail(
            "{}.target: found {}, expected the name of a morph target", place, describe(name));
    }
    if (driven.find(target->name) != nullptr) {
        return fail(
            "{}.target: found {}, expected a morph target without drivers", place, describe(name));
    }
    const JsonValue* const peak = source.find("peak");
    if (peak != nullptr
        && (peak->kind != JsonKind::Number || !(peak->number > 0 && peak->number <= 1))) {
        return fail(
            "{}.peak: found {}, expected a number above 0 and at most 1", place, describe(*peak));
    }
    return ShapeDriver{
        static_cast<std::uint16_t>(target - targets.begin()),
        peak != nullptr ? static_cast<float>(peak->number) : 1.0f};
}

Status read_drivers(
    const JsonValue& drivers, const std::string& place, std::vector<MorphTarget>& targets) {
    for (const JsonMember& member : drivers.members) {
        const auto driven = std::ranges::find(targets, member.key, &MorphTarget::name);
        if (driven == targets.end()) {
            return fail(
                "{}: found {}, expected names of morph targets", place, in_quotes(member.key));
        }
        for (std::size_t i = 0; i < member.value.items.size(); ++i) {
            driven->drivers.push_back(LIMN_TRY(read_driver(
                member.value.items[i], targets, drivers,
                fmt::format("{}.{}[{}]", place, member.key, i))));
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
    std::vector<Influence> influences;
    for (const std::uint32_t vertex : vertices.used) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        LIMN_TRY(gather_influences(sets, vertex, joints, influences));
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
    const std::string& place = sets[0].weights_place;
    if (off.count > 0) {
        document.warnings.push_back(fmt::format(
            "{}: the weights of {} vertices do not sum to 1 and were scaled; of element {} the "
            "sum is {:.4g}",
            place, off.count, off.vertex, off.sum));
    }
    if (loose.count > 0) {
        document.warnings.push_back(fmt::format(
            "{}: {} vertices have no weight and follow the first joint; the first is element {}",
            place, loose.count, loose.vertex));
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
        const Differences all = LIMN_TRY(read_differences(
            document, vertices, source, fmt::format("{}.targets[{}]", vertices.place, i)));
        targets.push_back(keep_displaced(all, vertices.used));
        targets.back().name = i < names.size() ? names[i].text : fmt::format("target {}", i);
        targets.back().action_unit = i < units.size() ? units[i].text : "";
    }
    const std::string mesh = vertices.place.substr(0, vertices.place.find(".primitives"));
    LIMN_TRY(read_drivers(extras["targetDrivers"], mesh + ".extras.targetDrivers", targets));
    return targets;
}

Result<std::vector<VertexRegion>>
read_regions(GltfDocument& document, const GltfVertices& vertices) {
    std::vector<VertexRegion> regions;
    const std::map<std::string, int>& attributes = vertices.primitive.attributes;
    for (const auto& [attribute, accessor] : attributes) {
        const std::string here = fmt::format("{}.attributes.{}", vertices.place, attribute);
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
                fmt::format("{}.attributes.{}", vertices.place, other)));
            for (const std::uint32_t vertex : vertices.used) {
                region.across.push_back(unit_or_zero(vector_at(values, vertex)));
            }
        }
        regions.push_back(std::move(region));
    }
    return regions;
}

}  // namespace limn
