#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/buffer.h"
#include "render/gpu/debug_output.h"
#include "render/gpu/device_caps.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/gpu/vertex_array.h"

#include <array>
#include <memory>
#include <optional>

namespace limn::gpu {

class Buffer;
class ShaderLibrary;
struct ProgramDesc;

// The current OpenGL context: its capabilities, debug messages, shaders and a cache of its state.
// All state is set through here, so that a redundant change costs a comparison instead of a driver
// call. After code that calls OpenGL directly (ImGui), call invalidate_state().
//
//     Result<std::unique_ptr<Device>> device = Device::from_current_context();
//     (*device)->use(pass.draw);                       // program and fixed-function state
//     (*device)->bind_texture(4, color);
//     (*device)->draw_fullscreen();

/// OpenGL calls of a frame; reset by Device::reset_stats().
struct DeviceStats {
    int draws = 0;          ///< draw calls; a multi-draw counts once
    int dispatches = 0;     ///< compute dispatches
    int state_changes = 0;  ///< state, program and binding calls that reached OpenGL
    int state_skipped = 0;  ///< redundant ones that were dropped
};

class Device {
  public:
    /// Fails below OpenGL 4.5 or without clip control. The context must stay current on this thread
    /// while the device is used, and outlive it. Sets reversed depth (clip control 0 .. 1, clear
    /// 0). Default profile: by the device.
    [[nodiscard]] static Result<std::unique_ptr<Device>>
    from_current_context(std::optional<Profile> profile = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceCaps& caps() const { return caps_; }
    [[nodiscard]] DebugOutput& debug_output() { return debug_output_; }
    [[nodiscard]] ShaderLibrary& shaders() { return *shaders_; }

    // ---- state; redundant calls are dropped ----
    void apply(const PipelineState& state);
    void use(const Program& program);
    /// Program and state together.
    void use(const Pipeline& pipeline);
    void bind_framebuffer(const Framebuffer& framebuffer);  ///< and sets the viewport to cover it
    void bind_window(int width, int height);                ///< the window's own framebuffer
    void set_viewport(int x, int y, int width, int height);
    void set_scissor(int x, int y, int width, int height);
    void disable_scissor();
    /// Draws only pixels whose depth in the buffer lies within the bounds (EXT_depth_bounds_test);
    /// no effect where the device lacks this test.
    void set_depth_bounds(float low, float high);
    void disable_depth_bounds();
    void bind_vertex_array(const VertexArray& vertices);
    /// Without a sampler the texture's own filter and wrap are used.
    void bind_texture(unsigned unit, const Texture& texture, const Sampler* sampler = nullptr);
    /// An OpenGL texture that is not a Texture, such as a buffer texture; 0 for none.
    void bind_texture_name(unsigned unit, GLuint texture, const Sampler* sampler = nullptr);
    /// One level as an image; `layer` < 0 binds all layers.
    void
    bind_image(unsigned unit, const Texture& texture, GLenum access, int level = 0, int layer = -1);
    void bind_uniforms(unsigned binding, const Buffer& buffer);
    void bind_uniforms(unsigned binding, GLuint buffer, std::size_t offset, std::size_t size);
    void bind_storage(unsigned binding, const Buffer& buffer);
    void bind_storage(unsigned binding, GLuint buffer, std::size_t offset, std::size_t size);
    /// The buffer with the arguments of indirect draws and dispatches.
    void bind_indirect(GLuint buffer);

    // ---- work; counted, and in debug contexts checked for missing bindings ----
    void draw(GLenum mode, int first, int count, int instances = 1, unsigned base_instance = 0);
    void draw_indexed(
        GLenum mode, int count, GLenum type, std::size_t offset, int base_vertex = 0,
        int instances = 1, unsigned base_instance = 0);
    /// `count` DrawElementsIndirectCommand, tight, from byte `offset` of the bound indirect buffer.
    void draw_indexed_indirect(GLenum mode, GLenum type, std::size_t offset, int count);
    /// Triangles without attributes, from gl_VertexID 0 .. count - 1.
    void draw_ids(int count);
    /// Points without attributes, from gl_VertexID 0 .. count - 1.
    void draw_points(int count);
    /// Quads without attributes: corner gl_VertexID % 4 of quad gl_VertexID / 4, in strip order. A
    /// single draw up to kQuadsAtOnce; not instanced, which would waste lanes on so few vertices.
    void draw_quads(int count);
    static constexpr int kQuadsAtOnce = 16384;  ///< limited by 16-bit vertex indices
    /// One triangle that covers the viewport, from gl_VertexID alone.
    void draw_fullscreen();
    void dispatch(unsigned x, unsigned y = 1, unsigned z = 1);
    /// Between dispatches of one pass of the frame graph: makes storage buffer writes of earlier
    /// dispatches visible to later ones. The graph does this between passes.
    void storage_barrier();
    /// As many groups of `group` x `group` as cover `width` x `height` items.
    void dispatch_over(int width, int height, int group);

    /// In debug contexts called before each draw and dispatch, with the program in use: how the
    /// frame graph checks what passes declare. Null: nobody.
    using DrawObserver = void (*)(void* context, const Program& program);
    void observe_draws(DrawObserver observer, void* context);
    /// The OpenGL name of the texture, image or storage buffer at a binding; 0 if unknown.
    [[nodiscard]] GLuint bound_object(BindingKind kind, int binding) const;

    /// The bindings that `program` expects and that are not set: "nothing bound at texture unit 4
    /// (scene_color)", or "" if all are set.
    [[nodiscard]] std::string missing_bindings(const Program& program) const;

    /// Invalidates the state cache: call it after other code has called OpenGL.
    void invalidate_state();

    [[nodiscard]] const DeviceStats& stats() const { return stats_; }
    void reset_stats() { stats_ = {}; }

  private:
    explicit Device(const DeviceCaps& caps);
    friend void
    blit_to_window(Device& device, const Texture& texture, int width, int height, int columns);

    static constexpr std::size_t kUnits = 48;
    struct BufferBinding {
        GLuint buffer = 0;
        std::size_t offset = 0;
        std::size_t size = 0;
        bool operator==(const BufferBinding&) const = default;
    };
    struct ImageBinding {
        GLuint texture = 0;
        GLenum access = 0;
        int level = 0;
        int layer = 0;
        bool operator==(const ImageBinding&) const = default;
    };

    template <typename T>
    bool change(T& current, const T& wanted);
    void bind_buffer(
        GLenum target, std::array<BufferBinding, kUnits>& bound, unsigned binding,
        const BufferBinding& wanted);
    void invalidate_deleted_objects();
    void check_draw() const;

    DeviceCaps caps_;
    DebugOutput debug_output_;
    std::unique_ptr<ShaderLibrary> shaders_;
    VertexArray no_vertices_;
    VertexArray quads_;
    Buffer quad_indices_;
    Framebuffer blit_source_;  // of the texture that blit_to_window() showed last
    std::uint64_t blit_serial_ = 0;
    DeviceStats stats_;
    DrawObserver observer_ = nullptr;
    void* observer_context_ = nullptr;

    // The state cache; kUnknown marks what must be set again.
    static constexpr GLuint kUnknown = ~0u;
    PipelineState state_;
    bool state_known_ = false;
    const Program* program_ = nullptr;
    GLuint program_id_ = kUnknown;
    GLuint framebuffer_ = kUnknown;
    GLuint vertex_array_ = kUnknown;
    GLuint indirect_ = kUnknown;
    std::array<int, 4> viewport_ = {-1, -1, -1, -1};
    std::array<int, 4> scissor_ = {-1, -1, -1, -1};
    int scissor_on_ = -1;
    std::array<float, 2> depth_bounds_ = {-1, -1};
    int depth_bounds_on_ = -1;
    std::array<GLuint, kUnits> textures_ = {};
    std::array<GLuint, kUnits> samplers_ = {};
    std::array<ImageBinding, 8> images_ = {};
    std::array<BufferBinding, kUnits> uniforms_ = {};
    std::array<BufferBinding, kUnits> storage_ = {};
    std::uint64_t known_deletions_ = 0;
};

/// Loads the program and combines it with `state`.
[[nodiscard]] Result<Pipeline>
create_pipeline(Device& device, const ProgramDesc& desc, const PipelineState& state = {});

/// Copies level 0 of a color texture over the window's framebuffer, scaled to `width` x `height`
/// [px]; only the left `columns` of it, if >= 0.
void blit_to_window(
    Device& device, const Texture& texture, int width, int height, int columns = -1);

}  // namespace limn::gpu
