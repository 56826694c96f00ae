#include "ecs/base/rng.h"
#include "ecs/components/all.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

namespace schedule_test {

using namespace limn;

struct A {
    float value = 0;
};
struct B {
    float value = 0;
};
struct C {
    float value = 0;
};
struct Trace {
    std::vector<int> steps;
};
struct Count {
    int value = 0;
};
struct Born {};

void write_a(Query<A> as) {
    as.each([](A& a) { a.value += 1; });
}
void write_b(Query<B> bs) {
    bs.each([](B& b) { b.value += 1; });
}
void read_a_write_b(Query<const A, B> pairs) {
    pairs.each([](const A& a, B& b) { b.value = a.value * 2; });
}
void read_a_write_c(Query<const A, C> pairs) {
    pairs.each([](const A& a, C& c) { c.value = a.value * 3; });
}
void read_bc_write_a(Query<const B, const C, A> all) {
    all.each([](const B& b, const C& c, A& a) { a.value = b.value + c.value; });
}
void add_entity(Commands commands) {
    commands.create(Born{});
}
void count_born(Query<With<Born>> born, Res<Count> count) {
    count->value = static_cast<int>(born.count());
}
void count_alone(World& world) {
    world.resource<Count>().value = static_cast<int>(world.query<With<Born>>().count());
}

template <int number>
void trace(Res<Trace> trace) {
    trace->steps.push_back(number);
}
template <int number>
void nothing(Query<const A> as) {
    static_cast<void>(as);
}

/// Restores the number of threads.
struct ThreadCountGuard {
    int before = thread_count();
    ~ThreadCountGuard() { set_thread_count(before); }
};

// A small world where everything happens: parallel loops, random numbers, births and deaths.

struct Mass {
    float value = 1;
};
struct Position {
    float x = 0;
    float y = 0;
};
struct Velocity {
    float x = 0;
    float y = 0;
};
struct Age {
    std::uint32_t frames = 0;
};
struct Frame {
    std::uint64_t number = 0;
};

void accelerate(Query<Velocity, const Mass> bodies, Res<const Frame> frame) {
    bodies.par_each([&](Entity entity, Velocity& v, const Mass& mass) {
        Random random(1, entity.bits(), name_hash("accelerate"), frame->number);
        v.x += random.uniform(-1, 1) / mass.value;
        v.y += random.uniform(-1, 1) / mass.value;
    });
}
void grow_old(Query<Age> ages) {
    ages.par_each([](Age& age) { ++age.frames; });
}
void move(Query<Position, const Velocity> bodies) {
    bodies.par_chunks([](ChunkView, std::span<Position> p, std::span<const Velocity> v) {
        for (std::size_t i = 0; i < p.size(); ++i) {
            p[i].x += v[i].x * 0.016f;
            p[i].y += v[i].y * 0.016f;
        }
    });
}
void give_birth(Query<const Age, const Position> all, Commands commands) {
    all.par_each([&](Entity entity, const Age& age, const Position& p) {
        if ((age.frames + entity.index) % 97 == 5) {
            commands.create(Position{p.x, p.y}, Velocity{1, 2}, Age{entity.index % 13});
        }
    });
}
void die(Query<const Age> all, Commands commands) {
    all.par_each([&](Entity entity, const Age& age) {
        if (age.frames > 40 + entity.index % 7) {
            commands.destroy(entity);
        } else if (age.frames == 20) {
            commands.add(entity, Mass{static_cast<float>(entity.index % 5 + 1)});
        } else if (age.frames == 30) {
            commands.remove<Mass>(entity);
        }
    });
}
void next_frame(Res<Frame> frame) {
    ++frame->number;
}

/// Hashes of the state after each frame.
std::vector<std::uint64_t> history(int threads, bool always_parallel) {
    const ThreadCountGuard guard;
    set_thread_count(threads);
    World world;
    world.insert_resource(Frame{});
    for (int i = 0; i < 5000; ++i) {
        const auto f = static_cast<float>(i);
        const Position position{f, -f};
        if (i % 3 == 0) {
            world.create(
                position, Velocity{}, Mass{1 + f / 1000}, Age{static_cast<std::uint32_t>(i) % 40});
        } else {
            world.create(position, Velocity{f / 100, 1}, Age{static_cast<std::uint32_t>(i) % 40});
        }
    }
    Schedule schedule;
    schedule.set_always_parallel(always_parallel);
    schedule.add<accelerate>()
        .add<grow_old>()
        .add<move>()
        .add<give_birth>()
        .sync()
        .add<die>()
        .add<next_frame>();
    std::vector<std::uint64_t> hashes;
    for (int frame = 0; frame < 60; ++frame) {
        schedule.run(world);
        hashes.push_back(state_hash(world));
    }
    return hashes;
}

}  // namespace schedule_test

