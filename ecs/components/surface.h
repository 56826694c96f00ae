#pragma once

#include "ecs/base/math.h"
#include "ecs/components/dress.h"
#include "ecs/components/path.h"
#include "ecs/components/skeleton.h"
#include "ecs/reflect.h"

#include <atomic>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace limn {

// Meshes, images and materials. They are stored in the Assets resource and referenced by index.
// Loaders and generators append to it; the renderer uploads new entries. Indices never change.
// Techniques: char.skin-shade, env.control-map, shade.inflate, skin.melanin-blood

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

/// A part of a mesh that is a mesh of its own, too.
struct MeshPiece {
    Vec3 center = {0, 0, 0};  ///< origin of that mesh, in the space of the whole [m]
    std::uint32_t first = 0;  ///< of its indices in the whole
    std::uint32_t count = 0;  ///< of its indices
    MeshId mesh = {};
};

/// A named region of a mesh, such as "forehead": a weight per vertex and, where skin folds there,
/// the direction across the folds. In glTF: the vertex attributes `_REGION_<NAME>` (float) and
/// `_ACROSS_<NAME>` (vec3), with the name in capitals.
struct VertexRegion {
    std::string name;            ///< a-z, 0-9 and _
    std::vector<float> weights;  ///< one per vertex, 0 .. 1
    std::vector<Vec3>
        across;  ///< one per vertex, mesh space at rest: unit; shortening along it raises wrinkles,
                 ///< whose lines are perpendicular to it; 0: none there. Or empty
};

/// Triangle mesh. All vertex arrays have the length of `positions`; `uvs1` and `colors` may be
/// empty. After editing it in place, increment `version`: the renderer uploads it again.
struct MeshData {
    std::string name;
    std::vector<Vec3> positions;  ///< [m]
    std::vector<Vec3> normals;    ///< unit
    std::vector<Vec4>
        tangents;            ///< unit xyz along +u; bitangent = w cross(normal, tangent), w = +-1
    std::vector<Vec2> uvs;   ///< (0, 0) is the first texel of the image (top left of a glTF image)
    std::vector<Vec2> uvs1;  ///< second set, or empty
    std::vector<Vec4> colors;            ///< linear RGBA factor per vertex, or empty
    std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise from the front
    SkinWeights skin;                    ///< empty: not skinned
    std::vector<MorphTarget> morphs;     ///< morph targets, in the file's order
    std::vector<MeshPiece> pieces;       ///< all of it in pieces, or empty
    std::vector<VertexRegion> regions;   ///< names differ; may overlap
    Bounds bounds;                       ///< of the undeformed mesh
    std::uint32_t version = 0;
};

/// Bc5 (two channels: the x and y of a normal) and Bc7 (four channels) are blocks of 4x4 pixels in
/// 16 bytes, row by row of blocks; an incomplete block at the right or the bottom is a whole one.
enum class PixelFormat : std::uint8_t { Rgba8, Rgba16F, Rgba32F, Bc5, Bc7 };

/// Rows from top to bottom, four channels; or blocks.
struct ImageData {
    std::string name;
    int width = 0;   ///< pixels, > 0
    int height = 0;  ///< pixels, > 0
    PixelFormat format = PixelFormat::Rgba8;
    bool srgb = false;   ///< Rgba8 and Bc7 only: sRGB color that the GPU decodes to linear
    int mip_levels = 1;  ///< levels in `pixels`, the largest first; more than 1 for blocks only
    std::vector<std::uint8_t>
        pixels;  ///< width * height * (4, 8 or 16) bytes, or 16 bytes a block of each level
    std::uint32_t version = 0;  ///< increment after editing pixels in place
};

enum class Wrap : std::uint8_t { Repeat, Mirror, Clamp };

/// What a texture lookup averages where an image is drawn smaller than it is (tex.sampling), as
/// OpenGL's minification filters: texels of level 0, of the mip level with the nearest resolution,
/// or of the two levels about it.
enum class Minify : std::uint8_t {
    Auto,               ///< as well as the device is quick at
    Nearest,            ///< one texel of level 0
    Linear,             ///< four texels of level 0
    NearestMipNearest,  ///< one texel of one level
    LinearMipNearest,   ///< four texels of one level
    NearestMipLinear,   ///< one texel of each of two levels
    LinearMipLinear,    ///< four texels of each of two levels: trilinear
};

