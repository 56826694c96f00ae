#include "ecs/command_flush.h"

#include "ecs/world_internals.h"

#include <algorithm>
#include <utility>

// Techniques: engine.main-loop

namespace limn {

CommandFlush::CommandFlush(World& world)
    : world_(world), order_(world.core()), plans_(world), applier_(world) {}

void CommandFlush::run(std::span<CommandBuffer* const> buffers) {
    FlushStats& stats = world_.internals_->flush_stats;
    plans_.clear_if_stale();
    list_.clear();
    order_.collect(buffers);
    order_.arrange(plans_, list_, stats);
    stats.flushes += list_.batches.empty() ? 0 : 1;
    applier_.apply(list_);
    for (CommandBuffer* buffer : buffers) {
        buffer->reset();
    }
    applier_.notify_added();
}

void CommandFlush::run(CommandKind kind, std::byte* record, std::span<const ArchetypeRows> rows) {
    FlushStats& stats = world_.internals_->flush_stats;
    plans_.clear_if_stale();
    list_.clear();
    list_.shares_records = true;
    std::uint32_t key = 0;
    for (const ArchetypeRows& part : rows) {
        Archetype* source = world_.core_.archetypes[part.archetype].get();
        list_.add(plans_, plans_.find(source, {&kind, 1}), part.rows, {&record, 1}, key);
        key += part.rows.count;
    }
    stats.commands += key;
    applier_.apply(list_);
    applier_.notify_added();
}

namespace {

/// Borrows the world's CommandFlush; creates a temporary one for nested use by an observer.
class FlushLoan {
  public:
    FlushLoan(World& world, std::unique_ptr<CommandFlush>& home)
        : home_(home), flush_(std::move(home)) {
        if (flush_ == nullptr) {
            flush_ = std::make_unique<CommandFlush>(world);
        }
    }
    FlushLoan(const FlushLoan&) = delete;
    FlushLoan& operator=(const FlushLoan&) = delete;
    ~FlushLoan() { home_ = std::move(flush_); }
    CommandFlush* operator->() const { return flush_.get(); }

  private:
    std::unique_ptr<CommandFlush>& home_;
    std::unique_ptr<CommandFlush> flush_;
};

}  // namespace

void World::apply(std::span<CommandBuffer* const> buffers) {
    core_.check_unlocked();
    FlushLoan(*this, internals_->flush)->run(buffers);
}

void World::change_rows(CommandKind kind, std::byte* record, std::vector<ArchetypeRows> rows) {
    core_.check_unlocked();
    const auto before = [](const ArchetypeRows& a, const ArchetypeRows& b) {
        return a.archetype != b.archetype ? a.archetype < b.archetype : a.rows.first < b.rows.first;
    };
    if (!std::is_sorted(rows.begin(), rows.end(), before)) {
        std::sort(rows.begin(), rows.end(), before);
    }
    FlushLoan(*this, internals_->flush)->run(kind, record, rows);
}

void apply_commands(World& world, std::span<CommandBuffer* const> buffers) {
    world.apply(buffers);
}

const FlushStats& World::flush_stats() const {
    return internals_->flush_stats;
}

}  // namespace limn
