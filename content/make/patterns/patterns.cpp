#include "content/make/patterns/patterns.h"

#include "content/make/head/complexion_pattern.h"
#include "content/make/head/face_fold_pattern.h"
#include "content/make/head/head_furrow_pattern.h"
#include "content/make/head/strain_fold_pattern.h"
#include "content/make/patterns/bubble_pattern.h"
#include "content/make/patterns/crown_pattern.h"
#include "content/make/patterns/fold_pattern.h"
#include "content/make/patterns/furrow_patterns.h"
#include "content/make/patterns/glow_pattern.h"
#include "content/make/patterns/hair_pattern.h"
#include "content/make/patterns/mask_pattern.h"
#include "content/make/patterns/masonry_patterns.h"
#include "content/make/patterns/noise.h"
#include "content/make/patterns/pattern_tools.h"
#include "content/make/patterns/puff_pattern.h"
#include "content/make/patterns/relief_patterns.h"
#include "content/make/patterns/ridge_pattern.h"
#include "content/make/patterns/sclera_pattern.h"
#include "content/make/patterns/solid_pattern.h"
#include "content/make/patterns/sprite_patterns.h"
#include "content/make/patterns/studio_pattern.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

/// A point in a grid of rectangles.
struct GridCell {
    int column;
    int row;
    Vec2 local;  ///< 0 .. 1 inside the rectangle
    float edge;  ///< distance to its border, in units of its height
};

/// `aspect`: width of a rectangle over its height.
GridCell find_grid_cell(const Vec2& cells, float aspect) {
    const Vec2 whole = glm::floor(cells);
    const Vec2 local = cells - whole;
    const float across = std::min(local.x, 1.0f - local.x) * aspect;
    const float along = std::min(local.y, 1.0f - local.y);
    return {static_cast<int>(whole.x), static_cast<int>(whole.y), local, std::min(across, along)};
}

}  // namespace

PatternMaps make_checker(const CheckerPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int cells = even(pattern.cells);
    const float width = 1.0f / static_cast<float>(cells);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const GridCell cell = find_grid_cell(uv * static_cast<float>(cells), 1);
        const bool first = (cell.column + cell.row) % 2 == 0;
        const float groove = glm::smoothstep(0.0f, 0.035f, cell.edge);
        const float wear = fbm(uv, 6, seed);
        PatternTexel t;
        t.color = (first ? pattern.color_a : pattern.color_b) * (0.35f + 0.65f * groove)
                  * (1.0f + 0.08f * wear);
        t.height = 0.012f * width * groove;
        t.roughness = glm::mix(0.8f, pattern.roughness * (1.0f + 0.5f * wear), groove);
        t.occlusion = 0.6f + 0.4f * groove;
        return t;
    });
}

PatternMaps make_tiles(const TilesPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float width = 1.0f / static_cast<float>(pattern.cells);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const GridCell cell = find_grid_cell(uv * static_cast<float>(pattern.cells), 1);
        const std::uint32_t random = lattice_hash(cell.column, cell.row, seed);
        const float grout = 0.5f * pattern.grout;
        const float glaze = glm::smoothstep(grout, grout + 0.02f, cell.edge);
        const float pillow = glm::smoothstep(grout, grout + 0.12f, cell.edge);
        // Every tile is slightly tilted and its glaze slightly wavy.
        const Vec2 tilt = {
            lattice_random(cell.column, cell.row, seed + 1) - 0.5f,
            lattice_random(cell.column, cell.row, seed + 2) - 0.5f};
        const float wave = fbm(uv, 3 * pattern.cells, seed + 10, 3);
        const float sand = fbm(uv, 24 * pattern.cells, seed + 20, 3, 0.7f);
        const float cloud = fbm(uv, 2 * pattern.cells, seed + 30);
        const Vec3 tile = tinted(pattern.color, pattern.variation, random) * (1.0f + 0.25f * cloud);
        PatternTexel t;
        t.color = glm::mix(pattern.grout_color * (0.85f + 0.4f * sand), tile, glaze);
        t.height = width
                   * glm::mix(
                       0.004f * sand,
                       0.02f + 0.012f * pillow + 0.012f * glm::dot(tilt, cell.local - 0.5f)
                           + 0.0012f * wave,
                       glaze);
        t.roughness = glm::mix(0.9f, 0.12f + 0.08f * std::abs(cloud), glaze);
        t.occlusion = glm::mix(0.65f, 1.0f, pillow);
        return t;
    });
}