/// Texture reference of a material. uv' = rotate(scale * uv) + offset (KHR_texture_transform).
struct TextureSlot {
    ImageId image;
    Wrap wrap_u = Wrap::Repeat;
    Wrap wrap_v = Wrap::Repeat;
    bool nearest = false;
    std::uint8_t uv_set = 0;
    Minify minify = Minify::Auto;
    Vec2 offset = {0, 0};
    Vec2 scale = {1, 1};
    float rotation = 0.0f;
    float anisotropy = 0.0f;
    float lod_bias = 0.0f;
    Vec2 lod_range = {0, 16};

    bool operator==(const TextureSlot&) const = default;
};

LIMN_FIELDS(TextureSlot) {
    LIMN_FIELD(image, "an image of the level, by name");
    LIMN_FIELD(
        wrap_u, .doc = "addressing beyond the left and right edge",
        .values = "repeat mirror clamp");
    LIMN_FIELD(
        wrap_v, .doc = "addressing beyond the top and bottom edge",
        .values = "repeat mirror clamp");
    LIMN_FIELD(nearest, "no filtering when magnified");
    LIMN_FIELD(uv_set, "texture coordinate set", "", 0, 1);
    LIMN_FIELD(
        minify,
        .doc = "filter when minified, as in OpenGL: of level 0, or of one or two mip levels; auto: "
               "trilinear where the device is quick at it",
        .values = "auto nearest linear nearest_mipmap_nearest linear_mipmap_nearest "
                  "nearest_mipmap_linear linear_mipmap_linear");
    LIMN_FIELD(offset, "offset of the texture coordinates");
    LIMN_FIELD(scale, "scale of the texture coordinates");
    LIMN_FIELD(rotation, "rotation of the texture coordinates, counter-clockwise", "rad");
    LIMN_FIELD(
        anisotropy,
        "samples at most along the longer axis of what a pixel sees; 0: with minify auto as the "
        "device is quick at it, otherwise 1",
        "", 0, 16);
    LIMN_FIELD(
        lod_bias, "mip levels added to that of the pixel's size: negative sharper", "", -16, 16);
    LIMN_FIELD(
        lod_range, "first and last mip level that are read; equal: that level alone", "", 0, 16);
}

enum class ShadingModel : std::uint8_t {
    Pbr,         ///< glTF metallic-roughness: GGX with multi-scatter compensation, Lambert diffuse
    Blinn,       ///< ka, kd, ks, n with the half vector (light.halfway-vector)
    Phong,       ///< the same with the reflection vector (light.phong-model)
    Unlit,       ///< (1 - m) base color + m reflected environment, m = metalness
    Skin,        ///< Blinn plus a rim glow from all sides that imitates soft skin (char.skin-shade)
    Lafortune,   ///< the base color and lobes fitted to a measured BRDF (skin.brdf-lafortune)
    Subsurface,  ///< two GGX lobes over diffuse light that scatters under the surface
    Hair,        ///< strands along v, from roots to tips: reflected, transmitted, scattered light
    Toon,        ///< diffuse light in the colors of a ramp (tex.toon-ramp)
    Strand,      ///< threads along the tangent (Banks 1994): satin, grass, brushed metal
};

/// How the amounts of melanin and blood affect the color of skin.
enum class Pigments : std::uint8_t {
    None,     ///< not at all
    Plane,    ///< each subtracts a multiple of a color (skin.melanin-blood)
    Density,  ///< each absorbs light, as in measured skin of types I to VI
};

/// One lobe of a BRDF (Lafortune et al. 1997), for red, green and blue: (across (ux vx + uy vy) +
/// along uz vz)^exponent, u and v toward light and viewer, z along the normal.
struct LafortuneLobe {
    Vec3 across = {-1, -1, -1};
    Vec3 along = {1, 1, 1};
    Vec3 exponent = {10, 10, 10};
};

LIMN_FIELDS(LafortuneLobe) {
    LIMN_FIELD(across, "coefficient Cx = Cy; negative: mirrors", "", -2, 2);
    LIMN_FIELD(along, "coefficient Cz", "", -2, 2);
    LIMN_FIELD(exponent, "n", "", 0, 10000);
}

inline constexpr std::size_t kMaxLafortuneLobes = 4;

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };

