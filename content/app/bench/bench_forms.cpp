#include "content/app/bench/bench_forms.h"

#include "content/app/commands/progress.h"
#include "ecs/base/jobs.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "render/material/acos_table.h"
#include "render/shaders/acos_gpu.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

// Techniques: engine.opt-cpu-const, engine.opt-frag-move, engine.opt-lut, engine.opt-normalise

namespace limn {
namespace {

constexpr int kBallCorners = 6 * 96 * 96;  // kQuads of shading_forms.vert
constexpr Vec3 kFormLight = {2, 1.5f, 2.5f};

/// A program of the ball, and what it draws with.
class FormDrawing {
  public:
    static Result<FormDrawing>
    create(gpu::Device& device, const std::vector<const char*>& defines, const IVec2& size) {
        FormDrawing drawing(size);
        gpu::ProgramDesc program = {
            .vertex = "shading_forms.vert", .fragment = "shading_forms.frag"};
        for (const char* name : defines) {
            program.defines.push_back({.name = name});
        }
        drawing.program_ = LIMN_TRY(device.shaders().load(program));
        return drawing;
    }

    /// Constants of the object are uploaded once, whatever the number of its vertices.
    void set_object(float turn) const {
        const float aspect = static_cast<float>(size_.x) / static_cast<float>(size_.y);
        // Reversed depth: the near plane is at 1.
        const Mat4 clip_from_world = glm::perspectiveRH_ZO(0.7f, aspect, 10.0f, 0.1f)
                                     * glm::lookAt(Vec3(0.8f, 0.6f, 3.2f), Vec3(0), Vec3(0, 1, 0));
        const Mat4 world_from_object = glm::rotate(Mat4(1), turn, Vec3(0.3f, 1, 0));
        program_->set("clip_from_world", clip_from_world);
        program_->set("world_from_object", world_from_object);
        program_->set("clip_from_object", clip_from_world * world_from_object);
        program_->set("normal_matrix", glm::inverseTranspose(Mat3(world_from_object)));
        program_->set("light", kFormLight);
    }

    /// The ball, into textures of the graph; the returned one is kept.
    TextureId add_pass(FrameGraph& graph) {
        const TextureId color = graph.create(
            {.name = "form", .format = GL_RGBA32F, .width = size_.x, .height = size_.y});
        const TextureId depth = graph.create(
            {.name = "form depth",
             .format = GL_DEPTH_COMPONENT32F,
             .width = size_.x,
             .height = size_.y});
        graph.add_pass("ball", {}, {cleared(color), cleared(depth)}, [this](PassContext& context) {
            context.device().use(gpu::Pipeline{program_, {}});
            context.device().bind_texture(layout::kAcosUnit, table_, &filter_);
            context.device().draw_ids(kBallCorners);
        });
        graph.keep(color);
        return color;
    }

  private:
    explicit FormDrawing(const IVec2& size)
        : size_(size),
          table_("acos", {.format = GL_RG32F, .width = kAcosTexels, .height = kAcosTexels}),
          filter_("acos", {.minify = GL_LINEAR, .magnify = GL_LINEAR, .wrap = GL_CLAMP_TO_EDGE}) {
        const std::vector<Vec2> texels = make_acos_table();
        table_.upload<Vec2>(texels, GL_RG, GL_FLOAT);
    }

    IVec2 size_;
    gpu::Texture table_;
    gpu::Sampler filter_;
    const gpu::Program* program_ = nullptr;
};

/// Milliseconds of a frame, until the GPU is done.
double time_form(FrameGraph& graph, FormDrawing& drawing) {
    glFinish();
    const auto begin = std::chrono::steady_clock::now();
    graph.begin_frame();
    drawing.set_object(0.4f);
    (void)drawing.add_pass(graph);
    graph.execute();
    glFinish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

}  // namespace

const std::vector<ShadingForm>& shading_forms() {
    static const std::vector<ShadingForm> forms = {
        {"constants of the object from the CPU", {"OBJECT_CONSTANTS"}},
        {"vector to the light per vertex", {"LIGHT_PER_VERTEX"}},
        {"direction to the light per vertex, wrong", {"LIGHT_PER_VERTEX", "UNIT_LIGHT"}},
        {"one normalization to tangent space", {"ONE_NORMALIZE"}},
        {"angles from a table", {"ANGLE_TABLE"}},
        {"all but the wrong one",
         {"OBJECT_CONSTANTS", "LIGHT_PER_VERTEX", "ONE_NORMALIZE", "ANGLE_TABLE"}}};
    return forms;
}

Result<gpu::FloatImage>
draw_form(gpu::Device& device, const std::vector<const char*>& defines, const IVec2& size) {
    FormDrawing drawing = LIMN_TRY(FormDrawing::create(device, defines, size));
    FrameGraph graph(device);
    graph.begin_frame();
    drawing.set_object(0.4f);
    const TextureId color = drawing.add_pass(graph);
    graph.execute();
    return gpu::read_floats(*graph.texture(color));
}

double form_difference(const gpu::FloatImage& a, const gpu::FloatImage& b, int first, int last) {
    float largest = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            for (int c = first; c <= last && a.at(x, y, 3) > 0 && b.at(x, y, 3) > 0; ++c) {
                largest = std::max(largest, std::abs(a.at(x, y, c) - b.at(x, y, c)));
            }
        }
    }
    return static_cast<double>(largest);
}

