#include "content/make/head/head_parts.h"
#include "content/make/head/head_surface.h"
#include "ecs/base/rng.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace limn {

namespace {

constexpr Vec3 kSkullCenter = {0, 5.5f, -0.5f};  ///< [cm]
constexpr float kImageWidth = 1.0f;              ///< of the image of strands [cm]
constexpr Vec3 kWhorl = {-0.9f, 13.0f, -4.5f};

/// Height of the hairline by the angle around the head from its front, on both sides.
struct HairlineKey {
    float angle;   ///< [degrees]
    float height;  ///< [cm]
};
constexpr std::array<HairlineKey, 12> kHairline = {{
    {0, 10.3f},
    {18, 10.2f},
    {32, 9.5f},
    {44, 8.2f},
    {56, 6.6f},
    {66, 4.2f},
    {72, 1.6f},
    {82, 1.4f},
    {88, 4.3f},
    {102, 3.6f},
    {118, -0.6f},
    {181, -4.4f},
}};

float hairline(const Vec3& p) {
    const float angle = std::atan2(std::abs(p.x), p.z) * 180 / kPi;
    std::size_t i = 1;
    while (i + 1 < kHairline.size() && kHairline[i].angle < angle) {
        ++i;
    }
    const HairlineKey& a = kHairline[i - 1];
    const HairlineKey& b = kHairline[i];
    return glm::mix(a.height, b.height, glm::smoothstep(a.angle, b.angle, angle));
}

/// The direction of hair at `p`: away from the whorl, across the forehead and down the sides.
Vec3 hair_flow(const Vec3& p, const Vec3& out) {
    const Vec3 away = glm::normalize(p - kWhorl);
    const float fringe = glm::smoothstep(7.5f, 10.5f, p.y) * glm::smoothstep(-2.0f, 5.0f, p.z);
    const Vec3 down = Vec3(0, -1.1f, 0) * (1 - glm::smoothstep(6.0f, 10.0f, p.y));
    const Vec3 flow = glm::mix(away + down, Vec3(0.75f, 0.25f, 0.55f), fringe);
    return glm::normalize(flow - glm::dot(flow, out) * out);
}

struct Card {
    Vec3 root, out, flow;  ///< out and flow: unit
    float length, width;   ///< [cm]
    float taper;           ///< fraction of the width that is lost to the tip
    float lift;            ///< of its tip from the scalp [cm]
    float strand;          ///< u of the image at its center line
    float shade;
    float root_shade;        ///< factor of the shade at the root, where less light arrives
    std::uint32_t rows = 3;  ///< of vertices
    float depth = 0.1f;      ///< of the root below the scalp [cm]
    float detail = 0;        ///< of the surface that it lies on
    float image_end = 1;     ///< v of the image at the tip
};

/// Points evenly on a sphere around the skull (R. Swinbank and R. Purser, "Fibonacci Grids", 2006),
/// from below, so that upper layers come last.
Vec3 around_skull(int i, int count) {
    const float up = -1 + 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const float turn = kPi * (3 - std::sqrt(5.0f)) * static_cast<float>(i);
    const float ring = std::sqrt(1 - up * up);
    return kSkullCenter + 9.0f * Vec3(ring * std::sin(turn), up, ring * std::cos(turn));
}

Vec3 to_scalp(Vec3 root, const HeadShape& shape, float detail = 0) {
    for (int step = 0; step < 3; ++step) {
        root = project_to_head(root, shape, detail);
    }
    return root;
}

void append_card(HeadPart& part, const Card& card, const HeadShape& shape) {
    const auto steps = static_cast<float>(card.rows - 1);
    Vec3 at = card.root - card.depth * card.out;
    Vec3 out = card.out;
    for (std::uint32_t row = 0; row < card.rows; ++row) {
        const float t = static_cast<float>(row) / steps;
        const float narrow = 1 - card.taper * t * t;
        if (row > 0) {
            const Vec3 flow = normalize_or(card.flow - glm::dot(card.flow, out) * out, card.flow);
            const Vec3 lie = hair_flow(at, out);
            at += card.length / steps * glm::normalize(glm::mix(flow, lie, 0.6f * t));
            const Vec3 slope = head_gradient(at, shape, card.detail);
            out = normalize_or(slope, out);
            const float rise = card.lift * std::sin(0.5f * kPi * std::min(1.6f * t, 1.0f));
            at += (rise - head_distance(at, shape, card.detail)) * out;
        }
        const Vec3 across = normalize_or(glm::cross(card.flow, out), Vec3(1, 0, 0));
        for (const float edge : {-1.0f, 1.0f}) {
            const Vec3 p = at + 0.5f * card.width * narrow * edge * across;
            part.points.push_back(bone_point(p, 0));
            part.mesh.positions.push_back(p);
            part.mesh.normals.push_back(glm::normalize(out + 0.2f * edge * across));
            part.mesh.uvs.emplace_back(
                card.strand + 0.5f * edge * card.width * narrow / kImageWidth, card.image_end * t);
            part.mesh.colors.emplace_back(
                Vec3(card.shade * glm::mix(card.root_shade, 1.0f, t)), 1.0f);
        }
    }
    append_grid(part.mesh, card.rows, 2, false);
}

/// Whether hair covers the scalp along both edges of a card.
bool is_covered(const Card& card, const HeadShape& shape) {
    const Vec3 across = glm::normalize(glm::cross(card.flow, card.out));
    for (const float along : {0.0f, 0.5f, 1.0f}) {
        for (const float edge : {-0.5f, 0.5f}) {
            const Vec3 p = card.root + along * card.length * card.flow + edge * card.width * across;
            if (scalp_hair_cover(to_scalp(p, shape)) < 0.8f) {
                return false;
            }
        }
    }
    return true;
}

/// Wide cards that lie on the scalp, so that hair, not skin, is visible between locks; narrow ones
/// along the hairline, where the corners of wide ones would be seen.
void append_undercoat(HeadPart& part, const HeadShape& shape) {
    constexpr int kCards = 700;
    for (int i = 0; i < kCards; ++i) {
        Card card;
        card.root = to_scalp(around_skull(i, kCards), shape);
        if (scalp_hair_cover(card.root) < 0.95f) {
            continue;
        }
        card.out = glm::normalize(head_gradient(card.root, shape, 0));
        card.flow = hair_flow(card.root, card.out);
        card.length = 2.4f;
        card.width = 2.0f;
        card.taper = 0.3f;
        if (!is_covered(card, shape)) {
            card.length = 0.9f;
            card.width = 0.5f;
            card.taper = 0.8f;
        }
        card.lift = 0.06f;
        card.strand = 0.37f * static_cast<float>(i);
        card.shade = 0.75f;
        card.root_shade = 1;
        append_card(part, card, shape);
    }
}

/// Single short hairs along the whole hairline, where cards end: thinner and fewer towards the
/// skin.
void append_fine_hairs(HeadPart& part, const HeadShape& shape) {
    constexpr int kHairs = 60000;  // on the whole sphere; some 500 are kept
    Random random(0, 0, name_hash("fine_hair"), 0);
    for (int i = 0; i < kHairs; ++i) {
        const std::array<float, 4> chance = {
            random.uniform(), random.uniform(), random.uniform(), random.uniform()};
        const Vec3 near = around_skull(i, kHairs);
        if (std::abs(near.y - hairline(near)) > 1.6f) {
            continue;
        }
        Card card;
        const Vec3 root = to_scalp(near, shape);  // the same at every age
        const float cover = scalp_hair_cover(root);
        if (cover > 0.32f || cover < 0.02f + 0.26f * chance[0]) {
            continue;
        }
        card.detail = 1;
        card.root = to_scalp(root, shape, card.detail);
        card.out = glm::normalize(head_gradient(card.root, shape, card.detail));
        const Vec3 flow = hair_flow(card.root, card.out);
        const Vec3 aside = glm::cross(card.out, flow);
        card.flow = glm::normalize(flow + 1.1f * (chance[1] - 0.5f) * aside);
        card.length = (0.7f + 1.2f * cover) * (0.6f + 0.8f * chance[2]);
        card.width = 0.035f + 0.04f * cover;
        card.taper = 0.85f;
        card.lift = 0.06f + 0.16f * chance[3];
        card.depth = 0.01f;
        card.image_end = 0.45f;  // every strand of the image is that long
        card.strand = 7.31f * chance[2] + 3.17f * chance[1];
        card.shade = 0.9f + 0.3f * chance[3];
        card.root_shade = 1;
        card.rows = 2;
        append_card(part, card, shape);
    }
}

}  // namespace

