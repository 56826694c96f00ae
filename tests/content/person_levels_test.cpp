#include "content/make/models/simplify_mesh.h"
#include "content/make/person/person.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_levels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/walk/activity_clip.h"
#include "systems/animation/walk/walk_clip.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace limn::person_levels_test {

namespace {

struct Person {
    Assets assets;
    std::vector<ClipData> clips;

    explicit Person(int seed) {
        const PersonShape shape = {.seed = seed, .head_triangles = 800, .triangles = 2200};
        assets.meshes.push_back(make_person(shape));
        MeshRig rig = make_person_rig(shape);
        assets.meshes[0].name = rig.skeleton.name = rig.skin.name = "person";
        assets.skeletons.push_back(std::move(rig.skeleton));
        assets.skins.push_back(std::move(rig.skin));
        const SkeletonData& skeleton = assets.skeletons[0];
        clips.push_back(make_walk_clip(skeleton, Walk{.speed = 1.3f, .stride = 1.25f}));
        for (const CrowdActivity activity :
             {CrowdActivity::Stand, CrowdActivity::Talk, CrowdActivity::Sit, CrowdActivity::Wave}) {
            clips.push_back(make_activity_clip(skeleton, activity));
        }
    }
    [[nodiscard]] MeshData level(int triangles, int joints) const {
        return make_simplified(
            {.mesh = {0}, .triangles = triangles, .merge = true, .joints = joints}, assets);
    }
    [[nodiscard]] std::vector<Vec3>
    skinned(const MeshData& mesh, const ClipData& clip, float time) const {
        LocalPose pose = assets.skeletons[0].rest;
        sample_clip(clip, time, pose, {});
        std::vector<Affine> joints(pose.size());
        compute_joint_matrices(assets.skeletons[0], pose, joints);
        std::vector<Affine> palette(used_joints(mesh.skin));
        compute_skin_palette(assets.skins[0], joints, palette);
        std::vector<Vec3> positions = mesh.positions;
        const RestVertices rest = {mesh.positions, {}, {}};
        skin_linear(mesh.skin, palette, rest, {positions, {}, {}}, 0, positions.size());
        return positions;
    }
};

float largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, glm::distance(a[i], b[i]));
    }
    return largest;
}

/// A level of detail of the levels `plaza` and `crossing`: its mesh, and how many pixels a meter
/// has where it is largest on screen.
struct DetailLevel {
    const char* name;
    int triangles;
    int joints;
    float pixels;
};
constexpr float kPixelsPerQuad = 26;
constexpr float kHysteresis = 1.1f;
constexpr DetailLevel kDetailLevels[] = {
    {"mid", 1000, 22, 8 * kHysteresis* kPixelsPerQuad},
    {"far", 320, 20, 4 * kHysteresis* kPixelsPerQuad},
    {"dot", 76, 20, 2 * kHysteresis* kPixelsPerQuad},
};

}  // namespace

TEST_CASE(
    "person levels: with fewer joints nothing moves by half a pixel where a level begins"
    * technique("engine.lod-mesh")) {
    for (const int seed : {101, 104, 109}) {
        const Person person(seed);
        for (const DetailLevel& level : kDetailLevels) {
            CAPTURE(seed);
            CAPTURE(std::string(level.name));
            const MeshData whole = person.level(level.triangles, 0);
            const MeshData few = person.level(level.triangles, level.joints);
            REQUIRE(few.positions == whole.positions);
            CHECK(
                needed_joints(few.skin, person.assets.skins[0])
                <= static_cast<std::size_t>(level.joints));
            CHECK(needed_joints(whole.skin, person.assets.skins[0]) > 22);
            float worst = 0;
            for (const ClipData& clip : person.clips) {
                for (int i = 0; i <= 24; ++i) {
                    const float time = clip.duration * static_cast<float>(i) / 24.0f;
                    worst = std::max(
                        worst,
                        largest_distance(
                            person.skinned(whole, clip, time), person.skinned(few, clip, time)));
                }
            }
            CAPTURE(worst * level.pixels);
            CHECK(worst * level.pixels < 0.5f);
        }
    }
}

TEST_CASE("person levels: weights that pass to ancestors keep their sums, and the rest its shape") {
    const Person person(105);
    const MeshData whole = person.level(320, 0);
    const MeshData few = person.level(320, 20);
    REQUIRE(few.skin.first.size() == whole.skin.first.size());
    CHECK(few.skin.joints.size() < whole.skin.joints.size());
    for (std::size_t v = 0; v + 1 < few.skin.first.size(); ++v) {
        float sum = 0;
        for (std::uint32_t i = few.skin.first[v]; i < few.skin.first[v + 1]; ++i) {
            sum += few.skin.weights[i];
            for (std::uint32_t k = few.skin.first[v]; k < i; ++k) {
                CHECK(few.skin.joints[k] != few.skin.joints[i]);
            }
        }
        CHECK(sum == test::near(1.0f).epsilon(1e-5));
    }
    const ClipData still = {.name = "rest", .duration = 1, .sheets = {}};
    CHECK(largest_distance(person.skinned(few, still, 0), whole.positions) < 1e-5f);
}

TEST_CASE("person levels: fingers, eyes and twist joints come after limbs, sides in turn") {
    const Person person(102);
    const std::vector<std::string>& names = person.assets.skeletons[0].joints;
    CHECK(check_skeleton(person.assets.skeletons[0]).ok());
    REQUIRE(names.size() == 60);
    const auto last = [&](const char* part) {
        std::size_t found = 0;
        for (std::size_t j = 0; j < names.size(); ++j) {
            found = names[j].find(part) != std::string::npos ? j : found;
        }
        return found;
    };
    CHECK(last("Foot") < 18);
    CHECK(last("Toes") < 20);
    CHECK(last("Head") < 6);
    for (const char* minor : {"Twist", "Thumb", "Index", "Eye"}) {
        CHECK(last(minor) >= 22);
    }
    CHECK(names[6] == "LeftShoulder");
    CHECK(names[7] == "RightShoulder");
}

}  // namespace limn::person_levels_test
