#include "systems/particles/surface_births.h"

#include "systems/particles/emitter_pose.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

// Techniques: engine.explode, particle.generation-shape, particle.mesh-volume

namespace limn {
namespace {

/// Triangle `i` of the table's vertices, transformed by `world`; false if an index is out of range.
bool find_source_triangle(
    const MeshData& mesh, const std::vector<Vec3>& positions, std::size_t i, const Affine& world,
    std::array<Vec3, 3>& corners) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.indices[3 * i + k];
        if (vertex >= positions.size()) {
            return false;
        }
        corners[k] = transform_point(world, positions[vertex]);
    }
    return true;
}

Vec3 cross_of(const std::array<Vec3, 3>& corners) {
    return glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
}

bool is_mirrored(const Affine& world) {
    const Vec3 x(world.row[0].x, world.row[1].x, world.row[2].x);
    const Vec3 y(world.row[0].y, world.row[1].y, world.row[2].y);
    const Vec3 z(world.row[0].z, world.row[1].z, world.row[2].z);
    return glm::dot(glm::cross(x, y), z) < 0;
}

Quat with_up(const Vec3& up) {
    return {Vec3(0, 1, 0), up};
}

/// World position and velocity of a position in the space of the source.
SurfacePoint
follow_source(const SurfaceSource& source, const Vec3& local, const Affine& world, float dt) {
    SurfacePoint point;
    point.position = transform_point(world, local);
    const Vec3 moved =
        transform_point(source.pose.now, local) - transform_point(source.pose.before, local);
    point.velocity = dt > 0 ? moved / dt : Vec3(0);
    return point;
}

SurfacePoint mesh_point(
    const SurfaceSource& source, const SurfaceTable& table, const Affine& world, float dt,
    Random& random) {
    const MeshData& mesh = *source.mesh.data;
    const double wanted = table.areas.back() * static_cast<double>(random.uniform());
    const auto found = std::upper_bound(table.areas.begin(), table.areas.end(), wanted);
    const auto last = static_cast<std::ptrdiff_t>(table.areas.size()) - 1;
    const auto i = static_cast<std::size_t>(std::min(found - table.areas.begin(), last));
    const float root = std::sqrt(random.uniform());
    const float side = random.uniform();
    const auto corner = [&](std::size_t k) { return table.positions[mesh.indices[3 * i + k]]; };
    const Vec3 local =
        corner(0) * (1 - root) + corner(1) * (root * (1 - side)) + corner(2) * (root * side);
    SurfacePoint point = follow_source(source, local, world, dt);
    std::array<Vec3, 3> corners{};
    find_source_triangle(mesh, table.positions, i, world, corners);
    const Vec3 front = is_mirrored(world) ? -cross_of(corners) : cross_of(corners);
    const Vec3 normal = normalize_or(front, Vec3(0, 1, 0));
    point.turn = with_up(normal);
    point.position += normal * finite_or(source.surface->offset, 0);
    return point;
}

SurfacePoint
path_point(const SurfaceSource& source, const Affine& world, float dt, Random& random) {
    const double distance =
        static_cast<double>(source.path->length()) * static_cast<double>(random.uniform());
    const PathFrame frame = path_frame_at(*source.path, distance);
    SurfacePoint point = follow_source(source, frame.position, world, dt);
    const Vec3 up = normalize_or(transform_vector(world, frame.up), Vec3(0, 1, 0));
    const Vec3 ahead = transform_vector(world, frame.ahead);
    const Vec3 right = normalize_or(glm::cross(up, ahead), any_perpendicular(up));
    point.turn = glm::quat_cast(Mat3(right, up, glm::cross(right, up)));
    point.position += up * finite_or(source.surface->offset, 0);
    return point;
}

SurfacePoint piece_point(
    const SurfaceSource& source, std::uint64_t number, const Affine& world, float dt,
    Random& random) {
    const std::vector<MeshPiece>& pieces = source.mesh.data->pieces;
    const auto piece = static_cast<std::size_t>(number % pieces.size());
    SurfacePoint point = follow_source(source, pieces[piece].center, world, dt);
    const Vec3 away = point.position - transform_point(world, source.surface->blast);
    point.turn = with_up(normalize_or(away, random.direction()));
    point.piece = static_cast<std::uint32_t>(piece);
    return point;
}

