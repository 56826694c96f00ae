// Wrong uses of the API, one a file in tests/ecs/compile_errors, and what the compiler must say
// first about each: the first line of the file. A file that begins with "// compiles" must.

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Snippet {
    fs::path path;
    std::string expected;  ///< empty: it compiles
    std::string found;     ///< first line with an error, or a warning
    bool compiled = false;
};

std::vector<Snippet> read_snippets() {
    const std::string mark = "// expects: ";
    std::vector<Snippet> snippets;
    for (const auto& entry :
         fs::directory_iterator(fs::path(LIMN_SOURCE_DIR) / "tests/ecs/compile_errors")) {
        if (entry.path().extension() != ".cpp") {
            continue;
        }
        std::ifstream file(entry.path());
        std::string first;
        std::getline(file, first);
        INFO(entry.path().string() << " begins with " << first);
        REQUIRE((first.rfind(mark, 0) == 0 || first == "// compiles"));
        snippets.push_back(
            {entry.path(), first == "// compiles" ? "" : first.substr(mark.size()), {}, false});
    }
    std::sort(snippets.begin(), snippets.end(), [](const Snippet& a, const Snippet& b) {
        return a.path < b.path;
    });
    return snippets;
}

fs::path work_folder() {
    return fs::path(LIMN_BUILD_DIR) / "compile_errors";
}

/// Runs the compiler; what it says goes to `said`.
bool run_compiler(const std::string& arguments, const fs::path& said) {
    const std::string command = "LC_ALL=C '" LIMN_CXX
                                "' -std=c++20 -Wall -Wextra -I '" LIMN_SOURCE_DIR "' "
                                + arguments + " > '" + said.string() + "' 2>&1";
    return std::system(command.c_str()) == 0;
}

/// What all snippets include, compiled once: four times as fast.
void precompile_headers() {
    fs::remove_all(work_folder());
    fs::create_directories(work_folder());
    const std::string header = (work_folder() / "all.h").string();
    std::ofstream(header) << "#include \"ecs/schedule.h\"\n#include \"ecs/world.h\"\n"
                             "#include \"tests/ecs/compile_errors/parts.h\"\n";
#if defined(__clang__)
    const std::string compiled = header + ".pch";
#else
    const std::string compiled = header + ".gch";
#endif
    REQUIRE(run_compiler(
        "-x c++-header '" + header + "' -o '" + compiled + "'", work_folder() / "all.txt"));
}

void compile(Snippet& snippet) {
    const fs::path said = work_folder() / (snippet.path.stem().string() + ".txt");
    snippet.compiled = run_compiler(
        "-include '" + (work_folder() / "all.h").string() + "' -fsyntax-only '"
            + snippet.path.string() + "'",
        said);
    std::ifstream file(said);
    for (std::string line; std::getline(file, line);) {
        if (line.find(" error: ") != std::string::npos
            || (snippet.compiled && line.find(" warning: ") != std::string::npos)) {
            snippet.found = line;
            return;
        }
    }
}

}  // namespace

TEST_CASE("compile errors: the first line says what is wrong") {
    std::vector<Snippet> snippets = read_snippets();
    precompile_headers();
    std::atomic<std::size_t> next = 0;
    const auto work = [&] {
        for (std::size_t i = next++; i < snippets.size(); i = next++) {
            compile(snippets[i]);
        }
    };
    std::thread second(work);
    work();
    second.join();

    CHECK(snippets.size() > 30);
    for (const Snippet& snippet : snippets) {
        INFO(snippet.path.filename().string() << ": " << snippet.found);
        CHECK(snippet.compiled == snippet.expected.empty());
        CHECK(snippet.found.empty() == snippet.expected.empty());
        CHECK(snippet.found.find(snippet.expected) != std::string::npos);
    }
}
