#pragma once

#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/entity.h"
#include "render/geometry/culling.h"
#include "render/geometry/fur_list.h"
#include "render/render_view.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

class Archetype;
class DeformedList;
class MaterialPool;
class MeshPool;
class World;

// What is drawn: every entity with a MeshInstance and a WorldTransform, read from the world once a
// frame. The camera, faces of probes, mirrors, shadow maps and shadow volumes all cull and draw
// these items; nothing else asks the world for meshes.
//
// Items are in blocks, one per chunk of the world and in its order. A block is kept if its chunk,
// by the change versions of its columns, has neither changed nor moved since the last frame. In a
// world at rest a frame costs one comparison per chunk.

// Particles that are meshes (ParticleMesh) are items, too, in blocks after those of the world; and
// so are outlines (ToonOutline): the same meshes, inflated and turned inside out, so that only
// their far sides are drawn; and the shells of fur (Fur): the same meshes, inflated.

/// Draw state of an item as a number, by which items are sorted and counted. From high bits to low:
/// blended, inflated, deformed, shell, fin, wide, batch (25 bits), mirrored, level of coarse
/// triangles (3 bits), index of the mesh or, if deformed, of the deformed instance (29 bits).
using DrawKey = std::uint64_t;

struct DrawState {
    bool blended = false;
    bool inflated = false;
    bool deformed = false;
    bool shell = false;  ///< of fur
    bool fin = false;    ///< of fur, instead
    bool mirrored = false;
    bool wide = false;        ///< 32-bit indices
    std::uint32_t batch = 0;  ///< of MaterialPool
    std::uint32_t level = 0;  ///< 0: the mesh; n: MeshRange::coarse[n - 1], of shadow casters
    std::uint32_t index = 0;  ///< of the mesh or, if deformed, of the deformed instance
};
inline constexpr int kLevelBit = 29;
[[nodiscard]] constexpr DrawKey make_draw_key(const DrawState& s) {
    return static_cast<DrawKey>(s.blended) << 63 | static_cast<DrawKey>(s.inflated) << 62
           | static_cast<DrawKey>(s.deformed) << 61 | static_cast<DrawKey>(s.shell) << 60
           | static_cast<DrawKey>(s.fin) << 59 | static_cast<DrawKey>(s.wide) << 58
           | static_cast<DrawKey>(s.batch) << 33 | static_cast<DrawKey>(s.mirrored) << 32
           | static_cast<DrawKey>(s.level) << kLevelBit | s.index;
}
[[nodiscard]] constexpr bool is_blended(DrawKey key) {
    return key >> 63 != 0;
}
[[nodiscard]] constexpr DrawState draw_state(DrawKey key) {
    return {
        .blended = is_blended(key),
        .inflated = (key >> 62 & 1) != 0,
        .deformed = (key >> 61 & 1) != 0,
        .shell = (key >> 60 & 1) != 0,
        .fin = (key >> 59 & 1) != 0,
        .mirrored = (key >> 32 & 1) != 0,
        .wide = (key >> 58 & 1) != 0,
        .batch = static_cast<std::uint32_t>(key >> 33) & 0x01ffffffu,
        .level = static_cast<std::uint32_t>(key >> kLevelBit) & 7u,
        .index = static_cast<std::uint32_t>(key) & ((1u << kLevelBit) - 1)};
}

/// Up to 1024 items of one archetype, or particles of one emitter. The spans are columns of the
/// world, valid until it changes.
struct RenderItemBlock {
    std::span<const Entity> entities;
    std::span<const MeshInstance> surfaces;
    std::span<const WorldTransform> now;
    std::span<const PreviousWorldTransform> previous;  ///< empty: static
    std::span<const Inflate> inflate;                  ///< empty: not inflated
    std::span<const FurShell> shells;                  ///< empty: not shells of fur
    const StepJumps* jumps = nullptr;                  ///< null: none in the last step
    bool casts_shadows = true;                         ///< no NoShadow
    bool visible = true;                               ///< not only casts shadows

    /// World-space boxes. Items that cannot be drawn (no such mesh, no triangles, a transform that
    /// is not finite) have a box outside every frustum.
    BoxBlock boxes;
    BlockBounds around;  ///< of `boxes`
    DrawKey keys[kCullBlock];
    /// Hash of everything that changes the item's shadow; 0: blended, casts no shadow. Computed by
    /// RenderItems::hash_casters().
    std::uint64_t caster_hashes[kCullBlock];

