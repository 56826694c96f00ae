#include "content/make/patterns/sprite_patterns.h"

#include "content/make/patterns/flipbook.h"
#include "content/make/patterns/pattern_tools.h"
#include "content/make/patterns/sprite_fluid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

// Techniques: particle.motion-vectors

namespace limn {
namespace {

/// Noise that changes with time: two layers that drift apart.
float moving_noise(const Vec2& p, const Vec2& drift, std::uint32_t seed, int octaves) {
    return 0.6f
           * (fbm(p + drift, seed, {0, 0}, octaves)
              + fbm(p - 0.7f * drift + 7.3f, seed + 50, {0, 0}, octaves));
}

// ---- from simulations --------------------------------------------------------------------------

constexpr int kMaxFluidSide = 128;
constexpr int kFluidSteps = 3;  // between frames

/// Color of soot by its heat, 0 .. 1: from dark red through orange to a yellowish white, as a black
/// body's between 800 and 2500 K.
Vec3 heat_color(float heat) {
    struct Key {
        float at;
        Vec3 color;
    };
    constexpr Key kKeys[] = {
        {0.0f, {0.16f, 0.005f, 0.0f}},
        {0.3f, {0.85f, 0.075f, 0.004f}},
        {0.55f, {1.0f, 0.30f, 0.03f}},
        {0.8f, {1.0f, 0.62f, 0.17f}},
        {1.0f, {1.0f, 0.88f, 0.55f}}};
    for (std::size_t i = 1; i < std::size(kKeys); ++i) {
        if (heat <= kKeys[i].at) {
            const float fraction = (heat - kKeys[i - 1].at) / (kKeys[i].at - kKeys[i - 1].at);
            return glm::mix(kKeys[i - 1].color, kKeys[i].color, std::max(fraction, 0.0f));
        }
    }
    return kKeys[std::size(kKeys) - 1].color;
}

float sample_field(const std::vector<float>& field, int side, const Vec2& at) {
    const Vec2 position = glm::clamp(
        at * static_cast<float>(side) - 0.5f, Vec2(0.0f), Vec2(static_cast<float>(side - 1)));
    const IVec2 cell = glm::min(IVec2(position), IVec2(side - 2));
    const Vec2 f = position - Vec2(cell);
    const float* const p = field.data() + static_cast<std::ptrdiff_t>(cell.y) * side + cell.x;
    return glm::mix(glm::mix(p[0], p[1], f.x), glm::mix(p[side], p[side + 1], f.x), f.y);
}

struct FluidFrame {
    std::vector<float> heat;
    std::vector<float> soot;
    std::vector<float> right, up;  ///< displacement until the next frame [sides]
};

FluidFrame frame_of(const FluidGrid& fluid) {
    const std::vector<float> nothing(fluid.u.size(), 0.0f);
    return {fluid.heat, fluid.soot, nothing, nothing};
}

/// Adds the displacement of a step.
void add_motion(const FluidGrid& fluid, float dt, FluidFrame& frame) {
    for (std::size_t i = 0; i < fluid.u.size(); ++i) {
        frame.right[i] += dt * fluid.u[i];
        frame.up[i] += dt * fluid.v[i];
    }
}

/// As a byte of a motion map, 0 .. 1.
float encode_motion(float fraction) {
    return (128.0f + 127.0f * std::clamp(fraction / kMotionRange, -1.0f, 1.0f)) / 255.0f;
}

/// `texel(heat, soot, frame point)`, bilinear between the cells of the frame.
template <typename Texel>
PatternMaps render_frames(
    const PatternSize& image, int frames, int side, const std::vector<FluidFrame>& film,
    Texel&& texel) {
    const float count = static_cast<float>(frames);
    const auto render = [&](auto&& evaluate) {
        return make_pattern_maps(image.size, [&](const Vec2& uv) {
            const Vec2 cell = glm::min(glm::floor(uv * count), Vec2(count - 1.0f));
            const Vec2 inside = uv * count - cell;
            const auto number = static_cast<std::size_t>(cell.y * count + cell.x);
            return evaluate(film[number], Vec2(inside.x, 1.0f - inside.y));
        });
    };
    PatternMaps maps = render([&](const FluidFrame& frame, const Vec2& at) {
        const float edge = 2.0f * std::max(std::abs(at.x - 0.5f), std::abs(at.y - 0.5f));
        PatternTexel t =
            texel(sample_field(frame.heat, side, at), sample_field(frame.soot, side, at), at);
        t.opacity = std::clamp(t.opacity, 0.0f, 1.0f) * glm::smoothstep(0.97f, 0.88f, edge);
        return t;
    });
    // Occlusion and roughness stand for the first channels of a linear image.
    maps.motion = render([&](const FluidFrame& frame, const Vec2& at) {
                      PatternTexel t;
                      t.occlusion = encode_motion(sample_field(frame.right, side, at));
                      t.roughness = encode_motion(-sample_field(frame.up, side, at));
                      return t;
                  }).orm;
    return maps;
}

int fluid_side(const PatternSize& image, int frames) {
    return std::clamp(image.size / std::max(frames, 1), 8, kMaxFluidSide);
}

/// The source at the foot of the frame: flickering heat, and an inflow from the sides.
void heat_foot(const FirePattern& pattern, float time, float dt, FluidGrid& fluid) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int side = fluid.side;
    for (int y = 1; y < side / 8 + 2; ++y) {
        for (int x = 1; x + 1 < side; ++x) {
            const Vec2 at = (Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f)
                            / static_cast<float>(side);
            const float away = std::abs(at.x - 0.5f) / (0.5f * pattern.width);
            const float high = at.y / 0.09f;
            const float body = glm::smoothstep(1.0f, 0.5f, away * away + high * high * 0.6f);
            const float flicker =
                0.85f + 1.1f * fbm(Vec2(at.x * 9.0f, time * 5.0f), seed, {0, 0}, 3);
            const std::size_t cell = fluid.at(x, y);
            fluid.heat[cell] = std::max(fluid.heat[cell], body * std::clamp(flicker, 0.0f, 1.1f));
            fluid.u[cell] +=
                body * 6.0f * dt * fbm(Vec2(time * 2.5f, at.x * 5.0f), seed + 77, {0, 0}, 2);
        }
    }
}

/// Cross-fades frames [count, count + overlap), beyond the last, into the first ones.
void close_loop(std::vector<FluidFrame>& film, int count, int overlap) {
    for (int i = 0; i < overlap; ++i) {
        const float fraction =
            (static_cast<float>(i) + 1.0f) / (static_cast<float>(overlap) + 1.0f);
        const auto first = static_cast<std::size_t>(i);
        const FluidFrame& late = film[first + static_cast<std::size_t>(count)];
        FluidFrame& early = film[first];
        for (const auto field : {&FluidFrame::heat, &FluidFrame::right, &FluidFrame::up}) {
            for (std::size_t cell = 0; cell < early.heat.size(); ++cell) {
                (early.*field)[cell] =
                    glm::mix((late.*field)[cell], (early.*field)[cell], fraction);
            }
        }
    }
}

}  // namespace