std::optional<SurfacePoint> volume_point(
    const SurfaceSource& source, const SurfaceTable& table, const Affine& world, float dt,
    Random& random) {
    const std::optional<Vec3> local =
        draw_in_volume(table.volume, table.positions, source.mesh.data->indices, random);
    return local ? std::optional(follow_source(source, *local, world, dt)) : std::nullopt;
}

/// Prefix sums of the areas; false if the total is 0.
bool sum_areas(const SurfaceSource& source, SurfaceTable& table) {
    const MeshData& mesh = *source.mesh.data;
    table.areas.resize(mesh.indices.size() / 3);
    double sum = 0;
    std::array<Vec3, 3> corners{};
    for (std::size_t i = 0; i < table.areas.size(); ++i) {
        if (find_source_triangle(mesh, table.positions, i, source.pose.now, corners)) {
            const float area = 0.5f * glm::length(cross_of(corners));
            sum += std::isfinite(area) ? static_cast<double>(area) : 0.0;
        }
        table.areas[i] = sum;
    }
    return sum > 0;
}

}  // namespace

SurfaceSource find_surface_source(
    const ParticleSurface& surface, const ParticleMesh* mesh, Entity emitter,
    const EmitterPose& pose, const MeshQuery& meshes, const Query<const Pose>& poses,
    const Query<const MorphWeights>& morphs, const Assets& assets) {
    SurfaceSource source{.surface = &surface, .pose = pose};
    switch (surface.on) {
    case BirthSurface::Mesh:
    case BirthSurface::Volume: {
        const Entity entity = surface.entity.is_null() ? emitter : surface.entity;
        const auto* const instance = meshes.find<const MeshInstance>(entity);
        if (instance != nullptr) {
            source.mesh = find_mesh_source(
                instance->mesh, meshes.find<const Deformed>(entity),
                meshes.find<const DeformerState>(entity), poses, morphs, assets,
                meshes.find<const SurfaceBindingState>(entity));
            source.pose = emitter_pose(
                *meshes.find<const WorldTransform>(entity),
                *meshes.find<const PreviousWorldTransform>(entity));
        }
        break;
    }
    case BirthSurface::Path:
        source.path =
            surface.path.index < assets.paths.size() ? &assets.paths[surface.path.index] : nullptr;
        break;
    case BirthSurface::Pieces:
        if (mesh != nullptr && !mesh->meshes.empty()
            && mesh->meshes[0].index < assets.meshes.size()) {
            source.mesh.mesh = mesh->meshes[0];
            source.mesh.data = &assets.meshes[mesh->meshes[0].index];
        }
        break;
    }
    return source;
}

bool fill_surface_table(const SurfaceSource& source, SurfaceTable& table) {
    switch (source.surface->on) {
    case BirthSurface::Mesh:
    case BirthSurface::Volume:
        if (source.mesh.data == nullptr) {
            return false;
        }
        transform_vertices(source.mesh, Affine{}, table.positions);
        return source.surface->on == BirthSurface::Mesh
                   ? sum_areas(source, table)
                   : fill_mesh_volume(table.positions, source.mesh.data->indices, table.volume);
    case BirthSurface::Path:
        return source.path != nullptr;
    case BirthSurface::Pieces:
        return source.mesh.data != nullptr && !source.mesh.data->pieces.empty();
    }
    return false;
}

std::optional<SurfacePoint> surface_point(
    const SurfaceSource& source, const SurfaceTable& table, std::uint64_t number, float at,
    float dt, Random& random) {
    const Affine world = interpolate_pose(source.pose, at);
    switch (source.surface->on) {
    case BirthSurface::Mesh:
        return mesh_point(source, table, world, dt, random);
    case BirthSurface::Path:
        return path_point(source, world, dt, random);
    case BirthSurface::Pieces:
        return piece_point(source, number, world, dt, random);
    case BirthSurface::Volume:
        return volume_point(source, table, world, dt, random);
    }
    return std::nullopt;
}

}  // namespace limn
