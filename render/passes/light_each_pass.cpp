#include "render/passes/light_each_pass.h"

#include "render/gpu/shader_library.h"

#include <array>

namespace limn {
namespace {

constexpr int kBallCorners = 4 * 8 * 6;
constexpr int kConeCorners = 2 * 8 * 3;
constexpr float kWidestCone =
    0.5f;  ///< cosine of half a cone whose pyramid is no better than a ball
constexpr std::uint32_t kDirectional = 1u << 16;  ///< beside lighting_key()
constexpr std::uint32_t kCone = 1u << 17;

/// Where a surface is; light_pass.cpp says why.
constexpr gpu::PipelineState kOverSurfaces = {
    .depth = {.test = true, .write = false, .func = GL_LESS}, .cull = GL_NONE};
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
one_light_program(SurfacePrograms& programs, const FrameScene& scene, std::uint32_t more) {
    std::vector<gpu::ShaderDefine> defines = lighting_defines(scene);
    if ((more & kDirectional) != 0) {
        defines.push_back({"DIRECTIONAL_LIGHT"});
    }
    if ((more & kCone) != 0) {
        defines.push_back({"CONE"});
    }
    return programs.get(0, lighting_key(scene) | more, defines);
}

void add_over_screen(
    gpu::Device& device, LightEachPass& pass, const FrameScene& scene, int light,
    bool directional) {
    const gpu::Program* program =
        one_light_program(pass.screen, scene, directional ? kDirectional : 0);
    if (program != nullptr) {
        device.use(gpu::Pipeline{program, kAddOverSurfaces});
        program->set("light_index", light);
        device.draw_fullscreen();
    }
}

void add_in_volume(
    gpu::Device& device, LightEachPass& pass, const FrameScene& scene, int light,
    const LightReach& reach) {
    const bool cone = reach.cosine > kWidestCone;
    const float sine = std::sqrt(std::max(1 - square(reach.cosine), 0.0f));
    const Vec4 sphere = Vec4(reach.center, reach.radius);
    const Vec4 axis = cone ? Vec4(reach.axis, sine / reach.cosine) : Vec4(0, 1, 0, 0);
    const gpu::Program* shade = one_light_program(pass.volume, scene, cone ? kCone : 0);
    if (shade == nullptr) {
        return;
    }
    for (const auto& [program, state] :
         {std::pair(pass.count[cone ? 1 : 0], kCountSides), std::pair(shade, kAddWhereCounted)}) {
        device.use(gpu::Pipeline{program, state});
        program->set("volume_sphere", sphere);
        program->set("volume_axis", axis);
        program->set("light_index", light);
        device.draw_ids(cone ? kConeCorners : kBallCorners);
    }
}

}  // namespace

Result<LightEachPass> create_light_each_pass(gpu::Device& device) {
    LightEachPass pass = {
        .base = SurfacePrograms(device, "fullscreen.vert", "light_base.frag"),
        .screen = SurfacePrograms(device, "fullscreen.vert", "light_one.frag"),
        .volume = SurfacePrograms(device, "light_volume.vert", "light_one.frag")};
    for (int cone = 0; cone < 2; ++cone) {
        gpu::ProgramDesc desc = {.vertex = "light_volume.vert", .fragment = "nothing.frag"};
        if (cone == 1) {
            desc.defines.push_back({"CONE"});
        }
        const Result<const gpu::Program*> count = device.shaders().load(desc);
        if (!count) {
            return count.error();
        }
        pass.count[cone] = *count;
    }
    return pass;
}

TextureId draw_each_light(
    FrameGraph& graph, LightEachPass& pass, const FrameScene& scene, const Gbuffer& gbuffer) {
    const TextureId radiance = graph.create(
        {.name = "radiance",
         .format = scene.radiance_format,
         .width = scene.view.width,
         .height = scene.view.height});
    const auto bind = [&scene, gbuffer](PassContext& context) {
        bind_lighting(context.device(), scene);
        context.bind_texture(kGbufferUnit, gbuffer.surface);
        context.bind_texture(kDepthUnit, gbuffer.depth);
    };
    graph.add_pass(
        "lights.base", {gbuffer.surface, depth_tested(gbuffer.depth)}, {cleared(radiance)},
        [&pass, &scene, bind](PassContext& context) {
            const gpu::Program* program =
                pass.base.get(0, lighting_key(scene), lighting_defines(scene));
            if (program != nullptr) {
                context.device().use(gpu::Pipeline{program, kOverSurfaces});
                bind(context);
                context.device().draw_fullscreen();
            }
        });
    const std::vector<Use> reads =
        lighting_reads(scene, {gbuffer.surface, depth_tested(gbuffer.depth)});
    const Use writes[] = {radiance};
    graph.add_pass(
        "lights.each", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene, bind](PassContext& context) {
            bind(context);
            bind_shadow_masks(context, scene);
            const LightList& lights = scene.lights;
            for (int i = 0; i < lights.directional; ++i) {
                add_over_screen(context.device(), pass, scene, i, true);
            }
            for (const layout::ClusterLight& placed : scene.clusters.lights) {
                const int light = static_cast<int>(placed.axis.w);
                const LightReach& reach = lights.reach[light - lights.directional];
                if (scene.method == LightMethod::Volumes && std::isfinite(reach.radius)) {
                    add_in_volume(context.device(), pass, scene, light, reach);
                } else {
                    add_over_screen(context.device(), pass, scene, light, false);
                }
            }
        });
    return radiance;
}

}  // namespace limn
