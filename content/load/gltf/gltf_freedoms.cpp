#include "content/load/gltf/gltf_freedoms.h"

#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr std::size_t kMaxFreedoms = 3;  // of a joint
constexpr float kMaxAngle = 2 * kPi;     // [rad]

tinygltf::Value number_value(float value) {
    return tinygltf::Value(static_cast<double>(value));
}

std::optional<float> read_number(const JsonValue& json) {
    const auto value = static_cast<float>(json.number);
    return json.kind == JsonKind::Number && std::isfinite(value) ? std::optional(value)
                                                                 : std::nullopt;
}

std::optional<JointFreedom> read_freedom(const JsonValue& json) {
    JointFreedom freedom;
    const std::vector<JsonValue>& axis = json["axis"].items;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::optional<float> part = i < axis.size() ? read_number(axis[i]) : std::nullopt;
        if (!part) {
            return std::nullopt;
        }
        freedom.axis[static_cast<int>(i)] = *part;
    }
    const std::optional<float> min = read_number(json["min"]);
    const std::optional<float> max = read_number(json["max"]);
    const float length = glm::length(freedom.axis);
    if (!min || !max || !(*min <= *max) || *min < -kMaxAngle || *max > kMaxAngle
        || !(length > 1e-6f)) {
        return std::nullopt;
    }
    // What is a unit vector stays as it is, to the bit.
    freedom.axis /= std::abs(length - 1) > 1e-4f ? length : 1.0f;
    freedom.min = *min;
    freedom.max = *max;
    const float middle = read_number(json["middle"]).value_or(0.5f * (*min + *max));
    freedom.middle = std::clamp(middle, *min, *max);
    freedom.stiffness = std::clamp(read_number(json["stiffness"]).value_or(0.0f), 0.0f, 1.0f);
    return freedom;
}

}  // namespace

tinygltf::Value::Array write_joint_limits(const SkeletonData& skeleton, std::uint16_t joint) {
    tinygltf::Value::Array limits;
    for (const JointFreedom& freedom : skeleton.freedoms) {
        if (freedom.joint != joint) {
            continue;
        }
        tinygltf::Value::Array axis;
        for (int i = 0; i < 3; ++i) {
            axis.push_back(number_value(freedom.axis[i]));
        }
        limits.emplace_back(tinygltf::Value::Object{
            {"axis", tinygltf::Value(std::move(axis))},
            {"min", number_value(freedom.min)},
            {"max", number_value(freedom.max)},
            {"middle", number_value(freedom.middle)},
            {"stiffness", number_value(freedom.stiffness)}});
    }
    return limits;
}

void read_joint_limits(GltfDocument& document, GltfScene& scene) {
    for (std::size_t index = 0; index < document.scene_nodes.size(); ++index) {
        const std::int32_t node = document.scene_nodes[index];
        const std::int32_t joint = node < 0 ? -1 : scene.joints.at(static_cast<std::size_t>(node));
        if (joint < 0) {
            continue;
        }
        const std::vector<JsonValue>& limits =
            extras_of(document, "nodes", index)["jointLimits"].items;
        for (std::size_t i = 0; i < limits.size(); ++i) {
            std::optional<JointFreedom> freedom = read_freedom(limits[i]);
            if (!freedom || i >= kMaxFreedoms) {
                document.warnings.push_back(format_text(
                    "{}: nodes[{}].extras.jointLimits[{}]: found {}, expected at most 3 objects "
                    "with an axis and angles min <= max; it is left out",
                    document.file, index, i, describe(limits[i])));
                continue;
            }
            freedom->joint = static_cast<std::uint16_t>(joint);
            scene.skeleton.freedoms.push_back(*freedom);
        }
    }
    std::ranges::stable_sort(scene.skeleton.freedoms, {}, &JointFreedom::joint);
}

}  // namespace limn
