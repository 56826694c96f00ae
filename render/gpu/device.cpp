#include "render/gpu/device.h"

#include "ecs/base/text.h"
#include "render/gpu/shader_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

// Techniques: shadow.depth-bounds

namespace limn::gpu {

Result<std::unique_ptr<Device>> Device::from_current_context(std::optional<Profile> profile) {
    const int version = epoxy_gl_version();
    if (version < 45 || !epoxy_is_desktop_gl()) {
        return fail(
            "OpenGL: version {}.{} found, expected at least 4.5 core", version / 10, version % 10);
    }
    DeviceCaps caps = read_device_caps();
    caps.profile = profile.value_or(caps.profile);
    return std::unique_ptr<Device>(new Device(caps));
}

namespace {

Buffer make_quad_indices() {
    std::vector<std::uint16_t> indices;
    indices.reserve(6 * std::size_t{Device::kQuadsAtOnce});
    for (int quad = 0; quad < Device::kQuadsAtOnce; ++quad) {
        for (const int corner : {0, 1, 2, 2, 1, 3}) {
            indices.push_back(static_cast<std::uint16_t>(4 * quad + corner));
        }
    }
    return Buffer::of("quad indices", std::span<const std::uint16_t>(indices));
}

}  // namespace

Device::Device(const DeviceCaps& caps)
    : caps_(caps), debug_output_(caps.debug), shaders_(std::make_unique<ShaderLibrary>(caps_)),
      no_vertices_("no vertices"), quads_("quads"), quad_indices_(make_quad_indices()) {
    quads_.set_indices(quad_indices_);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearDepth(0.0);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glEnable(GL_PROGRAM_POINT_SIZE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    invalidate_state();
}

Device::~Device() = default;

template <typename T>
bool Device::change(T& current, const T& wanted) {
    if (current == wanted) {
        ++stats_.state_skipped;
        return false;
    }
    current = wanted;
    ++stats_.state_changes;
    return true;
}

void Device::invalidate_state() {
    state_known_ = false;
    program_ = nullptr;
    program_id_ = kUnknown;
    framebuffer_ = kUnknown;
    vertex_array_ = kUnknown;
    indirect_ = kUnknown;
    viewport_.fill(-1);
    scissor_.fill(-1);
    scissor_on_ = -1;
    depth_bounds_.fill(-1);
    depth_bounds_on_ = -1;
    textures_.fill(kUnknown);
    samplers_.fill(kUnknown);
    images_.fill({.texture = kUnknown});
    uniforms_.fill({.buffer = kUnknown});
    storage_.fill({.buffer = kUnknown});
    known_deletions_ = deletion_count();
}

void Device::invalidate_deleted_objects() {
    // OpenGL unbinds deleted names and may reuse them for other objects. Programs and framebuffers
    // deleted while bound are handled the same way.
    if (known_deletions_ != deletion_count()) {
        const bool state_known = state_known_;
        const std::array<int, 4> viewport = viewport_;
        const std::array<int, 4> scissor = scissor_;
        const int scissor_on = scissor_on_;
        const std::array<float, 2> depth_bounds = depth_bounds_;
        const int depth_bounds_on = depth_bounds_on_;
        invalidate_state();
        state_known_ = state_known;
        viewport_ = viewport;
        scissor_ = scissor;
        scissor_on_ = scissor_on;
        depth_bounds_ = depth_bounds;
        depth_bounds_on_ = depth_bounds_on;
    }
}

namespace {

void enable(GLenum what, bool on) {
    if (on) {
        glEnable(what);
    } else {
        glDisable(what);
    }
}

void set_depth(const DepthState& depth) {
    enable(GL_DEPTH_TEST, depth.test);
    glDepthMask(static_cast<GLboolean>(depth.write));
    glDepthFunc(depth.func);
}

void set_blend(const BlendState& blend, const BlendState& second) {
    enable(GL_BLEND, blend.enabled);
    if (blend.enabled) {
        glBlendFuncSeparate(
            blend.source, blend.destination, blend.source_alpha, blend.destination_alpha);
        glBlendEquation(blend.equation);
    }
    if (second.enabled) {
        glBlendFuncSeparatei(
            1, second.source, second.destination, second.source_alpha, second.destination_alpha);
        glBlendEquationi(1, second.equation);
    }
}

void set_stencil(const StencilState& stencil) {
    enable(GL_STENCIL_TEST, stencil.test);
    glStencilMask(stencil.write_mask);
    if (stencil.test) {
        const auto set_face = [&](GLenum face, const StencilFace& s) {
            glStencilFuncSeparate(face, s.func, stencil.reference, stencil.read_mask);
            glStencilOpSeparate(face, s.stencil_fail, s.depth_fail, s.pass);
        };
        set_face(GL_FRONT, stencil.front);
        set_face(GL_BACK, stencil.back);
    }
}

}  // namespace

void Device::apply(const PipelineState& state) {
    const bool all = !state_known_;
    if (!all && state == state_) {
        ++stats_.state_skipped;
        return;
    }
    ++stats_.state_changes;
    if (all || state.depth != state_.depth) {
        set_depth(state.depth);
    }
    if (all || state.blend != state_.blend || state.second_blend != state_.second_blend) {
        set_blend(state.blend, state.second_blend);
    }
    if (all || state.stencil != state_.stencil) {
        set_stencil(state.stencil);
    }
    if (all || state.cull != state_.cull) {
        enable(GL_CULL_FACE, state.cull != GL_NONE);
        if (state.cull != GL_NONE) {
            glCullFace(state.cull);
        }
    }
    if (all || state.color_mask != state_.color_mask) {
        const auto bit = [&](int i) { return static_cast<GLboolean>((state.color_mask >> i) & 1); };
        glColorMask(bit(0), bit(1), bit(2), bit(3));
    }
    if (all || state.depth_clamp != state_.depth_clamp) {
        enable(GL_DEPTH_CLAMP, state.depth_clamp);
    }
    if (all || state.clip != state_.clip) {
        enable(GL_CLIP_DISTANCE0, state.clip);
    }
    if (all || state.wireframe != state_.wireframe) {
        glPolygonMode(GL_FRONT_AND_BACK, state.wireframe ? GL_LINE : GL_FILL);
    }
    if (all || state.alpha_to_coverage != state_.alpha_to_coverage) {
        enable(GL_SAMPLE_ALPHA_TO_COVERAGE, state.alpha_to_coverage);
    }
    if (all || state.depth_bias != state_.depth_bias
        || state.depth_bias_slope != state_.depth_bias_slope) {
        enable(GL_POLYGON_OFFSET_FILL, state.depth_bias != 0 || state.depth_bias_slope != 0);
        glPolygonOffset(state.depth_bias_slope, state.depth_bias);
    }
    state_ = state;
    state_known_ = true;
}

void Device::use(const Program& program) {
    invalidate_deleted_objects();
    program_ = &program;
    if (change(program_id_, program.id())) {
        glUseProgram(program.id());
    }
}

void Device::use(const Pipeline& pipeline) {
    LIMN_CHECK(pipeline.program != nullptr);
    use(*pipeline.program);
    apply(pipeline.state);
}

void Device::bind_framebuffer(const Framebuffer& framebuffer) {
    invalidate_deleted_objects();
    if (change(framebuffer_, framebuffer.id())) {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    }
    set_viewport(0, 0, framebuffer.width(), framebuffer.height());
}

void Device::bind_window(int width, int height) {
    if (change(framebuffer_, 0u)) {
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    set_viewport(0, 0, width, height);
}

void Device::set_viewport(int x, int y, int width, int height) {
    if (change(viewport_, {x, y, width, height})) {
        glViewport(x, y, width, height);
    }
}

void Device::set_scissor(int x, int y, int width, int height) {
    if (change(scissor_on_, 1)) {
        glEnable(GL_SCISSOR_TEST);
    }
    if (change(scissor_, {x, y, width, height})) {
        glScissor(x, y, width, height);
    }
}

void Device::disable_scissor() {
    if (change(scissor_on_, 0)) {
        glDisable(GL_SCISSOR_TEST);
    }
}

void Device::set_depth_bounds(float low, float high) {
    if (!caps_.depth_bounds) {
        return;
    }
    if (change(depth_bounds_on_, 1)) {
        glEnable(GL_DEPTH_BOUNDS_TEST_EXT);
    }
    if (change(depth_bounds_, {low, high})) {
        glDepthBoundsEXT(static_cast<double>(low), static_cast<double>(high));
    }
}

void Device::disable_depth_bounds() {
    if (caps_.depth_bounds && change(depth_bounds_on_, 0)) {
        glDisable(GL_DEPTH_BOUNDS_TEST_EXT);
    }
}

void Device::bind_vertex_array(const VertexArray& vertices) {
    invalidate_deleted_objects();
    if (change(vertex_array_, vertices.id())) {
        glBindVertexArray(vertices.id());
    }
}

void Device::bind_texture(unsigned unit, const Texture& texture, const Sampler* sampler) {
    LIMN_CHECK(unit < kUnits);
    invalidate_deleted_objects();
    if (change(textures_[unit], texture.id())) {
        glBindTextureUnit(unit, texture.id());
    }
    if (change(samplers_[unit], sampler != nullptr ? sampler->id() : 0u)) {
        glBindSampler(unit, samplers_[unit]);
    }
}

void Device::bind_texture_name(unsigned unit, GLuint texture, const Sampler* sampler) {
    LIMN_CHECK(unit < kUnits);
    invalidate_deleted_objects();
    if (change(textures_[unit], texture)) {
        glBindTextureUnit(unit, texture);
    }
    if (change(samplers_[unit], sampler != nullptr ? sampler->id() : 0u)) {
        glBindSampler(unit, samplers_[unit]);
    }
}

void Device::bind_image(
    unsigned unit, const Texture& texture, GLenum access, int level, int layer) {
    LIMN_CHECK(unit < images_.size());
    invalidate_deleted_objects();
    if (change(images_[unit], {texture.id(), access, level, layer})) {
        glBindImageTexture(
            unit, texture.id(), level, static_cast<GLboolean>(layer < 0), std::max(layer, 0),
            access, texture.desc().format);
    }
}

void Device::bind_buffer(
    GLenum target, std::array<BufferBinding, kUnits>& bound, unsigned binding,
    const BufferBinding& wanted) {
    LIMN_CHECK(binding < kUnits);
    invalidate_deleted_objects();
    if (change(bound[binding], wanted)) {
        glBindBufferRange(
            target, binding, wanted.buffer, static_cast<GLintptr>(wanted.offset),
            static_cast<GLsizeiptr>(wanted.size));
    }
}

void Device::bind_uniforms(unsigned binding, const Buffer& buffer) {
    bind_buffer(GL_UNIFORM_BUFFER, uniforms_, binding, {buffer.id(), 0, buffer.size()});
}

void Device::bind_uniforms(unsigned binding, GLuint buffer, std::size_t offset, std::size_t size) {
    bind_buffer(GL_UNIFORM_BUFFER, uniforms_, binding, {buffer, offset, size});
}

void Device::bind_storage(unsigned binding, const Buffer& buffer) {
    bind_buffer(GL_SHADER_STORAGE_BUFFER, storage_, binding, {buffer.id(), 0, buffer.size()});
}

void Device::bind_storage(unsigned binding, GLuint buffer, std::size_t offset, std::size_t size) {
    bind_buffer(GL_SHADER_STORAGE_BUFFER, storage_, binding, {buffer, offset, size});
}

void Device::bind_indirect(GLuint buffer) {
    invalidate_deleted_objects();
    if (change(indirect_, buffer)) {
        glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer);
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer);
    }
}

void Device::draw(GLenum mode, int first, int count, int instances, unsigned base_instance) {
    check_draw();
    ++stats_.draws;
    glDrawArraysInstancedBaseInstance(mode, first, count, instances, base_instance);
}

void Device::draw_indexed(
    GLenum mode, int count, GLenum type, std::size_t offset, int base_vertex, int instances,
    unsigned base_instance) {
    check_draw();
    ++stats_.draws;
    glDrawElementsInstancedBaseVertexBaseInstance(
        mode, count, type, reinterpret_cast<const void*>(offset), instances, base_vertex,
        base_instance);
}

void Device::draw_indexed_indirect(GLenum mode, GLenum type, std::size_t offset, int count) {
    if (count == 0) {
        return;
    }
    check_draw();
    ++stats_.draws;
    const GLenum drawn = program_->is_tessellated() ? static_cast<GLenum>(GL_PATCHES) : mode;
    glMultiDrawElementsIndirect(drawn, type, reinterpret_cast<const void*>(offset), count, 0);
}

void Device::draw_ids(int count) {
    bind_vertex_array(no_vertices_);
    draw(GL_TRIANGLES, 0, count);
}

void Device::draw_points(int count) {
    bind_vertex_array(no_vertices_);
    draw(GL_POINTS, 0, count);
}

void Device::draw_quads(int count) {
    bind_vertex_array(quads_);
    for (int first = 0; first < count; first += kQuadsAtOnce) {
        draw_indexed(
            GL_TRIANGLES, 6 * std::min(count - first, kQuadsAtOnce), GL_UNSIGNED_SHORT, 0,
            4 * first);
    }
}

void Device::draw_fullscreen() {
    draw_ids(3);
}

void Device::dispatch(unsigned x, unsigned y, unsigned z) {
    check_draw();
    ++stats_.dispatches;
    glDispatchCompute(x, y, z);
}

void Device::storage_barrier() {
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void Device::dispatch_over(int width, int height, int group) {
    LIMN_CHECK(group > 0);
    dispatch(
        static_cast<unsigned>((width + group - 1) / group),
        static_cast<unsigned>((height + group - 1) / group));
}

void Device::check_draw() const {
    if (caps_.debug && program_ != nullptr) {
        const std::string missing = missing_bindings(*program_);
        LIMN_CHECK_NOTE(missing.empty(), missing.c_str());
        if (observer_ != nullptr) {
            observer_(observer_context_, *program_);
        }
    }
}

void Device::observe_draws(DrawObserver observer, void* context) {
    observer_ = observer;
    observer_context_ = context;
}

GLuint Device::bound_object(BindingKind kind, int binding) const {
    const auto unit = static_cast<std::size_t>(binding);
    GLuint name = 0;
    switch (kind) {
    case BindingKind::UniformBlock:
        name = unit < uniforms_.size() ? uniforms_[unit].buffer : 0;
        break;
    case BindingKind::StorageBlock:
        name = unit < storage_.size() ? storage_[unit].buffer : 0;
        break;
    case BindingKind::Texture:
        name = unit < textures_.size() ? textures_[unit] : 0;
        break;
    case BindingKind::Image:
        name = unit < images_.size() ? images_[unit].texture : 0;
        break;
    }
    return name == kUnknown ? 0 : name;
}

std::string Device::missing_bindings(const Program& program) const {
    std::string text;
    for (const ProgramBinding& b : program.bindings()) {
        const auto unit = static_cast<std::size_t>(b.binding);
        const char* what = nullptr;
        // Unknown bindings (after invalidate_state()) count as missing; units beyond those tracked
        // count as bound.
        const auto empty = [&](GLuint bound) { return bound == 0 || bound == kUnknown; };
        switch (b.kind) {
        case BindingKind::UniformBlock:
            what = unit < uniforms_.size() && empty(uniforms_[unit].buffer) ? "uniform binding"
                                                                            : nullptr;
            break;
        case BindingKind::StorageBlock:
            what = unit < storage_.size() && empty(storage_[unit].buffer) ? "storage binding"
                                                                          : nullptr;
            break;
        case BindingKind::Texture:
            what = unit < textures_.size() && empty(textures_[unit]) ? "texture unit" : nullptr;
            break;
        case BindingKind::Image:
            what = unit < images_.size() && empty(images_[unit].texture) ? "image unit" : nullptr;
            break;
        }
        if (what != nullptr) {
            text += fmt::format(
                "{}{} {} ({})", text.empty() ? "nothing bound at " : ", ", what, unit, b.name);
        }
    }
    return text;
}

Result<Pipeline>
create_pipeline(Device& device, const ProgramDesc& desc, const PipelineState& state) {
    const Result<const Program*> program = device.shaders().load(desc);
    if (!program) {
        return program.error();
    }
    return Pipeline{*program, state};
}

void blit_to_window(Device& device, const Texture& texture, int width, int height, int columns) {
    if (device.blit_serial_ != texture.serial()) {
        const Attachment color = {&texture};
        device.blit_source_ = Framebuffer("blit source", std::span(&color, 1));
        device.blit_serial_ = texture.serial();
    }
    if (columns >= 0) {
        device.set_scissor(0, 0, columns, height);
    } else {
        device.disable_scissor();
    }
    glBlitNamedFramebuffer(
        device.blit_source_.id(), 0, 0, 0, texture.width(), texture.height(), 0, 0, width, height,
        GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

}  // namespace limn::gpu
