#include "content/load/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace limn {

namespace {

enum class Shape : std::uint8_t {
    Object,
    Array,    ///< min .. max items
    Index,    ///< of an item of the array at the path `text`
    Integer,  ///< min .. max, a whole number
    Number,   ///< min .. max
    Numbers,  ///< `length` of them, each min .. max
    String,   ///< one of `text`, separated by spaces, unless that is empty
    Bool,
};

constexpr bool kRequired = true;
constexpr double kLargestNumber = 1e9;  ///< no length, angle or intensity is larger
constexpr double kLargestSize = 9e15;   ///< integers that a double holds exactly

/// A constraint on all values at `path`: "a.b" is a member, "a[]" every item of an array, "a.*"
/// every member. Members may be absent unless the last one is `required`.
struct Rule {
    const char* path;
    Shape shape;
    bool required = false;
    double min = -kLargestNumber;
    double max = kLargestNumber;
    int length = 0;
    const char* text = "";
};

constexpr const char* kLights = "extensions.KHR_lights_punctual.lights";
// Rounded up: files hold them as floats.
constexpr double kHalfPi = 1.5707964;
constexpr double kMaxYfov = 3.1415928;

constexpr Rule index_of(const char* path, const char* target, bool required = false) {
    return {path, Shape::Index, required, 0, 0, 0, target};
}
constexpr Rule
size(const char* path, double min, bool required = false, double max = kLargestSize) {
    return {path, Shape::Integer, required, min, max};
}
constexpr Rule factor(const char* path, double max = 1.0, bool required = false) {
    return {path, Shape::Number, required, 0, max};
}
constexpr Rule factors(const char* path, int length, double max = 1.0) {
    return {path, Shape::Numbers, false, 0, max, length};
}
constexpr Rule numbers(const char* path, int length) {
    return {path, Shape::Numbers, false, -kLargestNumber, kLargestNumber, length};
}
constexpr Rule text(const char* path, const char* values = "", bool required = false) {
    return {path, Shape::String, required, 0, 0, 0, values};
}
constexpr Rule object(const char* path, bool required = false) {
    return {path, Shape::Object, required};
}
constexpr Rule array(const char* path, double min = 0) {
    return {path, Shape::Array, false, min, kLargestSize};
}
constexpr Rule required_array(const char* path, double min) {
    return {path, Shape::Array, kRequired, min, kLargestSize};
}

// Containers before their contents: a rule assumes that the path to its value is valid.
constexpr Rule kRules[] = {
    object("asset", kRequired),
    text("asset.version", "", kRequired),
    array("extensionsUsed"),
    text("extensionsUsed[]"),
    array("extensionsRequired"),
    text("extensionsRequired[]"),
    object("extensions"),
    object("extensions.KHR_lights_punctual"),

    array("buffers"),
    object("buffers[]"),
    text("buffers[].uri"),
    size("buffers[].byteLength", 1, kRequired),

    array("bufferViews"),
    object("bufferViews[]"),
    index_of("bufferViews[].buffer", "buffers", kRequired),
    size("bufferViews[].byteOffset", 0),
    size("bufferViews[].byteLength", 1, kRequired),
    size("bufferViews[].byteStride", 4, false, 252),

    array("accessors"),
    object("accessors[]"),
    index_of("accessors[].bufferView", "bufferViews"),
    size("accessors[].byteOffset", 0),
    size("accessors[].componentType", 0, kRequired, 65535),
    size("accessors[].count", 1, kRequired, 4294967295.0),
    text("accessors[].type", "", kRequired),
    {"accessors[].normalized", Shape::Bool},
    object("accessors[].sparse"),
    size("accessors[].sparse.count", 1, kRequired, 2147483647.0),
    object("accessors[].sparse.indices", kRequired),
    index_of("accessors[].sparse.indices.bufferView", "bufferViews", kRequired),
    size("accessors[].sparse.indices.byteOffset", 0, false, 2147483647.0),
    size("accessors[].sparse.indices.componentType", 5121, kRequired, 5125),
    object("accessors[].sparse.values", kRequired),
    index_of("accessors[].sparse.values.bufferView", "bufferViews", kRequired),
    size("accessors[].sparse.values.byteOffset", 0, false, 2147483647.0),

    array("images"),
    object("images[]"),
    text("images[].name"),
    text("images[].uri"),
    index_of("images[].bufferView", "bufferViews"),
    array("samplers"),
    object("samplers[]"),
    size("samplers[].magFilter", 0),
    size("samplers[].minFilter", 0),
    size("samplers[].wrapS", 0),
    size("samplers[].wrapT", 0),
    array("textures"),
    object("textures[]"),
    index_of("textures[].source", "images"),
    index_of("textures[].sampler", "samplers"),

    array("materials"),
    object("materials[]"),
    text("materials[].name"),
    text("materials[].alphaMode", "OPAQUE MASK BLEND"),
    factor("materials[].alphaCutoff", kLargestNumber),
    {"materials[].doubleSided", Shape::Bool},
    factors("materials[].emissiveFactor", 3),
    object("materials[].extensions"),
    object("materials[].extensions.KHR_materials_transmission"),
    factor("materials[].extensions.KHR_materials_transmission.transmissionFactor"),
    object("materials[].extensions.KHR_materials_ior"),
    factor("materials[].extensions.KHR_materials_ior.ior", kLargestNumber),
    object("materials[].extensions.KHR_materials_volume"),
    factor("materials[].extensions.KHR_materials_volume.thicknessFactor", kLargestNumber),
    factor("materials[].extensions.KHR_materials_volume.attenuationDistance", kLargestNumber),
    factors("materials[].extensions.KHR_materials_volume.attenuationColor", 3),
    object("materials[].extensions.KHR_materials_emissive_strength"),
    factor(
        "materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", kLargestNumber),
    object("materials[].pbrMetallicRoughness"),
    factors("materials[].pbrMetallicRoughness.baseColorFactor", 4),
    factor("materials[].pbrMetallicRoughness.metallicFactor"),
    factor("materials[].pbrMetallicRoughness.roughnessFactor"),
    object("materials[].normalTexture"),
    {"materials[].normalTexture.scale", Shape::Number},
    object("materials[].occlusionTexture"),
    factor("materials[].occlusionTexture.strength"),

    array("cameras"),
    object("cameras[]"),
    text("cameras[].name"),
    text("cameras[].type", "perspective orthographic", kRequired),
    object("cameras[].orthographic"),
    object("cameras[].perspective"),
    {"cameras[].perspective.yfov", Shape::Number, kRequired, 1e-6, kMaxYfov},
    {"cameras[].perspective.znear", Shape::Number, kRequired, 1e-9, kLargestNumber},

    array(kLights),
    object("extensions.KHR_lights_punctual.lights[]"),
    text("extensions.KHR_lights_punctual.lights[].name"),
    text("extensions.KHR_lights_punctual.lights[].type", "", kRequired),
    factors("extensions.KHR_lights_punctual.lights[].color", 3, kLargestNumber),
    factor("extensions.KHR_lights_punctual.lights[].intensity", kLargestNumber),
    {"extensions.KHR_lights_punctual.lights[].range", Shape::Number, false, 1e-6, kLargestNumber},
    object("extensions.KHR_lights_punctual.lights[].spot"),
    factor("extensions.KHR_lights_punctual.lights[].spot.innerConeAngle", kHalfPi),
    factor("extensions.KHR_lights_punctual.lights[].spot.outerConeAngle", kHalfPi),

    array("meshes"),
    object("meshes[]"),
    text("meshes[].name"),
    required_array("meshes[].primitives", 1),
    object("meshes[].primitives[]"),
    object("meshes[].primitives[].attributes", kRequired),
    index_of("meshes[].primitives[].attributes.*", "accessors"),
    index_of("meshes[].primitives[].indices", "accessors"),
    index_of("meshes[].primitives[].material", "materials"),
    size("meshes[].primitives[].mode", 0, false, 6),
    array("meshes[].primitives[].targets"),
    object("meshes[].primitives[].targets[]"),
    index_of("meshes[].primitives[].targets[].*", "accessors"),
    array("meshes[].weights"),
    {"meshes[].weights[]", Shape::Number},

    array("skins"),
    object("skins[]"),
    text("skins[].name"),
    required_array("skins[].joints", 1),
    index_of("skins[].joints[]", "nodes"),
    index_of("skins[].inverseBindMatrices", "accessors"),

    array("animations"),
    object("animations[]"),
    text("animations[].name"),
    required_array("animations[].samplers", 1),
    object("animations[].samplers[]"),
    index_of("animations[].samplers[].input", "accessors", kRequired),
    index_of("animations[].samplers[].output", "accessors", kRequired),
    text("animations[].samplers[].interpolation", "LINEAR STEP CUBICSPLINE"),
    required_array("animations[].channels", 1),
    object("animations[].channels[]"),
    size("animations[].channels[].sampler", 0, kRequired),
    object("animations[].channels[].target", kRequired),
    index_of("animations[].channels[].target.node", "nodes"),
    text("animations[].channels[].target.path", "", kRequired),

    array("nodes"),
    object("nodes[]"),
    text("nodes[].name"),
    array("nodes[].children"),
    index_of("nodes[].children[]", "nodes"),
    index_of("nodes[].mesh", "meshes"),
    index_of("nodes[].camera", "cameras"),
    index_of("nodes[].skin", "skins"),
    numbers("nodes[].matrix", 16),
    numbers("nodes[].translation", 3),
    numbers("nodes[].rotation", 4),
    numbers("nodes[].scale", 3),
    array("nodes[].weights"),
    {"nodes[].weights[]", Shape::Number},
    object("nodes[].extensions"),
    object("nodes[].extensions.KHR_lights_punctual"),
    index_of("nodes[].extensions.KHR_lights_punctual.light", kLights, kRequired),

    array("scenes"),
    object("scenes[]"),
    array("scenes[].nodes"),
    index_of("scenes[].nodes[]", "nodes"),
    index_of("scene", "scenes"),
};

/// The texture references of a material; each has the rules of a textureInfo.
constexpr const char* kTextureInfos[] = {
    "materials[].pbrMetallicRoughness.baseColorTexture",
    "materials[].pbrMetallicRoughness.metallicRoughnessTexture",
    "materials[].normalTexture",
    "materials[].occlusionTexture",
    "materials[].emissiveTexture",
};
constexpr Rule kTextureRules[] = {
    object(""),
    index_of(".index", "textures", kRequired),
    size(".texCoord", 0, false, 255),
    object(".extensions"),
    object(".extensions.KHR_texture_transform"),
    numbers(".extensions.KHR_texture_transform.offset", 2),
    {".extensions.KHR_texture_transform.rotation", Shape::Number},
    numbers(".extensions.KHR_texture_transform.scale", 2),
    size(".extensions.KHR_texture_transform.texCoord", 0, false, 255),
};

/// One step of the path to a value, for messages.
struct Step {
    std::string_view key;      ///< of a member; "" for an item
    std::size_t position = 0;  ///< of an item
};

class Checker {
  public:
    Checker(const JsonValue& root, const std::string& file) : root_(root), file_(file) {}

