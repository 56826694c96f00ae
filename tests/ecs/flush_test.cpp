#include "ecs/flush_stats.h"
#include "ecs/world.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace limn;
using namespace limn::test;

// The paths of a sync point against each other and against the world's own operations.

namespace {

/// Who an entity is, in every world; never removed.
struct Number {
    std::uint32_t value = 0;
};
/// A field a column.
struct Lanes {
    float x = 0, y = 0, z = 0;
};
/// Can be disabled.
struct Switch {
    int value = 0;
};
/// No entity ever has it.
struct Never {
    std::string text;
};

}  // namespace

template <>
struct limn::ComponentTraits<Lanes> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<Switch> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};

namespace {

enum class Act : std::uint8_t { Add, Set, Remove, Destroy, Create };

struct Step {
    Act act;
    std::uint32_t who;    ///< position in the list of entities; those created follow
    std::uint32_t what;   ///< which component
    std::uint32_t value;  ///< of the component
};

constexpr std::uint32_t kKinds = 9;

std::string text_of(std::uint32_t value) {
    return "a text that is too long to be kept in place: " + std::to_string(value);
}

/// call(component) with the component that `what` means.
template <typename Call>
void with_component(std::uint32_t what, std::uint32_t value, const Call& call) {
    const float x = static_cast<float>(value);
    switch (what) {
    case 0:
        return call(Position{x, 1, 2});
    case 1:
        return call(Velocity{x, x, x});
    case 2:
        return call(Label{text_of(value), {1, 2}});
    case 3:
        return call(Marked{});
    case 4:
        return call(Heat{static_cast<int>(value)});
    case 5:
        return call(Note{text_of(value)});
    case 6:
        return call(Counted(static_cast<int>(value)));
    case 7:
        return call(Lanes{x, x + 1, x + 2});
    default:
        return call(Switch{static_cast<int>(value)});
    }
}

struct Call {
    std::string event;
    std::vector<Entity> entities;
    bool operator==(const Call&) const = default;
};

/// A world with `count` entities in three archetypes, and what its observers were told.
struct Scene {
    std::vector<Call> calls;
    World world;
    std::vector<Entity> entities;

    auto log(std::string event) {
        return [this, event = std::move(event)](World&, std::span<const Entity> told) {
            calls.push_back({event, {told.begin(), told.end()}});
        };
    }

    explicit Scene(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const float x = static_cast<float>(i);
            entities.push_back(world.create(Number{i}, Position{x, 0, 0}));
        }
        for (std::uint32_t i = 0; i < count / 3; ++i) {
            const float x = static_cast<float>(i);
            entities.push_back(world.create(
                Number{count + i}, Position{x, 0, 0}, Label{text_of(i), {}}, Lanes{x, x, x}));
            if (i % 3 == 0) {
                world.add(entities.back(), Note{text_of(i)});
            }
        }
        for (std::uint32_t i = 0; i < 40; ++i) {
            entities.push_back(world.create(Number{3 * count + i}, Counted(1), Switch{2}));
            world.set_enabled<Switch>(entities.back(), i % 2 == 0);
        }
        world.on_add<Position>(log("+position"));
        world.on_remove<Position>(log("-position"));
        world.on_add<Note>(log("+note"));
        world.on_remove<Note>(log("-note"));
        world.on_add<Label>(log("+label"));
        world.on_remove<Label>(log("-label"));
    }

    void record(const Commands& commands, const std::vector<Step>& steps) {
        for (const Step& step : steps) {
            if (step.act == Act::Create) {
                const Number number{1'000'000 + step.value};
                with_component(step.what, step.value, [&]<typename T>(T&& component) {
                    entities.push_back(commands.create(number, std::move(component)));
                });
                continue;
            }
            const Entity entity = entities[step.who];
            with_component(step.what, step.value, [&]<typename T>(T&& component) {
                if (step.act == Act::Add) {
                    commands.add(entity, std::move(component));
                } else if (step.act == Act::Set) {
                    commands.set(entity, std::move(component));
                } else if (step.act == Act::Remove) {
                    commands.remove<T>(entity);
                } else {
                    commands.destroy(entity);
                }
            });
        }
    }