/// How a surface shows detail that its mesh does not have, from cheap to true (relief.selection).
/// All but Normal, ObjectNormal and Flat read `relief_texture`.
enum class SurfaceDetail : std::uint8_t {
    Normal,        ///< the tangent-space normal map
    Flat,          ///< none: the normals of the mesh
    Bump,          ///< normals from the differences of a height map (Blinn 1978)
    ObjectNormal,  ///< the normal map holds normals in mesh space
    Parallax,      ///< one lookup shifts the maps (Kaneko 2001)
    Occlusion,     ///< linear search and one secant step (Tatarchuk 2006)
    Relief,        ///< linear and binary search (Policarpo and Oliveira 2005)
    Cone,          ///< relaxed cone stepping (Policarpo and Oliveira 2007)
    DoubleDepth,   ///< as Relief, between a front and a back surface; empty texels are holes
    Silhouette,    ///< as Relief on the quadric of the mesh: its outline is that of the relief
    Odd,           ///< one lookup in a baked map of positions and view directions (odd.shade)
    Displaced,     ///< the mesh is tessellated, its vertices are displaced (tex.displacement)
};

/// How relief shadows itself.
enum class ReliefShadow : std::uint8_t {
    Map,   ///< in shadow maps of every light, which search the relief again
    Ray,   ///< by a second ray toward each of the level's two key lights: exact at every pixel
    None,  ///< not at all
};

/// What coarser mip levels of normal maps keep of the bumps that they average (bump.mipmap).
enum class NormalMips : std::uint8_t {
    Plain,    ///< their mean direction: distant highlights are too small and bright
    Toksvig,  ///< also how much they differ, as roughness alike in all directions (Toksvig 2005)
    Lean,     ///< also their covariance, as roughness along and across (Olano and Baker 2010)
};

/// Light on bumps that face it where the mesh itself faces away (bump.self-shadow).
enum class BumpShadow : std::uint8_t {
    None,    ///< lit
    Gate,    ///< unlit, with a hard border
    Smooth,  ///< times the cosine to the normal of the mesh: darker everywhere
    Ramp,    ///< times 8 of that cosine, at most 1
};

struct Material {
    std::string name = {};
    ShadingModel shading = ShadingModel::Pbr;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    bool double_sided = false;
    float alpha_cutoff = 0.5f;
    Vec4 base_color = {0.8f, 0.8f, 0.8f, 1};
    float metalness = 0.0f;
    float roughness = 0.5f;
    Vec3 emission = {0, 0, 0};
    Vec3 specular = {0.04f, 0.04f, 0.04f};
    float shininess = 50.0f;
    Vec3 skin_color = {0.6f, 0.2f, 0.1f};
    bool wide_rim = false;
    Pigments pigments = Pigments::None;
    float melanin = 0.2f;
    float blood = 0.5f;
    std::vector<LafortuneLobe> lobes = {};
    Vec3 scatter = {3.67e-3f, 1.37e-3f, 0.68e-3f};
    float gloss = 0.2f;
    float gloss_roughness = 0.3f;
    float roughness_across = 0.3f;
    float scale_tilt = radians(3.0f);
    float hair_scatter = 0.7f;
    float normal_scale = 1.0f;
    float occlusion_strength = 1.0f;
    float transmission = 0.0f;
    float refractive_index = 1.5f;
    float thickness = 0.0f;
    Vec3 attenuation_color = {1, 1, 1};
    float attenuation_distance = 1.0f;
    float clearcoat = 0.0f;
    float clearcoat_roughness = 0.0f;
    float clearcoat_normal_scale = 1.0f;
    Vec3 sheen = {0, 0, 0};
    float sheen_roughness = 0.0f;
    float specular_weight = 1.0f;
    Vec3 specular_tint = {1, 1, 1};
    float anisotropy = 0.0f;
    float anisotropy_rotation = 0.0f;
    float iridescence = 0.0f;
    float iridescence_index = 1.3f;
    Vec2 iridescence_thickness = {100, 400};
    float dispersion = 0.0f;
    std::vector<Vec3> ramp = {};
    SurfaceDetail detail = SurfaceDetail::Normal;
    float relief_depth = 0.05f;
    std::int32_t relief_steps = 24;
    std::int32_t relief_refinements = 6;
    ReliefShadow relief_shadow = ReliefShadow::Map;
    float tessellation = 6.0f;
    NormalMips normal_mips = NormalMips::Plain;
    BumpShadow bump_shadow = BumpShadow::None;
    Dress dress = {};
    TextureSlot base_color_texture = {};
    TextureSlot metal_rough_texture = {};
    TextureSlot normal_texture = {};
    TextureSlot occlusion_texture = {};
    TextureSlot emission_texture = {};
    TextureSlot wrinkle_texture = {};
    TextureSlot detail_texture = {};
    TextureSlot thickness_texture = {};
    TextureSlot transmission_texture = {};
    TextureSlot light_map_texture = {};
    TextureSlot relief_texture = {};
    TextureSlot clearcoat_texture = {};
    TextureSlot clearcoat_roughness_texture = {};
    TextureSlot clearcoat_normal_texture = {};
    TextureSlot sheen_texture = {};
    TextureSlot sheen_roughness_texture = {};
    TextureSlot specular_weight_texture = {};
    TextureSlot specular_tint_texture = {};
    TextureSlot anisotropy_texture = {};
    TextureSlot iridescence_texture = {};
    TextureSlot iridescence_thickness_texture = {};
};

