#include "content/load/gltf/gltf_load.h"
#include "tests/content/gltf_samples.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>

#include <cmath>
#include <string>
#include <vector>

namespace limn::gltf_meshopt_test {

using namespace limn::test;

// EXT_meshopt_compression: what the library's own encoders write is read as the plain file is.

namespace {

using Stream = std::vector<std::byte>;

/// A bent sheet of n x n squares.
struct Sheet {
    std::vector<float> positions;
    std::vector<float> normals;
    std::vector<unsigned int> indices;
    std::size_t count = 0;  ///< vertices
};

Sheet make_sheet(unsigned int n) {
    Sheet sheet;
    for (unsigned int y = 0; y <= n; ++y) {
        for (unsigned int x = 0; x <= n; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(n);
            const float v = static_cast<float>(y) / static_cast<float>(n);
            sheet.positions.insert(sheet.positions.end(), {u, v, 0.3f * std::sin(4.0f * u)});
            const Vec3 normal = glm::normalize(Vec3(-1.2f * std::cos(4.0f * u), 0, 1));
            sheet.normals.insert(sheet.normals.end(), {normal.x, normal.y, normal.z});
            const unsigned int corner = y * (n + 1) + x;
            if (x < n && y < n) {
                sheet.indices.insert(
                    sheet.indices.end(),
                    {corner, corner + 1, corner + n + 2, corner, corner + n + 2, corner + n + 1});
            }
        }
    }
    sheet.count = sheet.positions.size() / 3;
    return sheet;
}

Stream encode_vertices(const void* values, std::size_t count, std::size_t stride) {
    Stream stream(meshopt_encodeVertexBufferBound(count, stride));
    stream.resize(meshopt_encodeVertexBuffer(
        reinterpret_cast<unsigned char*>(stream.data()), stream.size(), values, count, stride));
    return stream;
}

Stream encode_indices(const Sheet& sheet, bool as_triangles) {
    const std::vector<unsigned int>& indices = sheet.indices;
    Stream stream(
        as_triangles ? meshopt_encodeIndexBufferBound(indices.size(), sheet.count)
                     : meshopt_encodeIndexSequenceBound(indices.size(), sheet.count));
    auto* const bytes = reinterpret_cast<unsigned char*>(stream.data());
    stream.resize(
        as_triangles
            ? meshopt_encodeIndexBuffer(bytes, stream.size(), indices.data(), indices.size())
            : meshopt_encodeIndexSequence(bytes, stream.size(), indices.data(), indices.size()));
    return stream;
}

/// Views of a file, compressed or as they are.
class Views {
  public:
    /// `fallback`: what plain readers take; nothing in buffer 0 is meant for them.
    void
    add(const Stream& stream, std::size_t count, std::size_t stride, const std::string& mode,
        const std::string& filter = "NONE") {
        views_ += fmt::format(
            R"(,{{"buffer": 1, "byteOffset": 0, "byteLength": {}{}, "extensions": {{
                "EXT_meshopt_compression": {{"buffer": 0, "byteOffset": {}, "byteLength": {},
                "count": {}, "byteStride": {}, "mode": "{}", "filter": "{}"}}}}}})",
            count * stride,
            mode == "ATTRIBUTES" && stride % 4 == 0 && stride < 256
                ? fmt::format(R"(, "byteStride": {})", stride)
                : "",
            bytes_.size(), stream.size(), count, stride, mode, filter);
        bytes_.insert(bytes_.end(), stream.begin(), stream.end());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
    }

    /// The file of a mesh with these accessors.
    [[nodiscard]] std::vector<std::byte> glb(const std::string& accessors) const {
        const std::string json = fmt::format(
            R"({{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": {}}},
            {{"byteLength": 9000000, "extensions": {{"EXT_meshopt_compression": {{"fallback": true}}}}}}],
            "bufferViews": [{}], "accessors": [{}], "extensionsRequired": ["EXT_meshopt_compression"],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1}}, "indices": 2}}]}}],
            "nodes": [{{"mesh": 0}}]}})",
            bytes_.size(), views_.substr(1), accessors);
        return make_glb(json, bytes_);
    }

  private:
    std::string views_;
    std::vector<std::byte> bytes_;
};

std::string accessor(
    int view, std::size_t count, const std::string& type, int component, bool normalized = false) {
    return fmt::format(
        R"({{"bufferView": {}, "count": {}, "type": "{}", "componentType": {}, "normalized": {}}})",
        view, count, type, component, normalized);
}

std::string float_accessors(const Sheet& sheet) {
    return accessor(0, sheet.count, "VEC3", 5126) + "," + accessor(1, sheet.count, "VEC3", 5126)
           + "," + accessor(2, sheet.indices.size(), "SCALAR", 5125);
}

