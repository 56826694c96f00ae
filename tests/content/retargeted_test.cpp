#include "content/bake/tangents.h"
#include "content/make/head/head.h"
#include "content/make/models/retargeted.h"
#include "content/make/models/simplify_mesh.h"
#include "ecs/base/triangle.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::retargeted_test {

using test::near;

namespace {

const MeshData& young() {
    static const MeshData mesh = make_head({.age = 0.3f});
    return mesh;
}

const MeshData& coarse() {
    static const MeshData mesh = [] {
        Assets assets;
        assets.meshes.push_back(young());
        return make_simplified({.mesh = {0}, .triangles = 500}, assets);
    }();
    return mesh;
}

MeshData map_head(const Affine& map) {
    MeshData mesh = young();
    for (Vec3& p : mesh.positions) {
        p = transform_point(map, p);
    }
    update_bounds(mesh);
    return mesh;
}

}  // namespace

TEST_CASE(
    "simplified: it has about as many triangles as asked for, and the shapes of its vertices") {
    const std::size_t triangles = coarse().indices.size() / 3;
    CHECK(triangles > 300);
    CHECK(triangles <= 500);
    CHECK(coarse().morphs.size() == young().morphs.size());
    for (std::size_t t = 0; t < coarse().morphs.size(); ++t) {
        const MorphTarget& morph = coarse().morphs[t];
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            CHECK(morph.vertices[i] < coarse().positions.size());
            CHECK(is_finite(morph.positions[i]));
        }
    }
    CHECK(make_simplified({.mesh = {7}}, Assets{}).positions.empty());
}

TEST_CASE(
    "retargeted: onto the same face the surface and its motion stay"
    * technique("face.retarget-fit, face.retarget-warp")) {
    const MeshData same = *retarget_surface(coarse(), young(), young(), 1, 0.2f);
    for (std::size_t v = 0; v < same.positions.size(); ++v) {
        CHECK(glm::distance(same.positions[v], coarse().positions[v]) < 2e-5f);
    }
    for (std::size_t t = 0; t < same.morphs.size(); ++t) {
        for (std::size_t i = 0; i < same.morphs[t].vertices.size(); ++i) {
            CHECK(
                glm::distance(same.morphs[t].positions[i], coarse().morphs[t].positions[i])
                < 1e-5f);
        }
    }
}

TEST_CASE(
    "retargeted: onto a larger face markers and motion are larger, and a gain exaggerates"
    * technique("face.retarget-warp")) {
    const Affine larger = affine_from({0.1f, 0.2f, 0}, Quat(1, 0, 0, 0), Vec3(1.4f));
    const MeshData moved = *retarget_surface(coarse(), young(), map_head(larger), 1.5f, 0.2f);
    for (std::size_t v = 0; v < moved.positions.size(); ++v) {
        CHECK(
            glm::distance(moved.positions[v], transform_point(larger, coarse().positions[v]))
            < 5e-5f);
    }
    float most = 0.0f;
    for (std::size_t t = 0; t < moved.morphs.size(); ++t) {
        for (std::size_t i = 0; i < moved.morphs[t].vertices.size(); ++i) {
            const Vec3 want = 1.5f * 1.4f * coarse().morphs[t].positions[i];
            CHECK(glm::distance(moved.morphs[t].positions[i], want) < 2e-5f);
            most = std::max(most, glm::length(want));
        }
    }
    CHECK(most > 0.02f);
}

TEST_CASE(
    "retargeted: onto another face markers lie on its skin" * technique("face.retarget-fit")) {
    const MeshData elder = make_head({.age = 0.95f, .sex = 0.8f, .build = 0.9f});
    const MeshData fitted = *retarget_surface(coarse(), young(), elder, 1, 0.02f);
    double sum = 0;
    double before = 0;
    for (std::size_t v = 0; v < fitted.positions.size(); ++v) {
        const auto distance = [&](const Vec3& p) {
            float nearest = INFINITY;
            for (std::size_t i = 0; i < elder.indices.size(); i += 3) {
                const Vec3 a = elder.positions[elder.indices[i]];
                if (glm::distance(p, a) < 0.03f + nearest) {
                    nearest = std::min(
                        nearest, distance_to_triangle(
                                     p, a, elder.positions[elder.indices[i + 1]],
                                     elder.positions[elder.indices[i + 2]]));
                }
            }
            return static_cast<double>(nearest);
        };
        sum += distance(fitted.positions[v]);
        before += distance(coarse().positions[v]);
    }
    const auto count = static_cast<double>(fitted.positions.size());
    INFO("mean distance [m] ", sum / count, ", of what is not fitted ", before / count);
    CHECK(sum / count < 0.0005);
    CHECK(sum < 0.75 * before);
}

TEST_CASE("retargeted: what cannot be is logged, and the surface stays") {
    Assets assets;
    assets.meshes = {coarse(), young(), young()};
    assets.meshes[2].positions.assign(assets.meshes[2].positions.size(), Vec3(0, 0, 1));
    MeshData made;
    const std::vector<std::string> messages = test::messages_of(
        [&] { made = make_retargeted({.mesh = {0}, .from = {2}, .onto = {1}}, assets); });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("coincide or lie in one plane") != std::string::npos);
    CHECK(made.positions == coarse().positions);
    CHECK(make_retargeted({.mesh = {0}, .from = {9}, .onto = {1}}, assets).positions.empty());
}

}  // namespace limn::retargeted_test
