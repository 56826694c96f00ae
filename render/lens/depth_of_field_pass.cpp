#include "render/lens/depth_of_field_pass.h"

#include "render/fullscreen.h"
#include "render/lens/lens_depth.h"
#include "render/render_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

// Techniques: particle.depth-of-field, post.circle-of-confusion, post.dof-mip

namespace limn {
namespace {

constexpr int kLuminanceLevels = 6;

/// Kinds of tiles, bits of depth_of_field_tile.vert.
enum TileKind : int {
    kSharpTiles = 1,
    kSlightTiles = 2,
    kBlurredTiles = 4,
    kBlurredSlightTiles = 8,
    kAnyBlurred = kBlurredTiles | kBlurredSlightTiles,
};

// ---- the uniform block of a lens ----

/// Maximum diameter of a disc [px].
int widest_circle(const RenderView& view) {
    return static_cast<int>(view.lens.max_blur * static_cast<float>(view.height));
}

/// Point on the rim of the unit aperture at the fraction `turn` of a revolution.
Vec2 rim(const LensView& lens, float turn) {
    if (lens.blades < 3) {
        return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn)};
    }
    return point_on_aperture(lens, {turn, 1});
}

/// Radius of the scaled aperture through `place`; 1 at the rim of the unit aperture.
float radius_of_aperture(const LensView& lens, const Vec2& place) {
    if (lens.blades < 3) {
        return length(place);
    }
    const float slice = 2 * kPi / static_cast<float>(lens.blades);
    const float angle = std::atan2(place.y, place.x) - lens.blade_rotation;
    const float from_middle = angle - (std::floor(angle / slice) + 0.5f) * slice;
    return length(place) * std::cos(from_middle) / std::cos(0.5f * slice);
}

/// A grid point, and the radius of the disc or aperture through it.
struct GridPlace {
    IVec2 at;
    float radius = 0;
};

/// Grid points within `extent`, sorted by radius.
template <typename RadiusOf>
std::vector<GridPlace> places_around(int extent, RadiusOf&& radius_of) {
    std::vector<GridPlace> places;
    for (int y = -extent; y <= extent; ++y) {
        for (int x = -extent; x <= extent; ++x) {
            places.push_back({{x, y}, radius_of(Vec2(x, y))});
        }
    }
    std::stable_sort(places.begin(), places.end(), [](const GridPlace& a, const GridPlace& b) {
        return a.radius < b.radius;
    });
    return places;
}

/// Grid coverage of a disc of `radius` with a soft rim of width 1, and its variance per axis.
struct Coverage {
    float area = 0;
    float variance = 0;
};

Coverage coverage_of(const std::vector<GridPlace>& places, float radius) {
    float area = 0;
    Vec2 middle = Vec2(0);
    float square = 0;
    for (const GridPlace& place : places) {
        const float covered = std::clamp(radius + 0.5f - place.radius, 0.0f, 1.0f);
        const Vec2 at = Vec2(place.at);
        area += covered;
        middle += covered * at;
        square += covered * dot(at, at);
    }
    middle /= area;
    return {area, 0.5f * (square / area - dot(middle, middle))};
}

void fill_small_circles(layout::FocusBlock& block) {
    const std::vector<GridPlace> places =
        places_around(3, [](const Vec2& at) { return length(at); });
    for (int i = 0; i < layout::kSlightTaps; ++i) {
        block.pixel[i] = Vec4(places[i].at, places[i].radius, 0);
    }
    for (int i = 0; i < layout::kAreas; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kSlightStep);
        block.area[i / 4][i % 4] = 1 / coverage_of(places, radius).area;
    }
}

/// Kernels at half resolution, whose discs together with all other blur are as wide as the circles.
void fill_kernels(const LensView& lens, layout::FocusBlock& block) {
    constexpr float kTents = 1.5f;     // variance of down- and upsampling [px^2]
    constexpr float kRim = 5.0f / 12;  // added to the squared radius by a rim of width 1
    constexpr float kFromLattice =
        6.0f;  // circle [px] from which the continuous area is accurate enough
    const float shape = block.aperture.w;
    const std::vector<GridPlace> places =
        places_around(5, [&](const Vec2& at) { return radius_of_aperture(lens, at); });
    for (int i = 0; i < layout::kFineTaps; ++i) {
        block.texel[i] = Vec4(places[i].at, places[i].radius, 0);
    }
    const float less = kRim + 0.25f * kTents / shape;
    const auto beyond = [&](float radius) {
        return std::sqrt(std::max(0.25f * radius * radius - less, 0.25f));
    };
    float kernel = 0.5f;
    for (int i = 0; i < layout::kKernels; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kKernelStep);
        const float target = 0.25f * (shape * radius * radius - kTents);
        while (kernel < beyond(kFromLattice) && coverage_of(places, kernel).variance < target) {
            kernel += 1.0f / 64;
        }
        const float sigma = radius < kFromLattice ? kernel : beyond(radius);
        block.kernel[i / 2][2 * (i % 2)] = sigma;
        block.kernel[i / 2][2 * (i % 2) + 1] = 1 / coverage_of(places, sigma).area;
    }
}

