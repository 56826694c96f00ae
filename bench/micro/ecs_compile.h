#pragma once

#include "bench/micro/ecs_measure.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

// What including the ECS costs: the compiler's time for the smallest source file that uses it.

namespace limn::bench {

inline constexpr const char* kSmallestSource = R"(#include "ecs/world.h"

struct Position { float x = 0, y = 0, z = 0; };
struct Velocity { float x = 0, y = 0, z = 0; };

void move(limn::Query<const Velocity, Position> things) {
    things.each([](const Velocity& v, Position& p) {
        p.x += v.x;
        p.y += v.y;
        p.z += v.z;
    });
}

void run(limn::World& world) {
    world.create(Position{}, Velocity{1, 2, 3});
    world.run(move);
}
)";

inline constexpr const char* kRawSource = R"(#include <vector>

struct Position { float x = 0, y = 0, z = 0; };
struct Velocity { float x = 0, y = 0, z = 0; };

void move(const std::vector<Velocity>& velocities, std::vector<Position>& positions) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i].x += velocities[i].x;
        positions[i].y += velocities[i].y;
        positions[i].z += velocities[i].z;
    }
}
)";

inline void compile_time(Bench& bench) {
    std::error_code failed;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(failed);
    const auto compile = [&](const char* stem, const char* source) {
        const std::string path = (folder / fmt::format("{}.cpp", stem)).string();
        bench.check(write_file(path, source), "a source file to compile");
        const std::string command = fmt::format(
            "'{}' -std=c++20 -O2 -I'{}' -c '{}' -o '{}.o'", LIMN_BENCH_COMPILER, LIMN_BENCH_SOURCES,
            path, path);
        const double time =
            time_of([&] { bench.check(std::system(command.c_str()) == 0, "the compiler's work"); });
        std::filesystem::remove(path, failed);
        std::filesystem::remove(path + ".o", failed);
        return time * 1e-9;
    };
    const auto times = take_turns(
        bench.slow_repeats > 3 ? 5 : 1, [&] { return compile("limn_bench_raw", kRawSource); },
        [&] { return compile("limn_bench_smallest", kSmallestSource); });
    bench.add(
        {22,
         "compiling the smallest file; vs std::vector",
         0,
         "s",
         times[1],
         times[0],
         {},
         Figure::Plain,
         1.1,
         ""});
}

}  // namespace limn::bench
