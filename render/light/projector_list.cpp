#include "render/light/projector_list.h"

#include "ecs/base/log.h"
#include "ecs/base/srgb.h"
#include "ecs/components/image_blocks.h"

#include <glm/geometric.hpp>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cstring>

// Techniques: shadow.projective-matrix, shadow.projector

namespace limn {
namespace {

/// Linear color of a pixel; rows from the top.
Vec3 pixel_of(const ImageData& image, int x, int y) {
    const std::size_t at = (static_cast<std::size_t>(y) * image.width + x) * 4;
    Vec3 color(0);
    for (int c = 0; c < 3; ++c) {
        const std::size_t i = at + static_cast<std::size_t>(c);
        if (image.format == PixelFormat::Rgba8) {
            const float value = static_cast<float>(image.pixels[i]) / 255.0f;
            color[c] = image.srgb ? linear_from_srgb(value) : value;
        } else if (image.format == PixelFormat::Rgba16F) {
            std::uint16_t half = 0;
            std::memcpy(&half, &image.pixels[2 * i], 2);
            color[c] = glm::unpackHalf1x16(half);
        } else {
            std::memcpy(&color[c], &image.pixels[4 * i], 4);
        }
        color[c] = std::isfinite(color[c]) ? std::max(color[c], 0.0f) : 0.0f;
    }
    return color;
}

/// Resamples the image to the size of a layer with a box filter.
std::vector<Vec4> resample(const ImageData& image) {
    constexpr int kSize = kProjectorImageSize;
    std::vector<Vec4> texels;
    texels.reserve(kSize * kSize);
    const auto range = [](int i, int count) {
        const int begin = static_cast<int>(static_cast<std::int64_t>(i) * count / kSize);
        const int end = static_cast<int>(static_cast<std::int64_t>(i + 1) * count / kSize);
        return std::pair(begin, std::max(end, begin + 1));
    };
    for (int y = 0; y < kSize; ++y) {
        const auto [top, bottom] = range(y, image.height);
        for (int x = 0; x < kSize; ++x) {
            const auto [left, right] = range(x, image.width);
            Vec3 sum(0);
            for (int py = top; py < bottom; ++py) {
                for (int px = left; px < right; ++px) {
                    sum += pixel_of(image, px, py);
                }
            }
            texels.emplace_back(sum / static_cast<float>((bottom - top) * (right - left)), 1.0f);
        }
    }
    return texels;
}

bool is_complete(const ImageData& image) {
    return image.width > 0 && image.height > 0 && image.pixels.size() >= level_bytes(image, 0);
}

}  // namespace

int projector_frame(const Projector& projector, double time) {
    const int count = std::clamp(
        projector.frames, 1, std::max(projector.columns, 1) * std::max(projector.rows, 1));
    const double passed = std::floor((time - projector.start) * projector.fps + 1e-6);
    if (!std::isfinite(passed)) {
        return 0;
    }
    if (!projector.loop) {
        return static_cast<int>(std::clamp(passed, 0.0, count - 1.0));
    }
    return static_cast<int>(passed - count * std::floor(passed / count));
}

layout::ProjectorRecord make_projector_record(
    const Projector& projector, LightKind kind, const Affine& pose, double time, int layer) {
    const auto column = [&](int i, const Vec3& fallback) {
        return normalize_or({pose.row[0][i], pose.row[1][i], pose.row[2][i]}, fallback);
    };
    const Vec3 right = column(0, {1, 0, 0});
    const Vec3 up = column(1, {0, 1, 0});
    const Vec3 forward = -column(2, {0, 0, 1});
    const Vec3 eye = {pose.row[0].w, pose.row[1].w, pose.row[2].w};
    const bool spot = kind == LightKind::Spot;
    const float width = std::isfinite(projector.width) ? projector.width : 1.0f;
    const float aspect = std::isfinite(projector.aspect) ? std::max(projector.aspect, 1e-3f) : 1.0f;
    const float across =
        spot ? 2 * std::tan(0.5f * std::clamp(width, 1e-3f, 3.0f)) : std::max(width, 1e-3f);
    const auto row = [&](const Vec3& axis) { return Vec4(axis, -glm::dot(axis, eye)); };

    layout::ProjectorRecord record{};
    record.row_q = spot ? row(forward) : Vec4(0, 0, 0, 1);
    record.row_s = row(right) / across + 0.5f * record.row_q;
    record.row_t = -row(up) * (aspect / across) + 0.5f * record.row_q;
    const int columns = std::max(projector.columns, 1);
    const int rows = std::max(projector.rows, 1);
    const int frame = projector_frame(projector, time);
    const Vec2 size = {1.0f / static_cast<float>(columns), 1.0f / static_cast<float>(rows)};
    record.frame = {
        size.x * static_cast<float>(frame % columns), size.y * static_cast<float>(frame / columns),
        size.x, size.y};
    record.source = {layer, kProjectorImageSize, 0, 0};
    return record;
}

int ProjectorPool::layer_of(const Assets& assets, ImageId image) {
    const auto found = std::find(layers_.begin(), layers_.end(), image);
    if (found != layers_.end()) {
        return static_cast<int>(found - layers_.begin());
    }
    if (image.index >= assets.images.size() || !is_complete(assets.images[image.index])) {
        return -1;
    }
    if (layers_.size() == kMaxProjectorImages) {
        if (!reported_) {
            log_warn(
                "projectors: more than {} images; the others are not projected",
                kMaxProjectorImages);
            reported_ = true;
        }
        return -1;
    }
    const int layer = static_cast<int>(layers_.size());
    if (layer == 0) {
        images_ = gpu::Texture(
            "projector images", {.format = GL_RGBA16F,
                                 .width = kProjectorImageSize,
                                 .height = kProjectorImageSize,
                                 .depth = kMaxProjectorImages,
                                 .levels = 0,
                                 .target = GL_TEXTURE_2D_ARRAY});
    }
    layers_.push_back(image);
    const ImageData& data = assets.images[image.index];
    const bool in_blocks = is_in_blocks(data.format);
    const ImageData decoded = in_blocks ? decoded_level(data) : ImageData{};
    const std::vector<Vec4> texels = resample(in_blocks ? decoded : data);
    images_.upload<Vec4>(texels, GL_RGBA, GL_FLOAT, 0, layer);
    images_.generate_mipmaps();
    return layer;
}

void ProjectorPool::update(const Assets& assets, LightList& lights) {
    if (assets_ != assets.identity.value()) {
        assets_ = assets.identity.value();
        layers_.clear();
    }
    records_.clear();
    for (const ProjectingLight& light : lights.projecting) {
        const int layer = layer_of(assets, light.projector.image);
        if (layer >= 0) {
            records_.push_back(
                make_projector_record(light.projector, light.kind, light.pose, lights.time, layer));
            lights.records[light.record].shadow.w = static_cast<float>(records_.size());
        }
    }
}

}  // namespace limn
