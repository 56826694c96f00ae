#include "render/render_frame.h"

#include "ecs/base/log.h"
#include "ecs/components/environment.h"
#include "ecs/components/post.h"
#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "render/cube_map.h"
#include "render/develop.h"
#include "render/env_probe_list.h"
#include "render/environment_light.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/lens.h"
#include "render/passes/aov_pass.h"
#include "render/passes/blend_pass.h"
#include "render/passes/caustics_pass.h"
#include "render/passes/cluster_pass.h"
#include "render/passes/deform_pass.h"
#include "render/passes/forward_pass.h"
#include "render/passes/gbuffer_pass.h"
#include "render/passes/light_each_pass.h"
#include "render/passes/light_pass.h"
#include "render/passes/mirror_caustic_pass.h"
#include "render/passes/panorama_pass.h"
#include "render/passes/probe_pass.h"
#include "render/passes/reflection_pass.h"
#include "render/passes/shadow_pass.h"
#include "render/passes/shadow_volume_pass.h"
#include "render/passes/speed_line_pass.h"
#include "render/passes/texture_combine_pass.h"
#include "render/passes/texture_wave_pass.h"
#include "render/passes/water_pass.h"
#include "render/passes/water_veil_pass.h"
#include "render/shaders/view_gpu.h"
#include "render/water/water_reflection.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <set>

namespace limn {
namespace {

constexpr std::size_t kRingBytes = std::size_t{8} << 20;  ///< at start; grows with the scene
constexpr int kSpecularAlbedoSize = 64;
constexpr int kProbeSamples = 64;  ///< of a texel of a probe's reflection map

/// Without the resource nothing surrounds the scene.
Environment environment_of(const World& world) {
    const auto* environment = world.find_resource<Environment>();
    return environment != nullptr
               ? *environment
               : Environment{.sky = SkyKind::Uniform, .zenith = Vec3(0), .visible = false};
}

Exposure exposure_of(const World& world) {
    const auto* exposure = world.find_resource<Exposure>();
    return exposure != nullptr ? *exposure : Exposure{};
}

Rendering rendering_of(const World& world) {
    const auto* rendering = world.find_resource<Rendering>();
    return rendering != nullptr ? *rendering : Rendering{};
}

/// Whether surfaces are lit while they are drawn.
bool is_forward(LightMethod method) {
    return method == LightMethod::ObjectMajor || method == LightMethod::LightMajor;
}

bool same_light(const Environment& a, const Environment& b) {
    return a.sky == b.sky && a.zenith == b.zenith && a.horizon == b.horizon && a.ground == b.ground
           && a.intensity == b.intensity && a.panorama == b.panorama && a.mapping == b.mapping
           && a.rotation == b.rotation && a.half_angle == b.half_angle;
}

struct Passes {
    DeformPass deform;
    GbufferPass gbuffer;
    LightPass lights;
    ClusterPass clusters;
    LightEachPass light_each;
    ForwardPass forward;
    BlendPass blend;
    Developer developer;
    AovPass aovs;
    PanoramaPass panorama;
    ReflectionPass reflection;
    ProbePass probes;
    ShadowPass shadows;
    ShadowVolumePass volumes;
    TextureCombinePass combine;
    TextureWavePass texture_waves;
    WaterPass water;
    WaterVeilPass veil;
    CausticsPass caustics;
    MirrorCausticPass mirrors;
    SpeedLinePass speed_lines;
    LensPasses lens;
    const gpu::Program* accumulate = nullptr;
};

/// The moment that `view` shows, in simulated time [s].
double shown_time(const World& world, const RenderView& view) {
    const auto* time = world.find_resource<FrameTime>();
    return time != nullptr ? time->time - (1.0 - view.alpha) * time->step : 0.0;
}

/// What a frame is made for.
enum class Seen : std::uint8_t {
    Picture,
    ByProbe,  ///< what lights, without probes
    InWater,  ///< what water mirrors, without water
};

bool asks_for_velocity(const FrameRequest& request) {
    return std::find(request.aovs.begin(), request.aovs.end(), "velocity") != request.aovs.end();
}

/// What a frame's passes made.
struct FrameTextures {
    Gbuffer gbuffer;
    TextureId radiance;
    TextureId display;
    std::vector<std::pair<int, TextureId>> aovs;
};

}  // namespace

class Renderer {
  public:
    Renderer(gpu::Device& device, const RenderSettings& settings, Passes passes);

