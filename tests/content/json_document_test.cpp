#include "content/load/files/json_document.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace limn::json_document_test {
namespace {

JsonValue parse(std::string_view text) {
    Result<JsonValue> value = parse_json(text, "t.json");
    REQUIRE_MESSAGE(value.ok(), (value.ok() ? "" : value.error().message));
    return *std::move(value);
}

/// The message, which must be one line that begins with the file.
std::string error_of(std::string_view text, const JsonLimits& limits = {}) {
    const Result<JsonValue> value = parse_json(text, "t.json", limits);
    REQUIRE(!value.ok());
    CHECK(value.error().message.find('\n') == std::string::npos);
    CHECK(value.error().message.starts_with("t.json:"));
    return value.error().message;
}

}  // namespace

TEST_CASE("json: every value knows its line and column, past comments and tabs") {
    const JsonValue root =
        parse("// a level\n{ \"a\": 1, /* two\nlines */ \"b\": [true,\n  \"x\"] }");
    CHECK(root.at.line == 2);
    CHECK(root.at.column == 1);
    CHECK(root.find("a")->at.column == 8);
    CHECK(root.members[1].at.line == 3);
    CHECK(root.members[1].at.column == 10);
    CHECK(root.find("b")->items[0].at.line == 3);
    CHECK(root.find("b")->items[1].at.line == 4);
    CHECK(root.find("b")->items[1].at.column == 3);
}

TEST_CASE("json: columns count characters, not bytes") {
    const JsonValue root = parse("[\"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\", 2]");
    CHECK(root.items[1].at.column == 9);
}

TEST_CASE("json: kinds and values arrive as written") {
    const JsonValue root =
        parse("[null, true, false, -0.5e1, \"\\u00e9\\n\\ud83d\\ude00\", [], {}]");
    CHECK(root.items[0].kind == JsonKind::Null);
    CHECK(root.items[1].truth);
    CHECK_FALSE(root.items[2].truth);
    CHECK(root.items[3].number == -5.0);
    CHECK(root.items[3].text == "-0.5e1");
    CHECK(root.items[4].text == "\xc3\xa9\n\xf0\x9f\x98\x80");
    CHECK(root.items[5].items.empty());
    CHECK(root.items[6].kind == JsonKind::Object);
    CHECK(root.find("a") == nullptr);
}

TEST_CASE("json: a byte order mark and line ends of any kind are no part of the text") {
    const JsonValue root = parse("\xef\xbb\xbf{\r\n\"a\": 1}\r\n");
    CHECK(root.at.column == 1);
    CHECK(root.find("a")->at.line == 2);
}

TEST_CASE("json: invalid JSON is refused with its position and what was expected") {
    CHECK(error_of("") == "t.json:1:1: found the end of the file, expected a value");
    CHECK(error_of("{\"a\": }") == "t.json:1:7: found \"}\", expected a value");
    CHECK(error_of("{\"a\" 1}") == "t.json:1:6: found \"1\", expected ':' after the key \"a\"");
    CHECK(error_of("[1 2]") == "t.json:1:4: found \"2\", expected ',' or ']' in the array");
    CHECK(
        error_of("{\"a\": 1  // one\n\n\"b\": 2}")
        == "t.json:3:1: found \"\\\"\", expected ',' or '}' in the object (line 1 ends without "
           "one)");
    CHECK(error_of("[1,]") == "t.json:1:3: found a comma before ], expected none there");
    CHECK(
        error_of("{\"a\": [1],  // one\n}")
        == "t.json:1:10: found a comma before }, expected none there");
    CHECK(error_of("[1,,]") == "t.json:1:4: found \",\", expected a value");
    CHECK(error_of("{\"a\": 1,\n}") == "t.json:1:8: found a comma before }, expected none there");
    CHECK(
        error_of("{\"a\": 1,\n \"a\": 2}")
        == "t.json:2:2: found a duplicate key \"a\", expected each key once");
    CHECK(
        error_of("[1] x")
        == "t.json:1:5: found \"x\", expected the end of the file after the value");
    CHECK(error_of("[1, /* x") == "t.json:1:5: found an unterminated comment, expected */");
    CHECK(error_of("\"abc") == "t.json:1:1: found an unterminated string, expected a closing \"");
    CHECK(error_of("\"a\nb\"").find("unterminated string") != std::string::npos);
    CHECK(error_of("\"\\x\"").find("after a backslash") != std::string::npos);
    CHECK(error_of("\"\\u12g4\"").find("four hexadecimal digits") != std::string::npos);
    CHECK(error_of("\"\\u12").find("four hexadecimal digits") != std::string::npos);
    CHECK(error_of("\"\\ud800x\"").find("surrogate") != std::string::npos);
    CHECK(error_of("\"\\ud800\\u0041\"").find("surrogate") != std::string::npos);
    CHECK(error_of("\"\xff\"").find("not UTF-8") != std::string::npos);
    CHECK(error_of("\"\xc0\x80\"").find("not UTF-8") != std::string::npos);
    CHECK(error_of("\"\xed\xa0\x80\"").find("not UTF-8") != std::string::npos);
    CHECK(error_of("\"\x01\"").find("control characters") != std::string::npos);
    CHECK(error_of("nul").find("expected a value") != std::string::npos);
    CHECK(error_of("{'a': 1}").find("expected a key in quotes") != std::string::npos);
}

