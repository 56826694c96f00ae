#include "render/geometry/instance_list.h"

#include "ecs/base/jobs.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/material/fur_hook.h"
#include "render/material/relief_hook.h"
#include "render/shaders/fur_gpu.h"
#include "render/shaders/instance_gpu.h"
#include "render/skinning/deformed_list.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <tuple>

// Techniques: engine.batching, engine.lod-shader, engine.multi-material,
//     engine.visibility-sets, shade.batching, shade.pipeline-model

namespace limn {
namespace {

constexpr std::uint16_t kHidden = 0xffff;

/// How far coarse casters are moved back, in units of their geometric error: the error is measured
/// across the surface, this along the light, which may be at a grazing angle.
constexpr float kErrorScale = 1.5f;

constexpr int kMaxShellStep = 8;        ///< of shells of distant fur
constexpr float kShadowShells = 0.25f;  ///< as many per texel of shadow maps as per pixel

// Of a draw of a few triangles (RenderItems::sampled).
constexpr std::uint32_t kSampledIndices = 3 * 64;
constexpr std::uint32_t kSampledInstances = 64;

/// Whether `entity` is `root` or one of its descendants; false if `root` is null.
bool is_part_of(const World& world, Entity entity, Entity root) {
    if (root.is_null()) {
        return false;
    }
    while (entity != root) {
        const auto* parent = world.find<Parent>(entity);
        if (parent == nullptr) {
            return false;
        }
        entity = parent->entity;
    }
    return true;
}

/// Largest factor by which the transform lengthens an axis, squared.
float largest_scale2(const Affine& a) {
    float scale2 = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 column = {a.row[0][axis], a.row[1][axis], a.row[2][axis]};
        scale2 = std::max(scale2, glm::dot(column, column));
    }
    return scale2;
}

std::uint32_t mesh_index(const RenderItems& items, const DrawState& state) {
    return state.deformed ? items.shapes()[state.index].mesh.index : state.index;
}

const MeshRange& mesh_of(const RenderItems& items, const DrawState& state) {
    return items.meshes().meshes()[mesh_index(items, state)];
}

/// Whether a shell is needed: fur whose shells are closer than half a pixel is drawn with half,
/// a quarter ... of them.
bool is_needed(const RenderItemBlock& block, std::uint32_t i, const Vec4& depth_row, float pixels) {
    const FurShell& shell = block.shells[i];
    const float depth = glm::dot(Vec3(depth_row), block.boxes.center(i)) + depth_row.w;
    const float spacing = shell.spacing * std::sqrt(largest_scale2(block.now[i].world)) * pixels
                          / std::max(depth, 1e-6f);
    int step = 1;
    while (step < kMaxShellStep && 2 * static_cast<float>(step) * spacing < 1) {
        step *= 2;
    }
    return pixels <= 0 || shell.index % step == 0;
}

/// Depth of an item's nearest point in the view of a CasterVolume.
float nearest_depth(const CasterVolume& volume, const RenderItemBlock& block, std::uint32_t i) {
    const Vec3 row = volume.depth_row;
    return glm::dot(row, block.boxes.center(i)) + volume.depth_row.w
           - glm::dot(glm::abs(row), block.boxes.half(i));
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
    const RenderItems& items, const RenderView& view, bool velocity, gpu::RingBuffer& ring,
    InstanceList& list, bool boxes) {
    const auto& camera = view.world_from_camera.row;
    const Selection selection = {
        .frustum = make_frustum(view.clip_from_world),
        .eye = {camera[0].w, camera[1].w, camera[2].w},
        .forward = {-camera[0].z, -camera[1].z, -camera[2].z},
        .previous_alpha = view.previous_alpha,
        .depth_row = glm::row(view.clip_from_world, 3),
        .pixels_per_unit = 0.5f * static_cast<float>(view.height)
                           * glm::length(Vec3(glm::row(view.clip_from_world, 1))),
        .velocity = velocity,
        .hidden = view.hidden,
        .boxes = boxes};
    collect_from(items, selection, ring, list);
}

void InstanceCollector::collect_casters(
    const RenderItems& items, const CasterVolume& volume, gpu::RingBuffer& ring,
    InstanceList& list) {
    const Selection casters = {
        .frustum = volume.frustum,
        .shading = volume.shading,
        .eye = volume.eye,
        .range = volume.range,
        .depth_row = volume.depth_row,
        .pixels_per_unit = kShadowShells * volume.texels_per_unit,
        .casters = &volume};
    collect_from(items, casters, ring, list);
}

void InstanceCollector::collect_from(
    const RenderItems& items, const Selection& selection, gpu::RingBuffer& ring,
    InstanceList& list) {
    list = {};
    list.total = static_cast<int>(items.size());
    const std::size_t count = items.block_count();
    const std::size_t grain = 1 + count / (32 * static_cast<std::size_t>(thread_count()));
    blocks_.resize(count);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            count_block(items, items.block(b), selection, blocks_[b]);
        }
    });

    commands_.clear();
    assign_slots(items, selection.velocity, list);
    list.visible = static_cast<int>(visible_count_);
    for (const BlockWork& work : blocks_) {
        list.tested += work.tested;
    }
    list.opaque_instances = static_cast<int>(opaque_count_);
    if (selection.boxes) {
        list.boxes.resize((visible_count_ + kCullBlock - 1) / kCullBlock);
    }
    list.instances = ring.allocate(visible_count_ * sizeof(layout::InstanceRecord));
    list.previous = ring.allocate(selection.velocity ? visible_count_ * sizeof(Affine) : 0);
    blended_.resize(visible_count_ - opaque_count_);
    parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            write_block(items, items.block(b), selection, blocks_[b], list);
        }
    });

    order_blended(items, selection.velocity, list);
    list.command_values = commands_;
    list.commands = ring.push(list.command_values);
    for (const DrawCommand& command : commands_) {
        list.triangles += static_cast<std::int64_t>(command.count / 3) * command.instance_count;
    }
}

