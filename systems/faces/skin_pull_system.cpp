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

/// The ray of the pointer.
struct Pointing {
    Vec3 eye{0, 0, 0};
    Vec3 direction{0, 0, 0};  ///< unit, or 0: none
};

/// What a pull begins with.
struct Taken {
    Entity entity;
    SkinPull pull;
};

Vec3 between(
    const std::vector<Vec3>& positions, const MeshData& mesh, std::uint32_t triangle,
    const Vec3& shares) {
    Vec3 place(0);
    for (std::uint32_t k = 0; k < 3; ++k) {
        place += shares[static_cast<int>(k)] * positions[mesh.indices[3 * triangle + k]];
    }
    return place;
}

/// The skin under the pointer, not pulled yet.
std::optional<SkinPull> take_skin(
    const MeshSource& source, const Affine& world, const Pointing& pointing,
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
        positions, mesh.indices, transform_point(mesh_from_world, pointing.eye),
        transform_vector(mesh_from_world, pointing.direction));
    if (!hit) {
        return std::nullopt;
    }
    deform_positions(
        mesh, *source.deformed, nullptr, nullptr, source.morphs, source.deformers, positions,
        source.surface);
    SkinPull pull;
    pull.tug.at = between(positions, mesh, hit->triangle, hit->shares);
    pull.tug.radius = skin.radius;
    pull.held = true;
    pull.distance = hit->distance;
    pull.triangle = hit->triangle;
    pull.shares = hit->shares;
    return pull;
}

/// Where joints take what is before them, at the place of a pull: the mean of its corners.
Mat4 joints_at(const MeshSource& source, const SkinPull& pull) {
    const MeshData& mesh = *source.data;
    if (source.skin == nullptr || source.pose == nullptr || mesh.skin.empty()) {
        return Mat4(1.0f);
    }
    std::vector<Affine> palette(source.skin->joints.size());
    compute_skin_palette(*source.skin, source.pose->joints, palette);
    Mat4 mean(0.0f);
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.indices[3 * pull.triangle + k];
        const std::uint32_t first = mesh.skin.first[vertex];
        const std::uint32_t end = mesh.skin.first[vertex + 1];
        const float share = pull.shares[static_cast<int>(k)];
        if (first == end) {
            mean += share * Mat4(1.0f);  // no joint moves it
        }
        for (std::uint32_t i = first; i < end; ++i) {
            mean += share * mesh.skin.weights[i] * to_mat4(palette[mesh.skin.joints[i]]);
        }
    }
    return mean;
}

/// The offset that takes the place to the pointer, as far as it reaches; none where joints or the
/// entity leave no space.
Vec3 pointer_offset(
    const MeshSource& source, const Affine& world, const Pointing& pointing,
    const PullableSkin& skin, const SkinPull& pull) {
    const Mat4 world_from_before = to_mat4(world) * joints_at(source, pull);
    const Vec4 target(pointing.eye + pull.distance * pointing.direction, 1.0f);
    const Vec3 place = Vec3(glm::inverse(world_from_before) * target);
    return limited_pull(place - pull.tug.at, skin.reach);
}

bool is_at_rest(const SkinPull& pull) {
    return !pull.held && glm::length(pull.tug.offset) < kRestOffset
           && glm::length(pull.velocity) < kRestSpeed;
}

/// False once the entity has another mesh.
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
    const float left = std::exp(-rate * dt);
    return {goal + left * (from + dt * slope), left * (spring.velocity - dt * rate * slope)};
}

Vec3 limited_pull(const Vec3& offset, float reach) {
    const float length = glm::length(offset);
    return std::isfinite(length) && reach > 0.0f ? offset / std::sqrt(1.0f + square(length / reach))
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
    const Pointing pointing = {input->eye, normalize_or(input->pointing, Vec3(0))};
    const bool points = pointing.direction != Vec3(0);
    const auto source_of = [&](Entity entity, const MeshInstance& instance,
                               const Deformed& deformed) {
        return find_mesh_source(
            instance.mesh, &deformed, deformers.find<const DeformerState>(entity), poses, morphs,
            *assets, bindings.find<const SurfaceBindingState>(entity));
    };
    const bool holds = action_value(*input, "pull_skin") > 0;
    std::optional<Taken> taken;
    skins.each([&](Entity entity, const PullableSkin& skin, SkinPulls& state,
                   const MeshInstance& instance, const Deformed& deformed,
                   const WorldTransform& place) {
        if (std::exchange(state.asked, holds) || !holds || !points) {
            return;
        }
        const auto pull =
            take_skin(source_of(entity, instance, deformed), place.world, pointing, skin);
        if (pull && (!taken || pull->distance < taken->pull.distance)) {
            taken = Taken{entity, *pull};
        }
    });
    skins.each([&](Entity entity, const PullableSkin& skin, SkinPulls& state,
                   const MeshInstance& instance, const Deformed& deformed,
                   const WorldTransform& place) {
        if (taken && taken->entity == entity) {
            add_skin_pull(state.pulls, taken->pull);
        }
        for (SkinPull& pull : state.pulls) {
            const MeshSource source = source_of(entity, instance, deformed);
            pull.held = pull.held && holds && has_triangle(source, pull.triangle);
            const Vec3 goal = !pull.held ? Vec3(0)
                              : points   ? pointer_offset(source, place.world, pointing, skin, pull)
                                         : pull.tug.offset;
            step_pull(pull, goal, skin.rate, time->step);
        }
        std::erase_if(state.pulls, is_at_rest);
    });
}

}  // namespace limn
