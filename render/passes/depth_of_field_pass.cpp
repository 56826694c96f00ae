#include "render/passes/depth_of_field_pass.h"

#include "render/gpu/shader_library.h"
#include "render/render_view.h"
#include "render/shaders/focus_gpu.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace limn {
namespace {

constexpr unsigned kFocusBinding = 2;
constexpr unsigned kTilesUnit = 7;
constexpr int kHiddenLevels = 5;
constexpr int kLuminanceLevels = 6;

/// Kinds of tiles, bits of focus_tile.vert.
enum TileKind : int {
    kSharpTiles = 1,
    kSlightTiles = 2,
    kBlurredTiles = 4,
    kBlurredSlightTiles = 8,
    kAnyBlurred = kBlurredTiles | kBlurredSlightTiles,
};

int widest_circle(const RenderView& view) {
    return static_cast<int>(view.lens.largest_blur * static_cast<float>(view.height));
}

/// How `blades` sides share a turn: the place on the rim of the unit aperture at `turn` of it.
Vec2 rim(const LensView& lens, float turn) {
    if (lens.blades < 3) {
        return {std::cos(2 * kPi * turn), std::sin(2 * kPi * turn)};
    }
    return point_on_aperture(lens, {turn, 1});
}

/// The textures between the passes; all but the tiles have the format of the radiance.
struct FocusTextures {
    IVec2 half;
    IVec2 quarter;
    TextureId tiles;
    TextureId far_light;  ///< of half the size
    TextureId near_light;
    TextureId radii;
    TextureId behind_near;
    TextureId far_rest;  ///< of a quarter
    TextureId near_rest;
    TextureId rest_radii;
    TextureId behind;
    TextureId far_blurred;  ///< of half the size
    TextureId near_blurred;
};

IVec2 half_of(const IVec2& size) {
    return (size + 1) / 2;
}

int levels_of(const IVec2& size, int most) {
    return std::min(gpu::full_level_count(size.x, size.y), most);
}

/// Adds the passes one after the other.
class Drawing {
  public:
    Drawing(FrameGraph& graph, DepthOfFieldPass& pass, const RenderView& view, GLenum format)
        : graph_(graph), pass_(pass), block_(make_focus_block(view)), format_(format),
          size_(view.width, view.height) {
        made_.half = half_of(size_);
        made_.quarter = half_of(made_.half);
    }

    TextureId through_lens(TextureId radiance, TextureId depth);
    TextureId by_levels(TextureId radiance, TextureId depth);

  private:
    TextureId create(const char* name, GLenum format, const IVec2& size, int levels = 1) {
        return graph_.create(
            {.name = name, .format = format, .width = size.x, .height = size.y, .levels = levels});
    }
    GLenum pair_format() const { return format_ == GL_RGBA32F ? GL_RG32F : GL_RG16F; }
    int tile_count() const { return block_.tiles.x * block_.tiles.y; }

    void find_tiles(TextureId depth);
    void split(TextureId radiance, TextureId depth);
    void take_off_highlights();
    void fill_levels(TextureId texture, int levels);
    void gather();
    TextureId compose(TextureId radiance, TextureId depth);
    void draw_discs(TextureId picture, TextureId radiance, TextureId depth);

