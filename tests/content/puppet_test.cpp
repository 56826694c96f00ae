// What one body does, performed live by another: over a link, filtered, retargeted.

#include "bench/oracles/walker_motion.h"
#include "content/bake/motion/body_retarget.h"
#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/walk.h"
#include "ecs/snapshot.h"
#include "systems/animation/puppet/puppet_stream.h"
#include "systems/animation/puppet/puppet_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace limn::puppet_test {

using test::near;

namespace {

constexpr float kFrame = 1.0f / 60;
const oracle::WalkerShape kShortShins = {.thigh = 0.5f, .shin = 0.3f, .ankle = 0.06f};
using Row = std::vector<Vec3>;

/// A recorded walk that is streamed to another body, frame by frame.
struct LiveShow {
    oracle::RecordedWalk walk = oracle::make_walk(oracle::make_walker());
    MotionFrames frames = sample_frames(walk.motion, 60);
    SkeletonData target;
    Puppet puppet;
    PuppetState state = {};
    PuppetBody body = {};
    Transform transform = {};

    explicit LiveShow(const Puppet& settings, const oracle::WalkerShape& shape = kShortShins)
        : target(oracle::make_walker(shape)), puppet(settings) {
        measure_puppet(walk.motion.skeleton, target, body);
        reset_stream(64, walk.motion.skeleton.joints.size(), state.stream);
    }
    void push(std::size_t frame, float delay = 0) {
        const auto joints = find_frame_joints(walk.motion.skeleton, frames, frame);
        PuppetPacket packet = {.time = double(static_cast<float>(frame) * kFrame)};
        packet.arrival = packet.time + double(delay);
        read_performer(body, joints, body.turns, packet.points);
        push_packet(packet, body.turns, state.stream);
    }
    /// Positions of the puppet's joints.
    Row step(std::size_t frame) {
        step_puppet(
            puppet, target, double(static_cast<float>(frame) * kFrame), kFrame, state, body,
            transform);
        Row row;
        for (const Affine& joint : body.matrices) {
            row.push_back(transform_point(joint, Vec3(0)));
        }
        return row;
    }
    std::vector<Row> play(std::size_t count) {
        std::vector<Row> rows;
        for (std::size_t f = 0; f < count; ++f) {
            push(f);
            rows.push_back(step(f));
        }
        return rows;
    }
};

float distance_of(const Row& a, const Row& b) {
    float largest = 0;
    for (std::size_t j = 0; j < a.size(); ++j) {
        largest = std::max(largest, glm::distance(a[j], b[j]));
    }
    return largest;
}

/// Longest way of the puppet's ankles while the walker's are planted, from two frames on.
float slide_of(const LiveShow& show, const std::vector<Row>& rows) {
    const BodyJoints from = find_body_joints(show.walk.motion.skeleton);
    const BodyJoints to = find_body_joints(show.target);
    float slide = 0;
    for (const ClipContact& plant : show.walk.plants) {
        const bool is_left = plant.joint == from[BodyPart::LeftFoot];
        const std::uint16_t foot = to[is_left ? BodyPart::LeftFoot : BodyPart::RightFoot];
        const auto begin = static_cast<std::size_t>(std::lround(plant.begin * 60)) + 3;
        const auto end = static_cast<std::size_t>(std::lround(plant.end * 60));
        for (std::size_t f = begin; f <= end && f < rows.size(); ++f) {
            slide = std::max(slide, glm::distance(rows[f][foot], rows[begin][foot]));
        }
    }
    return slide;
}

constexpr Puppet kDirect = {.latency = 0, .pin_feet = false, .moves_root = false};

}  // namespace