Views compress(const Sheet& sheet, bool as_triangles) {
    Views views;
    views.add(
        encode_vertices(sheet.positions.data(), sheet.count, 12), sheet.count, 12, "ATTRIBUTES");
    views.add(
        encode_vertices(sheet.normals.data(), sheet.count, 12), sheet.count, 12, "ATTRIBUTES");
    views.add(
        encode_indices(sheet, as_triangles), sheet.indices.size(), 4,
        as_triangles ? "TRIANGLES" : "INDICES");
    return views;
}

MeshData mesh_of(const std::vector<std::byte>& glb) {
    Result<GltfScene> scene = parse_gltf(glb, "sheet.glb", "");
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    CHECK(scene->warnings.empty());
    REQUIRE(scene->meshes.size() == 1);
    return std::move(scene->meshes[0]);
}

MeshData plain_mesh(const Sheet& sheet) {
    Numbers numbers;
    numbers.add("VEC3", 3, sheet.positions);
    numbers.add("VEC3", 3, sheet.normals);
    numbers.add_typed("SCALAR", 1, 5125, false, sheet.indices);
    const std::string json = R"({"asset": {"version": "2.0"}, )" + numbers.json() + R"(,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2}]}],
        "nodes": [{"mesh": 0}]})";
    return mesh_of(make_glb(json, numbers.bytes()));
}

/// Of the corners of all triangles, in order: what is drawn, however vertices are numbered.
float largest_distance(const MeshData& a, const MeshData& b, std::vector<Vec3> MeshData::*values) {
    REQUIRE(a.indices.size() == b.indices.size());
    float largest = 0;
    for (std::size_t i = 0; i < a.indices.size(); ++i) {
        largest =
            std::max(largest, glm::distance((a.*values)[a.indices[i]], (b.*values)[b.indices[i]]));
    }
    return largest;
}

}  // namespace

TEST_CASE("gltf meshopt: attributes and indices are those of the plain file, to the bit") {
    const Sheet sheet = make_sheet(20);
    const MeshData plain = plain_mesh(sheet);
    const MeshData sequence = mesh_of(compress(sheet, false).glb(float_accessors(sheet)));
    CHECK(sequence.positions == plain.positions);
    CHECK(sequence.normals == plain.normals);
    CHECK(sequence.indices == plain.indices);

    // The triangle mode may turn a triangle and start with another corner.
    const MeshData triangles = mesh_of(compress(sheet, true).glb(float_accessors(sheet)));
    REQUIRE(triangles.indices.size() == plain.indices.size());
    for (std::size_t i = 0; i < plain.indices.size(); i += 3) {
        Vec3 expected(0);
        Vec3 found(0);
        for (std::size_t k = i; k < i + 3; ++k) {
            expected += plain.positions[plain.indices[k]];
            found += triangles.positions[triangles.indices[k]];
        }
        CHECK(glm::distance(expected, found) < 1e-5f);
    }
}

TEST_CASE("gltf meshopt: filtered positions and normals are within their precision") {
    const Sheet sheet = make_sheet(16);
    const MeshData plain = plain_mesh(sheet);
    std::vector<float> padded;
    for (std::size_t i = 0; i < sheet.count; ++i) {
        padded.insert(
            padded.end(),
            {sheet.normals[3 * i], sheet.normals[3 * i + 1], sheet.normals[3 * i + 2], 0});
    }
    Stream positions(12 * sheet.count);
    meshopt_encodeFilterExp(positions.data(), sheet.count, 12, 15, sheet.positions.data());
    struct Octahedral {
        std::size_t stride;
        int component;
        int bits;
        float error;
    };
    for (const Octahedral& format : {Octahedral{4, 5120, 8, 0.02f}, {8, 5122, 12, 2e-3f}}) {
        CAPTURE(format.stride);
        Stream normals(format.stride * sheet.count);
        meshopt_encodeFilterOct(
            normals.data(), sheet.count, format.stride, format.bits, padded.data());
        Views views;
        views.add(
            encode_vertices(positions.data(), sheet.count, 12), sheet.count, 12, "ATTRIBUTES",
            "EXPONENTIAL");
        views.add(
            encode_vertices(normals.data(), sheet.count, format.stride), sheet.count, format.stride,
            "ATTRIBUTES", "OCTAHEDRAL");
        views.add(encode_indices(sheet, false), sheet.indices.size(), 4, "INDICES");
        const std::string accessors =
            accessor(0, sheet.count, "VEC3", 5126) + ","
            + fmt::format(
                R"({{"bufferView": 1, "count": {}, "type": "VEC3", "componentType": {}, "normalized": true}})",
                sheet.count, format.component)
            + "," + accessor(2, sheet.indices.size(), "SCALAR", 5125);
        const MeshData mesh = mesh_of(views.glb(accessors));
        CHECK(largest_distance(mesh, plain, &MeshData::positions) < 1.0f / (1 << 13));
        CHECK(largest_distance(mesh, plain, &MeshData::normals) < format.error);
    }
}

