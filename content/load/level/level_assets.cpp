#include "content/load/level/level_assets.h"

#include "content/load/files/brdf_file.h"
#include "content/load/files/error_list.h"
#include "content/load/files/file_uri.h"
#include "content/load/files/texture_load.h"
#include "content/load/level/level_names.h"
#include "content/make/models/fragments.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/components/image_blocks.h"
#include "ecs/field_access.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr PatternMap kPatternMaps[] = {
    {".base_color", &PatternMaps::base_color},
    {".normal", &PatternMaps::normal},
    {".orm", &PatternMaps::orm},
    {".motion", &PatternMaps::motion},
};
constexpr PatternMap kReliefMaps[] = {
    kPatternMaps[0],
    kPatternMaps[1],
    kPatternMaps[2],
    {".relief", &PatternMaps::relief},
};
constexpr PatternMap kPuffMaps[] = {
    kPatternMaps[0],
    kPatternMaps[1],
    kPatternMaps[2],
    {".positive_light", &PatternMaps::positive_light},
    {".negative_light", &PatternMaps::negative_light},
};

Status
make_pattern(Level& level, const LevelImage& image, MadeAssets& made, std::uint64_t& pixels_left) {
    const FieldInfo* const size = find_field(image.parameters.info().fields, "size");
    const auto side =
        size == nullptr ? 0.0 : get_number(*size, field_ptr(image.parameters.data(), *size));
    const std::span<const PatternMap> wanted = pattern_maps(*image.pattern);
    const auto pixels =
        static_cast<std::uint64_t>(static_cast<double>(wanted.size()) * side * side);
    if (pixels > pixels_left) {
        return fail(
            "{}: found {} pixels, expected at most {} more in this level",
            location_of(level, image.at, "images." + image.name), pixels, pixels_left);
    }
    pixels_left -= pixels;
    PatternMaps maps = made.pattern(*image.pattern, image.parameters);
    std::size_t index = image.index;
    for (const PatternMap& map : wanted) {
        (maps.*map.image).name = level.assets.images[index].name;
        level.assets.images[index++] = std::move(maps.*map.image);
    }
    return Done{};
}

Status load_image_file(
    Level& level, const LevelImage& image, const std::string& folder, const LevelLimits& limits,
    std::uint64_t& pixels_left) {
    const std::string location = location_of(level, image.at, "images." + image.name);
    const std::vector<std::byte> bytes =
        LIMN_TRY(fetch_uri(image.file, folder, location, limits.gltf.max_bytes));
    ImageLimits image_limits = limits.gltf.image;
    image_limits.max_pixels =
        std::min(image_limits.max_pixels, static_cast<std::int64_t>(pixels_left));
    ImageData data = LIMN_TRY(decode_texture(
        bytes, fmt::format("{}: {}", location, image.file), image.srgb, image_limits));
    pixels_left -= static_cast<std::uint64_t>(data.width) * static_cast<std::uint64_t>(data.height);
    if (const std::size_t bad = replace_non_finite(data); bad > 0) {
        log_warn(
            "{}: {}: {} values are not finite; NaN became 0, infinity 65504", location, image.file,
            bad);
    }
    data.name = image.name;
    level.assets.images[image.index] = std::move(data);
    return Done{};
}

/// How often materials of the level use an image.
struct ImageUse {
    int all = 0;
    int normals = 0;   ///< of tangent space, whose z >= 0 follows from x and y
    int wrinkles = 0;  ///< read by systems, too
};

ImageUse use_of(std::vector<Material>& materials, ImageId image) {
    ImageUse use;
    for (Material& m : materials) {
        for_each_asset(
            component_info<Material>().fields, &m,
            [&](std::string_view kind, const std::uint32_t& index) {
                use.all += kind == asset_kind<ImageId> && index == image.index ? 1 : 0;
            });
        for (const TextureSlot* slot :
             {&m.normal_texture, &m.detail_texture, &m.clearcoat_normal_texture}) {
            const bool in_mesh_space =
                slot == &m.normal_texture && m.detail == SurfaceDetail::ObjectNormal;
            use.normals += slot->image == image && !in_mesh_space ? 1 : 0;
        }
        use.wrinkles += m.wrinkle_texture.image == image ? 1 : 0;
    }
    return use;
}

/// The images that `image` has become, in blocks.
void compress_images(Level& level, const LevelImage& image, MadeAssets& made) {
    const std::size_t count = image.pattern != nullptr ? pattern_maps(*image.pattern).size() : 1;
    for (std::size_t i = image.index; i < image.index + count; ++i) {
        ImageData& data = level.assets.images[i];
        const ImageUse use = use_of(level.assets.materials, {static_cast<std::uint32_t>(i)});
        if (data.format != PixelFormat::Rgba8 || use.wrinkles > 0) {
            log_warn(
                "{}: {} is not compressed: found {}, expected 8 bits that only materials read",
                location_of(level, image.at, "images." + image.name), data.name,
                use.wrinkles > 0 ? "the wrinkles of a material" : format_name(data.format));
            continue;
        }
        const bool normals = use.normals > 0 && use.normals == use.all;
        data = made.blocks(
            data, {.format = normals ? PixelFormat::Bc5 : PixelFormat::Bc7,
                   .kind = normals     ? TexelKind::Normal
                           : data.srgb ? TexelKind::Color
                                       : TexelKind::Data});
    }
}

