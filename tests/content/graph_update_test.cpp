#include "content/load/level/level_load.h"
#include "content/load/level/level_update.h"
#include "ecs/components/all.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/update_world.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::graph_update_test {
namespace {

constexpr std::string_view kFox = R"({
"meshes": {"fox": {"make": "creature", "detail": 0.02, "triangles": 400}},
"motion_graphs": {"fox": {
  "states": [
    {"name": "idle", "clips": [{"clip": "fox.idle"}]},
    {"name": "walk", "clips": [{"clip": "fox.walk"}]}],
  "transitions": [
    {"from": "idle", "event": "go", "to": "walk"}]}},
"entities": [{"name": "fox", "mesh_instance": {"mesh": "fox"}, "skeleton": {"skeleton": "fox"},
  "deformed": {"skin": "fox"}, "motion_graph": {"graph": "fox"}}]
})";

std::string with(std::string_view from, std::string_view to) {
    std::string text(kFox);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// A fox that plays while its level's file is edited.
struct PlayingFox {
    PlayingFox() {
        register_all_components();
        write(std::string(kFox));
        Result<Level> level = load_level(path());
        REQUIRE_MESSAGE(level.ok(), (level ? "" : level.error().message));
        fields = remember_fields(*level, path());
        fields.entities = spawn_level(world, *std::move(level));
        world.insert_resource(FrameTime{.step = 1.0f / 64});
        start_world(world);
    }
    void write(const std::string& text) const { std::ofstream(path()) << text; }
    [[nodiscard]] std::string path() const { return folder.path() + "/t.level.json"; }
    /// The number of changes, or the error.
    [[nodiscard]] std::string update() {
        const Result<std::vector<LevelChange>> updated = update_level(world, fields);
        return updated ? std::to_string(updated->size())
                       : updated.error().message.substr(folder.path().size() + 1);
    }
    /// The state after an event and a step.
    [[nodiscard]] std::string after(const char* event) {
        world.get<MotionGraph>(fields.entities[0]).events = {event};
        step_world(world, schedule);
        const auto& state = world.get<const MotionGraphState>(fields.entities[0]);
        const MotionGraphData& graph = world.resource<MotionGraphs>().graphs.at(state.graph.index);
        return graph.states.at(state.current.state).name;
    }

    test::TemporaryFolder folder;
    World world;
    Schedule schedule = make_world_schedule();
    LevelFields fields;
};

}  // namespace

TEST_CASE(
    "graph update: a saved transition is taken without a restart"
    * technique("char.motion-select")) {
    PlayingFox fox;
    CHECK(fox.after("go") == "walk");
    CHECK(fox.after("halt") == "walk");
    CHECK(fox.update() == "0");
    fox.write(with(R"("transitions": [)", R"("transitions": [
        {"from": "walk", "event": "halt", "to": "idle"},)"));
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "walk");
    CHECK(fox.after("halt") == "idle");
    CHECK(fox.after("go") == "walk");
    CHECK(fox.update() == "0");
    // Back to the old one.
    fox.write(std::string(kFox));
    CHECK(fox.update() == "1");
    CHECK(fox.after("halt") == "walk");
}

TEST_CASE("graph update: who is in a state that was taken out of the file goes to the first one") {
    PlayingFox fox;
    CHECK(fox.after("go") == "walk");
    fox.write(with(R"("name": "walk")", R"("name": "trot")"));
    CHECK(fox.update().starts_with("t.level.json:8:"));  // a transition still leads to it
    CHECK(fox.after("none") == "walk");
    std::string text = with(R"("name": "walk")", R"("name": "trot")");
    text.replace(text.find(R"("to": "walk")"), 12, R"("to": "trot")");
    fox.write(text);
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "idle");
    const auto& state = fox.world.get<const MotionGraphState>(fox.fields.entities[0]);
    CHECK(state.transition == 1);
    CHECK(state.turns.size() > 1);
    CHECK(fox.after("go") == "trot");
}

