#include "render/shadow/shadow_casters.h"

#include "ecs/base/jobs.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <vector>

// Techniques: shadow.map-alpha

namespace limn {

CasterVolume make_caster_volume(const ShadowView& view) {
    CasterVolume volume = {make_frustum(view.clip_from_world), view.shading, view.eye, view.range};
    const Mat4 rows = glm::transpose(view.clip_from_world);
    // s = row_s p / q changes by (row_s - s row_q) / q, and s is within -1 .. 1.
    const float slope = std::max(glm::length(Vec3(rows[0])), glm::length(Vec3(rows[1])));
    volume.depth_row = rows[3];
    if (rows[3] == Vec4(0, 0, 0, 1)) {
        volume.away = -glm::normalize(Vec3(rows[2]));
    }
    volume.texels_per_unit =
        0.5f * static_cast<float>(view.resolution) * (slope + glm::length(Vec3(rows[3])));
    volume.detail = view.detail;
    if (view.clamp_depth) {
        // Casters in front of the near plane count; beyond the far one (depth 0) they do not.
        volume.frustum.planes[4] = rows[2] / std::max(glm::length(Vec3(rows[2])), 1e-20f);
    }
    return volume;
}

void hash_casters(
    RenderItems& items, std::span<const CasterVolume> volumes,
    std::span<std::uint64_t> signatures) {
    items.hash_casters();
    const std::size_t count = volumes.size();
    const std::size_t blocks = items.block_count();
    const std::size_t grain = 1 + blocks / (32 * static_cast<std::size_t>(thread_count()));
    std::vector<std::uint64_t> sums(blocks * count);
    parallel_for(blocks, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            const RenderItemBlock& block = items.block(b);
            if (!block.casts_shadows) {
                continue;
            }
            const auto rows = static_cast<int>(block.size());
            std::uint8_t visible[kCullBlock];
            for (std::size_t v = 0; v < count; ++v) {
                cull_boxes_within(volumes[v].frustum, block.around, block.boxes, rows, visible);
                cull_visible_boxes(volumes[v].shading, block.boxes, rows, visible);
                cull_boxes_by_distance(
                    volumes[v].eye, volumes[v].range, block.boxes, rows, visible);
                for (std::uint32_t i = 0; i < block.size(); ++i) {
                    sums[b * count + v] += visible[i] != 0 ? block.caster_hashes[i] : 0;
                }
            }
        }
    });
    std::fill(signatures.begin(), signatures.end(), 0);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        signatures[i % count] += sums[i];
    }
}

}  // namespace limn
