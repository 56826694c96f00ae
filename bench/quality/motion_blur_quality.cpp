#include "bench/oracles/motion_blur_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/creature.h"
#include "content/make/models/creature_gait.h"
#include "content/make/models/shapes.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_blur.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace limn::motion_blur_quality {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSubframes = 128;
constexpr float kShutter = 180;
constexpr double kMinPsnr = 32;  // [dB] (design 7)

/// Pose at a time, in frames: 0 is the frame shown, -1 the previous frame.
using Path = std::function<Affine(double time)>;

/// A scene whose objects can be posed at any time.
struct MovingScene : QualityScene {
    struct Mover {
        Entity entity;
        Path path;
    };
    std::vector<Mover> movers;
    std::function<void(World& world, double time)> deform;  ///< poses what deforms; may be empty
    Path camera;
    float fov_y = radians(50.0f);

    Entity move(MeshId mesh, MaterialId material, Path path) {
        const Entity entity = place(mesh, material, path(0));
        movers.push_back({entity, std::move(path)});
        return entity;
    }

    /// Poses the world at `time`, with the previous poses one frame earlier.
    void set_time(double time) {
        for (const Mover& mover : movers) {
            world.get<WorldTransform>(mover.entity).world = mover.path(time);
            world.get<PreviousWorldTransform>(mover.entity).world = mover.path(time - 1);
        }
        if (deform) {
            deform(world, time);
        }
    }
    [[nodiscard]] RenderView view_at(double time) const {
        return make_render_view(
            {.fov_y = fov_y, .near = 0.05f}, camera(time), camera(time - 1),
            {.width = kWidth, .height = kHeight});
    }
};

// ---- parts of the scenes

Affine
posed(const Vec3& position, const Quat& rotation = {1, 0, 0, 0}, const Vec3& scale = Vec3(1)) {
    return affine_from(position, rotation, scale);
}

Path still(const Affine& pose) {
    return [pose](double) { return pose; };
}

/// Linear motion by `step` per frame.
Path straight(const Vec3& position, const Vec3& step, const Quat& rotation = {1, 0, 0, 0}) {
    return [=](double time) { return posed(position + static_cast<float>(time) * step, rotation); };
}

/// A texture with detail at several scales: speckled tiles in two tones, with lines between them.
MaterialId tiled(MovingScene& scene, const Vec3& light, const Vec3& dark, float repeats) {
    constexpr int kSide = 64;
    ImageData image{.name = "tiles", .width = kSide, .height = kSide, .srgb = true, .pixels = {}};
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const bool line = x % 16 == 0 || y % 16 == 0;
            const bool even = (x / 16 + y / 16) % 2 == 0;
            const unsigned speck = (static_cast<unsigned>(x * 73 + y * 151) * 2654435761u) >> 29;
            const Vec3 color = line ? 0.5f * dark : even ? light : dark;
            for (int c = 0; c < 3; ++c) {
                const float value = color[c] * (0.85f + 0.02f * static_cast<float>(speck));
                image.pixels.push_back(static_cast<std::uint8_t>(255 * std::min(value, 1.0f)));
            }
            image.pixels.push_back(255);
        }
    }
    Material material{.base_color = {1, 1, 1, 1}, .roughness = 0.8f};
    material.base_color_texture.image = scene.add(std::move(image));
    material.base_color_texture.scale = {repeats, repeats};
    return scene.add(material);
}

void watch_from(MovingScene& scene, const Vec3& eye, const Vec3& target) {
    scene.camera = still(look_at(eye, target));
}

/// A wall by daylight, seen from the front.
void add_wall(MovingScene& scene, Path path = still(posed({0, 1, -3}))) {
    add_daylight(scene);
    const MaterialId wall = tiled(scene, {0.85f, 0.75f, 0.6f}, {0.55f, 0.4f, 0.3f}, 8);
    scene.move(scene.add(make_box({.size = {24, 12, 0.2f}})), wall, std::move(path));
    watch_from(scene, {0, 1, 4}, {0, 1, 0});
}

