#include "ecs/base/jobs.h"
#include "ecs/base/rng.h"
#include "systems/faces/skin_strain.h"
#include "systems/faces/wrinkle_batch.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::wrinkle_batch_test {
namespace {

/// A curved sheet whose vertices, some of them on a seam, are not a multiple of four.
struct Sheet {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<Vec3> across;
};

Sheet make_sheet() {
    constexpr std::uint32_t kColumns = 13;
    constexpr std::uint32_t kRows = 11;
    Sheet sheet;
    for (std::uint32_t row = 0; row < kRows; ++row) {
        for (std::uint32_t column = 0; column < kColumns; ++column) {
            const float angle = 0.2f * static_cast<float>(column % (kColumns - 1));
            sheet.positions.emplace_back(
                std::cos(angle), 0.1f * static_cast<float>(row), std::sin(angle));
            sheet.across.push_back(row < 8 ? Vec3{0, 1, 0} : Vec3{0, 0, 0});
            if (row > 0 && column > 0) {
                const std::uint32_t v = row * kColumns + column;
                sheet.indices.insert(
                    sheet.indices.end(),
                    {v, v - 1, v - kColumns, v - 1, v - kColumns - 1, v - kColumns});
            }
        }
    }
    return sheet;
}

std::vector<WrinkleRest> strain_rests(const Sheet& sheet) {
    const SkinTriangles skin = make_skin_triangles(sheet.positions, sheet.indices, 0);
    std::vector<Vec3> normals;
    for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
        normals.push_back(glm::cross(skin.vertex_u[v], skin.vertex_v[v]));
    }
    const std::array<WrinkleRest, 3> rests =
        make_strain_rest(sheet.positions, sheet.indices, skin.vertex_u, normals);
    return {rests.begin(), rests.end()};
}

/// Faces that are crumpled at random, and room for their intensities.
struct Crowd {
    std::vector<std::vector<Vec3>> deformed;
    std::vector<std::vector<float>> intensity;
    std::vector<CrowdFace> faces;

    Crowd(const Sheet& sheet, std::size_t count) {
        Random random(7, 0, 0, 0);
        for (std::size_t i = 0; i < count; ++i) {
            deformed.push_back(sheet.positions);
            for (Vec3& position : deformed.back()) {
                position += 0.03f * Vec3(random.uniform(), random.uniform(), random.uniform());
            }
            intensity.emplace_back(sheet.positions.size(), 9.0f);
        }
        for (std::size_t i = 0; i < count; ++i) {
            const auto k = static_cast<float>(i);
            faces.push_back({deformed[i], 1 + 0.02f * k, 1 + 0.5f * k, intensity[i], 0});
        }
    }
};

std::vector<std::vector<WrinkleRest>> all_rests(const Sheet& sheet) {
    WrinkleRest of_lengths = make_wrinkle_rest(sheet.positions, sheet.indices, sheet.across);
    of_lengths.mean_length = true;
    const std::vector<float> aside(sheet.positions.size(), 0.2f);
    return {
        {},
        {make_wrinkle_rest(sheet.positions, sheet.indices, sheet.across)},
        {make_wrinkle_rest(
            sheet.positions, sheet.indices, sheet.across, WrinkleWeight::Angle,
            {.aside = aside, .narrowing = 0.4f})},
        {of_lengths},
        {make_edge_rest(sheet.positions, sheet.indices)},
        strain_rests(sheet)};
}

}  // namespace

TEST_CASE(
    "wrinkle batch: eight faces at a time have the intensities of single faces"
    * technique("wrinkle.compression.integration, wrinkle.natural-width")) {
    const Sheet sheet = make_sheet();
    REQUIRE(sheet.positions.size() % 4 != 0);
    for (const std::vector<WrinkleRest>& rests : all_rests(sheet)) {
        for (const std::size_t count : {1, 7, 8, 19}) {
            Crowd together(sheet, count);
            Crowd alone(sheet, count);
            find_intensities(rests, together.faces);
            find_intensities_scalar(rests, alone.faces);
            float largest = 0;
            float spread = 0;
            for (std::size_t i = 0; i < count; ++i) {
                for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
                    const float expected = alone.intensity[i][v];
                    largest = std::max(largest, std::abs(together.intensity[i][v] - expected));
                    spread = std::max(spread, std::abs(expected - alone.intensity[0][0]));
                }
            }
            CHECK(largest <= 1e-6f);
            CHECK((rests.empty() || spread > 0.1f));
        }
    }
}