PatternMaps make_bricks(const BricksPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const int rows = even(pattern.rows);
    const int columns = rows / 2;
    const float height = 1.0f / static_cast<float>(rows);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 ragged = {fbm(uv, 5 * rows, seed + 40, 2), fbm(uv, 5 * rows, seed + 50, 2)};
        Vec2 cells = uv * Vec2(columns, rows) + 0.02f * Vec2(0.5f, 1.0f) * ragged;
        const bool shifted = static_cast<int>(std::floor(cells.y)) % 2 != 0;
        cells.x += shifted ? 0.5f : 0.0f;
        const GridCell cell = find_grid_cell(cells, 2);
        const int column = (cell.column + columns) % columns;
        const int row = (cell.row + rows) % rows;
        const std::uint32_t random = lattice_hash(column, row, seed);
        const float face = glm::smoothstep(0.055f, 0.10f, cell.edge);
        const float round = glm::smoothstep(0.05f, 0.2f, cell.edge);
        const float grain = fbm(uv, 6 * rows, seed + 10, 4, 0.65f);
        const float cloud = fbm(uv, rows, seed + 20);
        const float lift = lattice_random(column, row, seed + 1);
        const Vec3 brick = tinted(pattern.color, pattern.variation, random)
                           * (1.0f + 0.35f * cloud + 0.3f * grain);
        PatternTexel t;
        t.color = glm::mix(pattern.mortar_color * (0.85f + 0.45f * grain), brick, face);
        t.height = height
                   * (0.05f * face + 0.035f * round + 0.025f * lift * face
                      + (0.015f + 0.015f * face) * grain);
        t.roughness = 0.86f + 0.1f * grain;
        t.occlusion = glm::mix(0.55f, 1.0f, round);
        return t;
    });
}

PatternMaps make_stone(const StonePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float width = 1.0f / static_cast<float>(pattern.cells);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 ragged = {
            fbm(uv, 2 * pattern.cells, seed + 40, 4), fbm(uv, 2 * pattern.cells, seed + 50, 4)};
        const Vec2 p = uv * static_cast<float>(pattern.cells) + 0.14f * ragged;
        const CellSample cell = cell_noise(p, seed, 0.85f, IVec2(pattern.cells));
        const float face = glm::smoothstep(0.025f, 0.07f, cell.edge);
        const float round = glm::smoothstep(0.0f, 0.22f, cell.edge);
        const float lift = static_cast<float>(cell.cell & 255u) / 255.0f;
        const float grain = fbm(uv, 16 * pattern.cells, seed + 10, 4, 0.65f);
        const float chisel = fbm(uv, 3 * pattern.cells, seed + 20, 5);
        const float moss =
            glm::smoothstep(0.05f, 0.5f, fbm(uv, 4, seed + 30) + 0.25f * (1.0f - round));
        Vec3 stone = tinted(pattern.color, pattern.variation, cell.cell)
                     * (1.0f + 0.45f * chisel + 0.35f * grain);
        stone = glm::mix(stone, stone * Vec3(0.85f, 0.95f, 0.6f), moss);
        PatternTexel t;
        t.color = glm::mix(pattern.joint_color * (1.0f + 0.6f * grain), stone, face);
        t.height =
            width * (0.06f * round + face * (0.02f * lift + 0.03f * chisel) + 0.008f * grain);
        t.roughness = glm::mix(0.95f, 0.66f + 0.15f * chisel + 0.1f * grain, face);
        t.occlusion = glm::mix(0.45f, 1.0f, glm::smoothstep(0.0f, 0.15f, cell.edge));
        return t;
    });
}

