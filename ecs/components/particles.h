#pragma once

#include "ecs/base/math.h"
#include "ecs/components/periodic.h"
#include "ecs/components/surface.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <vector>

namespace limn {

// Particles: many short-lived points that an entity emits (Reeves 1983). What an artist sets is
// split by question:
//
//     ParticleEmitter   when and where particles are born, and with what
//     ParticleSource    that they are born where particles of another emitter are
//     ParticleSurface   that they are born on a mesh or along a path (particle_surface.h)
//     ParticleMotion    what moves them
//     ParticleCollision what happens where they meet a ParticleCollider (particle_collider.h)
//     ParticleWrap      that they stay around the camera
//     ParticleLook      how they are drawn
//     ParticleLight     that they light their surroundings
//     ParticlePool      the living ones, kept by the systems: one array per scalar
//
// "x, give or take s" means a value drawn evenly from [x - s, x + s], once per particle.
// Techniques: engine.particle-cpu, engine.particle-params, engine.space-dust,
//     particle.depth-of-field, particle.half-resolution, particle.linear-window,
//     particle.lit-in-middle, particle.motion-vectors, particle.shadow, particle.velocity,
//     particle.visibility
// Source of particle.velocity: motion vectors of blended particles
// Source of particle.shadow: Jansen and Bavoil 2010
// Source of particle.motion-vectors: frame blending by motion vectors, as in VFX practice
// Source of particle.lit-in-middle: light once a particle, as in most engines
// Source of particle.half-resolution: Cantlay 2007; Jansen and Bavoil 2011
// Source of particle.depth-of-field: 144 views from all over the lens

/// Where particles are born, in the emitter's local space. `size` scales the unit shape.
enum class EmitterShape : std::uint8_t {
    Point,
    Ball,    ///< evenly within an ellipsoid
    Sphere,  ///< on its surface; an axis of size 0 is left out, so that a ring is left
    Disc,    ///< within an ellipse in the xz plane
    Circle,  ///< on its edge
    Box,
    Torus,  ///< around y: evenly along a circle in xz and over a tube of radius size.y
};

/// Their initial direction.
enum class EmitterDirection : std::uint8_t {
    Cone,    ///< within `cone` of local +y, evenly by solid angle
    Radial,  ///< away from the emitter's origin
};

/// Particles born at one instant.
struct ParticleBurst {
    float time = 0;
    float count = 100;
    float spread = 0;
    float interval = 1;
    std::uint32_t repeats = 0;
};

LIMN_FIELDS(ParticleBurst) {
    LIMN_FIELD(time, "of the first one, after the emitter starts", "s", 0, 1e6);
    LIMN_FIELD(count, "number of particles", "", 0, 1e6);
    LIMN_FIELD(spread, "give or take", "", 0, 1e6);
    LIMN_FIELD(interval, "until the next one", "s", 0.001, 1e6);
    LIMN_FIELD(repeats, "number of repetitions");
}

/// A value at a fraction of a time, linear between keys.
struct CurveKey {
    float at = 0;
    float value = 1;
};

LIMN_FIELDS(CurveKey) {
    LIMN_FIELD(at, "fraction of the life, or of what the curve runs over", "", 0, 1);
    LIMN_FIELD(value, "factor", "", 0, 1000);
}

/// What simulates the particles of an emitter. Results are the same but for rounding. On the GPU,
/// particles are neither saved nor sorted among those of other emitters, light nothing, give birth
/// to no others, pass through water, and occupy the capacity for the longest possible lifetime.
enum class ParticleExecutor : std::uint8_t {
    Auto,  ///< the GPU from a capacity of 262,144 on
    Cpu,
    Gpu,
};

/// What the capacity limits (particle.linear-window, particle.circular-list).
enum class ParticlePopulation : std::uint8_t {
    Circular,  ///< living particles: slots are reused
    Linear,    ///< all births ever: for effects that end; a window that moves along an array
};

struct ParticleEmitter {
    bool active = true;
    ParticleExecutor executor = ParticleExecutor::Auto;
    float rate = 50;
    float rate_spread = 0;
    std::vector<CurveKey> rate_curve;
    bool by_screen_area = false;
    std::vector<ParticleBurst> bursts;
    float duration = 0;
    bool loop = true;
    float prewarm = 0;
    std::uint32_t capacity = 4096;
    ParticlePopulation population = ParticlePopulation::Circular;
    std::uint32_t seed = 0;
    EmitterShape shape = EmitterShape::Point;
    Vec3 size = {0.1f, 0.1f, 0.1f};
    Vec3 size_spread = {0, 0, 0};
    EmitterDirection direction = EmitterDirection::Cone;
    float cone = 0.3f;
    float speed = 1;
    float speed_spread = 0.2f;
    Vec3 velocity_spread = {0, 0, 0};
    float inherit = 0;
    float drop_speed = 1;
    float life = 2;
    float life_spread = 0.5f;
};

LIMN_FIELDS(ParticleEmitter) {
    LIMN_FIELD(active, "whether particles are born; living ones go on either way");
    LIMN_FIELD(
        executor,
        .doc =
            "what simulates them; those on the GPU light nothing, give birth to no others and pass "
            "through water",
        .values = "auto cpu gpu");
    LIMN_FIELD(rate, "births per second", "1/s", 0, 1e7);
    LIMN_FIELD(rate_spread, "give or take, drawn in each step", "1/s", 0, 1e7);
    LIMN_FIELD(rate_curve, "factor on the rate over the duration; without one, over a second");
    LIMN_FIELD(
        by_screen_area,
        "rate and spread are multiplied by the fraction of the image that the shape covers");
    LIMN_FIELD(bursts, "many births at one instant");
    LIMN_FIELD(duration, "how long it emits; 0: forever", "s", 0, 1e6);
    LIMN_FIELD(loop, "starts again after the duration, bursts included");
    LIMN_FIELD(
        prewarm,
        "how long it has been emitting when it starts; without sources, sprays and colliders", "s",
        0, 60);
    LIMN_FIELD(
        capacity, "maximum number of living particles; further births are dropped and counted", "",
        0, 4194304);
    LIMN_FIELD(
        population, .doc = "what the capacity counts: the living, or with linear all births ever",
        .values = "circular linear");
    LIMN_FIELD(seed, "random seed; 0: a different one for each entity");
    LIMN_FIELD(
        shape, .doc = "where particles are born",
        .values = "point ball sphere disc circle box torus");
    LIMN_FIELD(
        size, "half extents of the shape along the local axes; y of a torus: radius of its tube",
        "m", 0, 1e5);
    LIMN_FIELD(
        size_spread, "give or take, along each local axis: thickness of a shell", "m", 0, 1e5);
    LIMN_FIELD(
        direction, .doc = "initial direction: about local +y, or outward", .values = "cone radial");
    LIMN_FIELD(cone, "half angle of the cone of directions", "rad", 0, 3.1416);
    LIMN_FIELD(speed, "initial speed", "m/s", -1e4, 1e4);
    LIMN_FIELD(speed_spread, "give or take", "m/s", 0, 1e4);
    LIMN_FIELD(
        velocity_spread, "give or take, along each local axis beside the speed", "m/s", 0, 1e4);
    LIMN_FIELD(inherit, "fraction of the emitter's own velocity that is added", "", -10, 10);
    LIMN_FIELD(
        drop_speed, "factor on the speed of drops that a spray source or obstacle throws up", "", 0,
        100);
    LIMN_FIELD(life, "lifetime", "s", 0, 1e5);
    LIMN_FIELD(life_spread, "give or take", "s", 0, 1e5);
}

/// When a particle of another emitter gives birth.
enum class ParticleMoment : std::uint8_t {
    Birth,
    Flight,  ///< all the time: a trail
    Hit,     ///< when it meets a surface
    Death,
};

/// Particles of this emitter are born only at particles of another one: rocket and trail, shell and
/// stars, drop and splash. The emitter's shape is centered there, rotated as the emitter is, or
/// with +y along the normal of the surface that was hit.
struct ParticleSource {
    Entity emitter{};
    ParticleMoment at = ParticleMoment::Death;
    float count = 20;
    float spread = 0;
    float inherit = 0.2f;
};

LIMN_FIELDS(ParticleSource) {
    LIMN_FIELD(emitter, "whose particles give birth; not this one");
    LIMN_FIELD(
        at,
        .doc = "when; in flight the emitter's rate is per particle, along its curve over the life "
               "of that",
        .values = "birth flight hit death");
    LIMN_FIELD(count, "births at a birth, hit or death", "", 0, 1e6);
    LIMN_FIELD(spread, "give or take", "", 0, 1e6);
    LIMN_FIELD(inherit, "fraction of that particle's velocity that is added", "", -10, 10);
}

/// How a step integrates velocities to positions (particle.integrator).
enum class ParticleIntegrator : std::uint8_t {
    Average,        ///< by the mean of old and new velocity: exact for constant forces
    ExplicitEuler,  ///< by the old one, as when position and velocity are updated in one pass
    SemiImplicit,   ///< by the new one
    ClosedForm,     ///< from the age instead of by steps, under gravity alone
                    ///< (particle.stateless-script)
};

struct ParticleMotion {
    float gravity = 1;
    float drag = 0;
    Vec3 wind = {0, 0, 0};
    float weather = 0;
    float turbulence = 0;
    float turbulence_size = 1;
    float turbulence_speed = 0.5f;
    float vortex = 0;
    float attraction = 0;
    float orbit = 0;
    float brake = 0;
    float fields = 1;
    ParticleIntegrator integrator = ParticleIntegrator::Average;
};

LIMN_FIELDS(ParticleMotion) {
    LIMN_FIELD(gravity, "factor on 9.81 m/s^2 downwards; negative: rises", "", -100, 100);
    LIMN_FIELD(drag, "decay of the velocity relative to the air", "1/s", 0, 1000);
    LIMN_FIELD(wind, "velocity of the air, in world space; needs drag", "m/s", -1000, 1000);
    LIMN_FIELD(weather, "fraction of the wind of the resource weather that is added", "", 0, 10);
    LIMN_FIELD(turbulence, "acceleration by curl noise: whirls without sources", "m/s^2", 0, 1e4);
    LIMN_FIELD(turbulence_size, "extent of a whirl", "m", 0.001, 1e4);
    LIMN_FIELD(turbulence_speed, "whirls that come and go in a second", "1/s", 0, 100);
    LIMN_FIELD(vortex, "acceleration around the emitter's y axis", "m/s^2", -1e4, 1e4);
    LIMN_FIELD(attraction, "acceleration toward the emitter's y axis", "m/s^2", -1e4, 1e4);
    LIMN_FIELD(
        orbit,
        "how far directions turn into circles around that axis in 1/60 s; between 0 and 1 it "
        "slows particles down",
        "", 0, 1);
    LIMN_FIELD(brake, "speed that is lost, down to rest", "m/s^2", 0, 1e4);
    LIMN_FIELD(fields, "factor on the forces of each force_field", "", -100, 100);
    LIMN_FIELD(
        integrator,
        .doc = "average: exact for constant forces; closed_form: by the age, under gravity alone; "
               "the others as in the book",
        .values = "average explicit_euler semi_implicit closed_form");
}

/// Particles fill a box around the camera: those that leave it on one side enter on the other
/// (engine.space-dust). They do not collide.
struct ParticleWrap {
    Vec3 size = {20, 20, 20};
};

LIMN_FIELDS(ParticleWrap) {
    LIMN_FIELD(size, "extents of the box along the world's axes; 0: unbounded", "m", 0, 1e5);
}

struct ColorKey {
    float at = 0;
    Vec3 color = {1, 1, 1};
    float opacity = 1;
};

LIMN_FIELDS(ColorKey) {
    LIMN_FIELD(at, "fraction of the life", "", 0, 1);
    LIMN_FIELD(color, .doc = "linear RGB", .min = 0, .max = 1000);
    LIMN_FIELD(opacity, "0 transparent, 1 opaque at the center", "", 0, 1);
}

/// Value at 0 .. 1: linear between keys, which may be in any order. 1 without keys.
[[nodiscard]] float sample_curve(const std::vector<CurveKey>& keys, float at);
/// Color and opacity likewise; white without keys.
[[nodiscard]] Vec4 sample_colors(const std::vector<ColorKey>& keys, float at);

enum class ParticleFacing : std::uint8_t {
    Camera,    ///< a disc toward the camera
    Velocity,  ///< along the velocity, as long as the path of `stretch` seconds
    Ground,    ///< flat on the world's xz plane
    Pixels,    ///< a point sprite: `size` in pixels, see `attenuation` (particle.gpu-draw)
    Point,     ///< a disc drawn as one vertex: the cheapest for specks
};

/// The order in which particles cover each other (particle.distance-sort).
enum class ParticleSort : std::uint8_t {
    Distance,   ///< from back to front, among the particles of all emitters
    Amortized,  ///< on the GPU by four passes a frame; on the CPU as Distance
    Births,     ///< oldest first, the emitter as a whole among the others
    Weighted,   ///< none: averaged with weights that fall with distance, as one layer in front of
                ///< all others
};

/// Which frames of its flipbook a particle shows.
enum class ParticleFrames : std::uint8_t {
    Play,     ///< from the first
    Shuffle,  ///< from a random one
    Pick,     ///< a random one for life
};

/// What is culled when it is out of view (particle.visibility).
enum class ParticleCulling : std::uint8_t {
    Particles,  ///< each by itself
    Bounds,     ///< all, if none is in view
    Emitter,    ///< all, if the emitter's shape is out of view: cheap, but particles that flew into
                ///< view vanish
};

/// The resolution that particles are drawn at.
enum class ParticleResolution : std::uint8_t {
    Full,
    Half,  ///< a quarter of the pixels, upsampled with depth edges kept; as one layer at their
           ///< median
};

/// Where the light that a particle scatters is evaluated.
enum class ParticleLitAt : std::uint8_t {
    Corners,  ///< at each corner of its quad
    Middle,   ///< once, as the mean of its corners: for particles that are small in the image
};

struct ParticleLook {
    ImageId image;
    std::uint32_t columns = 1;
    std::uint32_t rows = 1;
    ParticleFrames frames = ParticleFrames::Play;
    float frame_rate = 0;
    ImageId motion;
    float motion_strength = 0.25f;
    ImageId negative_light;
    float size = 0.1f;
    float size_spread = 0;
    std::vector<CurveKey> size_curve;
    std::vector<ColorKey> colors;
    PeriodicFunction color_function = constant_function(0);
    Vec3 color_spread = {0, 0, 0};
    float emission = 0;
    float lit = 1;
    float cover = 1;
    float forward = 0;
    ParticleFacing facing = ParticleFacing::Camera;
    ParticleLitAt lit_at = ParticleLitAt::Corners;
    Vec3 attenuation = {1, 0, 0};
    ParticleSort sort = ParticleSort::Distance;
    float stretch = 0.02f;
    float camera_streak = 0;
    float turn_spread = 3.1416f;
    float spin = 0;
    float spin_spread = 0;
    float tumble = 0;
    float softness = 0.2f;
    float near_fade = 0;
    float far_fade = 0;
    float fade = 0;
    ParticleCulling culling = ParticleCulling::Particles;
    float cull_margin = 0;
    float velocity_cover = 0.5f;
    float shadow = 0;
    Vec3 shadow_tint = {1, 1, 1};
    ParticleResolution resolution = ParticleResolution::Full;
};

LIMN_FIELDS(ParticleLook) {
    LIMN_FIELD(image, "an image of the level with opacity; none: a soft disc");
    LIMN_FIELD(columns, "of a flipbook: frames side by side in the image", "", 1, 64);
    LIMN_FIELD(rows, "of a flipbook, the first at the top", "", 1, 64);
    LIMN_FIELD(
        frames, .doc = "play: from the first; shuffle: from a random one; pick: a random one",
        .values = "play shuffle pick");
    LIMN_FIELD(frame_rate, "frames per second, repeated; 0: once in a life", "1/s", 0, 1000);
    LIMN_FIELD(
        motion,
        "of a flipbook: how far its content moves until the next frame, an image of the same "
        "frames that is not sRGB: red to the right, green downward, 128 of 255 at rest; none: "
        "frames cross-fade");
    LIMN_FIELD(
        motion_strength,
        "what 255 in that image means, and 1 in the opposite direction, as a fraction of a frame",
        "", 0, 1);
    LIMN_FIELD(
        negative_light,
        "with it the image holds how much of the light from six sides goes to the camera, 1 as a "
        "white surface that faces the light: red from the right, green from above, blue from "
        "behind; and this one, of the same frames: from the left, from below, from the camera; "
        "opacity: a factor on the emission. Neither is sRGB; for quads, not for ribbons");
    LIMN_FIELD(size, "diameter", "m", 0, 1e4);
    LIMN_FIELD(size_spread, "give or take", "m", 0, 1e4);
    LIMN_FIELD(size_curve, "factor on the size over the life, sampled at 32 equal intervals");
    LIMN_FIELD(
        colors, "color and opacity over the life, sampled at 32 equal intervals; none: white");
    LIMN_FIELD(
        color_function,
        "position in `colors`, 0 .. 1, by age instead of the life, unless base and amplitude are "
        "0");
    LIMN_FIELD(color_spread, "give or take of red, green and blue, once for each", "", 0, 1000);
    LIMN_FIELD(emission, .doc = "radiance of a white particle by itself", .min = 0, .max = 1e6);
    LIMN_FIELD(lit, .doc = "factor on the light that it scatters; 0: unlit", .min = 0, .max = 10);
    LIMN_FIELD(
        lit_at,
        .doc = "where that light is evaluated; middle: once, as the mean of the corners, at a "
               "fraction of the cost, for what is too small in the image to show a gradient; with "
               "`negative_light`, as a trail, beam or billboard and on the GPU: at the corners",
        .values = "corners middle");
    LIMN_FIELD(cover, "1: hides what is behind by its opacity, 0: only adds light", "", 0, 1);
    LIMN_FIELD(
        forward,
        "light from behind: 0 evenly, toward 1 ever more forward (Henyey and Greenstein 1941)", "",
        -0.95, 0.95);
    LIMN_FIELD(
        facing,
        .doc =
            "how the quad is turned; pixels: to the camera, with `size` in pixels; point: a disc "
            "without an image as one vertex instead of four, for specks of a few pixels: it is "
            "clipped with its center and has a maximum size, 64 pixels or more",
        .values = "camera velocity ground pixels point");
    LIMN_FIELD(
        attenuation,
        "of pixels: at the distance d the size is times sqrt(1 / (x + y d + z d^2)); not all 0", "",
        0, 1e6);
    LIMN_FIELD(
        sort,
        .doc = "which covers which: the nearer one; likewise by four passes of a sort a frame, on "
               "the GPU; the younger one; weighted: all are mixed without a sort, the nearer the "
               "heavier, at full resolution and in front of those that are sorted",
        .values = "distance amortized births weighted");
    LIMN_FIELD(stretch, "length of a streak: its path in this time; facing velocity", "s", 0, 10);
    LIMN_FIELD(
        camera_streak, "fraction of the camera's own velocity that streaks show; facing velocity",
        "", 0, 10);
    LIMN_FIELD(turn_spread, "initial angle, give or take", "rad", 0, 3.1416);
    LIMN_FIELD(spin, "rotation", "rad/s", -1000, 1000);
    LIMN_FIELD(spin_spread, "give or take", "rad/s", 0, 1000);
    LIMN_FIELD(
        tumble, "rotation about the quad's own up, so that it turns edge-on: leaves", "rad/s", 0,
        1000);
    LIMN_FIELD(softness, "depth over which it fades where it meets a surface", "m", 0, 100);
    LIMN_FIELD(near_fade, "distance of the camera within which it fades", "m", 0, 1000);
    LIMN_FIELD(
        far_fade, "distance beyond which it is invisible, fading from 0.6 of it; 0: none", "m", 0,
        1e5);
    LIMN_FIELD(fade, "it fades out over the last seconds of its life", "s", 0, 1e5);
    LIMN_FIELD(
        culling,
        .doc = "what is not drawn where it is out of view: each particle by itself; all of them, "
               "if none is in view; all, if the emitter's shape is not, even those that flew into "
               "view",
        .values = "particles bounds emitter");
    LIMN_FIELD(cull_margin, "by which the bounds for culling are enlarged", "m", 0, 1e5);
    LIMN_FIELD(
        velocity_cover,
        "opacity times cover above which a pixel moves with it instead of with what is behind, for "
        "motion blur and temporal antialiasing, but for streaks; opacity above which it is as "
        "sharp as the lens shows it, not as what is behind; 1: never",
        "", 0, 1);
    LIMN_FIELD(
        shadow,
        "fraction of the opacity that casts a shadow, on surfaces and particles, in the first "
        "directional light, or without one in the first spot with a shadow",
        "", 0, 1);
    LIMN_FIELD(
        shadow_tint, .doc = "factors on the optical depth of red, green and blue in the shadow",
        .min = 0, .max = 1);
    LIMN_FIELD(
        resolution,
        .doc = "half: a quarter of the pixels, for smoke that covers much of the image; one layer "
               "in the order at their median",
        .values = "full half");
}

/// Particles light surfaces and each other, as small lights without shadows.
struct ParticleLight {
    Vec3 color = {1, 1, 1};
    float intensity = 1;
    std::vector<CurveKey> curve{};
    float radius = 3;
    float share = 1;
    std::uint32_t count = 64;
};

LIMN_FIELDS(ParticleLight) {
    LIMN_FIELD(color, .doc = "linear RGB", .min = 0, .max = 100);
    LIMN_FIELD(intensity, "of each", "cd", 0, 1e6);
    LIMN_FIELD(curve, "factor on the intensity over the life");
    LIMN_FIELD(radius, "where its light ends", "m", 0.01, 1e4);
    LIMN_FIELD(share, "random fraction of the particles that are lights", "", 0, 1);
    LIMN_FIELD(count, "maximum number of lights, which are the oldest particles", "", 0, 1024);
}

/// The state of an emitter's births; kept by the systems.
struct EmitterClock {
    std::uint64_t born = 0;     ///< so far; also the number of the next random sequence
    std::uint64_t dropped = 0;  ///< births over capacity
    double time = 0;            ///< the emitter's own [s]
    double carry = 0;           ///< fraction of the next birth that is due
};

LIMN_FIELDS(EmitterClock) {
    LIMN_FIELD(born, "births so far");
    LIMN_FIELD(dropped, "births over capacity");
    LIMN_FIELD(time, "of the emitter", "s");
    LIMN_FIELD(carry, "fraction of the next birth that is due");
}

/// The particles of an emitter; kept by the systems. World space. Newborns are appended. Where
/// anything depends on their order (keeps_order in systems/particles/particle_deaths.h), they are
/// kept oldest first; otherwise the last ones fill the slots of the dead.
struct ParticlePool {
    std::vector<float> x, y, z;        ///< position [m]
    std::vector<float> vx, vy, vz;     ///< velocity [m/s]
    std::vector<float> age, life;      ///< [s]; dead at age >= life
    std::vector<std::uint32_t> look;   ///< random bits: size, angle, spin
    std::vector<std::uint32_t> stuck;  ///< 1: sticks to a surface; shorter: the rest does not
    EmitterClock clock;
    std::uint64_t fresh =
        0;  ///< number of particles at the end that were born since the dead were removed
    bool mixed = false;  ///< not oldest first

