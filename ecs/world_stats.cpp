#include "ecs/world_stats.h"

#include "ecs/base/text.h"
#include "ecs/world.h"

namespace limn {

namespace {

std::uint32_t row_bytes(const Archetype& archetype) {
    std::uint32_t bytes = sizeof(Entity);
    for (const Column& column : archetype.columns()) {
        bytes += column.size;
    }
    return bytes;
}

std::string kib(std::size_t bytes) {
    return fixed_text(static_cast<double>(bytes) / 1024.0, 0);
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
        for (const Column& column : archetype->columns()) {
            memory.versions += column.versions.size() * sizeof(std::uint32_t);
        }
        memory.versions += std::size_t{archetype->chunk_count()} * sizeof(std::uint32_t);
        memory.versions += archetype->bits().bytes();
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
        for (const ToggleBits& toggle : archetype->bits().toggles()) {
            if (const std::uint32_t count = toggle.disabled_count(); count > 0) {
                one.disabled.emplace_back(component_info(toggle.id).name, count);
            }
        }
        stats.archetypes.push_back(std::move(one));
    }
    for (const SparseSet* set : world.sparse_sets()) {
        stats.sparse_sets.push_back({set->info().name, set->size(), set->committed()});
    }
    return stats;
}

std::string to_text(const WorldStats& stats) {
    std::string text = format_text("{} entities\n", stats.entities);
    for (const ArchetypeStats& archetype : stats.archetypes) {
        text += format_text(
            "{} rows {} chunks {} B/row {} % filled  {}\n",
            align_right(archetype.rows, 9),
            align_right(archetype.chunks, 6),
            align_right(archetype.row_bytes, 5),
            align_right(fixed_text(100.0 * archetype.fill(), 1), 5),
            join_text(archetype.components, " "));
        for (const auto& [component, rows] : archetype.disabled) {
            text += format_text("{} of them with {} disabled\n", align_right(rows, 9), component);
        }
    }
    for (const SparseStats& set : stats.sparse_sets) {
        text += format_text("{} values, sparse  {}\n", align_right(set.values, 9), set.component);
    }
    text += format_text(
        "{} KiB: columns {}, blocks {}, handles {}, sparse {}, versions {}\n",
        kib(stats.memory.total()),
        kib(stats.memory.archetypes),
        kib(stats.memory.blocks),
        kib(stats.memory.slots),
        kib(stats.memory.sparse),
        kib(stats.memory.versions));
    return text;
}

}  // namespace limn
