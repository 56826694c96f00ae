#include "ecs/change_plan.h"

#include "ecs/base/check.h"
#include "ecs/world.h"

#include <algorithm>

namespace limn {

namespace {

constexpr std::size_t kMaxPlannedCommands = 1 << 14;

std::size_t hash_of_change(const Archetype* source, std::span<const CommandKind> commands) {
    constexpr std::size_t kOdd = 0x9e3779b97f4a7c15u;
    std::size_t hash = reinterpret_cast<std::size_t>(source);
    for (const CommandKind& kind : commands) {
        hash = (hash ^ hash >> 29) * kOdd + reinterpret_cast<std::size_t>(kind.layout)
               + static_cast<std::size_t>(kind.op);
    }
    return (hash ^ hash >> 32) * kOdd >> 20;
}

/// Whether the command carries a value of the component, which must be in its layout.
bool has_value(const ComponentInfo& info, const CommandKind& kind) {
    return !info.is_tag && kind.layout->stride > 0;
}

/// Folds all commands that concern `id`, in order.
ComponentChange fold(
    std::span<const CommandKind> commands, ComponentId id, bool was_present,
    std::vector<DroppedValue>& dropped) {
    const ComponentInfo& info = component_info(id);
    ComponentChange change{&info};
    change.was_present = was_present;
    change.is_present = was_present;
    const auto drop = [&](std::uint32_t command, std::uint32_t offset) {
        if (!info.trivially_destructible) {
            dropped.push_back({&info, command, offset});
        }
    };
    for (std::uint32_t command = 0; command < commands.size(); ++command) {
        const CommandKind& kind = commands[command];
        for (std::uint32_t i = 0; i < kind.layout->size; ++i) {
            if (kind.layout->id(i) != id) {
                continue;
            }
            const std::uint32_t offset = kind.layout->offsets[i];
            const bool is_enabling = kind.op == CommandOp::Enable || kind.op == CommandOp::Disable;
            if (kind.op == CommandOp::Set && !change.is_present) {
                drop(command, offset);
            }
            if ((kind.op == CommandOp::Set || is_enabling) && !change.is_present) {
                continue;
            }
            if (kind.op != CommandOp::Set && info.storage == Storage::Toggle) {
                change.enabling =
                    kind.op == CommandOp::Disable ? Enabling::Disable : Enabling::Enable;
            }
            if (is_enabling) {
                continue;
            }
            if (change.command >= 0) {
                drop(static_cast<std::uint32_t>(change.command), change.offset);
            }
            change.command = has_value(info, kind) ? static_cast<std::int32_t>(command) : -1;
            change.offset = offset;
            change.is_present = kind.op != CommandOp::Remove;
            change.was_removed = change.was_removed || kind.op == CommandOp::Remove;
        }
    }
    return change;
}

void drop_all(std::span<const CommandKind> commands, std::vector<DroppedValue>& dropped) {
    for (std::uint32_t command = 0; command < commands.size(); ++command) {
        const RecordLayout& layout = *commands[command].layout;
        for (std::uint32_t i = 0; i < layout.size; ++i) {
            const ComponentInfo& info = component_info(layout.id(i));
            if (has_value(info, commands[command]) && !info.trivially_destructible) {
                dropped.push_back({&info, command, layout.offsets[i]});
            }
        }
    }
}

std::vector<ComponentId> components_of(std::span<const CommandKind> commands) {
    std::vector<ComponentId> ids;
    for (const CommandKind& kind : commands) {
        for (std::uint32_t i = 0; i < kind.layout->size; ++i) {
            ids.push_back(kind.layout->id(i));
        }
    }
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

}  // namespace

bool ChangePlan::is_for(const Archetype* from, std::span<const CommandKind> kinds) const {
    return source == from && commands.size() == kinds.size()
           && std::equal(kinds.begin(), kinds.end(), commands.begin());
}

const ChangePlan&
ChangePlans::find_or_make(Archetype* source, std::span<const CommandKind> commands) {
    if (2 * (plans_.size() + 1) > slots_.size()) {
        slots_.assign(std::max<std::size_t>(16, 2 * slots_.size()), 0);
        for (std::uint32_t i = 0; i < plans_.size(); ++i) {
            std::size_t slot = hash_of_change(plans_[i]->source, plans_[i]->commands);
            while (slots_[slot % slots_.size()] != 0) {
                ++slot;
            }
            slots_[slot % slots_.size()] = i + 1;
        }
    }
    for (std::size_t slot = hash_of_change(source, commands);; ++slot) {
        std::uint32_t& entry = slots_[slot % slots_.size()];
        if (entry == 0) {
            plans_.push_back(make(source, commands));
            commands_ += commands.size();
            entry = static_cast<std::uint32_t>(plans_.size());
            last_ = plans_.back().get();
            return *last_;
        }
        if (plans_[entry - 1]->is_for(source, commands)) {
            last_ = plans_[entry - 1].get();
            return *last_;
        }
    }
}

std::unique_ptr<ChangePlan>
ChangePlans::make(Archetype* source, std::span<const CommandKind> commands) {
    auto plan = std::make_unique<ChangePlan>();
    plan->source = source;
    plan->commands.assign(commands.begin(), commands.end());
    if (std::any_of(commands.begin(), commands.end(), [](const CommandKind& kind) {
            return kind.op == CommandOp::Destroy;
        })) {
        drop_all(commands, plan->dropped);
        return plan;
    }
    for (const ComponentId id : components_of(commands)) {
        if (component_info(id).storage == Storage::Sparse) {
            SparseChange& change = plan->sparse.emplace_back();
            change.if_absent = fold(commands, id, false, change.dropped_if_absent);
            change.if_present = fold(commands, id, true, change.dropped_if_present);
        } else {
            const bool was_present = source != nullptr && source->has(id);
            plan->table.push_back(fold(commands, id, was_present, plan->dropped));
        }
    }
    plan->sets_shared =
        std::any_of(plan->table.begin(), plan->table.end(), [](const ComponentChange& change) {
            return change.sets_shared();
        });
    if (!plan->sets_shared) {
        plan->target = &find_target(*plan, {});
    }
    return plan;
}

const ChangePlan&
ChangePlans::with_shared(const ChangePlan& plan, std::span<std::byte* const> records) {
    Archetype& target = find_target(plan, records);
    std::unique_ptr<ChangePlan>& known = plan.by_target[&target];
    if (known == nullptr) {
        known = std::make_unique<ChangePlan>();
        known->source = plan.source;
        known->target = &target;
        known->commands = plan.commands;
        known->table = plan.table;
        known->sparse = plan.sparse;
        known->dropped = plan.dropped;
        commands_ += plan.commands.size();
    }
    return *known;
}

/// The archetype that the entity ends up in. `records` are only read if the plan sets shared
/// components.
Archetype& ChangePlans::find_target(const ChangePlan& plan, std::span<std::byte* const> records) {
    std::vector<ComponentId> components;
    std::vector<SharedValue> shared;
    if (plan.source != nullptr) {
        const auto present = plan.source->components();
        components.assign(present.begin(), present.end());
        shared.assign(plan.source->shared().begin(), plan.source->shared().end());
    }
    for (const ComponentChange& change : plan.table) {
        const auto position =
            std::lower_bound(components.begin(), components.end(), change.info->id);
        if (change.is_present && !change.was_present) {
            components.insert(position, change.info->id);
        } else if (!change.is_present && change.was_present) {
            components.erase(position);
        }
        if (change.sets_shared() || !change.is_present) {
            std::erase_if(shared, [&](const SharedValue& value) {
                return value.component == change.info->id;
            });
        }
        if (change.sets_shared()) {
            const std::byte* value =
                records[static_cast<std::size_t>(change.command)] + change.offset;
            SharedValues& values = world_.core().shared;
            insert_shared(shared, values.value(values.add(*change.info, value)));
        }
    }
    return world_.archetype_of(components, shared);
}

void ChangePlans::clear_if_stale() {
    if (epoch_ != world_.core().epoch || commands_ > kMaxPlannedCommands) {
        epoch_ = world_.core().epoch;
        last_ = nullptr;
        plans_.clear();
        slots_.clear();
        commands_ = 0;
    }
}

}  // namespace limn
