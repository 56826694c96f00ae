#include "content/make/patterns/masonry_patterns.h"

#include "content/make/patterns/pattern_tools.h"

#include <algorithm>
#include <cmath>

namespace limn {

namespace {

/// A block of a course.
struct CourseBlock {
    int column;
    float edge;  ///< distance to its ends, in blocks
};

/// `x` is in units of blocks; a course has `columns` of them. Joints are moved by up to a third of
/// a block, so blocks keep their order.
CourseBlock find_block(float x, int columns, int row, float irregular, std::uint32_t seed) {
    const auto joint = [&](int k) {
        const int own = (k % columns + columns) % columns;
        return static_cast<float>(k) + 0.66f * irregular * (lattice_random(own, row, seed) - 0.5f);
    };
    int k = static_cast<int>(std::floor(x));
    k += x < joint(k) ? -1 : (x >= joint(k + 1) ? 1 : 0);
    return {(k % columns + columns) % columns, std::min(x - joint(k), joint(k + 1) - x)};
}

/// 0 inside of a line of half width `half`, 1 outside; `soft` on either side.
float beside_line(float distance, float half, float soft) {
    return glm::smoothstep(half - soft, half + soft, std::abs(distance));
}

/// Distance to the convex hull of two circles at x = 0 (radius a) and x = h > |a - b| (radius b).
float capsule_distance(Vec2 p, float a, float b, float h) {
    p.y = std::abs(p.y);
    const float slope = (a - b) / h;
    const float rest = std::sqrt(1.0f - square(slope));
    const float foot = rest * p.x - slope * p.y;  // along the slanted side
    if (foot < 0) {
        return glm::length(p) - a;
    }
    if (foot > rest * h) {
        return glm::length(p - Vec2(h, 0)) - b;
    }
    return rest * p.y + slope * p.x - a;
}

/// Color of one piece of glass, and its transmittance at the lead.
struct Glass {
    Vec3 color = {0, 0, 0};
    float clear = 1;
    int number = 0;  ///< of the piece, seeds its tint
};

/// Layout of a rose window, in units of its radius.
struct RoseLayout {
    float half_sector;
    float bar;    ///< half the width of a bar
    float lead;   ///< half the width of the lead
    float pixel;  ///< width of soft edges
    float hub;
    float petal_begin;
    float petal_end;
    float begin_radius;
    float end_radius;
    float roundel_distance;
    float roundel_radius;
    float bead_distance;
    float bead_radius;
};

RoseLayout lay_out(const RoseWindowPattern& pattern) {
    RoseLayout rose{};
    rose.half_sector = kPi / static_cast<float>(pattern.petals);
    rose.bar = 2.0f * pattern.tracery;
    rose.lead = 0.5f * pattern.lead * rose.bar;
    rose.pixel = 2.0f / static_cast<float>(pattern.image.size);
    const float sine = std::sin(rose.half_sector);
    const float cosine = std::cos(rose.half_sector);
    // Petals touch their neighbors and the hub, roundels two petals and the rim.
    rose.petal_begin = 0.27f;
    rose.petal_end = 0.60f;
    rose.begin_radius = std::max(rose.petal_begin * sine - rose.bar, 0.01f);
    rose.end_radius = std::clamp(rose.petal_end * sine - rose.bar, 0.01f, 0.3f);
    rose.hub = std::max(rose.petal_begin - rose.begin_radius - 2.0f * rose.bar, 0.02f);
    rose.roundel_distance = 0.82f;
    const float gap = glm::length(
        Vec2(rose.roundel_distance * cosine - rose.petal_end, rose.roundel_distance * sine));
    rose.roundel_radius =
        std::clamp(gap - rose.end_radius - 2.0f * rose.bar, 0.01f, 0.98f - 2.0f * rose.bar - 0.82f);
    rose.bead_distance = 0.89f;
    rose.bead_radius = std::max(0.98f - rose.bead_distance - 2.0f * rose.bar, 0.01f);
    return rose;
}

/// `p`: along the axis of the petal and across it; `inside` > 0: depth in the petal.
Glass petal_glass(const RoseWindowPattern& pattern, const RoseLayout& rose, Vec2 p, float inside) {
    const float band = 0.035f;
    const float large = glm::length(p - Vec2(rose.petal_end - 0.01f, 0)) - 0.55f * rose.end_radius;
    const float small = glm::length(p - Vec2(0.40f, 0)) - 0.45f * rose.end_radius;
    const float medallion = std::min(large, small);
    const float slices = 14.0f * p.x;
    const int slice = static_cast<int>(std::floor(slices));
    const float cut = (0.5f - std::abs(slices - std::floor(slices) - 0.5f)) / 14.0f;
    Glass glass;
    glass.clear = beside_line(inside - band, rose.lead, rose.pixel)
                  * beside_line(medallion, rose.lead, rose.pixel);
    if (medallion < 0) {
        glass.color = medallion < -0.4f * rose.end_radius ? pattern.border : pattern.accent;
        glass.clear *= beside_line(medallion + 0.4f * rose.end_radius, rose.lead, rose.pixel);
        glass.number = large < 0 ? 1 : 2;
    } else {
        glass.color = inside < band ? pattern.border : pattern.field;
        glass.clear *= beside_line(cut, 0.7f * rose.lead, rose.pixel);
        glass.number = 4 + 4 * slice + (p.y > 0 ? 1 : 0) + (inside < band ? 2 : 0);
    }
    if (inside >= band && medallion >= 0) {
        glass.clear *= beside_line(p.y, 0.7f * rose.lead, rose.pixel);
    }
    return glass;
}

/// A round pane of radius `radius`, divided into `parts` sectors around its center.
Glass round_glass(
    const RoseLayout& rose, Vec2 p, float radius, int parts, const Vec3& outer, const Vec3& inner) {
    const float d = glm::length(p) - 0.45f * radius;
    const float turn = (std::atan2(p.y, p.x) / (2.0f * kPi) + 0.5f) * static_cast<float>(parts);
    const int part = static_cast<int>(std::floor(turn)) % parts;
    const float across = std::abs(turn - std::floor(turn + 0.5f)) * 2.0f * kPi * glm::length(p)
                         / static_cast<float>(parts);
    Glass glass;
    glass.color = d < 0 ? inner : outer;
    glass.number = d < 0 ? 900 : 901 + part;
    glass.clear = beside_line(d, rose.lead, rose.pixel);
    if (d >= 0) {
        glass.clear *= beside_line(across, 0.7f * rose.lead, rose.pixel);
    }
    return glass;
}

/// Distance to the nearest outline, and the part it belongs to.
struct Nearest {
    float distance = 1e9f;
    int part = 0;

