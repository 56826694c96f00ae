#include "content/app/commands/bake_command.h"

#include "content/app/commands/bake_atlas.h"
#include "content/app/commands/bake_block.h"
#include "content/app/commands/bake_detail.h"
#include "content/app/commands/bake_ghosts.h"
#include "content/app/commands/bake_motion.h"
#include "content/app/commands/bake_photometric.h"
#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/bake_relief.h"
#include "content/app/commands/bake_strain_model.h"
#include "content/app/commands/bake_walk.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/progress.h"
#include "content/bake/furrow_recipe.h"
#include "content/bake/furrow_trace.h"
#include "content/game/game.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "content/load/gltf/gltf_load.h"
#include "content/make/find_kind.h"
#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "render/gpu/context.h"
#include "render/gpu/readback.h"
#include "render/material/furrow_maker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {
namespace {

constexpr int kGutter = 4;  // padding around the charts of an atlas [px]

/// A mesh of the file: the one with this name, or the one with the most triangles.
Result<MeshData> load_mesh(const std::string& path, const std::string& name) {
    register_game_components();
    GltfScene scene = LIMN_TRY(load_gltf(path));
    if (scene.meshes.empty()) {
        return fail("{}: found no mesh, expected at least one", path);
    }
    const auto found = name.empty() ? std::max_element(
                           scene.meshes.begin(), scene.meshes.end(),
                           [](const MeshData& a, const MeshData& b) {
                               return a.indices.size() < b.indices.size();
                           })
                                    : std::find_if(
                                        scene.meshes.begin(), scene.meshes.end(),
                                        [&](const MeshData& mesh) { return mesh.name == name; });
    if (found == scene.meshes.end()) {
        std::vector<std::string_view> names;
        for (const MeshData& mesh : scene.meshes) {
            names.emplace_back(mesh.name);
        }
        return Error{fmt::format(
            "{}: found no mesh {}, expected one of {}{}", path, in_quotes(name),
            fmt::join(names, ", "), did_you_mean(name, names))};
    }
    found->name = fmt::format("{}: mesh {}", path, in_quotes(found->name));
    return std::move(*found);
}

std::vector<std::uint8_t> encode_normals(const std::vector<Vec3>& normals) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * normals.size());
    for (const Vec3& n : normals) {
        for (int c = 0; c < 3; ++c) {
            const float value = std::clamp(0.5f + 0.5f * n[c], 0.0f, 1.0f);
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
        }
    }
    return bytes;
}

Status write_furrow_height(const std::string& path, ImageFileKind kind, const FurrowMaps& maps) {
    const IVec2 size = maps.growth.size;
    if (kind == ImageFileKind::Exr) {
        ExrImage image = {.width = size.x, .height = size.y};
        add_layer(image, "", "Y", maps.height, false);
        add_layer(image, "first", "Y", maps.growth.first, false);
        add_layer(image, "second", "Y", maps.growth.second, false);
        return write_exr(path, image);
    }
    std::vector<std::uint16_t> gray(maps.height.size());
    std::transform(maps.height.begin(), maps.height.end(), gray.begin(), [](float h) {
        return static_cast<std::uint16_t>(std::lround(65535.0f * std::clamp(h, 0.0f, 1.0f)));
    });
    return write_png16(path, size.x, size.y, 1, gray);
}

