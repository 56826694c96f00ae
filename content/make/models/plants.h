#pragma once

#include "ecs/base/math.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// Structured particles (particle.volume-fill; Reeves and Blau, "Approximate and Probabilistic
// Algorithms for Shading and Rendering Structured Particle Systems", SIGGRAPH 1985): a few numbers
// grow into many line particles that fill a volume. Stems are spread evenly over an area, and each
// particle branches at its tip, level by level: grass with no level, bushes and trees with several.
// They are also ordered by level, so that fewer levels are a prefix of the same list.
//
// Wind bends a particle to a parabola: a point is moved by wind * length * t^2, where `length` is
// the total of all levels, and t its position along the branches from the root as a fraction of
// that.

struct PlantShape {
    std::uint32_t seed = 1;
    Vec2 area = {1, 1};
    int stems = 400;
    int levels = 0;
    int branches = 3;
    float length = 0.3f;
    float length_spread = 0.1f;
    float shrink = 0.7f;
    float spread = 0.3f;
    float width = 0.008f;
    int segments = 3;
    Vec3 wind = {0, 0, 0};
};

LIMN_FIELDS(PlantShape) {
    LIMN_FIELD(seed, "random seed");
    LIMN_FIELD(area, "extents in x and z of the area with stems, at y = 0", "m", 0, 1e4);
    LIMN_FIELD(stems, "particles at the root", "", 1, 200000);
    LIMN_FIELD(levels, "levels of branching; limited to two million particles in total", "", 0, 10);
    LIMN_FIELD(branches, "at each tip", "", 1, 16);
    LIMN_FIELD(length, "of a stem", "m", 0.001, 1000);
    LIMN_FIELD(length_spread, "give or take, of a stem; for branches in proportion", "m", 0, 1000);
    LIMN_FIELD(shrink, "length and width of a branch relative to its parent", "", 0.1, 1);
    LIMN_FIELD(spread, "largest angle to its parent; of stems, to +y", "rad", 0, 3.1416);
    LIMN_FIELD(width, "of a stem at the root", "m", 1e-4, 100);
    LIMN_FIELD(segments, "quads along a particle", "", 1, 16);
    LIMN_FIELD(
        wind, "displacement of the tip of the last level, relative to the length of all levels", "",
        -1, 1);
}

/// A line from root to tip, in still air.
struct PlantParticle {
    Vec3 root = {0, 0, 0};    ///< [m]
    Vec3 along = {0, 1, 0};   ///< to the tip [m]
    float width = 0;          ///< at the root [m]
    float root_fraction = 0;  ///< t at the root, see above, 0 .. 1
    float tip_fraction = 1;   ///< t at the tip
};

inline constexpr std::size_t kMaxPlantParticles = std::size_t{1} << 21;

/// The stems, then the branches of each level: stems * branches^k of level k.
[[nodiscard]] std::vector<PlantParticle> grow_plants(const PlantShape& shape);

/// A point at 0 (root) .. 1 (tip) of a particle, bent by the wind of the shape.
[[nodiscard]] Vec3 plant_point(const PlantShape& shape, const PlantParticle& particle, float at);

/// All particles as flat blades, those of the last level pointed; with fewer segments beyond
/// kMaxPlantParticles quads. v runs from the tip down; the material must be double-sided.
[[nodiscard]] MeshData make_plants(const PlantShape& shape);

}  // namespace limn
