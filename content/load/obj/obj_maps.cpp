#include "content/load/obj/obj_maps.h"

#include "ecs/base/srgb.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

// Techniques: bump.nm-from-height

namespace limn {

namespace {

constexpr float kReliefHeight = 0.01f;  // of white, of the image's width

std::uint8_t obj_code(float value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
}

/// A value of a texel as 8 bits; a NaN is 0.
std::uint8_t obj_code_at(const ImageData& image, std::size_t texel, std::size_t channel) {
    const std::size_t i = 4 * texel + channel;
    float value = 0;
    switch (image.format) {
    case PixelFormat::Rgba8:
        return image.pixels[i];
    case PixelFormat::Rgba16F: {
        std::uint16_t bits;
        std::memcpy(&bits, &image.pixels[2 * i], sizeof(bits));
        value = glm::unpackHalf1x16(bits);
        break;
    }
    case PixelFormat::Rgba32F:
        std::memcpy(&value, &image.pixels[4 * i], sizeof(value));
        break;
    case PixelFormat::Bc5:
    case PixelFormat::Bc7:
        break;
    }
    return obj_code(std::isnan(value) ? 0 : value);
}

std::size_t obj_texel_count(const ImageData& image) {
    return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

std::uint8_t obj_scalar_at(const ImageData& image, std::size_t texel, ObjChannel channel) {
    switch (channel) {
    case ObjChannel::Red:
        return obj_code_at(image, texel, 0);
    case ObjChannel::Green:
        return obj_code_at(image, texel, 1);
    case ObjChannel::Blue:
        return obj_code_at(image, texel, 2);
    case ObjChannel::Alpha:
        return obj_code_at(image, texel, 3);
    case ObjChannel::Default:
    case ObjChannel::Luminance:
        break;
    }
    const float sum = 0.2126f * static_cast<float>(obj_code_at(image, texel, 0))
                      + 0.7152f * static_cast<float>(obj_code_at(image, texel, 1))
                      + 0.0722f * static_cast<float>(obj_code_at(image, texel, 2));
    return obj_code(sum / 255);
}

bool has_varying_alpha(const ImageData& image) {
    for (std::size_t i = 0; i < obj_texel_count(image); ++i) {
        if (obj_code_at(image, i, 3) != 255) {
            return true;
        }
    }
    return false;
}

/// An image of 8 bits, as large as the larger of two.
ImageData make_obj_image(const ImageData* a, const ImageData* b) {
    ImageData image;
    for (const ImageData* const source : {a, b}) {
        if (source != nullptr) {
            image.name += (image.name.empty() ? "" : " + ") + source->name;
            image.width = std::max(image.width, source->width);
            image.height = std::max(image.height, source->height);
        }
    }
    image.pixels.resize(4 * obj_texel_count(image), 255);
    return image;
}

/// The texel of `source` at texel (x, y) of `image`.
std::size_t obj_texel_of(const ImageData& source, const ImageData& image, int x, int y) {
    const std::int64_t sx = std::int64_t{x} * source.width / image.width;
    const std::int64_t sy = std::int64_t{y} * source.height / image.height;
    return static_cast<std::size_t>(sy * source.width + sx);
}

/// Calls `set` with the four values of each texel and its coordinates.
template <typename Set>
void for_each_obj_texel(ImageData& image, Set&& set) {
    std::uint8_t* texel = image.pixels.data();
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x, texel += 4) {
            set(texel, x, y);
        }
    }
}

}  // namespace

bool is_gray(const ImageData& image) {
    constexpr int kTolerance = 12;
    for (std::size_t i = 0; i < obj_texel_count(image); ++i) {
        const int r = obj_code_at(image, i, 0);
        const int g = obj_code_at(image, i, 1);
        const int b = obj_code_at(image, i, 2);
        if (std::max({r, g, b}) - std::min({r, g, b}) > kTolerance) {
            return false;
        }
    }
    return true;
}

ImageData with_opacity(const ImageData* color, const ImageData& opacity, ObjChannel channel) {
    if (channel == ObjChannel::Default && has_varying_alpha(opacity)) {
        channel = ObjChannel::Alpha;
    }
    ImageData image = make_obj_image(color, &opacity);
    image.srgb = true;
    for_each_obj_texel(image, [&](std::uint8_t* texel, int x, int y) {
        for (std::size_t c = 0; c < 3 && color != nullptr; ++c) {
            const std::uint8_t code = obj_code_at(*color, obj_texel_of(*color, image, x, y), c);
            texel[c] = color->format == PixelFormat::Rgba8
                           ? code
                           : obj_code(srgb_from_linear(static_cast<float>(code) / 255));
        }
        texel[3] = obj_scalar_at(opacity, obj_texel_of(opacity, image, x, y), channel);
    });
    return image;
}

AlphaMode alpha_mode_of(const ImageData& image) {
    constexpr std::uint8_t kMargin = 8;  // of what counts as 0 or 1
    std::size_t between = 0;
    std::size_t clear = 0;
    for (std::size_t i = 0; i < obj_texel_count(image); ++i) {
        const std::uint8_t alpha = obj_code_at(image, i, 3);
        clear += alpha < kMargin ? 1 : 0;
        between += alpha >= kMargin && alpha <= 255 - kMargin ? 1 : 0;
    }
    if (clear + between == 0) {
        return AlphaMode::Opaque;
    }
    return between > obj_texel_count(image) / 10 ? AlphaMode::Blend : AlphaMode::Mask;
}

ImageData normals_of_heights(const ImageData& heights, float strength, bool clamp) {
    ImageData image = make_obj_image(&heights, nullptr);
    const auto wrap = [clamp](int i, int size) {
        return clamp ? std::clamp(i, 0, size - 1) : (i + size) % size;
    };
    const auto height_at = [&](int x, int y) {
        const std::int64_t row = wrap(y, heights.height);
        const auto texel = static_cast<std::size_t>(row * heights.width + wrap(x, heights.width));
        return static_cast<float>(obj_scalar_at(heights, texel, ObjChannel::Luminance)) / 255;
    };
    // Half of a central difference, in texels.
    const float scale = 0.5f * strength * kReliefHeight * static_cast<float>(heights.width);
    for_each_obj_texel(image, [&](std::uint8_t* texel, int x, int y) {
        const Vec3 normal = glm::normalize(Vec3(
            scale * (height_at(x - 1, y) - height_at(x + 1, y)),
            scale * (height_at(x, y + 1) - height_at(x, y - 1)), 1));
        for (int c = 0; c < 3; ++c) {
            texel[c] = obj_code(0.5f * normal[c] + 0.5f);
        }
    });
    return image;
}

ImageData
pack_roughness_and_metalness(const ObjScalarMap& roughness, const ObjScalarMap& metalness) {
    ImageData image = make_obj_image(roughness.image, metalness.image);
    const auto value_of = [&](const ObjScalarMap& map, int x, int y) -> std::uint8_t {
        if (map.image == nullptr) {
            return 255;
        }
        const std::uint8_t code =
            obj_scalar_at(*map.image, obj_texel_of(*map.image, image, x, y), map.channel);
        return map.table.empty() ? code : map.table[code];
    };
    for_each_obj_texel(image, [&](std::uint8_t* texel, int x, int y) {
        texel[1] = value_of(roughness, x, y);
        texel[2] = value_of(metalness, x, y);
    });
    return image;
}

}  // namespace limn
