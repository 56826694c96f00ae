#include "content/make/models/creature.h"

#include "content/bake/tangents.h"
#include "content/make/models/creature_body.h"
#include "content/make/models/creature_gait.h"
#include "content/make/models/implicit_mesh.h"
#include "content/make/models/simplify_mesh.h"
#include "content/models/fox_model.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace limn {

namespace {

constexpr std::size_t kMaxInfluences = 4;
constexpr float kMinCreatureWeight = 0.01f;

/// Symmetric about x = 0.
ImplicitGrid body_grid(const CreatureShape& shape) {
    const float half = std::ceil(0.2f / shape.detail) * shape.detail;
    return {{{-half, -0.03f, -0.78f}, {half, 0.83f, 0.56f}}, shape.detail};
}

using Weights = std::array<float, kCreatureJoints>;

/// Weights by distance to the parts of each joint; sum to 1.
Weights joint_weights(const Vec3& p) {
    constexpr float kJointFalloff = 0.021f;  // distance over which weights fall off [m]; by eye
    Weights weights;
    weights.fill(0.0f);
    const std::array<float, kCreatureJoints> distances = creature_part_distances(p);
    float nearest = distances[0];
    for (const float distance : distances) {
        nearest = std::min(nearest, distance);
    }
    float sum = 0;
    for (std::size_t i = 0; i < kCreatureJoints; ++i) {
        weights[i] = std::exp(-square((distances[i] - nearest) / kJointFalloff));
        sum += weights[i];
    }
    for (float& weight : weights) {
        weight /= sum;
    }
    return weights;
}

std::vector<Weights> smooth_weights(const ImplicitMesh& body) {
    std::vector<Weights> weights;
    weights.reserve(body.positions.size());
    for (const Vec3& p : body.positions) {
        weights.push_back(joint_weights(p));
    }
    constexpr int kRounds = 6;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<Weights> sums = weights;
        std::vector<float> counts(weights.size(), 1.0f);
        for (std::size_t i = 0; i < body.indices.size(); ++i) {
            const std::uint32_t a = body.indices[i];
            const std::uint32_t b = body.indices[i % 3 == 2 ? i - 2 : i + 1];
            for (std::size_t j = 0; j < kCreatureJoints; ++j) {
                sums[a][j] += weights[b][j];
            }
            counts[a] += 1.0f;
        }
        for (std::size_t v = 0; v < weights.size(); ++v) {
            for (std::size_t j = 0; j < kCreatureJoints; ++j) {
                weights[v][j] = sums[v][j] / counts[v];
            }
        }
    }
    return weights;
}

void append_influences(SkinWeights& skin, const Weights& weights) {
    if (skin.first.empty()) {
        skin.first.push_back(0);
    }
    std::array<std::uint16_t, kCreatureJoints> order;
    for (std::uint16_t i = 0; i < kCreatureJoints; ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
        return weights[a] > weights[b];
    });
    std::size_t kept = 1;
    while (kept < kMaxInfluences && weights[order[kept]] > kMinCreatureWeight) {
        ++kept;
    }
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept));
    float sum = 0;
    for (std::size_t i = 0; i < kept; ++i) {
        sum += weights[order[i]];
    }
    for (std::size_t i = 0; i < kept; ++i) {
        skin.joints.push_back(order[i]);
        skin.weights.push_back(weights[order[i]] / sum);
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
}

// ---- texture coordinates ------------------------------------------------------------------------

/// A vertex of a chart: a vertex of the body may be in several charts, and at both ends of a chart.
struct ChartVertex {
    std::uint32_t vertex;
    int chart;
    int turn;  ///< wraps of u around the chart

    auto operator<=>(const ChartVertex&) const = default;
};

