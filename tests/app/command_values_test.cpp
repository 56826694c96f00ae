#include "content/app/commands/command_values.h"

#include <doctest/doctest.h>

#include <initializer_list>

namespace limn::command_values_test {

TEST_CASE("command_values: a size is two whole numbers of pixels") {
    const Result<IVec2> size = parse_size("1280x720");
    REQUIRE(size);
    CHECK(*size == IVec2(1280, 720));
    for (const char* bad :
         {"", "x", "640", "640x", "x360", "640x360x2", "640 x 360", "0x360", "-1x5", "640x99999",
          "16384x16384", "99999999999x1", "6e2x360", "640X360"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_size(bad));
    }
}

TEST_CASE("command_values: a frame range includes both ends") {
    CHECK(*parse_frame_range("0:99") == FrameRange{0, 99});
    CHECK(*parse_frame_range("7") == FrameRange{7, 7});
    for (const char* bad :
         {"", ":", "3:", ":3", "5:2", "-1:3", "0:1000000", "1:2:3", "a:b", "1.5:2"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_frame_range(bad));
    }
}

TEST_CASE("command_values: numbers are read whole, inside their range, and are never NaN") {
    CHECK(*parse_number("0.5", 0, 1) == 0.5);
    for (const char* bad : {"", "nan", "inf", "1.5", "-0.1", "0.5s", "1e999", " 0.5"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_number(bad, 0, 1));
    }
    CHECK(*parse_integer("8", 1, 8) == 8);
    for (const char* bad : {"", "0", "9", "1.0", "0x4", "99999999999999999999"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_integer(bad, 1, 8));
    }
}

TEST_CASE("command_values: --set needs a path and a value") {
    const Result<Assignment> assignment = parse_assignment("lamp.name.text=a=b");
    REQUIRE(assignment);
    CHECK(assignment->path == "lamp.name.text");
    CHECK(assignment->value == "a=b");
    CHECK_FALSE(parse_assignment("path"));
    CHECK_FALSE(parse_assignment("=3"));
    CHECK_FALSE(parse_assignment("path="));
}

TEST_CASE("command_values: messages keep their lines, but no other control character") {
    CHECK(printable_lines("a: b\nc: d") == "a: b\nc: d");
    CHECK(printable_lines("\x1b[2J a\r\t\x7f") == " [2J a   ");
    CHECK(
        printable_lines("\xc2\x9b"
                        "1m \xc2\xa0 \xc3\xa9 \xc2")
        == " 1m \xc2\xa0 \xc3\xa9 \xc2");
    CHECK(one_line("a\nb\x1b") == "a b ");
}

TEST_CASE("command_values: a list has no empty part") {
    CHECK(parse_list("depth,normal")->size() == 2);
    CHECK(parse_list("depth")->front() == "depth");
    CHECK_FALSE(parse_list(""));
    CHECK_FALSE(parse_list("depth,"));
    CHECK_FALSE(parse_list(",depth"));
    CHECK_FALSE(parse_list("depth,,normal"));
}

}  // namespace limn::command_values_test
