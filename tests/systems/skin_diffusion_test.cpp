#include "ecs/base/rng.h"
#include "systems/faces/skin_diffusion.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace limn::skin_diffusion_test {
namespace {

using limn::test::near;

struct Sheet {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
};

/// Equal triangles of edge 1 / side, in rows; or `jitter` of an edge away from that.
Sheet make_sheet(std::uint32_t side, float jitter = 0) {
    Sheet sheet;
    Random random(3, 0, 0, 0);
    const float edge = 1 / static_cast<float>(side);
    for (std::uint32_t y = 0; y <= side; ++y) {
        for (std::uint32_t x = 0; x <= side; ++x) {
            Vec3 p = {
                static_cast<float>(x) + 0.5f * static_cast<float>(y),
                static_cast<float>(y) * 0.5f * std::sqrt(3.0f), 0};
            p.x += jitter * (random.uniform() - 0.5f);
            p.y += jitter * (random.uniform() - 0.5f);
            sheet.positions.push_back(edge * p);
            if (x < side && y < side) {
                const std::uint32_t v = y * (side + 1) + x;
                const std::uint32_t above = v + side + 1;
                sheet.indices.insert(
                    sheet.indices.end(), {v, v + 1, above, v + 1, above + 1, above});
            }
        }
    }
    return sheet;
}

SkinDiffusion diffusion_of(const Sheet& sheet, float edges) {
    const std::vector<char> used(sheet.positions.size(), 1);
    return make_skin_diffusion(sheet.positions, sheet.indices, used, edges);
}

std::vector<double> diffused(const SkinDiffusion& diffusion, const std::vector<double>& values) {
    std::vector<double> after;
    for (std::size_t v = 0; v < values.size(); ++v) {
        double sum = 0;
        for (std::uint32_t i = diffusion.first[v]; i < diffusion.first[v + 1]; ++i) {
            sum += double{diffusion.weights[i].second} * values[diffusion.weights[i].first];
        }
        after.push_back(sum);
    }
    return after;
}

std::vector<Vec3> across_y(const Sheet& sheet) {
    return std::vector<Vec3>(sheet.positions.size(), Vec3(0, 1, 0));
}

std::vector<WrinkleRest> strain_rests(const Sheet& sheet, float smoothing) {
    const SkinTriangles skin = make_skin_triangles(sheet.positions, sheet.indices, 0);
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        normals.push_back(glm::cross(skin.vertex_u[v], skin.vertex_v[v]));
    }
    const auto rests = make_strain_rest(
        sheet.positions, sheet.indices, skin.vertex_u, normals, WrinkleWeight::Angle, smoothing);
    return {rests.begin(), rests.end()};
}

TEST_CASE(
    "skin diffusion: constant strain is preserved, by any driver, on any triangles"
    * technique("wrinkle.smoothing")) {
    const Sheet sheet = make_sheet(8, 0.5f);
    std::vector<Vec3> now = sheet.positions;
    for (Vec3& p : now) {
        p = {0.7f * p.x + 0.2f * p.y, 0.9f * p.y, 0.1f * p.x};
    }
    std::vector<WrinkleRest> chord = {
        make_wrinkle_rest(sheet.positions, sheet.indices, across_y(sheet))};
    const std::vector<float> rough = vertex_compression(chord, now);
    diffuse_rest(chord[0], sheet.positions, sheet.indices, 1.7f);
    const std::vector<float> smooth = vertex_compression(chord, now);
    const std::vector<float> rough_strain = vertex_compression(strain_rests(sheet, 0), now);
    const std::vector<float> smooth_strain = vertex_compression(strain_rests(sheet, 1.7f), now);
    for (std::size_t v = 0; v < now.size(); ++v) {
        CHECK(std::abs(smooth[v] - rough[v]) < 2e-6f);
        CHECK(std::abs(smooth_strain[v] - rough_strain[v]) < 2e-6f);
    }
}