TEST_CASE("json: a number is finite and spelled as JSON has it") {
    for (const char* text :
         {"NaN", "Infinity", "-", "-inf", "01", "1.", ".5", "1e", "+1", "0x10"}) {
        CAPTURE(text);
        CHECK_FALSE(parse_json(text, "t.json").ok());
    }
    CHECK(
        error_of("1e999")
        == "t.json:1:1: found the number 1e999, expected one that a double can hold");
    CHECK(parse("18446744073709551615").text == "18446744073709551615");
}

TEST_CASE("json: nesting, size and count are bounded") {
    const std::string deep(200'000, '[');
    CHECK(error_of(deep) == "t.json:1:65: found more than 64 levels of nesting, expected fewer");
    CHECK(error_of("[1, 2, 3]", {.max_values = 3}).find("more than 3 values") != std::string::npos);
    CHECK(
        error_of("[1, 2, 3]", {.max_bytes = 8}).find("found 9 bytes, expected at most 8")
        != std::string::npos);
}

TEST_CASE("json: a long line costs no more per character than short ones") {
    std::string text = "[0";
    for (int i = 0; i < 300'000; ++i) {
        text += ",1";
    }
    text += "]";
    CHECK(parse(text).items.back().at.column == 600'002);  // quadratic counting would take minutes
}

TEST_CASE("json: what was written reads back the same, floats to the bit") {
    JsonValue array = json_array();
    for (const float x : {0.1f, 1e-45f, 3.4028235e38f, -0.0f, 16777216.0f}) {
        array.items.push_back(json_of(x));
    }
    JsonMember text{"quote \" and \n", {}, json_of(std::string_view("tab\t\x01 \xe2\x82\xac"))};
    JsonMember integer{"seed", {}, json_of(std::uint64_t{18446744073709551615u})};
    const std::string written = write_json(json_object({text, integer, {"floats", {}, array}}));
    const JsonValue read = parse(written);
    CHECK(read.members[0].key == text.key);
    CHECK(read.members[0].value.text == text.value.text);
    CHECK(read.find("seed")->text == "18446744073709551615");
    for (std::size_t i = 0; i < array.items.size(); ++i) {
        CHECK(
            static_cast<float>(read.find("floats")->items[i].number)
            == static_cast<float>(array.items[i].number));
    }
    CHECK(write_json(read) == written);
}

TEST_CASE("json: a missing file, a directory and an empty file each give one line") {
    const test::TemporaryFolder folder;
    CHECK(
        load_json(folder.file("none.json")).error().message
        == folder.file("none.json") + ": no such file");
    std::ofstream(folder.file("Fox.glb")) << "";
    CHECK(
        load_json(folder.file("fox.gltf")).error().message
        == folder.file("fox.gltf") + ": no such file (did you mean Fox.glb?)");
    CHECK(
        load_json(folder.path()).error().message
        == folder.path() + ": found a folder, expected a file");
    const std::ofstream empty(folder.file("empty.json"));
    CHECK(
        load_json(folder.file("empty.json")).error().message
        == folder.file("empty.json") + ":1:1: found the end of the file, expected a value");
}

TEST_CASE("json: messages show long and strange strings short and on one line") {
    CHECK(describe(parse("\"a\\nb\"")) == "the string \"a\\nb\"");
    CHECK(describe(parse("[1, 2]")) == "an array of 2");
    CHECK(in_quotes("x\xffy") == "\"x\\xffy\"");
    CHECK(in_quotes(std::string(1000, 'x')).size() < 60);
}

TEST_CASE("json: the nearest name is a likely typo, and nothing when none is near") {
    const std::vector<std::string_view> names = {"intensity", "color", "radius"};
    CHECK(did_you_mean("intensty", names) == " (did you mean intensity?)");
    CHECK(did_you_mean("raduis", names) == " (did you mean radius?)");
    CHECK(did_you_mean("velocity_of_light", names).empty());
    CHECK(did_you_mean(std::string(1'000'000, 'x'), names).empty());
    CHECK(did_you_mean("xyz", names).empty());
    CHECK(did_you_mean("colr", names) == " (did you mean color?)");
    const std::vector<std::string_view> as_near = {"seed", "shape", "speed"};
    CHECK(did_you_mean("sped", as_near) == " (did you mean speed?)");
}

}  // namespace limn::json_document_test
