#include "bench/oracles/sampling_oracle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace limn::oracle {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

dvec4 texel_at(const TexelLevel& level, int x, int y, int z) {
    return level.texels[static_cast<std::size_t>((z * level.height + y) * level.width + x)];
}

dvec4 nearest_texel(const TexelLevel& level, const SamplerRules& rules, const dvec3& uvw) {
    const auto at = [](double u, int size, Wrap wrap) {
        return wrap_texel(static_cast<int>(std::floor(u * size)), size, wrap);
    };
    return texel_at(
        level, at(uvw.x, level.width, rules.wrap_u), at(uvw.y, level.height, rules.wrap_v),
        at(uvw.z, level.depth, rules.wrap_v));
}

dvec4 linear_texels(const TexelLevel& level, const SamplerRules& rules, const dvec3& uvw) {
    const dvec3 at = uvw * dvec3(level.width, level.height, level.depth) - 0.5;
    const dvec3 low = glm::floor(at);
    const dvec3 part = at - low;
    dvec4 sum(0);
    for (int corner = 0; corner < 8; ++corner) {
        const int dx = corner & 1;
        const int dy = corner >> 1 & 1;
        const int dz = corner >> 2;
        const double weight = (dx == 1 ? part.x : 1 - part.x) * (dy == 1 ? part.y : 1 - part.y)
                              * (dz == 1 ? part.z : 1 - part.z);
        sum += weight
               * texel_at(
                   level, wrap_texel(static_cast<int>(low.x) + dx, level.width, rules.wrap_u),
                   wrap_texel(static_cast<int>(low.y) + dy, level.height, rules.wrap_v),
                   wrap_texel(static_cast<int>(low.z) + dz, level.depth, rules.wrap_v));
    }
    return sum;
}

TexelLevel halved(const TexelLevel& from, bool in_depth) {
    TexelLevel to = {
        .width = std::max(from.width / 2, 1),
        .height = std::max(from.height / 2, 1),
        .depth = in_depth ? std::max(from.depth / 2, 1) : from.depth,
        .texels = {}};
    const auto range = [](int i, int size, int finer) {
        return std::pair(i * finer / size, (i + 1) * finer / size);
    };
    for (int z = 0; z < to.depth; ++z) {
        for (int y = 0; y < to.height; ++y) {
            for (int x = 0; x < to.width; ++x) {
                const auto xs = range(x, to.width, from.width);
                const auto ys = range(y, to.height, from.height);
                const auto zs = range(z, to.depth, from.depth);
                dvec4 sum(0);
                for (int k = zs.first; k < zs.second; ++k) {
                    for (int j = ys.first; j < ys.second; ++j) {
                        for (int i = xs.first; i < xs.second; ++i) {
                            sum += texel_at(from, i, j, k);
                        }
                    }
                }
                to.texels.push_back(
                    sum
                    / static_cast<double>(
                        (xs.second - xs.first) * (ys.second - ys.first) * (zs.second - zs.first)));
            }
        }
    }
    return to;
}

TexelPyramid pyramid_of(TexelLevel level, bool in_depth) {
    TexelPyramid pyramid;
    pyramid.levels.push_back(std::move(level));
    while (std::max(
               {pyramid.levels.back().width, pyramid.levels.back().height,
                in_depth ? pyramid.levels.back().depth : 1})
           > 1) {
        pyramid.levels.push_back(halved(pyramid.levels.back(), in_depth));
    }
    return pyramid;
}

bool reads_one_texel(Minify minify) {
    return minify == Minify::Nearest || minify == Minify::NearestMipNearest
           || minify == Minify::NearestMipLinear;
}

}  // namespace

TexelPyramid make_pyramid(TexelLevel level) {
    return pyramid_of(std::move(level), true);
}

TexelPyramid make_cube_pyramid(TexelLevel faces) {
    return pyramid_of(std::move(faces), false);
}

int wrap_texel(int i, int size, Wrap wrap) {
    const auto modulo = [](int a, int n) { return ((a % n) + n) % n; };
    if (wrap == Wrap::Clamp) {
        return std::clamp(i, 0, size - 1);
    }
    if (wrap == Wrap::Mirror) {
        const int there_and_back = modulo(i, 2 * size);
        return there_and_back < size ? there_and_back : 2 * size - 1 - there_and_back;
    }
    return modulo(i, size);
}

double level_of_detail(const dvec2& along_x, const dvec2& along_y) {
    return std::log2(std::max(glm::length(along_x), glm::length(along_y)));
}

dvec4 sample_texture(
    const TexelPyramid& texture, const SamplerRules& rules, const dvec3& uvw, double level) {
    const double lambda = std::clamp(level + rules.bias, rules.range.x, rules.range.y);
    const Minify minify = rules.minify;
    const bool late =  // so that sharpness does not jump
        !rules.nearest
        && (minify == Minify::NearestMipNearest || minify == Minify::NearestMipLinear);
    if (lambda <= (late ? 0.5 : 0.0)) {
        return rules.nearest ? nearest_texel(texture.levels[0], rules, uvw)
                             : linear_texels(texture.levels[0], rules, uvw);
    }
    const int last = static_cast<int>(texture.levels.size()) - 1;
    const auto at = [&](int number) {
        const TexelLevel& one =
            texture.levels[static_cast<std::size_t>(std::clamp(number, 0, last))];
        return reads_one_texel(minify) ? nearest_texel(one, rules, uvw)
                                       : linear_texels(one, rules, uvw);
    };
    switch (minify) {
    case Minify::Nearest:
    case Minify::Linear:
        return at(0);
    case Minify::NearestMipNearest:
    case Minify::LinearMipNearest:
        return at(static_cast<int>(std::ceil(lambda + 0.5)) - 1);
    default: {
        const double low = std::floor(lambda);
        return glm::mix(at(static_cast<int>(low)), at(static_cast<int>(low) + 1), lambda - low);
    }
    }
}

FaceSample face_sample(const dvec3& v) {
    const dvec3 size = glm::abs(v);
    if (size.x >= size.y && size.x >= size.z) {
        const double side = v.x > 0 ? -v.z : v.z;
        return {v.x > 0 ? 0 : 1, (dvec2(side, -v.y) / size.x + 1.0) / 2.0};
    }
    if (size.y >= size.z) {
        return {v.y > 0 ? 2 : 3, (dvec2(v.x, v.y > 0 ? v.z : -v.z) / size.y + 1.0) / 2.0};
    }
    return {v.z > 0 ? 4 : 5, (dvec2(v.z > 0 ? v.x : -v.x, -v.y) / size.z + 1.0) / 2.0};
}

dvec4 sample_cube(
    const TexelPyramid& cube, const SamplerRules& rules, const dvec3& direction, double level) {
    SamplerRules within = rules;
    within.wrap_u = Wrap::Clamp;
    within.wrap_v = Wrap::Clamp;
    const FaceSample point = face_sample(direction);
    return sample_texture(cube, within, dvec3(point.uv, (point.face + 0.5) / 6), level);
}

double compare_depth(const dvec4& texel, double reference) {
    return reference <= texel.x ? 1 : 0;
}

}  // namespace limn::oracle
