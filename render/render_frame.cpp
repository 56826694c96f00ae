#include "render/render_frame.h"

#include "ecs/base/log.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/curvature_view.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/post.h"
#include "ecs/components/rendering.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "render/frame_clock.h"
#include "render/fullscreen.h"
#include "render/geometry/culling.h"
#include "render/geometry/mesh_pool.h"
#include "render/geometry/render_items.h"
#include "render/gpu/device.h"
#include "render/image.h"
#include "render/light/light_list.h"
#include "render/material/material_pool.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/skinning/deformed_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

// Techniques: engine.draw-frame, post.distributed-sampling

namespace limn {
namespace {

constexpr std::size_t kRingBytes = std::size_t{8} << 20;  ///< at start; grows with the scene
constexpr int kWarmUpHeight = 44;       ///< of images [px]; no side is a power of two
constexpr int kWarmUpEnvironment = 16;  ///< RenderSettings::environment_size

/// Simulated time that `view` shows [s].
double shown_time(const World& world, const RenderView& view) {
    const auto* time = world.find_resource<FrameTime>();
    return time != nullptr ? time->time - (1.0 - view.alpha) * time->step : 0.0;
}

/// The same view with fewer pixels, with circles of confusion of the same size, and in motion.
RenderView make_small(const RenderView& view) {
    RenderView small = view;
    if (view.height > kWarmUpHeight) {
        const float scale = static_cast<float>(view.height) / static_cast<float>(kWarmUpHeight);
        const int width = static_cast<int>(static_cast<float>(view.width) / scale);
        // Some effects have a special case for halving an odd size.
        small.height = kWarmUpHeight + view.height % 2;
        small.width = std::max(width - width % 2, 2) + view.width % 2;
        small.lens.aperture_radius *= scale;
        small.lens.max_blur *= scale;
    }
    small.previous_clip_from_world[3][0] += 0.01f;
    return with_jitter(small, {0, 0});
}

/// Bounds of everything that is drawn or emits light, ignoring what is not finite.
Bounds bounds_of(const World& world, const Assets& assets) {
    Bounds all;
    const auto add = [&all](const Bounds& box) {
        const Vec3 sum = box.min + box.max;
        if (std::isfinite(sum.x + sum.y + sum.z)) {
            grow(all, box);
        }
    };
    world.query<const WorldTransform, Optional<const MeshInstance>>().each(
        [&](const WorldTransform& transform, const MeshInstance* surface) {
            const Vec3 origin = transform_point(transform.world, Vec3(0));
            add({origin, origin});
            if (surface != nullptr && surface->mesh.index < assets.meshes.size()) {
                add(transform_bounds(transform.world, assets.meshes[surface->mesh.index].bounds));
            }
        });
    return all;
}

/// A view from diagonally above, from far enough that everything is in view.
RenderView make_overview(const Bounds& all, const RenderView& view) {
    constexpr Camera kCamera{};
    const float radius = std::max(glm::length(half_extent(all)), 1.0f);
    const Vec3 eye = center(all) + 4 * radius * glm::normalize(Vec3(1, 1, 1));
    const Affine pose = look_at(eye, center(all));
    return make_render_view(
        kCamera, pose, pose,
        {.width = view.width,
         .height = view.height,
         .alpha = view.alpha,
         .previous_alpha = view.previous_alpha});
}

}  // namespace

/// An effect of the list and its state.
struct EffectSlot {
    const EffectEntry* entry = nullptr;
    void* state = nullptr;  ///< null: not created yet
    bool failed = false;    ///< creation failed: logged, left out
    bool active = false;    ///< in this frame
};

/// A view of this frame and the effects that take part in it.
struct ViewSlot {
    ViewData data;
    std::string_view name;
    std::vector<std::uint8_t> takes_part;  ///< by effect
};

/// Radiance summed over samples, and the AOVs of the image.
struct Accumulation {
    gpu::Texture sum;
    bool empty = true;
    SampleKind kind = SampleKind::Played;
    SampleMean mean = SampleMean::Light;
    float compression = 0;  ///< exposure by which samples are compressed; 0: they are not
    std::vector<std::pair<std::string, gpu::Texture>> aovs;  ///< by name
};

class Renderer {
  public:
    Renderer(gpu::Device& its_device, const RenderSettings& its_settings)
        : device(its_device), graph(its_device), settings_(its_settings),
          ring_(its_device.caps(), "frame data", kRingBytes),
          materials_(its_device, its_settings.anisotropy),
          shapes_(static_cast<std::size_t>(its_device.caps().max_storage_bytes)) {
        // A software OpenGL writes 32-bit floats faster than 16-bit ones, which it truncates
        // instead of rounding.
        const bool full_float =
            its_settings.full_float || its_device.caps().profile == gpu::Profile::Software;
        frame_.radiance_format = full_float ? GL_RGBA32F : GL_RGBA16F;
        frame_.velocity_format = full_float ? GL_RG32F : GL_RG16F;
        frame_.device = &device;
        frame_.ring = &ring_;
        frame_.meshes = &meshes_;
        frame_.materials = &materials_;
        frame_.shapes = &shapes_;
        frame_.items = &items_;
        for (const EffectEntry& entry :
             its_settings.image.empty() ? standard_image() : its_settings.image) {
            effects_.push_back({&entry});
        }
    }
    ~Renderer() { destroy_effects(); }
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Creates the effects that every frame uses.
    Status create_effects() {
        for (EffectSlot& effect : effects_) {
            if (effect.entry->is_used == nullptr) {
                effect.state = LIMN_TRY(effect.entry->create(device, settings_));
            }
        }
        return Done{};
    }