TEST_CASE("gltf meshopt: rotations by the quaternion filter turn instances as plain ones do") {
    const Sheet sheet = make_sheet(2);
    constexpr std::size_t kCount = 64;
    std::vector<float> rotations;
    for (std::size_t i = 0; i < kCount; ++i) {
        const float t = static_cast<float>(i);
        const Quat q = glm::normalize(
            Quat(std::sin(t), std::cos(1.7f * t), std::sin(2.3f * t + 1), std::cos(0.6f * t)));
        rotations.insert(rotations.end(), {q.x, q.y, q.z, q.w});
    }
    Stream filtered(8 * kCount);
    meshopt_encodeFilterQuat(filtered.data(), kCount, 8, 16, rotations.data());
    Views views = compress(sheet, false);
    views.add(encode_vertices(filtered.data(), kCount, 8), kCount, 8, "ATTRIBUTES", "QUATERNION");
    const std::vector<std::byte> glb =
        views.glb(float_accessors(sheet) + "," + accessor(3, kCount, "VEC4", 5122, true));
    std::string bytes(reinterpret_cast<const char*>(glb.data()), glb.size());
    const std::size_t size =
        20 + static_cast<std::uint8_t>(bytes[12]) + 256u * static_cast<std::uint8_t>(bytes[13]);
    std::string json = replace_once(
        bytes.substr(20, size - 20), R"("nodes": [{"mesh": 0}])",
        R"("nodes": [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
           {"attributes": {"ROTATION": 3}}}}])");
    const Result<GltfScene> scene = parse_gltf(
        make_glb(json, std::vector<std::byte>(glb.begin() + size + 8, glb.end())), "sheet.glb", "");
    REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
    REQUIRE(scene->nodes.size() == kCount + 1);
    for (std::size_t i = 0; i < kCount; ++i) {
        const Quat& found = scene->nodes[i + 1].transform.rotation;
        const float* const q = &rotations[4 * i];
        CHECK(
            std::abs(found.x * q[0] + found.y * q[1] + found.z * q[2] + found.w * q[3]) > 0.99999f);
    }
}

TEST_CASE("gltf meshopt: a broken stream is refused in one line, whatever its bytes are") {
    const Sheet sheet = make_sheet(8);
    const std::vector<std::byte> good = compress(sheet, true).glb(float_accessors(sheet));
    const std::size_t json =
        20 + std::to_integer<std::size_t>(good[12]) + 256 * std::to_integer<std::size_t>(good[13]);
    std::uint32_t random = 1;
    std::size_t refused = 0;
    for (int i = 0; i < 400; ++i) {
        std::vector<std::byte> bytes = good;
        for (int k = 0; k < 3; ++k) {
            random = random * 1664525u + 1013904223u;
            const std::size_t at = json + 8 + (random >> 8) % (bytes.size() - json - 8);
            bytes[at] = std::byte(random & 255u);
        }
        const Result<GltfScene> scene = parse_gltf(bytes, "sheet.glb", "");
        if (!scene) {
            ++refused;
            CHECK(scene.error().message.starts_with("sheet.glb: "));
            CHECK(scene.error().message.find('\n') == std::string::npos);
        }
    }
    CHECK(refused > 20);
    std::vector<std::byte> bytes = good;
    bytes[json + 8] = std::byte{0};  // the version of the first stream
    const Result<GltfScene> scene = parse_gltf(bytes, "sheet.glb", "");
    REQUIRE_FALSE(scene.ok());
    CHECK(scene.error().message.starts_with(
        "sheet.glb: bufferViews[0].extensions.EXT_meshopt_compression: found a broken stream"));
}

TEST_CASE("gltf meshopt: sizes that do not fit the mode are refused") {
    const Sheet sheet = make_sheet(4);
    const Stream positions = encode_vertices(sheet.positions.data(), sheet.count, 12);
    struct Case {
        std::size_t count;
        std::size_t stride;
        std::string mode;
        std::string filter;
    };
    for (const Case& bad :
         {Case{25, 10, "ATTRIBUTES", "NONE"},
          {25, 12, "ATTRIBUTES", "OCTAHEDRAL"},
          {25, 12, "ATTRIBUTES", "QUATERNION"},
          {24, 12, "TRIANGLES", "NONE"},
          {25, 4, "TRIANGLES", "NONE"},
          {24, 4, "INDICES", "EXPONENTIAL"},
          {25, 300, "ATTRIBUTES", "NONE"},
          {25, 12, "POINTS", "NONE"},
          {4000000000, 256, "ATTRIBUTES", "NONE"},
          {26000, 12, "ATTRIBUTES", "NONE"}}) {
        CAPTURE(bad.mode);
        CAPTURE(bad.stride);
        const std::string position = accessor(0, 4, "VEC3", 5126);
        Views views;
        views.add(positions, bad.count, bad.stride, bad.mode, bad.filter);
        const Result<GltfScene> scene =
            parse_gltf(views.glb(position + "," + position + "," + position), "sheet.glb", "");
        REQUIRE_FALSE(scene.ok());
        CHECK(scene.error().message.find("bufferViews[0].ext") != std::string::npos);
    }
}

}  // namespace limn::gltf_meshopt_test
