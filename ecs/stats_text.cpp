#include "ecs/base/text.h"
#include "ecs/world_stats.h"

#include <algorithm>

namespace limn {

// Statistics as tables for people.

namespace {

std::vector<std::string> labels_of(const ArchetypeStats& archetype) {
    std::vector<std::string> labels;
    for (std::size_t i = 0; i < archetype.components.size(); ++i) {
        const std::string& kind = archetype.kinds[i];
        labels.push_back(archetype.components[i] + (kind.empty() ? "" : "(" + kind + ")"));
    }
    return labels;
}

std::string kib(std::size_t bytes) {
    return fixed_text(static_cast<double>(bytes) / 1024.0, 0);
}

/// Seconds as milliseconds.
std::string ms(double time) {
    return align_right(fixed_text(time * 1e3, 3), 9);
}

std::string query_line(const QueryStats& query) {
    return format_text(
        "{} calls {} rows {} chunks {} archetypes  {}\n", align_right(query.calls, 9),
        align_right(query.rows, 9), align_right(query.chunks, 6), align_right(query.archetypes, 4),
        query.terms);
}

std::string archetype_lines(const ArchetypeStats& archetype) {
    std::string text = format_text(
        "{} rows {} chunks {} B/row {} % filled {} moved in {} out  {}\n",
        align_right(archetype.rows, 9), align_right(archetype.chunks, 6),
        align_right(archetype.row_bytes, 5),
        align_right(fixed_text(100.0 * archetype.fill(), 1), 5),
        align_right(archetype.rows_moved_in, 7), align_right(archetype.rows_moved_out, 7),
        join_text(labels_of(archetype), " "));
    for (const auto& [component, rows] : archetype.disabled) {
        text += format_text("{} rows with {} disabled\n", align_right(rows, 9), component);
    }
    return text;
}

}  // namespace

std::string to_text(const WorldStats& stats) {
    std::string text = format_text("{} entities\n", stats.entities);
    for (const ArchetypeStats& archetype : stats.archetypes) {
        text += archetype_lines(archetype);
    }
    for (const SparseStats& set : stats.sparse_sets) {
        text += format_text("{} values, sparse  {}\n", align_right(set.values, 9), set.component);
    }
    for (const QueryStats& query : stats.queries) {
        text += query.calls > 0 ? query_line(query) : "";
    }
    if (const FlushStats& flush = stats.flush; flush.flushes > 0 || flush.commands > 0) {
        text += format_text(
            "{} flushes of {} commands: {} entities created, {} destroyed; {} rows moved in "
            "ranges, {} one by one, {} by exchanging columns\n",
            flush.flushes, flush.commands, flush.entities_created, flush.entities_destroyed,
            flush.rows_moved_in_ranges, flush.rows_moved_singly, flush.rows_handed_over);
    }
    text += format_text(
        "{} KiB: columns {}, blocks {}, handles {}, sparse {}, versions {}\n",
        kib(stats.memory.total()), kib(stats.memory.archetypes), kib(stats.memory.blocks),
        kib(stats.memory.slots), kib(stats.memory.sparse), kib(stats.memory.versions));
    return text;
}

std::string to_text(const ScheduleStats& stats) {
    std::size_t width = 0;
    for (const SystemStats& system : stats.systems) {
        width = std::max(width, system.name.size());
    }
    std::string text;
    for (const SystemStats& system : stats.systems) {
        text += format_text(
            "{}  {} ms  mean {} ms {} runs {} commands\n", align_left(system.name, width),
            ms(system.last), ms(system.mean), align_right(system.runs, 7),
            align_right(system.commands, 8));
        for (const QueryStats& query : system.queries) {
            text += query_line(query);
        }
        for (const SyncStats& sync : stats.syncs) {
            if (sync.after == system.name && sync.runs > 0) {
                text += format_text(
                    "{}  {} ms  mean {} ms {} runs {} commands\n", align_left("  sync", width),
                    ms(sync.last), ms(sync.mean), align_right(sync.runs, 7),
                    align_right(sync.commands, 8));
            }
        }
    }
    return text;
}

}  // namespace limn
