// The example of content/levels/README.md loads without a warning and shows what it says.

#include "tests/app/read_image.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

namespace limn::level_page_test {

using test::ProgramRun;
using test::run_limn;

namespace {

/// The first block of JSON on the page.
std::string example() {
    const std::string page =
        test::read_text(std::string(LIMN_SOURCE_DIR) + "/content/levels/README.md");
    const std::string open = "```json\n";
    const std::size_t begin = page.find(open) + open.size();
    return page.substr(begin, page.find("```\n", begin) - begin);
}

}  // namespace

TEST_CASE("level page: the example has no warnings and renders lanterns brighter than the sky") {
    const test::TemporaryFolder folder;
    test::write_text(folder.file("jetty.level.json"), example());
    const ProgramRun check = run_limn(folder, {"check", "jetty.level.json"});
    CAPTURE(check.err);
    CHECK(check.exit_code == 0);
    CHECK(check.err.empty());
    CHECK(check.out.find("no warnings") != std::string::npos);
    const ProgramRun render = run_limn(
        folder, {"render", "jetty.level.json", "--time", "5", "--size", "160x90", "--spp", "4",
                 "-o", "a.png"});
    REQUIRE(render.exit_code == 0);
    const test::Picture picture = test::read_image(folder.file("a.png"));
    REQUIRE(picture.whole);
    int bright = 0;
    double red = 0;
    double blue = 0;
    for (std::size_t i = 0; i < picture.values.size(); i += 3) {
        bright += picture.values[i] > 0.98f && picture.values[i + 1] > 0.9f ? 1 : 0;
        red += static_cast<double>(picture.values[i]);
        blue += static_cast<double>(picture.values[i + 2]);
    }
    CHECK(bright >= 20);      // lanterns
    CHECK(bright <= 400);     // and nothing else
    CHECK(red > 1.2 * blue);  // dusk
}

}  // namespace limn::level_page_test