    [[nodiscard]] std::size_t size() const { return x.size(); }
};

LIMN_FIELDS(ParticlePool) {
    LIMN_FIELD(x, "positions", "m");
    LIMN_FIELD(y, "positions", "m");
    LIMN_FIELD(z, "positions", "m");
    LIMN_FIELD(vx, "velocities", "m/s");
    LIMN_FIELD(vy, "velocities", "m/s");
    LIMN_FIELD(vz, "velocities", "m/s");
    LIMN_FIELD(age, "ages", "s");
    LIMN_FIELD(life, "ages at death", "s");
    LIMN_FIELD(look, "random bits of each");
    LIMN_FIELD(stuck, "1 for those that stick to a surface");
    LIMN_FIELD(clock, "births so far, and the emitter's time");
    LIMN_FIELD(fresh, "births since the dead were removed");
    LIMN_FIELD(mixed, "whether they are in another order than that of their births");
}

[[nodiscard]] inline bool runs_on_gpu(const ParticleEmitter& emitter) {
    constexpr std::uint32_t kMany = 262144;
    return emitter.executor == ParticleExecutor::Gpu
           || (emitter.executor == ParticleExecutor::Auto && emitter.capacity >= kMany);
}

/// Bytes of the particles of a full emitter: in a ParticlePool, where none sticks, or on the GPU,
/// with what draws them there (render/particles/gpu_particle_pools.h).
[[nodiscard]] inline std::uint64_t particle_bytes(const ParticleEmitter& emitter) {
    constexpr std::uint64_t kPool = 8 * sizeof(float) + sizeof(std::uint32_t);
    constexpr std::uint64_t kGpu = 2 * sizeof(Vec4) + (1 + 7) * sizeof(std::uint32_t);
    return emitter.capacity * (runs_on_gpu(emitter) ? kGpu : kPool);
}

/// Copies of a prefab start without particles.
template <>
struct ComponentTraits<ParticlePool> : DefaultTraits {
    static constexpr bool in_prefabs = false;
};

}  // namespace limn
