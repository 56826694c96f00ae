#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "ecs/prefab.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/stop_message.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace toggle_test {

using namespace limn;
using limn::test::stop_message;

struct Body {
    int value = 0;
};
struct Chill {
    int value = 0;
};
/// The toggled components, and the same as plain ones.
struct Power {
    int value = 0;
};
struct Motto {
    std::string value;
};
struct Lit {};
struct PlainPower {
    int value = 0;
};
struct PlainMotto {
    std::string value;
};
struct PlainLit {};
/// In snapshots.
struct ToggledCharge {
    int value = 0;
};
struct ToggledSign {};

void register_toggled() {
    register_component<ToggledCharge>();
    register_component<ToggledSign>();
}

}  // namespace toggle_test

template <>
struct limn::ComponentTraits<toggle_test::Chill> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<toggle_test::Power> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::Motto> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::Lit> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::ToggledCharge> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::ToggledSign> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};

namespace toggle_test {

// ---- the law: disabled is as good as removed, but for the value
// -----------------------------------

struct Toggled {
    using Power = toggle_test::Power;
    using Motto = toggle_test::Motto;
    using Lit = toggle_test::Lit;
    static constexpr bool is_toggled = true;
};
struct Plain {
    using Power = PlainPower;
    using Motto = PlainMotto;
    using Lit = PlainLit;
    static constexpr bool is_toggled = false;
};

constexpr std::size_t kMaxEntities = 4096;

/// A world of one kind. Its entities have numbers, the same in both.
template <typename Kind>
struct Side {
    World world;
    std::vector<Entity> entities = std::vector<Entity>(kMaxEntities);
    std::vector<int> number_of;  ///< by index of the handle
    std::vector<std::optional<typename Kind::Power>> hidden_power{kMaxEntities};
    std::vector<std::optional<typename Kind::Motto>> hidden_motto{kMaxEntities};
    std::vector<std::optional<typename Kind::Lit>> hidden_lit{kMaxEntities};
    CommandBuffer buffer;
    bool records = false;  ///< operations are recorded, where there are commands for them

    template <typename T>
    auto& hidden() {
        if constexpr (std::is_same_v<T, typename Kind::Power>) {
            return hidden_power;
        } else if constexpr (std::is_same_v<T, typename Kind::Motto>) {
            return hidden_motto;
        } else {
            return hidden_lit;
        }
    }

