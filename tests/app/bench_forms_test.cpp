// Cheaper forms of a shader: what they change in the image, and by how much.

#include "bench/oracles/shader_values.h"
#include "content/app/bench/bench_forms.h"
#include "render/material/acos_table.h"
#include "tests/app/level_fixture.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace limn::bench_forms_test {
using test::near;

namespace {

constexpr IVec2 kSize = {320, 180};

gpu::FloatImage draw(const std::vector<const char*>& defines) {
    Result<gpu::FloatImage> image = draw_form(*test::level_renderer().device, defines, kSize);
    REQUIRE_MESSAGE(image.ok(), (image ? std::string() : image.error().message));
    return *std::move(image);
}

struct TableError {
    double quotient = 0;  ///< of acos(x / sqrt(1 - y^2)) [rad]
    double angle = 0;     ///< of acos(y) [rad]
};

/// Largest errors of the table for |y| <= `y_end` and |x| <= `q` sqrt(1 - y^2).
TableError table_error(double y_end, double q) {
    const std::vector<Vec2> table = make_acos_table();
    TableError error;
    constexpr int kSteps = 1000;
    for (int i = 0; i <= kSteps; ++i) {
        const double y = y_end * (2.0 * i / kSteps - 1);
        for (int k = 0; k <= kSteps; ++k) {
            const double quotient = q * (2.0 * k / kSteps - 1);
            const double x = quotient * std::sqrt(1 - y * y);
            const Vec2 read =
                sample_acos_table(table, kAcosTexels, static_cast<float>(x), static_cast<float>(y));
            error.quotient = std::max(
                error.quotient, std::abs(static_cast<double>(read.x) - std::acos(quotient)));
            error.angle =
                std::max(error.angle, std::abs(static_cast<double>(read.y) - std::acos(y)));
        }
    }
    return error;
}

/// Largest angle between the directions of both functions of tangent_space.glsl, with a frame of
/// these lengths [rad].
double tangent_space_error(const Vec3& lengths) {
    std::mt19937 random(1);
    std::normal_distribution<float> value(0, 1);
    std::vector<Vec4> directions;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 v = {value(random), value(random), value(random)};
        directions.emplace_back(glm::normalize(v), 0.0f);
    }
    const auto run = [&](const std::string& name) {
        const std::string frame = "vec3(" + std::to_string(lengths.x) + ", 0.0, 0.0), vec3(0.0, "
                                  + std::to_string(lengths.y) + ", 0.0), vec3(0.0, 0.0, "
                                  + std::to_string(lengths.z) + ")";
        Result<std::vector<Vec4>> out = oracle::evaluate_shader(
            *test::level_renderer().device, "#include \"lib/tangent_space.glsl\"\n",
            "y.xyz = " + name + "(x.xyz, " + frame + ");", directions);
        REQUIRE(out.ok());
        return *std::move(out);
    };
    const std::vector<Vec4> exact = run("to_tangent_space_exact");
    const std::vector<Vec4> cheap = run("to_tangent_space");
    double largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        CHECK(glm::length(Vec3(cheap[i])) == near(1).epsilon(1e-5));
        const glm::dvec3 a = Vec3(exact[i]);
        const glm::dvec3 b = Vec3(cheap[i]);
        largest = std::max(largest, std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
    }
    return largest;
}

}  // namespace

TEST_CASE(
    "bench forms: constants of an object are those that the shader computes"
    * technique("engine.opt-cpu-const")) {
    const gpu::FloatImage plain = draw({});
    CHECK(form_difference(draw({"OBJECT_CONSTANTS"}), plain, 0, 0) <= 1e-5);
    const auto covered = [](const gpu::FloatImage& image) {
        int pixels = 0;
        for (int i = 0; i < image.width * image.height; ++i) {
            pixels += image.at(i % image.width, i / image.width, 3) > 0 ? 1 : 0;
        }
        return pixels;
    };
    CHECK(covered(plain) > 4000);
    CHECK(std::abs(covered(draw({"OBJECT_CONSTANTS"})) - covered(plain)) <= 4);
}

TEST_CASE(
    "bench forms: the vector to a light may be interpolated, its direction may not"
    * technique("engine.opt-frag-move")) {
    const gpu::FloatImage plain = draw({});
    CHECK(form_difference(draw({"LIGHT_PER_VERTEX"}), plain, 0, 0) <= 1e-5);
    CHECK(form_difference(draw({"LIGHT_PER_VERTEX", "UNIT_LIGHT"}), plain, 0, 0) > 5e-5);
}

