#include "content/bake/furrow_skin.h"

#include "content/bake/furrow_field.h"
#include "content/bake/furrow_height.h"
#include "content/bake/furrow_map.h"
#include "content/bake/furrow_presets.h"
#include "content/bake/furrow_recipe.h"
#include "ecs/base/jobs.h"
#include "ecs/base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

// Techniques: wrinkle.furrow.editor

namespace limn {
namespace {

constexpr int kSkinGutter = 4;  // around the charts of an atlas [px]

/// Why the images of `furrows` cannot be written, or nothing.
std::string image_fault(const Furrows& furrows, const Assets& assets) {
    const auto fault = [&assets](const char* field, ImageId id, int size) -> std::string {
        if (id.index >= assets.images.size()) {
            return fmt::format("furrows.{}: found no image, expected one to write to", field);
        }
        const ImageData& image = assets.images[id.index];
        const bool fits = image.width == image.height && image.width <= kMaxFurrowSize
                          && (size == 0 || image.width == size)
                          && image.format == PixelFormat::Rgba8 && !image.srgb;
        if (fits) {
            return {};
        }
        return fmt::format(
            "furrows.{} \"{}\": found {} x {} px{}, expected a square of {} without, 8 bits a "
            "channel",
            field, image.name, image.width, image.height, image.srgb ? " of sRGB colors" : "",
            size == 0 ? fmt::format("1 .. {} px", kMaxFurrowSize) : fmt::format("{} px", size));
    };
    std::string found = fault("normals", furrows.normals, 0);
    if (found.empty() && furrows.heights.index != kNoAsset) {
        found = fault("heights", furrows.heights, assets.images[furrows.normals.index].width);
    }
    return found;
}

std::string mesh_fault(const MeshData& mesh) {
    const std::size_t vertices = mesh.positions.size();
    if (mesh.uvs.size() == vertices && mesh.normals.size() == vertices && vertices > 0) {
        return {};
    }
    return fmt::format(
        "{}: found {} vertices, {} normals and {} texture coordinates, expected as many of each",
        mesh.name, vertices, mesh.normals.size(), mesh.uvs.size());
}

/// The displayed fields: edited vertices have their own, others are interpolated from the arrows.
void show_field(FurrowSkin& skin, const Furrows& furrows, const MeshData& mesh) {
    const auto spread = place_furrow_arrows(spread_arrows(furrows), mesh.positions, mesh.normals);
    skin.field = make_furrow_field(mesh.positions, mesh.normals, spread);
    skin.edited.clear();
    for (const FurrowEdit& edit :
         place_furrow_arrows(furrows.arrows, mesh.positions, mesh.normals)) {
        skin.field[edit.vertex] = edit.vectors;
        skin.edited.push_back(edit.vertex);
    }
}

float mean_edge_length(const MeshData& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        sum += static_cast<double>(
            glm::distance(mesh.positions[mesh.indices[i]], mesh.positions[mesh.indices[next]]));
    }
    return mesh.indices.empty()
               ? 0.0f
               : static_cast<float>(sum / static_cast<double>(mesh.indices.size()));
}

std::uint8_t byte_of(float value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f));
}

/// RGBA of an image; write(pixel, its bytes) sets three of them.
template <typename Write>
std::vector<std::uint8_t> make_pixels(std::size_t pixels, const Write& write) {
    std::vector<std::uint8_t> image(4 * pixels, 255);
    parallel_for(pixels, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            write(i, &image[4 * i]);
        }
    });
    return image;
}

void make_images(FurrowSkin& skin) {
    FurrowMaps maps = {.growth = skin.growth, .height = skin.height, .normals = {}};
    maps.normals =
        make_furrow_normals(skin.map, maps.growth, maps.height, grown_style(skin.source).bump);
    if (!skin.source.tiles) {
        add_furrow_gutter(maps, kSkinGutter);
    }
    const std::size_t pixels = maps.height.size();
    skin.normals = make_pixels(pixels, [&](std::size_t i, std::uint8_t* texel) {
        const Vec3 n = skin.flat ? Vec3(0, 0, 1) : maps.normals[i];
        for (int c = 0; c < 3; ++c) {
            texel[c] = byte_of(0.5f + 0.5f * n[c]);
        }
    });
    skin.heights = make_pixels(pixels, [&](std::size_t i, std::uint8_t* texel) {
        texel[0] = texel[1] = texel[2] = byte_of(skin.flat ? 1.0f : maps.height[i]);
    });
}

}  // namespace

