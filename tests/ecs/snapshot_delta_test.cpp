#include "ecs/base/rng.h"
#include "ecs/commands.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/ecs/snapshot_seal.h"

#include <doctest/doctest.h>

#include <string>

namespace delta_test {

using namespace limn;

struct DeltaPlace {
    float x = 0, y = 0, z = 0;
};
struct DeltaSpeed {
    float x = 0, y = 0;
};
/// Padded: saved field by field.
struct DeltaLife {
    bool is_old = false;
    std::uint32_t days = 0;
};
template <typename Visitor>
void visit_fields(DeltaLife& life, Visitor&& visit) {
    visit("is_old", life.is_old);
    visit("days", life.days);
}
struct DeltaText {
    std::string text;
};
template <typename Visitor>
void visit_fields(DeltaText& text, Visitor&& visit) {
    visit("text", text.text);
}
struct DeltaFlag {};
/// Split.
struct DeltaSpin {
    float x = 0, y = 0;
    std::uint32_t turns = 1;
};
/// Toggled, with a value and without.
struct DeltaLamp {
    std::uint16_t watts = 40;
};
struct DeltaAwake {};
struct DeltaHeat {
    int degrees = 0;
};
struct DeltaNote {
    std::string text;
};
template <typename Visitor>
void visit_fields(DeltaNote& note, Visitor&& visit) {
    visit("text", note.text);
}
struct DeltaPicked {};
struct DeltaCache {
    std::vector<int> values;
};
struct DeltaScore {
    std::uint64_t points = 0;
};
struct DeltaTitle {
    std::string text;
};
template <typename Visitor>
void visit_fields(DeltaTitle& title, Visitor&& visit) {
    visit("text", title.text);
}

}  // namespace delta_test

template <>
struct limn::ComponentTraits<delta_test::DeltaSpin> : DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaLamp> : DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaAwake> : DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaHeat> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaNote> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaPicked> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<delta_test::DeltaCache> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

namespace delta_test {

void register_types() {
    register_component<DeltaPlace>();
    register_component<DeltaSpeed>();
    register_component<DeltaLife>();
    register_component<DeltaText>();
    register_component<DeltaFlag>();
    register_component<DeltaSpin>();
    register_component<DeltaLamp>();
    register_component<DeltaAwake>();
    register_component<DeltaHeat>();
    register_component<DeltaNote>();
    register_component<DeltaPicked>();
    register_resource<DeltaScore>();
    register_resource<DeltaTitle>();
}

std::vector<std::byte> save(const World& world, SnapshotMark* mark = nullptr) {
    return save_snapshot(world, mark).value();
}

/// A world to which anything may happen.
struct Story {
    World world;
    Random rng;
    std::vector<Entity> living;

    explicit Story(std::uint64_t seed) : rng(seed, 0, name_hash("delta_test"), 0) {
        register_types();
    }

    Entity any() { return living[rng.below(static_cast<std::uint32_t>(living.size()))]; }

    void create(std::uint32_t count) {
        const auto f = static_cast<float>(rng.below(100));
        switch (rng.below(8)) {
        case 0:
            keep(world.create_many(count, DeltaPlace{f, 0, 0}));
            break;
        case 1:
            keep(world.create_many(count, DeltaPlace{0, f, 0}, DeltaSpeed{f, f}));
            break;
        case 2:
            keep(world.create_many(count, DeltaPlace{}, DeltaCache{{1, 2}}));
            break;
        case 3:
            keep(world.create_many(count, DeltaText{std::string(rng.below(40), 'x')}));
            break;
        case 4:
            keep(world.create_many(count, DeltaLife{true, rng.below(9)}, DeltaFlag{}));
            break;
        case 5:
            keep(world.create_many(count, DeltaPlace{}, DeltaSpin{f, 0, 1}, DeltaAwake{}));
            break;
        case 6:
            keep(world.create_many(count, DeltaLamp{}, DeltaAwake{}));
            break;
        default:
            keep(world.create_many(count, DeltaHeat{3}));
            break;
        }
    }
    void keep(const std::vector<Entity>& entities) {
        living.insert(living.end(), entities.begin(), entities.end());
    }
    void destroy() {
        const std::uint32_t index = rng.below(static_cast<std::uint32_t>(living.size()));
        world.destroy(living[index]);
        living[index] = living.back();
        living.pop_back();
    }

    void toggle_component(Entity entity) {
        const auto flip = [&](auto value) {
            using T = decltype(value);
            if (!world.remove<T>(entity)) {
                world.add(entity, value);
            }
        };
        switch (rng.below(11)) {
        case 0:
            flip(DeltaSpeed{1, 2});
            break;
        case 1:
            flip(DeltaText{"later"});
            break;
        case 2:
            flip(DeltaFlag{});
            break;
        case 3:
            flip(DeltaHeat{7});
            break;
        case 4:
            flip(DeltaNote{std::string(30, 'n')});
            break;
        case 5:
            flip(DeltaPicked{});
            break;
        case 6:
            flip(DeltaCache{{3}});
            break;
        case 7:
            flip(DeltaSpin{3, 4, 5});
            break;
        case 8:
            flip(DeltaLamp{60});
            break;
        case 9:
            flip(DeltaAwake{});
            break;
        default:
            flip(DeltaLife{false, 4});
            break;
        }
    }

