#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>

namespace limn {

/// With a Floating: a boat with one sail, a keel and a rudder, +z ahead, +x to port. The wind comes
/// from Weather. A player steers it through Input, or it follows a course autonomously.
struct Sailboat {
    float sail_area = 22.0f;
    Vec3 sail_center = {0, 3.0f, 0.2f};
    float keel_area = 1.1f;
    Vec3 keel_center = {0, -0.8f, 0.3f};
    float rudder_area = 0.3f;
    Vec3 rudder_center = {0, -0.5f, -2.4f};
    float wave_drag = 0.06f;

    bool auto_trim = true;

    bool player = false;
    Entity camera{};
    Entity camera_target{};
    PathId course{};
    double distance = 0.0;
};

LIMN_FIELDS(Sailboat) {
    LIMN_FIELD(sail_area, "area of the sail", "m^2", 0, 1e4);
    LIMN_FIELD(sail_center, "center of effort of the sail", "m");
    LIMN_FIELD(keel_area, "submerged area of the keel", "m^2", 0, 1e4);
    LIMN_FIELD(keel_center, "point where the keel's force acts", "m");
    LIMN_FIELD(rudder_area, "area of the rudder", "m^2", 0, 1e4);
    LIMN_FIELD(rudder_center, "point where the rudder's force acts", "m");
    LIMN_FIELD(
        wave_drag, "wave-making resistance at hull speed, as a fraction of its weight", "", 0, 10);
    LIMN_FIELD(
        auto_trim, .doc = "the sheet is trimmed automatically, until a player trims it",
        .renamed = "trims_itself");
    LIMN_FIELD(player, "controlled by Input, once a player uses it");
    LIMN_FIELD(camera, "Input applies only while this camera is active, by name");
    LIMN_FIELD(
        camera_target, .doc = "upright entity moved along with the boat, as a camera target",
        .renamed = "lookout");
    LIMN_FIELD(course, "path of the level to follow autonomously, by name");
    LIMN_FIELD(distance, "initial distance of its target point along the course", "m", 0, 1e7);
}

/// State of a Sailboat.
struct SailboatState {
    float rudder = 0.0f;
    float sheet = 0.3f;
    float boom = 0.0f;
    bool player_active = false;
    std::int32_t tack = 1;
    bool auto_trim = true;
    double distance = 0.0;
};

LIMN_FIELDS(SailboatState) {
    LIMN_FIELD(rudder, "rudder; > 0 turns to starboard", "", -1, 1);
    LIMN_FIELD(sheet, "sheet; 0 hauled in, 1 let out", "", 0, 1);
    LIMN_FIELD(boom, "angle of the boom from the centerline, to port", "rad");
    LIMN_FIELD(player_active, "a player has taken control");
    LIMN_FIELD(tack, "when beating: wind from port 1, starboard -1", "", -1, 1);
    LIMN_FIELD(auto_trim, "the sheet is trimmed automatically");
    LIMN_FIELD(distance, "distance of its target point along the course", "m", 0, 1e7);
}

/// On a child of a Sailboat: rotates with the boom about its local +y; the sail, which bulges along
/// +x, fills to leeward.
struct Boom {
    float fullness = 0.0f;
};

LIMN_FIELDS(Boom) {
    LIMN_FIELD(fullness, "bulge of the sail, to port", "", -1, 1);
}

}  // namespace limn
