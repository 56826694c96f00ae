#pragma once

#include "content/make/patterns/patterns.h"

namespace limn {

// Flipbooks for particles: `frames` x `frames` white images whose opacity is the shape, in order
// from the top left. Every frame is transparent at its border. Those from simulations come with a
// motion map, for the default of particle_look's motion_strength.

inline constexpr float kMotionRange =
    0.25f;  ///< displacement encoded by 255, as a fraction of a frame

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
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(detail, "contrast of the opacity inside", "", 0, 1);
    LIMN_FIELD(billow, "height of its lumps; 0: a veil", "", 0, 2);
    LIMN_FIELD(shade, "how much the color shades lumps as if lit from above", "", 0, 1);
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
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(detail, "contrast of the opacity inside", "", 0, 1);
    LIMN_FIELD(sway, "sideways at the tip, in half frames", "", 0, 2);
}

/// Simulated fire in color, a loop. Its foot is at the lower edge.
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
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(width, "width of the source, in frames", "", 0.02, 0.9);
    LIMN_FIELD(rise, "acceleration of the hottest gas", "frames/s^2", 0, 100);
    LIMN_FIELD(cooling, "rate of heat loss; higher makes shorter flames", "1/s", 0.1, 20);
    LIMN_FIELD(whirls, "strength of small vortices", "", 0, 1);
}

/// A fireball that bursts, rises and turns to soot; plays once from the first frame to the last.
struct FireballPattern {
    PatternSize image;
    int frames = 4;
    float burst = 45;
    float cooling = 4.5f;
    float whirls = 0.25f;
};

LIMN_FIELDS(FireballPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(burst, "expansion of the hottest gas", "1/s", 0, 100);
    LIMN_FIELD(cooling, "rate of heat loss", "1/s", 0.1, 20);
    LIMN_FIELD(whirls, "strength of small vortices", "", 0, 1);
}

/// Autumn leaves, a different one per frame.
struct LeafPattern {
    PatternSize image;
    int frames = 4;
    Vec3 color = {0.55f, 0.20f, 0.03f};
    Vec3 second_color = {0.60f, 0.42f, 0.06f};
};

LIMN_FIELDS(LeafPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(color, "linear RGB of some leaves; randomly mixed", "", 0, 1);
    LIMN_FIELD(second_color, "linear RGB of the others", "", 0, 1);
}

/// Trees that stand on the lower edge of their frame, a different one per frame: for billboards.
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
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(color, "linear RGB of lit leaves", "", 0, 1);
    LIMN_FIELD(bark_color, "linear RGB of trunk and branches", "", 0, 1);
    LIMN_FIELD(slimness, "0: a round crown, 1: a poplar", "", 0, 1);
    LIMN_FIELD(gaps, "transparency of the rim of the crown", "", 0, 1);
}

/// Paper confetti in bright colors, a different piece per frame.
struct ConfettiPattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(ConfettiPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
}

/// Snow crystals, a different one per frame.
struct SnowflakePattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(SnowflakePattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
}

/// Splinters of stone, a different one per frame.
struct ShardPattern {
    PatternSize image;
    int frames = 4;
    Vec3 color = {0.30f, 0.27f, 0.24f};
};

LIMN_FIELDS(ShardPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(color, "linear RGB", "", 0, 1);
}

/// Water that breaks up into drops; plays once from the first frame to the last.
struct SplashPattern {
    PatternSize image;
    int frames = 4;
};

LIMN_FIELDS(SplashPattern) {
    visit_fields(self.image, visit);
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
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
    LIMN_FIELD(frames, "frames along each side of the image", "", 1, 16);
    LIMN_FIELD(width, "width of the ring, in half frames", "", 0.01, 0.5);
    LIMN_FIELD(detail, "contrast of the opacity inside", "", 0, 1);
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