PatternMaps make_wood(const WoodPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const float width = 1.0f / static_cast<float>(pattern.planks);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        // One joint per plank at a random position; the board wraps around the edge of the image.
        const float across = uv.x * static_cast<float>(pattern.planks);
        const int plank = static_cast<int>(across);
        const float local = across - static_cast<float>(plank);
        const float joint = lattice_random(plank, 0, seed + 1);
        const float to_end = std::abs(uv.y - joint);
        const float along_edge = std::min(to_end, 1.0f - to_end) / width;
        const float edge = std::min(std::min(local, 1.0f - local), along_edge);
        const std::uint32_t random = lattice_hash(plank, 3, seed);
        const std::uint32_t own = seed + 60u * static_cast<std::uint32_t>(plank);

        // Rings: the board is a slice through a bent trunk, so the ring number grows across it and
        // low-frequency noise along it makes cathedral grain.
        const float bend = fbm({across * 0.9f, uv.y * 2.0f}, own + 10, {0, 2}, 3);
        const float waver = fbm({across * 5.0f, uv.y * 8.0f}, own + 20, {0, 8}, 3);
        const float rings =
            5.0f * (local + 0.3f * lattice_random(plank, 1, seed)) + 4.5f * bend + 0.35f * waver;
        const float phase = rings - std::floor(rings);
        const float late = phase * phase * phase * glm::smoothstep(1.0f, 0.88f, phase) * 1.6f;
        const float fibers = fbm({across * 60.0f, uv.y * 6.0f}, own + 30, {0, 6}, 4, 0.7f);
        const float pores =
            glm::smoothstep(0.25f, 0.6f, fbm({across * 90.0f, uv.y * 12.0f}, own + 40, {0, 12}, 2));

        const float gap = glm::smoothstep(0.006f, 0.022f, edge);
        Vec3 wood = tinted(pattern.color, pattern.variation, random);
        wood =
            glm::mix(wood, wood * Vec3(0.52f, 0.42f, 0.34f), std::clamp(0.75f * late, 0.0f, 1.0f));
        wood *= (1.0f + 0.22f * fibers) * (1.0f - 0.35f * pores);
        PatternTexel t;
        t.color = wood * (0.12f + 0.88f * gap);
        t.height = width
                   * (0.018f * glm::smoothstep(0.0f, 0.04f, edge) + 0.002f * late + 0.0035f * fibers
                      - 0.003f * pores);
        t.roughness =
            glm::mix(0.9f, pattern.roughness + 0.12f * fibers + 0.15f * pores - 0.06f * late, gap);
        t.occlusion = 0.5f + 0.5f * gap;
        return t;
    });
}

PatternMaps make_brushed_metal(const BrushedMetalPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float fine = fbm(uv * Vec2(3, 192), seed, {3, 192}, 3, 0.8f);
        const float broad = fbm(uv * Vec2(2, 40), seed + 10, {2, 40}, 3);
        const float cloud = fbm(uv, 3, seed + 20, 4);
        PatternTexel t;
        t.color = pattern.color
                  * (1.0f + pattern.streaks * (0.10f * fine + 0.08f * broad) + 0.03f * cloud);
        t.height = pattern.streaks * (0.0006f * fine + 0.0006f * broad);
        t.roughness = pattern.roughness
                      * (1.0f + pattern.streaks * (0.35f * fine + 0.3f * broad) + 0.25f * cloud);
        t.metalness = 1;
        return t;
    });
}

PatternMaps make_marble(const MarblePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        // Veins are zero crossings of domain-warped noise: few broad ones and a net of thin ones.
        const Vec2 bend = {fbm(uv, 3, seed + 10, 5), fbm(uv, 3, seed + 20, 5)};
        const Vec2 p = uv + 0.16f * bend;
        const float broad = std::abs(fbm(p, 2, seed + 30, 5));
        const float thin = std::abs(fbm(p, 5, seed + 40, 4));
        const float where = glm::smoothstep(-0.3f, 0.35f, fbm(uv, 3, seed + 50, 3));
        const float cloud = fbm(p, 3, seed + 60, 6);
        const float dark = pattern.veins
                           * (0.85f * (1.0f - glm::smoothstep(0.0f, 0.05f + 0.05f * where, broad))
                                  * (0.35f + 0.65f * where)
                              + 0.5f * (1.0f - glm::smoothstep(0.0f, 0.03f, thin)) * where
                              + 0.25f * (1.0f - glm::smoothstep(0.0f, 0.35f, broad)));
        PatternTexel t;
        t.color = glm::mix(
            pattern.color * (1.0f + 0.12f * cloud), pattern.vein_color,
            std::clamp(dark, 0.0f, 1.0f));
        t.height = -0.0004f * dark;
        t.roughness = pattern.roughness + 0.12f * dark + 0.03f * cloud;
        return t;
    });
}

PatternMaps make_concrete(const ConcretePattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float stain = fbm(uv, 3, seed, 6);
        const float grain = fbm(uv, 48, seed + 10, 4, 0.75f);
        const CellSample bubbles = cell_noise(uv * 22.0f, seed + 20, 1, IVec2(22));
        const float size = static_cast<float>(bubbles.cell & 1023u) / 1023.0f;
        const float radius = 0.22f * pattern.pores * size * size * size;
        const float pore = 1.0f - glm::smoothstep(0.6f * radius, radius + 1e-4f, bubbles.nearest);
        PatternTexel t;
        t.color = pattern.color * (1.0f + 0.35f * stain + 0.22f * grain) * (1.0f - 0.55f * pore);
        t.height = 0.0016f * grain + 0.003f * stain - 0.006f * pore;
        t.roughness = 0.82f + 0.1f * grain - 0.12f * glm::smoothstep(0.1f, 0.5f, stain);
        t.occlusion = 1.0f - 0.5f * pore;
        return t;
    });
}

