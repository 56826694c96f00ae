#include "content/load/gltf/gltf_document.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>
#include <utility>

namespace limn {

namespace {

const tinygltf::Value kNullValue;

/// Maximum number of elements without a buffer view.
constexpr std::uint64_t kMaxZeros = std::uint64_t{1} << 22;

bool is_index_type(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
           || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
           || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint64_t size_of_component(int type) {
    return static_cast<std::uint64_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
}

int count_components(const tinygltf::Accessor& accessor) {
    return tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
}

template <typename T>
T load_component(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

/// Normalized by the specification's equations.
template <typename T>
float load_as_float(const std::byte* at, bool normalized) {
    const T value = load_component<T>(at);
    if (!std::is_integral_v<T> || !normalized) {
        return static_cast<float>(value);
    }
    constexpr double kMax = static_cast<double>(std::numeric_limits<T>::max());
    return std::max(static_cast<float>(value / kMax), -1.0f);
}

float load_float(const std::byte* at, int type, bool normalized) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return load_as_float<std::int8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load_as_float<std::uint8_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return load_as_float<std::int16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load_as_float<std::uint16_t>(at, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return load_as_float<std::uint32_t>(at, normalized);
    default:
        return load_as_float<float>(at, normalized);
    }
}

std::uint32_t load_index(const std::byte* at, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load_component<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load_component<std::uint16_t>(at);
    default:
        return load_component<std::uint32_t>(at);
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
    std::uint64_t element_size, bool strided, const std::string& where) {
    const std::span<const std::byte> bytes = LIMN_TRY(view_bytes(document, index));
    const std::uint64_t given = item_at(document.model.bufferViews, index).byteStride;
    const std::uint64_t stride = strided && given != 0 ? given : element_size;
    if (stride < element_size) {
        return fail(
            "{}: found a stride of {} in bufferViews[{}], expected at least the {} bytes of an "
            "element",
            where, stride, index, element_size);
    }
    if (bytes.empty()) {
        return fail("{}: found bufferViews[{}] in a buffer without data", where, index);
    }
    // count < 2^32, stride <= 252 and offset < 2^53: no overflow.
    const std::uint64_t end = offset + (count - 1) * stride + element_size;
    if (end > bytes.size()) {
        return fail(
            "{}: found {} elements that end at byte {}, expected to stay within the {} of "
            "bufferViews[{}]",
            where, count, end, bytes.size(), index);
    }
    return Strip{bytes.data() + offset, stride};
}

/// Storage of the elements of an accessor; those in neither are zero.
struct Elements {
    std::uint64_t size = 0;               ///< of one [bytes]
    Strip base;                           ///< first is null when there is no buffer view
    std::vector<std::uint32_t> replaced;  ///< by a sparse accessor; increasing, below its count
    Strip replacements;
};

Status find_replacements(
    const GltfDocument& document, const tinygltf::Accessor& accessor, const std::string& where,
    Elements& elements) {
    const auto& indices = accessor.sparse.indices;
    const auto& values = accessor.sparse.values;
    const auto count = static_cast<std::uint64_t>(accessor.sparse.count);
    if (count > accessor.count) {
        return fail("{}.sparse.count: found {}, expected at most {}", where, count, accessor.count);
    }
    const Strip strip = LIMN_TRY(find_strip(
        document, indices.bufferView, static_cast<std::uint64_t>(indices.byteOffset), count,
        size_of_component(indices.componentType), false, where + ".sparse.indices"));
    elements.replacements = LIMN_TRY(find_strip(
        document, values.bufferView, static_cast<std::uint64_t>(values.byteOffset), count,
        elements.size, false, where + ".sparse.values"));
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t element =
            load_index(strip.first + i * strip.stride, indices.componentType);
        if (element >= accessor.count) {
            return fail(
                "{}.sparse.indices: found {} at {}, expected an index below {}", where, element, i,
                accessor.count);
        }
        if (!elements.replaced.empty() && element <= elements.replaced.back()) {
            return fail(
                "{}.sparse.indices: found {} after {} at {}, expected increasing indices", where,
                element, elements.replaced.back(), i);
        }
        elements.replaced.push_back(element);
    }
    return Done{};
}

Result<Elements> find_elements(
    const GltfDocument& document, const tinygltf::Accessor& accessor, const std::string& where) {
    Elements elements;
    elements.size = size_of_component(accessor.componentType)
                    * static_cast<std::uint64_t>(count_components(accessor));
    if (accessor.count == 0) {
        return elements;
    }
    if (accessor.bufferView >= 0) {
        elements.base = LIMN_TRY(find_strip(
            document, accessor.bufferView, accessor.byteOffset, accessor.count, elements.size, true,
            where));
    } else if (accessor.count > kMaxZeros) {
        return fail(
            "{}.count: found {} elements without a bufferView, expected at most {}", where,
            accessor.count, kMaxZeros);
    }
    if (accessor.sparse.isSparse && accessor.sparse.count > 0) {
        LIMN_TRY(find_replacements(document, accessor, where, elements));
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

/// Takes `values` from the remaining limit of the file.
Status take_values(GltfDocument& document, std::uint64_t values, const std::string& where) {
    if (values > document.values_left) {
        return fail(
            "{}: found {} more values, expected at most {} in the whole file", where, values,
            document.limits.max_values);
    }
    document.values_left -= values;
    return Done{};
}

}  // namespace

const tinygltf::Value& member_of(const tinygltf::Value& object, const char* name) {
    return object.Has(name) ? object.Get(name) : kNullValue;
}

const tinygltf::Value& extension_of(const tinygltf::ExtensionMap& extensions, const char* name) {
    const auto found = extensions.find(name);
    return found != extensions.end() ? found->second : kNullValue;
}

float number_of(const tinygltf::Value& object, const char* name, double missing) {
    const tinygltf::Value& value = member_of(object, name);
    return static_cast<float>(value.IsNumber() ? value.GetNumberAsDouble() : missing);
}

Result<std::span<const std::byte>> view_bytes(const GltfDocument& document, std::int32_t view) {
    if (const std::string* const reason =
            find_bad_part(document, "bufferViews", static_cast<std::size_t>(view))) {
        return fail("{}: {}", document.file, *reason);
    }
    if (const std::vector<std::byte>& decoded = item_at(document.decoded_views, view);
        !decoded.empty()) {
        return std::span<const std::byte>(decoded);
    }
    const tinygltf::BufferView& source = item_at(document.model.bufferViews, view);
    const auto bytes =
        std::as_bytes(std::span(item_at(document.model.buffers, source.buffer).data));
    return bytes.empty() ? bytes : bytes.subspan(source.byteOffset, source.byteLength);
}

Result<std::vector<float>> read_any_floats(
    GltfDocument& document, std::int32_t index, int components, const std::string& where) {
    const tinygltf::Accessor& accessor = item_at(document.model.accessors, index);
    const std::string here = fmt::format("{}: accessors[{}]", where, index);
    if (const int found = count_components(accessor); found != components) {
        return fail(
            "{}.type: found {} components per element, expected {}", here, found, components);
    }
    const std::uint64_t size = size_of_component(accessor.componentType);
    const auto width = static_cast<std::uint64_t>(components);
    LIMN_TRY(take_values(document, accessor.count * width, here));
    const Elements elements = LIMN_TRY(find_elements(document, accessor, here));
    std::vector<float> values(accessor.count * width, 0.0f);
    visit_elements(elements, accessor.count, [&](std::uint64_t element, const std::byte* bytes) {
        for (std::uint64_t k = 0; k < width; ++k) {
            values[element * width + k] =
                load_float(bytes + k * size, accessor.componentType, accessor.normalized);
        }
    });
    return values;
}

Result<std::vector<float>>
read_floats(GltfDocument& document, std::int32_t index, int components, const std::string& where) {
    std::vector<float> values = LIMN_TRY(read_any_floats(document, index, components, where));
    const auto bad =
        std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
    if (bad != values.end()) {
        return fail(
            "{}: accessors[{}]: found NaN or infinity in element {}, expected finite numbers",
            where, index, (bad - values.begin()) / components);
    }
    return values;
}

Result<std::vector<std::uint32_t>>
read_indices(GltfDocument& document, std::int32_t index, const std::string& where) {
    const tinygltf::Accessor& accessor = item_at(document.model.accessors, index);
    const std::string here = fmt::format("{}: accessors[{}]", where, index);
    if (count_components(accessor) != 1 || !is_index_type(accessor.componentType)) {
        return fail(
            "{}: found {} components of type {} per element, expected one of type 5121, 5123 or "
            "5125",
            here, count_components(accessor), accessor.componentType);
    }
    LIMN_TRY(take_values(document, accessor.count, here));
    const Elements elements = LIMN_TRY(find_elements(document, accessor, here));
    std::vector<std::uint32_t> values(accessor.count, 0);
    visit_elements(elements, accessor.count, [&](std::uint64_t element, const std::byte* bytes) {
        values[element] = load_index(bytes, accessor.componentType);
    });
    return values;
}

}  // namespace limn