PatternMaps make_fire(const FirePattern& pattern) {
    const int side = fluid_side(pattern.image, pattern.frames);
    const int count = pattern.frames * pattern.frames;
    const int overlap = std::max(count / 4, 1);  // frames that blend into the beginning of the loop
    constexpr int kWarmUp = 70;                  // steps
    FluidGrid fluid = make_fluid(side);
    FluidStep step;
    step.rise = pattern.rise;
    step.cooling = pattern.cooling;
    step.whirls = pattern.whirls;
    step.drag = 1.0f;
    std::vector<FluidFrame> film;
    for (int i = 0; i < kWarmUp + (count + overlap + 1) * kFluidSteps; ++i) {
        heat_foot(pattern, static_cast<float>(i) * step.dt, step.dt, fluid);
        step_fluid(fluid, step);
        if (!film.empty()) {
            add_motion(fluid, step.dt, film.back());
        }
        if (i >= kWarmUp && (i - kWarmUp) % kFluidSteps == kFluidSteps - 1) {
            film.push_back(frame_of(fluid));
        }
    }
    close_loop(film, count, overlap);
    for (FluidFrame& frame : film) {
        frame.soot = frame.heat;
    }
    return render_frames(
        pattern.image, pattern.frames, side, film, [](float heat, float, const Vec2&) {
            PatternTexel t;
            t.color = heat_color(1.25f * heat);
            t.opacity = glm::smoothstep(0.04f, 0.42f, heat);
            return t;
        });
}

