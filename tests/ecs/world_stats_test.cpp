#include "ecs/commands.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "ecs/world_stats.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace world_stats_test {

using namespace limn;
using namespace limn::test;

/// Whether the text is one JSON value (RFC 8259), as far as statistics use it.
class JsonCheck {
  public:
    static bool is_json(std::string_view text) {
        JsonCheck check(text);
        return check.value() && check.text_.empty();
    }

  private:
    explicit JsonCheck(std::string_view text) : text_(text) {}

    bool take(std::string_view word) {
        if (!text_.starts_with(word)) {
            return false;
        }
        text_.remove_prefix(word.size());
        return true;
    }
    bool value() {
        if (text_.starts_with('{')) {
            return list('{', '}', [this] { return string() && take(": ") && value(); });
        }
        if (text_.starts_with('[')) {
            return list('[', ']', [this] { return value(); });
        }
        return text_.starts_with('"') ? string() : take("true") || take("false") || number();
    }
    template <typename Element>
    bool list(char open, char close, const Element& element) {
        take({&open, 1});
        if (take({&close, 1})) {
            return true;
        }
        while (element()) {
            if (take({&close, 1})) {
                return true;
            }
            if (!take(", ")) {
                return false;
            }
        }
        return false;
    }
    bool string() {
        if (!take("\"")) {
            return false;
        }
        while (!text_.empty() && text_[0] != '"') {
            if (static_cast<unsigned char>(text_[0]) < 0x20) {
                return false;
            }
            text_.remove_prefix(text_[0] == '\\' ? 2 : 1);
        }
        return take("\"");
    }
    bool number() {
        const std::size_t size = std::min(text_.find_first_not_of("0123456789+-.e"), text_.size());
        text_.remove_prefix(size);
        return size > 0;
    }

    std::string_view text_;
};

void move_all(Query<const Velocity, Position> rows) {
    rows.each([](const Velocity& v, Position& p) { p.x += v.x; });
}

void mark_some(Query<const Position, Without<Marked>> rows, Commands commands) {
    int left = 10;
    rows.each([&](Entity entity, const Position&) {
        if (left-- > 0) {
            commands.add(entity, Marked{});
        }
    });
}

}  // namespace world_stats_test

using namespace limn;
using namespace limn::test;
using namespace world_stats_test;

TEST_CASE("statistics: a query lists its terms, what it visits and how often") {
    World world;
    world.create_many(1500, Position{}, Velocity{});
    world.create_many(10, Position{}, Velocity{}, Frozen{});
    world.create_many(7, Position{});
    auto query =
        world.query<const Position, Velocity, With<Heat>, Without<Frozen>, Optional<const Mass>>();
    auto changed = world.query<Changed<Position, Velocity>>();
    query.each([](const Position&, Velocity&, const Mass*) {});
    query.each([](const Position&, Velocity&, const Mass*) {});
    static_cast<void>(
        query.gather({}, [](std::size_t, const Position&, Velocity&, const Mass*) {}));
    CHECK(query.count() == 0);  // looks, but does not iterate
    const WorldStats stats = world_stats(world);
    REQUIRE(stats.queries.size() == 2);
    const QueryStats& one = stats.queries[stats.queries[0].calls > 0 ? 0 : 1];
    const std::string names[] = {
        component_info<Position>().name, component_info<Velocity>().name,
        component_info<Heat>().name, component_info<Frozen>().name, component_info<Mass>().name};
    CHECK(
        one.terms
        == "const " + names[0] + ", " + names[1] + ", With<" + names[2] + ">, Without<" + names[3]
               + ">, Optional<const " + names[4] + ">");
    CHECK(one.calls == 3);
    CHECK(one.archetypes == 1);
    CHECK(one.chunks == 2);
    CHECK(one.rows == 1500);
    const QueryStats& other = stats.queries[stats.queries[0].calls > 0 ? 1 : 0];
    CHECK(other.terms == "Changed<" + names[0] + ", " + names[1] + ">");
    CHECK(other.calls == 0);
    static_cast<void>(changed);
}

