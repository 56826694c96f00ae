#include "content/make/patterns/puff_pattern.h"

#include "content/make/patterns/pattern_tools.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace limn {
namespace {

constexpr int kMaxGridSide = 64;

struct Side {
    std::size_t axis;
    bool from_end;  ///< light comes from the positive end of the axis
};
/// Right, above, behind; left, below, toward the viewer.
constexpr std::array<Side, 6> kSides = {Side{0, true}, {1, true},  {2, false},
                                        {0, false},    {1, false}, {2, true}};

/// A pixel of a frame.
struct PuffPixel {
    float opacity = 0;
    std::array<float, 6> light{};  ///< mean light scattered from each side
};

struct PuffFrame {
    int side = 0;
    std::vector<PuffPixel> pixels;  ///< rows from the top
};

/// Relative density at p, -1 .. 1 along each axis; y is up, z toward the viewer.
float density_at(const PuffPattern& pattern, const Vec3& p, float time) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float radius = 0.62f + 0.12f * std::sqrt(time);
    const float lump = pattern.lumps * radius;
    const float inside = radius - glm::length(p);
    constexpr float kRim = 0.24f;  // over which the density rises
    if (inside < -lump || inside > lump + kRim + pattern.fray) {
        return inside < 0 ? 0.0f : 1.0f;
    }
    const Vec3 q = p / radius - time * Vec3(0.1f, 0.35f, 0.5f);
    const float bend = noise(1.3f * q, seed, 1) - 0.5f;
    const Vec3 bent = q + 0.5f * bend;
    // Creases between round lumps: the noise is folded at its zero crossings. Most points are
    // decided before the finest lumps and the fray, whose weights bound them, are evaluated.
    const float max_fray = 0.5f * pattern.fray * time;
    float depth = inside;
    float weight = 0.6f;
    float rest = 1.125f;  // sum of the remaining weights
    float frequency = 1.6f;
    for (std::uint32_t octave = 1; octave <= 4; ++octave) {
        const float n = gradient_noise(frequency * bent, seed + octave);
        depth += lump * weight * (2.0f * std::sqrt(std::min(1.8f * std::abs(n), 1.0f)) - 1.0f);
        rest -= weight;
        if (depth + lump * rest < 0 || depth - lump * rest - max_fray > kRim) {
            return depth < 0 ? 0.0f : 1.0f;
        }
        weight *= 0.5f;
        frequency *= 2.1f;
    }
    const float frayed = max_fray > 0 ? max_fray * noise(3.1f * q, seed + 9, 3) : 0.0f;
    return glm::smoothstep(0.0f, kRim, depth - frayed);
}

/// Light transmitted through an optical depth, over all orders of scattering: each order is
/// fainter and penetrates farther (Wrenninge et al., "Oz: The Great and Volumetric", 2013).
float light_through(float depth) {
    float sum = 0;
    float weight = 1;
    float extinction = 1;
    for (int order = 0; order < 4; ++order) {
        sum += weight * std::exp(-extinction * depth);
        weight *= 0.75f;
        extinction *= 0.3f;
    }
    return sum;
}

PuffFrame make_frame(const PuffPattern& pattern, int side, float time) {
    const auto n = static_cast<std::size_t>(side);
    const std::array<std::size_t, 3> stride = {1, n, n * n};
    const float cell = 2.0f / static_cast<float>(side);
    const auto cell_center = [&](std::size_t i) {
        return (static_cast<float>(i) + 0.5f) * cell - 1.0f;
    };
    std::vector<float> depths(n * n * n);  // optical depth of each cell along an axis
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const Vec3 p = {cell_center(i % n), cell_center(i / n % n), cell_center(i / (n * n))};
        depths[i] = cell * pattern.density * density_at(pattern, p, time);
    }

    PuffFrame frame = {side, std::vector<PuffPixel>(n * n)};
    const auto pixel_of = [&](std::size_t i) -> PuffPixel& {
        return frame.pixels[(n - 1 - i / n % n) * n + i % n];
    };
    std::vector<float> coverage(depths.size());      // fraction of its pixel that a cell covers
    for (std::size_t i = depths.size(); i-- > 0;) {  // from the viewer
        PuffPixel& pixel = pixel_of(i);
        coverage[i] = (1 - pixel.opacity) * (1 - std::exp(-depths[i]));
        pixel.opacity += coverage[i];
    }
    for (std::size_t s = 0; s < kSides.size(); ++s) {
        const auto [axis, from_end] = kSides[s];
        const std::size_t b = (axis + 1) % 3;
        const std::size_t c = (axis + 2) % 3;
        for (std::size_t line = 0; line < n * n; ++line) {
            float before = 0;
            for (std::size_t k = 0; k < n; ++k) {
                const std::size_t along = from_end ? n - 1 - k : k;
                const std::size_t i =
                    along * stride[axis] + line % n * stride[b] + line / n * stride[c];
                if (coverage[i] > 0) {
                    pixel_of(i).light[s] += coverage[i] * light_through(before + 0.5f * depths[i]);
                }
                before += depths[i];
            }
        }
    }
    for (PuffPixel& pixel : frame.pixels) {
        for (float& light : pixel.light) {
            light = pixel.opacity > 1e-4f ? light / pixel.opacity : light_through(0);
        }
    }
    return frame;
}