// ---- the passes ----

/// The textures between the passes.
struct FocusTextures {
    IVec2 half;
    IVec2 quarter;
    TextureId tiles;
    TextureId slight_tiles;
    TextureId near_reach;
    TextureId packed;
    TextureId far_light;  ///< half resolution
    TextureId near_light;
    TextureId far_kernels;
    TextureId near_kernels;
    TextureId far_wide;
    TextureId near_wide;
    TextureId wide_radii;
    TextureId behind_near;
    TextureId far_rest;  ///< quarter resolution
    TextureId near_rest;
    TextureId rest_radii;
    TextureId behind;
    TextureId far_coarse;
    TextureId near_coarse;
    TextureId near_radius;
    TextureId far_blurred;  ///< half resolution
    TextureId near_blurred;
};

int levels_of(const IVec2& size, int max_levels) {
    return std::min(gpu::full_level_count(size.x, size.y), max_levels);
}

/// Adds the passes in order.
class Drawing {
  public:
    Drawing(FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, GLenum format)
        : graph_(graph), pass_(pass), block_(make_focus_block(view)), format_(format),
          size_(view.width, view.height) {
        made_.half = half_resolution(size_);
        made_.quarter = half_resolution(made_.half);
    }

    TextureId through_lens(TextureId radiance, TextureId depth);
    TextureId by_mips(TextureId radiance, TextureId depth);

  private:
    TextureId create(const char* name, GLenum format, const IVec2& size, int levels = 1) {
        return graph_.create(
            {.name = name, .format = format, .width = size.x, .height = size.y, .levels = levels});
    }
    GLenum pair_format() const { return format_ == GL_RGBA32F ? GL_RG32F : GL_RG16F; }
    int tile_count() const { return block_.tiles.x * block_.tiles.y; }

    void find_tiles(TextureId depth);
    void split(TextureId radiance, TextureId depth);
    void extract_highlights();
    void fill_levels(TextureId texture, int levels);
    void gather_coarse();
    void gather();
    TextureId compose(TextureId radiance);
    void draw_discs(TextureId composed, TextureId depth);

    FrameGraph& graph_;
    DepthOfFieldPass& pass_;
    layout::FocusBlock block_;
    GLenum format_;
    IVec2 size_;
    FocusTextures made_;
};

void use_fullscreen(PassContext& context, const gpu::Program* program, const gpu::Buffer& focus) {
    context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
    context.device().bind_uniforms(layout::kFocusBinding, focus);
}

/// Draws `program` over the tiles of any of `kinds`; the targets cover `cover` pixels of the
/// full-resolution image.
void draw_tiles(
    PassContext& context, const gpu::Program* program, const gpu::Buffer& focus, int kinds,
    const IVec2& cover, int tiles) {
    use_fullscreen(context, program, focus);
    program->set("kind", kinds);
    program->set("target_size", Vec2(cover));
    context.device().draw(GL_TRIANGLE_STRIP, 0, 4, tiles);
}

void bind_tiles(PassContext& context, const FocusTextures& made) {
    context.bind_texture(layout::kFocusTilesUnit, made.tiles);
    context.bind_texture(layout::kFocusSlightTilesUnit, made.slight_tiles);
}