    FrameGraph& graph_;
    DepthOfFieldPass& pass_;
    layout::FocusBlock block_;
    GLenum format_;
    IVec2 size_;
    FocusTextures made_;
};

void use_fullscreen(PassContext& context, const gpu::Program* program, const gpu::Buffer& focus) {
    context.device().use(gpu::Pipeline{program, gpu::kFullscreenState});
    context.device().bind_uniforms(kFocusBinding, focus);
}

/// Draws `program` over the tiles of one of `kinds`; the targets are `cover` pixels of the picture
/// wide and high.
void draw_tiles(
    PassContext& context,
    const gpu::Program* program,
    const gpu::Buffer& focus,
    int kinds,
    const IVec2& cover,
    int tiles) {
    use_fullscreen(context, program, focus);
    program->set("kind", kinds);
    program->set("target_size", Vec2(cover));
    context.device().draw(GL_TRIANGLE_STRIP, 0, 4, tiles);
}

void Drawing::find_tiles(TextureId depth) {
    const IVec2 count = {block_.tiles.x, block_.tiles.y};
    const TextureId own = create("focus.own tiles", GL_RGBA16F, count);
    const TextureId small = create("focus.own small", GL_RGBA16F, count);
    graph_.add_pass(
        "focus.tiles",
        {depth},
        {discarded(own), discarded(small)},
        [&pass = pass_, block = block_, depth](PassContext& context) {
            pass.focus.write(0, std::span(&block, 1));
            use_fullscreen(context, pass.tiles, pass.focus);
            context.bind_texture(1, depth);
            context.device().draw_fullscreen();
        });
    made_.tiles = create("focus.tiles", GL_RGBA16F, count);
    graph_.add_pass(
        "focus.reach",
        {own, small},
        {discarded(made_.tiles)},
        [&pass = pass_, own, small](PassContext& context) {
            use_fullscreen(context, pass.reach, pass.focus);
            context.bind_texture(0, own);
            context.bind_texture(1, small);
            context.device().draw_fullscreen();
        });
}

void Drawing::split(TextureId radiance, TextureId depth) {
    made_.far_light = create("focus.far", format_, made_.half);
    made_.near_light = create("focus.near", format_, made_.half);
    made_.radii = create("focus.radii", format_, made_.half);
    made_.behind_near = create("focus.behind near", format_, made_.half);
    graph_.add_pass(
        "focus.split",
        {radiance, depth, made_.tiles},
        {cleared(made_.far_light),
         cleared(made_.near_light),
         cleared(made_.radii),
         cleared(made_.behind_near)},
        [&pass = pass_,
         radiance,
         depth,
         tiles = made_.tiles,
         cover = 2 * made_.half,
         count = tile_count()](PassContext& context) {
            context.bind_texture(0, radiance);
            context.bind_texture(1, depth);
            context.bind_texture(kTilesUnit, tiles);
            draw_tiles(context, pass.split, pass.focus, kAnyBlurred, cover, count);
        });
}

void Drawing::fill_levels(TextureId texture, int levels) {
    if (levels > 1) {
        graph_.add_pass("focus.levels", {}, {image(texture)}, [texture](PassContext& context) {
            glGenerateTextureMipmap(context.texture(texture).id());
        });
    }
}

void Drawing::take_off_highlights() {
    const int luminance_levels = levels_of(made_.quarter, kLuminanceLevels);
    const TextureId luminance =
        create("focus.luminance", GL_RG32F, made_.quarter, luminance_levels);
    graph_.add_pass(
        "focus.light",
        {made_.near_light, made_.behind_near},
        {target_level(discarded(luminance), 0)},
        [&pass = pass_, near = made_.near_light, behind = made_.behind_near](PassContext& context) {
            use_fullscreen(context, pass.light, pass.focus);
            context.bind_texture(0, near);
            context.bind_texture(1, behind);
            context.device().draw_fullscreen();
        });
    fill_levels(luminance, luminance_levels);

    const int levels = levels_of(made_.quarter, std::max(block_.tiles.w, 1));
    const int hidden_levels = levels_of(made_.quarter, kHiddenLevels);
    made_.far_rest = create("focus.far rest", format_, made_.quarter, levels);
    made_.near_rest = create("focus.near rest", format_, made_.quarter, levels);
    made_.rest_radii = create("focus.rest radii", pair_format(), made_.quarter, levels);
    made_.behind = create("focus.behind", format_, made_.quarter, hidden_levels);
    graph_.add_pass(
        "focus.rest",
        {made_.far_light, made_.near_light, made_.radii, made_.behind_near, luminance},
        {target_level(discarded(made_.far_rest), 0),
         target_level(discarded(made_.near_rest), 0),
         target_level(discarded(made_.rest_radii), 0),
         target_level(discarded(made_.behind), 0)},
        [&pass = pass_, made = made_, luminance](PassContext& context) {
            use_fullscreen(context, pass.rest, pass.focus);
            context.bind_texture(0, made.far_light);
            context.bind_texture(1, made.near_light);
            context.bind_texture(2, made.radii);
            context.bind_texture(3, made.behind_near);
            context.bind_texture(4, luminance);
            context.device().draw_fullscreen();
        });
    fill_levels(made_.far_rest, levels);
    fill_levels(made_.near_rest, levels);
    fill_levels(made_.rest_radii, levels);
    fill_levels(made_.behind, hidden_levels);
}

void Drawing::gather() {
    made_.far_blurred = create("focus.far blurred", format_, made_.half);
    made_.near_blurred = create("focus.near blurred", format_, made_.half);
    graph_.add_pass(
        "focus.gather",
        {made_.far_light,
         made_.near_light,
         made_.radii,
         made_.far_rest,
         made_.near_rest,
         made_.rest_radii,
         made_.tiles},
        {cleared(made_.far_blurred), cleared(made_.near_blurred)},
        [&pass = pass_, made = made_, count = tile_count()](PassContext& context) {
            context.bind_texture(0, made.far_light);
            context.bind_texture(1, made.near_light);
            context.bind_texture(2, made.radii);
            context.bind_texture(3, made.far_rest);
            context.bind_texture(4, made.near_rest);
            context.bind_texture(5, made.rest_radii);
            context.bind_texture(kTilesUnit, made.tiles);
            draw_tiles(context, pass.gather, pass.focus, kAnyBlurred, 2 * made.half, count);
        });
}

TextureId Drawing::compose(TextureId radiance, TextureId depth) {
    const TextureId picture = create("radiance through lens", format_, size_);
    graph_.add_pass(
        "focus.compose",
        {radiance, depth, made_.far_blurred, made_.near_blurred, made_.behind, made_.tiles},
        {discarded(picture)},
        [&pass = pass_, made = made_, radiance, depth, size = size_, count = tile_count()](
            PassContext& context) {
            context.bind_texture(0, radiance);
            context.bind_texture(1, depth);
            context.bind_texture(2, made.far_blurred);
            context.bind_texture(3, made.near_blurred);
            context.bind_texture(4, made.behind);
            context.bind_texture(kTilesUnit, made.tiles);
            for (int i = 0; i < 4; ++i) {
                draw_tiles(context, pass.compose[i], pass.focus, 1 << i, size, count);
            }
        });
    return picture;
}

void Drawing::draw_discs(TextureId picture, TextureId radiance, TextureId depth) {
    graph_.add_pass(
        "focus.discs",
        {radiance,
         depth,
         made_.far_light,
         made_.near_light,
         made_.radii,
         made_.far_rest,
         made_.near_rest,
         made_.near_blurred},
        {picture},
        [&pass = pass_, made = made_, radiance, depth](PassContext& context) {
            gpu::PipelineState add = gpu::kFullscreenState;
            add.blend = gpu::kBlendAdd;
            add.color_mask = 0b0111;
            context.device().use(gpu::Pipeline{pass.disc, add});
            context.device().bind_uniforms(kFocusBinding, pass.focus);
            pass.disc->set("texels", made.quarter);
            context.bind_texture(0, made.far_light);
            context.bind_texture(1, made.near_light);
            context.bind_texture(2, made.radii);
            context.bind_texture(3, made.far_rest);
            context.bind_texture(4, made.near_rest);
            context.bind_texture(5, made.near_blurred);
            context.bind_texture(6, depth);
            context.bind_texture(8, radiance);
            context.device().draw(GL_POINTS, 0, 2 * made.quarter.x * made.quarter.y);
        });
}

TextureId Drawing::through_lens(TextureId radiance, TextureId depth) {
    find_tiles(depth);
    split(radiance, depth);
    take_off_highlights();
    gather();
    const TextureId picture = compose(radiance, depth);
    draw_discs(picture, radiance, depth);
    return picture;
}

TextureId Drawing::by_levels(TextureId radiance, TextureId depth) {
    const int levels = gpu::full_level_count(size_.x, size_.y);
    const TextureId pyramid = create("focus.pyramid", format_, size_, levels);
    graph_.add_pass(
        "focus.pyramid",
        {radiance},
        {image(pyramid)},
        [radiance, pyramid, size = size_](PassContext& context) {
            glCopyImageSubData(
                context.texture(radiance).id(),
                GL_TEXTURE_2D,
                0,
                0,
                0,
                0,
                context.texture(pyramid).id(),
                GL_TEXTURE_2D,
                0,
                0,
                0,
                0,
                size.x,
                size.y,
                1);
            glGenerateTextureMipmap(context.texture(pyramid).id());
        });
    const TextureId picture = create("radiance through lens", format_, size_);
    graph_.add_pass(
        "focus.mip",
        {pyramid, depth},
        {discarded(picture)},
        [&pass = pass_, block = block_, pyramid, depth](PassContext& context) {
            pass.focus.write(0, std::span(&block, 1));
            use_fullscreen(context, pass.mip, pass.focus);
            context.bind_texture(0, pyramid);
            context.bind_texture(1, depth);
            context.device().draw_fullscreen();
        });
    return picture;
}

}  // namespace

