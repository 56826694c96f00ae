#pragma once

#include "ecs/archetype.h"
#include "ecs/change_plan.h"
#include "ecs/entity.h"
#include "ecs/observer.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

class World;

// Pending changes of many rows in the order of execution: archetype by archetype, the rows of each
// in order, then the entities to create. Rows with the same plan form a batch, and a batch is
// applied column by column.

struct ChangeBatch {
    const ChangePlan* plan;
    std::uint32_t rows = 0;
    std::uint32_t range_count = 0;
    std::size_t first_range;
    std::size_t first_record;  ///< of the first range; each range has one per command
};

class ChangeList {
  public:
    void clear();
    /// `rows` are rows of plan.source or, if that is null, indices into `created`. `first_records`
    /// are the records of the first row, one per command of the plan. `key` orders the entities for
    /// observers. If the plan sets shared components, rows are grouped by those values.
    void
    add(ChangePlans& plans, const ChangePlan& plan, RowRange rows,
        std::span<std::byte* const> first_records, std::uint32_t key) {
        if (plan.sets_shared) {
            add_shared(plans, plan, rows, first_records, key);
        } else {
            append(plan, rows, first_records, key);
        }
    }
    /// Reserves memory for `count` calls of add().
    void reserve(std::size_t count);

    std::vector<ChangeBatch> batches;
    std::vector<RowRange> ranges;
    std::vector<std::byte*> records;
    std::vector<std::uint32_t> keys;  ///< of each range's first row
    std::vector<Entity> created;
    /// All rows get copies of the same values; otherwise each row's own values are moved.
    bool shares_records = false;

  private:
    void append(
        const ChangePlan& plan, RowRange rows, std::span<std::byte* const> first_records,
        std::uint32_t key) {
        if (batches.empty() || batches.back().plan != &plan) {
            batches.push_back({&plan, 0, 0, ranges.size(), records.size()});
        }
        ChangeBatch& batch = batches.back();
        batch.rows += rows.count;
        ++batch.range_count;
        ranges.push_back(rows);
        records.insert(records.end(), first_records.begin(), first_records.end());
        keys.push_back(key);
    }
    void add_shared(
        ChangePlans& plans, const ChangePlan& plan, RowRange rows,
        std::span<std::byte* const> first_records, std::uint32_t key);
};

/// Applies a list: notifies observers of removals, moves the rows, then notifies of additions.
class ChangeApplier {
  public:
    explicit ChangeApplier(World& world) : world_(world) {}

    /// Calls on_remove, then makes the changes.
    void apply(ChangeList& list);
    /// Calls on_add for what apply() added. Does not use the list any more.
    void notify_added();

  private:
    struct Added {
        ComponentId component;
        std::vector<Entity> entities;
    };
    struct KeyedEntity {
        std::uint32_t key;
        Entity entity;
    };

    void notify_removed();
    void collect_added();
    /// Collects the entities that gain or lose the component, in the order of their keys.
    void collect(ObserverEvent event, ComponentId id, std::vector<Entity>& entities);

    void apply_batch(const ChangeBatch& batch);
    void drop_values(const ChangeBatch& batch);
    void destroy_rows(const ChangeBatch& batch);
    /// Returns the first row in the target.
    std::uint32_t create_rows(const ChangeBatch& batch);
    std::uint32_t move_rows(const ChangeBatch& batch);
    void leave_gaps(const ChangeBatch& batch);
    void close_gaps(Archetype& archetype);
    void put_values(const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first);
    void
    put_split_values(const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first);
    void set_enabled(const ChangeBatch& batch, const ComponentChange& change, std::uint32_t first);
    void change_sparse(const ChangeBatch& batch, const SparseChange& change, std::uint32_t first);

    [[nodiscard]] std::span<const RowRange> ranges_of(const ChangeBatch& batch) const {
        return {list_->ranges.data() + batch.first_range, batch.range_count};
    }
    /// The record of a command of the plan; `range` is an index within the batch.
    [[nodiscard]] std::byte*
    record_of(const ChangeBatch& batch, std::size_t range, std::size_t command) const {
        return list_->records[batch.first_record + range * batch.plan->commands.size() + command];
    }
    [[nodiscard]] std::size_t stride_of(const ChangeBatch& batch, std::size_t command) const {
        return list_->shares_records ? 0 : batch.plan->commands[command].layout->stride;
    }
    /// Valid only before the batch is applied.
    [[nodiscard]] std::span<const Entity>
    entities_of(const ChangeBatch& batch, RowRange range) const {
        return batch.plan->source != nullptr
                   ? batch.plan->source->entities().subspan(range.first, range.count)
                   : std::span<const Entity>(list_->created).subspan(range.first, range.count);
    }

    World& world_;
    ChangeList* list_ = nullptr;
    std::vector<RowRange> gaps_;  ///< in the archetype that the rows leave
    std::vector<RowMove> moves_;
    std::vector<Added> added_;
    std::vector<KeyedEntity> keyed_;
    std::vector<Entity> notified_;
};

}  // namespace limn
