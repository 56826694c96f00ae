#include "render/gpu/texture.h"

#include "ecs/base/text.h"
#include "render/gpu/device_caps.h"
#include "render/gpu/undefined_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace limn::gpu {
namespace {

constexpr FormatInfo
color(GLenum format, const char* name, int channels, int bytes, GLenum pixel_format, GLenum type) {
    return {format, name, channels, bytes, pixel_format, type, false, false, false};
}
constexpr FormatInfo blocks(GLenum format, const char* name, int channels) {
    return {format, name, channels, 16, GL_NONE, GL_NONE, false, false, false};
}
constexpr FormatInfo integer(
    GLenum format, const char* name, int channels, int bytes, GLenum pixel_format, GLenum type) {
    return {format, name, channels, bytes, pixel_format, type, false, false, true};
}
constexpr FormatInfo
depth(GLenum format, const char* name, int bytes, GLenum pixel_format, GLenum type, bool stencil) {
    return {format, name, 1, bytes, pixel_format, type, true, stencil, false};
}

constexpr std::array kFormats = {
    color(GL_R8, "R8", 1, 1, GL_RED, GL_UNSIGNED_BYTE),
    color(GL_RG8, "RG8", 2, 2, GL_RG, GL_UNSIGNED_BYTE),
    color(GL_RGB8, "RGB8", 3, 4, GL_RGB, GL_UNSIGNED_BYTE),
    color(GL_SRGB8, "SRGB8", 3, 4, GL_RGB, GL_UNSIGNED_BYTE),
    color(GL_RGBA8, "RGBA8", 4, 4, GL_RGBA, GL_UNSIGNED_BYTE),
    color(GL_SRGB8_ALPHA8, "SRGB8_ALPHA8", 4, 4, GL_RGBA, GL_UNSIGNED_BYTE),
    color(GL_RGBA8_SNORM, "RGBA8_SNORM", 4, 4, GL_RGBA, GL_BYTE),
    color(GL_R16, "R16", 1, 2, GL_RED, GL_UNSIGNED_SHORT),
    color(GL_RG16, "RG16", 2, 4, GL_RG, GL_UNSIGNED_SHORT),
    color(GL_RGBA16, "RGBA16", 4, 8, GL_RGBA, GL_UNSIGNED_SHORT),
    color(GL_RG16_SNORM, "RG16_SNORM", 2, 4, GL_RG, GL_SHORT),
    color(GL_R16F, "R16F", 1, 2, GL_RED, GL_HALF_FLOAT),
    color(GL_RG16F, "RG16F", 2, 4, GL_RG, GL_HALF_FLOAT),
    color(GL_RGB16F, "RGB16F", 3, 8, GL_RGB, GL_HALF_FLOAT),
    color(GL_RGBA16F, "RGBA16F", 4, 8, GL_RGBA, GL_HALF_FLOAT),
    color(GL_R32F, "R32F", 1, 4, GL_RED, GL_FLOAT),
    color(GL_RG32F, "RG32F", 2, 8, GL_RG, GL_FLOAT),
    color(GL_RGB32F, "RGB32F", 3, 12, GL_RGB, GL_FLOAT),
    color(GL_RGBA32F, "RGBA32F", 4, 16, GL_RGBA, GL_FLOAT),
    color(GL_R11F_G11F_B10F, "R11F_G11F_B10F", 3, 4, GL_RGB, GL_UNSIGNED_INT_10F_11F_11F_REV),
    color(GL_RGB10_A2, "RGB10_A2", 4, 4, GL_RGBA, GL_UNSIGNED_INT_2_10_10_10_REV),
    blocks(GL_COMPRESSED_RG_RGTC2, "BC5", 2),
    blocks(GL_COMPRESSED_RGBA_BPTC_UNORM, "BC7", 4),
    blocks(GL_COMPRESSED_SRGB_ALPHA_BPTC_UNORM, "SRGB_BC7", 4),
    integer(GL_R8UI, "R8UI", 1, 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE),
    integer(GL_RGBA8UI, "RGBA8UI", 4, 4, GL_RGBA_INTEGER, GL_UNSIGNED_BYTE),
    integer(GL_R16UI, "R16UI", 1, 2, GL_RED_INTEGER, GL_UNSIGNED_SHORT),
    integer(GL_R32UI, "R32UI", 1, 4, GL_RED_INTEGER, GL_UNSIGNED_INT),
    integer(GL_RG32UI, "RG32UI", 2, 8, GL_RG_INTEGER, GL_UNSIGNED_INT),
    integer(GL_RGBA32UI, "RGBA32UI", 4, 16, GL_RGBA_INTEGER, GL_UNSIGNED_INT),
    integer(GL_R32I, "R32I", 1, 4, GL_RED_INTEGER, GL_INT),
    integer(GL_RGBA32I, "RGBA32I", 4, 16, GL_RGBA_INTEGER, GL_INT),
    depth(GL_DEPTH_COMPONENT16, "DEPTH16", 2, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, false),
    depth(GL_DEPTH_COMPONENT24, "DEPTH24", 4, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, false),
    depth(GL_DEPTH_COMPONENT32F, "DEPTH32F", 4, GL_DEPTH_COMPONENT, GL_FLOAT, false),
    depth(GL_DEPTH24_STENCIL8, "DEPTH24_STENCIL8", 4, GL_DEPTH_STENCIL, GL_UNSIGNED_INT_24_8, true),
    depth(
        GL_DEPTH32F_STENCIL8, "DEPTH32F_STENCIL8", 8, GL_DEPTH_STENCIL,
        GL_FLOAT_32_UNSIGNED_INT_24_8_REV, true),
};
constexpr FormatInfo kUnknownFormat;

bool is_cube(GLenum target) {
    return target == GL_TEXTURE_CUBE_MAP || target == GL_TEXTURE_CUBE_MAP_ARRAY;
}

/// Targets whose storage call takes three dimensions.
bool has_depth(GLenum target) {
    return target == GL_TEXTURE_3D || target == GL_TEXTURE_2D_ARRAY
           || target == GL_TEXTURE_CUBE_MAP_ARRAY || target == GL_TEXTURE_2D_MULTISAMPLE_ARRAY;
}

GLenum resolve_target(const TextureDesc& desc) {
    if (desc.samples == 0) {
        return desc.target;
    }
    return desc.target == GL_TEXTURE_2D_ARRAY ? GL_TEXTURE_2D_MULTISAMPLE_ARRAY
                                              : GL_TEXTURE_2D_MULTISAMPLE;
}

GLuint create_texture_name(GLenum target) {
    GLuint id = 0;
    glCreateTextures(target, 1, &id);
    return id;
}

/// Bytes of one pixel on the CPU in a client format and type.
std::size_t client_pixel_bytes(GLenum format, GLenum type) {
    switch (type) {
    case GL_UNSIGNED_INT_10F_11F_11F_REV:
    case GL_UNSIGNED_INT_2_10_10_10_REV:
    case GL_UNSIGNED_INT_24_8:
        return 4;
    case GL_FLOAT_32_UNSIGNED_INT_24_8_REV:
        return 8;
    default:
        break;
    }
    std::size_t channels = 1;
    switch (format) {
    case GL_RG:
    case GL_RG_INTEGER:
        channels = 2;
        break;
    case GL_RGB:
    case GL_BGR:
    case GL_RGB_INTEGER:
        channels = 3;
        break;
    case GL_RGBA:
    case GL_BGRA:
    case GL_RGBA_INTEGER:
        channels = 4;
        break;
    default:
        break;
    }
    switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE:
        return channels;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT:
        return 2 * channels;
    default:
        return 4 * channels;
    }
}

