#include "content/app/panels/buffer_viewer.h"

#include "content/app/panels/hud_style.h"
#include "render/gpu/device.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/readback.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/render_frame.h"
#include "render/shaders/fullscreen_gpu.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace limn {
namespace {

constexpr int kAllChannels = 4;
constexpr const char* kChannelNames[] = {"R", "G", "B", "A", "RGB"};

/// Why a texture cannot be shown, or "".
const char* why_not(const gpu::Texture& texture) {
    const gpu::FormatInfo& format = gpu::format_info(texture.desc().format);
    if (texture.target() != GL_TEXTURE_2D) {
        return "only plain 2D textures are shown";
    }
    if (format.integer) {
        return "integer textures are not shown";
    }
    return "";
}

bool is_aov(std::string_view name) {
    const std::vector<std::string_view>& names = aov_names();
    return std::find(names.begin(), names.end(), name) != names.end();
}

const gpu::Texture*
find_texture(std::string_view name, const FrameGraph& graph, const FrameOutput& frame) {
    for (const AovOutput& aov : frame.aovs) {
        if (aov.name == name) {
            return aov.texture;
        }
    }
    const TextureId id = graph.find(name);
    return id.valid() ? graph.texture(id) : nullptr;
}

bool is_unorm8(GLenum format) {
    return gpu::format_info(format).pixel_type == GL_UNSIGNED_BYTE;
}

/// One texel; channels that the format lacks are 0.
Vec4 read_texel(const gpu::Texture& texture, int x, int y) {
    std::array<float, 4> texel = {0, 0, 0, 0};
    const bool depth = gpu::format_info(texture.desc().format).depth;
    glGetTextureSubImage(
        texture.id(), 0, x, y, 0, 1, 1, 1, depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT,
        sizeof(texel), texel.data());
    return {texel[0], texel[1], texel[2], texel[3]};
}

}  // namespace

Result<BufferViewer> BufferViewer::create(gpu::Device& device) {
    const Result<gpu::Pipeline> pipeline = gpu::create_pipeline(
        device, {.vertex = "fullscreen.vert", .fragment = "buffer_viewer.frag"},
        {.depth = {.test = false, .write = false}});
    if (!pipeline) {
        return pipeline.error();
    }
    return BufferViewer(*pipeline);
}

void BufferViewer::select(std::string name) {
    selected_ = std::move(name);
    fit_requested_ = true;
}

void BufferViewer::before_frame(FrameGraph& graph, FrameRequest& request) {
    request.aovs.clear();
    if (open && is_aov(selected_)) {
        request.aovs.push_back(selected_);
    }
    const std::string_view wanted =
        open && !is_aov(selected_) ? std::string_view(selected_) : std::string_view();
    if (kept_name_ == wanted) {
        return;
    }
    if (!kept_name_.empty()) {
        graph.forget_named(kept_name_);
    }
    kept_name_ = wanted;
    if (!kept_name_.empty()) {
        graph.keep_named(kept_name_);
    }
}

void BufferViewer::after_frame(
    gpu::Device& device, const FrameGraph& graph, const FrameOutput& frame) {
    source_ = nullptr;
    if (!open) {
        return;
    }
    const gpu::Texture* texture = find_texture(selected_, graph, frame);
    why_not_shown_ = texture == nullptr ? "not part of this frame" : why_not(*texture);
    if (why_not_shown_[0] != '\0') {
        return;
    }
    if (fit_requested_) {
        fit_range(*texture);
    }
    const gpu::TextureDesc wanted = {
        .format = GL_RGBA8, .width = texture->width(), .height = texture->height()};
    if (!view_ || !(view_.desc() == wanted)) {
        view_ = gpu::Texture("buffer viewer", wanted);
    }
    const gpu::Attachment target = {.texture = &view_};
    const gpu::Framebuffer framebuffer("buffer viewer", {&target, 1});
    device.bind_framebuffer(framebuffer);
    device.use(pipeline_);
    pipeline_.program->set("shown_range", range_);
    pipeline_.program->set("shown_channel", channel_);
    pipeline_.program->set("encode_srgb", srgb_ ? 1 : 0);
    device.bind_texture(layout::kSourceUnit, *texture);
    device.draw_fullscreen();
    source_ = texture;
}