LIMN_FIELDS(Material) {
    LIMN_FIELD(
        shading, .doc = "shading model",
        .values = "pbr blinn phong unlit skin lafortune subsurface hair toon strand");
    LIMN_FIELD(alpha_mode, .doc = "how alpha is used", .values = "opaque mask blend");
    LIMN_FIELD(double_sided, "back faces are drawn too");
    LIMN_FIELD(alpha_cutoff, "with mask: lower alpha is discarded", "", 0, 1);
    LIMN_FIELD(base_color, .doc = "linear RGB and opacity", .min = 0, .max = 1, .color = true);
    LIMN_FIELD(metalness, "0 dielectric, 1 metal; mirror fraction of unlit", "", 0, 1);
    LIMN_FIELD(roughness, "perceptual roughness; of hair that along a strand", "", 0, 1);
    LIMN_FIELD(
        emission, .doc = "emitted radiance, of all models but hair", .unit = "W/(sr m^2)", .min = 0,
        .max = 1e6, .color = true);
    LIMN_FIELD(
        specular,
        .doc = "specular color ks of blinn, phong and skin; of subsurface its reflectance head on",
        .min = 0, .max = 1, .color = true);
    LIMN_FIELD(shininess, "specular exponent n of blinn, phong and skin", "", 1, 10000);
    LIMN_FIELD(
        skin_color, .doc = "rim color of skin, multiplied by the base color", .min = 0, .max = 1,
        .color = true);
    LIMN_FIELD(wide_rim, "skin: wide rim, 1 - (n.v)^2 instead of (1 - n.v)^2");
    LIMN_FIELD(
        pigments, .doc = "how melanin and blood color skin, a factor of the base color",
        .values = "none plane density");
    LIMN_FIELD(melanin, "amount of melanin", "", 0, 1);
    LIMN_FIELD(blood, "amount of blood: pale, or blushing", "", 0, 1);
    LIMN_FIELD(lobes, "of lafortune, at most 4, added to the base color");
    LIMN_FIELD(
        scatter,
        "subsurface: mean free path of diffuse light, for red, green and blue; 0: none passes", "m",
        0, 1);
    LIMN_FIELD(gloss, "subsurface: weight of the second lobe, that of the oily film", "", 0, 1);
    LIMN_FIELD(gloss_roughness, "subsurface: perceptual roughness of the second lobe", "", 0, 1);
    LIMN_FIELD(
        roughness_across,
        "hair: perceptual roughness around a strand (azimuthal), of light that passes it", "", 0,
        1);
    LIMN_FIELD(
        scale_tilt,
        "hair: tilt of a strand's scales, which shifts the white highlight toward the root and the "
        "colored one toward the tip",
        "rad", 0, 0.35);
    LIMN_FIELD(
        hair_scatter,
        "hair: fraction of the light through a strand that other strands scatter, in the base "
        "color; 0: a single strand, 1: a dense mass",
        "", 0, 1);
    LIMN_FIELD(normal_scale, "strength of the normal map", "", 0, 10);
    LIMN_FIELD(occlusion_strength, "strength of the occlusion map", "", 0, 1);
    LIMN_FIELD(
        transmission,
        "fraction of light that is transmitted instead of scattered; what is behind is visible "
        "refracted, in the base color, and blurred by the roughness",
        "", 0, 1);
    LIMN_FIELD(
        refractive_index,
        "of a dielectric: how much it reflects, and how it refracts with transmission; glass 1.5, "
        "water 1.33",
        "", 1, 3);
    LIMN_FIELD(
        thickness,
        "with transmission: of the medium behind the surface, scaled with the mesh. The bent ray "
        "ends there or at something opaque within it; light is absorbed over all of it. 0: a thin "
        "sheet, which does not refract",
        "m", 0, 1000);
    LIMN_FIELD(
        attenuation_color, .doc = "color of white light after attenuation_distance in the medium",
        .min = 0, .max = 1, .color = true);
    LIMN_FIELD(attenuation_distance, "see attenuation_color", "m", 1e-6, 1e6);
    LIMN_FIELD(
        clearcoat, "fraction of the surface under a clear coat of refractive index 1.5", "", 0, 1);
    LIMN_FIELD(clearcoat_roughness, "perceptual roughness of the clear coat", "", 0, 1);
    LIMN_FIELD(clearcoat_normal_scale, "strength of the normal map of the clear coat", "", -10, 10);
    LIMN_FIELD(
        sheen, .doc = "color of light that fibers scatter at grazing angles, as of velvet",
        .min = 0, .max = 1, .color = true);
    LIMN_FIELD(sheen_roughness, "perceptual roughness of the sheen", "", 0, 1);
    LIMN_FIELD(specular_weight, "factor of the reflection of a dielectric", "", 0, 1);
    LIMN_FIELD(
        specular_tint, .doc = "factor of the reflection of a dielectric head on", .min = 0,
        .max = 100, .color = true);
    LIMN_FIELD(
        anisotropy, "how far highlights stretch along the tangent, as on brushed metal", "", 0, 1);
    LIMN_FIELD(
        anisotropy_rotation, "of that direction from the tangent, counter-clockwise", "rad", -100,
        100);
    LIMN_FIELD(iridescence, "fraction of the surface under a thin film", "", 0, 1);
    LIMN_FIELD(iridescence_index, "refractive index of the thin film", "", 1, 5);
    LIMN_FIELD(
        iridescence_thickness,
        "thickness of the thin film at values 0 and 1 of its texture; without one it is the second",
        "nm", 0, 10000);
    LIMN_FIELD(
        dispersion,
        "with transmission and thickness: 20 / Abbe number, the spread of colors in the medium", "",
        0, 20);
    LIMN_FIELD(
        ramp,
        .doc = "toon: colors of the diffuse light from dark to lit, at equal distances, at most 16",
        .min = 0, .color = true);
    LIMN_FIELD(
        detail, .doc = "how the surface shows detail that its mesh does not have",
        .values = "normal flat bump object_normal parallax occlusion relief cone double_depth "
                  "silhouette odd displaced");
    LIMN_FIELD(relief_depth, "depth of the relief below the mesh where its map is 1", "m", 0, 1000);
    LIMN_FIELD(relief_steps, "steps of the linear search along the view ray", "", 4, 256);
    LIMN_FIELD(relief_refinements, "steps of the binary search after it", "", 0, 12);
    LIMN_FIELD(
        relief_shadow, .doc = "how relief shadows itself: in shadow maps, by a second ray, or not",
        .values = "map ray none");
    LIMN_FIELD(
        tessellation,
        "displaced: length of the parts of an edge on screen; there are at most 64, on software "
        "OpenGL 15",
        "px", 1, 100);
    LIMN_FIELD(
        normal_mips,
        .doc = "what coarser mip levels of the normal map keep of its bumps: their mean direction, "
               "or also roughness",
        .values = "plain toksvig lean");
    LIMN_FIELD(
        bump_shadow,
        .doc = "light on bumps that face it where the mesh faces away: all, none, or less",
        .values = "none gate smooth ramp");
    LIMN_FIELD(dress, "of a person in one mesh: colors and patterns of its parts");
    LIMN_FIELD(base_color_texture, "sRGB base color, alpha = opacity");
    LIMN_FIELD(metal_rough_texture, "green = roughness, blue = metalness");
    LIMN_FIELD(normal_texture, "tangent-space normals, green up");
    LIMN_FIELD(occlusion_texture, "ambient occlusion in red");
    LIMN_FIELD(emission_texture, "sRGB emission");
    LIMN_FIELD(
        wrinkle_texture,
        "tangent-space normals, green up, 128 flat, of wrinkles in full: drawn where a "
        "wrinkle_surface is compressed");
    LIMN_FIELD(
        detail_texture,
        "tangent-space normals, green up, of finer relief, added to normal_texture: give it a "
        "scale to tile it; the alpha of vertex colors scales its slopes, except with alpha_mode "
        "mask");
    LIMN_FIELD(thickness_texture, "green = fraction of the thickness");
    LIMN_FIELD(transmission_texture, "red = factor of transmission");
    LIMN_FIELD(
        light_map_texture,
        "linear diffuse light, irradiance over pi, in addition to that of lights: multiplied by "
        "the base color; shaded per pixel only");
    LIMN_FIELD(
        relief_texture,
        "replaces normal_texture where `detail` needs it: red, green = tangent-space normal, alpha "
        "= depth, 0 on the mesh and 1 deepest; blue = depth of the back surface (double_depth) or "
        "ratio of the widest empty cone (cone); for odd the map that `limn bake odd` makes");
    LIMN_FIELD(clearcoat_texture, "red = factor of clearcoat");
    LIMN_FIELD(clearcoat_roughness_texture, "green = factor of clearcoat_roughness");
    LIMN_FIELD(clearcoat_normal_texture, "tangent-space normals of the clear coat, green up");
    LIMN_FIELD(sheen_texture, "sRGB factor of sheen");
    LIMN_FIELD(sheen_roughness_texture, "alpha = factor of sheen_roughness");
    LIMN_FIELD(specular_weight_texture, "alpha = factor of specular_weight");
    LIMN_FIELD(specular_tint_texture, "sRGB factor of specular_tint");
    LIMN_FIELD(
        anisotropy_texture,
        "red, green = direction of the stretch in tangent space, blue = factor of anisotropy");
    LIMN_FIELD(iridescence_texture, "red = factor of iridescence");
    LIMN_FIELD(
        iridescence_thickness_texture, "green = thickness between those of iridescence_thickness");
}