/// Cuts the body into charts, one around each chain of bones: u goes around, v along.
void add_body(const ImplicitMesh& body, MeshData& mesh) {
    const std::vector<Weights> weights = smooth_weights(body);
    std::map<ChartVertex, std::uint32_t> numbers;
    for (std::size_t t = 0; t + 2 < body.indices.size(); t += 3) {
        const std::uint32_t* corners = &body.indices[t];
        const Vec3 center =
            (body.positions[corners[0]] + body.positions[corners[1]] + body.positions[corners[2]])
            / 3.0f;
        const int chart = creature_chart(center);
        float first = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = corners[k];
            Vec2 uv = creature_chart_uv(chart, body.positions[vertex]);
            first = k == 0 ? uv.x : first;
            // Unwrap u relative to the first corner.
            const int turn = uv.x - first > 0.5f ? -1 : uv.x - first < -0.5f ? 1 : 0;
            const auto next = static_cast<std::uint32_t>(mesh.positions.size());
            const auto [found, is_new] = numbers.try_emplace({vertex, chart, turn}, next);
            if (is_new) {
                uv.x += static_cast<float>(turn);
                mesh.positions.push_back(body.positions[vertex]);
                mesh.normals.push_back(body.normals[vertex]);
                mesh.uvs.push_back(atlas_uv(chart, uv));
                mesh.colors.emplace_back(
                    creature_color(body.positions[vertex], body.normals[vertex]), 1.0f);
                append_influences(mesh.skin, weights[vertex]);
            }
            mesh.indices.push_back(found->second);
        }
    }
}

// ---- eyes ---------------------------------------------------------------------------------------

struct Eye {
    Vec3 center;
    Vec3 forward;
    Vec3 up;
    Vec3 right;  ///< axis of rotation of the lids
    float radius;
};

Eye make_eye(float side) {
    constexpr float kEyeRadius = 0.0155f;
    constexpr float kDepth = 0.0092f;  // of its center below the face
    const Vec3 from = creature_joint(CreatureJoint::Head) + Vec3(0, 0.03f, 0.03f);
    const Vec3 direction = glm::normalize(Vec3(side * 0.78f, 0.16f, 0.72f));
    float depth = 0.02f;
    while (creature_distance(from + depth * direction) < 0.0f && depth < 0.2f) {
        depth += 0.0005f;
    }
    Eye eye;
    eye.radius = kEyeRadius;
    eye.forward = glm::normalize(Vec3(side * 0.66f, 0.05f, 0.75f));
    eye.center = from + (depth - kDepth) * direction;
    eye.right = glm::normalize(glm::cross(eye.forward, Vec3(0, 1, 0)));
    eye.up = glm::cross(eye.right, eye.forward);
    return eye;
}

void append_head_vertex(
    MeshData& mesh, const Vec3& position, const Vec3& normal, const Vec3& color, const Vec2& uv) {
    mesh.positions.push_back(position);
    mesh.normals.push_back(normal);
    mesh.colors.emplace_back(color, 1.0f);
    mesh.uvs.push_back(uv);
    mesh.skin.joints.push_back(static_cast<std::uint16_t>(CreatureJoint::Head));
    mesh.skin.weights.push_back(1.0f);
    mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
}

/// Two triangles of a grid whose rows have `width` + 1 vertices, from `first` on.
void append_grid_cell(
    MeshData& mesh, std::uint32_t first, std::uint32_t width, std::uint32_t row, std::uint32_t i) {
    const std::uint32_t a = first + row * (width + 1) + i;
    const std::uint32_t b = a + width + 1;
    mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
}

/// A sphere with its pole forward: a pupil and an amber iris.
void add_eyeball(MeshData& mesh, const Eye& eye) {
    constexpr std::uint32_t kAround = 20;
    constexpr std::uint32_t kRings = 14;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t row = 0; row <= kRings; ++row) {
        const float polar = kPi * static_cast<float>(row) / kRings;
        const bool is_pole = row == 0 || row == kRings;
        for (std::uint32_t i = 0; i <= kAround; ++i) {
            // The last column is bit-identical to the first.
            const float around = 2.0f * kPi * static_cast<float>(i % kAround) / kAround;
            const float sine = is_pole ? 0.0f : std::sin(polar);
            const Vec3 out = std::cos(polar) * eye.forward
                             + sine * (std::cos(around) * eye.right + std::sin(around) * eye.up);
            append_head_vertex(
                mesh, eye.center + eye.radius * out, out, creature_eye_color(polar),
                {static_cast<float>(i) / kAround, static_cast<float>(row) / kRings});
        }
    }
    for (std::uint32_t row = 0; row < kRings; ++row) {
        for (std::uint32_t i = 0; i < kAround; ++i) {
            append_grid_cell(mesh, first, kAround, row, i);
        }
    }
}

