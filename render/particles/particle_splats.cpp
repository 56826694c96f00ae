#include "render/particles/particle_splats.h"

#include "ecs/components/particles.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/shaders/fullscreen_gpu.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

// Techniques: particle.gpu-draw, particle.million

namespace limn {
namespace {

constexpr unsigned kAddGroup = 64;    // pixels of a row
constexpr float kMaxSteps = 1 << 17;  // units per point and pixel; less for more than 32,768 points
constexpr float kLargestSum = 4.29e9f;  // a little less than the maximum of 32 bits

bool is_positive(float x) {
    return x > 0 && std::isfinite(x);
}

}  // namespace

ParticleSplats create_particle_splats(gpu::Device& device) {
    return {
        .splat = ProgramVariants(device, {.compute = "particle_splat.comp"}),
        .add = ProgramVariants(device, {.compute = "particle_splat_add.comp"})};
}

bool can_be_splats(const GpuParticlePool& pool, const LookRecord& look) {
    const float softness = look[1].z;
    const float lit = look[2].y;
    const float cover = look[2].z;
    return !pool.sorted && is_point(look) && lit == 0 && cover == 0 && softness == 0;
}

float max_light(const LookRecord& look) {
    Vec4 top = {0, 0, 0, 0};
    for (std::uint32_t i = 0; i < layout::kLookSamples; ++i) {
        top = glm::max(top, look[layout::kLookColors + i]);
    }
    const Vec4& varied = look[layout::kLookMore + 3];
    const float color = std::max({top.x + varied.y, top.y + varied.z, top.z + varied.w});
    const float brightest = look[2].x * color * top.w;
    return is_positive(brightest) ? brightest : 0;
}

bool is_steady(const LookRecord& look) {
    const Vec4 sizes = look[layout::kLookSizes];
    bool steady = look[2].w == static_cast<float>(ParticleFacing::Point);
    for (std::uint32_t i = layout::kLookSizes; i < layout::kLookColors; ++i) {
        steady = steady && look[i] == Vec4(sizes.x);
    }
    for (std::uint32_t i = 0; i < layout::kLookSamples; ++i) {
        steady = steady && look[layout::kLookColors + i] == look[layout::kLookColors];
    }
    const Vec4& fades = look[layout::kLookMore];
    const Vec4& wave = look[layout::kLookMore + 2];
    const Vec4& varied = look[layout::kLookMore + 3];
    return steady && fades.y == 0 && fades.z == 0 && look[layout::kLookMore + 1].w == 0
           && wave.y == 0 && wave.z == 0 && Vec3(varied.y, varied.z, varied.w) == Vec3(0);
}

SplatPrograms begin_particle_splats(
    ParticleSplats& splats, const ViewData& view, std::size_t count, float brightest) {
    const float largest = kLargestSum / static_cast<float>(std::max<std::size_t>(count, 1));
    splats.max_amount = std::max(std::min(kMaxSteps, largest) - 1, 1.0f);  // rounding may add one
    splats.unit = brightest > 0 ? splats.max_amount / brightest : 1;
    const IVec2 size = view.size();
    const std::size_t words =
        3 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    if (splats.sums.size() < words * sizeof(std::uint32_t)) {
        const std::vector<std::uint32_t> zeros(words);
        splats.sums = gpu::Buffer::of("sums of particles", std::span(zeros));
    }
    return {splats.splat.get({}), splats.splat.get(Variant("STEADY"))};
}

void draw_particle_splats(
    PassContext& context, const SplatPrograms& programs, const ParticleSplats& splats,
    const GpuParticlePool& pool, const LookRecord& look) {
    const bool steady = is_steady(look);
    const gpu::Program* const program = steady ? programs.steady : programs.any;
    if (program == nullptr) {
        return;
    }
    gpu::Device& device = context.device();
    device.use(*program);
    device.bind_storage(layout::kSplatSumsBinding, splats.sums);
    program->set("count", static_cast<int>(pool.count));
    program->set("unit", splats.unit);
    program->set("max_amount", splats.max_amount);
    if (steady) {
        const Vec4& color = look[layout::kLookColors];
        program->set("size_spread", Vec2(look[0]) * look[layout::kLookSizes].x);
        program->set("steady_color", Vec4(Vec3(color) * look[2].x, color.w));
    }
    device.dispatch((pool.count + layout::kParticleGroup - 1) / layout::kParticleGroup);
}

void add_particle_sums(FrameGraph& graph, ParticleSplats& splats, ViewData& view) {
    Variant variant;
    variant.add_if(view.frame->radiance_format == GL_RGBA32F, "FULL_FLOATS");
    const gpu::Program* const program = splats.add.get(variant);
    const BufferId sums = graph.import("sums of particles", splats.sums);
    const TextureId radiance = view.radiance;
    const auto run = [&splats, program, sums, radiance](PassContext& context) {
        if (program == nullptr) {
            return;
        }
        context.device().use(*program);
        context.bind_storage(layout::kSplatSumsBinding, sums);
        context.bind_image(layout::kTargetImage, radiance, GL_READ_WRITE);
        program->set("unit", splats.unit);
        const gpu::Texture& target = context.texture(radiance);
        context.device().dispatch(
            (static_cast<unsigned>(target.width()) + kAddGroup - 1) / kAddGroup,
            static_cast<unsigned>(target.height()));
    };
    graph.add_pass("particles.sums", {}, {sums, image(radiance)}, run);
}

}  // namespace limn
