// The page that explains the library, held to its word: program, build file and output are taken
// from ecs/README.md itself.

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

namespace fs = std::filesystem;

std::string read_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The first block of the page in that language.
std::string block_of(const std::string& page, const std::string& language) {
    const std::string opening = "\n```" + language + "\n";
    const std::size_t begin = page.find(opening);
    REQUIRE(begin != std::string::npos);
    const std::size_t first = begin + opening.size();
    return page.substr(first, page.find("```", first) - first);
}

std::string quoted(const fs::path& path) {
    return "'" + path.string() + "'";
}

/// Runs a command of the shell; what it printed is in `log` if it fails.
void run(const std::string& command, const fs::path& log) {
    const int status = std::system((command + " > " + quoted(log) + " 2>&1").c_str());
    INFO(command << "\n" << read_file(log));
    REQUIRE(status == 0);
}

}  // namespace

TEST_CASE("readme: the example of the page builds against the installed library and prints what "
          "stands there") {
    const std::string page = read_file(fs::path(LIMN_SOURCE_DIR) / "ecs/README.md");
    const fs::path folder = fs::path(LIMN_BUILD_DIR) / "readme_example";
    fs::remove_all(folder);
    fs::create_directories(folder);
    std::ofstream(folder / "main.cpp") << block_of(page, "cpp");
    std::ofstream(folder / "CMakeLists.txt") << block_of(page, "cmake");

    const fs::path log = folder / "log.txt";
    const std::string cmake = quoted(LIMN_CMAKE);
    const fs::path prefix = folder / "installed";
    run(cmake + " --install " + quoted(LIMN_BUILD_DIR) + " --prefix " + quoted(prefix), log);
    CHECK_FALSE(fs::exists(prefix / "include/limn/ecs/base/math.h"));

    const fs::path build = folder / "build";
    run(cmake + " -S " + quoted(folder) + " -B " + quoted(build) + " -DCMAKE_BUILD_TYPE=Release"
            + " -DCMAKE_CXX_COMPILER=" + quoted(LIMN_CXX)
            + " -DCMAKE_PREFIX_PATH=" + quoted(prefix),
        log);
    run(cmake + " --build " + quoted(build), log);
    run(quoted(build / "fireworks"), log);
    CHECK(read_file(log) == block_of(page, "text"));
}

TEST_CASE("readme: the ECS alone is configured without the packages of the engine") {
    const fs::path build = fs::path(LIMN_BUILD_DIR) / "ecs_only";
    fs::remove_all(build);
    std::string command = quoted(LIMN_CMAKE) + " -S " + quoted(LIMN_SOURCE_DIR) + " -B "
                          + quoted(build) + " -DLIMN_ECS_ONLY=ON"
                          + " -DCMAKE_CXX_COMPILER=" + quoted(LIMN_CXX);
    for (const char* package : {"fmt", "spdlog", "PkgConfig", "hwy", "glfw3", "doctest"}) {
        command += std::string(" -DCMAKE_DISABLE_FIND_PACKAGE_") + package + "=ON";
    }
    run(command, fs::path(LIMN_BUILD_DIR) / "ecs_only.txt");
}
