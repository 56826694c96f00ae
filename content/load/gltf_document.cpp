#include "content/load/gltf_document.h"

#include "content/load/gltf_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <string_view>
#include <utility>

namespace limn {

namespace {

constexpr std::array kExtensions = {
    std::string_view("KHR_lights_punctual"),   std::string_view("KHR_materials_emissive_strength"),
    std::string_view("KHR_materials_ior"),     std::string_view("KHR_materials_transmission"),
    std::string_view("KHR_materials_unlit"),   std::string_view("KHR_materials_volume"),
    std::string_view("KHR_mesh_quantization"), std::string_view("KHR_texture_transform"),
};

/// Maximum number of elements without a buffer view.
constexpr std::uint64_t kMaxZeros = std::uint64_t{1} << 22;

std::uint64_t size_of(const JsonValue& value) {
    return static_cast<std::uint64_t>(value.number);
}

bool has_extension(std::string_view name) {
    return std::find(kExtensions.begin(), kExtensions.end(), name) != kExtensions.end();
}

/// Names of the extensions in `json`, whether the file lists them or not.
void find_extensions(const JsonValue& json, std::set<std::string_view>& names) {
    for (const JsonValue& item : json.items) {
        find_extensions(item, names);
    }
    for (const JsonMember& member : json.members) {
        if (member.key == "extensions") {
            for (const JsonMember& extension : member.value.members) {
                names.insert(extension.key);
            }
        } else if (member.key != "extras") {
            find_extensions(member.value, names);
        }
    }
}

void warn_of_extensions(GltfDocument& document) {
    std::set<std::string_view> used;
    for (const JsonValue& name : document.json["extensionsUsed"].items) {
        used.insert(name.text);
    }
    find_extensions(document.json, used);
    for (const std::string_view name : used) {
        if (!has_extension(name)) {
            document.warnings.push_back(
                fmt::format("{}: the extension {} is ignored", document.file, in_quotes(name)));
        }
    }
}

Status check_version(const JsonValue& json, const std::string& file) {
    const std::string& version = json["asset"]["version"].text;
    if (!version.starts_with("2.")) {
        return fail("{}: asset.version: found {}, expected 2.x", file, in_quotes(version));
    }
    const std::vector<JsonValue>& required = json["extensionsRequired"].items;
    for (std::size_t i = 0; i < required.size(); ++i) {
        const std::string& name = required[i].text;
        if (!has_extension(name)) {
            return fail(
                "{}: extensionsRequired[{}]: found {}, expected one of {}", file, i,
                in_quotes(name), join_text(kExtensions, ", "));
        }
    }
    return Done{};
}

Status load_buffers(GltfDocument& document, const GltfChunks& chunks) {
    const std::vector<JsonValue>& buffers = document.json["buffers"].items;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const std::string place = fmt::format("{}: buffers[{}]", document.file, i);
        const std::uint64_t length = size_of(buffers[i]["byteLength"]);
        std::vector<std::byte> bytes;
        if (const JsonValue* uri = buffers[i].find("uri"); uri != nullptr) {
            bytes = LIMN_TRY(
                fetch_uri(uri->text, document.folder, place + ".uri", document.limits.max_bytes));
        } else if (i == 0 && chunks.has_binary) {
            bytes.assign(chunks.binary.begin(), chunks.binary.end());
        } else {
            // An extension that Limn does not have may tell where the data are.
            document.warnings.push_back(place + ": it has no data");
            document.buffers.emplace_back();
            continue;
        }
        if (length > bytes.size()) {
            return fail(
                "{}.byteLength: found {}, expected at most the {} bytes available", place, length,
                bytes.size());
        }
        bytes.resize(length);
        total += length;
        if (total > document.limits.max_bytes) {
            return fail(
                "{}: found {} bytes in buffers, expected at most {}", place, total,
                document.limits.max_bytes);
        }
        document.buffers.push_back(std::move(bytes));
    }
    return Done{};
}

Status find_views(GltfDocument& document) {
    for (const JsonValue& view : document.json["bufferViews"].items) {
        const std::size_t number = document.views.size();
        const std::int32_t buffer = index_of(view["buffer"]);
        const std::span<const std::byte> all = document.buffers[static_cast<std::size_t>(buffer)];
        const std::uint64_t offset = size_of(view["byteOffset"]);
        const std::uint64_t length = size_of(view["byteLength"]);
        const std::uint64_t stride = size_of(view["byteStride"]);
        if (stride % 4 != 0) {
            return fail(
                "{}: bufferViews[{}].byteStride: found {}, expected a multiple of 4", document.file,
                number, stride);
        }
        if (all.empty()) {
            document.views.push_back({all, stride});  // what reads it fails
            continue;
        }
        if (offset > all.size() || length > all.size() - offset) {
            return fail(
                "{}: bufferViews[{}]: found {} bytes from byte {}, expected to stay within the {} "
                "of buffers[{}]",
                document.file, number, length, offset, all.size(), buffer);
        }
        document.views.push_back({all.subspan(offset, length), stride});
    }
    return Done{};
}

// ---- accessors ----------------------------------------------------------------------------------

/// Bytes of one component; 0 for types that glTF does not have (5124, 5127 ...).
std::uint64_t component_size(int type) {
    switch (type) {
    case kGltfByte:
    case kGltfUnsignedByte:
        return 1;
    case kGltfShort:
    case kGltfUnsignedShort:
        return 2;
    case kGltfUnsignedInt:
    case kGltfFloat:
        return 4;
    default:
        return 0;
    }
}

bool is_index_type(int type) {
    return type == kGltfUnsignedByte || type == kGltfUnsignedShort || type == kGltfUnsignedInt;
}

template <typename T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

/// The component at `at`; normalized by the specification's equations.
float load_float(const std::byte* at, int type, bool normalized) {
    switch (type) {
    case kGltfByte: {
        const float value = load<std::int8_t>(at);
        return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case kGltfUnsignedByte: {
        const float value = load<std::uint8_t>(at);
        return normalized ? value / 255.0f : value;
    }
    case kGltfShort: {
        const float value = load<std::int16_t>(at);
        return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case kGltfUnsignedShort: {
        const float value = load<std::uint16_t>(at);
        return normalized ? value / 65535.0f : value;
    }
    case kGltfUnsignedInt: {
        const auto value = load<std::uint32_t>(at);
        return normalized ? static_cast<float>(value / 4294967295.0) : static_cast<float>(value);
    }
    default:
        return load<float>(at);
    }
}

std::uint32_t load_index(const std::byte* at, int type) {
    switch (type) {
    case kGltfUnsignedByte:
        return load<std::uint8_t>(at);
    case kGltfUnsignedShort:
        return load<std::uint16_t>(at);
    default:
        return load<std::uint32_t>(at);
    }
}

/// Equally spaced elements within one buffer view.
struct Strip {
    const std::byte* first = nullptr;
    std::uint64_t stride = 0;
};

/// Fails unless `count` elements of `element_size` bytes fit into the view from `offset` on.
Result<Strip> find_strip(
    const GltfDocument& document, std::int32_t index, std::uint64_t offset, std::uint64_t count,
    std::uint64_t element_size, bool strided, const std::string& place) {
    const GltfView& view = document.views[static_cast<std::size_t>(index)];
    const std::uint64_t stride = strided && view.stride != 0 ? view.stride : element_size;
    if (stride < element_size) {
        return fail(
            "{}: found a stride of {} in bufferViews[{}], expected at least the {} bytes of an "
            "element",
            place, stride, index, element_size);
    }
    if (view.bytes.empty()) {
        return fail("{}: found bufferViews[{}] in a buffer without data", place, index);
    }
    // count < 2^32, stride <= 252 and offset < 2^53: no overflow.
    const std::uint64_t end = offset + (count - 1) * stride + element_size;
    if (end > view.bytes.size()) {
        return fail(
            "{}: found {} elements that end at byte {}, expected to stay within the {} of "
            "bufferViews[{}]",
            place, count, end, view.bytes.size(), index);
    }
    return Strip{view.bytes.data() + offset, stride};
}

/// Storage of the elements of an accessor; those in neither are zero.
struct Elements {
    std::uint64_t size = 0;               ///< of one [bytes]
    Strip base;                           ///< first is null when there is no buffer view
    std::vector<std::uint32_t> replaced;  ///< by a sparse accessor; increasing, below its count
    Strip replacements;
};

Status find_replacements(
    const GltfDocument& document, const JsonValue& sparse, std::uint64_t size,
    const std::string& place, Elements& elements) {
    const JsonValue& indices = sparse["indices"];
    const JsonValue& values = sparse["values"];
    const std::uint64_t count = size_of(sparse["count"]);
    const std::int32_t type = index_of(indices["componentType"]);
    if (count > size) {
        return fail("{}.sparse.count: found {}, expected at most {}", place, count, size);
    }
    if (!is_index_type(type)) {
        return fail(
            "{}.sparse.indices.componentType: found {}, expected 5121, 5123 or 5125", place, type);
    }
    const Strip strip = LIMN_TRY(find_strip(
        document, index_of(indices["bufferView"]), size_of(indices["byteOffset"]), count,
        component_size(type), false, place + ".sparse.indices"));
    elements.replacements = LIMN_TRY(find_strip(
        document, index_of(values["bufferView"]), size_of(values["byteOffset"]), count,
        elements.size, false, place + ".sparse.values"));
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t element = load_index(strip.first + i * strip.stride, type);
        if (element >= size) {
            return fail(
                "{}.sparse.indices: found {} at {}, expected an index below {}", place, element, i,
                size);
        }
        if (!elements.replaced.empty() && element <= elements.replaced.back()) {
            return fail(
                "{}.sparse.indices: found {} after {} at {}, expected increasing indices", place,
                element, elements.replaced.back(), i);
        }
        elements.replaced.push_back(element);
    }
    return Done{};
}

Result<Elements> find_elements(
    const GltfDocument& document, std::int32_t index, const GltfAccessor& accessor,
    const std::string& place) {
    Elements elements;
    elements.size = component_size(accessor.type) * static_cast<std::uint64_t>(accessor.components);
    if (accessor.view >= 0) {
        elements.base = LIMN_TRY(find_strip(
            document, accessor.view, accessor.offset, accessor.count, elements.size, true, place));
    } else if (accessor.count > kMaxZeros) {
        return fail(
            "{}.count: found {} elements without a bufferView, expected at most {}", place,
            accessor.count, kMaxZeros);
    }
    const JsonValue& sparse = json_item(document, "accessors", index)["sparse"];
    if (sparse.kind == JsonKind::Object) {
        LIMN_TRY(find_replacements(document, sparse, accessor.count, place, elements));
    }
    return elements;
}

/// Calls store(element, bytes) for the `count` elements that are stored.
template <typename Store>
void visit_elements(const Elements& elements, std::uint64_t count, Store&& store) {
    for (std::uint64_t i = 0; elements.base.first != nullptr && i < count; ++i) {
        store(i, elements.base.first + i * elements.base.stride);
    }
    for (std::uint64_t i = 0; i < elements.replaced.size(); ++i) {
        store(elements.replaced[i], elements.replacements.first + i * elements.size);
    }
}

/// Components of an element: 3 for "VEC3"; 0 for a type that glTF does not have.
int component_count_of(std::string_view type) {
    constexpr std::pair<std::string_view, int> kTypes[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3},
                                                           {"VEC4", 4},   {"MAT2", 4}, {"MAT3", 9},
                                                           {"MAT4", 16}};
    for (const auto& [name, components] : kTypes) {
        if (name == type) {
            return components;
        }
    }
    return 0;
}

/// Names what glTF does not have, in parts that may go unused: what reads it fails.
void warn_of_unknown_types(GltfDocument& document) {
    const std::vector<JsonValue>& accessors = document.json["accessors"].items;
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        const std::string place = fmt::format("{}: accessors[{}]", document.file, i);
        const std::string& type = accessors[i]["type"].text;
        const int component = index_of(accessors[i]["componentType"]);
        if (component_count_of(type) == 0) {
            document.warnings.push_back(
                fmt::format("{}.type: found {}, expected a type of glTF", place, in_quotes(type)));
        } else if (component_size(component) == 0) {
            document.warnings.push_back(fmt::format(
                "{}.componentType: found {}, expected 5120 to 5123, 5125 or 5126", place,
                component));
        }
    }
}