    [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(now.size()); }
    [[nodiscard]] float inflation(std::size_t i) const {
        return inflate.empty() ? 0.0f : inflate[i].distance;
    }
    [[nodiscard]] Affine world_at(std::size_t i, const StepTime& time) const {
        if (previous.empty() || (time.alpha == 1.0f && time.shown == 1.0f)) {
            return now[i].world;
        }
        return jumps == nullptr ? mix_affine(previous[i].world, now[i].world, time.alpha)
                                : limn::world_at(jumps, entities[i], now[i], &previous[i], time);
    }
    [[nodiscard]] bool is_drawable(std::size_t i) const { return boxes.half_x[i] >= 0; }
    [[nodiscard]] Bounds box(std::size_t i) const;

  private:
    friend class RenderItems;
    /// The rows that the block was built from.
    const Archetype* archetype_ = nullptr;
    std::uint32_t first_row_ = 0;
    bool hashed_ = false;
    /// Items that are not rows of the world: the spans refer to these.
    struct Copies {
        std::vector<Entity> entities;
        std::vector<MeshInstance> surfaces;
        std::vector<WorldTransform> now;
        std::vector<PreviousWorldTransform> previous;
        std::vector<Inflate> inflate;
        std::vector<FurShell> shells;
    };
    Copies copies_;
    bool inside_out_ = false;  ///< back faces are drawn instead of front faces
};

/// Reuses its memory, and keeps unchanged blocks, from frame to frame.
class RenderItems {
  public:
    /// Reads the world at `alpha`. Call after `shapes` was updated.
    void update(
        const World& world, const MeshPool& meshes, const MaterialPool& materials,
        DeformedList& shapes, float alpha);

    /// Draw only a few triangles and instances of each mesh: to compile what draws them, or to
    /// measure the others (FrameRequest::few_triangles).
    bool sampled = false;
    /// Rendering::plain_below [px].
    float plain_below = 0;

    [[nodiscard]] std::size_t block_count() const { return count_; }
    [[nodiscard]] const RenderItemBlock& block(std::size_t i) const { return *blocks_[i]; }
    /// Number of items, whether they can be drawn or not.
    [[nodiscard]] std::size_t size() const { return size_; }
    /// Blocks that the last update() rebuilt.
    [[nodiscard]] std::size_t refreshed() const { return refreshed_; }

    /// Fills caster_hashes of all blocks.
    void hash_casters();

    /// Bounds in mesh space, inflated, displaced and deformed. The mesh must exist.
    [[nodiscard]] Bounds local_bounds(const RenderItemBlock& block, std::size_t i) const;

    // Of the last update().
    [[nodiscard]] const World& world() const { return *world_; }
    [[nodiscard]] const MeshPool& meshes() const { return *meshes_; }
    [[nodiscard]] const MaterialPool& materials() const { return *materials_; }
    [[nodiscard]] DeformedList& shapes() const { return *shapes_; }
    [[nodiscard]] const FurList& furs() const { return furs_; }
    [[nodiscard]] FurList& furs() { return furs_; }
    [[nodiscard]] StepTime time() const { return {alpha_, alpha_}; }
    [[nodiscard]] StepTime previous_time(float previous_alpha) const {
        return {previous_alpha, alpha_};
    }

  private:
    /// A block of items that are not rows of the world, to be filled with up to kCullBlock of them.
    RenderItemBlock& add_block();
    /// Adds the copies of a block as its items.
    void use_copies(RenderItemBlock& block);
    void add_particles();
    void add_outlines();
    /// `box` of a mesh, inflated and displaced.
    [[nodiscard]] Bounds
    moved_bounds(const RenderItemBlock& block, std::size_t i, const Bounds& box) const;
    void add_shells();
    void add_relief_boxes();
    void refresh(RenderItemBlock& block) const;
    void hash_block(RenderItemBlock& block) const;

    std::vector<std::unique_ptr<RenderItemBlock>> blocks_;
    std::size_t count_ = 0;
    std::size_t size_ = 0;
    std::size_t refreshed_ = 0;
    const World* world_ = nullptr;
    const MeshPool* meshes_ = nullptr;
    const MaterialPool* materials_ = nullptr;
    DeformedList* shapes_ = nullptr;
    FurList furs_;
    float alpha_ = 1;
    // State of the last update, to detect changes.
    std::uint32_t epoch_ = 0;
    std::uint32_t version_ = 0;
    std::uint64_t mesh_revision_ = 0;
    std::uint64_t material_revision_ = 0;
};

}  // namespace limn
