#include "content/load/gltf/gltf_file.h"

#include "content/load/files/file_uri.h"
#include "content/load/gltf/gltf_extensions.h"
#include "content/load/gltf/gltf_meshopt.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <exception>
#include <limits>
#include <sstream>
#include <utility>

// Limitations of tinygltf 2.7, and the workarounds before and after it runs:
//
// - It ignores values of a wrong type, names no position, and recurses as deep as the JSON is
//   nested: parse_json and check_gltf_schema come first.
// - It reads + in a URI as a space, knows seven media types of data: URIs, skips characters that
//   are not base64, requires buffers of exactly byteLength, and decodes unused images: each URI is
//   replaced by the number of its buffer, whose bytes we have, and images are removed.
// - A buffer without data, bad items and indices without a buffer view fail the whole file, even if
//   nothing reads them; channels without a node are lost. They get stand-ins.
// - It accumulates errors, fatal or not: the last line is the cause.

namespace limn {

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546c67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004e4942;   // "BIN"

std::uint32_t little_endian(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    }
    return value;
}

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<GltfChunks> split_glb(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() < 20) {
        return fail("{}: found a GLB of {} bytes, expected at least 20", file, bytes.size());
    }
    const std::uint32_t version = little_endian(bytes, 4);
    if (version != 2) {
        return fail("{}: found GLB version {}, expected 2", file, version);
    }
    const std::uint32_t length = little_endian(bytes, 8);
    if (length > bytes.size()) {
        return fail(
            "{}: found {} bytes, expected {} as in the GLB header", file, bytes.size(), length);
    }
    GltfChunks chunks;
    chunks.trailing = bytes.size() - length;
    bytes = bytes.first(length);
    bool has_json = false;
    for (std::size_t at = 12; at < bytes.size();) {
        if (bytes.size() - at < 8) {
            chunks.trailing += bytes.size() - at;
            break;
        }
        const std::uint32_t size = little_endian(bytes, at);
        const std::uint32_t type = little_endian(bytes, at + 4);
        at += 8;
        if (size > bytes.size() - at) {
            return fail(
                "{}: found a GLB chunk of {} bytes, expected at most the {} left in the file", file,
                size, bytes.size() - at);
        }
        const std::span<const std::byte> data = bytes.subspan(at, size);
        if (!has_json && type != kJsonChunk) {
            return fail(
                "{}: found chunk type {}, expected JSON as the first chunk", file,
                fmt::format("{:#010x}", type));
        }
        if (!has_json) {
            chunks.json = as_text(data);
            has_json = true;
        } else if (type == kBinChunk && !chunks.has_binary) {
            chunks.binary = data;
            chunks.has_binary = true;
        }
        at += size;
    }
    if (!has_json) {
        return fail("{}: found a GLB without chunks, expected JSON", file);
    }
    // The standard pads with spaces, some exporters with zeros.
    chunks.json = chunks.json.substr(0, chunks.json.find_last_not_of('\0') + 1);
    return chunks;
}

Status check_version(const JsonValue& json, const std::string& file) {
    const std::string& version = json["asset"]["version"].text;
    if (!version.starts_with("2.")) {
        return fail("{}: asset.version: found {}, expected 2.x", file, in_quotes(version));
    }
    return Done{};
}

JsonValue* find_member(JsonValue& object, std::string_view key) {
    return const_cast<JsonValue*>(object.find(key));
}

/// Items of the array at `key`; none if there is no such member.
std::span<JsonValue> items_of(JsonValue& object, std::string_view key) {
    JsonValue* const array = find_member(object, key);
    return array != nullptr ? std::span(array->items) : std::span<JsonValue>();
}

void set_member(JsonValue& object, std::string_view key, JsonValue value) {
    if (JsonValue* const member = find_member(object, key)) {
        *member = std::move(value);
    } else {
        object.members.push_back({std::string(key), {}, std::move(value)});
    }
}

std::optional<JsonValue> take_member(JsonValue& object, std::string_view key) {
    const auto found = std::ranges::find(object.members, key, &JsonMember::key);
    if (found == object.members.end()) {
        return std::nullopt;
    }
    JsonValue value = std::move(found->value);
    object.members.erase(found);
    return value;
}