/// What fills_undefined_memory() puts into a texture.
Vec4 undefined_value(const FormatInfo& info) {
    const bool floats = info.pixel_type == GL_HALF_FLOAT || info.pixel_type == GL_FLOAT
                        || info.pixel_type == GL_UNSIGNED_INT_10F_11F_11F_REV;
    return Vec4(info.depth ? 0.5f : floats ? std::numeric_limits<float>::quiet_NaN() : 1.0f);
}

}  // namespace

const FormatInfo& format_info(GLenum format) {
    const auto* found = std::find_if(
        kFormats.begin(), kFormats.end(), [=](const FormatInfo& f) { return f.format == format; });
    return found != kFormats.end() ? *found : kUnknownFormat;
}

int full_level_count(int width, int height, int depth) {
    int levels = 1;
    for (int size = std::max({width, height, depth}); size > 1; size /= 2) {
        ++levels;
    }
    return levels;
}

namespace {

int block_side(const FormatInfo& info) {
    return info.pixel_format == GL_NONE ? 4 : 1;
}

/// Blocks along a side [px].
std::size_t level_blocks(const FormatInfo& info, int side) {
    return static_cast<std::size_t>((side + block_side(info) - 1) / block_side(info));
}

}  // namespace

std::size_t texture_bytes(const TextureDesc& desc) {
    const bool volume = desc.target == GL_TEXTURE_3D;
    const int levels = desc.levels > 0
                           ? desc.levels
                           : full_level_count(desc.width, desc.height, volume ? desc.depth : 1);
    const auto layers =
        static_cast<std::size_t>(desc.target == GL_TEXTURE_CUBE_MAP ? 6 : desc.depth);
    const FormatInfo& info = format_info(desc.format);
    std::size_t blocks = 0;  // of one pixel, in most formats
    for (int level = 0; level < levels; ++level) {
        const std::size_t slices =
            volume ? static_cast<std::size_t>(std::max(desc.depth >> level, 1)) : layers;
        blocks += level_blocks(info, std::max(desc.width >> level, 1))
                  * level_blocks(info, std::max(desc.height >> level, 1)) * slices;
    }
    return blocks * static_cast<std::size_t>(info.bytes)
           * static_cast<std::size_t>(std::max(desc.samples, 1));
}

