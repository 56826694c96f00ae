// The rules of the house that no compiler knows: who may include whom, unique names of
// files and types, one pragma.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace limn::house_test {
namespace {

namespace fs = std::filesystem;

struct SourceFile {
    std::string path;  ///< from the root, with '/'
    std::vector<std::string> lines;
};

std::vector<SourceFile>
files_in(const std::vector<const char*>& folders, const std::set<std::string>& extensions) {
    const fs::path root = LIMN_SOURCE_DIR;
    std::vector<SourceFile> sources;
    for (const char* folder : folders) {
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!extensions.contains(entry.path().extension().string())) {
                continue;
            }
            SourceFile source{fs::relative(entry.path(), root).generic_string(), {}};
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                source.lines.push_back(line);
            }
            sources.push_back(std::move(source));
        }
    }
    return sources;
}

std::vector<SourceFile> own_sources() {
    return files_in({"ecs", "systems", "render", "content", "tests", "bench"}, {".h", ".cpp"});
}

bool starts_with(const std::string& text, const std::string& prefix) {
    return text.compare(0, prefix.size(), prefix) == 0;
}

/// The box of the design a file belongs to.
std::string layer_of(const std::string& path) {
    for (const char* layer :
         {"ecs/base/", "ecs/components/", "ecs/", "systems/", "render/", "content/app/",
          "content/game/", "content/", "bench/oracles/", "bench/fakephong/", "bench/", "tests/"}) {
        if (starts_with(path, layer)) {
            return layer;
        }
    }
    return "";
}

/// What each box may include, itself apart.
const std::map<std::string, std::set<std::string>>& allowed_layers() {
    static const std::set<std::string> kAll = {
        "ecs/base/",        "ecs/",         "ecs/components/", "systems/",
        "render/",          "content/",     "content/game/",   "bench/oracles/",
        "bench/fakephong/", "content/app/", "tests/",          "bench/"};
    static const std::map<std::string, std::set<std::string>> kAllowed = {
        {"ecs/base/", {}},
        {"ecs/", {"ecs/base/"}},
        {"ecs/components/", {"ecs/base/", "ecs/"}},
        {"systems/", {"ecs/base/", "ecs/", "ecs/components/"}},
        {"render/", {"ecs/base/", "ecs/", "ecs/components/"}},
        {"content/", {"ecs/base/", "ecs/", "ecs/components/"}},
        {"content/game/", {"ecs/base/", "ecs/", "ecs/components/", "systems/"}},
        {"bench/oracles/",
         {"ecs/base/", "ecs/", "ecs/components/", "systems/", "render/", "content/"}},
        {"bench/fakephong/", {"ecs/base/", "ecs/", "ecs/components/", "content/"}},
        {"content/app/",
         {"ecs/base/", "ecs/", "ecs/components/", "systems/", "render/", "content/",
          "content/game/", "bench/fakephong/"}},
        {"tests/", kAll},
        {"bench/", kAll},
    };
    return kAllowed;
}

}  // namespace

TEST_CASE("house: includes point only to the left") {
    const std::regex include(R"re(^\s*#\s*include\s+"([^"]+)")re");
    for (const SourceFile& source : own_sources()) {
        const std::string from = layer_of(source.path);
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            std::smatch match;
            if (!std::regex_search(source.lines[i], match, include)) {
                continue;
            }
            const std::string included = match[1];
            const std::string to = layer_of(included);
            INFO(source.path << ":" << i + 1 << " includes " << included);
            CHECK_MESSAGE(!to.empty(), "not a full path from the root");
            CHECK((to == from || allowed_layers().at(from).count(to) == 1));
        }
    }
}

TEST_CASE("house: the ECS includes the standard library, the system and TBB, and nothing else") {
    // The engine's own base lies beside that of the ECS, but is no part of it.
    const std::set<std::string> engine_headers = {
        "ecs/base/air.h",         "ecs/base/bezier.h",         "ecs/base/caustic_optics.h",
        "ecs/base/foot_flight.h", "ecs/base/gradient_noise.h", "ecs/base/limb_reach.h",
        "ecs/base/math.h",        "ecs/base/optics.h",         "ecs/base/repeatable_math.h",
        "ecs/base/rng.h",         "ecs/base/rotation.h",       "ecs/base/triangle.h"};
    const std::regex include(R"re(^\s*#\s*include\s+([<"])([^>"]+)[>"])re");
    const std::regex allowed(
        R"(([a-z_]+|sys/(mman|resource)\.h|sanitizer/tsan_interface\.h|unistd\.h|(oneapi/)?tbb/[a-z_]+\.h))");
    std::size_t checked = 0;
    for (const SourceFile& source : own_sources()) {
        const std::string layer = layer_of(source.path);
        if ((layer != "ecs/" && layer != "ecs/base/") || engine_headers.count(source.path) == 1) {
            continue;
        }
        ++checked;
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            std::smatch match;
            if (!std::regex_search(source.lines[i], match, include)) {
                continue;
            }
            INFO(source.path << ":" << i + 1 << ": " << source.lines[i]);
            if (match[1] == "<") {
                CHECK(std::regex_match(match[2].str(), allowed));
            } else {
                CHECK(engine_headers.count(match[2]) == 0);
            }
        }
    }
    CHECK(checked > 40);
}