Result<FormBench> measure_forms(gpu::Device& device, const IVec2& size, int frames) {
    FormBench bench;
    bench.machine = {
        .size = size,
        .frames = frames,
        .threads = thread_count(),
        .gl_renderer = device.caps().renderer,
        .gl_version = device.caps().version};
    const gpu::FloatImage plain_image = LIMN_TRY(draw_form(device, {}, size));
    FormDrawing plain = LIMN_TRY(FormDrawing::create(device, {}, size));
    FrameGraph graph(device);
    const int count = static_cast<int>(shading_forms().size());
    Progress progress("frame", count * frames);
    int done = 0;
    for (const ShadingForm& form : shading_forms()) {
        const gpu::FloatImage image = LIMN_TRY(draw_form(device, form.defines, size));
        FormDrawing drawing = LIMN_TRY(FormDrawing::create(device, form.defines, size));
        FormBenchPoint point = {
            .name = form.name,
            .plain_ms = std::numeric_limits<double>::infinity(),
            .ms = std::numeric_limits<double>::infinity(),
            .shade = form_difference(image, plain_image, 0, 0),
            .angle = form_difference(image, plain_image, 1, 2) * static_cast<double>(kPi)};
        for (int i = 0; i < frames; ++i) {
            point.plain_ms = std::min(point.plain_ms, time_form(graph, plain));
            point.ms = std::min(point.ms, time_form(graph, drawing));
            progress.update(++done);
        }
        bench.points.push_back(std::move(point));
    }
    return bench;
}

std::string form_bench_table(const FormBench& bench) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "a ball, {} x {}, the best of {} frames, {} threads\n{}, OpenGL {}\n\n{:<40} {:>9} {:>9} "
        "{:>7} {:>9} {:>9}\n",
        bench.machine.size.x, bench.machine.size.y, bench.machine.frames, bench.machine.threads,
        bench.machine.gl_renderer, bench.machine.gl_version, "[ms]", "plain", "this", "ratio",
        "shade", "angle");
    for (const FormBenchPoint& point : bench.points) {
        fmt::format_to(
            out, "{:<40} {:>9.3f} {:>9.3f} {:>7.2f} {:>9.2g} {:>9.2g}\n", point.name,
            point.plain_ms, point.ms, point.ms / point.plain_ms, point.shade, point.angle);
    }
    return text;
}

std::string form_bench_json(const FormBench& bench) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const FormBenchPoint& point : bench.points) {
        points.push_back(
            {{"form", point.name},
             {"ms", point.ms},
             {"plain_ms", point.plain_ms},
             {"ratio", point.ms / point.plain_ms},
             {"shade", point.shade},
             {"angle", point.angle}});
    }
    const nlohmann::ordered_json json = {
        {"size", {bench.machine.size.x, bench.machine.size.y}},
        {"frames", bench.machine.frames},
        {"threads", bench.machine.threads},
        {"gl", {{"renderer", bench.machine.gl_renderer}, {"version", bench.machine.gl_version}}},
        {"points", std::move(points)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string form_bench_csv(const FormBench& bench) {
    std::string text = "form,ms,plain_ms,ratio,shade,angle\n";
    for (const FormBenchPoint& point : bench.points) {
        fmt::format_to(
            std::back_inserter(text), "\"{}\",{:.6f},{:.6f},{:.4f},{:.3g},{:.3g}\n", point.name,
            point.ms, point.plain_ms, point.ms / point.plain_ms, point.shade, point.angle);
    }
    return text;
}

}  // namespace limn
