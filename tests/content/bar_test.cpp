#include "content/make/models/bar.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/skin_kernels.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn::bar_test {

TEST_CASE(
    "bar: weights sum to 1, and change smoothly from one joint to the other"
    * technique("char.skin-defects")) {
    const BarShape shape;
    const MeshData mesh = make_bar(shape);
    REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        float sum = 0;
        float tip = 0;
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            CHECK(mesh.skin.weights[i] > 0);
            sum += mesh.skin.weights[i];
            tip += mesh.skin.joints[i] == 1 ? mesh.skin.weights[i] : 0.0f;
        }
        CHECK(sum == test::near(1));
        const float share = mesh.positions[v].y / shape.height;
        if (share < 0.25f) {
            CHECK(tip == 0);
        }
        if (share > 0.75f) {
            CHECK(tip == test::near(1));
        }
        if (std::abs(share - 0.5f) < 1e-6f) {
            CHECK(tip == test::near(0.5));
        }
    }
}

TEST_CASE("bar: its sides face outward, and its clips are those of its skeleton") {
    const MeshData mesh = make_bar({.sides = 6});
    CHECK(test::worst_facing(mesh) > 0.99f);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3 out(mesh.positions[v].x, 0, mesh.positions[v].z);
        CHECK(glm::dot(mesh.normals[v], out) > 0);
    }
    const MeshRig rig = make_bar_rig({});
    CHECK(check_skeleton(rig.skeleton).ok());
    REQUIRE(rig.clips.size() == 2);
    for (const ClipData& clip : rig.clips) {
        CHECK(check_clip(clip, rig.skeleton.joints.size(), 0).ok());
    }
    LocalPose pose = rig.skeleton.rest;
    std::vector<float> weights;
    sample_clip(rig.clips[0], 2.0f, pose, weights);
    CHECK(
        std::abs(glm::dot(pose.rotations[1], glm::angleAxis(radians(170.0f), Vec3(0, 1, 0))))
        == test::near(1).epsilon(1e-5));
}

}  // namespace limn::bar_test
