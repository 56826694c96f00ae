#include "content/load/faces/face_import.h"

#include "content/bake/face_regions.h"
#include "content/bake/region_directions.h"
#include "content/bake/tangents.h"
#include "content/load/obj/obj_scene.h"
#include "content/make/head/face_chart.h"
#include "ecs/base/check.h"
#include "ecs/components/weld.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace limn {

namespace {

constexpr float kMinOffset = 1e-6f;  ///< [m]; smaller ones are rounding errors of the files
constexpr float kMinTurn = 1e-4f;    ///< of a normal

/// Outer border of the lips of the reference face, left half from top to bottom [cm].
constexpr std::array<Vec2, 7> kLips = {
    {{0, -2.48f},
     {0.73f, -2.42f},
     {1.7f, -2.78f},
     {2.53f, -3.52f},
     {1.8f, -4.06f},
     {1.03f, -4.3f},
     {0, -4.38f}}};

/// Normals at rest, and their changes in an expression, by position.
MorphTarget make_target(
    const FaceShape& shape, float scale, std::span<const Vec3> turns,
    std::span<const std::uint32_t> source) {
    MorphTarget target;
    target.name = shape.name;
    target.action_unit = shape.action_unit;
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        const Vec3 offset = scale * shape.offsets[source[v]];
        const Vec3 turn = turns[source[v]];
        if (glm::length(offset) > kMinOffset || glm::length(turn) > kMinTurn) {
            target.vertices.push_back(v);
            target.positions.push_back(offset);
            target.normals.push_back(turn);
        }
    }
    return target;
}

template <typename T>
std::vector<T> gather(std::span<const T> all, std::span<const std::uint32_t> source) {
    std::vector<T> values;
    values.reserve(source.size());
    for (const std::uint32_t index : source) {
        values.push_back(all[index]);
    }
    return values;
}

SkinWeights
gather_source_influences(const SkinWeights& all, std::span<const std::uint32_t> source) {
    SkinWeights skin;
    if (all.empty()) {
        return skin;
    }
    for (const std::uint32_t position : source) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        for (std::uint32_t i = all.first[position]; i < all.first[position + 1]; ++i) {
            skin.joints.push_back(all.joints[i]);
            skin.weights.push_back(all.weights[i]);
        }
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    return skin;
}

/// Along u of the chart, whose v grows downwards on the face; equal for vertices at one position.
std::vector<Vec4> chart_tangents(const MeshData& mesh) {
    const std::vector<std::uint32_t> welded = weld_positions(mesh.positions);
    std::vector<Vec3> sums(mesh.positions.size(), Vec3(0));
    for (std::size_t i = 0; i + 3 <= mesh.indices.size(); i += 3) {
        const std::uint32_t* const v = &mesh.indices[i];
        const TriangleFrame frame = triangle_frame(
            {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]},
            {mesh.uvs1[v[0]], mesh.uvs1[v[1]], mesh.uvs1[v[2]]});
        for (int k = 0; k < 3; ++k) {
            sums[welded[v[k]]] += normalize_or(frame.tangent, Vec3(0));
        }
    }
    std::vector<Vec4> tangents;
    for (std::size_t v = 0; v < sums.size(); ++v) {
        const Vec3& normal = mesh.normals[v];
        const Vec3 along = sums[welded[v]] - glm::dot(sums[welded[v]], normal) * normal;
        tangents.emplace_back(normalize_or(along, any_perpendicular(normal)), 1.0f);
    }
    return tangents;
}

Material pbr(const char* name, const Vec3& color, float roughness) {
    Material material;
    material.name = name;
    material.base_color = Vec4(color, 1);
    material.roughness = roughness;
    return material;
}

/// Distance from the axis, in front of the center; infinite behind it.
float from_axis(const EyeBall& eye, const Vec3& p) {
    const float along = glm::dot(p - eye.center, eye.axis);
    return along > 0 ? glm::length(p - eye.center - along * eye.axis)
                     : std::numeric_limits<float>::infinity();
}

/// 1 on the lining of the mouth where it is part of the skin; `p` is on the left side.
float lining_amount(const Vec3& p) {
    return (1 - glm::smoothstep(8.4f, 9.2f, p.z)) * (1 - glm::smoothstep(2.3f, 2.8f, p.x))
           * glm::smoothstep(-6.6f, -6.0f, p.y) * (1 - glm::smoothstep(-1.0f, -0.5f, p.y));
}

/// 1 at `center`, 0 from `radius` on, smooth.
float bump(const Vec3& p, const Vec3& center, float radius) {
    return 1 - glm::smoothstep(0.0f, radius, glm::distance(p, center));
}

}  // namespace

