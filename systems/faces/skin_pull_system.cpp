#include "systems/faces/skin_pull_system.h"

#include "ecs/base/triangle.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/skin_kernels.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

// Techniques: face.pull

namespace limn {

namespace {

constexpr float kFollow = 3.0f;       ///< how much faster skin follows than it springs back; by eye
constexpr float kRestOffset = 1e-6f;  ///< [m]
constexpr float kRestSpeed = 1e-5f;   ///< [m/s]

struct PointerRay {
    Vec3 eye{0, 0, 0};
    Vec3 direction{0, 0, 0};  ///< unit, or 0: none
};

/// A pull that begins in this step.
struct NewSkinPull {
    Entity entity;
    SkinPull pull;
};

Vec3 interpolated_position(
    const std::vector<Vec3>& positions, const MeshData& mesh, std::uint32_t triangle,
    const Vec3& barycentric) {
    Vec3 position(0);
    for (std::uint32_t k = 0; k < 3; ++k) {
        position += barycentric[static_cast<int>(k)] * positions[mesh.indices[3 * triangle + k]];
    }
    return position;
}

/// The skin under the pointer, not pulled yet.
std::optional<SkinPull> grab_skin(
    const MeshSource& source, const Affine& world, const PointerRay& ray,
    const PullableSkin& skin) {
    const Mat4 world_from_mesh = to_mat4(world);
    if (source.data == nullptr || glm::determinant(Mat3(world_from_mesh)) == 0.0f) {
        return std::nullopt;
    }
    const MeshData& mesh = *source.data;
    const Affine mesh_from_world = to_affine(glm::inverse(world_from_mesh));
    std::vector<Vec3> positions;
    if (!deform_positions(
            mesh, *source.deformed, source.skin, source.pose, source.morphs, source.deformers,
            positions, source.surface)) {
        return std::nullopt;
    }
    const auto hit = hit_skin(
        positions, mesh.indices, transform_point(mesh_from_world, ray.eye),
        transform_vector(mesh_from_world, ray.direction));
    if (!hit) {
        return std::nullopt;
    }
    deform_positions(
        mesh, *source.deformed, nullptr, nullptr, source.morphs, source.deformers, positions,
        source.surface);
    SkinPull pull;
    pull.tug.at = interpolated_position(positions, mesh, hit->triangle, hit->barycentric);
    pull.tug.radius = skin.radius;
    pull.held = true;
    pull.distance = hit->distance;
    pull.triangle = hit->triangle;
    pull.shares = hit->barycentric;
    return pull;
}

/// The transform by joints at the point of a pull: the mean over the corners of its triangle.
Mat4 skin_matrix_at(const MeshSource& source, const SkinPull& pull) {
    const MeshData& mesh = *source.data;
    if (source.skin == nullptr || source.pose == nullptr || mesh.skin.empty()) {
        return Mat4(1.0f);
    }
    std::vector<Affine> palette(used_joints(mesh.skin));
    compute_skin_palette(*source.skin, source.pose->joints, palette);
    Mat4 mean(0.0f);
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.indices[3 * pull.triangle + k];
        const std::uint32_t first = mesh.skin.first[vertex];
        const std::uint32_t end = mesh.skin.first[vertex + 1];
        const float weight = pull.shares[static_cast<int>(k)];
        if (first == end) {
            mean += weight * Mat4(1.0f);  // no joint moves it
        }
        for (std::uint32_t i = first; i < end; ++i) {
            mean += weight * mesh.skin.weights[i] * to_mat4(palette[mesh.skin.joints[i]]);
        }
    }
    return mean;
}

/// The offset that moves the point to the pointer, within the limit of a pull; 0 where the
/// transform is singular.
Vec3 pointer_offset(
    const MeshSource& source, const Affine& world, const PointerRay& ray, const PullableSkin& skin,
    const SkinPull& pull) {
    const Mat4 world_from_unskinned = to_mat4(world) * skin_matrix_at(source, pull);
    const Vec4 target(ray.eye + pull.distance * ray.direction, 1.0f);
    const Vec3 position = Vec3(glm::inverse(world_from_unskinned) * target);
    return limited_pull(position - pull.tug.at, skin.reach);
}

bool is_at_rest(const SkinPull& pull) {
    return !pull.held && glm::length(pull.tug.offset) < kRestOffset
           && glm::length(pull.velocity) < kRestSpeed;
}

/// False after the entity got another mesh.
bool has_triangle(const MeshSource& source, std::uint32_t triangle) {
    return source.data != nullptr && 3 * std::size_t{triangle} + 2 < source.data->indices.size();
}

void add_skin_pull(std::vector<SkinPull>& pulls, const SkinPull& pull) {
    if (pulls.size() == kMaxSkinPulls) {
        pulls.erase(pulls.begin());
    }
    pulls.push_back(pull);
}

void step_pull(SkinPull& pull, const Vec3& goal, float rate, float dt) {
    const SpringState next =
        spring_after({pull.tug.offset, pull.velocity}, goal, pull.held ? kFollow * rate : rate, dt);
    const bool finite = is_finite(next.offset) && is_finite(next.velocity);
    pull.tug.offset = finite ? next.offset : Vec3(0);
    pull.velocity = finite ? next.velocity : Vec3(0);
}

}  // namespace

