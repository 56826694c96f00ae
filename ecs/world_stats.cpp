#include "ecs/world_stats.h"

#include "ecs/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace limn {

namespace {

std::uint32_t row_bytes(const Archetype& archetype) {
    std::uint32_t bytes = sizeof(Entity);
    for (const Column& column : archetype.columns()) {
        bytes += column.size;
    }
    return bytes;
}

double kib(std::size_t bytes) {
    return static_cast<double>(bytes) / 1024.0;
}

}  // namespace

WorldMemory World::memory() const {
    WorldMemory memory;
    memory.slots = core_.entities.committed();
    memory.blocks = core_.blocks.committed();
    for (const auto& archetype : core_.archetypes) {
        if (archetype->is_promoted()) {
            memory.archetypes += archetype->committed();
        }
        memory.used += std::size_t{archetype->size()} * row_bytes(*archetype);
        memory.versions += std::size_t{archetype->chunk_count()} * (archetype->columns().size() + 1)
                           * sizeof(std::uint32_t);
    }
    for (const SparseSet* set : core_.sparse_list) {
        memory.sparse += set->committed();
    }
    return memory;
}

WorldStats world_stats(const World& world) {
    WorldStats stats;
    stats.entities = world.entity_count();
    stats.free_slots = world.core().entities.free_count();
    stats.memory = world.memory();
    for (const auto& archetype : world.archetypes()) {
        ArchetypeStats one;
        for (const ComponentId id : archetype->components()) {
            one.components.push_back(component_info(id).name);
        }
        one.rows = archetype->size();
        one.capacity = archetype->capacity();
        one.chunks = archetype->chunk_count();
        one.row_bytes = row_bytes(*archetype);
        one.committed = archetype->committed();
        one.promoted = archetype->is_promoted();
        one.rows_moved_in = archetype->rows_moved_in;
        stats.archetypes.push_back(std::move(one));
    }
    for (const SparseSet* set : world.sparse_sets()) {
        stats.sparse_sets.push_back({set->info().name, set->size(), set->committed()});
    }
    return stats;
}

std::string to_text(const WorldStats& stats) {
    std::string text = fmt::format("{} entities\n", stats.entities);
    for (const ArchetypeStats& archetype : stats.archetypes) {
        text += fmt::format(
            "{:>9} rows {:>6} chunks {:>5} B/row {:>5.1f} % filled  {}\n",
            archetype.rows,
            archetype.chunks,
            archetype.row_bytes,
            100.0 * archetype.fill(),
            fmt::join(archetype.components, " "));
    }
    for (const SparseStats& set : stats.sparse_sets) {
        text += fmt::format("{:>9} values, sparse  {}\n", set.values, set.component);
    }
    text += fmt::format(
        "{:.0f} KiB: columns {:.0f}, blocks {:.0f}, handles {:.0f}, sparse {:.0f}, versions "
        "{:.0f}\n",
        kib(stats.memory.total()),
        kib(stats.memory.archetypes),
        kib(stats.memory.blocks),
        kib(stats.memory.slots),
        kib(stats.memory.sparse),
        kib(stats.memory.versions));
    return text;
}

}  // namespace limn
