#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

// The map of techniques, joined from where each is named by its id:
//
//     // Techniques: water.fresnel, water.foam          a comment of the product, and of the
//                                                       references in bench/ that it is held
//                                                       against
//     // Source of water.foam: Tessendorf 2001          where the specification does not ask for it
//     // Shown by `limn info pond`: water.foam          a command, where no level shows it
//     TEST_CASE("water: it is wet" * technique("water.fresnel"))           tests/technique.h
//     "shows": [{"technique": "water.fresnel", ...      a level
//
// A comment continues on lines that begin with "//" and at least four spaces. What a technique is
// called stands in content/load/level/technique_names.h.

struct TechniqueRow {
    std::string source;  ///< empty: from the specification
    std::vector<std::string> code;
    std::map<std::string, std::vector<std::string>> tests;  ///< names of test cases, by file
    std::vector<std::string> shows;                         ///< levels and commands
};

using TechniqueMap = std::map<std::string, TechniqueRow>;  ///< by id

/// Adds what the comments of a source file say.
void add_code(TechniqueMap& map, const std::string& path, std::string_view text);

/// Adds the test cases of a file. A name that is continued on a second line counts up to there.
void add_tests(TechniqueMap& map, const std::string& path, std::string_view text);

/// Adds what a level shows.
void add_shows(TechniqueMap& map, const std::string& level, std::string_view text);

/// That of the tree at `root`: code by layer and path, tests by line, levels by name.
[[nodiscard]] TechniqueMap read_technique_map(const std::string& root);

/// From technique_names.h; empty for an id that it lacks.
[[nodiscard]] std::string_view technique_names(std::string_view id);

/// TECHNIQUES.md, line by line.
[[nodiscard]] std::vector<std::string> technique_page(const TechniqueMap& map);

/// A line for each id and what it lacks: code that the product uses, a test or a show.
[[nodiscard]] std::vector<std::string> missing_parts(const TechniqueMap& map);

}  // namespace limn::test
