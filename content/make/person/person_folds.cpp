#include "content/make/person/person_parts.h"
#include "ecs/base/gradient_noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn {

namespace {

constexpr float kFoldShade = 45.0f;  ///< per meter of a fold's height; by eye

}  // namespace

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
        const float across = p.x + p.y;  // of an arm
        float height = 0.0020f * noise({14, 9, 14}, 0);
        if (vertex.zone == BodyZone::Arm) {
            const float bend = std::exp(-square((vertex.along - elbow) / 0.075f));
            const float cuff = glm::smoothstep(elbow + 0.1f, elbow + 0.2f, vertex.along);
            const auto rings = [&](float step, std::uint32_t salt) {
                return gradient_noise(
                    Vec3(step * vertex.along, 7 * across + 3.0f * p.z, 9 * p.z), seed + salt);
            };
            height += 0.012f * std::max(bend, 0.7f * cuff) * rings(30, 1);
            height += 0.006f * rings(17, 2);
        } else if (vertex.zone == BodyZone::Leg) {
            const float knee = std::exp(-square((p.y - 0.48f) / 0.10f));
            const float ankle = std::exp(-square((p.y - 0.10f) / 0.09f));
            const float thigh = std::exp(-square((p.y - 0.72f) / 0.08f));
            height += 0.012f * knee * noise({9, 26, 9}, 3);
            height += 0.016f * ankle * noise({8, 34, 8}, 4);
            height += 0.006f * thigh * noise({22, 10, 22}, 6);
        } else if (vertex.zone == BodyZone::Trunk) {
            const float waist = std::exp(-square((p.y - 1.06f) / 0.10f));
            const float groin = std::exp(-square((p.y - 0.83f) / 0.05f));
            const float chest = std::exp(-square((p.y - 1.27f) / 0.09f));
            const float out = std::abs(p.x);
            const float side = glm::smoothstep(0.07f, 0.13f, out);
            height += 0.014f * waist * noise({7, 24, 7}, 5);
            height += 0.008f * groin * noise({12, 16, 12}, 6);
            height += 0.006f * chest * noise({18, 9, 18}, 7);
            // From the armpits down to the front and the back.
            const Vec3 slanted(30 * (0.8f * p.y - 0.6f * out), 6 * out, 9 * p.z);
            height += 0.010f * side * glm::smoothstep(1.34f, 1.26f, p.y)
                      * glm::smoothstep(1.02f, 1.1f, p.y) * gradient_noise(slanted, seed + 8);
            const PersonTop top = frame.look.shape.top;
            if ((top == PersonTop::Shirt || top == PersonTop::Coat) && p.z > 0) {
                height *= glm::smoothstep(0.01f, 0.07f, out);  // a placket is stiff
            }
        }
        const bool lifted = vertex.lift != Vec3(0);
        // Light reaches the bottom of a fold less.
        vertex.color =
            glm::min(vertex.color * std::clamp(1 + kFoldShade * height, 0.72f, 1.1f), Vec3(1));
        vertex.position += height * (lifted ? vertex.lift : normalize_or(normals[i], Vec3(0)));
    }
}

}  // namespace limn