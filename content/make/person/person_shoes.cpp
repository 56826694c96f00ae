#include "content/make/person/person_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace limn {

namespace {

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

}  // namespace limn
