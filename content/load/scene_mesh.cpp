#include "content/load/scene_mesh.h"

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_scene.h"
#include "content/load/obj/obj_scene.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace limn {

namespace {

/// Appends `part`, moved by `matrix`. A mirrored one is turned inside out again.
void append_part(MeshData& mesh, const MeshData& part, const Affine& matrix) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const Vec3 rows[3] = {matrix.row[0], matrix.row[1], matrix.row[2]};
    const Vec3 cofactors[3] = {
        glm::cross(rows[1], rows[2]), glm::cross(rows[2], rows[0]), glm::cross(rows[0], rows[1])};
    const bool mirrored = glm::dot(rows[0], cofactors[0]) < 0;
    const float sign = mirrored ? -1.0f : 1.0f;
    for (const Vec3& p : part.positions) {
        mesh.positions.push_back(transform_point(matrix, p));
    }
    for (const Vec3& n : part.normals) {
        const Vec3 turned = {
            glm::dot(cofactors[0], n), glm::dot(cofactors[1], n), glm::dot(cofactors[2], n)};
        mesh.normals.push_back(normalize_or(sign * turned, Vec3(0, 1, 0)));
    }
    for (const Vec4& t : part.tangents) {
        mesh.tangents.emplace_back(
            normalize_or(transform_vector(matrix, Vec3(t)), Vec3(1, 0, 0)), sign * t.w);
    }
    mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
    for (std::size_t i = 0; i + 3 <= part.indices.size(); i += 3) {
        const std::size_t second = mirrored ? 2 : 1;
        for (const std::size_t k : {std::size_t{0}, second, 3 - second}) {
            mesh.indices.push_back(first + part.indices[i + k]);
        }
    }
}

}  // namespace

Result<MeshData>
join_meshes(const GltfScene& scene, const std::string& name, const std::string& path) {
    const std::vector<Affine> matrices = find_node_matrices(scene);
    MeshData mesh;
    mesh.name = fmt::format("{}: mesh {}", path, in_quotes(name.empty() ? scene.name : name));
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (const GltfPart& part : scene.nodes[i].parts) {
            const MeshData& source = scene.meshes[part.mesh];
            names.emplace_back(source.name);
            if (name.empty() || source.name == name || scene.nodes[i].name == name) {
                append_part(mesh, source, matrices[i]);
            }
        }
    }
    if (mesh.positions.empty() && !name.empty() && !names.empty()) {
        return Error{fmt::format(
            "{}: found no mesh {}, expected one of {}{}", path, in_quotes(name),
            fmt::join(names, ", "), did_you_mean(name, names))};
    }
    if (mesh.indices.empty()) {
        return fail("{}: found no triangle, expected a mesh", path);
    }
    if (mesh.normals.size() != mesh.positions.size()) {
        mesh.normals.clear();
    }
    if (mesh.uvs.size() != mesh.positions.size()) {
        mesh.uvs.clear();
    }
    if (mesh.tangents.size() != mesh.positions.size()) {
        mesh.tangents.clear();
    }
    return mesh;
}

Result<GltfScene> load_model_scene(const std::string& path) {
    const bool is_obj = path.ends_with(".obj") || path.ends_with(".OBJ");
    return is_obj ? load_obj_scene(path) : load_gltf(path);
}

Result<MeshData> load_joined_mesh(const std::string& path, const std::string& name) {
    const GltfScene scene = LIMN_TRY(load_model_scene(path));
    return join_meshes(scene, name, path);
}

}  // namespace limn
