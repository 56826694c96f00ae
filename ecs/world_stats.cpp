#include "ecs/world_stats.h"

#include "ecs/base/text.h"
#include "ecs/field_access.h"
#include "ecs/schedule.h"
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

/// A term as written in the source, with the component's name.
std::string term_text(const QueryTerm& term) {
    const std::string& name = component_info(term.id).name;
    switch (term.kind) {
    case TermKind::Read:
        return "const " + name;
    case TermKind::Write:
        return name;
    case TermKind::OptionalRead:
        return "Optional<const " + name + ">";
    case TermKind::OptionalWrite:
        return "Optional<" + name + ">";
    case TermKind::With:
        return "With<" + name + ">";
    case TermKind::Without:
        return "Without<" + name + ">";
    case TermKind::Changed:
        return "Changed<" + name + ">";
    case TermKind::AnyOf:
        return "AnyOf<" + name + ">";
    case TermKind::TakeRows:
        return "TakeRows<" + name + ">";
    }
    return name;
}

/// Joins the terms; Changed (or AnyOf) terms of one group become one term of several components.
std::string terms_text(std::span<const QueryTerm> terms) {
    std::string text;
    for (std::size_t i = 0; i < terms.size(); ++i) {
        std::string term = term_text(terms[i]);
        const TermKind kind = terms[i].kind;
        const bool is_list = kind == TermKind::Changed || kind == TermKind::AnyOf;
        while (is_list && i + 1 < terms.size() && terms[i + 1].kind == kind
               && terms[i + 1].group == terms[i].group) {
            ++i;
            term.insert(term.size() - 1, ", " + component_info(terms[i].id).name);
        }
        text += (text.empty() ? "" : ", ") + term;
    }
    return text;
}

/// How the archetype stores the component: "" in a column, otherwise the kind of storage or, for a
/// shared one, the value.
std::string kind_text(const Archetype& archetype, ComponentId id) {
    const ComponentInfo& info = component_info(id);
    if (info.storage == Storage::Split) {
        return "split";
    }
    if (info.storage == Storage::Toggle) {
        return "toggle";
    }
    if (info.storage != Storage::Shared) {
        return "";
    }
    const SharedValue& shared = *archetype.shared_value(id);
    if (info.fields.empty()) {
        return format_text("value {}", shared.key);
    }
    std::vector<std::string> fields;
    for (const FieldInfo& field : info.fields) {
        fields.push_back(
            format_text("{}={}", field.name, value_text(field, field_ptr(shared.value, field))));
    }
    return join_text(fields, " ");
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

QueryStats query_stats(const QueryState& query) {
    QueryStats stats;
    stats.terms = terms_text(query.terms());
    stats.archetypes = query.matches().size();
    for (const QueryMatch& match : query.matches()) {
        stats.chunks += match.archetype->chunk_count();
        stats.rows += match.archetype->size();
    }
    stats.calls = query.calls();
    return stats;
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
            one.kinds.push_back(kind_text(*archetype, id));
        }
        one.rows = archetype->size();
        one.capacity = archetype->capacity();
        one.chunks = archetype->chunk_count();
        one.row_bytes = row_bytes(*archetype);
        one.committed = archetype->committed();
        one.promoted = archetype->is_promoted();
        one.rows_moved_in = archetype->rows_moved_in;
        one.rows_moved_out = archetype->rows_moved_out;
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
    for (const auto& query : world.queries()) {
        if (query != nullptr) {
            stats.queries.push_back(query_stats(*query));
        }
    }
    for (const System* system : SystemCache::all(world)) {
        for (const QueryState* query : system->queries()) {
            stats.queries.push_back(query_stats(*query));
        }
    }
    stats.flush = world.flush_stats();
    return stats;
}

ScheduleStats schedule_stats(const Schedule& schedule) {
    ScheduleStats stats;
    for (std::size_t i = 0; i < schedule.size(); ++i) {
        const SystemTiming& timing = schedule.timings()[i];
        SystemStats one;
        one.name = timing.name;
        one.last = timing.last;
        one.mean = timing.mean;
        one.runs = timing.runs;
        one.commands = timing.commands;
        one.last_commands = timing.last_commands;
        for (const QueryState* query : schedule.systems()[i].queries()) {
            one.queries.push_back(query_stats(*query));
        }
        stats.systems.push_back(std::move(one));
    }
    for (const SyncTiming& timing : schedule.sync_timings()) {
        stats.syncs.push_back(
            {schedule.timings()[timing.system].name, timing.last, timing.mean, timing.runs,
             timing.commands});
    }
    return stats;
}

}  // namespace limn
