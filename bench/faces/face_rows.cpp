#include "bench/faces/face_rows.h"

#include "bench/micro/svg_plot.h"
#include "ecs/base/jobs.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <iterator>
#include <utility>

namespace limn::bench {

void FaceBench::add(FaceRow row) {
    if (!quiet) {
        fmt::print("{:<48} {:>8.3f} ms", row.name, row.ours);
        if (row.reference > 0) {
            fmt::print("  {:<18} {:>8.3f} ms  {:>6.3f}", row.against, row.reference, row.ratio());
        }
        if (row.limit > 0) {
            fmt::print(
                "  limit {:g}{} {}", row.limit, row.is_ratio ? "" : " ms",
                row.is_met() ? "met" : "missed");
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
    rows.push_back(std::move(row));
}

void FaceBench::add(FaceGrowthPoint point) {
    if (!quiet) {
        fmt::print("    {:<40} {:>4} {:>10.0f} ns\n", point.curve, point.faces, point.ns);
        std::fflush(stdout);
    }
    growth.push_back(std::move(point));
}

std::string face_bench_csv(const FaceBench& bench) {
    std::string csv = "name,ours_ms,reference_ms,against,ratio,limit,met\n";
    for (const FaceRow& row : bench.rows) {
        csv += fmt::format(
            "\"{}\",{:.4g},{:.4g},{},{:.4g},{:g},{}\n", row.name, row.ours, row.reference,
            row.against, row.ratio(), row.limit, row.is_met());
    }
    csv += "\ncurve,faces,ns\n";
    for (const FaceGrowthPoint& point : bench.growth) {
        csv += fmt::format("\"{}\",{},{:.4g}\n", point.curve, point.faces, point.ns);
    }
    return csv;
}

std::string face_bench_json(const FaceBench& bench) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const FaceRow& row : bench.rows) {
        rows.push_back(
            {{"name", row.name},
             {"ours_ms", row.ours},
             {"reference_ms", row.reference},
             {"against", row.against},
             {"ratio", row.ratio()},
             {"limit", row.limit},
             {"met", row.is_met()}});
    }
    nlohmann::ordered_json growth = nlohmann::ordered_json::array();
    for (const FaceGrowthPoint& point : bench.growth) {
        growth.push_back({{"curve", point.curve}, {"faces", point.faces}, {"ns", point.ns}});
    }
    const nlohmann::ordered_json all = {
        {"threads", thread_count()}, {"rows", std::move(rows)}, {"growth", std::move(growth)}};
    return all.dump(2) + "\n";
}

std::string face_bench_svg(const FaceBench& bench) {
    constexpr const char* kColors[] = {"#2a6fbb", "#c8553d", "#2e8b6f", "#d08a1d"};
    Svg svg;
    const Panel panel = {90, 60, 560, 420, 0, 2, 4, 7};
    draw_axes(svg, panel, "Cost of a face, by how many there are", "face", "faces");
    std::vector<EndLabel> labels;
    double right = panel.left;
    for (std::size_t i = 0; i < bench.growth.size();) {
        const std::string& curve = bench.growth[i].curve;
        const char* const ink = kColors[labels.size() % std::size(kColors)];
        std::vector<std::array<double, 2>> points;
        for (; i < bench.growth.size() && bench.growth[i].curve == curve; ++i) {
            points.push_back(
                {panel.x_of(static_cast<double>(bench.growth[i].faces)),
                 panel.y_of(bench.growth[i].ns)});
        }
        svg.curve(points, ink, 2);
        for (const auto& [x, y] : points) {
            svg.dot(x, y, ink);
            right = std::max(right, x);
        }
        labels.push_back({points.back()[1], curve, ink});
    }
    draw_labels(svg, right, std::move(labels));
    return svg.done(960, 560);
}

}  // namespace limn::bench
