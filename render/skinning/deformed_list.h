#pragma once

#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"
#include "render/gpu/ring_buffer.h"
#include "render/shaders/deform_gpu.h"
#include "render/skinning/deformed_vertices.h"
#include "render/skinning/rest_pool.h"

#include <compare>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace limn {

class MeshPool;
class World;

// Which instances have a shape of their own in this frame, where it lies, and which of them must be
// reckoned anew. Once a frame every Deformed is looked at: its box and the number of its shape are
// known before anything is culled. Whoever draws one asks for its vertices; only what was asked for
// is reckoned, once for all views, and only if its shape changed. What cannot be deformed - a
// character that is gone, joints that are missing or not finite - is no part of the list: it is
// drawn as it is at rest, and the log says so once.
//
//     shapes.update(world, meshes, view.alpha, view.alpha_before);
//     collector.collect(world, view, meshes, shapes, ...);    // and shadows, probes
//     shapes.write_jobs(ring);                                // then deform_meshes(graph, ...)

/// An instance whose vertices lie apart.
struct DeformedInstance {
    Bounds bounds;            ///< of the shape, in the mesh's space; never too small
    std::uint64_t shape = 0;  ///< equal numbers, equal shapes; never 0
    MeshId mesh;
};

/// Jobs that are one dispatch: they are of one kind, and their vertices lie within what a storage
/// block can show.
struct DeformBatch {
    std::uint32_t flags = 0;  ///< layout::kDeform*
    std::uint32_t first_group = 0;
    std::uint32_t group_count = 0;
    std::uint32_t first_vertex = 0;  ///< a multiple of 64
    std::uint32_t end_vertex = 0;
};

/// This frame's work; of no batches where no shape changed.
struct DeformWork {
    std::vector<DeformBatch> batches;
    gpu::RingSlice jobs;      ///< layout::DeformJob
    gpu::RingSlice groups;    ///< a job a work group
    gpu::RingSlice palettes;  ///< texels
    gpu::RingSlice weights;
    int instances = 0;
    std::int64_t vertices = 0;
};

/// Keeps its memory, and the shapes, from frame to frame.
class DeformedList {
  public:
    static constexpr std::uint32_t kNone = ~0u;

    /// `storage_bytes`: the most that a storage block can show.
    explicit DeformedList(std::size_t storage_bytes) : storage_bytes_(storage_bytes) {}

    /// Looks at the world at the moment `alpha` (RenderView). Frees the vertices of what is gone.
    void update(const World& world, const MeshPool& meshes, float alpha, float alpha_before);
    /// Other assets: all shapes are gone.
    void forget();

    /// Index of an instance; kNone of what has no shape of its own.
    [[nodiscard]] std::uint32_t find(Entity entity) const {
        const std::uint32_t i = entity.index < index_of_.size() ? index_of_[entity.index] : kNone;
        return i != kNone && entries_[i].active && entries_[i].entity == entity ? i : kNone;
    }
    [[nodiscard]] const DeformedInstance& operator[](std::uint32_t index) const {
        return entries_[index];
    }

    /// Its vertices will be drawn, `before`: with their positions before. Returns the first of
    /// them.
    std::int32_t request(std::uint32_t index, bool before);
    /// The work that makes all requested shapes what they should be.
    void write_jobs(gpu::RingBuffer& ring);

    [[nodiscard]] const DeformWork& work() const { return work_; }
    [[nodiscard]] DeformedVertices& vertices() { return vertices_; }
    [[nodiscard]] const DeformedVertices& vertices() const { return vertices_; }
    [[nodiscard]] const RestPool& rest() const { return rest_; }

  private:
    struct Entry : DeformedInstance {
        Entity entity;
        Deformed settings;
        bool seen = false;    ///< in this update
        bool active = false;  ///< has a shape
        bool wanted = false;  ///< requested in this frame
        bool wanted_before = false;
        bool placed = false;  ///< has vertices
        std::uint32_t first_vertex = 0;
        std::uint32_t vertex_count = 0;
        std::uint64_t drawn = 0;         ///< the shape that its vertices have; 0: none
        std::uint64_t drawn_before = 0;  ///< the shape of the positions before
        std::uint64_t before = 0;        ///< the shape of the moment before
        std::uint64_t reckoned = 0;      ///< the shape that bounds and palette are of
        std::vector<Affine> palette;     ///< mesh from mesh at rest, a joint each
        std::vector<float> weights;
        // Good until the world changes.
        const SkinData* skin = nullptr;
        const Pose* pose = nullptr;
        const MorphWeights* morphs = nullptr;
        const RestMesh* rest = nullptr;
    };

    Entry& entry_of(Entity entity);
    /// False, and why, if it is drawn at rest.
    bool resolve(const World& world, const Assets& assets, Entry& entry, std::string& fault);
    void reckon(Entry& entry) const;
    void release(Entry& entry);
    void report(const std::string& fault);
    [[nodiscard]] static std::uint32_t flags_of(const Entry& entry);
    void add_job(Entry& entry, std::uint32_t flags);

    std::size_t storage_bytes_;
    float alpha_ = 1;
    float alpha_before_ = 0;
    std::vector<Entry> entries_;
    std::vector<std::uint32_t> free_;
    std::vector<std::uint32_t> index_of_;  ///< by Entity::index
    std::vector<std::uint32_t> active_;
    const MeshPool* meshes_ = nullptr;
    RestPool rest_;
    DeformedVertices vertices_;
    std::set<std::string> reported_;
    // Of write_jobs().
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
};

}  // namespace limn
