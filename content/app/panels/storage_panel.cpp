#include "content/app/panels/storage_panel.h"

#include "content/app/panels/hud_style.h"
#include "ecs/archetype.h"
#include "ecs/reflect.h"
#include "ecs/schedule.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string_view>

namespace limn {
namespace {

constexpr double kRefreshInterval = 0.25;  // of the figures [s]
constexpr float kMinCell = 5.0f;           // narrower chunks are merged into one bar
const ImVec4 kLines = {1, 1, 1, 0.07f};    // unfilled part of a bar

/// Name and color of a component's storage kind.
struct StorageLook {
    const char* name;
    ImVec4 color;
};

const StorageLook kTableLook = {"table", kHudText};
const StorageLook kSplitLook = {"split", {0.50f, 0.83f, 0.58f, 1.0f}};
const StorageLook kToggleLook = {"toggle", {0.96f, 0.72f, 0.33f, 1.0f}};
const StorageLook kSharedLook = {"shared", {0.78f, 0.62f, 0.95f, 1.0f}};
const StorageLook kSparseLook = {"sparse", {0.45f, 0.75f, 0.95f, 1.0f}};
const StorageLook kTagLook = {"tag", kHudDim};

const StorageLook& look_of(std::string_view component) {
    const ComponentInfo* info = find_component(component);
    if (info == nullptr) {
        return kTableLook;
    }
    switch (info->storage) {
    case Storage::Split:
        return kSplitLook;
    case Storage::Toggle:
        return kToggleLook;
    case Storage::Shared:
        return kSharedLook;
    case Storage::Sparse:
        return kSparseLook;
    case Storage::Table:
        break;
    }
    return info->is_tag ? kTagLook : kTableLook;
}

/// Lays out words in a row, wrapping at the window's edge.
class WordFlow {
  public:
    void add(std::string_view word, const ImVec4& color) {
        const float width = ImGui::CalcTextSize(word.data(), word.data() + word.size()).x;
        if (!is_first_) {
            ImGui::SameLine(0, kGap);
            if (ImGui::GetContentRegionAvail().x < width) {
                ImGui::NewLine();
            }
        }
        is_first_ = false;
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::TextUnformatted(word.data(), word.data() + word.size());
        ImGui::PopStyleColor();
    }

