#include "content/make/person/person_bends.h"

#include "content/make/person/person_skeleton.h"
#include "ecs/base/rotation.h"
#include "ecs/components/bend_shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

// Techniques: char.skin-defects

namespace limn {

namespace {

constexpr float kMinShift = 1e-4f;  ///< of a vertex that a shape moves [m]
constexpr float kMaxShift = 0.12f;  ///< far from a hip, skin is held by what is around it [m]
constexpr float kMaxArmpitShift = 0.27f;
/// Armpits are between arm and chest, and a raised arm turns by half as much again against the
/// chest as against its collar bone, which rises with it. So much more is lacking, by measurement.
constexpr float kArmpitGain = 1.95f;

struct BendHinge {
    std::uint16_t joint = 0;
    std::string suffix = {};  ///< of the shape's name
    Vec3 center = {};
    Vec3 axis = {};        ///< bends by positive angles
    Vec3 inward = {};      ///< from the joint to the inside of the bend
    bool creased = false;  ///< the inside is no limb that folds onto a limb
};

Vec3 rest_center(const SkeletonData& skeleton, std::int32_t joint) {
    Vec3 p(0);
    for (; joint >= 0; joint = skeleton.parents[static_cast<std::size_t>(joint)]) {
        p += skeleton.rest.translations[static_cast<std::size_t>(joint)];
    }
    return p;
}

/// `axis`: index among the joint's axes of freedom.
BendHinge
find_hinge(const SkeletonData& skeleton, std::uint16_t joint, std::uint16_t end, int axis) {
    BendHinge hinge = {.joint = joint, .center = rest_center(skeleton, joint)};
    int index = 0;
    for (const JointFreedom& freedom : skeleton.freedoms) {
        if (freedom.joint == joint && index++ == axis) {
            hinge.axis = freedom.max >= -freedom.min ? freedom.axis : -freedom.axis;
        }
    }
    if (axis > 0) {
        hinge.suffix = " axis " + std::to_string(axis + 1);
        hinge.creased = true;
    }
    hinge.inward = glm::normalize(glm::cross(hinge.axis, skeleton.rest.translations[end]));
    return hinge;
}

/// Which joints move with `joint`: itself and all below.
std::vector<bool> list_carried(const SkeletonData& skeleton, std::uint16_t joint) {
    std::vector<bool> carried(skeleton.joints.size(), false);
    carried[joint] = true;
    for (std::size_t i = joint + 1u; i < carried.size(); ++i) {
        carried[i] =
            skeleton.parents[i] >= 0 && carried[static_cast<std::size_t>(skeleton.parents[i])];
    }
    return carried;
}

/// How far `p` has to be moved at rest to be where it belongs when the hinge is bent by kFullBend
/// and carries it by `share`.
Vec3 bend_shift(const BendHinge& hinge, const Vec3& p, float share) {
    const Vec3 from = p - hinge.center;
    const Quat whole = rotation_about(hinge.axis, kFullBend);
    const Mat3 blend = (1 - share) * Mat3(1) + share * glm::mat3_cast(whole);
    const Vec3 wanted = rotation_about(hinge.axis, share * kFullBend) * from;
    const float across = glm::length(from - glm::dot(from, hinge.axis) * hinge.axis);
    const float inside = glm::dot(from, hinge.inward) / std::max(across, 1e-4f);
    const float outside = 1 - glm::smoothstep(-0.2f, 0.7f, inside);
    const float more = hinge.creased ? kArmpitGain : 1.0f;
    const Vec3 shift = more * outside * (glm::inverse(blend) * (wanted - blend * from));
    const float length = glm::length(shift);
    const float most = hinge.creased ? kMaxArmpitShift : kMaxShift;
    return length > 0 ? most * std::tanh(length / most) / length * shift : shift;
}

/// Vertices at one place, each with all that share an edge with any of them.
struct WeldedMesh {
    std::vector<std::uint32_t> place;                   ///< of each vertex
    std::vector<std::vector<std::uint32_t>> neighbors;  ///< places around each place
};

WeldedMesh weld(const MeshData& mesh) {
    WeldedMesh welded;
    std::map<std::array<float, 3>, std::uint32_t> places;
    for (const Vec3& p : mesh.positions) {
        const auto next = static_cast<std::uint32_t>(places.size());
        welded.place.push_back(places.try_emplace({p.x, p.y, p.z}, next).first->second);
    }
    welded.neighbors.resize(places.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = welded.place[mesh.indices[i + k]];
            const std::uint32_t b = welded.place[mesh.indices[i + (k + 1) % 3]];
            welded.neighbors[a].push_back(b);
        }
    }
    return welded;
}

float carried_share(const MeshData& mesh, const std::vector<bool>& carried, std::uint32_t v) {
    float share = 0;
    for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
        share += carried[mesh.skin.joints[i]] ? mesh.skin.weights[i] : 0.0f;
    }
    return share;
}

