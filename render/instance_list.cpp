#include "render/instance_list.h"

#include "ecs/components/shadow.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "render/instance_rows.h"
#include "render/shaders/instance_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

namespace limn {
namespace {

constexpr std::uint16_t kHidden = 0xffff;
static_assert(kChunkRows <= kCullBlock);

// Sort key, from the high bits: blended, inflated, deformed, batch, mirrored, mesh or deformed
// instance.
constexpr std::uint64_t make_key(
    bool blend, bool inflated, bool deformed, std::uint32_t batch, bool mirrored,
    std::uint32_t what) {
    return static_cast<std::uint64_t>(blend) << 63 | static_cast<std::uint64_t>(inflated) << 62
           | static_cast<std::uint64_t>(deformed) << 61 | static_cast<std::uint64_t>(batch) << 33
           | static_cast<std::uint64_t>(mirrored) << 32 | what;
}
constexpr bool is_blended(std::uint64_t key) {
    return key >> 63 != 0;
}
constexpr bool is_inflated(std::uint64_t key) {
    return (key >> 62 & 1) != 0;
}
constexpr bool is_deformed(std::uint64_t key) {
    return (key >> 61 & 1) != 0;
}
constexpr std::uint32_t batch_of(std::uint64_t key) {
    return static_cast<std::uint32_t>(key >> 33) & 0x0fffffffu;
}
constexpr bool is_mirrored(std::uint64_t key) {
    return (key >> 32 & 1) != 0;
}
/// Index of the deformed instance or, for other keys, of the mesh.
constexpr std::uint32_t index_of(std::uint64_t key) {
    return static_cast<std::uint32_t>(key);
}

/// Whether `entity` is `whole` or one of its descendants; false if `whole` is null.
bool is_part_of(const World* world, Entity entity, Entity whole) {
    if (whole.is_null()) {
        return false;
    }
    while (entity != whole) {
        const auto* parent = world->find<Parent>(entity);
        if (parent == nullptr) {
            return false;
        }
        entity = parent->entity;
    }
    return true;
}

void set_box(BoxBlock& block, std::uint32_t i, const Bounds& box) {
    const Vec3 c = center(box);
    const Vec3 h = half_extent(box);
    block.center_x[i] = c.x;
    block.center_y[i] = c.y;
    block.center_z[i] = c.z;
    block.half_x[i] = h.x;
    block.half_y[i] = h.y;
    block.half_z[i] = h.z;
}

}  // namespace

/// The distinct keys of a chunk: a list with a small hash table.
class InstanceCollector::KeyTable {
  public:
    explicit KeyTable(std::vector<KeyCount>& keys) : keys_(keys) {
        keys_.clear();
        slots_.fill(kHidden);
    }
    /// Counts an instance of `key` at `distance`; returns the index of the key.
    std::uint16_t count(std::uint64_t key, float distance) {
        if (keys_.empty() || keys_[last_].key != key) {
            last_ = find(key);
        }
        ++keys_[last_].count;
        keys_[last_].distance = std::min(keys_[last_].distance, distance);
        return last_;
    }

  private:
    std::uint16_t find(std::uint64_t key) {
        std::size_t slot = (key * 0x9e3779b97f4a7c15ull) >> 53;
        while (slots_[slot] != kHidden && keys_[slots_[slot]].key != key) {
            slot = (slot + 1) & (slots_.size() - 1);
        }
        if (slots_[slot] == kHidden) {
            slots_[slot] = static_cast<std::uint16_t>(keys_.size());
            keys_.push_back({.key = key});
        }
        return slots_[slot];
    }