    void take(float d, int number) {
        if (d < distance) {
            distance = d;
            part = number;
        }
    }
};

PatternTexel glass_texel(const Glass& glass, float open, float variation, std::uint32_t random) {
    PatternTexel t;
    t.color = glm::clamp(tinted(glass.color, variation, random), 0.0f, 1.0f) * (glass.clear * open);
    t.height = 0.004f * (1.0f - open) + 0.001f * (1.0f - glass.clear);
    t.roughness = glm::mix(0.75f, 0.14f, open * glass.clear);
    return t;
}

}  // namespace

PatternMaps make_ashlar(const AshlarPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int rows = even(pattern.rows);
    const int columns =
        std::max(1, static_cast<int>(std::lround(static_cast<float>(rows) / pattern.aspect)));
    const float block = static_cast<float>(rows) / static_cast<float>(columns);  // in heights
    const float height = 1.0f / static_cast<float>(rows);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 ragged = {fbm(uv, 6 * rows, seed + 40, 3), fbm(uv, 6 * rows, seed + 50, 3)};
        const Vec2 p = uv * Vec2(columns, rows) + 0.018f * Vec2(1.0f / block, 1.0f) * ragged;
        const int course = static_cast<int>(std::floor(p.y));
        const int row = (course % rows + rows) % rows;
        const float shift = 0.5f * static_cast<float>(row % 2)
                            + 0.3f * pattern.irregular * lattice_random(row, 7, seed);
        const CourseBlock found =
            find_block(p.x + shift, columns, row, pattern.irregular, seed + 1);
        const float local = p.y - static_cast<float>(course);
        const float edge = std::min(found.edge * block, std::min(local, 1.0f - local));
        const std::uint32_t random = lattice_hash(found.column, row, seed + 2);
        const float own = static_cast<float>(random & 255u) / 255.0f;

        const float half = 0.5f * pattern.joint;
        const float face = glm::smoothstep(half, half + 0.03f, edge);
        const float round = glm::smoothstep(half, half + glm::mix(0.09f, 0.3f, pattern.wear), edge);
        const float grain = fbm(uv, 14 * rows, seed + 10, 4, 0.7f);
        const float cloud = fbm(uv, rows, seed + 20, 4);
        const float stain = fbm(uv, 2, seed + 25, 5);
        // Chisel marks slant either way on each block.
        const int slant = own < 0.5f ? 1 : -1;
        const Vec2 strokes = uv * static_cast<float>(rows) * Vec2(7, 14);
        const float chisel =
            fbm({strokes.x + static_cast<float>(slant) * 0.5f * strokes.y, strokes.y}, seed + 30,
                {7 * rows, 14 * rows}, 2);
        const float rough = 1.0f - pattern.wear;
        const Vec3 stone = tinted(pattern.color, pattern.variation, random)
                           * (1.0f + 0.30f * cloud + 0.22f * grain + 0.25f * stain);
        PatternTexel t;
        t.color = glm::mix(pattern.joint_color * (0.8f + 0.4f * grain), stone, face)
                  * (0.82f + 0.18f * round);
        t.height = height
                   * (0.035f * face + 0.02f * round + 0.012f * own * face
                      + rough * face * (0.012f * chisel + 0.01f * grain));
        const float polished = glm::mix(pattern.roughness, 0.32f, pattern.wear * round);
        t.roughness = glm::mix(0.93f, polished + 0.12f * grain + 0.1f * cloud, face);
        t.occlusion = glm::mix(0.6f, 1.0f, glm::smoothstep(0.0f, half + 0.1f, edge));
        return t;
    });
}