/// Rounds the crease on the inside of a bend: the mean of the neighbors there, some times over,
/// when the hinge is bent by kFullBend. Adds to `shifts`, one for each vertex.
void relax_crease(
    const MeshData& mesh, const std::vector<bool>& carried, const BendHinge& hinge,
    std::vector<Vec3>& shifts) {
    constexpr int kRounds = 12;
    const Mat3 whole = glm::mat3_cast(rotation_about(hinge.axis, kFullBend));
    const WeldedMesh welded = weld(mesh);
    std::vector<Vec3> bent(welded.neighbors.size());
    std::vector<float> mobile(welded.neighbors.size());
    std::vector<Mat3> blends(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const float share = carried_share(mesh, carried, v);
        const Vec3 from = mesh.positions[v] - hinge.center;
        const float inside = glm::dot(from, hinge.inward) / std::max(glm::length(from), 1e-4f);
        blends[v] = (1 - share) * Mat3(1) + share * whole;
        bent[welded.place[v]] = blends[v] * (from + shifts[v]);
        mobile[welded.place[v]] =
            glm::smoothstep(-0.1f, 0.4f, inside) * std::min(8 * share * (1 - share), 1.0f);
    }
    const std::vector<Vec3> before = bent;
    for (int round = 0; round < kRounds; ++round) {
        const std::vector<Vec3> last = bent;
        for (std::size_t p = 0; p < last.size(); ++p) {
            Vec3 sum(0);
            for (const std::uint32_t n : welded.neighbors[p]) {
                sum += last[n];
            }
            if (mobile[p] > 0 && !welded.neighbors[p].empty()) {
                const Vec3 mean = sum / static_cast<float>(welded.neighbors[p].size());
                bent[p] = glm::mix(last[p], mean, 0.6f * mobile[p]);
            }
        }
    }
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        const std::uint32_t p = welded.place[v];
        if (mobile[p] > 0) {
            shifts[v] += glm::inverse(blends[v]) * (bent[p] - before[p]);
        }
    }
}

MorphTarget
make_bend_shape(const MeshData& mesh, const SkeletonData& skeleton, const BendHinge& hinge) {
    MorphTarget shape;
    shape.name = std::string(kBendShapePrefix) + skeleton.joints[hinge.joint] + hinge.suffix;
    const std::vector<bool> carried = list_carried(skeleton, hinge.joint);
    std::vector<Vec3> shifts;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        shifts.push_back(bend_shift(hinge, mesh.positions[v], carried_share(mesh, carried, v)));
    }
    if (hinge.creased) {
        relax_crease(mesh, carried, hinge, shifts);
    }
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (glm::length(shifts[v]) > kMinShift) {
            shape.vertices.push_back(v);
            shape.positions.push_back(shifts[v]);
        }
    }
    return shape;
}

}  // namespace

void add_bend_shapes(MeshData& mesh, const SkeletonData& skeleton) {
    struct Bone {
        SideJoint joint;
        SideJoint end;
        int axis;
    };
    constexpr std::array<Bone, 4> kBones = {{
        {SideJoint::Forearm, SideJoint::Hand, 0},
        {SideJoint::Shin, SideJoint::Foot, 0},
        {SideJoint::Thigh, SideJoint::Shin, 0},
        {SideJoint::UpperArm, SideJoint::Forearm, 1},
    }};
    for (const Bone& bone : kBones) {
        for (const int side : {1, -1}) {
            const BendHinge hinge = find_hinge(
                skeleton, joint_index(bone.joint, side), joint_index(bone.end, side), bone.axis);
            mesh.morphs.push_back(make_bend_shape(mesh, skeleton, hinge));
        }
    }
}

}  // namespace limn
