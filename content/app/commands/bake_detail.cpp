#include "content/app/commands/bake_detail.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/map_file.h"
#include "content/app/commands/progress.h"
#include "content/bake/detail_bake.h"
#include "content/bake/tangents.h"
#include "content/load/gltf/gltf_write.h"
#include "content/load/scene_mesh.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <chrono>
#include <string>
#include <utility>

namespace limn {

struct DetailRecipe {
    int size = 1024;
    int samples = 2;
    float distance = 0.02f;
    int padding = 8;
    bool object_space = false;
    int rays = 32;
    float reach = 0.1f;
    int bits = 8;
    bool relief = false;
};

LIMN_FIELDS(DetailRecipe) {
    LIMN_FIELD(size, "width and height of the maps", "px", 1, 8192);
    LIMN_FIELD(samples, "rays per texel along either side", "", 1, 4);
    LIMN_FIELD(
        distance, "search for the high mesh along the normal, of the low mesh's diagonal", "", 1e-6,
        10);
    LIMN_FIELD(padding, "texels by which charts are dilated", "px", 0, 256);
    LIMN_FIELD(object_space, "normals in the space of the mesh; then without a model");
    LIMN_FIELD(rays, "per sample, for occlusion; 0: none", "", 0, 4096);
    LIMN_FIELD(reach, "length of those, of the low mesh's diagonal", "", 1e-4, 100);
    LIMN_FIELD(bits, "of the values in a PNG file, 8 or 16", "", 8, 16);
    LIMN_FIELD(
        relief,
        "also a relief map, and a model whose outline is that of the high mesh: its mesh is moved "
        "out until the high mesh lies below it");
}

namespace {

std::string percent_of(std::size_t part, std::size_t all) {
    return fmt::format("{:.2g} %", 100.0 * static_cast<double>(part) / static_cast<double>(all));
}

void report_detail(const std::string& low, const DetailReport& report) {
    if (report.degenerate > 0) {
        log_info("{}: {} triangles have no area in texture space", low, report.degenerate);
    }
    if (report.outside > 0) {
        log_info("{}: {} triangles reach beyond the map", low, report.outside);
    }
    if (report.overlapping > 0) {
        log_info(
            "{}: charts overlap at {} of the samples; the first triangle counts", low,
            percent_of(report.overlapping, report.covered));
    }
    if (report.from_point > 0) {
        log_info(
            "{}: at {} of the samples no ray met the high mesh, and its nearest point counts", low,
            percent_of(report.from_point, report.covered));
    }
    if (report.missed > 0) {
        log_warn(
            "{}: at {} of the samples nothing of the high mesh is near: raise distance", low,
            percent_of(report.missed, report.covered));
    }
}

/// An image of 8 bits for a glTF file.
ImageData image_of_map(const BakedMap& map, std::string name) {
    ImageData image;
    image.name = std::move(name);
    image.width = map.width;
    image.height = map.height;
    image.pixels = map_bytes(map, 4);
    return image;
}

void add_relief(const DetailRelief& relief, const std::string& name, GltfScene& scene) {
    Material& material = scene.materials.front();
    // A search below the quadric of a vertex misses what is beyond a crease of the mesh: at the
    // outline of a nose there would be holes. Steps are for devices without tessellation.
    material.detail = SurfaceDetail::Displaced;
    material.relief_depth = relief.depth;
    material.relief_steps = 40;
    material.relief_shadow = ReliefShadow::Ray;
    material.relief_texture.image = {static_cast<std::uint32_t>(scene.images.size())};
    scene.images.push_back(image_of_map(relief.map, name + "_relief"));
}

/// The low mesh with its maps.
GltfScene model_with_maps(
    MeshData mesh, const DetailBake& bake, const DetailRelief* relief, const std::string& name) {
    GltfScene scene;
    scene.name = name;
    Material material;
    material.name = name;
    material.metalness = 0;
    material.roughness = 0.6f;
    material.normal_texture.image = {0};
    scene.images.push_back(image_of_map(bake.normal, name + "_normal"));
    if (!bake.occlusion.texels.empty()) {
        material.occlusion_texture.image = {1};
        scene.images.push_back(image_of_map(bake.occlusion, name + "_occlusion"));
    }
    scene.materials.push_back(std::move(material));
    if (relief != nullptr) {
        add_relief(*relief, name, scene);
        move_out(mesh, relief->raised);
    }
    mesh.name = name;
    scene.meshes.push_back(std::move(mesh));
    GltfNode node;
    node.name = name;
    node.parts = {{0, 0}};
    scene.nodes.push_back(std::move(node));
    return scene;
}

}  // namespace

Status bake_detail_maps(const BakeOptions& options) {
    DetailRecipe recipe;
    LIMN_TRY(read_recipe(options, recipe));
    if (options.high.empty()) {
        return fail("{}: found no high mesh, expected --high FILE", options.in);
    }
    MeshData low = LIMN_TRY(load_joined_mesh(options.in, options.mesh));
    const MeshData high = LIMN_TRY(load_joined_mesh(options.high, ""));
    if (low.uvs.empty()) {
        return fail("{}: found no texture coordinates, expected those to bake to", options.in);
    }
    if (low.normals.empty()) {
        generate_normals(low);
    }
    if (low.tangents.empty()) {
        generate_tangents(low);
    }
    const DetailSettings settings = {
        .width = recipe.size,
        .height = recipe.size,
        .samples = recipe.samples,
        .distance = recipe.distance,
        .padding = recipe.padding,
        .object_space = recipe.object_space,
        .occlusion_rays = recipe.rays,
        .occlusion_reach = recipe.reach};
    Progress progress("row", recipe.size);
    const auto begin = std::chrono::steady_clock::now();
    const DetailBake bake =
        LIMN_TRY(bake_detail(low, high, settings, [&](int done) { progress.update(done); }));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    if (bake.report.covered == bake.report.missed) {
        return fail(
            "{}: found nothing of {} within {} of the diagonal, expected it around this mesh: "
            "raise "
            "distance or move one of them",
            options.in, options.high, recipe.distance);
    }
    report_detail(options.in, bake.report);
    log_info(
        "{}: {} x {} from {} triangles to {} in {} s", options.out, recipe.size, recipe.size,
        high.indices.size() / 3, low.indices.size() / 3, fmt::format("{:.1f}", seconds.count()));
    LIMN_TRY(write_map(with_ending(options.out, "normal"), bake.normal, 3, recipe.bits));
    LIMN_TRY(write_map(with_ending(options.out, "height"), bake.height, 1, recipe.bits));
    if (!bake.occlusion.texels.empty()) {
        LIMN_TRY(write_map(with_ending(options.out, "occlusion"), bake.occlusion, 1, recipe.bits));
    }
    if (recipe.object_space) {
        return Done{};
    }
    const std::string stem = options.out.substr(0, options.out.rfind('.'));
    const std::string name = stem.substr(stem.find_last_of('/') + 1);
    if (!recipe.relief) {
        return save_glb(stem + ".glb", model_with_maps(std::move(low), bake, nullptr, name));
    }
    const DetailRelief relief = make_relief(bake);
    LIMN_TRY(write_map(with_ending(options.out, "relief"), relief.map, 4, recipe.bits));
    log_info(
        "{}: the relief is {} m deep below the mesh, which is moved out by {} m", options.out,
        fmt::format("{:.4g}", relief.depth), fmt::format("{:.4g}", relief.raised));
    return save_glb(stem + ".glb", model_with_maps(std::move(low), bake, &relief, name));
}

}  // namespace limn
