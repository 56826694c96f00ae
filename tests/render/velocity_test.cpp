// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
// clang-format on
#include "bench/oracles/velocity_oracle.h"
#include "ecs/components/rendering.h"
#include "systems/update_world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace limn::test::velocity_test {
namespace {

constexpr int kSize = 96;

/// How far the images' velocities are from what rays say.
struct Agreement {
    double worst = 0;    ///< [px]
    double fastest = 0;  ///< [px]
    int compared = 0;    ///< pixels
};

struct VelocityScene : SkinScene {
    /// A camera that moves a little and turns.
    oracle::CameraMotion moving_camera() const {
        oracle::CameraMotion motion;
        motion.camera = {.fov_y = radians(70.0f), .near = 0.05f};
        motion.previous = look_at({0.15f, 0.4f, 1.7f}, {0.05f, 0.5f, 0});
        motion.current = look_at({0, 0.5f, 1.6f}, {0, 0.45f, 0});
        motion.width = kSize;
        motion.height = kSize;
        motion.previous_alpha = 0;
        return motion;
    }
    static RenderView view_of(const oracle::CameraMotion& motion, const Vec2& jitter = {0, 0}) {
        return make_render_view(
            motion.camera, motion.current, motion.previous,
            {.width = motion.width,
             .height = motion.height,
             .jitter = jitter,
             .alpha = static_cast<float>(motion.alpha),
             .previous_alpha = static_cast<float>(motion.previous_alpha)});
    }
    /// Every third pixel of the image against rays, at the moments and with the jitter given.
    Agreement agreement(const oracle::CameraMotion& motion, const Vec2& jitter = {0, 0}) {
        oracle::VelocityOracle rays(motion);
        rays.add(world);
        const FrameOutput out = draw(view_of(motion, jitter), {.aovs = {"depth", "velocity"}});
        const gpu::FloatImage depth = gpu::read_floats(*out.aovs[0].texture);
        const gpu::FloatImage velocity = gpu::read_floats(*out.aovs[1].texture);
        Agreement found;
        for (int y = 0; y < motion.height; y += 3) {
            for (int x = 0; x < motion.width; x += 3) {
                // The image is moved by the jitter, right and up.
                const glm::dvec2 point(x + 0.5 - jitter.x, y + 0.5 + jitter.y);
                const auto want = rays.at(point.x, point.y);
                const float distance = depth.at(x, y, 0);
                const bool sky = distance == kNoDepth;
                // The rim: the ray meets what the rasterizer does not, or another triangle.
                if (want.has_value() == sky
                    || (want && std::abs(want->distance - distance) > 2e-3 * want->distance)) {
                    continue;
                }
                const glm::dvec2 is = want ? want->velocity : rays.sky(point.x, point.y);
                const glm::dvec2 got(velocity.at(x, y, 0), velocity.at(x, y, 1));
                found.worst = std::max(found.worst, glm::distance(got, is));
                found.fastest = std::max(found.fastest, want ? glm::length(is) : 0.0);
                ++found.compared;
            }
        }
        return found;
    }
    void check_agreement(const oracle::CameraMotion& motion) {
        for (const auto& [alpha, before] :
             {std::pair(1.0, 0.0), std::pair(0.7, 0.3), std::pair(0.2, -0.6)}) {
            oracle::CameraMotion at = motion;
            at.alpha = alpha;
            at.previous_alpha = before;
            const Agreement found = agreement(at);
            CHECK(found.worst <= 0.05);
            CHECK(found.fastest >= 2.0);
            CHECK(found.compared >= 950);  // of 1024
        }
    }
    Entity moving(MeshId mesh, const Affine& before, const Affine& now) {
        return world.create(
            MeshInstance{mesh, gray}, WorldTransform{now}, PreviousWorldTransform{before});
    }
    Entity snake(Skinning skinning, std::uint64_t seed) {
        Random random(seed, 0, 0, 0);
        MeshData tube = make_tube(16, 8, 1);
        add_weights(tube, 5, 3, random);
        Pose pose;
        pose.previous = random_joints(5, 0.25f, 0.35f, skinning == Skinning::Linear, random);
        pose.joints = random_joints(5, 0.25f, 0.35f, skinning == Skinning::Linear, random);
        const SkinId skin = add_skin(make_chain(5, 0.25f));
        return SkinScene::pose(add(std::move(tube)), gray, skin, std::move(pose), skinning);
    }
    /// The largest speed in the image [px]; not a number if one is not.
    float fastest(const RenderView& view) {
        float most = 0;
        const gpu::FloatImage velocity = aov(view, "velocity");
        for (int y = 0; y < view.height; ++y) {
            for (int x = 0; x < view.width; ++x) {
                const float speed = std::hypot(velocity.at(x, y, 0), velocity.at(x, y, 1));
                if (!std::isfinite(speed)) {
                    return NAN;
                }
                most = std::max(most, speed);
            }
        }
        return most;
    }

