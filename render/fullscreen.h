#pragma once

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"

#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

/// Half resolution, rounded up for odd sizes.
[[nodiscard]] inline IVec2 half_resolution(const IVec2& size) {
    return (size + 1) / 2;
}

[[nodiscard]] inline IVec2 size_of(const FrameGraph& graph, TextureId texture) {
    const TextureSpec spec = graph.spec(texture);
    return {spec.width, spec.height};
}

/// A texture for a pass to draw into.
[[nodiscard]] inline TextureId create_target(
    FrameGraph& graph, std::string_view name, GLenum format, const IVec2& size, int levels = 1) {
    return graph.create(
        {.name = name, .format = format, .width = size.x, .height = size.y, .levels = levels});
}
/// The same, of the format and size of `other`.
[[nodiscard]] inline TextureId
create_like(FrameGraph& graph, std::string_view name, TextureId other) {
    return create_target(graph, name, graph.spec(other).format, size_of(graph, other));
}

/// The program of a shader that runs once per pixel.
[[nodiscard]] inline Result<const gpu::Program*> load_fullscreen(
    gpu::Device& device, const char* fragment, std::vector<gpu::ShaderDefine> defines = {}) {
    return device.shaders().load(
        {.vertex = "fullscreen.vert", .fragment = fragment, .defines = std::move(defines)});
}

/// Adds a pass that runs `program` once per pixel of its targets. Reads made by sampled() are bound
/// to their units; `set(context, program)` sets uniforms and binds resources outside the graph. A
/// null program draws nothing.
template <typename Set>
void add_fullscreen_pass(
    FrameGraph& graph, std::string_view name, std::initializer_list<Use> reads,
    std::initializer_list<Use> writes, const gpu::Program* program, const gpu::PipelineState& state,
    Set set) {
    graph.add_pass(name, reads, writes, [program, state, set](PassContext& context) {
        if (program != nullptr) {
            context.device().use(gpu::Pipeline{program, state});
            set(context, *program);
            context.device().draw_fullscreen();
        }
    });
}

/// The same with the usual state: no depth test, no blending.
template <typename Set>
void add_fullscreen_pass(
    FrameGraph& graph, std::string_view name, std::initializer_list<Use> reads,
    std::initializer_list<Use> writes, const gpu::Program* program, Set set) {
    add_fullscreen_pass(graph, name, reads, writes, program, gpu::kFullscreenState, set);
}

inline void add_fullscreen_pass(
    FrameGraph& graph, std::string_view name, std::initializer_list<Use> reads,
    std::initializer_list<Use> writes, const gpu::Program* program) {
    add_fullscreen_pass(
        graph, name, reads, writes, program, [](PassContext&, const gpu::Program&) {});
}

}  // namespace limn