void Drawing::find_tiles(TextureId depth) {
    const IVec2 count = {block_.tiles.x, block_.tiles.y};
    const IVec2 block_count = layout::kFocusTile / layout::kFocusBlock * count;
    const TextureId blocks = create("focus.blocks", GL_RGBA16F, block_count);
    const TextureId small_of_blocks = create("focus.small of blocks", GL_RG16F, block_count);
    graph_.add_pass(
        "focus.blocks", {depth}, {discarded(blocks), discarded(small_of_blocks)},
        [&pass = pass_, block = block_, depth](PassContext& context) {
            pass.focus.write(0, std::span(&block, 1));
            use_fullscreen(context, pass.blocks, pass.focus);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.device().draw_fullscreen();
        });
    made_.near_reach = create("focus.near reach", GL_R16F, block_count);
    graph_.add_pass(
        "focus.spread", {small_of_blocks}, {discarded(made_.near_reach)},
        [&pass = pass_, small_of_blocks](PassContext& context) {
            use_fullscreen(context, pass.spread, pass.focus);
            context.bind_texture(layout::kFocusSmallBlocksUnit, small_of_blocks);
            context.device().draw_fullscreen();
        });
    const TextureId own = create("focus.own tiles", GL_RGBA16F, count);
    const TextureId small = create("focus.own small", GL_RG16F, count);
    graph_.add_pass(
        "focus.tiles", {blocks, small_of_blocks}, {discarded(own), discarded(small)},
        [&pass = pass_, blocks, small_of_blocks](PassContext& context) {
            use_fullscreen(context, pass.tiles, pass.focus);
            context.bind_texture(layout::kFocusBlocksUnit, blocks);
            context.bind_texture(layout::kFocusSmallBlocksUnit, small_of_blocks);
            context.device().draw_fullscreen();
        });
    made_.tiles = create("focus.tiles", GL_RGBA16F, count);
    made_.slight_tiles = create("focus.slight tiles", GL_RG16F, count);
    graph_.add_pass(
        "focus.reach", {own, small}, {discarded(made_.tiles), discarded(made_.slight_tiles)},
        [&pass = pass_, own, small](PassContext& context) {
            use_fullscreen(context, pass.reach, pass.focus);
            context.bind_texture(layout::kFocusOwnTilesUnit, own);
            context.bind_texture(layout::kFocusOwnSmallUnit, small);
            context.device().draw_fullscreen();
        });
}

void Drawing::split(TextureId radiance, TextureId depth) {
    made_.packed = create("focus.packed", format_, size_);
    graph_.add_pass(
        "focus.pack", {radiance, depth}, {discarded(made_.packed)},
        [&pass = pass_, radiance, depth](PassContext& context) {
            use_fullscreen(context, pass.pack, pass.focus);
            context.bind_texture(layout::kFocusRadianceUnit, radiance);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.device().draw_fullscreen();
        });
    made_.far_light = create("focus.far", format_, made_.half);
    made_.near_light = create("focus.near", format_, made_.half);
    made_.far_kernels = create("focus.far kernels", format_, made_.half);
    made_.near_kernels = create("focus.near kernels", pair_format(), made_.half);
    made_.far_wide = create("focus.far wide", format_, made_.half);
    made_.near_wide = create("focus.near wide", format_, made_.half);
    made_.wide_radii = create("focus.wide radii", pair_format(), made_.half);
    made_.behind_near = create("focus.behind near", format_, made_.half);
    graph_.add_pass(
        "focus.split", {made_.packed, made_.tiles, made_.slight_tiles},
        {cleared(made_.far_light), cleared(made_.near_light), cleared(made_.far_kernels),
         cleared(made_.near_kernels), cleared(made_.far_wide), cleared(made_.near_wide),
         cleared(made_.wide_radii), cleared(made_.behind_near)},
        [&pass = pass_, made = made_, count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusPackedUnit, made.packed);
            bind_tiles(context, made);
            draw_tiles(context, pass.split, pass.focus, kAnyBlurred, 2 * made.half, count);
        });
}

void Drawing::fill_levels(TextureId texture, int levels) {
    if (levels > 1) {
        graph_.add_pass("focus.levels", {}, {image(texture)}, [texture](PassContext& context) {
            glGenerateTextureMipmap(context.texture(texture).id());
        });
    }
}