TEST_CASE("statistics: systems list the commands they recorded, sync points those they applied") {
    World world;
    world.create_many(25, Position{}, Velocity{});
    Schedule schedule;
    schedule.add<move_all>();
    schedule.add<mark_some>();
    for (int i = 0; i < 4; ++i) {
        schedule.run(world);
    }
    const ScheduleStats stats = schedule_stats(schedule);
    REQUIRE(stats.systems.size() == 2);
    CHECK(stats.systems[0].name == "move_all");
    CHECK(stats.systems[0].runs == 4);
    CHECK(stats.systems[0].commands == 0);
    REQUIRE(stats.systems[0].queries.size() == 1);
    CHECK(stats.systems[0].queries[0].calls == 4);
    CHECK(stats.systems[0].queries[0].rows == 25);
    CHECK(stats.systems[1].commands == 25);  // 10, 10, 5, and none
    CHECK(stats.systems[1].last_commands == 5);
    REQUIRE(stats.syncs.size() == 1);
    CHECK(stats.syncs[0].after == "mark_some");
    CHECK(stats.syncs[0].runs == 3);
    CHECK(stats.syncs[0].commands == 25);
    CHECK(stats.syncs[0].mean > 0);
    CHECK(world_stats(world).flush.commands == 25);
    CHECK(world_stats(world).flush.flushes == 3);
    schedule.reset_timings();
    CHECK(schedule_stats(schedule).syncs[0].runs == 0);
    CHECK(schedule_stats(schedule).systems[1].commands == 0);
}

TEST_CASE("statistics: rows that move leave one archetype and come to another") {
    World world;
    const std::vector<Entity> all = world.create_many(3000, Position{});
    world.add(all[0], Velocity{});                                                // one by one
    world.add_all(world.query<const Position, Without<Velocity>>(), Velocity{});  // handed over
    world.run([](Query<const Position> rows, Commands commands) {                 // in ranges
        rows.each([&](Entity entity, const Position&) {
            if (entity.index % 3 != 0) {
                commands.remove<Velocity>(entity);
            }
        });
    });
    std::uint64_t came = 0;
    std::uint64_t went = 0;
    for (const ArchetypeStats& archetype : world_stats(world).archetypes) {
        came += archetype.rows_moved_in;
        went += archetype.rows_moved_out;
        CHECK(archetype.rows_moved_in <= archetype.rows + archetype.rows_moved_out);
    }
    CHECK(came == went);
    CHECK(came == 1 + 2999 + 2000);
}

TEST_CASE("statistics: the memory of all archetypes adds up to the memory report") {
    World world;
    world.create_many(100'000, Position{}, Velocity{});  // in ranges of its own
    world.create_many(5, Position{}, Mass{});            // in pooled blocks
    std::size_t own = 0;
    std::size_t pooled = 0;
    for (const ArchetypeStats& archetype : world_stats(world).archetypes) {
        (archetype.promoted ? own : pooled) += archetype.committed;
        CHECK(archetype.fill() >= 0);
        CHECK(archetype.fill() <= 1);
        CHECK(archetype.committed >= std::size_t{archetype.rows} * archetype.row_bytes);
    }
    CHECK(own == world.memory().archetypes);
    CHECK(own >= 100'000 * (sizeof(Position) + sizeof(Velocity) + sizeof(Entity)));
    CHECK(pooled > 0);
    CHECK(pooled <= world.memory().blocks);
}

TEST_CASE("statistics: the JSON is valid, whatever a system is called") {
    World world;
    world.create_many(2000, Position{}, Marked{});
    world.create(Label{}, Heat{}, Selected{});
    world.query<Position>().each([](Position&) {});
    Schedule schedule;
    schedule.add("a \"name\"\\ of\n\ttwo lines", [](Query<Position>, Commands) {});
    schedule.run(world);
    const std::string json = to_json(world_stats(world));
    CHECK(JsonCheck::is_json(json));
    CHECK(json.find("\"entities\": 2001, ") != std::string::npos);
    const std::string scheduled = to_json(schedule_stats(schedule));
    CHECK(JsonCheck::is_json(scheduled));
    CHECK(scheduled.find(R"("a \"name\"\\ of\u000a\u0009two lines")") != std::string::npos);
    CHECK(JsonCheck::is_json(to_json(world_stats(World()))));
    CHECK(JsonCheck::is_json(to_json(ScheduleStats())));
}

TEST_CASE("statistics: the text has a line for everything") {
    World world;
    world.create_many(2000, Position{}, Marked{});
    world.create(Label{}, Heat{});
    Schedule schedule;
    schedule.add<mark_some>();
    world.create_many(3, Position{});
    schedule.run(world);
    const std::string text = to_text(world_stats(world));
    CHECK(text.find("2004 entities\n") != std::string::npos);
    CHECK(text.find("1 flushes of 3 commands: 0 entities created") != std::string::npos);
    const std::string systems = to_text(schedule_stats(schedule));
    CHECK(systems.find("mark_some") != std::string::npos);
    CHECK(systems.find("Without<") != std::string::npos);
    CHECK(systems.find("sync") != std::string::npos);
}
