#include "content/app/commands/bake_relief.h"

#include "content/app/commands/bake_command.h"
#include "content/app/commands/bake_recipe.h"
#include "content/app/commands/map_file.h"
#include "content/app/commands/progress.h"
#include "content/bake/cone_map.h"
#include "content/bake/height_map.h"
#include "content/bake/occlusion_bake.h"
#include "content/bake/odd_map.h"
#include "content/bake/relief_bake.h"
#include "content/bake/thin_features.h"
#include "content/bake/tile_surface.h"
#include "content/load/files/height_file.h"
#include "content/load/scene_mesh.h"
#include "ecs/base/log.h"
#include "ecs/base/text.h"
#include "ecs/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace limn {

struct ReliefRecipe {
    int size = 512;
    BoxFace face = BoxFace::Front;
    float depth = 0;
    bool repeats = true;
    int samples = 1;
    int rays = 64;
    float reach = 0.25f;
    OddOrder order = OddOrder::Directions;
    int bits = 8;
    bool levels = false;
};

LIMN_FIELDS(ReliefRecipe) {
    LIMN_FIELD(
        size, "width of the map of a mesh; that of heights is as large as their image", "px", 1,
        8192);
    LIMN_FIELD(
        face, .doc = "side of the mesh's box that becomes the map",
        .values = "right left top bottom front back");
    LIMN_FIELD(
        depth,
        "of the relief: between black and white heights, in widths of the map (0: 0.05); of the "
        "box "
        "of a mesh, in meters (0: all of it)",
        "", 0, 1e6);
    LIMN_FIELD(repeats, "the right edge of the map meets the left one, the bottom the top");
    LIMN_FIELD(samples, "rays per texel of a mesh along either side", "", 1, 16);
    LIMN_FIELD(rays, "ao: rays per texel", "", 1, 4096);
    LIMN_FIELD(reach, "ao: length of the rays, in widths of the map", "", 1e-4, 100);
    LIMN_FIELD(
        order, .doc = "odd: blocks of the map are directions or positions",
        .values = "directions positions");
    LIMN_FIELD(bits, "of the values in a PNG file, 8 or 16", "", 8, 16);
    LIMN_FIELD(levels, "relief, double-depth, cone: mip levels, too, as NAME_level1 ...");
}

namespace {

constexpr int kMaxRows = 16384;
constexpr float kUsualDepth = 0.05f;  // of heights, in widths of the map

/// A surface to bake, and its relief map in the layout Single.
struct ReliefSource {
    TileSurface tile;
    HeightMap heights;  ///< of an image
    bool of_mesh = false;
};

Result<ReliefSource> load_source(const BakeOptions& options, const ReliefRecipe& recipe) {
    ReliefSource source;
    if (is_image_name(options.in)) {
        source.heights = LIMN_TRY(load_heights(options.in));
        source.heights.repeats = recipe.repeats;
        HeightMap& map = source.heights;
        const auto [low, high] = std::minmax_element(map.heights.begin(), map.heights.end());
        if (*low < 0 || *high > 1) {
            const Vec2 range = normalize_heights(map);
            log_info(
                "{}: found heights from {} to {}; they become 0 and 1", options.in, range.x,
                range.y);
        }
        source.tile.depth = recipe.depth > 0 ? recipe.depth : kUsualDepth;
        return source;
    }
    const MeshData mesh = LIMN_TRY(load_joined_mesh(options.in, options.mesh));
    source.of_mesh = true;
    source.tile = tile_of(mesh, recipe.face, recipe.depth, recipe.repeats);
    return source;
}

struct ReliefJob {
    ReliefRecipe recipe;
    ReliefSource source;
    BakedMap map;  ///< Single, or Double where asked
};

/// Reads recipe and input and makes the relief map.
Result<ReliefJob> start_relief(const BakeOptions& options, ReliefLayout layout) {
    ReliefJob job;
    LIMN_TRY(read_recipe(options, job.recipe));
    job.source = LIMN_TRY(load_source(options, job.recipe));
    ReliefSource& source = job.source;
    if (!source.of_mesh) {
        if (layout == ReliefLayout::Double) {
            return fail("{}: found heights, expected a mesh, which has a back", options.in);
        }
        job.map = relief_of(source.heights, source.tile.depth);
        return job;
    }
    const int rows = rows_of(source.tile.size, job.recipe.size);
    if (rows > kMaxRows) {
        return fail(
            "{}: found a side that needs {} rows of texels, expected at most {}: choose another "
            "one, --set face=..., or a smaller size",
            options.in, rows, kMaxRows);
    }
    const TileCaster caster(source.tile);
    Progress progress("row", rows);
    ReliefBake bake = bake_relief(
        source.tile, caster, layout, job.recipe.size, job.recipe.samples,
        [&](int done) { progress.update(done); });
    if (bake.empty == bake.map.texels.size()) {
        return fail("{}: found nothing within {} m of this side", options.in, job.recipe.depth);
    }
    if (bake.empty > 0) {
        log_info(
            "{}: nothing is at {} of {} texels; their depth is 1", options.in, bake.empty,
            bake.map.texels.size());
    }
    if (bake.open > 0) {
        log_info(
            "{}: the mesh is open at {} texels; the depth of their back is 1", options.in,
            bake.open);
    }
    job.map = std::move(bake.map);
    return job;
}

/// The map, its mip levels where asked, and what a material needs to know.
Status
finish_relief(const BakeOptions& options, const ReliefJob& job, BakedMap map, ReliefLayout layout) {
    const ReliefRecipe& recipe = job.recipe;
    const float depth = job.source.tile.depth;
    const ThinFeatures thin = find_thin_features(map, recipe.repeats, depth);
    const std::string meters =
        job.source.of_mesh
            ? fmt::format(" (relief_depth {:.4g} m at its size)", depth * job.source.tile.meters)
            : "";
    log_info(
        "{}: {} x {}, depth {} of the width{}; features down to {} of the depth need relief_steps "
        "{}",
        options.out, map.width, map.height, fmt::format("{:.4g}", depth), meters,
        fmt::format("{:.3g}", thin.typical), thin.steps);
    LIMN_TRY(write_map(options.out, map, 4, recipe.bits));
    for (int level = 1; recipe.levels && (map.width > 1 || map.height > 1); ++level) {
        map = next_relief_level(map, layout);
        LIMN_TRY(write_map(
            with_ending(options.out, fmt::format("level{}", level)), map, 4, recipe.bits));
    }
    return Done{};
}

/// What rays for ao and odd are cast at: the mesh itself, or the heights as a mesh.
TileSurface tile_to_cast(const ReliefJob& job) {
    return job.source.of_mesh ? job.source.tile
                              : tile_of(job.source.heights, job.source.tile.depth);
}

}  // namespace

