#include "content/make/head/head_wrap.h"

#include "content/make/head/head_ear.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_shoulders.h"
#include "content/make/head/head_surface.h"
#include "ecs/base/jobs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

/// Mirrors `p`, of the left side, to the side of `vertex`.
Vec3 to_side(const HeadVertex& vertex, Vec3 p) {
    return vertex.left || vertex.loops == HeadLoops::Mouth ? p : Vec3(-p.x, p.y, p.z);
}

/// The outer edge of the margin, its inner edge, and the pocket between lids and ball.
Vec3 lid_point(const HeadVertex& vertex) {
    const Vec3 margin = lid_margin(vertex.angle);
    const int inwards = vertex.loop - kLidLoop;
    if (inwards == 0) {
        return margin;
    }
    const Vec3 offset = margin - kEyeCenter;
    const Vec3 direction = glm::normalize(offset);
    const float around = std::atan2(offset.y, offset.x);
    const float opening = std::acos(direction.z);
    constexpr std::array<float, 4> kOpen = {0, 0.3f, 0.65f, 1};
    const float angle =
        inwards < 5 ? glm::mix(opening, std::max(opening, 1.75f), kOpen[inwards - 1]) : 2.6f;
    const float radius = inwards == 1 ? std::max(kEyeRadius + 0.015f, glm::length(offset) - 0.2f)
                                      : kEyeRadius + 0.05f;
    return kEyeCenter
           + radius
                 * Vec3(
                     std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around),
                     std::cos(angle));
}

bool on_nose(const HeadVertex& vertex) {
    const Vec3& start = vertex.start;
    return vertex.loops == HeadLoops::None && start.z > 8 && std::abs(start.x) < 2.4f
           && start.y > -2 && start.y < 5;
}

/// A membrane from the rim to the grid until the nose has grown; then a rounded rim.
bool is_free_of_surface(const HeadVertex& vertex, float detail) {
    return vertex.loops == HeadLoops::Nostril && (detail < 1 || vertex.loop > kNostrilRim - 3);
}

/// Projects `p` onto the surface.
Vec3 project(
    const HeadVertex& vertex, const Vec3& p, const HeadShape& shape, float detail, int steps = 3) {
    if (is_free_of_surface(vertex, detail)) {
        return p;
    }
    return on_nose(vertex) ? project_forwards(p, shape, detail)
                           : project_to_head(p, shape, detail, steps);
}

/// Between the border of the lips, or a little beyond it, and where they touch: the red of the lips
/// rolls in there, and tapers to the corners of the mouth.
Vec3 lip_point(const HeadVertex& vertex, const HeadShape& shape, float detail) {
    constexpr float kBeyond = 0.13f;    // from the border to the loop outside of it [cm]
    constexpr float kThinning = 0.25f;  // with age
    constexpr std::array<float, 2> kRoll = {0.1f, 0.02f};  // depth where they touch, beside it [cm]
    const int outwards = kLipLoop - vertex.loop;
    const Vec3 line = lip_line(vertex.angle);
    const float side = std::copysign(1.0f, std::sin(vertex.angle));
    const float height =
        lip_height(vertex.angle) * (1 - kThinning * std::max(shape.age - 0.3f, 0.0f));
    constexpr int kRed = kLipLoop - kLipBorderLoop;
    const float red = std::min(static_cast<float>(outwards) / kRed, 1.0f);
    const float beyond = outwards > kRed ? kBeyond : 0.0f;
    const Vec3 at = {
        line.x * (1 + 0.012f * static_cast<float>(outwards) + 0.3f * beyond),
        line.y + side * (height * red + beyond * glm::smoothstep(0.0f, 0.3f, height)), 0};
    const float roll = outwards < 2 ? kRoll[outwards] : 0.0f;
    return {
        at.x, at.y,
        project_forwards(at, shape, detail).z
            - roll * glm::mix(0.3f, 1.0f, glm::smoothstep(0.0f, 0.3f, height))};
}