TEST_CASE(
    "puppet: a recording as a stream, without a filter, is what retargeting makes of it"
    * technique("char.puppetry")) {
    for (const float latency : {0.0f, 3 * kFrame}) {
        Puppet puppet = kDirect;
        puppet.latency = latency;
        LiveShow show(puppet);
        const ClipData clip = *retarget_motion(show.walk.motion, show.target, {.pin_feet = false});
        const MotionFrames expected = sample_frames({show.target, clip}, 60);
        const std::vector<Row> rows = show.play(show.frames.frames());
        const auto late = static_cast<std::size_t>(std::lround(latency * 60));
        REQUIRE(rows.size() > 100);
        float error = 0;
        for (std::size_t f = late; f < rows.size(); ++f) {
            Row row;
            for (const Affine& joint : find_frame_joints(show.target, expected, f - late)) {
                row.push_back(transform_point(joint, Vec3(0)));
            }
            error = std::max(error, distance_of(rows[f], row));
        }
        CHECK(error < 1e-4f);
    }
}

TEST_CASE(
    "puppet: when no packets arrive it holds its last pose, and goes on with the next"
    * technique("char.puppetry")) {
    LiveShow show({.latency = 0.05f, .cutoff = 0, .moves_root = false});
    CHECK(show.step(0) == show.step(1));  // nothing has arrived yet
    CHECK(!show.state.started);
    for (std::size_t f = 0; f < 30; ++f) {
        show.push(f);
    }
    show.step(40);
    const std::uint32_t held = show.state.stream.held;
    CHECK(held == 1);
    const std::vector<Quat> last = show.body.turns;
    for (std::size_t f = 41; f < 60; ++f) {
        show.step(f);
        CHECK(show.body.turns == last);
    }
    CHECK(show.state.stream.held == held + 19);
    for (std::size_t f = 60; f < 70; ++f) {
        show.push(f);
        show.step(f);
    }
    CHECK(show.body.turns != last);
    CHECK(show.state.stream.held < held + 24);
}

TEST_CASE("puppet: its pose depends on nothing that arrives later" * technique("char.puppetry")) {
    const Puppet puppet = {.latency = 0.05f, .cutoff = 3, .moves_root = false};
    LiveShow one(puppet);
    LiveShow other(puppet);
    for (std::size_t f = 0; f < 60; ++f) {
        one.push(f);
        other.push(f < 50 ? f : 110 - f);  // backward from there on
        const Row a = one.step(f);
        const Row b = other.step(f);
        CHECK((f > 50 || a == b));
        CHECK((f < 55 || a != b));  // the latency is three frames
    }
    // What is on its way is not there yet.
    LiveShow early(puppet);
    LiveShow late(puppet);
    for (std::size_t f = 0; f < 60; ++f) {
        if (f <= 30) {
            early.push(f);
            late.push(f);
        } else if (f == 31) {
            early.push(40, 1.0f);
        }
        CHECK(early.step(f) == late.step(f));
    }
}

TEST_CASE(
    "puppet: packets may overtake each other within the latency, and a few may be lost"
    * technique("char.puppetry")) {
    const Puppet puppet = {.latency = 0.1f, .pin_feet = false, .moves_root = false};
    LiveShow ordered(puppet);
    LiveShow shuffled(puppet);
    LiveShow lossy(puppet);
    float error = 0;
    for (std::size_t f = 0; f < 120; ++f) {
        ordered.push(f);
        lossy.push(f - f % 3);
        if (f % 4 == 3) {
            for (const std::size_t i : {f - 1, f - 3, f, f - 2}) {
                shuffled.push(i);
            }
        }
        const Row row = ordered.step(f);
        if (f >= 10) {
            CHECK(shuffled.step(f) == row);
            error = std::max(error, distance_of(lossy.step(f), row));
        }
    }
    CHECK(error > 1e-4f);
    CHECK(error < 0.02f);
    const std::uint32_t before = ordered.state.stream.late;
    ordered.push(1);
    CHECK(ordered.state.stream.late == before + 1);
}

