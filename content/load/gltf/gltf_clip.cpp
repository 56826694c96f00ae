#include "content/load/gltf/gltf_clip.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/file_uri.h"
#include "content/load/gltf/gltf_file.h"
#include "ecs/base/check.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

// Techniques: face.talking-head

namespace limn {

namespace {

Result<GltfDocument> open_face(std::span<const std::byte> bytes, const std::string& path) {
    return open_gltf(bytes, path, std::filesystem::path(path).parent_path().string(), {});
}

/// Puts all buffers into one, and all views on it.
void join_buffers(tinygltf::Model& model) {
    std::vector<std::size_t> offsets;
    std::vector<unsigned char> joined;
    for (const tinygltf::Buffer& buffer : model.buffers) {
        offsets.push_back(joined.size());
        joined.insert(joined.end(), buffer.data.begin(), buffer.data.end());
        joined.resize((joined.size() + 3) / 4 * 4);
    }
    offsets.resize(std::max<std::size_t>(offsets.size(), 1));  // for views that are left out
    for (tinygltf::BufferView& view : model.bufferViews) {
        view.byteOffset += item_at(offsets, view.buffer);
        view.buffer = 0;
    }
    model.buffers.resize(1);
    model.buffers[0].data = std::move(joined);
    model.buffers[0].uri.clear();
}

/// Copies images from existing files into the buffer.
void join_images(GltfDocument& document) {
    for (std::size_t i = 0; i < document.images.size(); ++i) {
        const std::optional<std::string>& uri = document.images[i].uri;
        tinygltf::Image& image = document.model.images[i];
        image.uri = uri.value_or("");
        image.bufferView = document.images[i].view;
        if (!uri || uri->starts_with("data:")) {
            continue;
        }
        const Result<std::vector<std::byte>> bytes = fetch_uri(
            *uri, document.folder, format_text("{}: images[{}]", document.file, i),
            document.limits.max_bytes);
        if (!bytes) {
            log_warn("{}; the reference stays", bytes.error().message);
            continue;
        }
        const bool is_png = bytes->size() > 3 && std::memcmp(bytes->data() + 1, "PNG", 3) == 0;
        image.uri.clear();
        image.bufferView = append_view(document.model, *bytes);
        image.mimeType = is_png ? "image/png" : "image/jpeg";
    }
}

JsonValue& member_at(JsonValue& object, std::string_view key) {
    const auto found = std::ranges::find(object.members, key, &JsonMember::key);
    if (found != object.members.end()) {
        return found->value;
    }
    object.members.push_back({std::string(key), {}, {}});
    return object.members.back().value;
}

/// The document written by tinygltf, with everything that the clip does not change copied from the
/// file's JSON `source`: tinygltf would lose extensions of accessors and buffer views, 64 bit
/// integers and empty values in extras, and members that it does not know.
Result<std::vector<std::byte>> pack_all(const GltfDocument& document, const JsonValue& source) {
    const std::vector<std::byte> bytes = LIMN_TRY(pack_model(document.model, document.file));
    const GltfChunks chunks = LIMN_TRY(split_gltf(bytes, document.file));
    JsonValue written = LIMN_TRY(parse_json(
        chunks.json, document.file,
        {.max_bytes = chunks.json.size(), .max_values = 2 * document.limits.max_json_values}));
    for (const JsonMember& kept : source.members) {
        JsonValue& target = member_at(written, kept.key);
        if (kept.key == "bufferViews" || kept.key == "images") {
            for (std::size_t i = 0; i < kept.value.items.size(); ++i) {
                for (const JsonMember& part : kept.value.items[i].members) {
                    if (part.key != "buffer" && part.key != "byteOffset" && part.key != "uri") {
                        member_at(target.items[i], part.key) = part.value;
                    }
                }
            }
        } else if (kept.key == "accessors" || kept.key == "animations") {
            const std::ptrdiff_t first = kept.key == "animations" ? 1 : 0;
            std::ranges::copy(kept.value.items, target.items.begin() + first);
        } else if (kept.key != "buffers") {
            target = kept.value;
        }
    }
    return pack_json(written, chunks.binary, document.file);
}

bool is_head(std::string_view name) {
    return name == "head" || name == "Head" || name == "HEAD" || name.ends_with(":Head");
}

}  // namespace

Result<GltfFace> read_gltf_face(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    const GltfDocument document = LIMN_TRY(open_face(bytes, path));
    GltfFace face;
    const std::vector<tinygltf::Node>& nodes = document.model.nodes;
    std::vector<bool> is_child(nodes.size(), false);
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
            is_child[static_cast<std::size_t>(child)] = true;
        }
        if (!face.head && is_head(nodes[i].name)) {
            face.head = i;
        }
        if (nodes[i].mesh < 0) {
            continue;
        }
        const auto mesh = static_cast<std::size_t>(nodes[i].mesh);
        const std::vector<tinygltf::Primitive>& primitives = document.model.meshes[mesh].primitives;
        const std::size_t count = primitives.empty() ? 0 : primitives[0].targets.size();
        if (count == 0) {
            continue;
        }
        GltfFaceNode& shapes = face.nodes.emplace_back();
        shapes.node = i;
        const JsonValue& extras = extras_of(document, "meshes", mesh);
        const std::vector<JsonValue>& names = extras["targetNames"].items;
        const std::vector<JsonValue>& units = extras["actionUnits"].items;
        for (std::size_t s = 0; s < count; ++s) {
            shapes.shapes.push_back(
                {s < names.size() ? names[s].text : format_text("target {}", s),
                 s < units.size() ? units[s].text : ""});
        }
    }
    if (face.nodes.empty()) {
        return fail("{}: found no morph targets, expected a face with shapes", path);
    }
    if (!face.head && document.model.skins.empty() && std::ranges::count(is_child, false) == 1) {
        const auto root = std::ranges::find(is_child, false) - is_child.begin();
        if (nodes[static_cast<std::size_t>(root)].matrix.empty()) {
            face.head = static_cast<std::uint32_t>(root);
        }
    }
    if (face.head) {
        const Vec4 q = vector_of(nodes[*face.head].rotation, Vec4(0, 0, 0, 1));
        face.head_rotation = Quat(q.w, q.x, q.y, q.z);
    }
    return face;
}