PatternMaps make_fireball(const FireballPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int side = fluid_side(pattern.image, pattern.frames);
    const int count = pattern.frames * pattern.frames;
    FluidGrid fluid = make_fluid(side);
    FluidStep step;
    constexpr float kStir = 0.09f;  // [sides^2/s]
    step.dt = 1.0f / 90;
    step.rise = 3.5f;
    step.cooling = pattern.cooling;
    step.whirls = pattern.whirls;
    step.expansion = pattern.burst;
    step.drag = 2.5f;
    step.has_floor = false;
    for (int y = 1; y + 1 < side; ++y) {
        for (int x = 1; x + 1 < side; ++x) {
            const Vec2 at = (Vec2(static_cast<float>(x), static_cast<float>(y)) + 0.5f)
                            / static_cast<float>(side);
            const Vec2 out = at - Vec2(0.5f, 0.46f);
            const float lumps = fbm(9.0f * at, seed, {0, 0}, 4);
            const float away = glm::length(out) * (1.0f - 0.9f * lumps);
            const std::size_t cell = fluid.at(x, y);
            const float body = glm::smoothstep(0.16f, 0.06f, away);
            fluid.heat[cell] = body * (1.0f + 1.2f * fbm(12.0f * at, seed + 9, {0, 0}, 3));
            fluid.soot[cell] = body;
            // Divergence-free vortices: the curl of noise.
            const auto stream = [&](const Vec2& p) { return fbm(10.0f * p, seed + 30, {0, 0}, 3); };
            constexpr float kStep = 0.01f;
            const float here = stream(at);
            fluid.u[cell] = kStir * (stream(at + Vec2(0, kStep)) - here) / kStep;
            fluid.v[cell] = -kStir * (stream(at + Vec2(kStep, 0)) - here) / kStep;
        }
    }
    std::vector<FluidFrame> film;
    for (int i = 0; i < count; ++i) {
        film.push_back(frame_of(fluid));
        for (int k = 0; k < kFluidSteps + i / 3; ++k) {  // fast at first
            step_fluid(fluid, step);
            add_motion(fluid, step.dt, film.back());
            step.expansion *= 0.8f;
        }
    }
    return render_frames(
        pattern.image, pattern.frames, side, film, [](float heat, float soot, const Vec2&) {
            PatternTexel t;
            t.color = heat_color(1.3f * heat) * glm::smoothstep(0.0f, 0.25f, heat);
            t.opacity = glm::smoothstep(0.02f, 0.3f, soot);
            return t;
        });
}