/// Like make_furrow_maps, in compute shaders.
Result<FurrowMaps> make_furrow_maps_on_gpu(const FurrowMap& map, const FurrowStyle& style) {
    const std::unique_ptr<gpu::Context> context = LIMN_TRY(gpu::create_headless_context());
    const std::unique_ptr<gpu::Device> device = LIMN_TRY(gpu::Device::from_current_context());
    const FurrowMaker maker = LIMN_TRY(create_furrow_maker(*device));
    FurrowMaps maps;
    maps.growth.size = map.size;
    maps.growth.cover = cover_furrow_map(map);
    const FurrowTextures made = make_furrow_textures(*device, maker, map, maps.growth.cover, style);
    const gpu::FloatImage height = gpu::read_floats(made.height);
    const gpu::FloatImage normal = gpu::read_floats(made.normal);
    for (int y = map.size.y - 1; y >= 0; --y) {  // images are read with the last row first
        for (int x = 0; x < map.size.x; ++x) {
            maps.growth.first.push_back(height.at(x, y, 0));
            maps.growth.second.push_back(height.at(x, y, 1));
            maps.height.push_back(height.at(x, y, 2));
            maps.normals.emplace_back(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
        }
    }
    return maps;
}

Status bake_furrows(const BakeOptions& options) {
    const ImageFileKind kind = LIMN_TRY(image_file_kind(options.out));
    FurrowRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    Progress progress("step", 4);
    const MeshData mesh = LIMN_TRY(load_mesh(options.in, options.mesh));
    progress.update(1);
    const FurrowMap map = LIMN_TRY(lay_out_furrows(mesh, recipe));
    progress.update(2);
    FurrowMaps maps = options.gpu ? LIMN_TRY(make_furrow_maps_on_gpu(map, style_of(recipe)))
                                  : make_furrow_maps(map, style_of(recipe));
    add_furrow_gutter(maps, kGutter);
    progress.update(3);
    const std::size_t dot = options.out.rfind('.');
    const std::string stem = options.out.substr(0, dot);
    LIMN_TRY(
        write_png(stem + "_normal.png", map.size.x, map.size.y, 3, encode_normals(maps.normals)));
    LIMN_TRY(write_furrow_height(stem + "_height" + options.out.substr(dot), kind, maps));
    return Done{};
}

constexpr BakeKind kKinds[] = {
    {"ao", "ambient occlusion of a height map or a mesh", bake_occlusion_map},
    {"atlas", "a model whose materials that differ only in their textures are one", bake_atlas,
     ".glb"},
    {"block", "an image in blocks that stay compressed on the GPU, with mip levels", bake_block,
     ".dds"},
    {"cone", "relief map with relaxed cones, for marching in few steps", bake_cone_map},
    {"curves", "plot of the angles of a joint over time", bake_curves, ".svg"},
    {"detail", "normals and occlusion of a detailed mesh for one with few triangles",
     bake_detail_maps},
    {"double-depth", "relief map of a mesh with front and back", bake_double_depth_map},
    {"furrows", "wrinkle furrows of skin along vector fields: height and normal map", bake_furrows},
    {"ghosts", "poses of a motion at equal time steps as one model", bake_ghosts, ".glb"},
    {"motion", "recorded motion without noise, gaps and jumps, with contacts of the feet",
     bake_motion, ".glb or .bvh", true},
    {"normal", "normal map of a height map or a mesh", bake_normal_map},
    {"odd", "what each view ray sees of a tile, by position and direction", bake_odd_map},
    {"photometric", "normals and reflectance from photographs, each under one light",
     bake_photometric},
    {"relief", "normals and depths of a height map or a mesh", bake_relief_map},
    {"retarget", "a motion for another body", bake_retarget, ".glb or .bvh", true},
    {"strain_model", "wrinkles of captured normal maps, as a function of the strain of a face",
     bake_strain_model},
    {"walk", "a generated walk as a clip of a skeleton, in any style, along any way", bake_walk,
     ".glb or .bvh"},
};

}  // namespace

std::span<const BakeKind> bake_kinds() {
    return kKinds;
}

Status run_bake(const BakeOptions& options) {
    const BakeKind* const kind = find_kind(bake_kinds(), options.kind);
    LIMN_CHECK(kind != nullptr);
    const std::size_t dot = options.out.rfind('.');
    const std::string ending = dot == std::string::npos ? "" : options.out.substr(dot);
    if (ending.size() != 4 || std::string_view(kind->endings).find(ending) == std::string::npos) {
        return fail(
            "{}: expected a file name ending in {} for {}", options.out, kind->endings, kind->name);
    }
    if (!options.body.empty() && !kind->has_body) {
        return fail("{}: found a second file, expected one for {}", options.body, kind->name);
    }
    return kind->run(options);
}

}  // namespace limn
