// How a show changes a level: patches that merge, name entities, add and remove them.

#include "content/load/level/level_show.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::level_show_test {
namespace {

JsonValue parse(std::string_view text) {
    Result<JsonValue> json = parse_json(text, "a.level.json");
    REQUIRE_MESSAGE(json.ok(), (json ? std::string() : json.error().message));
    return *std::move(json);
}

/// The level with the show on or off; both without white space.
std::string patched(std::string_view level, std::string_view show, bool off = false) {
    JsonValue json = parse(level);
    JsonValue shows = json_object({{"shows", {}, json_array({parse(show)})}});
    const Result<std::vector<LevelShow>> read = read_shows(shows, "a.level.json");
    REQUIRE_MESSAGE(read.ok(), (read ? std::string() : read.error().message));
    const Status status = apply_show(read->front(), off, "a.level.json", json);
    if (!status) {
        return status.error().message;
    }
    std::string text = write_json(json);
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
    return text;
}

std::string error_of(std::string_view shows) {
    const Result<std::vector<LevelShow>> read =
        read_shows(json_object({{"shows", {}, parse(shows)}}), "a.level.json");
    return read ? "" : read.error().message;
}

constexpr std::string_view kLevel = R"({
  "resources": {"glow": {"strength": 0.1, "radius": 0.2}},
  "prefabs": {"post": {"spin": {"speed": 1}}},
  "entities": [
    {"name": "lamp", "point_light": {"intensity": 3, "color": [1, 1, 1]}},
    {"children": [{"name": "ball"}]}
  ]
})";

std::string show_with(std::string_view rest) {
    return R"({"technique": "a.b", "text": "T", )" + std::string(rest) + "}";
}

TEST_CASE("level_show: objects merge, null removes, anything else replaces") {
    CHECK(
        patched(
            R"({"a": {"b": 1, "c": [1, 2], "d": 3}})",
            show_with(R"("set": {"a": {"b": null, "c": [3], "e": {"f": null}}})"))
        == R"({"a":{"c":[3],"d":3,"e":{"f":null}}})");
    CHECK(patched(R"({"a": 1})", show_with(R"("set": {"a": {"b": 2}})")) == R"({"a":{"b":2}})");
}

TEST_CASE("level_show: off applies its patch on top of on, or is the plain level") {
    const std::string both = show_with(R"("set": {"x": 1, "y": 1}, "off": {"y": 2})");
    CHECK(patched(R"({"x": 0})", both) == R"({"x":1,"y":1})");
    CHECK(patched(R"({"x": 0})", both, true) == R"({"x":1,"y":2})");
    const std::string alone = show_with(R"("set": {"x": 1})");
    CHECK(patched(R"({"x": 0})", alone, true) == R"({"x":0})");
    const std::string removed = show_with(R"("off": {"x": null})");
    CHECK(patched(R"({"x": 0})", removed) == R"({"x":0})");
    CHECK(patched(R"({"x": 0})", removed, true) == "{}");
}

TEST_CASE("level_show: entities are patched by name, wherever they are, added and removed") {
    const std::string changed = patched(
        kLevel, show_with(R"("set": {"entities": {"lamp": {"point_light": {"intensity": 9}}}})"));
    CHECK(changed.find(R"("intensity":9,"color":[1,1,1])") != std::string::npos);
    const std::string child =
        patched(kLevel, show_with(R"("set": {"entities": {"ball": {"spin": {"speed": 2}}}})"));
    CHECK(child.find(R"({"name":"ball","spin":{"speed":2}})") != std::string::npos);
    const std::string added =
        patched(kLevel, show_with(R"("set": {"entities": {"+": [{"name": "new"}]}})"));
    CHECK(added.find(R"({"children":[{"name":"ball"}]},{"name":"new"}])") != std::string::npos);
    const std::string removed =
        patched(kLevel, show_with(R"("set": {"entities": {"lamp": null}})"));
    CHECK(removed.find("lamp") == std::string::npos);
    CHECK(removed.find("ball") != std::string::npos);
}

TEST_CASE("level_show: an unknown entity is an error with its position and the nearest name") {
    const std::string error = patched(kLevel, show_with(R"("set": {"entities": {"lmp": {}}})"));
    CHECK(error.find("a.level.json:1:") != std::string::npos);
    CHECK(error.find("show a.b") != std::string::npos);
    CHECK(error.find("did you mean lamp?") != std::string::npos);
}

TEST_CASE("level_show: entities that are a list, or added as anything else, are an error") {
    for (const char* const set :
         {R"("set": {"entities": []})", R"("set": {"entities": {"+": {}}})"}) {
        CHECK(patched(kLevel, show_with(set)).find("show a.b.set.entities") != std::string::npos);
    }
}

TEST_CASE("level_show: what is not a show is an error of one line") {
    const struct {
        const char* shows;
        const char* says;
    } cases[] = {
        {R"([{"technique": "a.b", "text": "T"}])", "\"set\", \"off\" or both"},
        {R"([{"technique": 3, "text": "T", "set": {}}])", "a string"},
        {R"([{"technique": "a.b", "set": {}}])", "a string"},
        {R"([{"technique": "a.b", "text": "T", "set": []}])", "a patch"},
        {R"([{"technique": "a.b", "text": "T", "set": {}, "time": -1}])", "0"},
        {R"([{"technique": "a.b", "text": "T", "set": {}, "camera": {"from": 1}}])", "from"},
        {R"([{"technique": "a.b", "text": "T", "set": {}, "equal": 1}])", "true or false"},
        {R"([{"technique": "a.b", "text": "T", "set": {}, "sett": 1}])", "sett"},
        {R"([{"technique": "a.b", "text": "T", "set": {}},
             {"technique": "a.b", "text": "T", "set": {}}])",
         "a second show of a.b"},
    };
    for (const auto& test : cases) {
        CAPTURE(test.shows);
        const std::string error = error_of(test.shows);
        CHECK(error.starts_with("a.level.json:"));
        CHECK(error.find(test.says) != std::string::npos);
        CHECK(error.find('\n') == std::string::npos);
    }
}

}  // namespace
}  // namespace limn::level_show_test