    /// The same at once.
    void carry_out(const std::vector<Step>& steps) {
        for (const Step& step : steps) {
            if (step.act == Act::Create) {
                const Number number{1'000'000 + step.value};
                with_component(step.what, step.value, [&]<typename T>(T&& component) {
                    entities.push_back(world.create(number, std::move(component)));
                });
                continue;
            }
            const Entity entity = entities[step.who];
            if (!world.alive(entity)) {
                continue;
            }
            with_component(step.what, step.value, [&]<typename T>(T&& component) {
                if (step.act == Act::Destroy) {
                    world.destroy(entity);
                } else if (step.act == Act::Remove) {
                    world.remove<T>(entity);
                } else if (step.act == Act::Add || world.has<T>(entity)) {
                    const bool enabled = world.is_enabled(entity, component_id<T>);
                    world.add(entity, std::move(component));
                    if constexpr (std::is_same_v<T, Switch>) {
                        world.set_enabled<Switch>(entity, step.act == Act::Add || enabled);
                    }
                }
            });
        }
    }

    /// All that the entity has.
    [[nodiscard]] std::string describe(Entity entity) const {
        std::string text = std::to_string(world.get<Number>(entity).value) + ":";
        const auto put = [&](const char* name, double value) {
            text += " " + std::string(name) + std::to_string(value);
        };
        if (const auto* position = world.find<Position>(entity)) {
            put("p", position->x);
        }
        if (const auto* velocity = world.find<Velocity>(entity)) {
            put("v", velocity->x);
        }
        if (const auto* label = world.find<Label>(entity)) {
            text += label->text + std::to_string(label->numbers.size());
        }
        if (world.has<Marked>(entity)) {
            text += " marked";
        }
        if (const auto* heat = world.find<Heat>(entity)) {
            put("h", heat->degrees);
        }
        if (const auto* note = world.find<Note>(entity)) {
            text += note->text;
        }
        if (const auto* counted = world.find<Counted>(entity)) {
            put("c", counted->value);
        }
        if (world.has<Lanes>(entity)) {
            const Lanes lanes = world.value<Lanes>(entity);
            put("lanes", 10'000'000.0 * lanes.x + 1000 * lanes.y + lanes.z);
        }
        if (const auto* value = world.find<Switch>(entity)) {
            put(world.is_enabled<Switch>(entity) ? "on" : "off", value->value);
        }
        return text;
    }

    /// Everything, rows in their order, with handles.
    [[nodiscard]] std::vector<std::string> rows() const {
        std::vector<std::string> all;
        for (const auto& archetype : world.archetypes()) {
            for (std::uint32_t row = 0; row < archetype->size(); ++row) {
                const Entity entity = archetype->entities()[row];
                CHECK(world.core().entities.find(entity).row == row);
                all.push_back(describe(entity) + " " + std::to_string(entity.bits()));
            }
        }
        return all;
    }
    [[nodiscard]] std::vector<std::string> content() const {
        std::vector<std::string> all;
        world.each_entity([&](Entity entity) { all.push_back(describe(entity)); });
        std::sort(all.begin(), all.end());
        return all;
    }
};

void apply(World& world, std::initializer_list<CommandBuffer*> buffers) {
    apply_commands(world, std::span<CommandBuffer* const>(buffers.begin(), buffers.size()));
}

/// Each list stresses a path: all in order, some in order, in any order, several an entity.
std::vector<std::vector<Step>> make_lists(std::uint32_t entities, std::mt19937& random) {
    const auto any = [&](std::uint32_t below) {
        return static_cast<std::uint32_t>(random() % below);
    };
    std::vector<std::vector<Step>> lists;
    for (const Act act : {Act::Add, Act::Set, Act::Remove, Act::Destroy}) {
        const std::uint32_t what = any(kKinds);
        for (const std::uint32_t stride : {1u, 3u}) {
            std::vector<Step> list;
            for (std::uint32_t i = 0; i < entities; i += stride) {
                list.push_back({act, i, what, i});
            }
            lists.push_back(list);
            std::shuffle(list.begin(), list.end(), random);
            list.resize(list.size() / 2);
            lists.push_back(std::move(list));
        }
    }
    for (const std::uint32_t length : {entities / 5, 2 * entities}) {
        std::vector<Step> list;
        std::uint32_t known = entities;
        for (std::uint32_t i = 0; i < length; ++i) {
            const std::uint32_t dice = any(100);
            const Act act = dice < 10   ? Act::Create
                            : dice < 15 ? Act::Destroy
                            : dice < 35 ? Act::Remove
                            : dice < 50 ? Act::Set
                                        : Act::Add;
            list.push_back({act, any(known), any(kKinds), i});
            known += act == Act::Create ? 1 : 0;
        }
        lists.push_back(std::move(list));
    }
    return lists;
}

}  // namespace