PatternMaps make_rust(const RustPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float spread = fbm(uv, 4, seed, 7, 0.6f) + (2.0f * pattern.rust - 1.0f) * 0.45f;
        const float rust = glm::smoothstep(-0.02f, 0.06f, spread);
        const float deep = glm::smoothstep(0.05f, 0.4f, spread);
        const float crust = fbm(uv, 40, seed + 10, 4, 0.7f);
        const float scratches = fbm(uv * Vec2(6, 90), seed + 20, {6, 90}, 3, 0.7f);
        const float halo = glm::smoothstep(-0.16f, 0.0f, spread);
        const Vec3 metal = pattern.metal_color * (1.0f + 0.08f * scratches) * (1.0f - 0.35f * halo);
        const Vec3 fresh = pattern.rust_color * Vec3(1.7f, 1.9f, 1.6f);
        const Vec3 crusted =
            glm::mix(fresh, pattern.rust_color * 0.6f, deep) * (1.0f + 0.5f * crust);
        PatternTexel t;
        t.color = glm::mix(metal, crusted, rust);
        t.height = rust * (0.004f + 0.005f * crust + 0.004f * deep) + 0.0004f * scratches;
        t.roughness = glm::mix(0.34f + 0.1f * scratches + 0.15f * halo, 0.88f + 0.1f * crust, rust);
        t.metalness = 1.0f - rust;
        t.occlusion = 1.0f - 0.2f * rust * (0.5f - 0.5f * crust);
        return t;
    });
}

PatternMaps make_fabric(const FabricPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const bool twill = pattern.weave == FabricWeave::Twill;
    const bool knit = pattern.weave == FabricWeave::Knit;
    const int threads = twill ? (pattern.threads + 5) / 6 * 6 : even(pattern.threads);
    const float width = 1.0f / static_cast<float>(threads);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        // Plain weave: in every other square the thread along v lies on top; twill: in two of
        // three, a square farther in each row. A thread is arched across its width and dips at the
        // ends of its square. Knit: both legs of a loop lean to the middle of their column.
        const GridCell cell = find_grid_cell(uv * static_cast<float>(threads), 1);
        const int diagonal = cell.column + cell.row;
        const bool warp_on_top = knit || (twill ? diagonal % 3 != 0 : diagonal % 2 == 0);
        Vec2 off = 2.0f * cell.local - 1.0f;
        if (knit) {
            const float loop = cell.local.y + 0.6f * std::abs(off.x);
            off = {2.0f * std::abs(off.x) - 1.0f, 2.0f * (loop - std::floor(loop)) - 1.0f};
        }
        const float across = warp_on_top ? off.x : off.y;
        const float along = warp_on_top ? off.y : off.x;
        const float bow = std::sqrt(std::max(1.0f - 0.92f * across * across, 0.0f));
        const float dive = 1.0f - (twill && warp_on_top ? 0.3f : 0.75f) * along * along;
        const Vec2 fiber_cells =
            warp_on_top ? Vec2(6 * threads, threads) : Vec2(threads, 6 * threads);
        const float fibers = fbm(uv * fiber_cells, seed, IVec2(fiber_cells), 2, 0.6f);
        const float slub = fbm(uv, 8, seed + 10, 3);
        const float top = bow * dive;
        const Vec3 thread = warp_on_top ? pattern.warp_color : pattern.weft_color;
        PatternTexel t;
        t.color = thread * (0.45f + 0.6f * top) * (1.0f + 0.3f * fibers + 0.15f * slub);
        t.height = width * (0.22f * top + 0.03f * fibers);
        t.roughness = 0.88f + 0.08f * fibers;
        t.occlusion = 0.5f + 0.5f * std::clamp(top, 0.0f, 1.0f);
        return t;
    });
}

