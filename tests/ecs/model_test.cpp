#include "ecs/world.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <cstdio>
#include <map>
#include <optional>
#include <random>
#include <vector>

// A world beside a plain map, driven through the same random operations; after every few of them
// both must say the same.

using namespace limn;
using namespace limn::test;

namespace {

struct Record {
    std::optional<float> position;
    std::optional<std::string> label;
    std::optional<int> heat;
    std::optional<std::string> note;
    std::optional<int> counted;
    bool marked = false;
    bool selected = false;
};

class Model {
  public:
    explicit Model(unsigned seed) : random_(seed) {}

    void run(int operations) {
        for (int done = 0; done < operations; ++done) {
            const int kind = roll(100);
            if (kind < 22) {
                create();
            } else if (kind < 37) {
                destroy();
            } else if (kind < 70) {
                change(
                    world_,
                    [&](Entity entity, auto value) { world_.add(entity, std::move(value)); },
                    [&]<typename T>(Entity entity) { world_.remove<T>(entity); });
            } else if (kind < 98) {
                record();
            } else if (kind == 98) {
                bulk();
            } else {
                flush();
            }
            if (done % 997 == 0) {
                compare();
            }
        }
        flush();
        compare();
    }

    /// Grows or shrinks to `count` entities of one archetype, so that full chunks are met.
    void resize(std::uint32_t count) {
        while (plain_.size() < count) {
            plain_.push_back(world_.create(Position{1, 0, 0}, Counted(7)));
            Record record;
            record.position = 1.0f;
            record.counted = 7;
            add(plain_.back(), record);
        }
        while (plain_.size() > count) {
            const Entity entity = plain_.back();
            plain_.pop_back();
            if (records_.contains(entity)) {
                world_.destroy(entity);
                forget(entity);
            }
        }
    }

    void compare() {
        REQUIRE(world_.entity_count() == records_.size());
        std::size_t positions = 0;
        std::size_t warm = 0;
        for (const auto& [entity, record] : records_) {
            REQUIRE(world_.alive(entity));
            const Position* position = std::as_const(world_).find<Position>(entity);
            REQUIRE((position != nullptr) == record.position.has_value());
            REQUIRE((position == nullptr || position->x == *record.position));
            const Label* label = std::as_const(world_).find<Label>(entity);
            REQUIRE((label != nullptr) == record.label.has_value());
            REQUIRE((label == nullptr || label->text == *record.label));
            const Heat* heat = std::as_const(world_).find<Heat>(entity);
            REQUIRE((heat != nullptr) == record.heat.has_value());
            REQUIRE((heat == nullptr || heat->degrees == *record.heat));
            const Note* note = std::as_const(world_).find<Note>(entity);
            REQUIRE((note != nullptr) == record.note.has_value());
            REQUIRE((note == nullptr || note->text == *record.note));
            const Counted* counted = std::as_const(world_).find<Counted>(entity);
            REQUIRE((counted != nullptr) == record.counted.has_value());
            REQUIRE((counted == nullptr || counted->value == *record.counted));
            REQUIRE(world_.has<Marked>(entity) == record.marked);
            REQUIRE(world_.has<Selected>(entity) == record.selected);
            positions += record.position.has_value() && !record.marked ? 1 : 0;
            warm += record.heat.has_value() && record.position.has_value() ? 1 : 0;
        }
        for (const Entity entity : gone_) {
            REQUIRE_FALSE(world_.alive(entity));
        }
        REQUIRE(world_.query<const Position, Without<Marked>>().count() == positions);
        std::size_t visited = 0;
        world_.query<const Position, const Heat>().each(
            [&](Entity entity, const Position& position, const Heat& heat) {
                const Record& record = records_.at(entity);
                REQUIRE(position.x == *record.position);
                REQUIRE(heat.degrees == *record.heat);
                ++visited;
            });
        REQUIRE(visited == warm);
    }

  private:
    int roll(int sides) { return std::uniform_int_distribution<int>(0, sides - 1)(random_); }

    Entity any() {
        return entities_[static_cast<std::size_t>(roll(static_cast<int>(entities_.size())))];
    }

    void add(Entity entity, const Record& record) {
        REQUIRE(records_.emplace(entity, record).second);
        places_[entity] = entities_.size();
        entities_.push_back(entity);
    }
    void forget(Entity entity) {
        records_.erase(entity);
        const std::size_t place = places_[entity];
        entities_[place] = entities_.back();
        places_[entities_[place]] = place;
        entities_.pop_back();
        places_.erase(entity);
        if (gone_.size() < 1000) {
            gone_.push_back(entity);
        } else {
            gone_[static_cast<std::size_t>(roll(1000))] = entity;
        }
    }

    void create() {
        const float x = static_cast<float>(roll(1000));
        Record record;
        record.position = x;
        switch (roll(3)) {
        case 0:
            add(world_.create(Position{x, 0, 0}), record);
            break;
        case 1:
            record.label = std::to_string(x);
            record.heat = static_cast<int>(x);
            add(world_.create(
                    Label{std::to_string(x), {}}, Heat{static_cast<int>(x)}, Position{x, 0, 0}),
                record);
            break;
        default:
            record.counted = static_cast<int>(x);
            record.marked = true;
            add(world_.create(Marked{}, Position{x, 0, 0}, Counted(static_cast<int>(x))), record);
        }
    }

