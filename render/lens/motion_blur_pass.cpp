#include "render/lens/motion_blur_pass.h"

#include "ecs/base/log.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/motion_blur_gpu.h"
#include "render/view_block.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

// Techniques: post.motion-blur-reconstruct
// Source of post.motion-blur-reconstruct: McGuire et al. 2012; Guertin et al. 2014

namespace limn {
namespace {

constexpr int kMinTile = 16;       // side [px]
constexpr int kMaxTileRadius = 4;  // tiles that the longest blur crosses to either side

/// Tile size for the longest blur to either side of a pixel, and how many tiles it crosses.
struct Tiling {
    float longest = 0;  ///< [px]
    int side = kMinTile;
    int radius = 1;
};

Tiling make_tiling(const MotionBlur& settings, int height) {
    Tiling tiling;
    tiling.longest = std::max(0.5f * settings.max_length * static_cast<float>(height), 1.0f);
    const int longest = static_cast<int>(std::ceil(tiling.longest));
    tiling.side = std::max(kMinTile, (longest + kMaxTileRadius - 1) / kMaxTileRadius);
    tiling.radius = (longest + tiling.side - 1) / tiling.side;
    return tiling;
}

/// Maximum motion of each tile, separably: along rows first, then along columns.
TextureId find_longest(
    FrameGraph& graph, const gpu::Program* program, int side, TextureId source, bool first) {
    const IVec2 size = size_of(graph, source);
    const auto tiles = [side](int pixels) { return (pixels + side - 1) / side; };
    const IVec2 along = first ? IVec2(1, 0) : IVec2(0, 1);
    const TextureId longest = create_target(
        graph, first ? "motion blur.rows" : "motion blur.tiles", GL_RGBA32F,
        first ? IVec2(tiles(size.x), size.y) : IVec2(size.x, tiles(size.y)));
    add_fullscreen_pass(
        graph, first ? "motion blur, rows" : "motion blur, tiles",
        {sampled(source, layout::kSourceUnit)}, {discarded(longest)}, program,
        [side, along, first](PassContext&, const gpu::Program& shader) {
            shader.set("along", along);
            shader.set("side", side);
            shader.set("first", first ? 1 : 0);
        });
    return longest;
}

Result<MotionMethod> create_method(gpu::Device& device, MotionBlurMode mode) {
    switch (mode) {
    case MotionBlurMode::Reconstruct:
        return MotionMethod(LIMN_TRY(MotionReconstruct::create(device)));
    case MotionBlurMode::Accumulate:
        return MotionMethod(LIMN_TRY(MotionAccumulate::create(device)));
    case MotionBlurMode::Camera:
        return MotionMethod(LIMN_TRY(MotionCamera::create(device)));
    case MotionBlurMode::Flow:
        return MotionMethod(LIMN_TRY(MotionFlow::create(device)));
    case MotionBlurMode::Stretch:
        return MotionMethod(LIMN_TRY(MotionStretch::create(device)));
    }
    return MotionMethod();
}

}  // namespace

Result<MotionReconstruct> MotionReconstruct::create(gpu::Device& device) {
    return MotionReconstruct{
        LIMN_TRY(load_fullscreen(device, "motion_pack.frag")),
        LIMN_TRY(load_fullscreen(device, "motion_tile.frag")),
        LIMN_TRY(load_fullscreen(device, "motion_neighbor.frag")),
        LIMN_TRY(load_fullscreen(device, "motion_blur.frag"))};
}

TextureId
MotionReconstruct::blur(FrameGraph& graph, const MotionBlur& settings, const ViewData& view, bool) {
    const TextureId velocity = view.gbuffer.velocity;
    LIMN_CHECK(velocity.valid());
    const Tiling tiling = make_tiling(settings, size_of(graph, view.radiance).y);
    const TextureId motion =
        create_target(graph, "motion blur.motion", GL_RGBA32F, size_of(graph, velocity));
    add_fullscreen_pass(
        graph, "motion blur, pack",
        {sampled(velocity, layout::kPackVelocityUnit),
         sampled(view.gbuffer.depth, layout::kPackDepthUnit)},
        {discarded(motion)}, pack,
        [&view, longest = tiling.longest,
         half_share = half_exposure(settings)](PassContext& context, const gpu::Program& program) {
            bind_view(context, view);
            program.set("half_exposure", half_share);
            program.set("longest", longest);
        });
    const TextureId rows = find_longest(graph, tile, tiling.side, motion, true);
    const TextureId tiles = find_longest(graph, tile, tiling.side, rows, false);
    const TextureId neighbors =
        create_target(graph, "motion blur.neighbors", GL_RGBA32F, size_of(graph, tiles));
    add_fullscreen_pass(
        graph, "motion blur, neighbors", {sampled(tiles, layout::kSourceUnit)},
        {discarded(neighbors)}, neighbor, [tiling](PassContext&, const gpu::Program& program) {
            program.set("side", tiling.side);
            program.set("radius", tiling.radius);
        });
    const TextureId blurred = create_like(graph, "motion blur", view.radiance);
    add_fullscreen_pass(
        graph, "motion blur",
        {sampled(view.radiance, layout::kSourceUnit), sampled(motion, layout::kMotionUnit),
         sampled(neighbors, layout::kMotionNeighborsUnit)},
        {discarded(blurred)}, gather,
        [side = tiling.side,
         samples = std::clamp(settings.samples, 4, 64)](PassContext&, const gpu::Program& program) {
            program.set("side", side);
            program.set("samples", samples);
        });
    return blurred;
}

bool MotionBlurEffect::is_used(const FrameData& frame) {
    const auto* blur = frame.world->find_resource<MotionBlur>();
    const bool open = blur != nullptr && blur->shutter > 0.0f && blur->max_length > 0.0f;
    if (!open || frame.kind != kSampleView) {
        return open;
    }
    return frame.sample == SampleKind::Played && !needs_previous_frames(blur->mode);
}

void MotionBlurEffect::collect(FrameData& frame) {
    settings = *frame.world->find_resource<MotionBlur>();
    frame.velocity |= settings.mode == MotionBlurMode::Reconstruct
                      || settings.mode == MotionBlurMode::Flow
                      || settings.mode == MotionBlurMode::Stretch;
}

void MotionBlurEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    if (created != settings.mode) {
        created = settings.mode;
        Result<MotionMethod> made = create_method(*frame.device, settings.mode);
        if (!made) {
            log_error("{}", made.error().message);
        }
        method = made ? *std::move(made) : MotionMethod();
    }
    const bool follows = last_frame + 1 == frame.number && frame.since_last.has_value();
    last_frame = frame.number;
    std::visit(
        [&](auto& chosen) {
            if constexpr (!std::is_same_v<decltype(chosen), std::monostate&>) {
                view.radiance = chosen.blur(graph, settings, view, follows);
            }
        },
        method);
}

}  // namespace limn
