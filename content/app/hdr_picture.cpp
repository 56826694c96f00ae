#include "content/app/hdr_picture.h"

#include "content/load/image_load.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "render/gpu/device.h"
#include "render/gpu/readback.h"
#include "render/shaders/tone_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace limn {
namespace {

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
    gpu::Texture texture("hdr picture", desc);
    texture.upload(std::as_bytes(std::span(flipped)));
    return texture;
}

std::string range_text(double least, double largest) {
    const double ratio = range_ratio(least, largest);
    return fmt::format("{:.3g}:1 ({:.1f} stops)", ratio, std::log2(ratio));
}

}  // namespace

HdrPicture::HdrPicture(
    gpu::Device& device, Developer developer, gpu::Texture radiance, std::string path)
    : graph_(device), developer_(std::move(developer)), radiance_(std::move(radiance)),
      path_(std::move(path)) {
    measure();
}

Result<std::unique_ptr<HdrPicture>> HdrPicture::load(gpu::Device& device, const std::string& path) {
    Result<ImageData> image = load_image(path, false);
    if (!image) {
        return image.error();
    }
    if (image->format == PixelFormat::Rgba8) {
        return fail(
            "{}: found a picture of whole numbers, expected light in floats (.exr, .hdr)", path);
    }
    image->name = path;
    Result<gpu::Texture> radiance = upload(device, *image);
    if (!radiance) {
        return radiance.error();
    }
    Result<Developer> developer = create_developer(device);
    if (!developer) {
        return developer.error();
    }
    return std::unique_ptr<HdrPicture>(
        new HdrPicture(device, *std::move(developer), *std::move(radiance), path));
}

void HdrPicture::measure() {
    graph_.begin_frame();
    static_cast<void>(measure_picture(
        graph_, developer_.statistics, graph_.import("radiance", radiance_), {.histogram = true}));
    graph_.execute();
    const auto measure = developer_.statistics.measure.read_value<layout::PictureMeasure>(0);
    statistics_ = {
        .pixels = measure.pixels.x,
        .not_finite = measure.pixels.y,
        .log_average = measure.luminance.x,
        .mean = Vec3(measure.mean_scale),
        .least = measure.luminance.z,
        .largest = measure.luminance.w,
        .clipped_least = measure.clipped.x,
        .clipped_largest = measure.clipped.y};
}

const gpu::Texture& HdrPicture::show(const Exposure& exposure) {
    graph_.begin_frame();
    const TextureId display =
        develop(graph_, developer_, exposure, std::nullopt, graph_.import("radiance", radiance_));
    graph_.keep(display);
    graph_.execute();
    return *graph_.texture(display);
}

double range_ratio(double least, double largest) {
    return least > 0.0 ? largest / least : 1.0;
}

double clipped_share(const gpu::Texture& display) {
    const gpu::ByteImage image = gpu::read_bytes(display);
    const std::int64_t pixels = std::int64_t{image.width} * image.height;
    std::int64_t clipped = 0;
    for (std::int64_t i = 0; i < pixels; ++i) {
        const auto rgb = image.pixels.begin() + i * image.channels;
        clipped += *std::max_element(rgb, rgb + 3) == 255 ? 1 : 0;
    }
    return static_cast<double>(clipped) / static_cast<double>(pixels);
}

std::string describe(const HdrPicture& picture) {
    const HdrStatistics& s = picture.statistics();
    std::string text = fmt::format(
        "{}\n{} x {} pixels\nlog-average {:.4g}, mean color {:.4g} {:.4g} {:.4g}\n"
        "luminance {:.4g} .. {:.4g}, dynamic range {}\nwithout the outermost 0.1 % {}\n",
        picture.path(), picture.width(), picture.height(), s.log_average, s.mean.x, s.mean.y,
        s.mean.z, s.least, s.largest, range_text(s.least, s.largest),
        range_text(s.clipped_least, s.clipped_largest));
    if (s.not_finite > 0) {
        text += fmt::format(
            "{} of {} pixels hold NaN or infinity: left out of the numbers, shown black or white\n",
            s.not_finite, s.pixels + s.not_finite);
    }
    return text;
}

}  // namespace limn
