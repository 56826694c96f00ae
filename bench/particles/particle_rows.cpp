#include "bench/particles/particle_rows.h"

#include "bench/micro/svg_plot.h"
#include "ecs/base/jobs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <utility>

namespace limn::bench {
namespace {

struct Curve {
    std::string name;
    std::vector<const GrowthPoint*> points;
};

std::vector<Curve> curves_of(const ParticleBench& bench) {
    std::vector<Curve> curves;
    for (const GrowthPoint& point : bench.growth) {
        auto curve = std::find_if(curves.begin(), curves.end(), [&](const Curve& known) {
            return known.name == point.curve;
        });
        if (curve == curves.end()) {
            curve = curves.insert(curves.end(), {point.curve, {}});
        }
        curve->points.push_back(&point);
    }
    return curves;
}

}  // namespace

void ParticleBench::add(GateRow row) {
    if (!quiet) {
        fmt::print(
            "{:<3} {:<52} {:>9.3f} {:<2} against {:>9.3f} {:<28} {:>6.3f}  gate {:<5g} {}\n",
            row.gate, row.name, row.ours, row.unit, row.other, row.against, row.ratio(), row.limit,
            row.is_met() ? "met" : "missed");
        std::fflush(stdout);
    }
    gates.push_back(std::move(row));
}

void ParticleBench::add(GrowthPoint point) {
    if (!quiet) {
        fmt::print("    {:<40} {:>9} {:>9.3f} ns\n", point.curve, point.count, point.ns);
        std::fflush(stdout);
    }
    growth.push_back(std::move(point));
}

void ParticleBench::note(std::string text) {
    if (!quiet) {
        fmt::print("    {}\n", text);
    }
    notes.push_back(std::move(text));
}

std::string particle_bench_csv(const ParticleBench& bench) {
    std::string csv = "gate,name,ours,other,unit,ratio,limit,met\n";
    for (const GateRow& row : bench.gates) {
        csv += fmt::format(
            "{},\"{}\",{:.4g},{:.4g},{},{:.4g},{:g},{}\n", row.gate, row.name, row.ours, row.other,
            row.unit, row.ratio(), row.limit, row.is_met());
    }
    csv += "\ncurve,count,ns\n";
    for (const GrowthPoint& point : bench.growth) {
        csv += fmt::format("\"{}\",{},{:.4g}\n", point.curve, point.count, point.ns);
    }
    return csv;
}

std::string particle_bench_json(const ParticleBench& bench) {
    nlohmann::ordered_json gates = nlohmann::ordered_json::array();
    for (const GateRow& row : bench.gates) {
        gates.push_back(
            {{"gate", row.gate},
             {"name", row.name},
             {"ours", row.ours},
             {"other", row.other},
             {"against", row.against},
             {"unit", row.unit},
             {"ratio", row.ratio()},
             {"limit", row.limit},
             {"met", row.is_met()}});
    }
    nlohmann::ordered_json growth = nlohmann::ordered_json::array();
    for (const Curve& curve : curves_of(bench)) {
        nlohmann::ordered_json points = nlohmann::ordered_json::array();
        for (const GrowthPoint* point : curve.points) {
            points.push_back({{"count", point->count}, {"ns", point->ns}});
        }
        growth.push_back({{"curve", curve.name}, {"points", std::move(points)}});
    }
    const nlohmann::ordered_json all = {
        {"threads", thread_count()},
        {"gates", std::move(gates)},
        {"growth", std::move(growth)},
        {"notes", bench.notes}};
    return all.dump(2) + "\n";
}

std::string particle_bench_svg(const ParticleBench& bench) {
    constexpr const char* kColors[] = {"#2a6fbb", "#c8553d", "#2e8b6f", "#d08a1d",
                                       "#8a4f9e", "#6b6b6b", "#b3446c"};
    Svg svg;
    const Panel panel = {90, 60, 560, 420, 3, 7, -1, 3};
    draw_axes(svg, panel, "Cost of a particle, by how many there are", "particle", "particles");
    std::vector<EndLabel> labels;
    double right = panel.left;
    std::size_t color = 0;
    for (const Curve& curve : curves_of(bench)) {
        const char* const ink = kColors[color++ % std::size(kColors)];
        std::vector<std::array<double, 2>> points;
        for (const GrowthPoint* point : curve.points) {
            points.push_back(
                {panel.x_of(static_cast<double>(point->count)), panel.y_of(point->ns)});
        }
        svg.curve(points, ink, 2);
        for (const auto& [x, y] : points) {
            svg.dot(x, y, ink);
            right = std::max(right, x);
        }
        labels.push_back({points.back()[1], curve.name, ink});
    }
    draw_labels(svg, right, std::move(labels));
    return svg.done(960, 560);
}

}  // namespace limn::bench