const std::vector<FurrowArrow>& spread_arrows(const Furrows& furrows) {
    return furrows.hold.waits ? furrows.hold.spread : furrows.arrows;
}

const std::vector<FurrowArrow>& grown_arrows(const Furrows& furrows) {
    return furrows.hold.waits ? furrows.hold.grown : furrows.arrows;
}

const FurrowStyle& grown_style(const Furrows& furrows) {
    return furrows.hold.waits ? furrows.hold.style : furrows.style;
}

void update_furrow_skin(
    FurrowSkin& skin, const Furrows& furrows, const MeshData& mesh, int size, bool flat) {
    const FurrowStyle& style = grown_style(furrows);
    const FurrowStyle& old_style = grown_style(skin.source);
    const bool fresh = skin.field.size() != mesh.positions.size()
                       || skin.mesh_version != mesh.version || !skin.fault.empty()
                       || skin.growth.size != IVec2(size) || skin.source.tiles != furrows.tiles;
    show_field(skin, furrows, mesh);
    skin.spacing = fresh ? mean_edge_length(mesh) : skin.spacing;
    if (fresh || grown_arrows(skin.source) != grown_arrows(furrows)
        || needs_growth(old_style, style)) {
        FurrowRecipe recipe = {.size = size, .tiles = furrows.tiles};
        recipe.arrows = grown_arrows(furrows);
        Result<FurrowMap> map = lay_out_furrows(mesh, recipe);
        skin.fault = map ? std::string() : map.error().message;
        if (map) {
            skin.map = *std::move(map);
            skin.growth = grow_furrows(skin.map, style);
        }
    }
    skin.source = furrows;
    skin.mesh_version = mesh.version;
    skin.flat = flat;
    if (skin.fault.empty()) {
        skin.height = add_furrow_noise(skin.growth, style);
        make_images(skin);
    }
    ++skin.version;
}

void update_furrow_skins(
    Query<const Furrows, const MeshInstance> furrows, Query<FurrowSkin> skins,
    Query<const FurrowView> views, Res<const Assets> assets, Commands commands) {
    const Assets& known = *assets;
    furrows.each([&](Entity entity, const Furrows& source, const MeshInstance& instance) {
        if (instance.mesh.index >= known.meshes.size()) {
            return;
        }
        const MeshData& mesh = known.meshes[instance.mesh.index];
        const FurrowView* const view = views.find<const FurrowView>(entity);
        const bool flat = view != nullptr && view->mode == FurrowMode::Overview;
        FurrowSkin* const made = skins.find<FurrowSkin>(entity);
        if (made != nullptr && made->mesh == instance.mesh && made->mesh_version == mesh.version
            && made->flat == flat && made->source == source) {
            return;
        }
        FurrowSkin fresh;
        FurrowSkin& skin = made != nullptr ? *made : fresh;
        std::string fault = image_fault(source, known);
        fault = fault.empty() ? mesh_fault(mesh) : fault;
        if (!fault.empty() || skin.mesh != instance.mesh) {
            const std::uint32_t version = skin.version;
            skin = {};
            skin.version = version;
        }
        if (fault.empty()) {
            const int size = known.images[source.normals.index].width;
            update_furrow_skin(skin, source, mesh, size, flat);
        } else {
            skin.source = source;
            skin.mesh_version = mesh.version;
            skin.flat = flat;
            skin.fault = fault;
            ++skin.version;
        }
        skin.mesh = instance.mesh;
        if (!skin.fault.empty()) {
            log_warn("{}", skin.fault);
        }
        if (made == nullptr) {
            commands.add(entity, std::move(fresh));
        }
    });
}

}  // namespace limn