TEST_CASE(
    "puppet: the filter keeps what rests, follows what moves, and takes noise away"
    * technique("char.puppetry")) {
    CHECK(filter_share(0, kFrame) == 1);
    // A step of the input: 1 - (1 - share)^k of it after k steps.
    FilteredTurn turn;
    const Quat target = rotation_about({0, 1, 0}, 0.5f);
    const float share = filter_share(2, kFrame);
    CHECK(share == near(2 * kPi * 2 * kFrame / (1 + 2 * kPi * 2 * kFrame)));
    for (int k = 1; k <= 20; ++k) {
        filter_turn(target, 2, 0, kFrame, turn);
        const float done = axis_angle(turn.value).angle / 0.5f;
        CHECK(done == near(1 - std::pow(1 - share, static_cast<float>(k))).epsilon(1e-4));
    }
    // Noise at rest against noise after the filter; and how far a fast turn is ahead of it.
    const auto spread = [](float cutoff, float eagerness) {
        FilteredTurn filtered;
        Random random(5, 6, 7, 8);
        double sum = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 noise = {random.normal(), random.normal(), random.normal()};
            filter_turn(exp_rotation(0.01f * noise), cutoff, eagerness, kFrame, filtered);
            sum += square(double(axis_angle(filtered.value).angle));
        }
        return std::sqrt(sum / 2000);
    };
    const auto lag = [](float cutoff, float eagerness) {
        FilteredTurn filtered;
        Quat input;
        for (int i = 0; i < 240; ++i) {
            input = rotation_about({0, 1, 0}, 3.0f * static_cast<float>(i) * kFrame);
            filter_turn(input, cutoff, eagerness, kFrame, filtered);
        }
        return axis_angle(
                   glm::conjugate(filtered.value) * to_same_hemisphere(filtered.value, input))
            .angle;
    };
    CHECK(spread(1, 0.02f) < 0.4 * spread(0, 0));
    // A filter of first order is behind by the speed over 2 pi times the cutoff.
    CHECK(lag(1, 0) == near(3 / (2 * kPi)).epsilon(0.02));
    CHECK(lag(1, 2) < 0.25f * lag(1, 0));
    CHECK(lag(0, 0) < 1e-5f);
}

TEST_CASE(
    "puppet: planted feet stay on a body with other legs, and slide without pins"
    * technique("char.puppetry")) {
    Puppet puppet = kDirect;
    LiveShow free(puppet);
    CHECK(slide_of(free, free.play(free.frames.frames())) > 0.01f);
    puppet.pin_feet = true;
    LiveShow pinned(puppet);
    const std::vector<Row> rows = pinned.play(pinned.frames.frames());
    CHECK(slide_of(pinned, rows) < 2e-3f);
    // Corrections do not jump: no joint is faster than the walk by much.
    const auto fastest = [](const std::vector<Row>& of) {
        float most = 0;
        for (std::size_t f = 1; f < of.size(); ++f) {
            most = std::max(most, 60 * distance_of(of[f], of[f - 1]));
        }
        return most;
    };
    LiveShow again(kDirect);
    CHECK(fastest(rows) < 1.3f * fastest(again.play(again.frames.frames())));
    // Hands follow their own way where that is important.
    puppet.hands = 1;
    LiveShow reaching(puppet, {.thigh = 0.5f, .shin = 0.3f, .ankle = 0.06f, .arms = 0.7f});
    reaching.play(40);
    const std::uint16_t hand = find_body_joints(reaching.target)[BodyPart::LeftHand];
    const Vec3 wanted = reaching.body.map.scale * reaching.state.points[5] + reaching.body.shift;
    const Vec3 found = transform_point(reaching.body.matrices[hand], Vec3(0));
    CHECK(glm::distance(found + Vec3(0, reaching.state.drop, 0), wanted) < 0.02f);
}

namespace {

/// Someone walks, driven by an intent, and three puppets of other sizes do the same.
struct Theater {
    World world;
    Schedule schedule = make_world_schedule();
    Entity performer{};
    std::vector<Entity> puppets;