std::vector<Vec3> smooth_normals(
    const ObjFile& obj, std::span<const Vec3> positions, std::span<const std::uint32_t> faces) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (const std::uint32_t f : faces) {
        const ObjFace& face = obj.faces[f];
        const auto corner = [&](std::uint32_t k) {
            return obj.corners[face.first + k % face.count].position;
        };
        for (std::uint32_t k = 0; k < face.count; ++k) {
            const glm::dvec3 p = positions[corner(k)];
            const glm::dvec3 next = glm::dvec3(positions[corner(k + 1)]) - p;
            const glm::dvec3 previous = glm::dvec3(positions[corner(k + face.count - 1)]) - p;
            const glm::dvec3 normal = glm::cross(next, previous);
            const double length = glm::length(normal);
            if (length > 0) {
                sums[corner(k)] += std::atan2(length, glm::dot(next, previous)) / length * normal;
            }
        }
    }
    std::vector<Vec3> normals;
    normals.reserve(sums.size());
    for (const glm::dvec3& sum : sums) {
        normals.push_back(normalize_or(Vec3(sum), Vec3(0, 1, 0)));
    }
    return normals;
}

GltfScene make_face_scene(
    const std::string& name, const ObjFile& obj, float scale, std::span<const FacePart> parts,
    std::span<const FaceShape> shapes, std::span<const Vec3> reference, const SkinWeights& skin) {
    LIMN_CHECK(reference.size() == obj.positions.size());
    std::vector<std::uint32_t> faces;
    for (const FacePart& part : parts) {
        faces.insert(faces.end(), part.faces.begin(), part.faces.end());
    }
    const std::vector<Vec3> normals = smooth_normals(obj, obj.positions, faces);

    GltfScene scene;
    scene.name = name;
    GltfNode& node = scene.nodes.emplace_back();
    node.name = name;
    std::vector<std::vector<std::uint32_t>> sources;
    for (const FacePart& part : parts) {
        if (part.faces.empty()) {
            continue;
        }
        ObjMesh made = make_obj_mesh(obj, part.faces);
        MeshData& mesh = made.mesh;
        mesh.name = part.material.name;
        mesh.normals = gather<Vec3>(normals, made.source);
        for (Vec3& position : mesh.positions) {
            position *= scale;
        }
        update_bounds(mesh);
        mesh.skin = gather_source_influences(skin, made.source);
        if (part.color) {
            for (const std::uint32_t position : made.source) {
                mesh.colors.push_back(part.color(position));
            }
        }
        if (part.is_skin) {
            const std::vector<Vec3> own_reference = gather<Vec3>(reference, made.source);
            mesh.regions = make_face_regions(own_reference, mesh.normals);
            mesh.uvs1 = make_face_chart(own_reference);
        }
        node.parts.push_back(
            {static_cast<std::uint32_t>(scene.meshes.size()),
             static_cast<std::uint32_t>(scene.materials.size())});
        scene.materials.push_back(part.material);
        scene.meshes.push_back(std::move(mesh));
        sources.push_back(std::move(made.source));
    }

    std::vector<Vec3> moved(obj.positions.size());
    for (const FaceShape& shape : shapes) {
        for (std::size_t i = 0; i < moved.size(); ++i) {
            moved[i] = obj.positions[i] + shape.offsets[i];
        }
        std::vector<Vec3> turns = smooth_normals(obj, moved, faces);
        for (std::size_t i = 0; i < turns.size(); ++i) {
            turns[i] -= normals[i];
        }
        for (std::size_t part = 0; part < sources.size(); ++part) {
            scene.meshes[part].morphs.push_back(make_target(shape, scale, turns, sources[part]));
        }
    }
    for (MeshData& mesh : scene.meshes) {
        if (!mesh.uvs1.empty()) {
            fit_region_directions(mesh);
            mesh.tangents = chart_tangents(mesh);
        }
    }
    if (!shapes.empty()) {
        node.first_morph = 0;
        scene.morph_weights.assign(shapes.size(), 0.0f);
    }
    return scene;
}

std::vector<std::uint32_t> mirror_positions(std::span<const Vec3> positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return positions[i].y; });
    std::vector<std::uint32_t> mirror(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vec3 image = positions[i] * Vec3(-1, 1, 1);
        const auto same_height = std::ranges::lower_bound(
            order, image.y, {}, [&](std::uint32_t other) { return positions[other].y; });
        float nearest = std::numeric_limits<float>::infinity();
        const auto visit = [&](std::uint32_t other) {
            const float distance = glm::distance(positions[other], image);
            if (distance < nearest) {
                nearest = distance;
                mirror[i] = other;
            }
            return std::abs(positions[other].y - image.y) <= nearest;
        };
        for (auto at = same_height; at != order.end() && visit(*at); ++at) {
        }
        for (auto at = same_height; at != order.begin() && visit(*(at - 1)); --at) {
        }
    }
    return mirror;
}

std::vector<Vec3>
mirror_offsets(std::span<const Vec3> offsets, std::span<const std::uint32_t> mirror) {
    std::vector<Vec3> mirrored;
    mirrored.reserve(offsets.size());
    for (const std::uint32_t other : mirror) {
        mirrored.push_back(offsets[other] * Vec3(-1, 1, 1));
    }
    return mirrored;
}