PatternMaps make_smoke(const SmokePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const auto plain = [&](const FramePoint& at) {
        const Vec2 drift = at.time * Vec2(0.5f, -0.8f);
        const Vec2 warp = {
            moving_noise(1.4f * at.p, drift, seed, 4),
            moving_noise(1.4f * at.p + 31.0f, drift, seed, 4)};
        const float radius = glm::length(at.p + 0.45f * warp);
        const float body = glm::smoothstep(0.95f, 0.1f, radius);
        const float billows = moving_noise(2.6f * (at.p + 0.5f * warp), drift, seed + 200, 5);
        const float frayed =
            glm::smoothstep(-0.55f + 0.3f * at.time, 0.65f, billows + 0.6f * body - 0.25f);
        return body * glm::mix(1.0f, frayed * 1.3f, pattern.detail);
    };
    if (pattern.billow <= 0) {
        return make_flipbook(pattern.image, pattern.frames, plain);
    }
    // Depth toward the viewer: lumps on lumps, each a dent turned outward (cell noise).
    const auto depth = [&](const FramePoint& at) {
        const Vec2 drift = at.time * Vec2(0.35f, -0.55f);
        const Vec2 warp = {
            moving_noise(1.2f * at.p, drift, seed, 3),
            moving_noise(1.2f * at.p + 31.0f, drift, seed, 3)};
        const Vec2 p = at.p + 0.13f * warp;
        const float ball = 1.2f - 1.2f * glm::dot(p, p) / square(0.72f + 0.06f * at.time);
        const float large = 0.6f - square(cell_noise(2.6f * p + drift, seed + 400, 0.8f).nearest);
        const float small =
            0.6f - square(cell_noise(5.7f * p + 1.4f * drift, seed + 500, 0.8f).nearest);
        const float fine = fbm(9.0f * p - drift, seed + 600, {0, 0}, 3);
        return ball + pattern.billow * (0.8f * large + 0.3f * small + 0.1f * fine - 0.2f);
    };
    return make_shaded_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        constexpr float kStep = 0.03f;
        const float here = depth(at);
        const float right = depth({at.p + Vec2(kStep, 0), at.time});
        const float above = depth({at.p + Vec2(0, kStep), at.time});
        const Vec3 normal = glm::normalize(Vec3(here - right, here - above, 2.2f * kStep));
        const float lit = glm::dot(normal, glm::normalize(Vec3(-0.25f, 0.85f, 0.45f)));
        const float light = glm::mix(1.0f, 0.5f + 0.5f * lit, pattern.shade);
        PatternTexel t;
        t.color = Vec3(std::clamp(light, 0.0f, 1.0f));
        const float frayed = glm::mix(1.0f, plain(at), pattern.detail);
        t.opacity = glm::smoothstep(-0.05f, 0.5f, here) * frayed;
        return t;
    });
}

PatternMaps make_flame(const FlamePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const Vec2 rise = at.time * Vec2(0.15f, -2.2f);
        const float height = 0.5f * (at.p.y + 1.0f);
        const float sway = moving_noise(Vec2(0.9f, 1.3f) * at.p, rise, seed, 3);
        const float lick = moving_noise(Vec2(2.4f, 1.7f) * at.p, 1.3f * rise, seed + 200, 4);
        const float x = at.p.x + pattern.sway * height * sway;
        // Widest at a quarter of the height, a point at the top.
        const float width = 0.62f * std::pow(std::max(1.0f - height, 0.0f), 0.75f)
                            * glm::smoothstep(-0.02f, 0.3f, height);
        const float body = glm::smoothstep(1.0f, 0.15f, std::abs(x) / std::max(width, 1e-3f));
        const float torn =
            glm::smoothstep(-0.5f, 0.45f, lick + 0.55f - 0.9f * height * (0.6f + 0.6f * at.time));
        return body * glm::mix(1.0f, torn, pattern.detail);
    });
}

// ---- single things, one in each frame ----------------------------------------------------------

namespace {

float length_of(const Vec2& p) {
    return glm::length(p);
}

/// Folds the point into the wedge along +x, of twelve mirrored wedges around the center.
Vec2 fold_sixfold(Vec2 p) {
    p = glm::abs(p);
    constexpr Vec2 kNormal = {0.5f, -0.8660254f};  // of the line at 30 degrees
    const float beyond = std::min(glm::dot(p, kNormal), 0.0f);
    p -= 2.0f * beyond * kNormal;
    p.y = std::abs(p.y);
    return p;
}

}  // namespace

