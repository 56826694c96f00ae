#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"
#include "systems/animation/clip_player_system.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"
#include "systems/faces/wrinkle_track_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace limn::test::wrinkle_track_test {
namespace {

const WrinkleTrack kTrack = {
    .keys =
        {{.time = 1, .weights = {.left_brow = -1, .lips = 0.5f}},
         {.time = 3, .weights = {.left_brow = 1, .upper_right_cheek = -0.5f}},
         {.time = 4, .weights = {}}},
    .smooth = false};

}  // namespace

TEST_CASE(
    "wrinkle track: at a key are its weights, before the first and after the last too"
    * technique("wrinkle.maps.animation")) {
    for (const bool smooth : {false, true}) {
        WrinkleTrack track = kTrack;
        track.smooth = smooth;
        for (const WrinkleKey& key : track.keys) {
            CHECK(wrinkle_weights_at(track, key.time) == key.weights);
        }
        CHECK(wrinkle_weights_at(track, -7) == track.keys.front().weights);
        CHECK(wrinkle_weights_at(track, 1e9) == track.keys.back().weights);
        track.keys.resize(1);
        CHECK(wrinkle_weights_at(track, 2) == track.keys[0].weights);
        track.keys.clear();
        CHECK(wrinkle_weights_at(track, 2) == WrinkleWeights{});
    }
}

TEST_CASE(
    "wrinkle track: between keys each region is interpolated separately, linearly or smoothly"
    * technique("wrinkle.maps.animation")) {
    WrinkleTrack track = kTrack;
    const WrinkleWeights straight = wrinkle_weights_at(track, 1.5);
    CHECK(straight.left_brow == near(-0.5));
    CHECK(straight.lips == near(0.375));
    CHECK(straight.upper_right_cheek == near(-0.125));
    CHECK(straight.right_brow == 0);
    track.smooth = true;
    CHECK(wrinkle_weights_at(track, 1.5).left_brow == near(-1 + 2 * 0.15625));
    CHECK(wrinkle_weights_at(track, 2).left_brow == near(0));
}

TEST_CASE(
    "wrinkle track: a loop starts over after the last key, others stay there"
    * technique("wrinkle.maps.animation")) {
    World world;
    WrinkleTrack track = kTrack;
    track.loop = true;
    const Entity looped = world.create(track, WrinkleWeights{});
    const Entity once = world.create(kTrack, WrinkleWeights{});
    const Entity still = world.create(WrinkleTrack{}, WrinkleWeights{.lips = 0.25f});
    world.insert_resource(FrameTime{.step = 1.0f / 60, .time = 4.5});
    world.run(update_wrinkle_tracks);
    CHECK(world.get<WrinkleWeights>(looped).left_brow == near(-0.5));
    CHECK(world.get<WrinkleWeights>(once) == WrinkleWeights{});
    CHECK(world.get<WrinkleWeights>(still).lips == 0.25f);
}

TEST_CASE(
    "wrinkle track: a preset is the weights of a whole expression, to which those of regions add"
    * technique("wrinkle.maps.animation, wrinkle.maps.weights")) {
    const auto all = [](float weight) {
        std::array<float, kWrinkleRegions.size()> weights;
        weights.fill(weight);
        return weights;
    };
    CHECK(region_weights({}) == all(0));
    CHECK(region_weights({.preset = WrinklePreset::Surprised}) == all(-1));
    CHECK(region_weights({.preset = WrinklePreset::Sour}) == all(1));
    const auto disapproval = region_weights({.preset = WrinklePreset::Disapproval});
    for (std::size_t i = 0; i < 4; ++i) {  // brows and lips
        CHECK(disapproval[i] > 0);
    }
    // Half of a smile is added on top; nothing leaves the range.
    const auto mixed = region_weights({.preset = WrinklePreset::Sour, .lips = -0.5f, .chin = 3});
    CHECK(mixed[3] == 0.5f);
    CHECK(mixed[8] == 1);
    for (int p = 0; p <= static_cast<int>(WrinklePreset::Pout); ++p) {
        const auto preset = static_cast<WrinklePreset>(p);
        for (const float weight : region_weights({.preset = preset})) {
            CHECK(std::abs(weight) <= 1);
        }
        // Left and right are alike.
        const auto w = region_weights({.preset = preset});
        CHECK(w[0] == w[1]);
        CHECK(w[4] == w[5]);
        CHECK(w[6] == w[7]);
    }
    // Between keys with presets, the weights that they stand for are interpolated.
    const WrinkleTrack track = {
        .keys =
            {{.time = 0, .weights = {.preset = WrinklePreset::Surprised}},
             {.time = 1, .weights = {.preset = WrinklePreset::Sour, .lips = -1}}},
        .smooth = false};
    const WrinkleWeights middle = wrinkle_weights_at(track, 0.75);
    CHECK(middle.preset == WrinklePreset::Neutral);
    CHECK(middle.chin == near(0.5));
    CHECK(middle.lips == near(-0.25));
}

