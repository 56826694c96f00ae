#include "ecs/column.h"
#include "ecs/world.h"
#include "tests/ecs/test_components.h"

#include <doctest/doctest.h>

#include <array>
#include <cstring>
#include <set>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

using namespace limn;
using namespace limn::test;

namespace {

constexpr std::size_t cell_align(std::size_t number) {
    constexpr std::size_t kAligns[] = {1, 8, 4, 32, 2, 16, 64, 256};
    return number == 41 ? 4096 : number == 26 ? 1024 : kAligns[number % 8];
}

/// 64 types of different sizes and alignments.
template <std::size_t number>
struct alignas(cell_align(number)) Cell {
    unsigned char bytes[1 + number * 5 % 43] = {};
};

template <std::size_t... N>
std::vector<ComponentId> cell_ids(std::index_sequence<N...>) {
    return {component_id<Cell<N>>...};
}

bool is_aligned(const void* address, std::size_t alignment) {
    return reinterpret_cast<std::uintptr_t>(address) % alignment == 0;
}

bool all_are(const std::byte* bytes, std::size_t count, int value) {
    return count == 0
           || (bytes[0] == static_cast<std::byte>(value)
               && std::memcmp(bytes, bytes + 1, count - 1) == 0);
}

/// Whether all columns are aligned and their padding can be written without changing another
/// column's rows or padding.
bool has_sound_columns(World& world, Archetype& rows) {
    const std::uint32_t size = rows.size();
    const std::uint32_t padding = (size + 15) / 16 * 16 - size;
    bool sound = size + padding <= rows.capacity();
    const auto columns = rows.columns();
    for (std::size_t i = 0; i < columns.size(); ++i) {
        sound = sound && is_aligned(columns[i].data, 64)
                && is_aligned(columns[i].data, columns[i].info->align);
        std::memset(columns[i].data, static_cast<int>(i + 1), std::size_t{size} * columns[i].size);
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        std::memset(
            columns[i].at(size), static_cast<int>(i + 101), std::size_t{padding} * columns[i].size);
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const Column& column = columns[i];
        const int value = static_cast<int>(i);
        sound = sound && all_are(column.data, std::size_t{size} * column.size, value + 1)
                && all_are(column.at(size), std::size_t{padding} * column.size, value + 101);
    }
    for (std::uint32_t row = 0; row < size; ++row) {
        sound = sound && world.alive(rows.entities()[row]);
    }
    return sound;
}

#ifndef LIMN_SANITIZED  // sanitizers themselves reserve terabytes
/// Entities of several archetypes, beyond what fits a shared block, are there with their values.
bool holds_a_hundred_thousand() {
    World world;
    for (std::uint32_t i = 0; i < 25000; ++i) {
        world.create(Mass{static_cast<double>(i)});
        world.create(Mass{static_cast<double>(i)}, Cell<1>{});
        world.create(Mass{static_cast<double>(i)}, Cell<2>{});
        world.create(Mass{static_cast<double>(i)}, Cell<1>{}, Cell<2>{}, Cell<3>{});
    }
    double sum = 0;
    world.query<const Mass>().each([&](const Mass& mass) { sum += mass.value; });
    return sum == 4 * 24999.0 * 25000 / 2;
}
#endif

}  // namespace

TEST_CASE("column: a range keeps its base and its contents while it grows") {
    for (const std::size_t expected : {std::size_t{0}, std::size_t{4} << 20}) {
        VirtualRange range(std::size_t{1} << 30, skew_of(3), expected);
        range.commit(1);
        std::byte* base = range.data();
        base[0] = std::byte{7};
        std::size_t before = range.usable();
        for (std::size_t bytes = 1; bytes <= (std::size_t{1} << 25); bytes *= 3) {
            range.commit(bytes);
            CHECK(range.usable() >= bytes);
            CHECK(range.usable() >= before);
            CHECK(range.data()[range.usable() - 1] == std::byte{0});
            before = range.usable();
        }
        CHECK(range.data() == base);
        CHECK(base[0] == std::byte{7});
    }
}