PatternMaps make_windows(const WindowsPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    const Vec2 cells = {pattern.columns, pattern.rows};
    const float soft = 0.7f * std::max(cells.x, cells.y) / static_cast<float>(pattern.image.size);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const Vec2 position = uv * cells;
        const Vec2 cell = glm::min(glm::floor(position), cells - 1.0f);
        const int column = static_cast<int>(cell.x);
        const int row = static_cast<int>(cell.y);
        // Groups of four windows tend to be lit or dark together.
        const float stretch = lattice_random(column / 4, row, seed);
        const float own = lattice_random(column, row, seed + 1);
        const bool is_lit =
            0.5f * (stretch + own) < 0.5f * (pattern.lit + pattern.lit * pattern.lit)
            || own < 0.3f * pattern.lit;
        const Vec2 from_center = glm::abs(position - cell - 0.5f);
        const Vec2 half = 0.5f - 0.5f * pattern.frame * Vec2(1.0f, 1.4f);
        const Vec2 inside = 1.0f - glm::smoothstep(half - soft, half + soft, from_center);
        const float glass = inside.x * inside.y;
        const float bright = 1.0f - pattern.variation * lattice_random(column, row, seed + 2);
        // Lamps are at the ceiling; blinds cover part of the window.
        const float height = 1.0f - (position.y - cell.y);
        const float blind = 0.9f * lattice_random(column, row, seed + 3) - 0.3f;
        const float light = height > 1.0f - blind ? 0.35f : 0.55f + 0.45f * height;
        const bool accent = lattice_random(column / 4, row, seed + 4) < 0.25f;
        PatternTexel t;
        t.color =
            is_lit ? (accent ? pattern.accent : pattern.color) * (glass * bright * light) : Vec3(0);
        t.height = -0.004f * glass;
        t.roughness = glm::mix(0.7f, 0.12f, glass);
        return t;
    });
}

PatternMaps make_asphalt(const AsphaltPattern& pattern) {
    const std::uint32_t seed = seed_of(pattern.image);
    return make_pattern_maps(pattern.image.size, [&](const Vec2& uv) {
        const float low = fbm(uv, 3, seed, 5, 0.55f);  // about -0.5 .. 0.5
        const float grain = fbm(uv, 96, seed + 7, 2, 0.6f);
        const float stains = fbm(uv, 8, seed + 13);
        const float level = 0.9f * (pattern.wet - 0.5f);
        const float puddle = glm::smoothstep(-0.06f, 0.10f, level - low);
        PatternTexel t;
        t.color = pattern.color * (1.0f + 0.5f * grain + 0.35f * stains) * (1.0f - 0.45f * puddle);
        t.height = 0.0016f * grain * (1.0f - puddle);
        t.roughness = glm::mix(
            std::clamp(pattern.roughness + 0.2f * grain + 0.15f * stains, 0.2f, 1.0f), 0.06f,
            puddle);
        t.occlusion = 1.0f;
        return t;
    });
}

// ---- by name -----------------------------------------------------------------------------------

namespace {

template <typename Pattern, PatternMaps (*make)(const Pattern&)>
PatternKind
pattern_kind(const char* name, const char* doc, PatternKindMaps maps = PatternKindMaps::Surface) {
    const auto call = [](const void* parameters) {
        return make(*static_cast<const Pattern*>(parameters));
    };
    return {name, doc, &component_info<Pattern>(), call, maps};
}

}  // namespace

