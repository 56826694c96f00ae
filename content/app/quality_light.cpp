#include "content/app/quality_light.h"

#include "ecs/base/text.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"

#include <glm/common.hpp>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace limn {

using glm::dvec2;
using glm::dvec3;
using oracle::LightPicture;

LightPicture light_picture(const gpu::Texture& texture) {
    const gpu::FloatImage image = gpu::read_floats(texture);
    LightPicture picture = oracle::make_dark(image.width, image.height);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            picture.pixels[y * image.width + x] = {
                image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
        }
    }
    return picture;
}

gpu::Texture upload_light(const LightPicture& picture) {
    std::vector<Vec4> texels;
    for (int y = picture.height - 1; y >= 0; --y) {  // bottom row first
        for (int x = 0; x < picture.width; ++x) {
            texels.emplace_back(Vec3(picture.at(x, y)), 1.0f);
        }
    }
    gpu::Texture texture(
        "radiance", {.format = GL_RGBA32F, .width = picture.width, .height = picture.height});
    texture.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
    return texture;
}

LightPicture make_dot(const IVec2& size, const dvec2& place, double light) {
    LightPicture picture = oracle::make_dark(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const dvec2 share = glm::max(1.0 - glm::abs(dvec2(x, y) + 0.5 - place), 0.0);
            picture.pixels[y * size.x + x] = dvec3(share.x * share.y * light);
        }
    }
    return picture;
}

ColorImage develop_light(
    FrameGraph& graph, Developer& developer, const LightPicture& picture,
    const Exposure& exposure) {
    const gpu::Texture radiance = upload_light(picture);
    Exposure steady = exposure;
    steady.dither = false;
    graph.begin_frame();
    const TextureId display =
        develop(graph, developer, steady, std::nullopt, graph.import("radiance", radiance));
    graph.keep(display);
    graph.execute();
    const gpu::ByteImage bytes = gpu::read_bytes(*graph.texture(display));
    ColorImage shown = {picture.width, picture.height, {}};
    for (int y = 0; y < bytes.height; ++y) {
        for (int x = 0; x < bytes.width; ++x) {
            shown.pixels.push_back(
                Vec3(bytes.at(x, y, 0), bytes.at(x, y, 1), bytes.at(x, y, 2)) / 255.0f);
        }
    }
    return shown;
}

Result<LevelView> open_level_view(const std::string& level, const IVec2& size) {
    Result<std::unique_ptr<Stage>> opened = open_stage(level);
    if (!opened) {
        return opened.error();
    }
    LevelView made;
    made.stage = *std::move(opened);
    static_cast<void>(advance_stage(*made.stage, 1));
    const std::optional<Entity> camera = find_camera(made.stage->world);
    if (!camera) {
        return fail("level {}: found no camera, expected one", level);
    }
    made.view = make_render_view(made.stage->world, *camera, {.width = size.x, .height = size.y});
    if (const auto* exposure = made.stage->world.find_resource<Exposure>()) {
        made.exposure = *exposure;
    }
    return made;
}

double percent_off(double found, double exact) {
    return 100 * std::abs(found - exact) / exact;
}

}  // namespace limn
