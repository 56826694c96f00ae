#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "content/make/person/person_head_shape.h"
#include "content/make/person/person_parts.h"
#include "ecs/base/gradient_noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

// Lengths in the space of the head are centimeters.

constexpr Vec3 kSkull = {0, 5.5f, -0.5f};
constexpr int kHairColumns = 44;
constexpr int kHairRows = 13;
constexpr int kInnerRows = 3;  ///< of the inner side, from the edge up

struct EdgeKey {
    float angle;   ///< from the front [degrees]
    float height;  ///< of the edge of the hair [cm]
};
/// Around forehead, temples, over the ears and down to the nape.
constexpr std::array<EdgeKey, 11> kShortEdge = {{
    {0, 10.6f},
    {18, 10.5f},
    {32, 9.9f},
    {44, 8.4f},
    {56, 6.6f},
    {66, 4.4f},
    {74, 2.0f},
    {84, 2.8f},
    {100, 4.8f},
    {118, 0.4f},
    {181, -4.6f},
}};
constexpr std::array<EdgeKey, 7> kBobEdge = {{
    {0, 10.6f},
    {22, 10.0f},
    {34, 8.0f},
    {48, -1.0f},
    {62, -7.0f},
    {100, -8.0f},
    {181, -8.4f},
}};
constexpr std::array<EdgeKey, 8> kLongEdge = {{
    {0, 10.6f},
    {22, 10.0f},
    {36, 8.0f},
    {52, -2.0f},
    {68, -10.0f},
    {95, -13.0f},
    {125, -21.0f},
    {181, -24.0f},
}};

float edge_height(std::span<const EdgeKey> keys, float angle) {
    const float at = std::abs(angle) * 180 / kPi;
    std::size_t i = 1;
    while (i + 1 < keys.size() && keys[i].angle < at) {
        ++i;
    }
    const float height = glm::mix(
        keys[i - 1].height, keys[i].height, glm::smoothstep(keys[i - 1].angle, keys[i].angle, at));
    return height + 0.3f * gradient_noise(Vec2(7 * angle, height), 5);
}

std::span<const EdgeKey> edge_keys(PersonHair style) {
    switch (style) {
    case PersonHair::Bob:
        return kBobEdge;
    case PersonHair::Long:
        return kLongEdge;
    default:
        return kShortEdge;
    }
}

class HairBuilder {
  public:
    HairBuilder(BodyMesh& mesh, const PersonFrame& frame)
        : mesh_(mesh), frame_(frame), shape_(person_head_shape(frame)),
          style_(frame.look.shape.hair) {}

    void add() {
        if (style_ != PersonHair::Bald) {
            add_scalp();
        }
        if (style_ == PersonHair::Bun) {
            add_bun();
        }
    }

  private:
    std::uint32_t add_point(const Vec3& p, const Vec3& color) {
        BodyVertex vertex;
        vertex.position = frame_.head_origin + 0.01f * frame_.head_scale * skew_head(p, shape_);
        vertex.color = color;
        vertex.zone = BodyZone::Head;
        return mesh_.add(vertex);
    }

    [[nodiscard]] Vec3 on_skull(float angle, float elevation) const {
        const float c = std::cos(elevation);
        const Vec3 way(c * std::sin(angle), std::sin(elevation), c * std::cos(angle));
        return project_to_head(kSkull + 9.0f * way, shape_, 0, 4);
    }

    /// How far hair stands off the skull.
    [[nodiscard]] float thickness(float angle, float t) const {
        const float front = 0.5f + 0.5f * std::cos(angle);
        const float top = 1 - t;
        float thick = 0;
        switch (style_) {
        case PersonHair::Short:
            thick = glm::mix(0.65f, 1.6f, top) + 0.9f * front * top * t
                    + 0.35f * std::sin(angle + 0.9f) * top * front;
            break;
        case PersonHair::Bun:
            thick = 0.65f;
            break;
        default:
            thick = glm::mix(1.5f, 1.2f, top)
                    + 0.8f * std::exp(-square((std::abs(angle) - 1.6f) / 0.4f))
                          * glm::smoothstep(0.3f, 0.55f, t);
        }
        // Locks of short hair lie across the head, from a parting on one side.
        const bool is_short = style_ == PersonHair::Short;
        const float turn = is_short ? angle + 1.1f * t : angle;
        const float fine = is_short ? 7.5f : 5.0f;
        const float locks = gradient_noise(
            Vec2(fine * std::sin(turn) + 9, fine * std::cos(turn) + 2.2f * t), frame_.look.folds);
        return thick * (1 + (is_short ? 0.5f : 0.26f) * locks);
    }