PatternMaps make_rose_window(const RoseWindowPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const RoseLayout rose = lay_out(pattern);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 q = 2.0f * uv - 1.0f;
        const float radius = glm::length(q);
        // The first petal points up; image rows run downwards.
        const float sectors = (std::atan2(q.x, -q.y) / (2.0f * rose.half_sector));
        const float petal = std::floor(sectors + 0.5f);
        const float gap = std::floor(sectors);
        const auto in_sector = [&](float center) {
            const float angle = 2.0f * rose.half_sector * (sectors - center);
            return radius * Vec2(std::cos(angle), std::sin(angle));
        };
        const Vec2 by_petal = in_sector(petal);
        const Vec2 by_gap = in_sector(gap + 0.5f);
        const Vec2 in_roundel = by_gap - Vec2(rose.roundel_distance, 0);
        const Vec2 in_bead = by_petal - Vec2(rose.bead_distance, 0);

        Nearest nearest;
        nearest.take(radius - rose.hub, 0);
        nearest.take(
            capsule_distance(
                by_petal - Vec2(rose.petal_begin, 0), rose.begin_radius, rose.end_radius,
                rose.petal_end - rose.petal_begin),
            1);
        nearest.take(glm::length(in_roundel) - rose.roundel_radius, 2);
        nearest.take(glm::length(in_bead) - rose.bead_radius, 3);
        const float rim = radius - (0.98f - 2.0f * rose.bar);
        const float d = nearest.distance;
        const bool is_spandrel = d > rose.bar;

        Glass glass;
        if (is_spandrel) {
            glass.color = pattern.spandrel;
            glass.number = 1000;
        } else if (nearest.part == 0) {
            glass = round_glass(rose, q, rose.hub, pattern.petals, pattern.accent, pattern.border);
        } else if (nearest.part == 1) {
            glass = petal_glass(pattern, rose, by_petal, -d);
        } else if (nearest.part == 2) {
            glass = round_glass(
                rose, in_roundel, rose.roundel_radius, 8, pattern.border, pattern.accent);
        } else {
            glass =
                round_glass(rose, in_bead, rose.bead_radius, 6, pattern.spandrel, pattern.accent);
        }
        const int sector = nearest.part == 2 ? static_cast<int>(gap) : static_cast<int>(petal);
        const int count = pattern.petals;
        const std::uint32_t random = lattice_hash(
            nearest.part == 0 ? 0 : (sector % count + count) % count,
            glass.number + 2000 * nearest.part, seed);
        // Clear inside of the outlines, and again beyond the bars around them, up to the rim.
        const float inside = 1.0f - glm::smoothstep(-rose.pixel, rose.pixel, d);
        const float outside = glm::smoothstep(-rose.pixel, rose.pixel, d - 2.0f * rose.bar);
        const float within = 1.0f - glm::smoothstep(-rose.pixel, rose.pixel, rim);
        return glass_texel(glass, (inside + outside) * within, pattern.variation, random);
    });
}

