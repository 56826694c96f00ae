#include "content/app/panels/profiler_panel.h"

#include "content/app/panels/hud_style.h"
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "render/graph/frame_graph.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <initializer_list>
#include <malloc.h>
#include <string_view>
#include <unistd.h>

namespace limn {
namespace {

constexpr double kSmoothing = 0.08;   // weight of a new sample in the moving average
constexpr int kMemoryInterval = 30;   // frames between memory readings
constexpr double kGoodFrame = 16.67;  // [ms]

/// A right-aligned number.
void number_cell(const HudStyle& style, const ImVec4& color, const char* format, double value) {
    std::array<char, 32> text;
    *fmt::format_to_n(text.data(), text.size() - 1, fmt::runtime(format), value).out = '\0';
    ImGui::TableNextColumn();
    ImGui::PushFont(style.numbers);
    const float width = ImGui::CalcTextSize(text.data()).x;
    ImGui::SetCursorPosX(
        ImGui::GetCursorPosX() + std::max(ImGui::GetContentRegionAvail().x - width, 0.0f));
    ImGui::TextColored(color, "%s", text.data());
    ImGui::PopFont();
}

/// Headings: the first is of the row names, the others of numeric columns.
void heading_row(const char* name, std::initializer_list<const char*> numbers) {
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    ImGui::TableNextColumn();
    ImGui::TextColored(kHudDim, "%s", name);
    for (const char* text : numbers) {
        ImGui::TableNextColumn();
        const float width = ImGui::CalcTextSize(text).x;
        ImGui::SetCursorPosX(
            ImGui::GetCursorPosX() + std::max(ImGui::GetContentRegionAvail().x - width, 0.0f));
        ImGui::TextColored(kHudDim, "%s", text);
    }
}

/// A name with a bar behind it that shows its fraction of the total.
void name_cell(std::string_view name, double fraction) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float length = width * static_cast<float>(std::clamp(fraction, 0.0, 1.0));
    ImGui::GetWindowDrawList()->AddRectFilled(
        at, {at.x + length, at.y + ImGui::GetTextLineHeight()},
        ImGui::GetColorU32(ImGuiCol_HeaderHovered), 2.0f);
    ImGui::TextUnformatted(name.data(), name.data() + name.size());
}

/// The color of a time: dim if it is negligible.
const ImVec4& time_color(double ms) {
    return ms < 0.05 ? kHudDim : kHudText;
}

}  // namespace

double resident_memory_mib() {
    std::FILE* file = std::fopen("/proc/self/statm", "r");
    if (file == nullptr) {
        return 0.0;
    }
    long total = 0;
    long resident = 0;
    const int read = std::fscanf(file, "%ld %ld", &total, &resident);
    std::fclose(file);
    return read == 2 ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE))
                           / (1 << 20)
                     : 0.0;
}

double heap_memory_mib() {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks + info.hblkhd) / (1024.0 * 1024.0);
}

void ProfilerPanel::add_frame(const FrameCost& cost) {
    const auto smooth = [](double& shown, double now) { shown += kSmoothing * (now - shown); };
    smooth(cost_.simulate_ms, cost.simulate_ms);
    smooth(cost_.render_ms, cost.render_ms);
    cost_.frame_ms = cost.frame_ms;
    cost_.statistics = cost.statistics;
    compiled_ += cost.statistics.compiled;
    history_.add(cost.frame_ms);
    recent_.add(cost.frame_ms);
    summary_ = recent_.summary();
}

void ProfilerPanel::draw(
    const HudStyle& style, const World& world, const Schedule& schedule, const FrameGraph& graph) {
    if (!open) {
        return;
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float margin = 14.0f * style.scale;
    const float top = std::max(style.panel_top, 110.0f * style.scale);
    ImGui::SetNextWindowPos({margin, top}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize(
        {std::min(372.0f * style.scale, 0.45f * display.x), display.y - top - margin},
        ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Profiler", &open, ImGuiWindowFlags_NoCollapse)) {
        draw_graph(style);
        draw_counts(style, world, graph);
        draw_passes(style, graph);
        draw_systems(style, schedule);
    }
    ImGui::End();
}

void ProfilerPanel::draw_graph(const HudStyle& style) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size = {ImGui::GetContentRegionAvail().x, 72.0f * style.scale};
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(
        at, {at.x + size.x, at.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg), 4.0f);
    const Summary all = history_.summary();
    const double top = std::max(all.p95 * 1.5, 1.2 * kGoodFrame);
    const auto height_of = [&](double ms) {
        return static_cast<float>(std::min(ms / top, 1.0)) * (size.y - 4.0f);
    };
    const float step = size.x / static_cast<float>(kGraphFrames);
    const std::size_t count = history_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double ms = history_.sample(i);
        const float x = at.x + size.x - static_cast<float>(count - i) * step;
        const ImVec4& color = ms > 2.0 * all.median ? kHudBad : kHudAccent;
        list->AddRectFilled(
            {x, at.y + size.y - height_of(ms)}, {x + std::max(step - 0.5f, 1.0f), at.y + size.y},
            ImGui::GetColorU32({color.x, color.y, color.z, 0.75f}));
    }
    const float line = at.y + size.y - height_of(kGoodFrame);
    list->AddLine({at.x, line}, {at.x + size.x, line}, ImGui::GetColorU32(ImGuiCol_Separator));
    const ImVec2 label = ImGui::CalcTextSize("60/s");
    list->AddRectFilled(
        {at.x, line - label.y}, {at.x + label.x + 8, line}, ImGui::GetColorU32(ImGuiCol_PopupBg),
        3.0f);
    list->AddText({at.x + 4, line - label.y}, ImGui::GetColorU32(kHudDim), "60/s");
    ImGui::Dummy(size);

    std::array<char, 96> text;
    *fmt::format_to_n(
         text.data(), text.size() - 1, "median {:.2f}  p95 {:.2f}  max {:.2f} ms", all.median,
         all.p95, all.max)
         .out = '\0';
    ImGui::PushFont(style.numbers);
    ImGui::TextUnformatted(text.data());
    ImGui::PopFont();
}

