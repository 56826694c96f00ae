#pragma once

#include "ecs/components/texture_feedback.h"
#include "render/effect.h"
#include "render/gpu/texture.h"

#include <cstdint>
#include <vector>

namespace limn {

// Images that are computed from their previous states (TextureFeedback, tex.feedback).
//
// Reads    the start image of every TextureFeedback
// Writes   its target, with mip levels
// Order    before surfaces are drawn
// Shaders  texture_feedback.comp, texture_feedback.frag
//
// A step reads one texture and writes another, and they change places: reading and writing one
// would be undefined, and the frame graph refuses it. The steps of a frame are those that the time
// shown asks for, so that an image does not depend on the frame rate; going back in time starts
// anew.

/// Steps that one frame takes at most; the next ones take what remains.
inline constexpr std::int64_t kMaxFeedbackSteps = 4096;

struct TextureFeedbackEffect {
    /// The state of one TextureFeedback.
    struct State {
        gpu::Texture textures[2];
        TextureFeedback settings;  ///< that it was computed with
        int newest = 0;            ///< of `textures`
        std::int64_t steps = -1;   ///< since the start; -1: not started
    };
    const gpu::Program* step = nullptr;
    const gpu::Program* show = nullptr;
    gpu::Sampler nearest;
    std::vector<State> states{};
    std::uint64_t assets = 0;  ///< identity of those that `states` belong to

    static Result<TextureFeedbackEffect> create(gpu::Device& device, const RenderSettings&);
    static bool is_used(const FrameData& frame);
    void collect(FrameData& frame);
    void draw_shared(FrameGraph& graph, const FrameData& frame);

  private:
    void draw_one(
        FrameGraph& graph, const FrameData& frame, const TextureFeedback& settings, State& state);
    void add_steps(
        FrameGraph& graph, const FrameData& frame, const TextureFeedback& settings, State& state,
        std::int64_t end);
};

}  // namespace limn
