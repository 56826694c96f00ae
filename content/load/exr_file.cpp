#include "content/load/exr_file.h"

#include "content/load/atomic_file.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <OpenEXR/ImfArray.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace limn {

namespace {

constexpr float kLargestHalf = 65504.0f;

/// Limits what OpenEXR allocates for a header, before our own limits are checked.
constexpr int kLibraryMaxSize = 65536;

class MemoryReader : public Imf::IStream {
  public:
    MemoryReader(std::span<const std::byte> bytes, const std::string& place)
        : IStream(place.c_str()), bytes_(bytes) {}
    bool read(char c[], int n) override {
        if (n < 0 || static_cast<std::uint64_t>(n) > bytes_.size() - position_) {
            throw std::runtime_error("the file is truncated");
        }
        std::memcpy(c, bytes_.data() + position_, static_cast<std::size_t>(n));
        position_ += static_cast<std::size_t>(n);
        return position_ < bytes_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override {
        if (position > bytes_.size()) {
            throw std::runtime_error("the file is truncated");
        }
        position_ = position;
    }
    void clear() override {}

  private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
};

class MemoryWriter : public Imf::OStream {
  public:
    MemoryWriter() : OStream("memory") {}
    void write(const char c[], int n) override {
        const auto count = static_cast<std::size_t>(n);
        bytes.resize(std::max(bytes.size(), position_ + count));
        std::memcpy(bytes.data() + position_, c, count);
        position_ += count;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = position; }

    std::vector<std::byte> bytes;

  private:
    std::size_t position_ = 0;
};

/// Rejects unsupported kinds of files before OpenEXR reads them.
Status check_kind(std::span<const std::byte> bytes, const std::string& place) {
    constexpr unsigned char kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
    if (bytes.size() < 8 || std::memcmp(bytes.data(), kMagic, 4) != 0) {
        return fail(
            "{}: found {} bytes without the OpenEXR signature, expected 76 2f 31 01", place,
            bytes.size());
    }
    const auto version = std::to_integer<unsigned>(bytes[4]);
    const auto flags = std::to_integer<unsigned>(bytes[5]);
    if (version != 2) {
        return fail("{}: found OpenEXR version {}, expected 2", place, version);
    }
    constexpr std::pair<unsigned, const char*> kUnsupported[] = {
        {0x10, "multi-part"}, {0x08, "deep"}, {0x02, "tiled"}};
    for (const auto& [flag, name] : kUnsupported) {
        if ((flags & flag) != 0) {
            return fail(
                "{}: found a {} OpenEXR file, which is unsupported, expected scan lines", place,
                name);
        }
    }
    return Done{};
}

Status check_header(const Imf::Header& header, const std::string& place, const ExrLimits& limits) {
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > limits.max_size || height > limits.max_size) {
        return fail(
            "{}: dataWindow: found {} x {} pixels, expected 1 to {} along a side", place, width,
            height, limits.max_size);
    }
    std::int64_t channels = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        ++channels;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
            return fail(
                "{}: channel {}: found subsampling, which is unsupported", place, it.name());
        }
    }
    if (channels < 1 || channels > limits.max_channels) {
        return fail(
            "{}: found {} channels, expected 1 to {}", place, channels, limits.max_channels);
    }
    if (width * height * channels > limits.max_values) {
        return fail(
            "{}: found {} x {} x {} values, expected at most {}", place, width, height, channels,
            limits.max_values);
    }
    return Done{};
}

std::vector<std::pair<std::string, std::string>> metadata_of(const Imf::Header& header) {
    std::vector<std::pair<std::string, std::string>> metadata;
    for (auto it = header.begin(); it != header.end(); ++it) {
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute())) {
            metadata.emplace_back(it.name(), text->value());
        }
    }
    return metadata;
}

Result<ExrImage>
decode(std::span<const std::byte> bytes, const std::string& place, const ExrLimits& limits) {
    LIMN_TRY(check_kind(bytes, place));
    Imf::Header::setMaxImageSize(kLibraryMaxSize, kLibraryMaxSize);
    MemoryReader reader(bytes, place);
    Imf::InputFile file(reader);
    const Imf::Header& header = file.header();
    LIMN_TRY(check_header(header, place, limits));
    const Imath::Box2i& window = header.dataWindow();

    ExrImage image;
    image.x = window.min.x;
    image.y = window.min.y;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        image.channels.push_back(
            {it.name(), it.channel().type == Imf::HALF, std::vector<float>(count)});
    }
    Imf::FrameBuffer frame;
    for (ExrChannel& channel : image.channels) {
        frame.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
    }
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    image.metadata = metadata_of(header);
    return image;
}

Imf::Compression to_library(ExrCompression compression) {
    switch (compression) {
    case ExrCompression::None:
        return Imf::NO_COMPRESSION;
    case ExrCompression::Rle:
        return Imf::RLE_COMPRESSION;
    case ExrCompression::Zips:
        return Imf::ZIPS_COMPRESSION;
    case ExrCompression::Zip:
        return Imf::ZIP_COMPRESSION;
    case ExrCompression::Piz:
        return Imf::PIZ_COMPRESSION;
    }
    return Imf::ZIP_COMPRESSION;
}