void add_court(MovingScene& scene) {
    add_daylight(scene);
    populate_court(scene);
    scene.fov_y = radians(42.0f);
}

// ---- the scenes of design 7

/// A ball flies past a wall.
void populate_rigid(MovingScene& scene) {
    add_wall(scene);
    scene.move(
        scene.add(make_sphere({.radius = 0.75f, .segments = 48, .rings = 24})),
        tiled(scene, {0.95f, 0.5f, 0.2f}, {0.35f, 0.1f, 0.1f}, 4),
        straight({0, 1, 0}, {0.85f, 0.2f, 0}));
}

/// A moving wall behind posts at rest.
void populate_static_foreground(MovingScene& scene) {
    add_wall(scene, straight({0, 1, -3}, {1.6f, 0, 0}));
    const MaterialId post = tiled(scene, {0.3f, 0.6f, 0.35f}, {0.1f, 0.25f, 0.15f}, 2);
    const MeshId mesh = scene.add(make_box({.size = {0.35f, 3, 0.35f}}));
    for (int i = -2; i <= 2; ++i) {
        scene.move(mesh, post, still(posed({1.1f * static_cast<float>(i), 1, 0})));
    }
}

/// Two boxes and a ball with crossing paths.
void populate_crossing(MovingScene& scene) {
    add_wall(scene);
    const MaterialId red = tiled(scene, {0.9f, 0.25f, 0.2f}, {0.4f, 0.08f, 0.08f}, 3);
    const MaterialId blue = tiled(scene, {0.3f, 0.5f, 0.95f}, {0.1f, 0.15f, 0.4f}, 3);
    const MeshId box = scene.add(make_box({.size = {1, 1, 0.4f}}));
    scene.move(box, red, straight({-0.3f, 1.1f, 0.4f}, {0.7f, 0, 0}));
    scene.move(box, blue, straight({0.5f, 0.8f, -0.6f}, {0, 0.8f, 0}));
    scene.move(
        scene.add(make_sphere({.radius = 0.4f, .segments = 32, .rings = 16})), blue,
        straight({-1.4f, 1.4f, -1}, {0.4f, -0.5f, 0}));
}

/// A wheel with spokes rolls in front of the wall.
void populate_wheel(MovingScene& scene) {
    add_wall(scene);
    const MaterialId tire = tiled(scene, {0.25f, 0.25f, 0.28f}, {0.08f, 0.08f, 0.1f}, 12);
    const MaterialId spoke = tiled(scene, {0.95f, 0.85f, 0.3f}, {0.5f, 0.4f, 0.1f}, 2);
    constexpr float kTurn = -0.5f;  // [rad] per frame
    constexpr float kRadius = 1.05f;
    const auto roll = [](const Affine& part) {
        return [part](double time) {
            const float turned = kTurn * static_cast<float>(time);
            return posed({-kRadius * turned, 1, 0}, glm::angleAxis(turned, Vec3(0, 0, 1))) * part;
        };
    };
    scene.move(
        scene.add(make_torus({.radius = 0.9f, .tube = 0.15f, .segments = 64, .sides = 16})), tire,
        roll(posed({0, 0, 0}, glm::angleAxis(radians(90.0f), Vec3(1, 0, 0)))));
    const MeshId bar = scene.add(make_box({.size = {1.75f, 0.12f, 0.08f}}));
    for (int i = 0; i < 3; ++i) {
        scene.move(
            bar, spoke,
            roll(posed(
                {0, 0, 0}, glm::angleAxis(radians(60.0f * static_cast<float>(i)), Vec3(0, 0, 1)))));
    }
}

