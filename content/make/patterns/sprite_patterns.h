#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

// Flipbooks for particles: `frames` x `frames` white images whose opacity is the shape, in order
// from the top left. Every frame is transparent at its border. Those from simulations come with a
// motion map, for the default of particle_look's motion_strength.

inline constexpr float kMotionReach = 0.25f;  ///< what 255 in it means, as a share of a frame

/// A puff that swirls and frays.
struct SmokePattern {
    PatternSize image;
    int frames = 4;
    float detail = 0.7f;
    float billow = 0;
    float shade = 0.7f;
};

LIMN_FIELDS(SmokePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(detail, "share of the opacity that varies within", "", 0, 1);
    LIMN_FIELD(billow, "height of the lumps that it is made of; 0: a veil", "", 0, 2);
    LIMN_FIELD(shade, "how much lumps are lit from above, in the color", "", 0, 1);
}

/// A tongue of fire that rises and breaks apart.
struct FlamePattern {
    PatternSize image;
    int frames = 4;
    float detail = 0.8f;
    float sway = 0.75f;
};

LIMN_FIELDS(FlamePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(detail, "share of the opacity that varies within", "", 0, 1);
    LIMN_FIELD(sway, "to the sides at the tip, as a share of half the frame", "", 0, 2);
}

/// Fire from a simulation, in its own colors: a loop. Its foot is at the lower edge.
struct FirePattern {
    PatternSize image;
    int frames = 4;
    float width = 0.42f;
    float rise = 13;
    float cooling = 5;
    float whirls = 0.2f;
};

LIMN_FIELDS(FirePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(width, "of the source, as a share of the frame", "", 0.02, 0.9);
    LIMN_FIELD(rise, "acceleration of the hottest gas", "frames/s^2", 0, 100);
    LIMN_FIELD(cooling, "how fast heat is lost: how short the flames are", "1/s", 0.1, 20);
    LIMN_FIELD(whirls, "strength of small whirls", "", 0, 1);
}

/// A ball of fire that bursts, rises and turns to soot: from the first frame to the last.
struct FireballPattern {
    PatternSize image;
    int frames = 4;
    float burst = 45;
    float cooling = 4.5f;
    float whirls = 0.25f;
};

LIMN_FIELDS(FireballPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(burst, "expansion of the hottest gas", "1/s", 0, 100);
    LIMN_FIELD(cooling, "how fast heat is lost", "1/s", 0.1, 20);
    LIMN_FIELD(whirls, "strength of small whirls", "", 0, 1);
}

/// Leaves of a tree in autumn, another one in each frame.
struct LeafPattern {
    PatternSize image;
    int frames = 4;
    Vec3 color = {0.55f, 0.20f, 0.03f};
    Vec3 second_color = {0.60f, 0.42f, 0.06f};
};

LIMN_FIELDS(LeafPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(color, "linear RGB of some, mixed by chance", "", 0, 1);
    LIMN_FIELD(second_color, "of the others", "", 0, 1);
}

/// Trees that stand on the lower edge of their frame, another one in each: for billboards.
struct TreePattern {
    PatternSize image;
    int frames = 4;
    Vec3 color = {0.10f, 0.16f, 0.03f};
    Vec3 bark_color = {0.10f, 0.07f, 0.045f};
    float slimness = 0.25f;
    float gaps = 0.45f;
};

LIMN_FIELDS(TreePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(color, "linear RGB of the leaves in the light", "", 0, 1);
    LIMN_FIELD(bark_color, "linear RGB of trunk and branches", "", 0, 1);
    LIMN_FIELD(slimness, "0: a round crown, 1: a poplar", "", 0, 1);
    LIMN_FIELD(gaps, "how far one sees through the rim of the crown", "", 0, 1);
}

/// Cut paper in bright colors, another piece in each frame.
struct ConfettiPattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(ConfettiPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
}

/// Crystals of snow, another one in each frame.
struct SnowflakePattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(SnowflakePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
}

/// Splinters of stone, another one in each frame.
struct ShardPattern {
    PatternSize image;
    int frames = 4;
    Vec3 color = {0.30f, 0.27f, 0.24f};
};

LIMN_FIELDS(ShardPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(color, "linear RGB", "", 0, 1);
}

/// Water that breaks into drops, from the first frame to the last.
struct SplashPattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(SplashPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
}

/// A torn ring: shock waves, portals.
struct RingPattern {
    PatternSize image;
    int frames = 4;
    float width = 0.09f;
    float detail = 0.7f;
};

LIMN_FIELDS(RingPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "side by side, and one below the other", "", 1, 16);
    LIMN_FIELD(width, "of the ring, as a share of half the frame", "", 0.01, 0.5);
    LIMN_FIELD(detail, "share of the opacity that varies within", "", 0, 1);
}

[[nodiscard]] PatternMaps make_leaf(const LeafPattern& pattern);
[[nodiscard]] PatternMaps make_tree(const TreePattern& pattern);
[[nodiscard]] PatternMaps make_confetti(const ConfettiPattern& pattern);
[[nodiscard]] PatternMaps make_snowflake(const SnowflakePattern& pattern);
[[nodiscard]] PatternMaps make_shard(const ShardPattern& pattern);
[[nodiscard]] PatternMaps make_splash(const SplashPattern& pattern);
[[nodiscard]] PatternMaps make_ring(const RingPattern& pattern);
[[nodiscard]] PatternMaps make_fire(const FirePattern& pattern);
[[nodiscard]] PatternMaps make_fireball(const FireballPattern& pattern);
[[nodiscard]] PatternMaps make_smoke(const SmokePattern& pattern);
[[nodiscard]] PatternMaps make_flame(const FlamePattern& pattern);

}  // namespace limn
