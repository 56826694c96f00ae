#include "content/load/gltf/gltf_meshopt.h"

#include "ecs/base/text.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace limn {

namespace {

constexpr std::string_view kMeshopt = "EXT_meshopt_compression";

/// What a buffer view says about its stream; the schema has checked types and ranges.
struct MeshoptView {
    std::span<const std::byte> stream;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::string_view mode;    ///< ATTRIBUTES TRIANGLES INDICES
    std::string_view filter;  ///< NONE OCTAHEDRAL QUATERNION EXPONENTIAL
};

std::size_t meshopt_size(const JsonValue& value) {
    return static_cast<std::size_t>(value.number);  // 0 if there is none
}

Result<MeshoptView>
read_meshopt_view(const GltfDocument& document, const JsonValue& source, const std::string& where) {
    MeshoptView view;
    const std::vector<unsigned char>& buffer =
        document.model.buffers[meshopt_size(source["buffer"])].data;
    const std::size_t offset = meshopt_size(source["byteOffset"]);
    const std::size_t length = meshopt_size(source["byteLength"]);
    if (offset > buffer.size() || length > buffer.size() - offset) {
        return fail(
            "{}: found {} bytes from byte {}, expected to stay within the {} of buffers[{}]", where,
            length, offset, buffer.size(), source["buffer"].number);
    }
    view.stream = std::as_bytes(std::span(buffer)).subspan(offset, length);
    view.count = meshopt_size(source["count"]);
    view.stride = meshopt_size(source["byteStride"]);
    view.mode = source["mode"].text;
    const JsonValue* const filter = source.find("filter");
    view.filter = filter != nullptr ? std::string_view(filter->text) : "NONE";
    return view;
}

/// Preconditions of the decoder.
Status check_meshopt_view(const MeshoptView& view, const std::string& where) {
    const bool attributes = view.mode == "ATTRIBUTES";
    const bool stride_fits = attributes              ? view.stride % 4 == 0
                             : view.filter != "NONE" ? false
                                                     : view.stride == 2 || view.stride == 4;
    const bool filter_fits = view.filter == "OCTAHEDRAL"   ? view.stride == 4 || view.stride == 8
                             : view.filter == "QUATERNION" ? view.stride == 8
                                                           : true;
    const bool count_fits = view.mode != "TRIANGLES" || view.count % 3 == 0;
    if (!stride_fits || !filter_fits || !count_fits) {
        return fail(
            "{}: found {} elements of {} bytes with the filter {}, expected what the mode {} has",
            where, view.count, view.stride, view.filter, view.mode);
    }
    return Done{};
}

/// False when the stream is broken.
bool decode_meshopt_stream(const MeshoptView& view, std::vector<std::byte>& target) {
    using Decode = int(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
    Decode* decode = meshopt_decodeIndexSequence;
    if (view.mode != "INDICES") {
        decode = view.mode == "TRIANGLES" ? static_cast<Decode*>(meshopt_decodeIndexBuffer)
                                          : static_cast<Decode*>(meshopt_decodeVertexBuffer);
    }
    const auto* const stream = reinterpret_cast<const unsigned char*>(view.stream.data());
    if (decode(target.data(), view.count, view.stride, stream, view.stream.size()) != 0) {
        return false;
    }
    if (view.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(target.data(), view.count, view.stride);
    } else if (view.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(target.data(), view.count, view.stride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(target.data(), view.count, view.stride);
    }
    return true;
}

}  // namespace

Status decode_meshopt_views(GltfDocument& document) {
    const std::vector<JsonValue>& views = document.json["bufferViews"].items;
    document.decoded_views.resize(views.size());
    std::size_t total = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        const JsonValue* const source = views[i]["extensions"].find(kMeshopt);
        if (source == nullptr) {
            continue;
        }
        const std::string where =
            fmt::format("{}: bufferViews[{}].extensions.{}", document.file, i, kMeshopt);
        const MeshoptView view = LIMN_TRY(read_meshopt_view(document, *source, where));
        LIMN_TRY(check_meshopt_view(view, where));
        total += view.count * view.stride;  // at most 2^32 times 256
        if (total > document.limits.max_bytes) {
            return fail(
                "{}: found {} bytes in buffer views, expected at most {}", where, total,
                document.limits.max_bytes);
        }
        std::vector<std::byte>& decoded = document.decoded_views[i];
        decoded.resize(view.count * view.stride);
        if (!decode_meshopt_stream(view, decoded)) {
            return fail(
                "{}: found a broken stream of {} bytes, expected {} elements of {} bytes", where,
                view.stream.size(), view.count, view.stride);
        }
    }
    return Done{};
}

}  // namespace limn
