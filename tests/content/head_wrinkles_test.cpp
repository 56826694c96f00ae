#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"
#include "ecs/components/animation.h"
#include "systems/animation/deform_mesh.h"
#include "systems/faces/wrinkle_measure.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace limn::head_wrinkles_test {
namespace {

const MeshData& head() {
    static const MeshData mesh = make_head({});
    return mesh;
}

/// Positions with these expressions at `weight`.
std::vector<Vec3> posed(const std::vector<std::string_view>& names, float weight) {
    MorphWeights weights;
    weights.weights.assign(head().morphs.size(), 0.0f);
    for (const std::string_view name : names) {
        weights.weights[expression_index(name)] = weight;
    }
    std::vector<Vec3> positions;
    CHECK(deform_positions(head(), {}, nullptr, nullptr, &weights, nullptr, positions));
    return positions;
}

/// Mean shortening of the skin of a region across its folds, lengthening counted as 0.
float shortening(std::string_view name, const std::vector<Vec3>& positions) {
    const auto region = std::ranges::find(head().regions, name, &VertexRegion::name);
    REQUIRE(region != head().regions.end());
    const std::size_t vertices = head().positions.size();
    const bool directed = !region->across.empty();  // the chin dimples in any
    const std::vector<Vec3> across = directed ? region->across : std::vector<Vec3>(vertices);
    const std::vector<float> aside(vertices, directed ? 0.0f : 0.5f);
    const WrinkleRest rest = make_wrinkle_rest(
        head().positions, head().indices, across, WrinkleWeight::Angle,
        {.aside = aside, .narrowing = 0});
    const std::vector<float> ratios = vertex_compression({&rest, 1}, positions);
    float sum = 0;
    float weights = 0;
    for (std::size_t i = 0; i + 3 <= head().indices.size(); i += 3) {
        const std::uint32_t* const v = &head().indices[i];
        const Vec3 cross = glm::cross(
            head().positions[v[1]] - head().positions[v[0]],
            head().positions[v[2]] - head().positions[v[0]]);
        for (std::size_t k = 0; k < 3; ++k) {
            const float weight = glm::length(cross) * region->weights[v[k]];
            sum += weight * std::max(1 - std::sqrt(ratios[v[k]]), 0.0f);
            weights += weight;
        }
    }
    return sum / weights;
}

struct Folding {
    std::vector<std::string_view> shapes;
    std::string_view region;               ///< that folds
    std::vector<std::string_view> smooth;  ///< regions that do not
};

const std::vector<Folding>& foldings() {
    static const std::vector<Folding> list = {
        {{"AU1_L", "AU1_R", "AU2_L", "AU2_R"},
         "forehead",
         {"cheek", "nasolabial", "upper_lip", "mouth_corner", "mentolabial"}},
        {{"AU4_L", "AU4_R"},
         "glabella",
         {"cheek", "nasolabial", "upper_lip", "mouth_corner", "mentolabial"}},
        {{"AU6_L", "AU6_R"}, "crows_feet", {"forehead", "glabella", "mentolabial"}},
        {{"AU12_L", "AU12_R"}, "nasolabial", {"forehead", "glabella", "nose_root", "upper_lid"}},
        {{"AU9_L", "AU9_R"}, "nose_side", {"forehead", "mentolabial", "mouth_corner"}},
        {{"AU18"}, "upper_lip", {"forehead", "glabella", "nose_root", "crows_feet"}},
        {{"AU7_L", "AU7_R"}, "inner_canthus", {"forehead", "glabella", "mentolabial", "chin"}},
        {{"AU15_L", "AU15_R"}, "marionette", {"forehead", "glabella", "nose_side", "cheek"}},
        {{"AU17"}, "chin", {"forehead", "glabella", "nose_side", "cheek"}},
    };
    return list;
}

TEST_CASE(
    "head wrinkles: skin shortens across the folds of anatomy, 5 times more than elsewhere"
    * technique("wrinkle.dimples")) {
    for (const Folding& folding : foldings()) {
        CAPTURE(folding.region);
        const std::vector<Vec3> positions = posed(folding.shapes, 1);
        const float folded = shortening(folding.region, positions);
        CHECK(folded > 0.04f);
        for (const std::string_view smooth : folding.smooth) {
            CAPTURE(smooth);
            CHECK(shortening(smooth, positions) < 0.2f * folded);
        }
    }
}

TEST_CASE("head wrinkles: raised brows shorten the whole center of the forehead, without a gap") {
    const std::vector<Vec3> raised = posed({"AU1_L", "AU1_R", "AU2_L", "AU2_R"}, 1);
    const auto region = std::ranges::find(head().regions, "forehead", &VertexRegion::name);
    REQUIRE(region != head().regions.end());
    const WrinkleRest rest = make_wrinkle_rest(head().positions, head().indices, region->across);
    const std::vector<float> ratios = vertex_compression({&rest, 1}, raised);
    float least = 1;
    for (std::size_t v = 0; v < ratios.size(); ++v) {
        const Vec3 p = 100.0f * head().positions[v];
        if (region->weights[v] > 0.5f && std::abs(p.x) < 3 && p.y > 7.2f && p.y < 9.2f) {
            least = std::min(least, 1 - std::sqrt(ratios[v]));
        }
    }
    CHECK(least > 0.05f);
}

TEST_CASE("head wrinkles: at rest nothing is shorter") {
    for (const VertexRegion& region : head().regions) {
        CHECK(shortening(region.name, posed({}, 0)) < 1e-6f);
    }
}

TEST_CASE(
    "head expressions: all at weight 0, every vertex is at rest to the bit"
    * technique("wrinkle.compression.face-model")) {
    CHECK(posed({}, 0) == head().positions);
}

TEST_CASE(
    "head expressions: at half its weight a unit moves half as far, and no other vertex"
    * technique("wrinkle.compression.face-model")) {
    const std::vector<Vec3> whole = posed({"AU12_L"}, 1);
    const std::vector<Vec3> half = posed({"AU12_L"}, 0.5f);
    const MorphTarget& target = head().morphs[expression_index("AU12_L")];
    for (std::uint32_t v = 0; v < whole.size(); ++v) {
        const Vec3& rest = head().positions[v];
        if (std::ranges::binary_search(target.vertices, v)) {
            CHECK(glm::distance(half[v] - rest, 0.5f * (whole[v] - rest)) < 1e-7f);
        } else {
            CHECK(whole[v] == rest);
        }
    }
}

}  // namespace
}  // namespace limn::head_wrinkles_test