TEST_CASE("column: a range commits little at first and never much more than requested") {
    VirtualRange range(std::size_t{1} << 30, skew_of(2));
    range.commit(1);
    CHECK(range.usable() >= 64 * 1024);
    CHECK(range.committed() < 72 * 1024);
    for (std::size_t bytes = 64 << 10; bytes <= (256 << 10); bytes += 10'000) {
        range.commit(bytes);
        CHECK(range.committed() < 2 * bytes + 8192);
    }
    for (std::size_t bytes = 1 << 20; bytes <= (std::size_t{1} << 27); bytes += 12'345'678) {
        range.commit(bytes);
        CHECK(range.committed() < bytes + (std::size_t{2} << 20) + 8192);
    }
}

TEST_CASE("column: a range that is large at once wastes little but its skew") {
    constexpr std::size_t kBytes = 12'000'000;
    VirtualRange range(std::size_t{1} << 30, skew_of(7), kBytes);
    range.commit(kBytes);
    CHECK(range.usable() >= kBytes);
    CHECK(range.committed() < kBytes + kSkewRange + (64 << 10) + 4096);
}

TEST_CASE("column: skews differ for all positions in use, also within the lines of a page") {
    std::set<std::size_t> skews;
    for (std::size_t position = 0; position < 4096; ++position) {
        CHECK(skew_of(position) < kSkewRange);
        CHECK(skew_of(position) % 64 == 0);
        CHECK(skew_of(position, 4096) % 4096 == 0);
        CHECK(skew_of(position) % 4096 != skew_of(position + 1) % 4096);
        skews.insert(skew_of(position));
    }
    CHECK(skews.size() == 4096);
    VirtualRange range(1 << 20, skew_of(5));
    CHECK(reinterpret_cast<std::uintptr_t>(range.data()) % kSkewRange == skew_of(5));
}

TEST_CASE("column: a moved range has one owner") {
    VirtualRange a(4096);
    a.commit(10);
    VirtualRange b(std::move(a));
    CHECK(a.data() == nullptr);
    CHECK(b.data() != nullptr);
    a = std::move(b);
    CHECK(b.reserved() == 0);
    a.data()[9] = std::byte{1};
}

TEST_CASE("column: the pool reuses freed blocks and counts those in use") {
    BlockPool pool;
    std::byte* small = pool.allocate(4096);
    std::byte* large = pool.allocate(65536);
    CHECK(small != large);
    CHECK(is_aligned(large, 4096));
    CHECK(pool.used() == 4096 + 65536);
    pool.free(small, 4096);
    CHECK(pool.used() == 65536);
    CHECK(pool.allocate(4096) == small);
}

TEST_CASE("column: every table of 1 to 64 columns is aligned and padded, in blocks and in ranges") {
    const std::vector<ComponentId> ids = cell_ids(std::make_index_sequence<64>());
    for (const std::uint32_t count : {1u, 15u, 16u, 17u, 100u, 1023u, 1024u, 1025u, 2047u}) {
        World world;
        std::vector<Entity> entities;
        for (std::uint32_t i = 0; i < count; ++i) {
            entities.push_back(world.create());
        }
        for (std::size_t width = 1; width <= ids.size(); ++width) {
            for (const Entity entity : entities) {
                world.add(entity, ids[width - 1]);
            }
            Archetype& rows = *world.core().archetypes.back();
            REQUIRE(rows.columns().size() == width);
            REQUIRE(rows.size() == count);
            CHECK(has_sound_columns(world, rows));
        }
    }
}

TEST_CASE("column: tables around multiples of 1024 rows are aligned and padded") {
    for (const std::uint32_t k : {1u, 2u, 5u}) {
        for (const std::uint32_t count : {k * 1024 - 1, k * 1024, k * 1024 + 1}) {
            World world;
            world.create_many(count, Cell<3>{}, Cell<7>{}, Cell<8>{}, Cell<20>{}, Cell<31>{});
            Archetype& rows = *world.core().archetypes.back();
            CHECK(rows.is_promoted());
            CHECK(rows.chunk_count() == (count + 1023) / 1024);
            CHECK(has_sound_columns(world, rows));
            world.create(Cell<3>{}, Cell<7>{}, Cell<8>{}, Cell<20>{}, Cell<31>{});
            CHECK(has_sound_columns(world, rows));
        }
    }
}

