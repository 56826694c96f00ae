#include "content/load/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace limn {

namespace {

constexpr double kLargestNumber = 1e9;  // no length, angle or intensity is larger
constexpr double kLargestSize = 9e15;   // integers that a double holds exactly

// "path: member kind; member kind ..." for the members that are read. A path is of objects: "a.b"
// is a member, "a[]" every item of an array. A member may be absent unless it ends with "!"; "*" is
// every member, "a[]" every item of the member a. Kinds: object, array MIN (items), index ARRAY,
// size MIN MAX (a whole number), number MIN MAX, vecN MIN MAX (N numbers), text WORDS (one of them,
// any without), bool. Angles are rounded up, since files hold them as floats.
constexpr std::string_view kSchema =
    R"(: asset! object; extensionsUsed[] text; extensionsRequired[] text
asset: version! text
buffers[]: uri text; byteLength! size 1
buffers[].extensions.EXT_meshopt_compression: fallback bool
bufferViews[]: buffer! index buffers; byteOffset size; byteLength! size 1; byteStride size 4 252
bufferViews[].extensions.EXT_meshopt_compression: buffer! index buffers; byteOffset size
bufferViews[].extensions.EXT_meshopt_compression: byteLength! size 1; count! size 1 4294967295
bufferViews[].extensions.EXT_meshopt_compression: byteStride! size 2 256
bufferViews[].extensions.EXT_meshopt_compression: mode! text ATTRIBUTES TRIANGLES INDICES
bufferViews[].extensions.EXT_meshopt_compression: filter text NONE OCTAHEDRAL QUATERNION EXPONENTIAL
accessors[]: bufferView index bufferViews; byteOffset size; componentType! size 0 65535
accessors[]: count! size 1 4294967295; type! text; normalized bool
accessors[].sparse: count! size 1 2147483647; indices! object; values! object
accessors[].sparse.indices: bufferView! index bufferViews; byteOffset size 0 2147483647
accessors[].sparse.indices: componentType! size 5121 5125
accessors[].sparse.values: bufferView! index bufferViews; byteOffset size 0 2147483647
images[]: name text; uri text; bufferView index bufferViews
samplers[]: magFilter size 0 65535; minFilter size 0 65535; wrapS size 0 65535; wrapT size 0 65535
textures[]: source index images; sampler index samplers
textures[].extensions.EXT_texture_webp: source index images
materials[]: name text; alphaMode text OPAQUE MASK BLEND; alphaCutoff number 0 1e9
materials[]: doubleSided bool; emissiveFactor vec3 0 1
materials[].extensions.KHR_materials_transmission: transmissionFactor number 0 1
materials[].extensions.KHR_materials_ior: ior number 0 1e9
materials[].extensions.KHR_materials_pbrSpecularGlossiness: diffuseFactor vec4 0 1
materials[].extensions.KHR_materials_pbrSpecularGlossiness: specularFactor vec3 0 1
materials[].extensions.KHR_materials_pbrSpecularGlossiness: glossinessFactor number 0 1
materials[].extensions.KHR_materials_volume: thicknessFactor number 0 1e9
materials[].extensions.KHR_materials_volume: attenuationDistance number 0 1e9
materials[].extensions.KHR_materials_volume: attenuationColor vec3 0 1
materials[].extensions.KHR_materials_emissive_strength: emissiveStrength number 0 1e9
materials[].pbrMetallicRoughness: baseColorFactor vec4 0 1; metallicFactor number 0 1
materials[].pbrMetallicRoughness: roughnessFactor number 0 1
materials[].normalTexture: scale number
materials[].occlusionTexture: strength number 0 1
cameras[]: name text; type! text perspective orthographic
cameras[].orthographic: xmag! number; ymag! number; znear! number 0 1e9
cameras[].perspective: yfov! number 1e-6 3.1415928; znear! number 1e-9 1e9
extensions.KHR_lights_punctual.lights[]: name text; type! text; color vec3 0 1e9
extensions.KHR_lights_punctual.lights[]: intensity number 0 1e9; range number 1e-6 1e9
extensions.KHR_lights_punctual.lights[].spot: innerConeAngle number 0 1.5707964
extensions.KHR_lights_punctual.lights[].spot: outerConeAngle number 0 1.5707964
extensions.KHR_materials_variants.variants[]: name! text
meshes[].primitives[].extensions.KHR_materials_variants.mappings[]: material! index materials; variants! array
meshes[].primitives[].extensions.KHR_materials_variants.mappings[]: variants[] index extensions.KHR_materials_variants.variants
meshes[]: name text; primitives! array 1; weights[] number
meshes[].primitives[]: attributes! object; indices index accessors; material index materials
meshes[].primitives[]: mode size 0 6
meshes[].primitives[].attributes: * index accessors
meshes[].primitives[].targets[]: * index accessors
skins[]: name text; joints! array 1; joints[] index nodes; inverseBindMatrices index accessors
animations[]: name text; samplers! array 1; channels! array 1
animations[].samplers[]: input! index accessors; output! index accessors
animations[].samplers[]: interpolation text LINEAR STEP CUBICSPLINE
animations[].channels[]: sampler! size 0 2147483647; target! object
animations[].channels[].target: node index nodes; path! text
nodes[]: name text; children[] index nodes; mesh index meshes; camera index cameras
nodes[]: skin index skins; matrix vec16; translation vec3; rotation vec4; scale vec3
nodes[]: weights[] number
nodes[].extensions.KHR_lights_punctual: light! index extensions.KHR_lights_punctual.lights
nodes[].extensions.EXT_mesh_gpu_instancing: attributes! object
nodes[].extensions.EXT_mesh_gpu_instancing.attributes: * index accessors
scenes[]: nodes[] index nodes
: scene index scenes)";

