#include "ecs/components/camera.h"
#include "ecs/components/step_jumps.h"
#include "ecs/world.h"
#include "render/frame_clock.h"
#include "render/render_view.h"
#include "render/skinning/skin_palette.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <vector>

namespace limn::jump_view_test {

namespace {

Affine moved_to(float x) {
    return affine_from({x, 0, 0}, Quat(1, 0, 0, 0), Vec3(1));
}

}  // namespace

TEST_CASE("step jumps: a camera that jumps is shown before or after its jump, at rest, with a cut "
          "only in the frame that crosses it") {
    World world;
    const Entity camera =
        world.create(Camera{}, WorldTransform{moved_to(2)}, PreviousWorldTransform{moved_to(2)});
    StepJumps jumps;
    jumps.transforms.push_back({camera, 0.5f, moved_to(-1)});
    world.insert_resource(jumps);
    const auto view_at = [&](float alpha, float previous_alpha) {
        return make_render_view(
            world, camera,
            {.width = 8, .height = 8, .alpha = alpha, .previous_alpha = previous_alpha});
    };
    struct Frame {
        float alpha;
        float previous_alpha;
        float x;
        bool cut;
    };
    for (const Frame& frame :
         {Frame{0.25f, 0, -1, false}, Frame{0.49f, -1, -1, false}, Frame{0.5f, 0.25f, 2, true},
          Frame{0.75f, 0, 2, true}, Frame{1, 0, 2, true}, Frame{1, 0.75f, 2, false}}) {
        CAPTURE(frame.alpha);
        CAPTURE(frame.previous_alpha);
        const RenderView view = view_at(frame.alpha, frame.previous_alpha);
        CHECK(view.world_from_camera.row[0].w == frame.x);
        CHECK(view.previous_clip_from_world == view.unjittered_from_world);
        CHECK(view.cut == frame.cut);
    }
    FrameClock clock;
    (void)seconds_since_last(clock, 1, 1.0, moved_to(0));
    CHECK(seconds_since_last(clock, 1, 1.1, moved_to(1)).has_value());
    CHECK_FALSE(seconds_since_last(clock, 1, 1.2, moved_to(2), true).has_value());
}

TEST_CASE(
    "step jumps: an entity is shown before or after its jump, whatever the start of the motion") {
    World world;
    const Entity box = world.create();
    const Entity other = world.create();
    const WorldTransform now{moved_to(2)};
    const PreviousWorldTransform previous{moved_to(1)};
    StepJumps jumps;
    jumps.transforms.push_back({box, 0.5f, moved_to(-1)});
    for (const float alpha : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        for (const float measured : {-1.0f, 0.0f, 0.4f, alpha}) {
            const Affine a = world_at(&jumps, box, now, &previous, {measured, alpha});
            CHECK(a.row[0].w == (alpha < 0.5f ? -1.0f : 2.0f));
        }
        const Affine free = world_at(&jumps, other, now, &previous, {alpha, alpha});
        CHECK(free.row[0].w == test::near(1 + alpha));
    }
    CHECK(world_at(nullptr, box, now, &previous, {0.5f, 0.5f}).row[0].w == test::near(1.5));
    CHECK(world_at(&jumps, other, now, nullptr, {0.5f, 0.5f}).row[0].w == 2);
}

TEST_CASE("step jumps: only the joints and morph weights that jump are held") {
    const SkinData skin{.name = "", .joints = {1, 0}, .joint_from_mesh = {Affine{}, Affine{}}};
    Pose pose;
    pose.joints = {moved_to(1), moved_to(2)};
    pose.previous = {moved_to(0), moved_to(2)};
    pose.jumps.push_back({1, 0.5f, moved_to(-1)});
    MorphWeights morph{{1, 1}, {0, 1}};
    morph.jumps.push_back({1, 0.5f, 0.25f});
    std::vector<Affine> palette;
    std::vector<float> weights;
    for (const float alpha : {0.25f, 0.5f, 0.75f, 1.0f}) {
        for (const float measured : {-1.0f, 0.0f, alpha}) {
            const bool before = alpha < 0.5f;
            make_palette(&skin, &pose, Skinning::Linear, {measured, alpha}, palette);
            CHECK(palette[0].row[0].w == (before ? -1.0f : 2.0f));
            CHECK(palette[1].row[0].w == test::near(measured));
            make_morph_weights(&morph, 0, 2, {measured, alpha}, weights);
            CHECK(weights[0] == test::near(measured));
            CHECK(weights[1] == (before ? 0.25f : 1.0f));
        }
    }
}

}  // namespace limn::jump_view_test
