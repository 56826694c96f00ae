#include "tests/house/technique_map.h"

#include "content/load/level/technique_names.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace limn::test {
namespace {

namespace fs = std::filesystem;

std::string trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \n\r\t");
    const std::size_t last = text.find_last_not_of(" \n\r\t");
    return first == std::string_view::npos ? std::string()
                                           : std::string(text.substr(first, last + 1 - first));
}

std::vector<std::string> split_ids(std::string_view list) {
    std::vector<std::string> ids;
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        ids.push_back(trimmed(list.substr(0, comma)));
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return ids;
}

void add_once(std::vector<std::string>& list, const std::string& item) {
    if (std::find(list.begin(), list.end(), item) == list.end()) {
        list.push_back(item);
    }
}

/// One comment of a tag and of the lines that continue it.
void add_comment(TechniqueMap& map, const std::string& path, const std::string& comment) {
    constexpr std::string_view kCode = "Techniques: ";
    constexpr std::string_view kSource = "Source of ";
    constexpr std::string_view kShow = "Shown by `";
    if (comment.starts_with(kCode)) {
        for (const std::string& id : split_ids(comment.substr(kCode.size()))) {
            add_once(map[id].code, path);
        }
    } else if (comment.starts_with(kSource)) {
        const std::size_t colon = comment.find(": ");
        map[comment.substr(kSource.size(), colon - kSource.size())].source =
            colon == std::string::npos ? "" : comment.substr(colon + 2);
    } else if (comment.starts_with(kShow)) {
        const std::size_t end = comment.find("`: ");
        if (end != std::string::npos) {
            for (const std::string& id : split_ids(comment.substr(end + 3))) {
                add_once(map[id].shows, comment.substr(kShow.size(), end - kShow.size()));
            }
        }
    }
}

/// Reads C++ from a position on.
struct CodeReader {
    std::string_view text;
    std::size_t at = 0;

    bool take(std::string_view token) {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) {
            ++at;
        }
        const bool found = text.substr(at).starts_with(token);
        at += found ? token.size() : 0;
        return found;
    }
    /// A string literal without what continues it.
    std::string take_literal() {
        std::string literal;
        if (take("\"")) {
            for (; at < text.size() && text[at] != '"'; ++at) {
                at += text[at] == '\\' ? 1 : 0;
                literal += text.substr(at, 1);
            }
            ++at;
        }
        return literal;
    }
    std::string take_literals() {
        std::string all;
        for (std::string part = take_literal(); !part.empty(); part = take_literal()) {
            all += part;
        }
        return all;
    }
};

std::string read_text_file(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Files below a folder with one of these endings, from the root, by path.
std::set<std::string> files_below(
    const std::string& root, const std::string& folder, const std::vector<std::string>& endings) {
    std::set<std::string> paths;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(root) / folder)) {
        const std::string path = fs::relative(entry.path(), root).generic_string();
        for (const std::string& ending : endings) {
            if (path.ends_with(ending)) {
                paths.insert(path);
            }
        }
    }
    return paths;
}

std::string joined(const std::vector<std::string>& items) {
    std::string text;
    for (const std::string& item : items) {
        text += (text.empty() ? "`" : ", `") + item + "`";
    }
    return text;
}

/// Test cases after the file they are in.
std::string joined_tests(const std::map<std::string, std::vector<std::string>>& tests) {
    std::string text;
    for (const auto& [path, names] : tests) {
        text += (text.empty() ? "" : "; ") + fs::path(path).stem().string() + ": " + joined(names);
    }
    return text;
}

}  // namespace

void add_code(TechniqueMap& map, const std::string& path, std::string_view text) {
    std::string comment;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const bool continues = line.starts_with("//    ") && !comment.empty();
        if (continues) {
            comment += " " + trimmed(line.substr(2));
            continue;
        }
        add_comment(map, path, comment);
        comment = line.starts_with("// ") ? trimmed(line.substr(2)) : "";
    }
    add_comment(map, path, comment);
}

void add_tests(TechniqueMap& map, const std::string& path, std::string_view text) {
    CodeReader reader{text};
    while ((reader.at = text.find("TEST_CASE", reader.at)) != std::string_view::npos) {
        reader.at = text.find('(', reader.at);
        reader.at = std::min(text.find('"', reader.at), text.size());
        const std::string name = trimmed(reader.take_literal());
        reader.take_literals();
        while (reader.take("*")) {
            if (reader.take("technique(")) {
                for (const std::string& id : split_ids(reader.take_literals())) {
                    add_once(map[id].tests[path], name);
                }
            }
            reader.at = std::min(text.find(')', reader.at), text.size() - 1) + 1;
        }
    }
}

