#include "content/make/head/head_parts.h"
#include "content/make/head/head_surface.h"
#include "ecs/base/rng.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>

namespace limn {

namespace {

struct Strand {
    Vec3 root, control, tip;  ///< of a quadratic Bezier curve, on the left side
    Vec3 across;              ///< direction of the ribbon's width, unit
    float width;              ///< at the root [cm]
    std::uint32_t rows = 5;   ///< of vertices: fewer suffice for straight strands
    HeadPoint point;          ///< of the skin that it grows on
};

void append_strand(HeadPart& part, const Strand& strand, float side, float shade) {
    for (std::uint32_t row = 0; row < strand.rows; ++row) {
        const float t = static_cast<float>(row) / static_cast<float>(strand.rows - 1);
        const Vec3 at = glm::mix(
            glm::mix(strand.root, strand.control, t), glm::mix(strand.control, strand.tip, t), t);
        const Vec3 half = 0.5f * strand.width * (1 - 0.85f * t * t) * strand.across;
        for (const float edge : {-1.0f, 1.0f}) {
            HeadPoint point = strand.point;
            point.rest = (at + edge * half) * Vec3(side, 1, 1);
            part.mesh.positions.push_back(point.rest);
            part.mesh.uvs.emplace_back(0.5f + 0.5f * edge, t);
            part.mesh.colors.emplace_back(Vec3(shade), 1.0f);
            part.points.push_back(point);
        }
    }
    append_grid(part.mesh, strand.rows, 2, false, side > 0);
}

void append_both(HeadPart& part, const Strand& strand, float shade) {
    append_strand(part, strand, 1, shade);
    append_strand(part, strand, -1, shade);
}

void add_lashes(HeadPart& part, Random& random, bool upper) {
    const int count = upper ? 120 : 55;  // a row of three, N. Elder (1997): 90 to 150, 70 to 80
    for (int i = 0; i < count; ++i) {
        const float along = (static_cast<float>(i) + random.uniform()) / static_cast<float>(count);
        const float turn = glm::mix(0.1f, 0.93f, along) * kPi;  // from the outer corner inwards
        const float angle = upper ? turn : -turn;
        const Vec3 root = lid_margin(angle);
        const Vec3 beside = lid_margin(angle + 0.02f);
        const Vec3 out = glm::normalize(root - kEyeCenter);
        // Three by three they lean together, as wet lashes do.
        const float lean = 0.16f * (1 - static_cast<float>(i % 3));
        const float fan = 0.55f * std::cos(turn) + lean + 0.14f * (random.uniform() - 0.5f);
        const float arch = std::sin(turn);
        const float length = (upper ? 0.52f + 0.28f * arch : 0.3f + 0.14f * arch)
                             * (0.8f + 0.35f * random.uniform());
        const float curl = upper ? 1.0f : -0.8f;
        Strand strand;
        strand.root = root - 0.02f * out;
        const float rise = 0.5f + 0.4f * random.uniform();
        const Vec3 forward = glm::normalize(0.6f * out + Vec3(0.8f * fan, -0.3f * curl, 0.7f));
        const Vec3 up = glm::normalize(0.5f * out + Vec3(1.1f * fan, rise * curl, 0.5f));
        strand.control = strand.root + 0.55f * length * forward;
        strand.tip = strand.control + 0.6f * length * up;
        strand.across = glm::normalize(beside - root);
        strand.width = upper ? 0.013f : 0.008f;
        strand.point.loops = HeadLoops::Eye;
        strand.point.loop = kLidLoop;
        strand.point.angle = angle;
        append_both(part, strand, 0.7f + 0.5f * random.uniform());
    }
}

/// The center line of the brow from the nose outwards, as x and y.
Vec3 brow_line(float t) {
    const Vec2 line = glm::mix(
        glm::mix(Vec2(1.2f, 4.95f), Vec2(3.5f, 5.85f), t),
        glm::mix(Vec2(3.5f, 5.85f), Vec2(5.5f, 4.75f), t), t);
    return {line, 0};
}

void add_brows(HeadPart& part, Random& random, const HeadShape& shape) {
    const int count = 520 + static_cast<int>(120 * shape.sex);
    for (int i = 0; i < count; ++i) {
        const float u = random.uniform();  // sparser towards its end
        const float t = u * (0.75f + 0.25f * u) - 0.12f * random.uniform();
        const float height = 0.38f * (1 - 0.5f * t * t) * glm::smoothstep(-0.3f, 0.2f, t)
                             * (0.85f + 0.2f * shape.sex);
        const float v = random.uniform() + random.uniform() - 1;
        Vec3 root = brow_line(t) + Vec3(0, v * height, 10);
        root = project_forwards(root, shape, 1);
        // Upright beside the nose, then along the brow and towards its center line.
        const Vec3 ahead =
            glm::normalize(brow_line(std::min(t + 0.02f, 1.0f)) - brow_line(t - 0.01f));
        const float rise = glm::mix(1.6f, 0.1f, glm::smoothstep(-0.1f, 0.4f, t)) - 0.3f * v * t;
        const Vec3 out = glm::normalize(head_gradient(root, shape, 1));
        const Vec3 lay = glm::normalize(
            ahead + Vec3(0, rise, 0)
            + 0.25f * Vec3(random.uniform() - 0.5f, random.uniform() - 0.5f, 0));
        const Vec3 along = glm::normalize(lay - glm::dot(lay, out) * out);
        const float length = (0.75f - 0.35f * t) * (0.7f + 0.5f * random.uniform());
        Strand strand;
        strand.root = root - 0.02f * out;
        strand.control = root + 0.5f * length * along + 0.09f * out;
        strand.tip = root + length * along + 0.055f * out;
        strand.tip -= head_distance(strand.tip, shape, 1) * out - 0.05f * out;
        strand.across = glm::normalize(glm::cross(out, along));
        strand.rows = 3;  // within 0.1 mm of the curve
        strand.width =
            0.017f * glm::smoothstep(-0.3f, 0.15f, t) * (1 - 0.5f * glm::smoothstep(0.5f, 1.0f, t))
            + 0.002f;
        append_both(part, strand, 0.7f + 0.6f * random.uniform());
    }
}

}  // namespace

HeadPart make_face_hair(const HeadShape& shape) {
    HeadPart part;
    part.mesh.name = "hair";
    Random random(0, 0, name_hash("face_hair"), 0);
    add_lashes(part, random, true);
    add_lashes(part, random, false);
    add_brows(part, random, shape);
    return part;
}

}  // namespace limn
