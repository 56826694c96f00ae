#include "ecs/change_list.h"

#include "ecs/base/check.h"
#include "ecs/world_internals.h"

#include <algorithm>
#include <cstring>

namespace limn {

void ChangeList::clear() {
    batches.clear();
    ranges.clear();
    records.clear();
    keys.clear();
    created.clear();
    shares_records = false;
}

void ChangeList::add_shared(
    ChangePlans& plans, const ChangePlan& plan, RowRange rows,
    std::span<std::byte* const> first_records, std::uint32_t key) {
    const auto stride_of = [&](std::size_t command) {
        return shares_records ? std::size_t{0} : plan.commands[command].layout->stride;
    };
    const auto is_same = [&](std::uint32_t a, std::uint32_t b) {
        return std::all_of(
            plan.table.begin(), plan.table.end(), [&](const ComponentChange& change) {
                if (!change.sets_shared()) {
                    return true;
                }
                const auto command = static_cast<std::size_t>(change.command);
                const std::byte* values = first_records[command] + change.offset;
                return std::memcmp(
                           values + a * stride_of(command), values + b * stride_of(command),
                           change.info->size)
                       == 0;
            });
    };
    std::vector<std::byte*> some(first_records.begin(), first_records.end());
    for (std::uint32_t begin = 0, end = 0; begin < rows.count; begin = end) {
        end = begin + 1;
        while (end < rows.count && (shares_records || is_same(begin, end))) {
            ++end;
        }
        for (std::size_t command = 0; command < some.size(); ++command) {
            some[command] = first_records[command] + begin * stride_of(command);
        }
        append(plans.with_shared(plan, some), {rows.first + begin, end - begin}, some, key + begin);
    }
}

void ChangeList::reserve(std::size_t count) {
    ranges.reserve(count);
    records.reserve(count);
    keys.reserve(count);
}

// ---- apply
// ---------------------------------------------------------------------------------------

void ChangeApplier::apply(ChangeList& list) {
    list_ = &list;
    collect_added();
    notify_removed();
    gaps_.clear();
    for (std::size_t i = 0; i < list.batches.size(); ++i) {
        const ChangeBatch& batch = list.batches[i];
        apply_batch(batch);
        const bool is_last_of_source =
            i + 1 == list.batches.size() || list.batches[i + 1].plan->source != batch.plan->source;
        if (is_last_of_source && batch.plan->source != nullptr) {
            close_gaps(*batch.plan->source);
        }
    }
    list_ = nullptr;
}

void ChangeApplier::apply_batch(const ChangeBatch& batch) {
    const ChangePlan& plan = *batch.plan;
    drop_values(batch);
    if (plan.target == nullptr) {
        destroy_rows(batch);
        return;
    }
    std::uint32_t first = 0;
    if (plan.source == nullptr) {
        first = create_rows(batch);
    } else if (plan.source != plan.target) {
        first = move_rows(batch);
    }
    for (const ComponentChange& change : plan.table) {
        if (change.command >= 0 && change.is_present && !change.sets_shared()) {
            put_values(batch, change, first);
        }
        if (change.enabling != Enabling::Keep && change.is_present) {
            set_enabled(batch, change, first);
        }
    }
    for (const SparseChange& change : plan.sparse) {
        change_sparse(batch, change, first);
    }
}

void ChangeApplier::drop_values(const ChangeBatch& batch) {
    const auto ranges = ranges_of(batch);
    for (const DroppedValue& value : batch.plan->dropped) {
        const std::size_t stride = stride_of(batch, value.command);
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            std::byte* record = record_of(batch, i, value.command) + value.offset;
            for (std::uint32_t row = 0; row < ranges[i].count; ++row) {
                value.info->ops.destroy(record + row * stride, 1);
            }
        }
    }
}

void ChangeApplier::destroy_rows(const ChangeBatch& batch) {
    WorldCore& core = world_.core_;
    world_.internals_->flush_stats.entities_destroyed += batch.rows;
    for (const RowRange& range : ranges_of(batch)) {
        const auto entities = entities_of(batch, range);
        if (batch.plan->source != nullptr) {
            for (SparseSet* set : core.sparse_list) {
                for (std::size_t i = 0; i < entities.size() && set->size() > 0; ++i) {
                    const std::uint32_t position = set->find(entities[i]);
                    if (position != SparseSet::kAbsent) {
                        set->remove(position, core.now());
                    }
                }
            }
            batch.plan->source->destroy_components(range.first, range.count);
        }
        core.entities.free(entities);
    }
    leave_gaps(batch);
}

