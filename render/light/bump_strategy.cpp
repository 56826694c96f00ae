#include "render/light/bump_strategy.h"

#include "render/geometry/mesh_pool.h"
#include "render/light/light_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// The mesh that a command draws; null for one whose vertices are its own.
const MeshRange* drawn_mesh(const DrawCommand& command, const MeshPool& meshes) {
    const auto& all = meshes.meshes();
    const auto found = std::find_if(all.begin(), all.end(), [&](const MeshRange& mesh) {
        return mesh.index_count > 0 && mesh.first_index == command.first_index
               && mesh.base_vertex == command.base_vertex;
    });
    return found != all.end() ? &*found : nullptr;
}

/// The coarsest of the command's objects decides for all.
BumpStrategy strategy_of(
    const DrawCommand& command, const InstanceList& list, const MeshRange& mesh,
    const LightList& lights) {
    const float size = std::max(glm::length(half_extent(mesh.bounds)), 1e-20f);
    for (std::uint32_t i = 0; i < command.instance_count; ++i) {
        const std::uint32_t instance = command.base_instance + i;
        const BoxBlock& block = list.boxes[instance / kCullBlock];
        const Vec3 half = block.half(instance % kCullBlock);
        const float edge = mesh.mean_edge * glm::length(half) / size;
        const float distance =
            nearest_lamp(lights.ranges, block.center(instance % kCullBlock), half);
        if (bump_strategy(edge, distance) == BumpStrategy::Pixel) {
            return BumpStrategy::Pixel;
        }
    }
    return BumpStrategy::Vertex;
}

/// Appends one command of a run.
void append_command(std::vector<DrawRun>& runs, const DrawRun& run, std::uint32_t command) {
    const bool follows = !runs.empty() && runs.back().features == run.features
                         && runs.back().textures == run.textures
                         && runs.back().mirrored == run.mirrored && runs.back().wide == run.wide
                         && runs.back().first_command + runs.back().command_count == command;
    if (!follows) {
        runs.push_back(run);
        runs.back().first_command = command;
        runs.back().command_count = 0;
    }
    ++runs.back().command_count;
}

}  // namespace

BumpStrategy bump_strategy(float mean_edge, float light_distance) {
    return mean_edge <= kCoarseEdge * light_distance ? BumpStrategy::Vertex : BumpStrategy::Pixel;
}

float nearest_lamp(std::span<const LightRange> lamps, const Vec3& center, const Vec3& half) {
    float nearest = INFINITY;
    for (const LightRange& lamp : lamps) {
        const Vec3 outside = glm::max(glm::abs(lamp.center - center) - half, Vec3(0));
        const float distance = glm::length(outside);
        nearest = distance <= lamp.radius ? std::min(nearest, distance) : nearest;
    }
    return nearest;
}

BumpRuns
split_bump_runs(const InstanceList& list, const MeshPool& meshes, const LightList& lights) {
    BumpRuns runs;
    for (const DrawRun& run : list.opaque) {
        for (std::uint32_t i = 0; i < run.command_count; ++i) {
            const std::uint32_t at = run.first_command + i;
            const DrawCommand& command = list.command_values[at];
            const MeshRange* const mesh =
                run.features.has(kClassicBumps) ? drawn_mesh(command, meshes) : nullptr;
            const bool at_vertices =
                mesh != nullptr
                && strategy_of(command, list, *mesh, lights) == BumpStrategy::Vertex;
            append_command(at_vertices ? runs.vertex : runs.pixel, run, at);
        }
    }
    return runs;
}

}  // namespace limn