TEST_CASE(
    "flush: rows moved in ranges, one at a time or folded end up the same, as do observer calls") {
    std::mt19937 random(11);
    Counted::living = 0;
    for (const std::uint32_t count : {5u, 768u, 1023u, 1024u, 1025u, 2048u, 2049u, 3072u}) {
        const auto size = static_cast<std::uint32_t>(Scene(count).entities.size());
        for (const std::vector<Step>& list : make_lists(size, random)) {
            CAPTURE(count);
            Scene plain(count);
            Scene folded(count);
            Scene direct(count);
            CommandBuffer first;
            CommandBuffer second;
            plain.record(Commands(first), list);
            apply(plain.world, {&first});

            // Another command for every entity, one that does nothing: all take the folding path.
            folded.record(Commands(first), list);
            for (std::uint32_t i = 0; i < size; ++i) {
                Commands(second).set(folded.entities[size - 1 - i], Never{text_of(i)});
            }
            apply(folded.world, {&first, &second});
            CHECK(plain.rows() == folded.rows());
            CHECK(plain.calls == folded.calls);
            CHECK(plain.world.flush_stats().flushes == 1);
            CHECK(plain.world.flush_stats().commands == list.size());

            direct.carry_out(list);
            CHECK(plain.content() == direct.content());
        }
    }
    CHECK(Counted::living == 0);
}

TEST_CASE("flush: an archetype that moves as a whole hands over its columns, there and back") {
    World world;
    const std::vector<Entity> entities = world.create_many(5000, Position{1, 2, 3}, Mass{4});
    world.query<Position>().each(
        [i = 0](Position& position) mutable { position.x = static_cast<float>(i++); });
    CommandBuffer buffer;
    const Commands commands(buffer);
    for (int round = 0; round < 3; ++round) {
        for (const Entity entity : entities) {
            commands.add(entity, Velocity{world.get<const Position>(entity).x, 0, 0});
        }
        apply(world, {&buffer});
        CHECK(world.flush_stats().archetypes_handed_over == 2u * static_cast<unsigned>(round) + 1);
        bool same = true;
        for (std::uint32_t i = 0; i < entities.size(); ++i) {
            same = same && world.get<const Position>(entities[i]).x == static_cast<float>(i)
                   && world.get<const Velocity>(entities[i]).x == static_cast<float>(i)
                   && world.get<const Mass>(entities[i]).value == 4;
        }
        CHECK(same);
        for (const Entity entity : entities) {
            commands.remove<Velocity>(entity);
        }
        apply(world, {&buffer});
        CHECK(world.query<const Velocity>().empty());
        CHECK(world.query<const Position>().count() == entities.size());
    }
    CHECK(world.flush_stats().rows_moved_singly == 0);
    CHECK(world.flush_stats().rows_handed_over == 6 * entities.size());
}