EyeBall find_eye_ball(std::span<const Vec3> outer, float limbus) {
    Bounds box;
    for (const Vec3& p : outer) {
        grow(box, p);
    }
    EyeBall eye;
    eye.center = center(box);
    // The cornea bulges and the back may be open: the center is at the depth of the widest ring.
    const float radius = half_extent(box).y;
    float depth = 0;
    int count = 0;
    for (const Vec3& p : outer) {
        if (glm::length(Vec2(p) - Vec2(eye.center)) > 0.98f * radius) {
            depth += p.z;
            ++count;
        }
    }
    eye.center.z = count > 0 ? depth / static_cast<float>(count) : eye.center.z;
    float furthest = 0;
    for (const Vec3& p : outer) {
        const float distance = glm::distance(p, eye.center);
        if (distance > furthest && p.z > eye.center.z) {
            furthest = distance;
            eye.axis = (p - eye.center) / distance;
        }
    }
    eye.limbus = limbus * radius;
    eye.pupil = 0.33f * eye.limbus;
    return eye;
}

bool is_on_cornea(const EyeBall& eye, const Vec3& p) {
    return from_axis(eye, p) < eye.limbus;
}

Vec4 iris_color(const EyeBall& eye, const Vec3& p) {
    const float r = from_axis(eye, p) / eye.limbus;
    if (std::isinf(r)) {
        return Vec4(0, 0, 0, 1);
    }
    const float pupil = eye.pupil / eye.limbus;
    const Vec3 white = sclera_material().base_color;
    const Vec3 inner = {0.16f, 0.07f, 0.025f};
    const Vec3 outer = {0.07f, 0.035f, 0.018f};
    Vec3 color = glm::mix(inner, outer, glm::smoothstep(pupil, 1.0f, r));
    color *= glm::smoothstep(pupil - 0.04f, pupil + 0.04f, r);
    return Vec4(glm::mix(color, white, glm::smoothstep(0.85f, 1.0f, r)), 1);
}

float lip_amount(const Vec3& reference) {
    const Vec2 p = {std::abs(reference.x), reference.y};
    float nearest = std::numeric_limits<float>::infinity();
    bool inside = false;
    for (std::size_t i = 0; i + 1 < kLips.size(); ++i) {
        const Vec2 a = kLips[i];
        const Vec2 along = kLips[i + 1] - a;
        const float t = glm::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0f, 1.0f);
        nearest = std::min(nearest, glm::distance(p, a + t * along));
        // The half plane x > p.x crosses each edge on its way round an odd number of times.
        const Vec2 b = kLips[i + 1];
        if ((a.y > p.y) != (b.y > p.y) && a.x + (p.y - a.y) / along.y * along.x > p.x) {
            inside = !inside;
        }
    }
    constexpr float kSoft = 0.12f;  // [cm]
    return glm::smoothstep(-kSoft, kSoft, inside ? nearest : -nearest)
           * glm::smoothstep(8.0f, 9.5f, reference.z);
}

Vec4 skin_tint(const Vec3& reference) {
    if (!is_finite(reference)) {
        return Vec4(1);
    }
    const Vec3 p = {std::abs(reference.x), reference.y, reference.z};
    const float flush =
        std::min(1.0f, bump(p, {4.2f, -0.2f, 9}, 3) + bump(p, {0, 0.2f, 12.5f}, 2.2f));
    const Vec3 tint = glm::mix(Vec3(1, 1, 1), Vec3(1.0f, 0.88f, 0.88f), flush);
    const Vec3 lips = glm::mix(tint, Vec3(0.9f, 0.6f, 0.62f), lip_amount(p));
    return Vec4(glm::mix(lips, Vec3(0.6f, 0.3f, 0.33f), lining_amount(p)), 1);
}

Material skin_material() {
    return pbr("skin", {0.55f, 0.34f, 0.26f}, 0.5f);
}

Material mucosa_material() {
    return pbr("mucosa", {0.4f, 0.13f, 0.11f}, 0.35f);
}

Material teeth_material() {
    return pbr("teeth", {0.62f, 0.54f, 0.42f}, 0.25f);
}

Material sclera_material() {
    return pbr("sclera", {0.75f, 0.7f, 0.65f}, 0.3f);
}

Material iris_material() {
    Material material = pbr("iris", {1, 1, 1}, 0.5f);
    material.double_sided = true;  // the pupil may be a hole, through which the back is visible
    return material;
}

Material cornea_material() {
    Material material = pbr("cornea", {1, 1, 1}, 0.05f);
    material.base_color.w = 0.02f;
    material.alpha_mode = AlphaMode::Blend;
    return material;
}

Material lash_material() {
    Material material = pbr("lashes", {0.03f, 0.02f, 0.015f}, 0.6f);
    material.double_sided = true;
    material.alpha_mode = AlphaMode::Blend;
    return material;
}

}  // namespace limn
