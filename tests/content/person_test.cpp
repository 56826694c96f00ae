#include "content/make/person/person.h"
#include "ecs/base/jobs.h"
#include "ecs/components/dress.h"
#include "ecs/components/humanoid.h"
#include "tests/content/mesh_laws.h"
#include "tests/content/posed_person.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace limn::person_test {

using namespace test;

namespace {

constexpr std::array<PersonPart, 6> kParts = {PersonPart::Skin,     PersonPart::Eyes,
                                              PersonPart::Hair,     PersonPart::Shirt,
                                              PersonPart::Trousers, PersonPart::Shoes};

/// People who together wear everything there is.
const std::array<PersonShape, 6> kPeople = {{
    {.seed = 1,
     .sex = PersonSex::Woman,
     .hair = PersonHair::Long,
     .top = PersonTop::Tee,
     .legs = PersonLegwear::Skirt,
     .sleeves = PersonSleeves::Short},
    {.seed = 2,
     .sex = PersonSex::Man,
     .build = 1,
     .age = 1,
     .hair = PersonHair::Short,
     .top = PersonTop::Coat,
     .legs = PersonLegwear::Trousers,
     .sleeves = PersonSleeves::Long},
    {.seed = 3,
     .sex = PersonSex::Man,
     .height = 2,
     .build = -1,
     .hair = PersonHair::Bald,
     .top = PersonTop::Shirt,
     .legs = PersonLegwear::Shorts,
     .sleeves = PersonSleeves::Short},
    {.seed = 4,
     .sex = PersonSex::Woman,
     .height = 1.5f,
     .hair = PersonHair::Bun,
     .legs = PersonLegwear::Dress,
     .sleeves = PersonSleeves::Short},
    {.seed = 5,
     .sex = PersonSex::Woman,
     .build = 1,
     .hair = PersonHair::Bob,
     .top = PersonTop::Jumper,
     .legs = PersonLegwear::Trousers,
     .sleeves = PersonSleeves::Long},
    {.seed = 6,
     .height = 1.2f,
     .years = 7,
     .hair = PersonHair::Long,
     .top = PersonTop::Tee,
     .legs = PersonLegwear::Shorts,
     .sleeves = PersonSleeves::Short},
}};

PersonShape with_part(PersonShape shape, PersonPart part) {
    shape.part = part;
    return shape;
}

/// Lengths of arrays, unit vectors, finite numbers.
void check_vertices(const MeshData& mesh) {
    const std::size_t count = mesh.positions.size();
    REQUIRE(mesh.normals.size() == count);
    REQUIRE(mesh.tangents.size() == count);
    REQUIRE(mesh.uvs.size() == count);
    REQUIRE(mesh.colors.size() == count);
    REQUIRE(*std::max_element(mesh.indices.begin(), mesh.indices.end()) < count);
    float worst = 0;
    bool finite = true;
    for (std::size_t i = 0; i < count; ++i) {
        worst = std::max(worst, std::abs(glm::length(mesh.normals[i]) - 1.0f));
        worst = std::max(worst, std::abs(glm::length(Vec3(mesh.tangents[i])) - 1.0f));
        worst = std::max(worst, std::abs(std::abs(mesh.tangents[i].w) - 1.0f));
        finite = finite && is_finite(mesh.positions[i]) && is_finite(mesh.uvs[i]);
    }
    CHECK(worst < 1e-5f);
    CHECK(finite);
}

}  // namespace

TEST_CASE("person: every part is a closed two-manifold that faces outwards") {
    for (const PersonShape& shape : kPeople) {
        for (const PersonPart part : kParts) {
            CAPTURE(shape.seed);
            CAPTURE(static_cast<int>(part));
            const MeshData mesh = make_person(with_part(shape, part));
            if (part == PersonPart::Hair && shape.hair == PersonHair::Bald) {
                CHECK(mesh.indices.empty());
                continue;
            }
            check_vertices(mesh);
            CHECK(open_edges(mesh) == 0);
            CHECK(crowded_edges(mesh) == 0);
            CHECK(signed_volume(mesh) > 0);
            if (part != PersonPart::Skin && part != PersonPart::Hair) {  // they have narrow creases
                CHECK(worst_facing(mesh) > 0.2f);
            }
        }
    }
}