    std::vector<KeyCount>& keys_;
    std::array<std::uint16_t, 2048> slots_;  // twice the rows of a chunk: never full
    std::uint16_t last_ = 0;
};

void InstanceCollector::collect(
    const World& world, const RenderView& view, const MeshPool& meshes,
    const MaterialPool& materials, DeformedList& shapes, bool velocity, gpu::RingBuffer& ring,
    InstanceList& list, bool boxes) {
    const auto query = world.query<
        const MeshInstance, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const Inflate>, Optional<const Deformed>>();
    const auto& camera = view.world_from_camera.row;
    const Selection selection = {
        .frustum = make_frustum(view.clip_from_world),
        .eye = {camera[0].w, camera[1].w, camera[2].w},
        .forward = {-camera[0].z, -camera[1].z, -camera[2].z},
        .alpha = view.alpha,
        .previous_alpha = view.previous_alpha,
        .velocity = velocity,
        .world = &world,
        .hidden = view.hidden,
        .boxes = boxes};
    collect_from(query, selection, {meshes, materials, shapes}, ring, list);
}

void InstanceCollector::collect_casters(
    const World& world, const CasterVolume& volume, float alpha, const MeshPool& meshes,
    const MaterialPool& materials, DeformedList& shapes, gpu::RingBuffer& ring,
    InstanceList& list) {
    const auto query = world.query<
        const MeshInstance, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const Inflate>, Optional<const Deformed>, Without<NoShadow>>();
    const Selection casters = {
        .frustum = volume.frustum,
        .shading = volume.shading,
        .eye = volume.eye,
        .reach = volume.reach,
        .alpha = alpha,
        .casters = true};
    collect_from(query, casters, {meshes, materials, shapes}, ring, list);
}

template <typename Instances>
void InstanceCollector::collect_from(
    const Instances& query, const Selection& selection, const Sources& from, gpu::RingBuffer& ring,
    InstanceList& list) {
    const std::vector<MeshRange>& meshes = from.meshes.meshes();
    const MaterialPool& materials = from.materials;
    list = {};
    list.total = static_cast<int>(query.count());
    chunks_.resize(query.chunk_count());

    query.par_chunks([&](ChunkView chunk, std::span<const MeshInstance> surfaces,
                         std::span<const WorldTransform> now,
                         std::span<const PreviousWorldTransform> before,
                         std::span<const Inflate> inflate, std::span<const Deformed> deformed) {
        BoxBlock boxes;
        std::uint8_t mirrored[kCullBlock];
        std::uint8_t visible[kCullBlock];
        const auto count = static_cast<int>(chunk.size());
        ChunkWork& work = chunks_[chunk.index()];
        const InstanceRows rows = {surfaces,         now,        before, inflate, deformed,
                                   chunk.entities(), from.shapes};
        fill_boxes(rows, selection.alpha, meshes, boxes, mirrored);
        cull_boxes(selection.frustum, boxes, count, visible);
        if (selection.casters) {
            cull_visible_boxes(selection.shading, boxes, count, visible);
            cull_boxes_by_distance(selection.eye, selection.reach, boxes, count, visible);
        }
        KeyTable table(work.keys);
        for (std::uint32_t i = 0; i < chunk.size(); ++i) {
            work.local[i] = kHidden;
            if (visible[i] == 0
                || is_part_of(selection.world, chunk.entities()[i], selection.hidden)) {
                continue;
            }
            const std::uint32_t batch =
                materials.batch_of(materials.record_of(surfaces[i].material));
            const bool blend = materials.batch(batch).blend;
            if (selection.casters && blend) {
                continue;
            }
            // Distance to the far side of the box, so that large surroundings (floor, walls) come
            // last.
            const Vec3 c = {boxes.center_x[i], boxes.center_y[i], boxes.center_z[i]};
            const Vec3 h = {boxes.half_x[i], boxes.half_y[i], boxes.half_z[i]};
            const float far_side = glm::dot(selection.forward, c - selection.eye)
                                   + glm::dot(glm::abs(selection.forward), h);
            const std::uint32_t shape = rows.shape(i);
            const bool own = shape != DeformedList::kNone;
            const std::uint64_t key = make_key(
                blend, !inflate.empty(), own, batch, mirrored[i] != 0,
                own ? shape : surfaces[i].mesh.index);
            work.local[i] = table.count(key, far_side);
        }
    });

    commands_.clear();
    const bool velocity = selection.velocity;
    place_keys(from, velocity, list);
    list.visible = static_cast<int>(visible_count_);
    list.opaque_instances = static_cast<int>(opaque_count_);
    if (selection.boxes) {
        list.boxes.resize((visible_count_ + kCullBlock - 1) / kCullBlock);
    }
    list.instances = ring.allocate(visible_count_ * sizeof(layout::InstanceRecord));
    list.before = ring.allocate(velocity ? visible_count_ * sizeof(Affine) : 0);
    blended_.resize(visible_count_ - opaque_count_);

    auto* instances = reinterpret_cast<layout::InstanceRecord*>(list.instances.data);
    auto* previous_transforms = reinterpret_cast<Affine*>(list.before.data);
    query.par_chunks([&](ChunkView chunk, std::span<const MeshInstance> surfaces,
                         std::span<const WorldTransform> now,
                         std::span<const PreviousWorldTransform> before,
                         std::span<const Inflate> inflate, std::span<const Deformed> deformed) {
        ChunkWork& work = chunks_[chunk.index()];
        const InstanceRows rows = {surfaces,         now,        before, inflate, deformed,
                                   chunk.entities(), from.shapes};
        for (std::uint32_t i = 0; i < chunk.size(); ++i) {
            if (work.local[i] == kHidden) {
                continue;
            }
            KeyCount& kind = work.keys[work.local[i]];
            const std::uint32_t place = kind.place++;
            const Affine a = rows.at(i, selection.alpha);
            const std::uint32_t record = materials.record_of(surfaces[i].material);
            instances[place] = {
                {a.row[0], a.row[1], a.row[2]},
                record,
                (is_mirrored(kind.key) ? 1u : 0u) | materials.model_of(record) << 8,
                place,
                inflate.empty() ? 0.0f : inflate[i].distance};
            if (selection.boxes) {
                set_box(
                    list.boxes[place / kCullBlock], place % kCullBlock,
                    transform_bounds(a, rows.bounds(i, meshes)));
            }
            if (velocity) {
                previous_transforms[place] = rows.at(i, selection.previous_alpha);
            }
            if (is_blended(kind.key)) {
                const Vec3 middle = transform_point(a, center(rows.bounds(i, meshes)));
                blended_[place - opaque_count_] = {
                    glm::dot(selection.forward, middle), place, kind.key};
            }
        }
    });

    order_blended(from, velocity, list);
    list.command_values = commands_;
    list.commands = ring.push(list.command_values);
    for (const DrawCommand& command : commands_) {
        list.triangles += static_cast<std::int64_t>(command.count / 3) * command.instance_count;
    }
}

/// Sorts groups into draw order: front to back, so that early depth testing rejects hidden
/// fragments, but with equal programs and textures together; blended groups last.
void InstanceCollector::group_keys() {
    entries_.clear();
    for (std::uint32_t c = 0; c < chunks_.size(); ++c) {
        for (std::uint32_t k = 0; k < chunks_[c].keys.size(); ++k) {
            entries_.push_back({chunks_[c].keys[k].key, c, k});
        }
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.chunk < b.chunk;
    });
    groups_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        if (groups_.empty() || groups_.back().key != entry.key) {
            groups_.push_back({.key = entry.key, .first_entry = i, .end_entry = i});
        }
        Group& group = groups_.back();
        ++group.end_entry;
        group.distance = std::min(group.distance, chunks_[entry.chunk].keys[entry.local].distance);
    }
    const auto run_of = [](const Group& group) { return group.key >> 32; };
    for (std::size_t begin = 0; begin < groups_.size();) {
        std::size_t end = begin;
        float nearest = INFINITY;
        for (; end < groups_.size() && run_of(groups_[end]) == run_of(groups_[begin]); ++end) {
            nearest = std::min(nearest, groups_[end].distance);
        }
        for (; begin < end; ++begin) {
            groups_[begin].run_distance = nearest;
        }
    }
    std::sort(groups_.begin(), groups_.end(), [&](const Group& a, const Group& b) {
        return std::tuple(is_blended(a.key), a.run_distance, run_of(a), a.distance, a.key)
               < std::tuple(is_blended(b.key), b.run_distance, run_of(b), b.distance, b.key);
    });
}