    const MaterialId gray = add(Material{.double_sided = true});
};

Affine turned(const Vec3& position, const Vec3& axis, float angle, const Vec3& scale = Vec3(1)) {
    return affine_from(position, rotation_about(axis, angle), scale);
}

}  // namespace

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: rigid bodies, the sky and the camera match ray casting") {
    moving(
        add(make_ball(16)), turned({-0.3f, 0.5f, 0}, {0, 1, 1}, 0.2f, {0.3f, 0.4f, 0.3f}),
        turned({-0.1f, 0.45f, 0.2f}, {0, 1, 1}, 0.6f, {0.3f, 0.4f, 0.35f}));
    moving(
        add(make_square()), turned({0.5f, 0.3f, -0.5f}, {1, 0, 0}, -0.3f, Vec3(0.4f)),
        turned({0.45f, 0.5f, -0.7f}, {1, 0, 0}, -0.5f, Vec3(0.4f)));
    check_agreement(moving_camera());
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: skinned meshes match ray casting, as linear blends") {
    snake(Skinning::Linear, 1);
    check_agreement(moving_camera());
}

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: skinned meshes match ray casting, as dual quaternions") {
    const Entity entity = snake(Skinning::DualQuaternion, 2);
    world.get<PreviousWorldTransform>(entity).world = at({0.1f, 0, 0.05f});
    // Mixed matrices are no rotations: the oracle's columns are made perpendicular after the mix,
    // as the renderer's are.
    check_agreement(moving_camera());
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: morphing meshes match ray casting") {
    Random random(3, 0, 0, 0);
    MeshData ball = make_ball(10);
    for (Vec3& p : ball.positions) {
        p = 0.5f * p + Vec3(0, 0.5f, 0);
    }
    ball.bounds = {{-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}};
    add_morphs(ball, 4, 3, 0.1f, random);
    const Entity entity = moving(add(std::move(ball)), {}, {});
    world.add(
        entity,
        MorphWeights{.weights = {0.9f, -0.3f, 0.5f, 1}, .previous = {0.1f, 0.6f, 0.4f, -0.5f}});
    world.add(entity, Deformed{entity, {}, 0, Skinning::Linear});
    check_agreement(moving_camera());
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: each of many instances of one mesh has its own") {
    Random random(4, 0, 0, 0);
    const MeshId ball = add(make_ball(6));
    for (int i = 0; i < 12; ++i) {
        const Vec3 position = {
            random.uniform(-0.8f, 0.8f), random.uniform(-0.2f, 1.2f), random.uniform(-0.5f, 0.2f)};
        const Affine before =
            turned(position + 0.2f * random.direction(), random.direction(), 0.5f, Vec3(0.2f));
        moving(ball, before, turned(position, random.direction(), 0.3f, Vec3(0.2f)));
    }
    check_agreement(moving_camera());
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: jitter is no motion") {
    snake(Skinning::Linear, 5);
    const Agreement found = agreement(moving_camera(), {0.45f, -0.4f});
    CHECK(found.worst <= 0.05);
    CHECK(found.compared >= 950);
    oracle::CameraMotion still = moving_camera();
    still.previous = still.current;
    world.clear();
    place(add(make_ball(8)), gray, at({0, 0.5f, 0}));
    CHECK(fastest(view_of(still, {0.45f, -0.4f})) == 0);
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: all light methods and the half image agree") {
    snake(Skinning::Linear, 6);
    const RenderView view = view_of(moving_camera());
    const gpu::FloatImage want = aov(view, "velocity");
    for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        CHECK(aov(view, "velocity").pixels == want.pixels);
    }
}

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: spawned and teleported instances have none in their first frame") {
    Schedule schedule = make_world_schedule();
    const MeshId ball = add(make_ball(8));
    const Entity entity = world.create(
        Transform{.position = {0, 0.5f, 0}, .scale = Vec3(0.4f)}, MeshInstance{ball, gray});
    oracle::CameraMotion still = moving_camera();
    still.previous = still.current;
    const RenderView view = view_of(still);
    start_world(world);
    CHECK(fastest(view) == 0);
    world.get<Transform>(entity).position.x += 0.2f;
    step_world(world, schedule);
    CHECK(fastest(view) > 2);
    world.get<Transform>(entity).position.x -= 0.3f;
    world.add(entity, Teleport{});
    step_world(world, schedule);
    CHECK(fastest(view) == 0);
    // A character, too: its joints jump with it.
    auto& assets = world.resource<Assets>();
    SkeletonData skeleton;
    skeleton.joints = {"a", "b"};
    skeleton.parents = {-1, 0};
    skeleton.rest = {
        {{0, 0, 0}, {0, 0.5f, 0}}, {{1, 0, 0, 0}, {1, 0, 0, 0}}, {{1, 1, 1}, {1, 1, 1}}};
    assets.skeletons.push_back(skeleton);
    ClipSheet sheet;
    sheet.times = {1.0f / 60, 2.0f / 60};
    sheet.rotating = {1};
    sheet.rotations = {Quat(1, 0, 0, 0), rotation_about({0, 0, 1}, 1)};
    assets.clips.push_back({.name = "bend", .duration = 3, .sheets = {sheet}});
    Random random(7, 0, 0, 0);
    MeshData tube = make_tube(8, 8, 1);
    add_weights(tube, 2, 2, random);
    world.destroy(entity);
    for (const bool teleports : {false, true}) {
        const Entity character = world.create(
            Transform{}, Skeleton{{0}}, ClipPlayer{.clip = {0}}, MeshInstance{add(tube), gray});
        world.add(
            character, Deformed{character, add_skin(make_chain(2, 0.5f)), 0, Skinning::Linear});
        start_world(world);
        CHECK(fastest(view) == 0);
        step_world(world, schedule);
        CHECK(fastest(view) == 0);  // the clip has not moved it yet
        if (teleports) {
            world.add(character, Teleport{});
        }
        step_world(world, schedule);
        CHECK((fastest(view) > 2) == !teleports);
        world.destroy(character);
    }
}