/// A hemisphere that rotates about the corners of the eye; `side` +1: upper lid, -1: lower lid.
void add_lid(MeshData& mesh, const Eye& eye, float side, MorphTarget& blink) {
    constexpr std::uint32_t kAcross = 12;
    constexpr std::uint32_t kAlong = 8;
    const float open = side > 0 ? radians(33) : radians(42);
    const float closed = side > 0 ? radians(-14) : radians(16);
    const auto at = [&](float turn, float across) {
        const Vec3 out = std::cos(turn) * eye.forward + side * std::sin(turn) * eye.up;
        return std::cos(across) * out + std::sin(across) * eye.right;
    };
    const float radius =
        (side > 0 ? 1.13f : 1.1f) * eye.radius;  // the upper lid closes over the lower
    const Vec3 fur = creature_color(eye.center + 1.5f * eye.radius * eye.up, eye.up);
    const auto append = [&](float turn, float across, float size, const Vec3& color, bool is_cap) {
        const Vec3 rest = at(open + turn, across);
        const Vec3 shut = at(closed + turn, across);
        const Vec3 cap = at(open - 0.5f * kPi, 0);
        const Vec3 cap_shut = at(closed - 0.5f * kPi, 0);
        blink.vertices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        blink.positions.push_back(size * radius * (shut - rest));
        blink.normals.push_back(is_cap ? cap_shut - cap : shut - rest);
        append_head_vertex(
            mesh, eye.center + size * radius * rest, is_cap ? cap : rest, color,
            {0.5f + across / kPi, turn / kPi});
    };
    const auto across_of = [](std::uint32_t i) {
        return 0.5f * kPi * (2.0f * static_cast<float>(i) / kAcross - 1.0f);
    };
    const auto dome = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t row = 0; row <= kAlong; ++row) {
        const float turn = kPi * static_cast<float>(row) / kAlong;
        for (std::uint32_t i = 0; i <= kAcross; ++i) {
            append(turn, across_of(i), 1, row == 0 ? fox::kLidRim : fur, false);
        }
    }
    // The flat side, a fan from its center to both halves of its rim.
    const auto flat = static_cast<std::uint32_t>(mesh.positions.size());
    append(0, 0, 0, fox::kLidRim, true);
    for (std::uint32_t i = 0; i <= kAcross; ++i) {
        append(0, across_of(i), 1, fox::kLidRim, true);
    }
    for (std::uint32_t i = 0; i <= kAcross; ++i) {
        append(kPi, across_of(i), 1, fox::kLidRim, true);
    }
    const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.indices.insert(mesh.indices.end(), {a, side > 0 ? c : b, side > 0 ? b : c});
    };
    for (std::uint32_t row = 0; row < kAlong; ++row) {
        for (std::uint32_t i = 0; i < kAcross; ++i) {
            const std::uint32_t a = dome + row * (kAcross + 1) + i;
            const std::uint32_t b = a + kAcross + 1;
            triangle(a, a + 1, b);
            triangle(a + 1, b + 1, b);
        }
    }
    for (std::uint32_t i = 0; i < kAcross; ++i) {
        triangle(flat, flat + 2 + i, flat + 1 + i);
        const std::uint32_t back = flat + 2 + kAcross;
        triangle(flat, back + i, back + i + 1);
    }
}