/// A galloping creature, at ten frames per second.
void populate_gallop(MovingScene& scene) {
    constexpr float kFrame = 1.0f / 10;  // [s]
    constexpr float kShown = 0.13f;      // time in the clip at which both hind legs push [s]
    add_wall(scene, still(posed({0, 1, -1.5f})));
    const CreatureShape shape{.detail = 0.014f};
    MeshRig rig = make_creature_rig(shape);
    const auto run = std::find_if(rig.clips.begin(), rig.clips.end(), [](const ClipData& clip) {
        return clip.name == "run";
    });
    const Gait& gait = creature_gaits().back();
    const SkinId skin = scene.add(rig.skin);
    const Quat sideways = glm::angleAxis(radians(90.0f), Vec3(0, 1, 0));
    const Entity creature = scene.move(
        scene.add(make_creature(shape)),
        scene.add(Material{.base_color = {0.9f, 0.6f, 0.35f, 1}, .roughness = 0.8f}),
        straight({0, 0, 0}, {gait_speed(gait) * kFrame, 0, 0}, sideways));
    const std::size_t joints = rig.skeleton.parents.size();
    scene.world.add(creature, Pose{std::vector<Affine>(joints), std::vector<Affine>(joints)});
    scene.world.add(creature, Deformed{creature, skin, 0, Skinning::Linear});
    scene.deform = [skeleton = rig.skeleton, clip = *run, creature](World& world, double time) {
        auto& pose = world.get<Pose>(creature);
        LocalPose scratch;
        std::vector<float> weights(2);
        const float seconds = kShown + kFrame * static_cast<float>(time);
        const auto at = [&](float t) { return clip_time(clip.duration, t, true); };
        evaluate_pose(skeleton, &clip, at(seconds), scratch, pose.joints, weights);
        evaluate_pose(skeleton, &clip, at(seconds - kFrame), scratch, pose.previous, weights);
    };
    watch_from(scene, {0.1f, 0.35f, 1.3f}, {0.1f, 0.25f, 0});
}

/// A ball deformed by two morph targets of changing weights.
void populate_morph(MovingScene& scene) {
    add_wall(scene);
    MeshData ball = make_sphere({.radius = 0.9f, .segments = 64, .rings = 32});
    MorphTarget flat;
    flat.name = "flat";
    MorphTarget lean;
    lean.name = "lean";
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const Vec3 p = ball.positions[i];
        flat.vertices.push_back(static_cast<std::uint32_t>(i));
        flat.positions.push_back({0.5f * p.x, -0.5f * p.y, 0.2f * p.z});
        lean.vertices.push_back(static_cast<std::uint32_t>(i));
        lean.positions.push_back({0.6f * p.y, 0, 0});
    }
    ball.morphs = {std::move(flat), std::move(lean)};
    const Entity entity = scene.move(
        scene.add(std::move(ball)), tiled(scene, {0.95f, 0.5f, 0.2f}, {0.35f, 0.1f, 0.1f}, 4),
        still(posed({0, 1, 0})));
    scene.world.add(entity, MorphWeights{});
    scene.world.add(entity, Deformed{entity, {}, 0, Skinning::Linear});
    scene.deform = [entity](World& world, double time) {
        const auto weights = [](double at) {
            const auto t = static_cast<float>(at);
            return std::vector<float>{0.4f + 1.2f * t, 1.5f * t};
        };
        auto& morphs = world.get<MorphWeights>(entity);
        morphs.weights = weights(time);
        morphs.previous = weights(time - 1);
    };
}

/// The camera pans in the courtyard.
void populate_pan(MovingScene& scene) {
    add_court(scene);
    scene.camera = [](double time) {
        const float turn = 0.09f * static_cast<float>(time);
        const Vec3 forward = kCourtTarget - kCourtEye;
        return look_at(kCourtEye, kCourtEye + glm::angleAxis(turn, Vec3(0, 1, 0)) * forward);
    };
}

/// The camera tracks past the courtyard.
void populate_run(MovingScene& scene) {
    add_court(scene);
    scene.camera = [](double time) {
        const Vec3 moved = static_cast<float>(time) * Vec3(0.3f, 0, -0.25f);
        return look_at(kCourtEye + moved, kCourtTarget + moved);
    };
}