    void write(Entity entity) {
        if (auto* place = world.find<DeltaPlace>(entity); place != nullptr) {
            place->z += static_cast<float>(rng.below(3));
        }
        if (auto* text = world.find<DeltaText>(entity); text != nullptr) {
            text->text += 'y';
        }
        if (auto* heat = world.find<DeltaHeat>(entity); heat != nullptr) {
            ++heat->degrees;
        }
        if (auto* life = world.find<DeltaLife>(entity); life != nullptr) {
            ++life->days;
        }
        if (world.has<DeltaSpin>(entity)) {
            world.set(entity, DeltaSpin{1, 2, rng.below(5)});
        }
        if (world.has<DeltaLamp>(entity)) {
            world.set_enabled<DeltaLamp>(entity, rng.below(2) == 0);
        }
        if (world.has<DeltaAwake>(entity)) {
            world.set_enabled<DeltaAwake>(entity, rng.below(2) == 0);
        }
    }

    void use_resources() {
        switch (rng.below(4)) {
        case 0:
            world.insert_resource(DeltaScore{rng.below(5)});
            break;
        case 1:
            world.insert_resource(DeltaTitle{std::string(rng.below(20), 't')});
            break;
        case 2:
            world.remove_resource<DeltaScore>();
            break;
        default:
            if (auto* title = world.find_resource<DeltaTitle>(); title != nullptr) {
                title->text += '!';
            }
            break;
        }
    }

    void run_commands() {
        world.run([this](Query<const DeltaPlace> places, Commands commands) {
            const std::uint32_t step = 2 + rng.below(400);
            std::uint32_t i = 0;
            places.each([&](Entity entity, const DeltaPlace&) {
                if (++i % step == 0) {
                    commands.add(entity, DeltaSpeed{static_cast<float>(i), 0});
                }
            });
        });
    }