/// Takes `values` from the remaining limit of the file.
Status take_values(GltfDocument& document, std::uint64_t values, const std::string& place) {
    if (values > document.values_left) {
        return fail(
            "{}: found {} more values, expected at most {} in the whole file", place, values,
            document.limits.max_values);
    }
    document.values_left -= values;
    return Done{};
}

}  // namespace

Result<GltfDocument> open_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits) {
    if (bytes.size() > limits.max_bytes) {
        return fail(
            "{}: found {} bytes, expected at most {}", file, bytes.size(), limits.max_bytes);
    }
    const GltfChunks chunks = LIMN_TRY(split_gltf(bytes, file));
    GltfDocument document;
    document.file = file;
    document.folder = folder;
    document.limits = limits;
    document.values_left = limits.max_values;
    document.json = LIMN_TRY(parse_json(
        chunks.json, file,
        {.max_bytes = limits.max_bytes, .max_values = limits.max_json_values, .max_depth = 64}));
    LIMN_TRY(check_gltf_schema(document.json, file));
    LIMN_TRY(check_version(document.json, file));
    if (chunks.trailing > 0) {
        document.warnings.push_back(
            fmt::format("{}: {} bytes after the GLB are ignored", file, chunks.trailing));
    }
    warn_of_extensions(document);
    warn_of_unknown_types(document);
    LIMN_TRY(load_buffers(document, chunks));
    LIMN_TRY(find_views(document));
    return document;
}

