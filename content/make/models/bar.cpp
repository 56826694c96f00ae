#include "content/make/models/bar.h"

#include "content/bake/tangents.h"
#include "ecs/base/check.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

// Techniques: char.skin-defects

namespace limn {
namespace {

constexpr float kTwist = radians(170.0f);
constexpr float kBend = radians(110.0f);
constexpr float kClipTime = 4.0f;  // [s]

/// Weight of the upper joint at this fraction of the height: smooth over the central half.
float tip_weight(float fraction) {
    const float u = std::clamp((fraction - 0.25f) / 0.5f, 0.0f, 1.0f);
    return u * u * (3.0f - 2.0f * u);
}

ClipData make_clip(const char* name, const Vec3& axis, float angle) {
    ClipSheet sheet;
    sheet.rotating = {1};
    // Halfway keys: beyond 90 degrees between keys the shortest arc would be ambiguous.
    for (const float fraction : {0.0f, 0.5f, 1.0f, 0.5f, 0.0f}) {
        sheet.times.push_back(kClipTime * static_cast<float>(sheet.times.size()) / 4.0f);
        sheet.rotations.push_back(glm::angleAxis(fraction * angle, axis));
    }
    ClipData clip;
    clip.name = name;
    clip.duration = kClipTime;
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

/// One flat side with its own vertices.
void add_side(MeshData& mesh, const BarShape& shape, int side) {
    const auto corner = [&](int i) {
        const float angle =
            2 * kPi * (static_cast<float>(i) + 0.5f) / static_cast<float>(shape.sides);
        return Vec2(std::sin(angle), std::cos(angle)) * shape.radius;
    };
    const Vec2 from = corner(side);
    const Vec2 to = corner(side + 1);
    const Vec2 out = glm::normalize(from + to);
    const float lean = shape.radius * (1 - shape.taper) / shape.height;  // of a cone's normal
    for (int ring = 0; ring <= shape.rings; ++ring) {
        const float fraction = static_cast<float>(ring) / static_cast<float>(shape.rings);
        for (const Vec2& at : {from, to}) {
            const Vec2 point = at * std::lerp(1.0f, shape.taper, fraction);
            const Vec2 normal = shape.smooth ? glm::normalize(at) : out;
            const float u = at == from ? 0.0f : 1.0f;
            mesh.positions.emplace_back(point.x, fraction * shape.height, point.y);
            mesh.normals.push_back(glm::normalize(Vec3(normal.x, lean, normal.y)));
            mesh.uvs.emplace_back(
                shape.smooth ? (static_cast<float>(side) + u) / static_cast<float>(shape.sides) : u,
                1.0f - fraction);
            const float tip = tip_weight(fraction);
            mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
            for (const auto& [joint, weight] : {std::pair(0, 1.0f - tip), std::pair(1, tip)}) {
                if (weight > 0) {
                    mesh.skin.joints.push_back(static_cast<std::uint16_t>(joint));
                    mesh.skin.weights.push_back(weight);
                }
            }
        }
        if (ring > 0) {
            const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 4;
            for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) {
                mesh.indices.push_back(last + i);
            }
        }
    }
}

}  // namespace

MeshData make_bar(const BarShape& shape) {
    LIMN_CHECK(shape.sides >= 3 && shape.rings >= 2);
    MeshData mesh;
    for (int side = 0; side < shape.sides; ++side) {
        add_side(mesh, shape, side);
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    const float widest = shape.radius * std::max(shape.taper, 1.0f);
    mesh.bounds = {Vec3(-widest, 0, -widest), Vec3(widest, shape.height, widest)};
    const std::size_t vertices = mesh.positions.size();
    mesh.regions.push_back(
        {.name = "along",
         .weights = std::vector<float>(vertices, 1.0f),
         .across = std::vector<Vec3>(vertices, Vec3(0, 1, 0))});
    VertexRegion& around = mesh.regions.emplace_back();
    around.name = "around";
    around.weights.assign(vertices, 1.0f);
    for (const Vec3& normal : mesh.normals) {
        around.across.push_back(normalize_or(glm::cross(Vec3(0, 1, 0), normal), {1, 0, 0}));
    }
    generate_tangents(mesh);
    return mesh;
}

MeshRig make_bar_rig(const BarShape& shape) {
    MeshRig rig;
    const Vec3 tip(0, 0.5f * shape.height, 0);
    rig.skeleton.joints = {"base", "tip"};
    rig.skeleton.parents = {-1, 0};
    rig.skeleton.rest.translations = {Vec3(0), tip};
    rig.skeleton.rest.rotations.assign(2, Quat(1, 0, 0, 0));
    rig.skeleton.rest.scales.assign(2, Vec3(1));
    rig.skin.joints = {0, 1};
    rig.skin.joint_from_mesh = {Affine{}, affine_from(-tip, Quat(1, 0, 0, 0), Vec3(1))};
    rig.clips.push_back(make_clip("twist", {0, 1, 0}, kTwist));
    rig.clips.push_back(make_clip("bend", {0, 0, 1}, kBend));
    return rig;
}

}  // namespace limn
