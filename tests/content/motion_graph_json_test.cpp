#include "content/load/level/level_schema.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_graph.h"
#include "tests/content/level_text.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::motion_graph_json_test {

using namespace limn::test;

namespace {

constexpr std::string_view kFox = R"({
"meshes": {"fox": {"make": "creature", "detail": 0.02, "triangles": 400}},
"motion_graphs": {"fox": {
  "feet": ["left foot", "right foot"],
  "states": [
    {"name": "idle", "clips": [{"clip": "fox.idle"}]},
    {"name": "move", "x": "speed", "clips": [
      {"clip": "fox.walk", "at": [0.42, 0], "travel": 0.4},
      {"clip": "fox.run", "at": [2.5, 0], "travel": 1.1}]}],
  "transitions": [
    {"from": "idle", "event": "go", "to": "move", "duration": "300ms"},
    {"from": "move", "parameter": "speed", "below": 0.1, "to": "idle", "blend": "crossfade"}],
  "layers": [{"clip": "fox.idle", "mode": "additive", "joints": ["tail"]}]}},
"entities": [{"name": "fox", "mesh_instance": {"mesh": "fox"}, "skeleton": {"skeleton": "fox"},
  "deformed": {"skin": "fox"}, "motion_graph": {"graph": "fox", "speed": 1}}]
})";

std::string with(std::string_view from, std::string_view to) {
    std::string text(kFox);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

/// The error of parsing, or of loading the assets.
std::string error_of(const std::string& text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    if (!level) {
        return level.error().message;
    }
    const Status loaded = load_level_assets(*level, "");
    return loaded ? std::string() : loaded.error().message;
}

}  // namespace

TEST_CASE(
    "motion graph file: states, transitions and clips of a made mesh"
    * technique("char.motion-select")) {
    World world;
    world.insert_resource(Assets{}).clips.resize(3);  // of something else
    spawn_into(world, kFox);
    const Assets& assets = world.resource<Assets>();
    const MotionGraph& used = named<const MotionGraph>(world, "fox");
    REQUIRE(world.resource<MotionGraphs>().graphs.size() == 1);

    CHECK(used.graph.index == 0);
    const MotionGraphData& graph = world.resource<MotionGraphs>().graphs[0];
    CHECK(graph.name == "fox");
    CHECK(graph.states[1].x == GraphParameter::Speed);
    CHECK(assets.clips[graph.states[1].clips[1].clip.index].name == "fox.run");
    CHECK(assets.clips[graph.layers[0].clip.index].name == "fox.idle");
    CHECK(graph.transitions[0].duration == 0.3f);
    CHECK(graph.transitions[1].blend == TransitionBlend::Crossfade);
}

TEST_CASE("motion graph file: an error names the line and what was expected") {
    CHECK(error_of(std::string(kFox)).empty());
    CHECK(
        error_of(with(R"("to": "move")", R"("to": "mvoe")"))
        == "t.level.json:11:43: motion_graphs.fox.transitions[0].to: found the state \"mvoe\", "
           "expected one of idle, move (did you mean move?)");
    CHECK(
        error_of(with(R"("from": "move")", R"("from": "trot")"))
        == "t.level.json:12:14: motion_graphs.fox.transitions[1].from: found the state \"trot\", "
           "expected one of idle, move");
    CHECK(
        error_of(with(R"(, "to": "move")", ""))
        == "t.level.json:11:5: motion_graphs.fox.transitions[0].to: found no next state, expected "
           "one of idle, move");
    CHECK(
        error_of(with(R"("event": "go", )", ""))
        == "t.level.json:11:5: motion_graphs.fox.transitions[0]: found a transition that nothing "
           "triggers, expected an \"event\" or a \"parameter\"");
    CHECK(
        error_of(with(R"("name": "move")", R"("name": "idle")"))
        == "t.level.json:7:14: motion_graphs.fox.states[1]: found a second state \"idle\", "
           "expected another name");
    CHECK(
        error_of(with(R"("x": "speed", )", ""))
        == "t.level.json:7:5: motion_graphs.fox.states[1]: found several clips and no parameter "
           "that blends them, expected \"x\": one of speed turn slope amount");
    CHECK(
        error_of(with("[2.5, 0]", "[0.42, 1]"))
        == "t.level.json:9:7: motion_graphs.fox.states[1].clips[1]: found the same \"at\" as an "
           "earlier clip, expected another point of the blend space");
    CHECK(
        error_of(with("fox.run", "fox.rnu"))
        == "t.level.json:9:16: motion_graphs.fox: found the clip \"fox.rnu\", expected one of "
           "fox.idle, fox.walk, fox.trot, fox.run (did you mean fox.run?)");
    CHECK(
        error_of(with(R"({"graph": "fox")", R"({"graph": "wolf")"))
            .find("found the motion_graph \"wolf\"")
        != std::string::npos);
    CHECK(
        error_of(with(R"("duration": "300ms")", R"("duration": "300m")")).find("duration")
        != std::string::npos);
    CHECK(
        error_of(R"({"motion_graphs": {"none": {}}})")
        == "t.level.json:1:28: motion_graphs.none: found no states, expected \"states\": "
           "[{\"name\": ..., \"clips\": ...}]");
}

TEST_CASE("motion graph file: a state without an exit is valid, and the schema knows graphs") {
    CHECK(error_of(with(R"("from": "move", )", R"("from": "idle", )")).empty());
    const std::string schema = write_json(level_schema());
    CHECK(schema.find("\"motion_graphs\"") != std::string::npos);
    CHECK(schema.find("\"interruptible\"") != std::string::npos);
}

}  // namespace limn::motion_graph_json_test