std::uint32_t ChangeApplier::create_rows(const ChangeBatch& batch) {
    WorldCore& core = world_.core_;
    Archetype& target = *batch.plan->target;
    const std::uint32_t first = target.size();
    target.reserve(first + batch.rows);
    for (const RowRange& range : ranges_of(batch)) {
        const auto entities = entities_of(batch, range);
        core.entities.set_location(entities, target.index(), target.append(entities, core.now()));
    }
    world_.internals_->flush_stats.entities_created += batch.rows;
    return first;
}

std::uint32_t ChangeApplier::move_rows(const ChangeBatch& batch) {
    WorldCore& core = world_.core_;
    FlushStats& stats = world_.internals_->flush_stats;
    Archetype& source = *batch.plan->source;
    Archetype& target = *batch.plan->target;
    std::uint32_t first = 0;
    if (batch.rows == source.size() && target.adopt_rows(source, core.now())) {
        ++stats.archetypes_handed_over;
        stats.rows_handed_over += batch.rows;
    } else {
        const auto ranges = ranges_of(batch);
        first = target.append_from(source, ranges, core.now());
        leave_gaps(batch);
        const auto single = static_cast<std::uint64_t>(std::count_if(
            ranges.begin(), ranges.end(), [](const RowRange& range) { return range.count == 1; }));
        stats.rows_moved_singly += single;
        stats.rows_moved_in_ranges += batch.rows - single;
    }
    core.entities.set_location(target.entities().subspan(first, batch.rows), target.index(), first);
    return first;
}

void ChangeApplier::leave_gaps(const ChangeBatch& batch) {
    if (batch.plan->source != nullptr) {
        const auto ranges = ranges_of(batch);
        gaps_.insert(gaps_.end(), ranges.begin(), ranges.end());
    }
}

void ChangeApplier::close_gaps(Archetype& archetype) {
    if (gaps_.empty()) {
        return;
    }
    archetype.close_gaps(gaps_, world_.core_.now(), moves_);
    for (const RowMove& move : moves_) {
        world_.core_.entities.set_location(
            archetype.entities().subspan(move.to, move.count), archetype.index(), move.to);
    }
    gaps_.clear();
}

// ---- values
// --------------------------------------------------------------------------------------

namespace {

/// Copies values of kSize bytes: those of range i start at records[i * step], `stride` bytes apart.
template <std::size_t kSize>
void copy_values_of(
    std::byte* data, std::span<const RowRange> ranges, std::uint32_t first, bool in_place,
    std::byte* const* records, std::size_t step, std::size_t offset, std::size_t stride) {
    constexpr std::size_t kAhead = 16;
    std::uint32_t row = first;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if (i + kAhead < ranges.size()) {
            __builtin_prefetch(records[(i + kAhead) * step] + offset);
        }
        const std::byte* value = records[i * step] + offset;
        std::byte* to = data + std::size_t{in_place ? ranges[i].first : row} * kSize;
        const std::uint32_t count = ranges[i].count;
        row += count;
        if (stride == kSize && count > 1) {
            std::memcpy(to, value, count * kSize);
            continue;
        }
        for (std::uint32_t k = 0; k < count; ++k, to += kSize, value += stride) {
            std::memcpy(to, value, kSize);
        }
    }
}

}  // namespace

/// The target rows hold raw memory or, if they stay in place, the previous values.
void ChangeApplier::put_values(
    const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first) {
    const ChangePlan& plan = *batch.plan;
    const ComponentInfo& info = *change.info;
    Archetype& target = *plan.target;
    const int index = target.column_of(info.id);
    Column& column = target.column(index);
    const auto ranges = ranges_of(batch);
    const bool in_place = plan.source == plan.target;
    const auto command = static_cast<std::size_t>(change.command);
    const std::size_t step = plan.commands.size();
    const std::size_t stride = stride_of(batch, command);
    std::byte* const* records = list_->records.data() + batch.first_record + command;

    if (in_place) {
        for (const RowRange& range : ranges) {
            target.write_rows(index, range, world_.core_.now());
        }
    }
    if (info.storage == Storage::Split) {
        put_split_values(batch, change, first);
        return;
    }
    if (info.trivially_copyable) {
        const auto copy = [&]<std::size_t kSize>(std::integral_constant<std::size_t, kSize>) {
            copy_values_of<kSize>(
                column.data, ranges, first, in_place, records, step, change.offset, stride);
        };
        switch (info.size) {
        case 4:
            return copy(std::integral_constant<std::size_t, 4>{});
        case 8:
            return copy(std::integral_constant<std::size_t, 8>{});
        case 12:
            return copy(std::integral_constant<std::size_t, 12>{});
        case 16:
            return copy(std::integral_constant<std::size_t, 16>{});
        case 32:
            return copy(std::integral_constant<std::size_t, 32>{});
        case 64:
            return copy(std::integral_constant<std::size_t, 64>{});
        default:
            break;
        }
    }
    std::uint32_t row = first;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        std::byte* value = records[i * step] + change.offset;
        std::byte* to = column.at(in_place ? ranges[i].first : row);
        row += ranges[i].count;
        if (change.was_present && !info.trivially_destructible) {
            info.ops.destroy(to, ranges[i].count);
        }
        if (stride == info.size) {
            relocate_values(info, to, value, ranges[i].count);
            continue;
        }
        for (std::uint32_t k = 0; k < ranges[i].count; ++k, to += info.size, value += stride) {
            if (list_->shares_records) {
                info.ops.construct_copy(to, value, 1);
            } else {
                relocate_values(info, to, value, 1);
            }
        }
    }
}

