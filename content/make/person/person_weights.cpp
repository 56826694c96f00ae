#include "content/make/person/person_weights.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.skin-limits

namespace limn {

namespace {

constexpr std::size_t kMaxJointInfluences = 4;
constexpr float kMinJointWeight = 0.01f;

/// Moves weight from where it is to other joints.
class WeightMixer {
  public:
    explicit WeightMixer(int side) : side_(side) { weights.fill(0.0f); }

    void set(std::uint16_t joint, float weight) { weights[joint] = weight; }

    /// Passes the share `s` of the weight of `from` on to `to`.
    void pass(std::uint16_t from, std::uint16_t to, float s) {
        weights[to] += s * weights[from];
        weights[from] *= 1 - s;
    }
    void pass(SideJoint from, SideJoint to, float s) { pass(at(from), at(to), s); }

    [[nodiscard]] std::uint16_t at(SideJoint joint) const { return joint_index(joint, side_); }

    JointWeights weights;

  private:
    int side_;
};

float ramp(float begin, float end, float x) {
    return glm::smoothstep(begin, end, x);
}

void weigh_back(WeightMixer& mixer, float y) {
    const auto index = [](PersonJoint joint) { return joint_index(joint); };
    mixer.set(index(PersonJoint::Hips), 1);
    mixer.pass(index(PersonJoint::Hips), index(PersonJoint::Spine), ramp(0.985f, 1.10f, y));
    mixer.pass(index(PersonJoint::Spine), index(PersonJoint::Chest), ramp(1.10f, 1.21f, y));
    mixer.pass(index(PersonJoint::Chest), index(PersonJoint::UpperChest), ramp(1.20f, 1.32f, y));
}

/// How far `p` (on the left) is in the leg: the border rises from the crotch to the hip bone.
float thigh_share(const Vec3& p) {
    const float out = std::min(std::abs(p.x), 0.16f);
    const float behind = std::clamp(-p.z / 0.12f, 0.0f, 1.0f);
    const float border = 0.815f + 0.72f * out - 0.03f * behind;
    return 1 - ramp(border - 0.075f, border + 0.065f, p.y);
}

void weigh_leg(WeightMixer& mixer, const Vec3& p, bool foot) {
    const float y = p.y;
    mixer.pass(SideJoint::Thigh, SideJoint::ThighTwist, ramp(0.66f, 0.84f, y));
    mixer.pass(SideJoint::Thigh, SideJoint::Shin, 1 - ramp(0.44f, 0.55f, y));
    if (foot) {
        mixer.pass(SideJoint::Shin, SideJoint::Foot, 1 - ramp(0.06f, 0.115f, y));
    }
}

/// `along` the arm from the shoulder.
void weigh_arm(WeightMixer& mixer, const PersonFrame& frame, float along) {
    const float elbow = frame.upper_arm_length;
    const float wrist = elbow + frame.forearm_length;
    mixer.pass(SideJoint::UpperArm, SideJoint::UpperArmTwist, 1 - ramp(0.11f, 0.25f, along));
    mixer.pass(
        SideJoint::UpperArm, SideJoint::Forearm, ramp(elbow - 0.048f, elbow + 0.048f, along));
    mixer.pass(
        SideJoint::Forearm, SideJoint::ForearmTwist, ramp(elbow + 0.07f, wrist - 0.03f, along));
    const float hand = ramp(wrist - 0.026f, wrist + 0.022f, along);
    mixer.pass(SideJoint::Forearm, SideJoint::Hand, hand);
    mixer.pass(SideJoint::ForearmTwist, SideJoint::Hand, hand);
}

/// Trunk, hips and shoulders.
JointWeights weigh_trunk(const PersonFrame& frame, const BodyVertex& vertex) {
    const Vec3 p = vertex.position * Vec3(vertex.position.x < 0 ? -1 : 1, 1, 1);
    WeightMixer left(1);
    weigh_back(left, p.y);
    // Shoulders
    const Vec3 from = p - frame.at(SideJoint::UpperArm);
    const float out = glm::dot(from, glm::normalize(Vec3(0.9f, -0.42f, 0)));
    const float arm = ramp(-0.035f, 0.085f, out) * ramp(1.25f, 1.36f, p.y);
    const float collar = (1 - arm) * ramp(0.05f, 0.15f, p.x) * ramp(1.30f, 1.42f, p.y);
    const std::uint16_t chest = joint_index(PersonJoint::UpperChest);
    const float upper = left.weights[chest];
    left.weights[chest] = upper * (1 - 0.75f * collar) * (1 - arm);
    const float collar_weight = 0.75f * upper * collar * (1 - arm);
    const float arm_weight = upper * arm;
    const int side = vertex.position.x < 0 ? -1 : 1;
    WeightMixer mixer(side);
    mixer.weights = left.weights;
    mixer.weights[mixer.at(SideJoint::Shoulder)] += collar_weight;
    mixer.weights[mixer.at(SideJoint::UpperArm)] += arm_weight;
    mixer.pass(SideJoint::UpperArm, SideJoint::UpperArmTwist, 1);
    // Thighs
    const float most = vertex.zone == BodyZone::Skirt ? 0.85f : 1.0f;
    const float share = most * thigh_share(p);
    const float middle = vertex.zone == BodyZone::Skirt ? 0.1f : 0.025f;
    const float own = ramp(-middle, middle, p.x);
    const std::uint16_t hips = joint_index(PersonJoint::Hips);
    JointWeights result = mixer.weights;
    const float moved = share * result[hips];
    result[hips] -= moved;
    for (const int leg_side : {side, -side}) {
        WeightMixer leg(leg_side);
        leg.set(leg.at(SideJoint::Thigh), moved * (leg_side == side ? own : 1 - own));
        weigh_leg(leg, p, false);
        for (std::size_t j = 0; j < kPersonJoints; ++j) {
            result[j] += leg.weights[j];
        }
    }
    return result;
}

JointWeights weigh_hand(const PersonFrame& frame, const BodyVertex& vertex) {
    WeightMixer mixer(vertex.side);
    if (vertex.zone == BodyZone::Palm) {
        mixer.set(mixer.at(SideJoint::UpperArm), 1);
        weigh_arm(mixer, frame, vertex.along);
        return mixer.weights;
    }
    const std::array<float, 3> lengths = finger_lengths(vertex.finger);
    const auto bone = [&](int k) { return finger_joint(vertex.finger, k); };
    const float at = vertex.along;
    const bool thumb = vertex.finger == 0;
    mixer.set(mixer.at(SideJoint::Hand), 1);
    mixer.pass(
        SideJoint::Hand, bone(0), thumb ? ramp(-0.005f, 0.03f, at) : ramp(-0.012f, 0.024f, at));
    mixer.pass(bone(0), bone(1), ramp(lengths[0] - 0.006f, lengths[0] + 0.006f, at));
    const float second = lengths[0] + lengths[1];
    mixer.pass(bone(1), bone(2), ramp(second - 0.005f, second + 0.005f, at));
    return mixer.weights;
}

JointWeights weights_of(const PersonFrame& frame, const BodyVertex& vertex) {
    WeightMixer mixer(vertex.side);
    switch (vertex.zone) {
    case BodyZone::Trunk:
    case BodyZone::Skirt:
        return weigh_trunk(frame, vertex);
    case BodyZone::Leg:
    case BodyZone::Calf:
        if (vertex.position.y > 0.62f) {
            return weigh_trunk(frame, vertex);
        }
        mixer.set(mixer.at(SideJoint::Thigh), 1);
        weigh_leg(mixer, vertex.position, vertex.zone == BodyZone::Calf);
        return mixer.weights;
    case BodyZone::Arm:
        mixer.set(mixer.at(SideJoint::UpperArm), 1);
        weigh_arm(mixer, frame, vertex.along);
        return mixer.weights;
    case BodyZone::Palm:
    case BodyZone::Finger:
        return weigh_hand(frame, vertex);
    case BodyZone::Shoe: {
        const float z = vertex.position.z;
        mixer.set(mixer.at(SideJoint::Foot), 1);
        mixer.pass(SideJoint::Foot, SideJoint::Toes, ramp(0.075f, 0.125f, z));
        mixer.pass(
            SideJoint::Foot, SideJoint::Shin, 0.6f * ramp(0.095f, 0.135f, vertex.position.y));
        return mixer.weights;
    }
    case BodyZone::Eye:
        mixer.set(joint_index(vertex.side > 0 ? PersonJoint::LeftEye : PersonJoint::RightEye), 1);
        return mixer.weights;
    case BodyZone::Head:
        return head_weights_at(frame, vertex.position);
    }
    return mixer.weights;
}

bool is_smoothed(BodyZone zone) {
    return zone == BodyZone::Trunk || zone == BodyZone::Arm || zone == BodyZone::Palm;
}

/// Means over neighbors, where arms meet the trunk and fingers the palm.
void smooth_weights(const BodyMesh& mesh, std::vector<JointWeights>& weights) {
    constexpr int kRounds = 3;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<JointWeights> sums = weights;
        std::vector<float> counts(weights.size(), 1.0f);
        for (const BodyQuad& quad : mesh.quads) {
            for (int k = 0; k < 4; ++k) {
                const std::uint32_t a = quad.corners[k];
                const std::uint32_t b = quad.corners[(k + 1) % 4];
                for (const auto& [to, from] : {std::pair(a, b), std::pair(b, a)}) {
                    if (to != from && is_smoothed(mesh.vertices[to].zone)) {
                        for (std::size_t j = 0; j < kPersonJoints; ++j) {
                            sums[to][j] += weights[from][j];
                        }
                        counts[to] += 1.0f;
                    }
                }
            }
        }
        for (std::size_t v = 0; v < weights.size(); ++v) {
            for (std::size_t j = 0; j < kPersonJoints; ++j) {
                weights[v][j] = sums[v][j] / counts[v];
            }
        }
    }
}

}  // namespace

