#include "render/shadow/shadow_pass.h"

#include "ecs/base/log.h"
#include "ecs/components/caustics.h"
#include "ecs/components/shadow_volume.h"
#include "ecs/components/water.h"
#include "ecs/world.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/device.h"
#include "render/light/lighting.h"
#include "render/render_frame.h"
#include "render/shaders/shadow_gpu.h"
#include "render/shaders/view_gpu.h"

#include <utility>

// Techniques: shadow.map

namespace limn {
namespace {

/// What lighting binds in a view with shadows.
struct ShadowBindings {
    BufferTexture records = BufferTexture("shadow views", GL_RGBA32F);
    const gpu::Texture* atlas = nullptr;
};

gpu::Texture make_atlas(int size) {
    return {"shadow atlas", {.format = GL_DEPTH_COMPONENT32F, .width = size, .height = size}};
}

/// Copies the drawn maps: they keep their positions and depths.
void grow_atlas(gpu::Texture& atlas, int size) {
    if (atlas.width() >= size) {
        return;
    }
    gpu::Texture larger = make_atlas(size);
    glCopyImageSubData(
        atlas.id(), GL_TEXTURE_2D, 0, 0, 0, 0, larger.id(), GL_TEXTURE_2D, 0, 0, 0, 0,
        atlas.width(), atlas.height(), 1);
    atlas = std::move(larger);
}

void bind_shadows(PassContext& context, const ShadowBindings& shadows) {
    context.device().bind_texture(layout::kShadowAtlasUnit, *shadows.atlas);
    shadows.records.bind(context.device(), layout::kShadowViewsUnit);
}

/// Clears without the scissor test, with which a software OpenGL draws every pixel.
void clear_map(const gpu::Texture& atlas, const AtlasRect& rect) {
    constexpr float kFar = 0;
    glClearTexSubImage(
        atlas.id(), 0, rect.x, rect.y, 0, rect.size, rect.size, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
        &kFar);
}

void draw_map(
    PassContext& context, ProgramVariants& programs, const ViewData& view, const ShadowDraw& draw) {
    gpu::Device& device = context.device();
    const AtlasRect& rect = draw.rect;
    const gpu::PipelineState state = {.cull = GL_NONE, .depth_clamp = draw.clamp_depth};
    device.set_viewport(rect.x, rect.y, rect.size, rect.size);
    device.set_scissor(rect.x, rect.y, rect.size, rect.size);
    device.apply(state);
    const gpu::RingSlice& block = draw.view_block;
    device.bind_uniforms(layout::kViewBinding, block.buffer, block.offset, block.size);
    draw_casters(context, view, draw.casters, programs, state);
}

/// The atlas with this view's maps; not valid if nothing in the level has one.
TextureId draw_maps(
    FrameGraph& graph, ProgramVariants& programs, const gpu::Texture& texture,
    const ViewData& view) {
    const auto& list = view.data.get<ShadowList>();
    if (!list.kinds.maps) {
        return {};
    }
    const TextureId atlas = graph.import("shadow.atlas", texture);
    if (!list.due.empty()) {
        const Use writes[] = {atlas};
        graph.add_pass(
            "shadows", mesh_reads(graph, *view.frame), writes,
            [&programs, &texture, &view, &list](PassContext& context) {
                for (const ShadowDraw& draw : list.due) {
                    clear_map(texture, draw.rect);
                }
                for (const ShadowDraw& draw : list.due) {
                    draw_map(context, programs, view, draw);
                }
                context.device().disable_scissor();
            });
    }
    return atlas;
}

/// Of all lights and waters of the level, so that programs do not depend on which of them are in
/// view.
ShadowKinds find_shadow_kinds(const World& world, const LightList& lights) {
    ShadowKinds kinds;
    for (const ShadowedLight& light : lights.shadowed) {
        const bool has_volume = world.find<ShadowVolume>(light.entity) != nullptr;
        const ShadowMethod method = choose_shadow_method(light.settings.method, has_volume);
        kinds.masks |= method == ShadowMethod::Volume || method == ShadowMethod::Hybrid;
        if (method == ShadowMethod::Volume) {
            continue;
        }
        const bool sun = light.kind == LightKind::Directional;
        const bool narrow = light.kind == LightKind::Spot && light.outer_angle <= kMaxSpotViewAngle;
        kinds.maps = true;
        kinds.cubes |= !sun && !narrow;
        kinds.cascades |= sun || method == ShadowMethod::Perspective;
        const ShadowFilter filter = light.settings.filter;
        kinds.soft |= method != ShadowMethod::Hybrid && filter >= ShadowFilter::Soft;
        kinds.contact |= method != ShadowMethod::Hybrid && filter == ShadowFilter::ContactHardening;
    }
    // Caustics need maps: shadows of directional light fall on and into the water.
    kinds.maps |= lights.directional > 0 && !world.query<const Water, const Caustics>().empty();
    return kinds;
}

/// The union: a light may have another kind of shadow than it requests.
ShadowKinds both(const ShadowKinds& a, const ShadowKinds& b) {
    return {a.maps || b.maps,         a.masks || b.masks, a.cubes || b.cubes,
            a.cascades || b.cascades, a.soft || b.soft,   a.contact || b.contact};
}

}  // namespace

Result<ShadowEffect> ShadowEffect::create(gpu::Device& device, const RenderSettings&) {
    ShadowEffect effect{
        .casters = ProgramVariants::of_meshes(device, "shadow_map.frag"), .atlas = make_atlas(1)};
    LIMN_TRY(effect.casters.load());
    return effect;
}

void ShadowEffect::collect(FrameData& frame) {
    level = find_shadow_kinds(*frame.world, frame.data.get<LightList>());
    maps.begin_frame();
    if (frame.assets_replaced) {
        volumes.forget();
    }
}

bool ShadowEffect::prepare(const FrameData& frame, ViewData& view) {
    auto& lights = view.data.publish<LightList>();
    auto& volume_list = view.data.publish<VolumeList>();
    volumes.collect(*frame.items, view.camera, *frame.ring, lights, volume_list);
    auto& list = view.data.publish<ShadowList>();
    const auto* waters = view.data.find<WaterShadows>();
    maps.collect(
        frame, view, waters != nullptr ? waters->requests : std::span<const WaterShadow>(), lights,
        list);
    list.kinds = both(list.kinds, level);
    grow_atlas(atlas, list.atlas_size);
    VolumeCollector::assign_hybrid_masks(lights, volume_list);
    if (list.kinds.masks) {
        volume_list.pass = create_volume_pass(frame);
    }

    auto& bindings = view.data.publish<ShadowBindings>();
    bindings.records.upload(*frame.ring, list.records);
    bindings.atlas = &atlas;
    const ShadowKinds& kinds = list.kinds;
    const bool shadows = kinds.maps || kinds.masks;
    if (shadows) {
        view.lighting.add_binding<bind_shadows>(bindings);
    }
    Variant& variant = view.lighting.variant;
    variant.add_if(shadows, "SHADOWS");
    variant.add_if(kinds.cubes, "SHADOW_CUBES");
    variant.add_if(kinds.cascades, "SHADOW_CASCADES");
    variant.add_if(kinds.soft, "SHADOW_SOFT");
    variant.add_if(kinds.contact, "SHADOW_CONTACT");
    variant.add_if(kinds.maps, "SHADOW_MAPS");
    variant.add_if(kinds.masks, "SHADOW_MASKS");
    return true;
}

/// Null, and logged, if its shaders do not compile.
const ShadowVolumePass* ShadowEffect::create_volume_pass(const FrameData& frame) {
    if (!volume_pass) {
        Result<ShadowVolumePass> pass = create_shadow_volume_pass(*frame.device);
        if (!pass) {
            log_error("{}", pass.error().message);
            return nullptr;
        }
        volume_pass = *std::move(pass);
    }
    return &*volume_pass;
}

void ShadowEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    auto& published = view.data.publish<ShadowMaps>();
    published.list = &view.data.get<ShadowList>();
    published.records = &view.data.get<ShadowBindings>().records;
    published.atlas = draw_maps(graph, casters, atlas, view);
    if (published.atlas.valid()) {
        view.lighting.reads.emplace_back(published.atlas);
    }
    if (!published.list->kinds.masks || !volume_pass) {
        return;
    }
    const bool none = view.data.get<VolumeList>().lights.empty();
    auto& masks = view.data.publish<ShadowMasks>();
    masks.layers = none ? graph.import("no shadow masks", volume_pass->no_masks)
                        : draw_shadow_volumes(graph, *volume_pass, view);
    view.lighting.reads.emplace_back(masks.layers);
}

void ShadowEffect::report(const FrameData&, const ViewData& view, FrameOutput& out) {
    if (const auto* list = view.data.find<ShadowList>()) {
        out.statistics.shadow_views = static_cast<int>(list->records.size());
        out.statistics.shadow_views_drawn = static_cast<int>(list->due.size());
    }
}

}  // namespace limn