TEST_CASE("person: in one mesh, the alpha of vertex colors says which part they are of") {
    constexpr std::array<DressedPart, 6> kDressed = {DressedPart::Skin, DressedPart::Other,
                                                     DressedPart::Hair, DressedPart::Shirt,
                                                     DressedPart::Legs, DressedPart::Other};
    for (const PersonShape& shape : {kPeople[0], kPeople[2]}) {
        const MeshData whole = make_person(shape);
        std::size_t first = 0;
        for (std::size_t i = 0; i < kParts.size(); ++i) {
            const std::size_t count = make_person(with_part(shape, kParts[i])).positions.size();
            REQUIRE(first + count <= whole.colors.size());
            bool same = true;
            for (std::size_t v = first; v < first + count; ++v) {
                same = same && whole.colors[v].w == alpha_of_part(kDressed[i]);
            }
            CHECK(same);
            first += count;
        }
        CHECK(first == whole.colors.size());
    }
}

TEST_CASE("person: at most four joints move a vertex, with weights that sum to 1") {
    for (const PersonShape& shape : kPeople) {
        const MeshData mesh = make_person(shape);
        REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
        float worst = 0;
        bool few = true;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            float sum = 0;
            for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
                sum += mesh.skin.weights[i];
                REQUIRE(mesh.skin.joints[i] < 60);
            }
            worst = std::max(worst, std::abs(sum - 1));
            few = few && mesh.skin.first[v + 1] - mesh.skin.first[v] <= 4;
        }
        CHECK(few);
        CHECK(worst < 1e-5f);
    }
}

TEST_CASE("person: soles lie on the floor, the crown is as high as asked, few triangles") {
    for (const PersonShape& shape : kPeople) {
        CAPTURE(shape.seed);
        const MeshData shoes = make_person(with_part(shape, PersonPart::Shoes));
        CHECK(std::abs(shoes.bounds.min.y) < 1e-3f);
        const MeshData whole = make_person(shape);
        CHECK(whole.bounds.min.y > -1e-3f);
        CHECK(whole.indices.size() / 3 > 8000);
        CHECK(whole.indices.size() / 3 < 15000);
        if (shape.height > 0) {
            const MeshData skin = make_person(with_part(shape, PersonPart::Skin));
            CHECK(skin.bounds.max.y == near(double(shape.height)).epsilon(0.012));
        }
        PersonShape far = shape;
        far.triangles = 1500;
        const MeshData reduced = make_person(far);
        CHECK(reduced.indices.size() / 3 < 2600);
        CHECK(open_edges(reduced) == 0);
    }
}

TEST_CASE(
    "person: the skeleton has 60 joints, all parts of a person, and is symmetric at rest"
    * technique("char.skeleton-hierarchy")) {
    for (const PersonShape& shape : kPeople) {
        const MeshRig rig = make_person_rig(shape);
        const SkeletonData& skeleton = rig.skeleton;
        REQUIRE(check_skeleton(skeleton));
        REQUIRE(check_skin(rig.skin, skeleton.joints.size()));
        CHECK(skeleton.joints.size() == 60);
        const BodyJoints body = find_body_joints(skeleton);
        for (std::size_t part = 0; part < kBodyParts; ++part) {
            CAPTURE(part);
            CHECK(body.has(static_cast<BodyPart>(part)));
        }
        for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
            const std::string& name = skeleton.joints[i];
            if (name.starts_with("Left")) {
                const std::size_t other = joint_called(skeleton, "Right" + name.substr(4));
                const Vec3 left = rest_point(skeleton, static_cast<std::int32_t>(i));
                const Vec3 right = rest_point(skeleton, static_cast<std::int32_t>(other));
                CHECK(glm::distance(left, right * Vec3(-1, 1, 1)) < 1e-6f);
            }
        }
        for (const ClipData& clip : rig.clips) {
            CHECK(check_clip(clip, skeleton.joints.size(), 16));  // bends and faces
        }
    }
}

