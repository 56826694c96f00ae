#include "content/make/person/person_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr float kSkinColumn = 0.012f;  ///< width of a column around an arm in texture space [m]
constexpr int kFingerColumns = 8;

float arm_angle(int column) {
    return 2 * kPi * static_cast<float>(column) / kArmColumns;
}

/// Thicker hands for men.
float hand_size(const PersonFrame& frame) {
    return glm::mix(0.90f, 1.0f, frame.man) * (1 + 0.04f * frame.build);
}

Vec3 nail_color(const Vec3& skin) {
    return glm::mix(skin, Vec3(0.78f, 0.52f, 0.46f), 0.22f);
}
/// Palms have little melanin.
Vec3 palm_color(const Vec3& skin) {
    return glm::mix(skin, Vec3(0.66f, 0.40f, 0.31f), 0.35f);
}

/// A section of the palm: half widths toward the thumb and the back, at a distance from the wrist.
struct PalmSection {
    float at;
    float wide;
    float thick;
    float shift;  ///< of its center toward the thumb
};
constexpr std::array<PalmSection, 6> kPalm = {{
    {0.012f, 0.0300f, 0.0190f, 0.0000f},
    {0.026f, 0.0335f, 0.0180f, 0.0010f},
    {0.042f, 0.0365f, 0.0165f, 0.0010f},
    {0.058f, 0.0385f, 0.0150f, 0.0005f},
    {0.074f, 0.0400f, 0.0138f, 0.0002f},
    {0.089f, 0.0408f, 0.0125f, 0.0000f},
}};
constexpr int kThumbTop = 1;  ///< rings of the palm between which the thumb leaves it
constexpr int kThumbBottom = 3;

BodyRing add_arm_ring(BodyMesh& mesh, const PersonFrame& frame, float along) {
    BodyRing ring;
    ring.v = along;
    const Vec2 radii = arm_radii(frame, along);
    for (int j = 0; j < kArmColumns; ++j) {
        BodyVertex vertex;
        vertex.position = arm_point(frame, along, arm_angle(j), radii);
        vertex.color = frame.look.skin_color;
        vertex.zone = BodyZone::Arm;
        vertex.along = along;
        ring.vertices.push_back(mesh.add(vertex));
    }
    return ring;
}

class HandBuilder {
  public:
    HandBuilder(BodyMesh& mesh, const PersonFrame& frame)
        : mesh_(mesh), frame_(frame), size_(hand_size(frame)),
          reach_(frame.upper_arm_length + frame.forearm_length) {}

    /// Continues the arm from its last ring.
    void add(const BodyRing& wrist) {
        std::vector<BodyRing> palm = {wrist};
        for (const PalmSection& section : kPalm) {
            palm.push_back(add_palm_ring(section));
        }
        const int top = kThumbTop + 1;  // after the wrist
        const int bottom = kThumbBottom + 1;
        for (int r = 0; r + 1 < static_cast<int>(palm.size()); ++r) {
            join_palm(palm[r], palm[r + 1], r >= top && r < bottom);
        }
        add_fingers(palm.back());
        add_thumb(palm[top], palm[top + 1], palm[bottom]);
    }

  private:
    [[nodiscard]] Vec3 point(float along, float thumb, float back) const {
        const LimbAxes& hand = frame_.hand;
        return frame_.at(SideJoint::Hand) + along * hand.along + thumb * hand.thumb
               + back * hand.back;
    }

    [[nodiscard]] Vec3 tone(float back) const {
        return glm::mix(
            frame_.look.skin_color, palm_color(frame_.look.skin_color),
            glm::smoothstep(0.2f, -0.6f, back));
    }

