#include "ecs/base/jobs.h"

#include "ecs/base/check.h"
#include "ecs/base/hash.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#if defined(LIMN_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libtbb.so\n";  // its internal synchronization
}
#endif

namespace limn {

namespace {

constexpr int kMaxThreads = 256;

/// The thread pool. Created on first use and recreated when the thread count changes.
struct Workers {
    int count;
    tbb::global_control limit;
    tbb::task_arena arena;

    explicit Workers(int threads)
        : count(threads),
          limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)),
          arena(threads) {}
};

std::unique_ptr<Workers>& workers_slot() {
    static std::unique_ptr<Workers> slot =
        std::make_unique<Workers>(std::clamp(tbb::info::default_concurrency(), 1, kMaxThreads));
    return slot;
}

Workers& workers() {
    return *workers_slot();
}

// ---- shuffling, for tests
// ------------------------------------------------------------------------

std::atomic<std::uint64_t> task_shuffle = 0;  // seed; 0: off
std::atomic<std::uint64_t> shuffles = 0;      // done since set_task_shuffle

bool is_shuffled() {
    return task_shuffle.load(std::memory_order_relaxed) != 0;
}

/// Permutes `indices` depending on the seed and on the number of previous shuffles.
void shuffle(std::vector<std::size_t>& indices) {
    std::uint64_t state = hash_combine(
        task_shuffle.load(std::memory_order_relaxed),
        shuffles.fetch_add(1, std::memory_order_relaxed));
    for (std::size_t left = indices.size(); left > 1; --left) {
        state = hash_combine(state, left);
        std::swap(indices[left - 1], indices[state % left]);
    }
}

}  // namespace

namespace detail {

namespace {

// The distribution's libtbb is not instrumented, so the thread sanitizer cannot see how it passes
// tasks between threads. CMake exempts this file, and these two annotate the happens-before
// relations: everything before a release(address) happens before everything after a later
// acquire(address). Unordered tasks are not annotated.
void release([[maybe_unused]] void* address) {
#if defined(LIMN_THREAD_SANITIZER)
    __tsan_release(address);
#endif
}
void acquire([[maybe_unused]] void* address) {
#if defined(LIMN_THREAD_SANITIZER)
    __tsan_acquire(address);
#endif
}

}  // namespace

/// State shared by the ranges of one parallel_for.
struct IndexedRun {
    IndexedCall call;
    void* context;
    std::atomic<std::size_t> finished = 0;
};

struct IndexedBody {
    IndexedRun* run;
    void operator()(std::size_t index) const {
        IndexedRun* const shared = run;
        acquire(shared);
        shared->call(shared->context, index);
        release(&shared->finished);
        shared->finished.fetch_add(1, std::memory_order_release);
    }
};

/// Forwards calls in a permuted order.
struct Permuted {
    IndexedCall call;
    void* context;
    std::vector<std::size_t> order;

    static void run(void* permuted, std::size_t index) {
        const Permuted& self = *static_cast<const Permuted*>(permuted);
        self.call(self.context, self.order[index]);
    }
};

void run_in_order(std::size_t count, IndexedCall call, void* context) {
    Workers& pool = workers();
    if (pool.count == 1 || count == 1) {
        for (std::size_t i = 0; i < count; ++i) {
            call(context, i);
        }
        return;
    }
    IndexedRun run{call, context};
    release(&run);
    // Isolated: a system that waits for its ranges must not run another system on its stack.
    pool.arena.execute([&] {
        tbb::this_task_arena::isolate(
            [&] { tbb::parallel_for(std::size_t{0}, count, IndexedBody{&run}); });
    });
    LIMN_CHECK(run.finished.load(std::memory_order_acquire) == count);
    acquire(&run.finished);
}

void run_indexed(std::size_t count, IndexedCall call, void* context) {
    if (!is_shuffled()) {
        run_in_order(count, call, context);
        return;
    }
    Permuted permuted{call, context, std::vector<std::size_t>(count)};
    std::iota(permuted.order.begin(), permuted.order.end(), std::size_t{0});
    shuffle(permuted.order);
    run_in_order(count, Permuted::run, &permuted);
}

/// State shared by the tasks of one graph.
struct TaskRun {
    const TaskGraph& graph;
    IndexedCall call;
    void* context;
    tbb::task_group& group;
    std::unique_ptr<std::atomic<std::uint32_t>[]> waiting;  ///< unfinished predecessors per task
    std::atomic<std::size_t> finished = 0;
};

struct TaskBody {
    TaskRun* run;
    std::size_t task;