GltfAccessor accessor_at(const GltfDocument& document, std::int32_t index) {
    const JsonValue& json = json_item(document, "accessors", index);
    GltfAccessor accessor;
    accessor.view = index_of(json["bufferView"]);
    accessor.offset = size_of(json["byteOffset"]);
    accessor.count = size_of(json["count"]);
    accessor.type = index_of(json["componentType"]);
    accessor.components = component_count_of(json["type"].text);
    accessor.normalized = json["normalized"].truth;
    return accessor;
}

Result<std::vector<float>>
read_floats(GltfDocument& document, std::int32_t index, int components, const std::string& place) {
    const GltfAccessor accessor = accessor_at(document, index);
    const std::string here = fmt::format("{}: accessors[{}]", place, index);
    const std::uint64_t size = component_size(accessor.type);
    if (accessor.components == 0) {
        return fail(
            "{}.type: found {}, expected a type of glTF", here,
            in_quotes(json_item(document, "accessors", index)["type"].text));
    }
    if (accessor.components != components) {
        return fail(
            "{}.type: found {} components per element, expected {}", here, accessor.components,
            components);
    }
    if (size == 0) {
        return fail(
            "{}.componentType: found {}, expected 5120 to 5123, 5125 or 5126", here, accessor.type);
    }
    const auto width = static_cast<std::uint64_t>(components);
    LIMN_TRY(take_values(document, accessor.count * width, here));
    const Elements elements = LIMN_TRY(find_elements(document, index, accessor, here));
    std::vector<float> values(accessor.count * width, 0.0f);
    std::optional<std::uint64_t> bad;
    visit_elements(elements, accessor.count, [&](std::uint64_t element, const std::byte* bytes) {
        for (std::uint64_t k = 0; k < width; ++k) {
            const float value = load_float(bytes + k * size, accessor.type, accessor.normalized);
            values[element * width + k] = value;
            if (!std::isfinite(value) && !bad) {
                bad = element;
            }
        }
    });
    if (bad) {
        return fail("{}: found NaN or infinity in element {}, expected finite numbers", here, *bad);
    }
    return values;
}

Result<std::vector<std::uint32_t>>
read_indices(GltfDocument& document, std::int32_t index, const std::string& place) {
    const GltfAccessor accessor = accessor_at(document, index);
    const std::string here = fmt::format("{}: accessors[{}]", place, index);
    if (accessor.components != 1 || !is_index_type(accessor.type)) {
        return fail(
            "{}: found {} components of type {} per element, expected one of type 5121, 5123 or "
            "5125",
            here, accessor.components, accessor.type);
    }
    LIMN_TRY(take_values(document, accessor.count, here));
    const Elements elements = LIMN_TRY(find_elements(document, index, accessor, here));
    std::vector<std::uint32_t> values(accessor.count, 0);
    visit_elements(elements, accessor.count, [&](std::uint64_t element, const std::byte* bytes) {
        values[element] = load_index(bytes, accessor.type);
    });
    return values;
}

}  // namespace limn