    struct HairPoint {
        Vec3 outer;
        Vec3 inner;
    };

    /// `t`: 0 at the crown, 1 at the edge.
    [[nodiscard]] HairPoint hair_point(float angle, float t) const {
        constexpr float kEquator = 0.02f;  // elevation where hair leaves the skull
        constexpr float kTop = 0.5f * kPi;
        const float edge = edge_height(edge_keys(style_), angle);
        const bool hangs = style_ == PersonHair::Bob || style_ == PersonHair::Long;
        const float last = std::atan2(edge - kSkull.y, 9.2f);
        const bool falls = hangs && last < kEquator;
        const float ends = glm::smoothstep(0.80f, 1.0f, t);
        if (!falls) {
            const float elevation = std::lerp(kTop, last, t);
            const Vec3 p = on_skull(angle, elevation);
            const Vec3 out = normalize_or(head_gradient(p, shape_, 0), p - kSkull);
            const float thick = thickness(angle, t);
            return {p + std::lerp(thick, 0.12f, ends * ends) * out, p - 0.5f * out};
        }
        // On the skull to the equator, then down.
        const Vec3 side = on_skull(angle, kEquator);
        const float arc = 13.5f;
        const float drop = side.y - edge;
        const float way = t * (arc + drop);
        if (way < arc) {
            const Vec3 p = on_skull(angle, std::lerp(kTop, kEquator, way / arc));
            const Vec3 out = normalize_or(head_gradient(p, shape_, 0), p - kSkull);
            return {p + thickness(angle, t) * out, p - 0.5f * out};
        }
        const float down = way - arc;
        const Vec3 out(std::sin(angle), 0, std::cos(angle));
        const float curl = style_ == PersonHair::Bob ? -0.9f * ends : 0.0f;
        const float back = std::max(-std::cos(angle), 0.0f);
        const float shoulders = 4.6f * back * glm::smoothstep(9.0f, 20.0f, down);
        const float nape = -0.9f * back * glm::smoothstep(3.0f, 9.0f, down)
                           * (1 - glm::smoothstep(9.0f, 15.0f, down));
        const Vec3 p =
            side + (thickness(angle, t) + curl + shoulders + nape) * out - Vec3(0, down, 0);
        return {p, p - std::lerp(2.0f, 0.7f, ends) * out};
    }

    [[nodiscard]] Vec3 color_at(float angle, float t) const {
        const float locks = gradient_noise(
            Vec2(9.0f * std::sin(angle) + 3, 9.0f * std::cos(angle) + t), frame_.look.folds + 1);
        return glm::min(
            frame_.look.shape.hair_color * (1 + 0.35f * locks) * glm::mix(0.85f, 1.1f, t), Vec3(1));
    }