    /// Draws combined textures, and what probes see, where that is due: before the image that shows
    /// them.
    void draw_probes(const World& world, const RenderView& view);
    /// Draws what a water mirrors that asks for it, before the image of `view` that shows it.
    void draw_water_reflection(const World& world, const RenderView& view);
    /// Tells whether this picture follows the one before. After draw_probes(), which knows Assets.
    void follow(const World& world, const RenderView& view);
    /// Brings what changed in the world to the GPU and collects this frame's draws and lights.
    void
    prepare(const World& world, const RenderView& view, bool velocity, Seen seen = Seen::Picture);
    /// The image, as a list.
    FrameTextures draw_image(const FrameRequest& request, bool attributes, bool velocity);
    /// What lies where; `attributes`: also of what kind, which forward lighting has no need of.
    Gbuffer draw_surfaces(bool attributes, bool velocity);
    /// `attributes`: water leaves its own in the G-buffer, too.
    TextureId draw_radiance(FrameGraph& into, const Gbuffer& gbuffer, bool attributes = false);
    /// From its radiance through the lens to the display; once a picture, as the eye adapts.
    void develop_image(const World& world, const LensSettings& lens, FrameTextures& made);
    void finish(FrameGraph& drawn);
    FrameOutput output(const FrameTextures& textures) const;
    /// A sum of pictures, begun at 0.
    void begin_sum(const IVec2& size, SampleKind kind);
    void add_to_sum(const FrameTextures& made, const LensSettings& lens, float weight);
    [[nodiscard]] const gpu::Texture& sum() const { return sum_; }
    [[nodiscard]] SampleKind sample_kind() const { return sample_kind_; }
    /// Copies what the graph drew, for the output of the sum.
    void keep_aovs(const FrameTextures& textures);
    [[nodiscard]] std::vector<AovOutput> kept_aovs() const;

    gpu::Device& device;
    FrameGraph graph;
    Passes passes;
    FrameScene scene;
    FrameStatistics statistics;

  private:
    void update_assets(const World& world);
    Environment shown_environment(const World& world) const;
    void update_environment(const World& world);
    void report_missing_tangents(const Assets& assets);
    void draw_probe_face(const World& world, ProbeSlot& slot, int layer, float alpha);