std::span<const PatternKind> pattern_kinds() {
    static const std::vector<PatternKind> kinds = {
        pattern_kind<AshlarPattern, make_ashlar>("ashlar", "blocks of dressed stone in courses"),
        pattern_kind<AsphaltPattern, make_asphalt>("asphalt", "a road after rain"),
        pattern_kind<BlocksPattern, make_blocks>(
            "blocks", "blocks of stone with deep joints, with a relief map",
            PatternKindMaps::Relief),
        pattern_kind<BricksPattern, make_bricks>("bricks", "a wall of rough bricks"),
        pattern_kind<BrushedMetalPattern, make_brushed_metal>(
            "brushed_metal", "metal with fine streaks along u"),
        pattern_kind<BubblePattern, make_bubble>("bubble", "a flipbook of air bubbles in water"),
        pattern_kind<CheckerPattern, make_checker>("checker", "two colors in squares, polished"),
        pattern_kind<ComplexionPattern, make_complexion>(
            "complexion", "blotches, freckles, age spots and stubble of the skin of a head"),
        pattern_kind<ConcretePattern, make_concrete>("concrete", "stained gray with pores"),
        pattern_kind<ConfettiPattern, make_confetti>(
            "confetti", "a flipbook of cut paper in bright colors"),
        pattern_kind<CrownPattern, make_crown>(
            "crown", "a flipbook of the crown splash of a drop, from the side"),
        pattern_kind<FaceFoldsPattern, make_face_folds>(
            "face_folds", "folds of a face, as a wrinkle map for the skin of a head"),
        pattern_kind<FabricPattern, make_fabric>("fabric", "a plain weave of two threads"),
        pattern_kind<FirePattern, make_fire>(
            "fire", "a flipbook of fire from a simulation, in color, with its motion",
            PatternKindMaps::Motion),
        pattern_kind<FireballPattern, make_fireball>(
            "fireball",
            "a flipbook of a burst of fire that turns to soot, in color, with its motion",
            PatternKindMaps::Motion),
        pattern_kind<FlamePattern, make_flame>("flame", "a flipbook of a tongue of fire"),
        pattern_kind<FlutesPattern, make_flutes>(
            "flutes", "a fluted ball, with normals in the space of a sphere"),
        pattern_kind<FoldsPattern, make_folds>("folds", "folds of skin along u, as a wrinkle map"),
        pattern_kind<FurrowsPattern, make_furrows>(
            "furrows", "skin with wrinkle furrows that grow along two vector fields"),
        pattern_kind<GlowPattern, make_glow>(
            "glow", "a soft glow around a small bright source, for additive particles"),
        pattern_kind<HairPattern, make_hair>(
            "hair", "strands of hair along v with gaps, for the cards of a head"),
        pattern_kind<HeadFurrowsPattern, make_head_furrows>(
            "head_furrows", "furrows along the folds of a head, at rest or as wrinkle maps"),
        pattern_kind<LeafPattern, make_leaf>("leaf", "a flipbook of different leaves"),
        pattern_kind<MarblePattern, make_marble>("marble", "polished, with veins"),
        pattern_kind<MasksPattern, make_masks>(
            "masks", "masks of four regions, one per channel, for wrinkle_maps"),
        pattern_kind<PuffPattern, make_puff>(
            "puff", "a flipbook of a cloud, with the light that it scatters from six sides",
            PatternKindMaps::Light),
        pattern_kind<RidgePattern, make_ridges>(
            "ridges", "wooded hills on the horizon, crest behind crest, for a panorama_layer"),
        pattern_kind<RingPattern, make_ring>("ring", "a flipbook of a torn ring"),
        pattern_kind<RoseWindowPattern, make_rose_window>(
            "rose_window", "a round window of stained glass; black outside the glass"),
        pattern_kind<RosettesPattern, make_rosettes>(
            "rosettes", "carved flowers in frames, with a relief map", PatternKindMaps::Relief),
        pattern_kind<RustPattern, make_rust>("rust", "scratched metal under patches of rust"),
        pattern_kind<ShardPattern, make_shard>("shard", "a flipbook of different splinters"),
        pattern_kind<ScleraPattern, make_sclera>(
            "sclera", "vessels on the white of an eye, for the eyes of a head"),
        pattern_kind<SmokePattern, make_smoke>("smoke", "a flipbook of a puff"),
        pattern_kind<SnowflakePattern, make_snowflake>(
            "snowflake", "a flipbook of different snow crystals"),
        pattern_kind<SolidPattern, make_solid>(
            "solid", "a solid as seen through a side of its bounding box, with front and back",
            PatternKindMaps::Relief),
        pattern_kind<SplashPattern, make_splash>("splash", "a flipbook of water that breaks up"),
        pattern_kind<StainedGlassPattern, make_stained_glass>(
            "stained_glass", "leaded diamonds between two borders; black at the lead"),
        pattern_kind<StarsPattern, make_stars>("stars", "a painted sky with gilded stars"),
        pattern_kind<StonePattern, make_stone>("stone", "irregular flagstones"),
        pattern_kind<StrainFoldsPattern, make_strain_folds>(
            "strain_folds", "folds of a face as a function of its strain, for a wrinkle_surface"),
        pattern_kind<StudioPattern, make_studio>(
            "studio", "a panorama of soft boxes and windows around a model"),
        pattern_kind<TilesPattern, make_tiles>("tiles", "glazed tiles in grout"),
        pattern_kind<TreePattern, make_tree>(
            "tree", "a flipbook of trees in leaf, each another one"),
        pattern_kind<WindowsPattern, make_windows>(
            "windows", "facade of a tower at night; black except for lit windows"),
        pattern_kind<WoodPattern, make_wood>("wood", "planks with rings, fibers and pores"),
    };
    return kinds;
}

}  // namespace limn
