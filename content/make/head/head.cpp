#include "content/make/head/head.h"

#include "content/bake/even_chart.h"
#include "content/bake/face_regions.h"
#include "content/bake/region_directions.h"
#include "content/bake/tangents.h"
#include "content/make/head/head_clips.h"
#include "content/make/head/head_ear.h"
#include "content/make/head/head_expressions.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_markers.h"
#include "content/make/head/head_parts.h"
#include "content/make/head/head_shoulders.h"
#include "content/make/head/head_surface.h"
#include "content/make/head/head_wrap.h"
#include "content/make/models/keep_triangles.h"
#include "ecs/base/check.h"
#include "ecs/components/wrinkle_maps.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr float kMeters = 0.01f;      ///< per centimeter
constexpr float kMinWeight = 0.001f;  ///< smaller weights of joints are dropped

float gaussian_spot(const Vec3& p, const Vec3& center, float radius) {
    const Vec3 offset = p - center;
    return std::exp(-glm::dot(offset, offset) / square(radius));
}

Vec2 uv_at(const Vec2& chart) {
    return {0.5f + chart.x / kHeadColumns, (chart.y + 13) / (kHeadRows + 13)};
}

constexpr float kAroundNeck =
    1.4f;  ///< step across the seam in the chart of pores, near the natural one

/// Whether the texture seam is visible at `p` [cm], behind the neck.
bool at_nape(const Vec3& p) {
    constexpr float kTop = -3;  // within the hair
    constexpr float kEnd = -14;
    return p.y < kTop && p.y > kEnd;
}

/// A chart for patterns of uniform size, with a unit as long as across the forehead in `uvs`.
/// `reference`: NaN outside the skin of the face. `joins`: where patterns continue across the seam.
std::vector<Vec2> make_pore_chart(
    const HeadPart& part, std::span<const Vec3> reference, std::span<const ChartJoin> joins) {
    constexpr float kUnit = 33;           // [cm]
    constexpr float kFaceImportance = 9;  // added to that of the rest, 1; by trial
    std::vector<float> importance;
    for (const Vec3& p : reference) {
        const float face = is_finite(p) ? glm::smoothstep(6.5f, 8.5f, p.z) : 0.0f;
        importance.push_back(1 + kFaceImportance * face);
    }
    return make_even_chart(part.mesh, kUnit, importance, joins);
}

/// Vertices on the texture seam are duplicated.
HeadPart make_skin(const HeadShape& shape) {
    const HeadLayout& layout = head_layout(shape.shoulders);
    const std::vector<Vec3> positions = wrap_head(shape);
    HeadPart part;
    part.mesh.name = "head";
    std::map<std::pair<std::uint32_t, bool>, std::uint32_t> made;  // copies beyond the seam
    const auto vertex_at = [&](std::uint32_t v, bool beyond) {
        const auto [found, added] =
            made.try_emplace({v, beyond}, static_cast<std::uint32_t>(part.points.size()));
        if (added) {
            const HeadVertex& vertex = layout.vertices[v];
            const Vec2 chart = vertex.chart + Vec2(beyond ? kHeadColumns : 0, 0);
            part.points.push_back(skin_point(vertex, positions[v]));
            part.mesh.positions.push_back(positions[v]);
            part.mesh.uvs.push_back(uv_at(chart));
            part.mesh.colors.emplace_back(
                head_skin_color(vertex, positions[v], shape),
                head_skin_relief(vertex, positions[v]));
        }
        return found->second;
    };
    for (const auto& quad : layout.quads) {
        float high = -kHeadColumns;
        for (const std::uint32_t v : quad) {
            high = std::max(high, layout.vertices[v].chart.x);
        }
        std::array<std::uint32_t, 4> corners{};
        for (int k = 0; k < 4; ++k) {
            const bool beyond = layout.vertices[quad[k]].chart.x < high - 0.5f * kHeadColumns;
            corners[k] = vertex_at(quad[k], beyond);
        }
        // Split along the shorter diagonal, which is the same on both sides.
        const auto distance = [&](int a, int b) {
            return glm::distance(positions[quad[a]], positions[quad[b]]);
        };
        const std::uint32_t first = distance(0, 2) <= distance(1, 3) ? 0 : 1;
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
            part.mesh.indices.push_back(corners[(first + k) % 4]);
        }
    }
    if (shape.dressed) {
        const std::vector<bool> covered = find_covered_skin(positions);
        for (const auto& quad : layout.quads) {
            const bool hidden =
                std::all_of(quad.begin(), quad.end(), [&](std::uint32_t v) { return covered[v]; });
            part.covered.insert(part.covered.end(), 2, hidden);
        }
    }
    generate_normals(part.mesh);
    // Ears, shoulders and what lies behind lids and lips do not belong to the face.
    std::vector<Vec3> reference;
    for (const HeadPoint& point : part.points) {
        const bool face = (point.loops == HeadLoops::None
                           && (!shape.shoulders || turns_with_head(point.rest) > 0))
                          || (point.loops == HeadLoops::Eye && point.loop <= kLidLoop)
                          || (point.loops == HeadLoops::Nostril && point.loop <= kNostrilRim)
                          || (point.loops == HeadLoops::Mouth && point.loop <= kLipLoop);
        reference.push_back(face ? point.rest : Vec3(std::numeric_limits<float>::quiet_NaN()));
    }
    part.mesh.regions = make_face_regions(reference, part.mesh.normals);
    std::vector<ChartJoin> joins;
    for (const auto& [vertex, beyond] : made) {
        const auto before = made.find({vertex.first, false});
        if (vertex.second && before != made.end() && at_nape(positions[vertex.first])) {
            joins.push_back({.from = before->second, .to = beyond, .step = {kAroundNeck, 0}});
        }
    }
    part.mesh.uvs1 = make_pore_chart(part, reference, joins);
    return part;
}