TEST_CASE(
    "skin diffusion: the integral over the area is kept, and no value leaves the range"
    * technique("wrinkle.smoothing")) {
    const Sheet sheet = make_sheet(9, 0.6f);
    Random random(7, 0, 0, 0);
    std::vector<double> values;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        values.push_back(double{random.uniform()});
    }
    const SkinDiffusion diffusion = diffusion_of(sheet, 1.9f);
    const std::vector<double> after = diffused(diffusion, values);
    const auto total = [&](const std::vector<double>& x) {
        return std::inner_product(x.begin(), x.end(), diffusion.area.begin(), 0.0);
    };
    CHECK(total(after) == near(total(values)).epsilon(1e-6));
    for (const auto& [vertex, weight] : diffusion.weights) {
        CHECK(weight >= 0);
    }
    const auto variance = [&](const std::vector<double>& x) {
        double sum = 0;
        for (const double value : x) {
            sum += (value - 0.5) * (value - 0.5);
        }
        return sum;
    };
    CHECK(variance(after) < 0.1 * variance(values));
}

TEST_CASE(
    "skin diffusion: total strain of triangles is kept if they count by area"
    * technique("wrinkle.smoothing")) {
    const Sheet sheet = make_sheet(7, 0.5f);
    Random random(11, 0, 0, 0);
    std::vector<Vec3> now = sheet.positions;
    for (Vec3& p : now) {
        p += 0.05f * Vec3{random.uniform(), random.uniform(), random.uniform()};
    }
    WrinkleRest rest =
        make_wrinkle_rest(sheet.positions, sheet.indices, across_y(sheet), WrinkleWeight::Area);
    std::vector<float> triangles(rest.across.size());
    find_compression(rest, now, triangles);
    const SkinTriangles skin = make_skin_triangles(sheet.positions, sheet.indices, 0);
    const double expected =
        std::inner_product(triangles.begin(), triangles.end(), skin.area.begin(), 0.0);
    const SkinDiffusion diffusion = diffusion_of(sheet, 1);
    diffuse_rest(rest, sheet.positions, sheet.indices, 1);
    const std::vector<float> found = vertex_compression({&rest, 1}, now);
    const double total =
        std::inner_product(found.begin(), found.end(), diffusion.area.begin(), 0.0);
    CHECK(total == near(expected).epsilon(1e-5));
}

TEST_CASE(
    "skin diffusion: a peak spreads by the requested distance, whatever the triangle size"
    * technique("wrinkle.smoothing")) {
    for (const std::uint32_t side : {16u, 32u}) {
        for (const float edges : {0.5f, 1.0f, 2.0f}) {
            const Sheet sheet = make_sheet(side);
            const SkinDiffusion diffusion = diffusion_of(sheet, edges);
            const std::uint32_t center = side / 2 * (side + 1) + side / 2;
            double square = 0;
            for (std::uint32_t i = diffusion.first[center]; i < diffusion.first[center + 1]; ++i) {
                const auto& [vertex, weight] = diffusion.weights[i];
                const double distance =
                    double{glm::distance(sheet.positions[vertex], sheet.positions[center])};
                square += double{weight} * distance * distance;
            }
            CHECK(std::sqrt(square) * side == near(double{edges}).epsilon(0.1));
        }
    }
}

TEST_CASE("skin diffusion: fine meshes hardly change" * technique("wrinkle.smoothing")) {
    double previous = 0;
    for (const std::uint32_t side : {8u, 16u, 32u}) {
        const Sheet sheet = make_sheet(side);
        std::vector<double> values;
        for (const Vec3& p : sheet.positions) {
            values.push_back(std::sin(6 * double{p.x}) * std::cos(5 * double{p.y}));
        }
        const std::vector<double> after = diffused(diffusion_of(sheet, 1), values);
        double change = 0;
        const std::uint32_t border = side / 4;
        for (std::uint32_t y = border; y <= side - border; ++y) {
            for (std::uint32_t x = border; x <= side - border; ++x) {
                const std::size_t v = y * (side + 1) + x;
                change = std::max(change, std::abs(after[v] - values[v]));
            }
        }
        if (previous > 0) {
            CHECK(change < 0.35 * previous);  // a quarter for half the edges
        }
        previous = change;
    }
    CHECK(previous < 0.03);
}

