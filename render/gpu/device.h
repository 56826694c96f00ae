#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/debug_output.h"
#include "render/gpu/device_caps.h"
#include "render/gpu/framebuffer.h"
#include "render/gpu/program.h"
#include "render/gpu/texture.h"
#include "render/gpu/vertex_array.h"

#include <array>
#include <memory>

namespace limn::gpu {

class Buffer;
class ShaderLibrary;
struct ProgramDesc;

// The OpenGL context that is current, from our side: what it can do, what it complained about, its
// shaders, and the state that is set. State goes through here so that setting what is already set
// costs a comparison instead of a driver call. Code that calls OpenGL behind its back (ImGui) is
// followed by forget_state().
//
//     Result<std::unique_ptr<Device>> device = Device::from_current_context();
//     (*device)->use(pass.draw);                       // program and fixed-function state
//     (*device)->bind_texture(4, color);
//     (*device)->draw_fullscreen();

/// What a frame cost in calls; reset by Device::reset_stats().
struct DeviceStats {
    int draws = 0;          ///< draw calls; one for a whole multi-draw
    int dispatches = 0;     ///< compute
    int state_changes = 0;  ///< state, program and binding calls that reached OpenGL
    int state_skipped = 0;  ///< those that were already so
};

class Device {
  public:
    /// Fails below OpenGL 4.5 or without clip control. The context must stay current on this thread
    /// while the device is used, and outlive it. Sets reversed depth (clip control 0 .. 1, clear
    /// 0).
    [[nodiscard]] static Result<std::unique_ptr<Device>> from_current_context();
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceCaps& caps() const { return caps_; }
    [[nodiscard]] DebugOutput& debug_output() { return debug_output_; }
    [[nodiscard]] ShaderLibrary& shaders() { return *shaders_; }

    // ---- state; every call is dropped when it changes nothing ----
    void apply(const PipelineState& state);
    void use(const Program& program);
    /// Program and state together.
    void use(const Pipeline& pipeline);
    void bind_framebuffer(const Framebuffer& framebuffer);  ///< sets the viewport to all of it
    void bind_window(int width, int height);                ///< the window's own framebuffer
    void set_viewport(int x, int y, int width, int height);
    void set_scissor(int x, int y, int width, int height);
    void disable_scissor();
    /// Only pixels whose depth, as it is in the buffer, lies within are drawn; nothing where the
    /// device has no such test.
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
    /// Where indirect draws and dispatches read their arguments.
    void bind_indirect(GLuint buffer);

    // ---- work; counted, and in debug contexts checked for bindings that are missing ----
    void draw(GLenum mode, int first, int count, int instances = 1, unsigned base_instance = 0);
    void draw_indexed(
        GLenum mode, int count, GLenum type, std::size_t offset, int base_vertex = 0,
        int instances = 1, unsigned base_instance = 0);
    /// `count` DrawElementsIndirectCommand, tight, from byte `offset` of the bound indirect buffer.
    void draw_indexed_indirect(GLenum mode, GLenum type, std::size_t offset, int count);
    /// Triangles of vertex ids 0 .. count - 1 and no attributes.
    void draw_ids(int count);
    /// One triangle over the whole viewport, by its ids.
    void draw_fullscreen();
    void dispatch(unsigned x, unsigned y = 1, unsigned z = 1);
    /// Groups that cover `width` x `height` items with groups of `group` x `group`.
    void dispatch_over(int width, int height, int group);

    /// What `program` expects and nobody bound: "texture unit 4 (scene_color)", or "" if all is
    /// there.
    [[nodiscard]] std::string missing_bindings(const Program& program) const;

    /// Somebody else called OpenGL: nothing is known to be set any more.
    void forget_state();

    [[nodiscard]] const DeviceStats& stats() const { return stats_; }
    void reset_stats() { stats_ = {}; }

  private:
    explicit Device(const DeviceCaps& caps);
    friend void
    blit_to_window(Device& device, const Texture& texture, int width, int height, GLenum filter);

    static constexpr std::size_t kUnits = 32;
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
    void forget_dead_objects();
    void check_draw() const;

    DeviceCaps caps_;
    DebugOutput debug_output_;
    std::unique_ptr<ShaderLibrary> shaders_;
    VertexArray no_vertices_;
    Framebuffer blit_source_;  // of the texture that blit_to_window() showed last
    std::uint64_t blit_serial_ = 0;
    DeviceStats stats_;

    // What is set; kUnknown marks what must be set again.
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
    std::uint64_t deaths_seen_ = 0;
};

/// Loads the program and joins it with `state`.
[[nodiscard]] Result<Pipeline>
create_pipeline(Device& device, const ProgramDesc& desc, const PipelineState& state = {});

/// Copies level 0 of a color texture over the window's framebuffer, scaled to `width` x `height`
/// [px].
void blit_to_window(
    Device& device, const Texture& texture, int width, int height, GLenum filter = GL_LINEAR);

}  // namespace limn::gpu
