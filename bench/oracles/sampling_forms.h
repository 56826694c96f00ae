#pragma once

#include "bench/oracles/sampling_oracle.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/texture.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn::gpu {
class Device;
}

namespace limn::oracle {

// The 24 texture functions of shading languages (tex.sampling) as GLSL 4.5 has them, each evaluated
// on the GPU and in double precision.
//
// A point is (s, t, r, q): coordinates, the reference of a comparison in r, and the divisor q.
// Coordinates of rectangles are in texels. Derivatives are those of level 1. Evaluated outside
// fragment shaders, so that functions without derivatives read level 0.

enum class SampledShape : std::uint8_t { Line, Plane, Rectangle, Volume, Cube };

struct SamplingForm {
    const char* name;
    SampledShape shape;
    const char* sampler;  ///< its type
    const char* call;     ///< of the sampler `map`, the point `x` and the derivatives `g`
    bool gradients = false;
    bool compares = false;
    bool projects = false;
};

[[nodiscard]] std::span<const SamplingForm> sampling_forms();

/// Texels of a hash, 0 .. 1, with all mip levels; of a rectangle one level.
[[nodiscard]] TexelPyramid noise_texels(SampledShape shape, int size);

/// The same on the GPU, in floats; as depths: their red.
[[nodiscard]] gpu::Texture
make_sampled_texture(SampledShape shape, const TexelPyramid& texels, bool depths);

/// The function at each point, of the filter that `sampler` has. Fails with the compiler's message.
[[nodiscard]] Result<std::vector<Vec4>> sample_on_gpu(
    gpu::Device& device, const SamplingForm& form, const gpu::Texture& texture,
    const gpu::Sampler& sampler, std::span<const Vec4> points);

/// The same in double precision; comparisons are not filtered.
[[nodiscard]] glm::dvec4 sample_exactly(
    const SamplingForm& form, const TexelPyramid& texels, const SamplerRules& rules,
    const Vec4& point);

/// textureGrad of a plane at points (s, t), with derivatives along x and y of the screen in
/// coordinates per pixel: (s, t, 0, 0), (ds/dx, dt/dx, ds/dy, dt/dy), and so on.
[[nodiscard]] Result<std::vector<Vec4>> sample_gradients_on_gpu(
    gpu::Device& device, const gpu::Texture& texture, const gpu::Sampler& sampler,
    std::span<const Vec4> points);

}  // namespace limn::oracle
