#pragma once

#include "ecs/base/rng.h"
#include "ecs/commands.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"

#include <cstdint>
#include <string>
#include <vector>

// A world to which anything may happen that a snapshot must keep, with components of every kind of
// storage and of bytes.

namespace snapshot_story {

using namespace limn;

struct StoryPlace {
    float x = 0, y = 0, z = 0;
};
struct StorySpeed {
    float x = 0, y = 0;
};
/// Padded: saved field by field.
struct StoryLife {
    bool is_old = false;
    std::uint32_t days = 0;
};
template <typename Visitor>
void visit_fields(StoryLife& life, Visitor&& visit) {
    visit("is_old", life.is_old);
    visit("days", life.days);
}
struct StoryText {
    std::string text;
};
template <typename Visitor>
void visit_fields(StoryText& text, Visitor&& visit) {
    visit("text", text.text);
}
struct StoryTurn {
    Entity towards;
    std::uint32_t angle = 0;
    bool is_left = false;
};
template <typename Visitor>
void visit_fields(StoryTurn& turn, Visitor&& visit) {
    visit("towards", turn.towards);
    visit("angle", turn.angle);
    visit("is_left", turn.is_left);
}
/// Lists of plain elements and of structs.
struct StoryRoute {
    std::vector<std::uint16_t> stops;
    std::vector<StoryTurn> turns;
};
template <typename Visitor>
void visit_fields(StoryRoute& route, Visitor&& visit) {
    visit("stops", route.stops);
    visit("turns", route.turns);
}
struct StoryFlag {};
/// Split.
struct StorySpin {
    float x = 0, y = 0;
    std::uint32_t turns = 1;
};
/// Toggled, with a value and without.
struct StoryLamp {
    std::uint16_t watts = 40;
};
struct StoryAwake {};
/// Shared.
struct StoryShade {
    std::uint32_t color = 0;
    Entity source;
};
template <typename Visitor>
void visit_fields(StoryShade& shade, Visitor&& visit) {
    visit("color", shade.color);
    visit("source", shade.source);
}
/// Shared, not saved.
struct StoryBatch {
    std::uint32_t number = 0;
};
struct StoryHeat {
    int degrees = 0;
};
struct StoryNote {
    std::string text;
};
template <typename Visitor>
void visit_fields(StoryNote& note, Visitor&& visit) {
    visit("text", note.text);
}
struct StoryPicked {};
struct StoryCache {
    std::vector<int> values;
};
struct StoryScore {
    std::uint64_t points = 0;
};
struct StoryTitle {
    std::string text;
};
template <typename Visitor>
void visit_fields(StoryTitle& title, Visitor&& visit) {
    visit("text", title.text);
}

}  // namespace snapshot_story

