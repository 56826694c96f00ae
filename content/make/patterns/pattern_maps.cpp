#include "content/make/patterns/pattern_maps.h"

#include "content/bake/cone_map.h"
#include "content/bake/wrinkle_map.h"
#include "ecs/base/check.h"
#include "ecs/base/jobs.h"

#include <algorithm>
#include <cmath>

// Techniques: bump.nm-from-height, bump.normal-encoding

namespace limn {

namespace {

constexpr float kWidestCone = 0.125f;  // of relief maps: wider ones take minutes

std::uint8_t to_byte(float x) {
    return static_cast<std::uint8_t>(std::clamp(x, 0.0f, 1.0f) * 255.0f + 0.5f);
}

float encode_srgb(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

ImageData make_image(int size, bool srgb) {
    ImageData image;
    image.width = size;
    image.height = size;
    image.format = PixelFormat::Rgba8;
    image.srgb = srgb;
    image.pixels.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size) * 4);
    return image;
}

void put(
    ImageData& image, std::size_t pixel, std::uint8_t r, std::uint8_t g, std::uint8_t b,
    std::uint8_t a = 255) {
    std::uint8_t* at = &image.pixels[4 * pixel];
    at[0] = r;
    at[1] = g;
    at[2] = b;
    at[3] = a;
}

/// Runs body(x, y, pixel) for every pixel.
template <typename Body>
void for_pixels(int size, Body&& body) {
    parallel_for(static_cast<std::size_t>(size), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            for (int x = 0; x < size; ++x) {
                body(
                    x, static_cast<int>(y),
                    y * static_cast<std::size_t>(size) + static_cast<std::size_t>(x));
            }
        }
    });
}

using Texels = std::function<PatternTexel(const Vec2& uv)>;

/// All maps except the normals; `heights`: in pixels, row by row.
PatternMaps make_surface_maps(int size, const Texels& texel, std::vector<float>& heights) {
    LIMN_CHECK(size >= 1);
    PatternMaps maps;
    maps.base_color = make_image(size, true);
    maps.normal = make_image(size, false);
    maps.orm = make_image(size, false);
    heights.resize(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    const float pixels = static_cast<float>(size);
    for_pixels(size, [&](int x, int y, std::size_t pixel) {
        const PatternTexel t = texel((Vec2(x, y) + 0.5f) / pixels);
        heights[pixel] = t.height * pixels;
        const Vec3 c = glm::clamp(t.color, 0.0f, 1.0f);
        put(maps.base_color, pixel, to_byte(encode_srgb(c.x)), to_byte(encode_srgb(c.y)),
            to_byte(encode_srgb(c.z)), to_byte(t.opacity));
        put(maps.orm, pixel, to_byte(t.occlusion), to_byte(t.roughness), to_byte(t.metalness));
    });
    return maps;
}

/// `heights`: in pixels, row by row.
void write_normals(ImageData& normal, const std::vector<float>& heights) {
    const int size = normal.width;
    for_pixels(size, [&](int x, int y, std::size_t pixel) {
        const auto height = [&](int i, int j) {
            const int column = (i + size) % size;
            const int row = (j + size) % size;
            return heights
                [static_cast<std::size_t>(row) * static_cast<std::size_t>(size)
                 + static_cast<std::size_t>(column)];
        };
        // Rows run downwards while green points up, so the signs of the two slopes differ.
        const float right = 0.5f * (height(x + 1, y) - height(x - 1, y));
        const float down = 0.5f * (height(x, y + 1) - height(x, y - 1));
        const Vec3 n = 0.5f + 0.5f * glm::normalize(Vec3(-right, down, 1.0f));
        put(normal, pixel, to_byte(n.x), to_byte(n.y), to_byte(n.z));
    });
}

}  // namespace

PatternMaps make_pattern_maps(int size, const Texels& texel) {
    std::vector<float> heights;
    PatternMaps maps = make_surface_maps(size, texel, heights);
    write_normals(maps.normal, heights);
    return maps;
}

PatternMaps make_relief_maps(int size, float relief, const Texels& texel) {
    std::vector<float> heights;
    PatternMaps maps = make_surface_maps(
        size,
        [&](const Vec2& uv) {
            PatternTexel t = texel(uv);
            t.height = relief * std::clamp(t.height, 0.0f, 1.0f);
            return t;
        },
        heights);
    write_normals(maps.normal, heights);
    maps.relief = maps.normal;
    const float range = relief * static_cast<float>(size);
    BakedMap depths = make_baked_map(size, size);
    bool is_solid = true;
    for (std::size_t pixel = 0; pixel < heights.size(); ++pixel) {
        depths.texels[pixel].w = 1.0f - heights[pixel] / range;
        is_solid = is_solid && maps.base_color.pixels[4 * pixel + 3] >= 128;
    }
    if (is_solid) {
        depths = make_cone_map(depths, true, {}, kWidestCone);
    }
    for_pixels(size, [&](int, int, std::size_t pixel) {
        std::uint8_t* const at = &maps.relief.pixels[4 * pixel];
        const bool solid = maps.base_color.pixels[4 * pixel + 3] >= 128;
        at[2] =
            is_solid ? to_byte(depths.texels[pixel].z) : static_cast<std::uint8_t>(solid ? 255 : 0);
        at[3] = solid ? to_byte(depths.texels[pixel].w) : 255;
    });
    return maps;
}

PatternMaps make_wrinkle_maps(int size, const Texels& texel) {
    std::vector<float> heights;
    PatternMaps maps = make_surface_maps(size, texel, heights);
    for_pixels(size, [&](int, int, std::size_t pixel) { put(maps.normal, pixel, 128, 128, 255); });
    write_wrinkle_map(maps.normal, heights);
    return maps;
}

}  // namespace limn
