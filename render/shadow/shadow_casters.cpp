#include "render/shadow/shadow_casters.h"

#include "ecs/base/hash.h"
#include "ecs/components/shadow.h"
#include "ecs/world.h"
#include "render/instance_rows.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <vector>

namespace limn {

CasterVolume make_caster_volume(const ShadowView& view) {
    CasterVolume volume = {make_frustum(view.clip_from_world), view.shading, view.eye, view.reach};
    if (view.clamp_depth) {
        // Casters in front of the near plane count; beyond the far one (depth 0) they do not.
        const Mat4 rows = glm::transpose(view.clip_from_world);
        volume.frustum.planes[4] = rows[2] / std::max(glm::length(Vec3(rows[2])), 1e-20f);
    }
    return volume;
}

void hash_casters(
    const World& world, float alpha, const MeshPool& meshes, const MaterialPool& materials,
    const DeformedList& shapes, std::span<const CasterVolume> volumes,
    std::span<std::uint64_t> signatures) {
    const auto query = world.query<
        const MeshInstance, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const Inflate>, Optional<const Deformed>, Without<NoShadow>>();
    const std::size_t count = volumes.size();
    std::vector<std::uint64_t> sums(query.chunk_count() * count);

    query.par_chunks([&](ChunkView chunk, std::span<const MeshInstance> surfaces,
                         std::span<const WorldTransform> now,
                         std::span<const PreviousWorldTransform> before,
                         std::span<const Inflate> inflate, std::span<const Deformed> deformed) {
        BoxBlock boxes;
        std::uint8_t mirrored[kCullBlock];
        std::uint8_t visible[kCullBlock];
        std::uint64_t hashes[kCullBlock];
        const InstanceRows rows = {surfaces,         now,   before, inflate, deformed,
                                   chunk.entities(), shapes};
        const auto rows_here = static_cast<int>(chunk.size());
        fill_boxes(rows, alpha, meshes.meshes(), boxes, mirrored);
        for (std::size_t i = 0; i < chunk.size(); ++i) {
            const Affine a = rows.at(i, alpha);
            const std::uint32_t material = materials.record_of(surfaces[i].material);
            const std::uint64_t drawn =
                static_cast<std::uint64_t>(surfaces[i].mesh.index) << 32 | material;
            const std::uint32_t own = rows.shape(i);
            const std::uint64_t what =
                own != DeformedList::kNone ? hash_combine(drawn, shapes[own].shape) : drawn;
            const float inflation = inflate.empty() ? 0.0f : inflate[i].distance;
            const bool casts = !materials.batch(materials.batch_of(material)).blend;
            hashes[i] =
                casts ? hash_bytes(&a, sizeof a, hash_bytes(&inflation, sizeof inflation, what)) | 1
                      : 0;  // never 0 for a caster
        }
        for (std::size_t v = 0; v < count; ++v) {
            cull_boxes(volumes[v].frustum, boxes, rows_here, visible);
            cull_visible_boxes(volumes[v].shading, boxes, rows_here, visible);
            cull_boxes_by_distance(volumes[v].eye, volumes[v].reach, boxes, rows_here, visible);
            std::uint64_t sum = 0;
            for (std::size_t i = 0; i < chunk.size(); ++i) {
                sum += visible[i] != 0 ? hashes[i] : 0;
            }
            sums[chunk.index() * count + v] = sum;
        }
    });

    std::fill(signatures.begin(), signatures.end(), 0);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        signatures[i % count] += sums[i];
    }
}

}  // namespace limn