template <>
struct limn::ComponentTraits<snapshot_story::StorySpin> : DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryLamp> : DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryAwake> : DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryShade> : DefaultTraits {
    static constexpr Storage storage = Storage::Shared;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryBatch> : DefaultTraits {
    static constexpr Storage storage = Storage::Shared;
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryHeat> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryNote> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryPicked> : DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<snapshot_story::StoryCache> : DefaultTraits {
    static constexpr bool saved = false;
    static constexpr bool hashed = false;
};

namespace snapshot_story {

inline void register_types() {
    register_component<StoryPlace>();
    register_component<StorySpeed>();
    register_component<StoryLife>();
    register_component<StoryText>();
    register_component<StoryFlag>();
    register_component<StoryShade>();
    register_component<StoryRoute>();
    register_component<StorySpin>();
    register_component<StoryLamp>();
    register_component<StoryAwake>();
    register_component<StoryHeat>();
    register_component<StoryNote>();
    register_component<StoryPicked>();
    register_resource<StoryScore>();
    register_resource<StoryTitle>();
}

inline std::vector<std::byte> save(const World& world, SnapshotMark* mark = nullptr) {
    return save_snapshot(world, mark).value();
}

/// A world to which anything may happen.
struct Story {
    static constexpr std::uint32_t kComponents = 14;

    World world;
    Random rng;
    std::vector<Entity> living;

    explicit Story(std::uint64_t seed) : rng(seed, 0, name_hash("snapshot_story"), 0) {
        register_types();
    }

    Entity any() { return living[rng.below(static_cast<std::uint32_t>(living.size()))]; }

    void create(std::uint32_t count) {
        const auto f = static_cast<float>(rng.below(100));
        switch (rng.below(9)) {
        case 0:
            keep(world.create_many(count, StoryPlace{f, 0, 0}));
            break;
        case 1:
            keep(world.create_many(count, StoryPlace{0, f, 0}, StorySpeed{f, f}));
            break;
        case 2:
            keep(world.create_many(count, StoryPlace{}, StoryCache{{1, 2}}));
            break;
        case 3:
            keep(world.create_many(count, StoryText{std::string(rng.below(40), 'x')}));
            break;
        case 4:
            keep(world.create_many(count, StoryLife{true, rng.below(9)}, StoryFlag{}));
            break;
        case 5:
            keep(world.create_many(count, StoryPlace{}, StorySpin{f, 0, 1}, StoryAwake{}));
            break;
        case 6:
            keep(world.create_many(count, StoryLamp{}, StoryAwake{}));
            break;
        case 7:
            keep(world.create_many(count, StoryPlace{}, StoryShade{rng.below(3), {}}));
            break;
        default:
            keep(world.create_many(count, StoryHeat{3}));
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

    /// Adds or removes one of kComponents.
    void toggle_component(Entity entity, std::uint32_t which) {
        const auto flip = [&](auto value) {
            using T = decltype(value);
            if (!world.remove<T>(entity)) {
                world.add(entity, value);
            }
        };
        switch (which) {
        case 0:
            flip(StorySpeed{1, 2});
            break;
        case 1:
            flip(StoryText{"later"});
            break;
        case 2:
            flip(StoryFlag{});
            break;
        case 3:
            flip(StoryHeat{7});
            break;
        case 4:
            flip(StoryNote{std::string(30, 'n')});
            break;
        case 5:
            flip(StoryPicked{});
            break;
        case 6:
            flip(StoryCache{{3}});
            break;
        case 7:
            flip(StorySpin{3, 4, 5});
            break;
        case 8:
            flip(StoryLamp{60});
            break;
        case 9:
            flip(StoryAwake{});
            break;
        case 10:
            flip(StoryRoute{{1, 2, 3}, {{entity, 45, true}}});
            break;
        case 11:
            flip(StoryShade{rng.below(4), {}});
            break;
        case 12:
            flip(StoryBatch{rng.below(3)});
            break;
        default:
            flip(StoryLife{false, 4});
            break;
        }
    }

    void write(Entity entity) {
        if (auto* place = world.find<StoryPlace>(entity); place != nullptr) {
            place->z += static_cast<float>(rng.below(3));
        }
        if (auto* text = world.find<StoryText>(entity); text != nullptr) {
            text->text += 'y';
        }
        if (auto* route = world.find<StoryRoute>(entity); route != nullptr) {
            route->stops.resize(rng.below(5), 7);
            route->turns.push_back({any(), 90, false});
        }
        if (auto* heat = world.find<StoryHeat>(entity); heat != nullptr) {
            ++heat->degrees;
        }
        if (auto* life = world.find<StoryLife>(entity); life != nullptr) {
            ++life->days;
        }
        if (world.has<StorySpin>(entity)) {
            world.set(entity, StorySpin{1, 2, rng.below(5)});
        }
        if (world.has<StoryShade>(entity)) {
            world.set(entity, StoryShade{rng.below(4), rng.below(2) == 0 ? any() : Entity{}});
        }
        if (world.has<StoryLamp>(entity)) {
            world.set_enabled<StoryLamp>(entity, rng.below(2) == 0);
        }
        if (world.has<StoryAwake>(entity)) {
            world.set_enabled<StoryAwake>(entity, rng.below(2) == 0);
        }
    }

    void use_resources() {
        switch (rng.below(4)) {
        case 0:
            world.insert_resource(StoryScore{rng.below(5)});
            break;
        case 1:
            world.insert_resource(StoryTitle{std::string(rng.below(20), 't')});
            break;
        case 2:
            world.remove_resource<StoryScore>();
            break;
        default:
            if (auto* title = world.find_resource<StoryTitle>(); title != nullptr) {
                title->text += '!';
            }
            break;
        }
    }

    void run_commands() {
        world.run([this](Query<const StoryPlace> places, Commands commands) {
            const std::uint32_t step = 2 + rng.below(400);
            std::uint32_t i = 0;
            places.each([&](Entity entity, const StoryPlace&) {
                if (++i % step == 0) {
                    commands.add(entity, StorySpeed{static_cast<float>(i), 0});
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
                world.query<StoryPlace>().each([](StoryPlace& place) { place.x += 1; });
            }
            break;
        case 8:
        case 9:
            toggle_component(any(), rng.below(kComponents));
            break;
        default:
            write(any());
            break;
        }
    }
};

}  // namespace snapshot_story
