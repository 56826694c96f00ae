#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace limn::test {

/// An image as OpenImageIO reads it: not our own code.
struct Picture {
    bool whole = false;
    int width = 0;
    int height = 0;
    std::vector<std::string> channels;
    std::vector<float> values;

    [[nodiscard]] int channel(const std::string& name) const {
        const auto found = std::find(channels.begin(), channels.end(), name);
        return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
    }
};

inline Picture read_image(const std::string& path) {
    Picture picture;
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
    if (input == nullptr) {
        return picture;
    }
    const OIIO::ImageSpec& spec = input->spec();
    picture.width = spec.width;
    picture.height = spec.height;
    picture.channels = spec.channelnames;
    picture.values.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
    picture.whole =
        input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.values.data());
    return picture;
}

}  // namespace limn::test
