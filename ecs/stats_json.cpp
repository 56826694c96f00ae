#include "ecs/base/text.h"
#include "ecs/world_stats.h"

#include <concepts>
#include <string_view>

namespace limn {

// Statistics as JSON for programs.

namespace {

/// Quoted text; RFC 8259 requires escaping quotes, backslashes and control characters.
std::string quoted(std::string_view text) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string json = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            json += '\\';
            json += c;
        } else if (code < 0x20) {
            json += "\\u00";
            json += kHex[code >> 4];
            json += kHex[code & 15];
        } else {
            json += c;
        }
    }
    return json + '"';
}

/// Builds an object member by member: {"name": value, ...}.
class JsonObject {
  public:
    JsonObject& add(std::string_view name, std::string_view text) {
        return add_json(name, quoted(text));
    }
    template <typename T>
    requires std::integral<T> || std::floating_point<T> JsonObject&
    add(std::string_view name, T number) {
        return add_json(name, format_text("{}", number));
    }
    JsonObject& add_json(std::string_view name, std::string_view json) {
        text_ += text_.empty() ? "{" : ", ";
        text_ += quoted(name);
        text_ += ": ";
        text_ += json;
        return *this;
    }
    [[nodiscard]] std::string text() const { return text_.empty() ? "{}" : text_ + "}"; }

  private:
    std::string text_;
};

/// to_json of each element.
template <typename Range, typename ToJson>
std::string array_of(const Range& range, const ToJson& to_json) {
    std::string json;
    for (const auto& element : range) {
        json += json.empty() ? "[" : ", ";
        json += to_json(element);
    }
    return json.empty() ? "[]" : json + "]";
}

std::string query_json(const QueryStats& query) {
    return JsonObject()
        .add("terms", query.terms)
        .add("archetypes", query.archetypes)
        .add("chunks", query.chunks)
        .add("rows", query.rows)
        .add("calls", query.calls)
        .text();
}

std::string archetype_json(const ArchetypeStats& archetype) {
    JsonObject disabled;
    for (const auto& [component, rows] : archetype.disabled) {
        disabled.add(component, rows);
    }
    return JsonObject()
        .add_json("components", array_of(archetype.components, quoted))
        .add_json("kinds", array_of(archetype.kinds, quoted))
        .add("rows", archetype.rows)
        .add("capacity", archetype.capacity)
        .add("chunks", archetype.chunks)
        .add("row_bytes", archetype.row_bytes)
        .add("committed", archetype.committed)
        .add("fill", archetype.fill())
        .add_json("promoted", archetype.promoted ? "true" : "false")
        .add("rows_moved_in", archetype.rows_moved_in)
        .add("rows_moved_out", archetype.rows_moved_out)
        .add_json("disabled", disabled.text())
        .text();
}

std::string sparse_json(const SparseStats& set) {
    return JsonObject()
        .add("component", set.component)
        .add("values", set.values)
        .add("committed", set.committed)
        .text();
}

std::string flush_json(const FlushStats& flush) {
    return JsonObject()
        .add("flushes", flush.flushes)
        .add("commands", flush.commands)
        .add("entities_folded", flush.entities_folded)
        .add("entities_created", flush.entities_created)
        .add("entities_destroyed", flush.entities_destroyed)
        .add("rows_moved_singly", flush.rows_moved_singly)
        .add("rows_moved_in_ranges", flush.rows_moved_in_ranges)
        .add("rows_handed_over", flush.rows_handed_over)
        .add("archetypes_handed_over", flush.archetypes_handed_over)
        .text();
}

std::string memory_json(const WorldMemory& memory) {
    return JsonObject()
        .add("total", memory.total())
        .add("slots", memory.slots)
        .add("archetypes", memory.archetypes)
        .add("blocks", memory.blocks)
        .add("sparse", memory.sparse)
        .add("versions", memory.versions)
        .add("used", memory.used)
        .text();
}

std::string system_json(const SystemStats& system) {
    return JsonObject()
        .add("name", system.name)
        .add("last", system.last)
        .add("mean", system.mean)
        .add("runs", system.runs)
        .add("commands", system.commands)
        .add("last_commands", system.last_commands)
        .add_json("queries", array_of(system.queries, query_json))
        .text();
}

std::string sync_json(const SyncStats& sync) {
    return JsonObject()
        .add("after", sync.after)
        .add("last", sync.last)
        .add("mean", sync.mean)
        .add("runs", sync.runs)
        .add("commands", sync.commands)
        .text();
}

}  // namespace

std::string to_json(const WorldStats& stats) {
    return JsonObject()
        .add("entities", stats.entities)
        .add("free_slots", stats.free_slots)
        .add_json("archetypes", array_of(stats.archetypes, archetype_json))
        .add_json("sparse_sets", array_of(stats.sparse_sets, sparse_json))
        .add_json("queries", array_of(stats.queries, query_json))
        .add_json("flush", flush_json(stats.flush))
        .add_json("memory", memory_json(stats.memory))
        .text();
}

std::string to_json(const ScheduleStats& stats) {
    return JsonObject()
        .add_json("systems", array_of(stats.systems, system_json))
        .add_json("syncs", array_of(stats.syncs, sync_json))
        .text();
}

}  // namespace limn