    template <typename... Ts>
    void create(std::size_t number, Ts... components) {
        const Entity entity = world.create(std::move(components)...);
        entities[number] = entity;
        number_of.resize(std::max<std::size_t>(number_of.size(), entity.index + 1));
        number_of[entity.index] = static_cast<int>(number);
    }
    void destroy(std::size_t number) {
        world.destroy(entities[number]);
        hidden_power[number].reset();
        hidden_motto[number].reset();
        hidden_lit[number].reset();
    }
    template <typename T>
    void add(std::size_t number, T value) {
        if (Kind::is_toggled && records) {
            Commands(buffer).add(entities[number], std::move(value));
            return;
        }
        world.add(entities[number], std::move(value));
        if constexpr (!Kind::is_toggled) {
            hidden<T>()[number].reset();
        }
    }
    template <typename T>
    void remove(std::size_t number) {
        if (Kind::is_toggled && records) {
            Commands(buffer).remove<T>(entities[number]);
            return;
        }
        world.remove<T>(entities[number]);
        if constexpr (!Kind::is_toggled) {
            hidden<T>()[number].reset();
        }
    }
    template <typename T>
    void write(std::size_t number, T value) {
        const Entity entity = entities[number];
        if (Kind::is_toggled && records) {
            Commands(buffer).set(entity, std::move(value));
        } else if (T* found = world.find<T>(entity); found != nullptr) {
            *found = std::move(value);
        } else if (!Kind::is_toggled && hidden<T>()[number]) {
            hidden<T>()[number] = std::move(value);
        }
    }
    template <typename T>
    void set_enabled(std::size_t number, bool enabled) {
        const Entity entity = entities[number];
        if constexpr (Kind::is_toggled) {
            if (records) {
                Commands(buffer).set_enabled<T>(entity, enabled);
            } else if (world.has<T>(entity)) {
                world.set_enabled<T>(entity, enabled);
            }
        } else if (enabled && hidden<T>()[number]) {
            world.add(entity, std::move(*hidden<T>()[number]));
            hidden<T>()[number].reset();
        } else if (!enabled && world.has<T>(entity)) {
            hidden<T>()[number] = std::move(world.get<T>(entity));
            world.remove<T>(entity);
        }
    }
    void flush() {
        CommandBuffer* const all[] = {&buffer};
        apply_commands(world, all);
    }
};

int digest(int value) {
    return value;
}
int digest(const std::string& value) {
    return static_cast<int>(value.size() * 256) + (value.empty() ? 0 : value.back());
}
template <typename T>
int digest(const T&) requires(std::is_empty_v<T>) {
    return 1;
}
template <typename T>
int digest(const T& component) requires requires {
    component.value;
}
{ return digest(component.value); }
template <typename T>
int digest(T* component) {
    return component == nullptr ? -1 : digest(*component);
}

using Seen = std::vector<std::pair<int, int>>;  // number of the entity, digest of the arguments

template <typename... Terms, typename Kind>
Seen seen_by_each(Side<Kind>& side) {
    Seen seen;
    side.world.template query<Terms...>().each([&](Entity entity, auto&&... arguments) {
        int total = 0;
        ((total = total * 31 + digest(arguments)), ...);
        seen.emplace_back(side.number_of[entity.index], total);
    });
    std::sort(seen.begin(), seen.end());
    return seen;
}

template <typename... Terms, typename Kind>
Seen seen_by_par_each(Side<Kind>& side) {
    std::vector<int> found(kMaxEntities, -1);
    std::vector<int> times(kMaxEntities, 0);
    side.world.template query<Terms...>().par_each([&](Entity entity, auto&&... arguments) {
        int total = 0;
        ((total = total * 31 + digest(arguments)), ...);
        const std::size_t number = static_cast<std::size_t>(side.number_of[entity.index]);
        found[number] = total;
        ++times[number];
    });
    Seen seen;
    for (std::size_t i = 0; i < kMaxEntities; ++i) {
        for (int k = 0; k < times[i]; ++k) {
            seen.emplace_back(static_cast<int>(i), found[i]);
        }
    }
    return seen;
}

template <typename... Terms, typename Kind>
std::vector<int> contained_in(Side<Kind>& side) {
    std::vector<int> numbers;
    const auto query = side.world.template query<Terms...>();
    for (std::size_t i = 0; i < kMaxEntities; ++i) {
        if (query.contains(side.entities[i])) {
            numbers.push_back(static_cast<int>(i));
        }
    }
    return numbers;
}

/// Numbers of what chunk.enabled() lets through.
template <typename... Terms, typename Kind>
std::vector<int> seen_by_chunks(Side<Kind>& side) {
    std::vector<int> numbers;
    side.world.template query<Terms...>().chunks([&](ChunkView chunk, auto&&...) {
        CHECK(chunk.enabled().any());
        CHECK(chunk.all_enabled() == (chunk.enabled() == RowMask::first(chunk.size())));
        chunk.enabled().for_each([&](std::uint32_t row) {
            numbers.push_back(side.number_of[chunk.entities()[row].index]);
        });
    });
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

std::vector<int> numbers_of(const Seen& seen) {
    std::vector<int> numbers;
    for (const auto& [number, value] : seen) {
        numbers.push_back(number);
    }
    return numbers;
}

/// All ways to visit a query, which must agree; what each() saw. `Chunked`: chunks() can do it.
template <bool chunked, typename... Terms, typename Kind>
Seen seen_by(Side<Kind>& side) {
    const Seen seen = seen_by_each<Terms...>(side);
    const std::vector<int> numbers = numbers_of(seen);
    CHECK(seen_by_par_each<Terms...>(side) == seen);
    CHECK(side.world.template query<Terms...>().count() == seen.size());
    CHECK(contained_in<Terms...>(side) == numbers);
    if constexpr (chunked) {
        CHECK(seen_by_chunks<Terms...>(side) == numbers);
    }
    return seen;
}

template <typename Kind>
std::vector<Seen> seen_in_all_queries(Side<Kind>& side) {
    using P = typename Kind::Power;
    using M = typename Kind::Motto;
    using L = typename Kind::Lit;
    return {
        seen_by<true, const P>(side),
        seen_by<true, const Body, With<P, L>>(side),
        seen_by<true, const P, Without<L>>(side),
        seen_by<true, const Body, Without<P, M>>(side),
        seen_by<true, const P, const M>(side),
        seen_by<true, With<L>, Without<Body>>(side),
        seen_by<false, Optional<const P>, Optional<const L>, const Body>(side),
        seen_by<false, const L, Optional<const M>>(side),
        seen_by<false, const P, const Chill>(side),
        seen_by<false, const Chill, Without<L>>(side),
        seen_by<false, const P, Without<Chill>>(side),
        seen_by<true, const P, Changed<M>>(side),
    };
}

/// Creates, destroys, adds, removes, writes, enables and disables at random in both worlds; the
/// number of entities wanders between the edges of chunks.
class Law {
  public:
    explicit Law(std::uint64_t seed) : random_(seed, 0, 0, 0) {}

    void run(int operations) {
        constexpr std::size_t kEdges[] = {1023, 1024, 1025, 2047, 2048, 2049, 3072};
        for (int i = 0; i < operations; ++i) {
            if (i % 500 == 0) {
                target_ = kEdges[random_.below(std::size(kEdges))];
            }
            if (i % 40 == 0) {
                toggled_.flush();
                toggled_.records = random_.below(2) == 0;
            }
            one_operation();
            if (i % 2500 == 2499) {
                compare();
            }
        }
        compare();
        CHECK(toggled_.world.entity_count() == plain_.world.entity_count());
    }

  private:
    template <typename F>
    void both(const F& function) {
        function(toggled_);
        function(plain_);
    }

    void one_operation() {
        const bool grows = alive_.size() < target_;
        const std::uint32_t dice = random_.below(100);
        if (alive_.empty() || dice < (alive_.size() + 200 < target_ ? 90u : grows ? 20u : 4u)) {
            create();
        } else if (dice < (grows ? 22u : 24u)) {
            toggled_.flush();  // the commands before this belong to entities that still live
            const std::size_t place = random_.below(static_cast<std::uint32_t>(alive_.size()));
            both([&](auto& side) { side.destroy(alive_[place]); });
            free_.push_back(alive_[place]);
            alive_[place] = alive_.back();
            alive_.pop_back();
        } else {
            const std::size_t number =
                alive_[random_.below(static_cast<std::uint32_t>(alive_.size()))];
            switch (random_.below(4)) {
            case 0:
                change<Power, PlainPower>(number, [this] { return next(); });
                break;
            case 1:
                change<Motto, PlainMotto>(
                    number, [this] { return "motto number " + std::to_string(next()); });
                break;
            case 2:
                change<Lit, PlainLit>(number, 0);
                break;
            default:
                move(number);
                break;
            }
        }
    }

    int next() { return static_cast<int>(random_.below(1000)); }

    void create() {
        std::size_t number = alive_.size() + free_.size();
        if (!free_.empty()) {
            number = free_.back();
            free_.pop_back();
        }
        REQUIRE(number < kMaxEntities);
        alive_.push_back(number);
        const int value = next();
        if (random_.below(3) == 0) {
            toggled_.create(number, Body{value}, Lit{}, Power{value});
            plain_.create(number, Body{value}, PlainLit{}, PlainPower{value});
        } else {
            toggled_.create(number, Power{value}, Motto{"born"});
            plain_.create(number, PlainPower{value}, PlainMotto{"born"});
        }
    }

    template <typename T, typename P, typename Value>
    void change(std::size_t number, const Value& value) {
        const std::uint32_t dice = random_.below(10);
        if (dice < 2) {
            if constexpr (std::is_empty_v<T>) {
                toggled_.add(number, T{});
                plain_.add(number, P{});
            } else {
                const auto made = value();
                toggled_.add(number, T{made});
                plain_.add(number, P{made});
            }
        } else if (dice < 3) {
            toggled_.remove<T>(number);
            plain_.remove<P>(number);
        } else if (dice < 9) {
            const bool enabled = dice < 6;
            toggled_.set_enabled<T>(number, enabled);
            plain_.set_enabled<P>(number, enabled);
        } else if constexpr (!std::is_empty_v<T>) {
            const auto made = value();
            toggled_.write(number, T{made});
            plain_.write(number, P{made});
        }
    }
    void move(std::size_t number) {
        const int value = next();
        const bool adds = random_.below(2) == 0;
        const bool sparse = random_.below(2) == 0;
        both([&](auto& side) {
            World& world = side.world;
            const Entity entity = side.entities[number];
            if (sparse) {
                adds ? void(world.add(entity, Chill{value})) : void(world.remove<Chill>(entity));
            } else {
                adds ? void(world.add(entity, Body{value})) : void(world.remove<Body>(entity));
            }
        });
    }

    void compare() {
        toggled_.flush();
        const std::vector<Seen> toggled = seen_in_all_queries(toggled_);
        const std::vector<Seen> plain = seen_in_all_queries(plain_);
        for (std::size_t i = 0; i < toggled.size(); ++i) {
            INFO("query " << i);
            REQUIRE(toggled[i] == plain[i]);
        }
    }

    Random random_;
    Side<Toggled> toggled_;
    Side<Plain> plain_;
    std::vector<std::size_t> alive_;
    std::vector<std::size_t> free_;
    std::size_t target_ = 0;
};

}  // namespace toggle_test

using namespace toggle_test;

TEST_CASE("toggle: disable is to queries like remove, and enable like adding the old value") {
    for (const std::uint64_t seed : {1, 2, 3, 4}) {
        INFO("seed " << seed);
        Law(seed).run(25'000);
    }
}

TEST_CASE("toggle: a disabled component is there, with its value, but queries do not find it") {
    World world;
    const Entity entity = world.create(Power{5}, Lit{});
    CHECK(world.is_enabled<Power>(entity));
    CHECK(world.disable<Power>(entity));
    CHECK_FALSE(world.disable<Power>(entity));
    CHECK_FALSE(world.is_enabled<Power>(entity));
    CHECK(world.has<Power>(entity));
    CHECK(world.get<Power>(entity).value == 5);
    CHECK(world.query<const Power>().empty());
    CHECK(world.query<const Power>().find<const Power>(entity) == nullptr);
    CHECK(world.query<Without<Power>>().single_entity() == entity);
    CHECK(world.is_enabled<Lit>(entity));
    CHECK(world.enable<Power>(entity));
    CHECK_FALSE(world.enable<Power>(entity));
    CHECK(world.query<const Power>().find<const Power>(entity)->value == 5);
    CHECK(std::get<0>(world.query<const Power, With<Lit>>().single()).value == 5);
    CHECK_FALSE(world.is_enabled<Motto>(entity));
    world.destroy(entity);
    CHECK_FALSE(world.is_enabled<Power>(entity));
}

TEST_CASE("toggle: adding enables, replacing the value through a reference or set does not") {
    World world;
    const Entity entity = world.create(Power{1});
    const auto disabled = [&] {
        world.disable<Power>(entity);
        return !world.is_enabled<Power>(entity);
    };
    REQUIRE(disabled());
    world.get<Power>(entity).value = 2;
    CHECK_FALSE(world.is_enabled<Power>(entity));
    world.add(entity, Power{3});
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.add(entity, component_id<Power>);
    CHECK(world.is_enabled<Power>(entity));
    CHECK(world.get<Power>(entity).value == 3);
    REQUIRE(disabled());
    const Power four{4};
    world.add_copy(entity, component_id<Power>, &four);
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.run([entity](Commands commands) { commands.set(entity, Power{5}); });
    CHECK_FALSE(world.is_enabled<Power>(entity));
    CHECK(world.get<Power>(entity).value == 5);
    world.run([entity](Commands commands) { commands.add(entity, Power{6}); });
    CHECK(world.is_enabled<Power>(entity));
    REQUIRE(disabled());
    world.remove<Power>(entity);
    world.add(entity, Power{7});
    CHECK(world.is_enabled<Power>(entity));
}

TEST_CASE("toggle: commands fold in order, and say nothing to entities without the component") {
    World world;
    const Entity a = world.create(Body{}, Power{1});
    const Entity b = world.create(Body{});
    const Entity c = world.create(Body{}, Power{3});
    const Entity d = world.create(Body{}, Lit{});
    Entity made;
    world.run([&](Commands commands) {
        commands.disable<Power>(a);
        commands.disable<Power>(b);
        commands.remove<Power>(c);
        commands.disable<Power>(c);
        commands.add(c, Power{4});
        commands.add(d, Power{5});
        commands.disable<Power>(d);
        commands.disable<Lit>(d);
        commands.enable<Lit>(d);
        const Entity placeholder = commands.create(Body{}, Motto{"new"});
        commands.disable<Motto>(placeholder);
    });
    CHECK_FALSE(world.is_enabled<Power>(a));
    CHECK_FALSE(world.has<Power>(b));
    CHECK(world.is_enabled<Power>(c));
    CHECK(world.get<Power>(c).value == 4);
    CHECK(world.has<Power>(d));
    CHECK_FALSE(world.is_enabled<Power>(d));
    CHECK(world.is_enabled<Lit>(d));
    made = world.query<const Body, Without<Motto, Power, Lit>>().contains(b) ? b : Entity{};
    CHECK(made == b);
    CHECK(world.query<const Motto>().empty());
    CHECK(world_stats(world).entities == 5);
}

TEST_CASE("toggle: rows take their bits along when others go, and new rows are enabled") {
    for (const std::size_t count : {1023u, 1024u, 1025u, 2047u, 2048u, 2049u}) {
        World world;
        std::vector<Entity> entities = world.create_many(count, Power{});
        for (std::size_t i = 0; i < count; i += 3) {
            world.disable<Power>(entities[i]);
        }
        for (std::size_t i = 0; i < count; i += 7) {
            world.destroy(entities[i]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            CHECK(world.is_enabled<Power>(entities[i]) == (i % 7 != 0 && i % 3 != 0));
        }
        for (const Entity entity : world.create_many(count, Power{})) {
            CHECK(world.is_enabled<Power>(entity));
        }
        world.clear();
        world.create_many(count, Power{});
        CHECK(world.query<const Power>().count() == count);
    }
}

TEST_CASE("toggle: chunks() skips what is disabled as a whole, and each() leaves it untouched") {
    World world;
    const std::vector<Entity> entities = world.create_many(3000, Power{});
    for (std::size_t i = 1024; i < 2048; ++i) {
        world.disable<Power>(entities[i]);
    }
    world.disable<Power>(entities[5]);
    const std::uint32_t before = world.version();
    std::vector<std::uint32_t> indices;
    world.query<const Power>().chunks([&](ChunkView chunk, std::span<const Power> powers) {
        CHECK(powers.size() == chunk.size());
        CHECK(chunk.all_enabled() == (chunk.index() == 2));
        CHECK(chunk.enabled<Power>() == chunk.enabled());
        indices.push_back(chunk.index());
    });
    CHECK(indices == std::vector<std::uint32_t>{0, 2});
    world.query<Power>().each([](Power& power) { power.value = 1; });
    CHECK(world.get<const Power>(entities[5]).value == 0);
    CHECK(world.query<Without<Body>, Changed<Power>>().since(before).count() == 1023 + 952);
    world.enable<Power>(entities[1030]);
    CHECK(world.query<Changed<Power>>().since(before).count() == 1023 + 952 + 1);
}

TEST_CASE("toggle: the chunk of a written term enables and disables while iterating") {
    World world;
    const std::vector<Entity> entities = world.create_many(2500, Power{}, Lit{});
    const auto by_value = [](Query<Power, Optional<Lit>> query) {
        query.par_chunks([](ChunkView chunk, std::span<Power> powers, std::span<Lit> lit) {
            CHECK(lit.empty());
            for (std::uint32_t row = 0; row < chunk.size(); ++row) {
                powers[row].value = static_cast<int>(chunk.entities()[row].index % 3);
                chunk.set_enabled<Power>(row, powers[row].value != 0);
                chunk.set_enabled<Lit>(row, powers[row].value == 1);
            }
            CHECK(chunk.all_enabled());
        });
    };
    world.run(by_value);
    for (const Entity entity : entities) {
        CHECK(world.is_enabled<Power>(entity) == (entity.index % 3 != 0));
        CHECK(world.is_enabled<Lit>(entity) == (entity.index % 3 == 1));
    }
}

TEST_CASE("toggle: misuse stops with a message") {
    World world;
    const Entity with = world.create(Power{});
    const Entity without = world.create(Body{});
    CHECK(stop_message([&] { world.disable<Power>(without); }).find("power") != std::string::npos);
    const std::string iterating = stop_message(
        [&] { world.query<const Body>().each([&](const Body&) { world.disable<Power>(with); }); });
    CHECK(iterating.find("while iterating") != std::string::npos);
    const std::string unwritten = stop_message([&] {
        world.query<const Power>().chunks(
            [](ChunkView chunk, std::span<const Power>) { chunk.set_enabled<Power>(0, false); });
    });
    CHECK(unwritten.find("not a written term") != std::string::npos);
    world.destroy(with);
    CHECK(stop_message([&] { world.disable<Power>(with); }).find("stale") != std::string::npos);
}

// ---- versions
// ------------------------------------------------------------------------------------

namespace toggle_test {

struct Watched {
    std::size_t powers = 0;
    std::size_t lights = 0;
};

void watch(
    Query<With<Body>, Changed<Power>> powers, Query<With<Body>, Changed<Lit>> lights,
    Res<Watched> watched) {
    *watched = {powers.count(), lights.count()};
}

}  // namespace toggle_test

TEST_CASE(
    "toggle: enabling and disabling is a change of the component in its chunk, if it is one") {
    for (const std::uint32_t start : {1u, 0x7ffffff0u, 0xfffffff0u}) {
        World world;
        world.set_version(start);
        world.insert_resource(Watched{});
        const std::vector<Entity> entities = world.create_many(3000, Body{}, Power{}, Lit{});
        const auto seen = [&] {
            world.run(watch);
            const Watched& watched = world.resource<Watched>();
            return std::pair(watched.powers, watched.lights);
        };
        using Pair = std::pair<std::size_t, std::size_t>;
        CHECK(seen() == Pair{3000, 3000});
        for (int i = 0; i < 10; ++i) {
            CHECK(seen() == Pair{0, 0});
            world.disable<Power>(entities[1500]);
            CHECK(seen() == Pair{1023, 0});
            world.disable<Power>(entities[1500]);
            CHECK(seen() == Pair{0, 0});
            world.disable<Lit>(entities[5]);
            CHECK(seen() == Pair{0, 1023});
            world.run([&](Commands commands) {
                commands.enable<Lit>(entities[5]);
                commands.enable<Power>(entities[1500]);
            });
            CHECK(seen() == Pair{1024, 1024});
        }
        const std::uint32_t before = world.version();
        world.disable<Lit>(entities[2999]);
        std::vector<bool> changed;
        world.query<const Power>().chunks([&](ChunkView chunk, std::span<const Power>) {
            changed.push_back(chunk.changed_since<Lit>(before));
        });
        CHECK(changed == std::vector<bool>{false, false, true});
    }
}

TEST_CASE("toggle: a bit that changed very long ago never becomes new again") {
    World world;
    world.insert_resource(Watched{});
    const Entity entity = world.create(Body{}, Lit{});
    world.create(Body{}, Lit{});
    world.disable<Lit>(entity);
    world.run(watch);
    std::uint32_t version = world.version();
    for (int i = 0; i < 40; ++i) {
        version += 1u << 27;
        world.set_version(version);
        const std::uint32_t recently = world.version() - 1000;
        world.run(watch);
        CHECK(world.resource<Watched>().lights == 0);
        CHECK(world.query<Changed<Lit>>().since(recently).count() == 0);
    }
    world.enable<Lit>(entity);
    world.run(watch);
    CHECK(world.resource<Watched>().lights == 2);
}

TEST_CASE("toggle: no observer is told of enabling and disabling") {
    World world;
    int calls = 0;
    world.on_add<Power>([&](World&, std::span<const Entity>) { ++calls; });
    world.on_remove<Power>([&](World&, std::span<const Entity>) { ++calls; });
    const Entity entity = world.create(Power{});
    CHECK(calls == 1);
    world.disable<Power>(entity);
    world.enable<Power>(entity);
    world.run([entity](Commands commands) { commands.disable<Power>(entity); });
    world.add(entity, Power{2});
    CHECK(calls == 1);
    world.disable<Power>(entity);
    world.remove<Power>(entity);
    CHECK(calls == 2);
}

// ---- threads, snapshots, prefabs
// ------------------------------------------------------------------------------------

namespace toggle_test {

void charge(Query<ToggledCharge, With<ToggledSign>> charges) {
    charges.par_each([](ToggledCharge& charge) { charge.value += 3; });
}
void flip(Query<ToggledCharge> charges) {
    charges.par_chunks([](ChunkView chunk, std::span<ToggledCharge> values) {
        chunk.enabled().for_each([&](std::uint32_t row) {
            values[row].value += 1;
            chunk.set_enabled<ToggledCharge>(row, values[row].value % 5 != 0);
        });
    });
}

/// About `count` entities of two archetypes, a third of the bits disabled, some holes filled.
void fill_toggled(World& world, std::size_t count) {
    register_toggled();
    Random random(7, 0, 0, 0);
    std::vector<Entity> entities;
    for (std::size_t i = 0; i < count; ++i) {
        entities.push_back(
            i % 5 == 0 ? world.create(ToggledCharge{static_cast<int>(i)})
                       : world.create(ToggledCharge{static_cast<int>(i)}, ToggledSign{}));
        if (random.below(3) == 0) {
            world.disable<ToggledCharge>(entities.back());
        }
        if (i % 5 != 0 && random.below(3) == 0) {
            world.disable<ToggledSign>(entities.back());
        }
    }
    for (std::size_t i = 0; i < count; i += 11) {
        world.destroy(entities[i]);
    }
}

}  // namespace toggle_test

TEST_CASE("toggle: the same bits for any number of threads") {
    const int threads = thread_count();
    std::vector<std::uint64_t> hashes;
    for (const int count : {1, 2, 7}) {
        set_thread_count(count);
        World world;
        fill_toggled(world, 20'000);
        for (int i = 0; i < 4; ++i) {
            world.run(charge);
            world.run(flip);
        }
        hashes.push_back(state_hash(world));
    }
    set_thread_count(threads);
    CHECK(hashes[1] == hashes[0]);
    CHECK(hashes[2] == hashes[0]);
}

TEST_CASE("toggle: a snapshot brings every bit back") {
    for (const std::size_t count : {1u, 63u, 64u, 65u, 1130u, 3000u}) {
        World world;
        fill_toggled(world, count);
        const Result<std::vector<std::byte>> bytes = save_snapshot(world);
        REQUIRE(bytes.ok());
        World copy;
        copy.create(Body{});
        REQUIRE(restore_snapshot(copy, *bytes).ok());
        CHECK(state_hash(copy) == state_hash(world));
        world.each_entity([&](Entity entity) {
            CHECK(
                copy.is_enabled<ToggledCharge>(entity) == world.is_enabled<ToggledCharge>(entity));
            CHECK(copy.is_enabled<ToggledSign>(entity) == world.is_enabled<ToggledSign>(entity));
        });
        CHECK(*save_snapshot(copy) == *bytes);
    }
}

TEST_CASE("toggle: the state hash tells every single bit apart, and forgets what was undone") {
    World world;
    const std::vector<Entity> entities = world.create_many(1030, ToggledCharge{}, ToggledSign{});
    const std::uint64_t enabled = state_hash(world);
    std::vector<std::uint64_t> hashes{enabled};
    for (const std::size_t i : {0u, 1u, 63u, 64u, 1023u, 1024u, 1029u}) {
        world.disable<ToggledCharge>(entities[i]);
        hashes.push_back(state_hash(world));
        world.enable<ToggledCharge>(entities[i]);
        world.disable<ToggledSign>(entities[i]);
        hashes.push_back(state_hash(world));
        world.enable<ToggledSign>(entities[i]);
        CHECK(state_hash(world) == enabled);
    }
    std::sort(hashes.begin(), hashes.end());
    CHECK(std::adjacent_find(hashes.begin(), hashes.end()) == hashes.end());
    World longer;
    const std::vector<Entity> more = longer.create_many(5000, ToggledCharge{}, ToggledSign{});
    for (std::size_t i = more.size(); i > 1030; --i) {
        longer.disable<ToggledSign>(more[i - 1]);
        longer.destroy(more[i - 1]);
    }
    longer.disable<ToggledSign>(more[3]);
    world.disable<ToggledSign>(entities[3]);
    CHECK(state_hash(longer) == state_hash(world));
}

TEST_CASE("toggle: copies of a prefab have disabled what it has") {
    register_toggled();
    World world;
    const Entity root = world.create(ToggledCharge{1}, ToggledSign{});
    const Entity child = world.create(ToggledCharge{2}, ToggledSign{}, Parent{root});
    world.disable<ToggledSign>(root);
    world.disable<ToggledCharge>(child);
    const Prefab prefab = make_prefab(world, root);
    for (const Entity copy : spawn(world, prefab, 3)) {
        CHECK(world.is_enabled<ToggledCharge>(copy));
        CHECK(world.has<ToggledSign>(copy));
        CHECK_FALSE(world.is_enabled<ToggledSign>(copy));
    }
    CHECK(world.query<const ToggledCharge>().count() == 4);
    CHECK(world.query<With<ToggledSign>>().count() == 4);
    CHECK(world.query<With<Parent>, Without<ToggledCharge>>().count() == 4);
}

TEST_CASE("toggle: bits go along when ranges of rows, whole archetypes and holes in them move") {
    for (const std::size_t count : {1023u, 1024u, 1025u, 3000u}) {
        World world;
        const std::vector<Entity> entities = world.create_many(count, Power{}, Lit{}, Body{});
        const auto is_on = [](std::size_t i) { return i % 3 != 0 && (i < 1024 || i >= 2048); };
        for (std::size_t i = 0; i < count; ++i) {
            world.set_enabled<Power>(entities[i], is_on(i));
            world.set_enabled<Lit>(entities[i], !is_on(i));
        }
        std::vector<bool> alive(count, true);
        const auto check = [&] {
            std::size_t wrong = 0;
            std::size_t on = 0;
            for (std::size_t i = 0; i < count; ++i) {
                on += alive[i] && is_on(i) ? 1 : 0;
                wrong += world.is_enabled<Power>(entities[i]) == (alive[i] && is_on(i)) ? 0 : 1;
                wrong += world.is_enabled<Lit>(entities[i]) == (alive[i] && !is_on(i)) ? 0 : 1;
            }
            CHECK(wrong == 0);
            CHECK(world.query<const Power>().count() == on);
        };
        world.add_all(world.query<const Body>(), Motto{"all"});  // hands the columns over
        check();
        world.run([](Query<const Body> rows, Commands commands) {
            rows.each([&](Entity entity, const Body&) { commands.remove<Motto>(entity); });
        });
        check();
        world.run([&](Query<const Body> rows, Commands commands) {
            rows.each([&](Entity entity, const Body&) {
                if (entity.index % 7 < 3) {
                    commands.add(entity, Motto{"some"});
                }
            });
        });
        check();
        for (std::size_t i = 0; i < count; ++i) {
            alive[i] = !(entities[i].index % 7 < 3 && i % 2 == 0);
        }
        world.run([&](Query<const Motto> rows, Commands commands) {
            rows.each([&](Entity entity, const Motto&) {
                const auto found = std::find(entities.begin(), entities.end(), entity);
                if (!alive[static_cast<std::size_t>(found - entities.begin())]) {
                    commands.destroy(entity);
                }
            });
        });
        check();
        world.remove_all<Motto>(world.query<With<Body>>());  // behind the rows that stayed
        check();
        const std::size_t off = world.query<Without<Power>>().count();
        world.destroy_all(world.query<const Power>());
        CHECK(world.entity_count() == off);
        CHECK(world.query<With<Lit>>().count() == off);
        world.destroy_all(world.query<const Body>());
        CHECK(world.entity_count() == 0);
        world.create_many(count, Power{}, Lit{}, Body{});
        CHECK(world.query<const Power, With<Lit>>().count() == count);
    }
}