/// Some vertices of the skin, with its positions and texture coordinates.
HeadPart make_marker_surface(HeadShape shape) {
    shape.shoulders = false;
    const std::vector<Vec3> positions = wrap_head(shape);
    const HeadMarkers& markers = head_markers();
    HeadPart part;
    part.mesh.name = "markers";
    for (std::size_t i = 0; i < markers.vertices.size(); ++i) {
        const std::uint32_t v = markers.vertices[i];
        part.points.push_back(skin_point(head_layout().vertices[v], positions[v]));
        part.mesh.positions.push_back(positions[v]);
        part.mesh.uvs.push_back(uv_at(markers.charts[i]));
    }
    part.mesh.indices = markers.indices;
    generate_normals(part.mesh);
    return part;
}

HeadPart make_part(const HeadShape& shape) {
    switch (shape.part) {
    case HeadPartKind::Skin:
        return make_skin(shape);
    case HeadPartKind::Eyes:
        return make_eye_balls();
    case HeadPartKind::Corneas:
        return make_corneas();
    case HeadPartKind::Teeth:
        return make_teeth();
    case HeadPartKind::Mouth:
        return make_mouth();
    case HeadPartKind::Hair:
        return make_face_hair(shape);
    case HeadPartKind::Scalp:
        return make_scalp_hair(shape);
    case HeadPartKind::Shirt:
        return make_shirt(shape);
    case HeadPartKind::Markers:
        return make_marker_surface(shape);
    }
    return {};
}

enum class HeadJoint : std::uint16_t { Head, Jaw, LeftEye, RightEye, Shoulders };

/// Weight of the head, against that of the shoulders.
float head_weight(const HeadPoint& point) {
    const float weight = point.skin ? turns_with_head(point.rest) : 1.0f;
    return weight < kMinWeight ? 0 : weight > 1 - kMinWeight ? 1 : weight;
}

/// Weights of the joints of make_head_rig.
SkinWeights head_weights(std::span<const HeadPoint> points, const HeadShape& shape) {
    SkinWeights skin;
    const auto add = [&](HeadJoint joint, float weight) {
        if (weight >= kMinWeight) {
            skin.joints.push_back(static_cast<std::uint16_t>(joint));
            skin.weights.push_back(weight);
        }
    };
    for (const HeadPoint& point : points) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        if (point.eye != 0) {
            add(point.eye > 0 ? HeadJoint::LeftEye : HeadJoint::RightEye, 1);
        } else {
            const float turning = shape.shoulders ? head_weight(point) : 1.0f;
            const float jaw = turning * point.jaw < kMinWeight ? 0 : turning * point.jaw;
            add(HeadJoint::Head, turning - jaw);
            add(HeadJoint::Jaw, jaw);
            add(HeadJoint::Shoulders, 1 - turning);
        }
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    return skin;
}

/// A shirt is worn on shoulders.
HeadShape complete(HeadShape shape) {
    shape.shoulders = shape.shoulders || shape.dressed || shape.part == HeadPartKind::Shirt;
    return shape;
}

