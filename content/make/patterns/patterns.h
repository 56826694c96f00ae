#pragma once

#include "content/make/find_kind.h"
#include "content/make/patterns/pattern_maps.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <span>

namespace limn {

// Procedural materials that a level requests by name: {"make": "marble", "size": 512}. Each makes
// base color, normal and occlusion-roughness-metalness images that tile; the same parameters give
// the same pixels. Values are chosen by eye, to look right under the gallery's lights, not
// measured. Parameters are read as those of meshes, see make_mesh.h.

/// Which maps a kind makes: base color, normal, occlusion-roughness-metalness, and
enum class PatternKindMaps {
    Surface,  ///< nothing else
    Motion,   ///< the motion map of a flipbook
    Light,    ///< both light maps of a flipbook of volumes
    Relief,   ///< the relief map
};

struct PatternKind {
    const char* name;                 ///< as in levels
    const char* doc;                  ///< one line
    const ComponentInfo* parameters;  ///< fields, defaults, how to construct and destroy
    PatternMaps (*make)(const void* parameters);
    PatternKindMaps maps = PatternKindMaps::Surface;
};

/// All kinds, by name.
[[nodiscard]] std::span<const PatternKind> pattern_kinds();

/// Parameters of all patterns.
struct PatternSize {
    int size = 512;
    int seed = 1;
};

LIMN_FIELDS(PatternSize) {
    LIMN_FIELD(size, "pixels along each side", "px", 1, 4096);
    LIMN_FIELD(seed, "random seed", "", 0, 2147483647);
}

struct CheckerPattern {
    PatternSize image;
    int cells = 8;
    Vec3 color_a = {0.80f, 0.79f, 0.76f};
    Vec3 color_b = {0.06f, 0.07f, 0.08f};
    float roughness = 0.25f;
};

LIMN_FIELDS(CheckerPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(cells, "along each side", "", 2, 512);
    LIMN_FIELD(color_a, .doc = "of one half of the cells", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(color_b, .doc = "of the other half", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

struct TilesPattern {
    PatternSize image;
    int cells = 4;
    Vec3 color = {0.10f, 0.30f, 0.36f};
    Vec3 grout_color = {0.55f, 0.52f, 0.48f};
    float variation = 0.35f;
    float grout = 0.035f;
};

LIMN_FIELDS(TilesPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(cells, "tiles along each side", "", 1, 128);
    LIMN_FIELD(color, .doc = "of the glaze", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(grout_color, .doc = "between the tiles", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(variation, "from tile to tile", "", 0, 1);
    LIMN_FIELD(grout, "width of the grout in tiles", "", 0, 0.3);
}

struct BricksPattern {
    PatternSize image;
    int rows = 8;
    Vec3 color = {0.36f, 0.11f, 0.06f};
    Vec3 mortar_color = {0.48f, 0.45f, 0.40f};
    float variation = 0.6f;
};

LIMN_FIELDS(BricksPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(rows, "of bricks; rounded up to even", "", 2, 128);
    LIMN_FIELD(color, .doc = "of the bricks", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(mortar_color, .doc = "between the bricks", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(variation, "from brick to brick", "", 0, 1);
}

struct StonePattern {
    PatternSize image;
    int cells = 5;
    Vec3 color = {0.27f, 0.26f, 0.24f};
    Vec3 joint_color = {0.09f, 0.08f, 0.06f};
    float variation = 0.5f;
};

LIMN_FIELDS(StonePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(cells, "stones along each side", "", 2, 128);
    LIMN_FIELD(color, .doc = "of the stones", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(joint_color, .doc = "between the stones", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(variation, "from stone to stone", "", 0, 1);
}

struct WoodPattern {
    PatternSize image;
    int planks = 4;
    Vec3 color = {0.36f, 0.19f, 0.09f};
    float variation = 0.4f;
    float roughness = 0.42f;
};

LIMN_FIELDS(WoodPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(planks, "side by side", "", 1, 64);
    LIMN_FIELD(color, .doc = "of the early wood", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(variation, "from plank to plank", "", 0, 1);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

struct BrushedMetalPattern {
    PatternSize image;
    Vec3 color = {0.77f, 0.78f, 0.78f};
    float roughness = 0.32f;
    float streaks = 0.5f;
};

LIMN_FIELDS(BrushedMetalPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(color, .doc = "reflectance at normal incidence", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
    LIMN_FIELD(streaks, "strength of the brushing along u", "", 0, 1);
}

struct MarblePattern {
    PatternSize image;
    Vec3 color = {0.83f, 0.81f, 0.78f};
    Vec3 vein_color = {0.17f, 0.18f, 0.20f};
    float veins = 0.6f;
    float roughness = 0.12f;
};

LIMN_FIELDS(MarblePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(color, .doc = "of the ground", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(vein_color, .doc = "of the veins", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(veins, "density and darkness", "", 0, 1);
    LIMN_FIELD(roughness, "perceptual roughness", "", 0, 1);
}

struct ConcretePattern {
    PatternSize image;
    Vec3 color = {0.36f, 0.35f, 0.33f};
    float pores = 0.5f;
};

LIMN_FIELDS(ConcretePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(color, .doc = "when dry", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(pores, "density of pores", "", 0, 1);
}

struct RustPattern {
    PatternSize image;
    Vec3 metal_color = {0.52f, 0.50f, 0.48f};
    Vec3 rust_color = {0.28f, 0.09f, 0.03f};
    float rust = 0.5f;
};

LIMN_FIELDS(RustPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(metal_color, .doc = "of the bare metal", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(rust_color, .doc = "of the rust", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(rust, "fraction of the surface", "", 0, 1);
}

enum class FabricWeave : std::uint8_t {
    Plain,
    Twill,  ///< as denim: ribs run diagonally
    Knit,   ///< columns of loops
};

struct FabricPattern {
    PatternSize image;
    FabricWeave weave = FabricWeave::Plain;
    int threads = 48;
    Vec3 warp_color = {0.33f, 0.05f, 0.06f};
    Vec3 weft_color = {0.42f, 0.08f, 0.07f};
};

LIMN_FIELDS(FabricPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(weave, .doc = "how threads cross", .values = "plain twill knit");
    LIMN_FIELD(
        threads, "along each side; rounded up to even, of twill to a multiple of 6", "", 2, 512);
    LIMN_FIELD(warp_color, .doc = "of the threads along v", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(weft_color, .doc = "of the threads along u", .min = 0, .max = 1, .color = true);
}

/// Facade of a tower at night: storeys of windows, some of them lit, in groups like offices.
/// Everything unlit is black, for use as emission.
struct WindowsPattern {
    PatternSize image;
    int columns = 16;
    int rows = 24;
    float lit = 0.35f;
    float frame = 0.22f;
    float variation = 0.6f;
    Vec3 color = {1.0f, 0.72f, 0.40f};
    Vec3 accent = {0.55f, 0.80f, 1.0f};
};

LIMN_FIELDS(WindowsPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(columns, "windows along u", "", 1, 256);
    LIMN_FIELD(rows, "storeys", "", 1, 256);
    LIMN_FIELD(lit, "fraction of the windows that are lit", "", 0, 1);
    LIMN_FIELD(frame, "gap between windows / cell size", "", 0, 0.9);
    LIMN_FIELD(variation, "of brightness from window to window", "", 0, 1);
    LIMN_FIELD(color, .doc = "of lit windows", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(accent, .doc = "of one window in four", .min = 0, .max = 1, .color = true);
}

/// Asphalt after rain: grains and seams, and puddles that are as smooth as glass.
struct AsphaltPattern {
    PatternSize image;
    float wet = 0.45f;
    float roughness = 0.55f;
    Vec3 color = {0.035f, 0.036f, 0.04f};
};

LIMN_FIELDS(AsphaltPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(wet, "fraction covered by puddles", "", 0, 1);
    LIMN_FIELD(roughness, "outside of puddles", "", 0, 1);
    LIMN_FIELD(color, .doc = "dry", .min = 0, .max = 1, .color = true);
}

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
[[nodiscard]] PatternMaps make_windows(const WindowsPattern& pattern);
[[nodiscard]] PatternMaps make_asphalt(const AsphaltPattern& pattern);

}  // namespace limn
