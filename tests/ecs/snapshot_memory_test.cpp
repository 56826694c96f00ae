#include "ecs/snapshot.h"
#include "ecs/snapshot_format.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/allocation_count.h"
#include "tests/ecs/snapshot_seal.h"
#include "tests/ecs/snapshot_story.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

// What a file makes a program allocate is bounded by the file's size: by a factor that covers the
// smallest group of a few bytes, which becomes an archetype with all its tables, and by a constant
// that covers what every world has.

namespace snapshot_memory_test {

using namespace limn;
using namespace snapshot_story;

constexpr std::size_t kFactor = 100;
constexpr std::size_t kConstant = 256 << 10;
/// Ranges of a sparse set are committed in steps of this much; there are few sets.
constexpr std::size_t kCommittedConstant = 4 << 20;

struct Use {
    std::size_t allocated = 0;
    std::size_t committed = 0;
};

/// What restoring does to memory; the bytes may be refused or not.
Use restore(std::span<const std::byte> bytes) {
    World world;
    Use use;
    use.allocated =
        test::bytes_allocated_by([&] { static_cast<void>(restore_snapshot(world, bytes).ok()); });
    use.committed = world.memory().total();
    return use;
}

void check_restore(std::span<const std::byte> bytes) {
    const Use use = restore(bytes);
    CHECK(use.allocated <= kFactor * bytes.size() + kConstant);
    CHECK(use.committed <= kFactor * bytes.size() + kCommittedConstant);
}

void check_apply(std::span<const std::byte> base, std::span<const std::byte> delta) {
    const std::size_t allocated =
        test::bytes_allocated_by([&] { static_cast<void>(apply_delta(base, delta).ok()); });
    CHECK(allocated <= 4 * (base.size() + delta.size()) + 4096);
}

/// Calls call(altered) with every byte flipped, and with every number of four or eight bytes
/// replaced by larger ones.
template <typename Call>
void for_each_alteration(const std::vector<std::byte>& bytes, const Call& call) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::vector<std::byte> altered = bytes;
            altered[i] ^= static_cast<std::byte>(flip);
            call(altered);
        }
        for (const std::uint64_t value :
             {std::uint64_t{0xffff}, std::uint64_t{0xffffff}, std::uint64_t{0x3ffffff},
              std::uint64_t{0x7fffffff}, std::uint64_t{0xffffffff}, std::uint64_t{0xffffffffff},
              ~std::uint64_t{0}}) {
            for (const std::size_t size : {std::size_t{4}, std::size_t{8}}) {
                std::vector<std::byte> altered = bytes;
                std::memcpy(altered.data() + i, &value, std::min(size, bytes.size() - i));
                call(altered);
            }
        }
    }
}

std::vector<std::byte> small_snapshot(Story& story, SnapshotMark* mark = nullptr) {
    register_types();
    const Entity e = story.world.create(StoryPlace{}, StoryText{"text"}, StoryLamp{});
    story.world.create(StorySpin{}, StoryAwake{}, StoryLife{});
    story.world.create(StoryRoute{{1, 2}, {{e, 30, false}}});
    story.world.create(StoryShade{1, e}, StoryPlace{});
    story.world.create(StoryShade{2, e}, StoryPlace{});
    story.world.add(e, StoryHeat{});
    story.world.add(e, StoryNote{"note"});
    story.world.disable<StoryLamp>(e);
    story.world.destroy(story.world.create());
    story.world.insert_resource(StoryTitle{"title"});
    return save(story.world, mark);
}

}  // namespace snapshot_memory_test

using namespace limn;
using namespace snapshot_memory_test;

TEST_CASE("snapshot memory: altered or truncated, it allocates no more than its size allows") {
    Story story(1);
    const std::vector<std::byte> bytes = small_snapshot(story);
    check_restore(bytes);
    for_each_alteration(bytes, [](std::vector<std::byte>& altered) {
        check_restore(altered);
        test::seal_snapshot(altered);
        check_restore(altered);
    });
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        std::vector<std::byte> cut(
            bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        test::seal_snapshot(cut);
        check_restore(cut);
    }
}

TEST_CASE("snapshot memory: groups of no rows cost a bounded multiple of their few bytes") {
    // Every set of components there is, without an entity: the most an archetype can cost a byte.
    Story story(2);
    register_types();
    for (int i = 0; i < 200; ++i) {
        const Entity e = story.world.create();
        for (int c = 0; c < 8; ++c) {
            if ((i >> c & 1) != 0) {
                story.toggle_component(e, static_cast<std::uint32_t>(c));
            }
        }
    }
    story.world.clear();
    check_restore(save(story.world));
}

TEST_CASE("snapshot memory: of a large world, it allocates less than it commits") {
    World world;
    register_types();
    world.create_many(100'000, StoryPlace{}, StorySpeed{});
    const std::vector<std::byte> bytes = save(world);
    const Use use = restore(bytes);
    CHECK(use.allocated < bytes.size());
    CHECK(use.committed < 2 * bytes.size());
}

TEST_CASE("snapshot memory: an altered delta allocates no more than base and delta allow") {
    Story story(3);
    SnapshotMark mark;
    const std::vector<std::byte> base = small_snapshot(story, &mark);
    story.create(20);
    const std::vector<std::byte> delta = save_delta(story.world, mark).value();
    check_apply(base, delta);
    for_each_alteration(delta, [&](std::vector<std::byte>& altered) {
        test::seal_delta(altered);
        check_apply(base, altered);
    });
}