void ChangeApplier::put_split_values(
    const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first) {
    const bool in_place = batch.plan->source == batch.plan->target;
    const auto command = static_cast<std::size_t>(change.command);
    const std::size_t stride = stride_of(batch, command);
    Column* lanes = &batch.plan->target->column(batch.plan->target->column_of(change.info->id));
    const auto ranges = ranges_of(batch);
    std::uint32_t row = first;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const std::byte* value = record_of(batch, i, command) + change.offset;
        const std::uint32_t begin = in_place ? ranges[i].first : row;
        const std::uint32_t count = ranges[i].count;
        row += count;
        if (list_->shares_records) {
            fill_values(lanes, begin, count, value);
        } else if (stride == change.info->size) {
            scatter_values(lanes, begin, count, value);
        } else {
            for (std::uint32_t k = 0; k < count; ++k) {
                scatter_values(lanes, begin + k, 1, value + k * stride);
            }
        }
    }
}

void ChangeApplier::set_enabled(
    const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first) {
    Archetype& target = *batch.plan->target;
    const bool in_place = batch.plan->source == &target;
    std::uint32_t row = first;
    for (const RowRange& range : ranges_of(batch)) {
        const std::uint32_t begin = in_place ? range.first : row;
        for (std::uint32_t k = 0; k < range.count; ++k) {
            target.set_enabled(
                change.info->id, begin + k, change.enabling == Enabling::Enable,
                world_.core_.now());
        }
        row += range.count;
    }
}

void ChangeApplier::change_sparse(
    const ChangeBatch& batch, const SparseChange& changes, std::uint32_t first) {
    const ChangePlan& plan = *batch.plan;
    const ComponentInfo& info = *changes.if_absent.info;
    const std::uint32_t now = world_.core_.now();
    SparseSet* set = world_.core_.sparse_set(info.id);
    if (set == nullptr) {
        set = &world_.use_sparse_set(info.id);
    }
    const auto change_one = [&](Entity entity, std::size_t range, std::uint32_t k) {
        const auto value_at = [&](std::size_t command, std::uint32_t offset) {
            return record_of(batch, range, command) + k * stride_of(batch, command) + offset;
        };
        std::uint32_t position = set->find(entity);
        const bool was_present = position != SparseSet::kAbsent;
        for (const DroppedValue& value :
             was_present ? changes.dropped_if_present : changes.dropped_if_absent) {
            info.ops.destroy(value_at(value.command, value.offset), 1);
        }
        const ComponentChange& change = was_present ? changes.if_present : changes.if_absent;
        if (!change.is_present) {
            if (was_present) {
                set->remove(position, now);
            }
            return;
        }
        if (!was_present) {
            position = set->append(entity, now);
        } else if (change.command >= 0) {
            info.ops.destroy(set->value(position), 1);
            set->touch(position, now);
        }
        if (change.command >= 0) {
            std::byte* value = value_at(static_cast<std::size_t>(change.command), change.offset);
            if (list_->shares_records) {
                info.ops.construct_copy(set->value(position), value, 1);
            } else {
                relocate_values(info, set->value(position), value, 1);
            }
        }
    };
    const auto ranges = ranges_of(batch);
    std::uint32_t row = first;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        const std::uint32_t begin = plan.source == plan.target ? ranges[i].first : row;
        for (std::uint32_t k = 0; k < ranges[i].count; ++k) {
            change_one(plan.target->entities()[begin + k], i, k);
        }
        row += ranges[i].count;
    }
}

