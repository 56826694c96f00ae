#include "content/app/bench/bench_fakephong.h"

#include "bench/fakephong/phong_models.h"
#include "content/app/bench/bench_command.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/stage.h"
#include "ecs/base/text.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/shading_comparison.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/field_access.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

// Techniques: fakephong.blinn-path, fakephong.forward-difference, fakephong.metric-analytic,
//     fakephong.metric-efficiency, fakephong.results

namespace limn {
namespace {

constexpr std::array kModels = {"teapot", "triangle", "dodecahedron", "sphere"};
constexpr float kDistance = 3.4f;  ///< of the camera [m]: the model fills the height of the image

std::string rate_name(std::size_t rate) {
    const FieldInfo* field = find_field(component_info<Rendering>().fields, "shading");
    return std::string(field->values[rate]);
}

/// Keeps one model, viewed from the front, lit by `count` lamps on a ring before it whose light
/// sums to a constant.
Status arrange(Stage& stage, const std::string& model, int count) {
    World& world = stage.world;
    Vec3 model_center(0);
    std::vector<Entity> others;
    bool found = false;
    world.query<const Name, const MeshInstance, const Transform>().each(
        [&](Entity entity, const Name& name, const MeshInstance&, const Transform& transform) {
            if (name.text == model) {
                found = true;
                model_center = {transform.position.x, 0, 0};
            } else {
                others.push_back(entity);
            }
        });
    if (!found) {
        return fail(
            "level {}: found no entity \"{}\", expected the model", stage.scene.name, model);
    }
    for (const Entity other : others) {
        destroy_tree(world, other);
    }
    for (int i = 0; i < count; ++i) {
        const float angle = 2 * kPi * (static_cast<float>(i) + 0.3f) / static_cast<float>(count);
        const Vec3 at = model_center + Vec3(1.2f * std::cos(angle), 1.2f * std::sin(angle), 2.4f);
        world.create(
            Transform{.position = at}, WorldTransform{affine_from(at, {1, 0, 0, 0}, Vec3(1))},
            PointLight{
                .intensity = kPi / static_cast<float>(count),
                .radius = 30,
                .attenuation = {.falloff = Falloff::None}});
    }
    world.get<Transform>(stage.scene.camera).position = model_center + Vec3(0, 0, kDistance);
    world.remove_resource<ShadingComparison>();
    world.remove_resource<ScanlinePlot>();
    return Done{};
}

double best_of_objects(const BenchReport& report) {
    for (const BenchSeries& series : report.series) {
        if (series.kind == BenchKind::Pass && series.clock == BenchClock::Gpu
            && series.name == "objects") {
            return *std::min_element(series.samples.begin(), series.samples.end());
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

double ratio_to_pixel(const FakePhongPoint& point, std::size_t rate) {
    return point.best_ms[rate] / std::max(point.best_ms[0], 1e-6);
}

}  // namespace

std::vector<FakePhongCount> count_fakephong() {
    using namespace fakephong;
    std::vector<FakePhongCount> counts;
    for (const PhongScene& scene :
         {teapot_scene(), triangle_scene(), dodecahedron_scene(), sphere_scene()}) {
        const SceneResult result = evaluate_scene(scene);
        const auto add = [&](std::string method, const Efficiency& efficiency) {
            counts.push_back({scene.name, std::move(method), efficiency});
        };
        add("phong", efficiency_of(result.phong, result.phong));
        for (const MethodResult& one : result.methods) {
            add(std::string(one.method->id), efficiency_of(one.image, reference_of(result, one)));
        }
        for (const SteppedMethod& one : step_scene(scene)) {
            add(std::string(one.method->id) + ", stepped",
                efficiency_of(one.stepped, result.phong));
        }
    }
    return counts;
}

Result<FakePhongBench> measure_fakephong(const BenchOptions& options, HeadlessRenderer& headless) {
    FakePhongBench bench;
    bench.counts = count_fakephong();
    Progress progress("point", static_cast<int>(kModels.size() * kFakePhongLights.size()));
    for (const char* const model : kModels) {
        for (const int lights : kFakePhongLights) {
            std::unique_ptr<Stage> stage =
                LIMN_TRY(open_stage(kFakePhongScene, {.assignments = options.assignments}));
            if (bench.points.empty()) {
                bench.machine = machine_report(*stage, headless, options);
                bench.machine.frames = options.frames;
            }
            LIMN_TRY(arrange(*stage, model, lights));
            auto& rendering = stage->world.resource<Rendering>();
            rendering.lights = LightMethod::ObjectMajor;
            std::array<BenchReport, kShadingRates> reports;
            for (int i = -1; i < options.frames; ++i) {  // the first compiles shaders and uploads
                for (std::size_t rate = 0; rate < reports.size(); ++rate) {
                    rendering.shading = static_cast<ShadingRate>(rate);
                    run_bench_frame(
                        *stage, headless, options.size, i < 0 ? nullptr : &reports[rate]);
                }
            }
            FakePhongPoint& point = bench.points.emplace_back(FakePhongPoint{model, lights, {}});
            std::transform(reports.begin(), reports.end(), point.best_ms.begin(), best_of_objects);
            progress.update(static_cast<int>(bench.points.size()));
        }
    }
    return bench;
}

namespace {

/// Operations per pixel on the first model, and the work of a frame on each.
std::string count_table(std::span<const FakePhongCount> counts) {
    const auto of_model =
        static_cast<std::size_t>(std::count_if(counts.begin(), counts.end(), [&](const auto& one) {
            return one.model == counts[0].model;
        }));
    std::string text = fmt::format(
        "\nCounted on a CPU under one light: lighting evaluations per facet, operations per pixel "
        "of "
        "the "
        "{},\nand the work of a frame over that of Phong shading, set-up "
        "included:\n{:<28}{:>6}{:>8}"
        "{:>8}{:>6}{:>6}{:>6}{:>6} ",
        counts[0].model, "method", "lit", "add", "mul", "div", "root", "pow", "fetch");
    for (std::size_t i = 0; i < counts.size(); i += of_model) {
        text += fmt::format("{:>9}", counts[i].model.substr(0, 8));
    }
    for (std::size_t i = 0; i < of_model; ++i) {
        const fakephong::Efficiency& e = counts[i].efficiency;
        text += fmt::format(
            "\n{:<28}{:>6.0f}{:>8.1f}{:>8.1f}{:>6.1f}{:>6.1f}{:>6.1f}{:>6.1f} ", counts[i].method,
            e.lightings, e.additions, e.multiplications, e.divisions, e.roots, e.powers, e.fetches);
        for (std::size_t k = i; k < counts.size(); k += of_model) {
            text += fmt::format("{:>9.2f}", counts[k].efficiency.work);
        }
    }
    return text + "\n";
}

}  // namespace

std::string fakephong_bench_table(const FakePhongBench& bench) {
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "{}, {} x {}, {} threads, best of {} frames\n{}, OpenGL {}\n\n"
        "Time of drawing and lighting the model, as a ratio to per-pixel Phong shading [ms]:\n",
        bench.machine.scene, bench.machine.size.x, bench.machine.size.y, bench.machine.threads,
        bench.machine.frames, bench.machine.gl_renderer, bench.machine.gl_version);
    const auto heading = [&](const char* name, auto&& cell) {
        fmt::format_to(out, "{:<18}", name);
        for (std::size_t i = 0; i < bench.points.size(); ++i) {
            fmt::format_to(out, "{}{:>6}", i % kFakePhongLights.size() == 0 ? "  " : " ", cell(i));
        }
        text += "\n";
    };
    heading("model", [&](std::size_t i) {
        return i % kFakePhongLights.size() == 0 ? bench.points[i].model.substr(0, 6) : "";
    });
    heading("lights", [&](std::size_t i) { return std::to_string(bench.points[i].lights); });
    heading("pixel [ms]", [&](std::size_t i) {
        return fmt::format("{:.2f}", bench.points[i].best_ms[0]);
    });
    for (std::size_t rate = 1; rate < kShadingRates; ++rate) {
        heading(rate_name(rate).c_str(), [&](std::size_t i) {
            return fmt::format("{:.2f}", ratio_to_pixel(bench.points[i], rate));
        });
    }
    return bench.counts.empty() ? text : text + count_table(bench.counts);
}

std::string fakephong_bench_json(const FakePhongBench& bench) {
    nlohmann::ordered_json points = nlohmann::ordered_json::array();
    for (const FakePhongPoint& point : bench.points) {
        nlohmann::ordered_json rates = nlohmann::ordered_json::array();
        for (std::size_t rate = 0; rate < kShadingRates; ++rate) {
            rates.push_back(
                {{"shading", rate_name(rate)},
                 {"best_ms", point.best_ms[rate]},
                 {"ratio", ratio_to_pixel(point, rate)}});
        }
        points.push_back(
            {{"model", point.model}, {"lights", point.lights}, {"methods", std::move(rates)}});
    }
    nlohmann::ordered_json counts = nlohmann::ordered_json::array();
    for (const FakePhongCount& count : bench.counts) {
        const fakephong::Efficiency& e = count.efficiency;
        counts.push_back(
            {{"model", count.model},
             {"method", count.method},
             {"lightings", e.lightings},
             {"additions", e.additions},
             {"multiplications", e.multiplications},
             {"divisions", e.divisions},
             {"roots", e.roots},
             {"powers", e.powers},
             {"fetches", e.fetches},
             {"work", e.work}});
    }
    const nlohmann::ordered_json json = {
        {"scene", bench.machine.scene},
        {"size", {bench.machine.size.x, bench.machine.size.y}},
        {"frames", bench.machine.frames},
        {"threads", bench.machine.threads},
        {"gl", {{"renderer", bench.machine.gl_renderer}, {"version", bench.machine.gl_version}}},
        {"points", std::move(points)},
        {"counts", std::move(counts)}};
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string fakephong_bench_csv(const FakePhongBench& bench) {
    std::string text = "model,lights,shading,frames,best_ms,ratio\n";
    for (const FakePhongPoint& point : bench.points) {
        for (std::size_t rate = 0; rate < kShadingRates; ++rate) {
            fmt::format_to(
                std::back_inserter(text), "{},{},{},{},{:.4f},{:.3f}\n", point.model, point.lights,
                rate_name(rate), bench.machine.frames, point.best_ms[rate],
                ratio_to_pixel(point, rate));
        }
    }
    text +=
        "\nmodel,method,lightings,additions,multiplications,divisions,roots,powers,fetches,work\n";
    for (const FakePhongCount& count : bench.counts) {
        const fakephong::Efficiency& e = count.efficiency;
        fmt::format_to(
            std::back_inserter(text),
            "{},\"{}\",{:.0f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.4f}\n", count.model,
            count.method, e.lightings, e.additions, e.multiplications, e.divisions, e.roots,
            e.powers, e.fetches, e.work);
    }
    return text;
}

}  // namespace limn
