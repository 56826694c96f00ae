#include "render/passes/caustics_pass.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"

namespace limn {
namespace {

constexpr unsigned kRecordsUnit = 20;
constexpr unsigned kRaysBinding = 0;
constexpr unsigned kLightBinding = 1;
constexpr unsigned kMapsImage = 0;
constexpr int kRayGroup = 8;     ///< rays of a side of a work group
constexpr unsigned kGroup = 64;  ///< of cells and of texels
constexpr std::uint32_t kOceanKey = 1u << 31;

gpu::Texture make_maps(int side, int layers) {
    return {
        "caustic maps",
        {.format = GL_R32F,
         .width = side,
         .height = side,
         .depth = layers,
         .target = GL_TEXTURE_2D_ARRAY}};
}

unsigned groups_of(unsigned items, unsigned group) {
    return (items + group - 1) / group;
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

/// Transient sums, then the maps.
void sum_on_gpu(
    FrameGraph& graph, CausticsPass& pass, BufferId rays, TextureId made, unsigned stride) {
    const auto maps = static_cast<unsigned>(pass.list.maps.size());
    const auto side = static_cast<unsigned>(pass.list.resolution);
    const std::size_t bytes = std::size_t{side} * side * maps * sizeof(std::uint32_t);
    const BufferId light = graph.create_buffer({"caustics.light", bytes});
    graph.add_pass("caustic splats", {rays}, {light}, [=, &pass](PassContext& context) {
        gpu::Device& device = context.device();
        const std::uint32_t none = 0;
        glClearNamedBufferSubData(
            context.buffer(light).id(),
            GL_R32UI,
            0,
            static_cast<GLsizeiptr>(bytes),
            GL_RED_INTEGER,
            GL_UNSIGNED_INT,
            &none);
        device.use(*pass.splat);
        pass.splat->set("stride", stride);
        pass.records.bind(device, kRecordsUnit);
        context.bind_storage(kRaysBinding, rays);
        context.bind_storage(kLightBinding, light);
        const auto cells = static_cast<unsigned>(pass.list.cells);
        device.dispatch(groups_of(cells * cells, kGroup), maps);
    });
    graph.add_pass("caustic maps", {light}, {image(made)}, [=, &pass](PassContext& context) {
        gpu::Device& device = context.device();
        device.use(*pass.map);
        pass.records.bind(device, kRecordsUnit);
        context.bind_storage(kLightBinding, light);
        context.bind_image(kMapsImage, made, GL_WRITE_ONLY);
        device.dispatch(groups_of(side, kGroup), side, maps);
    });
}

void sum_on_cpu(
    FrameGraph& graph, CausticsPass& pass, BufferId rays, TextureId made, unsigned stride) {
    graph.add_pass("caustic splats", {rays}, {image(made)}, [=, &pass](PassContext& context) {
        const CausticList& list = pass.list;
        pass.rays_on_cpu.resize(stride * list.maps.size());
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        context.buffer(rays).read(0, std::as_writable_bytes(std::span(pass.rays_on_cpu)));
        const auto side = static_cast<std::size_t>(list.resolution);
        pass.map_on_cpu.resize(side * side);
        for (std::size_t i = 0; i < list.maps.size(); ++i) {
            const std::span<const Vec4> own(pass.rays_on_cpu.data() + i * stride, stride);
            splat_caustics(list.maps[i], own, pass.sums_on_cpu, pass.map_on_cpu);
            pass.maps.upload<float>(pass.map_on_cpu, GL_RED, GL_FLOAT, 0, static_cast<int>(i));
        }
    });
}

}  // namespace

Result<CausticsPass> create_caustics_pass(gpu::Device& device) {
    CausticsPass pass;
    pass.on_cpu = device.caps().software;
    pass.maps = make_maps(1, 1);
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

void resize_caustic_maps(CausticsPass& pass) {
    const int layers = static_cast<int>(pass.list.maps.size());
    if (layers > 0 && (pass.maps.width() != pass.list.resolution || pass.maps.layers() != layers)) {
        pass.maps = make_maps(pass.list.resolution, layers);
    }
}

TextureId draw_caustics(
    FrameGraph& graph, CausticsPass& pass, const WaterSurfaces& waters, const FrameScene& scene) {
    const CausticList& list = pass.list;
    if (list.maps.empty()) {
        return {};
    }
    const auto maps = static_cast<unsigned>(list.maps.size());
    const auto points = static_cast<unsigned>(list.cells + 1);
    const unsigned stride = points * points;
    const BufferId rays = graph.create_buffer({"caustics.rays", stride * maps * sizeof(Vec4)});
    const TextureId made = graph.import("caustics", pass.maps);

    std::vector<Use> reads;
    if (scene.shadow_maps.valid()) {
        reads.emplace_back(scene.shadow_maps);
    }
    const Use writes[] = {rays};
    graph.add_pass(
        "caustic rays",
        std::span<const Use>(reads),
        std::span<const Use>(writes),
        [=, &pass, &waters, &scene](PassContext& context) {
            gpu::Device& device = context.device();
            const bool ocean = !waters.seas.empty();
            const gpu::Program* program = rays_program(pass, device, scene, ocean);
            if (program == nullptr) {
                return;
            }
            device.use(*program);
            program->set("stride", stride);
            bind_view(device, scene);
            if (scene.lights.shadows) {
                device.bind_texture(kShadowAtlasUnit, *scene.shadow_atlas);
                scene.shadow_views->bind(device, kShadowViewsUnit);
            }
            bind_water_surfaces(device, waters);
            pass.records.bind(device, kRecordsUnit);
            context.bind_storage(kRaysBinding, rays);
            const unsigned groups = groups_of(points, kRayGroup);
            device.dispatch(groups, groups, maps);
        });
    if (pass.on_cpu) {
        sum_on_cpu(graph, pass, rays, made, stride);
    } else {
        sum_on_gpu(graph, pass, rays, made, stride);
    }
    return made;
}

}  // namespace limn
