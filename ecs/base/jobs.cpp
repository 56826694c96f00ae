#include "ecs/base/jobs.h"

#include "ecs/base/check.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <memory>

#if defined(LIMN_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libtbb.so\n";  // what it does among its own threads
}
#endif

namespace limn {

namespace {

constexpr int kMostThreads = 256;

/// The threads. Made on first use, made anew when their number changes.
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
        std::make_unique<Workers>(std::clamp(tbb::info::default_concurrency(), 1, kMostThreads));
    return slot;
}

Workers& workers() {
    return *workers_slot();
}

}  // namespace

namespace detail {

namespace {

// The distribution's libtbb is not instrumented, so the thread sanitizer cannot see how it hands
// tasks from thread to thread. CMake exempts this file, and these two tell the sanitizer what is
// ordered: everything before a release(place) comes before everything after a later acquire(place).
// Where tasks are not ordered, nothing is told.
void release([[maybe_unused]] void* place) {
#if defined(LIMN_THREAD_SANITIZER)
    __tsan_release(place);
#endif
}
void acquire([[maybe_unused]] void* place) {
#if defined(LIMN_THREAD_SANITIZER)
    __tsan_acquire(place);
#endif
}

}  // namespace

/// What the ranges of one parallel_for share.
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

void run_indexed(std::size_t count, IndexedCall call, void* context) {
    Workers& pool = workers();
    if (pool.count == 1 || count == 1) {
        for (std::size_t i = 0; i < count; ++i) {
            call(context, i);
        }
        return;
    }
    IndexedRun run{call, context};
    release(&run);
    // Isolated: a system that waits for its ranges must not start another system on its stack
    // meanwhile.
    pool.arena.execute([&] {
        tbb::this_task_arena::isolate(
            [&] { tbb::parallel_for(std::size_t{0}, count, IndexedBody{&run}); });
    });
    LIMN_CHECK(run.finished.load(std::memory_order_acquire) == count);
    acquire(&run.finished);
}

/// What the tasks of one graph share.
struct TaskRun {
    const TaskGraph& graph;
    IndexedCall call;
    void* context;
    tbb::task_group& group;
    std::unique_ptr<std::atomic<std::uint32_t>[]> waiting;  ///< for so many predecessors
    std::atomic<std::size_t> finished = 0;
};

struct TaskBody {
    TaskRun* run;
    std::size_t task;

    void operator()() const { work_from(*run, task); }

    /// Runs a task and then, itself, the first of those that it made ready: a chain costs no
    /// hand-over.
    static void work_from(TaskRun& shared, std::size_t task) {
        constexpr std::size_t kNone = ~std::size_t{0};
        acquire(&shared);
        while (task != kNone) {
            acquire(&shared.waiting[task]);
            shared.call(shared.context, task);
            std::size_t next = kNone;
            for (const std::uint32_t successor : shared.graph.successors(task)) {
                release(&shared.waiting[successor]);
                if (shared.waiting[successor].fetch_sub(1, std::memory_order_acq_rel) == 1) {
                    if (next == kNone) {
                        next = successor;
                    } else {
                        shared.group.run(TaskBody{&shared, successor});
                    }
                }
            }
            release(&shared.finished);
            shared.finished.fetch_add(1, std::memory_order_release);
            task = next;
        }
    }
};

void run_tasks(const TaskGraph& graph, IndexedCall call, void* context) {
    Workers& pool = workers();
    if (pool.count == 1 || graph.size() <= 1) {
        for (std::size_t i = 0; i < graph.size(); ++i) {
            call(context, i);
        }
        return;
    }
    pool.arena.execute([&] {
        tbb::task_group group;
        TaskRun run{graph, call, context, group, nullptr};
        run.waiting = std::make_unique<std::atomic<std::uint32_t>[]>(graph.size());
        for (std::size_t i = 0; i < graph.size(); ++i) {
            run.waiting[i].store(graph.predecessor_count(i), std::memory_order_relaxed);
        }
        release(&run);
        for (std::size_t i = 0; i < graph.size(); ++i) {
            if (graph.predecessor_count(i) == 0) {
                group.run(TaskBody{&run, i});
            }
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

void set_thread_count(int count) {
    const int threads = std::clamp(count, 1, kMostThreads);
    std::unique_ptr<Workers>& slot = workers_slot();
    if (slot->count != threads) {
        slot.reset();  // a limit in force would hold the new one down
        slot = std::make_unique<Workers>(threads);
    }
}

int thread_count() {
    return workers().count;
}

}  // namespace limn