void InstanceCollector::count_block(
    const RenderItems& items, const RenderItemBlock& block, const Selection& selection,
    BlockWork& work) const {
    KeyTable table(work.keys);
    work.tested = 0;
    if (selection.casters != nullptr ? !block.casts_shadows : !block.visible) {
        return;
    }
    const BoxBlock& boxes = block.boxes;
    const auto count = static_cast<int>(block.size());
    std::uint8_t visible[kCullBlock];
    work.tested = cull_boxes_within(selection.frustum, block.around, boxes, count, visible);
    if (selection.casters != nullptr) {
        cull_visible_boxes(selection.shading, boxes, count, visible);
        cull_boxes_by_distance(selection.eye, selection.range, boxes, count, visible);
    }
    for (std::uint32_t i = 0; i < block.size(); ++i) {
        DrawKey key = block.keys[i];
        work.local[i] = kHidden;
        if (visible[i] == 0 || (selection.casters != nullptr && is_blended(key))
            || is_part_of(items.world(), block.entities[i], selection.hidden)) {
            continue;
        }
        if (!block.shells.empty()
            && !is_needed(block, i, selection.depth_row, selection.pixels_per_unit)) {
            continue;
        }
        if (selection.casters == nullptr && items.plain_below > 0) {
            key = sized_key(items, block, i, selection);
        }
        if (selection.casters != nullptr && selection.casters->detail > 0) {
            key |= static_cast<DrawKey>(level_of(items, block, i, *selection.casters)) << kLevelBit;
        }
        // Distance to the far side of the box, so that large surroundings (floor, walls) come last.
        const float far_side = glm::dot(selection.forward, boxes.center(i) - selection.eye)
                               + glm::dot(glm::abs(selection.forward), boxes.half(i));
        work.local[i] = table.count(key, far_side);
    }
}

DrawKey InstanceCollector::sized_key(
    const RenderItems& items, const RenderItemBlock& block, std::uint32_t i,
    const Selection& selection) {
    const MaterialPool& materials = items.materials();
    const std::uint32_t record = materials.record_of(block.surfaces[i].material);
    const std::uint32_t plain = materials.plain_record_of(record);
    const float depth =
        glm::dot(Vec3(selection.depth_row), block.boxes.center(i)) + selection.depth_row.w;
    const float pixels = 2 * glm::length(block.boxes.half(i)) * selection.pixels_per_unit;
    if (plain == record || !(pixels < items.plain_below * depth)) {
        return block.keys[i];
    }
    DrawState state = draw_state(block.keys[i]);
    state.batch = materials.batch_of(plain);
    return make_draw_key(state);
}

