#include "systems/particles/emitter_place.h"

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

EmitterPlace place_of(const WorldTransform& now, const PreviousWorldTransform& previous) {
    const Vec4& row = previous.world.row[0];
    const bool is_new = row.x == 0 && row.y == 0 && row.z == 0 && row.w == 0;
    return {is_new ? now.world : previous.world, now.world};
}

Affine mix_places(const EmitterPlace& place, float at) {
    Affine mixed = place.before;
    for (int i = 0; i < 3; ++i) {
        mixed.row[i] += (place.now.row[i] - place.before.row[i]) * at;
    }
    return mixed;
}

EmitterEye find_eye(const Query<const Camera, const WorldTransform>& cameras) {
    EmitterEye eye;
    bool found = false;
    cameras.each([&](const Camera& camera, const WorldTransform& transform) {
        if (camera.active && !found) {
            eye = {transform_point(transform.world, Vec3(0)), camera.fov_y};
            found = true;
        }
    });
    return eye;
}

float seen_share(const ParticleEmitter& emitter, const Affine& world, const EmitterEye& eye) {
    if (!emitter.by_screen_area) {
        return 1;
    }
    const Vec3 reach = transform_vector(world, {emitter.size.x, 0, 0});
    const Vec3 side = transform_vector(world, {0, emitter.size.y, 0});
    const Vec3 depth = transform_vector(world, {0, 0, emitter.size.z});
    const float radius = std::max({glm::length(reach), glm::length(side), glm::length(depth)});
    return screen_share(
        radius, glm::distance(transform_point(world, Vec3(0)), eye.place), eye.fov_y);
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
    constexpr float kMost = 60;  // [s]
    const float time = std::clamp(finite_or(emitter.prewarm, 0), 0.0f, kMost);
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