    /// One thing, small or large.
    void happen() {
        if (living.empty()) {
            create(1);
        }
        switch (rng.below(12)) {
        case 0:
            create(1 + rng.below(30));
            break;
        case 1:
            create(rng.below(8) == 0 ? 1024 + rng.below(3) - 1 : 1);
            break;
        case 2:
        case 3:
            destroy();
            break;
        case 4:
            if (rng.below(40) == 0) {
                world.clear();
                living.clear();
            }
            break;
        case 5:
            use_resources();
            break;
        case 6:
            if (rng.below(4) == 0) {
                run_commands();
            }
            break;
        case 7:
            if (rng.below(10) == 0) {
                world.query<DeltaPlace>().each([](DeltaPlace& place) { place.x += 1; });
            }
            break;
        case 8:
        case 9:
            toggle_component(any());
            break;
        default:
            write(any());
            break;
        }
    }
};

/// 100 000 entities of 4 components.
void fill_large(World& world) {
    register_types();
    world.create_many(100'000, DeltaPlace{1, 2, 3}, DeltaSpeed{}, DeltaLife{}, DeltaText{"abc"});
}

}  // namespace delta_test

using namespace limn;
using namespace delta_test;

TEST_CASE("delta: applied to any earlier snapshot it is the snapshot of its moment, to the byte") {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
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

TEST_CASE("delta: a chain of deltas, each from the mark of the one before, follows the world") {
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
    const Entity one = world.create(DeltaPlace{}, DeltaSpeed{}, DeltaLife{}, DeltaText{});
    SnapshotMark mark;
    const std::size_t all = save(world, &mark).size();
    CHECK(save_delta(world, mark)->size() < 400);  // nothing
    world.get<DeltaPlace>(one).x = 9;
    const std::size_t chunk = 100'001 % 1024 * sizeof(DeltaPlace);
    const std::size_t size = save_delta(world, mark)->size();
    CHECK(size > chunk);
    CHECK(size < chunk + 500);
    CHECK(all > 3'000'000);
    // A string too: its column is cut into chunks like the others.
    world.get<DeltaText>(one).text = "abcdef";
    CHECK(save_delta(world, mark)->size() < size + 100'001 % 1024 * 7 + 200);
}

TEST_CASE("delta: one entity created and one destroyed cost their chunks, not the slots of all") {
    World world;
    fill_large(world);
    const std::vector<Entity> few = world.create_many(1500, DeltaPlace{});
    SnapshotMark mark;
    static_cast<void>(save(world, &mark));
    world.create(DeltaPlace{});
    world.destroy(few[1]);
    // Two chunks of place and entities, two of generations and links.
    const std::size_t most = 2 * 1024 * (sizeof(DeltaPlace) + sizeof(Entity) + 8);
    CHECK(save_delta(world, mark)->size() < most + 1000);
}

TEST_CASE("delta: a bit that is set is a change, and costs no values") {
    World world;
    register_types();
    const Entity one = world.create_many(5000, DeltaLamp{}, DeltaAwake{}, DeltaSpin{})[3000];
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    world.disable<DeltaAwake>(one);
    world.disable<DeltaLamp>(one);
    const std::vector<std::byte> delta = save_delta(world, mark, &mark).value();
    CHECK(delta.size() < 2 * 128 + 400);
    const std::vector<std::byte> later = apply_delta(bytes, delta).value();
    CHECK(later == save(world));
    World restored;
    REQUIRE(restore_snapshot(restored, later).ok());
    CHECK_FALSE(restored.is_enabled<DeltaAwake>(one));
    CHECK_FALSE(restored.is_enabled<DeltaLamp>(one));
    CHECK(restored.query<With<DeltaLamp>>().count() == 4999);
    CHECK(state_hash(restored) == state_hash(world));
}

TEST_CASE("delta: taking everything for writing without changing it costs next to nothing") {
    World world;
    fill_large(world);
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    world.query<DeltaPlace, DeltaText>().each([](DeltaPlace& place, DeltaText&) { place.x = 1; });
    const std::vector<std::byte> delta = save_delta(world, mark).value();
    CHECK(delta.size() < 400);
    CHECK(apply_delta(bytes, delta).value() == bytes);
}

TEST_CASE("delta: changes are seen across the wrap of versions") {
    World world;
    register_types();
    world.set_version(0xfffffffeu);
    const Entity e = world.create(DeltaPlace{});
    world.create_many(3000, DeltaPlace{});
    SnapshotMark mark;
    std::vector<std::byte> bytes = save(world, &mark);
    for (int i = 0; i < 6; ++i) {
        world.get<DeltaPlace>(e).x += 1;
        bytes = apply_delta(bytes, save_delta(world, mark, &mark).value()).value();
        REQUIRE(bytes == save(world));
    }
    CHECK(world.core().now() < 100);
}

TEST_CASE("delta: to a mark from before versions were forgotten, everything is new") {
    World world;
    register_types();
    const Entity e = world.create(DeltaPlace{});
    SnapshotMark mark;
    const std::vector<std::byte> bytes = save(world, &mark);
    // The same number again after 2^32 runs, with a change on the way.
    const std::uint32_t begin = world.core().now();
    for (std::uint32_t quarter = 1; quarter <= 4; ++quarter) {
        world.set_version(begin + quarter * (1u << 30));
        static_cast<void>(world.begin_run());
        if (quarter == 1) {
            world.get<DeltaPlace>(e).x = 5;
        }
    }
    CHECK(apply_delta(bytes, save_delta(world, mark).value()).value() == save(world));
}

TEST_CASE("delta: a restored world goes on from its snapshot with small deltas") {
    World world;
    fill_large(world);
    const Entity one = world.create(DeltaText{"x"});
    SnapshotMark before;
    std::vector<std::byte> bytes = save(world, &before);
    world.destroy(one);
    SnapshotMark mark;
    REQUIRE(restore_snapshot(world, bytes, &mark).ok());
    CHECK(save_delta(world, mark)->size() < 500);
    world.get<DeltaText>(one).text = "y";
    const std::vector<std::byte> delta = save_delta(world, mark).value();
    CHECK(delta.size() < 600);
    CHECK(apply_delta(bytes, delta).value() == save(world));
    // A mark from before the restore still gives a delta that is right, if a large one.
    CHECK(apply_delta(bytes, save_delta(world, before).value()).value() == save(world));
}

TEST_CASE("delta: applied to another snapshot it is refused") {
    Story story(5);
    story.create(10);
    SnapshotMark mark;
    const std::vector<std::byte> first = save(story.world, &mark);
    story.create(1);
    const std::vector<std::byte> second = save(story.world);
    const std::vector<std::byte> delta = save_delta(story.world, mark).value();
    CHECK(apply_delta(second, delta).error().message == "delta: belongs to another snapshot");
    CHECK(
        apply_delta({}, delta).error().message
        == "delta: the earlier snapshot: no snapshot: it does not begin with LIMNSNAP");
    CHECK(
        apply_delta(first, first).error().message
        == "delta: no delta: it does not begin with LIMNDELT");
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

TEST_CASE("delta: cut off or altered, with or without a fitting checksum, it is an error") {
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
    for (std::size_t size = 0; size < delta.size(); ++size) {
        std::vector<std::byte> cut(
            delta.begin(), delta.begin() + static_cast<std::ptrdiff_t>(size));
        CHECK_FALSE(apply_delta(base, cut).ok());
        test::seal_delta(cut);
        CHECK_FALSE(apply_delta(base, cut).ok());
    }
    for (std::size_t i = 0; i < delta.size(); ++i) {
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
