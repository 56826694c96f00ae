#include "content/app/picture_file.h"

#include "content/load/exr_file.h"
#include "content/load/image_write.h"
#include "ecs/base/text.h"
#include "render/gpu/readback.h"
#include "render/render_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace limn {
namespace {

/// Where "%0Nd" stands in a path and how many digits it asks for.
struct NumberPlace {
    std::size_t begin = std::string_view::npos;
    std::size_t end = std::string_view::npos;
    int digits = 1;
};

bool ends_with(std::string_view text, std::string_view end) {
    return text.size() > end.size()
           && std::equal(end.rbegin(), end.rend(), text.rbegin(), [](char a, char b) {
                  return std::tolower(static_cast<unsigned char>(b)) == a;
              });
}

/// Nothing for a path without '%'; false in `ok` for anything but one good place.
NumberPlace find_number_place(std::string_view path, bool& ok) {
    NumberPlace place;
    ok = true;
    place.begin = path.find('%');
    if (place.begin == std::string_view::npos) {
        return place;
    }
    std::size_t at = place.begin + 1;
    if (at + 1 < path.size() && path[at] == '0' && path[at + 1] >= '1' && path[at + 1] <= '9') {
        place.digits = path[at + 1] - '0';
        at += 2;
    }
    place.end = at + 1;
    ok = at < path.size() && path[at] == 'd' && path.find('%', place.end) == std::string_view::npos;
    return place;
}

/// The letters that follow a layer's name, one a channel.
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
write_exr_picture(const std::string& path, const FrameOutput& frame, const PictureNotes& notes) {
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

Result<PictureKind> picture_kind(std::string_view path) {
    if (ends_with(path, ".png")) {
        return PictureKind::Png;
    }
    if (ends_with(path, ".exr")) {
        return PictureKind::Exr;
    }
    return fail("found \"{}\", expected a name that ends in .png or .exr", path);
}

Result<bool> has_frame_number(std::string_view path) {
    bool ok = true;
    const NumberPlace place = find_number_place(path, ok);
    if (!ok) {
        return fail("found \"{}\", expected one place for the frame's number such as %04d", path);
    }
    return place.begin != std::string_view::npos;
}

std::string numbered_path(std::string_view path, int frame) {
    bool ok = true;
    const NumberPlace place = find_number_place(path, ok);
    if (!ok || place.begin == std::string_view::npos) {
        return std::string(path);
    }
    return fmt::format(
        "{}{:0{}}{}", path.substr(0, place.begin), frame, place.digits, path.substr(place.end));
}

Status write_picture(const std::string& path, const FrameOutput& frame, const PictureNotes& notes) {
    const Result<PictureKind> kind = picture_kind(path);
    if (!kind) {
        return kind.error();
    }
    if (*kind == PictureKind::Exr) {
        return write_exr_picture(path, frame, notes);
    }
    const gpu::ByteImage image = gpu::read_bytes(*frame.display);
    return write_png(path, image.width, image.height, image.channels, image.pixels);
}

}  // namespace limn
