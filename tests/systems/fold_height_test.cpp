#include "systems/faces/fold_height.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace limn::fold_height_test {

using limn::test::near;

namespace {

constexpr float kSide = 0.08f;  ///< of a sheet of skin [m]
constexpr float kWave = 0.01f;  ///< wavelength of its folds [m]
constexpr float kSteep = 0.8f;  ///< largest slope
constexpr float kHigh = kSteep * kWave / (2 * std::numbers::pi_v<float>);

/// A sheet in z = 0 with x right, y up, u along x and v down, as one grid.
MeshData make_sheet(int quads) {
    MeshData mesh;
    for (int j = 0; j <= quads; ++j) {
        for (int i = 0; i <= quads; ++i) {
            const Vec2 uv = Vec2(i, j) / static_cast<float>(quads);
            mesh.positions.emplace_back(kSide * uv.x, kSide * (1 - uv.y), 0);
            mesh.normals.emplace_back(0, 0, 1);
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.push_back(uv);
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(j * (quads + 1) + i);
    };
    for (int j = 0; j < quads; ++j) {
        for (int i = 0; i < quads; ++i) {
            for (const std::uint32_t corner :
                 {index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i, j),
                  index(i + 1, j + 1), index(i + 1, j)}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    return mesh;
}

float phase_at(float y) {
    return 2 * std::numbers::pi_v<float> * y / kWave;
}

/// Folds along x: the slope up the map is that of kHigh sin(phase_at(y)).
ImageData sine_map(int size = 1024) {
    ImageData map = {.name = "sine", .width = size, .height = size, .pixels = {}};
    for (int row = 0; row < size; ++row) {
        const float y = kSide * (1 - (static_cast<float>(row) + 0.5f) / static_cast<float>(size));
        const float slope = kSteep * std::cos(phase_at(y));
        const float z = 1 / std::sqrt(1 + slope * slope);
        for (int column = 0; column < size; ++column) {
            const auto byte = [](float n) {
                return static_cast<std::uint8_t>(128 + std::lround(127 * n));
            };
            map.pixels.insert(map.pixels.end(), {128, byte(-slope * z), byte(z), 255});
        }
    }
    return map;
}

/// Largest distance of heights from those of the sine, except at the rim [m].
float worst_height(const MeshData& mesh, const std::vector<Vec2>& heights) {
    float worst = heights.size() == mesh.positions.size() ? 0.0f : 1.0f;
    for (std::size_t v = 0; v < heights.size(); ++v) {
        const float y = mesh.positions[v].y;
        if (y > 0.1f * kSide && y < 0.9f * kSide) {
            worst = std::max(worst, std::abs(heights[v].x - kHigh * std::sin(phase_at(y))));
        }
    }
    return worst;
}

float highest(const std::vector<Vec2>& heights) {
    float most = 0;
    for (const Vec2& height : heights) {
        most = std::max(most, std::abs(height.x));
    }
    return most;
}

}  // namespace

TEST_CASE(
    "fold height: folds of a sine have the height of its integral, to 3 %"
    * technique("wrinkle.displacement")) {
    const MeshData sheet = make_sheet(96);  // 12 edges a fold
    CHECK(worst_height(sheet, fold_heights(sheet, sine_map(), {}, false)) <= 0.03f * kHigh);
}

TEST_CASE("fold height: on a sheet of twice the size folds are twice as high") {
    MeshData large = make_sheet(96);
    for (Vec3& p : large.positions) {
        p *= 2.0f;
    }
    const std::vector<Vec2> small = fold_heights(make_sheet(96), sine_map(), {}, false);
    const std::vector<Vec2> heights = fold_heights(large, sine_map(), {}, false);
    REQUIRE(heights.size() == small.size());
    for (std::size_t v = 0; v < heights.size(); ++v) {
        CHECK(heights[v].x == near(2 * double{small[v].x}).epsilon(1e-3).scale(kHigh));
    }
}

TEST_CASE(
    "fold height: the mapping to the mesh does not matter, and no seam opens"
    * technique("wrinkle.displacement")) {
    MeshData sheet = make_sheet(96);
    const std::vector<Vec2> whole = fold_heights(sheet, sine_map(), {}, false);
    // The upper half has vertices of its own, a copy of the map beyond its edge, mirrored.
    constexpr std::uint32_t kRow = 97;
    constexpr std::uint32_t kFirst = 48 * kRow;  // of the row common to both halves
    const auto copies = static_cast<std::uint32_t>(sheet.positions.size());
    for (std::uint32_t v = kFirst; v < kFirst + kRow; ++v) {
        sheet.positions.push_back(Vec3(sheet.positions[v]));
        sheet.normals.push_back(Vec3(sheet.normals[v]));
        sheet.tangents.push_back(Vec4(sheet.tangents[v]));
        sheet.uvs.push_back(Vec2(sheet.uvs[v]));
    }
    for (std::size_t t = 0; t < sheet.indices.size(); t += 3) {
        std::uint32_t* const corner = &sheet.indices[t];
        if (*std::min_element(corner, corner + 3) < kFirst) {
            std::for_each(corner, corner + 3, [&](std::uint32_t& v) {
                v = v >= kFirst ? copies + (v - kFirst) : v;
            });
        }
    }
    for (std::uint32_t v = 0; v < sheet.positions.size(); ++v) {
        if (v < kFirst || v >= copies) {
            sheet.uvs[v] = {1 - sheet.uvs[v].x, sheet.uvs[v].y + 1};
            sheet.tangents[v] = {-1, 0, 0, -1};
        }
        sheet.uvs[v] = (sheet.uvs[v] - Vec2(0.25f, 0.5f)) / Vec2(1, 2);
    }
    const TextureSlot slot = {.image = {}, .offset = {0.25f, 0.5f}, .scale = {1, 2}};
    const std::vector<Vec2> heights = fold_heights(sheet, sine_map(), slot, false);
    REQUIRE(heights.size() == sheet.positions.size());
    for (std::uint32_t v = 0; v < copies; ++v) {
        CHECK(heights[v].x == near(whole[v].x).epsilon(1e-3).scale(kHigh));
    }
    for (std::uint32_t i = 0; i < kRow; ++i) {
        CHECK(heights[copies + i] == heights[kFirst + i]);
    }
}

TEST_CASE("fold height: edges of a quarter of a fold resolve it, of half a fold do not") {
    const auto sheet = [](int edges_per_fold) {
        return make_sheet(static_cast<int>(std::lround(kSide / kWave)) * edges_per_fold);
    };
    const ImageData map = sine_map();
    CHECK(highest(fold_heights(sheet(12), map, {}, false)) == near(kHigh).epsilon(0.04));
    CHECK(highest(fold_heights(sheet(6), map, {}, false)) > 0.8f * kHigh);
    CHECK(fold_heights(sheet(2), map, {}, false).empty());
    CHECK(fold_heights(sheet(1), map, {}, false).empty());
}

TEST_CASE("fold height: at a hard edge nothing moves, where it is smooth it does") {
    MeshData sheet = make_sheet(96);
    const std::size_t center = 48 * 97 + 30;
    const float before = fold_heights(sheet, sine_map(), {}, false)[center - 97 * 3].x;
    sheet.positions.push_back(Vec3(sheet.positions[center - 97 * 3]));
    sheet.normals.emplace_back(1, 0, 0);
    sheet.tangents.emplace_back(0, 1, 0, 1);
    sheet.uvs.emplace_back(0, 0);
    const std::vector<Vec2> heights = fold_heights(sheet, sine_map(), {}, false);
    REQUIRE(heights.size() == sheet.positions.size());
    CHECK(std::abs(before) > 0.5f * kHigh);
    CHECK(heights[center - 97 * 3].x == 0);
    CHECK(heights.back().x == 0);
}

TEST_CASE("fold height: two layers have separate heights") {
    ImageData map = sine_map();
    for (std::size_t i = 0; i < map.pixels.size(); i += 4) {
        map.pixels[i + 2] = 128;
        map.pixels[i + 3] = static_cast<std::uint8_t>(256 - map.pixels[i + 1]);  // upside down
    }
    const MeshData sheet = make_sheet(96);
    std::vector<Vec2> heights = fold_heights(sheet, map, {}, true);
    CHECK(worst_height(sheet, heights) <= 0.04f * kHigh);
    for (Vec2& height : heights) {
        height.x = -height.y;
    }
    CHECK(worst_height(sheet, heights) <= 0.04f * kHigh);
    map.pixels.assign(map.pixels.size(), 128);
    CHECK(fold_heights(sheet, map, {}, true).empty());  // both flat
}

TEST_CASE("fold height: missing, non-finite or out-of-range input displaces nothing") {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    MeshData sheet = make_sheet(24);
    sheet.tangents.clear();
    CHECK(fold_heights(sheet, sine_map(64), {}, false).empty());
    CHECK(fold_heights(MeshData{}, sine_map(64), {}, false).empty());
    CHECK(fold_heights(make_sheet(24), ImageData{}, {}, false).empty());

    MeshData broken = make_sheet(96);
    broken.positions[700] = {kNan, 0, 0};
    broken.uvs[900] = {kNan, 3e38f};
    broken.uvs[901] = {1e30f, 0};
    broken.normals[1000] = {kNan, kNan, kNan};
    broken.indices[5] = 4000000;
    for (const Vec2& height : fold_heights(broken, sine_map(), {}, false)) {
        CHECK(std::abs(height.x) <= 10 * kHigh);
    }
}

}  // namespace limn::fold_height_test
