#include "content/bake/scene_atlas.h"

#include "content/bake/texture_atlas.h"
#include "content/load/gltf/gltf_layers.h"
#include "content/load/level/component_json.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <utility>

// Techniques: engine.texture-atlas

namespace limn {
namespace {

constexpr float kOutside = 1e-4f;  // texture coordinates beyond 0 and 1 that are rounding

/// The images of a material, by slot; kNoAsset where it has none.
using SlotImages = std::array<std::uint32_t, std::size(kGltfSlots)>;

SlotImages images_of(const Material& material) {
    SlotImages images{};
    for (std::size_t i = 0; i < images.size(); ++i) {
        images[i] = (material.*kGltfSlots[i]).image.index;
    }
    return images;
}

bool has_texture(const Material& material) {
    return std::ranges::any_of(
        images_of(material), [](std::uint32_t image) { return image != kNoAsset; });
}

/// Equal for materials that differ in their names and images only.
std::string kind_of(const GltfScene& scene, Material material) {
    std::string kind;
    for (TextureSlot Material::*const slot : kGltfSlots) {
        TextureSlot& texture = material.*slot;
        const std::uint32_t image = texture.image.index;
        kind += image == kNoAsset ? '-' : scene.images[image].srgb ? 'c' : 'd';
        texture.image = {};
        texture.wrap_u = texture.wrap_v = Wrap::Repeat;  // within 0 .. 1
    }
    material.name.clear();
    return kind + write_json(write_component(component_info<Material>(), &material, {}));
}

/// Why the material cannot be in an atlas; empty: it can.
std::string obstacle(const GltfScene& scene, std::uint32_t number) {
    const Material& material = scene.materials[number];
    for (TextureSlot Material::*const slot : kExtraSlots) {
        if ((material.*slot).image.index != kNoAsset) {
            return "found a relief, detail, wrinkle or light map, expected maps of glTF";
        }
    }
    for (TextureSlot Material::*const slot : kGltfSlots) {
        const TextureSlot& texture = material.*slot;
        if (texture.image.index == kNoAsset) {
            continue;
        }
        const ImageData& image = scene.images[texture.image.index];
        if (image.format != PixelFormat::Rgba8) {
            return fmt::format(
                "found the image {} in blocks or floats, expected 8 bits", in_quotes(image.name));
        }
        if (texture.uv_set != 0 || texture.offset != Vec2(0) || texture.scale != Vec2(1)
            || texture.rotation != 0) {
            return fmt::format(
                "found a texture transform or TEXCOORD_1 with the image {}, expected neither",
                in_quotes(image.name));
        }
    }
    for (const GltfNode& node : scene.nodes) {
        for (const GltfPart& part : node.parts) {
            if (part.material != number) {
                continue;
            }
            const MeshData& mesh = scene.meshes[part.mesh];
            if (mesh.uvs.empty()) {
                return fmt::format(
                    "found no texture coordinates in the mesh {}", in_quotes(mesh.name));
            }
            for (const Vec2& uv : mesh.uvs) {
                if (!(std::min(uv.x, uv.y) >= -kOutside && std::max(uv.x, uv.y) <= 1 + kOutside)) {
                    return fmt::format(
                        "found texture coordinates ({:.4g}, {:.4g}) in the mesh {}, expected 0 to "
                        "1: an atlas cannot tile",
                        uv.x, uv.y, in_quotes(mesh.name));
                }
            }
        }
    }
    return {};
}

/// Gives what has a material of `cells` (by number) the material `merged`, and a copy of its mesh
/// with texture coordinates in that cell.
void move_into_cells(
    GltfScene& scene, const AtlasLayout& layout, const std::map<std::uint32_t, std::size_t>& cells,
    std::uint32_t merged) {
    std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t> moved;  // by mesh and cell
    for (GltfNode& node : scene.nodes) {
        for (GltfPart& part : node.parts) {
            const auto cell = cells.find(part.material);
            if (cell == cells.end()) {
                continue;
            }
            const auto [at, is_new] = moved.try_emplace({part.mesh, cell->second}, part.mesh);
            if (is_new) {
                MeshData mesh = scene.meshes[part.mesh];
                const AtlasCell rect = atlas_cell(layout, cell->second);
                for (Vec2& uv : mesh.uvs) {
                    uv = rect.offset + rect.scale * glm::clamp(uv, Vec2(0), Vec2(1));
                }
                at->second = static_cast<std::uint32_t>(scene.meshes.size());
                scene.meshes.push_back(std::move(mesh));
            }
            part.mesh = at->second;
            part.material = merged;
        }
    }
}

/// The textures of the members as atlases of the first of them.
void merge_group(
    GltfScene& scene, std::span<const std::uint32_t> group, const SceneAtlasOptions& options,
    SceneAtlasReport& report) {
    std::map<SlotImages, std::size_t> cell_of;
    std::vector<SlotImages> textures;
    std::map<std::uint32_t, std::size_t> cells;
    int largest = 1;
    for (const std::uint32_t member : group) {
        const SlotImages images = images_of(scene.materials[member]);
        const auto [at, is_new] = cell_of.try_emplace(images, textures.size());
        if (is_new) {
            textures.push_back(images);
        }
        cells[member] = at->second;
        for (const std::uint32_t image : images) {
            if (image != kNoAsset) {
                largest =
                    std::max({largest, scene.images[image].width, scene.images[image].height});
            }
        }
    }
    if (textures.size() == 1) {  // the same material several times
        for (GltfNode& node : scene.nodes) {
            for (GltfPart& part : node.parts) {
                part.material = cells.contains(part.material) ? group.front() : part.material;
            }
        }
        return;
    }
    const AtlasLayout layout =
        lay_out_atlas(textures.size(), largest, options.max_size, options.gutter);
    if (layout.cell < largest) {
        report.notes.push_back(fmt::format(
            "textures of up to {} pixels have {} in the atlas, whose sides are at most {}", largest,
            layout.cell, options.max_size));
    }
    Material merged = scene.materials[group.front()];
    std::map<std::vector<std::uint32_t>, std::uint32_t> made;  // slots with the same images share
    for (std::size_t slot = 0; slot < std::size(kGltfSlots); ++slot) {
        TextureSlot& texture = merged.*kGltfSlots[slot];
        if (texture.image.index == kNoAsset) {
            continue;
        }
        std::vector<std::uint32_t> images;
        std::vector<const ImageData*> sources;
        for (const SlotImages& of : textures) {
            images.push_back(of[slot]);
            sources.push_back(&scene.images[of[slot]]);
        }
        const auto [at, is_new] =
            made.try_emplace(images, static_cast<std::uint32_t>(scene.images.size()));
        if (is_new) {
            ImageData atlas = make_atlas(layout, sources);
            atlas.name = fmt::format("atlas of {}", scene.images[images.front()].name);
            scene.images.push_back(std::move(atlas));
        }
        texture.image.index = at->second;
        texture.wrap_u = texture.wrap_v = Wrap::Clamp;
        texture.lod_range.y =
            std::min(texture.lod_range.y, static_cast<float>(last_atlas_level(layout)));
    }
    const std::uint32_t first = group.front();
    scene.materials[first] = std::move(merged);
    move_into_cells(scene, layout, cells, first);
}

/// Removes meshes, materials and images that no node has, which must have no components.
void drop_unused(GltfScene& scene) {
    std::vector<std::uint32_t> mesh_number(scene.meshes.size(), kNoAsset);
    std::vector<std::uint32_t> material_number(scene.materials.size(), kNoAsset);
    std::vector<std::uint32_t> image_number(scene.images.size(), kNoAsset);
    std::vector<MeshData> meshes;
    std::vector<Material> materials;
    std::vector<ImageData> images;
    const auto take = [](auto& from, auto& to, auto& numbers, std::uint32_t& index) {
        if (index != kNoAsset && numbers[index] == kNoAsset) {
            numbers[index] = static_cast<std::uint32_t>(to.size());
            to.push_back(std::move(from[index]));
        }
        index = index != kNoAsset ? numbers[index] : index;
    };
    for (GltfNode& node : scene.nodes) {
        for (GltfPart& part : node.parts) {
            take(scene.meshes, meshes, mesh_number, part.mesh);
            take(scene.materials, materials, material_number, part.material);
        }
    }
    for (Material& material : materials) {
        const auto number = [&](TextureSlot Material::*slot) {
            take(scene.images, images, image_number, (material.*slot).image.index);
        };
        std::ranges::for_each(kGltfSlots, number);
        std::ranges::for_each(kExtraSlots, number);
    }
    scene.meshes = std::move(meshes);
    scene.materials = std::move(materials);
    scene.images = std::move(images);
}

}  // namespace

SceneAtlasReport merge_materials(GltfScene& scene, const SceneAtlasOptions& options) {
    drop_unused(scene);
    SceneAtlasReport report;
    report.materials_before = scene.materials.size();
    report.images_before = scene.images.size();
    std::map<std::string, std::vector<std::uint32_t>> groups;
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
        if (has_texture(scene.materials[i])) {
            groups[kind_of(scene, scene.materials[i])].push_back(i);
        }
    }
    for (auto& [kind, group] : groups) {
        if (group.size() < 2) {
            continue;
        }
        std::erase_if(group, [&](std::uint32_t number) {
            const std::string why = obstacle(scene, number);
            if (!why.empty()) {
                report.notes.push_back(fmt::format(
                    "material {}: {}; it keeps its textures",
                    in_quotes(scene.materials[number].name), why));
            }
            return !why.empty();
        });
        if (group.size() > 1) {
            merge_group(scene, group, options, report);
        }
    }
    drop_unused(scene);
    report.materials = scene.materials.size();
    report.images = scene.images.size();
    return report;
}

}  // namespace limn