float scalp_hair_cover(const Vec3& p) {
    return glm::smoothstep(-0.5f, 0.7f, p.y - hairline(p));
}

HeadPart make_scalp_hair(const HeadShape& shape) {
    constexpr int kCards = 3500;  // on the whole sphere around the skull; some 2200 are kept
    HeadPart part;
    part.mesh.name = "scalp";
    append_undercoat(part, shape);
    Random random(0, 0, name_hash("scalp_hair"), 0);
    for (int i = 0; i < kCards; ++i) {
        const float aside_x = random.uniform() - 0.5f;
        const float aside_z = random.uniform() - 0.5f;
        const Vec3 root =
            to_scalp(around_skull(i, kCards) + 0.35f * Vec3(aside_x, 0, aside_z), shape);
        const float grown = random.uniform();
        const std::array<float, 4> chance = {
            random.uniform(), random.uniform(), random.uniform(), random.uniform()};
        const float cover = scalp_hair_cover(root);
        if (cover < 0.34f + 0.45f * grown) {
            continue;
        }
        const float edge =
            1 - glm::smoothstep(0.6f, 1.0f, cover);  // finer and shorter at the hairline
        Card card;
        card.root = root;
        card.out = glm::normalize(head_gradient(root, shape, 0));
        const Vec3 flow = hair_flow(root, card.out);
        const Vec3 aside = glm::cross(card.out, flow);
        card.flow = glm::normalize(flow + 0.4f * (chance[0] - 0.5f) * aside);
        const float top = glm::smoothstep(3.0f, 11.0f, root.y);
        card.length = glm::mix(2.1f, 4.2f, top) * (0.75f + 0.4f * chance[1]);
        card.length *= glm::mix(1.0f, 0.4f + 0.4f * chance[0], edge);
        card.width = glm::mix(0.38f, 0.6f, top) * (0.7f + 0.6f * chance[1]) * (1 - 0.7f * edge);
        // Its tip does not hang far below the hairline of sides and neck, where hair is cut.
        for (int cut = 0; cut < 8; ++cut) {
            const Vec3 middle = root + 0.5f * card.length * card.flow;
            const Vec3 tip = middle + 0.5f * card.length * hair_flow(middle, card.out);
            const bool fringe = tip.y > root.y - 0.3f * card.length;  // is brushed aside
            if (fringe || hairline(tip) - tip.y < 0.15f + 0.5f * square(chance[1])) {
                break;
            }
            card.length *= 0.78f;
            card.width *= 0.86f;
        }
        card.taper = 0.8f;
        card.lift = glm::mix(0.1f, 0.75f, top) * (0.35f + 0.75f * chance[2]);
        card.strand = 7.31f * chance[3] + 3.17f * chance[0];
        card.shade = 0.9f + 0.2f * chance[3];
        card.root_shade = glm::mix(0.85f, 0.6f, top);
        append_card(part, card, shape);
    }
    append_fine_hairs(part, shape);
    return part;
}

}  // namespace limn
