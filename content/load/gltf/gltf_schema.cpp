#include "content/load/gltf/gltf_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr double kLargestNumber = 1e9;    // no length, angle or intensity is larger
constexpr double kLargestSize = 9e15;     // integers that a double holds exactly
constexpr double kFactorRounding = 1e-5;  // a factor may be out of range by this without a warning

// "path: member kind; member kind ..." for the members that are read. A path is of objects: "a.b"
// is a member, "a[]" every item of an array. A member may be absent unless it ends with "!"; "*" is
// every member, "a[]" every item of the member a. Kinds: object, array MIN (items), index ARRAY,
// size MIN MAX (a whole number), number MIN MAX, vecN MIN MAX (N numbers), text WORDS (one of them,
// any without), code WORDS (a number that is one of them), bool; size MIN MAX STEP is a multiple.
// factor MIN MAX and factorN MIN MAX are numbers that are clamped. Angles are rounded up, since
// files hold them as floats.
constexpr std::string_view kSchema =
    R"(: asset! object; extensionsUsed[] text; extensionsRequired[] text
asset: version! text
buffers[]: uri text; byteLength! size
buffers[].extensions.EXT_meshopt_compression: fallback bool
bufferViews[]: buffer! index buffers; byteOffset size; byteLength! size 1; byteStride size 4 252 4
bufferViews[].extensions.EXT_meshopt_compression: buffer! index buffers; byteOffset size
bufferViews[].extensions.EXT_meshopt_compression: byteLength! size 1; count! size 1 4294967295
bufferViews[].extensions.EXT_meshopt_compression: byteStride! size 2 256
bufferViews[].extensions.EXT_meshopt_compression: mode! text ATTRIBUTES TRIANGLES INDICES
bufferViews[].extensions.EXT_meshopt_compression: filter text NONE OCTAHEDRAL QUATERNION EXPONENTIAL
accessors[]: bufferView index bufferViews; byteOffset size; normalized bool
accessors[]: componentType! code 5120 5121 5122 5123 5125 5126; count! size 0 4294967295
accessors[]: type! text SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4
accessors[].sparse: count! size 0 2147483647; indices! object; values! object
accessors[].sparse.indices: bufferView! index bufferViews; byteOffset size 0 2147483647
accessors[].sparse.indices: componentType! code 5121 5123 5125
accessors[].sparse.values: bufferView! index bufferViews; byteOffset size 0 2147483647
images[]: name text; uri text; bufferView index bufferViews
samplers[]: magFilter size 0 65535; minFilter size 0 65535; wrapS size 0 65535; wrapT size 0 65535
textures[]: source index images; sampler index samplers
textures[].extensions.EXT_texture_webp: source index images
textures[].extensions.MSFT_texture_dds: source index images
materials[]: name text; alphaMode text OPAQUE MASK BLEND; alphaCutoff factor 0 1e9
materials[]: doubleSided bool; emissiveFactor factor3 0 1e9
materials[].extensions.KHR_materials_transmission: transmissionFactor factor 0 1
materials[].extensions.KHR_materials_ior: ior factor 0 1e9
materials[].extensions.KHR_materials_pbrSpecularGlossiness: diffuseFactor factor4 0 1
materials[].extensions.KHR_materials_pbrSpecularGlossiness: specularFactor factor3 0 1
materials[].extensions.KHR_materials_pbrSpecularGlossiness: glossinessFactor factor 0 1
materials[].extensions.KHR_materials_volume: thicknessFactor factor 0 1e9
materials[].extensions.KHR_materials_volume: attenuationDistance factor 0 1e9
materials[].extensions.KHR_materials_volume: attenuationColor factor3 0 1
materials[].extensions.KHR_materials_emissive_strength: emissiveStrength factor 0 1e9
materials[].extensions.KHR_materials_clearcoat: clearcoatFactor factor 0 1
materials[].extensions.KHR_materials_clearcoat: clearcoatRoughnessFactor factor 0 1
materials[].extensions.KHR_materials_clearcoat.clearcoatNormalTexture: scale number
materials[].extensions.KHR_materials_sheen: sheenColorFactor factor3 0 1
materials[].extensions.KHR_materials_sheen: sheenRoughnessFactor factor 0 1
materials[].extensions.KHR_materials_specular: specularFactor factor 0 1
materials[].extensions.KHR_materials_specular: specularColorFactor factor3 0 1e9
materials[].extensions.KHR_materials_anisotropy: anisotropyStrength factor 0 1
materials[].extensions.KHR_materials_anisotropy: anisotropyRotation number
materials[].extensions.KHR_materials_iridescence: iridescenceFactor factor 0 1
materials[].extensions.KHR_materials_iridescence: iridescenceIor factor 1 5
materials[].extensions.KHR_materials_iridescence: iridescenceThicknessMinimum factor 0 1e4
materials[].extensions.KHR_materials_iridescence: iridescenceThicknessMaximum factor 0 1e4
materials[].extensions.KHR_materials_dispersion: dispersion factor 0 20
materials[].pbrMetallicRoughness: baseColorFactor factor4 0 1; metallicFactor factor 0 1
materials[].pbrMetallicRoughness: roughnessFactor factor 0 1
materials[].normalTexture: scale number
materials[].occlusionTexture: strength factor 0 1
cameras[]: name text; type! text perspective orthographic
cameras[].orthographic: xmag! number; ymag! number; znear! number 0 1e9
cameras[].perspective: yfov! number 1e-6 3.1415928; znear! number 1e-9 1e9
extensions.KHR_lights_punctual.lights[]: name text; type! text; color vec3 0 1e9
extensions.KHR_lights_punctual.lights[]: intensity number 0 1e9; range number 1e-6 1e9
extensions.KHR_lights_punctual.lights[].spot: innerConeAngle factor 0 1.5707964
extensions.KHR_lights_punctual.lights[].spot: outerConeAngle factor 0 1.5707964
extensions.KHR_materials_variants.variants[]: name! text
meshes[].primitives[].extensions.KHR_materials_variants.mappings[]: material! index materials; variants! array
meshes[].primitives[].extensions.KHR_materials_variants.mappings[]: variants[] index extensions.KHR_materials_variants.variants
meshes[]: name text; primitives! array 1; weights[] number
meshes[].primitives[]: attributes! object; indices index accessors; material index materials
meshes[].primitives[]: mode size 0 6
meshes[].primitives[].attributes: POSITION index accessors; * index accessors
meshes[].primitives[].targets[]: * index accessors
skins[]: name text; joints! array 1; joints[] index nodes; inverseBindMatrices index accessors
animations[]: name text; channels! array 1; samplers! array 1
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
    "materials[].extensions.KHR_materials_transmission.transmissionTexture",
    "materials[].extensions.KHR_materials_volume.thicknessTexture",
    "materials[].extensions.KHR_materials_pbrSpecularGlossiness.diffuseTexture",
    "materials[].extensions.KHR_materials_pbrSpecularGlossiness.specularGlossinessTexture",
    "materials[].extensions.KHR_materials_clearcoat.clearcoatTexture",
    "materials[].extensions.KHR_materials_clearcoat.clearcoatRoughnessTexture",
    "materials[].extensions.KHR_materials_clearcoat.clearcoatNormalTexture",
    "materials[].extensions.KHR_materials_sheen.sheenColorTexture",
    "materials[].extensions.KHR_materials_sheen.sheenRoughnessTexture",
    "materials[].extensions.KHR_materials_specular.specularTexture",
    "materials[].extensions.KHR_materials_specular.specularColorTexture",
    "materials[].extensions.KHR_materials_anisotropy.anisotropyTexture",
    "materials[].extensions.KHR_materials_iridescence.iridescenceTexture",
    "materials[].extensions.KHR_materials_iridescence.iridescenceThicknessTexture",
};
constexpr std::string_view kTextureSchema =
    R"(: index! index textures; texCoord size 0 255
