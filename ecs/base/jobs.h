#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace limn {

// Multithreading over oneTBB. How work is split never depends on the number of threads: range k of
// a parallel_for is [k * grain, (k + 1) * grain) for one thread and for sixty-four. A body that
// writes only to its range therefore gives bit-identical results everywhere; for a sum, keep one
// partial result per range and add them in range order. Which thread runs a range, and when, is
// unspecified.

/// Number of threads, including the caller; 1 .. 256. Default: the machine's hardware threads.
/// Must not be called from inside a job.
void set_thread_count(int count);
[[nodiscard]] int thread_count();

/// For tests of that guarantee: starts ready ranges and tasks in a pseudo-random order from `seed`,
/// on one thread too. 0, the default: first to last. Must not be called from inside a job.
void set_task_shuffle(std::uint64_t seed);

/// A dependency graph of tasks. A task may only depend on tasks that were added before it.
class TaskGraph {
  public:
    /// Adds a task that waits for the tasks in `predecessors`; returns its index.
    std::size_t add(const std::vector<std::size_t>& predecessors);
    [[nodiscard]] std::size_t size() const { return tasks_.size(); }
    [[nodiscard]] const std::vector<std::uint32_t>& successors(std::size_t task) const {
        return tasks_[task].successors;
    }
    [[nodiscard]] std::uint32_t predecessor_count(std::size_t task) const {
        return tasks_[task].predecessor_count;
    }

  private:
    struct Task {
        std::vector<std::uint32_t> successors;
        std::uint32_t predecessor_count = 0;
    };
    std::vector<Task> tasks_;
};

namespace detail {

using IndexedCall = void (*)(void* context, std::size_t index);
void run_indexed(std::size_t count, IndexedCall call, void* context);
void run_tasks(const TaskGraph& graph, IndexedCall call, void* context);

template <typename Body>
void* context_of(Body& body) {
    return const_cast<void*>(static_cast<const void*>(std::addressof(body)));
}

}  // namespace detail

/// Splits 0 .. count into ranges of `grain` indices, the last one possibly shorter, calls
/// body(begin, end) for each, and returns when all are done. May be called from inside a job.
template <typename Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
    if (count == 0) {
        return;
    }
    if (grain == 0 || count <= grain) {
        body(std::size_t{0}, count);
        return;
    }
    struct Work {
        std::remove_reference_t<Body>& body;
        std::size_t count;
        std::size_t grain;
    } work{body, count, grain};
    const auto call = [](void* context, std::size_t index) {
        const Work& w = *static_cast<const Work*>(context);
        const std::size_t begin = index * w.grain;
        w.body(begin, w.count - begin < w.grain ? w.count : begin + w.grain);
    };
    detail::run_indexed((count - 1) / grain + 1, call, &work);
}

/// Calls run(i) for every task, after the tasks it waits for, and returns when all are done.
template <typename Run>
void run_task_graph(const TaskGraph& graph, Run&& run) {
    const auto call = [](void* context, std::size_t index) {
        (*static_cast<std::remove_reference_t<Run>*>(context))(index);
    };
    detail::run_tasks(graph, call, detail::context_of(run));
}

}  // namespace limn