void Drawing::extract_highlights() {
    const int luminance_levels = levels_of(made_.quarter, kLuminanceLevels);
    const TextureId luminance =
        create("focus.luminance", GL_RG32F, made_.quarter, luminance_levels);
    graph_.add_pass(
        "focus.light", {made_.near_light, made_.near_wide, made_.behind_near},
        {target_level(discarded(luminance), 0)},
        [&pass = pass_, made = made_](PassContext& context) {
            use_fullscreen(context, pass.light, pass.focus);
            context.bind_texture(layout::kFocusNearLightUnit, made.near_light);
            context.bind_texture(layout::kFocusNearWideUnit, made.near_wide);
            context.bind_texture(layout::kFocusBehindNearUnit, made.behind_near);
            context.device().draw_fullscreen();
        });
    fill_levels(luminance, luminance_levels);

    const int levels = levels_of(made_.quarter, std::max(block_.tiles.w, 1));
    const int hidden_levels = gpu::full_level_count(made_.quarter.x, made_.quarter.y);
    made_.far_rest = create("focus.far rest", format_, made_.quarter, levels);
    made_.near_rest = create("focus.near rest", format_, made_.quarter, levels);
    made_.rest_radii = create("focus.rest radii", pair_format(), made_.quarter, levels);
    made_.behind = create("focus.behind", format_, made_.quarter, hidden_levels);
    graph_.add_pass(
        "focus.rest",
        {made_.far_wide, made_.near_wide, made_.wide_radii, made_.behind_near, luminance},
        {target_level(discarded(made_.far_rest), 0), target_level(discarded(made_.near_rest), 0),
         target_level(discarded(made_.rest_radii), 0), target_level(discarded(made_.behind), 0)},
        [&pass = pass_, made = made_, luminance](PassContext& context) {
            use_fullscreen(context, pass.rest, pass.focus);
            context.bind_texture(layout::kFocusFarWideUnit, made.far_wide);
            context.bind_texture(layout::kFocusNearWideUnit, made.near_wide);
            context.bind_texture(layout::kFocusWideRadiiUnit, made.wide_radii);
            context.bind_texture(layout::kFocusBehindNearUnit, made.behind_near);
            context.bind_texture(layout::kFocusLuminanceUnit, luminance);
            context.device().draw_fullscreen();
        });
    fill_levels(made_.far_rest, levels);
    fill_levels(made_.near_rest, levels);
    fill_levels(made_.rest_radii, levels);
    fill_levels(made_.behind, hidden_levels);
}

void Drawing::gather_coarse() {
    made_.far_coarse = create("focus.far coarse", format_, made_.quarter);
    made_.near_coarse = create("focus.near coarse", format_, made_.quarter);
    made_.near_radius = create("focus.near radius", GL_R16F, made_.quarter);
    graph_.add_pass(
        "focus.coarse", {made_.far_rest, made_.near_rest, made_.rest_radii, made_.tiles},
        {discarded(made_.far_coarse), discarded(made_.near_coarse), discarded(made_.near_radius)},
        [&pass = pass_, made = made_](PassContext& context) {
            use_fullscreen(context, pass.coarse, pass.focus);
            context.bind_texture(layout::kFocusFarRestUnit, made.far_rest);
            context.bind_texture(layout::kFocusNearRestUnit, made.near_rest);
            context.bind_texture(layout::kFocusRestRadiiUnit, made.rest_radii);
            context.bind_texture(layout::kFocusTilesUnit, made.tiles);
            context.device().draw_fullscreen();
        });
}

void Drawing::gather() {
    made_.far_blurred = create("focus.far blurred", format_, made_.half);
    made_.near_blurred = create("focus.near blurred", format_, made_.half);
    graph_.add_pass(
        "focus.gather",
        {made_.far_light, made_.near_light, made_.far_kernels, made_.near_kernels, made_.far_wide,
         made_.far_coarse, made_.near_coarse, made_.near_radius, made_.tiles, made_.slight_tiles},
        {cleared(made_.far_blurred), cleared(made_.near_blurred)},
        [&pass = pass_, made = made_, count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusFarLightUnit, made.far_light);
            context.bind_texture(layout::kFocusNearLightUnit, made.near_light);
            context.bind_texture(layout::kFocusFarKernelsUnit, made.far_kernels);
            context.bind_texture(layout::kFocusNearKernelsUnit, made.near_kernels);
            context.bind_texture(layout::kFocusFarWideUnit, made.far_wide);
            context.bind_texture(layout::kFocusFarCoarseUnit, made.far_coarse);
            context.bind_texture(layout::kFocusNearCoarseUnit, made.near_coarse);
            bind_tiles(context, made);
            context.bind_texture(layout::kFocusNearRadiusUnit, made.near_radius);
            draw_tiles(context, pass.gather, pass.focus, kAnyBlurred, 2 * made.half, count);
        });
}