TEST_CASE_FIXTURE(VelocityScene, "velocity: a camera that jumps shows no motion, a fast one does") {
    place(add(make_ball(8)), gray, at({0, 0.5f, 0}));
    oracle::CameraMotion motion = moving_camera();
    CHECK(fastest(view_of(motion)) > 2);
    motion.previous = look_at({0, 0.5f, 11.7f}, {0, 0.5f, 0});
    CHECK(fastest(view_of(motion)) == 0);
    motion.previous = look_at({0, 0.5f, 1.6f}, {1.6f, 0.5f, 1.0f});  // 70 degrees
    CHECK(fastest(view_of(motion)) == 0);
    // Nor is it drawn anywhere between the two positions.
    const RenderView between = make_render_view(
        motion.camera, motion.current, motion.previous, {.width = 9, .height = 9, .alpha = 0.5f});
    CHECK(between.world_from_camera.row[0] == motion.current.row[0]);
}

TEST_CASE_FIXTURE(
    VelocityScene,
    "velocity: a jump within a step is drawn on one side or the other and shows no motion") {
    const auto small_at = [](float x) {
        return affine_from({x, 0.5f, 0}, Quat(1, 0, 0, 0), Vec3(0.2f));
    };
    const Entity ball = moving(add(make_ball(8)), small_at(-0.4f), small_at(-0.4f));
    oracle::CameraMotion still = moving_camera();
    still.previous = still.current;
    StepJumps jumps;
    jumps.transforms.push_back({ball, 0.5f, small_at(0.4f)});
    world.insert_resource(jumps);
    for (const double alpha : {0.25, 0.75, 1.0}) {
        for (const double previous_alpha : {-1.0, 0.0}) {
            still.alpha = alpha;
            still.previous_alpha = previous_alpha;
            CHECK(fastest(view_of(still)) == 0);
        }
        const FrameOutput out = draw(view_of(still), {.aovs = {"depth"}});
        const gpu::FloatImage depth = gpu::read_floats(*out.aovs[0].texture);
        const int row = kSize / 2;
        CHECK((depth.at(kSize / 3, row, 0) != kNoDepth) == (alpha >= 0.5));
        CHECK((depth.at(kSize - kSize / 3, row, 0) != kNoDepth) == (alpha < 0.5));
    }
}

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: the sky moves when the camera rotates, not when it translates") {
    oracle::CameraMotion motion = moving_camera();
    motion.previous = look_at({0, 0.5f, 1.6f}, {0.1f, 0.42f, 0});
    const Agreement turning = agreement(motion);
    CHECK(turning.compared >= 1024);
    CHECK(turning.worst <= 0.01);
    CHECK(fastest(view_of(motion)) > 2);
    motion.previous = motion.current;
    motion.previous.row[0].w += 0.5f;
    CHECK(fastest(view_of(motion)) == 0);
}

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: every value is finite and within bounds, whatever the input") {
    const Entity body = moving(add(make_square()), at({0, 0.5f, 0}), at({0, 0.5f, 0}));
    const Entity character = snake(Skinning::Linear, 8);
    const RenderView view = view_of(moving_camera());
    const auto bounded = [&] { return fastest(view) <= 8.01f * kSize; };
    world.get<PreviousWorldTransform>(body).world = at({NAN, 0, 0});
    CHECK(bounded());
    world.get<PreviousWorldTransform>(body).world = at({1e30f, -1e38f, 1e30f});
    CHECK(bounded());
    world.get<PreviousWorldTransform>(body).world = {{Vec4(0), Vec4(0), Vec4(0)}};
    CHECK(bounded());
    world.get<PreviousWorldTransform>(body).world = at({0.3f, 0.5f, 5});  // behind the camera
    CHECK(bounded());
    CHECK(fastest(view) > kSize);
    world.destroy(body);
    world.get<Pose>(character).previous[2].row[0].x = NAN;
    CHECK(bounded());
    world.get<Pose>(character).previous.clear();
    CHECK(bounded());
    RenderView broken = view;
    broken.previous_clip_from_world = Mat4(NAN);
    CHECK(fastest(broken) == 0);
}

TEST_CASE_FIXTURE(
    VelocityScene, "velocity: through a blended surface it is that of the opaque surface behind") {
    const MeshId square = add(make_square());
    moving(square, at({0.1f, 0.5f, -0.5f}), at({0, 0.5f, -0.5f}));
    oracle::CameraMotion motion = moving_camera();
    motion.previous = motion.current;
    const RenderView view = view_of(motion);
    const gpu::FloatImage want = aov(view, "velocity");
    Material glass = {.base_color = {0.9f, 0.9f, 1, 0.4f}};
    glass.alpha_mode = AlphaMode::Blend;
    world.create(
        MeshInstance{square, add(glass)}, WorldTransform{at({0, 0.5f, 0})},
        PreviousWorldTransform{at({0, 0, 0})});
    CHECK(aov(view, "velocity").pixels == want.pixels);
}

}  // namespace limn::test::velocity_test
