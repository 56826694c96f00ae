#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "content/make/person/person_face.h"
#include "content/make/person/person_head_shape.h"
#include "content/make/person/person_parts.h"
#include "ecs/base/gradient_noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

namespace {

// Lengths in the space of the head are centimeters.

constexpr Vec3 kSkull = {0, 5.5f, -0.5f};
constexpr int kHairColumns = 36;
constexpr int kHairRows = 11;
constexpr int kHangingColumns = 60;  ///< of hair that falls, near: four per clump
constexpr int kHangingRows = 13;
constexpr int kClumps = 15;
constexpr int kPartColumn = 3;          ///< of the parting, from the middle
constexpr float kBunElevation = 0.45f;  ///< [rad]

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
          style_(frame.look.shape.hair), is_near_(has_face_shapes(frame.look.shape)),
          part_((frame.look.folds & 1u) != 0 ? kPartColumn : -kPartColumn) {}

    void add() {
        if (style_ == PersonHair::Bald) {
            return;
        }
        add_shell();
        if (style_ == PersonHair::Bun) {
            add_bun();
        }
        if (is_near_) {
            add_locks();
        }
    }

  private:
    [[nodiscard]] Vec3 in_body(const Vec3& p) const {
        return head_in_body(frame_, skew_head(p, shape_));
    }

    std::uint32_t add_point(const Vec3& p, const Vec3& color) {
        BodyVertex vertex;
        vertex.position = in_body(p);
        vertex.color = color;
        vertex.zone = BodyZone::Head;
        return mesh_.add(vertex);
    }

    [[nodiscard]] float noise(float x, float y, std::uint32_t salt) const {
        return gradient_noise(Vec2(x, y), frame_.look.folds + salt);
    }

    [[nodiscard]] bool hangs() const {
        return style_ == PersonHair::Bob || style_ == PersonHair::Long;
    }

    /// Strands that fall together: 1 on the ridge of a clump, 0 in the groove beside it. Shallow on
    /// the skull; none from afar.
    [[nodiscard]] float clump(float angle, float t) const {
        if (!is_near_ || !hangs()) {
            return 0;
        }
        const float drift = noise(2 * std::sin(angle) + 5, 2 * std::cos(angle) + 0.8f * t, 4);
        return std::abs(std::sin(0.5f * kClumps * angle + 1.3f * drift));
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
        switch (style_) {
        case PersonHair::Short:  // shorter down the sides and the nape, longest above the forehead
            return 0.4f + 0.9f * glm::smoothstep(0.1f, 0.7f, top)
                   + 0.9f * square(front) * glm::smoothstep(0.0f, 0.35f, top)
                         * glm::smoothstep(1.0f, 0.5f, top);
        case PersonHair::Bun:
            return 0.6f;
        default: {
            // Over the ears, and flatter at the parting.
            const float ears = 0.7f * std::exp(-square((std::abs(angle) - 1.6f) / 0.4f))
                               * glm::smoothstep(0.3f, 0.55f, t);
            return (glm::mix(1.25f, 1.0f, top) + ears) * (1 - 0.4f * parting(angle, t));
        }
        }
    }

    /// 1 on the parting, a line from the crown to the forehead.
    [[nodiscard]] float parting(float angle, float t) const {
        const float away = (angle - part_angle()) * std::max(t, 0.12f) / 0.1f;
        return std::exp(-square(away)) * glm::smoothstep(0.05f, 0.2f, t);
    }

    [[nodiscard]] float part_angle() const {
        return 2 * kPi * static_cast<float>(part_) / kHairColumns;
    }

    struct HairPlace {
        Vec3 root = {};      ///< on the skull, or where hair falls
        Vec3 out = {};       ///< a unit vector
        bool falls = false;  ///< free of the skull
        float thick = 0;     ///< of the hair there
    };

