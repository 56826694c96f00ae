#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device.h"

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace limn {

// One frame as a list of passes. A pass declares which textures and buffers it reads and writes,
// and a function that draws; the graph does the rest:
//
// - a pass whose output is unused is culled; kept and imported resources count as used;
// - transient textures come from a pool and alias when their lifetimes do not overlap;
// - targets are attached, cleared and bound, memory barriers set, debug groups opened;
// - every pass is timed on the CPU and the GPU (smoothed, some frames late, without stalls).
//
// Passes run in the order they are added. Reading what no earlier pass wrote is a programming error
// and aborts.
//
//     graph.begin_frame();
//     const TextureId hdr = graph.create({.name = "hdr", .width = w, .height = h});
//     graph.add_pass("sky", {depth}, {cleared(hdr)}, [=, &pass](PassContext& context) {
//         context.device().use(pass.draw);
//         context.bind_texture(0, depth);
//         context.device().draw_fullscreen();
//     });
//     graph.keep(hdr);
//     graph.execute();
//     const gpu::Texture* image = graph.texture(hdr);
//
// Create one graph and reuse it: after the first frames it allocates nothing. A pass's captures are
// copied into the graph and destroyed after execute().

struct TextureId {
    std::uint32_t index = ~0u;
    [[nodiscard]] bool valid() const { return index != ~0u; }
    bool operator==(const TextureId&) const = default;
};
struct BufferId {
    std::uint32_t index = ~0u;
    [[nodiscard]] bool valid() const { return index != ~0u; }
    bool operator==(const BufferId&) const = default;
};

/// A texture that lives for (part of) a frame. Names are paths like "gbuffer.normal", as listed in
/// the buffer viewer.
struct TextureSpec {
    std::string_view name = {};
    GLenum format = GL_RGBA16F;
    int width = 1;
    int height = 1;
    int depth = 1;  ///< layers or slices
    int levels = 1;
    int samples = 0;
    GLenum target = GL_TEXTURE_2D;
};
struct BufferSpec {
    std::string_view name = {};
    std::size_t bytes = 0;
};

/// How a pass uses a resource; made by the functions below, or implicitly from an id.
struct Use {
    enum class How : std::uint8_t {
        Plain,      ///< read: any kind of fetch; written: a render target or a storage block
        Cleared,    ///< a target, cleared first
        Discarded,  ///< a target whose previous contents are not needed
        DepthTest,  ///< a depth attachment tested but not written; may be sampled as well
        Image,      ///< written as a shader image or a copy: not attached
    };

    Use(TextureId texture) : resource(texture.index) {}
    Use(BufferId buffer) : resource(buffer.index) {}
    Use(std::uint32_t id, How use) : resource(id), how(use) {}

    std::uint32_t resource;
    How how = How::Plain;
    int level = 0;
    int layer = -1;  ///< all
    Vec4 clear = {0, 0, 0, 0};
    int unit = -1;                          ///< of sampled(); -1: the pass binds it
    const gpu::Sampler* sampler = nullptr;  ///< of sampled(); null: the texture's own filter
};

/// A target cleared to `value` before the pass; depth uses x, stencil y. The default is the far
/// plane.
[[nodiscard]] inline Use cleared(TextureId texture, const Vec4& value = Vec4(0)) {
    Use use(texture.index, Use::How::Cleared);
    use.clear = value;
    return use;
}
/// A target of which the pass writes every pixel: its previous contents are not needed, nor the
/// passes that drew them.
[[nodiscard]] inline Use discarded(TextureId texture) {
    return {texture.index, Use::How::Discarded};
}
/// Written by image stores, a copy or glGenerateTextureMipmap.
[[nodiscard]] inline Use image(TextureId texture) {
    return {texture.index, Use::How::Image};
}
/// As a read: the depth buffer to test against without writing.
[[nodiscard]] inline Use depth_tested(TextureId texture) {
    return {texture.index, Use::How::DepthTest};
}
/// One level or layer of a target instead of all: `target_level(cleared(cube), 0, face)`.
[[nodiscard]] inline Use target_level(Use use, int level, int layer = -1) {
    use.level = level;
    use.layer = layer;
    return use;
}

/// As a read: bound to a texture unit before the pass runs; `sampler` must outlive the frame.
[[nodiscard]] inline Use sampled(Use use, unsigned unit, const gpu::Sampler* sampler = nullptr) {
    use.unit = static_cast<int>(unit);
    use.sampler = sampler;
    return use;
}

class FrameGraph;

/// Passed to a running pass: its targets are bound and cleared, the viewport covers them.
class PassContext {
  public:
    [[nodiscard]] gpu::Device& device() const { return device_; }
    [[nodiscard]] const gpu::Texture& texture(TextureId id) const;
    [[nodiscard]] const gpu::Buffer& buffer(BufferId id) const;
    /// Size of the targets [px]; (0, 0) without any.
    [[nodiscard]] IVec2 size() const { return size_; }

    void bind_texture(unsigned unit, TextureId id, const gpu::Sampler* sampler = nullptr) const;
    void
    bind_image(unsigned unit, TextureId id, GLenum access, int level = 0, int layer = -1) const;
    void bind_storage(unsigned binding, BufferId id) const;
    void bind_uniforms(unsigned binding, BufferId id) const;

  private:
    friend class FrameGraph;
    PassContext(gpu::Device& device, FrameGraph& graph) : device_(device), graph_(graph) {}

    gpu::Device& device_;
    FrameGraph& graph_;
    IVec2 size_ = {0, 0};
};

/// Cost of a pass. GPU times lag some frames behind. On a software OpenGL (llvmpipe) a driver call
/// may wait for earlier passes, which then counts as CPU time of this one.
struct PassTiming {
    std::string_view name = {};
    double cpu_ms = 0;       ///< smoothed over about 20 frames
    double gpu_ms = 0;       ///< smoothed
    double last_cpu_ms = 0;  ///< of the last frame
    double last_gpu_ms = 0;  ///< of the last frame whose times arrived
};

/// Memory that a pass reads and writes if it touches each texel and byte of its resources once
/// (engine.opt-framebuffer): less where it covers only some pixels, more where it blends, tests
/// depth, or samples a texel several times.
struct PassTraffic {
    std::string_view name = {};
    std::size_t read_bytes = 0;
    std::size_t written_bytes = 0;
};

/// A texture of the frame that is not imported.
struct TargetCost {
    std::string_view name = {};
    const char* format = "";
    int bytes_per_pixel = 0;  ///< per sample
    int width = 0;
    int height = 0;
    std::size_t bytes = 0;  ///< with all levels, layers and samples
};

class FrameGraph {
  public:
    explicit FrameGraph(gpu::Device& device);
    ~FrameGraph();
    FrameGraph(const FrameGraph&) = delete;
    FrameGraph& operator=(const FrameGraph&) = delete;

    /// Drops the last frame's passes and textures; its ids become invalid.
    void begin_frame();

    [[nodiscard]] TextureId create(const TextureSpec& spec);
    [[nodiscard]] BufferId create_buffer(const BufferSpec& spec);
    /// An external texture or buffer, which must live until execute() has returned. Passes that
    /// write it always run.
    [[nodiscard]] TextureId import(std::string_view name, const gpu::Texture& texture);
    [[nodiscard]] BufferId import(std::string_view name, const gpu::Buffer& buffer);

    /// Passes that are added until end_scope() are named "scope/pass", to distinguish views; an
    /// empty scope changes no name.
    void begin_scope(std::string_view scope);
    void end_scope();

    /// Adds a pass. Several passes may write the same texture: later ones draw over it.
    template <typename Run>
    void add_pass(
        std::string_view name, std::initializer_list<Use> reads, std::initializer_list<Use> writes,
        Run&& run) {
        add_pass(
            name, std::span(reads.begin(), reads.size()), std::span(writes.begin(), writes.size()),
            std::forward<Run>(run));
    }
    template <typename Run>
    void add_pass(
        std::string_view name, std::span<const Use> reads, std::span<const Use> writes, Run&& run);
    /// Exempts the pass added last from culling.
    void always_run();

    /// Retains the contents of the texture until the next begin_frame().
    void keep(TextureId texture);
    /// keep() for every texture of this name in all following frames (buffer viewer, AOVs), until
    /// forget_named().
    void keep_named(std::string_view name);
    void forget_named(std::string_view name);

    /// Fails on a read before any write, a texture that is both read and written in one pass, or
    /// targets of different sizes. execute() aborts on these.
    [[nodiscard]] Status validate() const;
    /// In debug contexts every draw is also checked: aborts if a program reads a texture or buffer
    /// that passes of this frame write and its pass does not declare, or one that its pass draws
    /// to.
    void execute();
    /// For tests: such hazards are listed by hazards() instead of aborting.
    void collect_hazards(bool on);
    [[nodiscard]] const std::vector<std::string>& hazards() const;  ///< of the last frame

    // ---- after add_pass ----
    /// The last texture declared under this name in this frame; not valid() if there is none.
    [[nodiscard]] TextureId find(std::string_view name) const;
    [[nodiscard]] TextureSpec spec(TextureId id) const;

    // ---- after execute ----
    /// The texture after the frame; null if its passes were culled or its memory was reused by a
    /// later texture (use keep()).
    [[nodiscard]] const gpu::Texture* texture(TextureId id) const;
    /// Names of all textures of the frame, in order of declaration.
    [[nodiscard]] std::vector<std::string_view> texture_names() const;
    [[nodiscard]] bool was_run(std::string_view pass) const;

    /// In the pass order of the last frame.
    [[nodiscard]] std::span<const PassTiming> timings() const;
    /// All passes of a frame together, smoothed.
    [[nodiscard]] double total_cpu_ms() const;
    [[nodiscard]] double total_gpu_ms() const;
    /// Waits for the GPU times of every frame so far: for `limn bench`.
    void wait_for_timings();
    /// Timestamps can be switched off to measure their cost.
    void set_gpu_timing(bool on);

    /// Of the passes that ran in the last frame, in their order.
    [[nodiscard]] std::vector<PassTraffic> traffic() const;
    /// Of the last frame, those that some pass used.
    [[nodiscard]] std::vector<TargetCost> targets() const;

    /// A table of passes, what they read and write, and their times.
    [[nodiscard]] std::string to_text() const;
    /// The same as a graph for Graphviz.
    [[nodiscard]] std::string to_dot() const;

    /// Statistics of the last frame.
    struct Stats {
        int passes_run = 0;
        int passes_culled = 0;
        int barriers = 0;                ///< glMemoryBarrier calls
        int pool_textures = 0;           ///< alive in the pool
        int framebuffers = 0;            ///< alive in the cache
        std::size_t pool_bytes = 0;      ///< of textures and buffers in the pool
        std::size_t unshared_bytes = 0;  ///< the same without aliasing
    };
    [[nodiscard]] const Stats& stats() const;

  private:
    friend class PassContext;
    struct Impl;
    using RunFunction = void (*)(void*, PassContext&);
    using DestroyFunction = void (*)(void*);

    /// Memory for a pass's captures, until the next begin_frame().
    [[nodiscard]] void* allocate_closure(std::size_t size, std::size_t alignment);
    void add_pass_erased(
        std::string_view name, std::span<const Use> reads, std::span<const Use> writes,
        void* closure, RunFunction run, DestroyFunction destroy);

    std::unique_ptr<Impl> impl_;
};

template <typename Run>
void FrameGraph::add_pass(
    std::string_view name, std::span<const Use> reads, std::span<const Use> writes, Run&& run) {
    using Closure = std::decay_t<Run>;
    void* memory = allocate_closure(sizeof(Closure), alignof(Closure));
    new (memory) Closure(std::forward<Run>(run));
    add_pass_erased(
        name, reads, writes, memory,
        [](void* closure, PassContext& context) { (*static_cast<Closure*>(closure))(context); },
        [](void* closure) { static_cast<Closure*>(closure)->~Closure(); });
}

}  // namespace limn