TEST_CASE(
    "skin diffusion: a seam does not stop it, excluded skin does"
    * technique("wrinkle.smoothing")) {
    Sheet sheet = make_sheet(6);
    const SkinDiffusion whole = diffusion_of(sheet, 1.5f);
    // The same with every triangle's own vertices.
    Sheet torn;
    for (const std::uint32_t v : sheet.indices) {
        torn.indices.push_back(static_cast<std::uint32_t>(torn.positions.size()));
        torn.positions.push_back(sheet.positions[v]);
    }
    const SkinDiffusion apart = diffusion_of(torn, 1.5f);
    std::vector<double> height;
    std::vector<double> torn_height;
    for (const Vec3& p : sheet.positions) {
        height.push_back(double{p.x * p.x});
    }
    for (const Vec3& p : torn.positions) {
        torn_height.push_back(double{p.x * p.x});
    }
    const std::vector<double> expected = diffused(whole, height);
    const std::vector<double> found = diffused(apart, torn_height);
    for (std::size_t i = 0; i < torn.positions.size(); ++i) {
        CHECK(found[i] == near(expected[sheet.indices[i]]).epsilon(1e-5));
    }

    std::vector<char> used(sheet.positions.size(), 1);
    for (std::uint32_t y = 0; y <= 6; ++y) {
        used[7 * y + 3] = 0;
    }
    const SkinDiffusion halves = make_skin_diffusion(sheet.positions, sheet.indices, used, 2);
    for (std::uint32_t v = 0; v < sheet.positions.size(); ++v) {
        for (std::uint32_t i = halves.first[v]; i < halves.first[v + 1]; ++i) {
            CHECK((v % 7 < 3) == (halves.weights[i].first % 7 < 3));
        }
    }
}

TEST_CASE(
    "skin diffusion: around a tube strain keeps its direction" * technique("wrinkle.smoothing")) {
    Sheet tube = make_sheet(24);
    for (Vec3& p : tube.positions) {
        p = {std::sin(3 * p.x), p.y, std::cos(3 * p.x)};
    }
    std::vector<Vec3> now = tube.positions;
    for (Vec3& p : now) {
        p.y *= 0.8f;
    }
    const std::vector<float> rough = vertex_compression(strain_rests(tube, 0), now);
    const std::vector<float> smooth = vertex_compression(strain_rests(tube, 2), now);
    for (std::size_t v = 0; v < now.size(); ++v) {
        CHECK(std::abs(rough[v] - 0.64f) < 0.01f);
        CHECK(std::abs(smooth[v] - 0.64f) < 0.01f);
    }
}

TEST_CASE(
    "skin diffusion: strain that jumps between triangles becomes smooth"
    * technique("wrinkle.smoothing")) {
    const Sheet sheet = make_sheet(12);
    std::vector<Vec3> now = sheet.positions;
    Random random(5, 0, 0, 0);
    for (Vec3& p : now) {
        p.y += random.uniform(-0.2f, 0.2f) / 12;
    }
    std::vector<WrinkleRest> rests = {
        make_wrinkle_rest(sheet.positions, sheet.indices, across_y(sheet))};
    const auto range = [&] {
        const std::vector<float> ratio = vertex_compression(rests, now);
        float low = 1e6f;
        float high = -1e6f;
        for (std::size_t y = 4; y <= 8; ++y) {
            for (std::size_t x = 4; x <= 8; ++x) {
                low = std::min(low, ratio[y * 13 + x]);
                high = std::max(high, ratio[y * 13 + x]);
            }
        }
        return high - low;
    };
    const float before = range();
    CHECK(before > 0.2f);
    diffuse_rest(rests[0], sheet.positions, sheet.indices, 2);
    CHECK(range() < 0.4f * before);
}

}  // namespace
}  // namespace limn::skin_diffusion_test
