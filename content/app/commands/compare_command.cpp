#include "content/app/commands/compare_command.h"

#include "content/app/commands/image_file.h"
#include "content/bake/image_compare.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace limn {
namespace {

/// An image in the encodings that the metrics need.
struct Loaded {
    ColorImage display;                ///< sRGB encoded, 0 .. 1
    std::optional<ColorImage> linear;  ///< of an EXR
    std::vector<std::uint8_t> mask;    ///< 0 where the image is transparent
};

float display_from_linear(float x) {
    const float clamped = x > 0.0f ? std::min(x, 1.0f) : 0.0f;  // NaN becomes 0
    return clamped <= 0.0031308f ? 12.92f * clamped
                                 : 1.055f * std::pow(clamped, 1.0f / 2.4f) - 0.055f;
}

/// The value of pixel `index`, channel by channel.
Vec4 read_pixel(const ImageData& image, std::size_t index) {
    Vec4 pixel;
    if (image.format == PixelFormat::Rgba8) {
        const std::uint8_t* bytes = image.pixels.data() + 4 * index;
        return Vec4(bytes[0], bytes[1], bytes[2], bytes[3]) / 255.0f;
    }
    if (image.format == PixelFormat::Rgba16F) {
        std::uint16_t halves[4];
        std::memcpy(halves, image.pixels.data() + 8 * index, sizeof(halves));
        for (int i = 0; i < 4; ++i) {
            pixel[i] = glm::unpackHalf1x16(halves[i]);
        }
        return pixel;
    }
    std::memcpy(&pixel, image.pixels.data() + 16 * index, sizeof(pixel));
    return pixel;
}

Result<Loaded> load_comparable(const std::string& path) {
    const Result<ImageData> image = load_image(path, false);
    if (!image) {
        return image.error();
    }
    const std::size_t count = static_cast<std::size_t>(image->width) * image->height;
    const bool is_linear = image->format != PixelFormat::Rgba8;
    Loaded loaded;
    loaded.display = {.width = image->width, .height = image->height, .pixels = {}};
    loaded.display.pixels.resize(count);
    loaded.mask.resize(count);
    if (is_linear) {
        loaded.linear = loaded.display;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const Vec4 pixel = read_pixel(*image, i);
        const Vec3 color(pixel);
        loaded.mask[i] = pixel.w > 0.0f ? 1 : 0;
        if (is_linear) {
            loaded.linear->pixels[i] = color;
            loaded.display.pixels[i] = {
                display_from_linear(color.x), display_from_linear(color.y),
                display_from_linear(color.z)};
        } else {
            loaded.display.pixels[i] = color;
        }
    }
    return loaded;
}

/// The row of the brightest pixel, as the scanline most likely to cross a highlight.
int brightest_row(const ColorImage& image) {
    const auto brightest = std::max_element(
        image.pixels.begin(), image.pixels.end(),
        [](const Vec3& a, const Vec3& b) { return a.x + a.y + a.z < b.x + b.y + b.z; });
    return static_cast<int>(brightest - image.pixels.begin()) / image.width;
}

/// Every number that compare prints.
struct Comparison {
    double psnr = 0.0;
    double ssim = 0.0;
    ErrorSummary flip;
    LargestDifference largest;
    std::optional<double> relative_mse;
    double color_correctness = 0.0;
    int row = 0;
    ScanlineComparison line;
};

Comparison compare(const Loaded& a, const Loaded& b) {
    Comparison numbers;
    numbers.psnr = psnr(a.display, b.display);
    numbers.ssim = ssim(a.display, b.display);
    numbers.flip = summarize_errors(flip_map(a.display, b.display));
    const bool both_linear = a.linear && b.linear;
    numbers.largest = both_linear ? largest_difference(*a.linear, *b.linear)
                                  : largest_difference(a.display, b.display);
    if (both_linear) {
        numbers.relative_mse = relative_mse(*a.linear, *b.linear);
    }
    numbers.color_correctness = color_correctness(a.display, b.display, a.mask);
    numbers.row = brightest_row(a.display);
    numbers.line =
        compare_scanlines(scanline(a.display, numbers.row), scanline(b.display, numbers.row));
    return numbers;
}

void print_table(const Comparison& numbers) {
    fmt::print("psnr               {:.3f} dB\n", numbers.psnr);
    fmt::print("ssim               {:.6f}\n", numbers.ssim);
    fmt::print("flip mean          {:.6f}\n", numbers.flip.mean);
    fmt::print("flip p99           {:.6f}\n", numbers.flip.p99);
    if (numbers.relative_mse) {
        fmt::print("relative mse       {:.6g}\n", *numbers.relative_mse);
    }
    fmt::print(
        "largest difference {:.6g} in channel {} at ({}, {})\n", numbers.largest.difference,
        "RGB"[numbers.largest.channel], numbers.largest.pixel.x, numbers.largest.pixel.y);
    fmt::print("color correctness  {:.6f}\n", numbers.color_correctness);
    fmt::print(
        "scanline {:<9} peak moves {} px, height x {:.4f}, roughness {:.4f} and {:.4f}\n",
        numbers.row, numbers.line.peak_shift, numbers.line.peak_ratio, numbers.line.roughness_a,
        numbers.line.roughness_b);
}

/// JSON has no infinity: equal images have "psnr": null.
nlohmann::ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void print_json(const Comparison& numbers) {
    nlohmann::ordered_json json = {
        {"psnr", finite_or_null(numbers.psnr)},
        {"ssim", finite_or_null(numbers.ssim)},
        {"flip_mean", finite_or_null(numbers.flip.mean)},
        {"flip_p99", finite_or_null(numbers.flip.p99)},
        {"largest_difference", finite_or_null(static_cast<double>(numbers.largest.difference))},
        {"color_correctness", finite_or_null(numbers.color_correctness)},
        {"scanline",
         {{"row", numbers.row},
          {"peak_shift", numbers.line.peak_shift},
          {"peak_ratio", finite_or_null(numbers.line.peak_ratio)},
          {"roughness_a", finite_or_null(numbers.line.roughness_a)},
          {"roughness_b", finite_or_null(numbers.line.roughness_b)},
          {"largest_difference", finite_or_null(numbers.line.largest_difference)}}}};
    if (numbers.relative_mse) {
        json["relative_mse"] = finite_or_null(*numbers.relative_mse);
    }
    fmt::print("{}\n", json.dump(2));
}

Status write_difference(const std::string& path, const ColorImage& a, const ColorImage& b) {
    const ColorImage difference = enhanced_difference(a, b);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * difference.pixels.size());
    for (const Vec3& pixel : difference.pixels) {
        for (int c = 0; c < 3; ++c) {
            bytes.push_back(
                static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(pixel[c], 0.0f, 1.0f))));
        }
    }
    return write_png(path, difference.width, difference.height, 3, bytes);
}