    Status check(const Rule& rule) {
        rule_ = &rule;
        steps_.clear();
        target_size_ = 0;
        if (rule.shape == Shape::Index) {
            const JsonValue* target = find_target(rule.text);
            target_size_ = target != nullptr ? target->items.size() : 0;
        }
        return walk(root_, rule.path);
    }

  private:
    [[nodiscard]] const JsonValue* find_target(std::string_view path) const {
        const JsonValue* value = &root_;
        while (value != nullptr && !path.empty()) {
            const std::size_t dot = std::min(path.find('.'), path.size());
            value = value->find(path.substr(0, dot));
            path.remove_prefix(std::min(dot + 1, path.size()));
        }
        return value;
    }

    /// Recurses once for each step of the rule's path, so never deeply.
    Status walk(const JsonValue& value, std::string_view path) {
        if (path.empty()) {
            return check_value(value);
        }
        if (path.starts_with("[]")) {
            path.remove_prefix(path.starts_with("[].") ? 3 : 2);
            for (std::size_t i = 0; i < value.items.size(); ++i) {
                LIMN_TRY(descend(value.items[i], {"", i}, path));
            }
            return Done{};
        }
        if (path.starts_with("*")) {
            for (const JsonMember& member : value.members) {
                LIMN_TRY(descend(member.value, {member.key}, path.substr(1)));
            }
            return Done{};
        }
        const std::size_t end = std::min(path.find_first_of(".["), path.size());
        const std::string_view key = path.substr(0, end);
        path.remove_prefix(end);
        if (path.starts_with(".")) {
            path.remove_prefix(1);
        }
        if (const JsonValue* member = value.find(key); member != nullptr) {
            return descend(*member, {key}, path);
        }
        if (path.empty() && rule_->required) {
            steps_.push_back({key});
            return fail("{}: {}: found nothing, expected {}", file_, place(), expectation());
        }
        return Done{};
    }