/// Files written on Windows may have backslashes instead of slashes, also as %5C.
std::string read_slashes(GltfDocument& document, std::string uri, const std::string& where) {
    if (uri.starts_with("data:")) {
        return uri;
    }
    std::string slashes;
    for (std::string_view rest = uri; !rest.empty();) {
        const bool is_code = rest.starts_with("%5C") || rest.starts_with("%5c");
        slashes += is_code || rest[0] == '\\' ? '/' : rest[0];
        rest.remove_prefix(is_code ? 3 : 1);
    }
    if (slashes != uri) {
        document.warnings.push_back(fmt::format(
            "{}: found {}, expected no backslash; it is read as a slash", where, in_quotes(uri)));
    }
    return slashes;
}

/// The buffers that tinygltf reads through its callbacks.
using BufferBytes = std::vector<std::vector<std::byte>>;

/// Fetches the bytes of all buffers, and replaces their URIs by their numbers.
Result<BufferBytes> take_buffers(GltfDocument& document, const GltfChunks& chunks) {
    BufferBytes all;
    std::uint64_t total = 0;
    for (JsonValue& buffer : items_of(document.json, "buffers")) {
        const std::string where = fmt::format("{}: buffers[{}]", document.file, all.size());
        const auto length = static_cast<std::uint64_t>(buffer["byteLength"].number);
        const std::optional<JsonValue> uri = take_member(buffer, "uri");
        set_member(buffer, "uri", json_of(std::to_string(all.size())));
        std::vector<std::byte>& bytes = all.emplace_back();
        if (uri) {
            bytes = LIMN_TRY(fetch_uri(
                read_slashes(document, uri->text, where + ".uri"), document.folder, where + ".uri",
                document.limits.max_bytes));
        } else if (all.size() == 1 && chunks.has_binary) {
            bytes.assign(chunks.binary.begin(), chunks.binary.end());
        } else {
            // An extension that Limn does not support may provide the data.
            if (!buffer["extensions"]["EXT_meshopt_compression"]["fallback"].truth) {
                document.warnings.push_back(where + ": it has no data");
            }
            set_member(buffer, "byteLength", json_of(std::uint64_t{1}));
            continue;
        }
        if (length == 0) {  // tinygltf rejects it
            bytes.clear();
            set_member(buffer, "byteLength", json_of(std::uint64_t{1}));
        }
        if (length > bytes.size()) {
            return fail(
                "{}.byteLength: found {}, expected at most the {} bytes available", where, length,
                bytes.size());
        }
        bytes.resize(length);
        total += length;
        if (total > document.limits.max_bytes) {
            return fail(
                "{}: found {} bytes in buffers, expected at most {}", where, total,
                document.limits.max_bytes);
        }
    }
    return all;
}

void take_images(GltfDocument& document) {
    for (JsonValue& image : items_of(document.json, "images")) {
        std::optional<JsonValue> uri = take_member(image, "uri");
        const std::optional<JsonValue> view = take_member(image, "bufferView");
        GltfImage& taken = document.images.emplace_back();
        if (uri) {
            taken.uri = read_slashes(
                document, std::move(uri->text),
                fmt::format("{}: images[{}].uri", document.file, document.images.size() - 1));
        }
        if (view) {
            taken.view = static_cast<std::int32_t>(view->number);
        }
        set_member(image, "uri", json_of(std::string_view("image")));
    }
}

void warn_of_empty_accessors(GltfDocument& document) {
    const std::vector<JsonValue>& accessors = document.json["accessors"].items;
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        if (accessors[i]["count"].number == 0) {
            document.warnings.push_back(fmt::format(
                "{}: accessors[{}].count: found 0, expected at least 1", document.file, i));
        }
    }
}

void add_missing_targets(JsonValue& json) {
    for (JsonValue& animation : items_of(json, "animations")) {
        for (JsonValue& channel : items_of(animation, "channels")) {
            JsonValue& target = *find_member(channel, "target");
            if (target.find("node") == nullptr) {
                set_member(target, "node", json_of(std::int64_t{-1}));
            }
        }
    }
}

/// Indices of a primitive whose accessor has no buffer view.
struct LooseIndices {
    std::size_t mesh = 0;
    std::size_t primitive = 0;
    int accessor = -1;
};