TEST_CASE(
    "person: elbows, knees and fingers bend the way of a body"
    * technique("char.ik-joint-limits")) {
    const SkeletonData skeleton = make_person_rig({}).skeleton;
    const auto limit_of = [&](const char* name) {
        const std::size_t joint = joint_called(skeleton, name);
        for (const JointFreedom& freedom : skeleton.freedoms) {
            if (freedom.joint == joint) {
                return freedom;
            }
        }
        FAIL("no limit of ", name);
        return JointFreedom{};
    };
    /// How the end of a bone moves when its joint turns by a small positive angle.
    const auto moves = [&](const char* joint, const char* end) {
        const std::size_t child = joint_called(skeleton, end);
        return glm::cross(limit_of(joint).axis, skeleton.rest.translations[child]);
    };
    for (const char* side : {"Left", "Right"}) {
        const std::string s = side;
        CHECK(moves((s + "Forearm").c_str(), (s + "Hand").c_str()).z > 0.1f);
        CHECK(moves((s + "Shin").c_str(), (s + "Foot").c_str()).z < -0.1f);
        CHECK(limit_of((s + "Forearm").c_str()).min > -0.2f);
        CHECK(limit_of((s + "Shin").c_str()).max > 2.0f);
        // Palms face the thighs: fingers bend toward the middle of the body.
        const Vec3 bends = moves((s + "Middle2").c_str(), (s + "Middle3").c_str());
        CHECK(bends.x * (s == "Left" ? 1.0f : -1.0f) < 0);
    }
}

TEST_CASE(
    "person: arms that hang or are raised, a seat, a squat and fists keep the volume of a body"
    * technique("char.skin-bone-offset")) {
    for (const PersonShape& shape : kPeople) {
        const MeshRig rig = make_person_rig(shape);
        for (const PersonPart part : {PersonPart::Skin, PersonPart::Shirt, PersonPart::Trousers}) {
            const MeshData mesh = make_person(with_part(shape, part));
            const double volume = signed_volume(mesh);
            for (const ClipData& clip : rig.clips) {
                CAPTURE(shape.seed);
                CAPTURE(static_cast<int>(part));
                CAPTURE(clip.name);
                const MeshData moved =
                    posed_mesh(mesh, rig.skeleton, first_pose(rig.skeleton, clip));
                // Skirts and coats are drawn over the knees.
                const bool skirt =
                    (part == PersonPart::Trousers
                     && (shape.legs == PersonLegwear::Skirt || shape.legs == PersonLegwear::Dress))
                    || (part == PersonPart::Shirt && shape.top == PersonTop::Coat);
                CHECK(signed_volume(moved) == near(volume).epsilon(skirt ? 0.35 : 0.15));
            }
        }
    }
}

TEST_CASE("person: soles lie on the floor in every clip, whatever the height and the build") {
    for (int seed = 0; seed < 24; ++seed) {
        const PersonShape shape = {
            .part = PersonPart::Shoes,
            .seed = seed,
            .height = seed % 2 == 0 ? 0.0f : 1.2f + 0.04f * static_cast<float>(seed)};
        const MeshRig rig = make_person_rig(shape);
        const MeshData shoes = make_person(shape);
        for (const ClipData& clip : rig.clips) {
            CAPTURE(seed);
            CAPTURE(clip.name);
            const MeshData moved = posed_mesh(shoes, rig.skeleton, first_pose(rig.skeleton, clip));
            std::array<float, 2> soles = {1, 1};
            for (const Vec3& p : moved.positions) {
                float& sole = soles[p.x > 0 ? 0 : 1];
                sole = std::min(sole, p.y);
            }
            CHECK(std::abs(soles[0]) < 0.002f);
            CHECK(std::abs(soles[1]) < 0.002f);
        }
    }
}

