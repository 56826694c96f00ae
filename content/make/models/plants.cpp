#include "content/make/models/plants.h"

#include "content/bake/tangents.h"
#include "ecs/base/check.h"
#include "ecs/base/hash.h"
#include "ecs/base/rng.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

// Techniques: particle.volume-fill

namespace limn {
namespace {

constexpr float kMinLengthFraction =
    0.05f;  // minimum fraction of the mean length, for wide spreads

/// Length of a chain of mean branches from the root to the tip of the last level [m].
float total_length(const PlantShape& shape) {
    float length_sum = 0;
    float length = shape.length;
    for (int level = 0; level <= shape.levels; ++level) {
        length_sum += length;
        length *= shape.shrink;
    }
    return length_sum;
}

/// A random direction, uniform by solid angle, within `spread` of `axis`.
Vec3 direction_about(const Vec3& axis, float spread, Random& random) {
    const float y = std::lerp(std::cos(spread), 1.0f, random.uniform());
    const float angle = 2 * kPi * random.uniform();
    const float radius = std::sqrt(std::max(1 - y * y, 0.0f));
    const Vec3 side = any_perpendicular(axis);
    return axis * y + side * (radius * std::cos(angle))
           + glm::cross(axis, side) * (radius * std::sin(angle));
}

/// A particle at `root`, `scale` times as large as a stem.
PlantParticle grow_one(
    const PlantShape& shape, const Vec3& root, const Vec3& axis, float scale, float fraction,
    Random& random) {
    const float vary = shape.length_spread * random.uniform(-1.0f, 1.0f);
    const float length = scale * std::max(shape.length + vary, kMinLengthFraction * shape.length);
    return {
        .root = root,
        .along = length * direction_about(axis, shape.spread, random),
        .width = scale * shape.width,
        .root_fraction = fraction,
        .tip_fraction = fraction + scale * shape.length / total_length(shape)};
}

/// Unit vector across the blade: horizontal if possible, in any direction for an upright stem.
Vec3 blade_side(const PlantParticle& particle, std::size_t number) {
    const Vec3 along = normalize_or(particle.along, Vec3(0, 1, 0));
    const Vec3 any = any_perpendicular(along);
    Random random(0, number, name_hash("blade_side"), 0);
    const float angle = 2 * kPi * random.uniform();
    return any * std::cos(angle) + glm::cross(along, any) * std::sin(angle);
}

/// A blade: pairs of vertices, or one at a tip that is `pointed`.
void add_blade(
    MeshData& mesh, const PlantShape& shape, const PlantParticle& particle, const Vec3& side,
    int segments, bool pointed) {
    for (int ring = 0; ring <= segments; ++ring) {
        const float at = static_cast<float>(ring) / static_cast<float>(segments);
        const Vec3 center = plant_point(shape, particle, at);
        const Vec3 ahead = plant_point(shape, particle, at + 0.01f) - center;
        const Vec3 normal = normalize_or(glm::cross(side, ahead), Vec3(0, 1, 0));
        const float taper = pointed ? 1 - at : std::lerp(1.0f, shape.shrink, at);
        for (const float edge : {-0.5f, 0.5f}) {
            mesh.positions.push_back(center + side * (edge * particle.width * taper));
            mesh.normals.push_back(normal);
            mesh.uvs.emplace_back(0.5f + edge, 1 - at);
        }
        if (ring > 0) {
            const auto last = static_cast<std::uint32_t>(mesh.positions.size()) - 4;
            const bool tip = pointed && ring == segments;
            for (const std::uint32_t i : {0u, 1u, 2u, 2u, 1u, 3u}) {
                mesh.indices.push_back(last + i);
            }
            if (tip) {  // the upper pair is one point: its triangle has no area
                mesh.indices.resize(mesh.indices.size() - 3);
            }
        }
    }
}

}  // namespace

std::vector<PlantParticle> grow_plants(const PlantShape& shape) {
    LIMN_CHECK(shape.stems >= 1 && shape.branches >= 1 && shape.levels >= 0);
    std::vector<PlantParticle> particles;
    const auto stems = static_cast<std::size_t>(shape.stems);
    particles.reserve(stems);
    for (std::size_t i = 0; i < stems; ++i) {
        Random random(shape.seed, i, name_hash("grow_plants"), 0);
        const float x = shape.area.x * (random.uniform() - 0.5f);
        const float z = shape.area.y * (random.uniform() - 0.5f);
        particles.push_back(grow_one(shape, {x, 0, z}, {0, 1, 0}, 1, 0, random));
    }
    const auto branches = static_cast<std::size_t>(shape.branches);
    std::size_t first = 0;  // first particle of the level that branches
    float scale = 1;
    for (int level = 1; level <= shape.levels; ++level) {
        const std::size_t end = particles.size();
        if (end + (end - first) * branches > kMaxPlantParticles) {
            break;
        }
        particles.reserve(end + (end - first) * branches);
        scale *= shape.shrink;
        for (std::size_t parent = first; parent < end; ++parent) {
            const PlantParticle from = particles[parent];
            const Vec3 axis = normalize_or(from.along, Vec3(0, 1, 0));
            for (std::size_t i = 0; i < branches; ++i) {
                Random random(shape.seed, particles.size(), name_hash("grow_plants"), 0);
                particles.push_back(grow_one(
                    shape, from.root + from.along, axis, scale, from.tip_fraction, random));
            }
        }
        first = end;
    }
    return particles;
}

Vec3 plant_point(const PlantShape& shape, const PlantParticle& particle, float at) {
    const float fraction = std::lerp(particle.root_fraction, particle.tip_fraction, at);
    return particle.root + at * particle.along
           + shape.wind * (total_length(shape) * fraction * fraction);
}

MeshData make_plants(const PlantShape& shape) {
    LIMN_CHECK(shape.segments >= 1);
    const std::vector<PlantParticle> particles = grow_plants(shape);
    MeshData mesh;
    const int segments =
        std::min(shape.segments, static_cast<int>(kMaxPlantParticles / particles.size()));
    const std::size_t vertices = 2 * (static_cast<std::size_t>(segments) + 1);
    mesh.positions.reserve(particles.size() * vertices);
    mesh.normals.reserve(particles.size() * vertices);
    mesh.uvs.reserve(particles.size() * vertices);
    const float last_level = particles.back().tip_fraction;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const bool pointed = particles[i].tip_fraction >= last_level;
        add_blade(mesh, shape, particles[i], blade_side(particles[i], i), segments, pointed);
    }
    for (const Vec3& position : mesh.positions) {
        grow(mesh.bounds, position);
    }
    generate_tangents(mesh);
    return mesh;
}

}  // namespace limn