void ProfilerPanel::draw_counts(
    const HudStyle& style, const World& world, const FrameGraph& graph) {
    if (frames_until_memory_-- <= 0) {
        frames_until_memory_ = kMemoryInterval;
        resident_mib_ = resident_memory_mib();
    }
    const FrameStatistics& statistics = cost_.statistics;
    const double target_bytes = static_cast<double>(graph.stats().pool_bytes);
    if (!ImGui::BeginTable("##counts", 4, ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    const auto pair = [&style](const char* name, double value, const char* format) {
        ImGui::TableNextColumn();
        ImGui::TextColored(kHudDim, "%s", name);
        number_cell(style, kHudText, format, value);
    };
    const double mib = 1.0 / (1 << 20);
    pair("draws", statistics.draws, "{:.0f}");
    pair("triangles", static_cast<double>(statistics.triangles), "{:.0f}");
    pair("visible", statistics.visible_instances, "{:.0f}");
    pair("instances", statistics.instances, "{:.0f}");
    pair("boxes tested", statistics.tested_boxes, "{:.0f}");
    pair("lights", statistics.lights, "{:.0f}");
    pair("entities", static_cast<double>(world.entity_count()), "{:.0f}");
    pair("programs", statistics.programs, "{:.0f}");
    pair("compiled late", compiled_, "{:.0f}");
    pair("memory", resident_mib_, "{:.0f} MiB");
    pair("targets", target_bytes * mib, "{:.1f} MiB");
    ImGui::EndTable();
}

void ProfilerPanel::draw_passes(const HudStyle& style, const FrameGraph& graph) {
    ImGui::Spacing();
    if (!ImGui::BeginTable("##passes", 3, ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch, 0.5f);
    ImGui::TableSetupColumn("cpu ms", ImGuiTableColumnFlags_WidthStretch, 0.25f);
    ImGui::TableSetupColumn("gpu ms", ImGuiTableColumnFlags_WidthStretch, 0.25f);
    heading_row("pass", {"cpu ms", "gpu ms"});
    const double whole = std::max(graph.total_gpu_ms(), 1e-6);
    for (const PassTiming& timing : graph.timings()) {
        name_cell(timing.name, timing.gpu_ms / whole);
        number_cell(style, time_color(timing.cpu_ms), "{:.3f}", timing.cpu_ms);
        number_cell(style, time_color(timing.gpu_ms), "{:.3f}", timing.gpu_ms);
    }
    name_cell("all passes", 0.0);
    number_cell(style, kHudAccent, "{:.3f}", graph.total_cpu_ms());
    number_cell(style, kHudAccent, "{:.3f}", graph.total_gpu_ms());
    name_cell("extract", 0.0);
    number_cell(style, kHudText, "{:.3f}", cost_.statistics.extract_ms);
    ImGui::TableNextColumn();
    name_cell("drawing, total", 0.0);
    number_cell(style, kHudText, "{:.3f}", cost_.render_ms);
    ImGui::EndTable();
}

void ProfilerPanel::draw_systems(const HudStyle& style, const Schedule& schedule) {
    ImGui::Spacing();
    if (!ImGui::BeginTable("##systems", 2, ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    ImGui::TableSetupColumn("system", ImGuiTableColumnFlags_WidthStretch, 0.75f);
    ImGui::TableSetupColumn("cpu ms", ImGuiTableColumnFlags_WidthStretch, 0.25f);
    heading_row("system", {"cpu ms"});
    const std::span<const SystemTiming> timings = schedule.timings();
    system_ms_.resize(timings.size(), 0.0);
    double whole = 1e-6;
    for (std::size_t i = 0; i < timings.size(); ++i) {
        system_ms_[i] += kSmoothing * (timings[i].last * 1e3 - system_ms_[i]);
        whole += system_ms_[i];
    }
    for (std::size_t i = 0; i < timings.size(); ++i) {
        name_cell(timings[i].name, system_ms_[i] / whole);
        number_cell(style, time_color(system_ms_[i]), "{:.3f}", system_ms_[i]);
    }
    name_cell("simulation of a frame", 0.0);
    number_cell(style, kHudAccent, "{:.3f}", cost_.simulate_ms);
    ImGui::EndTable();
}

}  // namespace limn