TEST_CASE("wrinkle batch: the grouping of faces and the number of threads change no bit") {
    const Sheet sheet = make_sheet();
    const std::vector<WrinkleRest> rests = {
        make_wrinkle_rest(sheet.positions, sheet.indices, sheet.across)};
    Crowd all(sheet, 21);
    find_intensities(rests, all.faces);
    const int threads = thread_count();
    set_thread_count(1);
    Crowd each(sheet, 21);
    for (const CrowdFace& face : each.faces) {
        find_intensities(rests, {&face, 1});
    }
    set_thread_count(threads);
    CHECK(all.intensity == each.intensity);
}

TEST_CASE(
    "wrinkle batch: collapsed, huge and NaN faces have finite intensities and harm no other") {
    const Sheet sheet = make_sheet();
    const std::vector<WrinkleRest> rests = {
        make_wrinkle_rest(sheet.positions, sheet.indices, sheet.across)};
    Crowd crowd(sheet, 4);
    std::ranges::fill(crowd.deformed[0], Vec3{0, 0, 0});
    std::ranges::fill(crowd.deformed[1], Vec3{NAN, 0, std::numeric_limits<float>::infinity()});
    for (Vec3& position : crowd.deformed[2]) {
        position *= 1e15f;
    }
    find_intensities(rests, crowd.faces);
    CHECK(crowd.intensity[0][0] == 1.0f);
    CHECK(crowd.intensity[2][0] == -1.0f);
    const std::vector<std::vector<float>> found = crowd.intensity;
    find_intensities_scalar(rests, crowd.faces);
    for (std::size_t i = 0; i < found.size(); ++i) {
        float largest = 0;
        for (std::size_t v = 0; v < sheet.positions.size(); ++v) {
            REQUIRE(std::isfinite(found[i][v]));
            largest = std::max(largest, std::abs(found[i][v] - crowd.intensity[i][v]));
        }
        CHECK(largest <= 1e-6f);
    }
}

TEST_CASE("wrinkle batch: folds at rest count as shortening, each face by its own weight") {
    const Sheet sheet = make_sheet();
    std::vector<float> resting(sheet.positions.size(), 0.0f);
    for (std::size_t v = 0; v < resting.size(); v += 3) {  // some where nothing is measured
        resting[v] = 0.2f;
    }
    for (const std::vector<WrinkleRest>& rests : all_rests(sheet)) {
        if (rests.empty()) {
            continue;
        }
        Crowd together(sheet, 11);
        Crowd alone(sheet, 11);
        for (std::size_t i = 0; i < 11; ++i) {
            together.faces[i].resting_weight = 0.1f * static_cast<float>(i);
            alone.faces[i].resting_weight = together.faces[i].resting_weight;
        }
        find_intensities(rests, together.faces, resting);
        find_intensities_scalar(rests, alone.faces, resting);
        Crowd young(sheet, 11);
        find_intensities(rests, young.faces);
        CHECK(together.intensity[0] == young.intensity[0]);
        float largest = 0;
        for (std::size_t i = 0; i < 11; ++i) {
            for (std::size_t v = 0; v < resting.size(); ++v) {
                const float found = together.intensity[i][v];
                largest = std::max(largest, std::abs(found - alone.intensity[i][v]));
                const bool folds = i > 0 && resting[v] > 0;
                CHECK_UNARY(folds ? found > young.intensity[i][v] : found == young.intensity[i][v]);
            }
        }
        CHECK(largest <= 1e-6f);
        // A sheet at rest, of which a fifth is too long, has the intensity of 0.8^2.
        const CrowdFace still = {sheet.positions, 1, 4, together.intensity[0], 1};
        find_intensities(rests, {&still, 1}, resting);
        CHECK(still.intensity[0] == test::near(wrinkle_intensity(0.64f, 1, 4)).epsilon(1e-4));
    }
}

}  // namespace limn::wrinkle_batch_test
