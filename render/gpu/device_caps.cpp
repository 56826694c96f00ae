#include "render/gpu/device_caps.h"

#include "ecs/base/text.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

// Techniques: shade.profile

namespace limn::gpu {
namespace {

int get_int(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

std::string get_string(GLenum what) {
    const GLubyte* text = glGetString(what);
    return text != nullptr ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace

DeviceCaps read_device_caps() {
    DeviceCaps caps;
    caps.vendor = get_string(GL_VENDOR);
    caps.renderer = get_string(GL_RENDERER);
    caps.version = get_string(GL_VERSION);
    caps.gl_major = get_int(GL_MAJOR_VERSION);
    caps.gl_minor = get_int(GL_MINOR_VERSION);
    for (const char* name :
         {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software Rasterizer"}) {
        caps.software = caps.software || caps.renderer.find(name) != std::string::npos;
    }
    caps.profile = caps.software ? Profile::Software : Profile::Gpu;
    caps.opaque_uniforms = caps.software && caps.renderer.find("zink") != std::string::npos;
    caps.debug = (get_int(GL_CONTEXT_FLAGS) & GL_CONTEXT_FLAG_DEBUG_BIT) != 0;
    caps.max_texture_size = get_int(GL_MAX_TEXTURE_SIZE);
    caps.max_texture_3d_size = get_int(GL_MAX_3D_TEXTURE_SIZE);
    caps.max_cube_size = get_int(GL_MAX_CUBE_MAP_TEXTURE_SIZE);
    caps.max_texture_layers = get_int(GL_MAX_ARRAY_TEXTURE_LAYERS);
    caps.max_samples = get_int(GL_MAX_SAMPLES);
    caps.max_color_attachments =
        std::min(get_int(GL_MAX_COLOR_ATTACHMENTS), get_int(GL_MAX_DRAW_BUFFERS));
    caps.max_vertex_textures = get_int(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS);
    caps.max_evaluation_textures = get_int(GL_MAX_TESS_EVALUATION_TEXTURE_IMAGE_UNITS);
    caps.max_fragment_textures = get_int(GL_MAX_TEXTURE_IMAGE_UNITS);
    caps.max_compute_textures = get_int(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS);
    caps.max_combined_textures = get_int(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS);
    caps.max_image_units = get_int(GL_MAX_IMAGE_UNITS);
    caps.max_uniform_block_bytes = get_int(GL_MAX_UNIFORM_BLOCK_SIZE);
    caps.max_uniform_bindings = get_int(GL_MAX_UNIFORM_BUFFER_BINDINGS);
    caps.max_storage_bindings = get_int(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS);
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    caps.max_storage_bytes = bytes;
    caps.max_vertex_storage_blocks = get_int(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS);
    caps.max_fragment_storage_blocks = get_int(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS);
    caps.max_compute_invocations = get_int(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    caps.max_compute_shared_bytes = get_int(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    caps.uniform_alignment = std::max(get_int(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT), 16);
    caps.storage_alignment = std::max(get_int(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT), 16);
    if (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &caps.max_anisotropy);
    }
    caps.depth_bounds = epoxy_has_gl_extension("GL_EXT_depth_bounds_test");
    return caps;
}

std::vector<ProfileError>
check_requirements(const DeviceCaps& caps, const PassRequirements& needs) {
    std::vector<ProfileError> errors;
    const auto compare = [&](const char* what, int required, int available) {
        if (required <= available) {
            return;
        }
        if (available == 0) {
            errors.push_back(
                {ProfileErrorKind::Capability,
                 fmt::format("capability: {} {} required, this device has none", required, what)});
        } else {
            errors.push_back(
                {ProfileErrorKind::Capacity,
                 fmt::format(
                     "capacity: {} {} required, this device has {}", required, what, available)});
        }
    };
    compare("vertex textures", needs.vertex_textures, caps.max_vertex_textures);
    compare("tessellation textures", needs.evaluation_textures, caps.max_evaluation_textures);
    compare("fragment textures", needs.fragment_textures, caps.max_fragment_textures);
    compare("compute textures", needs.compute_textures, caps.max_compute_textures);
    compare(
        "textures in all stages",
        needs.vertex_textures + needs.evaluation_textures + needs.fragment_textures
            + needs.compute_textures,
        caps.max_combined_textures);
    compare("color attachments", needs.color_attachments, caps.max_color_attachments);
    compare("pixels of texture side", needs.texture_size, caps.max_texture_size);
    compare("texture layers", needs.texture_layers, caps.max_texture_layers);
    compare("samples", needs.samples, caps.max_samples);
    compare("image units", needs.image_units, caps.max_image_units);
    compare("bytes of uniform block", needs.uniform_block_bytes, caps.max_uniform_block_bytes);
    compare("vertex storage blocks", needs.vertex_storage_blocks, caps.max_vertex_storage_blocks);
    compare(
        "fragment storage blocks", needs.fragment_storage_blocks, caps.max_fragment_storage_blocks);
    compare("compute invocations", needs.compute_invocations, caps.max_compute_invocations);
    compare("bytes of shared memory", needs.compute_shared_bytes, caps.max_compute_shared_bytes);
    return errors;
}

Status require(const DeviceCaps& caps, const char* pass, const PassRequirements& needs) {
    const std::vector<ProfileError> errors = check_requirements(caps, needs);
    if (errors.empty()) {
        return Done{};
    }
    std::string text;
    for (const ProfileError& error : errors) {
        text += (text.empty() ? "" : "; ") + error.message;
    }
    return fail("{}: {}", pass, text);
}

int choose_version(const DeviceCaps& caps, std::span<const PassRequirements> versions) {
    for (std::size_t i = 0; i < versions.size(); ++i) {
        if (check_requirements(caps, versions[i]).empty()) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

}  // namespace limn::gpu