TEST_CASE("flush: all of a query are destroyed, added to and removed from in one call") {
    Counted::living = 0;
    for (const std::uint32_t count : {1u, 1023u, 1024u, 1025u, 4096u}) {
        CAPTURE(count);
        std::vector<Call> calls;
        World world;
        const auto log = [&](const char* event) {
            return [&calls, event](World&, std::span<const Entity> told) {
                calls.push_back({event, {told.begin(), told.end()}});
            };
        };
        const std::vector<Entity> plain = world.create_many(count, Position{}, Counted(1));
        const std::vector<Entity> marked = world.create_many(count, Position{}, Marked{});
        const Entity other = world.create(Mass{2});
        for (std::uint32_t i = 0; i < count; i += 3) {
            world.add(marked[i], Heat{7});
        }
        world.on_add<Label>(log("+label"));
        world.on_remove<Label>(log("-label"));
        world.on_remove<Position>(log("-position"));

        std::vector<Entity> both = plain;
        both.insert(both.end(), marked.begin(), marked.end());
        world.add_all(world.query<const Position>(), Label{text_of(5), {1}});
        CHECK(world.query<const Label>().count() == 2 * count);
        CHECK_FALSE(world.has<Label>(other));
        CHECK(world.get<Label>(marked.back()).text == text_of(5));
        CHECK(calls == std::vector<Call>{{"+label", both}});

        // Again: values are replaced, nobody is told.
        world.add_all(world.query<With<Marked>>(), Label{text_of(6), {}});
        CHECK(world.get<Label>(marked[0]).text == text_of(6));
        CHECK(world.get<Label>(plain[0]).text == text_of(5));
        CHECK(calls.size() == 1);

        world.add_all(world.query<const Position>(), Lanes{1, 2, 3});
        CHECK(world.value<Lanes>(plain.back()).z == 3);
        world.add_all(world.query<const Position, Without<Marked>>(), Note{text_of(8)});
        CHECK(world.query<const Note>().count() == count);
        CHECK(world.get<Note>(plain[0]).text == text_of(8));

        world.remove_all<Label>(world.query<const Heat>());
        std::vector<Entity> hot;
        for (std::uint32_t i = 0; i < count; i += 3) {
            hot.push_back(marked[i]);
            CHECK_FALSE(world.has<Label>(marked[i]));
        }
        CHECK(calls.size() == 2);
        CHECK(calls.back() == Call{"-label", hot});
        CHECK(world.query<const Label>().count() == 2 * count - hot.size());

        const std::uint32_t since = world.version();
        world.get<Position>(plain[0]).x = 1;
        world.destroy_all(world.query<const Counted, Changed<Position>>().since(since));
        const std::uint32_t chunk = std::min(count, 1024u);
        CHECK(world.query<const Position>().count() == 2 * count - chunk);
        CHECK(Counted::living == static_cast<int>(count - chunk));
        CHECK(calls.size() == 4);  // -label and -position

        world.destroy_all(world.query<const Position>());
        CHECK(world.entity_count() == 1);
        CHECK(world.alive(other));
        CHECK(Counted::living == 0);
        world.destroy_all(world.query<const Position>());
        CHECK(world.entity_count() == 1);
    }
}

TEST_CASE("flush: a query led by a sparse set changes rows in the order of that set") {
    World world;
    const std::vector<Entity> all = world.create_many(3000, Position{});
    // Heat comes from behind, so that the query visits the rows from behind.
    for (std::size_t i = all.size(); i-- > 0;) {
        if (i % 2 == 0) {
            world.add(all[i], Heat{static_cast<int>(i)});
        }
    }
    std::vector<Entity> told;
    world.on_add<Label>([&](World&, std::span<const Entity> entities) {
        told.insert(told.end(), entities.begin(), entities.end());
    });
    world.add_all(world.query<const Position, With<Heat>>(), Label{text_of(3), {}});
    CHECK(world.query<const Label>().count() == 1500);
    CHECK(told.size() == 1500);
    CHECK(std::is_sorted(
        told.begin(), told.end(), [](Entity a, Entity b) { return a.index < b.index; }));
    world.destroy_all(world.query<const Position, With<Heat>>());
    CHECK(world.query<const Position>().count() == 1500);
    for (std::size_t i = 0; i < all.size(); ++i) {
        CHECK(world.alive(all[i]) == (i % 2 != 0));
    }
}