void InstanceCollector::place_keys(const Sources& from, bool velocity, InstanceList& list) {
    group_keys();
    std::uint32_t place = 0;
    opaque_count_ = 0;
    for (const Group& group : groups_) {
        const std::uint32_t first = place;
        for (std::size_t i = group.first_entry; i < group.end_entry; ++i) {
            KeyCount& kind = chunks_[entries_[i].chunk].keys[entries_[i].local];
            kind.place = place;
            place += kind.count;
        }
        if (!is_blended(group.key)) {
            add_command(group.key, first, place - first, from, velocity, list);
            opaque_count_ = place;
        }
    }
    visible_count_ = place;
}

void InstanceCollector::order_blended(const Sources& from, bool velocity, InstanceList& list) {
    std::sort(blended_.begin(), blended_.end(), [](const Blended& a, const Blended& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.instance < b.instance;
    });
    for (const Blended& one : blended_) {
        add_command(one.key, one.instance, 1, from, velocity, list);
    }
}

void InstanceCollector::add_command(
    std::uint64_t key, std::uint32_t first, std::uint32_t count, const Sources& from, bool velocity,
    InstanceList& list) {
    std::vector<DrawRun>& runs = is_blended(key) ? list.blended : list.opaque;
    const bool own = is_deformed(key);
    const std::uint32_t mesh_index = own ? from.shapes[index_of(key)].mesh.index : index_of(key);
    const MeshRange& mesh = from.meshes.meshes()[mesh_index];
    const std::int32_t base_vertex =
        own ? from.shapes.request(index_of(key), velocity) : mesh.base_vertex;
    const SurfaceBatch& batch = from.materials.batch(batch_of(key));
    DrawRun run;
    run.features = batch.features | (mesh.colored ? kVertexColor : 0u)
                   | (is_inflated(key) ? kInflate : 0u) | (own ? kDeformed : 0u);
    if ((run.features & kNormalMap) != 0 && !mesh.tangents) {
        run.features &= ~static_cast<std::uint32_t>(kNormalMap);
        list.without_tangents.push_back(mesh_index);
    }
    run.textures = batch.textures;
    run.mirrored = is_mirrored(key);
    run.first_command = static_cast<std::uint32_t>(commands_.size());
    run.command_count = 1;
    commands_.push_back({mesh.index_count, count, mesh.first_index, base_vertex, first});
    if (!runs.empty() && runs.back().features == run.features
        && runs.back().textures == run.textures && runs.back().mirrored == run.mirrored) {
        ++runs.back().command_count;
    } else {
        runs.push_back(run);
    }
}

}  // namespace limn
