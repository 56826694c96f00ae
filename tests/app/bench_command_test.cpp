#include "content/app/bench/bench_command.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::test::bench_command_test {

using Words = std::vector<std::string>;

TEST_CASE("bench_command: options of particles and faces are passed to their programs") {
    BenchOptions options;
    options.scene = "particles";
    options.frames = 1000;
    CHECK(bench_program_arguments(options) == Words{"--repeats", "400"});
    options.frames = 9;
    options.csv = "-";
    options.only = "growth";
    options.most = 2000;
    CHECK(
        bench_program_arguments(options)
        == Words{"--repeats", "9", "--csv", "-", "--only", "growth", "--most", "2000"});
}

TEST_CASE("bench_command: levels of detail are those of the image, unless the user sets them") {
    BenchOptions options;
    options.size = {640, 360};
    options.assignments = {{"rendering.level_rows", "1080"}};
    const std::vector<Assignment> all = bench_assignments(options);
    REQUIRE(all.size() == 2);
    CHECK(all[0].path == "rendering.level_rows");
    CHECK(all[0].value == "360");
    CHECK(all[1].value == "1080");  // assigned in order: the last one counts
    options.size = {32, 8};
    CHECK(bench_assignments(options)[0].value == "16");  // the least that the field takes
}

TEST_CASE("bench_command: --only is refused for scenes without parts") {
    BenchOptions options;
    options.scene = "gallery";
    options.only = "draw";
    const Status part = check_bench_options(options);
    REQUIRE(!part);
    CHECK(
        part.error().message.find("--only is for `particles`, `faces` and `characters`")
        != std::string::npos);
    options.only = "skin";
    options.scene = "characters";
    CHECK(check_bench_options(options));
    options.svg = "a.svg";
    const Status plot = check_bench_options(options);
    REQUIRE(!plot);
    CHECK(plot.error().message.find("--svg is for `particles` and `faces`") != std::string::npos);
    options.svg.clear();
    options.only.clear();
    options.scene = "faces";
    options.most = 2000;
    const Status most = check_bench_options(options);
    REQUIRE(!most);
    CHECK(most.error().message.find("--most is for `particles`") != std::string::npos);
}

}  // namespace limn::test::bench_command_test