// ---- measurements

gpu::FloatImage accumulate(HeadlessRenderer& headless, MovingScene& scene) {
    oracle::MeanImage mean;
    for (int i = 0; i < kSubframes; ++i) {
        const double time = oracle::exposure_sample_time(i, kSubframes, kShutter);
        scene.set_time(time);
        mean.add(scene.render(headless, scene.view_at(time)));
    }
    return mean.mean();
}

gpu::FloatImage blur(HeadlessRenderer& headless, MovingScene& scene) {
    scene.set_time(0);
    scene.world.insert_resource(MotionBlur{.shutter = kShutter});
    const gpu::FloatImage image = scene.render(headless, scene.view_at(0));
    scene.world.remove_resource<MotionBlur>();
    return image;
}

struct SceneToMeasure {
    const char* name;
    void (*populate)(MovingScene& scene);
};

void measure_scene(
    HeadlessRenderer& headless, const SceneToMeasure& wanted, QualityReport& report) {
    MovingScene scene;
    wanted.populate(scene);
    scene.set_time(0);
    const ColorImage sharp = displayed(scene.render(headless, scene.view_at(0)));
    const ColorImage truth = displayed(accumulate(headless, scene));
    ColorImage effect = displayed(blur(headless, scene));
    report.at_least(fmt::format("{}, PSNR", wanted.name), psnr(effect, truth), kMinPsnr, "dB");
    report.inform(
        fmt::format("{}, PSNR of the sharp image", wanted.name), psnr(sharp, truth), "dB");
    report.images.push_back({wanted.name, std::move(effect), truth});
}

/// Fraction of a bright bar's smear, on a black background, that lies outside its silhouette.
void measure_smear(HeadlessRenderer& headless, QualityReport& report) {
    MovingScene scene;
    watch_from(scene, {0, 1, 4}, {0, 1, 0});
    scene.move(
        scene.add(make_box({.size = {1.6f, 1.6f, 0.1f}})),
        scene.add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}}),
        straight({0, 1, 0}, {1, 0, 0}));
    scene.set_time(0);
    const gpu::FloatImage sharp = scene.render(headless, scene.view_at(0));
    const gpu::FloatImage blurred = blur(headless, scene);
    double smeared = 0;
    double outside = 0;
    double light = 0;
    double sharp_light = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const float value = blurred.at(x, y, 0);
            const bool partly = value > 0.01f && value < 0.99f;
            smeared += partly ? 1 : 0;
            outside += partly && sharp.at(x, y, 0) == 0.0f ? 1 : 0;
            light += static_cast<double>(value);
            sharp_light += static_cast<double>(sharp.at(x, y, 0));
        }
    }
    const double percentage = 100 * outside / std::max(smeared, 1.0);
    report.at_most(
        "smear outside the silhouette, difference from half", std::abs(percentage - 50), 3, "%");
    report.at_most("energy error of a smear", 100 * std::abs(light / sharp_light - 1), 1, "%");
}

Status measure_motion_blur(HeadlessRenderer& headless, QualityReport& report) {
    for (const SceneToMeasure& scene :
         {SceneToMeasure{"a ball in front of a wall", populate_rigid},
          SceneToMeasure{"static posts in front of a moving wall", populate_static_foreground},
          SceneToMeasure{"crossing boxes", populate_crossing},
          SceneToMeasure{"a rolling wheel", populate_wheel},
          SceneToMeasure{"a galloping creature", populate_gallop},
          SceneToMeasure{"a morphing ball", populate_morph},
          SceneToMeasure{"a panning camera", populate_pan},
          SceneToMeasure{"a tracking camera", populate_run}}) {
        measure_scene(headless, scene, report);
    }
    measure_smear(headless, report);
    return Done{};
}

const RegisterQuality
    kRegistered("motion-blur", "the mean of 128 frames within the exposure", measure_motion_blur);

}  // namespace
}  // namespace limn::motion_blur_quality