JointWeights head_weights_at(const PersonFrame& frame, const Vec3& p) {
    WeightMixer mixer(1);
    const Vec3 q = (p - frame.head_origin) / frame.head_scale;
    const float height = q.y + 0.45f * q.z;  // the jaw is lower in front
    const auto index = [](PersonJoint joint) { return joint_index(joint); };
    mixer.set(index(PersonJoint::UpperChest), 1);
    mixer.pass(
        index(PersonJoint::UpperChest), index(PersonJoint::Neck), ramp(-0.18f, -0.125f, height));
    mixer.pass(index(PersonJoint::Neck), index(PersonJoint::Head), ramp(-0.115f, -0.055f, height));
    return mixer.weights;
}

std::vector<JointWeights> person_weights(const PersonFrame& frame, const BodyMesh& mesh) {
    std::vector<JointWeights> weights;
    weights.reserve(mesh.vertices.size());
    for (const BodyVertex& vertex : mesh.vertices) {
        weights.push_back(weights_of(frame, vertex));
    }
    smooth_weights(mesh, weights);
    return weights;
}

void append_weights(SkinWeights& skin, const JointWeights& weights) {
    std::array<std::uint16_t, kPersonJoints> order{};
    for (std::uint16_t i = 0; i < kPersonJoints; ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
        return weights[a] > weights[b];
    });
    std::size_t kept = 1;
    while (kept < kMaxJointInfluences && weights[order[kept]] > kMinJointWeight) {
        ++kept;
    }
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept));
    float sum = 0;
    for (std::size_t i = 0; i < kept; ++i) {
        sum += weights[order[i]];
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    for (std::size_t i = 0; i < kept; ++i) {
        skin.joints.push_back(order[i]);
        skin.weights.push_back(weights[order[i]] / sum);
    }
}

}  // namespace limn