/// From where the lips touch to the back of the mouth.
Vec3 mouth_point(const HeadVertex& vertex, const HeadShape& shape, float detail) {
    struct Profile {
        float depth, open,
            width;  // behind the lips, above or below their line, fraction of its width
    };
    constexpr std::array<Profile, 7> kProfile = {{
        {0.10f, 0, 1},
        {0.35f, 0, 0.99f},
        {0.55f, 0.28f, 1.0f},
        {0.66f, 0.9f, 1.03f},
        {0.95f, 1.5f, 1.08f},
        {3.0f, 1.55f, 1.05f},
        {5.5f, 0.9f, 0.7f},
    }};
    const Profile& profile = kProfile[vertex.loop - kLipLoop];
    const Vec3 line = lip_line(vertex.angle);
    if (vertex.loop == kLipLoop) {
        return lip_point(vertex, shape, detail);
    }
    return {
        line.x * profile.width, line.y + profile.open * std::sin(vertex.angle),
        project_forwards({line.x, line.y, 0}, shape, detail).z - profile.depth};
}

/// The rim of a nostril, and its cavity, up into the nose.
Vec3 nostril_point(const HeadVertex& vertex, const HeadShape& shape, float detail) {
    struct Profile {
        float depth;  // [cm]
        float width;  // fraction of the rim's
    };
    constexpr std::array<Profile, kNostrilLoops - kNostrilRim + 1> kProfile = {{
        {0, 1},
        {0.07f, 0.88f},
        {0.2f, 0.72f},
        {0.45f, 0.74f},
        {0.8f, 0.72f},
        {1.15f, 0.35f},
    }};
    const Vec3 inwards = glm::normalize(Vec3(-0.2f, 0.9f, -0.05f));
    const Profile& profile = kProfile[vertex.loop - kNostrilRim];
    const Vec3 rim = project_to_head(nostril_rim(vertex.angle), shape, detail);
    const Vec3 opposite = project_to_head(nostril_rim(vertex.angle + kPi), shape, detail);
    return glm::mix(opposite, rim, 0.5f + 0.5f * profile.width) + profile.depth * inwards;
}

class HeadWrap {
  public:
    explicit HeadWrap(const HeadShape& shape)
        : shape_(shape), layout_(head_layout(shape.shoulders)),
          neighbors_(layout_.vertices.size()) {
        for (const auto& quad : layout_.quads) {
            for (int k = 0; k < 4; ++k) {
                neighbors_[quad[k]].push_back(quad[(k + 1) % 4]);
            }
        }
        for (std::uint32_t v = 0; v < layout_.vertices.size(); ++v) {
            positions_.push_back(
                shape.shoulders ? raise(layout_.vertices[v].start) : layout_.vertices[v].start);
            const bool end = at_end(layout_.vertices[v]);
            free_.push_back(!end);
        }
    }

