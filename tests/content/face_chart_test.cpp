#include "content/make/head/face_chart.h"
#include "content/make/head/head.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::face_chart_test {
namespace {

/// The reference positions of the skin that folds.
float farthest_from_uvs() {
    const MeshData head = make_head({});
    std::vector<std::size_t> folding;
    std::vector<Vec3> reference;
    for (std::size_t v = 0; v < head.positions.size(); ++v) {
        if (std::ranges::any_of(
                head.regions, [v](const VertexRegion& region) { return region.weights[v] > 0; })) {
            folding.push_back(v);
            reference.push_back(100.0f * head.positions[v]);
        }
    }
    CHECK(folding.size() > 1000);
    const std::vector<Vec2> uvs = make_face_chart(reference);
    float farthest = 0;
    for (std::size_t i = 0; i < folding.size(); ++i) {
        farthest = std::max(farthest, glm::distance(uvs[i], head.uvs[folding[i]]));
    }
    return farthest;
}

}  // namespace

TEST_CASE("face chart: points of the head's own skin are at its texture coordinates") {
    CHECK(farthest_from_uvs() <= 1e-5f);
}

TEST_CASE("face chart: points outside the face map to the corner") {
    const Vec3 none(std::numeric_limits<float>::quiet_NaN());
    CHECK(make_face_chart(std::vector<Vec3>{none})[0] == Vec2{0, 0});
}

}  // namespace limn::face_chart_test