void add_shows(TechniqueMap& map, const std::string& level, std::string_view text) {
    CodeReader reader{text};
    constexpr std::string_view kMember = "\"technique\"";
    while ((reader.at = text.find(kMember, reader.at)) != std::string_view::npos) {
        reader.at += kMember.size();
        if (reader.take(":")) {
            add_once(map[reader.take_literal()].shows, level);
        }
    }
}

TechniqueMap read_technique_map(const std::string& root) {
    TechniqueMap map;
    for (const char* folder : {"ecs", "systems", "render", "content", "bench"}) {
        for (const std::string& path : files_below(
                 root, folder,
                 {".h", ".cpp", ".glsl", ".vert", ".frag", ".comp", ".geom", ".tesc", ".tese"})) {
            add_code(map, path, read_text_file(fs::path(root) / path));
        }
    }
    for (const std::string& path : files_below(root, "tests", {".cpp"})) {
        add_tests(map, path, read_text_file(fs::path(root) / path));
    }
    const std::string ending = ".level.json";
    for (const std::string& path : files_below(root, "content/levels", {ending})) {
        const std::string name = fs::path(path).filename().string();
        add_shows(
            map, name.substr(0, name.size() - ending.size()),
            read_text_file(fs::path(root) / path));
    }
    return map;
}

std::string_view technique_names(std::string_view id) {
    const auto* const found = std::find_if(
        std::begin(kTechniqueNames), std::end(kTechniqueNames),
        [id](const TechniqueName& named) { return named.id == id; });
    return found != std::end(kTechniqueNames) ? found->names : "";
}

std::vector<std::string> technique_page(const TechniqueMap& map) {
    std::vector<std::string> specified;
    std::vector<std::string> further;
    for (const auto& [id, row] : map) {
        const std::string first = "| " + id + " | ";
        const std::string rest = std::string(technique_names(id)) + ": " + joined(row.code) + " | "
                                 + joined_tests(row.tests) + " | " + joined(row.shows) + " |";
        if (row.source.empty()) {
            specified.push_back(first + rest);
        } else {
            further.push_back(first + row.source + " | " + rest);
        }
    }
    std::vector<std::string> page = {
        "# Techniques",
        "",
        "Where each technique is: its code, its tests, and the level or the command that shows it. "
        "To find one, search this page",
        "for what you call it, or run `limn shows depth of field`; `limn play --show ID` shows it "
        "with and without (F7). Test cases",
        "follow the file they are in; `ctest --preset release -R glow_test` runs those of one "
        "file.",
        "",
        "This page is generated from comments, test cases and levels "
        "(`tests/house/technique_map.h`) by",
        "`cmake --build --preset release --target techniques`; a test fails where it is not up to "
        "date.",
        "",
        "| id | name: code | tests | shown by |",
        "|---|---|---|---|"};
    page.insert(page.end(), specified.begin(), specified.end());
    const std::vector<std::string> second = {
        "",
        "## Further techniques",
        "",
        "Beyond the specification of the project, from the papers named.",
        "",
        "| id | source | name: code | tests | shown by |",
        "|---|---|---|---|---|"};
    page.insert(page.end(), second.begin(), second.end());
    page.insert(page.end(), further.begin(), further.end());
    return page;
}

std::vector<std::string> missing_parts(const TechniqueMap& map) {
    std::vector<std::string> missing;
    for (const auto& [id, row] : map) {
        const bool used = std::any_of(row.code.begin(), row.code.end(), [](const auto& path) {
            return !path.starts_with("bench/") || path.starts_with("bench/fakephong/");
        });
        std::string lacks = used ? "" : ", code (a comment \"// Techniques: " + id + "\")";
        lacks += !row.tests.empty() ? "" : ", a test (technique(\"" + id + "\"))";
        lacks += !row.shows.empty() ? "" : ", a show (of a level, or \"// Shown by `limn ...`: \")";
        if (!lacks.empty()) {
            missing.push_back(id + ": lacks " + lacks.substr(2));
        }
    }
    return missing;
}

}  // namespace limn::test
