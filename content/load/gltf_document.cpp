#include "content/load/gltf_document.h"

#include "content/load/gltf_file.h"
#include "content/load/gltf_schema.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>

namespace limn {

namespace {

constexpr std::array kExtensions = {
    std::string_view("KHR_lights_punctual"),   std::string_view("KHR_materials_emissive_strength"),
    std::string_view("KHR_materials_unlit"),   std::string_view("KHR_mesh_quantization"),
    std::string_view("KHR_texture_transform"),
};

Status check_version(const JsonValue& json, const std::string& file) {
    const std::string& version = json.find("asset")->find("version")->text;
    if (!version.starts_with("2.")) {
        return fail("{}: asset.version: found {}, expected 2.x", file, in_quotes(version));
    }
    const JsonValue* required = json.find("extensionsRequired");
    for (std::size_t i = 0; required != nullptr && i < required->items.size(); ++i) {
        const std::string& name = required->items[i].text;
        if (std::find(kExtensions.begin(), kExtensions.end(), name) == kExtensions.end()) {
            return fail(
                "{}: extensionsRequired[{}]: found {}, expected one of {}", file, i,
                in_quotes(name), join_text(kExtensions, ", "));
        }
    }
    return Done{};
}

/// Hands tinygltf what it has to turn into structs, and nothing that it would open, decode or
/// guess.
JsonValue choose_for_tinygltf(const JsonValue& json) {
    constexpr std::string_view kSections[] = {
        "asset", "accessors", "bufferViews", "meshes",   "nodes",   "skins",     "scenes",
        "scene", "materials", "textures",    "samplers", "cameras", "extensions"};
    std::vector<JsonMember> members;
    for (const JsonMember& member : json.members) {
        if (std::find(std::begin(kSections), std::end(kSections), member.key)
            != std::end(kSections)) {
            members.push_back(member);
        }
    }
    return json_object(std::move(members));
}

bool refuse_image(
    tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return false;
}

Status fill_model(tinygltf::Model& model, const JsonValue& json, const std::string& file) {
    const std::string text = write_json(choose_for_tinygltf(json));
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(refuse_image, nullptr);
    parser.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
    std::string error;
    std::string warning;
    bool ok = false;
    try {
        ok = parser.LoadASCIIFromString(
            &model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "");
    } catch (const std::exception& exception) {
        error = exception.what();
    }
    if (!ok) {
        error.resize(std::min(error.find('\n'), error.size()));
        return fail("{}: {}", file, error.empty() ? "tinygltf cannot read it" : error);
    }
    return Done{};
}

Status load_buffers(GltfDocument& document, const GltfChunks& chunks) {
    const JsonValue* buffers = document.json.find("buffers");
    std::uint64_t total = 0;
    for (std::size_t i = 0; buffers != nullptr && i < buffers->items.size(); ++i) {
        const std::string place = fmt::format("{}: buffers[{}]", document.file, i);
        const JsonValue& buffer = buffers->items[i];
        const auto length = static_cast<std::uint64_t>(buffer.find("byteLength")->number);
        std::vector<std::byte> bytes;
        if (const JsonValue* uri = buffer.find("uri"); uri != nullptr) {
            Result<std::vector<std::byte>> fetched =
                fetch_uri(uri->text, document.folder, place + ".uri", document.limits.max_bytes);
            if (!fetched) {
                return fetched.error();
            }
            bytes = std::move(*fetched);
        } else if (i == 0 && chunks.has_binary) {
            bytes.assign(chunks.binary.begin(), chunks.binary.end());
        } else {
            return fail(
                "{}.uri: found nothing, expected a URI or the binary chunk of a GLB", place);
        }
        if (length > bytes.size()) {
            return fail(
                "{}.byteLength: found {}, expected at most the {} bytes there are", place, length,
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

Status check_views(const GltfDocument& document) {
    for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
        const tinygltf::BufferView& view = document.model.bufferViews[i];
        const std::uint64_t size = document.buffers[static_cast<std::size_t>(view.buffer)].size();
        if (view.byteOffset > size || view.byteLength > size - view.byteOffset) {
            return fail(
                "{}: bufferViews[{}]: found {} bytes from byte {}, expected to stay within the {} "
                "of buffers[{}]",
                document.file, i, view.byteLength, view.byteOffset, size, view.buffer);
        }
    }
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
    const Result<GltfChunks> chunks = split_gltf(bytes, file);
    if (!chunks) {
        return chunks.error();
    }
    const JsonLimits json_limits{
        .max_bytes = limits.max_bytes, .max_values = limits.max_json_values, .max_depth = 64};
    Result<JsonValue> json = parse_json(chunks->json, file, json_limits);
    if (!json) {
        return json.error();
    }
    GltfDocument document;
    document.file = file;
    document.folder = folder;
    document.limits = limits;
    document.values_left = limits.max_values;
    document.json = std::move(*json);
    if (Status status = check_gltf_schema(document.json, file); !status) {
        return status.error();
    }
    if (Status status = check_version(document.json, file); !status) {
        return status.error();
    }
    if (Status status = fill_model(document.model, document.json, file); !status) {
        return status.error();
    }
    if (Status status = load_buffers(document, *chunks); !status) {
        return status.error();
    }
    if (Status status = check_views(document); !status) {
        return status.error();
    }
    return document;
}

std::span<const std::byte> view_bytes(const GltfDocument& document, std::size_t index) {
    const tinygltf::BufferView& view = document.model.bufferViews[index];
    return std::span(document.buffers[static_cast<std::size_t>(view.buffer)])
        .subspan(view.byteOffset, view.byteLength);
}

const JsonValue&
json_item(const GltfDocument& document, std::string_view array, std::size_t index) {
    return document.json.find(array)->items[index];
}

}  // namespace limn