namespace {

/// A face whose mesh has a shape, two channels and another shape, and clips that move all of them.
struct ChannelFace {
    World world;
    Entity face;

    ChannelFace() {
        Assets assets;
        MeshData mesh;
        mesh.name = "face";
        for (const char* const name : {"smile", "wrinkle.chin", "wrinkle.left_brow", "blink"}) {
            mesh.morphs.emplace_back().name = name;
        }
        assets.meshes.push_back(mesh);
        const auto clip = [](float chin, float brow) {
            ClipData made;
            made.duration = 2;
            ClipSheet& sheet = made.sheets.emplace_back();
            sheet.times = {0, 2};
            sheet.morphing = {0, 1, 2, 3};
            sheet.weights = {0, 0, 0, 0, 0.9f, chin, brow, 0.3f};
            return made;
        };
        assets.clips = {clip(1, -0.8f), clip(-0.5f, 0.4f)};
        world.insert_resource(std::move(assets));
        world.insert_resource(FrameTime{.step = 0.25f});
        face = world.create(
            MeshInstance{.mesh = {0}, .material = {}}, WrinkleWeights{.lips = 0.2f},
            MorphWeights{std::vector<float>(4, 0.0f), {}});
        world.add(face, Deformed{face, {}});
    }
    WrinkleWeights step() {
        world.run(advance_clips);
        world.run(update_poses);
        world.run(update_wrinkle_channels);
        return world.get<WrinkleWeights>(face);
    }
};

}  // namespace

TEST_CASE(
    "wrinkle channels: weights are sampled with the clip, at its time and speed"
    * technique("wrinkle.maps.animation")) {
    ChannelFace face;
    face.world.add(face.face, ClipPlayer{.clip = {0}});
    CHECK(face.step().chin == near(0.125));
    CHECK(face.step().left_brow == near(-0.2));
    face.world.get<ClipPlayer>(face.face).speed = 3;
    const WrinkleWeights fast = face.step();  // at 1.25 s
    CHECK(fast.chin == near(0.625));
    CHECK(fast.left_brow == near(-0.5));
    CHECK(fast.lips == 0.2f);  // has no channel
    CHECK(fast.right_brow == 0);
    face.world.get<ClipPlayer>(face.face).speed = -3;
    CHECK(face.step().chin == near(0.25));
}

TEST_CASE(
    "wrinkle channels: where a clip blends into another one, wrinkles do, below 0 as above"
    * technique("wrinkle.maps.animation")) {
    ChannelFace face;
    const Assets& assets = face.world.resource<Assets>();
    std::vector<float> weights(4, 0.0f);
    const auto blended_at = [&](float share) {
        std::vector<float> first(4, 0.0f);
        std::vector<float> second(4, 0.0f);
        sample_clip_weights(assets.clips[0], 1.5f, first);
        sample_clip_weights(assets.clips[1], 1.5f, second);
        for (std::size_t i = 0; i < 4; ++i) {
            weights[i] = (1 - share) * first[i] + share * second[i];
        }
        face.world.get<MorphWeights>(face.face).weights = weights;
        face.world.run(update_wrinkle_channels);
        return face.world.get<WrinkleWeights>(face.face);
    };
    CHECK(blended_at(0).left_brow == near(-0.6));
    CHECK(blended_at(0.5f).left_brow == near(0.5 * (-0.6 + 0.3)));
    CHECK(blended_at(0.5f).chin == near(0.5 * (0.75 - 0.375)));
    CHECK(blended_at(1).chin == near(-0.375));
}

}  // namespace limn::test::wrinkle_track_test