Status check_texture(const DeviceCaps& caps, const TextureDesc& desc) {
    if (format_info(desc.format).bytes == 0) {
        return fail(
            "texture: format {} found, expected a supported one",
            fmt::format("{:#x}", desc.format));
    }
    if (desc.width < 1 || desc.height < 1 || desc.depth < 1) {
        return fail(
            "texture: size {}x{}x{} found, expected at least 1x1x1", desc.width, desc.height,
            desc.depth);
    }
    const int limit = desc.target == GL_TEXTURE_3D ? caps.max_texture_3d_size
                      : is_cube(desc.target)       ? caps.max_cube_size
                                                   : caps.max_texture_size;
    if (desc.width > limit || desc.height > limit) {
        return fail(
            "texture: size {}x{} found, expected at most {}", desc.width, desc.height, limit);
    }
    const int depth_limit = desc.target == GL_TEXTURE_3D ? limit : caps.max_texture_layers;
    if (desc.depth > depth_limit) {
        return fail("texture: {} layers found, expected at most {}", desc.depth, depth_limit);
    }
    if (desc.samples > caps.max_samples) {
        return fail(
            "texture: {} samples found, expected at most {}", desc.samples, caps.max_samples);
    }
    return Done{};
}

Texture::Texture(std::string_view label, const TextureDesc& desc)
    : object_(create_texture_name(resolve_target(desc)), label), desc_(desc),
      target_(resolve_target(desc)) {
    LIMN_CHECK(format_info(desc.format).bytes > 0);
    LIMN_CHECK(desc.width > 0 && desc.height > 0 && desc.depth > 0);
    if (desc_.levels == 0) {
        desc_.levels = full_level_count(
            desc.width, desc.height, desc.target == GL_TEXTURE_3D ? desc.depth : 1);
    }
    if (desc.samples > 0) {
        if (has_depth(target_)) {
            glTextureStorage3DMultisample(
                id(), desc.samples, desc.format, desc.width, desc.height, desc.depth, GL_TRUE);
        } else {
            glTextureStorage2DMultisample(
                id(), desc.samples, desc.format, desc.width, desc.height, GL_TRUE);
        }
    } else if (target_ == GL_TEXTURE_1D) {
        glTextureStorage1D(id(), desc_.levels, desc.format, desc.width);
    } else if (has_depth(target_)) {
        glTextureStorage3D(id(), desc_.levels, desc.format, desc.width, desc.height, desc.depth);
    } else {
        glTextureStorage2D(id(), desc_.levels, desc.format, desc.width, desc.height);
    }
    if (desc.samples == 0) {
        set_defaults();
    }
    object_.set_bytes(texture_bytes(desc_));
    const FormatInfo& info = format_info(desc.format);
    if (desc.samples == 0 && !info.integer && block_side(info) == 1 && fills_undefined_memory()) {
        for (int level = 0; level < desc_.levels; ++level) {
            clear(undefined_value(info), level);
        }
    }
}