    BodyRing add_palm_ring(const PalmSection& section) {
        BodyRing ring;
        ring.v = reach_ + section.at;
        for (int j = 0; j < kArmColumns; ++j) {
            const float angle = arm_angle(j);
            const float c =
                std::copysign(std::pow(std::abs(std::cos(angle)), 0.8f), std::cos(angle));
            const float s =
                std::copysign(std::pow(std::abs(std::sin(angle)), 0.8f), std::sin(angle));
            // The hollow of the palm between the balls of thumb and little finger.
            const float hollow = s < 0 ? 0.0035f * std::exp(-square(c / 0.35f)) : 0.0f;
            const float ball =
                s < 0 && c > 0 ? 0.005f * std::exp(-square((section.at - 0.03f) / 0.025f)) : 0.0f;
            BodyVertex vertex;
            vertex.position = point(
                section.at, size_ * (section.shift + section.wide * c),
                size_ * (section.thick * s + 0.003f * (1 - c * c)) + hollow + ball * s);
            vertex.color = tone(s);
            vertex.zone = BodyZone::Palm;
            vertex.along = reach_ + section.at;
            vertex.fair = (j > 15 || j < 4) && section.at > 0.02f && section.at < 0.07f;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    /// Without the two columns of the thumb.
    void join_palm(const BodyRing& a, const BodyRing& b, bool hole) {
        for (int j = 0; j < kArmColumns; ++j) {
            if (hole && j >= kArmColumns - 2) {
                continue;
            }
            const int next = (j + 1) % kArmColumns;
            const float u = kSkinColumn * static_cast<float>(j);
            mesh_.add_quad(
                {a.vertices[j], b.vertices[j], b.vertices[next], a.vertices[next]},
                {Vec2(u, a.v), Vec2(u, b.v), Vec2(u + kSkinColumn, b.v),
                 Vec2(u + kSkinColumn, a.v)});
        }
    }

    struct FingerPlace {
        Vec3 center = {};
        Vec3 along = {};
        Vec3 thumb = {};
        Vec3 back = {};
    };

    [[nodiscard]] Vec3 bone(int finger, int k) const { return frame_.at(finger_joint(finger, k)); }

    /// On the axis of a finger, `at` from its first joint.
    [[nodiscard]] FingerPlace finger_place(int finger, float at) const {
        const std::array<float, 3> lengths = finger_lengths(finger);
        const Vec3 first = glm::normalize(bone(finger, 1) - bone(finger, 0));
        const Vec3 second = glm::normalize(bone(finger, 2) - bone(finger, 1));
        Vec3 third = second + (second - first);  // bends on
        if (finger > 0) {
            third = glm::normalize(second + 0.3f * (second - first));
        }
        third = glm::normalize(third);
        FingerPlace place;
        const float two = lengths[0] + lengths[1];
        if (at < lengths[0]) {
            place.center = bone(finger, 0) + at * first;
        } else if (at < two) {
            place.center = bone(finger, 1) + (at - lengths[0]) * second;
        } else {
            place.center = bone(finger, 2) + (at - two) * third;
        }
        const float s1 = glm::smoothstep(lengths[0] - 0.008f, lengths[0] + 0.008f, at);
        const float s2 = glm::smoothstep(two - 0.006f, two + 0.006f, at);
        place.along = glm::normalize(glm::mix(glm::mix(first, second, s1), third, s2));
        const LimbAxes& hand = frame_.hand;
        const Vec3 up =
            finger == 0 ? 0.62f * hand.back + 0.62f * hand.thumb - 0.35f * hand.along : hand.back;
        place.back = glm::normalize(up - glm::dot(up, place.along) * place.along);
        place.thumb = glm::cross(place.along, place.back);
        return place;
    }

    [[nodiscard]] float finger_radius(int finger, float at) const {
        constexpr std::array<float, 5> kThick = {0.0112f, 0.0087f, 0.0090f, 0.0085f, 0.0074f};
        const std::array<float, 3> lengths = finger_lengths(finger);
        const float two = lengths[0] + lengths[1];
        const float length = two + lengths[2];
        const float t = at / length;
        const float knuckles = 0.05f * std::exp(-square((at - lengths[0]) / 0.006f))
                               + 0.05f * std::exp(-square((at - two) / 0.005f));
        const float waist = finger == 0 ? 0.06f * std::exp(-square((at - 0.058f) / 0.01f)) : 0.0f;
        const float root = finger == 0 ? 0.36f * glm::smoothstep(0.046f, 0.016f, at) : 0.0f;
        const float tip = std::min((length - at) / (1.15f * kThick[finger]), 1.0f);
        const float round = std::sqrt(std::max(1 - square(1 - tip), 0.0f));
        return size_ * kThick[finger] * (1.06f - 0.22f * t + knuckles - waist + root) * round;
    }

    BodyRing add_finger_ring(int finger, float at, float first_angle, float turn) {
        const FingerPlace place = finger_place(finger, at);
        const float radius = finger_radius(finger, at);
        const std::array<float, 3> lengths = finger_lengths(finger);
        const float two = lengths[0] + lengths[1];
        const bool nail = at > two + 0.35f * lengths[2];
        BodyRing ring;
        ring.v = reach_ + 0.09f + at;
        for (int i = 0; i < kFingerColumns; ++i) {
            const float angle =
                first_angle + turn * 2 * kPi * static_cast<float>(i) / kFingerColumns;
            const float c = std::cos(angle);
            const float s = std::sin(angle);
            const float flat = s > 0 && at > two ? 0.8f : 0.93f;
            BodyVertex vertex;
            vertex.position = place.center + radius * (c * place.thumb + flat * s * place.back);
            vertex.color = nail && s > 0.6f ? nail_color(frame_.look.skin_color) : tone(s);
            vertex.zone = BodyZone::Finger;
            vertex.finger = static_cast<std::int8_t>(finger);
            vertex.along = at;
            vertex.fair = finger == 0 && at < 0.03f;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    /// From `base` to the tip.
    void add_finger_tube(
        int finger, BodyRing base, std::span<const float> places, float first_angle, float turn) {
        for (const float at : places) {
            const BodyRing next = add_finger_ring(finger, at, first_angle, turn);
            mesh_.join(base, next, 0.007f);
            base = next;
        }
        const std::array<float, 3> lengths = finger_lengths(finger);
        const float length = lengths[0] + lengths[1] + lengths[2];
        const FingerPlace place = finger_place(finger, length);
        const Vec3 tip = place.center - 0.0012f * place.back;
        Vec3 mean(0);
        for (const std::uint32_t v : base.vertices) {
            mean += mesh_.vertices[v].position / static_cast<float>(kFingerColumns);
        }
        mesh_.cap(base, tip - mean, 0.007f, true);
    }

    std::uint32_t add_web(const Vec3& p, int finger, float along, float back) {
        BodyVertex vertex;
        vertex.position = p;
        vertex.color = tone(back);
        vertex.zone = BodyZone::Finger;
        vertex.finger = static_cast<std::int8_t>(finger);
        vertex.along = along;
        vertex.fair = true;
        return mesh_.add(vertex);
    }

    /// The ring where the palm ends is divided among four fingers: nine vertices on the back, nine
    /// on the palm, one on each side and one in each gap.
    void add_fingers(const BodyRing& knuckles) {
        constexpr float kWeb = 0.5f;  // of the first bone
        std::array<FingerPlace, 4> places;
        std::array<float, 4> radii{};
        std::array<float, 4> at{};
        for (int k = 0; k < 4; ++k) {
            at[k] = kWeb * finger_lengths(k + 1)[0];
            places[k] = finger_place(k + 1, at[k]);
            radii[k] = finger_radius(k + 1, at[k]);
        }
        std::array<std::uint32_t, 9> back{};
        std::array<std::uint32_t, 9> front{};
        std::array<std::uint32_t, 5> sides{};
        for (int m = 0; m < 9; ++m) {
            const int k = std::min(m / 2, 3);
            if (m % 2 == 1) {
                const Vec3 up = 0.93f * radii[k] * places[k].back;
                back[m] = add_web(places[k].center + up, k + 1, at[k], 1);
                front[m] = add_web(places[k].center - 1.08f * up, k + 1, at[k], -1);
                continue;
            }
            const bool ends = m == 0 || m == 8;
            const int other = std::max(m / 2 - 1, 0);
            const Vec3 middle =
                ends ? places[k].center + (m == 0 ? 0.74f : -0.74f) * radii[k] * places[k].thumb
                     : 0.5f * (places[k].center + places[other].center);
            const Vec3 up = (ends ? 0.70f : 0.55f) * radii[k] * places[k].back;
            const Vec3 in = ends ? Vec3(0) : -0.004f * frame_.hand.along;
            back[m] = add_web(middle + up + in, k + 1, at[k], 0.7f);
            front[m] = add_web(middle - 1.1f * up - in, k + 1, at[k], -0.7f);
        }
        for (int m = 0; m < 5; ++m) {
            const int k = std::min(m, 3);
            const Vec3 p = m == 0   ? places[0].center + 1.02f * radii[0] * places[0].thumb
                           : m == 4 ? places[3].center - 1.02f * radii[3] * places[3].thumb
                                    : 0.5f * (places[m].center + places[m - 1].center)
                                          + 0.002f * frame_.hand.along;
            sides[m] = add_web(p, k + 1, at[k], 0);
        }
        BodyRing edge;
        edge.v = knuckles.v + 0.02f;
        edge.vertices = {sides[0]};
        edge.vertices.insert(edge.vertices.end(), back.begin(), back.end());
        edge.vertices.push_back(sides[4]);
        edge.vertices.insert(edge.vertices.end(), front.rbegin(), front.rend());
        mesh_.join(knuckles, edge, kSkinColumn);
        for (int k = 0; k < 4; ++k) {
            BodyRing base;
            base.v = edge.v;
            base.vertices = {sides[k],     back[2 * k],      back[2 * k + 1],  back[2 * k + 2],
                             sides[k + 1], front[2 * k + 2], front[2 * k + 1], front[2 * k]};
            const std::array<float, 3> l = finger_lengths(k + 1);
            const float two = l[0] + l[1];
            const std::array<float, 9> rings = {
                0.68f * l[0],        l[0] - 0.006f,      l[0] + 0.004f,
                l[0] + 0.55f * l[1], two - 0.004f,       two + 0.004f,
                two + 0.55f * l[2],  two + 0.82f * l[2], two + 0.95f * l[2]};
            add_finger_tube(k + 1, base, rings, 0, 1);
        }
    }

    /// Leaves the palm through a hole of two columns by two rows.
    void add_thumb(const BodyRing& top, const BodyRing& middle, const BodyRing& bottom) {
        const int a = kArmColumns - 2;
        const int b = kArmColumns - 1;
        BodyRing hole;
        hole.v = reach_ + 0.03f;
        // The same turn as the tubes: from the thumb's side over the back, seen along the arm.
        hole.vertices = {top.vertices[a],    top.vertices[b],    top.vertices[0],
                         middle.vertices[0], bottom.vertices[0], bottom.vertices[b],
                         bottom.vertices[a], middle.vertices[a]};
        const std::array<float, 3> l = finger_lengths(0);
        const float two = l[0] + l[1];
        const FingerPlace base = finger_place(0, 0.024f);
        // The columns of the thumb begin where the hole's vertices are, seen along the thumb.
        float sine = 0;
        float cosine = 0;
        float turn = 0;
        std::array<float, kFingerColumns> angles{};
        for (int i = 0; i < kFingerColumns; ++i) {
            const Vec3 d = mesh_.vertices[hole.vertices[i]].position - base.center;
            angles[i] = std::atan2(glm::dot(d, base.back), glm::dot(d, base.thumb));
        }
        for (int i = 0; i < kFingerColumns; ++i) {
            const float step = angles[(i + 1) % kFingerColumns] - angles[i];
            turn += std::sin(step);
        }
        turn = turn > 0 ? 1.0f : -1.0f;
        for (int i = 0; i < kFingerColumns; ++i) {
            const float rest = angles[i] - turn * 2 * kPi * static_cast<float>(i) / kFingerColumns;
            sine += std::sin(rest);
            cosine += std::cos(rest);
        }
        const std::array<float, 10> rings = {
            0.025f,       0.036f,       l[0] - 0.002f,      l[0] + 0.006f,      l[0] + 0.5f * l[1],
            two - 0.003f, two + 0.005f, two + 0.45f * l[2], two + 0.72f * l[2], two + 0.93f * l[2]};
        add_finger_tube(0, hole, rings, std::atan2(sine, cosine), turn);
    }

    BodyMesh& mesh_;
    const PersonFrame& frame_;
    float size_;
    float reach_;
};

}  // namespace

void add_arm(BodyMesh& mesh, const PersonFrame& frame, float start) {
    const float elbow = frame.upper_arm_length;
    const float wrist = elbow + frame.forearm_length;
    std::vector<float> rings;
    for (const float along :
         {start, 0.16f, 0.19f, 0.22f, 0.25f, elbow - 0.02f, elbow - 0.006f, elbow + 0.008f,
          elbow + 0.022f, elbow + 0.04f, elbow + 0.065f, elbow + 0.095f, elbow + 0.13f,
          elbow + 0.165f, elbow + 0.20f, wrist - 0.03f, wrist - 0.015f, wrist}) {
        if (along >= start && (rings.empty() || along > rings.back() + 0.004f)) {
            rings.push_back(along);
        }
    }
    BodyRing last = add_arm_ring(mesh, frame, rings.front());
    const ArmPlace place = arm_place(frame, start);
    mesh.cap(last, -0.01f * place.axes.along, kSkinColumn, false);
    for (std::size_t i = 1; i < rings.size(); ++i) {
        const BodyRing next = add_arm_ring(mesh, frame, rings[i]);
        mesh.join(last, next, kSkinColumn);
        last = next;
    }
    HandBuilder(mesh, frame).add(last);
}

void add_leg(BodyMesh& mesh, const PersonFrame& frame, float top) {
    constexpr int kColumns = 20;
    constexpr float kBottom = 0.045f;
    std::vector<float> heights;
    for (const float height :
         {top,   0.66f,  0.62f,  0.58f, 0.55f, 0.53f, 0.515f, 0.50f, 0.485f, 0.465f, 0.44f,
          0.41f, 0.375f, 0.335f, 0.29f, 0.24f, 0.19f, 0.145f, 0.11f, 0.08f,  kBottom}) {
        if (height <= top && (heights.empty() || height < heights.back() - 0.01f)) {
            heights.push_back(height);
        }
    }
    BodyRing last;
    for (const float height : heights) {
        BodyRing ring;
        ring.v = -height;
        const BodySection section = leg_section(frame, height);
        for (int j = 0; j < kColumns; ++j) {
            const float angle = 2 * kPi * static_cast<float>(j) / kColumns;
            const float knee =
                std::exp(-square((height - 0.5f) / 0.022f)) * std::max(std::cos(angle), 0.0f);
            BodyVertex vertex;
            vertex.position = leg_point(section, frame, height, angle);
            vertex.color = glm::mix(frame.look.skin_color, 0.86f * frame.look.skin_color, knee);
            vertex.zone = BodyZone::Calf;
            ring.vertices.push_back(mesh.add(vertex));
        }
        if (last.vertices.empty()) {
            mesh.cap(ring, Vec3(0, 0.01f, 0), 0.02f, false);
        } else {
            mesh.join(last, ring, 0.02f);
        }
        last = ring;
    }
    mesh.cap(last, Vec3(0, -0.008f, 0), 0.02f, true);
}

}  // namespace limn