PatternMaps make_leaf(const LeafPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    const float soft = 3.0f * static_cast<float>(frames) / static_cast<float>(pattern.image.size);
    return make_shaded_flipbook(pattern.image, frames, [&](const FramePoint& at) {
        const auto random = [&](std::uint32_t i) { return frame_random(at, frames, seed, i); };
        const float slim = 0.30f + 0.22f * random(0);
        const float bend = 0.5f * (random(1) - 0.5f);
        const float along = (at.p.y + 0.62f) / 1.4f;  // 0 at the foot, 1 at the tip
        const float side = at.p.x - bend * (at.p.y * at.p.y - 0.3f);
        // Widest at two fifths, with a pointed tip and teeth.
        const float u = std::clamp(along, 0.0f, 1.0f);
        const float teeth = 0.03f * std::abs(2.0f * (14.0f * u - std::floor(14.0f * u)) - 1.0f);
        const float width = slim * 2.9f * std::sqrt(u) * (1.0f - u) * (0.75f + 0.4f * u) - teeth;
        const float blade =
            along > 0 && along < 1 ? glm::smoothstep(soft, -soft, std::abs(side) - width) : 0.0f;
        const float stalk = at.p.y < -0.5f && at.p.y > -0.88f
                                ? glm::smoothstep(0.035f + soft, 0.02f, std::abs(side))
                                : 0.0f;
        const float rib = glm::smoothstep(0.03f + soft, 0.0f, std::abs(side));
        const float run = 8.0f * (u - 0.55f * std::abs(side));
        const float vein =
            glm::smoothstep(0.85f, 1.0f, std::abs(2.0f * (run - std::floor(run)) - 1.0f));
        const float spots = fbm(6.0f * at.p + 10.0f * random(5), seed + 3, {0, 0}, 4);
        const Vec3 warm = glm::mix(pattern.color, pattern.second_color, random(2));
        Vec3 color = warm * (0.85f + 0.3f * random(3)) * (1.0f + 0.5f * spots);
        color =
            glm::mix(color, pattern.second_color * 0.5f, glm::smoothstep(0.1f, 0.5f, spots) * 0.5f);
        color = glm::mix(color, color * 1.45f, std::max(rib, 0.5f * vein));
        const bool is_near = std::abs(side) < width + 4.0f * soft;
        color *= at.p.x < 0 && is_near ? 0.82f : 1.0f;  // folded along the rib
        PatternTexel t;
        t.color = glm::clamp(color, Vec3(0), Vec3(1));
        t.opacity = std::max(blade, stalk);
        return t;
    });
}

namespace {

/// A clump of leaves: a sphere in front of the image plane.
struct LeafClump {
    Vec3 center;
    float radius;
};

struct TreeForm {
    std::vector<LeafClump> clumps;
    Vec2 crown;  ///< its center
    Vec2 extent;
};

TreeForm grow_tree(const TreePattern& pattern, std::uint32_t number) {
    const auto random = [&](std::uint32_t i) {
        return frame_random({{}, 0}, 1, seed_of(pattern.image) + 977u * number + 13u * i, i);
    };
    TreeForm tree;
    const float slim = pattern.slimness;
    tree.extent = {0.66f - 0.42f * slim + 0.08f * random(0), 0.60f + 0.08f * slim};
    tree.crown = {0.06f * (random(1) - 0.5f), 0.20f};
    constexpr std::uint32_t kClumps = 90;
    for (std::uint32_t i = 0; i < kClumps; ++i) {
        const float z = 2.0f * random(4 * i + 2) - 1.0f;
        const float angle = 2.0f * kPi * random(4 * i + 3);
        const float ring = std::sqrt(1.0f - z * z);
        const float away = std::cbrt(0.25f + 0.75f * random(4 * i + 4));
        const Vec3 unit = away * Vec3(ring * std::cos(angle), ring * std::sin(angle), z);
        const float widest = 1.0f - 0.25f * unit.y;  // narrower at the top
        const Vec2 position = tree.crown + 0.8f * tree.extent * Vec2(unit.x * widest, unit.y);
        const float radius = (0.13f + 0.10f * random(4 * i + 5)) * (1.0f - 0.35f * slim);
        tree.clumps.push_back({{position, 0.8f * tree.extent.x * unit.z}, radius});
    }
    return tree;
}

/// Trunk and boughs: depth of `p` inside them, in units of the image; negative outside.
float bark_depth(const TreeForm& tree, const Vec2& p) {
    const float wobble = 0.02f * std::sin(7.0f * p.y);
    const float up = std::clamp((p.y + 1.0f) / 1.3f, 0.0f, 1.0f);
    const float flare = 0.05f * glm::smoothstep(0.25f, 0.0f, up);
    float depth =
        p.y < 0.3f ? 0.055f * (1.0f - 0.75f * up) + flare - std::abs(p.x - wobble) : -1.0f;
    for (std::size_t i = 0; i < tree.clumps.size(); i += 6) {
        const Vec2 end = Vec2(tree.clumps[i].center);
        const Vec2 foot = {0.01f, std::min(-0.45f + 0.5f * (end.y + 0.4f), end.y - 0.1f)};
        depth = std::max(depth, 0.014f - line_distance(p, foot, end));
    }
    return depth;
}

}  // namespace

