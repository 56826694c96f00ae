#include "systems/particles/emitter_pose.h"

#include "systems/particles/particle_births.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace limn {
namespace {

constexpr std::uint32_t kBirths = name_hash("particle births");
constexpr std::uint32_t kPrewarm = name_hash("particle prewarm");
constexpr std::uint32_t kAttributes = name_hash("particles");
constexpr std::uint32_t kSurface = name_hash("particle surface");

}  // namespace

EmitterPose emitter_pose(const WorldTransform& now, const PreviousWorldTransform& previous) {
    const Vec4& row = previous.world.row[0];
    const bool is_new = row.x == 0 && row.y == 0 && row.z == 0 && row.w == 0;
    return {is_new ? now.world : previous.world, now.world};
}

Affine interpolate_pose(const EmitterPose& pose, float at) {
    Affine mixed = pose.before;
    for (int i = 0; i < 3; ++i) {
        mixed.row[i] += (pose.now.row[i] - pose.before.row[i]) * at;
    }
    return mixed;
}

Viewpoint find_viewpoint(const Query<const Camera, const WorldTransform>& cameras) {
    Viewpoint eye;
    bool found = false;
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && !found) {
            eye = {transform_point(transform.world, Vec3(0)), camera.fov_y};
            found = true;
        }
    });
    return eye;
}

float screen_coverage(const ParticleEmitter& emitter, const Affine& world, const Viewpoint& eye) {
    if (!emitter.by_screen_area) {
        return 1;
    }
    const Vec3 width = transform_vector(world, {emitter.size.x, 0, 0});
    const Vec3 height = transform_vector(world, {0, emitter.size.y, 0});
    const Vec3 depth = transform_vector(world, {0, 0, emitter.size.z});
    const float radius = std::max({glm::length(width), glm::length(height), glm::length(depth)});
    return screen_coverage(
        radius, glm::distance(transform_point(world, Vec3(0)), eye.position), eye.fov_y);
}

std::uint64_t subject_of(const ParticleEmitter& emitter, Entity entity) {
    return emitter.seed != 0 ? emitter.seed : entity.bits();
}

Random births_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t frame) {
    return {seed, subject, kBirths, frame};
}

bool is_unused(const EmitterClock& clock) {
    return clock.born == 0 && clock.time == 0;
}

int prewarm_steps(const ParticleEmitter& emitter, float dt) {
    constexpr float kMaxPrewarm = 60;  // [s]
    const float time = std::clamp(finite_or(emitter.prewarm, 0), 0.0f, kMaxPrewarm);
    return dt > 0 ? static_cast<int>(time / dt + 0.5f) : 0;
}

Random prewarm_random(std::uint64_t seed, std::uint64_t subject, int i) {
    return {seed, subject, kPrewarm, static_cast<std::uint64_t>(i)};
}

Random attributes_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number) {
    return {seed, subject, kAttributes, number};
}

Random surface_random(std::uint64_t seed, std::uint64_t subject, std::uint64_t number) {
    return {seed, subject, kSurface, number};
}

}  // namespace limn
