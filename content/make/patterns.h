#pragma once

#include "content/make/pattern_maps.h"
#include "ecs/reflect.h"

#include <span>
#include <string>
#include <string_view>

namespace limn {

// Procedural materials that a level may ask for by name: {"make": "marble", "size": 512}. Each
// makes base color, normal and occlusion-roughness-metalness images that tile; the same parameters
// give the same pixels. What the numbers say is by eye: they are meant to look right under the
// gallery's lights, not to measure anything. Reading the parameters works as for meshes, see
// make_mesh.h.

struct PatternKind {
    const char* name;                 ///< as a level writes it
    const char* doc;                  ///< one line
    const ComponentInfo* parameters;  ///< fields, defaults, how to construct and destroy
    PatternMaps (*make)(const void* parameters);
};

/// All kinds, by name.
[[nodiscard]] std::span<const PatternKind> pattern_kinds();

/// nullptr if there is none.
[[nodiscard]] const PatternKind* find_pattern_kind(std::string_view name);

/// "" or " (did you mean marble?)", to end a message about an unknown kind.
[[nodiscard]] std::string pattern_kind_suggestion(std::string_view name);

/// What all patterns have.
struct PatternSize {
    int size = 512;  ///< pixels along each side
    int seed = 1;    ///< another piece of the same material
};

struct CheckerPattern {
    PatternSize image;
    int cells = 8;  ///< along each side, even
    Vec3 color_a = {0.80f, 0.79f, 0.76f};
    Vec3 color_b = {0.06f, 0.07f, 0.08f};
    float roughness = 0.25f;
};

struct TilesPattern {
    PatternSize image;
    int cells = 4;  ///< tiles along each side
    Vec3 color = {0.10f, 0.30f, 0.36f};
    Vec3 grout_color = {0.55f, 0.52f, 0.48f};
    float variation = 0.35f;  ///< from tile to tile, 0 .. 1
    float grout = 0.035f;     ///< width in tiles, 0 .. 0.3
};

struct BricksPattern {
    PatternSize image;
    int rows = 8;  ///< of bricks, even; half as many bricks side by side
    Vec3 color = {0.36f, 0.11f, 0.06f};
    Vec3 mortar_color = {0.48f, 0.45f, 0.40f};
    float variation = 0.6f;  ///< from brick to brick, 0 .. 1
};

struct StonePattern {
    PatternSize image;
    int cells = 5;  ///< stones along each side
    Vec3 color = {0.27f, 0.26f, 0.24f};
    Vec3 joint_color = {0.09f, 0.08f, 0.06f};
    float variation = 0.5f;  ///< from stone to stone, 0 .. 1
};

struct WoodPattern {
    PatternSize image;
    int planks = 4;  ///< side by side; they run from the image's top to its bottom
    Vec3 color = {0.36f, 0.19f, 0.09f};
    float variation = 0.4f;  ///< from plank to plank, 0 .. 1
    float roughness = 0.42f;
};

struct BrushedMetalPattern {
    PatternSize image;
    Vec3 color = {0.77f, 0.78f, 0.78f};
    float roughness = 0.32f;
    float streaks = 0.5f;  ///< strength, 0 .. 1; they run along u
};

struct MarblePattern {
    PatternSize image;
    Vec3 color = {0.83f, 0.81f, 0.78f};
    Vec3 vein_color = {0.17f, 0.18f, 0.20f};
    float veins = 0.6f;  ///< how many and how dark, 0 .. 1
    float roughness = 0.12f;
};

struct ConcretePattern {
    PatternSize image;
    Vec3 color = {0.36f, 0.35f, 0.33f};
    float pores = 0.5f;  ///< how many, 0 .. 1
};

struct RustPattern {
    PatternSize image;
    Vec3 metal_color = {0.52f, 0.50f, 0.48f};
    Vec3 rust_color = {0.28f, 0.09f, 0.03f};
    float rust = 0.5f;  ///< share of the surface, 0 .. 1
};

struct FabricPattern {
    PatternSize image;
    int threads = 48;  ///< along each side, even
    Vec3 warp_color = {0.33f, 0.05f, 0.06f};
    Vec3 weft_color = {0.42f, 0.08f, 0.07f};
};

[[nodiscard]] PatternMaps make_checker(const CheckerPattern& pattern);
[[nodiscard]] PatternMaps make_tiles(const TilesPattern& pattern);
[[nodiscard]] PatternMaps make_bricks(const BricksPattern& pattern);
[[nodiscard]] PatternMaps make_stone(const StonePattern& pattern);
[[nodiscard]] PatternMaps make_wood(const WoodPattern& pattern);
[[nodiscard]] PatternMaps make_brushed_metal(const BrushedMetalPattern& pattern);
[[nodiscard]] PatternMaps make_marble(const MarblePattern& pattern);
[[nodiscard]] PatternMaps make_concrete(const ConcretePattern& pattern);
[[nodiscard]] PatternMaps make_rust(const RustPattern& pattern);
[[nodiscard]] PatternMaps make_fabric(const FabricPattern& pattern);

namespace detail {

template <typename Visitor>
void visit_image(PatternSize& image, Visitor& visit) {
    visit(
        "size", image.size, {.doc = "pixels along each side", .unit = "px", .min = 1, .max = 4096});
    visit(
        "seed", image.seed,
        {.doc = "another piece of the same material", .min = 0, .max = 2147483647});
}

}  // namespace detail

template <typename Visitor>
void visit_fields(CheckerPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("cells", p.cells, {.doc = "along each side", .min = 2, .max = 512});
    visit(
        "color_a", p.color_a,
        {.doc = "of one half of the cells", .min = 0, .max = 1, .color = true});
    visit("color_b", p.color_b, {.doc = "of the other half", .min = 0, .max = 1, .color = true});
    visit("roughness", p.roughness, {.doc = "perceptual roughness", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(TilesPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("cells", p.cells, {.doc = "tiles along each side", .min = 1, .max = 128});
    visit("color", p.color, {.doc = "of the glaze", .min = 0, .max = 1, .color = true});
    visit(
        "grout_color", p.grout_color,
        {.doc = "between the tiles", .min = 0, .max = 1, .color = true});
    visit("variation", p.variation, {.doc = "from tile to tile", .min = 0, .max = 1});
    visit("grout", p.grout, {.doc = "width of the grout in tiles", .min = 0, .max = 0.3});
}

template <typename Visitor>
void visit_fields(BricksPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("rows", p.rows, {.doc = "of bricks; made even", .min = 2, .max = 128});
    visit("color", p.color, {.doc = "of the bricks", .min = 0, .max = 1, .color = true});
    visit(
        "mortar_color", p.mortar_color,
        {.doc = "between the bricks", .min = 0, .max = 1, .color = true});
    visit("variation", p.variation, {.doc = "from brick to brick", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(StonePattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("cells", p.cells, {.doc = "stones along each side", .min = 2, .max = 128});
    visit("color", p.color, {.doc = "of the stones", .min = 0, .max = 1, .color = true});
    visit(
        "joint_color", p.joint_color,
        {.doc = "between the stones", .min = 0, .max = 1, .color = true});
    visit("variation", p.variation, {.doc = "from stone to stone", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(WoodPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("planks", p.planks, {.doc = "side by side", .min = 1, .max = 64});
    visit("color", p.color, {.doc = "of the early wood", .min = 0, .max = 1, .color = true});
    visit("variation", p.variation, {.doc = "from plank to plank", .min = 0, .max = 1});
    visit("roughness", p.roughness, {.doc = "perceptual roughness", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(BrushedMetalPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("color", p.color, {.doc = "reflectance seen head-on", .min = 0, .max = 1, .color = true});
    visit("roughness", p.roughness, {.doc = "perceptual roughness", .min = 0, .max = 1});
    visit("streaks", p.streaks, {.doc = "strength of the brushing along u", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(MarblePattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("color", p.color, {.doc = "of the ground", .min = 0, .max = 1, .color = true});
    visit("vein_color", p.vein_color, {.doc = "of the veins", .min = 0, .max = 1, .color = true});
    visit("veins", p.veins, {.doc = "how many and how dark", .min = 0, .max = 1});
    visit("roughness", p.roughness, {.doc = "perceptual roughness", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(ConcretePattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("color", p.color, {.doc = "when dry", .min = 0, .max = 1, .color = true});
    visit("pores", p.pores, {.doc = "how many", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(RustPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit(
        "metal_color", p.metal_color,
        {.doc = "of the bare metal", .min = 0, .max = 1, .color = true});
    visit("rust_color", p.rust_color, {.doc = "of the rust", .min = 0, .max = 1, .color = true});
    visit("rust", p.rust, {.doc = "share of the surface", .min = 0, .max = 1});
}

template <typename Visitor>
void visit_fields(FabricPattern& p, Visitor&& visit) {
    detail::visit_image(p.image, visit);
    visit("threads", p.threads, {.doc = "along each side; made even", .min = 2, .max = 512});
    visit(
        "warp_color", p.warp_color,
        {.doc = "of the threads along v", .min = 0, .max = 1, .color = true});
    visit(
        "weft_color", p.weft_color,
        {.doc = "of the threads along u", .min = 0, .max = 1, .color = true});
}

}  // namespace limn
