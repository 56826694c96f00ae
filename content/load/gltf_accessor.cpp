#include "content/load/gltf_accessor.h"

#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace limn {

namespace {

/// Elements that a file may have without giving their bytes.
constexpr std::uint64_t kMaxZeros = std::uint64_t{1} << 22;

/// Bytes of one number; 0 for what glTF does not have (5124, 5127 ...).
std::uint64_t component_size(int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

template <typename T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    return value;
}

/// The number at `at`; normalized as the specification's equations say.
float load_float(const std::byte* at, int type, bool normalized) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: {
        const float value = load<std::int8_t>(at);
        return normalized ? std::max(value / 127.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: {
        const float value = load<std::uint8_t>(at);
        return normalized ? value / 255.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_SHORT: {
        const float value = load<std::int16_t>(at);
        return normalized ? std::max(value / 32767.0f, -1.0f) : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: {
        const float value = load<std::uint16_t>(at);
        return normalized ? value / 65535.0f : value;
    }
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: {
        const auto value = load<std::uint32_t>(at);
        return normalized ? static_cast<float>(value / 4294967295.0) : static_cast<float>(value);
    }
    default:
        return load<float>(at);
    }
}

std::uint32_t load_index(const std::byte* at, int type) {
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load<std::uint8_t>(at);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<std::uint16_t>(at);
    default:
        return load<std::uint32_t>(at);
    }
}

bool is_index_type(int type) {
    return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
           || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
           || type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

/// Equally spaced elements within one buffer view.
struct Strip {
    const std::byte* first = nullptr;
    std::uint64_t stride = 0;
};

/// Fails unless `count` elements of `element_size` bytes fit into the view from `offset` on.
Result<Strip> find_strip(
    const GltfDocument& document, int view_index, std::uint64_t offset, std::uint64_t count,
    std::uint64_t element_size, bool strided, const std::string& place) {
    const auto index = static_cast<std::size_t>(view_index);
    const std::span<const std::byte> bytes = view_bytes(document, index);
    const std::uint64_t own_stride = document.model.bufferViews[index].byteStride;
    const std::uint64_t stride = strided && own_stride != 0 ? own_stride : element_size;
    if (stride < element_size) {
        return fail(
            "{}: found a stride of {} in bufferViews[{}], expected at least the {} bytes of an "
            "element",
            place, stride, index, element_size);
    }
    // count < 2^32, stride <= 252 and offset < 2^53: no overflow.
    const std::uint64_t end = offset + (count - 1) * stride + element_size;
    if (end > bytes.size()) {
        return fail(
            "{}: found {} elements that end at byte {}, expected to stay within the {} of "
            "bufferViews[{}]",
            place, count, end, bytes.size(), index);
    }
    return Strip{bytes.data() + offset, stride};
}

/// Which elements a sparse accessor replaces, and by what.
struct Replacements {
    std::vector<std::uint32_t> elements;  ///< increasing, each below the accessor's count
    Strip values;
};

Result<Replacements> find_replacements(
    const GltfDocument& document, const tinygltf::Accessor& accessor, std::uint64_t element_size,
    const std::string& place) {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::uint64_t>(sparse.count);
    if (count > accessor.count) {
        return fail("{}.sparse.count: found {}, expected at most {}", place, count, accessor.count);
    }
    if (!is_index_type(sparse.indices.componentType)) {
        return fail(
            "{}.sparse.indices.componentType: found {}, expected 5121, 5123 or 5125", place,
            sparse.indices.componentType);
    }
    const std::uint64_t index_size = component_size(sparse.indices.componentType);
    const Result<Strip> indices = find_strip(
        document, sparse.indices.bufferView, static_cast<std::uint64_t>(sparse.indices.byteOffset),
        count, index_size, false, place + ".sparse.indices");
    if (!indices) {
        return indices.error();
    }
    const Result<Strip> values = find_strip(
        document, sparse.values.bufferView, static_cast<std::uint64_t>(sparse.values.byteOffset),
        count, element_size, false, place + ".sparse.values");
    if (!values) {
        return values.error();
    }
    Replacements result{{}, *values};
    result.elements.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint32_t element =
            load_index(indices->first + i * index_size, sparse.indices.componentType);
        if (element >= accessor.count) {
            return fail(
                "{}.sparse.indices: found {} at {}, expected an index below {}", place, element, i,
                accessor.count);
        }
        if (!result.elements.empty() && element <= result.elements.back()) {
            return fail(
                "{}.sparse.indices: found {} after {} at {}, expected increasing ones", place,
                element, result.elements.back(), i);
        }
        result.elements.push_back(element);
    }
    return result;
}

/// Where the elements of an accessor are; those in neither are zero.
struct Elements {
    Strip base;  ///< first is null when there is no buffer view
    Replacements sparse;
};

Result<Elements> find_elements(
    const GltfDocument& document, const tinygltf::Accessor& accessor, std::uint64_t element_size,
    const std::string& place) {
    Elements elements;
    if (accessor.bufferView >= 0) {
        const Result<Strip> strip = find_strip(
            document, accessor.bufferView, accessor.byteOffset, accessor.count, element_size, true,
            place);
        if (!strip) {
            return strip.error();
        }
        elements.base = *strip;
    } else if (accessor.count > kMaxZeros) {
        return fail(
            "{}.count: found {} elements without a bufferView, expected at most {}", place,
            accessor.count, kMaxZeros);
    }
    if (accessor.sparse.isSparse) {
        Result<Replacements> sparse = find_replacements(document, accessor, element_size, place);
        if (!sparse) {
            return sparse.error();
        }
        elements.sparse = std::move(*sparse);
    }
    return elements;
}

/// Calls store(element, bytes) for the elements that are somewhere.
template <typename Store>
void visit_elements(
    const tinygltf::Accessor& accessor, const Elements& elements, std::uint64_t size,
    Store&& store) {
    if (elements.base.first != nullptr) {
        for (std::uint64_t i = 0; i < accessor.count; ++i) {
            store(i, elements.base.first + i * elements.base.stride);
        }
    }
    for (std::uint64_t i = 0; i < elements.sparse.elements.size(); ++i) {
        store(elements.sparse.elements[i], elements.sparse.values.first + i * size);
    }
}

/// Counts `values` against what the file may still cost.
Status take_values(GltfDocument& document, std::uint64_t values, const std::string& place) {
    if (values > document.values_left) {
        return fail(
            "{}: found {} more numbers, expected at most {} in the whole file", place, values,
            document.limits.max_values);
    }
    document.values_left -= values;
    return Done{};
}

const tinygltf::Accessor& accessor_at(const GltfDocument& document, int index) {
    return document.model.accessors[static_cast<std::size_t>(index)];
}

}  // namespace

int component_count(const GltfDocument& document, int index) {
    return tinygltf::GetNumComponentsInType(
        static_cast<std::uint32_t>(accessor_at(document, index).type));
}

Result<std::vector<float>>
read_floats(GltfDocument& document, int index, int components, const std::string& place) {
    const tinygltf::Accessor& accessor = accessor_at(document, index);
    const std::string here = fmt::format("{}: accessors[{}]", place, index);
    const std::uint64_t size = component_size(accessor.componentType);
    if (component_count(document, index) != components) {
        return fail(
            "{}.type: found {} numbers an element, expected {}", here,
            component_count(document, index), components);
    }
    if (size == 0) {
        return fail(
            "{}.componentType: found {}, expected 5120 to 5123, 5125 or 5126", here,
            accessor.componentType);
    }
    const auto width = static_cast<std::uint64_t>(components);
    if (Status status = take_values(document, accessor.count * width, here); !status) {
        return status.error();
    }
    const Result<Elements> elements = find_elements(document, accessor, size * width, here);
    if (!elements) {
        return elements.error();
    }
    std::vector<float> values(accessor.count * width, 0.0f);
    std::optional<std::uint64_t> bad;
    visit_elements(
        accessor, *elements, size * width, [&](std::uint64_t element, const std::byte* bytes) {
            for (std::uint64_t k = 0; k < width; ++k) {
                const float value =
                    load_float(bytes + k * size, accessor.componentType, accessor.normalized);
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
read_indices(GltfDocument& document, int index, const std::string& place) {
    const tinygltf::Accessor& accessor = accessor_at(document, index);
    const std::string here = fmt::format("{}: accessors[{}]", place, index);
    if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_index_type(accessor.componentType)) {
        return fail(
            "{}: found {} numbers of type {} an element, expected one of type 5121, 5123 or 5125",
            here, component_count(document, index), accessor.componentType);
    }
    if (Status status = take_values(document, accessor.count, here); !status) {
        return status.error();
    }
    const std::uint64_t size = component_size(accessor.componentType);
    const Result<Elements> elements = find_elements(document, accessor, size, here);
    if (!elements) {
        return elements.error();
    }
    std::vector<std::uint32_t> values(accessor.count, 0);
    visit_elements(accessor, *elements, size, [&](std::uint64_t element, const std::byte* bytes) {
        values[element] = load_index(bytes, accessor.componentType);
    });
    return values;
}

}  // namespace limn
