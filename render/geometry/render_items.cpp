#include "render/geometry/render_items.h"

#include "ecs/base/hash.h"
#include "ecs/base/jobs.h"
#include "ecs/components/fur.h"
#include "ecs/components/ink.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/relief_box.h"
#include "ecs/components/shadow.h"
#include "ecs/world.h"
#include "render/geometry/mesh_pool.h"
#include "render/material/material_pool.h"
#include "render/material/relief_hook.h"
#include "render/skinning/deformed_list.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

// Techniques: engine.projectile-instances, particle.mesh-particles, shade.fur, shade.inflate,
//     tex.toon-outline

namespace limn {
namespace {

static_assert(kChunkRows <= kCullBlock);

float determinant(const Affine& a) {
    const auto& r = a.row;
    return r[0].x * (r[1].y * r[2].z - r[1].z * r[2].y)
           - r[0].y * (r[1].x * r[2].z - r[1].z * r[2].x)
           + r[0].z * (r[1].x * r[2].y - r[1].y * r[2].x);
}

/// Whether the chunk's matrices are the same at any alpha. update_transforms lets
/// PreviousWorldTransform catch up one step after the last change of WorldTransform.
bool is_at_rest(const ChunkView& chunk) {
    return !chunk.has<PreviousWorldTransform>()
           || is_newer(chunk.version<PreviousWorldTransform>(), chunk.version<WorldTransform>());
}

template <typename T>
bool has_changed(const ChunkView& chunk, std::uint32_t since) {
    return chunk.has<T>() && chunk.changed_since<T>(since);
}

bool has_changed(const ChunkView& chunk, std::uint32_t since) {
    return has_changed<MeshInstance>(chunk, since) || has_changed<WorldTransform>(chunk, since)
           || has_changed<PreviousWorldTransform>(chunk, since)
           || has_changed<Inflate>(chunk, since);
}

}  // namespace

Bounds RenderItemBlock::box(std::size_t i) const {
    return {boxes.center(i) - boxes.half(i), boxes.center(i) + boxes.half(i)};
}

Bounds
RenderItems::moved_bounds(const RenderItemBlock& block, std::size_t i, const Bounds& box) const {
    const std::uint32_t record = materials_->record_of(block.surfaces[i].material);
    return inflated(
        box, {.distance = std::abs(block.inflation(i)) + materials_->displacement_of(record)});
}

Bounds RenderItems::local_bounds(const RenderItemBlock& block, std::size_t i) const {
    const DrawState state = draw_state(block.keys[i]);
    const Bounds& box =
        state.deformed ? (*shapes_)[state.index].bounds : meshes_->meshes()[state.index].bounds;
    return moved_bounds(block, i, box);
}

void RenderItems::update(
    const World& world, const MeshPool& meshes, const MaterialPool& materials, DeformedList& shapes,
    float alpha) {
    const auto query = world.query<
        const MeshInstance, const WorldTransform, Optional<const PreviousWorldTransform>,
        Optional<const Inflate>>();
    const bool same_sources = world_ == &world && epoch_ == world.core().epoch
                              && mesh_revision_ == meshes.revision()
                              && material_revision_ == materials.revision();
    const bool same_time = alpha == 1.0f && alpha_ == 1.0f;
    world_ = &world;
    meshes_ = &meshes;
    materials_ = &materials;
    shapes_ = &shapes;
    alpha_ = alpha;
    size_ = query.count();
    count_ = query.chunk_count();
    while (blocks_.size() < count_) {
        blocks_.push_back(std::make_unique<RenderItemBlock>());
    }

    const auto* const jumps = world.find_resource<StepJumps>();
    std::atomic<std::size_t> refreshed = 0;
    query.par_chunks([&](ChunkView chunk, std::span<const MeshInstance> surfaces,
                         std::span<const WorldTransform> now,
                         std::span<const PreviousWorldTransform> previous,
                         std::span<const Inflate> inflate) {
        RenderItemBlock& block = *blocks_[chunk.index()];
        const bool kept = same_sources && block.archetype_ == &chunk.archetype()
                          && block.first_row_ == chunk.first_row() && block.size() == chunk.size()
                          && !chunk.has<Deformed>() && (same_time || is_at_rest(chunk))
                          && !has_changed(chunk, version_);
        block.entities = chunk.entities();
        block.surfaces = surfaces;
        block.now = now;
        block.previous = previous;
        block.inflate = inflate;
        block.shells = {};
        block.jumps = jumps != nullptr && !jumps->transforms.empty() ? jumps : nullptr;
        block.casts_shadows = !chunk.has<NoShadow>();
        block.visible = true;
        block.inside_out_ = false;
        block.archetype_ = &chunk.archetype();
        block.first_row_ = chunk.first_row();
        if (!kept) {
            refresh(block);
            refreshed.fetch_add(1, std::memory_order_relaxed);
        }
    });
    refreshed_ = refreshed;
    add_particles();
    add_outlines();
    add_shells();
    add_relief_boxes();
    epoch_ = world.core().epoch;
    version_ = world.version();
    mesh_revision_ = meshes.revision();
    material_revision_ = materials.revision();
}

RenderItemBlock& RenderItems::add_block() {
    if (count_ == blocks_.size()) {
        blocks_.push_back(std::make_unique<RenderItemBlock>());
    }
    RenderItemBlock& block = *blocks_[count_++];
    block.copies_.entities.clear();
    block.copies_.surfaces.clear();
    block.copies_.now.clear();
    block.copies_.previous.clear();
    block.copies_.inflate.clear();
    block.copies_.shells.clear();
    block.inside_out_ = false;
    block.visible = true;
    return block;
}

void RenderItems::use_copies(RenderItemBlock& block) {
    const RenderItemBlock::Copies& copies = block.copies_;
    block.entities = copies.entities;
    block.surfaces = copies.surfaces;
    block.now = copies.now;
    block.previous = copies.previous;
    block.inflate = copies.inflate;
    block.shells = copies.shells;
    block.archetype_ = nullptr;
    refresh(block);
    size_ += copies.now.size();
}

void RenderItems::add_particles() {
    const auto add =
        [this](Entity entity, const ParticleMesh& mesh, const ParticleMeshState& state) {
            const std::vector<MeshParticle>& particles = state.instances;
            for (std::size_t first = 0; first < particles.size(); first += kCullBlock) {
                const std::size_t end = std::min<std::size_t>(first + kCullBlock, particles.size());
                RenderItemBlock& block = add_block();
                RenderItemBlock::Copies& copies = block.copies_;
                copies.entities.assign(end - first, entity);
                for (std::size_t i = first; i < end; ++i) {
                    copies.surfaces.push_back({particles[i].mesh, mesh.material});
                    copies.now.push_back({particles[i].now});
                    copies.previous.push_back({particles[i].before});
                }
                block.jumps = nullptr;
                block.casts_shadows = !world_->has<NoShadow>(entity);
                use_copies(block);
            }
        };
    world_->query<const ParticleMesh, const ParticleMeshState>().each(add);
}

void RenderItems::add_outlines() {
    RenderItemBlock* block = nullptr;
    const auto* const jumps = world_->find_resource<StepJumps>();
    const auto add = [&](Entity entity, const ToonOutline& outline, const MeshInstance& surface,
                         const WorldTransform& now, const PreviousWorldTransform* previous,
                         const Inflate* inflate) {
        if (block == nullptr || block->copies_.now.size() == kCullBlock) {
            if (block != nullptr) {
                use_copies(*block);
            }
            block = &add_block();
            block->inside_out_ = true;
            block->jumps = jumps != nullptr && !jumps->transforms.empty() ? jumps : nullptr;
            block->casts_shadows = false;
        }
        RenderItemBlock::Copies& copies = block->copies_;
        copies.entities.push_back(entity);
        copies.surfaces.push_back({surface.mesh, outline.material});
        copies.now.push_back(now);
        copies.previous.push_back(
            previous != nullptr ? *previous : PreviousWorldTransform{now.world});
        copies.inflate.push_back({outline.width + (inflate != nullptr ? inflate->distance : 0.0f)});
    };
    world_
        ->query<
            const ToonOutline, const MeshInstance, const WorldTransform,
            Optional<const PreviousWorldTransform>, Optional<const Inflate>>()
        .each(add);
    if (block != nullptr) {
        use_copies(*block);
    }
}

/// One block per coat, its outermost shell first: those below are hidden by it.
void RenderItems::add_shells() {
    furs_.clear();
    const auto* const jumps = world_->find_resource<StepJumps>();
    const auto add = [&](Entity entity, const Fur& fur, const MeshInstance& surface,
                         const WorldTransform& now, const PreviousWorldTransform* previous) {
        const std::optional<std::uint8_t> number =
            fur.length > 0 ? furs_.add(fur, surface.mesh, world_->resource<Assets>())
                           : std::nullopt;
        if (!number) {
            return;
        }
        RenderItemBlock& block = add_block();
        block.jumps = jumps != nullptr && !jumps->transforms.empty() ? jumps : nullptr;
        block.casts_shadows = !fur.fins && !world_->has<NoShadow>(entity);
        RenderItemBlock::Copies& copies = block.copies_;
        const bool own = fur.material.index != kNoAsset;
        const std::int32_t outermost = fur.fins ? fur.shells : fur.shells - 1;
        const std::int32_t innermost = fur.fins ? fur.shells : 1;
        for (std::int32_t i = outermost; i >= innermost; --i) {
            copies.entities.push_back(entity);
            copies.surfaces.push_back({surface.mesh, own ? fur.material : surface.material});
            copies.now.push_back(now);
            copies.previous.push_back(
                previous != nullptr ? *previous : PreviousWorldTransform{now.world});
            copies.inflate.push_back({shell_offset(fur, i)});
            copies.shells.push_back(
                {.fur = *number,
                 .index = static_cast<std::uint8_t>(fur.fins ? 0 : i),
                 .spacing = fur.length / static_cast<float>(fur.shells),
                 .lean = fur_lean(fur)});
        }
        use_copies(block);
    };
    world_
        ->query<
            const Fur, const MeshInstance, const WorldTransform,
            Optional<const PreviousWorldTransform>>()
        .each(add);
}

void RenderItems::add_relief_boxes() {
    // Parts that are drawn and cast shadows, that only cast shadows, and that are only drawn.
    struct Kind {
        bool visible;
        bool casts_shadows;
        RenderItemBlock* block = nullptr;
    };
    Kind kinds[] = {{true, true}, {false, true}, {true, false}};
    const auto* const jumps = world_->find_resource<StepJumps>();
    const auto add_part = [&](Kind& kind, Entity entity, const ReliefBoxPart& part,
                              const Affine& now, const Affine& previous) {
        const std::vector<MeshRange>& meshes = meshes_->meshes();
        if (part.mesh.index >= meshes.size() || meshes[part.mesh.index].index_count == 0) {
            return;
        }
        if (kind.block == nullptr || kind.block->copies_.now.size() == kCullBlock) {
            if (kind.block != nullptr) {
                use_copies(*kind.block);
            }
            kind.block = &add_block();
            kind.block->visible = kind.visible;
            kind.block->casts_shadows = kind.casts_shadows;
            kind.block->jumps = jumps != nullptr && !jumps->transforms.empty() ? jumps : nullptr;
        }
        RenderItemBlock::Copies& copies = kind.block->copies_;
        copies.entities.push_back(entity);
        copies.surfaces.push_back({part.mesh, part.material});
        copies.now.push_back({now});
        copies.previous.push_back({previous});
    };
    const auto add = [&](Entity entity, const ReliefBox& box, const ReliefBoxState& state,
                         const WorldTransform& now, const PreviousWorldTransform* previous) {
        const Affine unit_box = affine_from({0, 0, 0}, {1, 0, 0, 0}, box.size);
        const Affine at = now.world * unit_box;
        const Affine was = previous != nullptr ? previous->world * unit_box : at;
        const bool sliced = state.slice_count > 0;
        const bool casts = !world_->has<NoShadow>(entity);
        for (int i = 0; i < kReliefFaces; ++i) {
            const auto face = static_cast<std::size_t>(i);
            if (sliced) {
                add_part(kinds[2], entity, state.sliced[face], at, was);
            }
            if (!sliced || casts) {
                add_part(kinds[sliced ? 1 : casts ? 0 : 2], entity, state.searched[face], at, was);
            }
        }
    };
    world_
        ->query<
            const ReliefBox, const ReliefBoxState, const WorldTransform,
            Optional<const PreviousWorldTransform>>()
        .each(add);
    for (const Kind& kind : kinds) {
        if (kind.block != nullptr) {
            use_copies(*kind.block);
        }
    }
}

void RenderItems::refresh(RenderItemBlock& block) const {
    const std::vector<MeshRange>& meshes = meshes_->meshes();
    BoxBlock& boxes = block.boxes;
    block.hashed_ = false;
    const bool may_deform =
        block.inside_out_ || !block.shells.empty()
        || (block.archetype_ != nullptr && block.archetype_->has(component_id<Deformed>));
    for (std::uint32_t i = 0; i < block.size(); ++i) {
        const std::uint32_t mesh = block.surfaces[i].mesh.index;
        const std::uint32_t shape =
            may_deform ? shapes_->find(block.entities[i]) : DeformedList::kNone;
        const bool deformed = shape != DeformedList::kNone;
        Vec3 c = {0, 0, 0};
        Vec3 h = Vec3(-1e30f);
        float det = 1;
        if (mesh < meshes.size() && meshes[mesh].index_count > 0) {
            const Bounds& own = deformed ? (*shapes_)[shape].bounds : meshes[mesh].bounds;
            Bounds local = moved_bounds(block, i, own);
            if (!block.shells.empty()) {
                local = inflated(local, {block.inflation(i) * block.shells[i].lean});
            }
            const Affine a = block.world_at(i, time());
            const Vec3 box_center = transform_point(a, center(local));
            const Vec3 half = transform_half_extent(a, half_extent(local));
            det = determinant(a);
            // The sum is not finite if any term is not.
            const float sum = box_center.x + box_center.y + box_center.z + half.x + half.y + half.z
                              + std::abs(det);
            if (std::abs(sum) < INFINITY) {
                c = box_center;
                h = half;
            }
        }
        boxes.set(i, c, h);
        const std::uint32_t batch =
            materials_->batch_of(materials_->record_of(block.surfaces[i].material));
        block.keys[i] = make_draw_key(
            {.blended = materials_->batch(batch).blend,
             .inflated = !block.inflate.empty(),
             .deformed = deformed,
             .shell = !block.shells.empty() && block.shells[i].index > 0,
             .fin = !block.shells.empty() && block.shells[i].index == 0,
             .mirrored = (det < 0) != block.inside_out_,
             .wide = mesh < meshes.size() && meshes[mesh].wide,
             .batch = batch,
             .index = deformed ? shape : mesh});
    }
    block.around = bounds_around(boxes, static_cast<int>(block.size()));
}

void RenderItems::hash_casters() {
    const std::size_t grain = 1 + count_ / (32 * static_cast<std::size_t>(thread_count()));
    parallel_for(count_, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t b = begin; b < end; ++b) {
            if (!blocks_[b]->hashed_ && blocks_[b]->casts_shadows) {
                hash_block(*blocks_[b]);
                blocks_[b]->hashed_ = true;
            }
        }
    });
}