TextureId Drawing::compose(TextureId radiance) {
    const TextureId composed = create("radiance through lens", format_, size_);
    graph_.add_pass(
        "focus.compose",
        {radiance, made_.packed, made_.far_blurred, made_.near_blurred, made_.behind,
         made_.near_reach, made_.near_coarse, made_.tiles, made_.slight_tiles},
        {discarded(composed)},
        [&pass = pass_, made = made_, radiance, size = size_,
         count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusRadianceUnit, radiance);
            context.bind_texture(layout::kFocusPackedUnit, made.packed);
            context.bind_texture(layout::kFocusFarBlurredUnit, made.far_blurred);
            context.bind_texture(layout::kFocusNearBlurredUnit, made.near_blurred);
            context.bind_texture(layout::kFocusBehindNearUnit, made.behind);
            context.bind_texture(layout::kFocusNearReachUnit, made.near_reach);
            context.bind_texture(layout::kFocusNearCoarseUnit, made.near_coarse);
            bind_tiles(context, made);
            for (int i = 0; i < 4; ++i) {
                draw_tiles(context, pass.compose[i], pass.focus, 1 << i, size, count);
            }
        });
    return composed;
}

void Drawing::draw_discs(TextureId composed, TextureId depth) {
    graph_.add_pass(
        "focus.discs",
        {depth, made_.packed, made_.far_wide, made_.near_wide, made_.far_rest, made_.near_rest,
         made_.near_blurred, made_.tiles},
        {composed}, [&pass = pass_, made = made_, depth](PassContext& context) {
            gpu::PipelineState add = gpu::kFullscreenState;
            add.blend = gpu::kBlendAdd;
            add.color_mask = 0b0111;
            context.device().use(gpu::Pipeline{pass.disc, add});
            context.device().bind_uniforms(layout::kFocusBinding, pass.focus);
            pass.disc->set("texels", made.quarter);
            context.bind_texture(layout::kFocusFarWideUnit, made.far_wide);
            context.bind_texture(layout::kFocusNearWideUnit, made.near_wide);
            context.bind_texture(layout::kFocusFarRestUnit, made.far_rest);
            context.bind_texture(layout::kFocusNearRestUnit, made.near_rest);
            context.bind_texture(layout::kFocusPackedUnit, made.packed);
            context.bind_texture(layout::kFocusNearBlurredUnit, made.near_blurred);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.bind_texture(layout::kFocusTilesUnit, made.tiles);
            context.device().draw(GL_POINTS, 0, 2 * made.quarter.x * made.quarter.y);
        });
}

TextureId Drawing::through_lens(TextureId radiance, TextureId depth) {
    find_tiles(depth);
    split(radiance, depth);
    extract_highlights();
    gather_coarse();
    gather();
    const TextureId composed = compose(radiance);
    draw_discs(composed, depth);
    return composed;
}

TextureId Drawing::by_mips(TextureId radiance, TextureId depth) {
    const int levels = gpu::full_level_count(size_.x, size_.y);
    const TextureId pyramid = create("focus.pyramid", format_, size_, levels);
    graph_.add_pass(
        "focus.pyramid", {radiance}, {image(pyramid)},
        [radiance, pyramid, size = size_](PassContext& context) {
            glCopyImageSubData(
                context.texture(radiance).id(), GL_TEXTURE_2D, 0, 0, 0, 0,
                context.texture(pyramid).id(), GL_TEXTURE_2D, 0, 0, 0, 0, size.x, size.y, 1);
            glGenerateTextureMipmap(context.texture(pyramid).id());
        });
    const TextureId composed = create("radiance through lens", format_, size_);
    graph_.add_pass(
        "focus.mip", {pyramid, depth}, {discarded(composed)},
        [&pass = pass_, block = block_, pyramid, depth](PassContext& context) {
            pass.focus.write(0, std::span(&block, 1));
            use_fullscreen(context, pass.mip, pass.focus);
            context.bind_texture(layout::kFocusRadianceUnit, pyramid);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.device().draw_fullscreen();
        });
    return composed;
}

}  // namespace

layout::FocusBlock make_focus_block(const RenderView& view) {
    const LensView& lens = view.lens;
    const IVec2 size = {view.width, view.height};
    const IVec2 half = half_resolution(size);
    const float widest = static_cast<float>(widest_circle(view));
    layout::FocusBlock block{};
    block.lens = {
        circle_scale(lens, view.tangent.y, view.height), 1 / lens.focus_distance, 1 / view.near,
        widest};

    const bool round = lens.blades < 3;
    const float slice = 2 * kPi / static_cast<float>(round ? 3 : lens.blades);
    block.aperture = {
        static_cast<float>(lens.blades), lens.blade_rotation,
        round ? kPi : kPi / slice * std::sin(slice), round ? 0.25f : (2 + std::cos(slice)) / 12};

    const IVec2 tiles = (size + layout::kFocusTile - 1) / layout::kFocusTile;
    const float coarse = std::max(0.5f * widest / layout::kLevelRadius, 1.0f);
    block.tiles = {
        tiles.x, tiles.y,
        static_cast<int>(std::ceil(0.5f * widest / static_cast<float>(layout::kFocusTile))),
        std::max(static_cast<int>(std::ceil(std::log2(coarse))), 1)};
    block.size = Vec4(size, half);

    // A sunflower (Vogel) pattern: equal areas, no visible rows.
    constexpr float kGolden = 0.61803399f;
    for (int i = 0; i < layout::kFocusTaps; ++i) {
        const float turn = static_cast<float>(i) * kGolden;
        block.tap[i] = Vec4(rim(lens, turn - std::floor(turn)), 0, 0);
    }
    fill_small_circles(block);
    fill_kernels(lens, block);
    return block;
}

