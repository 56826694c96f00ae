#include "ecs/base/rng.h"
#include "ecs/world.h"
#include "tests/ecs/toggle_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace toggle_test {

// Disabled is as good as removed, but for the value.

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

using Visited = std::vector<std::pair<int, int>>;  // number of the entity, digest of the arguments

template <typename... Terms, typename Kind>
Visited visited_by_each(Side<Kind>& side) {
    Visited visited;
    side.world.template query<Terms...>().each([&](Entity entity, auto&&... arguments) {
        int total = 0;
        ((total = total * 31 + digest(arguments)), ...);
        visited.emplace_back(side.number_of[entity.index], total);
    });
    std::sort(visited.begin(), visited.end());
    return visited;
}

template <typename... Terms, typename Kind>
Visited visited_by_par_each(Side<Kind>& side) {
    std::vector<int> found(kMaxEntities, -1);
    std::vector<int> times(kMaxEntities, 0);
    side.world.template query<Terms...>().par_each([&](Entity entity, auto&&... arguments) {
        int total = 0;
        ((total = total * 31 + digest(arguments)), ...);
        const std::size_t number = static_cast<std::size_t>(side.number_of[entity.index]);
        found[number] = total;
        ++times[number];
    });
    Visited visited;
    for (std::size_t i = 0; i < kMaxEntities; ++i) {
        for (int k = 0; k < times[i]; ++k) {
            visited.emplace_back(static_cast<int>(i), found[i]);
        }
    }
    return visited;
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
std::vector<int> visited_by_chunks(Side<Kind>& side) {
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

std::vector<int> numbers_of(const Visited& visited) {
    std::vector<int> numbers;
    for (const auto& [number, value] : visited) {
        numbers.push_back(number);
    }
    return numbers;
}

/// Visits a query with all functions, which must agree; returns what each() visited. `Chunked`:
/// includes chunks().
template <bool chunked, typename... Terms, typename Kind>
Visited visited_by(Side<Kind>& side) {
    const Visited visited = visited_by_each<Terms...>(side);
    const std::vector<int> numbers = numbers_of(visited);
    CHECK(visited_by_par_each<Terms...>(side) == visited);
    CHECK(side.world.template query<Terms...>().count() == visited.size());
    CHECK(contained_in<Terms...>(side) == numbers);
    if constexpr (chunked) {
        CHECK(visited_by_chunks<Terms...>(side) == numbers);
    }
    return visited;
}

template <typename Kind>
std::vector<Visited> visited_in_all_queries(Side<Kind>& side) {
    using P = typename Kind::Power;
    using M = typename Kind::Motto;
    using L = typename Kind::Lit;
    return {
        visited_by<true, const P>(side),
        visited_by<true, const Body, With<P, L>>(side),
        visited_by<true, const P, Without<L>>(side),
        visited_by<true, const Body, Without<P, M>>(side),
        visited_by<true, const P, const M>(side),
        visited_by<true, With<L>, Without<Body>>(side),
        visited_by<false, Optional<const P>, Optional<const L>, const Body>(side),
        visited_by<false, const L, Optional<const M>>(side),
        visited_by<false, const P, const Chill>(side),
        visited_by<false, const Chill, Without<L>>(side),
        visited_by<false, const P, Without<Chill>>(side),
        visited_by<true, const P, Changed<M>>(side),
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
            const std::size_t index = random_.below(static_cast<std::uint32_t>(alive_.size()));
            both([&](auto& side) { side.destroy(alive_[index]); });
            free_.push_back(alive_[index]);
            alive_[index] = alive_.back();
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
        const std::vector<Visited> toggled = visited_in_all_queries(toggled_);
        const std::vector<Visited> plain = visited_in_all_queries(plain_);
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