PatternMaps make_tree(const TreePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    const float texel = 2.0f * static_cast<float>(frames) / static_cast<float>(pattern.image.size);
    std::vector<TreeForm> trees;
    for (int i = 0; i < frames * frames; ++i) {
        trees.push_back(grow_tree(pattern, static_cast<std::uint32_t>(i)));
    }
    const Vec3 sun = glm::normalize(Vec3(-0.45f, 0.75f, 0.5f));
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 cell = glm::floor(uv * static_cast<float>(frames));
        const Vec2 inside = 2.0f * (uv * static_cast<float>(frames) - cell) - 1.0f;
        const Vec2 p = {inside.x, -inside.y};
        const auto number = static_cast<std::uint32_t>(cell.y) * static_cast<std::uint32_t>(frames)
                            + static_cast<std::uint32_t>(cell.x);
        const TreeForm& tree = trees[number % trees.size()];
        const Vec2 q = p + 10.0f * Vec2(cell);
        // Twigs shift the rims of clumps, leaves break them up.
        const Vec2 shift = {
            fbm(9.0f * q, seed + 1, {0, 0}, 3), fbm(9.0f * q + 31.0f, seed + 2, {0, 0}, 3)};
        const float leaf = fbm(34.0f * q, seed + 3, {0, 0}, 2);
        const Vec2 moved = p + 0.05f * shift;
        float front = -10.0f;
        float cover = 0;
        Vec3 normal(0, 0, 1);
        for (const LeafClump& clump : tree.clumps) {
            const Vec2 offset = (moved - Vec2(clump.center)) / clump.radius;
            const float inward =
                1.0f - glm::dot(offset, offset) + 1.3f * pattern.gaps * (leaf - 0.05f);
            if (inward <= 0) {
                continue;
            }
            const float z = std::sqrt(std::max(1.0f - glm::dot(offset, offset), 0.0f));
            const float depth = clump.center.z + clump.radius * z + 0.05f * leaf;
            cover = std::max(cover, glm::smoothstep(0.0f, 0.08f + 3.0f * texel, inward));
            if (depth > front) {
                front = depth;
                normal = Vec3(offset, z);
            }
        }
        const Vec2 in_crown = (p - tree.crown) / tree.extent;
        const Vec3 leaning =
            glm::normalize(normal + 1.1f * Vec3(in_crown, 0.4f) + 0.9f * Vec3(shift, 0));
        const float lit = glm::smoothstep(-0.5f, 1.0f, glm::dot(leaning, sun));
        const float buried = glm::smoothstep(-0.5f, 0.35f, front / std::max(tree.extent.x, 0.1f));
        const float shade =
            (0.16f + 0.84f * lit * lit) * (0.4f + 0.6f * buried) * (1.0f + 0.9f * leaf);
        const Vec3 warm = pattern.color * Vec3(1.35f, 1.1f, 0.7f);
        Vec3 color = glm::mix(pattern.color, warm, std::clamp(0.5f + 0.8f * shift.x, 0.0f, 1.0f))
                     * shade * 1.5f;
        float opacity = cover;
        const float bark = bark_depth(tree, p);
        const float trunk = glm::smoothstep(0.0f, 1.5f * texel, bark);
        if (front < 0.1f || cover <= 0) {
            const float ridges = 1.0f + 1.2f * fbm({40.0f * q.x, 7.0f * q.y}, seed + 5, {0, 0}, 3);
            const float round = std::clamp(0.75f - 6.0f * (p.x + 0.02f), 0.3f, 1.2f);
            const float under = glm::smoothstep(0.1f, -0.6f, p.y) * 0.7f + 0.3f;
            color = glm::mix(color, pattern.bark_color * ridges * round * under, trunk);
            opacity = std::max(opacity, trunk);
        }
        const float edge = std::max(std::abs(p.x), std::abs(p.y));
        PatternTexel t;
        t.color = glm::clamp(color, Vec3(0), Vec3(1));
        t.opacity = opacity * glm::smoothstep(0.97f, 0.93f, edge);
        return t;
    });
}