void RenderItems::hash_block(RenderItemBlock& block) const {
    const std::vector<MeshRange>& meshes = meshes_->meshes();
    for (std::uint32_t i = 0; i < block.size(); ++i) {
        const DrawState state = draw_state(block.keys[i]);
        const std::uint64_t drawn = static_cast<std::uint64_t>(block.surfaces[i].mesh.index) << 32
                                    | materials_->record_of(block.surfaces[i].material);
        const std::uint64_t shape = state.deformed         ? (*shapes_)[state.index].shape
                                    : block.is_drawable(i) ? meshes[state.index].version
                                                           : 0;
        // Which fragments of such surfaces are drawn, and where, depends on the material itself.
        const SurfaceFeatures& features = materials_->batch(state.batch).features;
        const bool by_material =
            features.has(kAlphaMask) || is_off_mesh(features) || is_tessellated(features);
        const std::uint64_t fur = block.shells.empty() ? 0 : furs_.hash(block.shells[i].fur);
        const std::uint64_t what = hash_combine(
            hash_combine(drawn, shape), (by_material ? materials_->revision() : 0) ^ fur);
        const Affine a = block.world_at(i, time());
        const float inflation = block.inflation(i);
        block.caster_hashes[i] =
            state.blended
                ? 0
                : hash_bytes(&a, sizeof a, hash_bytes(&inflation, sizeof inflation, what)) | 1;
    }
}

}  // namespace limn
