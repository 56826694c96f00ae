#include "bench/oracles/skin_shapes.h"
#include "bench/oracles/velocity_oracle.h"
#include "bench/quality/quality_scene.h"
#include "content/make/models/shapes.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "systems/update_world.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace limn::velocity_quality {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 135;
/// [px] (design 7). Half floats may be truncated: another 1/1024 of the fastest along each axis.
double max_error(const HeadlessRenderer& headless) {
    return headless.device->caps().profile == gpu::Profile::Gpu ? 0.07 : 0.05;
}

struct MotionStage : QualityScene {
    Entity move(MeshId mesh, const Affine& before, const Affine& now) {
        const Entity entity = place(mesh, gray, now);
        world.get<PreviousWorldTransform>(entity).world = before;
        return entity;
    }
    const MaterialId gray = add(Material{.double_sided = true});
};

/// A camera that moves and turns.
oracle::CameraMotion moving_camera() {
    oracle::CameraMotion motion;
    motion.camera = {.fov_y = radians(55.0f), .near = 0.05f};
    motion.previous = look_at({0.2f, 0.4f, 1.8f}, {0.05f, 0.5f, 0});
    motion.current = look_at({0, 0.5f, 1.7f}, {0, 0.45f, 0});
    motion.width = kWidth;
    motion.height = kHeight;
    return motion;
}

RenderView view_of(const oracle::CameraMotion& motion) {
    return make_render_view(
        motion.camera, motion.current, motion.previous,
        {.width = motion.width,
         .height = motion.height,
         .alpha = static_cast<float>(motion.alpha),
         .previous_alpha = static_cast<float>(motion.previous_alpha)});
}

Affine turned(const Vec3& position, const Vec3& axis, float angle, const Vec3& scale = Vec3(1)) {
    return affine_from(position, rotation_about(axis, angle), scale);
}

// ---- moving objects

void populate_rigid(MotionStage& stage) {
    stage.move(
        stage.add(make_sphere({.radius = 0.5f, .segments = 24, .rings = 12})),
        turned({-0.7f, 0.5f, 0}, {0, 1, 1}, 0.2f, {1, 0.8f, 0.9f}),
        turned({-0.45f, 0.45f, 0.2f}, {0, 1, 1}, 0.6f, {1, 0.8f, 1}));
    stage.move(
        stage.add(make_box({.size = {0.7f, 0.7f, 0.7f}})),
        turned({0.75f, 0.3f, -0.5f}, {1, 0, 1}, -0.3f),
        turned({0.6f, 0.5f, -0.3f}, {1, 0, 1}, 0.2f));
}

void populate_crowd(MotionStage& stage) {
    Random random(1, 0, 0, 0);
    const MeshId ball = stage.add(make_sphere({.radius = 0.2f, .segments = 12, .rings = 6}));
    for (int i = 0; i < 20; ++i) {
        const Vec3 position = {
            random.uniform(-1.4f, 1.4f), random.uniform(-0.3f, 1.2f), random.uniform(-0.8f, 0.1f)};
        const Vec3 motion = 0.2f * random.direction();
        stage.move(
            ball, turned(position + motion, random.direction(), 0.5f),
            turned(position, random.direction(), 0.3f));
    }
}

void add_snakes(MotionStage& stage, Skinning skinning) {
    const SkinId skin = stage.add(oracle::make_chain(6, 0.2f));
    for (int i = 0; i < 3; ++i) {
        Random random(2, static_cast<std::uint64_t>(i), 0, 0);
        MeshData tube = oracle::make_tube(20, 10, 1);
        oracle::add_weights(tube, 6, 4, random);
        const bool scaled = skinning == Skinning::Linear;
        Pose pose;
        pose.previous = oracle::random_joints(6, 0.2f, 0.3f, scaled, random);
        pose.joints = oracle::random_joints(6, 0.2f, 0.3f, scaled, random);
        const Affine where = placed_at({0.8f * static_cast<float>(i - 1), 0, 0});
        const Entity entity = stage.move(stage.add(std::move(tube)), where, where);
        stage.world.add(entity, std::move(pose));
        stage.world.add(entity, Deformed{entity, skin, 0, skinning});
    }
}

void populate_linear(MotionStage& stage) {
    add_snakes(stage, Skinning::Linear);
}

void populate_dual(MotionStage& stage) {
    add_snakes(stage, Skinning::DualQuaternion);
}

void populate_morphs(MotionStage& stage) {
    Random random(3, 0, 0, 0);
    MeshData ball = make_sphere({.radius = 0.55f, .segments = 24, .rings = 12});
    oracle::add_morphs(ball, 4, 3, 0.12f, random);
    const Affine where = placed_at({0, 0.5f, 0});
    const Entity entity = stage.move(stage.add(std::move(ball)), where, where);
    stage.world.add(
        entity,
        MorphWeights{.weights = {0.9f, -0.3f, 0.5f, 1}, .previous = {0.1f, 0.6f, 0.4f, -0.5f}});
    stage.world.add(entity, Deformed{entity, {}, 0, Skinning::Linear});
}

// ---- the image against ray casting

/// Direction as hue, speed as saturation; gray is at rest.
Vec3 color_of(const glm::dvec2& velocity) {
    constexpr double kBright = 24;  // [px]
    const double speed = glm::length(velocity);
    const double angle = std::atan2(velocity.y, velocity.x);
    const auto saturation = static_cast<float>(std::min(speed / kBright, 1.0));
    Vec3 color;
    for (int c = 0; c < 3; ++c) {
        color[c] = 0.5f + 0.5f * static_cast<float>(std::cos(angle - c * 2.0943951));
    }
    return glm::mix(Vec3(0.2f), color, saturation);
}

