#include "ecs/base/jobs.h"
#include "ecs/components/all.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/snapshot_seal.h"

#include <doctest/doctest.h>

#include <cstring>

namespace snapshot_test {

using namespace limn;
using test::seal_snapshot;

struct SnapGears {
    std::vector<Entity> teeth;
    std::string label = "none";
};
template <typename Visitor>
void visit_fields(SnapGears& gears, Visitor&& visit) {
    visit("teeth", gears.teeth);
    visit("label", gears.label);
}

struct SnapMark {
    int value = 0;
};
struct SnapSelected {};
struct SnapCache {
    std::vector<float> values;
};
struct SnapForgotten {
    int value = 0;
};
struct SnapOpaque {
    std::vector<float> values;
};
struct SnapScore {
    std::uint64_t points = 0;
};
struct SnapEngine {
    int value = 0;
};

}  // namespace snapshot_test

template <>
struct limn::ComponentTraits<snapshot_test::SnapMark> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<snapshot_test::SnapSelected> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<snapshot_test::SnapCache> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

namespace snapshot_test {

void register_snapshot_types() {
    register_all_components();
    register_component<SnapGears>();
    register_component<SnapMark>();
    register_component<SnapSelected>();
    register_resource<SnapScore>();
}

/// Tables, tags, strings, lists, sparse components, dead entities, resources of both kinds.
void fill(World& world) {
    register_snapshot_types();
    for (int i = 0; i < 1500; ++i) {
        world.create(
            Transform{.position = {static_cast<float>(i), 0, 0}}, PointLight{.intensity = 5});
    }
    const Entity lamp = world.create(Transform{}, Name{"lamp"}, SnapCache{{1, 2}});
    world.create(
        SnapGears{{lamp, {}, lamp}, "a label that is longer than a small string"}, Teleport{});
    std::vector<Entity> dead;
    for (int i = 0; i < 40; ++i) {
        dead.push_back(world.create(Transform{}));
    }
    for (std::size_t i = 0; i < dead.size(); i += 3) {
        world.destroy(dead[i]);
    }
    world.add(lamp, SnapMark{42});
    world.add(dead[1], SnapMark{43});
    world.add(lamp, SnapSelected{});
    world.insert_resource(SnapScore{1234567890123});
    world.insert_resource(FrameTime{.frame = 77});
    world.insert_resource(SnapEngine{5});
}

std::vector<std::byte> save(const World& world) {
    Result<std::vector<std::byte>> bytes = save_snapshot(world);
    REQUIRE_MESSAGE(bytes.ok(), (bytes ? "" : bytes.error().message));
    return *bytes;
}

/// The message of a restore that must fail and change nothing.
std::string refusal(std::span<const std::byte> bytes) {
    World world;
    world.create(Transform{}, Name{"before"});
    world.insert_resource(SnapScore{1});
    const std::uint64_t before = state_hash(world);
    const Status status = restore_snapshot(world, bytes);
    CHECK_FALSE(status.ok());
    CHECK(state_hash(world) == before);
    return status ? "" : status.error().message;
}

}  // namespace snapshot_test

using namespace limn;
using namespace snapshot_test;

TEST_CASE("snapshot: a restored world is the saved one: values, handles, order, resources") {
    World world;
    fill(world);
    const std::vector<std::byte> bytes = save(world);

    World restored;
    REQUIRE(restore_snapshot(restored, bytes).ok());
    CHECK(restored.entity_count() == world.entity_count());
    CHECK(save(restored) == bytes);

    std::vector<Entity> order;
    std::vector<Entity> restored_order;
    world.query<const Transform>().each(
        [&](Entity entity, const Transform&) { order.push_back(entity); });
    restored.query<const Transform>().each(
        [&](Entity entity, const Transform&) { restored_order.push_back(entity); });
    CHECK(order == restored_order);
    world.each_entity([&](Entity entity) {
        REQUIRE(restored.alive(entity));
        CHECK(restored.has<Name>(entity) == world.has<Name>(entity));
        CHECK(restored.has<SnapSelected>(entity) == world.has<SnapSelected>(entity));
        if (const SnapMark* mark = world.find<const SnapMark>(entity); mark != nullptr) {
            CHECK(restored.get<const SnapMark>(entity).value == mark->value);
        }
        if (const SnapGears* gears = world.find<const SnapGears>(entity); gears != nullptr) {
            CHECK(restored.get<const SnapGears>(entity).teeth == gears->teeth);
            CHECK(restored.get<const SnapGears>(entity).label == gears->label);
        }
        CHECK_FALSE(restored.has<SnapCache>(entity));  // never saved
    });
    CHECK(restored.resource<SnapScore>().points == 1234567890123);
    CHECK(restored.resource<FrameTime>().frame == 77);
    CHECK(restored.find_resource<SnapEngine>() == nullptr);  // not registered: not saved
}

