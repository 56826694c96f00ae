#pragma once

#include <cstdint>

namespace limn {

// The current thread's position within a system, so that commands recorded by many threads can be
// sorted into the order in which one thread would have recorded them. par_chunks starts a new
// sequence before and after its work, and sets the chunk in each task.

struct TaskScope {
    std::uint32_t sequence = 0;  ///< counts the parallel loops of the running system
    std::uint32_t chunk = 0;     ///< 1 + index of the chunk; 0: the system itself
};

inline constinit thread_local TaskScope current_task;

/// Replaces current_task during its lifetime.
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
