#pragma once

#include "ecs/components/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace limn::oracle {

// Texture lookups in double precision, as section 8.14 of the OpenGL 4.5 specification has them:
// wrapping, filters, the level of detail of derivatives, faces of cubes (tex.sampling).

/// Texels of one mip level: x first, then y, then z. Of a line y and z have size 1; z of a cube is
/// the face.
struct TexelLevel {
    int width = 1;
    int height = 1;
    int depth = 1;
    std::vector<glm::dvec4> texels;
};

/// From the largest level to smaller ones.
struct TexelPyramid {
    std::vector<TexelLevel> levels;
};

struct SamplerRules {
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;  ///< and of the third coordinate
    bool nearest = false;        ///< when magnified
    Minify minify = Minify::LinearMipLinear;
    double bias = 0;
    glm::dvec2 range = {0, 16};  ///< of levels
};

/// Level 0 of this size and all smaller ones; each texel is the mean of those that it covers.
[[nodiscard]] TexelPyramid make_pyramid(TexelLevel level);
/// A cube of faces of this size, with smaller levels of each face.
[[nodiscard]] TexelPyramid make_cube_pyramid(TexelLevel faces);

/// The texel that stands for texel `i` beyond the edges of `size` texels.
[[nodiscard]] int wrap_texel(int i, int size, Wrap wrap);

/// log2 of the longer derivative; both in texels of level 0 per pixel.
[[nodiscard]] double level_of_detail(const glm::dvec2& along_x, const glm::dvec2& along_y);

/// The lookup at normalized coordinates; `level` before bias and range.
[[nodiscard]] glm::dvec4 sample_texture(
    const TexelPyramid& texture, const SamplerRules& rules, const glm::dvec3& uvw, double level);

/// Face number (+x -x +y -y +z -z) and coordinates in it, 0 .. 1, of a direction that is not 0.
struct FaceSample {
    int face = 0;
    glm::dvec2 uv;
};
[[nodiscard]] FaceSample face_sample(const glm::dvec3& direction);

/// The lookup in a cube, which does not filter across edges.
[[nodiscard]] glm::dvec4 sample_cube(
    const TexelPyramid& cube, const SamplerRules& rules, const glm::dvec3& direction, double level);

/// 1 where `reference` is at most the texel's red, otherwise 0.
[[nodiscard]] double compare_depth(const glm::dvec4& texel, double reference);

}  // namespace limn::oracle
