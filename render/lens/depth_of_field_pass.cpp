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

/// Radius of the scaled aperture whose rim passes through `point`; 1 for the unit aperture.
float radius_of_aperture(const LensView& lens, const Vec2& point) {
    if (lens.blades < 3) {
        return length(point);
    }
    const float slice = 2 * kPi / static_cast<float>(lens.blades);
    const float angle = std::atan2(point.y, point.x) - lens.blade_rotation;
    const float from_center = angle - (std::floor(angle / slice) + 0.5f) * slice;
    return length(point) * std::cos(from_center) / std::cos(0.5f * slice);
}

/// A grid point, and the radius of the disc or aperture through it.
struct GridPoint {
    IVec2 at;
    float radius = 0;
};

/// Grid points within `extent`, sorted by radius.
template <typename RadiusOf>
std::vector<GridPoint> grid_points_around(int extent, RadiusOf&& radius_of) {
    std::vector<GridPoint> points;
    for (int y = -extent; y <= extent; ++y) {
        for (int x = -extent; x <= extent; ++x) {
            points.push_back({{x, y}, radius_of(Vec2(x, y))});
        }
    }
    std::stable_sort(points.begin(), points.end(), [](const GridPoint& a, const GridPoint& b) {
        return a.radius < b.radius;
    });
    return points;
}

/// Grid coverage of a disc of `radius` with a soft rim of width 1, and its variance per axis.
struct Coverage {
    float area = 0;
    float variance = 0;
};

Coverage coverage_of(const std::vector<GridPoint>& points, float radius) {
    float area = 0;
    Vec2 mean = Vec2(0);
    float square = 0;
    for (const GridPoint& point : points) {
        const float covered = std::clamp(radius + 0.5f - point.radius, 0.0f, 1.0f);
        const Vec2 at = Vec2(point.at);
        area += covered;
        mean += covered * at;
        square += covered * dot(at, at);
    }
    mean /= area;
    return {area, 0.5f * (square / area - dot(mean, mean))};
}

void fill_small_circles(layout::FocusBlock& block) {
    const std::vector<GridPoint> points =
        grid_points_around(3, [](const Vec2& at) { return length(at); });
    for (int i = 0; i < layout::kSlightTaps; ++i) {
        block.pixel[i] = Vec4(points[i].at, points[i].radius, 0);
    }
    for (int i = 0; i < layout::kAreas; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kSlightStep);
        block.area[i / 4][i % 4] = 1 / coverage_of(points, radius).area;
    }
}

/// Kernels at half resolution, whose discs are as wide as the circles once the blur of resampling
/// is added.
void fill_kernels(const LensView& lens, layout::FocusBlock& block) {
    constexpr float kTents = 1.5f;     // variance of down- and upsampling [px^2]
    constexpr float kRim = 5.0f / 12;  // added to the squared radius by a rim of width 1
    constexpr float kFromLattice =
        6.0f;  // circle [px] from which the continuous area is accurate enough
    const float shape = block.aperture.w;
    const std::vector<GridPoint> points =
        grid_points_around(5, [&](const Vec2& at) { return radius_of_aperture(lens, at); });
    for (int i = 0; i < layout::kFineTaps; ++i) {
        block.texel[i] = Vec4(points[i].at, points[i].radius, 0);
    }
    const float narrowing = kRim + 0.25f * kTents / shape;
    const auto continuous_radius = [&](float radius) {
        return std::sqrt(std::max(0.25f * radius * radius - narrowing, 0.25f));
    };
    float kernel = 0.5f;
    for (int i = 0; i < layout::kKernels; ++i) {
        const float radius = static_cast<float>(i) / static_cast<float>(layout::kKernelStep);
        const float target = 0.25f * (shape * radius * radius - kTents);
        while (kernel < continuous_radius(kFromLattice)
               && coverage_of(points, kernel).variance < target) {
            kernel += 1.0f / 64;
        }
        const float sigma = radius < kFromLattice ? kernel : continuous_radius(radius);
        block.kernel[i / 2][2 * (i % 2)] = sigma;
        block.kernel[i / 2][2 * (i % 2) + 1] = 1 / coverage_of(points, sigma).area;
    }
}

// ---- the passes ----

