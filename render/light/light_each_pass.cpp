#include "render/light/light_each_pass.h"

#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/light/light_clusters.h"
#include "render/light/lighting.h"
#include "render/shaders/gbuffer_gpu.h"

#include <array>

// Techniques: deferred.light-volume, light.volume-stencil

namespace limn {
namespace {

constexpr int kSphereVertices = 4 * 8 * 6;
constexpr int kConeVertices = 2 * 8 * 3;
constexpr float kMinConeCosine =
    0.5f;  ///< of the half angle; below, a cone is no tighter than the sphere

constexpr gpu::PipelineState kAddOverSurfaces = {
    .depth = {.test = true, .write = false, .func = GL_LESS},
    .blend = gpu::kBlendAdd,
    .cull = GL_NONE};
constexpr gpu::PipelineState kCountSides = {
    .depth = {.test = true, .write = false},
    .stencil =
        {.test = true, .front = {.depth_fail = GL_DECR_WRAP}, .back = {.depth_fail = GL_INCR_WRAP}},
    .cull = GL_NONE,
    .color_mask = 0};
constexpr gpu::PipelineState kAddWhereCounted = {
    .depth = {.test = false, .write = false},
    .blend = gpu::kBlendAdd,
    .stencil =
        {.test = true,
         .front = {.func = GL_NOTEQUAL, .pass = GL_ZERO},
         .back = {.func = GL_NOTEQUAL, .pass = GL_ZERO}},
    .cull = GL_FRONT};

const gpu::Program*
one_light_program(ProgramVariants& programs, const ViewData& view, const char* definition) {
    Variant variant = view.lighting.variant;
    if (definition != nullptr) {
        variant.add(definition);
    }
    return programs.get(variant);
}

void add_over_screen(
    gpu::Device& device, LightEachPass& pass, const ViewData& view, int light, bool directional) {
    const gpu::Program* program =
        one_light_program(pass.screen, view, directional ? "DIRECTIONAL_LIGHT" : nullptr);
    if (program != nullptr) {
        device.use(gpu::Pipeline{program, kAddOverSurfaces});
        program->set("light_index", light);
        device.draw_fullscreen();
    }
}

void add_in_volume(
    gpu::Device& device, LightEachPass& pass, const ViewData& view, int light,
    const LightRange& reach) {
    const bool cone = reach.cosine > kMinConeCosine;
    const float sine = std::sqrt(std::max(1 - square(reach.cosine), 0.0f));
    const Vec4 sphere = Vec4(reach.center, reach.radius);
    const Vec4 axis = cone ? Vec4(reach.axis, sine / reach.cosine) : Vec4(0, 1, 0, 0);
    const gpu::Program* shade = one_light_program(pass.volume, view, cone ? "CONE" : nullptr);
    if (shade == nullptr) {
        return;
    }
    for (const auto& [program, state] :
         {std::pair(pass.count[cone ? 1 : 0], kCountSides), std::pair(shade, kAddWhereCounted)}) {
        device.use(gpu::Pipeline{program, state});
        program->set("volume_sphere", sphere);
        program->set("volume_axis", axis);
        program->set("light_index", light);
        device.draw_ids(cone ? kConeVertices : kSphereVertices);
    }
}

/// What the light shaders read and test: G-buffer and depth. Volumes write the stencil of the depth
/// buffer, and OpenGL leaves sampling its depth at the same time undefined: they sample a copy.
std::vector<Use> gbuffer_reads(FrameGraph& graph, const ViewData& view) {
    const TextureId depth = view.gbuffer.depth;
    if (view.data.get<LightingMethod>().method != LightMethod::Volumes) {
        return surface_reads(view, sampled(depth_tested(depth), layout::kDepthUnit));
    }
    const TextureId copy = graph.create(
        {.name = "lights.depth",
         .format = graph.spec(depth).format,
         .width = view.camera.width,
         .height = view.camera.height});
    graph.add_pass("lights.depth", {depth}, {image(copy)}, [depth, copy](PassContext& context) {
        const gpu::Texture& from = context.texture(depth);
        const gpu::Texture& to = context.texture(copy);
        glCopyImageSubData(
            from.id(), GL_TEXTURE_2D, 0, 0, 0, 0, to.id(), GL_TEXTURE_2D, 0, 0, 0, 0, from.width(),
            from.height(), 1);
    });
    std::vector<Use> reads = surface_reads(view, sampled(copy, layout::kDepthUnit));
    reads.push_back(depth_tested(depth));
    return reads;
}

}  // namespace

Result<LightEachPass> create_light_each_pass(gpu::Device& device) {
    LightEachPass pass = {
        .base = ProgramVariants::fullscreen(device, "light_base.frag"),
        .screen = ProgramVariants::fullscreen(device, "light_one.frag"),
        .volume =
            ProgramVariants(device, {.vertex = "light_volume.vert", .fragment = "light_one.frag"})};
    for (int cone = 0; cone < 2; ++cone) {
        gpu::ProgramDesc desc = {.vertex = "light_volume.vert", .fragment = "nothing.frag"};
        if (cone == 1) {
            desc.defines.push_back({"CONE"});
        }
        pass.count[cone] = LIMN_TRY(device.shaders().load(desc));
    }
    return pass;
}

void draw_each_light(FrameGraph& graph, LightEachPass& pass, const ViewData& view) {
    const std::vector<Use> reads = gbuffer_reads(graph, view);
    const Use base[] = {cleared(view.radiance)};
    graph.add_pass("lights.base", std::span(reads), base, [&pass, &view](PassContext& context) {
        if (const gpu::Program* program = pass.base.get(view.lighting.variant)) {
            context.device().use(gpu::Pipeline{program, kWhereSurfaces});
            bind_lighting(context, view);
            context.device().draw_fullscreen();
        }
    });
    const Use writes[] = {view.radiance};
    graph.add_pass("lights.each", std::span(reads), writes, [&pass, &view](PassContext& context) {
        bind_lighting(context, view);
        bind_shadow_masks(context, view);
        const auto& lights = view.data.get<LightList>();
        const LightMethod method = view.data.get<LightingMethod>().method;
        for (int i = 0; i < lights.directional; ++i) {
            add_over_screen(context.device(), pass, view, i, true);
        }
        for (const layout::ClusterLight& placed : view.data.get<ClusterLights>().lights) {
            const int light = static_cast<int>(placed.axis.w);
            const LightRange& reach = lights.reach[light - lights.directional];
            if (method == LightMethod::Volumes && std::isfinite(reach.radius)) {
                add_in_volume(context.device(), pass, view, light, reach);
            } else {
                add_over_screen(context.device(), pass, view, light, false);
            }
        }
    });
}

}  // namespace limn
