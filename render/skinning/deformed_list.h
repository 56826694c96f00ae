#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/wrinkle.h"
#include "ecs/entity.h"
#include "render/gpu/ring_buffer.h"
#include "render/material/surface_hooks.h"
#include "render/shaders/deform_gpu.h"
#include "render/skinning/deformed_vertices.h"
#include "render/skinning/rest_pool.h"

#include <compare>
#include <deque>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace limn {

class MeshPool;
class World;
struct StepTime;
struct SurfaceBindingState;

// Tracks the deformed instances of a frame, where their vertices are stored, and which must be
// recomputed. Once per frame update() visits every Deformed: its bounds and a hash of its shape are
// known before anything is culled. Passes request the vertices of the instances that they draw;
// only requested vertices are computed, once for all views, and only if the shape changed.
// Instances that cannot be deformed (the character is gone, joints are missing or not finite) are
// not in the list: they are drawn in rest pose, which is logged once.
//
//     shapes.update(world, meshes, view.alpha, view.previous_alpha);
//     collector.collect(world, view, meshes, shapes, ...);    // and shadows, probes
//     shapes.write_jobs(ring);                                // then deform_meshes(graph, ...)

/// An instance with vertices of its own.
struct DeformedInstance {
    Bounds bounds;            ///< of the shape, in mesh space; conservative
    std::uint64_t shape = 0;  ///< hash: equal for equal shapes; never 0
    MeshId mesh;
    HookBits hooks;                ///< what effects add to its surface
    bool wrinkled = false;         ///< has a WrinkleState, and draws it
    bool wrinkle_columns = false;  ///< by the methods of a WrinkleComparison
    float resting = 1;             ///< fraction of WrinkleState::resting
    float displacement = 0;        ///< fraction of the fold heights that displaces the skin
};

/// Jobs that share one dispatch: of the same kind, with their vertices within the range that a
/// storage block can bind.
struct DeformBatch {
    std::uint32_t flags = 0;  ///< layout::kDeform*
    std::uint32_t first_group = 0;
    std::uint32_t group_count = 0;
    std::uint32_t first_vertex = 0;  ///< a multiple of 64
    std::uint32_t end_vertex = 0;
};

/// This frame's work; no batches if no shape changed.
struct DeformWork {
    std::vector<DeformBatch> batches;
    gpu::RingSlice jobs;      ///< layout::DeformJob
    gpu::RingSlice groups;    ///< job index of each work group
    gpu::RingSlice palettes;  ///< texels of deform.comp
    gpu::RingSlice weights;
    gpu::RingSlice controls;
    int instances = 0;
    std::int64_t vertices = 0;
};

/// Reuses its memory, and caches the shapes, from frame to frame.
class DeformedList {
  public:
    static constexpr std::uint32_t kNone = ~0u;

    /// Deform the finest mesh of each MeshLevels, to compile what draws it.
    bool finest = false;

    /// `storage_bytes`: maximum size of a storage block.
    explicit DeformedList(std::size_t storage_bytes) : storage_bytes_(storage_bytes) {}

    /// Visits the world at time `alpha` (RenderView). Frees the vertices of removed instances.
    /// Folds move the skin that is near `eye`.
    void update(
        const World& world, const MeshPool& meshes, float alpha, float previous_alpha,
        const Vec3& eye = {0, 0, 0});
    /// Discards all shapes, when the assets are replaced.
    void forget();

    /// Index of an instance; kNone if it is not deformed.
    [[nodiscard]] std::uint32_t find(Entity entity) const {
        const std::uint32_t i = entity.index < index_of_.size() ? index_of_[entity.index] : kNone;
        return i != kNone && entries_[i].active && entries_[i].entity == entity ? i : kNone;
    }
    [[nodiscard]] const DeformedInstance& operator[](std::uint32_t index) const {
        return entries_[index];
    }

    /// Whether some instance has one of these bits of a hook.
    [[nodiscard]] bool has_hook(const SurfaceHook& hook, unsigned bits) const;

