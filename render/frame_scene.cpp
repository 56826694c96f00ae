#include "render/frame_scene.h"

#include "ecs/base/log.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/instance_gpu.h"

namespace limn {
namespace {

struct FeatureName {
    std::uint32_t bit;
    const char* define;
};
constexpr FeatureName kFeatureNames[] = {
    {kBaseColorMap, "BASE_COLOR_MAP"},
    {kMetalRoughMap, "METAL_ROUGH_MAP"},
    {kNormalMap, "NORMAL_MAP"},
    {kOcclusionMap, "OCCLUSION_MAP"},
    {kEmissionMap, "EMISSION_MAP"},
    {kOcclusionShared, "OCCLUSION_SHARED"},
    {kUvMap, "UV_MAP"},
    {kUvMaps, "UV_MAPS"},
    {kSrgbBaseColor, "SRGB_BASE_COLOR"},
    {kSrgbEmission, "SRGB_EMISSION"},
    {kAlphaMask, "ALPHA_MASK"},
    {kDoubleSided, "DOUBLE_SIDED"},
    {kVertexColor, "VERTEX_COLOR"},
    {kVelocity, "VELOCITY"},
    {kInflate, "INFLATE"},
    {kDeformed, "DEFORMED"},
};

/// The instance streams point into this frame's part of the ring.
void set_instance_streams(gpu::VertexArray& vertices, const InstanceList& list) {
    const GLuint id = vertices.id();
    glVertexArrayVertexBuffer(
        id, kInstanceStream, list.instances.buffer, static_cast<GLintptr>(list.instances.offset),
        sizeof(layout::InstanceRecord));
    glVertexArrayBindingDivisor(id, kInstanceStream, 1);
    // Nobody reads this stream when it is empty, but something must be bound.
    const gpu::RingSlice& before = list.before.size > 0 ? list.before : list.instances;
    glVertexArrayVertexBuffer(
        id, kBeforeStream, before.buffer, static_cast<GLintptr>(before.offset), sizeof(Affine));
    glVertexArrayBindingDivisor(id, kBeforeStream, 1);
}

/// What all runs of a list share.
void bind_instances(gpu::Device& device, const FrameScene& scene, const InstanceList& list) {
    set_instance_streams(scene.meshes->vertices(), list);
    set_instance_streams(scene.shapes->vertices().vertices(), list);
    scene.materials->records().bind(device, kMaterialsUnit);
    device.bind_indirect(list.commands.buffer);
}

void bind_vertices(gpu::Device& device, const FrameScene& scene, const DrawRun& run) {
    const bool deformed = (run.features & kDeformed) != 0;
    device.bind_vertex_array(
        deformed ? scene.shapes->vertices().vertices() : scene.meshes->vertices());
}

void draw_run(
    gpu::Device& device, const FrameScene& scene, const InstanceList& list, const DrawRun& run) {
    bind_vertices(device, scene, run);
    device.draw_indexed_indirect(
        GL_TRIANGLES, GL_UNSIGNED_INT,
        list.commands.offset + run.first_command * sizeof(DrawCommand),
        static_cast<int>(run.command_count));
}

/// The state that draws the sides of a run's surfaces that are meant to be seen.
gpu::PipelineState seen_sides(gpu::PipelineState state, const DrawRun& run) {
    const bool both_sides = (run.features & kDoubleSided) != 0;
    state.cull = static_cast<GLenum>(both_sides ? GL_NONE : run.mirrored ? GL_FRONT : GL_BACK);
    return state;
}

/// Draws a run for its depth: `programs` get no more features than decide where its points are and
/// where there are holes.
void draw_depth(
    gpu::Device& device, const FrameScene& scene, const InstanceList& list, const DrawRun& run,
    SurfacePrograms& programs, const gpu::PipelineState& state) {
    constexpr std::uint32_t kHoles = kAlphaMask | kBaseColorMap | kUvMap | kUvMaps | kVertexColor;
    const bool holes = (run.features & kAlphaMask) != 0;
    const gpu::Program* program =
        programs.get(run.features & (holes ? kHoles | kInflate : kInflate), 0, {});
    if (program == nullptr) {
        return;
    }
    device.use(gpu::Pipeline{program, state});
    if (holes) {
        scene.materials->bind_textures(run.textures);
    }
    draw_run(device, scene, list, run);
}

}  // namespace

layout::ViewBlock
make_view_block(const RenderView& view, const ClusterShape& shape, const LightList& lights) {
    const auto& r = view.world_from_camera.row;
    const auto column = [&](int c) { return Vec3(r[0][c], r[1][c], r[2][c]); };
    const Vec2 size = {view.width, view.height};
    const Vec2 jitter = 2.0f * view.jitter / size;
    layout::ViewBlock block{};
    block.clip_from_world = view.clip_from_world;
    block.previous_from_world = view.previous_from_world;
    block.camera_ws = Vec4(column(3), view.near);
    block.ray_right = Vec4(column(0) * view.tangent.x, jitter.x);
    block.ray_up = Vec4(column(1) * view.tangent.y, jitter.y);
    block.ray_forward = Vec4(-column(2), 0);
    block.size = {size.x, size.y, 1 / size.x, 1 / size.y};
    block.grid_cells = {shape.columns, shape.rows, shape.slices, shape.tile};
    block.grid_depth = {
        shape.depth_scale, shape.depth_bias, lights.directional, lights.first_shadowed};
    block.clip_plane = view.clip_plane;
    return block;
}

void bind_view(gpu::Device& device, const FrameScene& scene) {
    device.bind_uniforms(
        kViewBinding, scene.view_block.buffer, scene.view_block.offset, scene.view_block.size);
}

void bind_lighting(gpu::Device& device, const FrameScene& scene) {
    bind_view(device, scene);
    const gpu::RingSlice& block = scene.environment_block;
    device.bind_uniforms(kEnvironmentBinding, block.buffer, block.offset, block.size);
    device.bind_texture(kReflectionUnit, *scene.environment.reflection);
    device.bind_uniforms(kSurroundingsBinding, *scene.environment.irradiance);
    if (scene.probe_block.size > 0) {
        const gpu::RingSlice& probes = scene.probe_block;
        device.bind_uniforms(kProbesBinding, probes.buffer, probes.offset, probes.size);
    }
    device.bind_texture(kSpecularAlbedoUnit, *scene.environment.specular_albedo);
    scene.light_records->bind(device, kLightsUnit);
    if (scene.lists.cells.valid()) {
        scene.light_indices->bind(device, kLightIndicesUnit);
        scene.light_cells->bind(device, kLightCellsUnit);
    }
    if (scene.lights.shadows) {
        device.bind_texture(kShadowAtlasUnit, *scene.shadow_atlas);
        scene.shadow_views->bind(device, kShadowViewsUnit);
    }
    if (!scene.projectors->records().empty()) {
        device.bind_texture(kProjectorImagesUnit, scene.projectors->images());
        scene.projector_records->bind(device, kProjectorsUnit);
    }
    if (scene.waters) {
        scene.water_lights->bind(device, kWaterLightsUnit);
        device.bind_texture(kCausticMapsUnit, *scene.caustic_maps);
    }
    scene.materials->records().bind(device, kSurfaceMaterialsUnit);
}

void bind_shadow_masks(PassContext& context, const FrameScene& scene) {
    if (scene.shadow_masks.valid()) {
        context.bind_texture(kShadowMasksUnit, scene.shadow_masks);
    }
}

bool needs_stencil(const FrameScene& scene) {
    const bool by_screen =
        scene.method == LightMethod::Clustered || scene.method == LightMethod::FullScreen;
    return !by_screen || !scene.volumes.lights.empty();
}

bool is_clipped(const FrameScene& scene) {
    return scene.view.clip_plane != Vec4(0);
}

std::vector<Use> lighting_reads(const FrameScene& scene, std::initializer_list<Use> reads) {
    std::vector<Use> all = reads;
    if (scene.shadow_maps.valid()) {
        all.emplace_back(scene.shadow_maps);
    }
    if (scene.caustics.valid()) {
        all.emplace_back(scene.caustics);
    }
    if (scene.lists.cells.valid()) {
        all.insert(all.end(), {scene.lists.cells, scene.lists.indices});
    }
    if (scene.shadow_masks.valid()) {
        all.emplace_back(scene.shadow_masks);
    }
    return all;
}

std::vector<gpu::ShaderDefine> lighting_defines(const FrameScene& scene) {
    std::vector<gpu::ShaderDefine> defines;
    const std::uint32_t key = lighting_key(scene);
    constexpr const char* kNames[] = {
        "DIRECTIONAL_LIGHTS",
        "SPOT_LIGHTS",
        "SPOT_ANGLES",
        "CLASSIC_MODELS",
        "LINEAR_FADE",
        "SHADOWS",
        "SHADOW_CUBES",
        "SHADOW_CASCADES",
        "SHADOW_SOFT",
        "LOCAL_LIGHTS",
        "SHADOW_MAPS",
        "SHADOW_MASKS",
        "PROBES",
        "PROJECTORS",
        "WATERS",
        "MIRRORS"};
    for (std::uint32_t i = 0; i < std::size(kNames); ++i) {
        if ((key >> i & 1) != 0) {
            defines.push_back({kNames[i]});
        }
    }
    return defines;
}

std::uint32_t lighting_key(const FrameScene& scene) {
    const LightList& lights = scene.lights;
    const ShadowList& maps = scene.shadows;
    return (lights.directional > 0 ? 1u : 0u) | (lights.spots > 0 ? 2u : 0u)
           | (lights.spot_angles ? 4u : 0u) | (scene.materials->has_classic() ? 8u : 0u)
           | (lights.linear_fade ? 16u : 0u) | (lights.shadows ? 32u : 0u) | (maps.cubes ? 64u : 0u)
           | (maps.cascades ? 128u : 0u) | (maps.soft ? 256u : 0u)
           | (scene.clusters.lights.empty() ? 0u : 512u) | (maps.records.empty() ? 0u : 1024u)
           | (scene.volumes.lights.empty() ? 0u : 2048u) | (scene.probe_block.size > 0 ? 4096u : 0u)
           | (scene.projectors->records().empty() ? 0u : 8192u) | (scene.waters ? 16384u : 0u)
           | (scene.mirrors ? 32768u : 0u);
}

const gpu::Program* SurfacePrograms::get(
    std::uint32_t features, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more) {
    if ((features & kVelocity) == 0) {
        features &= ~static_cast<std::uint32_t>(kDeformed);  // a vertex is a vertex
    }
    const std::uint64_t key = static_cast<std::uint64_t>(more_key) << 32 | features;
    const auto found = programs_.find(key);
    if (found != programs_.end()) {
        return found->second;
    }
    std::vector<gpu::ShaderDefine> defines = more;
    for (const FeatureName& feature : kFeatureNames) {
        if ((features & feature.bit) != 0) {
            defines.push_back({feature.define});
        }
    }
    const Result<const gpu::Program*> program = device_->shaders().load(
        {.vertex = vertex_, .fragment = fragment_, .defines = std::move(defines)});
    const Status fits = program ? (*program)->expect_inputs(mesh_attributes()) : program.error();
    if (!fits) {
        log_error("{}", fits.error().message);
    }
    return programs_[key] = fits ? *program : nullptr;
}

Status SurfacePrograms::load(
    std::uint32_t features, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more) {
    if (get(features, more_key, more) == nullptr) {
        return fail("{}: does not compile, see the log", fragment_);
    }
    return Done{};
}

void draw_runs(
    gpu::Device& device, const FrameScene& scene, const std::vector<DrawRun>& runs,
    SurfacePrograms& programs, std::uint32_t more_features, std::uint32_t more_key,
    const std::vector<gpu::ShaderDefine>& more, const gpu::PipelineState& state, int light) {
    if (runs.empty()) {
        return;
    }
    bind_instances(device, scene, scene.instances);
    for (const DrawRun& run : runs) {
        const gpu::Program* program = programs.get(run.features | more_features, more_key, more);
        if (program == nullptr) {
            continue;
        }
        device.use(gpu::Pipeline{program, seen_sides(state, run)});
        if (light >= 0) {
            program->set("light_index", light);
        }
        scene.materials->bind_textures(run.textures);
        draw_run(device, scene, scene.instances, run);
    }
}

void draw_light_runs(
    gpu::Device& device, const FrameScene& scene, std::span<const LightRun> runs,
    SurfacePrograms& programs, std::uint32_t more_key, const std::vector<gpu::ShaderDefine>& more,
    const gpu::PipelineState& state) {
    bind_instances(device, scene, scene.instances);
    device.bind_indirect(scene.light_commands.buffer);
    for (const LightRun& lit : runs) {
        const DrawRun& run = scene.instances.opaque[lit.run];
        const gpu::Program* program = programs.get(run.features, more_key, more);
        if (program == nullptr) {
            continue;
        }
        device.use(gpu::Pipeline{program, seen_sides(state, run)});
        program->set("light_index", static_cast<int>(lit.light));
        scene.materials->bind_textures(run.textures);
        bind_vertices(device, scene, run);
        device.draw_indexed_indirect(
            GL_TRIANGLES, GL_UNSIGNED_INT,
            scene.light_commands.offset + lit.first_command * sizeof(DrawCommand),
            static_cast<int>(lit.command_count));
    }
}

void draw_depths(gpu::Device& device, const FrameScene& scene, SurfacePrograms& programs) {
    bind_instances(device, scene, scene.instances);
    for (const DrawRun& run : scene.instances.opaque) {
        draw_depth(device, scene, scene.instances, run, programs, seen_sides({}, run));
    }
}

void draw_casters(
    gpu::Device& device, const FrameScene& scene, const InstanceList& casters,
    SurfacePrograms& programs, const gpu::PipelineState& state) {
    bind_instances(device, scene, casters);
    for (const DrawRun& run : casters.opaque) {
        draw_depth(device, scene, casters, run, programs, state);
    }
}

void draw_motions(
    gpu::Device& device, const FrameScene& scene, SurfacePrograms& programs,
    const gpu::PipelineState& state, const std::function<void(const gpu::Program&)>& set) {
    bind_instances(device, scene, scene.instances);
    for (const DrawRun& run : scene.instances.opaque) {
        const gpu::Program* program =
            programs.get((run.features & (kInflate | kDeformed)) | kVelocity, 0, {});
        if (program == nullptr) {
            continue;
        }
        device.use(gpu::Pipeline{program, seen_sides(state, run)});
        set(*program);
        draw_run(device, scene, scene.instances, run);
    }
}

}  // namespace limn
