#include "bench/oracles/sampling_forms.h"

#include "bench/oracles/shader_values.h"
#include "render/gpu/device.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <string>

// Techniques: tex.sampling

namespace limn::oracle {
namespace {

using Shape = SampledShape;

constexpr SamplingForm kForms[] = {
    {"1D", Shape::Line, "sampler1D", "texture(map, x.x)"},
    {"1D, derivatives", Shape::Line, "sampler1D", "textureGrad(map, x.x, g, g)", true},
    {"1D, compared", Shape::Line, "sampler1DShadow", "vec4(texture(map, x.xyz))", false, true},
    {"1D, compared, derivatives", Shape::Line, "sampler1DShadow",
     "vec4(textureGrad(map, x.xyz, g, g))", true, true},
    {"1D, projected", Shape::Line, "sampler1D", "textureProj(map, x.xw)", false, false, true},
    {"1D, projected, compared", Shape::Line, "sampler1DShadow", "vec4(textureProj(map, x))", false,
     true, true},
    {"2D", Shape::Plane, "sampler2D", "texture(map, x.xy)"},
    {"2D, derivatives", Shape::Plane, "sampler2D",
     "textureGrad(map, x.xy, vec2(g, 0.0), vec2(0.0, g))", true},
    {"2D, compared", Shape::Plane, "sampler2DShadow", "vec4(texture(map, x.xyz))", false, true},
    {"2D, compared, derivatives", Shape::Plane, "sampler2DShadow",
     "vec4(textureGrad(map, x.xyz, vec2(g, 0.0), vec2(0.0, g)))", true, true},
    {"2D, projected", Shape::Plane, "sampler2D", "textureProj(map, x.xyw)", false, false, true},
    {"2D, projected, compared", Shape::Plane, "sampler2DShadow", "vec4(textureProj(map, x))", false,
     true, true},
    {"rectangle", Shape::Rectangle, "sampler2DRect", "texture(map, x.xy)"},
    {"rectangle, derivatives", Shape::Rectangle, "sampler2DRect",
     "textureGrad(map, x.xy, vec2(g, 0.0), vec2(0.0, g))", true},
    {"rectangle, compared", Shape::Rectangle, "sampler2DRectShadow", "vec4(texture(map, x.xyz))",
     false, true},
    {"rectangle, compared, derivatives", Shape::Rectangle, "sampler2DRectShadow",
     "vec4(textureGrad(map, x.xyz, vec2(g, 0.0), vec2(0.0, g)))", true, true},
    {"rectangle, projected", Shape::Rectangle, "sampler2DRect", "textureProj(map, x.xyw)", false,
     false, true},
    {"rectangle, projected, compared", Shape::Rectangle, "sampler2DRectShadow",
     "vec4(textureProj(map, x))", false, true, true},
    {"3D", Shape::Volume, "sampler3D", "texture(map, x.xyz)"},
    {"3D, derivatives", Shape::Volume, "sampler3D",
     "textureGrad(map, x.xyz, vec3(g, 0.0, 0.0), vec3(0.0, g, 0.0))", true},
    {"3D, projected", Shape::Volume, "sampler3D", "textureProj(map, x)", false, false, true},
    {"cube", Shape::Cube, "samplerCube", "texture(map, x.xyz)"},
    {"cube, derivatives", Shape::Cube, "samplerCube",
     "textureGrad(map, x.xyz, across_face(x.xyz, g), across_face(x.xyz, g))", true},
    // There is no textureProj of cubes.
    {"cube, projected", Shape::Cube, "samplerCube", "texture(map, x.xyz / x.w)", false, false,
     true},
};

// A step along a face by `g` of its width, whichever face a direction meets.
constexpr const char* kAcrossFace = R"(
vec3 across_face(vec3 v, float g) {
    vec3 a = abs(v);
    float longest = max(a.x, max(a.y, a.z));
    return (a.x == longest ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)) * 2.0 * g * longest;
}
)";

GLenum gl_target(Shape shape) {
    constexpr GLenum kTargets[] = {
        GL_TEXTURE_1D, GL_TEXTURE_2D, GL_TEXTURE_RECTANGLE, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP};
    return kTargets[static_cast<std::size_t>(shape)];
}

Result<std::vector<Vec4>> evaluate_bound(
    gpu::Device& device, const gpu::Texture& texture, const gpu::Sampler& sampler,
    const std::string& before, const std::string& body, std::span<const Vec4> points) {
    device.invalidate_state();
    device.bind_texture(0, texture, &sampler);
    return evaluate_shader(device, before, body, points);
}

}  // namespace

