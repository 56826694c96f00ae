#include "content/make/models/body_part.h"

#include "content/bake/tangents.h"
#include "content/make/models/even_triangles.h"
#include "content/make/models/implicit_mesh.h"
#include "content/make/models/implicit_model.h"
#include "content/make/models/loft.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

// Techniques: wrinkle.furrow.presets

namespace limn {

namespace {

using Parts = std::vector<ModelPart>;

ModelPart cone(const Vec3& a, const Vec3& b, float radius_a, float radius_b, float blend) {
    return {.blend = blend, .a = a, .b = b, .radius_a = radius_a, .radius_b = radius_b};
}
ModelPart ball(const Vec3& center, const Vec3& radii, float blend) {
    return {.shape = PartShape::Ellipsoid, .blend = blend, .a = center, .b = radii};
}
ModelPart hollow(const Vec3& center, const Vec3& radii, float blend) {
    return {
        .shape = PartShape::Ellipsoid,
        .use = PartUse::Cut,
        .blend = blend,
        .a = center,
        .b = radii};
}
ModelPart half_space(PartShape shape, PartUse use, const Vec3& a, float blend) {
    return {.shape = shape, .use = use, .blend = blend, .a = a};
}

/// The bones of a finger or a toe in a plane, from its knuckle [cm].
struct Digit {
    Vec3 root;
    Vec3 direction;  ///< unit
    Vec3 back;       ///< where its nail faces, unit
    std::array<float, 3> bones;
    std::array<float, 3> bends;  ///< of each bone, to the other side [rad]
    float size;                  ///< of its sections
    float nail;                  ///< half the width of its nail, of the section there
};

/// A section of a digit, of size 1 [cm].
struct DigitSection {
    int bone;
    float share;  ///< of the length of the bone
    float half_width, back, front;
};

/// Knuckle, shaft, middle joint, shaft, last joint, ball, tip.
constexpr std::array<DigitSection, 11> kFinger = {{
    {0, 0.0f, 0.98f, 0.80f, 0.95f},
    {0, 0.3f, 0.94f, 0.80f, 1.02f},
    {0, 0.68f, 0.90f, 0.79f, 0.95f},
    {1, 0.0f, 0.985f, 0.90f, 0.78f},
    {1, 0.35f, 0.87f, 0.73f, 0.86f},
    {1, 0.7f, 0.815f, 0.68f, 0.80f},
    {2, 0.0f, 0.865f, 0.73f, 0.68f},
    {2, 0.28f, 0.83f, 0.66f, 0.76f},
    {2, 0.55f, 0.80f, 0.56f, 0.80f},
    {2, 0.70f, 0.745f, 0.48f, 0.73f},
    {2, 0.80f, 0.70f, 0.44f, 0.67f},
}};

/// The ball of the thumb is broad.
constexpr std::array<DigitSection, 10> kThumb = {{
    {0, 0.0f, 1.30f, 1.10f, 1.55f},
    {0, 0.5f, 1.10f, 0.95f, 1.35f},
    {0, 0.85f, 1.06f, 0.97f, 1.10f},
    {1, 0.0f, 1.10f, 1.00f, 1.00f},
    {1, 0.45f, 0.95f, 0.80f, 0.98f},
    {2, 0.0f, 1.07f, 0.86f, 0.84f},
    {2, 0.3f, 1.08f, 0.72f, 0.94f},
    {2, 0.58f, 1.03f, 0.60f, 0.92f},
    {2, 0.71f, 0.95f, 0.53f, 0.84f},
    {2, 0.80f, 0.88f, 0.48f, 0.77f},
}};

/// A narrow neck, a ball that rests on the ground.
constexpr std::array<DigitSection, 9> kToe = {{
    {0, 0.0f, 1.02f, 0.95f, 0.95f},
    {0, 0.6f, 0.92f, 0.86f, 0.80f},
    {1, 0.0f, 0.95f, 0.90f, 0.72f},
    {1, 0.5f, 0.86f, 0.78f, 0.74f},
    {2, 0.0f, 0.90f, 0.78f, 0.82f},
    {2, 0.35f, 0.96f, 0.70f, 0.98f},
    {2, 0.62f, 0.90f, 0.58f, 0.98f},
    {2, 0.72f, 0.85f, 0.53f, 0.93f},
    {2, 0.80f, 0.80f, 0.48f, 0.88f},
}};

/// A joint of a digit, and its directions there.
struct DigitBone {
    Vec3 at, along, up;
    float length;
};

std::array<DigitBone, 3> bones_of(const Digit& digit) {
    std::array<DigitBone, 3> bones{};
    Vec3 at = digit.root;
    Vec3 along = digit.direction;
    Vec3 up = digit.back;
    for (std::size_t k = 0; k < 3; ++k) {
        const float c = std::cos(digit.bends[k]);
        const float s = std::sin(digit.bends[k]);
        std::tie(along, up) = std::pair(c * along - s * up, c * up + s * along);
        bones[k] = {at, along, up, digit.bones[k]};
        at += digit.bones[k] * along;
    }
    return bones;
}

Loft loft_digit(const Digit& digit, std::span<const DigitSection> sections) {
    const std::array<DigitBone, 3> bones = bones_of(digit);
    std::vector<LoftStation> stations;
    for (const DigitSection& s : sections) {
        const DigitBone& bone = bones[static_cast<std::size_t>(s.bone)];
        const float side = digit.size * s.half_width;
        stations.push_back(
            {bone.at + s.share * bone.length * bone.along, side, digit.size * s.back, side,
             digit.size * s.front});
    }
    return make_loft(
        {.stations = stations,
         .up = digit.back,
         .first_cap = 0.9f * digit.size,
         .last_cap = (1.0f - sections.back().share) * digit.bones[2]});
}

/// Groups of parts, with the lofts that they refer to.
struct Anatomy {
    std::vector<Parts> groups = {{}};  ///< the body, then a digit each
    std::deque<Loft> lofts;
    std::vector<Digit> digits;
    std::vector<std::size_t> groups_of_digits;