/// Two images of one size.
struct LoadedPair {
    Loaded a;
    Loaded b;
};

Result<LoadedPair> load_pair(const std::string& path_a, const std::string& path_b) {
    LoadedPair pair;
    pair.a = LIMN_TRY(load_comparable(path_a));
    pair.b = LIMN_TRY(load_comparable(path_b));
    const ColorImage& a = pair.a.display;
    const ColorImage& b = pair.b.display;
    if (a.width != b.width || a.height != b.height) {
        return fail(
            "{}: found {} x {} pixels, expected {} x {} as {} has", path_b, b.width, b.height,
            a.width, a.height, path_a);
    }
    return pair;
}

}  // namespace

Status run_compare(const CompareOptions& options) {
    const LoadedPair pair = LIMN_TRY(load_pair(options.a, options.b));
    const Comparison numbers = compare(pair.a, pair.b);
    options.json ? print_json(numbers) : print_table(numbers);
    return options.diff.empty() ? Status(Done{})
                                : write_difference(options.diff, pair.a.display, pair.b.display);
}

Result<DisplayedDifference> compare_displayed(const std::string& a, const std::string& b) {
    const LoadedPair pair = LIMN_TRY(load_pair(a, b));
    return DisplayedDifference{
        psnr(pair.a.display, pair.b.display),
        static_cast<double>(largest_difference(pair.a.display, pair.b.display).difference)};
}

}  // namespace limn