Result<DepthOfFieldPass> create_depth_of_field_pass(gpu::Device& device) {
    struct Wanted {
        const gpu::Program*& program;
        const char* vertex;
        const char* fragment;
        std::vector<gpu::ShaderDefine> defines;
    };
    DepthOfFieldPass pass;
    const gpu::ShaderDefine slight = {"SLIGHT", "1"};
    const gpu::ShaderDefine blurred = {"BLURRED", "1"};
    const Wanted all[] = {
        {pass.tiles, "fullscreen.vert", "focus_tiles.frag", {}},
        {pass.reach, "fullscreen.vert", "focus_reach.frag", {}},
        {pass.split, "focus_tile.vert", "focus_split.frag", {}},
        {pass.light, "fullscreen.vert", "focus_light.frag", {}},
        {pass.rest, "fullscreen.vert", "focus_rest.frag", {}},
        {pass.gather, "focus_tile.vert", "focus_gather.frag", {}},
        {pass.compose[0], "focus_tile.vert", "focus_compose.frag", {}},
        {pass.compose[1], "focus_tile.vert", "focus_compose.frag", {slight}},
        {pass.compose[2], "focus_tile.vert", "focus_compose.frag", {blurred}},
        {pass.compose[3], "focus_tile.vert", "focus_compose.frag", {slight, blurred}},
        {pass.disc, "focus_disc.vert", "focus_disc.frag", {}},
        {pass.mip, "fullscreen.vert", "focus_mip.frag", {}}};
    for (const Wanted& wanted : all) {
        const Result<const gpu::Program*> loaded = device.shaders().load(
            {.vertex = wanted.vertex, .fragment = wanted.fragment, .defines = wanted.defines});
        if (!loaded) {
            return loaded.error();
        }
        wanted.program = *loaded;
    }
    pass.focus = gpu::Buffer("focus", sizeof(layout::FocusBlock), gpu::BufferUse::Dynamic);
    return pass;
}

