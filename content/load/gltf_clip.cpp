#include "content/load/gltf_clip.h"

#include "content/load/atomic_file.h"
#include "content/load/gltf_document.h"
#include "content/load/gltf_file.h"
#include "content/load/gltf_write.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <span>
#include <string_view>
#include <utility>

namespace limn {

namespace {

JsonValue json_index(std::size_t index) {
    return json_of(static_cast<std::uint64_t>(index));
}

Result<GltfDocument> open(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    return open_gltf(bytes, path, std::filesystem::path(path).parent_path().string(), {});
}

/// The member `key`, made where it is missing.
JsonValue& member(JsonValue& object, std::string_view key, JsonValue missing) {
    const auto found = std::ranges::find(object.members, key, &JsonMember::key);
    if (found != object.members.end()) {
        return found->value;
    }
    object.members.push_back({std::string(key), {}, std::move(missing)});
    return object.members.back().value;
}

void remove_member(JsonValue& object, std::string_view key) {
    std::erase_if(object.members, [key](const JsonMember& member) { return member.key == key; });
}

/// A file whose buffers are being joined into one.
struct Joined {
    JsonValue& json;
    std::vector<std::byte> bytes;

    std::size_t append(std::span<const std::byte> added) {
        const std::size_t at = bytes.size();
        bytes.insert(bytes.end(), added.begin(), added.end());
        bytes.resize((bytes.size() + 3) / 4 * 4);
        return at;
    }

    /// The index of a view of these bytes.
    JsonValue add_view(std::span<const std::byte> added) {
        JsonValue view = json_object();
        view.members.push_back({"buffer", {}, json_index(0)});
        view.members.push_back({"byteOffset", {}, json_index(append(added))});
        view.members.push_back({"byteLength", {}, json_index(added.size())});
        JsonValue& views = member(json, "bufferViews", json_array());
        views.items.push_back(std::move(view));
        return json_index(views.items.size() - 1);
    }

    JsonValue add_accessor(std::span<const float> values, const char* type, std::size_t count) {
        JsonValue accessor = json_object();
        accessor.members.push_back({"bufferView", {}, add_view(std::as_bytes(values))});
        accessor.members.push_back({"componentType", {}, json_index(kGltfFloat)});
        accessor.members.push_back({"count", {}, json_index(count)});
        accessor.members.push_back({"type", {}, json_of(std::string_view(type))});
        JsonValue& accessors = member(json, "accessors", json_array());
        accessors.items.push_back(std::move(accessor));
        return json_index(accessors.items.size() - 1);
    }
};

/// Puts all buffers of the document into one, and all views on it.
void join_buffers(const GltfDocument& document, Joined& joined) {
    std::vector<std::size_t> offsets;
    for (const std::vector<std::byte>& buffer : document.buffers) {
        offsets.push_back(joined.append(buffer));
    }
    if (document.json.find("bufferViews") == nullptr) {
        return;
    }
    for (JsonValue& view : member(joined.json, "bufferViews", json_array()).items) {
        const auto buffer = static_cast<std::size_t>(index_of(view["buffer"]));
        const auto offset = static_cast<std::size_t>(number_of(view["byteOffset"], 0.0));
        member(view, "buffer", {}) = json_index(0);
        member(view, "byteOffset", {}) = json_index(offsets[buffer] + offset);
    }
}

/// Puts images from files into the buffer.
Status join_images(const GltfDocument& document, Joined& joined) {
    if (document.json.find("images") == nullptr) {
        return Done{};
    }
    for (JsonValue& image : member(joined.json, "images", json_array()).items) {
        const std::string uri = image["uri"].text;
        if (uri.empty() || uri.starts_with("data:")) {
            continue;
        }
        const std::vector<std::byte> bytes =
            LIMN_TRY(fetch_uri(uri, document.folder, document.file, document.limits.max_bytes));
        const bool is_png = bytes.size() > 3 && std::memcmp(bytes.data() + 1, "PNG", 3) == 0;
        remove_member(image, "uri");
        image.members.push_back({"bufferView", {}, joined.add_view(bytes)});
        member(image, "mimeType", {}) =
            json_of(std::string_view(is_png ? "image/png" : "image/jpeg"));
    }
    return Done{};
}

class Animation {
  public:
    Animation(Joined& joined, const GltfFaceClip& clip) : joined_(joined) {
        times_ = joined.add_accessor(clip.times, "SCALAR", clip.times.size());
        JsonValue& accessor = member(joined.json, "accessors", {}).items.back();
        accessor.members.push_back({"min", {}, json_array({json_of(clip.times.front())})});
        accessor.members.push_back({"max", {}, json_array({json_of(clip.times.back())})});
    }

