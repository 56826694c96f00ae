#pragma once

#include "ecs/base/math.h"
#include "ecs/components/path.h"
#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <atomic>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace limn {

// What is drawn: meshes, images and materials are kept once, in the Assets resource, and named by
// index. Loaders and makers append to it; the renderer uploads what is new. Indices never change.

/// Index into Assets; kNoAsset = none.
inline constexpr std::uint32_t kNoAsset = 0xffffffffu;
struct MeshId {
    std::uint32_t index = kNoAsset;
    bool operator==(const MeshId&) const = default;
};
struct ImageId {
    std::uint32_t index = kNoAsset;
    bool operator==(const ImageId&) const = default;
};
struct MaterialId {
    std::uint32_t index = kNoAsset;
    bool operator==(const MaterialId&) const = default;
};
template <>
inline constexpr const char* asset_kind<MeshId> = "mesh";
template <>
inline constexpr const char* asset_kind<ImageId> = "image";
template <>
inline constexpr const char* asset_kind<MaterialId> = "material";

/// Triangles. All vertex arrays have the length of `positions`; `uvs1` and `colors` may be empty.
struct MeshData {
    std::string name;
    std::vector<Vec3> positions;  ///< [m]
    std::vector<Vec3> normals;    ///< unit
    std::vector<Vec4>
        tangents;            ///< unit xyz along +u; bitangent = w cross(normal, tangent), w = +-1
    std::vector<Vec2> uvs;   ///< (0, 0) is the first texel of the image (top left of a glTF image)
    std::vector<Vec2> uvs1;  ///< second set, or empty
    std::vector<Vec4> colors;  ///< linear RGBA factor a vertex, or empty
    std::vector<std::uint32_t>
        indices;                      ///< three a triangle, counter-clockwise seen from the front
    SkinWeights skin;                 ///< empty: no joints move it
    std::vector<MorphTarget> morphs;  ///< shapes it can take on, in the file's order
    Bounds bounds;                    ///< at rest
};

enum class PixelFormat : std::uint8_t { Rgba8, Rgba16F, Rgba32F };

/// Rows from top to bottom, four channels.
struct ImageData {
    std::string name;
    int width = 0;   ///< pixels, > 0
    int height = 0;  ///< pixels, > 0
    PixelFormat format = PixelFormat::Rgba8;
    bool srgb = false;                 ///< Rgba8 only: color that the GPU decodes to linear
    std::vector<std::uint8_t> pixels;  ///< width * height * (4, 8 or 16) bytes
};

enum class Wrap : std::uint8_t { Repeat, Mirror, Clamp };

/// One use of an image by a material. uv' = rotate(scale * uv) + offset (KHR_texture_transform).
struct TextureSlot {
    ImageId image;
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    bool nearest = false;     ///< no filtering when magnified
    std::uint8_t uv_set = 0;  ///< 0 or 1
    Vec2 offset = {0, 0};
    Vec2 scale = {1, 1};
    float rotation = 0.0f;  ///< [rad], counter-clockwise as glTF defines it
};

enum class ShadingModel : std::uint8_t {
    Pbr,    ///< metal-rough of glTF: GGX with multi-scatter compensation, Lambert diffuse
    Blinn,  ///< ka, kd, ks, n with the half vector (light.halfway-vector)
    Phong,  ///< the same with the mirrored vector (light.phong-model)
    Unlit,  ///< base color as it is, or what it mirrors: (1 - m) color + m surroundings, m =
            ///< metalness
    Skin,   ///< Blinn, and a glow toward the rim that soft skin has on every side of a light
            ///< (char.skin-shade)
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

struct Material {
    std::string name = {};
    ShadingModel shading = ShadingModel::Pbr;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    bool double_sided = false;
    float alpha_cutoff = 0.5f;                ///< Mask only
    Vec4 base_color = {0.8f, 0.8f, 0.8f, 1};  ///< linear RGB, opacity; kd but of Pbr
    float metalness = 0.0f;                   ///< share that is metal, or mirrors, 0 .. 1
    float roughness = 0.5f;                   ///< perceptual, 0 .. 1
    Vec3 emission = {0, 0, 0};                ///< radiance, linear [W/(sr m^2)], >= 0
    Vec3 specular = {0.04f, 0.04f, 0.04f};    ///< ks of Blinn, Phong and Skin
    float shininess = 50.0f;                  ///< n of Blinn, Phong and Skin, > 0
    Vec3 skin_color = {0.6f, 0.2f, 0.1f};     ///< of Skin's rim, linear RGB, of the base color
    bool wide_rim = false;                    ///< Skin: 1 - (n.v)^2 instead of (1 - n.v)^2
    float normal_scale = 1.0f;
    float occlusion_strength = 1.0f;       ///< 0 .. 1
    TextureSlot base_color_texture = {};   ///< sRGB, alpha = opacity
    TextureSlot metal_rough_texture = {};  ///< g = roughness, b = metalness
    TextureSlot normal_texture = {};       ///< tangent space, green up
    TextureSlot occlusion_texture = {};    ///< r
    TextureSlot emission_texture = {};     ///< sRGB
};

/// Tells one Assets from every other of this run, even from one that lives where it did: the
/// renderer keeps what it uploaded by it. Moves with the value; a copy is another.
class AssetsIdentity {
  public:
    AssetsIdentity() = default;
    AssetsIdentity(const AssetsIdentity& /*other*/) {}
    AssetsIdentity(AssetsIdentity&& other) noexcept : value_(std::exchange(other.value_, next())) {}
    AssetsIdentity& operator=(const AssetsIdentity& other) {
        value_ = this == &other ? value_ : next();
        return *this;
    }
    AssetsIdentity& operator=(AssetsIdentity&& other) noexcept {
        std::swap(value_, other.value_);
        return *this;
    }
    /// Never 0; no two living values are equal.
    [[nodiscard]] std::uint64_t value() const { return value_; }

