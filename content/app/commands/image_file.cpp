#include "content/app/commands/image_file.h"

#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "ecs/base/text.h"
#include "render/gpu/readback.h"
#include "render/render_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace limn {
namespace {

/// Position of "%0Nd" in a path, and its digit count.
struct Placeholder {
    std::size_t begin = std::string_view::npos;
    std::size_t end = std::string_view::npos;
    int digits = 1;
};

/// Not found (`begin` is npos) for a path without '%'; `ok` is false for anything but one valid
/// placeholder.
Placeholder find_placeholder(std::string_view path, bool& ok) {
    Placeholder placeholder;
    ok = true;
    placeholder.begin = path.find('%');
    if (placeholder.begin == std::string_view::npos) {
        return placeholder;
    }
    std::size_t at = placeholder.begin + 1;
    if (at + 1 < path.size() && path[at] == '0' && path[at + 1] >= '1' && path[at + 1] <= '9') {
        placeholder.digits = path[at + 1] - '0';
        at += 2;
    }
    placeholder.end = at + 1;
    ok = at < path.size() && path[at] == 'd'
         && path.find('%', placeholder.end) == std::string_view::npos;
    return placeholder;
}

/// The channel letters that follow a layer's name.
std::string_view layer_letters(std::string_view aov) {
    if (aov == "depth") {
        return "Z";
    }
    if (aov == "normal") {
        return "XYZ";
    }
    if (aov == "shadow_texels" || aov == "volume_layers") {
        return "Y";
    }
    return aov == "velocity" ? "XY" : "RGB";
}

/// The first `channels` of every pixel.
std::vector<float> first_channels(const gpu::FloatImage& image, int channels) {
    const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
    std::vector<float> values(pixels * channels);
    for (std::size_t i = 0; i < pixels; ++i) {
        for (int c = 0; c < channels; ++c) {
            values[i * channels + c] = image.pixels[i * image.channels + c];
        }
    }
    return values;
}

Status
write_exr_file(const std::string& path, const FrameOutput& frame, const ImageAttributes& notes) {
    const gpu::FloatImage radiance = gpu::read_floats(*frame.radiance);
    ExrImage exr;
    exr.width = radiance.width;
    exr.height = radiance.height;
    exr.metadata = notes;
    add_layer(
        exr, "", std::string_view("RGBA").substr(0, static_cast<std::size_t>(radiance.channels)),
        radiance.pixels, false);
    for (const AovOutput& aov : frame.aovs) {
        const gpu::FloatImage image = gpu::read_floats(*aov.texture);
        const std::string_view letters = layer_letters(aov.name);
        const int channels = std::min(static_cast<int>(letters.size()), image.channels);
        add_layer(exr, aov.name, letters, first_channels(image, channels), false);
    }
    return write_exr(path, exr);
}

}  // namespace

bool has_extension(std::string_view path, std::string_view extension) {
    return path.size() > extension.size()
           && std::equal(extension.rbegin(), extension.rend(), path.rbegin(), [](char a, char b) {
                  return std::tolower(static_cast<unsigned char>(b)) == a;
              });
}

Result<ImageFileKind> image_file_kind(std::string_view path) {
    if (has_extension(path, ".png")) {
        return ImageFileKind::Png;
    }
    if (has_extension(path, ".exr")) {
        return ImageFileKind::Exr;
    }
    return fail("found \"{}\", expected a name that ends in .png or .exr", path);
}

Result<bool> has_frame_number(std::string_view path) {
    bool ok = true;
    const Placeholder placeholder = find_placeholder(path, ok);
    if (!ok) {
        return fail(
            "found \"{}\", expected one placeholder for the frame number, such as %04d", path);
    }
    return placeholder.begin != std::string_view::npos;
}

std::string numbered_path(std::string_view path, int frame) {
    bool ok = true;
    const Placeholder placeholder = find_placeholder(path, ok);
    if (!ok || placeholder.begin == std::string_view::npos) {
        return std::string(path);
    }
    return fmt::format(
        "{}{:0{}}{}", path.substr(0, placeholder.begin), frame, placeholder.digits,
        path.substr(placeholder.end));
}

Status
write_image_file(const std::string& path, const FrameOutput& frame, const ImageAttributes& notes) {
    const Result<ImageFileKind> kind = image_file_kind(path);
    if (!kind) {
        return kind.error();
    }
    if (*kind == ImageFileKind::Exr) {
        return write_exr_file(path, frame, notes);
    }
    const gpu::ByteImage image = gpu::read_bytes(*frame.display);
    return write_png(path, image.width, image.height, image.channels, image.pixels);
}

}  // namespace limn
