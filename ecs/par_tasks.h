#pragma once

#include "ecs/base/jobs.h"
#include "ecs/task_scope.h"

#include <cstddef>
#include <cstdint>

namespace limn::detail {

/// Calls work(i) for 0 <= i < count on several threads, each as a task of its own, so that the
/// commands it records are sorted by i.
template <typename Work>
void par_tasks(std::size_t count, const Work& work) {
    if (current_task.chunk != 0) {
        for (std::size_t i = 0; i < count; ++i) {
            work(i);  // nested in a task: keeps the task's commands in order
        }
        return;
    }
    // Scheduling a range costs as much as some hundred rows: 32 ranges per thread are enough.
    const std::size_t grain = 1 + count / (32 * static_cast<std::size_t>(thread_count()));
    const std::uint32_t sequence = ++current_task.sequence;
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const TaskScopeGuard scope({sequence, static_cast<std::uint32_t>(i) + 1});
            work(i);
        }
    });
    ++current_task.sequence;
}

}  // namespace limn::detail