    Status descend(const JsonValue& value, Step step, std::string_view path) {
        steps_.push_back(step);
        LIMN_TRY(walk(value, path));
        steps_.pop_back();
        return Done{};
    }

    Status check_value(const JsonValue& value) const {
        if (fits(value)) {
            return Done{};
        }
        return fail(
            "{}: {}: found {}, expected {}", file_, place(), describe(value), expectation());
    }

    [[nodiscard]] bool fits(const JsonValue& value) const {
        const auto is_number = [this](const JsonValue& v) {
            return v.kind == JsonKind::Number && v.number >= rule_->min && v.number <= rule_->max;
        };
        const auto is_integer = [](const JsonValue& v) {
            return v.kind == JsonKind::Number && v.number >= 0 && v.number <= kLargestSize
                   && v.number == std::floor(v.number);
        };
        switch (rule_->shape) {
        case Shape::Object:
            return value.kind == JsonKind::Object;
        case Shape::Array:
            return value.kind == JsonKind::Array
                   && static_cast<double>(value.items.size()) >= rule_->min;
        case Shape::Index:
            return is_integer(value) && value.number < static_cast<double>(target_size_);
        case Shape::Integer:
            return is_integer(value) && is_number(value);
        case Shape::Number:
            return is_number(value);
        case Shape::Numbers:
            return value.kind == JsonKind::Array
                   && value.items.size() == static_cast<std::size_t>(rule_->length)
                   && std::all_of(value.items.begin(), value.items.end(), is_number);
        case Shape::String:
            return value.kind == JsonKind::String && is_allowed(value.text);
        case Shape::Bool:
            return value.kind == JsonKind::Bool;
        }
        return false;
    }

