#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace limn::test {

// Small glTF files made in memory, to be spoiled by the tests of bad input.

template <typename T>
void append_values(std::vector<std::byte>& bytes, const std::vector<T>& values) {
    const std::size_t at = bytes.size();
    bytes.resize(at + values.size() * sizeof(T));
    std::memcpy(bytes.data() + at, values.data(), values.size() * sizeof(T));
}

/// A GLB with the two chunks, padded as the standard wants.
inline std::vector<std::byte> make_glb(std::string json, std::vector<std::byte> binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4);
    std::vector<std::byte> glb;
    const auto chunk = [&glb](std::uint32_t type, const void* data, std::size_t size) {
        append_values<std::uint32_t>(glb, {static_cast<std::uint32_t>(size), type});
        const std::size_t at = glb.size();
        glb.resize(at + size);
        std::memcpy(glb.data() + at, data, size);
    };
    append_values<std::uint32_t>(glb, {0x46546c67, 2, 0});
    chunk(0x4e4f534a, json.data(), json.size());
    if (!binary.empty()) {
        chunk(0x004e4942, binary.data(), binary.size());
    }
    const auto length = static_cast<std::uint32_t>(glb.size());
    std::memcpy(glb.data() + 8, &length, 4);
    return glb;
}

/// Numbers of a buffer; each list is a view and an accessor of its own.
class Numbers {
  public:
    void add(const char* type, std::size_t width, const std::vector<float>& values) {
        add_typed(type, width, 5126, false, values);
    }
    template <typename T>
    void add_typed(
        const char* type, std::size_t width, int component_type, bool normalized,
        const std::vector<T>& values) {
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
        const std::size_t at = bytes_.size();
        append_values(bytes_, values);
        views_ += fmt::format(
            R"(,{{"buffer": 0, "byteOffset": {}, "byteLength": {}}})", at,
            values.size() * sizeof(T));
        accessors_ += fmt::format(
            R"(,{{"bufferView": {}, "componentType": {}, "normalized": {}, "count": {}, "type": "{}"}})",
            count_, component_type, normalized, values.size() / width, type);
        ++count_;
    }
    /// A further accessor as JSON; views are numbered as the lists are.
    void add_accessor(const std::string& json) { accessors_ += "," + json; }
    [[nodiscard]] std::string json() const {
        return fmt::format(
            R"("buffers": [{{"byteLength": {}}}], "bufferViews": [{}], "accessors": [{}])",
            bytes_.size(), views_.substr(1), accessors_.substr(1));
    }
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }

  private:
    std::vector<std::byte> bytes_;
    std::string views_;
    std::string accessors_;
    int count_ = 0;
};

/// `text` with its only `from` replaced; the text itself when it is not there once, which parses
/// and so fails the test.
inline std::string replace_once(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at != std::string::npos && text.find(from, at + 1) == std::string::npos) {
        text.replace(at, from.size(), to);
    }
    return text;
}

/// The unit square of two triangles in z = 0: 48 bytes of positions, 12 of 16 bit indices, 4 of
/// padding, then 2 of sparse indices, 2 of padding and 24 of sparse values.
inline std::vector<std::byte> square_binary() {
    std::vector<std::byte> bytes;
    append_values<float>(bytes, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    append_values<std::uint16_t>(bytes, {0, 1, 2, 0, 2, 3, 0, 0});
    append_values<std::uint8_t>(bytes, {1, 3, 0, 0});
    append_values<float>(bytes, {2, 0, 0, 0, 2, 0});
    return bytes;
}

inline const char* const kSquareJson = R"({
    "asset": {"version": "2.0"},
    "buffers": [{"byteLength": 92}],
    "bufferViews": [
        {"buffer": 0, "byteOffset": 0, "byteLength": 48},
        {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        {"buffer": 0, "byteOffset": 64, "byteLength": 2},
        {"buffer": 0, "byteOffset": 68, "byteLength": 24}
    ],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
         "sparse": {"count": 2, "indices": {"bufferView": 2, "componentType": 5121},
                    "values": {"bufferView": 3}}}
    ],
    "materials": [{"name": "paint"}],
    "meshes": [{"name": "square", "primitives": [
        {"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "nodes": [
        {"name": "root", "children": [1]},
        {"name": "leaf", "mesh": 0, "translation": [1, 2, 3]}
    ],
    "scenes": [{"nodes": [0]}],
    "scene": 0
})";

inline std::vector<std::byte> square_glb() {
    return make_glb(kSquareJson, square_binary());
}

}  // namespace limn::test