.extensions.KHR_texture_transform: offset vec2; rotation number; scale vec2; texCoord size 0 255)";

/// Items that may be bad, and their stand-ins for tinygltf. An item that needs a bad one is bad,
/// too, up to the scene, which is then rejected.
constexpr std::pair<std::string_view, std::string_view> kItems[] = {
    {"bufferViews[]", R"({"buffer": 0, "byteLength": 1})"},
    {"accessors[]", R"({"componentType": 5126, "count": 1, "type": "SCALAR"})"},
    {"images[]", "{}"},
    {"samplers[]", "{}"},
    {"textures[]", "{}"},
    {"materials[]", "{}"},
    {"cameras[]", R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 1}})"},
    {"extensions.KHR_lights_punctual.lights[]", R"({"type": "point"})"},
    {"meshes[]", R"({"primitives": []})"},
    {"meshes[].primitives[].extensions.KHR_materials_variants.mappings[]",
     R"({"material": 0, "variants": []})"},
    {"skins[]", R"({"joints": []})"},
    {"animations[]", "{}"},
    {"animations[].samplers[]", R"({"input": 0, "output": 0})"},
    {"animations[].channels[]", R"({"sampler": 0, "target": {"path": ""}})"},
    {"nodes[]", "{}"},
    {"scenes[]", "{}"},
};