    /// `t`: 0 at the crown, 1 at the edge.
    [[nodiscard]] HairPlace place(float angle, float t) const {
        constexpr float kEquator = 0.02f;  // elevation where hair leaves the skull
        constexpr float kTop = 0.5f * kPi;
        constexpr float kArc = 13.5f;  // from the crown to there
        const float edge = edge_height(edge_keys(style_), angle) - 1.1f * clump(angle, 1)
                           + (hangs() ? 0.6f * noise(4 * angle, 0.7f, 5) : 0.0f);
        const float last = std::atan2(edge - kSkull.y, 9.2f);
        const float thick =
            thickness(angle, t) + 0.5f * (clump(angle, t) - 0.6f) * glm::smoothstep(0.1f, 0.6f, t);
        const auto on_head = [&](float elevation) {
            const Vec3 p = on_skull(angle, elevation);
            return HairPlace{
                p, normalize_or(head_gradient(p, shape_, 0), p - kSkull), false, thick};
        };
        if (!hangs() || last >= kEquator) {
            return on_head(std::lerp(kTop, last, t));
        }
        // On the skull to the equator, then down.
        const Vec3 side = on_skull(angle, kEquator);
        const float way = t * (kArc + side.y - edge);
        if (way < kArc) {
            return on_head(std::lerp(kTop, kEquator, way / kArc));
        }
        const float down = way - kArc;
        const float ends = glm::smoothstep(0.75f, 1.0f, t);
        const Vec3 out(std::sin(angle), 0, std::cos(angle));
        const float back = std::max(-std::cos(angle), 0.0f);
        const float curl = style_ == PersonHair::Bob ? -1.0f * ends : 0.35f * std::sin(0.5f * down);
        const float shoulders = 4.6f * back * glm::smoothstep(9.0f, 20.0f, down);
        const float nape = -0.4f * back * glm::smoothstep(3.0f, 9.0f, down)
                           * (1 - glm::smoothstep(9.0f, 15.0f, down));
        // Beside the face it comes forward a little, over the collar bones.
        const float front = glm::smoothstep(9.0f, 18.0f, down) * square(std::sin(angle));
        return {
            side + (curl + shoulders + nape) * out + Vec3(0, -down, 1.5f * front), out, true,
            thick};
    }

    /// Ends are thin.
    [[nodiscard]] static Vec3 outer(const HairPlace& place, float t) {
        const float ends = glm::smoothstep(0.80f, 1.0f, t);
        const float least = place.falls ? 0.7f * place.thick : 0.22f;
        return place.root + std::lerp(place.thick, least, ends * ends) * place.out;
    }

    [[nodiscard]] Vec3 color_at(float angle, float t) const {
        const float locks = noise(9.0f * std::sin(angle) + 3, 9.0f * std::cos(angle) + t, 1);
        const float line = hangs() ? 1 - 0.45f * parting(angle, t) : 1.0f;
        return glm::min(
            frame_.look.shape.hair_color * (1 + 0.3f * locks) * line * glm::mix(0.8f, 1.08f, t),
            Vec3(1));
    }

