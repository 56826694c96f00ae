#include "bench/particles/particle_race.h"
#include "bench/particles/particle_rows.h"
#include "ecs/base/rng.h"
#include "ecs/components/all.h"
#include "ecs/components/gpu_particles.h"
#include "ecs/components/light.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/components/weather.h"
#include "ecs/world.h"
#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/shader_library.h"
#include "render/particles/gpu_particle_pools.h"
#include "render/render_frame.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/particle_obstacles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Drawing and moving particles on the GPU, against programs without an engine. On a software
// OpenGL, which draws with several threads, times are the sum over all threads of the process.

namespace limn::bench {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 360;
constexpr int kImageSide = 64;

clockid_t drawing_clock = CLOCK_PROCESS_CPUTIME_ID;

double time_now() {  // [s]
    std::timespec now{};
    clock_gettime(drawing_clock, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Time of a call and of all that it asked the GPU for [s].
template <typename Run>
double drawing_time(Run&& run) {
    glFinish();
    const double begin = time_now();
    run();
    glFinish();
    return time_now() - begin;
}

/// A soft white spot, in four frames of a flipbook.
ImageData make_spot() {
    ImageData image;
    image.width = image.height = kImageSide;
    image.srgb = false;
    for (int y = 0; y < kImageSide; ++y) {
        for (int x = 0; x < kImageSide; ++x) {
            const Vec2 at = (Vec2(x, y) + 0.5f) / (0.5f * kImageSide) - 1.0f;
            const float a = std::max(1 - at.x * at.x - at.y * at.y, 0.0f);
            for (const float value : {1.0f, 1.0f, 1.0f, 0.3f * a}) {
                image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
            }
        }
    }
    return image;
}

/// Centers of particles whose whole quads are in the image, for the engine and the plain programs
/// [fractions of the image].
std::vector<Vec2> random_centers(std::size_t count, float side) {
    Random random(7, 1, 8, 2);
    const Vec2 border = 0.5f * side / Vec2(kWidth, kHeight);
    std::vector<Vec2> found(count);
    for (Vec2& at : found) {
        at = border + (1.0f - 2.0f * border) * Vec2(random.uniform(), random.uniform());
    }
    return found;
}

/// Quads drawn by a minimal program.
class PlainSprites {
  public:
    PlainSprites(gpu::Device& device, std::span<const Vec2> at, float side)
        : device_(device), library_(device.caps(), make_files()),
          count_(static_cast<int>(at.size())), side_(side),
          target_("target", {.format = GL_RGBA16F, .width = kWidth, .height = kHeight}),
          image_("spot", {.format = GL_RGBA8, .width = kImageSide, .height = kImageSide}) {
        image_.upload<std::uint8_t>(make_spot().pixels, GL_RGBA, GL_UNSIGNED_BYTE);
        glTextureParameteri(image_.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTextureParameteri(image_.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glCreateFramebuffers(1, &frame_);
        glNamedFramebufferTexture(frame_, GL_COLOR_ATTACHMENT0, target_.id(), 0);
        std::vector<Vec4> records;
        for (const Vec2& one : at) {
            records.emplace_back(2.0f * one - 1.0f, 0.0f, 0.0f);
        }
        records_ = gpu::Buffer::of("centers", std::span<const Vec4>(records));
        texels_.set(records_);
    }
    ~PlainSprites() { glDeleteFramebuffers(1, &frame_); }
    PlainSprites(const PlainSprites&) = delete;
    PlainSprites& operator=(const PlainSprites&) = delete;

    enum class Shape { Strip, SixVertices };
    /// Draws them all once; `textured`: else a disc.
    double time(Shape shape, bool textured) {
        std::vector<gpu::ShaderDefine> defines;
        defines.push_back({shape == Shape::Strip ? "STRIP" : "SIX"});
        if (textured) {
            defines.push_back({"TEXTURED"});
        }
        const Result<const gpu::Program*> program =
            library_.load({.vertex = "plain.vert", .fragment = "plain.frag", .defines = defines});
        if (!program) {
            fmt::print(stderr, "{}\n", program.error().message);
            return NAN;
        }
        device_.invalidate_state();
        device_.use(gpu::Pipeline{
            *program,
            {.depth = {.test = false, .write = false},
             .blend = gpu::kBlendPremultiplied,
             .cull = GL_NONE}});
        (*program)->set("extent", side_ / Vec2(kWidth, kHeight));
        device_.bind_texture(0, image_);
        texels_.bind(device_, 2);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_);
        glViewport(0, 0, kWidth, kHeight);
        const double found = drawing_time([&] {
            if (shape == Shape::Strip) {
                device_.draw(GL_TRIANGLE_STRIP, 0, 4, count_);
            } else {
                device_.draw(GL_TRIANGLES, 0, 6 * count_);
            }
        });
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        device_.invalidate_state();
        return found;
    }

  private:
    static gpu::ShaderFiles make_files() {
        gpu::ShaderFiles files = gpu::ShaderFiles::standard();
        files.put("plain.vert", R"(#version 450
layout(binding = 2) uniform samplerBuffer centers;
uniform vec2 extent;
layout(location = 0) out vec2 uv;
void main() {
#ifdef STRIP
    int at = gl_InstanceID;
    int corner = gl_VertexID;
#else
    int at = gl_VertexID / 6;
    int corner = int[6](0, 1, 2, 2, 1, 3)[gl_VertexID % 6];
#endif
    vec2 center = texelFetch(centers, at).xy;
    uv = vec2(corner & 1, corner >> 1);
    gl_Position = vec4(center + extent * (2.0 * uv - 1.0), 0.0, 1.0);
}
)");
        files.put("plain.frag", R"(#version 450
layout(binding = 0) uniform sampler2D image;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
#ifdef TEXTURED
    vec4 s = texture(image, uv);
#else
    vec2 position = 2.0 * uv - 1.0;
    float inside = max(1.0 - dot(position, position), 0.0);
    vec4 s = vec4(1.0, 1.0, 1.0, inside * inside);
#endif
    color = vec4(s.rgb * s.a, s.a);
}
)");
        return files;
    }

    gpu::Device& device_;
    gpu::ShaderLibrary library_;
    int count_;
    float side_;
    gpu::Texture target_;
    gpu::Texture image_;
    gpu::Buffer records_;
    BufferTexture texels_ = BufferTexture("centers", GL_RGBA32F);
    GLuint frame_ = 0;
};

/// The same particles in a world that holds nothing else.
class EngineSprites {
  public:
    EngineSprites(Renderer& renderer, std::span<const Vec2> at, float side)
        : renderer_(renderer), centers_(at.begin(), at.end()) {
        world_.insert_resource(FrameTime{});
        Assets assets;
        assets.images.push_back(make_spot());
        ImageData still;
        still.width = still.height = kImageSide;
        still.srgb = false;
        still.pixels.assign(static_cast<std::size_t>(4 * kImageSide * kImageSide), 128);
        assets.images.push_back(std::move(still));
        world_.insert_resource(std::move(assets));
        look_.facing = ParticleFacing::Pixels;
        look_.size = side;
        look_.turn_spread = 0;
        look_.lit = 0;
        look_.emission = 1;
        look_.softness = 0;
        look_.image = {0};
    }
    /// White lamps around the center of the particles, each of which lights all of them.
    void add_lamps(int count) {
        for (int i = 0; i < count; ++i) {
            const float turn = 2 * kPi * static_cast<float>(i) / static_cast<float>(count);
            world_.create(
                PointLight{.intensity = 5},
                WorldTransform{affine_from(
                    {3 * std::cos(turn), 3 * std::sin(turn), -kAway}, Quat(1, 0, 0, 0), Vec3(1))});
        }
    }
    /// Time of a frame with them minus that of one without [s].
    double time(const ParticleLook& look) {
        const Entity all = emit(look);
        const double with = frame_time();
        world_.destroy(all);
        return with - frame_time();
    }
    [[nodiscard]] const ParticleLook& look() const { return look_; }
    /// Without the image, as a point or a quad.
    [[nodiscard]] ParticleLook disc(ParticleFacing facing) const {
        ParticleLook disc = look_;
        disc.image = {};
        disc.facing = facing;
        disc.size *= 2 * kAway * view_.tangent.y / static_cast<float>(kHeight);  // [m]
        return disc;
    }

  private:
    Entity emit(const ParticleLook& look) {
        ParticlePool pool;
        for (const Vec2& at : centers_) {
            const Vec2 ndc = 2.0f * at - 1.0f;
            pool.x.push_back(ndc.x * kAway * view_.tangent.x);
            pool.y.push_back(ndc.y * kAway * view_.tangent.y);
            pool.z.push_back(-kAway);
            for (auto* column : {&pool.vx, &pool.vy, &pool.vz}) {
                column->push_back(0);
            }
            pool.age.push_back(0.5f);
            pool.life.push_back(1);
            pool.look.push_back(7);
        }
        return world_.create(ParticleEmitter{}, look, std::move(pool));
    }
    double frame_time() {
        return drawing_time([&] { (void)render_frame(renderer_, world_, view_); });
    }

    static constexpr float kAway = 5;  // [m]
    Renderer& renderer_;
    std::vector<Vec2> centers_;
    World world_;
    RenderView view_ = make_render_view(
        {.fov_y = radians(60.0f), .near = 0.05f}, Affine{}, Affine{},
        {.width = kWidth, .height = kHeight});
    ParticleLook look_;
};

/// Minimum of several runs of two functions that return times, alternating.
template <typename A, typename B>
std::pair<double, double> best_of(A a, B b) {
    std::pair<double, double> best = {INFINITY, INFINITY};
    for (int i = 0; i < std::min(max_repeats, 9); ++i) {
        best.first = std::min(best.first, a());
        best.second = std::min(best.second, b());
    }
    return best;
}

/// Quads of 64 px, per pixel that they cover.
void add_fill_rows(ParticleBench& bench, gpu::Device& device, Renderer& renderer) {
    constexpr std::size_t kCount = 2000;
    constexpr float kSide = 64;
    constexpr double kPixel = 1e9 / (static_cast<double>(kCount) * kSide * kSide);
    const std::vector<Vec2> at = random_centers(kCount, kSide);
    PlainSprites plain(device, at, kSide);
    EngineSprites engine(renderer, at, kSide);
    const auto add = [&](const char* gate, const char* name, const ParticleLook& look,
                         double limit) {
        const auto [ours, other] = best_of(
            [&] { return engine.time(look); },
            [&] { return plain.time(PlainSprites::Shape::Strip, true); });
        bench.add(
            GateRow{gate, name, ours * kPixel, other * kPixel, "a plain program", "ns/px", limit});
    };
    add("18", "sprite of 64 px", engine.look(), 1.05);
    ParticleLook look = engine.look();
    look.softness = 0.3f;
    add("19", "soft sprite", look, 1.4);
    look = engine.look();
    look.sort = ParticleSort::Weighted;
    add("19", "weighted sprite", look, 1.1);
    look = engine.look();
    look.columns = look.rows = 2;
    look.frame_rate = 3;
    look.motion = {1};
    add("19", "flipbook with motion map", look, 2.4);
    look = engine.look();
    look.lit = 1;
    look.negative_light = {0};
    add("19", "six-way lit sprite, no lights", look, 1.5);
}

/// Particles of 2 px.
void add_small_rows(ParticleBench& bench, gpu::Device& device, Renderer& renderer) {
    constexpr std::size_t kCount = 50000;
    constexpr double kEach = 1e9 / static_cast<double>(kCount);
    const std::vector<Vec2> at = random_centers(kCount, 2);
    PlainSprites plain(device, at, 2);
    EngineSprites engine(renderer, at, 2);
    using Shape = PlainSprites::Shape;
    const ParticleLook disc = engine.disc(ParticleFacing::Camera);
    const auto [discs, six] = best_of(
        [&] { return engine.time(disc); }, [&] { return plain.time(Shape::SixVertices, false); });
    bench.add(GateRow{
        "20", "disc of 2 px", discs * kEach, six * kEach, "a quad of 6 vertices, plain", "ns",
        0.75});
    const auto [points, images] = best_of(
        [&] { return engine.time(engine.disc(ParticleFacing::Point)); },
        [&] { return engine.time(engine.look()); });
    bench.add(GateRow{
        "20", "point of 2 px", points * kEach, images * kEach, "an image of 2 px, a quad", "ns",
        0.65});
}

/// Light of particles of 2 px, evaluated once or at four corners.
void add_light_row(ParticleBench& bench, Renderer& renderer) {
    constexpr std::size_t kCount = 20000;
    constexpr double kEach = 1e9 / static_cast<double>(kCount);
    EngineSprites engine(renderer, random_centers(kCount, 2), 2);
    engine.add_lamps(16);
    ParticleLook look = engine.disc(ParticleFacing::Camera);
    look.lit = 1;
    look.emission = 0;
    ParticleLook at_center = look;
    at_center.lit_at = ParticleLitAt::Middle;
    const auto [center, corners] =
        best_of([&] { return engine.time(at_center); }, [&] { return engine.time(look); });
    bench.add(GateRow{
        "28", "disc of 2 px, 16 lamps, lit in the middle", center * kEach, corners * kEach,
        "lit at its corners", "ns", 0.9});
}

constexpr std::uint32_t kMillion = 1000000;

/// A world with nothing but a million falling particles, moved by the GPU.
struct Million {
    World world;
    Entity entity;
    ParticleEmitter emitter;

    Million() {
        world.insert_resource(FrameTime{});
        world.insert_resource(RandomSeed{});
        world.insert_resource(WeatherState{});
        world.insert_resource(Assets{});
        world.insert_resource(ParticleObstacles{});
        world.insert_resource(GpuShapes{});
        emitter.executor = ParticleExecutor::Gpu;
        emitter.rate = 0;
        emitter.bursts = {{.time = 0, .count = static_cast<float>(kMillion)}};
        emitter.capacity = kMillion;
        emitter.life = 1e5f;
        emitter.shape = EmitterShape::Box;
        emitter.size = Vec3(2);
        entity = world.create(
            emitter, ParticleMotion{}, WorldTransform{}, PreviousWorldTransform{Affine{}});
        world.run(add_gpu_particles);
    }
    void step() {
        FrameTime& time = world.resource<FrameTime>();
        time.time += static_cast<double>(time.step);
        ++time.frame;
        world.run(record_gpu_particles);
    }
};

/// The engine's dispatch, and one that reads and writes the same buffers.
void add_move_row(ParticleBench& bench, gpu::Device& device) {
    Million all;
    Result<GpuParticlePools> pools = GpuParticlePools::create(device);
    if (!pools) {
        bench.note("21: " + pools.error().message);
        return;
    }
    FrameGraph graph(device);
    graph.set_gpu_timing(false);
    gpu::RingBuffer ring(device.caps(), "steps", 1 << 20);
    const auto step = [&] {
        all.step();
        FrameData frame;
        frame.ring = &ring;
        frame.device = &device;
        ring.begin_frame();
        pools->begin_frame(all.world);
        pools->add(frame, all.entity, all.emitter, all.world.get<GpuParticles>(all.entity), 0);
        graph.begin_frame();
        pools->update(graph, {});
        const double found = drawing_time([&] { graph.execute(); });
        ring.end_frame();
        return found;
    };
    step();  // their births
    gpu::ShaderFiles files = gpu::ShaderFiles::standard();
    files.put("bare.comp", R"(#version 450
layout(local_size_x = 128) in;
layout(std430, binding = 0) buffer State { vec4 state[]; };
layout(std430, binding = 1) buffer Bits { uint bits[]; };
layout(std430, binding = 2) writeonly buffer Instances { uint instances[]; };
uniform uint count;
uniform vec4 shift;  // so that no compiler leaves out what is written
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) {
        vec4 position = state[2u * i] + shift;
        vec4 velocity = state[2u * i + 1u] + shift;
        uint word = bits[i];
        state[2u * i] = position;
        state[2u * i + 1u] = velocity;
        instances[7u * i] = floatBitsToUint(position.x);
        instances[7u * i + 1u] = floatBitsToUint(position.y);
        instances[7u * i + 2u] = floatBitsToUint(position.z);
        instances[7u * i + 3u] = floatBitsToUint(position.w);
        instances[7u * i + 4u] = floatBitsToUint(velocity.x);
        instances[7u * i + 5u] = floatBitsToUint(velocity.y);
        instances[7u * i + 6u] = word;
    }
}
)");
    gpu::ShaderLibrary library(device.caps(), files);
    const Result<const gpu::Program*> program = library.load({.compute = "bare.comp"});
    if (!program) {
        bench.note("21: " + program.error().message);
        return;
    }
    const GpuParticlePool& pool = *pools->pools().begin()->second;
    const auto bare = [&] {
        device.use(**program);
        (*program)->set("count", kMillion);
        (*program)->set("shift", Vec4(0));
        device.bind_storage(0, pool.state);
        device.bind_storage(1, pool.bits);
        device.bind_storage(2, pool.instances);
        return drawing_time([&] { device.dispatch((kMillion + 127) / 128); });
    };
    const auto [ours, other] = best_of(step, bare);
    constexpr double kEach = 1e9 / static_cast<double>(kMillion);
    bench.add(GateRow{
        "21", "1M moved by the GPU", ours * kEach, other * kEach, "a bare dispatch, same buffers",
        "ns", 1.2});
}

/// The same million as points of about 2 px, moved and drawn, minus a frame without them. A
/// nanosecond each is a millisecond for all.
void add_million_row(ParticleBench& bench, Renderer& renderer) {
    const RenderView view = make_render_view(
        {.fov_y = radians(60.0f), .near = 0.05f}, look_at({0, 0, 8}, {0, 0, 0}),
        look_at({0, 0, 8}, {0, 0, 0}), {.width = kWidth, .height = kHeight});
    const auto least_frame = [&](const std::optional<ParticleLook>& look) {
        Million all;
        if (look) {
            all.world.add(all.entity, *look);
        }
        double best = INFINITY;
        for (int i = 0; i < 2 + std::min(max_repeats, 9); ++i) {
            all.step();
            const double time =
                drawing_time([&] { (void)render_frame(renderer, all.world, view); });
            best = i < 2 ? best : std::min(best, time);  // after their births
        }
        return best;
    };
    ParticleLook look;
    look.facing = ParticleFacing::Point;
    look.size = 0.05f;
    look.lit = look.cover = look.softness = 0;
    look.emission = 0.01f;
    ParticleLook rasterized = look;
    rasterized.softness = 1e-6f;  // which particle_splats.h leaves to the rasterizer
    const double empty = least_frame(std::nullopt);
    constexpr double kEach = 1e9 / static_cast<double>(kMillion);
    bench.add(GateRow{
        "29", "1M points moved and drawn", (least_frame(look) - empty) * kEach,
        (least_frame(rasterized) - empty) * kEach, "drawn by the rasterizer", "ns", 0.7});
}

}  // namespace

void add_draw_rows(ParticleBench& bench) {
    register_all_components();
    Result<std::unique_ptr<gpu::Context>> context = gpu::create_headless_context({});
    if (!context) {
        bench.note("18 .. 21, 28, 29: " + context.error().message);
        return;
    }
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context();
    if (!device) {
        bench.note("18 .. 21, 28, 29: " + device.error().message);
        return;
    }
    drawing_clock = (*device)->caps().software ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC;
    Result<RendererPtr> renderer = create_renderer(**device, {});
    if (!renderer) {
        bench.note("18 .. 21, 28, 29: " + renderer.error().message);
        return;
    }
    add_fill_rows(bench, **device, **renderer);
    add_small_rows(bench, **device, **renderer);
    add_light_row(bench, **renderer);
    add_move_row(bench, **device);
    add_million_row(bench, **renderer);
}

}  // namespace limn::bench