TEST_CASE("person: a shirt has buttons on its placket, a tee has not; few triangles have neither") {
    const auto shirt = [](PersonTop top, int triangles) {
        return make_person(
            {.part = PersonPart::Shirt,
             .seed = 6,
             .top = top,
             .legs = PersonLegwear::Trousers,
             .sleeves = PersonSleeves::Long,
             .shirt_color = {0.1f, 0.2f, 0.4f},
             .triangles = triangles});
    };
    /// Vertices in front of the cloth, in the colors of buttons, from hem to collar.
    const auto buttons = [](const MeshData& mesh) {
        int count = 0;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const Vec3& p = mesh.positions[v];
            const bool apart = std::abs(mesh.colors[v].x - mesh.colors[0].x) > 0.05f;
            count += apart && std::abs(p.x) < 0.012f && p.z > 0 ? 1 : 0;
        }
        return count;
    };
    CHECK(buttons(shirt(PersonTop::Shirt, 0)) > 30);
    CHECK(buttons(shirt(PersonTop::Coat, 0)) > 20);
    CHECK(buttons(shirt(PersonTop::Tee, 0)) == 0);
    CHECK(buttons(shirt(PersonTop::Jumper, 0)) == 0);
    CHECK(buttons(shirt(PersonTop::Shirt, 3600)) == 0);
}

TEST_CASE("person: what a shirt has on it lies outside of its cloth, within a centimeter") {
    const PersonShape shape = {
        .part = PersonPart::Shirt,
        .seed = 6,
        .top = PersonTop::Shirt,
        .sleeves = PersonSleeves::Long,
        .shirt_color = {0.1f, 0.2f, 0.4f}};
    const MeshData mesh = make_person(shape);
    // Along the middle in front, from a camera: first the button or the placket, then the cloth.
    int found = 0;
    for (float height = 1.05f; height < 1.38f; height += 0.004f) {
        const float scale = mesh.bounds.max.y / 1.5f;
        std::vector<float> depths;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            std::array<Vec3, 3> p;
            for (std::size_t k = 0; k < 3; ++k) {
                p[k] = mesh.positions[mesh.indices[i + k]];
            }
            const Vec3 n = glm::cross(p[1] - p[0], p[2] - p[0]);
            if (!(n.z > 1e-9f)) {
                continue;
            }
            const Vec2 at(0.004f, height * scale);
            const auto side = [&](std::size_t a, std::size_t b) {
                return (p[b].x - p[a].x) * (at.y - p[a].y) - (p[b].y - p[a].y) * (at.x - p[a].x);
            };
            if (side(0, 1) >= 0 && side(1, 2) >= 0 && side(2, 0) >= 0) {
                depths.push_back(p[0].z - (n.x * (at.x - p[0].x) + n.y * (at.y - p[0].y)) / n.z);
            }
        }
        std::sort(depths.rbegin(), depths.rend());
        REQUIRE(depths.size() >= 2);
        CHECK(depths[0] - depths[1] < 0.010f);
        CHECK(depths[0] - depths[1] > 0.0008f);
        ++found;
    }
    CHECK(found > 60);
}

TEST_CASE("person: 8,000 to 15,000 triangles, whatever the seed and whatever is worn") {
    constexpr int kSeeds = 64;
    // Most cloth over most bare skin, and most hair.
    constexpr std::array<PersonShape, 4> kFull = {{
        {.seed = 23,
         .hair = PersonHair::Long,
         .top = PersonTop::Coat,
         .legs = PersonLegwear::Shorts,
         .sleeves = PersonSleeves::Long},
        {.seed = 133,
         .hair = PersonHair::Long,
         .top = PersonTop::Shirt,
         .legs = PersonLegwear::Shorts,
         .sleeves = PersonSleeves::Short},
        {.seed = 91,
         .hair = PersonHair::Long,
         .top = PersonTop::Shirt,
         .legs = PersonLegwear::Dress,
         .sleeves = PersonSleeves::Short},
        {.seed = 5,
         .years = 5,
         .hair = PersonHair::Long,
         .top = PersonTop::Coat,
         .legs = PersonLegwear::Skirt,
         .sleeves = PersonSleeves::Long},
    }};
    std::array<std::size_t, kSeeds + kFull.size()> triangles{};
    parallel_for(triangles.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const PersonShape shape =
                i < kSeeds ? PersonShape{.seed = static_cast<int>(i)} : kFull[i - kSeeds];
            triangles[i] = make_person(shape).indices.size() / 3;
        }
    });
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        CAPTURE(i);
        CHECK(triangles[i] >= 8000);
        CHECK(triangles[i] <= 15000);
    }
}