    [[nodiscard]] bool is_allowed(std::string_view word) const {
        const std::string_view words = rule_->text;
        for (std::size_t at = 0; !words.empty() && at < words.size();) {
            const std::size_t end = std::min(words.find(' ', at), words.size());
            if (words.substr(at, end - at) == word) {
                return true;
            }
            at = end + 1;
        }
        return words.empty();
    }

    [[nodiscard]] std::string expectation() const {
        const std::string range = fmt::format("from {} to {}", rule_->min, rule_->max);
        switch (rule_->shape) {
        case Shape::Object:
            return "an object";
        case Shape::Array:
            return rule_->min > 0 ? fmt::format("an array of at least {}", rule_->min) : "an array";
        case Shape::Index:
            return target_size_ > 0 ? fmt::format("an index below {}", target_size_)
                                    : fmt::format("no index, since there are no {}", rule_->text);
        case Shape::Integer:
            return "a whole number " + range;
        case Shape::Number:
            return "a number " + range;
        case Shape::Numbers:
            return fmt::format("{} numbers {}", rule_->length, range);
        case Shape::String:
            return *rule_->text != 0 ? fmt::format("one of {}", rule_->text) : "a string";
        case Shape::Bool:
            return "true or false";
        }
        return "";
    }

    [[nodiscard]] std::string place() const {
        std::string result;
        for (const Step& step : steps_) {
            if (step.key.empty()) {
                result += fmt::format("[{}]", step.position);
            } else {
                result += result.empty() ? "" : ".";
                result += step.key;
            }
        }
        return result;
    }

    const JsonValue& root_;
    const std::string& file_;
    const Rule* rule_ = nullptr;
    std::vector<Step> steps_;
    std::size_t target_size_ = 0;
};

/// Fails unless each item has the member that its type asks for.
Status check_member_of_type(
    const std::vector<JsonValue>& items, std::string_view type, std::string_view path,
    const std::string& file) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i]["type"].text == type && items[i].find(type) == nullptr) {
            return fail("{}: {}[{}].{}: found nothing, expected an object", file, path, i, type);
        }
    }
    return Done{};
}

}  // namespace

Status check_gltf_schema(const JsonValue& json, const std::string& file) {
    if (json.kind != JsonKind::Object) {
        return fail("{}: found {}, expected an object", file, describe(json));
    }
    Checker checker(json, file);
    for (const Rule& rule : kRules) {
        LIMN_TRY(checker.check(rule));
    }
    for (const char* info : kTextureInfos) {
        for (const Rule& rule : kTextureRules) {
            const std::string path = std::string(info) + rule.path;
            Rule placed = rule;
            placed.path = path.c_str();
            LIMN_TRY(checker.check(placed));
        }
    }
    const std::vector<JsonValue>& cameras = json["cameras"].items;
    LIMN_TRY(check_member_of_type(cameras, "perspective", "cameras", file));
    LIMN_TRY(check_member_of_type(cameras, "orthographic", "cameras", file));
    const JsonValue& lights = json["extensions"]["KHR_lights_punctual"]["lights"];
    return check_member_of_type(lights.items, "spot", kLights, file);
}

}  // namespace limn