/// Members that may be bad: then they count as missing. With "." at the end, all in that object,
/// but for those that are required: then the object counts as missing. With "!" at the end, the
/// member itself and nothing in it.
constexpr std::string_view kMembers[] = {
    "extensionsUsed",
    "extensions",
    "extensions.KHR_lights_punctual",
    "extensions.KHR_materials_variants",
    "extensions.KHR_lights_punctual.lights[].range",
    "images",
    "samplers",
    "textures",
    "textures[].sampler",
    "materials",
    "materials[].",
    "cameras",
    "meshes[].weights",
    "meshes[].primitives!",
    "meshes[].primitives[].material",
    "meshes[].primitives[].extensions",
    "meshes[].primitives[].attributes.*",
    "meshes[].primitives[].targets[].*",
    "skins",
    "animations",
    "nodes[].camera",
    "nodes[].skin",
    "nodes[].weights",
    "nodes[].extensions.",
    "buffers[].extensions.",
};

/// Required members of a light or a camera, by its type.
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
    double step = 1;
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
    rule.step = number(2, 1);
    return rule;
}

/// The last step of the path to a value.
struct SchemaStep {
    const SchemaStep* parent = nullptr;
    std::string_view rule;     ///< the path as in the schema
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

JsonValue* value_at(JsonValue& root, std::string_view path) {
    const JsonValue* value = &root;
    for (const std::string_view key : split_text(path, ".")) {
        value = value != nullptr ? value->find(key) : nullptr;
    }
    return const_cast<JsonValue*>(value);
}

std::string_view find_stand_in(std::string_view rule) {
    const auto* const found =
        std::ranges::find_if(kItems, [&](const auto& item) { return item.first == rule; });
    return found != std::end(kItems) ? found->second : std::string_view();
}

/// Whether the member at `rule` may be missing. `is_bad_itself`: not only something in it.
bool may_miss(std::string_view rule, bool is_bad_itself, bool is_required) {
    return rule.ends_with(".name") || std::ranges::any_of(kMembers, [&](std::string_view member) {
               const std::string_view start = member.substr(0, member.size() - 1);
               return rule == member || (member.ends_with("!") && is_bad_itself && rule == start)
                      || (member.ends_with(".") && !is_required && rule.starts_with(member));
           });
}

class SchemaChecker {
  public:
    explicit SchemaChecker(GltfDocument& document) : document_(document) {}

    /// All lines of `schema`, with paths below `prefix`.
    Status check(std::string_view prefix, std::string_view schema) {
        for (const std::string_view line : split_text(schema, "\n")) {
            const std::vector<std::string_view> parts = split_text(line, ": ");
            for (const std::string_view text : split_text(parts[1], "; ")) {
                rule_ = parse_rule(fmt::format("{}{}", prefix, parts[0]), text);
                if (rule_.kind == "index") {
                    const JsonValue* const array = value_at(document_.json, rule_.words[0]);
                    targets_ = array != nullptr ? array->items.size() : 0;
                }
                LIMN_TRY(walk(document_.json, rule_.path, nullptr));
            }
        }
        return Done{};
    }

