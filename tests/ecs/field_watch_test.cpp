#include "ecs/any_component.h"
#include "ecs/field_watch.h"
#include "ecs/reflect.h"
#include "ecs/world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn::field_watch_test {

struct Dial {
    float angle = 1;
    int notch = 2;
    std::vector<float> marks = {};
};
LIMN_FIELDS(Dial) {
    LIMN_FIELD(angle, "where it points");
    LIMN_FIELD(notch, "the last one passed");
    LIMN_FIELD(marks, "where the lines are");
}

namespace {

struct Watched {
    World world;
    Entity entity = world.create(Dial{});
    std::vector<std::string> calls;

    void watch(const char* field) {
        watch_field<Dial>(world, field, [this](World& there, const FieldNote& note) {
            const Dial& dial = std::as_const(there).get<Dial>(note.entity);
            calls.push_back(
                std::string(note.field->name)
                + (note.phase == FieldPhase::Before ? " before " : " after ")
                + std::to_string(static_cast<int>(dial.angle)));
        });
    }
    void set(Dial dial) { write_fields(world, entity, AnyComponent::of(dial)); }
};

}  // namespace

TEST_CASE(
    "field watch: before sees the previous value, after the new one, each once"
    * technique("engine.param-notify")) {
    Watched dial;
    dial.watch("angle");
    dial.set({.angle = 5});
    CHECK(dial.calls == std::vector<std::string>{"angle before 1", "angle after 5"});
    CHECK(dial.world.value<Dial>(dial.entity).angle == 5);
    dial.calls.clear();
    dial.set({.angle = 5, .notch = 9});  // that field has no handler
    CHECK(dial.calls.empty());
    CHECK(dial.world.value<Dial>(dial.entity).notch == 9);
}

TEST_CASE("field watch: with several fields, all before come before all after") {
    Watched dial;
    dial.watch("marks");
    dial.watch("angle");
    dial.set({.angle = 3, .marks = {1, 2}});
    CHECK(
        dial.calls
        == std::vector<std::string>{
            "angle before 1", "marks before 1", "angle after 3", "marks after 3"});
    dial.calls.clear();
    dial.set({.angle = 3, .marks = {1, 3}});  // an element of a list
    CHECK(dial.calls == std::vector<std::string>{"marks before 3", "marks after 3"});
}

TEST_CASE("field watch: what a handler sets calls no handlers") {
    Watched dial;
    dial.watch("angle");
    int calls = 0;
    watch_field<Dial>(dial.world, "angle", [&](World& world, const FieldNote& note) {
        ++calls;
        Dial limited = std::as_const(world).get<Dial>(note.entity);
        limited.angle = std::min(limited.angle, 10.0f);
        write_fields(world, note.entity, AnyComponent::of(limited));
    });
    dial.set({.angle = 50});
    CHECK(calls == 2);
    CHECK(dial.calls == std::vector<std::string>{"angle before 1", "angle after 50"});
    CHECK(dial.world.value<Dial>(dial.entity).angle == 10);
    dial.calls.clear();
    dial.set({.angle = 4});  // they are called again afterwards
    CHECK(dial.calls.size() == 2);
}

TEST_CASE("field watch: only the entity's own component, and versions, change") {
    Watched dial;
    const Entity other = dial.world.create(Dial{});
    dial.watch("angle");
    const std::uint32_t before = dial.world.version();
    dial.set({.angle = 7});
    CHECK(dial.world.value<Dial>(other).angle == 1);
    int changed = 0;
    dial.world.query<const Dial, Changed<Dial>>().since(before).each(
        [&](const Dial&) { ++changed; });
    CHECK(changed > 0);
}

}  // namespace limn::field_watch_test