TEST_CASE("snapshot: the restored world allocates the same handles afterwards") {
    World world;
    fill(world);
    World restored;
    REQUIRE(restore_snapshot(restored, save(world)).ok());
    for (int i = 0; i < 3000; ++i) {
        const Entity a = world.create(Transform{});
        const Entity b = restored.create(Transform{});
        REQUIRE(a == b);
        if (i % 2 == 0) {
            world.destroy(a);
            restored.destroy(b);
        }
    }
}

TEST_CASE("snapshot: rolling back undoes whatever happened since") {
    World world;
    fill(world);
    const std::vector<std::byte> bytes = save(world);
    const std::uint64_t before = state_hash(world);
    std::vector<Entity> all;
    world.each_entity([&](Entity entity) { all.push_back(entity); });
    for (std::size_t i = 0; i < all.size(); i += 2) {
        world.destroy(all[i]);
    }
    world.create_many(100, Transform{}, Name{"new"});
    world.resource<SnapScore>().points = 0;
    world.insert_resource(RandomSeed{5});
    CHECK(state_hash(world) != before);
    REQUIRE(restore_snapshot(world, bytes).ok());
    CHECK(save(world) == bytes);
    CHECK(world.find_resource<RandomSeed>() == nullptr);  // was not there
    CHECK(world.resource<SnapEngine>().value == 5);       // is not part of it
    CHECK(world.query<const Transform>().count() == 1500 + 1 + 26);
}