    void operator()() const { work_from(*run, task); }

    /// Runs a task and then, on the same thread, the first task that it made ready: a chain costs
    /// no scheduling.
    static void work_from(TaskRun& shared, std::size_t task) {
        constexpr std::size_t kNone = ~std::size_t{0};
        acquire(&shared);
        while (task != kNone) {
            acquire(&shared.waiting[task]);
            shared.call(shared.context, task);
            std::size_t next = kNone;
            const auto notify = [&shared, &next](std::size_t successor) {
                release(&shared.waiting[successor]);
                if (shared.waiting[successor].fetch_sub(1, std::memory_order_acq_rel) == 1) {
                    if (next == kNone) {
                        next = successor;
                    } else {
                        shared.group.run(TaskBody{&shared, successor});
                    }
                }
            };
            const std::vector<std::uint32_t>& successors = shared.graph.successors(task);
            if (is_shuffled()) {
                std::vector<std::size_t> order(successors.begin(), successors.end());
                shuffle(order);
                std::for_each(order.begin(), order.end(), notify);
            } else {
                std::for_each(successors.begin(), successors.end(), notify);
            }
            release(&shared.finished);
            shared.finished.fetch_add(1, std::memory_order_release);
            task = next;
        }
    }
};

/// Runs tasks one at a time, choosing randomly among the ready ones.
void run_tasks_shuffled(const TaskGraph& graph, IndexedCall call, void* context) {
    std::vector<std::uint32_t> waiting(graph.size());
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < graph.size(); ++i) {
        waiting[i] = graph.predecessor_count(i);
        if (waiting[i] == 0) {
            ready.push_back(i);
        }
    }
    while (!ready.empty()) {
        shuffle(ready);
        const std::size_t task = ready.back();
        ready.pop_back();
        call(context, task);
        for (const std::uint32_t successor : graph.successors(task)) {
            if (--waiting[successor] == 0) {
                ready.push_back(successor);
            }
        }
    }
}

void run_tasks(const TaskGraph& graph, IndexedCall call, void* context) {
    Workers& pool = workers();
    if (pool.count == 1 || graph.size() <= 1) {
        if (is_shuffled()) {
            run_tasks_shuffled(graph, call, context);
            return;
        }
        for (std::size_t i = 0; i < graph.size(); ++i) {
            call(context, i);
        }
        return;
    }
    pool.arena.execute([&] {
        tbb::task_group group;
        TaskRun run{graph, call, context, group, nullptr};
        run.waiting = std::make_unique<std::atomic<std::uint32_t>[]>(graph.size());
        std::vector<std::size_t> first;
        for (std::size_t i = 0; i < graph.size(); ++i) {
            run.waiting[i].store(graph.predecessor_count(i), std::memory_order_relaxed);
            if (graph.predecessor_count(i) == 0) {
                first.push_back(i);
            }
        }
        if (is_shuffled()) {
            shuffle(first);
        }
        release(&run);
        for (const std::size_t task : first) {
            group.run(TaskBody{&run, task});
        }
        group.wait();
        LIMN_CHECK(run.finished.load(std::memory_order_acquire) == graph.size());
        acquire(&run.finished);
    });
}

}  // namespace detail

std::size_t TaskGraph::add(const std::vector<std::size_t>& predecessors) {
    const std::size_t task = tasks_.size();
    tasks_.emplace_back().predecessor_count = static_cast<std::uint32_t>(predecessors.size());
    for (const std::size_t predecessor : predecessors) {
        LIMN_CHECK(predecessor < task);
        tasks_[predecessor].successors.push_back(static_cast<std::uint32_t>(task));
    }
    return task;
}

void set_task_shuffle(std::uint64_t seed) {
    task_shuffle = seed;
    shuffles = 0;
}

void set_thread_count(int count) {
    const int threads = std::clamp(count, 1, kMaxThreads);
    std::unique_ptr<Workers>& slot = workers_slot();
    if (slot->count != threads) {
        slot.reset();  // the old limit would still cap the new one
        slot = std::make_unique<Workers>(threads);
    }
}

int thread_count() {
    return workers().count;
}

}  // namespace limn
