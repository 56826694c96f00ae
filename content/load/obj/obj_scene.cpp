#include "content/load/obj/obj_scene.h"

#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_strokes.h"
#include "content/load/obj/obj_libraries.h"
#include "content/load/obj/triangulate_polygon.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace limn {

namespace {

constexpr float kObjCreaseAngle = radians(50);  // as for glTF

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

/// Normals where the file has a bad or zero one: of the triangles around each position.
void replace_zero_normals(ObjMesh& made) {
    MeshData& mesh = made.mesh;
    if (std::find(mesh.normals.begin(), mesh.normals.end(), Vec3(0)) == mesh.normals.end()) {
        return;
    }
    std::unordered_map<std::uint32_t, glm::dvec3> sums;  // by position of the file
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t* const v = &mesh.indices[i];
        const glm::dvec3 p = mesh.positions[v[0]];
        const glm::dvec3 area =
            glm::cross(glm::dvec3(mesh.positions[v[1]]) - p, glm::dvec3(mesh.positions[v[2]]) - p);
        for (int k = 0; k < 3; ++k) {
            sums.try_emplace(made.source[v[k]], 0).first->second += area;
        }
    }
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        if (mesh.normals[v] == Vec3(0)) {
            const glm::dvec3 sum = sums[made.source[v]];
            const double length = glm::length(sum);
            mesh.normals[v] = length > 0 ? Vec3(sum / length) : Vec3(0, 1, 0);
        }
    }
}

std::string node_name(const ObjFile& obj, const ObjFace& face) {
    const std::string& object = obj.objects[face.object];
    const std::string& group = obj.groups[face.group];
    return object.empty() ? group : group.empty() ? object : object + "." + group;
}

void build_obj_nodes(const ObjFile& obj, GltfScene& scene) {
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
            scene.nodes.back().transform.position = obj.origin;
        }
        previous = &face;
        MeshData mesh = make_obj_mesh(obj, faces).mesh;
        mesh.name = node_name(obj, face);
        if (mesh.normals.empty()) {
            generate_normals(mesh, kObjCreaseAngle);
        }
        generate_tangents(mesh);
        scene.nodes.back().parts.push_back(
            {static_cast<std::uint32_t>(scene.meshes.size()), face.material});
        scene.meshes.push_back(std::move(mesh));
    }
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
                    ? normalize_or(obj.normals[static_cast<std::size_t>(corner.normal)], Vec3(0))
                    : Vec3(0));
            if (!obj.colors.empty()) {
                mesh.colors.emplace_back(obj.colors[corner.position], 1);
            }
        }
    }
    if (!has_normals) {
        mesh.normals.clear();
    }
    replace_zero_normals(result);
    update_bounds(mesh);
    return result;
}

namespace {

/// Points or lines as a node of their own.
void add_obj_strokes(
    const ObjFile& obj, const ObjStrokes& source, std::int32_t mode, GltfScene& scene) {
    const Strokes strokes = make_strokes(obj.positions, source.indices, mode);
    if (strokes.indices.empty()) {
        return;
    }
    const char* const name = mode == kGltfPoints ? "points" : "lines";
    if (strokes.found > kMaxStrokes) {
        scene.warnings.push_back(format_text(
            "{}: found {} {}, of which {} are drawn", scene.name, strokes.found, name,
            kMaxStrokes));
    }
    MeshData mesh;
    mesh.name = name;
    for (std::size_t i = 0; i < strokes.sources.size(); ++i) {
        const std::uint32_t vertex = strokes.sources[i];
        mesh.positions.push_back(obj.positions[vertex] + strokes.offsets[i]);
        mesh.tangents.emplace_back(any_perpendicular(strokes.normals[i]), 1);
        if (!obj.colors.empty()) {
            mesh.colors.emplace_back(obj.colors[vertex], 1);
        }
    }
    mesh.normals = strokes.normals;
    mesh.uvs.assign(mesh.positions.size(), Vec2(0));
    mesh.indices = strokes.indices;
    update_bounds(mesh);
    scene.nodes.emplace_back();
    scene.nodes.back().name = name;
    scene.nodes.back().transform.position = obj.origin;
    scene.nodes.back().parts.push_back(
        {static_cast<std::uint32_t>(scene.meshes.size()), source.material});
    scene.meshes.push_back(std::move(mesh));
}

/// A cloud of points, as scanners write it, has vertices and nothing else.
void make_point_cloud(ObjFile& obj) {
    if (obj.errors.empty() && obj.faces.empty() && obj.lines.indices.empty()
        && obj.points.indices.empty()) {
        obj.points.indices.resize(obj.positions.size());
        std::iota(obj.points.indices.begin(), obj.points.indices.end(), 0u);
    }
}

}  // namespace

Result<GltfScene>
load_obj_scene(const std::string& path, const ObjLimits& limits, const LoadOptions& options) {
    ObjFile obj = LIMN_TRY(load_obj(path, limits));
    make_point_cloud(obj);
    GltfScene scene;
    scene.name = std::filesystem::path(path).stem().string();
    scene.warnings = obj.errors;
    scene.warnings.insert(scene.warnings.end(), obj.warnings.begin(), obj.warnings.end());
    build_obj_materials(obj, path, limits, scene);
    build_obj_nodes(obj, scene);
    add_obj_strokes(obj, obj.points, kGltfPoints, scene);
    add_obj_strokes(obj, obj.lines, kGltfLines, scene);
    LIMN_TRY(report_load_warnings(path, scene.warnings, options));
    if (scene.meshes.empty()) {
        return fail("{}: found no faces, lines or points, expected at least one", path);
    }
    return scene;
}

}  // namespace limn
