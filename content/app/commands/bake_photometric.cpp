#include "content/app/commands/bake_photometric.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/progress.h"
#include "content/bake/photometric_normals.h"
#include "content/load/files/image_load.h"
#include "content/load/files/json_document.h"
#include "content/load/files/png_file.h"
#include "content/load/level/component_json.h"
#include "ecs/base/log.h"
#include "ecs/base/srgb.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

// Techniques: face.photometric-normals

namespace limn {

/// A photograph and the direction to its only light.
struct PhotometricShot {
    std::string image;
    Vec3 to_light = {0, 0, 1};
};

LIMN_FIELDS(PhotometricShot) {
    LIMN_FIELD(image, "file, relative to this one; 8 bits are read as sRGB");
    LIMN_FIELD(to_light, "direction: right, up, toward the camera; of any length");
}

struct PhotometricShots {
    std::vector<PhotometricShot> shots;
    float shadow = 0.02f;
};

LIMN_FIELDS(PhotometricShots) {
    LIMN_FIELD(shots, "at least three, with lights that are not coplanar");
    LIMN_FIELD(shadow, "radiance of pixels that no light reaches", "", 0, 1);
}

namespace {

/// Mean of the channels of a pixel, linear.
float radiance_at(const ImageData& image, std::size_t pixel) {
    if (image.format == PixelFormat::Rgba8) {
        float sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            sum += linear_from_srgb(static_cast<float>(image.pixels[4 * pixel + c]) / 255.0f);
        }
        return sum / 3;
    }
    Vec4 value;
    if (image.format == PixelFormat::Rgba16F) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &image.pixels[pixel * sizeof bits], sizeof bits);
        value = glm::unpackHalf4x16(bits);
    } else {
        std::memcpy(&value, &image.pixels[pixel * sizeof value], sizeof value);
    }
    return (value.x + value.y + value.z) / 3;
}

std::uint8_t byte_of(float value) {
    return static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

Result<std::vector<ImageData>> load_shots(const std::string& file, const PhotometricShots& recipe) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    std::vector<ImageData> images;
    Progress progress("image", static_cast<int>(recipe.shots.size()));
    for (const PhotometricShot& shot : recipe.shots) {
        const std::string path = (folder / shot.image).string();
        images.push_back(LIMN_TRY(load_image(path, true)));
        const ImageData& first = images.front();
        const ImageData& image = images.back();
        if (image.width != first.width || image.height != first.height) {
            return fail(
                "{}: found {} x {} pixels, expected the {} x {} of the first image", path,
                image.width, image.height, first.width, first.height);
        }
        progress.update(static_cast<int>(images.size()));
    }
    return images;
}

}  // namespace

Status bake_photometric(const BakeOptions& options) {
    const ImageFileKind kind = LIMN_TRY(image_file_kind(options.out));
    if (kind != ImageFileKind::Png) {
        return fail("{}: expected a file name ending in .png", options.out);
    }
    PhotometricShots recipe;
    const JsonValue json = LIMN_TRY(load_json(options.in));
    LIMN_TRY(read_struct(json, recipe, {options.in, ""}, {}));
    std::vector<Vec3> lights;
    for (const PhotometricShot& shot : recipe.shots) {
        lights.push_back(shot.to_light);
    }
    if (const Status status = check_photometric_lights(lights); !status) {
        return fail("{}: {}", options.in, status.error().message);
    }
    for (Vec3& light : lights) {
        light = glm::normalize(light);
    }
    const std::vector<ImageData> images = LIMN_TRY(load_shots(options.in, recipe));
    const int width = images[0].width;
    const int height = images[0].height;
    const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<std::uint8_t> normals;
    std::vector<std::uint8_t> albedo;
    normals.reserve(3 * pixels);
    albedo.reserve(pixels);
    std::size_t dark = 0;
    std::vector<float> radiance(images.size());
    for (std::size_t i = 0; i < pixels; ++i) {
        std::transform(images.begin(), images.end(), radiance.begin(), [i](const ImageData& image) {
            return radiance_at(image, i);
        });
        const PhotometricPixel found = solve_photometric(lights, radiance, recipe.shadow);
        dark += found.reflectance == 0 ? 1 : 0;
        for (int c = 0; c < 3; ++c) {
            normals.push_back(byte_of(0.5f + 0.5f * found.normal[c]));
        }
        albedo.push_back(byte_of(srgb_from_linear(std::min(found.reflectance, 1.0f))));
    }
    if (dark > 0) {
        log_info("{}: too few lights illuminate {} of {} pixels", options.in, dark, pixels);
    }
    const std::string stem = options.out.substr(0, options.out.rfind('.'));
    LIMN_TRY(write_png(stem + "_normal.png", width, height, 3, normals));
    return write_png(stem + "_albedo.png", width, height, 1, albedo);
}

}  // namespace limn