PatternMaps make_stained_glass(const StainedGlassPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int n = pattern.panes;
    const float count = static_cast<float>(n);
    const float pixel = count / static_cast<float>(pattern.image.size);
    const float band = 0.09f;  // of the image, on either side
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float half = 0.5f * pattern.lead;
        const float to_side = std::min(uv.x, 1.0f - uv.x);
        Glass glass;
        glass.clear = beside_line((to_side - band) * count, half, pixel)
                      * beside_line(to_side * count, half, pixel);
        std::uint32_t random = 0;
        if (to_side < band) {
            const float along = 2.0f * count * uv.y;
            const int part = static_cast<int>(std::floor(along));
            glass.color = pattern.border;
            glass.clear *= beside_line(0.5f * (along - std::floor(along + 0.5f)), half, pixel);
            random = lattice_hash(part % (2 * n), uv.x < 0.5f ? 1 : 2, seed);
        } else {
            const float s = count * (uv.x + uv.y);
            const float t = count * (uv.x - uv.y);
            const float across_s = s - std::floor(s + 0.5f);
            const float across_t = t - std::floor(t + 0.5f);
            glass.clear *= beside_line(0.7f * across_s, half, pixel)
                           * beside_line(0.7f * across_t, half, pixel);
            // A pane that is cut by the lower edge continues at the upper one.
            const int column = static_cast<int>(std::floor(s));
            const int turns = column / n;
            const int row = static_cast<int>(std::floor(t)) + n * turns;
            random = lattice_hash(column % n, (row % (2 * n) + 2 * n) % (2 * n), seed + 1);
            glass.color = random % 6 == 0 ? pattern.accent : pattern.color;
        }
        return glass_texel(glass, 1.0f, pattern.variation, random);
    });
}

PatternMaps make_stars(const StarsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int rows = even(pattern.rows);
    const float count = static_cast<float>(rows);
    const float pixel = count / static_cast<float>(pattern.image.size);
    const float half_sector = kPi / static_cast<float>(pattern.points);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const int row = static_cast<int>(std::floor(uv.y * count));
        const float x = uv.x * count + (row % 2 != 0 ? 0.5f : 0.0f);
        const int column = static_cast<int>(std::floor(x)) % rows;
        const Vec2 q = Vec2(x, uv.y * count) - glm::floor(Vec2(x, uv.y * count)) - 0.5f;
        // Tips of a star are at `outer`, the corners between them at `inner`.
        const float outer =
            pattern.radius * (0.75f + 0.25f * lattice_random(column, row, seed + 3));
        const Vec2 inner = 0.42f * outer * Vec2(std::cos(half_sector), std::sin(half_sector));
        const float sector = std::atan2(q.x, -q.y) / (2.0f * half_sector);
        const float angle = 2.0f * half_sector * std::abs(sector - std::floor(sector + 0.5f));
        const Vec2 p = glm::length(q) * Vec2(std::cos(angle), std::sin(angle));
        const Vec2 side = glm::normalize(inner - Vec2(outer, 0));
        const float outside = side.y * (p.x - outer) - side.x * p.y;
        const float star = 1.0f - glm::smoothstep(-pixel, pixel, outside);

        const float grain = fbm(uv, 24 * rows, seed + 10, 3, 0.7f);
        const float cloud = fbm(uv, 3, seed + 20, 5);
        const float bare = glm::smoothstep(0.32f, 0.5f, fbm(uv, 2 * rows, seed + 30, 5));
        PatternTexel t;
        t.color = glm::mix(
            pattern.color * (1.0f + 0.5f * cloud + 0.2f * grain),
            pattern.star_color * (1.0f + 0.2f * grain), star * (1.0f - 0.7f * bare));
        t.height = 0.0015f * star / count + 0.0008f * grain / count;
        t.roughness = glm::mix(0.8f, 0.34f, star * (1.0f - bare)) + 0.05f * grain;
        return t;
    });
}

}  // namespace limn