    void add(std::uint32_t node, const char* path, JsonValue values) {
        JsonValue target = json_object();
        target.members.push_back({"node", {}, json_index(node)});
        target.members.push_back({"path", {}, json_of(std::string_view(path))});
        JsonValue channel = json_object();
        channel.members.push_back({"sampler", {}, json_index(samplers_.items.size())});
        channel.members.push_back({"target", {}, std::move(target)});
        channels_.items.push_back(std::move(channel));
        JsonValue sampler = json_object();
        sampler.members.push_back({"input", {}, times_});
        sampler.members.push_back({"output", {}, std::move(values)});
        samplers_.items.push_back(std::move(sampler));
    }

    void finish(const std::string& name) {
        JsonValue animation = json_object();
        animation.members.push_back({"name", {}, json_of(std::string_view(name))});
        animation.members.push_back({"channels", {}, std::move(channels_)});
        animation.members.push_back({"samplers", {}, std::move(samplers_)});
        std::vector<JsonValue>& all = member(joined_.json, "animations", json_array()).items;
        all.insert(all.begin(), std::move(animation));
    }

  private:
    Joined& joined_;
    JsonValue times_;
    JsonValue channels_ = json_array();
    JsonValue samplers_ = json_array();
};

bool is_head(std::string_view name) {
    return name == "head" || name == "Head" || name == "HEAD" || name.ends_with(":Head");
}

}  // namespace

Result<GltfFace> read_gltf_face(const std::string& path) {
    const GltfDocument document = LIMN_TRY(open(path));
    GltfFace face;
    const std::vector<JsonValue>& nodes = document.json["nodes"].items;
    std::vector<bool> is_child(nodes.size(), false);
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        for (const JsonValue& child : nodes[i]["children"].items) {
            is_child[static_cast<std::size_t>(index_of(child))] = true;
        }
        if (!face.head && is_head(nodes[i]["name"].text)) {
            face.head = i;
        }
        if (nodes[i].find("mesh") == nullptr) {
            continue;
        }
        const JsonValue& mesh = json_item(document, "meshes", index_of(nodes[i]["mesh"]));
        const std::size_t count = mesh["primitives"].items[0]["targets"].items.size();
        if (count == 0) {
            continue;
        }
        GltfFaceNode& shapes = face.nodes.emplace_back();
        shapes.node = i;
        const JsonValue& names = mesh["extras"]["targetNames"];
        const JsonValue& units = mesh["extras"]["actionUnits"];
        for (std::size_t s = 0; s < count; ++s) {
            shapes.shapes.push_back(
                {s < names.items.size() ? names.items[s].text : format_text("target {}", s),
                 s < units.items.size() ? units.items[s].text : ""});
        }
    }
    if (face.nodes.empty()) {
        return fail("{}: found no morph targets, expected a face with shapes", path);
    }
    if (!face.head && document.json["skins"].items.empty()
        && std::ranges::count(is_child, false) == 1) {
        const auto root = std::ranges::find(is_child, false) - is_child.begin();
        if (nodes[static_cast<std::size_t>(root)].find("matrix") == nullptr) {
            face.head = static_cast<std::uint32_t>(root);
        }
    }
    if (face.head) {
        const Vec4 q = vector_of(nodes[*face.head]["rotation"], Vec4(0, 0, 0, 1));
        face.head_rotation = Quat(q.w, q.x, q.y, q.z);
    }
    return face;
}

Result<std::vector<std::byte>>
add_face_clip(const std::string& path, const GltfFace& face, const GltfFaceClip& clip) {
    LIMN_CHECK(!clip.times.empty() && clip.weights.size() == face.nodes.size());
    const GltfDocument document = LIMN_TRY(open(path));
    JsonValue json = document.json;
    Joined joined{json, {}};
    join_buffers(document, joined);
    LIMN_TRY(join_images(document, joined));
    Animation animation(joined, clip);
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
        LIMN_CHECK(clip.weights[i].size() == clip.times.size() * face.nodes[i].shapes.size());
        animation.add(
            face.nodes[i].node, "weights",
            joined.add_accessor(clip.weights[i], "SCALAR", clip.weights[i].size()));
    }
    if (face.head && !clip.head_rotations.empty()) {
        std::vector<float> rotations;
        for (const Quat& q : clip.head_rotations) {
            rotations.insert(rotations.end(), {q.x, q.y, q.z, q.w});
        }
        animation.add(
            *face.head, "rotation", joined.add_accessor(rotations, "VEC4", clip.times.size()));
    }
    animation.finish(clip.name);
    return pack_glb(std::move(json), joined.bytes, path);
}

}  // namespace limn
