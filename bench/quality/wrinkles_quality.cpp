#include "bench/quality/face_folds_file.h"
#include "bench/quality/quality.h"
#include "bench/quality/wrinkle_methods_quality.h"
#include "content/bake/furrow_field.h"
#include "content/bake/furrow_recipe.h"
#include "content/bake/furrow_trace.h"
#include "content/make/head/head.h"
#include "content/make/models/shapes.h"
#include "content/make/patterns/furrow_patterns.h"
#include "ecs/components/surface.h"
#include "render/gpu/readback.h"
#include "render/material/furrow_maker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace limn::wrinkles_quality {
namespace {

using glm::dvec3;

constexpr int kSize = 256;

/// A field that rotates and grows over a tiling square.
FurrowRecipe make_recipe() {
    FurrowRecipe recipe = {.size = kSize, .tiles = true};
    recipe.arrows = {
        {.at = {-0.3f, 0.3f, 0}, .first = {0.2f, 0.7f, 0}, .second = {0.9f, -0.2f, 0}},
        {.at = {0.3f, -0.2f, 0}, .first = {-0.5f, 1.3f, 0}, .second = {1.0f, 0.6f, 0}},
        {.at = {0, 0, 0}, .first = {0.1f, 1.0f, 0}, .second = {0.8f, 0.1f, 0}, .weight = 2}};
    recipe.style.noise = 0.3f;
    return recipe;
}

/// Inverse-distance weights in double precision, in the tangent plane with the magnitude kept.
dvec3 exact_vector(
    const dvec3& p, const dvec3& n, const std::vector<FurrowEdit>& edits,
    const std::vector<Vec3>& positions, std::size_t field) {
    dvec3 sum(0);
    double total = 0;
    for (const FurrowEdit& edit : edits) {
        const double distance = glm::distance(p, dvec3(positions[edit.vertex]));
        if (distance == 0) {
            return edit.vectors[field];
        }
        const double weight = static_cast<double>(edit.weight) / distance;
        total += weight;
        sum += weight * dvec3(edit.vectors[field]);
    }
    sum /= total;
    const dvec3 tangent = sum - glm::dot(sum, n) * n;
    return glm::length(tangent) > 0 ? glm::length(sum) * glm::normalize(tangent) : dvec3(0);
}

void measure_field(QualityReport& report) {
    const MeshData ball = make_sphere({.radius = 1, .segments = 48, .rings = 24});
    const std::vector<FurrowArrow> arrows = {
        {.at = {0, 0, 1}, .first = {0, 1.5f, 0}, .second = {1, 0, 0}},
        {.at = {1, 0, 0}, .first = {0, 0.5f, 0.5f}, .second = {0, 0.2f, -1}, .weight = 3},
        {.at = {0, 0.5f, -1}, .first = {1, 0, 0}, .second = {0, 1, 0.2f}}};
    const auto edits = place_furrow_arrows(arrows, ball.positions, ball.normals);
    const auto field = make_furrow_field(ball.positions, ball.normals, edits);
    double error = 0;
    double lean = 0;
    for (std::size_t i = 0; i < field.size(); ++i) {
        const dvec3 n = glm::normalize(dvec3(ball.normals[i]));
        for (std::size_t f = 0; f < 2; ++f) {
            const dvec3 exact = exact_vector(ball.positions[i], n, edits, ball.positions, f);
            error = std::max(error, glm::length(dvec3(field[i][f]) - exact));
            lean = std::max(lean, std::abs(glm::dot(dvec3(field[i][f]), n)));
        }
    }
    report.at_most("furrows: field against double precision, magnitude up to 2", error, 1e-5);
    report.at_most("furrows: part of the field along the normal", lean, 1e-5);
}

/// Directions and lengths of furrows, compared with the six functions.
void measure_furrows(QualityReport& report) {
    FurrowRecipe recipe = {.size = kSize, .tiles = true};
    recipe.arrows = {{.at = {0, 0, 0}, .first = {0, 1, 0}, .second = {1, 0, 0}}};
    const auto map = *lay_out_furrows(make_furrow_surface(FurrowSurface::Square), recipe);
    const FurrowStyle style = style_of(recipe);
    const auto cover = cover_furrow_map(map);
    std::vector<FurrowSegment> segments;
    const FurrowDrawing drawing = trace_furrows(map, cover, style, 0, &segments);
    double turn = 0;
    double largest = 0;
    double length = 0;
    std::size_t whole = 0;
    std::size_t met = 0;
    for (const FurrowSegment& s : segments) {
        const Vec2 d = (s.to - s.from) * (s.backward ? -1.0f : 1.0f);
        length += static_cast<double>(glm::length(d));
        met += s.met ? 1 : 0;
        if (!s.met) {
            const double angle = std::atan2(static_cast<double>(d.x), static_cast<double>(-d.y));
            turn += angle;
            largest = std::max(largest, std::abs(angle));
            ++whole;
        }
    }
    std::size_t bands = 0;
    for (const std::uint32_t cell : drawing.cells) {
        bands += (cell & kFurrowBand) != 0 ? 1 : 0;
    }
    const double pixels = kSize * kSize;
    const FurrowShape shape = furrow_shape(style, 1);
    report.at_least(
        "furrows: pixels in a band", 100.0 * static_cast<double>(bands) / pixels, 100, "%");
    report.at_most(
        "furrows: largest turn of a segment relative to the style's",
        largest / static_cast<double>(shape.angle), 1.001);
    report.inform("furrows: mean turn", turn / static_cast<double>(whole), "rad");
    report.inform("furrows: mean distance between furrows", pixels / length, "px");
    report.inform(
        "furrows: half a band, the minimum distance", 0.5 * static_cast<double>(shape.density),
        "px");
    report.inform(
        "furrows: segments that end at another furrow",
        100.0 * static_cast<double>(met) / static_cast<double>(segments.size()), "%");
}

ColorImage make_image(int height) {
    return {kSize, height, std::vector<Vec3>(static_cast<std::size_t>(kSize * height))};
}

Status measure_maker(HeadlessRenderer& headless, QualityReport& report) {
    const FurrowRecipe recipe = make_recipe();
    const FurrowMap map =
        LIMN_TRY(lay_out_furrows(make_furrow_surface(FurrowSurface::Square), recipe));
    const FurrowMaker maker = LIMN_TRY(create_furrow_maker(*headless.device));
    const FurrowStyle style = style_of(recipe);
    const FurrowMaps cpu = make_furrow_maps(map, style);
    const FurrowTextures made =
        make_furrow_textures(*headless.device, maker, map, cpu.growth.cover, style);
    headless.device->invalidate_state();
    const gpu::FloatImage heights = gpu::read_floats(made.height);
    const gpu::FloatImage normals = gpu::read_floats(made.normal);
    double height_error = 0;
    double normal_error = 0;
    ColorImage shown = make_image(2 * kSize);
    ColorImage expected = make_image(2 * kSize);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const int row = kSize - 1 - y;  // images are read with the last row first
            const auto pixel = static_cast<std::size_t>(y * kSize + x);
            const float found = heights.at(x, row, 2);
            const Vec3 normal(normals.at(x, row, 0), normals.at(x, row, 1), normals.at(x, row, 2));
            height_error =
                std::max(height_error, static_cast<double>(std::abs(found - cpu.height[pixel])));
            for (int c = 0; c < 3; ++c) {
                normal_error = std::max(
                    normal_error, static_cast<double>(std::abs(normal[c] - cpu.normals[pixel][c])));
            }
            const std::size_t below = pixel + static_cast<std::size_t>(kSize * kSize);
            shown.pixels[pixel] = Vec3(std::clamp(found, 0.0f, 1.0f));
            expected.pixels[pixel] = Vec3(std::clamp(cpu.height[pixel], 0.0f, 1.0f));
            shown.pixels[below] = 0.5f + 0.5f * normal;
            expected.pixels[below] = 0.5f + 0.5f * cpu.normals[pixel];
        }
    }
    report.at_most("furrows: height, GPU against CPU", height_error, 1e-3);
    report.at_most("furrows: normals, GPU against CPU", normal_error, 1e-3);
    report.images.push_back({"furrows: height and normals", std::move(shown), std::move(expected)});
    return Done{};
}

Status measure_wrinkles(HeadlessRenderer& headless, QualityReport& report) {
    measure_field(report);
    measure_furrows(report);
    LIMN_TRY(measure_face("head", make_head({}), report, true));
    LIMN_TRY(measure_wrinkle_methods(headless, report));
    return measure_maker(headless, report);
}

const RegisterQuality kRegistered(
    "wrinkles", "lengths, normals, fields in double precision; the CPU's maps; faces: anatomy",
    measure_wrinkles, measure_face_file);

}  // namespace
}  // namespace limn::wrinkles_quality