    void add_scalp() {
        std::vector<BodyRing> rings;
        const auto angle_of = [](int j) {
            return 2 * kPi * (static_cast<float>(j) / kHairColumns - 0.5f);
        };
        for (int r = 1; r <= kHairRows; ++r) {
            BodyRing ring;
            const float t = static_cast<float>(r) / kHairRows;
            ring.v = 0.16f * t;
            for (int j = 0; j < kHairColumns; ++j) {
                ring.vertices.push_back(
                    add_point(hair_point(angle_of(j), t).outer, color_at(angle_of(j), t)));
            }
            rings.push_back(ring);
        }
        for (int r = 0; r < kInnerRows; ++r) {
            BodyRing ring;
            const float t = 1 - static_cast<float>(r) / kHairRows;
            ring.v = 0.16f + 0.012f * static_cast<float>(r + 1);
            for (int j = 0; j < kHairColumns; ++j) {
                ring.vertices.push_back(
                    add_point(hair_point(angle_of(j), t).inner, 0.6f * color_at(angle_of(j), t)));
            }
            rings.push_back(ring);
        }
        constexpr float kColumn = 0.5f / kHairColumns;
        Vec3 mean(0);
        for (const std::uint32_t v : rings.front().vertices) {
            mean += mesh_.vertices[v].position / static_cast<float>(kHairColumns);
        }
        const Vec3 crown = hair_point(0, 0).outer;
        const Vec3 top = frame_.head_origin + 0.01f * frame_.head_scale * skew_head(crown, shape_);
        mesh_.cap(rings.front(), top - mean, kColumn, false);
        for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
            mesh_.join(rings[r], rings[r + 1], kColumn);
        }
        mesh_.cap(rings.back(), Vec3(0), kColumn, true);
    }

    void add_bun() {
        constexpr int kColumns = 14;
        constexpr int kRows = 8;
        constexpr float kRadius = 3.3f;
        const Vec3 root = on_skull(kPi, 0.45f);
        const Vec3 out = normalize_or(head_gradient(root, shape_, 0), Vec3(0, 0, -1));
        const Vec3 center = root + 2.6f * out;
        const Vec3 across(1, 0, 0);
        const Vec3 up = glm::cross(out, across);
        BodyRing last;
        for (int r = 1; r < kRows; ++r) {
            BodyRing ring;
            const float polar = kPi * static_cast<float>(r) / kRows;
            ring.v = 0.01f * kRadius * polar;
            for (int j = 0; j < kColumns; ++j) {
                const float turn = 2 * kPi * static_cast<float>(j) / kColumns + 0.5f * polar;
                const Vec3 p =
                    center
                    + kRadius
                          * (std::cos(polar) * 0.82f * out
                             + std::sin(polar) * (std::cos(turn) * across + std::sin(turn) * up));
                ring.vertices.push_back(add_point(p, color_at(turn, 0.6f)));
            }
            if (last.vertices.empty()) {
                mesh_.cap(ring, 0.0018f * out, 0.015f, false);
            } else {
                mesh_.join(last, ring, 0.015f);
            }
            last = ring;
        }
        mesh_.cap(last, -0.0018f * out, 0.015f, true);
    }

    BodyMesh& mesh_;
    const PersonFrame& frame_;
    HeadShape shape_;
    PersonHair style_;
};

}  // namespace

void add_hair(BodyMesh& mesh, const PersonFrame& frame) {
    HairBuilder(mesh, frame).add();
}

void add_eyes(BodyMesh& mesh, const PersonFrame& frame) {
    constexpr int kColumns = 12;
    struct EyeRing {
        float angle;  ///< from the axis [degrees]
        int color;    ///< 0 pupil, 1 iris, 2 rim of the iris, 3 white
    };
    constexpr std::array<EyeRing, 8> kRings = {
        {{8, 0}, {9.5f, 1}, {22, 1}, {25.5f, 2}, {28, 3}, {45, 3}, {68, 3}, {105, 3}}};
    const Vec3 white(0.50f, 0.47f, 0.45f);
    const std::array<Vec3, 4> colors = {
        {Vec3(0.004f), frame.look.iris_color, 0.35f * frame.look.iris_color, white}};
    const float radius = 0.0127f * frame.head_scale;
    for (const int side : {1, -1}) {
        const Vec3 center = frame.at(side > 0 ? PersonJoint::LeftEye : PersonJoint::RightEye);
        BodyRing last;
        for (const EyeRing& key : kRings) {
            BodyRing ring;
            const float polar = radians(key.angle);
            ring.v = radius * polar;
            for (int j = 0; j < kColumns; ++j) {
                const float turn = 2 * kPi * static_cast<float>(j) / kColumns;
                BodyVertex vertex;
                vertex.position = center
                                  + radius
                                        * Vec3(
                                            std::sin(polar) * std::cos(turn),
                                            std::sin(polar) * std::sin(turn), std::cos(polar));
                vertex.color = colors[key.color];
                vertex.zone = BodyZone::Eye;
                vertex.side = static_cast<std::int8_t>(side);
                ring.vertices.push_back(mesh.add(vertex));
            }
            if (last.vertices.empty()) {
                mesh.cap(ring, Vec3(0, 0, 0.0001f), 0.005f, false);
            } else {
                mesh.join(last, ring, 0.005f);
            }
            last = ring;
        }
        mesh.cap(last, Vec3(0, 0, -0.006f), 0.005f, true);
    }
}

}  // namespace limn
