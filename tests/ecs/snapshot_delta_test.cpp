#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/ecs/snapshot_seal.h"
#include "tests/ecs/snapshot_story.h"

#include <doctest/doctest.h>

namespace delta_test {

using namespace limn;
using namespace snapshot_story;

// Sanitizers make each step ten times slower: fewer stories, and every seventh byte.
#if defined(LIMN_SANITIZED)
constexpr std::uint64_t kStories = 3;
constexpr std::size_t kStride = 7;
#else
constexpr std::uint64_t kStories = 12;
constexpr std::size_t kStride = 1;
#endif

/// 100 000 entities of 4 components.
void fill_large(World& world) {
    register_types();
    world.create_many(100'000, StoryPlace{1, 2, 3}, StorySpeed{}, StoryLife{}, StoryText{"abc"});
}

}  // namespace delta_test

using namespace limn;
using namespace snapshot_story;
using namespace delta_test;

TEST_CASE("delta: applied to the earlier snapshot it gives the later one, to the byte") {
    for (std::uint64_t seed = 1; seed <= kStories; ++seed) {
        CAPTURE(seed);
        Story story(seed);
        struct Moment {
            SnapshotMark mark;
            std::vector<std::byte> bytes;
        };
        std::vector<Moment> moments;
        for (int round = 0; round < 60; ++round) {
            const std::uint32_t count = story.rng.below(40);
            for (std::uint32_t i = 0; i < count; ++i) {
                story.happen();
            }
            Moment now;
            now.bytes = save(story.world, &now.mark);
            for (std::size_t i = 0; i < moments.size(); i += 1 + story.rng.below(9)) {
                const auto delta = save_delta(story.world, moments[i].mark);
                REQUIRE(delta.ok());
                const auto applied = apply_delta(moments[i].bytes, *delta);
                REQUIRE_MESSAGE(applied.ok(), (applied ? "" : applied.error().message));
                REQUIRE(*applied == now.bytes);
            }
            moments.push_back(std::move(now));
        }
    }
}

TEST_CASE("delta: a chain of deltas, each from the mark of the previous one, follows the world") {
    for (std::uint64_t seed = 100; seed <= 106; ++seed) {
        CAPTURE(seed);
        Story story(seed);
        story.create(3000);
        SnapshotMark mark;
        std::vector<std::byte> bytes = save(story.world, &mark);
        for (int round = 0; round < 80; ++round) {
            const std::uint32_t count = story.rng.below(12);
            for (std::uint32_t i = 0; i < count; ++i) {
                story.happen();
            }
            const std::vector<std::byte> delta = save_delta(story.world, mark, &mark).value();
            bytes = apply_delta(bytes, delta).value();
            REQUIRE(bytes == save(story.world));
        }
        World restored;
        REQUIRE(restore_snapshot(restored, bytes).ok());
        CHECK(save(restored) == bytes);
    }
}

TEST_CASE("delta: one value written in 100 000 rows costs one chunk of its column") {
    World world;
    fill_large(world);
    const Entity one = world.create(StoryPlace{}, StorySpeed{}, StoryLife{}, StoryText{});
    SnapshotMark mark;
    const std::size_t all = save(world, &mark).size();
    CHECK(save_delta(world, mark)->size() < 400);  // nothing
    world.get<StoryPlace>(one).x = 9;
    const std::size_t chunk = 100'001 % 1024 * sizeof(StoryPlace);
    const std::size_t size = save_delta(world, mark)->size();
    CHECK(size > chunk);
    CHECK(size < chunk + 500);
    CHECK(all > 3'000'000);
    // A string too: its column is cut into chunks like the others.
    world.get<StoryText>(one).text = "abcdef";
    CHECK(save_delta(world, mark)->size() < size + 100'001 % 1024 * 7 + 200);
}

TEST_CASE("delta: one entity created and one destroyed cost their chunks, not the slots of all") {
    World world;
    fill_large(world);
    const std::vector<Entity> few = world.create_many(1500, StoryPlace{});
    SnapshotMark mark;
    static_cast<void>(save(world, &mark));
    world.create(StoryPlace{});
    world.destroy(few[1]);
    // Two chunks of positions and entities, two of generations and links.
    const std::size_t most = 2 * 1024 * (sizeof(StoryPlace) + sizeof(Entity) + 8);
    CHECK(save_delta(world, mark)->size() < most + 1000);
}

TEST_CASE("delta: an enable bit that is set is a change, and costs no values") {
    World world;
    register_types();
    const Entity one = world.create_many(5000, StoryLamp{}, StoryAwake{}, StorySpin{})[3000];
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    world.disable<StoryAwake>(one);
    world.disable<StoryLamp>(one);
    const std::vector<std::byte> delta = save_delta(world, mark, &mark).value();
    CHECK(delta.size() < 2 * 128 + 400);
    const std::vector<std::byte> later = apply_delta(bytes, delta).value();
    CHECK(later == save(world));
    World restored;
    REQUIRE(restore_snapshot(restored, later).ok());
    CHECK_FALSE(restored.is_enabled<StoryAwake>(one));
    CHECK_FALSE(restored.is_enabled<StoryLamp>(one));
    CHECK(restored.query<With<StoryLamp>>().count() == 4999);
    CHECK(state_hash(restored) == state_hash(world));
}

TEST_CASE("delta: taking everything for writing without changing it costs next to nothing") {
    World world;
    fill_large(world);
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    world.query<StoryPlace, StoryText>().each([](StoryPlace& place, StoryText&) { place.x = 1; });
    const std::vector<std::byte> delta = save_delta(world, mark).value();
    CHECK(delta.size() < 400);
    CHECK(apply_delta(bytes, delta).value() == bytes);
}

TEST_CASE("delta: changes are detected across the wraparound of versions") {
    World world;
    register_types();
    world.set_version(0xfffffffeu);
    const Entity e = world.create(StoryPlace{});
    world.create_many(3000, StoryPlace{});
    SnapshotMark mark;
    std::vector<std::byte> bytes = save(world, &mark);
    for (int i = 0; i < 6; ++i) {
        world.get<StoryPlace>(e).x += 1;
        world.create(StorySpeed{});
        bytes = apply_delta(bytes, save_delta(world, mark, &mark).value()).value();
        REQUIRE(bytes == save(world));
    }
    CHECK(world.core().now() < 100);
}

TEST_CASE("delta: relative to a mark older than the clamped versions, everything is new") {
    World world;
    register_types();
    const Entity e = world.create(StoryPlace{});
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    // The same number again after 2^32 runs, with a change in between.
    const std::uint32_t begin = world.core().now();
    for (std::uint32_t quarter = 1; quarter <= 4; ++quarter) {
        world.set_version(begin + quarter * (1u << 30));
        static_cast<void>(world.begin_run());
        if (quarter == 1) {
            world.get<StoryPlace>(e).x = 5;
        }
    }
    CHECK(apply_delta(bytes, save_delta(world, mark).value()).value() == save(world));
}

TEST_CASE("delta: a restored world continues from its snapshot with small deltas") {
    World world;
    fill_large(world);
    const Entity one = world.create(StoryText{"x"});
    SnapshotMark before;
    std::vector<std::byte> bytes = save(world, &before);
    world.destroy(one);
    SnapshotMark mark;
    REQUIRE(restore_snapshot(world, bytes, &mark).ok());
    CHECK(save_delta(world, mark)->size() < 500);
    world.get<StoryText>(one).text = "y";
    const std::vector<std::byte> delta = save_delta(world, mark).value();
    CHECK(delta.size() < 600);
    CHECK(apply_delta(bytes, delta).value() == save(world));
    // A mark from before the restore still gives a delta that is right, if a large one.
    CHECK(apply_delta(bytes, save_delta(world, before).value()).value() == save(world));
}

TEST_CASE("delta: applied to another snapshot it is rejected") {
    Story story(5);
    story.create(10);
    SnapshotMark mark;
    const std::vector<std::byte> first = save(story.world, &mark);
    story.create(1);
    const std::vector<std::byte> second = save(story.world);
    const std::vector<std::byte> delta = save_delta(story.world, mark).value();
    CHECK(apply_delta(second, delta).error().message == "delta: belongs to a different snapshot");
    CHECK(
        apply_delta({}, delta).error().message
        == "delta: the earlier snapshot: not a snapshot: it does not begin with LIMNSNAP");
    CHECK(
        apply_delta(first, first).error().message
        == "delta: not a delta: it does not begin with LIMNDELT");
    // An altered one either fails or has its altered bytes replaced.
    int refused = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        std::vector<std::byte> altered = first;
        altered[i] ^= std::byte{0x20};
        const auto applied = apply_delta(altered, delta);
        refused += applied.ok() ? 0 : 1;
        CHECK((!applied.ok() || *applied == second));
    }
    CHECK(refused > 200);
}

TEST_CASE("delta: truncated or altered, with or without a matching checksum, it is an error") {
    Story story(9);
    for (int i = 0; i < 60; ++i) {
        story.happen();
    }
    SnapshotMark mark;
    const std::vector<std::byte> base = save(story.world, &mark);
    for (int i = 0; i < 10; ++i) {
        story.happen();
    }
    const std::vector<std::byte> delta = save_delta(story.world, mark).value();
    REQUIRE(apply_delta(base, delta).ok());
    for (std::size_t size = 0; size < delta.size(); size += kStride) {
        std::vector<std::byte> cut(
            delta.begin(), delta.begin() + static_cast<std::ptrdiff_t>(size));
        CHECK_FALSE(apply_delta(base, cut).ok());
        test::seal_delta(cut);
        CHECK_FALSE(apply_delta(base, cut).ok());
    }
    for (std::size_t i = 0; i < delta.size(); i += kStride) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::vector<std::byte> altered = delta;
            altered[i] ^= static_cast<std::byte>(flip);
            CHECK_FALSE(apply_delta(base, altered).ok());
            test::seal_delta(altered);
            if (const auto applied = apply_delta(base, altered); applied.ok()) {
                CHECK(i >= 16);
                CHECK(i < 24);  // the checksum itself, mended
            }
        }
    }
}