/// The textures between the passes.
struct FocusTextures {
    IVec2 half;
    IVec2 quarter;
    TextureId tiles;
    TextureId slight_tiles;
    TextureId small_near;
    TextureId packed;
    TextureId far_light;  ///< half resolution
    TextureId near_light;
    TextureId far_kernels;
    TextureId near_kernels;
    TextureId far_wide;
    TextureId near_wide;
    TextureId wide_radii;
    TextureId behind_near;
    TextureId far_base;  ///< quarter resolution
    TextureId near_base;
    TextureId base_radii;
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
class DepthOfFieldDrawing {
  public:
    DepthOfFieldDrawing(
        FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, GLenum format)
        : graph_(graph), pass_(pass), block_(make_focus_block(view)), format_(format),
          size_(view.width, view.height) {
        textures_.half = half_resolution(size_);
        textures_.quarter = half_resolution(textures_.half);
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
    FocusTextures textures_;
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

void bind_tiles(PassContext& context, const FocusTextures& textures) {
    context.bind_texture(layout::kFocusTilesUnit, textures.tiles);
    context.bind_texture(layout::kFocusSlightTilesUnit, textures.slight_tiles);
}

void DepthOfFieldDrawing::find_tiles(TextureId depth) {
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
    textures_.small_near = create("focus.small near", GL_R16F, block_count);
    graph_.add_pass(
        "focus.dilate blocks", {small_of_blocks}, {discarded(textures_.small_near)},
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
    textures_.tiles = create("focus.tiles", GL_RGBA16F, count);
    textures_.slight_tiles = create("focus.slight tiles", GL_RG16F, count);
    graph_.add_pass(
        "focus.dilate", {own, small},
        {discarded(textures_.tiles), discarded(textures_.slight_tiles)},
        [&pass = pass_, own, small](PassContext& context) {
            use_fullscreen(context, pass.dilate, pass.focus);
            context.bind_texture(layout::kFocusOwnTilesUnit, own);
            context.bind_texture(layout::kFocusOwnSmallUnit, small);
            context.device().draw_fullscreen();
        });
}

void DepthOfFieldDrawing::split(TextureId radiance, TextureId depth) {
    textures_.packed = create("focus.packed", format_, size_);
    graph_.add_pass(
        "focus.pack", {radiance, depth}, {discarded(textures_.packed)},
        [&pass = pass_, radiance, depth](PassContext& context) {
            use_fullscreen(context, pass.pack, pass.focus);
            context.bind_texture(layout::kFocusRadianceUnit, radiance);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.device().draw_fullscreen();
        });
    textures_.far_light = create("focus.far", format_, textures_.half);
    textures_.near_light = create("focus.near", format_, textures_.half);
    textures_.far_kernels = create("focus.far kernels", format_, textures_.half);
    textures_.near_kernels = create("focus.near kernels", pair_format(), textures_.half);
    textures_.far_wide = create("focus.far wide", format_, textures_.half);
    textures_.near_wide = create("focus.near wide", format_, textures_.half);
    textures_.wide_radii = create("focus.wide radii", pair_format(), textures_.half);
    textures_.behind_near = create("focus.behind near", format_, textures_.half);
    graph_.add_pass(
        "focus.split", {textures_.packed, textures_.tiles, textures_.slight_tiles},
        {cleared(textures_.far_light), cleared(textures_.near_light),
         cleared(textures_.far_kernels), cleared(textures_.near_kernels),
         cleared(textures_.far_wide), cleared(textures_.near_wide), cleared(textures_.wide_radii),
         cleared(textures_.behind_near)},
        [&pass = pass_, textures = textures_, count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusPackedUnit, textures.packed);
            bind_tiles(context, textures);
            draw_tiles(context, pass.split, pass.focus, kAnyBlurred, 2 * textures.half, count);
        });
}

void DepthOfFieldDrawing::fill_levels(TextureId texture, int levels) {
    if (levels > 1) {
        graph_.add_pass("focus.levels", {}, {image(texture)}, [texture](PassContext& context) {
            glGenerateTextureMipmap(context.texture(texture).id());
        });
    }
}

void DepthOfFieldDrawing::extract_highlights() {
    const int luminance_levels = levels_of(textures_.quarter, kLuminanceLevels);
    const TextureId luminance =
        create("focus.luminance", GL_RG32F, textures_.quarter, luminance_levels);
    graph_.add_pass(
        "focus.light", {textures_.near_light, textures_.near_wide, textures_.behind_near},
        {target_level(discarded(luminance), 0)},
        [&pass = pass_, textures = textures_](PassContext& context) {
            use_fullscreen(context, pass.light, pass.focus);
            context.bind_texture(layout::kFocusNearLightUnit, textures.near_light);
            context.bind_texture(layout::kFocusNearWideUnit, textures.near_wide);
            context.bind_texture(layout::kFocusBehindNearUnit, textures.behind_near);
            context.device().draw_fullscreen();
        });
    fill_levels(luminance, luminance_levels);

    const int levels = levels_of(textures_.quarter, std::max(block_.tiles.w, 1));
    const int hidden_levels = gpu::full_level_count(textures_.quarter.x, textures_.quarter.y);
    textures_.far_base = create("focus.far base", format_, textures_.quarter, levels);
    textures_.near_base = create("focus.near base", format_, textures_.quarter, levels);
    textures_.base_radii = create("focus.base radii", pair_format(), textures_.quarter, levels);
    textures_.behind = create("focus.behind", format_, textures_.quarter, hidden_levels);
    graph_.add_pass(
        "focus.base",
        {textures_.far_wide, textures_.near_wide, textures_.wide_radii, textures_.behind_near,
         luminance},
        {target_level(discarded(textures_.far_base), 0),
         target_level(discarded(textures_.near_base), 0),
         target_level(discarded(textures_.base_radii), 0),
         target_level(discarded(textures_.behind), 0)},
        [&pass = pass_, textures = textures_, luminance](PassContext& context) {
            use_fullscreen(context, pass.base, pass.focus);
            context.bind_texture(layout::kFocusFarWideUnit, textures.far_wide);
            context.bind_texture(layout::kFocusNearWideUnit, textures.near_wide);
            context.bind_texture(layout::kFocusWideRadiiUnit, textures.wide_radii);
            context.bind_texture(layout::kFocusBehindNearUnit, textures.behind_near);
            context.bind_texture(layout::kFocusLuminanceUnit, luminance);
            context.device().draw_fullscreen();
        });
    fill_levels(textures_.far_base, levels);
    fill_levels(textures_.near_base, levels);
    fill_levels(textures_.base_radii, levels);
    fill_levels(textures_.behind, hidden_levels);
}

void DepthOfFieldDrawing::gather_coarse() {
    textures_.far_coarse = create("focus.far coarse", format_, textures_.quarter);
    textures_.near_coarse = create("focus.near coarse", format_, textures_.quarter);
    textures_.near_radius = create("focus.near radius", GL_R16F, textures_.quarter);
    graph_.add_pass(
        "focus.coarse",
        {textures_.far_base, textures_.near_base, textures_.base_radii, textures_.tiles},
        {discarded(textures_.far_coarse), discarded(textures_.near_coarse),
         discarded(textures_.near_radius)},
        [&pass = pass_, textures = textures_](PassContext& context) {
            use_fullscreen(context, pass.coarse, pass.focus);
            context.bind_texture(layout::kFocusFarBaseUnit, textures.far_base);
            context.bind_texture(layout::kFocusNearBaseUnit, textures.near_base);
            context.bind_texture(layout::kFocusBaseRadiiUnit, textures.base_radii);
            context.bind_texture(layout::kFocusTilesUnit, textures.tiles);
            context.device().draw_fullscreen();
        });
}

void DepthOfFieldDrawing::gather() {
    textures_.far_blurred = create("focus.far blurred", format_, textures_.half);
    textures_.near_blurred = create("focus.near blurred", format_, textures_.half);
    graph_.add_pass(
        "focus.gather",
        {textures_.far_light, textures_.near_light, textures_.far_kernels, textures_.near_kernels,
         textures_.far_wide, textures_.far_coarse, textures_.near_coarse, textures_.near_radius,
         textures_.tiles, textures_.slight_tiles},
        {cleared(textures_.far_blurred), cleared(textures_.near_blurred)},
        [&pass = pass_, textures = textures_, count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusFarLightUnit, textures.far_light);
            context.bind_texture(layout::kFocusNearLightUnit, textures.near_light);
            context.bind_texture(layout::kFocusFarKernelsUnit, textures.far_kernels);
            context.bind_texture(layout::kFocusNearKernelsUnit, textures.near_kernels);
            context.bind_texture(layout::kFocusFarWideUnit, textures.far_wide);
            context.bind_texture(layout::kFocusFarCoarseUnit, textures.far_coarse);
            context.bind_texture(layout::kFocusNearCoarseUnit, textures.near_coarse);
            bind_tiles(context, textures);
            context.bind_texture(layout::kFocusNearRadiusUnit, textures.near_radius);
            draw_tiles(context, pass.gather, pass.focus, kAnyBlurred, 2 * textures.half, count);
        });
}

TextureId DepthOfFieldDrawing::compose(TextureId radiance) {
    const TextureId composed = create("radiance through lens", format_, size_);
    graph_.add_pass(
        "focus.compose",
        {radiance, textures_.packed, textures_.far_blurred, textures_.near_blurred,
         textures_.behind, textures_.small_near, textures_.near_coarse, textures_.tiles,
         textures_.slight_tiles},
        {discarded(composed)},
        [&pass = pass_, textures = textures_, radiance, size = size_,
         count = tile_count()](PassContext& context) {
            context.bind_texture(layout::kFocusRadianceUnit, radiance);
            context.bind_texture(layout::kFocusPackedUnit, textures.packed);
            context.bind_texture(layout::kFocusFarBlurredUnit, textures.far_blurred);
            context.bind_texture(layout::kFocusNearBlurredUnit, textures.near_blurred);
            context.bind_texture(layout::kFocusBehindNearUnit, textures.behind);
            context.bind_texture(layout::kFocusSmallNearUnit, textures.small_near);
            context.bind_texture(layout::kFocusNearCoarseUnit, textures.near_coarse);
            bind_tiles(context, textures);
            for (int i = 0; i < 4; ++i) {
                draw_tiles(context, pass.compose[i], pass.focus, 1 << i, size, count);
            }
        });
    return composed;
}

void DepthOfFieldDrawing::draw_discs(TextureId composed, TextureId depth) {
    graph_.add_pass(
        "focus.discs",
        {depth, textures_.packed, textures_.far_wide, textures_.near_wide, textures_.far_base,
         textures_.near_base, textures_.near_blurred, textures_.tiles},
        {composed}, [&pass = pass_, textures = textures_, depth](PassContext& context) {
            gpu::PipelineState add = gpu::kFullscreenState;
            add.blend = gpu::kBlendAdd;
            add.color_mask = 0b0111;
            context.device().use(gpu::Pipeline{pass.disc, add});
            context.device().bind_uniforms(layout::kFocusBinding, pass.focus);
            pass.disc->set("texels", textures.quarter);
            context.bind_texture(layout::kFocusFarWideUnit, textures.far_wide);
            context.bind_texture(layout::kFocusNearWideUnit, textures.near_wide);
            context.bind_texture(layout::kFocusFarBaseUnit, textures.far_base);
            context.bind_texture(layout::kFocusNearBaseUnit, textures.near_base);
            context.bind_texture(layout::kFocusPackedUnit, textures.packed);
            context.bind_texture(layout::kFocusNearBlurredUnit, textures.near_blurred);
            context.bind_texture(layout::kFocusDepthUnit, depth);
            context.bind_texture(layout::kFocusTilesUnit, textures.tiles);
            context.device().draw(GL_POINTS, 0, 2 * textures.quarter.x * textures.quarter.y);
        });
}

TextureId DepthOfFieldDrawing::through_lens(TextureId radiance, TextureId depth) {
    find_tiles(depth);
    split(radiance, depth);
    extract_highlights();
    gather_coarse();
    gather();
    const TextureId composed = compose(radiance);
    draw_discs(composed, depth);
    return composed;
}

TextureId DepthOfFieldDrawing::by_mips(TextureId radiance, TextureId depth) {
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
        {pass.dilate, "fullscreen.vert", "depth_of_field_dilate.frag", {}},
        {pass.pack, "fullscreen.vert", "depth_of_field_pack.frag", {}},
        {pass.split, "depth_of_field_tile.vert", "depth_of_field_split.frag", {}},
        {pass.light, "fullscreen.vert", "depth_of_field_light.frag", {}},
        {pass.base, "fullscreen.vert", "depth_of_field_base.frag", {}},
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

    DepthOfFieldDrawing drawing(graph, pass, view, graph.spec(radiance).format);
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