struct Agreement {
    double worst = 0;      ///< [px]
    double fastest = 0;    ///< [px]
    double compared = 0;   ///< fraction of the pixels
    double worst_sky = 0;  ///< [px]
};

Agreement compare(
    HeadlessRenderer& headless, const MotionStage& stage, const oracle::CameraMotion& motion,
    QualityImage* image) {
    oracle::VelocityOracle rays(motion);
    rays.add(stage.world);
    const FrameOutput out = render_frame(
        *headless.renderer, stage.world, view_of(motion), {.aovs = {"depth", "velocity"}});
    const gpu::FloatImage depth = gpu::read_floats(*out.aovs[0].texture);
    const gpu::FloatImage velocity = gpu::read_floats(*out.aovs[1].texture);
    Agreement found;
    int compared = 0;
    for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
            const auto hit = rays.at(x + 0.5, y + 0.5);
            const glm::dvec2 expected = hit ? hit->velocity : rays.sky(x + 0.5, y + 0.5);
            const glm::dvec2 measured(velocity.at(x, y, 0), velocity.at(x, y, 1));
            if (image != nullptr) {
                image->effect.pixels.push_back(color_of(measured));
                image->oracle.pixels.push_back(color_of(expected));
            }
            // At silhouettes, ray and rasterizer may disagree on coverage.
            const double distance = depth.at(x, y, 0);
            const bool sky = depth.at(x, y, 0) == kNoDepth;
            if (hit.has_value() == sky
                || (hit && std::abs(hit->distance - distance) > 2e-3 * distance)) {
                continue;
            }
            ++compared;
            double& worst = sky ? found.worst_sky : found.worst;
            worst = std::max(worst, glm::distance(measured, expected));
            found.fastest = std::max(found.fastest, sky ? 0.0 : glm::length(expected));
        }
    }
    found.compared = static_cast<double>(compared) / (kWidth * kHeight);
    return found;
}

void measure_scene(
    HeadlessRenderer& headless, const char* name, void (*populate)(MotionStage&),
    QualityReport& report, double& worst_sky, double& min_compared) {
    MotionStage stage;
    populate(stage);
    double worst = 0;
    double fastest = 0;
    for (const auto& [alpha, before] : {std::pair(1.0, 0.0), std::pair(0.6, -0.2)}) {
        oracle::CameraMotion motion = moving_camera();
        motion.alpha = alpha;
        motion.previous_alpha = before;
        QualityImage image;
        image.title = name;
        image.effect = {.width = kWidth, .height = kHeight, .pixels = {}};
        image.oracle = image.effect;
        const bool shown = alpha == 1.0;
        const Agreement found = compare(headless, stage, motion, shown ? &image : nullptr);
        worst = std::max(worst, found.worst);
        fastest = std::max(fastest, found.fastest);
        worst_sky = std::max(worst_sky, found.worst_sky);
        min_compared = std::min(min_compared, found.compared);
        if (shown) {
            report.images.push_back(std::move(image));
        }
    }
    report.at_most(
        fmt::format("{}: largest difference from ray casting", name), worst, max_error(headless),
        "px");
    report.inform(fmt::format("{}: fastest pixel", name), fastest, "px");
}

// ---- zero velocity

double fastest(HeadlessRenderer& headless, const World& world, const RenderView& view) {
    const FrameOutput out = render_frame(*headless.renderer, world, view, {.aovs = {"velocity"}});
    const gpu::FloatImage velocity = gpu::read_floats(*out.aovs[0].texture);
    double most = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const double speed = std::hypot(velocity.at(x, y, 0), velocity.at(x, y, 1));
            most = std::isfinite(speed) ? std::max(most, speed) : INFINITY;
        }
    }
    return most;
}

void measure_stillness(HeadlessRenderer& headless, QualityReport& report) {
    const auto add = [&](const char* name, double found) { report.at_most(name, found, 0, "px"); };
    MotionStage stage;
    Schedule schedule = make_world_schedule();
    const Entity ball = stage.world.create(
        Transform{.position = {0, 0.5f, 0}},
        MeshInstance{stage.add(make_sphere({.radius = 0.4f})), stage.gray});
    oracle::CameraMotion still = moving_camera();
    still.previous = still.current;
    start_world(stage.world);
    add("in the first frame", fastest(headless, stage.world, view_of(still)));
    stage.world.get<Transform>(ball).position.x = 0.3f;
    stage.world.add(ball, Teleport{});
    step_world(stage.world, schedule);
    add("after a teleport", fastest(headless, stage.world, view_of(still)));
    oracle::CameraMotion jump = moving_camera();
    jump.previous = look_at({0, 0.5f, 20}, {0, 0.5f, 0});
    add("after a camera cut", fastest(headless, stage.world, view_of(jump)));
}

Status measure_velocity(HeadlessRenderer& headless, QualityReport& report) {
    double worst_sky = 0;
    double min_compared = 1;
    const auto measure = [&](const char* name, void (*populate)(MotionStage&)) {
        measure_scene(headless, name, populate, report, worst_sky, min_compared);
    };
    measure("rigid", populate_rigid);
    measure("instances of one mesh", populate_crowd);
    measure("skinned, linear blend", populate_linear);
    measure("skinned, dual quaternions", populate_dual);
    measure("morphed", populate_morphs);
    report.at_most(
        "sky: largest difference from ray casting", worst_sky, max_error(headless), "px");
    report.at_least("pixels compared (the others are silhouettes)", 100 * min_compared, 97, "%");
    measure_stillness(headless, report);
    return Done{};
}

const RegisterQuality kRegistered(
    "velocity", "rays in double precision against triangles, tracked between both times",
    measure_velocity);

}  // namespace
}  // namespace limn::velocity_quality