/// With the final positions [cm] for `shape`, and normals.
HeadPart make_skewed_part(const HeadShape& shape) {
    HeadPart part = make_part(shape);
    MeshData& mesh = part.mesh;
    const bool on_skin = shape.part == HeadPartKind::Skin || shape.part == HeadPartKind::Shirt
                         || shape.part == HeadPartKind::Markers;
    if (!on_skin) {  // points on the skin are already skewed
        for (Vec3& p : mesh.positions) {
            p = skew_head(p, shape);
        }
        if (shape.part != HeadPartKind::Scalp) {
            generate_normals(mesh);
        }
    }
    return part;
}

/// From `positions` [m], those of `shape`, to the same head at seventy.
MorphTarget make_aging(std::span<const Vec3> positions, const HeadShape& shape) {
    constexpr float kMinOffset = 1e-5f;
    HeadShape old = shape;
    old.age = 1;
    const MeshData aged = make_skewed_part(old).mesh;
    LIMN_CHECK(aged.positions.size() == positions.size());
    MorphTarget target;
    target.name = "age";
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const Vec3 offset = kMeters * aged.positions[v] - positions[v];
        if (glm::dot(offset, offset) > square(kMinOffset)) {
            target.vertices.push_back(v);
            target.positions.push_back(offset);
        }
    }
    return target;
}

void remove_triangles(MeshData& mesh, const std::vector<bool>& triangles) {
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (!triangles[t]) {
            kept.insert(kept.end(), &mesh.indices[3 * t], &mesh.indices[3 * t] + 3);
        }
    }
    keep_triangles(mesh, std::move(kept));
}

}  // namespace

Vec3 head_skin_color(const HeadVertex& vertex, const Vec3& point, const HeadShape& shape) {
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    Vec3 color = Vec3(1);
    color *=
        glm::mix(Vec3(1), Vec3(0.16f, 0.15f, 0.16f), shape.scalp_shade * scalp_hair_cover(point));
    const float flush = std::min(
        1.0f, 0.8f * gaussian_spot(p, {4.4f, -0.2f, 8.6f}, 2.4f)
                  + gaussian_spot(p, {0, 0.2f, 12}, 1.5f)
                  + (vertex.loops == HeadLoops::Ear ? 0.9f * (1 - ear_on_cheek(vertex)) : 0.0f)
                  + 0.4f * gaussian_spot(p, {0, -6.3f, 10.2f}, 1.6f));
    color = glm::mix(color, Vec3(1.0f, 0.80f, 0.76f), flush);
    color = glm::mix(
        color, Vec3(0.83f, 0.76f, 0.78f), 0.6f * gaussian_spot(p, {2.6f, 2.0f, 9.2f}, 0.9f));
    if (vertex.loops == HeadLoops::Mouth) {
        constexpr std::array<float, 3> kRed = {0.1f, 0.75f, 1};  // from beside the border inwards
        const int inwards = vertex.loop - kLipBorderLoop + 1;
        const float corner = glm::smoothstep(1.0f, 0.9f, std::abs(across_mouth(vertex.angle)));
        const float red =
            inwards < 0 ? 0 : kRed[std::min(inwards, 2)] * glm::mix(0.4f, 1.0f, corner);
        color = glm::mix(color, Vec3(0.86f, 0.52f, 0.52f), red);
        if (vertex.loop == kLipLoop) {  // little light arrives between the lips
            color *= Vec3(0.66f, 0.58f, 0.58f);
        } else if (vertex.loop > kLipLoop + 1) {
            color = Vec3(0.45f, 0.2f, 0.2f);
        }
    }
    if (vertex.loops == HeadLoops::Nostril) {
        // What lies behind the tip of the nose, and is seen below it, gets little light, and the
        // cavity none: lamps without shadows would light both.
        constexpr std::array<float, kNostrilRim + 1> kBehind = {1, 0.8f, 0.58f, 0.36f, 0.2f, 0.1f};
        constexpr std::array<float, 4> kInside = {0.4f, 0.1f, 0.03f, 0.008f};
        const int inwards = vertex.loop - kNostrilRim;
        const float open = inwards < 0 ? 1.0f : kInside[std::min(inwards, 3)];
        const float behind = glm::smoothstep(0.35f, -0.6f, std::sin(vertex.angle));
        const float light = std::min(
            open, glm::mix(1.0f, kBehind[std::min<int>(vertex.loop, kNostrilRim)], behind));
        // Skin lights skin red.
        color *= Vec3(light, std::pow(light, 1.35f), std::pow(light, 1.4f));
    }
    if (vertex.loops == HeadLoops::Eye) {
        const bool upper = std::sin(vertex.angle) > 0;
        if (vertex.loop > kLidLoop) {
            color = Vec3(0.93f, 0.62f, 0.58f);
        } else if (vertex.loop == kLidLoop) {  // among the roots of lashes
            color *= upper ? Vec3(0.62f, 0.5f, 0.5f) : Vec3(0.9f, 0.76f, 0.74f);
        }
    }
    return color;
}