TEST_CASE("flush: cached plans are dropped when archetypes are reset") {
    World world;
    const auto grow = [&](auto value) {
        world.run([&](Query<const Position> rows, Commands commands) {
            rows.each([&](Entity entity, const Position&) { commands.add(entity, value); });
        });
    };
    world.create_many(5, Position{1, 2, 3});
    grow(Mass{4});
    CHECK(world.query<const Mass>().count() == 5);
    // The same archetypes, made in another order, perhaps where the old ones lay.
    for (int round = 0; round < 8; ++round) {
        CAPTURE(round);
        world.clear();
        world.create_many(round % 3, Velocity{});
        world.create_many(4, Position{1, 2, 3}, Marked{});
        world.create_many(5, Position{5, 6, 7});
        grow(Mass{8});
        REQUIRE(world.query<const Mass>().count() == 9);
        REQUIRE(world.query<const Mass, With<Marked>>().count() == 4);
        world.query<const Mass, const Position, Without<Marked>>().each(
            [](const Mass& mass, const Position& place) {
                CHECK(mass.value == 8);
                CHECK(place.z == 7);
            });
    }
}

TEST_CASE("flush: only sync points with commands count") {
    World world;
    world.create_many(3, Position{});
    const auto idle = [](Query<const Position>, Commands) {};
    world.run(idle);
    CHECK(world.flush_stats().flushes == 0);
    world.run([](Query<const Position> rows, Commands commands) {
        rows.each([&](Entity entity, const Position&) { commands.add(entity, Marked{}); });
    });
    world.run(idle);
    CHECK(world.flush_stats().flushes == 1);
    CHECK(world.flush_stats().commands == 3);
}

TEST_CASE("flush: disabled rows do not belong to the query") {
    World world;
    const std::vector<Entity> entities = world.create_many(2500, Switch{1});
    for (std::size_t i = 0; i < entities.size(); i += 2) {
        world.disable<Switch>(entities[i]);
    }
    world.add_all(world.query<const Switch>(), Mass{3});
    for (std::size_t i = 0; i < entities.size(); ++i) {
        REQUIRE(world.has<Mass>(entities[i]) == (i % 2 == 1));
        REQUIRE(world.is_enabled<Switch>(entities[i]) == (i % 2 == 1));
    }
    world.destroy_all(world.query<const Switch>());
    CHECK(world.entity_count() == 1250);
    CHECK(world.alive(entities[0]));
}

TEST_CASE("flush: an observer may start another sync point") {
    World world;
    CommandBuffer inner;
    world.on_add<Mass>([&](World& w, std::span<const Entity> told) {
        for (const Entity entity : told) {
            Commands(inner).add(entity, Velocity{});
        }
        apply(w, {&inner});
    });
    std::vector<Entity> told;
    world.on_add<Velocity>([&](World&, std::span<const Entity> entities) {
        told.insert(told.end(), entities.begin(), entities.end());
    });
    CommandBuffer outer;
    const std::vector<Entity> entities = world.create_many(1500, Position{});
    for (int round = 0; round < 2; ++round) {
        for (const Entity entity : entities) {
            Commands(outer).add(entity, Mass{1});
        }
        apply(world, {&outer});
        CHECK(world.query<const Velocity, const Mass, const Position>().count() == 1500);
        CHECK(told == entities);
        told.clear();
        world.remove_all<Mass>(world.query<const Mass>());
        world.remove_all<Velocity>(world.query<const Velocity>());
    }
}

TEST_CASE("flush: rows keep their order when they move, and gaps are filled from the end") {
    World world;
    CommandBuffer buffer;
    const Commands commands(buffer);
    std::vector<Entity> entities;
    for (std::uint32_t i = 0; i < 10; ++i) {
        entities.push_back(world.create(Number{i}));
    }
    for (const std::uint32_t i : {7u, 1u, 4u}) {
        commands.add(entities[i], Marked{});
    }
    commands.create(Number{20}, Marked{});
    commands.create(Number{21}, Marked{});
    apply(world, {&buffer});
    std::vector<std::uint32_t> order;
    const auto note = [&](const Number& number) { order.push_back(number.value); };
    world.query<const Number, Without<Marked>>().each(note);
    CHECK(order == std::vector<std::uint32_t>{0, 8, 2, 3, 9, 5, 6});
    order.clear();
    world.query<const Number, With<Marked>>().each(note);
    CHECK(order == std::vector<std::uint32_t>{1, 4, 7, 20, 21});
}