  private:
    static constexpr float kGap = 8.0f;
    bool is_first_ = true;
};

void row_counts_text(const HudStyle& style, const ImVec4& color, const std::string& text) {
    ImGui::PushFont(style.numbers);
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopFont();
}

/// Aligned to the right of its cell or line.
void right_text(const HudStyle& style, const ImVec4& color, const std::string& text) {
    ImGui::PushFont(style.numbers);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SetCursorPosX(
        ImGui::GetCursorPosX() + std::max(ImGui::GetContentRegionAvail().x - width, 0.0f));
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopFont();
}

/// "12 345 678"
std::string grouped(std::uint64_t number) {
    std::string text = std::to_string(number);
    for (std::size_t at = text.size(); at > 3;) {
        at -= 3;
        text.insert(at, 1, ' ');
    }
    return text;
}

std::string bytes_text(std::size_t bytes) {
    const double kib = static_cast<double>(bytes) / 1024.0;
    return kib < 1000 ? fmt::format("{:.0f} KiB", kib) : fmt::format("{:.1f} MiB", kib / 1024.0);
}

std::string ms_text(double seconds) {
    return fmt::format("{:.3f}", seconds * 1e3);
}

const ImVec4& count_color(std::uint64_t count) {
    return count > 0 ? kHudText : kHudDim;
}

bool section(const char* title, std::size_t count) {
    const std::string label = fmt::format("{}  ({})###{}", title, count, title);
    return ImGui::CollapsingHeader(label.c_str(), ImGuiTreeNodeFlags_DefaultOpen);
}

/// One cell per chunk, filled in proportion to its rows; many chunks are merged into one bar.
void draw_chunks(const HudStyle& style, const ArchetypeStats& archetype) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = 7.0f * style.scale;
    const auto chunks = static_cast<float>(std::max(archetype.chunks, 1u));
    const bool cells = width / chunks >= kMinCell * style.scale;
    const std::uint32_t count = cells ? std::max(archetype.chunks, 1u) : 1;
    const float cell = width / static_cast<float>(count);
    const std::uint32_t rows_a_cell = cells ? kChunkRows : archetype.chunks * kChunkRows;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 filled = ImGui::GetColorU32({kHudAccent.x, kHudAccent.y, kHudAccent.z, 0.75f});
    for (std::uint32_t i = 0; i < count; ++i) {
        const float left = at.x + static_cast<float>(i) * cell;
        const float right = left + cell - (count > 1 ? 1.0f : 0.0f);
        const std::uint32_t before = i * rows_a_cell;
        const std::uint32_t rows = std::min(archetype.rows - before, rows_a_cell);
        const float fill = static_cast<float>(rows) / static_cast<float>(rows_a_cell);
        list->AddRectFilled({left, at.y}, {right, at.y + height}, ImGui::GetColorU32(kLines), 2.0f);
        list->AddRectFilled(
            {left, at.y}, {left + fill * (right - left), at.y + height}, filled, 2.0f);
    }
    ImGui::Dummy({width, height});
}

void draw_archetype(const HudStyle& style, const ArchetypeStats& archetype) {
    WordFlow words;
    for (const std::string& component : archetype.components) {
        words.add(component, look_of(component).color);
    }
    if (archetype.components.empty()) {
        words.add("no components", kHudDim);
    }
    draw_chunks(style, archetype);
    row_counts_text(
        style, kHudText,
        fmt::format(
            "{} rows  {} {}", grouped(archetype.rows), archetype.chunks,
            archetype.chunks == 1 ? "chunk" : "chunks"));
    ImGui::SameLine();
    right_text(
        style, kHudDim,
        fmt::format(
            "{} B/row  {} {:.0f} %", archetype.row_bytes, bytes_text(archetype.committed),
            100.0 * archetype.fill()));
    for (const auto& [component, rows] : archetype.disabled) {
        row_counts_text(
            style, kToggleLook.color, fmt::format("{} disabled: {}", component, grouped(rows)));
    }
    if (archetype.rows_moved_in + archetype.rows_moved_out > 0) {
        row_counts_text(
            style, kHudDim,
            fmt::format(
                "moved in {}, out {}", grouped(archetype.rows_moved_in),
                grouped(archetype.rows_moved_out)));
    }
    ImGui::Dummy({0, 4 * style.scale});
}

bool begin_figures(const char* name, const char* first, std::initializer_list<const char*> rest) {
    if (!ImGui::BeginTable(
            name, static_cast<int>(rest.size()) + 1, ImGuiTableFlags_SizingFixedFit)) {
        return false;
    }
    ImGui::TableSetupColumn(first, ImGuiTableColumnFlags_WidthStretch);
    for (const char* title : rest) {
        ImGui::TableSetupColumn(title);
    }
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(kHudDim, "%s", first);
    for (const char* title : rest) {
        ImGui::TableNextColumn();
        ImGui::TextColored(kHudDim, "%s", title);
    }
    return true;
}

void figure_cell(const HudStyle& style, const ImVec4& color, const std::string& text) {
    ImGui::TableNextColumn();
    right_text(style, color, text);
}

void wrapped_cell(const ImVec4& color, const std::string& text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(color, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void StoragePanel::draw(const HudStyle& style, const World& world, const Schedule& schedule) {
    const double now = ImGui::GetTime();
    if (refreshed_at_ < 0.0 || now - refreshed_at_ > kRefreshInterval) {
        world_ = world_stats(world);
        schedule_ = schedule_stats(schedule);
        refreshed_at_ = now;
    }
    draw_summary(style);
    ImGui::BeginChild("##storage");
    draw_archetypes(style);
    draw_sparse_sets(style);
    draw_systems(style);
    draw_queries(style);
    draw_flushes(style);
    ImGui::EndChild();
}

void StoragePanel::draw_summary(const HudStyle& style) const {
    row_counts_text(
        style, kHudAccent,
        fmt::format(
            "{} entities, {}", grouped(world_.entities), bytes_text(world_.memory.total())));
    WordFlow words;
    for (const StorageLook* look :
         {&kTableLook, &kSplitLook, &kToggleLook, &kSharedLook, &kSparseLook, &kTagLook}) {
        words.add(look->name, look->color);
    }
    ImGui::Separator();
}

void StoragePanel::draw_archetypes(const HudStyle& style) const {
    const auto used = static_cast<std::size_t>(std::count_if(
        world_.archetypes.begin(), world_.archetypes.end(),
        [](const ArchetypeStats& archetype) { return archetype.rows > 0; }));
    if (!section("Archetypes", used)) {
        return;
    }
    for (const ArchetypeStats& archetype : world_.archetypes) {
        if (archetype.rows > 0) {
            draw_archetype(style, archetype);
        }
    }
    if (const std::size_t empty = world_.archetypes.size() - used; empty > 0) {
        ImGui::TextColored(kHudDim, "and %zu without rows", empty);
    }
}

void StoragePanel::draw_sparse_sets(const HudStyle& style) const {
    if (world_.sparse_sets.empty() || !section("Sparse sets", world_.sparse_sets.size())) {
        return;
    }
    if (begin_figures("##sets", "component", {"values", "memory"})) {
        for (const SparseStats& set : world_.sparse_sets) {
            wrapped_cell(kSparseLook.color, set.component);
            figure_cell(style, count_color(set.values), grouped(set.values));
            figure_cell(style, kHudDim, bytes_text(set.committed));
        }
        ImGui::EndTable();
    }
}

void StoragePanel::draw_systems(const HudStyle& style) const {
    if (schedule_.systems.empty() || !section("Systems", schedule_.systems.size())) {
        return;
    }
    if (!begin_figures("##systems", "system", {"ms", "rows", "commands"})) {
        return;
    }
    for (const SystemStats& system : schedule_.systems) {
        std::size_t rows = 0;
        for (const QueryStats& query : system.queries) {
            rows += query.rows;
        }
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const bool open = ImGui::TreeNodeEx(
            system.name.c_str(),
            system.queries.empty() ? ImGuiTreeNodeFlags_Leaf : ImGuiTreeNodeFlags_None);
        figure_cell(style, system.mean < 5e-5 ? kHudDim : kHudText, ms_text(system.mean));
        figure_cell(style, count_color(rows), grouped(rows));
        figure_cell(style, count_color(system.last_commands), grouped(system.last_commands));
        if (open) {
            for (const QueryStats& query : system.queries) {
                wrapped_cell(kHudDim, query.terms);
                ImGui::TableNextColumn();
                figure_cell(style, kHudDim, grouped(query.rows));
            }
            ImGui::TreePop();
        }
    }
    for (const SyncStats& sync : schedule_.syncs) {
        wrapped_cell(kHudAccent, "sync after " + sync.after);
        figure_cell(style, sync.mean < 5e-5 ? kHudDim : kHudText, ms_text(sync.mean));
        ImGui::TableNextColumn();
        figure_cell(style, count_color(sync.commands), grouped(sync.commands));
    }
    ImGui::EndTable();
}

void StoragePanel::draw_queries(const HudStyle& style) const {
    const auto called = static_cast<std::size_t>(
        std::count_if(world_.queries.begin(), world_.queries.end(), [](const QueryStats& query) {
            return query.calls > 0;
        }));
    if (called == 0 || !section("Queries elsewhere", called)) {
        return;
    }
    if (begin_figures("##queries", "terms", {"calls", "rows"})) {
        for (const QueryStats& query : world_.queries) {
            if (query.calls > 0) {
                wrapped_cell(kHudText, query.terms);
                figure_cell(style, kHudText, grouped(query.calls));
                figure_cell(style, count_color(query.rows), grouped(query.rows));
            }
        }
        ImGui::EndTable();
    }
}

void StoragePanel::draw_flushes(const HudStyle& style) const {
    const FlushStats& flush = world_.flush;
    if (!section("Sync points", flush.flushes)) {
        return;
    }
    if (!begin_figures("##flush", "since start", {""})) {
        return;
    }
    const auto line = [&](const char* name, std::uint64_t count) {
        wrapped_cell(count > 0 ? kHudText : kHudDim, name);
        figure_cell(style, count_color(count), grouped(count));
    };
    line("commands applied", flush.commands);
    line("entities created", flush.entities_created);
    line("entities destroyed", flush.entities_destroyed);
    line("entities with several commands", flush.entities_folded);
    line("rows moved in ranges", flush.rows_moved_in_ranges);
    line("rows moved singly", flush.rows_moved_singly);
    line("rows moved with their whole columns", flush.rows_handed_over);
    ImGui::EndTable();
}

}  // namespace limn