/// Whether what is behind the surface is visible through it.
[[nodiscard]] inline bool is_see_through(const Material& material) {
    return material.alpha_mode == AlphaMode::Blend || material.transmission > 0;
}

/// Unique ID of an Assets object within this run, even if another one reuses its address: the
/// renderer keys uploaded resources by it. Moves with the value; a copy gets a new ID.
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
    /// Never 0; unique among living objects.
    [[nodiscard]] std::uint64_t value() const { return value_; }

  private:
    static std::uint64_t next() {
        static std::atomic<std::uint64_t> count = 0;
        return ++count;
    }
    std::uint64_t value_ = next();
};

/// Resource: all loaded or generated assets. Entries are only appended; a mesh that nothing draws
/// any more can be freed.
struct Assets {
    std::vector<MeshData> meshes;
    std::vector<ImageData> images;
    std::vector<Material> materials;
    std::vector<SkeletonData> skeletons;
    std::vector<SkinData> skins;
    std::vector<ClipData> clips;
    std::vector<PathData> paths;
    std::uint64_t material_version = 1;  ///< increment after editing a material in place
    AssetsIdentity identity;
};

/// Frees the memory of a mesh, on the GPU at the next frame. Its index stays; what draws it draws
/// nothing.
inline void free_mesh(Assets& assets, MeshId mesh) {
    MeshData freed;
    freed.name = assets.meshes[mesh.index].name;
    freed.version = assets.meshes[mesh.index].version + 1;
    assets.meshes[mesh.index] = std::move(freed);
}

/// Draws `mesh` with `material` at the entity's WorldTransform.
struct MeshInstance {
    MeshId mesh;
    MaterialId material;
};

LIMN_FIELDS(MeshInstance) {
    LIMN_FIELD(mesh, "a mesh of the level, by name");
    LIMN_FIELD(material, "a material of the level, by name");
}

/// With a MeshInstance: displaces every vertex along its normal (shade.inflate). Hard edges, where
/// vertices share a position but not a normal, split open. Lights with shadow volumes that reach it
/// use maps.
struct Inflate {
    float distance = 0.02f;
};

LIMN_FIELDS(Inflate) {
    LIMN_FIELD(
        distance, "displacement of every vertex along its normal; negative: thinner", "m", -1000,
        1000);
}

/// Bounds of an inflated mesh; an empty `box` stays empty.
[[nodiscard]] inline Bounds inflated(const Bounds& box, const Inflate& inflate) {
    const Vec3 more = is_empty(box) ? Vec3(0) : Vec3(std::abs(inflate.distance));
    return {box.min - more, box.max + more};
}

}  // namespace limn