    /// One closed surface: the outer side, and the inner one up to the skull.
    void add_shell() {
        constexpr int kInnerRows = 5;
        const bool fine = is_near_ && hangs();
        const int columns = fine ? kHangingColumns : kHairColumns;
        const int rows = fine ? kHangingRows : kHairRows;
        std::vector<BodyRing> rings;
        const auto angle_of = [columns](int j) {
            return 2 * kPi * (static_cast<float>(j) / static_cast<float>(columns) - 0.5f);
        };
        for (int r = 1; r <= rows; ++r) {
            BodyRing ring;
            const float t = static_cast<float>(r) / static_cast<float>(rows);
            ring.v = 0.16f * t;
            for (int j = 0; j < columns; ++j) {
                const float angle = angle_of(j);
                ring.vertices.push_back(add_point(outer(place(angle, t), t), color_at(angle, t)));
            }
            rings.push_back(ring);
        }
        for (int r = 0; r < kInnerRows; ++r) {
            BodyRing ring;
            // Those of the outer side, every second where it hangs.
            const int row = rows - (hangs() ? 2 * r : r);
            ring.v = 0.16f + 0.012f * static_cast<float>(r + 1);
            for (int j = 0; j < columns; ++j) {
                const float angle = angle_of(j);
                const float t = static_cast<float>(row) / static_cast<float>(rows);
                const HairPlace at = place(angle, t);
                const Vec3 inner = at.root - (at.falls ? 0.2f : 0.5f) * at.out;
                ring.vertices.push_back(add_point(inner, 0.4f * color_at(angle, t)));
            }
            rings.push_back(ring);
        }
        const float column = 0.5f / static_cast<float>(columns);
        Vec3 mean(0);
        for (const std::uint32_t v : rings.front().vertices) {
            mean += mesh_.vertices[v].position / static_cast<float>(columns);
        }
        mesh_.cap(rings.front(), in_body(outer(place(0, 0), 0)) - mean, column, false);
        for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
            mesh_.join(rings[r], rings[r + 1], column);
        }
        mesh_.cap(rings.back(), Vec3(0), column, true);
    }

    struct LockPoint {
        Vec3 center;
        Vec3 out;
    };

    /// A strand of hair that lies on the others and ends in a point, as a closed ridge. `half`: its
    /// width, `height`: of its ridge [cm], `tip`: how far it ends beyond its last point.
    void add_lock(
        const std::vector<LockPoint>& path, float half, float height, float tip, float shade,
        float from) {
        constexpr float kSunk = 0.3f;
        constexpr float kRootEnd = 0.01f;  // textures of strands begin with a gap
        BodyRing last;
        float length = 0;
        const std::size_t count = path.size();
        for (std::size_t i = 0; i < count; ++i) {
            const float s = static_cast<float>(i) / static_cast<float>(count - 1);
            const Vec3& center = path[i].center;
            const Vec3 ahead = normalize_or(
                path[std::min(i + 1, count - 1)].center - path[i == 0 ? 0 : i - 1].center,
                Vec3(0, -1, 0));
            const Vec3 side = normalize_or(glm::cross(path[i].out, ahead), Vec3(1, 0, 0));
            const float wide = half * std::sqrt(std::sin(kPi * (0.12f + 0.76f * s)));
            const float high = height * std::sin(kPi * (0.08f + 0.82f * s));
            length += i == 0 ? 0 : glm::distance(center, path[i - 1].center);
            const Vec3 color = glm::min(
                shade * frame_.look.shape.hair_color
                    * std::lerp(0.85f, 1.15f, std::lerp(from, 1.0f, s)),
                Vec3(1));
            BodyRing ring;
            ring.v = kRootEnd + 0.01f * length;
            const Vec3 low = center - kSunk * path[i].out;
            ring.vertices = {
                add_point(low - wide * side, 0.75f * color),
                add_point(center + high * path[i].out, color),
                add_point(low + wide * side, 0.75f * color)};
            if (last.vertices.empty()) {
                mesh_.cap(ring, Vec3(0), 0.006f, false);
            } else {
                mesh_.join(last, ring, 0.006f);
            }
            last = ring;
        }
        const Vec3 ahead = path[count - 1].center - path[count - 2].center;
        mesh_.cap(
            last, 0.01f * frame_.head_scale * tip * normalize_or(ahead, Vec3(0, -1, 0)), 0.006f,
            true);
    }

    struct Flow {
        float angle0, t0;  ///< where it begins
        float angle1, t1;  ///< where it ends
    };

    void add_flow(const Flow& flow, int points, float half, float height, float tip, float shade) {
        std::vector<LockPoint> path;
        for (int i = 0; i < points; ++i) {
            const float s = static_cast<float>(i) / static_cast<float>(points - 1);
            const float bend = s * (2 - s);  // turns first, then runs straight
            const float angle = std::lerp(flow.angle0, flow.angle1, bend);
            const float t = std::lerp(flow.t0, flow.t1, s);
            const HairPlace at = place(angle, t);
            path.push_back({at.root + std::lerp(1.0f, 0.95f, s) * at.thick * at.out, at.out});
        }
        add_lock(path, half, height, tip, shade, flow.t0);
    }

    void add_locks() {
        const float side = part_ > 0 ? -1.0f : 1.0f;
        const auto shade = [&](int k) {
            return 1 + 0.35f * noise(1.7f * static_cast<float>(k) + 0.4f, 0.3f, 2);
        };
        if (style_ == PersonHair::Bun) {
            return add_bun_locks();
        }
        if (style_ == PersonHair::Short) {
            constexpr int kLocks = 25;
            for (int k = 0; k < kLocks; ++k) {
                const float angle = 2 * kPi * (static_cast<float>(k) / kLocks - 0.5f);
                const float front = square(0.5f + 0.5f * std::cos(angle));
                const float vary = noise(2.3f * static_cast<float>(k) + 0.7f, 0.6f, 3);
                const float sweep = side * (0.35f + 0.5f * front);
                add_flow(
                    {angle - sweep, 0.2f + 0.12f * static_cast<float>(k % 2), angle + 0.1f * vary,
                     0.9f + 0.07f * vary},
                    4, 1.15f, std::lerp(0.3f, 0.6f, front), 0.3f + 0.7f * front, shade(k));
            }
            return;
        }
        // From the parting to both sides of the face; the rest falls in clumps.
        constexpr int kLocks = 8;
        constexpr float kFaceEdge = 0.8f;  // beside the forehead [rad]
        for (int k = 0; k < kLocks; ++k) {
            const float way = k % 2 == 0 ? 1.0f : -1.0f;
            const float away = 0.1f * static_cast<float>(k / 2);
            const float vary = noise(1.9f * static_cast<float>(k) + 0.2f, 0.8f, 3);
            const float begin = std::lerp(0.8f, 0.08f, std::min(2.2f * away, 1.0f));
            add_flow(
                {part_angle() + way * std::lerp(0.12f, 2.6f, away), begin,
                 part_angle() + way * std::lerp(kFaceEdge, kPi - 0.1f, away),
                 0.985f + 0.015f * vary},
                6, 1.3f + 0.4f * away, 0.4f + 0.15f * vary, 1.2f + 0.8f * vary, shade(k));
        }
    }

    /// From the edge of the hair to the bun.
    void add_bun_locks() {
        constexpr int kLocks = 15;
        constexpr int kPoints = 5;
        const Vec3 bun = normalize_or(on_skull(kPi, kBunElevation) - kSkull, Vec3(0, 0, -1));
        for (int k = 0; k < kLocks; ++k) {
            const float angle = 1.75f * kPi * (static_cast<float>(k) / (kLocks - 1) - 0.5f);
            const HairPlace edge = place(angle, 0.95f);
            const Vec3 first = normalize_or(edge.root - kSkull, Vec3(0, 0, 1));
            std::vector<LockPoint> path;
            for (int i = 0; i < kPoints; ++i) {
                const float s = static_cast<float>(i) / (kPoints - 1);
                const Vec3 way = normalize_or(glm::mix(first, bun, 0.92f * s), bun);
                const Vec3 p = project_to_head(kSkull + 9.0f * way, shape_, 0, 4);
                path.push_back({p + 0.55f * way, way});
            }
            const float shade = 1 + 0.3f * noise(1.7f * static_cast<float>(k) + 0.4f, 0.3f, 2);
            add_lock(path, 1.2f, 0.22f, 0.5f, shade, 0.3f);
        }
    }

    void add_bun() {
        constexpr int kColumns = 14;
        constexpr int kRows = 8;
        constexpr float kRadius = 3.3f;
        const Vec3 root = on_skull(kPi, kBunElevation);
        const Vec3 out = normalize_or(head_gradient(root, shape_, 0), Vec3(0, 0, -1));
        const Vec3 center = root + 2.4f * out;
        const Vec3 across(1, 0, 0);
        const Vec3 up = glm::cross(out, across);
        BodyRing last;
        for (int r = 1; r < kRows; ++r) {
            BodyRing ring;
            const float polar = kPi * static_cast<float>(r) / kRows;
            ring.v = 0.01f * kRadius * polar;
            for (int j = 0; j < kColumns; ++j) {
                const float turn = 2 * kPi * static_cast<float>(j) / kColumns + 1.1f * polar;
                // Coils of hair.
                const float coil = 1 + 0.09f * std::sin(2 * (turn - 2.5f * polar));
                const Vec3 p =
                    center
                    + coil * kRadius
                          * (std::cos(polar) * 0.78f * out
                             + std::sin(polar) * (std::cos(turn) * across + std::sin(turn) * up));
                ring.vertices.push_back(add_point(p, (1.6f * coil - 0.6f) * color_at(turn, 0.6f)));
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
    bool is_near_;
    int part_;  ///< column of the parting, counted from the front
};

}  // namespace

void add_hair(BodyMesh& mesh, const PersonFrame& frame) {
    HairBuilder(mesh, frame).add();
}

void add_eyes(BodyMesh& mesh, const PersonFrame& frame) {
    constexpr int kColumns = 10;
    struct EyeRing {
        float angle;  ///< from the axis [degrees]
        int color;    ///< 0 pupil, 1 iris, 2 rim of the iris, 3 white
    };
    constexpr std::array<EyeRing, 7> kRings = {
        {{8, 0}, {9.5f, 1}, {22, 1}, {25.5f, 2}, {28, 3}, {50, 3}, {100, 3}}};
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