layout::FocusBlock make_focus_block(const RenderView& view) {
    const LensView& lens = view.lens;
    const IVec2 size = {view.width, view.height};
    const IVec2 half = half_of(size);
    const float widest = static_cast<float>(widest_circle(view));
    layout::FocusBlock block{};
    block.lens = {
        circle_scale(lens, view.tangent.y, view.height),
        1 / lens.focus_distance,
        1 / view.near,
        widest};

    const bool round = lens.blades < 3;
    const float slice = 2 * kPi / static_cast<float>(round ? 3 : lens.blades);
    block.aperture = {
        static_cast<float>(lens.blades),
        lens.blade_rotation,
        round ? kPi : kPi / slice * std::sin(slice),
        round ? 0.25f : (2 + std::cos(slice)) / 12};

    const IVec2 tiles = (size + layout::kFocusTile - 1) / layout::kFocusTile;
    const float coarse = std::max(0.5f * widest / layout::kLevelRadius, 1.0f);
    block.tiles = {
        tiles.x,
        tiles.y,
        static_cast<int>(std::ceil(0.5f * widest / static_cast<float>(layout::kFocusTile))),
        std::max(static_cast<int>(std::ceil(std::log2(coarse))), 1)};
    block.size = Vec4(size, half);

    // A sunflower: equal areas, no rows.
    constexpr float kGolden = 0.61803399f;
    for (int i = 0; i < layout::kFocusTaps; ++i) {
        const float turn = static_cast<float>(i) * kGolden;
        block.tap[i] = Vec4(rim(lens, turn - std::floor(turn)), 0, 0);
    }
    std::array<IVec2, 49> around;
    for (int i = 0; i < 49; ++i) {
        around[i] = {i % 7 - 3, i / 7 - 3};
    }
    std::stable_sort(around.begin(), around.end(), [](const IVec2& a, const IVec2& b) {
        return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
    });
    for (int i = 0; i < layout::kSlightTaps; ++i) {
        block.tap[i].z = static_cast<float>(around[i].x);
        block.tap[i].w = static_cast<float>(around[i].y);
    }
    for (int i = 0; i < 52; ++i) {
        float area = 0;
        for (const IVec2& pixel : around) {
            const float away = std::sqrt(static_cast<float>(pixel.x * pixel.x + pixel.y * pixel.y));
            area += std::clamp(static_cast<float>(i) / 16 + 0.5f - away, 0.0f, 1.0f);
        }
        block.area[i / 4][i % 4] = area;
    }
    return block;
}

bool has_depth_of_field(const RenderView& view) {
    // The widest circles there can be: of what is at the near plane, and infinitely far away.
    const float scale = circle_scale(view.lens, view.tangent.y, view.height);
    const float nearness = 1 / view.lens.focus_distance;
    const float widest = scale * std::max(nearness, 1 / view.near - nearness);
    return std::min(widest, static_cast<float>(widest_circle(view))) > layout::kLeastCircle;
}

TextureId draw_depth_of_field(
    FrameGraph& graph,
    DepthOfFieldPass& pass,
    const RenderView& view,
    TextureId radiance,
    TextureId depth) {
    LIMN_CHECK(has_depth_of_field(view));

    Drawing drawing(graph, pass, view, graph.spec(radiance).format);
    return view.lens.method == FocusMethod::Mip ? drawing.by_levels(radiance, depth)
                                                : drawing.through_lens(radiance, depth);
}

}  // namespace limn