/// The references to textures; each has the rules of a textureInfo.
constexpr std::string_view kTextureInfos[] = {
    "materials[].pbrMetallicRoughness.baseColorTexture",
    "materials[].pbrMetallicRoughness.metallicRoughnessTexture",
    "materials[].normalTexture",
    "materials[].occlusionTexture",
    "materials[].emissiveTexture",
    "materials[].extensions.KHR_materials_volume.thicknessTexture",
    "materials[].extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
    "materials[].extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture",
};
constexpr std::string_view kTextureSchema =
    R"(: index! index textures; texCoord size 0 255
.extensions.KHR_texture_transform: offset vec2; rotation number; scale vec2; texCoord size 0 255)";

/// What a light or a camera must have by its type.
constexpr std::pair<std::string_view, std::string_view> kMembersOfTypes[] = {
    {"cameras", "perspective"},
    {"cameras", "orthographic"},
    {"extensions.KHR_lights_punctual.lights", "spot"}};

std::vector<std::string_view> split_text(std::string_view text, std::string_view separator) {
    std::vector<std::string_view> parts;
    for (std::size_t end = text.find(separator); end != text.npos; end = text.find(separator)) {
        parts.push_back(text.substr(0, end));
        text.remove_prefix(end + separator.size());
    }
    parts.push_back(text);
    return parts;
}

/// A constraint on all values at `path`.
struct SchemaRule {
    std::string path;
    bool required = false;
    std::string_view kind;                ///< of those above
    std::vector<std::string_view> words;  ///< that follow it
    double min = 0;
    double max = 0;
};

SchemaRule parse_rule(std::string_view prefix, std::string_view text) {
    SchemaRule rule;
    rule.words = split_text(text, " ");
    std::string_view member = rule.words[0];
    rule.kind = rule.words[1];
    rule.words.erase(rule.words.begin(), rule.words.begin() + 2);
    rule.required = member.ends_with("!");
    member.remove_suffix(rule.required ? 1 : 0);
    rule.path = fmt::format("{}{}{}", prefix, prefix.empty() ? "" : ".", member);
    const bool is_size = rule.kind == "size" || rule.kind == "array";
    const auto number = [&rule](std::size_t word, double value) {
        if (word < rule.words.size()) {
            const std::string_view digits = rule.words[word];
            (void)std::from_chars(digits.data(), digits.data() + digits.size(), value);
        }
        return value;
    };
    rule.min = number(0, is_size ? 0 : -kLargestNumber);
    rule.max = number(1, is_size ? kLargestSize : kLargestNumber);
    return rule;
}

/// The last step of the path to a value, for messages.
struct SchemaStep {
    const SchemaStep* parent = nullptr;
    std::string_view key;      ///< of a member; "" for an item
    std::size_t position = 0;  ///< of an item
};

std::string path_of(const SchemaStep* step) {
    if (step == nullptr) {
        return "";
    }
    const std::string parent = path_of(step->parent);
    return step->key.empty() ? fmt::format("{}[{}]", parent, step->position)
                             : fmt::format("{}{}{}", parent, parent.empty() ? "" : ".", step->key);
}

const JsonValue& value_at(const JsonValue& root, std::string_view path) {
    const JsonValue* value = &root;
    for (const std::string_view key : split_text(path, ".")) {
        value = &(*value)[key];
    }
    return *value;
}

class SchemaChecker {
  public:
    SchemaChecker(JsonValue& root, const std::string& file) : root_(root), file_(file) {}

    /// All lines of `schema`, with paths below `prefix`.
    Status check(std::string_view prefix, std::string_view schema) {
        for (const std::string_view line : split_text(schema, "\n")) {
            const std::vector<std::string_view> parts = split_text(line, ": ");
            for (const std::string_view text : split_text(parts[1], "; ")) {
                rule_ = parse_rule(fmt::format("{}{}", prefix, parts[0]), text);
                targets_ = rule_.kind == "index" ? value_at(root_, rule_.words[0]).items.size() : 0;
                LIMN_TRY(walk(root_, rule_.path, nullptr));
            }
        }
        return Done{};
    }