std::uint32_t InstanceCollector::level_of(
    const RenderItems& items, const RenderItemBlock& block, std::uint32_t i,
    const CasterVolume& volume) {
    const DrawState state = draw_state(block.keys[i]);
    const std::vector<CoarseRange>& coarse = mesh_of(items, state).coarse;
    const SurfaceFeatures& features = items.materials().batch(state.batch).features;
    // Coarse levels are made of the rest mesh: they lack triangles where skin folds.
    const bool folded = state.deformed && items.shapes()[state.index].displacement > 0;
    if (coarse.empty() || state.inflated || features.has(kAlphaMask) || is_tessellated(features)
        || folded) {
        return 0;
    }
    const float scale2 = largest_scale2(block.now[i].world);
    const float allowed = volume.detail * nearest_depth(volume, block, i)
                          / (volume.texels_per_unit * std::sqrt(scale2));
    std::uint32_t level = 0;
    while (level < coarse.size() && coarse[level].error <= allowed) {
        ++level;
    }
    return level;
}

void InstanceCollector::push_back_caster(
    const RenderItems& items, const RenderItemBlock& block, std::uint32_t i, DrawKey key,
    const CasterVolume& volume, Affine& world) {
    const DrawState state = draw_state(key);
    if (state.level == 0) {
        return;
    }
    const float offset = kErrorScale * mesh_of(items, state).coarse[state.level - 1].error
                         * std::sqrt(largest_scale2(world));
    if (volume.away != Vec3(0)) {
        for (int axis = 0; axis < 3; ++axis) {
            world.row[axis].w += offset * volume.away[axis];
        }
        return;
    }
    const float factor = 1 + offset / std::max(nearest_depth(volume, block, i), 1e-6f);
    for (int axis = 0; axis < 3; ++axis) {
        world.row[axis] *= factor;
        world.row[axis].w += (1 - factor) * volume.eye[axis];
    }
}

void InstanceCollector::write_block(
    const RenderItems& items, const RenderItemBlock& block, const Selection& selection,
    BlockWork& work, InstanceList& list) {
    const MaterialPool& materials = items.materials();
    auto* instances = reinterpret_cast<layout::InstanceRecord*>(list.instances.data);
    auto* previous_transforms = reinterpret_cast<Affine*>(list.previous.data);
    if (work.keys.empty()) {
        return;
    }
    for (std::uint32_t i = 0; i < block.size(); ++i) {
        if (work.local[i] == kHidden) {
            continue;
        }
        KeyCount& kind = work.keys[work.local[i]];
        const std::uint32_t slot = kind.slot++;
        Affine a = block.world_at(i, items.time());
        if (selection.casters != nullptr) {
            push_back_caster(items, block, i, kind.key, *selection.casters, a);
        }
        std::uint32_t record = materials.record_of(block.surfaces[i].material);
        if (materials.batch_of(record) != draw_state(kind.key).batch) {
            record = materials.plain_record_of(record);
        }
        instances[slot] = {
            {a.row[0], a.row[1], a.row[2]},
            record,
            (draw_state(kind.key).mirrored ? 1u : 0u)
                | (block.shells.empty() ? 0u
                                        : std::uint32_t{block.shells[i].fur} << layout::kFurShift)
                | materials.model_of(record) << 8,
            slot,
            block.inflation(i)};
        if (selection.boxes) {
            list.boxes[slot / kCullBlock].set(
                slot % kCullBlock, block.boxes.center(i), block.boxes.half(i));
        }
        if (selection.velocity) {
            previous_transforms[slot] =
                block.world_at(i, items.previous_time(selection.previous_alpha));
        }
        if (is_blended(kind.key)) {
            const Vec3 box_center = transform_point(a, center(items.local_bounds(block, i)));
            blended_[slot - opaque_count_] = {
                glm::dot(selection.forward, box_center), slot, kind.key};
        }
    }
}

