#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <vector>

namespace limn {

// Work on several cores, over oneTBB. How work is cut never depends on the number of threads: range
// k of a parallel_for is [k * grain, (k + 1) * grain) for one thread and for sixty-four. A body
// that writes only what belongs to its range therefore gives the same bits everywhere; a sum is
// made by one partial result a range, added in the order of the ranges. Which thread runs a range,
// and when, is left open.

/// How many threads work, the caller among them; 1 .. 256. At start: as many as the machine has.
/// Not to be called from inside a job.
void set_thread_count(int count);
[[nodiscard]] int thread_count();

/// For tests of that promise: ranges and tasks that are ready start in an order drawn from `seed`,
/// on one thread too. 0, at start: from the first to the last. Not to be called from inside a job.
void set_task_shuffle(std::uint64_t seed);

/// Tasks and what each must wait for. Task i may only be waited for by tasks after it: j > i.
class TaskGraph {
  public:
    /// The index of a new task that waits for the tasks in `predecessors`, all of smaller index.
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

/// Calls body(begin, end) for the ranges of `grain` > 0 indices that make up 0 .. count, the last
/// one possibly shorter, and returns when all are done. May be called from inside a job.
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