Result<std::vector<std::byte>>
add_face_clip(const std::string& path, const GltfFace& face, const GltfFaceClip& clip) {
    LIMN_CHECK(!clip.times.empty() && clip.weights.size() == face.nodes.size());
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    GltfDocument document = LIMN_TRY(open_face(bytes, path));
    tinygltf::Model& model = document.model;
    join_buffers(model);
    join_images(document);
    tinygltf::Animation animation;
    animation.name = clip.name;
    const int times = append_times(model, clip.times);
    const auto add = [&](std::uint32_t node, const char* property, int type, std::size_t count,
                         std::span<const float> values) {
        append_channel(
            animation, static_cast<int>(node), property, times,
            append_accessor(
                model, type, TINYGLTF_COMPONENT_TYPE_FLOAT, count, std::as_bytes(values)));
    };
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
        const std::vector<float>& weights = clip.weights[i];
        LIMN_CHECK(weights.size() == clip.times.size() * face.nodes[i].shapes.size());
        add(face.nodes[i].node, "weights", TINYGLTF_TYPE_SCALAR, weights.size(), weights);
    }
    if (face.head && !clip.head_rotations.empty()) {
        std::vector<float> rotations;
        for (const Quat& q : clip.head_rotations) {
            rotations.insert(rotations.end(), {q.x, q.y, q.z, q.w});
        }
        add(*face.head, "rotation", TINYGLTF_TYPE_VEC4, clip.times.size(), rotations);
    }
    model.animations.insert(model.animations.begin(), std::move(animation));
    const GltfChunks chunks = LIMN_TRY(split_gltf(bytes, path));
    return pack_all(
        document, LIMN_TRY(parse_json(
                      chunks.json, path,
                      {.max_bytes = bytes.size(), .max_values = document.limits.max_json_values})));
}

}  // namespace limn