std::vector<LooseIndices> take_loose_indices(JsonValue& json) {
    std::vector<LooseIndices> taken;
    const std::span<JsonValue> meshes = items_of(json, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        const std::span<JsonValue> primitives = items_of(meshes[m], "primitives");
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const JsonValue* const indices = primitives[p].find("indices");
            const auto accessor = static_cast<int>(indices != nullptr ? indices->number : -1);
            if (accessor >= 0
                && json["accessors"].items[static_cast<std::size_t>(accessor)].find("bufferView")
                       == nullptr) {
                taken.push_back({m, p, accessor});
                (void)take_member(primitives[p], "indices");
            }
        }
    }
    return taken;
}

const std::vector<std::byte>* find_buffer(const std::string& path, void* buffers) {
    const auto& all = *static_cast<const BufferBytes*>(buffers);
    std::size_t number = all.size();
    const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), number);
    const bool is_number = error == std::errc() && end == path.data() + path.size();
    return is_number && number < all.size() ? &all[number] : nullptr;
}

/// Callbacks that provide the buffers and no files.
tinygltf::FsCallbacks make_callbacks(BufferBytes& buffers) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.user_data = &buffers;
    callbacks.FileExists = [](const std::string& path, void* all) {
        return find_buffer(path, all) != nullptr;
    };
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* target, std::string*,
                                 const std::string& path, void* all) {
        const std::vector<std::byte>& bytes = *find_buffer(path, all);
        target->resize(std::max<std::size_t>(bytes.size(), 1));  // one byte: none are an error
        if (!bytes.empty()) {
            std::memcpy(target->data(), bytes.data(), bytes.size());
        }
        return true;
    };
    callbacks.WriteWholeFile = [](std::string*, const std::string&,
                                  const std::vector<unsigned char>&, void*) { return false; };
    return callbacks;
}

std::string last_line(std::string text) {
    text.erase(text.find_last_not_of("\n. ") + 1);
    return text.substr(text.find_last_of('\n') + 1);
}

Status load_model(GltfDocument& document, BufferBytes buffers) {
    const std::vector<LooseIndices> loose = take_loose_indices(document.json);
    const std::string text = write_json(document.json);
    tinygltf::TinyGLTF loader;
    loader.SetFsCallbacks(make_callbacks(buffers));
    loader.SetImageLoader(
        [](tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
           int, void*) { return true; },
        nullptr);
    std::string error;
    std::string warning;
    bool is_loaded = false;
    try {
        is_loaded = loader.LoadASCIIFromString(
            &document.model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!is_loaded) {
        return fail("{}: {}", document.file, last_line(error));
    }
    for (const LooseIndices& indices : loose) {
        document.model.meshes[indices.mesh].primitives[indices.primitive].indices =
            indices.accessor;
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        if (buffers[i].empty()) {
            document.model.buffers[i].data.clear();
        }
    }
    return Done{};
}

/// Marks the views that exceed their buffers.
void check_views(GltfDocument& document) {
    const std::vector<tinygltf::BufferView>& views = document.model.bufferViews;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (find_bad_part(document, "bufferViews", i) != nullptr) {
            continue;
        }
        const tinygltf::BufferView& view = views[i];
        const std::size_t size = item_at(document.model.buffers, view.buffer).data.size();
        const bool is_read = document.decoded_views[i].empty();
        if (is_read && size > 0
            && (view.byteOffset > size || view.byteLength > size - view.byteOffset)) {
            const std::string part = fmt::format("bufferViews[{}]", i);
            const std::string reason = fmt::format(
                "{}: found {} bytes from byte {}, expected to stay within the {} of buffers[{}]",
                part, view.byteLength, view.byteOffset, size, view.buffer);
            document.bad_parts.emplace(part, reason);
            warn_of_loss(
                document, {fmt::format("{}: {}", document.file, reason)}, "it is left out");
        }
    }
}

/// Sizes in a GLB have 32 bits.
Status check_glb_size(std::size_t size, const std::string& name) {
    constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();
    if (size > kMaxBytes) {
        return fail("{}: found {} bytes, expected at most {}", name, size, kMaxBytes);
    }
    return Done{};
}

}  // namespace