TEST_CASE("graph update: a bad edit is one line, and the old graph stays") {
    PlayingFox fox;
    fox.write(with(R"("to": "walk")", R"("to": "wlak")"));
    CHECK(
        fox.update()
        == "t.level.json:8:43: motion_graphs.fox.transitions[0].to: found the state \"wlak\", "
           "expected one of idle, walk (did you mean walk?)");
    fox.write(with("fox.walk", "fox.wlak"));
    const std::string error = fox.update();
    CHECK(error.starts_with("t.level.json:6:"));
    CHECK(error.find("found the clip \"fox.wlak\"") != std::string::npos);
    CHECK(error.find('\n') == std::string::npos);
    CHECK(fox.world.resource<MotionGraphs>().edits.empty());
    CHECK(fox.after("go") == "walk");
}

TEST_CASE("graph update: graphs are added, given to characters by a blend, and removed") {
    const std::size_t begin = kFox.find(R"("fox": {
  "states")");
    const std::size_t end = kFox.find(R"(},
"entities")");
    const std::string fox_graph(kFox.substr(begin, end - begin));
    const auto level = [&](const std::string& graphs, const std::string& plays) {
        std::string text(kFox);
        text.replace(begin, end - begin, graphs);
        const std::size_t at = text.find(R"({"graph": "fox"})");
        return text.replace(at, 16, "{\"graph\": \"" + plays + "\"}");
    };
    const std::string runner = R"("runner": {
        "states": [
            {"name": "trot", "clips": [{"clip": "fox.trot"}]},
            {"name": "rest", "clips": [{"clip": "fox.idle"}]}],
        "transitions": [{"from": "trot", "event": "halt", "to": "rest"}]})";
    PlayingFox fox;
    CHECK(fox.after("go") == "walk");
    const auto state = [&]() -> const MotionGraphState& {
        return fox.world.get<const MotionGraphState>(fox.fields.entities[0]);
    };
    // Before the old one, so that places in the file and in the world differ.
    fox.write(level(runner + ", " + fox_graph, "fox"));
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "walk");
    CHECK(fox.world.resource<MotionGraphs>().graphs.size() == 2);
    // Nothing jumps: what was shown is the offset with which the new graph begins.
    fox.write(level(runner + ", " + fox_graph, "runner"));
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "trot");
    CHECK(state().graph.index == 1);
    CHECK(state().turns.size() > 1);
    CHECK(state().cut == 0);
    CHECK(fox.after("halt") == "rest");
    // The old one is removed: nobody plays it.
    fox.write(level(runner, "runner"));
    CHECK(fox.update() == "0");
    CHECK(fox.after("none") == "rest");
    // Edits of the new one arrive, whatever its place.
    std::string edited = level(runner, "runner");
    edited.replace(edited.find(R"("name": "rest")"), 14, R"("name": "wait")");
    edited.replace(edited.find(R"("to": "rest")"), 12, R"("to": "wait")");
    fox.write(edited);
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "trot");
    // And the old one comes back, in its old place.
    fox.write(std::string(kFox));
    CHECK(fox.update() == "1");
    CHECK(fox.after("none") == "idle");
    CHECK(state().graph.index == 0);
    CHECK(fox.world.resource<MotionGraphs>().graphs.size() == 2);
    CHECK(fox.after("go") == "walk");
}

TEST_CASE("graph update: graphs that are switched often do not grow") {
    PlayingFox fox;
    fox.write(with(R"("motion_graphs": {)", R"("motion_graphs": {"still": {
        "states": [{"name": "rest", "clips": [{"clip": "fox.idle"}]}]},)"));
    CHECK(fox.update() == "1");
    for (std::uint32_t i = 0; i < 12; ++i) {
        fox.world.get<MotionGraph>(fox.fields.entities[0]).graph = {(i + 1) % 2};
        step_world(fox.world, fox.schedule);
    }
    const auto& graphs = fox.world.resource<MotionGraphs>().graphs;
    CHECK(graphs[0].transitions.size() == 2);
    CHECK(graphs[1].transitions.size() == 1);
}

TEST_CASE("graph update: of two saves before the next step, the second one counts") {
    PlayingFox fox;
    fox.write(with(R"("event": "go")", R"("event": "leap")"));
    CHECK(fox.update() == "1");
    fox.write(with(R"("event": "go")", R"("event": "run")"));
    CHECK(fox.update() == "1");
    CHECK(fox.after("leap") == "idle");
    CHECK(fox.after("go") == "idle");
    CHECK(fox.after("run") == "walk");
}

}  // namespace limn::graph_update_test