TEST_CASE("house: a system never includes another system, nor a pass another pass") {
    // A pass is one of the effects in the list of image.cpp; its parts may lie in files of their
    // own.
    const std::regex include(
        R"re(^\s*#\s*include\s+"((?:systems|content/game)/[^"]+|render/[a-z]+/\w+_pass\.h)")re");
    std::set<std::string> effects;
    for (const SourceFile& source : own_sources()) {
        for (const std::string& line : source.lines) {
            std::smatch match;
            if (source.path == "render/image.cpp" && std::regex_search(line, match, include)) {
                effects.insert(match[1]);
            }
        }
    }
    CHECK(effects.size() > 20);
    for (const SourceFile& source : own_sources()) {
        const bool system =
            (starts_with(source.path, "systems/") || starts_with(source.path, "content/game/"))
            && source.path.find("_system.") != std::string::npos;
        const bool pass = starts_with(source.path, "render/") && source.path != "render/image.cpp";
        if (!system && !pass) {
            continue;
        }
        const std::string own_stem = fs::path(source.path).stem().string();
        for (const std::string& line : source.lines) {
            std::smatch match;
            if (std::regex_search(line, match, include)) {
                const std::string stem = fs::path(match[1].str()).stem().string();
                const bool other_effect =
                    stem != own_stem && (stem.ends_with("_system") || effects.count(match[1]) == 1);
                INFO(source.path << " includes " << match[1].str());
                CHECK(!other_effect);
            }
        }
    }
}

TEST_CASE("house: file names are unique in the whole tree") {
    std::map<std::string, std::string> first;
    for (const SourceFile& source : own_sources()) {
        const std::string name = fs::path(source.path).filename().string();
        if (name == "main.cpp") {
            continue;
        }
        const auto added = first.emplace(name, source.path);
        INFO(source.path << " and " << added.first->second);
        CHECK(added.second);
    }
}

TEST_CASE("house: no two types of one namespace have the same name, which no linker sees") {
    const std::regex opened(R"(^(?:inline )?namespace ?([\w:]*) \{$)");
    const std::regex closed(R"(^\}  // namespace)");
    const std::regex defined(
        R"(^(?:struct|class|union|enum class|enum) (\w+)(?: final)?(?: :[^:;].*)? \{)");
    std::map<std::string, std::string> first;
    for (const SourceFile& source : own_sources()) {
        if (starts_with(source.path, "tests/ecs/compile_errors/")
            || source.path == "bench/micro/ecs_compile.h") {
            continue;  // programs of their own
        }
        std::vector<std::string> namespaces;
        for (const std::string& line : source.lines) {
            std::smatch match;
            if (std::regex_search(line, match, opened)) {
                namespaces.push_back(match[1].length() == 0 ? source.path : match[1].str());
            } else if (std::regex_search(line, closed) && !namespaces.empty()) {
                namespaces.pop_back();
            } else if (!namespaces.empty() && std::regex_search(line, match, defined)) {
                std::string name;
                for (const std::string& part : namespaces) {
                    name += part + "::";
                }
                name += match[1];
                const auto added = first.emplace(name, source.path);
                INFO(name << " is defined in " << source.path << " and " << added.first->second);
                CHECK(added.second);
            }
        }
    }
    CHECK(first.size() > 500);
}

TEST_CASE("house: every header has its pragma, every source includes its own header first") {
    for (const SourceFile& source : own_sources()) {
        INFO(source.path);
        const fs::path path = source.path;
        if (path.extension() == ".h") {
            bool has_pragma = false;
            for (const std::string& line : source.lines) {
                has_pragma = has_pragma || line == "#pragma once";
            }
            CHECK((has_pragma || source.path.ends_with("_gpu.h")));
            continue;
        }
        const std::string own = fs::path(source.path).replace_extension(".h").generic_string();
        if (!fs::exists(fs::path(LIMN_SOURCE_DIR) / own)) {
            continue;
        }
        for (const std::string& line : source.lines) {
            if (starts_with(line, "#include")) {
                CHECK(line == "#include \"" + own + "\"");
                break;
            }
        }
    }
}

/// What a file includes, directly or through headers of the tree; `included` maps a path to its
/// #include lines.
std::set<std::string> find_reachable(
    const std::string& path, const std::map<std::string, std::vector<std::string>>& included) {
    std::set<std::string> reachable;
    std::vector<std::string> open = {path};
    while (!open.empty()) {
        const auto found = included.find(open.back());
        open.pop_back();
        if (found == included.end()) {
            continue;
        }
        for (const std::string& header : found->second) {
            if (reachable.insert(header).second) {
                open.push_back(header);
            }
        }
    }
    return reachable;
}

// Precompiled headers hide a missing include, and other standard libraries do not include what
// this one does.
TEST_CASE("house: what a file uses of the standard library and fmt is included") {
    const struct {
        std::regex used;
        std::vector<std::string> headers;  ///< one of them
    } rules[] = {
        {std::regex(R"(std::vector<)"), {"vector"}},
        {std::regex(R"(std::string\b)"), {"string"}},
        {std::regex(R"(std::string_view\b)"), {"string_view", "string"}},
        {std::regex(R"(std::span<)"), {"span"}},
        {std::regex(R"(std::array\b)"), {"array"}},
        {std::regex(R"(std::optional<)"), {"optional"}},
        {std::regex(R"(std::map<)"), {"map"}},
        {std::regex(R"(std::unordered_map<)"), {"unordered_map"}},
        {std::regex(R"(std::(unique_ptr|make_unique|shared_ptr|make_shared)\b)"), {"memory"}},
        {std::regex(R"(std::function<)"), {"functional"}},
        {std::regex(R"(std::atomic\b)"), {"atomic"}},
        {std::regex(R"(std::numeric_limits)"), {"limits"}},
        {std::regex(R"(std::(iota|accumulate)\b)"), {"numeric"}},
        {std::regex(R"(std::(bit_cast|popcount|countr_zero|has_single_bit)\b)"), {"bit"}},
        {std::regex(R"(std::mem(cpy|set|cmp|move)\b)"), {"cstring"}},
        {std::regex(R"(std::u?int(8|16|32|64)_t\b)"), {"cstdint"}},
        {std::regex(R"(std::(mt19937|uniform_\w+))"), {"random"}},
        {std::regex(R"(std::(sort|min|max|clamp|any_of|all_of|find_if|fill|copy|transform)\()"),
         {"algorithm"}},
        {std::regex(R"(std::(sqrt|floor|ceil|pow|exp2?|log2?|sin|cos|atan2|lround)\()"), {"cmath"}},
        {std::regex(R"(std::(move|forward|exchange|as_const|swap|pair)\b)"), {"utility"}},
        {std::regex(R"(std::is_\w+_v|std::decay_t)"), {"type_traits", "concepts"}},
        {std::regex(R"(\bfmt::)"), {"fmt/format.h", "fmt/core.h"}},
    };
    const std::vector<SourceFile> sources = own_sources();
    std::map<std::string, std::vector<std::string>> included;
    const std::regex include(R"(^#include ["<]([^">]+)[">])");
    for (const SourceFile& source : sources) {
        for (const std::string& line : source.lines) {
            std::smatch header;
            if (starts_with(line, "#include") && std::regex_search(line, header, include)) {
                included[source.path].push_back(header[1]);
            }
        }
    }
    for (const SourceFile& source : sources) {
        if (source.path == "tests/house/house_test.cpp") {
            continue;  // these rules
        }
        std::string code;
        for (const std::string& line : source.lines) {
            if (line.find("::") != std::string::npos) {
                code += line.substr(0, line.find("//")) + '\n';
            }
        }
        const std::set<std::string> reachable = find_reachable(source.path, included);
        for (const auto& rule : rules) {
            bool is_included = false;
            for (const std::string& header : rule.headers) {
                is_included = is_included || reachable.count(header) > 0;
            }
            if (!is_included && std::regex_search(code, rule.used)) {
                FAIL_CHECK(
                    source.path << ": found a name of <" << rule.headers.front()
                                << ">, expected its #include");
            }
        }
    }
}

TEST_CASE("house: each of the five packages of the project does its work, where it belongs") {
    struct Package {
        std::string name;
        std::regex header;
        std::vector<std::string> places;  ///< files, or folders and stems that begin so
    };
    const std::vector<Package> packages = {
        {"GLFW", std::regex("GLFW/.*"), {"content/app/"}},  // window and input
        {"GLM",
         std::regex("glm/.*"),  // vectors and matrices
         {"ecs/base/", "ecs/components/", "systems/", "render/", "content/", "bench/"}},
        {"tinygltf", std::regex("tiny_gltf\\.h"), {"content/load/gltf/"}},  // glTF, both ways
        {"OpenEXR", std::regex("(OpenEXR|Imath)/.*"), {"content/load/files/exr_file.cpp"}},
        {"OpenImageIO", std::regex("OpenImageIO/.*"), {"content/codecs/"}},  // other image formats
    };
    const std::regex include(R"re(^\s*#\s*include\s+<([^>]+)>)re");
    std::vector<std::set<std::string>> users(packages.size());
    for (const SourceFile& source : own_sources()) {
        if (starts_with(source.path, "tests/")) {
            continue;
        }
        for (const std::string& line : source.lines) {
            std::smatch match;
            if (!std::regex_search(line, match, include)) {
                continue;
            }
            for (std::size_t i = 0; i < packages.size(); ++i) {
                if (std::regex_match(match[1].str(), packages[i].header)) {
                    users[i].insert(source.path);
                }
            }
        }
    }
    for (std::size_t i = 0; i < packages.size(); ++i) {
        INFO(packages[i].name);
        for (const std::string& place : packages[i].places) {
            const auto is_there = [&](const std::string& path) { return starts_with(path, place); };
            INFO("used nowhere in " << place);
            CHECK(std::any_of(users[i].begin(), users[i].end(), is_there));
        }
        for (const std::string& path : users[i]) {
            const auto allows = [&](const std::string& place) { return starts_with(path, place); };
            INFO(path << " is no file for it");
            CHECK(std::any_of(packages[i].places.begin(), packages[i].places.end(), allows));
        }
    }
}

TEST_CASE("house: bindings have names, in a header that shaders and C++ share") {
    const std::regex in_shaders(R"(binding = \d)");
    const std::regex in_sources(
        R"(bind_(texture|texture_name|image|storage|uniforms)\(\d|sampled\(.*, \d+[,)]|bind\([^,]*device[^,]*, \d)");
    const auto check = [&](const std::vector<SourceFile>& sources, const std::regex& number) {
        for (const SourceFile& source : sources) {
            for (std::size_t i = 0; i < source.lines.size(); ++i) {
                const std::string& line = source.lines[i];
                if (!starts_with(line, "//") && std::regex_search(line, number)) {
                    FAIL_CHECK(source.path << ":" << i + 1 << ": " << line << ", expected a name");
                }
            }
        }
    };
    check(
        files_in({"render/shaders"}, {".vert", ".tesc", ".geom", ".frag", ".comp", ".glsl"}),
        in_shaders);
    check(files_in({"render", "content"}, {".h", ".cpp"}), in_sources);
}

TEST_CASE("house: tests compare by near(), because a bare Approx passes every small number") {
    for (const SourceFile& source : own_sources()) {
        if (source.path == "tests/near.h" || source.path == "tests/house/house_test.cpp") {
            continue;
        }
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            INFO(source.path << ":" << i + 1 << ": " << source.lines[i]);
            CHECK(source.lines[i].find("Approx(") == std::string::npos);
        }
    }
}

TEST_CASE("house: no clock, no global random numbers and no printing in simulation code") {
    const std::regex forbidden(
        R"(std::chrono|\brand\s*\(|std::random_device|\btime\s*\(\s*(nullptr|NULL|0)\s*\)|std::cout|\bprintf\()");
    for (const SourceFile& source : own_sources()) {
        if (!starts_with(source.path, "systems/") && !starts_with(source.path, "ecs/components/")
            && !starts_with(source.path, "content/game/")) {
            continue;
        }
        for (std::size_t i = 0; i < source.lines.size(); ++i) {
            INFO(source.path << ":" << i + 1 << ": " << source.lines[i]);
            CHECK(!std::regex_search(source.lines[i], forbidden));
        }
    }
}

}  // namespace limn::house_test
