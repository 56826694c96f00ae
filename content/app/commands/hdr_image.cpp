#include "content/app/commands/hdr_image.h"

#include "content/load/files/image_load.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "render/gpu/device.h"
#include "render/gpu/readback.h"
#include "render/shaders/tone_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

// Techniques: hdr.viewer

namespace limn {
namespace {

/// An image of sRGB codes in linear light.
ImageData decode_srgb(const ImageData& image) {
    std::array<float, 256> linear;
    for (std::size_t code = 0; code < linear.size(); ++code) {
        const double c = static_cast<double>(code) / 255.0;
        linear[code] =
            static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
    }
    ImageData decoded = {
        .name = image.name,
        .width = image.width,
        .height = image.height,
        .format = PixelFormat::Rgba32F,
        .pixels = std::vector<std::uint8_t>(4 * image.pixels.size())};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float value =
            i % 4 == 3 ? static_cast<float>(image.pixels[i]) / 255.0f : linear[image.pixels[i]];
        std::memcpy(&decoded.pixels[4 * i], &value, sizeof(value));
    }
    return decoded;
}

/// The image with OpenGL's bottom row first.
Result<gpu::Texture> upload(const gpu::Device& device, const ImageData& image) {
    const bool half = image.format == PixelFormat::Rgba16F;
    const gpu::TextureDesc desc = {
        .format = static_cast<GLenum>(half ? GL_RGBA16F : GL_RGBA32F),
        .width = image.width,
        .height = image.height};
    if (const Status fits = gpu::check_texture(device.caps(), desc); !fits) {
        return fail("{}: {}", image.name, fits.error().message);
    }
    const std::size_t row = image.pixels.size() / static_cast<std::size_t>(image.height);
    std::vector<std::uint8_t> flipped;
    flipped.reserve(image.pixels.size());
    for (int y = image.height; y-- > 0;) {
        const auto begin = image.pixels.begin() + static_cast<std::ptrdiff_t>(row) * y;
        flipped.insert(flipped.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
    }
    gpu::Texture texture("hdr image", desc);
    texture.upload(std::as_bytes(std::span(flipped)));
    return texture;
}

std::string range_text(double least, double largest) {
    const double ratio = range_ratio(least, largest);
    return fmt::format("{:.3g}:1 ({:.1f} stops)", ratio, std::log2(ratio));
}

}  // namespace

HdrImage::HdrImage(
    gpu::Device& device, ToneMapper tone_mapper, gpu::Texture radiance, std::string path)
    : graph_(device), tone_mapper_(std::move(tone_mapper)), radiance_(std::move(radiance)),
      path_(std::move(path)) {
    measure();
}

Result<std::unique_ptr<HdrImage>> HdrImage::load(gpu::Device& device, const std::string& path) {
    Result<ImageData> image = load_image(path, false);
    if (!image) {
        return image.error();
    }
    if (image->format == PixelFormat::Rgba8) {
        *image = decode_srgb(*image);
    }
    image->name = path;
    Result<gpu::Texture> radiance = upload(device, *image);
    if (!radiance) {
        return radiance.error();
    }
    Result<ToneMapper> tone_mapper = create_tone_mapper(device);
    if (!tone_mapper) {
        return tone_mapper.error();
    }
    return std::unique_ptr<HdrImage>(
        new HdrImage(device, *std::move(tone_mapper), *std::move(radiance), path));
}

void HdrImage::measure() {
    graph_.begin_frame();
    static_cast<void>(measure_image(
        graph_, tone_mapper_.statistics, graph_.import("radiance", radiance_),
        {.histogram = true}));
    graph_.execute();
    const auto measure = tone_mapper_.statistics.measure.read_value<layout::ImageStatistics>(0);
    statistics_ = {
        .pixels = measure.pixels.x,
        .not_finite = measure.pixels.y,
        .log_average = measure.luminance.x,
        .mean = Vec3(measure.mean_scale),
        .least = measure.luminance.z,
        .largest = measure.luminance.w,
        .clipped_min_luminance = measure.clipped.x,
        .clipped_max_luminance = measure.clipped.y};
}

const gpu::Texture& HdrImage::show(const Exposure& exposure) {
    graph_.begin_frame();
    const TextureId display = apply_tone_mapper(
        graph_, tone_mapper_, exposure, std::nullopt, graph_.import("radiance", radiance_));
    graph_.keep(display);
    graph_.execute();
    return *graph_.texture(display);
}

double range_ratio(double least, double largest) {
    return least > 0.0 ? largest / least : 1.0;
}

double clipped_fraction(const gpu::Texture& display) {
    const gpu::ByteImage image = gpu::read_bytes(display);
    const std::int64_t pixels = std::int64_t{image.width} * image.height;
    std::int64_t clipped = 0;
    for (std::int64_t i = 0; i < pixels; ++i) {
        const auto rgb = image.pixels.begin() + i * image.channels;
        clipped += *std::max_element(rgb, rgb + 3) == 255 ? 1 : 0;
    }
    return static_cast<double>(clipped) / static_cast<double>(pixels);
}

std::string describe(const HdrImage& image) {
    const HdrStatistics& s = image.statistics();
    std::string text = fmt::format(
        "{}\n{} x {} pixels\nlog-average {:.4g}, mean color {:.4g} {:.4g} {:.4g}\n"
        "luminance {:.4g} .. {:.4g}, dynamic range {}\nwithout the darkest and brightest 0.1 % "
        "{}\n",
        image.path(), image.width(), image.height(), s.log_average, s.mean.x, s.mean.y, s.mean.z,
        s.least, s.largest, range_text(s.least, s.largest),
        range_text(s.clipped_min_luminance, s.clipped_max_luminance));
    if (s.not_finite > 0) {
        text += fmt::format(
            "{} of {} pixels hold NaN or infinity: excluded from the statistics, shown black or "
            "white\n",
            s.not_finite, s.pixels + s.not_finite);
    }
    return text;
}

}  // namespace limn