PatternMaps make_confetti(const ConfettiPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    const float soft = 3.0f * static_cast<float>(frames) / static_cast<float>(pattern.image.size);
    constexpr Vec3 kColors[] = {{0.85f, 0.02f, 0.05f}, {0.95f, 0.28f, 0.01f}, {0.95f, 0.68f, 0.02f},
                                {0.05f, 0.55f, 0.08f}, {0.01f, 0.33f, 0.80f}, {0.35f, 0.05f, 0.70f},
                                {0.90f, 0.08f, 0.42f}, {0.02f, 0.60f, 0.60f}};
    return make_shaded_flipbook(pattern.image, frames, [&](const FramePoint& at) {
        const auto random = [&](std::uint32_t i) { return frame_random(at, frames, seed, i); };
        const std::uint32_t number = frame_number(at, frames);
        const Vec2 half = {0.35f + 0.2f * random(0), 0.55f + 0.15f * random(1)};
        const Vec2 beyond = glm::max(glm::abs(at.p) - half, Vec2(0));
        const float fold = 0.12f * (random(2) - 0.5f) + 0.1f * at.p.x;
        PatternTexel t;
        t.color = glm::clamp(
            kColors[number % std::size(kColors)] * (at.p.y > fold ? 1.0f : 0.72f), Vec3(0),
            Vec3(1));
        t.opacity = glm::smoothstep(soft, 0.0f, length_of(beyond));
        return t;
    });
}

PatternMaps make_snowflake(const SnowflakePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    const float soft = 2.5f * static_cast<float>(frames) / static_cast<float>(pattern.image.size);
    return make_flipbook(pattern.image, frames, [&](const FramePoint& at) {
        const auto random = [&](std::uint32_t i) { return frame_random(at, frames, seed, i); };
        const float away = length_of(at.p);
        const Vec2 p = fold_sixfold(at.p);
        const float thick = 0.035f + 0.02f * random(0);
        float nearest = line_distance(p, {0, 0}, {0.8f, 0}) - thick;
        for (std::uint32_t i = 0; i < 4; ++i) {  // side branches, at 60 degrees
            const float from = 0.16f + 0.17f * static_cast<float>(i) + 0.08f * random(1 + i);
            const float branch = (0.10f + 0.22f * random(6 + i)) * (1.0f - 0.6f * from);
            const Vec2 foot = {from, 0};
            nearest = std::min(
                nearest,
                line_distance(p, foot, foot + branch * Vec2(0.5f, 0.866f)) - 0.75f * thick);
        }
        const float core = away - 0.10f - 0.12f * random(11);
        nearest = std::min(nearest, core);
        const float crystal = glm::smoothstep(soft + 0.03f, -soft, nearest);
        const float halo = 0.35f * glm::smoothstep(0.85f, 0.0f, away);
        return std::max(crystal, halo * halo * 1.6f);
    });
}