Result<DepthOfFieldPass> create_depth_of_field_pass(gpu::Device& device) {
    struct ProgramSlot {
        const gpu::Program*& program;
        const char* vertex;
        const char* fragment;
        std::vector<gpu::ShaderDefine> defines;
    };
    DepthOfFieldPass pass;
    const gpu::ShaderDefine slight = {"SLIGHT", "1"};
    const gpu::ShaderDefine blurred = {"BLURRED", "1"};
    const ProgramSlot all[] = {
        {pass.blocks, "fullscreen.vert", "depth_of_field_blocks.frag", {}},
        {pass.spread, "fullscreen.vert", "depth_of_field_spread.frag", {}},
        {pass.tiles, "fullscreen.vert", "depth_of_field_tiles.frag", {}},
        {pass.reach, "fullscreen.vert", "depth_of_field_reach.frag", {}},
        {pass.pack, "fullscreen.vert", "depth_of_field_pack.frag", {}},
        {pass.split, "depth_of_field_tile.vert", "depth_of_field_split.frag", {}},
        {pass.light, "fullscreen.vert", "depth_of_field_light.frag", {}},
        {pass.rest, "fullscreen.vert", "depth_of_field_rest.frag", {}},
        {pass.coarse, "fullscreen.vert", "depth_of_field_coarse.frag", {}},
        {pass.gather, "depth_of_field_tile.vert", "depth_of_field_gather.frag", {}},
        {pass.compose[0], "depth_of_field_tile.vert", "depth_of_field_compose.frag", {}},
        {pass.compose[1], "depth_of_field_tile.vert", "depth_of_field_compose.frag", {slight}},
        {pass.compose[2], "depth_of_field_tile.vert", "depth_of_field_compose.frag", {blurred}},
        {pass.compose[3],
         "depth_of_field_tile.vert",
         "depth_of_field_compose.frag",
         {slight, blurred}},
        {pass.disc, "depth_of_field_disc.vert", "depth_of_field_disc.frag", {}},
        {pass.mip, "fullscreen.vert", "depth_of_field_mip.frag", {}}};
    for (const ProgramSlot& slot : all) {
        slot.program = LIMN_TRY(device.shaders().load(
            {.vertex = slot.vertex, .fragment = slot.fragment, .defines = slot.defines}));
    }
    pass.focus = gpu::Buffer("focus", sizeof(layout::FocusBlock), gpu::BufferUse::Dynamic);
    return pass;
}

bool has_depth_of_field(const RenderView& view) {
    // The widest possible circles: at the near plane and at infinity.
    const float scale = circle_scale(view.lens, view.tangent.y, view.height);
    const float nearness = 1 / view.lens.focus_distance;
    const float widest = scale * std::max(nearness, 1 / view.near - nearness);
    return std::min(widest, static_cast<float>(widest_circle(view))) > layout::kMinCircle;
}

TextureId draw_depth_of_field(
    FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, TextureId radiance,
    TextureId depth) {
    LIMN_CHECK(has_depth_of_field(view));

    Drawing drawing(graph, pass, view, graph.spec(radiance).format);
    return view.lens.method == FocusMethod::Mip ? drawing.by_mips(radiance, depth)
                                                : drawing.through_lens(radiance, depth);
}

Result<DepthOfFieldEffect> DepthOfFieldEffect::create(gpu::Device& device, const RenderSettings&) {
    return DepthOfFieldEffect{LIMN_TRY(create_depth_of_field_pass(device))};
}

void DepthOfFieldEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    const auto* const lens = view.data.find<LensDepth>();
    view.radiance = draw_depth_of_field(
        graph, pass, view.camera, view.radiance,
        lens != nullptr ? lens->depth : view.gbuffer.depth);
}

}  // namespace limn
