#include "systems/particles/force_fields.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: particle.forces

namespace limn {

std::vector<Force>
find_forces(const Query<const ForceField, const WorldTransform>& fields, double time) {
    std::vector<Force> forces;
    fields.each([&](const ForceField& field, const WorldTransform& at) {
        double strength = static_cast<double>(finite_or(field.strength, 0));
        if (field.frequency > 0) {
            const double turns = std::fmod(static_cast<double>(field.frequency) * time, 1.0);
            strength *= std::sin(
                2 * 3.14159265358979 * turns + static_cast<double>(finite_or(field.phase, 0)));
        }
        const Vec3 origin = transform_point(at.world, Vec3(0));
        if (strength != 0 && is_finite(origin)) {
            forces.push_back(
                {.kind = field.kind,
                 .origin = origin,
                 .axis = normalize_or(transform_vector(at.world, Vec3(0, 1, 0)), Vec3(0, 1, 0)),
                 .strength = static_cast<float>(strength),
                 .speed = finite_or(field.speed, 0),
                 .radius = std::max(finite_or(field.radius, 0), 0.0f)});
        }
    });
    return forces;
}

Vec3 acceleration(const Force& force, const Vec3& position, const Vec3& velocity) {
    const Vec3 offset = position - force.origin;
    const float distance2 = glm::dot(offset, offset);
    float strength = force.strength;
    if (force.radius > 0) {
        strength *= std::max(1 - distance2 / (force.radius * force.radius), 0.0f);
    }
    switch (force.kind) {
    case ForceKind::Push:
        return strength * force.axis;
    case ForceKind::Attract:
        return distance2 > 0 ? (-strength / std::sqrt(distance2)) * offset : Vec3(0);
    case ForceKind::Spring:
        return -strength * offset;
    case ForceKind::Whirl: {
        const Vec3 tangent = glm::cross(force.axis, offset);
        const float radius = glm::length(tangent);
        return radius > 0 ? (strength / radius) * tangent : Vec3(0);
    }
    case ForceKind::Wind:
        return strength * (force.speed * force.axis - velocity);
    }
    return Vec3(0);
}

void apply_forces(
    const ParticleBlock& block, std::span<const Force> forces, float scale, float dt) {
    for (std::size_t i = 0; i < block.count; ++i) {
        const Vec3 position = {block.x[i], block.y[i], block.z[i]};
        const Vec3 velocity = {block.vx[i], block.vy[i], block.vz[i]};
        Vec3 sum(0);
        for (const Force& force : forces) {
            sum += acceleration(force, position, velocity);
        }
        block.vx[i] += sum.x * (scale * dt);
        block.vy[i] += sum.y * (scale * dt);
        block.vz[i] += sum.z * (scale * dt);
    }
}

}  // namespace limn