void Texture::set_defaults() {
    const FormatInfo& info = format_info(desc_.format);
    const bool nearest = info.integer || info.depth;
    set_filter(
        nearest            ? GL_NEAREST
        : desc_.levels > 1 ? GL_LINEAR_MIPMAP_LINEAR
                           : GL_LINEAR,
        nearest ? GL_NEAREST : GL_LINEAR);
    set_wrap(GL_CLAMP_TO_EDGE);
}

Texture Texture::view(std::string_view label, GLenum format, int layer) const {
    LIMN_CHECK(layer < layers() && desc_.samples == 0);
    LIMN_CHECK(format_info(format).bytes == format_info(desc_.format).bytes);
    Texture view;
    view.desc_ = desc_;
    view.desc_.format = format;
    if (layer >= 0) {
        view.desc_.target = GL_TEXTURE_2D;
        view.desc_.depth = 1;
    }
    view.target_ = view.desc_.target;
    GLuint name = 0;
    glGenTextures(1, &name);
    glTextureView(
        name, view.target_, id(), format, 0, static_cast<GLuint>(desc_.levels),
        static_cast<GLuint>(std::max(layer, 0)), static_cast<GLuint>(view.layers()));
    view.object_ = GlObject<ObjectKind::Texture>(name, label);
    view.set_defaults();
    return view;
}

int Texture::layers(int level) const {
    if (desc_.target == GL_TEXTURE_CUBE_MAP) {
        return 6;
    }
    return desc_.target == GL_TEXTURE_3D ? std::max(desc_.depth >> level, 1) : desc_.depth;
}

void Texture::upload(
    std::span<const std::byte> pixels, GLenum format, GLenum type, int level, int layer) {
    LIMN_CHECK(level >= 0 && level < desc_.levels && layer < layers(level));
    const int count = layer < 0 ? layers(level) : 1;
    const int w = width(level);
    const int h = height(level);
    const std::size_t needed = client_pixel_bytes(format, type) * static_cast<std::size_t>(w)
                               * static_cast<std::size_t>(h) * static_cast<std::size_t>(count);
    LIMN_CHECK(pixels.size() >= needed);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (has_depth(target_) || is_cube(target_)) {
        glTextureSubImage3D(
            id(), level, 0, 0, std::max(layer, 0), w, h, count, format, type, pixels.data());
    } else if (target_ == GL_TEXTURE_1D) {
        glTextureSubImage1D(id(), level, 0, w, format, type, pixels.data());
    } else {
        glTextureSubImage2D(id(), level, 0, 0, w, h, format, type, pixels.data());
    }
}

