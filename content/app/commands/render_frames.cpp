#include "content/app/commands/render_frames.h"

#include "content/app/commands/exposure_samples.h"
#include "content/app/commands/image_file.h"
#include "content/app/player/player_camera.h"
#include "ecs/base/text.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/name.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/rendering.h"
#include "render/render_view.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

// Techniques: post.distributed-sampling

namespace limn {
namespace {

constexpr int kTemporalFrames = 16;  ///< after which temporal antialiasing has converged

/// Motion blur modes that keep previous frames must keep whole frames, not antialiasing samples.
int played_samples(const World& world, const RenderOptions& options) {
    const auto* blur = world.find_resource<MotionBlur>();
    return blur != nullptr && needs_previous_frames(blur->mode) ? 1 : options.edge_samples;
}

/// The names of all cameras, for the error about an unknown one.
std::string camera_names(const World& world) {
    std::string names;
    world.query<const Name, const Camera>().each(
        [&](const Name& name, const Camera&) { names += (names.empty() ? "" : ", ") + name.text; });
    return names.empty() ? "no named camera" : names;
}

/// Simulation times of a frame and of the previous one [s].
struct FrameTimes {
    double shown = 0;
    double previous = 0;
};

/// Steps the simulation to the frame's time and returns the camera's view.
RenderView
advance_to_view(Stage& stage, Entity camera, const RenderOptions& options, const FrameTimes& time) {
    const float alpha = advance_stage(stage, time.shown);
    if (options.camera.empty()) {
        camera = follow_active_camera(stage.world, camera);
    }
    const double steps = (time.shown - time.previous) / stage_step(stage);
    return make_render_view(
        stage.world, camera,
        {.width = options.size.x,
         .height = options.size.y,
         .alpha = alpha,
         .previous_alpha = alpha - static_cast<float>(steps)});
}

SampleMean sample_mean(const RenderOptions& options) {
    const bool light = options.samples > 0 || has_extension(options.out, ".exr");
    return options.average.value_or(light ? SampleMean::Light : SampleMean::Displayed);
}

/// Exposure time [s]: at most the time between frames.
double open_seconds(const World& world, const FrameTimes& time) {
    const auto* blur = world.find_resource<MotionBlur>();
    const double shutter_fraction =
        blur != nullptr ? static_cast<double>(blur->shutter) / 360.0 : 0.0;
    return std::clamp(shutter_fraction, 0.0, 1.0) * (time.shown - time.previous);
}

/// Renders the frame with the effects of `limn play`, antialiased by accumulation.
FrameOutput draw_played(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const FrameTimes& time) {
    const RenderView view = advance_to_view(stage, camera, options, time);
    return render_accumulated(
        renderer, stage.world, view, played_samples(stage.world, options), {.aovs = options.aovs},
        sample_mean(options));
}

/// Averages samples over shutter, lens and pixel while the simulation advances: the ground truth
/// that the real-time effects approximate. `progress` gets the number of samples that are done.
FrameOutput draw_sampled(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options,
    const FrameTimes& time, const std::function<void(int)>& progress) {
    const double open = open_seconds(stage.world, time);
    const float weight = 1.0f / static_cast<float>(options.samples);
    begin_accumulation(renderer, options.size, SampleKind::Instant, sample_mean(options));
    bool half_done = false;
    RenderView shown;
    for (int i = 0; i < options.samples; ++i) {
        const ExposureSample sample = exposure_sample(i, options.samples);
        const double sample_time = std::max(time.shown + sample.time * open, 0.0);
        if (!half_done && sample.time >= 0) {
            shown = advance_to_view(stage, camera, options, time);
            accumulate_aovs(renderer, stage.world, shown, {.aovs = options.aovs});
            half_done = true;
        }
        const RenderView view = advance_to_view(stage, camera, options, {sample_time, sample_time});
        accumulate(
            renderer, stage.world,
            with_lens_sample(
                with_jitter(view, sample.jitter), point_on_aperture(view.lens, sample.square)),
            weight);
        if (progress) {
            progress(i + 1);
        }
    }
    return finish_accumulation(renderer, stage.world, shown);
}

/// Frames that particles with screen-space collision live, two seconds at most.
int depth_collision_frames(const World& world, double step) {
    constexpr double kLongest = 2;  // [s]
    double longest = 0;
    world.query<const ParticleEmitter, const ParticleCollision>().each(
        [&](const ParticleEmitter& emitter, const ParticleCollision& collision) {
            if (runs_on_gpu(emitter) && collision.collide_depth > 0) {
                longest =
                    std::max(longest, static_cast<double>(emitter.life + emitter.life_spread));
            }
        });
    return static_cast<int>(std::ceil(std::min(longest, kLongest) / step));
}

/// How many previous frames an image depends on.
int previous_frames(const World& world, double step) {
    const auto* const blur = world.find_resource<MotionBlur>();
    const auto* const rendering = world.find_resource<Rendering>();
    const bool averages = blur != nullptr && needs_previous_frames(blur->mode);
    const bool accumulates =
        rendering != nullptr && rendering->antialiasing == Antialiasing::Temporal;
    return std::max(
        {averages ? blur->window : 0, accumulates ? kTemporalFrames : 0,
         depth_collision_frames(world, step)});
}

/// Whether later frames depend on the first one: probes may keep what they captured.
bool keeps_first_frame(const World& world) {
    return !world.query<const EnvProbe>().empty();
}

/// Those of the frames that are to be drawn: all that are not `done`, those on which they depend,
/// and where `from_first` the first one.
std::vector<bool> frames_to_draw(const std::vector<bool>& done, int dependent, bool from_first) {
    std::vector<bool> drawn(done.size(), false);
    int wanted = 0;  // more frames before the one at hand
    for (std::size_t i = done.size(); i-- > 0;) {
        wanted = done[i] ? wanted - 1 : dependent;
        drawn[i] = !done[i] || wanted >= 0;
    }
    if (from_first && std::ranges::count(drawn, true) > 0) {
        drawn[0] = true;
    }
    return drawn;
}

}  // namespace

Result<Entity> choose_camera(const Stage& stage, const std::string& name) {
    if (name.empty()) {
        return stage.scene.camera;
    }
    if (const std::optional<Entity> camera = find_camera(stage.world, name)) {
        return *camera;
    }
    return fail(
        "{}: found no camera \"{}\", expected one of: {}", stage.scene.path, name,
        camera_names(stage.world));
}

Result<RenderSession> open_render(const RenderOptions& options) {
    std::unique_ptr<Stage> stage = LIMN_TRY(open_stage(
        options.scene, {.seed = options.seed,
                        .assignments = options.assignments,
                        .show = options.show,
                        .model = options.model}));
    const Entity camera = LIMN_TRY(choose_camera(*stage, options.camera));
    HeadlessRenderer headless =
        LIMN_TRY(create_headless_renderer(options.profile, {}, options.renderer));
    LIMN_TRY(check_image_size(*headless.device, options.size));
    return RenderSession{std::move(stage), camera, std::move(headless)};
}

Status render_frames(
    RenderSession& session, const RenderOptions& options, const std::vector<bool>& done,
    const FrameEvents& events) {
    Stage& stage = *session.stage;
    Renderer& renderer = *session.headless.renderer;
    const auto drawn = frames_to_draw(
        done, previous_frames(stage.world, 1 / options.fps), keeps_first_frame(stage.world));
    const auto tick = [&events](int) {
        if (events.progress) {
            events.progress();
        }
    };
    for (std::size_t i = 0; i < done.size(); ++i) {
        if (!drawn[i]) {
            continue;
        }
        const int frame = options.frames->first + static_cast<int>(i);
        const FrameTimes time = {frame / options.fps, (frame - 1) / options.fps};
        if (!done[i] && events.begin) {
            events.begin(frame);
        }
        const FrameOutput image =
            options.samples > 0 ? draw_sampled(renderer, stage, session.camera, options, time, tick)
                                : draw_played(renderer, stage, session.camera, options, time);
        if (!done[i] && events.write) {
            LIMN_TRY(events.write(frame, image, time.shown));
        }
        tick(0);
    }
    return Done{};
}

FrameOutput draw_sampled_still(
    RenderSession& session, const RenderOptions& options, double time,
    const std::function<void(int)>& progress) {
    return draw_sampled(
        *session.headless.renderer, *session.stage, session.camera, options,
        {time, time - stage_step(*session.stage)}, progress);
}

FrameOutput draw_still(
    Renderer& renderer, Stage& stage, Entity camera, const RenderOptions& options, double time) {
    const double step = stage_step(stage);
    const auto draw_at = [&](double when) {
        const RenderView view = advance_to_view(stage, camera, options, {when, when - step});
        (void)render_frame(renderer, stage.world, view);
    };
    if (time > 0 && keeps_first_frame(stage.world)) {
        draw_at(0);
    }
    for (int i = previous_frames(stage.world, step); i > 0; --i) {
        if (time - i * step >= stage_time(stage)) {
            draw_at(time - i * step);
        }
    }
    return draw_played(renderer, stage, camera, options, {time, time - step});
}

}  // namespace limn