PatternMaps make_shard(const ShardPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    const float soft = 2.5f * static_cast<float>(frames) / static_cast<float>(pattern.image.size);
    return make_shaded_flipbook(pattern.image, frames, [&](const FramePoint& at) {
        const auto random = [&](std::uint32_t i) { return frame_random(at, frames, seed, i); };
        // A polygon bounded by six lines, with facets that meet at an off-center point.
        const Vec2 peak = 0.3f * Vec2(random(30) - 0.5f, random(31) - 0.5f);
        float outside = -1;
        float facet = -1;
        float light = 0.5f;
        for (std::uint32_t i = 0; i < 6; ++i) {
            Vec2 normal = {2.0f * random(3 * i) - 1.0f, 2.0f * random(3 * i + 1) - 1.0f};
            constexpr Vec2 kAround[] = {{1, 0},  {0.5f, 0.87f},   {-0.5f, 0.87f},
                                        {-1, 0}, {-0.5f, -0.87f}, {0.5f, -0.87f}};
            normal = glm::normalize(normal * 0.55f + kAround[i]);
            const float radius = 0.36f + 0.34f * random(3 * i + 2);
            outside = std::max(outside, glm::dot(at.p, normal) - radius);
            const float height = glm::dot(at.p - peak, normal) / radius;
            if (height > facet) {
                facet = height;
                light = 0.62f + 0.38f * normal.y - 0.15f * normal.x;
            }
        }
        const float rough = 0.06f * fbm(7.0f * at.p + 9.0f * random(40), seed, {0, 0}, 3);
        const float grain = fbm(13.0f * at.p, seed + 7, {0, 0}, 3);
        PatternTexel t;
        t.color = glm::clamp(pattern.color * light * (1.0f + 0.5f * grain), Vec3(0), Vec3(1));
        t.opacity = glm::smoothstep(soft, -soft, outside + rough);
        return t;
    });
}

PatternMaps make_splash(const SplashPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int frames = pattern.frames;
    return make_shaded_flipbook(pattern.image, frames, [&](const FramePoint& at) {
        // Sheets that tear into threads and drops, which fly apart.
        const float spread = 0.5f + 0.5f * std::sqrt(at.time);
        const Vec2 warp = {
            fbm(2.2f * at.p, seed + 20, {0, 0}, 2), fbm(2.2f * at.p + 9.0f, seed + 20, {0, 0}, 2)};
        const float away = length_of(at.p) / spread;
        const Vec2 p = at.p / spread;
        const float sheet_noise = fbm(2.6f * (p + 0.5f * warp), seed + 9, {0, 0}, 4);
        const float sheet = glm::smoothstep(
            0.02f + 0.4f * at.time, 0.22f + 0.4f * at.time, 0.75f - away + 0.9f * sheet_noise);
        float drops = 0;
        for (const float cells : {3.2f, 6.1f}) {
            const CellSample drop = cell_noise(
                cells * (p + 0.2f * warp), seed + static_cast<std::uint32_t>(cells * 10), 0.9f);
            const float size = 0.10f + 0.2f * static_cast<float>(drop.cell & 255u) / 255.0f;
            drops = std::max(drops, glm::smoothstep(size, 0.4f * size, drop.nearest));
        }
        const float edge = glm::smoothstep(0.98f, 0.6f, away);
        PatternTexel t;
        t.color = Vec3(glm::mix(0.7f, 1.0f, std::max(drops, sheet * (0.5f + sheet_noise))));
        t.opacity = edge * std::max(drops * 0.9f, 0.7f * sheet * (1.0f - 0.5f * at.time));
        return t;
    });
}

PatternMaps make_ring(const RingPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_flipbook(pattern.image, pattern.frames, [&](const FramePoint& at) {
        const float away = length_of(at.p);
        // Rotating noise around the center, sampled on the unit circle to avoid a seam.
        const Vec2 around = at.p / std::max(away, 1e-3f);
        const float wisps = fbm(
            3.0f * around + Vec2(2.5f * away - 1.2f * at.time, 0.8f * at.time), seed, {0, 0}, 4);
        const float offset = (away - 0.72f - 0.10f * wisps) / std::max(pattern.width, 0.01f);
        const float ring = 1.0f / (1.0f + 9.0f * offset * offset);
        const float inner = offset < 0 ? 0.35f * glm::smoothstep(-3.0f, 0.0f, offset) : 0.0f;
        const float torn = glm::mix(1.0f, glm::smoothstep(-0.4f, 0.4f, wisps), pattern.detail);
        return (ring * torn + inner * torn * torn) * glm::smoothstep(0.98f, 0.8f, away);
    });
}

}  // namespace limn
