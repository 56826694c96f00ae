#pragma once

#include "ecs/base/math.h"
#include "render/effect.h"

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

// G-buffer attributes as plain numbers, for image files and the buffer viewer; and the shadow map
// resolution at each pixel (shadow.map-aliasing).
//
// Reads    G-buffer, records of the shadow views
// Writes   RGBA32F, named "aov.<name>"; shadow volume layers come from their own pass
// Order    after all that draws into the G-buffer
// Shaders  aov.frag

inline constexpr int kAovCount = 7;

struct Aov {
    std::string_view name;
    int channels;
    Vec4 background;  ///< value where there is no surface
};
/// In the order of AOV in aov.frag.
extern const std::array<Aov, kAovCount> kAovs;

struct AovEffect {
    ProgramVariants programs;
    const FrameGraph* graph = nullptr;                  ///< of the last frame
    std::vector<std::pair<int, TextureId>> textures{};  ///< those requested: index into kAovs

    static Result<AovEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame) { return !frame.aovs.empty(); }
    void collect(FrameData& frame);
    void draw(FrameGraph& graph, const FrameData& frame, ViewData& view);
    void report(const FrameData& frame, const ViewData& view, FrameOutput& out);
};

}  // namespace limn
