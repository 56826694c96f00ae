#include "render/light/normalization_cube.h"

#include "ecs/world.h"
#include "render/environment/cube_map.h"
#include "render/gpu/device.h"
#include "render/shaders/normalization_gpu.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <span>

// Techniques: env.normalise-cube

namespace limn {
namespace {

Normalization normalization_of(const FrameData& frame) {
    const auto* rendering = frame.world->find_resource<Rendering>();
    return rendering != nullptr ? rendering->normalization : Normalization::Computed;
}

void bind_cube(PassContext& context, const NormalizationEffect& effect) {
    context.device().bind_texture(layout::kNormalizationUnit, *effect.cube);
}

}  // namespace

std::vector<Vec3> make_normalization_cube(int size) {
    std::vector<Vec3> vectors;
    const auto at = [size](int i) {
        return (static_cast<float>(i) + 0.5f) / static_cast<float>(size);
    };
    for (int face = 0; face < kCubeFaces; ++face) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                vectors.push_back(
                    glm::normalize(cube_direction({.face = face, .st = {at(x), at(y)}})));
            }
        }
    }
    return vectors;
}

std::vector<std::uint8_t> normalization_bytes(int size) {
    std::vector<std::uint8_t> bytes;
    for (const Vec3& v : make_normalization_cube(size)) {
        for (int c = 0; c < 3; ++c) {
            bytes.push_back(static_cast<std::uint8_t>(std::lround(127.5f + 127.5f * v[c])));
        }
        bytes.push_back(255);
    }
    return bytes;
}

gpu::Texture make_normalization_texture(Normalization source, int size) {
    const bool in_bytes = source == Normalization::CubeBytes;
    gpu::Texture texture(
        "normalization cube", {.format = static_cast<GLenum>(in_bytes ? GL_RGBA8 : GL_RGBA16F),
                               .width = size,
                               .height = size,
                               .target = GL_TEXTURE_CUBE_MAP});
    if (in_bytes) {
        texture.upload<std::uint8_t>(normalization_bytes(size), GL_RGBA, GL_UNSIGNED_BYTE);
    } else {
        texture.upload<Vec3>(make_normalization_cube(size), GL_RGB, GL_FLOAT);
    }
    return texture;
}

bool NormalizationEffect::is_used(const FrameData& frame) {
    return normalization_of(frame) != Normalization::Computed;
}

void NormalizationEffect::collect(FrameData& frame) {
    const Normalization wanted = normalization_of(frame);
    if (!cube || source != wanted) {
        cube = make_normalization_texture(wanted, kNormalizationSize);
        source = wanted;
    }
}

bool NormalizationEffect::prepare(const FrameData&, ViewData& view) {
    view.lighting.variant.add(
        source == Normalization::CubeBytes ? "NORMALIZATION_CUBE_BYTES" : "NORMALIZATION_CUBE");
    view.lighting.add_binding<bind_cube>(*this);
    return true;
}

}  // namespace limn