/// The chest gets wider and deeper.
MorphTarget make_breath(const MeshData& mesh, std::size_t body_vertices) {
    MorphTarget breath;
    breath.name = "breath";
    const Vec3 lungs(0, 0.41f, 0.06f);
    for (std::uint32_t v = 0; v < body_vertices; ++v) {
        const Vec3 away = mesh.positions[v] - lungs;
        const float weight = std::exp(-glm::dot(away, away) / square(0.115f));
        const float legs = glm::smoothstep(0.27f, 0.36f, mesh.positions[v].y);
        if (weight * legs > 0.02f) {
            breath.vertices.push_back(v);
            breath.positions.push_back(0.011f * (weight * legs - 0.02f) * mesh.normals[v]);
        }
    }
    return breath;
}

/// The alpha of colors: none around the eyes.
void set_fur_length(MeshData& mesh) {
    const Eye eyes[] = {make_eye(1), make_eye(-1)};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const Vec3& p = mesh.positions[v];
        float bare = 0;
        for (const Eye& eye : eyes) {
            const float near =
                glm::smoothstep(2.2f, 1.3f, glm::distance(p, eye.center) / eye.radius);
            bare = std::max(bare, near);
        }
        mesh.colors[v].w = creature_fur_length(p) * (1.0f - bare);
    }
}

void scale_mesh(MeshData& mesh, float scale) {
    for (Vec3& p : mesh.positions) {
        p *= scale;
    }
    for (MorphTarget& morph : mesh.morphs) {
        for (Vec3& p : morph.positions) {
            p *= scale;
        }
    }
}

}  // namespace

Vec3 creature_joint(CreatureJoint joint) {
    return fox::kJoints[static_cast<std::size_t>(joint)].position;
}

std::int32_t creature_parent(CreatureJoint joint) {
    return fox::kJoints[static_cast<std::size_t>(joint)].parent;
}

MeshData make_creature(const CreatureShape& shape) {
    MeshData mesh;
    const ImplicitMesh body = mesh_surface(creature_distance, body_grid(shape));
    add_body(body, mesh);
    const std::size_t body_vertices = mesh.positions.size();
    MorphTarget blink;
    blink.name = "blink";
    for (const float side : {1.0f, -1.0f}) {
        const Eye eye = make_eye(side);
        add_eyeball(mesh, eye);
        add_lid(mesh, eye, 1, blink);
        add_lid(mesh, eye, -1, blink);
    }
    mesh.morphs.push_back(std::move(blink));
    mesh.morphs.push_back(make_breath(mesh, body_vertices));
    if (shape.triangles > 0) {
        simplify_mesh(mesh, static_cast<std::size_t>(shape.triangles));
    }
    generate_tangents(mesh);
    generate_morph_normals(mesh);
    generate_morph_tangents(mesh);
    set_fur_length(mesh);
    scale_mesh(mesh, shape.height / fox::kHeight);
    update_bounds(mesh);
    return mesh;
}

MeshRig make_creature_rig(const CreatureShape& shape) {
    const float scale = shape.height / fox::kHeight;
    MeshRig rig;
    for (std::size_t i = 0; i < kCreatureJoints; ++i) {
        const fox::JointInfo& joint = fox::kJoints[i];
        const Vec3 parent = joint.parent < 0
                                ? Vec3(0)
                                : fox::kJoints[static_cast<std::size_t>(joint.parent)].position;
        rig.skeleton.joints.emplace_back(joint.name);
        rig.skeleton.parents.push_back(joint.parent);
        rig.skeleton.rest.translations.push_back(scale * (joint.position - parent));
        rig.skeleton.rest.rotations.emplace_back(1, 0, 0, 0);
        rig.skeleton.rest.scales.emplace_back(1);
        rig.skin.joints.push_back(static_cast<std::uint16_t>(i));
        rig.skin.joint_from_mesh.push_back(
            affine_from(-scale * joint.position, Quat(1, 0, 0, 0), Vec3(1)));
    }
    for (const Gait& gait : creature_gaits()) {
        rig.clips.push_back(make_gait_clip(gait, scale));
    }
    return rig;
}

}  // namespace limn
