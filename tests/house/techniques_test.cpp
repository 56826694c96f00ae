// TECHNIQUES.md is generated: what it is made of, and that it is up to date.

#include "content/load/level/technique_names.h"
#include "tests/house/technique_map.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace limn::techniques_test {
namespace {

const std::string kPagePath = std::string(LIMN_SOURCE_DIR) + "/TECHNIQUES.md";

std::vector<std::string> read_lines(const std::string& path) {
    std::vector<std::string> lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        lines.push_back(line);
    }
    return lines;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("techniques: TECHNIQUES.md is what code, tests and levels say") {
    const Names page = test::technique_page(test::read_technique_map(LIMN_SOURCE_DIR));
    if (std::getenv("LIMN_UPDATE_TECHNIQUES") != nullptr) {
        std::ofstream file(kPagePath);
        for (const std::string& line : page) {
            file << line << '\n';
        }
    }
    const Names found = read_lines(kPagePath);
    const std::set<std::string> expected_rows(page.begin(), page.end());
    const std::set<std::string> found_rows(found.begin(), found.end());
    for (const std::string& line : page) {
        CHECK_MESSAGE(found_rows.contains(line), "missing: " << line);
    }
    for (const std::string& line : found) {
        CHECK_MESSAGE(expected_rows.contains(line), "out of date: " << line);
    }
    CHECK_MESSAGE(found == page, "build the target `techniques` to write TECHNIQUES.md anew");
}

TEST_CASE("techniques: each has code that the product uses, a test and a show") {
    for (const std::string& line : test::missing_parts(test::read_technique_map(LIMN_SOURCE_DIR))) {
        FAIL_CHECK(line);
    }
}

TEST_CASE("techniques: each has a name, listed once, by id") {
    const test::TechniqueMap map = test::read_technique_map(LIMN_SOURCE_DIR);
    for (const auto& [id, row] : map) {
        CHECK_MESSAGE(!test::technique_names(id).empty(), id << ": add it to technique_names.h");
    }
    for (const TechniqueName& named : kTechniqueNames) {
        CHECK_MESSAGE(map.contains(std::string(named.id)), named.id << " is no technique");
    }
    CHECK(std::is_sorted(
        std::begin(kTechniqueNames), std::end(kTechniqueNames),
        [](const TechniqueName& a, const TechniqueName& b) { return a.id < b.id; }));
    CHECK(std::size(kTechniqueNames) == map.size());
}

TEST_CASE("techniques: the page finds a technique by name, with the files of its tests") {
    test::TechniqueMap map;
    test::add_code(map, "render/glow.cpp", "// Techniques: post.glow");
    test::add_tests(
        map, "tests/glow_test.cpp", "TEST_CASE(\"glow: it is\" * technique(\"post.glow\"))");
    test::add_tests(
        map, "tests/lens_test.cpp", "TEST_CASE(\"lens: all\" * technique(\"post.glow\"))");
    test::add_shows(map, "museum", R"("technique": "post.glow")");
    const Names page = test::technique_page(map);
    const auto row = std::find_if(page.begin(), page.end(), [](const std::string& line) {
        return line.starts_with("| post.glow ");
    });
    REQUIRE(row != page.end());
    CHECK(row->find("bloom") != std::string::npos);
    CHECK(row->ends_with(": `render/glow.cpp` | glow_test: `glow: it is`; lens_test: `lens: all` | "
                         "`museum` |"));
}

TEST_CASE("techniques: each is in the specification or says where it is from, and not both") {
    const auto index = test::shared_file("spec/index.tsv");
    if (!index) {
        return;
    }
    std::set<std::string> ids;
    for (const std::string& line : read_lines(*index)) {
        ids.insert(line.substr(0, line.find('\t')));
    }
    for (const auto& [key, value] : test::read_technique_map(LIMN_SOURCE_DIR)) {
        const std::string& id = key;  // a binding cannot be captured
        const test::TechniqueRow& row = value;
        INFO(id << " has the source \"" << row.source << "\"");
        CHECK(ids.contains(id) == row.source.empty());
    }
}

TEST_CASE("techniques: comments name code, sources and commands, over several lines") {
    test::TechniqueMap map;
    test::add_code(
        map, "systems/water.cpp",
        "// Techniques: water.foam, water.fresnel,\n"
        "//     water.ripples\n"
        "// Source of water.foam: a paper,\n"
        "//     of its authors\n"
        "// Shown by `limn info pond`: water.foam, water.fresnel\n"
        "// Techniques are no tag without a colon.\n"
        "int techniques;  // Techniques: none.here");
    CHECK(map.size() == 3);
    for (const char* id : {"water.foam", "water.fresnel", "water.ripples"}) {
        CHECK(map[id].code == Names{"systems/water.cpp"});
    }
    CHECK(map["water.foam"].source == "a paper, of its authors");
    CHECK(map["water.fresnel"].shows == Names{"limn info pond"});
    CHECK(map["water.ripples"].shows.empty());
}

TEST_CASE("techniques: test cases name theirs, with and without fixture, over several lines") {
    test::TechniqueMap map;
    test::add_tests(
        map, "tests/water_test.cpp",
        "TEST_CASE(\"water: one\" * technique(\"water.foam\")) {}\n"
        "TEST_CASE(\"water: none\") { const int n = 2 * 3; }\n"
        "TEST_CASE_FIXTURE(\n"
        "    Pond, \"water: two \"\n"
        "          \"lines\"\n"
        "    * doctest::skip() * technique(\"water.foam, \"\n"
        "                                  \"water.fresnel\")) {}");
    CHECK(map.size() == 2);
    CHECK(map["water.foam"].tests.size() == 1);
    CHECK(map["water.foam"].tests["tests/water_test.cpp"] == Names{"water: one", "water: two"});
    CHECK(map["water.fresnel"].tests["tests/water_test.cpp"] == Names{"water: two"});
}

TEST_CASE("techniques: an id that lacks code, a test or a show is named with what it lacks") {
    test::TechniqueMap map;
    test::add_code(map, "bench/oracles/foam.cpp", "// Techniques: a.oracle, a.whole");
    test::add_code(map, "render/foam.cpp", "// Techniques: a.untested, a.whole");
    test::add_tests(
        map, "tests/a_test.cpp", "TEST_CASE(\"a: b\" * technique(\"a.oracle, a.whole, a.whale\"))");
    test::add_shows(
        map, "pond", R"({"shows": [{"technique": "a.whole"}, {"technique":"a.oracle"}]})");
    const Names missing = test::missing_parts(map);
    REQUIRE(missing.size() == 3);
    CHECK(missing[0].starts_with("a.oracle: lacks code"));
    CHECK(missing[1].starts_with("a.untested: lacks a test"));
    CHECK(missing[2].starts_with("a.whale: lacks code"));
    CHECK(missing[2].find("show") != std::string::npos);
}

}  // namespace limn::techniques_test
