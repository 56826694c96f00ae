#pragma once

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <png.h>
#include <string>
#include <vector>

namespace limn::test {

/// An image as libpng and OpenEXR read it: not our own code.
struct Picture {
    bool whole = false;
    int width = 0;
    int height = 0;
    std::vector<std::string> channels = {};
    std::vector<float> values = {};

    [[nodiscard]] int channel(const std::string& name) const {
        const auto found = std::find(channels.begin(), channels.end(), name);
        return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
    }
};

/// 8 bits a channel, rows from top to bottom.
struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> bytes;  ///< RGB; empty where the file is no whole PNG

    bool operator==(const Pixels&) const = default;
};

inline Pixels read_png(const std::string& path) {
    png_image image = {};
    image.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_file(&image, path.c_str()) == 0) {
        return {};
    }
    image.format = PNG_FORMAT_RGBA;
    Pixels pixels{static_cast<int>(image.width), static_cast<int>(image.height), {}};
    std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(image));
    if (png_image_finish_read(&image, nullptr, rgba.data(), 0, nullptr) == 0) {
        return {};
    }
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        pixels.bytes.insert(pixels.bytes.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    }
    return pixels;
}

inline Picture read_exr(const std::string& path) {
    Picture picture;
    try {
        Imf::InputFile file(path.c_str());
        const Imath::Box2i window = file.header().dataWindow();
        picture.width = window.max.x - window.min.x + 1;
        picture.height = window.max.y - window.min.y + 1;
        const Imf::ChannelList& list = file.header().channels();
        for (auto channel = list.begin(); channel != list.end(); ++channel) {
            picture.channels.emplace_back(channel.name());
        }
        const std::size_t count = picture.channels.size();
        const std::size_t row = count * static_cast<std::size_t>(picture.width);
        picture.values.resize(row * static_cast<std::size_t>(picture.height));
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < count; ++c) {
            buffer.insert(
                picture.channels[c], Imf::Slice::Make(
                                         Imf::FLOAT, picture.values.data() + c, window,
                                         count * sizeof(float), row * sizeof(float)));
        }
        file.setFrameBuffer(buffer);
        file.readPixels(window.min.y, window.max.y);
        picture.whole = true;
    } catch (const std::exception&) {
        picture.whole = false;
    }
    return picture;
}

inline Picture read_image(const std::string& path) {
    if (path.ends_with(".exr")) {
        return read_exr(path);
    }
    const Pixels pixels = read_png(path);
    Picture picture{
        .whole = !pixels.bytes.empty(),
        .width = pixels.width,
        .height = pixels.height,
        .channels = {"R", "G", "B"}};
    for (const std::uint8_t byte : pixels.bytes) {
        picture.values.push_back(static_cast<float>(byte) / 255.0f);
    }
    return picture;
}

}  // namespace limn::test