/// Base color and lobes of a material.
Status load_brdf_file(
    Level& level, const LevelBrdf& brdf, const std::string& folder, const LevelLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(
        fetch_uri(brdf.file, folder, location_of(level, brdf.at, "brdf"), limits.gltf.max_bytes));
    const std::string path = (std::filesystem::path(folder) / brdf.file).string();
    const BrdfFit fit =
        LIMN_TRY(parse_brdf({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path));
    Material& material = level.assets.materials[brdf.material];
    material.base_color = Vec4(fit.diffuse, material.base_color.w);
    material.lobes = fit.lobes;
    return Done{};
}

/// Skeleton and skin get the name of the mesh, clips begin with it: "fox.walk".
void add_rig(Assets& assets, const std::string& name, MeshRig rig) {
    rig.skeleton.name = name;
    rig.skin.name = name;
    assets.skeletons.push_back(std::move(rig.skeleton));
    assets.skins.push_back(std::move(rig.skin));
    for (ClipData& clip : rig.clips) {
        clip.name = fmt::format("{}.{}", name, clip.name);
        assets.clips.push_back(std::move(clip));
    }
}

Status make_meshes(Level& level, const LevelLimits& limits, MadeAssets& made) {
    std::uint64_t vertices = 0;
    for (const LevelMesh& mesh : level.meshes) {
        MadeMesh made_mesh = made.mesh(*mesh.kind, mesh.parameters, level.assets);
        MeshData& data = level.assets.meshes.emplace_back(std::move(made_mesh.data));
        data.name = mesh.name;
        if (made_mesh.rig) {
            add_rig(level.assets, mesh.name, *std::move(made_mesh.rig));
        }
        vertices += data.positions.size();
        if (vertices > limits.max_vertices) {
            return fail(
                "{}: meshes.{}: found {} vertices so far, expected at most {} in all meshes",
                level.file, mesh.name, vertices, limits.max_vertices);
        }
    }
    for (std::uint32_t i = 0; i < level.meshes.size(); ++i) {
        add_piece_meshes(level.assets, {i});  // after those whose ids are their indices in the file
    }
    return Done{};
}

Result<GltfScene> load_scene_file(
    const Level& level, const GltfUse& use, const std::string& folder, const LevelLimits& limits) {
    const std::vector<std::byte> bytes = LIMN_TRY(
        fetch_uri(use.file, folder, location_of(level, use.at, "gltf"), limits.gltf.max_bytes));
    const std::filesystem::path path = std::filesystem::path(folder) / use.file;
    return parse_gltf(bytes, path.string(), path.parent_path().string(), limits.gltf, use.variant);
}

}  // namespace

std::span<const PatternMap> pattern_maps(const PatternKind& kind) {
    switch (kind.maps) {
    case PatternKindMaps::Motion:
        return kPatternMaps;
    case PatternKindMaps::Light:
        return kPuffMaps;
    case PatternKindMaps::Relief:
        return kReliefMaps;
    case PatternKindMaps::Surface:
        break;
    }
    return std::span(kPatternMaps).first(3);
}

std::string location_of(const Level& level, SourcePosition at, std::string_view path) {
    return location_text(level.file, at) + ": " + std::string(path);
}

Status load_level_assets(
    Level& level, const std::string& folder, const LevelLimits& limits, MadeAssets* made) {
    MadeAssets own;
    MadeAssets& makes = made != nullptr ? *made : own;
    makes.begin_level();
    std::uint64_t pixels_left = limits.max_pixels;
    ErrorList errors(level.file);
    for (const LevelImage& image : level.images) {
        const Status loaded = image.pattern != nullptr
                                  ? make_pattern(level, image, makes, pixels_left)
                                  : load_image_file(level, image, folder, limits, pixels_left);
        errors.keep(loaded);
        if (loaded && image.compress) {
            compress_images(level, image, makes);
        }
    }
    for (const LevelBrdf& brdf : level.brdfs) {
        errors.keep(load_brdf_file(level, brdf, folder, limits));
    }
    for (const GltfUse& use : level.gltfs) {
        Result<GltfScene> scene = load_scene_file(level, use, folder, limits);
        if (!scene) {
            errors.keep(scene.error());
            continue;
        }
        for (const std::string& warning : scene->warnings) {
            log_warn("{}", warning);
        }
        level.scenes.push_back(*std::move(scene));
    }
    LIMN_TRY(errors.status());
    LIMN_TRY(make_meshes(level, limits, makes));
    LIMN_TRY(find_changed_nodes(level));
    return resolve_deferred_names(level);
}

}  // namespace limn