float head_skin_relief(const HeadVertex& vertex, const Vec3& point) {
    struct Spot {
        Vec3 center;
        float radius, relief;
    };
    constexpr float kElsewhere = 0.3f;
    constexpr std::array<Spot, 5> kSpots = {{
        {{0, 0.6f, 12}, 2.0f, 1.15f},       // nose
        {{2.6f, 0.4f, 9.8f}, 2.0f, 0.8f},   // cheek beside it
        {{0, -6.2f, 10.4f}, 1.9f, 0.7f},    // chin
        {{0, 7.4f, 10.2f}, 3.6f, 0.6f},     // forehead
        {{4.6f, -1.6f, 8.2f}, 2.4f, 0.5f},  // cheek below its bone
    }};
    if (vertex.loops == HeadLoops::Nostril && vertex.loop >= kNostrilRim) {
        constexpr std::array<float, 4> kOpen = {1, 0.15f, 0.03f, 0};
        return kSkinCavity * kOpen[std::min(vertex.loop - kNostrilRim, 3)];
    }
    if (vertex.loops == HeadLoops::Mouth && vertex.loop > kLipLoop) {
        return vertex.loop == kLipLoop + 1 ? kSkinCavity : kSkinCavity * 0.15f;
    }
    if (vertex.loops == HeadLoops::Eye && vertex.loop >= kLidCreaseLoop - 2) {
        return 0.15f;  // thin skin without pores
    }
    if (vertex.loops == HeadLoops::Mouth && vertex.loop >= kLipBorderLoop) {
        return 0.45f;
    }
    const Vec3 p = {std::abs(point.x), point.y, point.z};
    float relief = kElsewhere;
    for (const Spot& spot : kSpots) {
        relief += (spot.relief - kElsewhere) * gaussian_spot(p, spot.center, spot.radius);
    }
    return std::min(relief, 1.0f);
}

MeshData make_head(const HeadShape& requested) {
    const HeadShape shape = complete(requested);
    HeadPart part = make_skewed_part(shape);
    MeshData& mesh = part.mesh;
    for (Vec3& p : mesh.positions) {
        p *= kMeters;
    }
    mesh.skin = head_weights(part.points, shape);
    mesh.morphs = make_expressions(part.points, shape);
    fit_region_directions(mesh);
    if (shape.grows_old) {
        mesh.morphs.push_back(make_aging(mesh.positions, shape));
    }
    if (shape.wrinkle_channels) {
        for (const char* const channel : kWrinkleChannels) {
            mesh.morphs.emplace_back().name = channel;
        }
    }
    generate_morph_normals(mesh);
    generate_tangents(mesh);
    generate_morph_tangents(mesh);
    if (!part.covered.empty()) {
        remove_triangles(mesh, part.covered);
    }
    update_bounds(mesh);
    return mesh;
}

MeshRig make_head_rig(const HeadShape& requested) {
    const HeadShape shape = complete(requested);
    const Vec3 right = kEyeCenter * Vec3(-1, 1, 1);
    std::vector<Vec3> joints = {
        Vec3(0), Vec3(0, kJawAxis.x, kJawAxis.y), skew_head(kEyeCenter, shape),
        skew_head(right, shape)};
    MeshRig rig;
    rig.skeleton.joints = {"head", "jaw", "left_eye", "right_eye"};
    rig.skeleton.parents = {-1, 0, 0, 0};
    if (shape.shoulders) {  // last, so that the other joints have the same indices without it
        joints.emplace_back(0, -16, -3);
        rig.skeleton.joints.emplace_back("shoulders");
        rig.skeleton.parents.push_back(-1);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
        rig.skeleton.rest.translations.push_back(kMeters * joints[i]);
        rig.skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        rig.skeleton.rest.scales.emplace_back(1);
        rig.skin.joints.push_back(static_cast<std::uint16_t>(i));
        rig.skin.joint_from_mesh.push_back(
            affine_from(-kMeters * joints[i], Quat(1, 0, 0, 0), Vec3(1)));
    }
    if (shape.part == HeadPartKind::Skin) {
        rig.clips = make_head_clips(shape);
    }
    return rig;
}

}  // namespace limn
