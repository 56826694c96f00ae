#include "content/load/files/exr_file.h"

#include "content/load/files/atomic_file.h"
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

// Techniques: hdr.float-formats, hdr.openexr

namespace limn {

namespace {

constexpr float kLargestHalf = 65504.0f;

/// Limits what OpenEXR allocates for a header, before our own limits are checked.
constexpr int kLibraryMaxSize = 65536;

class MemoryReader : public Imf::IStream {
  public:
    MemoryReader(std::span<const std::byte> bytes, const std::string& location)
        : IStream(location.c_str()), bytes_(bytes) {}
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
Status check_kind(std::span<const std::byte> bytes, const std::string& location) {
    constexpr unsigned char kMagic[4] = {0x76, 0x2f, 0x31, 0x01};
    if (bytes.size() < 8 || std::memcmp(bytes.data(), kMagic, 4) != 0) {
        return fail(
            "{}: found {} bytes without the OpenEXR signature, expected 76 2f 31 01", location,
            bytes.size());
    }
    const auto version = std::to_integer<unsigned>(bytes[4]);
    const auto flags = std::to_integer<unsigned>(bytes[5]);
    if (version != 2) {
        return fail("{}: found OpenEXR version {}, expected 2", location, version);
    }
    constexpr std::pair<unsigned, const char*> kUnsupported[] = {
        {0x10, "multi-part"}, {0x08, "deep"}, {0x02, "tiled"}};
    for (const auto& [flag, name] : kUnsupported) {
        if ((flags & flag) != 0) {
            return fail(
                "{}: found a {} OpenEXR file, which is unsupported, expected scan lines", location,
                name);
        }
    }
    return Done{};
}

Status
check_header(const Imf::Header& header, const std::string& location, const ExrLimits& limits) {
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
    const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > limits.max_size || height > limits.max_size) {
        return fail(
            "{}: dataWindow: found {} x {} pixels, expected 1 to {} along a side", location, width,
            height, limits.max_size);
    }
    const Imath::Box2i& display = header.displayWindow();
    const std::int64_t shown_width = std::int64_t{display.max.x} - display.min.x + 1;
    const std::int64_t shown_height = std::int64_t{display.max.y} - display.min.y + 1;
    if (shown_width < 1 || shown_height < 1 || shown_width > limits.max_size
        || shown_height > limits.max_size || 4 * shown_width * shown_height > limits.max_values) {
        return fail(
            "{}: displayWindow: found {} x {} pixels, expected 1 to {} along a side and {} in all",
            location, shown_width, shown_height, limits.max_size, limits.max_values / 4);
    }
    std::int64_t channels = 0;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        ++channels;
        if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
            return fail(
                "{}: channel {}: found subsampling, which is unsupported", location, it.name());
        }
    }
    if (channels < 1 || channels > limits.max_channels) {
        return fail(
            "{}: found {} channels, expected 1 to {}", location, channels, limits.max_channels);
    }
    if (width * height * channels > limits.max_values) {
        return fail(
            "{}: found {} x {} x {} values, expected at most {}", location, width, height, channels,
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

ExrWindow exr_window_of(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

Imath::Box2i exr_box_of(const ExrWindow& window) {
    return {{window.x, window.y}, {window.x + window.width - 1, window.y + window.height - 1}};
}

/// The display window, or the data window if that is empty.
ExrWindow exr_display_of(const ExrImage& image) {
    return image.display.width > 0 ? image.display
                                   : ExrWindow{image.x, image.y, image.width, image.height};
}

Result<ExrImage>
decode(std::span<const std::byte> bytes, const std::string& location, const ExrLimits& limits) {
    LIMN_TRY(check_kind(bytes, location));
    Imf::Header::setMaxImageSize(kLibraryMaxSize, kLibraryMaxSize);
    MemoryReader reader(bytes, location);
    Imf::InputFile file(reader);
    const Imf::Header& header = file.header();
    LIMN_TRY(check_header(header, location, limits));
    const Imath::Box2i& window = header.dataWindow();

    ExrImage image;
    image.x = window.min.x;
    image.y = window.min.y;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    image.display = exr_window_of(header.displayWindow());
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
    const Imath::Box2i window = exr_box_of({image.x, image.y, image.width, image.height});
    Imf::Header header(exr_box_of(exr_display_of(image)), window);
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
decode_exr(std::span<const std::byte> bytes, const std::string& location, const ExrLimits& limits) {
    try {
        return decode(bytes, location, limits);
    } catch (const std::exception& exception) {
        return fail("{}: corrupt OpenEXR file: {}", location, exr_line(exception.what()));
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

namespace {

/// "diffuse" and "R" of "diffuse.R"; "" and "R" of "R".
std::pair<std::string_view, std::string_view> split_exr_layer(std::string_view name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::pair(std::string_view(), name)
                                         : std::pair(name.substr(0, dot), name.substr(dot + 1));
}

int exr_channel_index(const ExrImage& image, std::string_view layer, char letter) {
    for (std::size_t i = 0; i < image.channels.size(); ++i) {
        const auto [its_layer, its_letter] = split_exr_layer(image.channels[i].name);
        if (its_layer == layer && its_letter.size() == 1 && its_letter[0] == letter) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

/// Chooses three channels of a layer, if it has all of them.
bool show_exr_layer(
    const ExrImage& image, std::string_view layer, std::string_view letters, ExrShown& shown) {
    for (std::size_t k = 0; k < 3; ++k) {
        shown.channels[k] = exr_channel_index(image, layer, letters[k]);
        if (shown.channels[k] < 0) {
            return false;
        }
    }
    shown.channels[3] = exr_channel_index(image, layer, 'A');
    shown.layer = layer;
    return true;
}

/// The layers in the order of their first channels; "" for channels without a layer.
std::vector<std::string_view> exr_layers_of(const ExrImage& image) {
    std::vector<std::string_view> layers;
    for (const ExrChannel& channel : image.channels) {
        const std::string_view layer = split_exr_layer(channel.name).first;
        if (std::find(layers.begin(), layers.end(), layer) == layers.end()) {
            layers.push_back(layer);
        }
    }
    return layers;
}

}  // namespace

ExrShown find_shown(const ExrImage& image) {
    ExrShown shown;
    const std::vector<std::string_view> layers = exr_layers_of(image);
    const auto show_color = [&] {
        if (show_exr_layer(image, "", "RGB", shown) || show_exr_layer(image, "", "YYY", shown)) {
            return true;
        }
        for (const char* const letters : {"RGB", "rgb", "XYZ"}) {
            for (const std::string_view layer : layers) {
                if (show_exr_layer(image, layer, letters, shown)) {
                    return true;
                }
            }
        }
        return false;
    };
    if (show_color()) {
        for (const std::string_view layer : layers) {
            if (!shown.layer.empty() && layer != shown.layer) {
                shown.others.emplace_back(layer.empty() ? "(without a layer)" : layer);
            }
        }
        return shown;
    }
    const int alpha = exr_channel_index(image, "", 'A');
    const int gray = alpha == 0 && image.channels.size() > 1 ? 1 : 0;
    shown = {.channels = {gray, gray, gray, alpha}, .layer = {}, .others = {}};
    for (int i = 0; i < static_cast<int>(image.channels.size()); ++i) {
        const std::string& name = image.channels[static_cast<std::size_t>(i)].name;
        if (i == gray) {
            shown.layer = name;
        } else if (i != alpha) {
            shown.others.push_back(name);
        }
    }
    return shown;
}

std::string describe_shown(const ExrImage& image) {
    const ExrShown shown = find_shown(image);
    if (shown.others.empty()) {
        return "";
    }
    constexpr std::size_t kMaxNames = 12;
    std::string others;
    for (std::size_t i = 0; i < std::min(shown.others.size(), kMaxNames); ++i) {
        others += format_text("{}{}", i > 0 ? ", " : "", shown.others[i]);
    }
    if (shown.others.size() > kMaxNames) {
        others += format_text(" and {} more", shown.others.size() - kMaxNames);
    }
    return format_text(
        "found no channels R, G and B; of its layers, {} is shown, and not {}", shown.layer,
        others);
}

ImageData to_image_data(const ExrImage& image, const std::string& name) {
    const ExrShown shown = find_shown(image);
    const ExrChannel* sources[4] = {};
    bool all_half = true;
    for (std::size_t k = 0; k < 4; ++k) {
        if (shown.channels[k] >= 0) {
            sources[k] = &image.channels[static_cast<std::size_t>(shown.channels[k])];
            all_half = all_half && sources[k]->half;
        }
    }
    const ExrWindow display = exr_display_of(image);
    ImageData result;
    result.name = name;
    result.width = display.width;
    result.height = display.height;
    result.format = all_half ? PixelFormat::Rgba16F : PixelFormat::Rgba32F;
    const std::size_t bytes = all_half ? 2 : 4;
    const std::size_t count =
        static_cast<std::size_t>(display.width) * static_cast<std::size_t>(display.height);
    result.pixels.resize(count * 4 * bytes);
    std::uint8_t* to = result.pixels.data();
    for (int y = 0; y < display.height; ++y) {
        // Both windows have at most 2^31 pixels per side, but arbitrary positions.
        const std::int64_t from_y = std::int64_t{y} + display.y - image.y;
        for (int x = 0; x < display.width; ++x) {
            const std::int64_t from_x = std::int64_t{x} + display.x - image.x;
            const bool has_pixel =
                from_x >= 0 && from_y >= 0 && from_x < image.width && from_y < image.height;
            const auto i = static_cast<std::size_t>(from_y * image.width + from_x);
            for (std::size_t k = 0; k < 4; ++k, to += bytes) {
                const float missing = k == 3 && sources[3] == nullptr ? 1.0f : 0.0f;
                const float value =
                    has_pixel && sources[k] != nullptr ? sources[k]->values[i] : missing;
                if (all_half) {
                    const std::uint16_t bits = half(value).bits();
                    std::memcpy(to, &bits, bytes);
                } else {
                    std::memcpy(to, &value, bytes);
                }
            }
        }
    }
    return result;
}

}  // namespace limn