TEST_CASE("person: a seed is always the same person, another seed another one") {
    const MeshData first = make_person({.seed = 7});
    const MeshData again = make_person({.seed = 7});
    CHECK(first.positions == again.positions);
    CHECK(first.colors == again.colors);
    CHECK(first.indices == again.indices);
    std::array<float, 8> heights{};
    for (int seed = 0; seed < 8; ++seed) {
        const SkeletonData skeleton = make_person_rig({.seed = seed}).skeleton;
        heights[static_cast<std::size_t>(seed)] = skeleton.rest.translations[0].y;
        for (int other = 0; other < seed; ++other) {
            CHECK(
                heights[static_cast<std::size_t>(other)]
                != heights[static_cast<std::size_t>(seed)]);
        }
    }
    const MeshData other = make_person({.seed = 8});
    CHECK(other.positions != first.positions);
}

/// Vertical extents of the head, from the chin up, and of the legs, from the hip joints down, in
/// heights of the person.
struct Proportions {
    float head = 0;
    float legs = 0;
    float shoulders = 0;
    float hand = 0;
};

Proportions proportions_of(const PersonShape& shape) {
    const MeshData skin = make_person(with_part(shape, PersonPart::Skin));
    const SkeletonData skeleton = make_person_rig(shape).skeleton;
    const auto at = [&](const char* joint) {
        return rest_point(skeleton, static_cast<std::int32_t>(joint_called(skeleton, joint)));
    };
    // The chin is the foremost point of the skin a little above the neck, below the mouth.
    const float height = skin.bounds.max.y;
    const float eyes = at("LeftEye").y;
    const float face = height - eyes;  // as high as the part of a head above its eyes, or less
    float chin = eyes;
    for (const Vec3& p : skin.positions) {
        const bool in_front = std::abs(p.x) < 0.1f * face && p.z > at("LeftEye").z - 0.12f * face;
        chin = in_front && p.y > eyes - 1.4f * face ? std::min(chin, p.y) : chin;
    }
    return {
        (height - chin) / height, at("LeftThigh").y / height,
        (at("LeftUpperArm").x - at("RightUpperArm").x) / height,
        glm::distance(at("LeftHand"), at("LeftMiddle3")) / height};
}

TEST_CASE("person: children have large heads, short legs, narrow shoulders and small hands") {
    const PersonShape base = {.seed = 3, .sex = PersonSex::Woman, .hair = PersonHair::Bald};
    PersonShape child = base;
    Proportions last = {.head = 1};
    for (const float years : {4.0f, 7.0f, 10.0f, 13.0f, 16.0f, 0.0f}) {
        CAPTURE(years);
        child.years = years;
        const Proportions now = proportions_of(child);
        CAPTURE(now.head);
        CHECK(now.head < last.head);
        CHECK(now.legs > last.legs);
        CHECK(now.shoulders > last.shoulders);
        CHECK(now.hand > last.hand);
        if (years == 4) {
            CHECK(1 / now.head == near(5.0).epsilon(0.06));
        } else if (years == 10) {
            CHECK(1 / now.head == near(6.1).epsilon(0.06));
        } else if (years == 0) {
            CHECK(1 / now.head == near(7.5).epsilon(0.06));
        }
        last = now;
    }
}

TEST_CASE("person: a child is as high as its years, or as asked") {
    const float adult =
        make_person({.part = PersonPart::Skin, .seed = 5, .hair = PersonHair::Bald}).bounds.max.y;
    float last = 0;
    for (const float years : {3.0f, 6.0f, 9.0f, 12.0f, 15.0f}) {
        CAPTURE(years);
        const float own =
            make_person(
                {.part = PersonPart::Skin, .seed = 5, .years = years, .hair = PersonHair::Bald})
                .bounds.max.y;
        CHECK(own > last + 0.08f);
        CHECK(own < adult);
        last = own;
    }
    const PersonShape asked = {
        .part = PersonPart::Skin, .seed = 5, .height = 1.3f, .years = 6, .hair = PersonHair::Bald};
    CHECK(make_person(asked).bounds.max.y == near(1.3).epsilon(0.012));
}

}  // namespace limn::person_test