void BufferViewer::fit_range(const gpu::Texture& texture) {
    fit_requested_ = false;
    const gpu::FormatInfo& format = gpu::format_info(texture.desc().format);
    channel_ = format.channels >= 3 ? kAllChannels : 0;
    srgb_ = !is_unorm8(texture.desc().format) && format.channels >= 3;
    range_ = {0, 1};
    if (is_unorm8(texture.desc().format)) {
        return;
    }
    // 1st and 99th percentile of the finite values, so that one bright texel does not darken the
    // rest.
    const gpu::FloatImage image = gpu::read_floats(texture);
    std::vector<float> values;
    values.reserve(image.pixels.size());
    const int channels = std::min(image.channels, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const bool counts =
            static_cast<int>(i % static_cast<std::size_t>(image.channels)) < channels;
        if (counts && std::isfinite(image.pixels[i]) && std::abs(image.pixels[i]) < 1e9f) {
            values.push_back(image.pixels[i]);
        }
    }
    if (values.empty()) {
        return;
    }
    const auto percentile = [&values](std::size_t percent) {
        const auto value =
            values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * percent / 100);
        std::nth_element(values.begin(), value, values.end());
        return *value;
    };
    const float low = percentile(1);
    const float high = percentile(99);
    // Symmetric about zero for signed data, from zero for unsigned data.
    range_ = low < 0.0f ? Vec2(-std::max(-low, high), std::max(-low, high)) : Vec2(0.0f, high);
    srgb_ = srgb_ && low >= 0.0f;
    if (range_.y - range_.x < 1e-12f) {
        range_ = {0, 1};
    }
}

void BufferViewer::draw(const HudStyle& style, const FrameGraph& graph) {
    if (!open) {
        return;
    }
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float width = std::min(0.56f * display.x, 900.0f * style.scale);
    const float height = std::min(0.52f * display.y, 500.0f * style.scale);
    ImGui::SetNextWindowSize({width, height}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowPos(
        {0.5f * display.x, display.y - 14.0f * style.scale}, ImGuiCond_FirstUseEver, {0.5f, 1.0f});
    if (ImGui::Begin("Buffers", &open, ImGuiWindowFlags_NoCollapse)) {
        ImGui::BeginChild("##names", {200.0f * style.scale, 0});
        draw_list(style, graph);
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("##picture");
        draw_mapping(style);
        draw_image(style);
        ImGui::EndChild();
    }
    ImGui::End();
}

void BufferViewer::draw_list(const HudStyle& style, const FrameGraph& graph) {
    std::array<char, 128> label;
    const auto entry = [&](std::string_view name) {
        *fmt::format_to_n(label.data(), label.size() - 1, "{}", name).out = '\0';
        if (ImGui::Selectable(label.data(), name == selected_) && name != selected_) {
            select(std::string(name));
        }
    };
    ImGui::TextColored(kHudDim, "Surfaces");
    ImGui::PushFont(style.numbers);
    for (const std::string_view name : aov_names()) {
        entry(name);
    }
    ImGui::PopFont();
    ImGui::Spacing();
    ImGui::TextColored(kHudDim, "Frame graph");
    ImGui::PushFont(style.numbers);
    for (const std::string_view name : graph.texture_names()) {
        if (!name.starts_with("aov")) {
            entry(name);
        }
    }
    ImGui::PopFont();
}

void BufferViewer::draw_mapping(const HudStyle& style) {
    for (int channel = 0; channel <= kAllChannels; ++channel) {
        if (channel > 0) {
            ImGui::SameLine();
        }
        ImGui::RadioButton(kChannelNames[channel], &channel_, channel);
    }
    ImGui::SameLine(0, 16 * style.scale);
    ImGui::Checkbox("linear light", &srgb_);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 64 * style.scale);
    const float speed = std::max(std::abs(range_.y - range_.x) * 0.005f, 1e-6f);
    ImGui::DragFloatRange2(
        "##range", &range_.x, &range_.y, speed, 0, 0, "black %.4g", "white %.4g");
    if (range_.y <= range_.x) {
        range_.y = range_.x + 1e-6f;
    }
    ImGui::SameLine();
    fit_requested_ = ImGui::Button("Fit", {-1, 0}) || fit_requested_;
}

void BufferViewer::draw_image(const HudStyle& style) {
    if (source_ == nullptr) {
        ImGui::TextColored(kHudDim, "%s", why_not_shown_);
        return;
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float aspect = static_cast<float>(view_.width()) / static_cast<float>(view_.height());
    const float width = std::max(std::min(room.x, (room.y - line) * aspect), 16.0f);
    const ImVec2 size = {width, width / aspect};
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Image(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(view_.id())), size, {0, 1},
        {1, 0});

    const gpu::FormatInfo& format = gpu::format_info(source_->desc().format);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const int x = static_cast<int>((mouse.x - at.x) / size.x * static_cast<float>(view_.width()));
    const int y = static_cast<int>((mouse.y - at.y) / size.y * static_cast<float>(view_.height()));
    const bool inside =
        ImGui::IsItemHovered() && x >= 0 && y >= 0 && x < view_.width() && y < view_.height();
    ImGui::PushFont(style.numbers);
    if (inside) {
        const Vec4 texel = read_texel(*source_, x, view_.height() - 1 - y);
        ImGui::TextColored(
            kHudAccent, "(%d, %d)  %.5g  %.5g  %.5g  %.5g", x, y, texel.x, texel.y, texel.z,
            texel.w);
    } else {
        ImGui::TextColored(kHudDim, "%d x %d  %s", view_.width(), view_.height(), format.name);
    }
    ImGui::PopFont();
}

}  // namespace limn
