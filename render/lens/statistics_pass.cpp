#include "render/lens/statistics_pass.h"

#include "render/gpu/shader_library.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/tone_gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

// Techniques: hdr.defog, hdr.log-average

namespace limn {
namespace {}  // namespace

Result<StatisticsPass> create_statistics_pass(gpu::Device& device) {
    StatisticsPass pass = {
        ProgramVariants(device, {.compute = "image_statistics.comp"}),
        ProgramVariants(device, {.compute = "image_measure.comp"})};
    LIMN_TRY(pass.parts.load());
    LIMN_TRY(pass.join.load());
    const layout::ImageStatistics initial{};
    pass.measure =
        gpu::Buffer("image statistics", sizeof(initial), gpu::BufferUse::GpuOnly, &initial);
    const std::vector<std::uint32_t> empty(layout::kHistogramBins);
    pass.histogram = gpu::Buffer(
        "luminance histogram", empty.size() * sizeof(std::uint32_t), gpu::BufferUse::GpuOnly,
        empty.data());
    return pass;
}

float adaptation_blend(float adaptation, float seconds) {
    return adaptation > 0.0f ? 1.0f - std::exp(-std::max(seconds, 0.0f) / adaptation) : 1.0f;
}

BufferId measure_image(
    FrameGraph& graph, StatisticsPass& pass, TextureId radiance, const MeasureRequest& request) {
    Variant variant;
    variant.add_if(request.histogram, "HISTOGRAM");
    const gpu::Program* const join = pass.join.get(variant);
    variant.add_if(request.depth.valid(), "SURFACES");
    const gpu::Program* const sum = pass.parts.get(variant);

    const TextureSpec source = graph.spec(radiance);
    const auto tiles = [](int size) {
        return (size + layout::kStatisticsTile - 1) / layout::kStatisticsTile;
    };
    const IVec2 groups = {tiles(source.width), tiles(source.height)};
    const int count = groups.x * groups.y * layout::kStatisticsGroup * layout::kStatisticsGroup;
    const BufferId parts = graph.create_buffer(
        {.name = "statistics", .bytes = sizeof(layout::StatisticsPart) * count});
    const BufferId histogram = graph.import("luminance histogram", pass.histogram);
    const BufferId measure = graph.import("image statistics", pass.measure);

    std::vector<Use> reads = {sampled(radiance, layout::kSourceUnit)};
    if (request.depth.valid()) {
        reads.push_back(sampled(request.depth, layout::kStatisticsDepthUnit));
    }
    const float log_delta = std::min(layout::kLogDelta, request.adaptation_range.x);
    const std::array<Use, 2> writes = {parts, histogram};
    graph.add_pass(
        "statistics", std::span(reads), std::span(writes),
        [sum, parts, histogram, groups, log_delta](PassContext& context) {
            if (sum == nullptr) {
                return;
            }
            context.device().use(*sum);
            sum->set("log_delta", log_delta);
            context.bind_storage(layout::kStatisticsPartsBinding, parts);
            context.bind_storage(layout::kHistogramBinding, histogram);
            context.device().dispatch(groups.x, groups.y);
        });
    graph.add_pass(
        "statistics, joined", {parts}, {histogram, measure},
        [join, request, parts, histogram, measure, count, log_delta](PassContext& context) {
            if (join == nullptr) {
                return;
            }
            const gpu::Program& program = *join;
            context.device().use(program);
            program.set("part_count", count);
            program.set("log_delta", log_delta);
            program.set("key", request.key);
            program.set("adaptation_blend", request.blend);
            program.set("adaptation_range", request.adaptation_range);
            program.set("clipped_fraction", request.clipped_share);
            context.bind_storage(layout::kStatisticsPartsBinding, parts);
            context.bind_storage(layout::kHistogramBinding, histogram);
            context.bind_storage(layout::kStatisticsBinding, measure);
            context.device().dispatch(1);
        });
    return measure;
}

}  // namespace limn