    /// Checks that lights and cameras have the member of their type.
    Status check_types() {
        for (const auto& [array, type] : kMembersOfTypes) {
            JsonValue* const found = value_at(document_.json, array);
            for (std::size_t i = 0; found != nullptr && i < found->items.size(); ++i) {
                if (found->items[i]["type"].text == type && !found->items[i].find(type)) {
                    const SchemaStep list{nullptr, array, array};
                    const std::string rule = fmt::format("{}[]", array);
                    const SchemaStep item{&list, rule, "", i};
                    const SchemaStep member{&item, "", type};
                    LIMN_TRY(lose("nothing", "an object", &member));
                    replace(found->items[i], rule);
                }
            }
        }
        return Done{};
    }

  private:
    /// The step to a value at which a part is lost; nullptr if none is.
    using Lost = Result<const SchemaStep*>;

    /// Recurses once for each step of the rule's path, so never deeply.
    Lost walk(JsonValue& value, std::string_view path, const SchemaStep* at) {
        if (path.empty()) {
            return check_value(value, at);
        }
        const bool is_array = path.starts_with("[]");
        if (value.kind != (is_array ? JsonKind::Array : JsonKind::Object)) {
            return lose(describe(value), is_array ? "an array" : "an object", at);
        }
        return is_array ? walk_items(value, path.substr(2), at) : walk_members(value, path, at);
    }

    Lost walk_items(JsonValue& value, std::string_view path, const SchemaStep* at) {
        for (std::size_t i = 0; i < value.items.size(); ++i) {
            const SchemaStep step{at, rule_up_to(path), "", i};
            if (is_bad(step)) {
                continue;
            }
            const SchemaStep* const lost = LIMN_TRY(walk(value.items[i], path, &step));
            if (lost == &step) {
                replace(value.items[i], step.rule);
            } else if (lost != nullptr) {
                return lost;
            }
        }
        return nullptr;
    }

    Lost walk_members(JsonValue& value, std::string_view path, const SchemaStep* at) {
        path.remove_prefix(path.starts_with(".") ? 1 : 0);
        const std::string_view key = path.substr(0, path.find_first_of(".["));
        path.remove_prefix(key.size());
        bool is_found = false;
        bool has_lost = false;
        for (JsonMember& member : value.members) {
            if (key == "*" || member.key == key) {
                is_found = true;
                const SchemaStep step{at, rule_up_to(path), member.key};
                const SchemaStep* const lost = LIMN_TRY(walk(member.value, path, &step));
                if (lost != nullptr && lost != &step) {
                    return lost;
                }
                if (lost == &step) {
                    has_lost = true;
                    member.key.clear();
                }
            }
        }
        if (has_lost) {
            std::erase_if(value.members, [](const JsonMember& each) { return each.key.empty(); });
        }
        if (!is_found && path.empty() && rule_.required) {
            const SchemaStep step{at, rule_.path, key};
            const SchemaStep* const lost = LIMN_TRY(lose("nothing", expectation(), &step));
            return lost == &step ? nullptr : lost;
        }
        return nullptr;
    }

    [[nodiscard]] bool is_bad(const SchemaStep& item) const {
        return !document_.bad_parts.empty() && !find_stand_in(item.rule).empty()
               && document_.bad_parts.contains(path_of(&item));
    }

    /// The path of the rule without the rest `path`.
    [[nodiscard]] std::string_view rule_up_to(std::string_view path) const {
        return std::string_view(rule_.path).substr(0, rule_.path.size() - path.size());
    }

    Lost check_value(JsonValue& value, const SchemaStep* at) {
        if (rule_.kind.starts_with("factor")) {
            clamp(value, at);
        }
        if (!fits(value)) {
            return lose(describe(value), expectation(), at);
        }
        const bool is_index = rule_.kind == "index";
        if (is_index || rule_.kind == "size" || rule_.kind == "code") {
            if (value.text.find_first_not_of("0123456789") != std::string::npos) {
                value.text = std::to_string(static_cast<std::int64_t>(value.number));
            }
        }
        const std::string* const reason =
            is_index
                ? find_bad_part(document_, rule_.words[0], static_cast<std::size_t>(value.number))
                : nullptr;
        return reason != nullptr ? lose_silently(*reason, at) : Lost(nullptr);
    }