    void join(std::span<const LoftStation> stations, const Vec3& up, Vec2 caps, float blend) {
        add(groups[0],
            make_loft({.stations = stations, .up = up, .first_cap = caps.x, .last_cap = caps.y}),
            blend);
    }
    void add(Parts& group, Loft loft, float blend) {
        lofts.push_back(std::move(loft));
        group.push_back({.shape = PartShape::Loft, .blend = blend, .loft = &lofts.back()});
    }
    void add_digit(const Digit& digit, std::span<const DigitSection> sections) {
        digits.push_back(digit);
        groups_of_digits.push_back(groups.size());
        add(groups.emplace_back(), loft_digit(digit, sections), 0);
    }
};

void add_hand(Anatomy& hand) {
    constexpr std::array<LoftStation, 7> kPalm = {{
        {{0, -4.5f, 0}, 2.6f, 1.95f, 2.85f, 2.0f},
        {{0, -1.2f, 0}, 2.6f, 1.8f, 2.85f, 1.8f},
        {{0, 0.6f, 0}, 2.7f, 1.7f, 2.9f, 1.7f},
        {{0, 2.6f, 0}, 3.2f, 1.6f, 3.35f, 1.65f},
        {{0, 5.0f, 0.05f}, 3.65f, 1.45f, 3.85f, 1.5f},
        {{0, 7.0f, 0.1f}, 3.7f, 1.3f, 3.9f, 1.4f},
        {{0, 8.5f, 0.1f}, 3.55f, 1.0f, 3.3f, 1.2f},
    }};
    hand.join(kPalm, {0, 0, 1}, {1, 0.9f}, 0);
    Parts& palm = hand.groups[0];
    const auto finger = [](const Vec3& root, float aside, const std::array<float, 3>& bones,
                           float curl, float size) {
        return Digit{
            .root = root,
            .direction = glm::normalize(Vec3(aside, 1, 0.03f)),
            .back = glm::normalize(Vec3(0.35f * aside, -0.03f, 1)),
            .bones = bones,
            .bends = {0.4f * curl, curl, 0.7f * curl},
            .size = size,
            .nail = 0.86f};
    };
    const std::array<Digit, 4> fingers = {{
        finger({2.65f, 7.9f, 0.1f}, 0.12f, {4.4f, 2.75f, 2.4f}, 0.13f, 1.02f),
        finger({0.72f, 8.15f, 0.25f}, 0.02f, {4.8f, 3.1f, 2.55f}, 0.13f, 1.06f),
        finger({-1.15f, 7.6f, 0.15f}, -0.08f, {4.5f, 2.95f, 2.5f}, 0.16f, 1.0f),
        finger({-2.85f, 6.7f, -0.1f}, -0.2f, {3.7f, 2.1f, 2.15f}, 0.18f, 0.87f),
    }};
    for (const Digit& f : fingers) {
        // Its knuckle, and the tendon to it under the skin of the back.
        palm.push_back(ball(f.root + Vec3(0, 0.1f, 0.5f), {0.78f, 0.95f, 0.66f}, 0.9f));
        const Vec3 tendon = f.root + Vec3(0, -0.3f, 0.98f);
        palm.push_back(cone({0.4f * f.root.x, 1.5f, 1.0f}, tendon, 0.1f, 0.2f, 0.8f));
        // Fat before its root, in the palm.
        palm.push_back(ball(f.root + Vec3(0, 0.9f, -0.75f), {0.85f, 0.9f, 0.62f}, 0.9f));
    }
    palm.push_back(
        ball({-2.55f, 3.5f, -1.0f}, {1.25f, 3.1f, 1.2f}, 1.2f));  // below the little finger
    palm.push_back(ball({-1.85f, -1.1f, 0.95f}, {0.75f, 0.95f, 0.72f}, 1.4f));  // head of the ulna
    palm.push_back(hollow({-0.1f, 4.9f, -2.75f}, {1.7f, 2.7f, 1.2f}, 1.4f));
    // The thumb turns its nail to the side; its ball lies before the palm.
    const Digit thumb = {
        .root = {1.75f, 1.9f, -0.75f},
        .direction = glm::normalize(Vec3(0.62f, 0.78f, -0.1f)),
        .back = glm::normalize(Vec3(0.62f, -0.42f, 0.66f)),
        .bones = {4.5f, 3.3f, 3.0f},
        .bends = {0, -0.16f, 0.08f},
        .size = 1.0f,
        .nail = 0.82f};
    palm.push_back(cone({1.2f, 0.6f, -0.5f}, {3.2f, 4.2f, -1.3f}, 0.8f, 1.1f, 1.8f));
    palm.push_back(
        {.shape = PartShape::Squashed,
         .blend = 1.6f,
         .a = {2.6f, 3.6f, -0.5f},
         .b = {3.0f, 6.2f, -0.2f},
         .radius_a = 1.3f,
         .radius_b = 0.75f,
         .squash = {1, 1, 0.6f}});  // the fold between thumb and hand
    hand.add(palm, loft_digit(thumb, kThumb), 1.3f);
    hand.digits.push_back(thumb);
    hand.groups_of_digits.push_back(0);
    palm.push_back(half_space(PartShape::Above, PartUse::Clip, {0, -3, 0}, 0.8f));
    for (const Digit& f : fingers) {
        hand.add_digit(f, kFinger);
    }
}

void add_foot(Anatomy& foot) {
    constexpr std::array<LoftStation, 9> kSole = {{
        {{0, 2.2f, 2.9f}, 2.5f, 2.6f, 2.5f, 2.9f},
        {{0, 4.2f, 3.1f}, 3.0f, 3.3f, 3.05f, 3.2f},
        {{0.05f, 7.0f, 3.2f}, 3.05f, 3.9f, 3.1f, 3.2f},
        {{0.1f, 9.6f, 3.1f}, 3.2f, 4.1f, 3.35f, 2.9f},
        {{0.1f, 12.3f, 2.7f}, 3.6f, 3.4f, 3.75f, 2.6f},
        {{0.1f, 14.8f, 2.3f}, 4.15f, 2.5f, 4.25f, 2.3f},
        {{0.1f, 17.0f, 1.95f}, 4.55f, 1.8f, 4.5f, 1.95f},
        {{0.1f, 18.2f, 1.75f}, 4.45f, 1.4f, 4.3f, 1.75f},
        {{0.1f, 19.0f, 1.6f}, 4.3f, 1.2f, 4.1f, 1.55f},
    }};
    foot.join(kSole, {0, 0, 1}, {2.2f, 1.5f}, 0);
    constexpr std::array<LoftStation, 6> kLeg = {{
        {{0, 4.3f, 15.0f}, 3.6f, 3.9f, 3.6f, 3.9f},
        {{0, 4.5f, 12.2f}, 3.2f, 3.5f, 3.2f, 3.55f},
        {{0, 4.7f, 10.0f}, 3.05f, 3.5f, 3.05f, 3.5f},
        {{0, 5.0f, 7.8f}, 3.0f, 4.1f, 3.0f, 3.8f},
        {{0, 5.3f, 5.4f}, 2.95f, 5.0f, 2.95f, 4.4f},
        {{0, 5.3f, 4.2f}, 2.6f, 4.3f, 2.6f, 4.0f},
    }};
    foot.join(kLeg, {0, 1, 0}, {1, 2}, 1.6f);
    Parts& body = foot.groups[0];
    body.push_back(ball({2.55f, 5.9f, 8.3f}, {0.95f, 1.3f, 1.3f}, 1.3f));  // ankle bones
    body.push_back(ball({-2.55f, 4.9f, 7.4f}, {0.85f, 1.1f, 1.6f}, 1.3f));
    body.push_back(
        hollow({3.75f, 2.5f, 8.9f}, {1.2f, 1.2f, 3.0f}, 1.6f));  // before Achilles' tendon
    body.push_back(hollow({-3.95f, 2.2f, 8.8f}, {1.2f, 1.2f, 3.0f}, 1.6f));
    body.push_back(hollow({3.9f, 10.3f, -0.4f}, {2.4f, 4.0f, 1.9f}, 1.4f));  // the arch
    body.push_back(ball({3.3f, 17.3f, 1.6f}, {1.1f, 1.8f, 1.3f}, 1.2f));     // balls of the foot
    body.push_back(ball({-3.35f, 15.7f, 1.3f}, {0.9f, 2.2f, 1.1f}, 1.4f));
    body.push_back(ball({-2.75f, 10.2f, 1.5f}, {0.75f, 2.2f, 1.0f}, 1.4f));  // of the outer bone
    struct Toe {
        Vec2 root;
        std::array<float, 3> bones;
        float size, aside, curl;
    };
    constexpr std::array<Toe, 5> kToes = {{
        {{2.85f, 17.6f}, {3.1f, 1.6f, 3.0f}, 1.28f, -0.07f, 0.04f},
        {{0.9f, 18.4f}, {2.9f, 2.0f, 1.85f}, 0.86f, -0.03f, 0.3f},
        {{-0.75f, 18.0f}, {2.7f, 1.75f, 1.75f}, 0.80f, 0.02f, 0.34f},
        {{-2.15f, 17.2f}, {2.5f, 1.5f, 1.65f}, 0.77f, 0.08f, 0.36f},
        {{-3.45f, 16.2f}, {2.3f, 1.2f, 1.55f}, 0.78f, 0.14f, 0.34f},
    }};
    for (const Toe& toe : kToes) {  // its tendon shows on the back of the foot
        const bool big = toe.size > 1;
        body.push_back(cone(
            {0.3f * toe.root.x + 0.2f, 9, 6.3f}, {toe.root.x, toe.root.y - 1.5f, big ? 3.0f : 2.8f},
            0.12f, big ? 0.3f : 0.2f, 0.8f));
    }
    body.push_back(half_space(PartShape::Before, PartUse::Clip, {0, 0, 0.1f}, 0.8f));
    body.push_back(half_space(PartShape::Before, PartUse::Cut, {0, 0, 13}, 0.8f));
    for (const Toe& toe : kToes) {
        // It rises from the ball of the foot, bends, and rests on its tip.
        const bool big = toe.size > 1;
        const Digit digit = {
            .root = {toe.root, big ? 1.5f : 1.45f},
            .direction = glm::normalize(Vec3(toe.aside, 1, big ? 0.0f : 0.22f)),
            .back = glm::normalize(Vec3(0, big ? 0.0f : -0.22f, 1)),
            .bones = toe.bones,
            .bends = {0, toe.curl, 0.8f * toe.curl},
            .size = toe.size,
            .nail = 0.74f};
        foot.add_digit(digit, kToe);
    }
}

void add_arm(Anatomy& arm) {
    constexpr std::array<LoftStation, 12> kArm = {{
        {{0, -18, -0.5f}, 4.5f, 4.5f, 4.5f, 4.7f},
        {{0, -14.5f, -0.5f}, 4.35f, 4.2f, 4.35f, 4.4f},
        {{0, -11.5f, -0.5f}, 4.25f, 3.8f, 4.35f, 4.1f},
        {{0, -9, -0.3f}, 4.45f, 3.6f, 4.4f, 3.9f},
        {{0.1f, -6.2f, 0}, 4.75f, 3.75f, 4.35f, 3.8f},
        {{0.1f, -3, 0}, 4.65f, 3.85f, 4.35f, 3.75f},
        {{0.1f, 1, 0}, 4.0f, 3.45f, 4.0f, 3.35f},
        {{0.05f, 5, 0}, 3.35f, 2.85f, 3.4f, 2.75f},
        {{0, 8.5f, 0}, 2.95f, 2.3f, 2.95f, 2.2f},
        {{0, 11.5f, 0}, 2.8f, 1.95f, 2.75f, 1.9f},
        {{0, 13.6f, 0}, 2.9f, 1.9f, 2.85f, 1.85f},
        {{0, 16, 0}, 3.1f, 1.9f, 3.1f, 1.9f},
    }};
    arm.join(kArm, {0, 0, 1}, {1, 1}, 0);
    Parts& body = arm.groups[0];
    constexpr std::array<LoftStation, 5> kBrachioradialis = {{
        {{1.9f, -16, 0.6f}, 1.3f, 1.3f, 1.3f, 1.3f},
        {{2.8f, -11.5f, 0.9f}, 1.75f, 1.7f, 1.7f, 1.7f},
        {{3.15f, -7.5f, 0.9f}, 1.75f, 1.8f, 1.7f, 1.8f},
        {{2.9f, -2.5f, 0.7f}, 1.3f, 1.4f, 1.3f, 1.4f},
        {{2.3f, 3.5f, 0.4f}, 0.7f, 0.8f, 0.7f, 0.8f},
    }};
    constexpr std::array<LoftStation, 5> kFlexors = {{
        {{-2.6f, -13, -0.6f}, 1.1f, 1.1f, 1.1f, 1.1f},
        {{-2.6f, -9.5f, 0.5f}, 1.7f, 1.8f, 1.8f, 1.7f},
        {{-2.3f, -5, 0.9f}, 1.9f, 2.0f, 2.0f, 1.9f},
        {{-1.8f, 0, 0.9f}, 1.5f, 1.6f, 1.6f, 1.5f},
        {{-1.2f, 6, 0.6f}, 0.8f, 0.9f, 0.9f, 0.8f},
    }};
    arm.join(kBrachioradialis, {0, 0, 1}, {1, 0.8f}, 1.4f);  // its `right` is +x, the thumb's side
    arm.join(kFlexors, {0, 0, 1}, {1, 0.8f}, 1.4f);
    body.push_back(cone({0.4f, -18, 2.3f}, {0.8f, -10, 1.9f}, 2.0f, 0.9f, 1.4f));  // end of biceps
    body.push_back(hollow({0.5f, -9.2f, 5.95f}, {1.9f, 3.2f, 1.5f}, 2.0f));   // bend of the elbow
    body.push_back(ball({-0.6f, -11.6f, -3.6f}, {1.2f, 1.8f, 0.95f}, 1.5f));  // point of the elbow
    body.push_back(ball({-3.6f, -11.6f, -1.2f}, {0.8f, 1.2f, 1.0f}, 1.5f));
    body.push_back(ball({-1.85f, 11.8f, -1.1f}, {0.75f, 1.0f, 0.75f}, 1.3f));  // head of the ulna
    body.push_back(ball({2.15f, 13.2f, 0}, {0.75f, 1.4f, 0.9f}, 1.3f));
    body.push_back(cone({-0.1f, 5, 1.8f}, {0.1f, 15, 1.55f}, 0.15f, 0.3f, 0.8f));  // tendons
    body.push_back(cone({0.9f, 5, 1.7f}, {1.0f, 15, 1.45f}, 0.15f, 0.3f, 0.8f));
    body.push_back(half_space(PartShape::Above, PartUse::Clip, {0, -15.5f, 0}, 1.0f));
    body.push_back(half_space(PartShape::Above, PartUse::Cut, {0, 14.5f, 0}, 1.0f));
}

struct PartModel {
    Anatomy anatomy;
    std::vector<ModelGroup> groups;
    Bounds box;        ///< [cm]
    float begin, end;  ///< along y [cm]
};

float distance_to(const PartModel& model, const Vec3& p) {
    return model_distance(model.groups, p);
}

PartModel part_model(BodyPartKind part) {
    PartModel model;
    switch (part) {
    case BodyPartKind::Foot:
    case BodyPartKind::FootNails:
        add_foot(model.anatomy);
        model.box = {{-6, -1, -1}, {6, 27, 14}};
        model.begin = 0;
        model.end = 25.4f;
        break;
    case BodyPartKind::Arm:
        add_arm(model.anatomy);
        model.box = {{-7, -16.5f, -7}, {7, 15.5f, 7}};
        model.begin = -15.5f;
        model.end = 14.5f;
        break;
    default:
        add_hand(model.anatomy);
        model.box = {{-6, -4, -4}, {10, 20, 3.5f}};
        model.begin = -3;
        model.end = 18.3f;
        break;
    }
    constexpr float kWeb = 0.35f;  // skin between digits [cm]
    for (const Parts& parts : model.anatomy.groups) {
        model.groups.push_back({kWeb, parts});
    }
    return model;
}

/// Where the surface is on the ray from `p` against `direction`, which starts outside.
Vec3 skin_below(std::span<const ModelPart> parts, Vec3 p, const Vec3& direction) {
    for (int i = 0; i < 40; ++i) {
        const float distance = group_distance(parts, p, false);
        p -= 0.8f * distance * direction;
        if (std::abs(distance) < 1e-3f) {
            break;
        }
    }
    return p;
}

/// A plate on the last bone, that starts under the skin and ends free, with an edge that goes down
/// to the skin.
void add_nail(MeshData& mesh, std::span<const ModelPart> parts, const Digit& digit) {
    constexpr int kAcross = 14;
    constexpr int kAlong = 12;       ///< and one row more, of the edge
    constexpr float kBegin = 0.36f;  ///< of the bone
    constexpr float kEnd = 1.0f;
    constexpr float kFree = 0.55f;  ///< from where the plate is straight, of its length
    const DigitBone bone = bones_of(digit)[2];
    const Vec3 right = glm::normalize(glm::cross(bone.along, bone.up));
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const float angle = 1.3f * digit.nail;
    for (int i = 0; i <= kAcross; ++i) {
        const float u = 2.0f * static_cast<float>(i) / kAcross - 1.0f;
        float straight = 0;  // height over the axis where the plate leaves the skin
        float slope = 0;     // and how much it falls a row
        float before = 0;
        for (int j = 0; j <= kAlong + 1; ++j) {
            const bool edge = j > kAlong;
            const float v = static_cast<float>(std::min(j, kAlong)) / kAlong;
            const float share =
                kBegin + (kEnd - kBegin) * (v + u * u * (0.16f * (1 - v) - 0.1f * v));
            const Vec3 axis = bone.at + share * bone.length * bone.along;
            const float turn = angle * u * (0.9f + 0.1f * std::min(4.0f * v, 1.0f));
            const Vec3 out = std::sin(turn) * right + std::cos(turn) * bone.up;
            const Vec3 skin = skin_below(parts, axis + 2.0f * digit.size * out, out);
            const float rim = glm::smoothstep(0.72f, 1.0f, std::abs(u));
            float height = glm::dot(skin - axis, out)
                           + digit.size
                                 * (0.045f * glm::smoothstep(0.0f, 0.2f, v) - 0.02f
                                    - 0.05f * rim * (1.0f - glm::smoothstep(0.6f, 0.9f, v)));
            if (v >= kFree && straight == 0) {
                straight = height;
                slope = std::clamp(before - height, 0.0f, 0.012f * digit.size);
            } else if (v > kFree) {
                slope += 0.006f * digit.size;
                straight -= slope;
                height = std::max(height, straight);
            }
            before = height;
            if (edge) {
                height -= 0.12f * digit.size;
            }
            mesh.positions.push_back(axis + height * out);
            mesh.uvs.emplace_back(0.5f + 0.5f * u, static_cast<float>(j) / (kAlong + 1));
            // A pale moon at its root, rose above the bed, white where it is free.
            const float moon = 1.0f - glm::smoothstep(0.12f, 0.2f, v + 0.4f * u * u);
            const float white = glm::smoothstep(0.84f, 0.9f, v - 0.06f * u * u);
            const Vec3 rose(0.80f, 0.50f, 0.42f);
            const Vec3 pale(0.83f, 0.62f, 0.54f);
            mesh.colors.emplace_back(
                glm::mix(glm::mix(rose, pale, moon), Vec3(0.9f, 0.82f, 0.72f), white), 1.0f);
        }
    }
    constexpr std::uint32_t kRow = kAlong + 2;
    for (std::uint32_t i = 0; i < kAcross; ++i) {
        for (std::uint32_t j = 0; j + 1 < kRow; ++j) {
            const std::uint32_t a = first + i * kRow + j;
            mesh.indices.insert(
                mesh.indices.end(), {a, a + kRow, a + 1, a + 1, a + kRow, a + kRow + 1});
        }
    }
}

/// How red the skin is: over joints and at tips, where blood shows.
float redness(const PartModel& model, const Vec3& p) {
    float red = 0;
    for (const Digit& digit : model.anatomy.digits) {
        const std::array<DigitBone, 3> bones = bones_of(digit);
        const Vec3 tip = bones[2].at + 0.85f * bones[2].length * bones[2].along;
        for (const Vec3& at : {bones[0].at, bones[1].at, bones[2].at, tip}) {
            const Vec3 q = (p - at) / (1.1f * digit.size);
            red = std::max(red, std::exp(-glm::dot(q, q)));
        }
    }
    return red;
}

/// Texture coordinates [cm], to the right and up; `copy` is 1 on the other side of a seam.
Vec2 chart_position(BodyPartKind part, const Vec3& p, int copy) {
    if (part == BodyPartKind::Foot) {
        // The map folds down at the sides and up the leg, about which it is unrolled.
        constexpr float kLeg = 2.8f;  // less than its radius, so that the back fits into the image
        const float turn = std::atan2(p.x, p.y - 4.6f) + 2.0f * kPi * static_cast<float>(copy);
        const float leg = glm::smoothstep(5.0f, 8.5f, p.z);
        const float across = p.x * (1.0f + 0.22f * std::max(3.5f - p.z, 0.0f));
        return {
            glm::mix(across, kLeg * turn, leg),
            glm::mix(p.y, 8.8f, leg) - std::max(p.z - 5.5f, 0.0f)};
    }
    return {p.x - 1.7f, p.y};
}

}  // namespace

MeshData make_body_part(const BodyPartShape& shape) {
    const PartModel model = part_model(shape.part);
    const float height = model.end - model.begin;
    const float scale = shape.length / height;
    const Vec3 middle = {0, 0.5f * (model.begin + model.end), 0};
    MeshData mesh;
    mesh.name = "body_part";
    if (shape.part == BodyPartKind::HandNails || shape.part == BodyPartKind::FootNails) {
        const Anatomy& anatomy = model.anatomy;
        for (std::size_t i = 0; i < anatomy.digits.size(); ++i) {
            const std::size_t group = anatomy.groups_of_digits[i];
            add_nail(mesh, model.groups[group].parts, anatomy.digits[i]);
        }
        for (Vec3& p : mesh.positions) {
            p = scale * (p - middle);
        }
        generate_normals(mesh);
        generate_tangents(mesh);
        update_bounds(mesh);
        return mesh;
    }
    const float cell = height / static_cast<float>(shape.cells);
    const SignedDistance distance = [&](const Vec3& p) { return distance_to(model, p); };
    ImplicitMesh surface = mesh_surface(distance, {model.box, cell});
    even_triangles(surface, distance, cell, 6);
    // Copies of a vertex: of the front and the back of a planar map, or at both sides of a seam.
    std::map<std::tuple<std::uint32_t, bool, int>, std::uint32_t> made;
    const auto vertex_at = [&](std::uint32_t v, bool back, int copy) {
        const auto [found, added] =
            made.try_emplace({v, back, copy}, static_cast<std::uint32_t>(mesh.positions.size()));
        if (added) {
            const Vec3 p = surface.positions[v];
            const Vec3 at = p - middle;
            mesh.positions.push_back(scale * at);
            mesh.normals.push_back(surface.normals[v]);
            if (shape.part == BodyPartKind::Arm) {
                const float turn = 0.5f + std::atan2(p.x, p.z) / (2 * kPi);  // 0 and 1 behind
                mesh.uvs.emplace_back(turn + static_cast<float>(copy), 0.5f - at.y / height);
            } else {
                const Vec2 flat = chart_position(shape.part, p, copy) - Vec2(0, middle.y);
                const Vec2 uv = kBodyChartScale * flat / height;
                mesh.uvs.emplace_back(back ? 0.75f - uv.x : 0.25f + uv.x, 0.5f - uv.y);
            }
            const float red = redness(model, p);
            mesh.colors.emplace_back(
                glm::mix(Vec3(1, 0.97f, 0.95f), Vec3(1, 0.8f, 0.77f), red), 1.0f);
        }
        return found->second;
    };
    for (std::size_t t = 0; t + 3 <= surface.indices.size(); t += 3) {
        const std::uint32_t* const v = &surface.indices[t];
        const auto at = [&](int k) { return surface.positions[v[k]]; };
        const Vec3 area = glm::cross(at(1) - at(0), at(2) - at(0));
        const Vec3 axis = shape.part == BodyPartKind::Foot ? Vec3(0, 4.6f, 0) : Vec3(0);
        bool back = false;  // or the sole
        bool seam = false;  // behind the limb, partly on the side of +x
        if (shape.part == BodyPartKind::Hand) {
            back = area.z < 0;
        } else {
            const bool foot = shape.part == BodyPartKind::Foot;
            back = foot && area.z < -0.5f * glm::length(area) && at(0).z < 3;
            const auto behind = [&](int k) {
                const Vec3 q = at(k) - axis;
                return (foot ? q.y : q.z) < 0;
            };
            seam = behind(0) && behind(1) && behind(2) && (!foot || at(0).z > 4)
                   && std::max({at(0).x, at(1).x, at(2).x}) > 0;
        }
        for (int k = 0; k < 3; ++k) {
            mesh.indices.push_back(vertex_at(v[k], back, seam && at(k).x < 0 ? 1 : 0));
        }
    }
    generate_tangents(mesh);
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