TEST_CASE(
    "bench forms: one normalization is exact for equal lengths, off by asin((1 - k) / (1 + k)) else"
    * technique("engine.opt-normalise")) {
    CHECK(tangent_space_error({0.7f, 0.7f, 0.7f}) <= 1e-5);
    for (const double k : {0.9, 0.8, 0.5}) {
        CAPTURE(k);
        const double expected = std::asin((1 - k) / (1 + k));
        const double found = tangent_space_error({static_cast<float>(k), 1, 1});
        CHECK(found <= expected + 1e-4);
        CHECK(found >= 0.99 * expected);
    }
    CHECK(degrees(static_cast<float>(std::asin(0.1 / 1.9))) == near(3.017).epsilon(1e-3));
    CHECK(form_difference(draw({"ONE_NORMALIZE"}), draw({}), 0, 0) < 1e-3);  // of fine triangles
}

TEST_CASE(
    "bench forms: angles from a table err where acos has an infinite slope, and hardly elsewhere"
    * technique("engine.opt-lut")) {
    const std::vector<Vec2> table = make_acos_table();
    const auto read = [&](float x, float y) { return sample_acos_table(table, kAcosTexels, x, y); };
    CHECK(read(0.3f, 0).y == near(kPi / 2).epsilon(1e-5));
    CHECK(read(0, 1).y == near(0).epsilon(1e-6));
    CHECK(read(0, -1).y == near(kPi).epsilon(1e-6));
    CHECK(read(0.6f, 0).x == near(std::acos(0.6)).epsilon(1e-4));
    CHECK(read(1, 0.8f).x == near(0).epsilon(1e-6));
    CHECK(read(-1, 0.8f).x == near(kPi).epsilon(1e-6));
    // Of a fine grid; the specification's 0.0066, 0.036 and 0.074 are of a coarser one.
    struct Bound {
        double q;
        double error;
    };
    for (const Bound& bound : {Bound{0.9, 0.0027}, {0.95, 0.0084}, {0.99, 0.0373}, {1, 0.101}}) {
        CAPTURE(bound.q);
        const double found = table_error(0.9, bound.q).quotient;
        CHECK(found <= 1.02 * bound.error);
        CHECK(found >= 0.9 * bound.error);
    }
    CHECK(table_error(0.9, 0.5).angle <= 7.8e-5);
    CHECK(table_error(0.99, 0.5).angle == near(2.2e-3).epsilon(0.05));
    CHECK(table_error(1, 0).angle == near(0.031).epsilon(0.05));
    // The texture is read as the table is, where the second angle is far from its ends.
    gpu::FloatImage plain = draw({});
    const double end = std::acos(0.9) / static_cast<double>(kPi);
    for (int i = 0; i < plain.width * plain.height; ++i) {
        float* const pixel = &plain.pixels[4 * static_cast<std::size_t>(i)];
        const double second = static_cast<double>(pixel[2]);
        pixel[3] = second > end && second < 1 - end ? pixel[3] : 0.0f;
    }
    const gpu::FloatImage by_table = draw({"ANGLE_TABLE"});
    const double largest = form_difference(by_table, plain, 1, 2) * static_cast<double>(kPi);
    CHECK(largest > 1e-3);
    CHECK(largest <= 0.101);
    CHECK(
        form_difference(by_table, plain, 2, 2) * static_cast<double>(kPi)
        <= 2e-4);  // weights of 8 bits
}

TEST_CASE("bench forms: the report has a row for each form, and its JSON parses") {
    const Result<FormBench> bench = measure_forms(*test::level_renderer().device, {64, 36}, 2);
    REQUIRE(bench.ok());
    REQUIRE(bench->points.size() == shading_forms().size());
    for (const FormBenchPoint& point : bench->points) {
        CAPTURE(point.name);
        CHECK(point.ms > 0);
        CHECK(point.plain_ms > 0);
        CHECK(form_bench_table(*bench).find(point.name) != std::string::npos);
    }
    const nlohmann::json json = nlohmann::json::parse(form_bench_json(*bench));
    CHECK(json["points"][0]["form"] == bench->points[0].name);
    const std::string csv = form_bench_csv(*bench);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + static_cast<int>(bench->points.size()));
}

}  // namespace limn::bench_forms_test