/// The factor that makes the brightest pixel white under uniform light: a
/// light counts by the square of its cosine to a side, two thirds of its irradiance over all sides.
float white_scale(const std::vector<PuffFrame>& film) {
    float brightest = 0;
    for (const PuffFrame& frame : film) {
        for (const PuffPixel& pixel : frame.pixels) {
            const float sum = std::accumulate(pixel.light.begin(), pixel.light.end(), 0.0f);
            brightest = std::max(brightest, pixel.opacity > 0.5f ? sum : 0.0f);
        }
    }
    return 1.5f / brightest;
}

/// Bilinear.
PuffPixel sample(const PuffFrame& frame, const Vec2& uv) {
    const Vec2 position = glm::clamp(
        uv * static_cast<float>(frame.side) - 0.5f, Vec2(0.0f),
        Vec2(static_cast<float>(frame.side - 1)));
    const IVec2 first = glm::min(IVec2(position), IVec2(frame.side - 2));
    const Vec2 f = position - Vec2(first);
    PuffPixel mixed;
    for (int corner = 0; corner < 4; ++corner) {
        const int dx = corner % 2;
        const int dy = corner / 2;
        const float weight = (dx == 1 ? f.x : 1 - f.x) * (dy == 1 ? f.y : 1 - f.y);
        const PuffPixel& pixel =
            frame.pixels[static_cast<std::size_t>((first.y + dy) * frame.side + first.x + dx)];
        mixed.opacity += weight * pixel.opacity;
        for (std::size_t s = 0; s < pixel.light.size(); ++s) {
            mixed.light[s] += weight * pixel.light[s];
        }
    }
    return mixed;
}

}  // namespace

PatternMaps make_puff(const PuffPattern& pattern) {
    const int frames = std::max(pattern.frames, 1);
    const int side = std::clamp(pattern.image.size / frames, 4, kMaxGridSide);
    std::vector<PuffFrame> film(static_cast<std::size_t>(frames * frames));
    parallel_for(film.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto last = static_cast<float>(std::max(film.size() - 1, std::size_t{1}));
            film[i] = make_frame(pattern, side, static_cast<float>(i) / last);
        }
    });
    const float scale = white_scale(film);
    const auto render = [&](auto&& texel) {
        return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
            const Vec2 position = uv * static_cast<float>(frames);
            const Vec2 cell = glm::min(glm::floor(position), Vec2(static_cast<float>(frames - 1)));
            const auto number = static_cast<std::size_t>(cell.y) * static_cast<std::size_t>(frames)
                                + static_cast<std::size_t>(cell.x);
            return texel(sample(film[number], position - cell), position - cell);
        });
    };
    PatternMaps maps = render([](const PuffPixel& pixel, const Vec2& at) {
        const float edge = 2.0f * std::max(std::abs(at.x - 0.5f), std::abs(at.y - 0.5f));
        PatternTexel t;
        t.color = {1, 1, 1};
        t.opacity = pixel.opacity * glm::smoothstep(0.97f, 0.88f, edge);
        return t;
    });
    // Occlusion, roughness and metalness are the channels of a linear image.
    const auto light_map = [&](std::size_t first) {
        return render([&](const PuffPixel& pixel, const Vec2&) {
                   PatternTexel t;
                   t.occlusion = scale * pixel.light[first];
                   t.roughness = scale * pixel.light[first + 1];
                   t.metalness = scale * pixel.light[first + 2];
                   return t;
               })
            .orm;
    };
    maps.positive_light = light_map(0);
    maps.negative_light = light_map(3);
    for (std::size_t alpha = 3; alpha < maps.base_color.pixels.size(); alpha += 4) {
        maps.positive_light.pixels[alpha] = maps.base_color.pixels[alpha];
        maps.negative_light.pixels[alpha] = 0;  // no emission
    }
    return maps;
}

}  // namespace limn
