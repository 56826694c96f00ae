#pragma once

namespace limn::oracle {

// Light in a long groove between two walls of the same slope, by radiosity in double precision: the
// walls are cut into strips, whose form factors are those of Hottel's crossed strings, and light
// bounces until none is left. An independent check of fold_light.glsl.

/// Means over both walls.
struct GrooveWalls {
    double left = 0;
    double right = 0;
};

/// Cosines at the walls of light from (x, y) in the cross-section of the groove, y > 0 out of it: 0
/// where a strip is shadowed by the other wall. The left wall faces +x. `slope` of the walls [rad],
/// 0 to pi/2; (x, y) is shorter than 1 if the light also has a component along the groove.
[[nodiscard]] GrooveWalls groove_cosines(double slope, double x, double y);

/// Radiosity relative to white skin without a groove that faces the light, for walls of `albedo` 0
/// to 1.
[[nodiscard]] GrooveWalls groove_radiosity(double slope, double albedo, double x, double y);

/// The same for light from all directions.
[[nodiscard]] double groove_radiosity_around(double slope, double albedo);

}  // namespace limn::oracle