SpringState spring_after(const SpringState& spring, const Vec3& goal, float rate, float dt) {
    const Vec3 from = spring.offset - goal;
    const Vec3 slope = spring.velocity + rate * from;
    const float decay = std::exp(-rate * dt);
    return {goal + decay * (from + dt * slope), decay * (spring.velocity - dt * rate * slope)};
}

Vec3 limited_pull(const Vec3& offset, float limit) {
    const float length = glm::length(offset);
    return std::isfinite(length) && limit > 0.0f ? offset / std::sqrt(1.0f + square(length / limit))
                                                 : Vec3(0);
}

std::optional<SkinHit> hit_skin(
    std::span<const Vec3> positions, std::span<const std::uint32_t> indices, const Vec3& origin,
    const Vec3& direction) {
    std::optional<SkinHit> nearest;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const Vec3& a = positions[indices[i]];
        const Vec3& b = positions[indices[i + 1]];
        const Vec3& c = positions[indices[i + 2]];
        const auto hit = hit_triangle(origin, direction, a, b, c);
        if (hit && glm::dot(glm::cross(b - a, c - a), direction) < 0.0f
            && (!nearest || hit->distance < nearest->distance)) {
            nearest = SkinHit{
                static_cast<std::uint32_t>(i / 3),
                {1.0f - hit->b - hit->c, hit->b, hit->c},
                hit->distance};
        }
    }
    return nearest;
}

void add_skin_pulls(
    Query<const PullableSkin, Without<SkinPulls>> bare, Query<const Deformers> deformers,
    Commands commands) {
    bare.each([&](Entity entity, const PullableSkin&) {
        commands.add(entity, SkinPulls{});
        if (deformers.find<const Deformers>(entity) == nullptr) {
            commands.add(entity, Deformers{});
        }
    });
}

void update_skin_pulls(
    Query<const PullableSkin, SkinPulls, const MeshInstance, const Deformed, const WorldTransform>
        skins,
    Query<const DeformerState> deformers, Query<const Pose> poses, Query<const MorphWeights> morphs,
    Query<const SurfaceBindingState> bindings, Res<const Assets> assets, Res<const Input> input,
    Res<const FrameTime> time) {
    const PointerRay ray = {input->eye, normalize_or(input->pointing, Vec3(0))};
    const bool points = ray.direction != Vec3(0);
    const auto source_of = [&](Entity entity, const MeshInstance& instance,
                               const Deformed& deformed) {
        return find_mesh_source(
            instance.mesh, &deformed, deformers.find<const DeformerState>(entity), poses, morphs,
            *assets, bindings.find<const SurfaceBindingState>(entity));
    };
    const bool holds = action_value(*input, "pull_skin") > 0;
    std::optional<NewSkinPull> grabbed;
    skins.each([&](Entity entity, const PullableSkin& skin, SkinPulls& state,
                   const MeshInstance& instance, const Deformed& deformed,
                   const WorldTransform& transform) {
        if (std::exchange(state.asked, holds) || !holds || !points) {
            return;
        }
        const auto pull =
            grab_skin(source_of(entity, instance, deformed), transform.world, ray, skin);
        if (pull && (!grabbed || pull->distance < grabbed->pull.distance)) {
            grabbed = NewSkinPull{entity, *pull};
        }
    });
    skins.each([&](Entity entity, const PullableSkin& skin, SkinPulls& state,
                   const MeshInstance& instance, const Deformed& deformed,
                   const WorldTransform& transform) {
        if (grabbed && grabbed->entity == entity) {
            add_skin_pull(state.pulls, grabbed->pull);
        }
        for (SkinPull& pull : state.pulls) {
            const MeshSource source = source_of(entity, instance, deformed);
            pull.held = pull.held && holds && has_triangle(source, pull.triangle);
            const Vec3 goal = !pull.held ? Vec3(0)
                              : points   ? pointer_offset(source, transform.world, ray, skin, pull)
                                         : pull.tug.offset;
            step_pull(pull, goal, skin.rate, time->step);
        }
        std::erase_if(state.pulls, is_at_rest);
    });
}

}  // namespace limn
