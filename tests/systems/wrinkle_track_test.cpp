#include "ecs/world.h"
#include "systems/faces/wrinkle_track_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

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

}  // namespace limn::test::wrinkle_track_test
