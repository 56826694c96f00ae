#pragma once

#include <cstdint>

namespace limn {

// Where in a system the current thread is, so that commands recorded by many threads can be put
// into the order that one thread would have recorded them in. par_chunks opens a new sequence
// before and after its work, and says in each task which chunk it is about.

struct TaskScope {
    std::uint32_t sequence = 0;  ///< counts the parallel loops of the running system
    std::uint32_t chunk = 0;     ///< 1 + index of the chunk; 0: the system itself
};

inline constinit thread_local TaskScope current_task;

/// Replaces current_task for the lifetime.
class TaskScopeGuard {
  public:
    explicit TaskScopeGuard(TaskScope scope) : outer_(current_task) { current_task = scope; }
    TaskScopeGuard(const TaskScopeGuard&) = delete;
    TaskScopeGuard& operator=(const TaskScopeGuard&) = delete;
    ~TaskScopeGuard() { current_task = outer_; }

  private:
    TaskScope outer_;
};

}  // namespace limn
