#include "systems/particles/height_image_system.h"

#include "ecs/components/image_blocks.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Techniques: particle.heightfield-collision

namespace limn {
namespace {

constexpr std::uint32_t kMaxImagePoints = 1024;

/// Red of a texel; the image is complete and not in blocks.
float red_at(const ImageData& image, int x, int y) {
    const std::size_t texel = static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width)
                              + static_cast<std::size_t>(x);
    float red = 0;
    if (image.format == PixelFormat::Rgba8) {
        red = static_cast<float>(image.pixels[4 * texel]) / 255.0f;
    } else if (image.format == PixelFormat::Rgba16F) {
        std::uint16_t bits = 0;
        std::memcpy(&bits, &image.pixels[8 * texel], sizeof(bits));
        red = glm::unpackHalf1x16(bits);
    } else if (image.format == PixelFormat::Rgba32F) {
        std::memcpy(&red, &image.pixels[16 * texel], sizeof(red));
    }
    return finite_or(red, 0);
}

float sample_pixels(const ImageData& image, const Vec2& at) {
    const auto last_x = static_cast<float>(image.width - 1);
    const auto last_y = static_cast<float>(image.height - 1);
    const float x = std::clamp(at.x * static_cast<float>(image.width) - 0.5f, 0.0f, last_x);
    const float y = std::clamp(at.y * static_cast<float>(image.height) - 0.5f, 0.0f, last_y);
    const int i = static_cast<int>(x);
    const int j = static_cast<int>(y);
    const int next_i = std::min(i + 1, image.width - 1);
    const int next_j = std::min(j + 1, image.height - 1);
    const float fx = x - static_cast<float>(i);
    const float fy = y - static_cast<float>(j);
    const float top = std::lerp(red_at(image, i, j), red_at(image, next_i, j), fx);
    const float bottom = std::lerp(red_at(image, i, next_j), red_at(image, next_i, next_j), fx);
    return std::lerp(top, bottom, fy);
}

bool has_pixels(const ImageData& image) {
    return image.width > 0 && image.height > 0 && image.pixels.size() >= image_bytes(image);
}

}  // namespace

float sample_red(const ImageData& image, const Vec2& at) {
    if (!has_pixels(image) || !std::isfinite(at.x + at.y)) {
        return 0;
    }
    return sample_pixels(is_in_blocks(image.format) ? decoded_level(image) : image, at);
}

void fill_height_image(const HeightImage& settings, const ImageData& image, HeightField& field) {
    const std::uint32_t points = std::clamp(settings.points, 2u, kMaxImagePoints);
    const std::size_t side = points;
    field.points = points;
    field.size = settings.size;
    field.height.assign(side * side, settings.base);
    field.normal.assign(side * side, Vec3(0, 1, 0));
    if (has_pixels(image)) {
        const ImageData decoded = is_in_blocks(image.format) ? decoded_level(image) : ImageData{};
        const ImageData& pixels = decoded.width > 0 ? decoded : image;
        for (std::size_t j = 0; j < side; ++j) {
            for (std::size_t i = 0; i < side; ++i) {
                const Vec2 at = Vec2(i, j) / static_cast<float>(points - 1);
                field.height[j * side + i] =
                    settings.base + settings.height * sample_pixels(pixels, at);
            }
        }
    }
    const Vec2 cell = settings.size / static_cast<float>(points - 1);
    for (std::size_t j = 0; j < side; ++j) {
        for (std::size_t i = 0; i < side; ++i) {
            const std::size_t left = i > 0 ? i - 1 : 0;
            const std::size_t right = std::min(i + 1, side - 1);
            const std::size_t back = j > 0 ? j - 1 : 0;
            const std::size_t front = std::min(j + 1, side - 1);
            const auto& h = field.height;
            const Vec2 slope = {
                (h[j * side + right] - h[j * side + left])
                    / (static_cast<float>(right - left) * cell.x),
                (h[front * side + i] - h[back * side + i])
                    / (static_cast<float>(front - back) * cell.y)};
            field.normal[j * side + i] = normalize_or({-slope.x, 1, -slope.y}, Vec3(0, 1, 0));
        }
    }
    const auto [low, high] = std::minmax_element(field.height.begin(), field.height.end());
    field.low = *low;
    field.range = *high - *low;
}

void add_height_images(
    Query<const HeightImage, Without<HeightImageState>> bare, Commands commands) {
    bare.each([&](Entity entity, const HeightImage&) {
        commands.add(entity, HeightImageState{});
        commands.add(entity, HeightField{});
    });
}

void update_height_images(
    Query<const HeightImage, HeightImageState, HeightField> images, Res<const Assets> assets) {
    images.each([&](const HeightImage& settings, HeightImageState& state, HeightField& field) {
        static const ImageData kNone;
        const ImageData& image = settings.image.index < assets->images.size()
                                     ? assets->images[settings.image.index]
                                     : kNone;
        if (field.points == 0 || !(state.settings == settings) || state.version != image.version) {
            fill_height_image(settings, image, field);
            state = {settings, image.version};
        }
    });
}

}  // namespace limn