    std::vector<Vec3> run() {
        constexpr int kSteps = 12;
        for (int step = 0; step <= kSteps; ++step) {
            const float detail = static_cast<float>(step) / kSteps;
            set_curves(detail);
            stretch_nostrils();
            for (int round = 0; round < (step == kSteps ? 6 : 2); ++round) {
                relax(detail);
            }
        }
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            if (free_[v]) {
                positions_[v] = project(layout_.vertices[v], positions_[v], shape_, 1);
            }
        }
        heal();
        set_ears();
        make_symmetric();
        return std::move(positions_);
    }

  private:
    /// Initial position of `p` of a neutral head: outside of and above the shoulders, since the
    /// nearest surface may be below.
    Vec3 raise(Vec3 p) const {
        constexpr float kStep = 0.2f;
        constexpr float kBelow = -8;  // [cm]
        p = from_neutral_shoulders(p, shape_);
        if (p.y < kBelow && p.y > kShouldersEnd) {
            const Vec3 out = glm::normalize(Vec3(p.x, std::abs(p.x), p.z + 3));
            for (int i = 0; i < 40 && head_distance(p, shape_, 0) < 0; ++i) {
                p += kStep * out;
            }
        }
        return p;
    }

    bool at_end(const HeadVertex& vertex) const {
        return vertex.chart.y >= static_cast<float>(layout_.rows);
    }

    void set_curves(float detail) {
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            const HeadVertex& vertex = layout_.vertices[v];
            if (vertex.loops == HeadLoops::Eye && vertex.loop >= kLidLoop) {
                positions_[v] = to_side(vertex, lid_point(vertex));
                free_[v] = false;
            } else if (vertex.loops == HeadLoops::Mouth && vertex.loop >= kLipLoop) {
                positions_[v] = mouth_point(vertex, shape_, detail);
                free_[v] = false;
            } else if (vertex.loops == HeadLoops::Mouth && vertex.loop >= kLipBorderLoop - 1) {
                positions_[v] = lip_point(vertex, shape_, detail);
                free_[v] = false;
            } else if (vertex.loops == HeadLoops::Nostril && vertex.loop >= kNostrilRim) {
                positions_[v] = to_side(vertex, nostril_point(vertex, shape_, detail));
                free_[v] = false;
            } else if (at_end(vertex)) {
                for (int step = 0; step < 2; ++step) {  // a planar ring, where a body begins
                    positions_[v] = project_to_head(positions_[v], shape_, detail);
                    positions_[v].y = vertex.start.y;
                }
            }
        }
    }

    /// Interpolates between the grid and the rims, which have moved.
    void stretch_nostrils() {
        for (int round = 0; round < 30; ++round) {
            for (std::size_t v = 0; v < positions_.size(); ++v) {
                if (free_[v] && layout_.vertices[v].loops == HeadLoops::Nostril) {
                    positions_[v] = mean_around(positions_, v);
                }
            }
        }
    }

    void relax(float detail) {
        const std::vector<Vec3> before = positions_;
        parallel_for(positions_.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::vector<std::size_t> nose;
            std::vector<Vec3> on_nose_points;
            for (std::size_t v = begin; v < end; ++v) {
                if (!free_[v]) {
                    continue;
                }
                const Vec3 moved =
                    to_lid(layout_.vertices[v], glm::mix(before[v], mean_around(before, v), 0.35f));
                if (on_nose(layout_.vertices[v])) {
                    nose.push_back(v);
                    on_nose_points.push_back(moved);
                } else {
                    positions_[v] = project(layout_.vertices[v], moved, shape_, detail, 1);
                }
            }
            project_forwards(on_nose_points, shape_, detail);
            for (std::size_t i = 0; i < nose.size(); ++i) {
                positions_[nose[i]] = on_nose_points[i];
            }
        });
    }

    /// Moves `p` of a loop of the upper lid towards its height between the lid's edge and its fold,
    /// or beside that, so that a loop lies in the fold; not at the corners, where loops meet. The
    /// next loops stay above these, however far the brow of a man comes down.
    static Vec3 to_lid(const HeadVertex& vertex, Vec3 p) {
        constexpr float kAbove = 0.2f;   // from the fold to the next loop [cm]
        constexpr float kApart = 0.13f;  // of further ones, at least [cm]
        constexpr int kFurther = 3;
        if (vertex.loops != HeadLoops::Eye || vertex.loop >= kLidLoop
            || vertex.loop < kLidCreaseLoop - 1 - kFurther) {
            return p;
        }
        const Vec3 margin = lid_margin(vertex.angle);
        const float up = static_cast<float>(kLidLoop - vertex.loop) / (kLidLoop - kLidCreaseLoop);
        const float crease = lid_crease(margin.x);
        const float height = up > 1 ? crease + kAbove : glm::mix(margin.y, crease, up);
        const float share = glm::smoothstep(0.4f, 0.75f, std::sin(vertex.angle));
        if (const int further = kLidCreaseLoop - 1 - vertex.loop; further > 0) {
            const float lowest = crease + kAbove + kApart * static_cast<float>(further);
            p.y = glm::mix(p.y, std::max(p.y, lowest), share);
            return p;
        }
        p.y = glm::mix(p.y, height, share);
        p.x = glm::mix(p.x, std::copysign(margin.x, p.x), share);
        return p;
    }

    /// Smooths the mesh where it is folded, where its normal differs from that of the surface.
    void heal() {
        std::vector<Vec3> normals(positions_.size(), Vec3(0));
        for (const auto& quad : layout_.quads) {
            const Vec3 normal = glm::cross(
                positions_[quad[2]] - positions_[quad[0]],
                positions_[quad[3]] - positions_[quad[1]]);
            for (const std::uint32_t v : quad) {
                normals[v] += normalize_or(normal, Vec3(0));
            }
        }
        constexpr int kRings = 2;  // around what is folded
        std::vector<int> ring(positions_.size(), kRings + 1);
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            const Vec3 out = head_gradient(positions_[v], shape_, 1);
            if (free_[v] && layout_.vertices[v].loops == HeadLoops::None
                && glm::dot(normalize_or(normals[v], out), normalize_or(out, Vec3(0))) < 0.7f) {
                ring[v] = 0;
            }
        }
        for (int grown = 1; grown <= kRings; ++grown) {
            for (std::size_t v = 0; v < positions_.size(); ++v) {
                for (const std::uint32_t other : neighbors_[v]) {
                    ring[v] = std::min(ring[v], ring[other] == grown - 1 ? grown : kRings + 1);
                }
            }
        }
        for (int round = 0; round < 10; ++round) {
            const std::vector<Vec3> before = positions_;
            for (std::size_t v = 0; v < positions_.size(); ++v) {
                if (free_[v] && ring[v] <= kRings) {
                    const Vec3 smoothed = glm::mix(before[v], mean_around(before, v), 0.5f);
                    const bool nose = round >= 5 && on_nose(layout_.vertices[v]);
                    positions_[v] = nose ? project_to_head(smoothed, shape_, 1, 1) : smoothed;
                }
            }
        }
    }

    /// At the corners of eyes and mouth, where loops turn sharply, mostly the mean of neighbors on
    /// other loops: along a loop the mean lies beyond the opening.
    Vec3 mean_around(const std::vector<Vec3>& positions, std::size_t v) const {
        const HeadVertex& vertex = layout_.vertices[v];
        const bool opening = vertex.loops == HeadLoops::Eye || vertex.loops == HeadLoops::Mouth;
        const float corner = glm::smoothstep(0.5f, 0.9f, std::abs(std::cos(vertex.angle)));
        const float along = opening ? glm::mix(1.0f, 0.05f, corner) : 1.0f;
        Vec3 sum = Vec3(0);
        float weights = 0;
        for (const std::uint32_t other : neighbors_[v]) {
            const float weight = layout_.vertices[other].loop == vertex.loop ? along : 1.0f;
            sum += weight * positions[other];
            weights += weight;
        }
        return sum / weights;
    }

    void set_ears() {
        const Vec3 root = project_to_head({7, 0.95f, -0.3f}, shape_, 1) + Vec3(0.6f, 0, 0.1f);
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            const HeadVertex& vertex = layout_.vertices[v];
            if (vertex.loops == HeadLoops::Ear) {
                const Vec3 p = ear_point(vertex, root);
                const float cheek = ear_on_cheek(vertex);
                positions_[v] = to_side(vertex, glm::mix(p, project_to_head(p, shape_, 1), cheek));
            }
        }
    }

    void make_symmetric() {
        const std::vector<Vec3> before = positions_;
        for (std::size_t v = 0; v < positions_.size(); ++v) {
            const Vec3& other = before[layout_.mirror[v]];
            positions_[v] = 0.5f * (before[v] + Vec3(-other.x, other.y, other.z));
        }
        for (Vec3& p : positions_) {
            p = skew_head(p, shape_);
        }
    }

    HeadShape shape_;
    const HeadLayout& layout_;
    std::vector<std::vector<std::uint32_t>> neighbors_;
    std::vector<Vec3> positions_;
    std::vector<bool> free_;
};

}  // namespace

Vec3 skew_head(Vec3 p, const HeadShape& shape) {
    const float skewed = shape.asymmetry * glm::smoothstep(-20.0f, -14.5f, p.y);  // no shoulders
    const float low = glm::smoothstep(6.0f, -7.0f, p.y);
    p.x += skewed * 0.18f * low * glm::smoothstep(0.0f, 8.0f, p.z);
    p.y += skewed * 0.02f * p.x;
    return p;
}

std::vector<Vec3> wrap_head(const HeadShape& shape) {
    return HeadWrap(shape).run();
}

}  // namespace limn