  private:
    static std::uint64_t next() {
        static std::atomic<std::uint64_t> count = 0;
        return ++count;
    }
    std::uint64_t value_ = next();
};

/// Resource: everything loaded or made. Append only.
struct Assets {
    std::vector<MeshData> meshes;
    std::vector<ImageData> images;
    std::vector<Material> materials;
    std::vector<SkeletonData> skeletons;
    std::vector<SkinData> skins;
    std::vector<ClipData> clips;
    std::vector<PathData> paths;
    std::uint64_t material_version = 1;  ///< raise after editing a material in place
    AssetsIdentity identity;
};

/// Draws `mesh` with `material` at the entity's WorldTransform.
struct MeshInstance {
    MeshId mesh;
    MaterialId material;
};

/// Beside a MeshInstance: moves every vertex along its normal (shade.inflate). Where vertices of
/// one place have different normals the mesh comes apart there. Lights with shadow volumes that
/// reach it get maps.
struct Inflate {
    float distance = 0.02f;  ///< in the mesh's own space [m]; negative: thinner
};

/// What an inflated mesh stays within; `box` of no mesh stays empty.
[[nodiscard]] inline Bounds inflated(const Bounds& box, const Inflate& inflate) {
    const Vec3 more = is_empty(box) ? Vec3(0) : Vec3(std::abs(inflate.distance));
    return {box.min - more, box.max + more};
}

template <typename Visitor>
void visit_fields(Inflate& inflate, Visitor&& visit) {
    visit(
        "distance", inflate.distance,
        {.doc = "by which every vertex moves along its normal",
         .unit = "m",
         .min = -1000,
         .max = 1000});
}

template <typename Visitor>
void visit_fields(MeshInstance& instance, Visitor&& visit) {
    visit("mesh", instance.mesh, {.doc = "a mesh of the level, by name"});
    visit("material", instance.material, {.doc = "a material of the level, by name"});
}

template <typename Visitor>
void visit_fields(TextureSlot& slot, Visitor&& visit) {
    visit("image", slot.image, {.doc = "an image of the level, by name"});
    visit(
        "wrap_u", slot.wrap_u,
        {.doc = "beyond the left and right edge", .values = "repeat mirror clamp"});
    visit(
        "wrap_v", slot.wrap_v,
        {.doc = "beyond the upper and lower edge", .values = "repeat mirror clamp"});
    visit("nearest", slot.nearest, {.doc = "no filtering when magnified"});
    visit("uv_set", slot.uv_set, {.doc = "which texture coordinates", .min = 0, .max = 1});
    visit("offset", slot.offset, {.doc = "of the texture coordinates"});
    visit("scale", slot.scale, {.doc = "of the texture coordinates"});
    visit(
        "rotation", slot.rotation,
        {.doc = "of the texture coordinates, counter-clockwise", .unit = "rad"});
}

template <typename Visitor>
void visit_fields(Material& material, Visitor&& visit) {
    visit(
        "shading", material.shading,
        {.doc = "shading model", .values = "pbr blinn phong unlit skin"});
    visit(
        "alpha_mode", material.alpha_mode,
        {.doc = "what alpha means", .values = "opaque mask blend"});
    visit("double_sided", material.double_sided, {.doc = "drawn from behind too"});
    visit(
        "alpha_cutoff", material.alpha_cutoff,
        {.doc = "of mask: below is a hole", .min = 0, .max = 1});
    visit(
        "base_color", material.base_color,
        {.doc = "linear RGB and opacity", .min = 0, .max = 1, .color = true});
    visit(
        "metalness", material.metalness,
        {.doc = "0 dielectric, 1 metal; of unlit the share that mirrors", .min = 0, .max = 1});
    visit("roughness", material.roughness, {.doc = "perceptual roughness", .min = 0, .max = 1});
    visit(
        "emission", material.emission,
        {.doc = "radiance it gives off",
         .unit = "W/(sr m^2)",
         .min = 0,
         .max = 1e6,
         .color = true});
    visit(
        "specular", material.specular,
        {.doc = "ks of blinn, phong and skin", .min = 0, .max = 1, .color = true});
    visit(
        "shininess", material.shininess,
        {.doc = "n of blinn, phong and skin", .min = 1, .max = 10000});
    visit(
        "skin_color", material.skin_color,
        {.doc = "of the rim of skin, times the base color", .min = 0, .max = 1, .color = true});
    visit("wide_rim", material.wide_rim, {.doc = "skin: the rim reaches far into the face"});
    visit(
        "normal_scale", material.normal_scale,
        {.doc = "strength of the normal map", .min = 0, .max = 10});
    visit(
        "occlusion_strength", material.occlusion_strength,
        {.doc = "strength of the occlusion map", .min = 0, .max = 1});
    visit("base_color_texture", material.base_color_texture, {.doc = "sRGB, alpha = opacity"});
    visit(
        "metal_rough_texture", material.metal_rough_texture,
        {.doc = "green = roughness, blue = metalness"});
    visit("normal_texture", material.normal_texture, {.doc = "tangent space, green up"});
    visit("occlusion_texture", material.occlusion_texture, {.doc = "red"});
    visit("emission_texture", material.emission_texture, {.doc = "sRGB"});
}

}  // namespace limn