  private:
    /// Recurses once for each step of the rule's path, so never deeply.
    Status walk(JsonValue& value, std::string_view path, const SchemaStep* at) {
        if (path.empty()) {
            return check_value(value, at);
        }
        const bool is_array = path.starts_with("[]");
        if (value.kind != (is_array ? JsonKind::Array : JsonKind::Object)) {
            return refuse(describe(value), is_array ? "an array" : "an object", at);
        }
        if (is_array) {
            path.remove_prefix(2);
            for (std::size_t i = 0; i < value.items.size(); ++i) {
                const SchemaStep step{at, "", i};
                LIMN_TRY(walk(value.items[i], path, &step));
            }
            return Done{};
        }
        path.remove_prefix(path.starts_with(".") ? 1 : 0);
        const std::string_view key = path.substr(0, path.find_first_of(".["));
        path.remove_prefix(key.size());
        bool is_found = false;
        for (JsonMember& member : value.members) {
            if (key == "*" || member.key == key) {
                is_found = true;
                const SchemaStep step{at, member.key};
                LIMN_TRY(walk(member.value, path, &step));
            }
        }
        if (!is_found && path.empty() && rule_.required) {
            const SchemaStep step{at, key};
            return refuse("nothing", expectation(), &step);
        }
        return Done{};
    }

    Status check_value(JsonValue& value, const SchemaStep* at) const {
        if (!fits(value)) {
            return refuse(describe(value), expectation(), at);
        }
        if ((rule_.kind == "index" || rule_.kind == "size")
            && value.text.find_first_not_of("0123456789") != std::string::npos) {
            value.text = std::to_string(static_cast<std::int64_t>(value.number));
        }
        return Done{};
    }

    [[nodiscard]] Status
    refuse(std::string_view found, std::string_view expected, const SchemaStep* at) const {
        const std::string path = path_of(at);
        return fail(
            "{}{}{}: found {}, expected {}", file_, path.empty() ? "" : ": ", path, found,
            expected);
    }

    [[nodiscard]] bool fits(const JsonValue& value) const {
        const std::string_view kind = rule_.kind;
        const auto is_number = [this](const JsonValue& v) {
            return v.kind == JsonKind::Number && v.number >= rule_.min && v.number <= rule_.max;
        };
        const bool is_size = value.kind == JsonKind::Number && value.number >= 0
                             && value.number <= kLargestSize
                             && value.number == std::floor(value.number);
        if (kind == "index") {
            return is_size && value.number < static_cast<double>(targets_);
        }
        if (kind == "size" || kind == "number") {
            return is_number(value) && (is_size || kind == "number");
        }
        if (kind == "array") {
            return value.kind == JsonKind::Array
                   && static_cast<double>(value.items.size()) >= rule_.min;
        }
        if (kind == "text") {
            return value.kind == JsonKind::String
                   && (rule_.words.empty()
                       || std::ranges::find(rule_.words, value.text) != rule_.words.end());
        }
        if (kind == "object" || kind == "bool") {
            return value.kind == (kind == "bool" ? JsonKind::Bool : JsonKind::Object);
        }
        return value.kind == JsonKind::Array && std::to_string(value.items.size()) == vec_length()
               && std::ranges::all_of(value.items, is_number);
    }

    [[nodiscard]] std::string_view vec_length() const { return rule_.kind.substr(3); }

    [[nodiscard]] std::string expectation() const {
        const std::string_view kind = rule_.kind;
        const std::string range = fmt::format("from {} to {}", rule_.min, rule_.max);
        if (kind == "index") {
            return targets_ > 0 ? fmt::format("an index below {}", targets_)
                                : fmt::format("no index, since there are no {}", rule_.words[0]);
        }
        return kind == "object"      ? "an object"
               : kind == "array"     ? fmt::format("an array of at least {}", rule_.min)
               : kind == "bool"      ? "true or false"
               : kind == "size"      ? "a whole number " + range
               : kind == "number"    ? "a number " + range
               : kind != "text"      ? fmt::format("{} numbers {}", vec_length(), range)
               : rule_.words.empty() ? "a string"
                                     : fmt::format("one of {}", fmt::join(rule_.words, " "));
    }

    JsonValue& root_;
    const std::string& file_;
    SchemaRule rule_;
    std::size_t targets_ = 0;  ///< items of the array of an index
};

}  // namespace

Status check_gltf_schema(JsonValue& json, const std::string& file) {
    SchemaChecker checker(json, file);
    LIMN_TRY(checker.check("", kSchema));
    for (const std::string_view info : kTextureInfos) {
        LIMN_TRY(checker.check(info, kTextureSchema));
    }
    for (const auto& [path, type] : kMembersOfTypes) {
        const std::vector<JsonValue>& items = value_at(json, path).items;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (items[i]["type"].text == type && items[i].find(type) == nullptr) {
                return fail(
                    "{}: {}[{}].{}: found nothing, expected an object", file, path, i, type);
            }
        }
    }
    return Done{};
}

}  // namespace limn