    void destroy() {
        if (!entities_.empty()) {
            const Entity entity = any();
            world_.destroy(entity);
            forget(entity);
        }
    }

    /// One random addition or removal, through `add_to(entity, value)` and
    /// `remove_from<T>(entity)`.
    template <typename Add, typename Remove>
    void change(World&, const Add& add_to, const Remove& remove_from) {
        if (entities_.empty()) {
            return;
        }
        const Entity entity = any();
        Record& record = records_.at(entity);
        const int value = roll(10'000);
        const std::string text =
            std::to_string(value) + " is a text too long to be kept inside of the string";
        switch (roll(14)) {
        case 0:
            add_to(entity, Position{static_cast<float>(value), 0, 0});
            record.position = static_cast<float>(value);
            break;
        case 1:
            add_to(entity, Label{text, {}});
            record.label = text;
            break;
        case 2:
            add_to(entity, Heat{value});
            record.heat = value;
            break;
        case 3:
            add_to(entity, Note{text});
            record.note = text;
            break;
        case 4:
            add_to(entity, Counted(value));
            record.counted = value;
            break;
        case 5:
            add_to(entity, Marked{});
            record.marked = true;
            break;
        case 6:
            add_to(entity, Selected{});
            record.selected = true;
            break;
        case 7:
            remove_from.template operator()<Position>(entity);
            record.position.reset();
            break;
        case 8:
            remove_from.template operator()<Label>(entity);
            record.label.reset();
            break;
        case 9:
            remove_from.template operator()<Heat>(entity);
            record.heat.reset();
            break;
        case 10:
            remove_from.template operator()<Note>(entity);
            record.note.reset();
            break;
        case 11:
            remove_from.template operator()<Counted>(entity);
            record.counted.reset();
            break;
        case 12:
            remove_from.template operator()<Marked>(entity);
            record.marked = false;
            break;
        default:
            remove_from.template operator()<Selected>(entity);
            record.selected = false;
        }
    }

    /// Some commands, applied at once: the record is ahead of the world only in between.
    void record() {
        const Commands commands(buffer_);
        const int count = 1 + roll(20);
        for (int i = 0; i < count; ++i) {
            const int kind = roll(10);
            if (kind == 0 && !entities_.empty()) {
                const Entity entity = any();
                commands.destroy(entity);
                commands.add(entity, Note{"for the dead"});
                forget(entity);
            } else if (kind == 1) {
                created_.push_back(roll(1000));
                const Entity entity =
                    commands.create(Position{static_cast<float>(created_.back()), 0, 0}, Created{});
                commands.add(entity, Heat{created_.back()});
                commands.add<Marked>(entity);
                commands.remove<Marked>(entity);
            } else {
                change(
                    world_,
                    [&](Entity entity, auto value) { commands.add(entity, std::move(value)); },
                    [&]<typename T>(Entity entity) { commands.remove<T>(entity); });
            }
        }
        flush();
    }

    void flush() {
        CommandBuffer* const all[] = {&buffer_};
        apply_commands(world_, all);
        std::vector<Entity> made;
        world_.query<With<Created>>().each([&](Entity entity) { made.push_back(entity); });
        REQUIRE(made.size() == created_.size());
        for (std::size_t i = 0; i < made.size(); ++i) {
            Record record;
            record.position = static_cast<float>(created_[i]);
            record.heat = created_[i];
            add(made[i], record);
            world_.remove<Created>(
                made[made.size() - 1 - i]);  // from the end: the others keep their order
        }
        created_.clear();
    }

    void bulk() {
        const int count = roll(40);
        Record record;
        record.note = "bulk";
        record.position = 3.0f;
        for (const Entity entity :
             world_.create_many(static_cast<std::size_t>(count), Position{3, 0, 0}, Note{"bulk"})) {
            add(entity, record);
        }
    }

    struct Created {};  ///< marks what commands made until the model knows it

    std::mt19937 random_;
    World world_;
    CommandBuffer buffer_;
    std::map<Entity, Record> records_;
    std::map<Entity, std::size_t> places_;
    std::vector<Entity> entities_;
    std::vector<Entity> gone_;
    std::vector<Entity> plain_;
    std::vector<int> created_;
};

}  // namespace

TEST_CASE("model: a world and a map agree after 100,000 random operations") {
    for (const unsigned seed : {1u, 20'261u}) {
        std::printf("model: seed %u\n", seed);
        CAPTURE(seed);
        Counted::living = 0;
        {
            Model model(seed);
            for (const std::uint32_t count : {1023u, 1024u, 1025u, 2047u, 2048u, 2049u, 0u}) {
                model.resize(count);
                model.compare();
                model.run(50'000 / 7);
            }
        }
        CHECK(Counted::living == 0);
    }
}
