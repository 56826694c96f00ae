#include "ecs/system.h"

#include "ecs/world_internals.h"

#include <algorithm>
#include <iterator>

namespace limn {

namespace {

using Ids = std::vector<ComponentId>;

void sort_unique(Ids& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

void subtract(Ids& ids, const Ids& others) {
    std::erase_if(
        ids, [&](ComponentId id) { return std::binary_search(others.begin(), others.end(), id); });
}

bool overlap(const Ids& a, const Ids& b) {
    return std::any_of(a.begin(), a.end(), [&](ComponentId id) {
        return std::binary_search(b.begin(), b.end(), id);
    });
}

bool writes_anything(const SystemAccess& access) {
    return !access.writes.empty() || !access.resource_writes.empty();
}

}  // namespace

WorldCore& detail::core_of(World& world) {
    return world.core();
}

ResourceSlot* detail::find_resource_slot(World& world, ComponentId id) {
    return world.resource_slot(id);
}

ResourceSlot& detail::require_resource_slot(World& world, ComponentId id) {
    ResourceSlot* const slot = world.resource_slot(id);
    LIMN_CHECK_NOTE(slot != nullptr, component_info(id).name.c_str());
    return *slot;
}

void SystemAccess::normalize() {
    sort_unique(reads);
    sort_unique(writes);
    sort_unique(resource_reads);
    sort_unique(resource_writes);
    subtract(reads, writes);
    subtract(resource_reads, resource_writes);
}

bool SystemAccess::conflicts_with(const SystemAccess& other) const {
    if (exclusive || other.exclusive) {
        return true;
    }
    if ((reads_all && writes_anything(other)) || (other.reads_all && writes_anything(*this))) {
        return true;
    }
    return overlap(writes, other.writes) || overlap(writes, other.reads)
           || overlap(reads, other.writes) || overlap(resource_writes, other.resource_writes)
           || overlap(resource_writes, other.resource_reads)
           || overlap(resource_reads, other.resource_writes);
}

void System::run(World& world, std::uint32_t version) {
    if (access_.exclusive) {
        world.core().check_unlocked();
        run_locked(world, version);
    } else {
        const IterationGuard guard(world.core(), IterationLock::Shared);
        run_locked(world, version);
    }
}

void System::run_locked(World& world, std::uint32_t version) {
    // A fresh scope: command order starts at 0, whichever thread stole the task.
    const TaskScopeGuard scope({});
    const bool has_run = last_epoch_ == world.core().epoch;
    body_->run(world, version, has_run ? last_version_ : version - kNeverRan);
    last_version_ = version;
    last_epoch_ = world.core().epoch;
}

void run_system(World& world, System& system) {
    world.core().check_unlocked();
    const std::uint32_t version = world.begin_run();
    system.prepare(world);
    system.run(world, version);
    if (CommandBuffer* commands = system.commands(); commands != nullptr) {
        apply_commands(world, {&commands, 1});
    }
}

System* SystemCache::find(World& world, const void* type, const void* function) {
    for (const auto& known : world.internals_->systems) {
        if (known.type == type && known.function == function) {
            return known.system.get();
        }
    }
    return nullptr;
}

std::vector<const System*> SystemCache::all(const World& world) {
    std::vector<const System*> systems;
    for (const auto& known : world.internals_->systems) {
        systems.push_back(known.system.get());
    }
    return systems;
}

System& SystemCache::insert(World& world, const void* type, const void* function, System system) {
    world.internals_->systems.push_back(
        {type, function, std::make_unique<System>(std::move(system))});
    return *world.internals_->systems.back().system;
}

}  // namespace limn
