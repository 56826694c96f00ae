#include "content/load/faces/inside_mesh.h"

#include "ecs/components/surface.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace limn {

double winding_number(const MeshData& mesh, const Vec3& point) {
    double angle = 0;  // solid, of all triangles [sr]
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[i]] - point);
        const glm::dvec3 b(mesh.positions[mesh.indices[i + 1]] - point);
        const glm::dvec3 c(mesh.positions[mesh.indices[i + 2]] - point);
        const double la = glm::length(a);
        const double lb = glm::length(b);
        const double lc = glm::length(c);
        angle +=
            2
            * std::atan2(
                glm::dot(a, glm::cross(b, c)),
                la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return angle / (4 * std::numbers::pi);
}

}  // namespace limn
