#include "content/load/obj_scene.h"

#include "content/bake/tangents.h"
#include "content/load/atomic_file.h"
#include "content/load/file_uri.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace limn {

namespace {

constexpr float kCreaseAngle = radians(50);  // as for glTF

struct CornerHash {
    std::size_t operator()(const ObjCorner& corner) const {
        std::uint64_t hash = corner.position;
        for (const std::int32_t index : {corner.uv, corner.normal}) {
            hash = (hash ^ (hash >> 29)) * 0xff51afd7ed558ccdu + static_cast<std::uint32_t>(index);
        }
        return static_cast<std::size_t>(hash ^ (hash >> 32));
    }
};

struct SameCorner {
    bool operator()(const ObjCorner& a, const ObjCorner& b) const {
        return a.position == b.position && a.uv == b.uv && a.normal == b.normal;
    }
};

/// Perceptual roughness whose GGX lobe is as wide as a Blinn-Phong lobe of this exponent
/// (Karis 2013: alpha^2 = 2 / (n + 2)).
float roughness_of(float shininess) {
    return std::sqrt(std::sqrt(2.0f / (shininess + 2.0f)));
}

Material material_of(const ObjMaterial& source) {
    Material material;
    material.name = source.name;
    material.base_color = Vec4(source.diffuse, source.opacity);
    material.emission = source.emission;
    material.alpha_mode = source.opacity < 1 ? AlphaMode::Blend : AlphaMode::Opaque;
    material.roughness = roughness_of(source.shininess);
    return material;
}

/// The materials of all libraries by name; those that cannot be read leave a warning.
std::map<std::string, ObjMaterial, std::less<>>
read_libraries(const ObjFile& obj, const std::string& path, const ObjLimits& limits) {
    std::map<std::string, ObjMaterial, std::less<>> found;
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const auto read = [&](const std::string& library) -> Status {
        const std::vector<std::byte> bytes = LIMN_TRY(fetch_uri(
            library, folder.empty() ? "." : folder.string(), path + ": mtllib", limits.max_bytes));
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::vector<ObjMaterial> materials =
            LIMN_TRY(parse_obj_materials(text, (folder / library).string(), limits));
        for (const ObjMaterial& material : materials) {
            found.emplace(material.name, material);
        }
        return Done{};
    };
    for (const std::string& library : obj.libraries) {
        if (const Status status = read(library); !status) {
            log_warn("{}", status.error().message);
        }
    }
    return found;
}

std::string node_name(const ObjFile& obj, const ObjFace& face) {
    const std::string& object = obj.objects[face.object];
    const std::string& group = obj.groups[face.group];
    return object.empty() ? group : group.empty() ? object : object + "." + group;
}

}  // namespace

ObjMesh make_obj_mesh(const ObjFile& obj, std::span<const std::uint32_t> faces) {
    ObjMesh result;
    MeshData& mesh = result.mesh;
    std::unordered_map<ObjCorner, std::uint32_t, CornerHash, SameCorner> vertices;
    std::vector<Vec3> polygon;
    bool has_normals = true;
    for (const std::uint32_t f : faces) {
        const ObjFace& face = obj.faces[f];
        const std::span<const ObjCorner> corners(&obj.corners[face.first], face.count);
        polygon.clear();
        for (const ObjCorner& corner : corners) {
            polygon.push_back(obj.positions[corner.position]);
        }
        for (const std::uint32_t number : triangulate_polygon(polygon)) {
            const ObjCorner& corner = corners[number];
            const auto next = static_cast<std::uint32_t>(mesh.positions.size());
            const auto [vertex, is_new] = vertices.try_emplace(corner, next);
            mesh.indices.push_back(vertex->second);
            if (!is_new) {
                continue;
            }
            result.source.push_back(corner.position);
            mesh.positions.push_back(obj.positions[corner.position]);
            const Vec2 uv =
                corner.uv < 0 ? Vec2(0, 1) : obj.uvs[static_cast<std::size_t>(corner.uv)];
            mesh.uvs.emplace_back(uv.x, 1 - uv.y);
            has_normals = has_normals && corner.normal >= 0;
            mesh.normals.push_back(
                has_normals
                    ? normalize_or(obj.normals[static_cast<std::size_t>(corner.normal)], {0, 1, 0})
                    : Vec3(0));
        }
    }
    if (!has_normals) {
        mesh.normals.clear();
    }
    update_bounds(mesh);
    return result;
}

Result<GltfScene> load_obj_scene(const std::string& path, const ObjLimits& limits) {
    const ObjFile obj = LIMN_TRY(load_obj(path, limits));
    for (const std::string& warning : obj.warnings) {
        log_warn("{}", warning);
    }
    if (obj.faces.empty()) {
        return fail("{}: found no faces, expected at least one", path);
    }

    GltfScene scene;
    scene.name = std::filesystem::path(path).stem().string();
    const auto colors = read_libraries(obj, path, limits);
    for (const std::string& name : obj.materials) {
        const auto color = colors.find(name);
        scene.materials.push_back(
            material_of(color == colors.end() ? ObjMaterial{.name = name} : color->second));
        scene.materials.back().name = name.empty() ? "default" : name;
    }

    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>>
        parts;
    for (std::uint32_t f = 0; f < obj.faces.size(); ++f) {
        const ObjFace& face = obj.faces[f];
        parts[{face.object, face.group, face.material}].push_back(f);
    }
    const ObjFace* previous = nullptr;
    for (const auto& [key, faces] : parts) {
        const ObjFace& face = obj.faces[faces[0]];
        if (previous == nullptr || face.object != previous->object
            || face.group != previous->group) {
            scene.nodes.emplace_back();
            scene.nodes.back().name = node_name(obj, face);
        }
        previous = &face;
        MeshData mesh = make_obj_mesh(obj, faces).mesh;
        mesh.name = node_name(obj, face);
        if (mesh.normals.empty()) {
            generate_normals(mesh, kCreaseAngle);
        }
        generate_tangents(mesh);
        scene.nodes.back().parts.push_back(
            {static_cast<std::uint32_t>(scene.meshes.size()), face.material});
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

}  // namespace limn