TEST_CASE("snapshot: rolling back reuses existing memory") {
    World world;
    register_snapshot_types();
    world.create_many(50'000, Transform{});
    const std::vector<std::byte> bytes = save(world);
    const Transform* before = nullptr;
    const Transform* after = nullptr;
    const auto look = [&](const Transform*& first) {
        first = nullptr;
        world.query<const Transform>().chunks([&](ChunkView, std::span<const Transform> some) {
            first = first == nullptr ? some.data() : first;
        });
    };
    look(before);
    world.create_many(10, Transform{}, Name{"more"});
    REQUIRE(restore_snapshot(world, bytes).ok());
    look(after);
    CHECK(before == after);
    CHECK(save(world) == bytes);
    const std::size_t memory = world.memory().total();
    for (int i = 0; i < 10; ++i) {
        REQUIRE(restore_snapshot(world, bytes).ok());
    }
    CHECK(world.memory().total() == memory);
}

TEST_CASE("snapshot: observers see the old world go and the new one come") {
    int added = 0;
    int removed = 0;
    World world;
    fill(world);
    const std::vector<std::byte> bytes = save(world);
    world.on_add<PointLight>([&](World&, std::span<const Entity> entities) {
        added += static_cast<int>(entities.size());
    });
    world.on_remove<PointLight>([&](World&, std::span<const Entity> entities) {
        removed += static_cast<int>(entities.size());
    });
    REQUIRE(restore_snapshot(world, bytes).ok());
    CHECK(removed == 1500);
    CHECK(added == 1500);
}

TEST_CASE("snapshot: an empty world is saved and restored") {
    World empty;
    const std::vector<std::byte> bytes = save(empty);
    World world;
    fill(world);
    REQUIRE(restore_snapshot(world, bytes).ok());
    CHECK(world.entity_count() == 0);
    CHECK(world.find_resource<SnapScore>() == nullptr);
}

TEST_CASE("snapshot: what cannot be saved is named") {
    {
        World world;
        world.create(SnapForgotten{});
        CHECK(
            save_snapshot(world).error().message
            == "component snap_forgotten: not registered, so it cannot be saved; register it, or "
               "mark it as not saved");
    }
    {
        register_component<SnapOpaque>();
        World world;
        world.create(SnapOpaque{});
        CHECK(
            save_snapshot(world).error().message
            == "component snap_opaque: cannot be serialized; give it LIMN_FIELDS, or mark it as "
               "not saved");
    }
}

TEST_CASE("snapshot: truncated at any byte, it is rejected and changes nothing") {
    World world;
    register_snapshot_types();
    const Entity e = world.create(Transform{}, Name{"x"});
    world.create(SnapGears{{e}, "y"});
    world.add(e, SnapMark{3});
    world.insert_resource(SnapScore{4});
    const std::vector<std::byte> bytes = save(world);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        std::vector<std::byte> cut(
            bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        CHECK_FALSE(refusal(cut).empty());
        seal_snapshot(cut);
        CHECK_FALSE(refusal(cut).empty());
    }
    std::vector<std::byte> longer = bytes;
    longer.push_back(std::byte{0});
    CHECK(refusal(longer) == "snapshot: found 513 bytes, expected 48 plus the sizes in the header");
    seal_snapshot(longer);
    CHECK(refusal(longer) == "snapshot: found 115 bytes of data, expected the 114 of the pieces");
}

TEST_CASE("snapshot: any altered byte is detected") {
    World world;
    register_snapshot_types();
    world.create(Transform{}, Name{"x"});
    const std::vector<std::byte> bytes = save(world);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::vector<std::byte> altered = bytes;
        altered[i] ^= std::byte{0x10};
        CHECK_FALSE(refusal(altered).empty());
    }
    std::vector<std::byte> altered = bytes;
    altered.back() ^= std::byte{1};
    CHECK(refusal(altered) == "snapshot: corrupt: the checksum of the data does not match");
    altered = bytes;
    altered[8] = std::byte{9};
    CHECK(refusal(altered) == "snapshot: found version 9, expected 2");
    CHECK(refusal({}) == "snapshot: not a snapshot: it does not begin with LIMNSNAP");
}

TEST_CASE("snapshot: any altered byte with a matching checksum gives an error or a valid world") {
    World world;
    register_snapshot_types();
    const Entity e = world.create(Transform{}, Name{"x"});
    world.create(SnapGears{{e}, "y"}, PointLight{});
    world.destroy(world.create());
    world.add(e, SnapMark{3});
    world.insert_resource(SnapScore{4});
    const std::vector<std::byte> bytes = save(world);
    int refused = 0;
    for (std::size_t i = kSnapshotHeaderSize; i < bytes.size(); ++i) {
        for (const int flip : {0x01, 0x80, 0xff}) {
            std::vector<std::byte> altered = bytes;
            altered[i] ^= static_cast<std::byte>(flip);
            seal_snapshot(altered);
            World target;
            const Status status = restore_snapshot(target, altered);
            if (status) {
                static_cast<void>(state_hash(target));
                CHECK(save_snapshot(target).ok());
                target.create(Transform{});
            } else {
                ++refused;
                CHECK(target.entity_count() == 0);
            }
        }
    }
    CHECK(refused > 300);
}

TEST_CASE("snapshot: a free slot that is missing, duplicated or linked by a live one is detected") {
    World world;
    register_snapshot_types();
    const std::vector<Entity> all = world.create_many(4, SnapMark{});
    world.destroy(all[1]);
    world.destroy(all[3]);
    const std::vector<std::byte> bytes = save(world);
    // The links 0xffffffff, 3, 0xffffffff, 0xffffffff come behind the generations 1, 2, 1, 2.
    const std::uint32_t links[] = {1, 2, 1, 2, kNoLink, 3, kNoLink, kNoLink};
    const auto* pattern = reinterpret_cast<const std::byte*>(links);
    const auto found = std::search(bytes.begin(), bytes.end(), pattern, pattern + sizeof links);
    REQUIRE(found != bytes.end());
    const auto refusal_with = [&](std::size_t slot, std::uint32_t link) {
        std::vector<std::byte> altered = bytes;
        std::memcpy(&altered[found - bytes.begin() + 16 + 4 * slot], &link, sizeof link);
        seal_snapshot(altered);
        return refusal(altered);
    };
    CHECK(refusal_with(3, 2) == "snapshot: slots: the free list is longer than 2");
    CHECK(
        refusal_with(1, 1)
        == "snapshot: slots: free slot 1 appears twice or is not below the slot count 4");
    CHECK(
        refusal_with(1, 7)
        == "snapshot: slots: free slot 7 appears twice or is not below the slot count 4");
    CHECK(refusal_with(0, 2) == "snapshot: slots: found a link in slot 0, which is not free");
}