    /// Clamps without a warning if the value is out of range only by rounding.
    void clamp(JsonValue& value, const SchemaStep* at) {
        const bool is_array = value.kind == JsonKind::Array;
        for (JsonValue& number : is_array ? std::span(value.items) : std::span(&value, 1)) {
            const double clamped = std::clamp(number.number, rule_.min, rule_.max);
            if (number.kind != JsonKind::Number || clamped == number.number) {
                continue;
            }
            if (std::abs(clamped - number.number) > kFactorRounding) {
                const SchemaStep item{
                    at, "", "", static_cast<std::size_t>(&number - value.items.data())};
                document_.warnings.push_back(fmt::format(
                    "{}: {}: found {}, expected a number from {} to {}; it is clamped",
                    document_.file, path_of(is_array ? &item : at), describe(number), rule_.min,
                    rule_.max));
            }
            number = json_of(clamped);
        }
    }

    /// The part that is lost because of the value, with a warning; fails if that is the whole file.
    Lost lose(std::string_view found, std::string_view expected, const SchemaStep* at) {
        const std::string path = path_of(at);
        const std::string reason = fmt::format(
            "{}{}found {}, expected {}", path, path.empty() ? "" : ": ", found, expected);
        const SchemaStep* const lost = LIMN_TRY(lose_silently(reason, at));
        const std::string part = path_of(lost);
        warn_of_loss(
            document_, {fmt::format("{}: {}", document_.file, reason)},
            part == path ? "it is left out" : part + " is left out");
        return lost;
    }

    Lost lose_silently(const std::string& reason, const SchemaStep* at) {
        for (const SchemaStep* step = at; step != nullptr; step = step->parent) {
            if (may_miss(step->rule, step == at, step == at && rule_.required)) {
                return step;
            }
            if (!find_stand_in(step->rule).empty()) {
                document_.bad_parts.emplace(path_of(step), reason);
                return step;
            }
        }
        return fail("{}: {}", document_.file, reason);
    }

    void replace(JsonValue& item, std::string_view rule) const {
        item = *parse_json(find_stand_in(rule), document_.file);
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
        if (kind == "size") {
            return is_number(value) && is_size && std::fmod(value.number, rule_.step) == 0;
        }
        if (kind == "code") {
            const std::string code = fmt::format("{}", value.number);
            return is_size && std::ranges::find(rule_.words, code) != rule_.words.end();
        }
        if (kind == "number" || kind == "factor") {
            return is_number(value);
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

    /// "3" of vec3 and factor3; "" of factor.
    [[nodiscard]] std::string_view vec_length() const {
        return rule_.kind.substr(rule_.kind.starts_with("vec") ? 3 : 6);
    }

    [[nodiscard]] std::string expectation() const {
        const std::string_view kind = rule_.kind;
        const std::string range = fmt::format("from {} to {}", rule_.min, rule_.max);
        if (kind == "index") {
            return targets_ > 0 ? fmt::format("an index below {}", targets_)
                                : fmt::format("no index, since there are no {}", rule_.words[0]);
        }
        return kind == "object"  ? "an object"
               : kind == "array" ? fmt::format("an array of at least {}", rule_.min)
               : kind == "bool"  ? "true or false"
               : kind == "size"
                   ? "a whole number " + range
                         + (rule_.step > 1 ? fmt::format(", a multiple of {}", rule_.step) : "")
               : kind == "number" || kind == "factor" ? "a number " + range
               : kind != "text" && kind != "code"
                   ? fmt::format("{} numbers {}", vec_length(), range)
               : rule_.words.empty() ? "a string"
                                     : fmt::format("one of {}", fmt::join(rule_.words, " "));
    }

    GltfDocument& document_;
    SchemaRule rule_;
    std::size_t targets_ = 0;  ///< items of the array of an index
};

}  // namespace

const std::string*
find_bad_part(const GltfDocument& document, std::string_view array, std::size_t index) {
    if (document.bad_parts.empty()) {
        return nullptr;
    }
    const auto found = document.bad_parts.find(fmt::format("{}[{}]", array, index));
    return found != document.bad_parts.end() ? &found->second : nullptr;
}

Status check_gltf_schema(GltfDocument& document) {
    SchemaChecker checker(document);
    LIMN_TRY(checker.check_types());
    LIMN_TRY(checker.check("", kSchema));
    for (const std::string_view info : kTextureInfos) {
        LIMN_TRY(checker.check(info, kTextureSchema));
    }
    return Done{};
}

}  // namespace limn
