#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace limn {

struct ImageData;
struct ImageLimits;

// The library limn_codecs: images in the formats that OpenImageIO reads. It is loaded when the
// first such image is met (image_load.cpp): OpenImageIO brings more than two hundred libraries,
// whose loading would take most of the time in which `limn --help` answers.

/// Decodes `bytes`, a file in OpenImageIO's `format`, into size, format and pixels of `image`.
/// False, with the reason in `error`, where the file is corrupt or exceeds the limits.
using DecodeImage = bool (*)(
    std::span<const std::byte> bytes, const char* format, const ImageLimits& limits,
    ImageData& image, std::string& error);

inline constexpr const char* kCodecLibrary = "liblimn_codecs.so";  // beside the program
inline constexpr const char* kDecodeImage = "limn_decode_image";   // a DecodeImage

}  // namespace limn