Result<GltfChunks> split_gltf(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.empty()) {
        return fail("{}: found an empty file, expected glTF", file);
    }
    if (bytes.size() >= 4 && little_endian(bytes, 0) == kGlbMagic) {
        return split_glb(bytes, file);
    }
    GltfChunks chunks;
    chunks.json = as_text(bytes);
    return chunks;
}

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
    LIMN_TRY(check_gltf_schema(document));
    LIMN_TRY(check_version(document.json, file));
    if (chunks.trailing > 0) {
        document.warnings.push_back(
            fmt::format("{}: {} bytes after the GLB are ignored", file, chunks.trailing));
    }
    LIMN_TRY(check_gltf_extensions(document.json, file, document.warnings));
    warn_of_empty_accessors(document);
    take_images(document);
    add_missing_targets(document.json);
    BufferBytes buffers = LIMN_TRY(take_buffers(document, chunks));
    LIMN_TRY(load_model(document, std::move(buffers)));
    LIMN_TRY(decode_meshopt_views(document));
    check_views(document);
    return document;
}

int append_view(tinygltf::Model& model, std::span<const std::byte> bytes) {
    model.buffers.resize(std::max<std::size_t>(model.buffers.size(), 1));
    std::vector<unsigned char>& all = model.buffers[0].data;
    tinygltf::BufferView& view = model.bufferViews.emplace_back();
    view.buffer = 0;
    view.byteOffset = all.size();
    view.byteLength = bytes.size();
    all.resize(all.size() + (bytes.size() + 3) / 4 * 4);
    std::ranges::copy(
        bytes, std::as_writable_bytes(std::span(all)).subspan(view.byteOffset).begin());
    return static_cast<int>(model.bufferViews.size()) - 1;
}

int append_accessor(
    tinygltf::Model& model, int type, int component, std::size_t count,
    std::span<const std::byte> values) {
    const int view = values.empty() ? -1 : append_view(model, values);
    tinygltf::Accessor& accessor = model.accessors.emplace_back();
    accessor.bufferView = view;
    accessor.type = type;
    accessor.componentType = component;
    accessor.count = count;
    return static_cast<int>(model.accessors.size()) - 1;
}

int append_times(tinygltf::Model& model, std::span<const float> times) {
    const int added = append_accessor(
        model, TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_FLOAT, times.size(),
        std::as_bytes(times));
    model.accessors.back().minValues = {times.front()};
    model.accessors.back().maxValues = {times.back()};
    return added;
}

void append_channel(
    tinygltf::Animation& animation, int node, const char* path, int times, int values) {
    tinygltf::AnimationChannel& channel = animation.channels.emplace_back();
    channel.target_node = node;
    channel.target_path = path;
    channel.sampler = static_cast<int>(animation.samplers.size());
    tinygltf::AnimationSampler& sampler = animation.samplers.emplace_back();
    sampler.input = times;
    sampler.output = values;
}

Result<std::vector<std::byte>>
pack_json(const JsonValue& json, std::span<const std::byte> binary, const std::string& name) {
    std::string text = write_json(json);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::size_t size = 20 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
    LIMN_TRY(check_glb_size(size, name));
    std::vector<std::byte> glb;
    const auto append = [&glb](std::span<const std::byte> bytes) {
        glb.insert(glb.end(), bytes.begin(), bytes.end());
    };
    const auto append_words = [&](std::initializer_list<std::size_t> words) {
        for (const std::size_t word : words) {
            const auto small = static_cast<std::uint32_t>(word);
            append(std::as_bytes(std::span(&small, 1)));
        }
    };
    append_words({kGlbMagic, 2, size, text.size(), kJsonChunk});
    append(std::as_bytes(std::span(text)));
    if (!binary.empty()) {
        append_words({binary.size(), kBinChunk});
        append(binary);
    }
    return glb;
}

Result<std::vector<std::byte>> pack_model(const tinygltf::Model& model, const std::string& name) {
    std::ostringstream stream;
    tinygltf::TinyGLTF writer;
    writer.SetImageWriter(nullptr, nullptr);
    try {
        if (!writer.WriteGltfSceneToStream(&model, stream, false, true)) {
            return fail("{}: cannot be written as glTF", name);
        }
    } catch (const std::exception& exception) {  // strings that are not UTF-8
        return fail("{}: cannot be written as glTF: {}", name, exception.what());
    }
    const std::string_view text = stream.view();
    LIMN_TRY(check_glb_size(text.size(), name));  // tinygltf does not check
    const auto bytes = std::as_bytes(std::span(text));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

}  // namespace limn
