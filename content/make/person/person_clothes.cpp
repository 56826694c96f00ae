#include "content/make/person/person_parts.h"
#include "ecs/base/gradient_noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr int kHalfColumns = 20;       ///< of the trunk, from front to back
constexpr float kClothColumn = 0.02f;  ///< width of a column in texture space [m]

float half_angle(int column) {
    return kPi * static_cast<float>(column) / kHalfColumns;
}

/// A point of a cubic curve from `a` to `b` with tangents `da` and `db`.
Vec3 curve_point(const Vec3& a, const Vec3& da, const Vec3& b, const Vec3& db, float t) {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b
           + (t3 - t2) * db;
}

BodySection grown(BodySection section, float ease) {
    section.width += ease;
    section.front += ease;
    section.back += ease;
    return section;
}

BodySection larger(const BodySection& a, const BodySection& b) {
    return {std::max(a.width, b.width), std::max(a.front, b.front), std::max(a.back, b.back)};
}

BodySection mixed(const BodySection& a, const BodySection& b, float t) {
    return {
        std::lerp(a.width, b.width, t), std::lerp(a.front, b.front, t),
        std::lerp(a.back, b.back, t)};
}

// ---- shirt --------------------------------------------------------------------------------------

constexpr float kChestLine = 1.26f;  ///< cloth hangs from here
constexpr float kHipLine = 0.91f;
constexpr int kHoleColumn = 7;  ///< of the armhole: 6 columns by 4 rows
constexpr int kHoleColumns = 6;
constexpr int kHoleRows = 4;
constexpr float kSleeveBegin = 0.115f;  ///< along the arm [m]

class ShirtBuilder {
  public:
    ShirtBuilder(BodyMesh& mesh, const PersonFrame& frame) : mesh_(mesh), frame_(frame) {}

    void add() {
        std::vector<float> heights = {};
        const bool tucked = frame_.look.tucked;
        const float hem = tucked ? 0.985f : kHipLine + 0.012f - frame_.look.shirt_length;
        for (const float height :
             {hem, hem + 0.008f, 0.925f, 0.955f, 0.985f, 1.012f, 1.04f, 1.07f, 1.10f, 1.13f, 1.16f,
              1.19f, 1.215f, 1.24f, 1.265f}) {
            if (heights.empty() || height > heights.back() + 0.005f) {
                heights.push_back(height);
            }
        }
        hole_row_ = static_cast<int>(heights.size());
        for (const float height :
             {1.29f, 1.32f, 1.352f, 1.384f, 1.412f, 1.432f, 1.449f, 1.464f, 1.477f}) {
            heights.push_back(height);
        }
        for (const float height : heights) {
            rows_.push_back(add_row(height, 0, height));
        }
        for (int r = 0; r + 1 < static_cast<int>(rows_.size()); ++r) {
            join_rows(r);
        }
        add_hem(hem);
        add_collar();
        add_sleeve();
    }

  private:
    [[nodiscard]] BodySection section(float height) const {
        const BodySection body = trunk_section(frame_, height);
        const float neck = glm::smoothstep(1.40f, 1.47f, height);
        const float ease = std::lerp(0.013f, 0.003f, neck);
        const BodySection close = grown(body, ease);
        if (height > kChestLine) {
            return close;
        }
        const float t = (kChestLine - height) / (kChestLine - kHipLine);
        const BodySection straight = grown(
            mixed(trunk_section(frame_, kChestLine), trunk_section(frame_, kHipLine), t), 0.013f);
        BodySection hanging = mixed(close, larger(close, straight), 0.65f);
        hanging = grown(hanging, 0.006f * glm::smoothstep(0.3f, 1.0f, t));
        if (frame_.look.tucked) {  // drawn in below the waistband, full above it
            const float in = 1 - glm::smoothstep(0.99f, 1.035f, height);
            hanging = mixed(hanging, grown(body, 0.003f), in);
        }
        return hanging;
    }