    /// Requests an instance's vertices, with `previous` also its previous positions. Returns its
    /// base vertex.
    std::int32_t request(std::uint32_t index, bool previous);
    /// Calls f(entity, instance, first vertex, number of vertices) for every requested instance.
    template <typename F>
    void each_requested(F&& f) const {
        for (const std::uint32_t i : active_) {
            if (entries_[i].requested) {
                f(entries_[i].entity, static_cast<const DeformedInstance&>(entries_[i]),
                  entries_[i].first_vertex, entries_[i].vertex_count);
            }
        }
    }
    /// Fills work() with the jobs that bring all requested shapes up to date.
    void write_jobs(gpu::RingBuffer& ring);

    [[nodiscard]] const DeformWork& work() const { return work_; }
    [[nodiscard]] DeformedVertices& vertices() { return vertices_; }
    [[nodiscard]] const DeformedVertices& vertices() const { return vertices_; }
    [[nodiscard]] const RestPool& rest() const { return rest_; }

  private:
    struct Entry : DeformedInstance {
        Entity entity;
        std::uint32_t mesh_version = 0;
        Deformed settings;
        bool by_offsets = false;  ///< has vertices in the spaces of its joints
        bool found = false;       ///< found by this update
        bool active = false;      ///< deformed in this frame
        bool requested = false;   ///< in this frame
        bool previous_requested = false;
        bool allocated = false;  ///< has vertices in DeformedVertices
        std::uint32_t first_vertex = 0;
        std::uint32_t vertex_count = 0;
        std::uint64_t drawn = 0;           ///< shape of its vertices; 0: none
        std::uint64_t drawn_previous = 0;  ///< shape of its previous positions
        std::uint64_t previous_shape = 0;  ///< shape of the previous frame
        std::uint64_t evaluated = 0;       ///< shape of the bounds and palette
        std::uint32_t resting_shape = 0;   ///< of WrinkleState
        std::uint64_t folds = 0;           ///< hash of the displacement by folds; 0: none
        float largest_fold = 0;            ///< upper bound of that displacement [m]
        std::vector<Affine> palette;       ///< mesh from rest pose, one per joint
        std::vector<float> weights;
        std::vector<Vec4> controls;  ///< packed deformers
        std::vector<Vec4> patches;   ///< of its surface
        // Valid until the world changes.
        const SkinData* skin = nullptr;
        const Pose* pose = nullptr;
        const MorphWeights* morphs = nullptr;
        const DeformerState* deformers = nullptr;
        const SurfaceBindingState* surface = nullptr;
        const RestMesh* rest = nullptr;
    };

    Entry& entry_of(Entity entity);
    /// False, with the reason in `fault`, if it is drawn in rest pose.
    bool resolve(const World& world, const Assets& assets, Entry& entry, std::string& fault);
    const RestMesh& rest_of(const World& world, const Assets& assets, const Entry& entry);
    void find_wrinkles(
        const World& world, const std::vector<WrinkleMethod>& columns, const Vec3& eye,
        Entry& entry) const;
    static void
    make_entry_palette(const Entry& entry, const StepTime& time, std::vector<Affine>& palette);
    void evaluate(Entry& entry) const;
    void release(Entry& entry);
    void report(const std::string& fault);
    [[nodiscard]] static std::uint32_t flags_of(const Entry& entry);
    void add_job(Entry& entry, std::uint32_t flags);

    std::size_t storage_bytes_;
    float alpha_ = 1;
    float previous_alpha_ = 0;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> index_of_;  ///< by Entity::index
    std::vector<std::uint32_t> active_;
    const MeshPool* meshes_ = nullptr;
    RestPool rest_;
    DeformedVertices vertices_;
    std::deque<Pose> whole_poses_;  ///< of characters whose finest mesh needs more joints
    std::set<std::string> reported_;
    // Scratch of write_jobs().
    DeformWork work_;
    struct Due {
        std::uint32_t flags = 0;
        std::uint32_t first_vertex = 0;
        std::uint32_t entry = 0;
        auto operator<=>(const Due&) const = default;
    };
    std::vector<Due> due_;
    std::vector<layout::DeformJob> jobs_;
    std::vector<std::uint32_t> groups_;
    std::vector<Vec4> palette_texels_;
    std::vector<float> weights_;
    std::vector<Vec4> controls_;
};

}  // namespace limn
