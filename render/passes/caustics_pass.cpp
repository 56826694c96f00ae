#include "render/passes/caustics_pass.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr unsigned kJobsUnit = 20;
constexpr unsigned kRaysBinding = 0;
constexpr unsigned kLightBinding = 1;
constexpr unsigned kMapsImage = 0;
constexpr unsigned kGroup = 64;  ///< texels of a work group
constexpr std::uint32_t kOceanKey = 1u << 31;

gpu::Texture make_atlas(const IVec2& size) {
    return {"caustic maps", {.format = GL_R32F, .width = size.x, .height = size.y}};
}

/// Null, and said once, if it does not compile.
const gpu::Program*
rays_program(CausticsPass& pass, gpu::Device& device, const FrameScene& scene, bool ocean) {
    const std::uint32_t key = lighting_key(scene) | (ocean ? kOceanKey : 0);
    const auto found = pass.rays.find(key);
    if (found != pass.rays.end()) {
        return found->second;
    }
    std::vector<gpu::ShaderDefine> defines = lighting_defines(scene);
    if (ocean) {
        defines.push_back({"OCEAN"});
    }
    const Result<const gpu::Program*> program =
        device.shaders().load({.compute = "caustics_rays.comp", .defines = defines});
    if (!program) {
        log_error("{}", program.error().message);
    }
    return pass.rays[key] = program ? *program : nullptr;
}

void use_with_jobs(gpu::Device& device, const CausticsPass& pass, const gpu::Program& program) {
    device.use(program);
    program.set("groups", pass.list.groups);
    pass.jobs.bind(device, kJobsUnit);
}

/// Transient sums, then the maps.
void sum_on_gpu(FrameGraph& graph, CausticsPass& pass, BufferId rays, TextureId made) {
    const auto width = static_cast<unsigned>(pass.list.atlas.x);
    const auto height = static_cast<unsigned>(pass.list.atlas.y);
    const std::size_t bytes = std::size_t{width} * height * sizeof(std::uint32_t);
    const BufferId light = graph.create_buffer({"caustics.light", bytes});
    graph.add_pass("caustic splats", {rays}, {light}, [=, &pass](PassContext& context) {
        gpu::Device& device = context.device();
        const std::uint32_t none = 0;
        glClearNamedBufferSubData(
            context.buffer(light).id(), GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER,
            GL_UNSIGNED_INT, &none);
        use_with_jobs(device, pass, *pass.splat);
        pass.splat->set("width", static_cast<int>(width));
        context.bind_storage(kRaysBinding, rays);
        context.bind_storage(kLightBinding, light);
        device.dispatch(static_cast<unsigned>(pass.list.groups));
    });
    graph.add_pass("caustic maps", {light}, {image(made)}, [=, &pass](PassContext& context) {
        gpu::Device& device = context.device();
        device.use(*pass.map);
        context.bind_storage(kLightBinding, light);
        context.bind_image(kMapsImage, made, GL_WRITE_ONLY);
        device.dispatch((width + kGroup - 1) / kGroup, height);
    });
}

void sum_on_cpu(FrameGraph& graph, CausticsPass& pass, BufferId rays, TextureId made) {
    graph.add_pass("caustic splats", {rays}, {image(made)}, [=, &pass](PassContext& context) {
        const CausticList& list = pass.list;
        pass.rays_on_cpu.resize(list.rays);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        context.buffer(rays).read(0, std::as_writable_bytes(std::span(pass.rays_on_cpu)));
        pass.atlas_on_cpu.resize(
            static_cast<std::size_t>(list.atlas.x) * static_cast<std::size_t>(list.atlas.y));
        splat_caustics(
            list.maps, pass.rays_on_cpu, list.atlas.x, pass.sums_on_cpu, pass.atlas_on_cpu);
        pass.maps.upload<float>(pass.atlas_on_cpu, GL_RED, GL_FLOAT);
    });
}

}  // namespace

Result<CausticsPass> create_caustics_pass(gpu::Device& device) {
    CausticsPass pass;
    pass.on_cpu = device.caps().software;
    pass.maps = make_atlas({1, 1});
    const Result<const gpu::Program*> splat =
        device.shaders().load({.compute = "caustics_splat.comp"});
    if (!splat) {
        return splat.error();
    }
    const Result<const gpu::Program*> map = device.shaders().load({.compute = "caustics_map.comp"});
    if (!map) {
        return map.error();
    }
    pass.splat = *splat;
    pass.map = *map;
    return pass;
}

void resize_caustic_atlas(CausticsPass& pass) {
    const IVec2 size = pass.list.atlas;
    if (size.x > 0 && (pass.maps.width() != size.x || pass.maps.height() != size.y)) {
        pass.maps = make_atlas(size);
    }
}

TextureId draw_caustics(
    FrameGraph& graph, CausticsPass& pass, const WaterSurfaces& waters, const FrameScene& scene) {
    const CausticList& list = pass.list;
    if (list.maps.empty()) {
        return {};
    }
    const BufferId rays = graph.create_buffer({"caustics.rays", list.rays * sizeof(Vec4)});
    const TextureId made = graph.import("caustics", pass.maps);

    std::vector<Use> reads;
    if (scene.shadow_maps.valid()) {
        reads.emplace_back(scene.shadow_maps);
    }
    const Use writes[] = {rays};
    graph.add_pass(
        "caustic rays", std::span<const Use>(reads), std::span<const Use>(writes),
        [=, &pass, &waters, &scene](PassContext& context) {
            gpu::Device& device = context.device();
            const bool ocean = !waters.seas.empty();
            const gpu::Program* program = rays_program(pass, device, scene, ocean);
            if (program == nullptr) {
                return;
            }
            use_with_jobs(device, pass, *program);
            bind_view(device, scene);
            if (scene.lights.shadows) {
                device.bind_texture(kShadowAtlasUnit, *scene.shadow_atlas);
                scene.shadow_views->bind(device, kShadowViewsUnit);
            }
            bind_water_surfaces(device, waters);
            context.bind_storage(kRaysBinding, rays);
            device.dispatch(static_cast<unsigned>(pass.list.groups));
        });
    if (pass.on_cpu) {
        sum_on_cpu(graph, pass, rays, made);
    } else {
        sum_on_gpu(graph, pass, rays, made);
    }
    return made;
}

}  // namespace limn
