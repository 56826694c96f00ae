#include "ecs/base/jobs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <mutex>
#include <numeric>
#include <set>
#include <thread>
#include <utility>

using namespace limn;

namespace {

constexpr int kThreadCounts[] = {1, 2, 3, 7, 16};

/// Sets the number of threads back at the end of a test.
struct ThreadCountGuard {
    int before = thread_count();
    ~ThreadCountGuard() { set_thread_count(before); }
};

}  // namespace

TEST_CASE("jobs: every index is visited once, whatever count, grain and number of threads") {
    const ThreadCountGuard guard;
    for (const int threads : kThreadCounts) {
        set_thread_count(threads);
        CHECK(thread_count() == threads);
        for (const std::size_t count : {0u, 1u, 9u, 10u, 11u, 1000u}) {
            for (const std::size_t grain : {1u, 10u, 4096u}) {
                std::vector<int> visits(count);
                parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i) {
                        ++visits[i];
                    }
                });
                CHECK(visits == std::vector<int>(count, 1));
            }
        }
    }
}

TEST_CASE("jobs: ranges begin at multiples of the grain for any number of threads") {
    const ThreadCountGuard guard;
    for (const int threads : kThreadCounts) {
        set_thread_count(threads);
        std::mutex mutex;
        std::set<std::pair<std::size_t, std::size_t>> ranges;
        parallel_for(25, 10, [&](std::size_t begin, std::size_t end) {
            const std::lock_guard lock(mutex);
            ranges.emplace(begin, end);
        });
        CHECK(ranges == std::set<std::pair<std::size_t, std::size_t>>{{0, 10}, {10, 20}, {20, 25}});
    }
}

TEST_CASE("jobs: a sum of partial sums has the same bits for any number of threads") {
    const ThreadCountGuard guard;
    std::vector<float> results;
    for (const int threads : kThreadCounts) {
        set_thread_count(threads);
        std::vector<float> partial(100);
        parallel_for(100'000, 1000, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                partial[begin / 1000] += std::sin(static_cast<float>(i));
            }
        });
        float sum = 0;
        for (const float x : partial) {
            sum += x;
        }
        results.push_back(sum);
    }
    for (const float result : results) {
        CHECK(std::memcmp(&result, &results.front(), sizeof result) == 0);
    }
}

TEST_CASE("jobs: several threads work at the same time") {
    const ThreadCountGuard guard;
    set_thread_count(4);
    std::atomic<int> arrived = 0;
    parallel_for(4, 1, [&](std::size_t, std::size_t) {
        ++arrived;
        while (arrived < 4) {  // would hang if one thread ran them one after another
            std::this_thread::yield();
        }
    });
    CHECK(arrived == 4);
}

TEST_CASE("jobs: a job may start other jobs") {
    const ThreadCountGuard guard;
    for (const int threads : kThreadCounts) {
        set_thread_count(threads);
        std::vector<int> visits(1000);
        parallel_for(10, 1, [&](std::size_t outer, std::size_t) {
            parallel_for(100, 7, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    ++visits[outer * 100 + i];
                }
            });
        });
        CHECK(visits == std::vector<int>(1000, 1));
    }
}

TEST_CASE("jobs: a task graph runs every task once and after those it waits for") {
    const ThreadCountGuard guard;
    TaskGraph graph;
    std::vector<std::vector<std::size_t>> predecessors;
    for (std::size_t i = 0; i < 200; ++i) {
        std::vector<std::size_t> before;
        for (const std::size_t distance : std::vector<std::size_t>{1 + i % 3, 7, 31}) {
            if (distance <= i && (i % 5 != 0)) {
                before.push_back(i - distance);
            }
        }
        CHECK(graph.add(before) == i);
        predecessors.push_back(before);
    }
    for (const int threads : kThreadCounts) {
        set_thread_count(threads);
        for (int repeat = 0; repeat < 20; ++repeat) {
            std::vector<int> runs(graph.size());  // plain ints: a missing order is a data race
            std::atomic<int> early = 0;
            run_task_graph(graph, [&](std::size_t task) {
                for (const std::size_t before : predecessors[task]) {
                    early += runs[before] == 1 ? 0 : 1;
                }
                ++runs[task];
            });
            CHECK(early == 0);
            CHECK(runs == std::vector<int>(graph.size(), 1));
        }
    }
}

TEST_CASE(
    "jobs: shuffled, everything runs once and in another order, tasks after those they wait for") {
    const ThreadCountGuard guard;
    TaskGraph graph;
    for (std::size_t i = 0; i < 40; ++i) {
        graph.add(i % 4 == 3 ? std::vector<std::size_t>{i - 3, i - 1} : std::vector<std::size_t>{});
    }
    for (const int threads : {1, 4}) {
        set_thread_count(threads);
        set_task_shuffle(20'261);
        std::mutex mutex;
        std::vector<std::size_t> ranges;
        parallel_for(40, 1, [&](std::size_t begin, std::size_t) {
            const std::lock_guard lock(mutex);
            ranges.push_back(begin);
        });
        std::vector<std::size_t> tasks;
        run_task_graph(graph, [&](std::size_t task) {
            const std::lock_guard lock(mutex);
            tasks.push_back(task);
        });
        set_task_shuffle(0);

        for (std::vector<std::size_t>* const order : {&ranges, &tasks}) {
            REQUIRE(order->size() == 40);
            CHECK_FALSE(std::is_sorted(order->begin(), order->end()));
        }
        std::vector<std::size_t> place(40);
        for (std::size_t i = 0; i < 40; ++i) {
            place[tasks[i]] = i;
        }
        for (std::size_t i = 3; i < 40; i += 4) {
            CHECK(place[i] > place[i - 3]);
            CHECK(place[i] > place[i - 1]);
        }
        std::sort(ranges.begin(), ranges.end());
        std::sort(tasks.begin(), tasks.end());
        std::vector<std::size_t> all(40);
        std::iota(all.begin(), all.end(), std::size_t{0});
        CHECK(ranges == all);
        CHECK(tasks == all);
    }
}

TEST_CASE("jobs: an impossible number of threads becomes the nearest possible one") {
    const ThreadCountGuard guard;
    set_thread_count(0);
    CHECK(thread_count() == 1);
    set_thread_count(100'000);
    CHECK(thread_count() == 256);
}