    Theater() {
        register_all_components();
        Assets assets;
        assets.skeletons = {
            oracle::make_walker(), oracle::make_walker({.thigh = 0.25f, .shin = 0.22f}),
            oracle::make_walker({.thigh = 0.9f, .shin = 0.85f, .ankle = 0.15f})};
        world.insert_resource(std::move(assets));
        world.insert_resource(RandomSeed{3});
        performer = world.create(Transform{}, Skeleton{{0}}, Walk{}, MoveIntent{});
        for (const std::uint32_t skeleton : {1u, 2u, 0u}) {
            Puppet puppet = {.performer = performer};
            if (skeleton == 0) {
                puppet = {
                    .performer = performer,
                    .cutoff = 4,
                    .loss = 0.2f,
                    .jitter = 0.05f,
                    .noise = 0.02f};
            }
            puppets.push_back(world.create(
                Transform{.position = {2.0f + static_cast<float>(skeleton), 0, 0}},
                Skeleton{{skeleton}}, puppet));
        }
    }
    void step(int count, const Vec3& velocity) {
        for (int i = 0; i < count; ++i) {
            world.get<MoveIntent>(performer).velocity = velocity;
            step_world(world, schedule);
        }
    }
    Vec3 place(Entity entity) { return world.get<const Transform>(entity).position; }
};

std::vector<std::uint64_t> theater_hashes(int threads) {
    set_thread_count(threads);
    Theater theater;
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 60; ++i) {
        theater.step(1, {0, 0, i < 40 ? 1.2f : 0.0f});
        hashes.push_back(state_hash(theater.world));
    }
    set_thread_count(0);
    return hashes;
}

}  // namespace

TEST_CASE(
    "puppet: walks where its performer is driven, as far as its legs are long"
    * technique("char.puppetry")) {
    Theater theater;
    std::vector<Vec3> begin;
    for (const Entity puppet : theater.puppets) {
        begin.push_back(theater.place(puppet));
    }
    theater.step(180, {0, 0, 1.2f});
    theater.step(200, Vec3(0));  // until all have stopped
    CHECK(theater.place(theater.performer).z > 2.5f);
    const std::array<float, 3> scales = {0.47f / 0.88f, 1.75f / 0.88f, 1.0f};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 moved = theater.place(theater.puppets[i]) - begin[i];
        const auto& state = theater.world.get<const PuppetState>(theater.puppets[i]);
        const float way = theater.place(theater.performer).z - state.first_place.z;
        CHECK(moved.z == near(scales[i] * way).epsilon(1e-3));
        CHECK(std::abs(moved.x) < 1e-3f);
        // Their soles are on the ground.
        const auto& pose = theater.world.get<const Pose>(theater.puppets[i]);
        const auto& assets = theater.world.resource<Assets>();
        const std::uint32_t skeleton =
            theater.world.get<const Skeleton>(theater.puppets[i]).skeleton.index;
        const SkeletonData& data = assets.skeletons[skeleton];
        const std::uint16_t foot = find_body_joints(data)[BodyPart::LeftFoot];
        const float ankle = transform_point(find_rest_matrices(data)[foot], Vec3(0)).y;
        CHECK(std::abs(transform_point(pose.joints[foot], Vec3(0)).y - ankle) < 0.02f);
    }
}

TEST_CASE(
    "puppet: the same bits on 1, 2, 3 and 7 threads, and after a snapshot"
    * technique("char.puppetry")) {
    const std::vector<std::uint64_t> expected = theater_hashes(1);
    CHECK(theater_hashes(2) == expected);
    CHECK(theater_hashes(3) == expected);
    CHECK(theater_hashes(7) == expected);
    Theater theater;
    theater.step(30, {0, 0, 1});
    const Result<std::vector<std::byte>> saved = save_snapshot(theater.world);
    theater.step(30, {0, 0, 1});
    const std::uint64_t hash = state_hash(theater.world);
    REQUIRE(restore_snapshot(theater.world, saved.value()).ok());
    theater.step(30, {0, 0, 1});
    CHECK(state_hash(theater.world) == hash);
}

}  // namespace limn::puppet_test