Status bake_normal_map(const BakeOptions& options) {
    const ReliefJob job = LIMN_TRY(start_relief(options, ReliefLayout::Single));
    return write_map(options.out, job.map, 3, job.recipe.bits);
}

Status bake_relief_map(const BakeOptions& options) {
    const ReliefJob job = LIMN_TRY(start_relief(options, ReliefLayout::Single));
    return finish_relief(options, job, job.map, ReliefLayout::Single);
}

Status bake_double_depth_map(const BakeOptions& options) {
    const ReliefJob job = LIMN_TRY(start_relief(options, ReliefLayout::Double));
    return finish_relief(options, job, job.map, ReliefLayout::Double);
}

Status bake_cone_map(const BakeOptions& options) {
    const ReliefJob job = LIMN_TRY(start_relief(options, ReliefLayout::Single));
    Progress progress("row", job.map.height);
    BakedMap cones =
        make_cone_map(job.map, job.recipe.repeats, [&](int done) { progress.update(done); });
    return finish_relief(options, job, std::move(cones), ReliefLayout::Cone);
}

Status bake_occlusion_map(const BakeOptions& options) {
    const ReliefJob job = LIMN_TRY(start_relief(options, ReliefLayout::Single));
    const TileSurface tile = tile_to_cast(job);
    const TileCaster caster(tile);
    Progress progress("row", job.map.height);
    const BakedMap map = bake_occlusion(
        tile, caster, job.map.width, job.map.height, job.recipe.rays, job.recipe.reach,
        [&](int done) { progress.update(done); });
    return write_map(options.out, map, 1, job.recipe.bits);
}

Status bake_odd_map(const BakeOptions& options) {
    ReliefJob job;
    LIMN_TRY(read_recipe(options, job.recipe));
    job.source = LIMN_TRY(load_source(options, job.recipe));
    const TileSurface tile = tile_to_cast(job);
    const TileCaster caster(tile);
    Progress progress("row", kOddPositions * kOddDirections);
    const BakedMap map =
        bake_odd(tile, caster, job.recipe.order, [&](int done) { progress.update(done); });
    LIMN_TRY(write_map(options.out, map, 4, job.recipe.bits));
    return write_map(with_ending(options.out, "index"), make_odd_index_map(), 4, job.recipe.bits);
}

}  // namespace limn