std::span<const SamplingForm> sampling_forms() {
    return kForms;
}

TexelPyramid noise_texels(Shape shape, int size) {
    TexelLevel level = {
        .width = size,
        .height = shape == Shape::Line ? 1 : size,
        .depth = shape == Shape::Volume ? size
                 : shape == Shape::Cube ? 6
                                        : 1,
        .texels = {}};
    const int count = level.width * level.height * level.depth;
    for (int i = 0; i < count; ++i) {
        glm::dvec4 texel;
        for (int c = 0; c < 4; ++c) {
            texel[c] =
                static_cast<float>(std::fmod(0.61803398875 * (4 * i + c) + 0.1 * c * i, 1.0));
        }
        level.texels.push_back(texel);
    }
    if (shape == Shape::Rectangle) {
        return {{level}};
    }
    return shape == Shape::Cube ? make_cube_pyramid(level) : make_pyramid(level);
}

gpu::Texture make_sampled_texture(Shape shape, const TexelPyramid& texels, bool depths) {
    const TexelLevel& first = texels.levels[0];
    gpu::Texture texture(
        "sampled", {.format = static_cast<GLenum>(depths ? GL_DEPTH_COMPONENT32F : GL_RGBA32F),
                    .width = first.width,
                    .height = first.height,
                    .depth = shape == Shape::Volume ? first.depth : 1,
                    .levels = static_cast<int>(texels.levels.size()),
                    .target = gl_target(shape)});
    for (std::size_t i = 0; i < texels.levels.size(); ++i) {
        std::vector<float> values;
        for (const glm::dvec4& texel : texels.levels[i].texels) {
            for (int c = 0; c < (depths ? 1 : 4); ++c) {
                values.push_back(static_cast<float>(texel[c]));
            }
        }
        texture.upload(std::as_bytes(std::span(values)), static_cast<int>(i));
    }
    return texture;
}

Result<std::vector<Vec4>> sample_on_gpu(
    gpu::Device& device, const SamplingForm& form, const gpu::Texture& texture,
    const gpu::Sampler& sampler, std::span<const Vec4> points) {
    const float g =
        form.shape == Shape::Rectangle ? 2.0f : 2.0f / static_cast<float>(texture.width());
    return evaluate_bound(
        device, texture, sampler,
        fmt::format("layout(binding = 0) uniform {} map;\n{}", form.sampler, kAcrossFace),
        fmt::format("    const float g = {:.9f};\n    y = {};\n", g, form.call), points);
}

glm::dvec4 sample_exactly(
    const SamplingForm& form, const TexelPyramid& texels, const SamplerRules& rules,
    const Vec4& point) {
    const glm::dvec4 x = glm::dvec4(point) / (form.projects ? static_cast<double>(point.w) : 1.0);
    const double level = form.gradients && form.shape != Shape::Rectangle ? 1 : 0;
    const TexelLevel& first = texels.levels[0];
    glm::dvec3 uvw(0.5);
    switch (form.shape) {
    case Shape::Line:
        uvw.x = x.x;
        break;
    case Shape::Plane:
        uvw = {x.x, x.y, 0.5};
        break;
    case Shape::Rectangle:
        uvw = {x.x / first.width, x.y / first.height, 0.5};
        break;
    case Shape::Volume:
        uvw = glm::dvec3(x);
        break;
    case Shape::Cube:
        return sample_cube(texels, rules, glm::dvec3(x), level);
    }
    const glm::dvec4 texel = sample_texture(texels, rules, uvw, level);
    return form.compares ? glm::dvec4(compare_depth(texel, x.z)) : texel;
}

Result<std::vector<Vec4>> sample_gradients_on_gpu(
    gpu::Device& device, const gpu::Texture& texture, const gpu::Sampler& sampler,
    std::span<const Vec4> points) {
    const std::vector<Vec4> both = LIMN_TRY(evaluate_bound(
        device, texture, sampler, "layout(binding = 0) uniform sampler2D map;\n",
        "    vec4 g = inputs[min(i + 1u, uint(inputs.length()) - 1u)];\n"
        "    y = textureGrad(map, x.xy, g.xy, g.zw);\n",
        points));
    std::vector<Vec4> values;
    for (std::size_t i = 0; i < both.size(); i += 2) {
        values.push_back(both[i]);
    }
    return values;
}

}  // namespace limn::oracle
