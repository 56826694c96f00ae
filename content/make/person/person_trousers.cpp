#include "content/make/person/person_cloth.h"
#include "content/make/person/person_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr float kSplit = 0.845f;    ///< where the trunk becomes two legs
constexpr int kCrotchVertices = 5;  ///< between front and back
constexpr int kLegColumns = kHalfColumns + 1 + kCrotchVertices;
constexpr float kLegBegin = 0.735f;

class TrousersBuilder {
  public:
    TrousersBuilder(BodyMesh& mesh, const PersonFrame& frame)
        : mesh_(mesh), frame_(frame), end_(person_hems(frame).leg) {}

    void add() {
        const bool skirt = frame_.look.shape.legs == PersonLegwear::Skirt
                           || frame_.look.shape.legs == PersonLegwear::Dress;
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
        const bool skirt = frame_.look.shape.legs == PersonLegwear::Skirt
                           || frame_.look.shape.legs == PersonLegwear::Dress;
        for (int j = 0; j <= kHalfColumns; ++j) {
            BodyVertex vertex;
            vertex.position = waist_point(frame_, height, cloth_angle(j), grow);
            vertex.color = frame_.look.shape.trousers_color;
            if (height > 0.984f && !skirt) {
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
            const float angle = cloth_angle(j);
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

}  // namespace

void add_trousers(BodyMesh& mesh, const PersonFrame& frame) {
    TrousersBuilder(mesh, frame).add();
}

}  // namespace limn