// ---- observers
// -----------------------------------------------------------------------------------

namespace {

/// Which entities of a plan gain or lose a component, by presence of a sparse component.
struct Affected {
    bool if_absent;
    bool if_present;
};

/// Applies the predicate to the plan's change of the component, if there is one.
template <typename Predicate>
Affected affected_by(const ChangePlan& plan, ComponentId id, const Predicate& is_affected) {
    for (const ComponentChange& change : plan.table) {
        if (change.info->id == id) {
            return {is_affected(change), is_affected(change)};
        }
    }
    for (const SparseChange& change : plan.sparse) {
        if (change.if_present.info->id == id) {
            return {is_affected(change.if_absent), is_affected(change.if_present)};
        }
    }
    return {false, false};
}

Affected affected_by_loss(const ChangePlan& plan, ComponentId id) {
    if (plan.target == nullptr) {
        const bool in_table = plan.source != nullptr && plan.source->has(id);
        return {in_table, plan.source != nullptr};
    }
    return affected_by(plan, id, [](const ComponentChange& change) { return change.loses(); });
}

Affected affected_by_gain(const ChangePlan& plan, ComponentId id) {
    if (plan.target == nullptr) {
        return {false, false};
    }
    return affected_by(plan, id, [](const ComponentChange& change) { return change.gains(); });
}

}  // namespace

void ChangeApplier::collect(ObserverEvent event, ComponentId id, std::vector<Entity>& entities) {
    keyed_.clear();
    const bool is_sparse = component_info(id).storage == Storage::Sparse;
    const SparseSet* set = world_.core_.sparse_set(id);
    for (const ChangeBatch& batch : list_->batches) {
        const Affected affected = event == ObserverEvent::Remove
                                      ? affected_by_loss(*batch.plan, id)
                                      : affected_by_gain(*batch.plan, id);
        if (!affected.if_absent && !affected.if_present) {
            continue;
        }
        const auto ranges = ranges_of(batch);
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            const std::uint32_t key = list_->keys[batch.first_range + i];
            const auto all = entities_of(batch, ranges[i]);
            for (std::uint32_t k = 0; k < all.size(); ++k) {
                const bool present = is_sparse && set != nullptr && set->has(all[k]);
                if (present ? affected.if_present : affected.if_absent) {
                    keyed_.push_back({key + k, all[k]});
                }
            }
        }
    }
    const auto by_key = [](const KeyedEntity& a, const KeyedEntity& b) { return a.key < b.key; };
    if (!std::is_sorted(keyed_.begin(), keyed_.end(), by_key)) {
        std::sort(keyed_.begin(), keyed_.end(), by_key);
    }
    entities.clear();
    for (const KeyedEntity& keyed : keyed_) {
        entities.push_back(keyed.entity);
    }
}

void ChangeApplier::notify_removed() {
    for (std::size_t i = 0; i < world_.internals_->observers.size(); ++i) {
        const Observer& observer = *world_.internals_->observers[i];
        if (observer.event != ObserverEvent::Remove) {
            continue;
        }
        collect(ObserverEvent::Remove, observer.component, notified_);
        if (!notified_.empty()) {
            const IterationGuard guard(world_.core_, IterationLock::Plain);
            observer.function(world_, notified_);
        }
    }
}

void ChangeApplier::collect_added() {
    added_.clear();
    for (const auto& observer : world_.internals_->observers) {
        const ComponentId id = observer->component;
        const bool is_known = std::any_of(added_.begin(), added_.end(), [&](const Added& added) {
            return added.component == id;
        });
        if (observer->event == ObserverEvent::Add && !is_known) {
            added_.push_back({id, {}});
            collect(ObserverEvent::Add, id, added_.back().entities);
        }
    }
}

void ChangeApplier::notify_added() {
    for (std::size_t i = 0; i < world_.internals_->observers.size(); ++i) {
        const Observer& observer = *world_.internals_->observers[i];
        if (observer.event != ObserverEvent::Add) {
            continue;
        }
        for (const Added& added : added_) {
            if (added.component != observer.component) {
                continue;
            }
            // An earlier observer may have removed it again.
            notified_.clear();
            std::copy_if(
                added.entities.begin(), added.entities.end(), std::back_inserter(notified_),
                [&](Entity entity) { return world_.has(entity, added.component); });
            if (!notified_.empty()) {
                observer.function(world_, notified_);
            }
        }
    }
}

}  // namespace limn