using namespace limn;
using namespace schedule_test;

TEST_CASE("schedule: each system sees the writes of earlier systems, and none of later ones") {
    const ThreadCountGuard guard;
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        World world;
        const Entity entity = world.create(A{}, B{}, C{});
        Schedule schedule;
        schedule.set_always_parallel(true);
        schedule.add<write_a>().add<read_a_write_b>().add<read_a_write_c>().add<read_bc_write_a>();
        schedule.run(world);
        CHECK(world.get<const B>(entity).value == 2);
        CHECK(world.get<const C>(entity).value == 3);
        CHECK(world.get<const A>(entity).value == 5);
        schedule.run(world);
        CHECK(world.get<const A>(entity).value == 30);
    }
}

TEST_CASE("schedule: systems that write the same resource run in the order of the list") {
    const ThreadCountGuard guard;
    set_thread_count(7);
    World world;
    world.insert_resource(Trace{});
    Schedule schedule;
    schedule.set_always_parallel(true);
    schedule.add<trace<1>>().add<nothing<1>>().add<trace<2>>().add<nothing<2>>().add<trace<3>>();
    for (int i = 0; i < 50; ++i) {
        world.resource<Trace>().steps.clear();
        schedule.run(world);
        CHECK(world.resource<Trace>().steps == std::vector<int>{1, 2, 3});
    }
}

TEST_CASE("schedule: systems with disjoint accesses run at the same time") {
    const ThreadCountGuard guard;
    set_thread_count(2);
    World world;
    std::atomic<int> inside = 0;
    const auto meet = [&inside] {
        ++inside;
        while (inside < 2) {  // hangs if they run one after the other
            std::this_thread::yield();
        }
    };
    Schedule schedule;
    schedule.set_always_parallel(true);
    schedule.add("first", [&](Query<A>) { meet(); });
    schedule.add("second", [&](Query<B>) { meet(); });
    schedule.run(world);
    CHECK(inside == 2);
}

