#include "content/make/models/joined.h"

#include "content/bake/tangents.h"

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <cstdint>

namespace limn {
namespace {

constexpr std::size_t kMaxVertices = 1000000;

void append_part(MeshData& mesh, const MeshData& source, const JoinedPart& part) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Quat turn = glm::normalize(part.rotation);
    const Vec3 scale =
        glm::max(part.scale, Vec3(1e-3f));  // positive, so that no part is turned inside out
    for (std::size_t v = 0; v < source.positions.size(); ++v) {
        const Vec3 normal = normalize_or(source.normals[v] / scale, source.normals[v]);
        const Vec4 old = source.tangents[v];
        const Vec3 tangent = normalize_or(Vec3(old) * scale, Vec3(old));
        const Vec4 color = v < source.colors.size() ? source.colors[v] : Vec4(1);
        mesh.positions.push_back(part.position + turn * (source.positions[v] * scale));
        mesh.normals.push_back(turn * normal);
        mesh.tangents.emplace_back(turn * tangent, old.w);
        mesh.uvs.push_back(source.uvs[v]);
        mesh.colors.push_back(color * Vec4(part.color, 1.0f));
    }
    for (const std::uint32_t index : source.indices) {
        mesh.indices.push_back(first + index);
    }
}

/// Copies all attributes of a vertex.
bool is_whole(const MeshData& mesh) {
    const std::size_t count = mesh.positions.size();
    return mesh.normals.size() == count && mesh.tangents.size() == count
           && mesh.uvs.size() == count;
}

}  // namespace

MeshData make_joined(const JoinedShape& shape, const Assets& assets) {
    MeshData mesh;
    for (const JoinedPart& part : shape.parts) {
        if (part.mesh.index >= assets.meshes.size()) {
            continue;
        }
        const MeshData& source = assets.meshes[part.mesh.index];
        if (is_whole(source) && mesh.positions.size() + source.positions.size() <= kMaxVertices) {
            append_part(mesh, source, part);
        }
    }
    update_bounds(mesh);
    return mesh;
}

}  // namespace limn
