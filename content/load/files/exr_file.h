#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

struct ImageData;

// OpenEXR images with any number of named channels (hdr.openexr): linear color and AOVs. A layer is
// a channel prefix: "normal.X", "normal.Y", "normal.Z"; the color is R, G, B and A without one.
// The display window is the image; the data window is the area with pixels. The rest of the image
// is black, and pixels outside the display window are not shown. Values are floats in memory
// whatever the file holds: half to float and back is lossless (hdr.float-formats); a 32 bit integer
// rounds to a float.
//
// Scan-line files of one part; tiled, deep, multi-part and subsampled (luminance/chroma) files are
// errors that say so.

enum class ExrCompression : std::uint8_t { None, Rle, Zips, Zip, Piz };

struct ExrChannel {
    std::string name;           ///< "R", "depth.Z" ...
    bool half = false;          ///< stored with 16 bits in the file, else 32
    std::vector<float> values;  ///< width * height, rows from top to bottom
};

/// A rectangle of pixels, y down.
struct ExrWindow {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

struct ExrImage {
    int width = 0;                          ///< of the data window [pixels], > 0
    int height = 0;                         ///< of the data window [pixels], > 0
    int x = 0;                              ///< left edge of the data window [pixels]
    int y = 0;                              ///< top edge of the data window [pixels]
    std::vector<ExrChannel> channels = {};  ///< unique names; the file sorts them by name
    std::vector<std::pair<std::string, std::string>> metadata = {};  ///< text attributes by name
    ExrWindow display = {};  ///< what the image shows; without size: the data window
};

struct ExrLimits {
    int max_size = 16384;                             ///< pixels along either side
    std::int64_t max_values = std::int64_t{1} << 28;  ///< width * height * channels; 1 GiB
    int max_channels = 1024;
};

/// Reads the file `path`. Fails with "path: found X, expected Y".
[[nodiscard]] Result<ExrImage> read_exr(const std::string& path, const ExrLimits& limits = {});

/// Text attributes of a file by name; none if it cannot be read.
[[nodiscard]] std::vector<std::pair<std::string, std::string>>
read_exr_metadata(const std::string& path);

/// The same as read_exr from memory; `location` is the prefix of error messages.
[[nodiscard]] Result<ExrImage> decode_exr(
    std::span<const std::byte> bytes, const std::string& location, const ExrLimits& limits = {});

/// Writes the file atomically. Half channels clamp finite values to +-65504 and keep inf and NaN.
[[nodiscard]] Status write_exr(
    const std::string& path, const ExrImage& image,
    ExrCompression compression = ExrCompression::Zip);

/// Appends the channels "layer.X" ... for the letters of `letters`, from interleaved `values` with
/// one value per letter. An empty `layer` gives plain "R", "G" ...
void add_layer(
    ExrImage& image, std::string_view layer, std::string_view letters,
    std::span<const float> values, bool half);

/// The channel called `name`, or null.
[[nodiscard]] const ExrChannel* find_channel(const ExrImage& image, std::string_view name);

/// Replaces NaN by 0 and infinities by +-65504; returns how many values were replaced.
std::size_t replace_non_finite(std::span<float> values);

/// The channels that are shown as color, by index; -1: none.
struct ExrShown {
    int channels[4] = {-1, -1, -1, -1};
    std::string layer;  ///< "" for the plain ones
    std::vector<std::string>
        others;  ///< other layers with a color, or channels, that are not shown
};

/// R, G and B; else Y; else the first layer with those; else the first with X, Y and Z; else the
/// first channel as gray. A in the same layer.
[[nodiscard]] ExrShown find_shown(const ExrImage& image);

/// One line on which layer is shown if an image has no plain R, G and B, Y or single channel; else
/// "".
[[nodiscard]] std::string describe_shown(const ExrImage& image);

/// The display window of the channels from find_shown as an image for a texture: Rgba16F if all are
/// half, else Rgba32F. A missing alpha is 1.
[[nodiscard]] ImageData to_image_data(const ExrImage& image, const std::string& name);

}  // namespace limn
