#include "ecs/world.h"
#include "tests/ecs/stop_message.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

using Log = std::vector<std::string>;

/// Writes "name count" into the log.
auto note(Log& log, const std::string& name) {
    return [&log, name](World&, std::span<const Entity> entities) {
        log.push_back(name + " " + std::to_string(entities.size()));
    };
}

}  // namespace

TEST_CASE("observer: every operation that adds or removes calls once, with all its entities") {
    Log log;
    World world;
    world.on_add<Label>(note(log, "+label"));
    world.on_remove<Label>(note(log, "-label"));
    world.on_add<Heat>(note(log, "+heat"));
    world.on_remove<Heat>(note(log, "-heat"));
    world.on_add<Marked>(note(log, "+marked"));
    const Entity entity = world.create(Label{}, Heat{}, Position{});
    CHECK(log == Log{"+label 1", "+heat 1"});
    log.clear();
    const std::vector<Entity> many = world.create_many(50, Label{});
    world.add<Marked>(entity);
    world.add(entity, Label{"replaced", {}});  // no event: it stays
    world.add(entity, Heat{4});
    world.get<Label>(entity).text = "written";
    CHECK(log == Log{"+label 50", "+marked 1"});
    log.clear();
    world.remove<Label>(entity);
    world.remove<Label>(entity);
    world.add(entity, Label{});
    world.destroy(entity);
    world.add(many[0], component_id<Heat>);
    world.remove(many[0], component_id<Heat>);
    CHECK(log == Log{"-label 1", "+label 1", "-label 1", "-heat 1", "+heat 1", "-heat 1"});
    log.clear();
    world.clear();
    CHECK(log == Log{"-label 50"});
}

TEST_CASE("observer: when the world is destroyed, remaining components count as removed, before "
          "resources") {
    Log log;
    {
        World world;
        world.insert_resource(Mass{7});
        world.on_remove<Label>([&](World& w, std::span<const Entity> entities) {
            for (const Entity entity : entities) {
                log.push_back(
                    w.get<Label>(entity).text
                    + std::to_string(static_cast<int>(w.resource<Mass>().value)));
            }
        });
        world.on_remove<Heat>(note(log, "-heat"));
        world.create(Label{"a", {}});
        world.create(Label{"b", {}}, Heat{});
        world.create(Label{"c", {}}, Position{});
    }
    CHECK(log == Log{"a7", "b7", "c7", "-heat 1"});
}

TEST_CASE("observer: the order is that of registration") {
    Log log;
    World world;
    world.on_add<Position>(note(log, "first"));
    world.on_add<Velocity>(note(log, "second"));
    world.on_add<Position>(note(log, "third"));
    world.create(Velocity{}, Position{});
    CHECK(log == Log{"first 1", "second 1", "third 1"});
}

TEST_CASE("observer: a removed component can still be read, an added one is in place") {
    World world;
    std::string seen;
    world.on_remove<Label>([&](World& w, std::span<const Entity> entities) {
        seen += "-" + w.get<Label>(entities[0]).text;
    });
    world.on_add<Label>([&](World& w, std::span<const Entity> entities) {
        seen += "+" + w.get<Label>(entities[0]).text;
    });
    const Entity entity = world.create(Label{"a", {}});
    world.remove<Label>(entity);
    world.add(entity, Label{"b", {}});
    world.destroy(entity);
    CHECK(seen == "+a-a+b-b");
}

TEST_CASE("observer: on_add may change the structure; later observers see the result") {
    Log log;
    World world;
    world.on_add<Label>([](World& w, std::span<const Entity> entities) {
        for (const Entity entity : std::vector<Entity>(entities.begin(), entities.end())) {
            if (w.get<Label>(entity).text == "unwanted") {
                w.destroy(entity);
            } else {
                w.add(entity, Mass{5});
            }
        }
    });
    world.on_add<Label>(note(log, "label"));
    world.on_add<Mass>(note(log, "mass"));
    const Entity good = world.create(Label{"good", {}});
    CHECK(world.get<Mass>(good).value == 5);
    CHECK(log == Log{"mass 1", "label 1"});
    log.clear();
    const Entity bad = world.create(Label{"unwanted", {}});
    CHECK_FALSE(world.alive(bad));
    CHECK(log.empty());
}

TEST_CASE("observer: on_remove must not change the structure") {
    bool strict = false;
    World world;
    world.on_remove<Label>([&](World& w, std::span<const Entity> entities) {
        if (strict) {
            w.add(entities[0], Mass{});
        }
    });
    const Entity entity = world.create(Label{});
    strict = true;
    CHECK(
        stop_message([&] { world.remove<Label>(entity); }).find("structural change")
        != std::string::npos);
    CHECK_FALSE(stop_message([&] { world.destroy(entity); }).empty());
    CHECK_FALSE(stop_message([&] { world.clear(); }).empty());
    strict = false;
}

TEST_CASE(
    "observer: a sync point calls each observer once, with entities in the order of the commands") {
    Log log;
    std::vector<Entity> removed;  // outlives the world, whose end calls observers
    World world;
    const std::vector<Entity> entities = world.create_many(10, Label{}, Heat{});
    world.on_remove<Label>([&](World& w, std::span<const Entity> span) {
        CHECK(w.has<Label>(span[0]));
        removed.assign(span.begin(), span.end());
        log.push_back("-label");
    });
    world.on_remove<Heat>(note(log, "-heat"));
    world.on_add<Mass>(note(log, "+mass"));
    world.on_add<Label>(note(log, "+label"));
    CommandBuffer buffer;
    const Commands commands(buffer);
    commands.remove<Label>(entities[7]);
    commands.destroy(entities[2]);
    commands.add(entities[3], Mass{});
    commands.add(entities[4], Mass{});
    commands.remove<Mass>(entities[4]);  // never there: nobody is told
    commands.remove<Label>(entities[5]);
    commands.add(entities[5], Label{"other", {}});  // another label: both are told
    commands.add(entities[6], Label{"replaced", {}});
    commands.destroy(commands.create(Label{}, Mass{}));
    commands.create(Mass{}, Label{});
    CommandBuffer* const all[] = {&buffer};
    apply_commands(world, all);
    CHECK(log == Log{"-label", "-heat 1", "+mass 2", "+label 2"});
    CHECK(removed == std::vector<Entity>{entities[7], entities[2], entities[5]});
    CHECK(world.get<Label>(entities[5]).text == "other");
}

TEST_CASE("observer: restoring a snapshot removes the old components and adds the new ones") {
    Log log;
    World world;
    world.on_add<Label>(note(log, "+label"));
    world.on_remove<Label>(note(log, "-label"));
    world.create(Label{});
    log.clear();
    const EntityTableImage image = world.entity_image();
    const Entity entity{0, 1};
    world.begin_restore(image);
    const ComponentId id = component_id<Label>;
    world.restore_rows({&id, 1}, {&entity, 1});
    world.end_restore();
    CHECK(log == Log{"-label 1", "+label 1"});
}