TEST_CASE("schedule: systems that conflict never run at the same time") {
    const ThreadCountGuard guard;
    set_thread_count(4);
    World world;
    std::atomic<int> inside = 0;
    std::atomic<int> most = 0;
    const auto busy = [&] {
        const int now = ++inside;
        if (now > most) {
            most = now;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        --inside;
    };
    Schedule schedule;
    schedule.set_always_parallel(true);
    schedule.add("writes", [&](Query<A>) { busy(); });
    schedule.add("reads", [&](Query<const A>) { busy(); });
    schedule.add("writes again", [&](Query<A>) { busy(); });
    schedule.add("reads all", [&](const World&) { busy(); });
    schedule.add("alone", [&](World&) { busy(); });
    for (int i = 0; i < 5; ++i) {
        schedule.run(world);
    }
    CHECK(most == 1);
}

TEST_CASE("schedule: commands wait for a sync point, for an exclusive system or for the end") {
    World world;
    world.insert_resource(Count{});
    SUBCASE("not before") {
        Schedule schedule;
        schedule.add<add_entity>().add<count_born>();
        schedule.run(world);
        CHECK(world.resource<Count>().value == 0);
        CHECK(world.query<With<Born>>().count() == 1);  // at the end
        schedule.run(world);
        CHECK(world.resource<Count>().value == 1);
    }
    SUBCASE("sync") {
        Schedule schedule;
        schedule.add<add_entity>().sync().add<count_born>();
        schedule.run(world);
        CHECK(world.resource<Count>().value == 1);
    }
    SUBCASE("exclusive") {
        Schedule schedule;
        schedule.add<add_entity>().add<count_alone>();
        schedule.run(world);
        CHECK(world.resource<Count>().value == 1);
    }
}

TEST_CASE("schedule: the state has the same history for any number of threads") {
    const std::vector<std::uint64_t> expected = history(1, false);
    CHECK(expected.front() != expected.back());
    for (const int threads : {1, 2, 3, 7, 16}) {
        CAPTURE(threads);
        CHECK(history(threads, true) == expected);
    }
    CHECK(history(2, false) == expected);
}

TEST_CASE("schedule: it prints systems, access, order and times as text") {
    World world;
    Schedule schedule;
    schedule.add<write_a>()
        .add<write_b>()
        .add<read_a_write_b>()
        .add<add_entity>()
        .add<count_alone>();
    const std::string text = schedule.to_text();
    CHECK(text.find("stage 1\n  write_a") != std::string::npos);
    CHECK(text.find("reads a  writes b  after write_a, write_b") != std::string::npos);
    CHECK(text.find("commands") != std::string::npos);
    CHECK(text.find("stage 2\n  count_alone") != std::string::npos);
    CHECK(text.find("exclusive") != std::string::npos);
    CHECK(text.find("mean") == std::string::npos);
    world.insert_resource(Count{});
    schedule.run(world);
    CHECK(schedule.to_text().find("mean") != std::string::npos);
}

TEST_CASE("schedule: it prints itself for Graphviz, without transitive arrows") {
    Schedule schedule;
    schedule.add<write_a>()
        .add<read_a_write_b>()
        .add<read_a_write_c>()
        .add<read_bc_write_a>()
        .sync()
        .add<write_a>();
    const std::string dot = schedule.to_dot();
    CHECK(dot.starts_with("digraph schedule {"));
    CHECK(dot.find("s0 [label=\"write_a\"]") != std::string::npos);
    CHECK(dot.find("s0 -> s1") != std::string::npos);
    CHECK(dot.find("s0 -> s2") != std::string::npos);
    CHECK(dot.find("s1 -> s2") == std::string::npos);
    CHECK(dot.find("s1 -> s3") != std::string::npos);
    CHECK(dot.find("s2 -> s3") != std::string::npos);
    CHECK(dot.find("s0 -> s3") == std::string::npos);  // through s1
    CHECK(dot.find("s3 -> s4 [style=dashed") != std::string::npos);
}

TEST_CASE("schedule: every system is timed") {
    World world;
    Schedule schedule;
    schedule.add(
        "slow", [](Query<A>) { std::this_thread::sleep_for(std::chrono::milliseconds(2)); });
    schedule.add<write_b>();
    schedule.run(world);
    schedule.run(world);
    REQUIRE(schedule.timings().size() == 2);
    CHECK(schedule.timings()[0].name == "slow");
    CHECK(schedule.timings()[0].runs == 2);
    CHECK(schedule.timings()[0].last >= 0.002);
    CHECK(schedule.timings()[0].mean >= 0.002);
    CHECK(schedule.timings()[1].name == "write_b");
    CHECK(schedule.timings()[1].last < schedule.timings()[0].last);
    schedule.reset_timings();
    CHECK(schedule.timings()[0].runs == 0);
}

TEST_CASE("schedule: no time is counted for two systems") {
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
    World world;
    Schedule schedule;
    schedule.add("first", [&](Query<A>) { wait(); });
    schedule.add("second", [&](Query<A>) { wait(); });
    schedule.add("third", [&](Query<A>) { wait(); });
    const auto start = std::chrono::steady_clock::now();
    schedule.run(world);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    double sum = 0;
    for (const SystemTiming& timing : schedule.timings()) {
        CHECK(timing.last >= 0.001);
        sum += timing.last;
    }
    CHECK(sum <= whole.count());
}

TEST_CASE("schedule: a system changes nothing in the world except what it wrote") {
    // Changed sees the writes of the systems before, once.
    World world;
    world.create(A{}, B{});
    int changed = 0;
    int frame = 0;
    Schedule schedule;
    schedule.add("write every other time", [&](Query<A> as) {
        if (frame % 2 == 0) {
            as.each([](A& a) { a.value += 1; });
        }
    });
    schedule.add("count changed", [&](Query<const A, Changed<A>> as) {
        changed += static_cast<int>(as.count());
    });
    for (frame = 0; frame < 6; ++frame) {
        schedule.run(world);
    }
    CHECK(changed == 3);
}

TEST_CASE("schedule: an empty one runs, and a system may be added between runs") {
    World world;
    world.insert_resource(Trace{});
    Schedule schedule;
    schedule.run(world);
    CHECK(schedule.size() == 0);
    schedule.add<trace<1>>();
    schedule.run(world);
    schedule.add<trace<2>>();
    schedule.run(world);
    CHECK(world.resource<Trace>().steps == std::vector<int>{1, 1, 2});
    Schedule moved = std::move(schedule);
    moved.run(world);
    CHECK(world.resource<Trace>().steps.size() == 5);
}
