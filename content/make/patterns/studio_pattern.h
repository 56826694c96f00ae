#pragma once

#include "content/make/patterns/patterns.h"

#include <vector>

namespace limn {

/// A rectangular light, a soft box or a window, that faces the center of a room.
struct StudioLight {
    Vec3 toward = {0.6f, 0.5f, 0.6f};
    Vec2 size = {0.8f, 1.0f};
    Vec3 color = {1, 1, 1};
    float edge = 0.06f;
    IVec2 panes = {1, 1};
    float bars = 0.06f;
};

LIMN_FIELDS(StudioLight) {
    LIMN_FIELD(toward, "direction to its center from the center of the room; -z is straight ahead");
    LIMN_FIELD(size, "width and height at a distance of 1", "", 0.01, 10);
    LIMN_FIELD(color, .doc = "its light", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(edge, "width of its blurred border / half its size", "", 0, 1);
    LIMN_FIELD(panes, "of a window, across and upward", "", 1, 32);
    LIMN_FIELD(bars, "width of the bars between panes / width of a pane", "", 0, 0.9);
}

/// The surroundings of a model in a studio, as an equirectangular panorama for the environment:
/// eyes and glossy surfaces then reflect soft boxes instead of point lights. The sky `studio` has
/// fixed lamps; this one has those that a level defines.
struct StudioPattern {
    PatternSize image;
    Vec3 wall = {0.02f, 0.02f, 0.021f};
    Vec3 floor = {0.012f, 0.011f, 0.01f};
    std::vector<StudioLight> lights = {
        {},
        {.toward = {-0.9f, 0.2f, 0.5f}, .size = {0.5f, 1.2f}, .color = {0.3f, 0.32f, 0.36f}},
        {.toward = {-0.7f, 0.4f, -0.7f}, .size = {0.3f, 1.2f}},
        {.toward = {0.9f, 0.2f, -0.4f},
         .size = {0.7f, 1},
         .color = {0.45f, 0.55f, 0.75f},
         .edge = 0,
         .panes = {2, 3}}};
};

LIMN_FIELDS(StudioPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(
        wall, .doc = "radiance of the walls at eye level, slightly uneven", .min = 0, .max = 1,
        .color = true);
    LIMN_FIELD(floor, .doc = "of the floor", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(lights, "soft boxes and windows; they do not occlude each other");
}

[[nodiscard]] PatternMaps make_studio(const StudioPattern& pattern);

}  // namespace limn