    FrameGraph probe_graph_;  ///< apart from the image's, whose times it would blur
    FrameGraph reflection_graph_;
    EnvProbeList probes_;
    gpu::RingBuffer ring_;
    MeshPool meshes_;
    MaterialPool materials_;
    DeformedList shapes_;
    InstanceCollector collector_;
    ShadowCollector shadow_collector_;
    VolumeCollector volume_collector_;
    LightObjects light_objects_;
    ObjectLights lights_of_objects_;
    BufferTexture light_records_;
    BufferTexture object_lists_ = BufferTexture("object lists", GL_RG32UI);
    BufferTexture object_lights_ = BufferTexture("object lights", GL_R32UI);
    BufferTexture shadow_views_;
    BufferTexture projector_records_;
    ProjectorPool projectors_;
    gpu::Texture specular_albedo_;
    gpu::Texture sum_;
    bool sum_is_empty_ = true;
    SampleKind sample_kind_ = SampleKind::Played;
    std::vector<std::pair<int, gpu::Texture>> kept_aovs_;
    std::uint64_t assets_ = 0;                // identity of those that were uploaded
    int probe_faces_ = 0;                     // drawn for this frame
    Entity planar_water_;                     // whose reflection was drawn for this frame
    std::optional<Environment> environment_;  // that the reflection map shows
    bool reflection_due_ = false;
    bool dropped_reported_ = false;
    std::set<std::uint32_t> untangented_reported_;  // meshes
    PictureClock clock_;
    std::vector<SpeedLine> speed_lines_;
};

void RendererDeleter::operator()(Renderer* renderer) const {
    delete renderer;
}

Renderer::Renderer(gpu::Device& gpu_device, const RenderSettings& settings, Passes made)
    : device(gpu_device), graph(gpu_device), passes(std::move(made)), probe_graph_(gpu_device),
      reflection_graph_(gpu_device), ring_(gpu_device.caps(), "frame data", kRingBytes),
      materials_(gpu_device, settings.anisotropy),
      shapes_(static_cast<std::size_t>(gpu_device.caps().max_storage_bytes)),
      light_records_("lights", GL_RGBA32F), shadow_views_("shadow views", GL_RGBA32F),
      projector_records_("projectors", GL_RGBA32F),
      specular_albedo_(
          "specular albedo",
          {.format = GL_RG32F, .width = kSpecularAlbedoSize, .height = kSpecularAlbedoSize}) {
    const std::vector<Vec2> table = make_specular_albedo(kSpecularAlbedoSize);
    specular_albedo_.upload<Vec2>(table, GL_RG, GL_FLOAT);
    // A software OpenGL writes 32-bit floats faster than 16-bit ones, which it also cuts off
    // instead of rounding.
    const bool full_float = settings.full_float || gpu_device.caps().software;
    scene.radiance_format = full_float ? GL_RGBA32F : GL_RGBA16F;
    scene.velocity_format = full_float ? GL_RG32F : GL_RG16F;
    scene.meshes = &meshes_;
    scene.materials = &materials_;
    scene.shapes = &shapes_;
    scene.light_records = &light_records_;
    scene.shadow_views = &shadow_views_;
    scene.projector_records = &projector_records_;
    scene.projectors = &projectors_;
    scene.shadow_atlas = &passes.shadows.atlas;
    scene.environment.reflection = &passes.reflection.maps;
    scene.environment.irradiance = &passes.reflection.irradiance;
    scene.environment.cube = &passes.panorama.cube;
    scene.object_lists = &object_lists_;
    scene.object_lights = &object_lights_;
    scene.light_indices = &passes.clusters.indices;
    scene.light_cells = &passes.clusters.cells;
    scene.water_lights = &passes.caustics.waters;
    scene.caustic_maps = &passes.caustics.maps;
    scene.environment.specular_albedo = &specular_albedo_;
}

void Renderer::update_assets(const World& world) {
    static const Assets kNone;
    const auto* found = world.find_resource<Assets>();
    const Assets& assets = found != nullptr ? *found : kNone;
    const bool fresh = assets_ != assets.identity.value()
                       || meshes_.meshes().size() > assets.meshes.size()
                       || materials_.image_count() > assets.images.size();
    if (fresh) {
        meshes_.clear();
        shapes_.forget();
        volume_collector_.forget();
        assets_ = assets.identity.value();
        environment_.reset();  // its panorama may be another
        untangented_reported_.clear();
    }
    meshes_.append(std::span(assets.meshes).subspan(meshes_.meshes().size()));
    materials_.update(assets, fresh);
}

Environment Renderer::shown_environment(const World& world) const {
    Environment environment = environment_of(world);
    if (environment.sky == SkyKind::Panorama
        && materials_.find_image(environment.panorama) == nullptr) {
        // As surfaces show what is missing.
        environment.sky = SkyKind::Uniform;
        environment.zenith = {1, 0, 1};
    }
    return environment;
}

void Renderer::update_environment(const World& world) {
    const Environment environment = shown_environment(world);
    layout::EnvironmentBlock& block = scene.environment.block;
    reflection_due_ = !environment_ || !same_light(*environment_, environment);
    if (reflection_due_) {
        block = make_environment_block(environment, Vec3(0, 1, 0), Vec3(0));
        describe_reflection(passes.reflection, block);
        environment_ = environment;
    }
    scene.environment.settings = environment;
    block.sun_direction = Vec4(scene.lights.sun_direction, 0);
    block.sun_color = Vec4(scene.lights.sun_color, 0);
}

void Renderer::draw_probes(const World& world, const RenderView& view) {
    update_assets(world);
    probe_graph_.begin_frame();
    if (combine_textures(probe_graph_, passes.combine, world, materials_, shown_time(world, view))
        > 0) {
        probe_graph_.execute();
    }
    if (!environment_ || !same_light(*environment_, shown_environment(world))) {
        probes_.forget();
    }
    probes_.collect(world, view.alpha);
    probe_faces_ = 0;
    for (std::size_t i = 0; i < probes_.slots().size(); ++i) {
        ProbeSlot& slot = probes_.slots()[i];
        while (slot.seen && slot.drawn < slot.due) {
            draw_probe_face(world, slot, probe_layer(i), view.alpha);
            ++probe_faces_;
        }
    }
}

void Renderer::follow(const World& world, const RenderView& view) {
    scene.since_last =
        seconds_since_last(clock_, assets_, shown_time(world, view), view.world_from_camera);
}

void Renderer::draw_probe_face(const World& world, ProbeSlot& slot, int layer, float alpha) {
    if (!slot.cube || slot.cube.width() != slot.resolution) {
        slot.cube = gpu::Texture(
            "probe cube", {.format = scene.radiance_format,
                           .width = slot.resolution,
                           .height = slot.resolution,
                           .levels = 0,
                           .target = GL_TEXTURE_CUBE_MAP});
    }
    const int face = static_cast<int>(slot.drawn % kCubeFaces);
    probe_graph_.begin_frame();
    prepare(world, make_probe_view(slot, face, alpha), false, Seen::ByProbe);
    deform_meshes(probe_graph_, passes.deform, shapes_);
    const Gbuffer gbuffer = draw_gbuffer(probe_graph_, passes.gbuffer, scene, false);
    const TextureId radiance = draw_radiance(probe_graph_, gbuffer);
    keep_probe_face(probe_graph_, passes.probes, radiance, slot.cube, face);
    ++slot.drawn;
    ++slot.fresh;
    // A round is shown when it is whole.
    const bool whole = slot.ready ? slot.drawn % kCubeFaces == 0 : slot.fresh >= kCubeFaces;
    if (whole) {
        draw_cube_levels(probe_graph_, slot.cube);
        draw_cube_reflection(
            probe_graph_, passes.reflection, scene, slot.cube, layer, kProbeSamples);
        slot.ready = true;
    }
    finish(probe_graph_);
}

void Renderer::draw_water_reflection(const World& world, const RenderView& view) {
    const std::optional<PlanarWater> water = find_planar_water(world, view);
    planar_water_ = water ? water->entity : Entity{};
    if (!water) {
        return;
    }
    reflection_graph_.begin_frame();
    prepare(world, make_reflected_view(view, water->level, water->map_scale), false, Seen::InWater);
    deform_meshes(reflection_graph_, passes.deform, shapes_);
    const Gbuffer gbuffer = draw_gbuffer(reflection_graph_, passes.gbuffer, scene, false);
    const TextureId radiance = draw_radiance(reflection_graph_, gbuffer);
    keep_reflection(reflection_graph_, passes.water, scene, radiance, gbuffer);
    finish(reflection_graph_);
}

void Renderer::report_missing_tangents(const Assets& assets) {
    for (const std::uint32_t mesh : scene.instances.without_tangents) {
        if (untangented_reported_.insert(mesh).second) {
            log_warn(
                "mesh {}: no tangents found, expected one a vertex; it is drawn without its normal "
                "map",
                assets.meshes[mesh].name);
        }
    }
}

void Renderer::prepare(const World& world, const RenderView& view, bool velocity, Seen seen) {
    const bool for_probe = seen == Seen::ByProbe;
    const bool for_picture = seen == Seen::Picture;
    update_assets(world);
    ring_.begin_frame();

    const auto begin = std::chrono::steady_clock::now();
    scene.view = view;
    collect_lights(world, view.alpha, scene.lights);
    update_environment(world);
    place_lights(view, scene.lights, scene.clusters);
    if (scene.clusters.dropped > 0 && !dropped_reported_) {
        log_warn(
            "lights: {} of {} reach over so much of the picture that the clusters have no room for "
            "them (kMaxListEntries, light_clusters.h); they are not shown",
            scene.clusters.dropped, scene.lights.reach.size());
        dropped_reported_ = true;
    }
    const Rendering rendering = for_picture ? rendering_of(world) : Rendering{};
    scene.per_vertex = rendering.shading == ShadingRate::Vertex;
    scene.method = scene.per_vertex ? LightMethod::ObjectMajor : rendering.lights;
    shapes_.update(world, meshes_, view.alpha, view.alpha_before);
    collector_.collect(
        world, view, meshes_, materials_, shapes_, velocity, ring_, scene.instances,
        is_forward(scene.method));
    volume_collector_.collect(world, view, shapes_, ring_, scene.lights, scene.volumes);
    WaterSurfaces& water = passes.water.surfaces;
    collect_waters(
        world, view, velocity, for_picture ? planar_water_ : Entity{},
        device.caps().max_texture_size, water.ripples, water.seas, water.list);
    CausticList& caustics = passes.caustics.list;
    collect_caustics(water.list, scene.lights, view, for_picture, caustics, scene.shadows);
    shadow_collector_.collect(
        world, view, meshes_, materials_, shapes_, assets_, ring_, scene.lights, scene.shadows);
    shapes_.write_jobs(ring_);
    resize_shadow_atlas(passes.shadows, scene.shadows);
    VolumeCollector::take_over_hybrids(scene.lights, scene.volumes);
    if (const auto* assets = world.find_resource<Assets>()) {
        report_missing_tangents(*assets);
        projectors_.update(*assets, scene.lights);
    }

    const std::size_t alignment = BufferTexture::alignment();
    const auto push = [&](const auto& items) {
        const std::span bytes = std::as_bytes(std::span(items));
        // A view of a buffer must not be empty.
        const gpu::RingSlice slice =
            ring_.allocate(std::max<std::size_t>(bytes.size(), 16), alignment);
        std::memset(slice.data, 0, 16);
        std::memcpy(slice.data, bytes.data(), bytes.size());
        return slice;
    };
    light_records_.set(push(scene.lights.records));
    shadow_views_.set(push(scene.shadows.records));
    projector_records_.set(push(projectors_.records()));
    collect_speed_lines(world, view, speed_lines_);
    if (!for_picture) {
        speed_lines_.clear();
    }
    passes.speed_lines.count = static_cast<int>(speed_lines_.size());
    passes.speed_lines.records.set(push(speed_lines_));
    collect_mirrors(world, view.alpha, passes.mirrors.mirrors);
    place_caustics(scene.lights, scene.shadows, caustics);
    if (!for_picture) {
        caustics.maps.clear();
    }
    if (seen == Seen::InWater) {
        water.list.patches.clear();
        water.list.around.reset();
    }
    resize_caustic_atlas(passes.caustics);
    scene.waters = !water.list.bodies.empty();
    scene.mirrors = !caustics.mirrors.empty();
    if (scene.waters) {
        passes.caustics.waters.set(push(caustics.texels));
        passes.caustics.jobs.set(push(caustics.jobs));
        water.bodies.set(push(water.list.bodies));
        water.lines.set(push(water.list.lines));
        water.rings.set(push(water.list.rings));
        if (water.list.details.needed) {
            water.details.set(push(water.list.details.records));
            water.texture_waves.set(push(water.list.details.waves));
        }
        passes.water.patches.set(push(water.list.patches));
    }
    passes.clusters.lights.set(push(scene.clusters.lights));
    passes.clusters.boxes.set(push(scene.clusters.boxes));
    if (is_forward(scene.method)) {
        collect_light_objects(scene.lights, scene.clusters, scene.instances, light_objects_);
    }
    if (scene.method == LightMethod::ObjectMajor) {
        list_lights_of_objects(
            light_objects_, scene.instances.opaque_instances, lights_of_objects_);
        object_lists_.set(push(lights_of_objects_.lists));
        object_lights_.set(push(lights_of_objects_.lights));
    }
    if (scene.method == LightMethod::LightMajor) {
        list_draws_of_lights(light_objects_, scene.instances, scene.light_draws);
        scene.light_commands = push(scene.light_draws.commands);
    }
    layout::ViewBlock view_block = make_view_block(view, scene.clusters.shape, scene.lights);
    view_block.ray_forward.w = rendering.infinite_viewer ? 1.0f : 0.0f;
    scene.view_block = ring_.push_value(view_block);
    scene.environment_block = ring_.push_value(scene.environment.block);
    const layout::ProbeBlock probes = probes_.make_block();
    const bool any_probes = !for_probe && probes.count.x > 0;
    scene.probe_block = any_probes ? ring_.push_value(probes) : gpu::RingSlice{};
    scene.for_light = !for_picture;
    const auto end = std::chrono::steady_clock::now();

    const InstanceList& list = scene.instances;
    statistics = {
        .instances = list.total,
        .visible_instances = list.visible,
        .draws = static_cast<int>(list.opaque.size() + list.blended.size()),
        .triangles = list.triangles,
        .deformed = shapes_.work().instances,
        .lights = static_cast<int>(scene.lights.records.size()),
        .shadow_views = static_cast<int>(scene.shadows.records.size()),
        .shadow_views_drawn = static_cast<int>(scene.shadows.due.size()),
        .probe_faces = probe_faces_,
        .water_reflections = planar_water_.is_null() ? 0 : 1,
        .lit_objects = scene.method == LightMethod::LightMajor
                           ? static_cast<int>(light_objects_.objects.size())
                           : 0,
        .extract_ms = std::chrono::duration<double, std::milli>(end - begin).count()};
}

Gbuffer Renderer::draw_surfaces(bool attributes, bool velocity) {
    deform_meshes(graph, passes.deform, shapes_);
    const bool hybrids = std::any_of(
        scene.volumes.lights.begin(), scene.volumes.lights.end(), [](const VolumeLight& light) {
            return light.hybrid;  // asks for normals
        });
    if (is_forward(scene.method) && !attributes && !hybrids) {
        Gbuffer depth_alone;
        depth_alone.depth = draw_depth_first(graph, passes.forward, scene);
        return depth_alone;
    }
    return draw_gbuffer(graph, passes.gbuffer, scene, velocity);
}

TextureId Renderer::draw_radiance(FrameGraph& into, const Gbuffer& gbuffer, bool attributes) {
    const bool by_clusters =
        scene.method == LightMethod::Clustered || !scene.instances.blended.empty();
    scene.lists = by_clusters ? build_clusters(into, passes.clusters, scene) : ClusterLists{};
    if (reflection_due_) {
        const Environment& environment = scene.environment.settings;
        if (environment.sky == SkyKind::Panorama) {
            draw_panorama(
                into, passes.panorama, *materials_.find_image(environment.panorama), environment);
        }
        draw_sky_reflection(into, passes.reflection, scene);
    }
    scene.shadow_maps = draw_shadows(into, passes.shadows, scene);
    scene.caustics = draw_caustics(into, passes.caustics, passes.water.surfaces, scene);
    scene.shadow_masks = draw_shadow_volumes(into, passes.volumes, scene, gbuffer);
    TextureId radiance =
        scene.method == LightMethod::Clustered ? draw_lights(into, passes.lights, scene, gbuffer)
        : is_forward(scene.method) ? draw_forward(into, passes.forward, scene, gbuffer.depth)
                                   : draw_each_light(into, passes.light_each, scene, gbuffer);
    radiance = draw_sky(into, passes.lights, scene, radiance, gbuffer);
    draw_mirror_caustics(into, device, passes.mirrors, scene, radiance, gbuffer);
    draw_texture_waves(into, passes.texture_waves, passes.water.surfaces);
    radiance = draw_water(into, passes.water, scene, radiance, gbuffer, attributes);
    radiance = draw_water_veil(into, passes.veil, passes.water.surfaces, scene, radiance, gbuffer);
    radiance =
        draw_blended(into, passes.blend, scene, radiance, gbuffer);  // after sky: seen through
    draw_speed_lines(into, device, passes.speed_lines, scene, radiance, gbuffer);
    return radiance;
}

FrameTextures Renderer::draw_image(const FrameRequest& request, bool attributes, bool velocity) {
    FrameTextures made;
    made.gbuffer = draw_surfaces(attributes || velocity || !request.aovs.empty(), velocity);
    const Gbuffer& gbuffer = made.gbuffer;
    made.radiance = draw_radiance(graph, gbuffer, attributes || !request.aovs.empty());
    for (int i = 0; i < kAovCount; ++i) {
        if (std::find(request.aovs.begin(), request.aovs.end(), kAovs[i].name)
            != request.aovs.end()) {
            const TextureId layer = i == kVolumeLayersAov
                                        ? draw_volume_layers(graph, passes.volumes, scene)
                                        : draw_aov(graph, passes.aovs, scene, gbuffer, i);
            made.aovs.emplace_back(i, layer);
            graph.keep(made.aovs.back().second);
        }
    }
    return made;
}

void Renderer::develop_image(const World& world, const LensSettings& lens, FrameTextures& made) {
    made.radiance = apply_lens(graph, passes.lens, lens, scene, made.gbuffer, made.radiance);
    graph.keep(made.radiance);
    made.display =
        develop(graph, passes.developer, exposure_of(world), scene.since_last, made.radiance);
    graph.keep(made.display);
}

void Renderer::finish(FrameGraph& drawn) {
    drawn.execute();
    ring_.end_frame();
}

FrameOutput Renderer::output(const FrameTextures& textures) const {
    FrameOutput out;
    out.display = graph.texture(textures.display);
    out.radiance = graph.texture(textures.radiance);
    for (const auto& [index, texture] : textures.aovs) {
        out.aovs.push_back(
            {std::string(kAovs[index].name), kAovs[index].channels, graph.texture(texture)});
    }
    out.statistics = statistics;
    return out;
}

void Renderer::begin_sum(const IVec2& size, SampleKind kind) {
    if (!sum_ || sum_.width() != size.x || sum_.height() != size.y) {
        sum_ =
            gpu::Texture("accumulation", {.format = GL_RGBA32F, .width = size.x, .height = size.y});
    }
    sum_is_empty_ = true;
    sample_kind_ = kind;
    kept_aovs_.clear();
}

void Renderer::add_to_sum(const FrameTextures& made, const LensSettings& lens, float weight) {
    const TextureId picture =
        apply_lens(graph, passes.lens, lens, scene, made.gbuffer, made.radiance);
    const TextureId target = graph.import("accumulation", sum_);
    graph.add_pass(
        "accumulate", {picture}, {sum_is_empty_ ? cleared(target) : Use(target)},
        [program = passes.accumulate, weight, picture](PassContext& context) {
            gpu::PipelineState add = gpu::kFullscreenState;
            add.blend = gpu::kBlendAdd;
            context.device().use(gpu::Pipeline{program, add});
            program->set("weight", weight);
            context.bind_texture(0, picture);
            context.device().draw_fullscreen();
        });
    sum_is_empty_ = false;
}

void Renderer::keep_aovs(const FrameTextures& textures) {
    for (const auto& [index, id] : textures.aovs) {
        const gpu::Texture& drawn = *graph.texture(id);
        gpu::Texture copy(kAovs[index].name, drawn.desc());
        copy.copy_from(drawn);
        kept_aovs_.emplace_back(index, std::move(copy));
    }
}

std::vector<AovOutput> Renderer::kept_aovs() const {
    std::vector<AovOutput> aovs;
    for (const auto& [index, texture] : kept_aovs_) {
        aovs.push_back({std::string(kAovs[index].name), kAovs[index].channels, &texture});
    }
    return aovs;
}

Result<RendererPtr> create_renderer(gpu::Device& device, const RenderSettings& settings) {
    Result<DeformPass> deform = create_deform_pass(device);
    if (!deform) {
        return deform.error();
    }
    Result<GbufferPass> gbuffer = create_gbuffer_pass(device);
    if (!gbuffer) {
        return gbuffer.error();
    }
    Result<LightPass> lights = create_light_pass(device);
    if (!lights) {
        return lights.error();
    }
    Result<ClusterPass> clusters = create_cluster_pass(device);
    if (!clusters) {
        return clusters.error();
    }
    Result<LightEachPass> light_each = create_light_each_pass(device);
    if (!light_each) {
        return light_each.error();
    }
    Result<ForwardPass> forward = create_forward_pass(device);
    if (!forward) {
        return forward.error();
    }
    Result<BlendPass> blend = create_blend_pass(device);
    if (!blend) {
        return blend.error();
    }
    Result<Developer> developer = create_developer(device);
    if (!developer) {
        return developer.error();
    }
    Result<AovPass> aovs = create_aov_pass(device);
    if (!aovs) {
        return aovs.error();
    }
    Result<PanoramaPass> panorama = create_panorama_pass(device);
    if (!panorama) {
        return panorama.error();
    }
    Result<ProbePass> probes = create_probe_pass(device);
    if (!probes) {
        return probes.error();
    }
    Result<ReflectionPass> reflection = create_reflection_pass(device, settings.environment_size);
    if (!reflection) {
        return reflection.error();
    }
    Result<ShadowPass> shadows = create_shadow_pass(device);
    if (!shadows) {
        return shadows.error();
    }
    Result<ShadowVolumePass> volumes = create_shadow_volume_pass(device);
    if (!volumes) {
        return volumes.error();
    }
    Result<TextureCombinePass> combine = create_texture_combine_pass(device);
    if (!combine) {
        return combine.error();
    }
    Result<TextureWavePass> texture_waves = create_texture_wave_pass(device);
    if (!texture_waves) {
        return texture_waves.error();
    }
    Result<WaterPass> water = create_water_pass(device);
    if (!water) {
        return water.error();
    }
    Result<WaterVeilPass> veil = create_water_veil_pass(device);
    if (!veil) {
        return veil.error();
    }
    Result<CausticsPass> caustics = create_caustics_pass(device);
    if (!caustics) {
        return caustics.error();
    }
    const Result<const gpu::Program*> accumulate =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"});
    if (!accumulate) {
        return accumulate.error();
    }
    Passes passes = {
        *std::move(deform),
        *std::move(gbuffer),
        *std::move(lights),
        *std::move(clusters),
        *std::move(light_each),
        *std::move(forward),
        *std::move(blend),
        *std::move(developer),
        *std::move(aovs),
        *std::move(panorama),
        *std::move(reflection),
        *std::move(probes),
        *std::move(shadows),
        *std::move(volumes),
        *std::move(combine),
        *std::move(texture_waves),
        *std::move(water),
        *std::move(veil),
        *std::move(caustics),
        MirrorCausticPass{},
        SpeedLinePass{},
        LensPasses(device),
        *accumulate};
    return RendererPtr(new Renderer(device, settings, std::move(passes)));
}

FrameOutput render_frame(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request) {
    const LensSettings lens = lens_settings(world, view);
    const bool velocity = asks_for_velocity(request) || needs_velocity(lens);
    renderer.draw_probes(world, view);
    renderer.follow(world, view);
    const bool cut = !renderer.scene.since_last.has_value();
    const RenderView shown = lens_view(renderer.passes.lens, lens, view, cut);
    renderer.draw_water_reflection(world, shown);
    renderer.graph.begin_frame();
    renderer.prepare(world, shown, velocity);
    FrameTextures textures = renderer.draw_image(request, needs_attributes(lens), velocity);
    renderer.develop_image(world, lens, textures);
    renderer.finish(renderer.graph);
    return renderer.output(textures);
}

void begin_accumulation(Renderer& renderer, const IVec2& size, SampleKind kind) {
    renderer.begin_sum(size, kind);
}

void accumulate(Renderer& renderer, const World& world, const RenderView& view, float weight) {
    const LensSettings lens = lens_of_sample(lens_settings(world, view), renderer.sample_kind());
    const bool velocity = needs_velocity(lens);
    renderer.draw_probes(world, view);
    renderer.draw_water_reflection(world, view);
    renderer.graph.begin_frame();
    renderer.prepare(world, view, velocity);
    renderer.add_to_sum(renderer.draw_image({}, needs_attributes(lens), velocity), lens, weight);
    renderer.finish(renderer.graph);
}

void accumulate_aovs(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request) {
    if (request.aovs.empty()) {
        return;
    }
    const bool velocity = asks_for_velocity(request);
    const RenderView middle = with_jitter(view, {0, 0});
    renderer.draw_probes(world, view);
    renderer.draw_water_reflection(world, middle);
    renderer.graph.begin_frame();
    renderer.prepare(world, middle, velocity);
    const FrameTextures textures = renderer.draw_image(request, false, velocity);
    renderer.finish(renderer.graph);
    renderer.keep_aovs(textures);
}

FrameOutput finish_accumulation(Renderer& renderer, const World& world, const RenderView& view) {
    renderer.follow(world, view);
    renderer.graph.begin_frame();
    renderer.scene.view = view;
    FrameTextures textures;
    textures.radiance = renderer.graph.import("accumulation", renderer.sum());
    renderer.develop_image(world, lens_of_mean(lens_settings(world, view)), textures);
    renderer.graph.execute();
    FrameOutput out = renderer.output(textures);
    out.aovs = renderer.kept_aovs();
    return out;
}

FrameOutput render_accumulated(
    Renderer& renderer, const World& world, const RenderView& view, int samples,
    const FrameRequest& request) {
    LIMN_CHECK(samples >= 1);
    if (samples == 1) {
        return render_frame(renderer, world, with_jitter(view, {0, 0}), request);
    }
    begin_accumulation(renderer, {view.width, view.height}, SampleKind::Played);
    for (int i = 0; i < samples; ++i) {
        accumulate(
            renderer, world, with_jitter(view, sample_jitter(i, samples)),
            1.0f / static_cast<float>(samples));
    }
    accumulate_aovs(renderer, world, view, request);
    return finish_accumulation(renderer, world, view);
}

const std::vector<std::string_view>& aov_names() {
    static const std::vector<std::string_view> kNames = [] {
        std::vector<std::string_view> names;
        for (const Aov& aov : kAovs) {
            names.push_back(aov.name);
        }
        return names;
    }();
    return kNames;
}

int aov_channels(std::string_view name) {
    for (const Aov& aov : kAovs) {
        if (aov.name == name) {
            return aov.channels;
        }
    }
    return 0;
}

FrameGraph& frame_graph(Renderer& renderer) {
    return renderer.graph;
}

}  // namespace limn
