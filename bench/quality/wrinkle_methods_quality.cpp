#include "bench/quality/wrinkle_methods_quality.h"

#include "bench/oracles/shader_values.h"
#include "content/make/head/face_fold_pattern.h"
#include "ecs/base/rng.h"
#include "systems/faces/wrinkle_fold.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace limn {
namespace {

using glm::dvec2;
using glm::dvec3;

/// The folds of a face compressed by 0 to 30 %: the length of their profile relative to rest.
void measure_length(QualityReport& report) {
    FaceFoldsPattern pattern;
    pattern.image.size = 512;
    const std::vector<Vec2> all = wrinkle_slopes(make_face_folds(pattern).normal);
    std::vector<double> squares;  // squared slopes that fold
    for (const Vec2& slope : all) {
        const double square = glm::dot(glm::dvec2(slope), glm::dvec2(slope));
        if (square > 1e-6) {
            squares.push_back(square);
        }
    }
    const FoldTable table = make_fold_table(all);
    double error = 0;
    for (int percent = 0; percent <= 30; ++percent) {
        const double left = 1 - 0.01 * percent;
        const float excess = fold_excess(static_cast<float>(left * left), 0, 1);
        const double strength = fold_strength(table, excess);
        double length = 0;
        for (const double square : squares) {
            length += std::sqrt(1 + strength * strength * square);
        }
        error = std::max(error, std::abs(left * length / static_cast<double>(squares.size()) - 1));
    }
    report.at_least(
        "isometric: texels of the face's map that fold", static_cast<double>(squares.size()), 1000);
    report.at_most(
        "isometric: length of skin compressed by 0 to 30 %, difference from rest", 100 * error, 2,
        "%");
}

struct FitRow {
    double angle;                 ///< of the map's normal [degrees]
    std::array<double, 3> error;  ///< at strengths 0.25, 0.5 and 0.75 [degrees]
};

/// wrinkle.compression.normal-fit.
constexpr FitRow kFit[] = {
    {10, {0.036, 0.057, 0.050}},    {20, {0.294, 0.468, 0.405}},    {30, {1.032, 1.625, 1.389}},
    {40, {2.600, 4.013, 3.361}},    {50, {5.550, 8.269, 6.724}},    {53.13, {6.898, 10.112, 8.130}},
    {60, {10.909, 15.234, 11.906}}, {70, {20.897, 25.923, 19.302}}, {80, {40.552, 41.076, 29.157}}};

/// How much too flat the shader's normals are.
Status measure_fit(gpu::Device& device, QualityReport& report) {
    std::vector<Vec4> inputs;
    for (const FitRow& row : kFit) {
        for (int i = 1; i <= 3; ++i) {
            const auto slope = static_cast<float>(std::tan(glm::radians(row.angle)));
            inputs.emplace_back(0.6f * slope, 0.8f * slope, 0.25f * static_cast<float>(i), 0);
        }
    }
    const std::vector<Vec4> found = LIMN_TRY(oracle::evaluate_shader(
        device, "#include \"lib/wrinkle.glsl\"", "y.xy = lifted_slope(x.xy, x.z);", inputs));
    double error = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double should =
            std::atan(double{inputs[i].z} * std::hypot(double{inputs[i].x}, double{inputs[i].y}));
        const double is = std::atan(std::hypot(double{found[i].x}, double{found[i].y}));
        error = std::max(error, std::abs(glm::degrees(should - is) - kFit[i / 3].error[i % 3]));
    }
    report.at_most(
        "sphere: 27 errors of the printed table, to their last digit", error, 0.00051, "degrees");
    return Done{};
}

/// Listings 1 and 2 of Oat 2007.
dvec3 composed(const dvec3& n, const dvec3& stretched, const dvec3& compressed, dvec2 influence) {
    influence = glm::min(influence, dvec2(1));
    const dvec3 w =
        glm::mix(glm::mix(dvec3(0, 0, 1), stretched, influence.x), compressed, influence.y);
    return glm::normalize(dvec3(n.x + w.x, n.y + w.y, n.z * w.z));
}

Status measure_oat(gpu::Device& device, QualityReport& report) {
    constexpr std::size_t kCases = 500;
    constexpr std::size_t kRecord = 7;
    Random random(3, 0, 0, 0);
    std::vector<Vec4> inputs;
    for (std::size_t i = 0; i < kCases; ++i) {
        for (std::size_t k = 0; k < kRecord; ++k) {
            const auto part = [&] { return random.uniform(k < 2 ? 0.0f : -1.0f, 1.0f); };
            Vec4 record = {part(), part(), part(), part()};
            if (k >= 4) {
                record = Vec4(glm::normalize(Vec3(record.x, record.y, 1)), 0);
            }
            inputs.push_back(record);
        }
    }
    const std::vector<Vec4> found = LIMN_TRY(oracle::evaluate_shader(
        device, "#include \"lib/wrinkle_maps.glsl\"",
        "uint k = i / 7u * 7u;\n"
        "vec2 f = wrinkle_influence(inputs[k], inputs[k + 1u], 0.0, inputs[k + 2u], "
        "inputs[k + 3u], 0.0);\n"
        "y.xyz = compose_by_lerp(inputs[k + 4u].xyz, inputs[k + 5u].xyz, inputs[k + 6u].xyz, f);",
        inputs));
    double error = 0;
    for (std::size_t i = 0; i < kCases; ++i) {
        const Vec4* const in = &inputs[kRecord * i];
        dvec2 influence = {0, 0};
        for (int region = 0; region < 8; ++region) {
            const double mask = in[region / 4][region % 4];
            const double weight = in[2 + region / 4][region % 4];
            influence += mask * dvec2(std::max(-weight, 0.0), std::max(weight, 0.0));
        }
        const dvec3 expected = composed(Vec3(in[4]), Vec3(in[5]), Vec3(in[6]), influence);
        error = std::max(error, glm::distance(dvec3(Vec3(found[kRecord * i])), expected));
    }
    report.at_most("Oat: composed normals against double precision", error, 1e-6);
    return Done{};
}

}  // namespace

Status measure_wrinkle_methods(HeadlessRenderer& headless, QualityReport& report) {
    measure_length(report);
    LIMN_TRY(measure_fit(*headless.device, report));
    return measure_oat(*headless.device, report);
}

}  // namespace limn
