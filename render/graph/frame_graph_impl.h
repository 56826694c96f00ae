#pragma once

#include "render/gpu/gpu_timer.h"
#include "render/graph/frame_graph.h"
#include "render/graph/target_pool.h"

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace limn {

// State of a FrameGraph, shared by its source files: frame_graph.cpp declares and validates,
// frame_graph_run.cpp runs and times, frame_graph_text.cpp prints.

struct TextHash {
    using is_transparent = void;
    std::size_t operator()(std::string_view text) const {
        return std::hash<std::string_view>{}(text);
    }
};

struct FrameGraph::Impl {
    struct Resource {
        std::uint32_t name = 0;
        bool is_texture = true;
        gpu::TextureDesc desc;  // textures
        std::size_t bytes = 0;  // buffers
        const gpu::Texture* imported_texture = nullptr;
        const gpu::Buffer* imported_buffer = nullptr;
        bool kept = false;
        bool written = false;   // by a pass that has run
        bool unsynced = false;  // imported: shader writes not yet followed by a barrier
        // Lifetime, filled by plan(): first and last running pass that uses it.
        int first = -1;
        int last = -1;
        std::uint32_t slot = TargetPool::kNoOwner;

        [[nodiscard]] bool imported() const {
            return imported_texture != nullptr || imported_buffer != nullptr;
        }
    };
    struct Pass {
        std::uint32_t name = 0;
        // Ranges of `uses`: [reads, writes) are read, [writes, end) written.
        std::uint32_t reads = 0;
        std::uint32_t writes = 0;
        std::uint32_t end = 0;
        void* closure = nullptr;
        RunFunction run = nullptr;
        DestroyFunction destroy = nullptr;
        bool always = false;
        bool runs = false;
    };
    /// Timings of all passes of one name, across frames.
    struct Times {
        double cpu_ms = 0;
        double gpu_ms = 0;
        double last_cpu_ms = 0;
        double last_gpu_ms = 0;
        bool cpu_valid = false;
        bool gpu_valid = false;
        std::uint64_t frame = 0;  // of last_cpu_ms
    };
    /// Bump allocator for captures of passes: blocks never move.
    struct Arena {
        std::vector<std::unique_ptr<std::byte[]>> blocks;
        std::size_t block = 0;
        std::size_t used = 0;
    };

    explicit Impl(gpu::Device& gpu_device) : device(gpu_device) {}

    gpu::Device& device;
    TargetPool pool;
    std::deque<std::string>
        names;  // of passes and resources; stable, as timings hold views of them
    std::unordered_map<std::string, std::uint32_t, TextHash, std::equal_to<>> name_index;
    std::unordered_set<std::string, TextHash, std::equal_to<>> kept_names;

    std::string scope;        // of the passes being added, with its '/'
    std::string scoped_name;  // scratch

    std::uint32_t generation = 0;  // of the frame; part of every id
    std::vector<Resource> resources;
    std::vector<Pass> passes;
    std::vector<Use> uses;
    Arena arena;
    bool executed = false;
    const Pass* running = nullptr;

    gpu::GpuTimer timer;
    bool gpu_timing = true;
    std::uint64_t frame = 0;
    std::vector<Times> times;  // by name
    std::vector<PassTiming> timings;
    std::vector<std::uint32_t> timed_names;  // of timings
    double total_cpu_ms = 0;
    double total_gpu_ms = 0;
    bool total_cpu_valid = false;
    bool total_gpu_valid = false;
    Stats stats;
    bool collects_hazards = false;
    std::vector<std::string> hazards;
    std::vector<std::uint8_t> scratch;  // one per resource, for validate() and plan()

    // frame_graph.cpp
    [[nodiscard]] std::uint32_t intern(std::string_view name);
    [[nodiscard]] std::uint32_t add_resource(const Resource& resource);
    /// The id of a texture or buffer that was imported before; ~0 if it was not.
    [[nodiscard]] std::uint32_t find_imported(const void* object) const;
    [[nodiscard]] const Resource& resource(std::uint32_t id) const;
    [[nodiscard]] Resource& resource(std::uint32_t id);
    [[nodiscard]] std::uint32_t index_of(std::uint32_t id) const;
    [[nodiscard]] std::span<const Use> reads(const Pass& pass) const {
        return std::span(uses).subspan(pass.reads, pass.writes - pass.reads);
    }
    [[nodiscard]] std::span<const Use> writes(const Pass& pass) const {
        return std::span(uses).subspan(pass.writes, pass.end - pass.writes);
    }
    [[nodiscard]] const std::string& name_of(const Resource& r) const { return names[r.name]; }
    /// Whether it is attached to the pass's framebuffer.
    [[nodiscard]] bool is_target(const Use& use, bool written) const;
    void destroy_closures();

    // frame_graph_run.cpp
    void plan();
    void acquire(const Pass& pass, int number);
    void release(const Pass& pass, int number);
    [[nodiscard]] bool& unsynced(Resource& resource);
    void synchronize(const Pass& pass);
    void mark_unsynced(const Pass& pass);
    [[nodiscard]] IVec2 bind_targets(const Pass& pass);
    void clear_target(GLuint framebuffer, const Use& use, int color_index);
    void run_pass(Pass& pass, int number, PassContext& context);
    /// Describes an undeclared or conflicting use, by the running pass, of a texture or buffer that
    /// passes of this frame write and `program` reads; "" if there is none.
    [[nodiscard]] std::string find_hazard(const gpu::Program& program) const;
    void check_hazards(const gpu::Program& program);
    [[nodiscard]] const gpu::Texture& physical_texture(const Resource& resource) const;
    void collect_gpu_times(bool wait);
    void publish_timings();
};

}  // namespace limn