    /// `grow`: of the section; `at`: the height of its texture coordinate.
    BodyRing add_row(float height, float grow, float at) {
        BodyRing ring;
        ring.closed = false;
        ring.v = 1.5f - at;
        const BodySection own = grown(section(height), grow);
        for (int j = 0; j <= kHalfColumns; ++j) {
            BodyVertex vertex;
            vertex.position = trunk_point(own, frame_, height, half_angle(j), 1);
            vertex.color = frame_.look.shape.shirt_color;
            const bool near_hole = j >= kHoleColumn - 1 && j <= kHoleColumn + kHoleColumns + 1;
            vertex.fair = near_hole && height > 1.27f && height < 1.44f;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    void join_rows(int r) {
        const BodyRing& a = rows_[r];
        const BodyRing& b = rows_[r + 1];
        const bool hole = r >= hole_row_ && r < hole_row_ + kHoleRows;
        for (int j = 0; j < kHalfColumns; ++j) {
            if (hole && j >= kHoleColumn && j < kHoleColumn + kHoleColumns) {
                continue;
            }
            const float u = kClothColumn * static_cast<float>(j);
            mesh_.add_quad(
                {a.vertices[j], b.vertices[j], b.vertices[j + 1], a.vertices[j + 1]},
                {Vec2(u, a.v), Vec2(u, b.v), Vec2(u + kClothColumn, b.v),
                 Vec2(u + kClothColumn, a.v)});
        }
    }

    void add_hem(float hem) {
        const BodyRing fold = add_row(hem, -0.003f, hem - 0.004f);
        const BodyRing inside = add_row(hem + 0.05f, -0.010f, hem - 0.05f);
        mesh_.join(fold, rows_.front(), kClothColumn);
        mesh_.join(inside, fold, kClothColumn);
        mesh_.cap(inside, Vec3(0), kClothColumn, false);
    }

    /// A band around the neck, folded in.
    void add_collar() {
        const BodyRing outer = add_row(1.487f, 0.0042f, 1.487f);
        const BodyRing top = add_row(1.492f, 0.003f, 1.492f);
        const BodyRing inner = add_row(1.489f, 0.0f, 1.496f);
        const BodyRing deep = add_row(1.462f, -0.006f, 1.53f);
        const std::array<const BodyRing*, 5> rings = {&rows_.back(), &outer, &top, &inner, &deep};
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            mesh_.join(*rings[i], *rings[i + 1], kClothColumn);
        }
        mesh_.cap(deep, Vec3(0), kClothColumn, true);
    }

    /// Around the armhole, from the middle of its front up and to the back.
    [[nodiscard]] BodyRing hole() const {
        BodyRing ring;
        const int front = kHoleColumn;
        const int back = kHoleColumn + kHoleColumns;
        const auto at = [&](int row, int column) {
            return rows_[hole_row_ + row].vertices[column];
        };
        for (int row = kHoleRows / 2; row < kHoleRows; ++row) {
            ring.vertices.push_back(at(row, front));
        }
        for (int column = front; column < back; ++column) {
            ring.vertices.push_back(at(kHoleRows, column));
        }
        for (int row = kHoleRows; row > 0; --row) {
            ring.vertices.push_back(at(row, back));
        }
        for (int column = back; column > front; --column) {
            ring.vertices.push_back(at(0, column));
        }
        for (int row = 0; row < kHoleRows / 2; ++row) {
            ring.vertices.push_back(at(row, front));
        }
        return ring;
    }

    [[nodiscard]] Vec2 sleeve_radii(float along, float grow) const {
        const float wrist = frame_.upper_arm_length + frame_.forearm_length;
        const Vec2 arm = arm_radii(frame_, along);
        const float round = 0.5f * (arm.x + arm.y);
        const bool is_long = frame_.look.shape.sleeves == PersonSleeves::Long;
        const float flare = is_long ? 0.0f : 0.010f * glm::smoothstep(kSleeveBegin, 0.22f, along);
        const float loose = is_long ? 0.006f * glm::smoothstep(0.25f, 0.40f, along) : 0.0f;
        const float cuff =
            is_long ? 0.004f * glm::smoothstep(wrist - 0.05f, wrist - 0.03f, along) : 0;
        const float ease = 0.0095f + flare + loose - cuff + grow;
        return glm::mix(arm, Vec2(round), 0.5f) + Vec2(ease);
    }

    BodyRing add_sleeve_ring(float along, float grow) {
        BodyRing ring;
        ring.v = along;
        const Vec2 radii = sleeve_radii(along, grow);
        for (int j = 0; j < kArmColumns; ++j) {
            const float angle = 2 * kPi * static_cast<float>(j) / kArmColumns;
            BodyVertex vertex;
            vertex.position = arm_point(frame_, along, angle, radii);
            vertex.color = frame_.look.shape.shirt_color;
            vertex.zone = BodyZone::Arm;
            vertex.along = along;
            vertex.fair = along <= kSleeveBegin;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    BodyRing add_bridge_ring(const BodyRing& from, const BodyRing& to, float t) {
        BodyRing ring;
        ring.v = std::lerp(-0.02f, to.v, t);
        for (int j = 0; j < kArmColumns; ++j) {
            const Vec3 a = mesh_.vertices[from.vertices[j]].position;
            const Vec3 b = mesh_.vertices[to.vertices[j]].position;
            const float length = glm::distance(a, b);
            const float up = (a.y - 1.36f) / 0.09f;
            const Vec3 out =
                glm::normalize(Vec3(1, std::clamp(0.3f * up, -0.45f, 0.08f), 3 * a.z + 0.04f));
            BodyVertex vertex = mesh_.vertices[from.vertices[j]];
            vertex.position = curve_point(a, length * out, b, length * frame_.upper_arm.along, t);
            vertex.fair = true;
            if (t > 0.7f) {
                vertex.zone = BodyZone::Arm;
                vertex.along = t * to.v;
            }
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    void add_sleeve() {
        const float elbow = frame_.upper_arm_length;
        const float wrist = elbow + frame_.forearm_length;
        const BodyRing edge = hole();
        const BodyRing first = add_sleeve_ring(kSleeveBegin, 0);
        const BodyRing one = add_bridge_ring(edge, first, 0.27f);
        const BodyRing two = add_bridge_ring(edge, first, 0.52f);
        const BodyRing three = add_bridge_ring(edge, first, 0.76f);
        std::vector<BodyRing> rings = {edge, one, two, three, first};
        rings[0].v = -0.02f;
        const float end = person_hems(frame_).sleeve;
        for (const float along :
             {0.14f, 0.165f, 0.19f, 0.215f, 0.24f, elbow - 0.03f, elbow - 0.012f, elbow + 0.004f,
              elbow + 0.02f, elbow + 0.038f, elbow + 0.06f, elbow + 0.09f, elbow + 0.12f,
              elbow + 0.15f, elbow + 0.18f, elbow + 0.205f, wrist - 0.034f, wrist - 0.028f, end}) {
            if (along <= end && along > rings.back().v + 0.004f) {
                rings.push_back(add_sleeve_ring(along, 0));
            }
        }
        BodyRing fold = add_sleeve_ring(end, -0.003f);
        fold.v = end + 0.004f;
        BodyRing inside = add_sleeve_ring(end - 0.035f, -0.0075f);
        inside.v = end + 0.05f;
        rings.push_back(fold);
        rings.push_back(inside);
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            mesh_.join(rings[i + 1], rings[i], kClothColumn);
        }
        mesh_.cap(rings.back(), Vec3(0), kClothColumn, false);
    }

    BodyMesh& mesh_;
    const PersonFrame& frame_;
    std::vector<BodyRing> rows_;
    int hole_row_ = 0;
};

// ---- trousers -----------------------------------------------------------------------------------

constexpr float kWaist = 1.008f;
constexpr float kSplit = 0.845f;    ///< where the trunk becomes two legs
constexpr int kCrotchVertices = 5;  ///< between front and back
constexpr int kLegColumns = kHalfColumns + 1 + kCrotchVertices;
constexpr float kLegBegin = 0.735f;

class TrousersBuilder {
  public:
    TrousersBuilder(BodyMesh& mesh, const PersonFrame& frame)
        : mesh_(mesh), frame_(frame), end_(person_hems(frame).leg) {}

    void add() {
        const bool skirt = frame_.look.shape.legs == PersonLegwear::Skirt;
        BodyRing inside = add_row(kWaist - 0.05f, -0.010f, 1.07f);
        BodyRing edge = add_row(kWaist - 0.001f, -0.002f, kWaist + 0.004f);
        BodyRing last = add_row(kWaist, 0.0f, kWaist);
        mesh_.cap(inside, Vec3(0), kClothColumn, false);
        mesh_.join(inside, edge, kClothColumn);
        mesh_.join(edge, last, kClothColumn);
        const std::array<float, 7> heights = {0.985f, 0.982f, 0.955f, 0.925f,
                                              0.898f, 0.872f, kSplit};
        for (const float height : heights) {
            const BodyRing next = add_row(height, 0, height);
            mesh_.join(last, next, kClothColumn);
            last = next;
        }
        if (skirt) {
            add_skirt(last);
        } else {
            add_legs(last);
        }
    }

  private:
    /// Of the trunk.
    BodyRing add_row(float height, float grow, float at) {
        BodyRing ring;
        ring.closed = false;
        ring.v = 1.5f - at;
        const float belt = height > 0.984f ? 0.003f : 0.0f;
        const BodySection own = grown(trunk_section(frame_, height), 0.0065f + belt + grow);
        for (int j = 0; j <= kHalfColumns; ++j) {
            BodyVertex vertex;
            vertex.position = trunk_point(own, frame_, height, half_angle(j), 0);
            vertex.color = frame_.look.shape.trousers_color;
            if (height > 0.984f && frame_.look.shape.legs != PersonLegwear::Skirt) {
                vertex.color = 0.7f * frame_.look.shape.shoe_color;
            }
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    [[nodiscard]] Vec3 leg_cloth(float height, int column, float grow) const {
        BodySection leg = leg_section(frame_, height);
        const bool shorts = frame_.look.shape.legs == PersonLegwear::Shorts;
        const float ease =
            shorts ? 0.010f + 0.022f * glm::smoothstep(0.78f, 0.56f, height) : 0.009f;
        leg = grown(leg, ease);
        const float down = glm::smoothstep(0.62f, 0.3f, height);
        const float wide = glm::mix(0.060f, 0.066f, frame_.man) * (1 + 0.05f * frame_.build);
        const BodySection straight = {wide, wide + 0.004f, wide + 0.006f};
        leg = mixed(leg, larger(leg, straight), down);
        const float cuff = glm::smoothstep(0.16f, 0.03f, height);
        leg.front += 0.014f * cuff;
        leg.back -= 0.004f * cuff;
        const float angle =
            0.5f * kPi + 2 * kPi * static_cast<float>(column - kHalfColumns / 2) / kLegColumns;
        Vec3 p = leg_point(grown(leg, grow), frame_, height, angle);
        // The hem rests on the instep and falls behind the heel.
        p.y += 0.020f * cuff * std::max(std::cos(angle), -0.4f);
        p.x = std::max(p.x, 0.004f);
        return p;
    }

    BodyRing add_leg_ring(float height, float grow, float at) {
        BodyRing ring;
        ring.v = 1.5f - at;
        for (int j = 0; j < kLegColumns; ++j) {
            BodyVertex vertex;
            vertex.position = leg_cloth(height, j, grow);
            vertex.color = frame_.look.shape.trousers_color;
            vertex.zone = BodyZone::Leg;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    /// The half ring of the trunk and the line between the legs, from back to front.
    BodyRing add_split(const BodyRing& last) {
        BodyRing split;
        split.v = last.v;
        split.vertices = last.vertices;
        const Vec3 front = mesh_.vertices[last.vertices.front()].position;
        const Vec3 back = mesh_.vertices[last.vertices.back()].position;
        for (int k = 1; k <= kCrotchVertices; ++k) {
            const float t = static_cast<float>(k) / (kCrotchVertices + 1);
            BodyVertex vertex = mesh_.vertices[last.vertices.front()];
            vertex.position = glm::mix(back, front, t);
            vertex.position.y -= 0.052f * std::pow(std::sin(kPi * t), 0.6f);
            vertex.position.x = 0;
            split.vertices.push_back(mesh_.add(vertex));
        }
        return split;
    }

    void add_legs(const BodyRing& trunk) {
        const BodyRing split = add_split(trunk);
        const BodyRing begin = add_leg_ring(kLegBegin, 0, kLegBegin);
        std::vector<BodyRing> rings = {split};
        for (const float t : {0.3f, 0.65f}) {
            BodyRing ring;
            ring.v = std::lerp(split.v, begin.v, t);
            for (int j = 0; j < kLegColumns; ++j) {
                const Vec3 a = mesh_.vertices[split.vertices[j]].position;
                const Vec3 b = mesh_.vertices[begin.vertices[j]].position;
                const float length = glm::distance(a, b);
                const bool crotch = j > kHalfColumns;
                const Vec3 out = crotch ? glm::normalize(Vec3(0.6f, -0.8f, 0)) : Vec3(0, -1, 0);
                BodyVertex vertex = mesh_.vertices[begin.vertices[j]];
                vertex.position = curve_point(a, length * out, b, Vec3(0, -length, 0), t);
                vertex.position.x = std::max(vertex.position.x, 0.003f);
                vertex.zone = BodyZone::Trunk;
                vertex.fair = true;
                ring.vertices.push_back(mesh_.add(vertex));
            }
            rings.push_back(ring);
        }
        rings.push_back(begin);
        for (const float height : {0.70f,  0.665f, 0.63f,  0.60f,  0.575f, 0.555f, 0.535f, 0.518f,
                                   0.50f,  0.482f, 0.463f, 0.44f,  0.41f,  0.375f, 0.335f, 0.29f,
                                   0.245f, 0.20f,  0.16f,  0.125f, 0.095f, 0.07f,  0.05f,  end_}) {
            if (height >= end_ && 1.5f - height > rings.back().v + 0.004f) {
                rings.push_back(add_leg_ring(height, 0, height));
            }
        }
        rings.push_back(add_leg_ring(end_, -0.003f, end_ - 0.004f));
        rings.push_back(add_leg_ring(end_ + 0.045f, -0.008f, end_ - 0.05f));
        for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
            mesh_.join(rings[i], rings[i + 1], kClothColumn);
        }
        mesh_.cap(rings.back(), Vec3(0), kClothColumn, true);
    }

    BodyRing add_skirt_ring(float height, float grow, float at) {
        BodyRing ring;
        ring.closed = false;
        ring.v = 1.5f - at;
        const float down = (kSplit - height) / (kSplit - end_);
        const BodySection hip = grown(trunk_section(frame_, kSplit), 0.0065f + grow);
        for (int j = 0; j <= kHalfColumns; ++j) {
            const float angle = half_angle(j);
            const float flare = 0.030f * down + 0.012f * down * std::cos(6 * angle);
            const BodySection own = grown(hip, flare);
            BodyVertex vertex;
            vertex.position = trunk_point(own, frame_, kSplit, angle, 0);
            vertex.position.y = height;
            vertex.color = frame_.look.shape.trousers_color;
            vertex.zone = BodyZone::Skirt;
            ring.vertices.push_back(mesh_.add(vertex));
        }
        return ring;
    }

    void add_skirt(const BodyRing& trunk) {
        BodyRing last = trunk;
        constexpr int kRows = 9;
        for (int r = 1; r <= kRows; ++r) {
            const float height =
                std::lerp(kSplit, end_, static_cast<float>(r) / static_cast<float>(kRows));
            const BodyRing next = add_skirt_ring(height, 0, height);
            mesh_.join(last, next, kClothColumn);
            last = next;
        }
        const BodyRing fold = add_skirt_ring(end_, -0.003f, end_ - 0.004f);
        const BodyRing inside = add_skirt_ring(end_ + 0.07f, -0.010f, end_ - 0.05f);
        mesh_.join(last, fold, kClothColumn);
        mesh_.join(fold, inside, kClothColumn);
        mesh_.cap(inside, Vec3(0), kClothColumn, true);
    }

    BodyMesh& mesh_;
    const PersonFrame& frame_;
    float end_;
};

// ---- shoes --------------------------------------------------------------------------------------

/// A section of a shoe across its length.
struct ShoeSection {
    float z;
    float half;    ///< width of the sole
    float height;  ///< of the upper
    float sole;    ///< thickness
};
constexpr std::array<ShoeSection, 15> kShoe = {{
    {-0.090f, 0.0190f, 0.060f, 0.026f},
    {-0.084f, 0.0265f, 0.082f, 0.026f},
    {-0.072f, 0.0320f, 0.094f, 0.026f},
    {-0.050f, 0.0355f, 0.099f, 0.026f},
    {-0.024f, 0.0360f, 0.102f, 0.025f},
    {0.004f, 0.0360f, 0.101f, 0.021f},
    {0.030f, 0.0375f, 0.089f, 0.018f},
    {0.056f, 0.0405f, 0.075f, 0.017f},
    {0.082f, 0.0440f, 0.065f, 0.017f},
    {0.108f, 0.0460f, 0.058f, 0.017f},
    {0.132f, 0.0450f, 0.052f, 0.017f},
    {0.152f, 0.0410f, 0.047f, 0.017f},
    {0.168f, 0.0340f, 0.042f, 0.017f},
    {0.179f, 0.0245f, 0.037f, 0.017f},
    {0.185f, 0.0140f, 0.031f, 0.017f},
}};
constexpr int kSoleColumns = 4;
constexpr int kUpperColumns = 8;

}  // namespace

PersonHems person_hems(const PersonFrame& frame) {
    PersonHems hems;
    const bool is_long = frame.look.shape.sleeves == PersonSleeves::Long;
    const float wrist = frame.upper_arm_length + frame.forearm_length;
    hems.sleeve = is_long ? wrist + 0.004f : 0.225f;
    switch (frame.look.shape.legs) {
    case PersonLegwear::Shorts:
        hems.leg = 0.55f;
        break;
    case PersonLegwear::Skirt:
        hems.leg = 0.53f;
        break;
    default:
        hems.leg = 0.036f;
    }
    return hems;
}

void add_shirt(BodyMesh& mesh, const PersonFrame& frame) {
    ShirtBuilder(mesh, frame).add();
}

void add_trousers(BodyMesh& mesh, const PersonFrame& frame) {
    TrousersBuilder(mesh, frame).add();
}

void add_shoe(BodyMesh& mesh, const PersonFrame& frame) {
    const Vec3 sole_color =
        glm::mix(Vec3(0.02f), Vec3(0.45f), frame.look.folds % 2 == 0 ? 0.0f : 1.0f);
    BodyRing last;
    for (const ShoeSection& section : kShoe) {
        BodyRing ring;
        ring.v = section.z;
        const float center = std::lerp(0.095f, 0.112f, (section.z + 0.09f) / 0.275f);
        const auto add = [&](float x, float y, const Vec3& color) {
            BodyVertex vertex;
            // The inner side is straighter than the outer one.
            const float inward = x < 0 ? 0.94f : 1.04f;
            vertex.position = {center + inward * x, y, section.z};
            vertex.color = color;
            vertex.zone = BodyZone::Shoe;
            ring.vertices.push_back(mesh.add(vertex));
        };
        for (int k = 0; k <= kSoleColumns; ++k) {
            add(section.half * (1 - 2 * static_cast<float>(k) / kSoleColumns), 0, sole_color);
        }
        const float lip = section.half + 0.0015f;
        add(-lip, section.sole, sole_color);
        for (int k = 0; k <= kUpperColumns; ++k) {
            const float angle = kPi * static_cast<float>(k) / kUpperColumns;
            const float c = std::cos(angle);
            const float x = -std::copysign(std::pow(std::abs(c), 0.75f), c) * 0.96f * section.half;
            const float y = section.sole + 0.0015f
                            + (section.height - section.sole) * std::pow(std::sin(angle), 0.85f);
            add(x, k == 0 || k == kUpperColumns ? section.sole + 0.0015f : y,
                frame.look.shape.shoe_color);
        }
        add(lip, section.sole, sole_color);
        if (last.vertices.empty()) {
            mesh.cap(ring, Vec3(0, 0, -0.003f), 0.02f, false);
        } else {
            mesh.join(last, ring, 0.02f);
        }
        last = ring;
    }
    mesh.cap(last, Vec3(0, 0, 0.003f), 0.02f, true);
}

void fold_cloth(BodyMesh& mesh, const PersonFrame& frame) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3(0));
    for (const BodyQuad& quad : mesh.quads) {
        const auto at = [&](int k) { return mesh.vertices[quad.corners[k]].position; };
        const Vec3 area = glm::cross(at(2) - at(0), at(3) - at(1));
        for (const std::uint32_t corner : quad.corners) {
            normals[corner] += area;
        }
    }
    const std::uint32_t seed = frame.look.folds;
    const float elbow = frame.upper_arm_length;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        BodyVertex& vertex = mesh.vertices[i];
        const Vec3& p = vertex.position;
        const auto noise = [&](const Vec3& scale, std::uint32_t salt) {
            return gradient_noise(scale * p + Vec3(0.37f), seed + salt);
        };
        float height = 0.0020f * noise({14, 9, 14}, 0);
        if (vertex.zone == BodyZone::Arm) {
            const float bend = std::exp(-square((vertex.along - elbow) / 0.07f));
            const float cuff = vertex.along > elbow + 0.12f ? 0.5f : 0.0f;
            height += 0.008f * std::max(bend, cuff) * noise({22, 30, 22}, 1);
            height += 0.0045f * noise({9, 22, 22}, 2);
        } else if (vertex.zone == BodyZone::Leg) {
            const float knee = std::exp(-square((p.y - 0.48f) / 0.09f));
            const float ankle = std::exp(-square((p.y - 0.11f) / 0.09f));
            height += 0.009f * knee * noise({9, 26, 9}, 3);
            height += 0.013f * ankle * noise({9, 30, 9}, 4);
        } else if (vertex.zone == BodyZone::Trunk) {
            const float waist = std::exp(-square((p.y - 1.06f) / 0.10f));
            const float groin = std::exp(-square((p.y - 0.83f) / 0.05f));
            const float chest = std::exp(-square((p.y - 1.27f) / 0.09f));
            height += 0.014f * waist * noise({7, 24, 7}, 5);
            height += 0.006f * groin * noise({12, 16, 12}, 6);
            height += 0.006f * chest * noise({18, 9, 18}, 7);
        }
        vertex.position += height * normalize_or(normals[i], Vec3(0));
    }
}

}  // namespace limn
