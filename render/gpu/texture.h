#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/gl_object.h"

#include <algorithm>
#include <span>

namespace limn::gpu {

struct DeviceCaps;

/// Properties of an image format. Transfers to and from the CPU use `pixel_format` and
/// `pixel_type`. Formats in blocks of 4 x 4 pixels (BC5, BC7) have neither: they are uploaded as
/// they are, cannot be drawn to and make no mip levels. OpenGL 4.5 always has them.
struct FormatInfo {
    GLenum format = GL_NONE;        ///< sized, e.g. GL_RGBA16F
    const char* name = "unknown";   ///< "RGBA16F"
    int channels = 0;               ///< 1 .. 4; depth and depth-stencil count 1
    int bytes = 0;                  ///< per pixel or block on the GPU; 0 for unsupported formats
    GLenum pixel_format = GL_NONE;  ///< e.g. GL_RGBA, GL_RED_INTEGER; GL_NONE: in blocks
    GLenum pixel_type = GL_NONE;    ///< e.g. GL_HALF_FLOAT
    bool depth = false;
    bool stencil = false;
    bool integer = false;
};

/// Properties of a sized format; `bytes` is 0 if Limn does not support it.
[[nodiscard]] const FormatInfo& format_info(GLenum format);

struct TextureDesc {
    GLenum format = GL_RGBA8;  ///< sized internal format
    int width = 1;             ///< [px], > 0
    int height = 1;            ///< [px], > 0
    int depth = 1;             ///< slices of a 3D texture, layers of an array; 6 n for cube arrays
    int levels = 1;            ///< mip levels; 0 = full chain down to 1x1
    int samples = 0;           ///< 0 = not multisampled
    GLenum target = GL_TEXTURE_2D;  ///< 1D, 2D, 2D_ARRAY, 3D, CUBE_MAP, CUBE_MAP_ARRAY, RECTANGLE
                                    ///< (of one level, read in texels); multisampled by `samples`

    bool operator==(const TextureDesc&) const = default;
};

/// Mip levels of a full chain down to 1x1x1.
[[nodiscard]] int full_level_count(int width, int height, int depth = 1);

/// Bytes of all levels and layers, without padding.
[[nodiscard]] std::size_t texture_bytes(const TextureDesc& desc);

/// Fails with one line that names the limit which `desc` exceeds: for sizes that come from files.
[[nodiscard]] Status check_texture(const DeviceCaps& caps, const TextureDesc& desc);

class Texture {
  public:
    Texture() = default;
    /// Immutable storage, contents undefined. A level count of 0 becomes the full one.
    Texture(std::string_view label, const TextureDesc& desc);

    /// The same texels as `format`, which must be of the same size per texel: all layers, or one as
    /// a 2D texture. Shares the storage, which lives as long as either.
    [[nodiscard]] Texture view(std::string_view label, GLenum format, int layer = -1) const;

    /// Replaces one level (all layers, or only `layer` if >= 0; a face of a cube is a layer). Rows
    /// are tightly packed, bottom row first; `pixels` must hold the whole region in `format` and
    /// `type`.
    void upload(
        std::span<const std::byte> pixels, GLenum format, GLenum type, int level = 0,
        int layer = -1);
    /// The same in the format's own pixel_format and pixel_type, or in its blocks.
    void upload(std::span<const std::byte> pixels, int level = 0, int layer = -1);
    template <typename T>
    void
    upload(std::span<const T> pixels, GLenum format, GLenum type, int level = 0, int layer = -1) {
        upload(std::as_bytes(pixels), format, type, level, layer);
    }

    /// Copies all levels into a texture of the same size, format and layers, which may have more
    /// levels; a 2D texture may become one `layer` of an array.
    void copy_to(const Texture& target, int layer = -1) const;

    /// Sets every texel of a level, converted as a shader would write it; not for integer formats.
    void clear(const Vec4& value, int level = 0);

    /// Fills levels 1 .. n from level 0.
    void generate_mipmaps();

    /// Filtering where no Sampler is bound. New textures filter linearly (nearest for integer and
    /// depth formats), trilinearly if they have mip levels, and clamp to the edge.
    void set_filter(GLenum minify, GLenum magnify);
    void set_wrap(GLenum wrap);

    [[nodiscard]] GLuint id() const { return object_.id(); }
    [[nodiscard]] std::uint64_t serial() const { return object_.serial(); }
    [[nodiscard]] const TextureDesc& desc() const { return desc_; }
    [[nodiscard]] GLenum target() const { return target_; }  ///< with multisampling resolved
    [[nodiscard]] int width(int level = 0) const { return std::max(desc_.width >> level, 1); }
    [[nodiscard]] int height(int level = 0) const { return std::max(desc_.height >> level, 1); }
    [[nodiscard]] int layers(int level = 0) const;
    explicit operator bool() const { return static_cast<bool>(object_); }

  private:
    void set_defaults();

    GlObject<ObjectKind::Texture> object_;
    TextureDesc desc_;
    GLenum target_ = GL_TEXTURE_2D;
};

/// How a shader samples a texture; a bound sampler overrides the texture's own filter and wrap.
struct SamplerDesc {
    GLenum minify = GL_LINEAR_MIPMAP_LINEAR;
    GLenum magnify = GL_LINEAR;
    GLenum wrap = GL_REPEAT;
    GLenum wrap_v = GL_NONE;  ///< of the second coordinate; GL_NONE: `wrap`
    float anisotropy = 1.0f;  ///< >= 1, clamped to the device's limit
    float lod_bias = 0.0f;    ///< mip levels added to that of the derivatives
    Vec2 lod_range = {-1000, 1000};
    GLenum compare = GL_NONE;    ///< e.g. GL_GEQUAL: a shadow sampler
    Vec4 border = {0, 0, 0, 0};  ///< with GL_CLAMP_TO_BORDER

    bool operator==(const SamplerDesc&) const = default;
};

class Sampler {
  public:
    Sampler() = default;
    Sampler(std::string_view label, const SamplerDesc& desc);
    [[nodiscard]] GLuint id() const { return object_.id(); }

  private:
    GlObject<ObjectKind::Sampler> object_;
};

}  // namespace limn::gpu