    /// Draws the main view, of the given kind, and the views that it needs.
    FrameOutput draw(
        ViewKind kind, const World& world, const RenderView& camera, const FrameRequest& request,
        float weight = 0);
    void keep_aovs(const FrameOutput& output);
    int warm_up(const World& world, const RenderView& view, const WarmUpProgress& progress);

    gpu::Device& device;
    FrameGraph graph;
    Accumulation accumulation;

    void cut() { clock_ = {}; }

  private:
    void destroy_effects();
    /// Drops all state of earlier frames, except for uploaded assets.
    void forget_frames();
    [[nodiscard]] std::vector<RenderView>
    find_warm_up_views(const World& world, const RenderView& view);
    void begin(ViewKind kind, const World& world, const RenderView& camera);
    void update_assets();
    void choose_effects();
    void prepare_views();
    ViewSlot& view_slot(std::size_t index);
    void draw_views();
    void add_to_sum(const World& world, const ViewData& view, float weight);
    /// The mean of the samples that were added.
    TextureId mean_radiance();
    [[nodiscard]] float exposure_of_samples(const World& world) const;
    const gpu::Program* accumulation_program();

    RenderSettings settings_;
    std::vector<EffectSlot> effects_;
    gpu::RingBuffer ring_;
    MeshPool meshes_;
    MaterialPool materials_;
    DeformedList shapes_;
    RenderItems items_;
    FrameData frame_;
    std::vector<std::unique_ptr<ViewSlot>>
        views_;                   ///< the main one first; kept from frame to frame
    std::size_t view_count_ = 0;  ///< of this frame
    std::uint64_t assets_ = 0;    ///< identity of those that were uploaded
    FrameClock clock_;
    float warm_up_plain_below_ = 0;  ///< of RenderItems, where it is not 0
    const gpu::Program* add_ = nullptr;
};

void RendererDeleter::operator()(Renderer* renderer) const {
    delete renderer;
}

void Renderer::destroy_effects() {
    for (EffectSlot& effect : effects_) {
        if (effect.state != nullptr) {
            effect.entry->destroy(effect.state);
        }
        effect = {effect.entry};
    }
}

void Renderer::forget_frames() {
    graph.begin_frame();  // its passes refer to effects
    destroy_effects();
    views_.clear();
    shapes_.forget();
    frame_.data.clear();
    frame_.number = 0;
    clock_ = {};
}

std::vector<RenderView> Renderer::find_warm_up_views(const World& world, const RenderView& view) {
    std::vector<RenderView> views = {view};
    world.query<const Camera, const WorldTransform>().each(
        [&](Entity entity, const Camera&, const WorldTransform&) {
            const ViewRequest request = {
                .width = view.width,
                .height = view.height,
                .alpha = view.alpha,
                .previous_alpha = view.previous_alpha};
            const RenderView from_camera = make_render_view(world, entity, request);
            if (from_camera.unjittered_from_world != view.unjittered_from_world) {
                views.push_back(from_camera);
            }
        });
    if (const Bounds all = bounds_of(world, *frame_.assets); !is_empty(all)) {
        views.push_back(make_overview(all, view));
    }
    for (const EffectSlot& effect : effects_) {
        const EffectEntry& entry = *effect.entry;
        if (entry.add_warm_up_views != nullptr
            && (entry.is_used == nullptr || entry.is_used(frame_))) {
            entry.add_warm_up_views(frame_, views);
        }
    }
    return views;
}

int Renderer::warm_up(const World& world, const RenderView& view, const WarmUpProgress& progress) {
    device.shaders().count_loaded();
    const int environment_size = std::exchange(settings_.environment_size, kWarmUpEnvironment);
    frame_.warm_up = items_.sampled = true;
    begin(kCameraView, world, view);
    const std::vector<RenderView> views = find_warm_up_views(world, view);
    struct Round {
        bool all_lights = false;
        bool finest = false;
        float plain_below = 0;
    };
    std::vector<Round> rounds(1);
    if (any_light_off(world)) {
        rounds.push_back({.all_lights = true});
    }
    if (world.query<const MeshLevels, const Deformed>().count() > 0) {
        rounds.push_back({.all_lights = true, .finest = true});
    }
    const auto* const rendering = world.find_resource<Rendering>();
    if (rendering != nullptr && rendering->plain_below > 0) {
        const std::vector<Round> detailed = rounds;
        for (Round round : detailed) {
            round.plain_below = INFINITY;
            rounds.push_back(round);
        }
    }
    const int total = static_cast<int>(rounds.size() * views.size());
    int done = 0;
    for (const Round& round : rounds) {
        forget_frames();  // so that effects request all their programs, and draw their caches
        frame_.all_lights = round.all_lights;
        shapes_.finest = round.finest;
        warm_up_plain_below_ = round.plain_below;
        for (const RenderView& one : views) {
            if (progress) {
                progress(done++, total);
            }
            draw(kCameraView, world, make_small(one), {});
        }
    }
    frame_.warm_up = items_.sampled = frame_.all_lights = shapes_.finest = false;
    settings_.environment_size = environment_size;
    forget_frames();
    return static_cast<int>(device.shaders().loaded_count());
}

void Renderer::begin(ViewKind kind, const World& world, const RenderView& camera) {
    static const Assets kNone;
    const auto* assets = world.find_resource<Assets>();
    frame_.data.begin();
    frame_.world = &world;
    frame_.assets = assets != nullptr ? assets : &kNone;
    ++frame_.number;
    frame_.kind = kind;
    frame_.sample = accumulation.kind;
    frame_.camera = camera;
    frame_.time = shown_time(world, camera);
    frame_.velocity = false;
    frame_.attributes = false;
    frame_.material_ids = false;
    frame_.views.clear();
    update_assets();
    if ((kind & kFilmViews) != 0) {
        frame_.since_last =
            seconds_since_last(clock_, assets_, frame_.time, camera.world_from_camera, camera.cut);
    } else {
        frame_.since_last.reset();
    }
}

void Renderer::update_assets() {
    const Assets& assets = *frame_.assets;
    const bool replaced = assets_ != assets.identity.value()
                          || meshes_.meshes().size() > assets.meshes.size()
                          || materials_.images().size() > assets.images.size();
    if (replaced) {
        meshes_.clear();
        shapes_.forget();
        assets_ = assets.identity.value();
    }
    frame_.assets_identity = assets_;
    frame_.assets_replaced = replaced;
    const auto* rendering = frame_.world->find_resource<Rendering>();
    const Rendering settings = rendering != nullptr ? *rendering : Rendering{};
    materials_.update(assets, replaced, settings.surface_detail, settings.plain_below > 0);
    items_.plain_below =
        frame_.warm_up && settings.plain_below > 0 ? warm_up_plain_below_ : settings.plain_below;
    const bool viewed = frame_.world->find_resource<CurvatureView>() != nullptr;
    meshes_.update(assets.meshes, materials_.curves() || viewed);
}

/// Effects that some view of this frame may use; creates them when they are first used.
void Renderer::choose_effects() {
    const std::uint32_t kinds =
        (frame_.kind & kMainViews) != 0 ? frame_.kind | kProbeView | kMirrorView : frame_.kind;
    for (EffectSlot& effect : effects_) {
        const EffectEntry& entry = *effect.entry;
        const bool wanted =
            entry.views == 0 ? (frame_.kind & kMainViews) != 0 : (entry.views & kinds) != 0;
        effect.active =
            wanted && !effect.failed && (entry.is_used == nullptr || entry.is_used(frame_));
        if (effect.active && effect.state == nullptr) {
            const Result<void*> state = entry.create(device, settings_);
            if (state) {
                effect.state = *state;
            } else {
                log_error("{}", state.error().message);
                effect.failed = true;
                effect.active = false;
            }
        }
    }
}

ViewSlot& Renderer::view_slot(std::size_t index) {
    while (index >= views_.size()) {
        views_.push_back(std::make_unique<ViewSlot>());
    }
    return *views_[index];
}

/// Requested views come first: the main view uses their images.
void Renderer::prepare_views() {
    view_count_ = frame_.views.size() + 1;
    const gpu::RingSlice zeros =
        ring_.push_value(std::array<std::byte, layout::kEffectBlockBytes>{});
    for (std::size_t i = 0; i < view_count_; ++i) {
        const bool main = i + 1 == view_count_;
        ViewSlot& slot = view_slot(main ? 0 : i + 1);
        ViewData& view = slot.data;
        view.frame = &frame_;
        view.kind = main ? frame_.kind : frame_.views[i].kind;
        view.camera = main ? frame_.camera : frame_.views[i].camera;
        view.index = main ? 0 : frame_.views[i].index;
        view.velocity = main && frame_.velocity;
        view.attributes = main && frame_.attributes;
        view.material_ids = main && frame_.material_ids;
        view.lighting.clear();
        view.effect_blocks.fill(zeros);
        view.gbuffer = {};
        view.radiance = {};
        view.scattered = {};
        view.spreads = false;
        view.display = {};
        view.data.begin();
        slot.name = main ? std::string_view() : frame_.views[i].name;
        slot.takes_part.assign(effects_.size(), 0);
        for (std::size_t e = 0; e < effects_.size(); ++e) {
            const EffectSlot& effect = effects_[e];
            const bool chosen = effect.active && view.is(effect.entry->views);
            slot.takes_part[e] = chosen
                                 && (effect.entry->prepare == nullptr
                                     || effect.entry->prepare(effect.state, frame_, view));
        }
    }
}

void Renderer::draw_views() {
    for (const EffectSlot& effect : effects_) {
        if (effect.active && effect.entry->draw_shared != nullptr) {
            effect.entry->draw_shared(effect.state, graph, frame_);
        }
    }
    for (std::size_t i = 0; i < view_count_; ++i) {
        ViewSlot& slot = *views_[i + 1 == view_count_ ? 0 : i + 1];
        graph.begin_scope(slot.name);
        if (slot.data.is(kMeanView)) {
            slot.data.radiance = mean_radiance();
        }
        for (std::size_t e = 0; e < effects_.size(); ++e) {
            if (slot.takes_part[e] != 0 && effects_[e].entry->draw != nullptr) {
                effects_[e].entry->draw(effects_[e].state, graph, frame_, slot.data);
            }
        }
        graph.end_scope();
    }
}

FrameOutput Renderer::draw(
    ViewKind kind, const World& world, const RenderView& camera, const FrameRequest& request,
    float weight) {
    const std::size_t programs = device.shaders().program_count();
    frame_.aovs = request.aovs;
    frame_.paced = request.paced;
    items_.sampled = request.few_triangles || frame_.warm_up;
    graph.begin_frame();
    ring_.begin_frame();
    begin(kind, world, camera);
    const auto begin_time = std::chrono::steady_clock::now();
    choose_effects();
    for (const EffectSlot& effect : effects_) {
        if (effect.active && effect.entry->collect != nullptr) {
            effect.entry->collect(effect.state, frame_);
        }
    }
    for (const EffectSlot& effect : effects_) {
        if (effect.active && effect.entry->request_views != nullptr) {
            effect.entry->request_views(effect.state, frame_);
        }
    }
    const Affine& eye = camera.world_from_camera;
    shapes_.update(
        world, meshes_, camera.alpha, camera.previous_alpha,
        {eye.row[0].w, eye.row[1].w, eye.row[2].w});
    items_.update(world, meshes_, materials_, shapes_, camera.alpha);
    items_.furs().upload(ring_);
    prepare_views();
    const auto end_time = std::chrono::steady_clock::now();
    draw_views();

    const ViewData& view = views_[0]->data;
    if (weight > 0) {
        add_to_sum(world, view, weight);
    }
    if (view.display.valid()) {
        graph.keep(view.radiance);
        graph.keep(view.display);
    }
    graph.execute();
    ring_.end_frame();

    FrameOutput out;
    if (view.display.valid()) {
        out.display = graph.texture(view.display);
        out.radiance = graph.texture(view.radiance);
    }
    for (std::size_t e = 0; e < effects_.size(); ++e) {
        if (effects_[e].active && effects_[e].entry->report != nullptr) {
            effects_[e].entry->report(effects_[e].state, frame_, view, out);
        }
    }
    out.statistics.programs = static_cast<int>(device.shaders().program_count());
    out.statistics.compiled = out.statistics.programs - static_cast<int>(programs);
    out.statistics.extract_ms =
        std::chrono::duration<double, std::milli>(end_time - begin_time).count();
    return out;
}

float Renderer::exposure_of_samples(const World& world) const {
    const auto* const found = world.find_resource<Exposure>();
    const Exposure exposure = found != nullptr ? *found : Exposure{};
    const bool compresses =
        accumulation.mean == SampleMean::Displayed && exposure.metering == Metering::Manual;
    return compresses ? std::exp2(exposure.ev + exposure.manual_ev) : 0.0f;
}

TextureId Renderer::mean_radiance() {
    const TextureId sum = graph.import("accumulation", accumulation.sum);
    const float factor = accumulation.compression;
    if (factor == 0) {
        return sum;
    }
    const TextureId mean = create_target(
        graph, "expanded mean", GL_RGBA32F, {accumulation.sum.width(), accumulation.sum.height()});
    add_fullscreen_pass(
        graph, "expand mean", {sampled(sum, layout::kSourceUnit)}, {discarded(mean)},
        accumulation_program(), [factor](PassContext&, const gpu::Program& program) {
            program.set("weight", 1.0f);
            program.set("compression", -factor);
        });
    return mean;
}

const gpu::Program* Renderer::accumulation_program() {
    if (add_ == nullptr) {
        const Result<const gpu::Program*> program =
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"});
        LIMN_CHECK_NOTE(program.ok(), "accumulate.frag does not compile");
        add_ = *program;
    }
    return add_;
}

void Renderer::add_to_sum(const World& world, const ViewData& view, float weight) {
    const TextureId target = graph.import("accumulation", accumulation.sum);
    if (accumulation.empty) {  // the same for all samples, whatever happens in the world
        accumulation.compression = exposure_of_samples(world);
    }
    const float factor = accumulation.compression;
    gpu::PipelineState state = gpu::kFullscreenState;
    state.blend = gpu::kBlendAdd;
    add_fullscreen_pass(
        graph, "accumulate", {sampled(view.radiance, layout::kSourceUnit)},
        {accumulation.empty ? cleared(target) : Use(target)}, accumulation_program(), state,
        [weight, factor](PassContext&, const gpu::Program& program) {
            program.set("weight", weight);
            program.set("compression", factor);
        });
    accumulation.empty = false;
}

void Renderer::keep_aovs(const FrameOutput& output) {
    for (const AovOutput& aov : output.aovs) {
        gpu::Texture copy(aov.name, aov.texture->desc());
        aov.texture->copy_to(copy);
        accumulation.aovs.emplace_back(aov.name, std::move(copy));
    }
}

Result<RendererPtr> create_renderer(gpu::Device& device, const RenderSettings& settings) {
    RendererPtr renderer(new Renderer(device, settings));
    LIMN_TRY(renderer->create_effects());
    return renderer;
}

FrameOutput render_frame(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request) {
    return renderer.draw(kCameraView, world, view, request);
}

void cut(Renderer& renderer) {
    renderer.cut();
}

int warm_up(
    Renderer& renderer, const World& world, const RenderView& view,
    const WarmUpProgress& progress) {
    return renderer.warm_up(world, view, progress);
}

void begin_accumulation(Renderer& renderer, const IVec2& size, SampleKind kind, SampleMean mean) {
    Accumulation& into = renderer.accumulation;
    if (!into.sum || into.sum.width() != size.x || into.sum.height() != size.y) {
        into.sum =
            gpu::Texture("accumulation", {.format = GL_RGBA32F, .width = size.x, .height = size.y});
    }
    into.empty = true;
    into.kind = kind;
    into.mean = mean;
    into.aovs.clear();
}

void accumulate(Renderer& renderer, const World& world, const RenderView& view, float weight) {
    renderer.draw(kSampleView, world, view, {}, weight);
}

void accumulate_aovs(
    Renderer& renderer, const World& world, const RenderView& view, const FrameRequest& request) {
    if (!request.aovs.empty()) {
        renderer.keep_aovs(renderer.draw(kSampleView, world, with_jitter(view, {0, 0}), request));
    }
}

FrameOutput finish_accumulation(Renderer& renderer, const World& world, const RenderView& view) {
    FrameOutput out = renderer.draw(kMeanView, world, view, {});
    for (const auto& [name, texture] : renderer.accumulation.aovs) {
        out.aovs.push_back({name, aov_channels(name), &texture});
    }
    return out;
}

FrameOutput render_accumulated(
    Renderer& renderer, const World& world, const RenderView& view, int samples,
    const FrameRequest& request, SampleMean mean) {
    LIMN_CHECK(samples >= 1);
    if (samples == 1) {
        return render_frame(renderer, world, with_jitter(view, {0, 0}), request);
    }
    begin_accumulation(renderer, {view.width, view.height}, SampleKind::Played, mean);
    for (int i = 0; i < samples; ++i) {
        accumulate(
            renderer, world, with_jitter(view, sample_jitter(i, samples)),
            1.0f / static_cast<float>(samples));
    }
    accumulate_aovs(renderer, world, view, request);
    return finish_accumulation(renderer, world, view);
}

FrameGraph& frame_graph(Renderer& renderer) {
    return renderer.graph;
}

}  // namespace limn