half to_half(float value) {
    const float bounded =
        std::isfinite(value) ? std::clamp(value, -kLargestHalf, kLargestHalf) : value;
    return half(bounded);
}

std::vector<std::byte> encode(const ExrImage& image, ExrCompression compression) {
    const Imath::Box2i window(
        {image.x, image.y}, {image.x + image.width - 1, image.y + image.height - 1});
    Imf::Header header(window, window);
    header.compression() = to_library(compression);
    for (const auto& [name, text] : image.metadata) {
        header.insert(name, Imf::StringAttribute(text));
    }
    std::vector<std::vector<half>> halves;
    halves.reserve(image.channels.size());
    Imf::FrameBuffer frame;
    for (const ExrChannel& channel : image.channels) {
        const Imf::PixelType type = channel.half ? Imf::HALF : Imf::FLOAT;
        header.channels().insert(channel.name, Imf::Channel(type));
        const void* values = channel.values.data();
        if (channel.half) {
            std::vector<half>& rounded = halves.emplace_back(channel.values.size());
            std::transform(channel.values.begin(), channel.values.end(), rounded.begin(), to_half);
            values = rounded.data();
        }
        frame.insert(channel.name, Imf::Slice::Make(type, values, window));
    }
    MemoryWriter writer;
    {
        Imf::OutputFile file(writer, header);
        file.setFrameBuffer(frame);
        file.writePixels(image.height);
    }
    return std::move(writer.bytes);
}

/// The first line of a library's message.
std::string exr_line(std::string message) {
    message.resize(std::min(message.find('\n'), message.size()));
    return message;
}

}  // namespace

Result<ExrImage> read_exr(const std::string& path, const ExrLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    return decode_exr(bytes, path, limits);
}

Result<ExrImage>
decode_exr(std::span<const std::byte> bytes, const std::string& place, const ExrLimits& limits) {
    try {
        return decode(bytes, place, limits);
    } catch (const std::exception& exception) {
        return fail("{}: corrupt OpenEXR file: {}", place, exr_line(exception.what()));
    }
}

std::vector<std::pair<std::string, std::string>> read_exr_metadata(const std::string& path) {
    try {
        return metadata_of(Imf::InputFile(path.c_str()).header());
    } catch (const std::exception&) {
        return {};
    }
}

Status write_exr(const std::string& path, const ExrImage& image, ExrCompression compression) {
    LIMN_CHECK(image.width > 0 && image.height > 0 && !image.channels.empty());
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (const ExrChannel& channel : image.channels) {
        LIMN_CHECK(channel.values.size() == count);
    }
    try {
        return write_file(path, encode(image, compression));
    } catch (const std::exception& exception) {
        return fail("{}: cannot encode OpenEXR: {}", path, exr_line(exception.what()));
    }
}

void add_layer(
    ExrImage& image, std::string_view layer, std::string_view letters,
    std::span<const float> values, bool half) {
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    LIMN_CHECK(values.size() == count * letters.size());
    for (std::size_t k = 0; k < letters.size(); ++k) {
        ExrChannel& channel = image.channels.emplace_back();
        channel.name =
            layer.empty() ? std::string(1, letters[k]) : std::string(layer) + "." + letters[k];
        channel.half = half;
        channel.values.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            channel.values[i] = values[i * letters.size() + k];
        }
    }
}

const ExrChannel* find_channel(const ExrImage& image, std::string_view name) {
    const auto found =
        std::find_if(image.channels.begin(), image.channels.end(), [name](const ExrChannel& c) {
            return c.name == name;
        });
    return found == image.channels.end() ? nullptr : &*found;
}

std::size_t replace_non_finite(std::span<float> values) {
    std::size_t count = 0;
    for (float& value : values) {
        if (!std::isfinite(value)) {
            value = std::isnan(value) ? 0.0f : std::copysign(kLargestHalf, value);
            ++count;
        }
    }
    return count;
}

ImageData to_image_data(const ExrImage& image, const std::string& name) {
    const ExrChannel* gray = find_channel(image, "Y");
    gray = gray != nullptr ? gray : &image.channels.front();
    const ExrChannel* sources[4] = {
        find_channel(image, "R"), find_channel(image, "G"), find_channel(image, "B"),
        find_channel(image, "A")};
    if (sources[0] == nullptr || sources[1] == nullptr || sources[2] == nullptr) {
        sources[0] = sources[1] = sources[2] = gray;
    }
    const bool all_half = std::all_of(
        sources, sources + 4, [](const ExrChannel* c) { return c == nullptr || c->half; });

    ImageData result;
    result.name = name;
    result.width = image.width;
    result.height = image.height;
    result.format = all_half ? PixelFormat::Rgba16F : PixelFormat::Rgba32F;
    const std::size_t count =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    result.pixels.resize(count * (all_half ? 8 : 16));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            const float value = sources[k] != nullptr ? sources[k]->values[i] : 1.0f;
            if (all_half) {
                const std::uint16_t bits = half(value).bits();
                std::memcpy(&result.pixels[(4 * i + k) * 2], &bits, 2);
            } else {
                std::memcpy(&result.pixels[(4 * i + k) * 4], &value, 4);
            }
        }
    }
    return result;
}

}  // namespace limn