TEST_CASE(
    "column: small archetypes share the pool, large ones are promoted once and stay promoted") {
    World world;
    world.create(Position{}, Velocity{});
    Archetype& rows = *world.core().archetypes.back();
    CHECK_FALSE(rows.is_promoted());
    world.create_many(1024, Position{}, Velocity{});
    CHECK(rows.is_promoted());
    const std::byte* base = rows.columns()[0].data;
    world.create_many(200'000, Position{}, Velocity{});
    CHECK(rows.columns()[0].data == base);
    world.clear();
    world.create_many(10, Position{}, Velocity{});
    CHECK(rows.columns()[0].data == base);
}

TEST_CASE("column: values survive every growth, those that own memory too") {
    World world;
    std::vector<Entity> entities;
    for (int i = 0; i < 3000; ++i) {
        entities.push_back(world.create(
            Label{std::to_string(i), {i}}, Wide{}, Position{static_cast<float>(i), 0, 0}));
    }
    for (int i = 0; i < 3000; ++i) {
        const Entity entity = entities[static_cast<std::size_t>(i)];
        REQUIRE(world.get<Label>(entity).text == std::to_string(i));
        REQUIRE(world.get<Label>(entity).numbers == std::vector<int>{i});
        REQUIRE(world.get<Position>(entity).x == static_cast<float>(i));
        REQUIRE(is_aligned(&world.get<Wide>(entity), 128));
    }
}

TEST_CASE("column: a component larger than a block has its own columns from the first row") {
    struct Huge {
        std::array<unsigned char, 100'000> bytes{};
    };
    World world;
    const Entity entity = world.create(Huge{});
    world.get<Huge>(entity).bytes[99'999] = 3;
    CHECK(world.core().archetypes.back()->is_promoted());
    CHECK(world.get<Huge>(entity).bytes[99'999] == 3);
}

TEST_CASE("column: memory that a range has released is zero when reused, the rest is kept") {
    for (const std::size_t expected : {std::size_t{0}, std::size_t{8} << 20}) {
        VirtualRange range(std::size_t{1} << 30, skew_of(9), expected);
        range.commit(std::size_t{8} << 20);
        std::memset(range.data(), 7, range.usable());
        range.shrink(100'000);
        CHECK(range.usable() >= 100'000);
        CHECK(range.committed() < 100'000 + kSkewRange + 4096);
        CHECK(range.data()[99'999] == std::byte{7});
        range.commit(std::size_t{8} << 20);
        CHECK(range.data()[99'999] == std::byte{7});
        CHECK(range.data()[(std::size_t{8} << 20) - 1] == std::byte{0});
        range.shrink(0);
        CHECK(range.committed() == 0);
        range.commit(1);
        CHECK(range.data()[0] == std::byte{0});
    }
}

TEST_CASE("column: the pool releases memory beyond the last block in use") {
    BlockPool pool;
    std::vector<std::byte*> blocks;
    for (int i = 0; i < 20; ++i) {
        blocks.push_back(pool.allocate(65536));
    }
    const std::size_t all = pool.committed();
    for (int i = 5; i < 20; ++i) {
        pool.free(blocks[static_cast<std::size_t>(i)], 65536);
    }
    pool.shrink();
    CHECK(pool.committed() <= all - std::size_t{14} * 65536);
    CHECK(pool.committed() >= std::size_t{5} * 65536);
    blocks[4][65535] = std::byte{1};
    CHECK(pool.allocate(65536) == blocks[5]);
    blocks[5][65535] = std::byte{1};
}

#ifndef LIMN_SANITIZED
TEST_CASE("column: where address space is limited, ranges are smaller") {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        const rlimit limit = {rlim_t{1} << 30, rlim_t{1} << 30};
        const bool held = setrlimit(RLIMIT_AS, &limit) == 0 && holds_a_hundred_thousand();
        _exit(held ? 0 : 1);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
}
#endif