void Texture::upload(std::span<const std::byte> pixels, int level, int layer) {
    const FormatInfo& info = format_info(desc_.format);
    if (block_side(info) == 1) {
        upload(pixels, info.pixel_format, info.pixel_type, level, layer);
        return;
    }
    LIMN_CHECK(level >= 0 && level < desc_.levels && layer < layers(level));
    const int count = layer < 0 ? layers(level) : 1;
    const std::size_t needed = level_blocks(info, width(level)) * level_blocks(info, height(level))
                               * static_cast<std::size_t>(info.bytes * count);
    LIMN_CHECK(pixels.size() >= needed);
    if (has_depth(target_) || is_cube(target_)) {
        glCompressedTextureSubImage3D(
            id(), level, 0, 0, std::max(layer, 0), width(level), height(level), count, desc_.format,
            static_cast<GLsizei>(needed), pixels.data());
    } else {
        glCompressedTextureSubImage2D(
            id(), level, 0, 0, width(level), height(level), desc_.format,
            static_cast<GLsizei>(needed), pixels.data());
    }
}

void Texture::copy_to(const Texture& target, int layer) const {
    LIMN_CHECK(
        target.desc_.format == desc_.format && target.width() == width()
        && target.height() == height() && target.desc_.levels >= desc_.levels);
    LIMN_CHECK(layer < 0 ? target.layers() == layers() : layer < target.layers() && layers() == 1);
    for (int level = 0; level < desc_.levels; ++level) {
        glCopyImageSubData(
            id(), target_, level, 0, 0, 0, target.id(), target.target_, level, 0, 0,
            std::max(layer, 0), width(level), height(level), layers(level));
    }
}

void Texture::clear(const Vec4& value, int level) {
    const FormatInfo& info = format_info(desc_.format);
    LIMN_CHECK(!info.integer);
    if (info.stencil) {
        struct {
            float depth;
            std::uint32_t stencil;
        } const packed = {value.x, static_cast<std::uint32_t>(value.y)};
        glClearTexImage(id(), level, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV, &packed);
    } else {
        glClearTexImage(id(), level, info.depth ? GL_DEPTH_COMPONENT : GL_RGBA, GL_FLOAT, &value);
    }
}

void Texture::generate_mipmaps() {
    LIMN_CHECK(block_side(format_info(desc_.format)) == 1);
    glGenerateTextureMipmap(id());
}

void Texture::set_filter(GLenum minify, GLenum magnify) {
    glTextureParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
    glTextureParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
}

void Texture::set_wrap(GLenum wrap) {
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glTextureParameteri(id(), axis, static_cast<GLint>(wrap));
    }
}

namespace {

GLuint create_sampler_name() {
    GLuint id = 0;
    glCreateSamplers(1, &id);
    return id;
}

}  // namespace

Sampler::Sampler(std::string_view label, const SamplerDesc& desc)
    : object_(create_sampler_name(), label) {
    glSamplerParameteri(id(), GL_TEXTURE_MIN_FILTER, static_cast<GLint>(desc.minify));
    glSamplerParameteri(id(), GL_TEXTURE_MAG_FILTER, static_cast<GLint>(desc.magnify));
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
        glSamplerParameteri(id(), axis, static_cast<GLint>(desc.wrap));
    }
    if (desc.wrap_v != GL_NONE) {
        glSamplerParameteri(id(), GL_TEXTURE_WRAP_T, static_cast<GLint>(desc.wrap_v));
    }
    if (desc.lod_bias != 0) {
        glSamplerParameterf(id(), GL_TEXTURE_LOD_BIAS, desc.lod_bias);
    }
    glSamplerParameterf(id(), GL_TEXTURE_MIN_LOD, desc.lod_range.x);
    glSamplerParameterf(id(), GL_TEXTURE_MAX_LOD, desc.lod_range.y);
    if (desc.anisotropy > 1.0f && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
        float limit = 1.0f;
        glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &limit);
        glSamplerParameterf(id(), GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(desc.anisotropy, limit));
    }
    if (desc.compare != GL_NONE) {
        glSamplerParameteri(id(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glSamplerParameteri(id(), GL_TEXTURE_COMPARE_FUNC, static_cast<GLint>(desc.compare));
    }
    glSamplerParameterfv(id(), GL_TEXTURE_BORDER_COLOR, &desc.border.x);
}

}  // namespace limn::gpu