/// Sorts groups into draw order: front to back, so that early depth testing rejects hidden
/// fragments, but with equal programs and textures together; blended groups last.
void InstanceCollector::group_keys() {
    entries_.clear();
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
        for (std::uint32_t k = 0; k < blocks_[b].keys.size(); ++k) {
            entries_.push_back({blocks_[b].keys[k].key, b, k});
        }
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return a.key != b.key ? a.key < b.key : a.block < b.block;
    });
    groups_.clear();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        if (groups_.empty() || groups_.back().key != entry.key) {
            groups_.push_back({.key = entry.key, .first_entry = i, .end_entry = i});
        }
        Group& group = groups_.back();
        ++group.end_entry;
        group.distance = std::min(group.distance, blocks_[entry.block].keys[entry.local].distance);
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

void InstanceCollector::assign_slots(const RenderItems& items, bool velocity, InstanceList& list) {
    group_keys();
    std::uint32_t slot = 0;
    opaque_count_ = 0;
    for (const Group& group : groups_) {
        const std::uint32_t first = slot;
        for (std::size_t i = group.first_entry; i < group.end_entry; ++i) {
            KeyCount& kind = blocks_[entries_[i].block].keys[entries_[i].local];
            kind.slot = slot;
            slot += kind.count;
        }
        if (!is_blended(group.key)) {
            add_command(group.key, first, slot - first, items, velocity, list);
            opaque_count_ = slot;
        }
    }
    visible_count_ = slot;
}

void InstanceCollector::order_blended(const RenderItems& items, bool velocity, InstanceList& list) {
    std::sort(blended_.begin(), blended_.end(), [](const Blended& a, const Blended& b) {
        return a.distance != b.distance ? a.distance > b.distance : a.instance < b.instance;
    });
    for (const Blended& one : blended_) {
        add_command(one.key, one.instance, 1, items, velocity, list);
    }
}

void InstanceCollector::add_command(
    DrawKey key, std::uint32_t first, std::uint32_t count, const RenderItems& items, bool velocity,
    InstanceList& list) {
    const DrawState state = draw_state(key);
    std::vector<DrawRun>& runs = state.blended ? list.blended : list.opaque;
    const MeshRange& mesh = mesh_of(items, state);
    const std::int32_t base_vertex =
        state.deformed ? items.shapes().request(state.index, velocity) : mesh.base_vertex;
    const SurfaceBatch& batch = items.materials().batch(state.batch);
    DrawRun run;
    run.features = batch.features;
    run.features.bits |= (mesh.colored ? kVertexColor : 0u) | (state.inflated ? kInflate : 0u)
                         | (state.deformed ? kDeformed : 0u);
    constexpr std::uint32_t kTangentSpace =
        1u << layout::kNormalSlot | 1u << layout::kReliefSlot | 1u << layout::kClearcoatNormalSlot;
    if (run.features.maps.has_any(kTangentSpace) && !mesh.tangents) {
        run.features.maps.remove_all(kTangentSpace);
        list.without_tangents.push_back(mesh_index(items, state));
    }
    add_hooks(run.features, state.deformed ? items.shapes()[state.index].hooks : HookBits{});
    if (state.shell || state.fin) {
        run.features.bits |= kAlphaMask;
        run.features.hooks.set(kFurHook, state.fin ? kFurShell | kFurFin : kFurShell);
    }
    run.textures = batch.textures;
    run.mirrored = state.mirrored;
    run.wide = state.wide;
    run.first_command = static_cast<std::uint32_t>(commands_.size());
    run.command_count = 1;
    DrawCommand command = {mesh.index_count, count, mesh.first_index, base_vertex, first};
    if (state.level > 0) {
        const CoarseRange& level = mesh.coarse[state.level - 1];
        command.count = level.index_count;
        command.first_index = level.first_index;
    }
    if (items.sampled) {
        command.count = std::min(command.count, kSampledIndices);
        command.instance_count = std::min(command.instance_count, kSampledInstances);
    }
    commands_.push_back(command);
    if (!runs.empty() && runs.back().features == run.features
        && runs.back().textures == run.textures && runs.back().mirrored == run.mirrored
        && runs.back().wide == run.wide) {
        ++runs.back().command_count;
    } else {
        runs.push_back(run);
    }
}

}  // namespace limn