TEST_CASE("snapshot: a component that is unknown to this program, or differs, is named") {
    World world;
    register_snapshot_types();
    world.create(Transform{});
    std::vector<std::byte> bytes = save(world);
    std::vector<std::byte> renamed = bytes;
    const char name[] = "transform";
    const auto at = std::search(
        renamed.begin(), renamed.end(), reinterpret_cast<const std::byte*>(name),
        reinterpret_cast<const std::byte*>(name) + 9);
    REQUIRE(at != renamed.end());
    *at = std::byte{'T'};
    seal_snapshot(renamed);
    CHECK(refusal(renamed) == "snapshot: component Transform: unknown to this program");
    at[9] ^= std::byte{1};
    *at = std::byte{'t'};
    seal_snapshot(renamed);
    CHECK(refusal(renamed) == "snapshot: component transform: was saved with different fields");
}

TEST_CASE("state hash: it does not depend on threads or on the creation order of archetypes") {
    const int before = thread_count();
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        World world;
        fill(world);
        hashes.push_back(state_hash(world));
    }
    set_thread_count(before);
    CHECK(hashes[0] == hashes[1]);
    CHECK(hashes[0] == hashes[2]);

    World a;
    World b;
    b.destroy(b.create(PointLight{}, Transform{}));  // an archetype more, and earlier
    a.destroy(a.create(Name{}));
    const Entity ea = a.create(Transform{});
    const Entity eb = b.create(Transform{});
    REQUIRE(ea == eb);
    a.create(PointLight{}, Transform{});
    b.create(Transform{}, PointLight{});
    CHECK(state_hash(a) == state_hash(b));
}

TEST_CASE("state hash: everything that is state counts") {
    const auto differs = [](auto change) {
        World world;
        fill(world);
        const std::uint64_t before = state_hash(world);
        change(world);
        return state_hash(world) != before;
    };
    CHECK_FALSE(differs([](World&) {}));
    CHECK(differs([](World& world) { world.create(); }));
    CHECK(differs([](World& world) { world.create(Transform{}); }));
    CHECK(differs([](World& world) {
        world.query<Transform>().each(
            [](Transform& t) { t.scale.z += t.position.x == 1100 ? 1e-6f : 0.0f; });
    }));
    CHECK(differs(
        [](World& world) { world.query<Name>().each([](Name& name) { name.text += "s"; }); }));
    CHECK(differs(
        [](World& world) { world.query<SnapMark>().each([](SnapMark& mark) { ++mark.value; }); }));
    CHECK(differs([](World& world) { world.add<SnapSelected>(world.create()); }));
    CHECK(differs([](World& world) { world.resource<SnapScore>().points ^= 1; }));
    // What is marked as not hashed, and resources nobody registered, are not.
    CHECK_FALSE(differs(
        [](World& world) { world.query<SnapCache>().each([](SnapCache& c) { c.values = {7}; }); }));
    CHECK_FALSE(differs([](World& world) { world.resource<SnapEngine>().value = 9; }));
}

TEST_CASE("state hash: two entities that swap their rows are another state") {
    World a;
    World b;
    const Entity first = a.create(Transform{});
    a.create(Transform{.position = {1, 0, 0}});
    b.create(Transform{});
    b.create(Transform{.position = {1, 0, 0}});
    CHECK(state_hash(a) == state_hash(b));
    // Away and back: now it is the last row.
    a.add(first, Name{});
    a.remove<Name>(first);
    CHECK(state_hash(a) != state_hash(b));
}
