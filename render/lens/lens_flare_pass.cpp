#include "render/lens/lens_flare_pass.h"

#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/lens/lens_ghosts.h"
#include "render/light/light_list.h"
#include "render/settings.h"
#include "render/shaders/disk_visibility_gpu.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/glow_gpu.h"
#include "render/shaders/lens_flare_gpu.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

// Techniques: engine.lens-flare

namespace limn {
namespace {

constexpr std::size_t kMaxLights = 16;
constexpr float kMinSoftness = 1.5f;  ///< of edges [px of half resolution]

const LensFlare* find_flare(const FrameData& frame) {
    const LensFlare* const flare = frame.world->find<LensFlare>(frame.camera.entity);
    return flare != nullptr && flare->strength > 0 ? flare : nullptr;
}

float luminance(const Vec3& color) {
    return glm::dot(color, Vec3(0.2126f, 0.7152f, 0.0722f));
}

/// The radius of a polygon with the area of the unit circle.
double polygon_radius(int blades) {
    const double n = blades;
    return blades < 3 ? 1 : std::sqrt(2 * kPi / (n * std::sin(2 * kPi / n)));
}

/// Where a ray that ends at `p` in the image crosses the plane of a rim, in units of its radius:
/// scale p + offset t for a light at t.
struct Rim {
    double scale = 1;
    double offset = 0;
    FlareShape shape = FlareShape::Disc;
};

/// A rim of `radius` at which rays arrive by the map `at`, as imaged in a ghost with the map
/// `sensor`; lengths in focal lengths. Images are upside down on the sensor, so that the slope is
/// t, not -t.
Rim make_rim(const ParaxialMap& at, double radius, const ParaxialMap& sensor, FlareShape shape) {
    const double scale = at.height / (sensor.height * radius);
    return {scale, at.slope / radius - sensor.slope * scale, shape};
}

/// The part of the image within all `rims`; `radiance` is that for a light of size 0.
FlareSprite make_sprite(
    std::span<const Rim> rims, const FlareLight& light, double source, double min_softness,
    const Vec3& radiance) {
    const Rim tightest =
        *std::max_element(rims.begin(), rims.end(), [](const Rim& a, const Rim& b) {
            return std::abs(a.scale) < std::abs(b.scale);
        });
    const double radius = 1 / std::abs(tightest.scale);
    const double position = -tightest.offset / tightest.scale;
    const double softness = std::max(std::abs(position) * source, min_softness);
    // An edge with the profile of smoothstep from r - s to r + s holds as much light as a sharp one
    // at sqrt(r^2 + s^2 / 5); it must not extend beyond the center.
    const double drawn = std::max(radius, softness);
    const double thinner = square(radius) / (square(drawn) + square(softness) / 5);

    FlareSprite sprite;
    sprite.center = static_cast<float>(position) * light.tangent;
    sprite.radius = static_cast<float>(drawn + softness);
    sprite.softness = static_cast<float>(softness);
    sprite.radiance = static_cast<float>(thinner) * radiance;
    for (std::size_t i = 0; i < rims.size(); ++i) {
        const double scale = rims[i].scale * radius / drawn;
        const double offset = rims[i].offset + (rims[i].scale - scale) * position;
        sprite.rims[i] = {
            scale, Vec2(static_cast<float>(offset) * light.tangent),
            static_cast<float>(rims[i].shape)};
    }
    return sprite;
}

std::vector<FlareSprite>
make_ghosts(const LensFlare& flare, const FlareLight& light, double source, double min_softness) {
    const std::span<const LensSurface> lens = double_gauss();
    const LensFocus focus = focus_of(lens);
    const double mm = 1 / focus.focal_length;
    const auto scaled = [mm](const ParaxialMap& map) {
        return ParaxialMap{map.height, map.slope * mm};
    };
    const double stop_radius =
        focus.stop.height * polygon_radius(flare.blades) / (2.0 * flare.f_number);
    const FlareShape stop_shape = flare.blades < 3 ? FlareShape::Disc : FlareShape::Polygon;
    const float exposed = 4 * square(flare.f_number) / kPi;  // radiance / irradiance

    std::vector<FlareSprite> sprites;
    for (const LensGhost& ghost :
         make_lens_ghosts(lens, {.wavelength = flare.coating, .spread = flare.coating_spread})) {
        const ParaxialMap sensor = scaled(ghost.sensor);
        Rim rims[4] = {make_rim({}, 0.5 * lens[0].diameter * mm, sensor, FlareShape::Disc)};
        for (int i = 0; i < ghost.passages; ++i) {
            rims[i + 1] = make_rim(scaled(ghost.stop[i]), stop_radius, sensor, stop_shape);
        }
        const auto gathered = static_cast<float>(1 / square(sensor.height));
        sprites.push_back(make_sprite(
            std::span(rims, ghost.passages + 1), light, source, min_softness,
            flare.strength * exposed * gathered * ghost.strength * light.illuminance));
    }
    const auto kept = std::min(static_cast<std::size_t>(flare.ghosts), sprites.size());
    std::partial_sort(
        sprites.begin(), sprites.begin() + static_cast<std::ptrdiff_t>(kept), sprites.end(),
        [](const FlareSprite& a, const FlareSprite& b) {
            return luminance(a.radiance) > luminance(b.radiance);
        });
    sprites.resize(kept);
    return sprites;
}

std::vector<FlareSprite> make_billboards(
    const LensFlare& flare, const FlareLight& light, double source, double min_softness,
    float tangent_y) {
    std::vector<FlareSprite> sprites;
    for (const FlareElement& element : flare.elements) {
        const double scale = 1 / std::max(element.size * tangent_y, 1e-6f);
        const Rim rim = {scale, -scale * (1 - 2 * element.place), element.shape};
        sprites.push_back(make_sprite(
            {&rim, 1}, light, source, min_softness,
            flare.strength * element.tint * light.illuminance));
    }
    return sprites;
}

/// Illuminance at `eye` [lx], as in lib/light.glsl.
Vec3 illuminance_at(const Vec3& eye, const layout::LightRecord& light) {
    const Vec3 offset = Vec3(light.position) - eye;
    const float d2 = glm::dot(offset, offset);
    const float x = d2 * light.position.w;
    const float window = light.color.w > 0 ? std::clamp(light.color.w * (1 - x), 0.0f, 1.0f)
                                           : square(std::clamp(1 - x * x, 0.0f, 1.0f));
    const Vec4& fade = light.polynomial;
    const float distance = window / std::max(fade.x + fade.y * std::sqrt(d2) + fade.z * d2, 1e-4f);
    const Vec3 axis = Vec3(light.axis);
    float t = -glm::dot(normalize_or(offset, Vec3(0)), axis);
    if (fade.w == static_cast<float>(SpotProfile::LinearAngle)) {
        const float scale = std::max(glm::length(axis), 1e-20f);
        t = -std::acos(std::clamp(t / scale, -1.0f, 1.0f)) * scale;
    }
    const float s = std::clamp(t + light.axis.w, 0.0f, 1.0f);
    const bool smooth = fade.w == static_cast<float>(SpotProfile::Smoothstep);
    return distance * (smooth ? s * s * (3 - 2 * s) : s) * Vec3(light.color);
}

/// A light in the image, and the disk that tests its visibility.
struct VisibleLight {
    FlareLight light;
    DiskSource source;
};

/// The brightest lights in or close to the image.
std::vector<VisibleLight>
find_lights(const LightList& list, const RenderView& view, const LensFlare& flare) {
    const Affine& pose = view.world_from_camera;
    const Vec3 eye = {pose.row[0].w, pose.row[1].w, pose.row[2].w};
    const float radius = 0.5f * flare.source_size * static_cast<float>(view.height);
    const Vec2 margin = 1.0f + 2 * radius / Vec2(view.width, view.height);
    std::vector<VisibleLight> lights;
    for (std::size_t i = 0; i < list.records.size(); ++i) {
        const layout::LightRecord& record = list.records[i];
        const bool distant = i < static_cast<std::size_t>(list.directional);
        const Vec4 position = {Vec3(record.position), distant ? 0.0f : 1.0f};
        const Vec4 clip = view.unjittered_from_world * position;
        const Vec4 jittered = view.clip_from_world * position;
        const Vec2 ndc = Vec2(clip) / clip.w;
        if (!(clip.w > view.near || (distant && clip.w > 0))
            || glm::any(glm::greaterThan(glm::abs(ndc), margin))) {
            continue;
        }
        const Vec3 illuminance = distant ? Vec3(record.color) : illuminance_at(eye, record);
        if (luminance(illuminance) > 0) {
            const float front = std::max(clip.w - flare.lamp_radius, view.near);
            lights.push_back(
                {{ndc * view.tangent, illuminance},
                 {0.5f * Vec2(jittered) / jittered.w + 0.5f, distant ? 0 : view.near / front,
                  radius}});
        }
    }
    const auto kept = static_cast<std::ptrdiff_t>(std::min(lights.size(), kMaxLights));
    std::partial_sort(
        lights.begin(), lights.begin() + kept, lights.end(),
        [](const VisibleLight& a, const VisibleLight& b) {
            return luminance(a.light.illuminance) > luminance(b.light.illuminance);
        });
    lights.resize(kept);
    return lights;
}

}  // namespace

std::vector<FlareSprite>
make_flare_sprites(const LensFlare& flare, const FlareLight& light, float tangent_y, int height) {
    const double source = flare.source_size * tangent_y;
    const double min_softness = 4 * kMinSoftness * tangent_y / static_cast<float>(height);
    return flare.mode == LensFlareMode::Billboards
               ? make_billboards(flare, light, source, min_softness, tangent_y)
               : make_ghosts(flare, light, source, min_softness);
}

bool LensFlareEffect::is_used(const FrameData& frame) {
    return find_flare(frame) != nullptr;
}

Result<LensFlareEffect> LensFlareEffect::create(gpu::Device& device, const RenderSettings&) {
    return LensFlareEffect{
        LIMN_TRY(load_fullscreen(device, "disk_visibility.frag")),
        LIMN_TRY(
            device.shaders().load({.vertex = "lens_flare.vert", .fragment = "lens_flare.frag"})),
        LIMN_TRY(load_fullscreen(device, "glow_add.frag"))};
}

void LensFlareEffect::collect(FrameData& frame) {
    flare = within_ranges(*find_flare(frame));
    sources.clear();
    sprites.clear();
    for (const VisibleLight& visible :
         find_lights(frame.data.get<LightList>(), frame.camera, flare)) {
        for (FlareSprite& drawn : make_flare_sprites(
                 flare, visible.light, frame.camera.tangent.y, frame.camera.height)) {
            drawn.light = static_cast<float>(sources.size());
            sprites.push_back(drawn);
        }
        sources.push_back(visible.source);
    }
    source_records.upload(*frame.ring, sources);
    sprite_records.upload(*frame.ring, sprites);
}

void LensFlareEffect::draw(FrameGraph& graph, const FrameData&, ViewData& view) {
    if (sprites.empty()) {
        return;
    }
    const IVec2 count = {static_cast<int>(sources.size()), 1};
    const TextureId visible = create_target(graph, "flare visibility", GL_R32F, count);
    add_fullscreen_pass(
        graph, "lens flare visibility", {sampled(view.gbuffer.depth, layout::kDiskDepthUnit)},
        {discarded(visible)}, visibility, [this](PassContext& context, const gpu::Program&) {
            source_records.bind(context.device(), layout::kDiskSourcesUnit);
        });
    const TextureId light = create_target(
        graph, "lens flare", graph.spec(view.radiance).format,
        half_resolution(size_of(graph, view.radiance)));
    graph.add_pass(
        "lens flare", {sampled(visible, layout::kVisibilityUnit)}, {cleared(light)},
        [this, &view](PassContext& context) {
            gpu::PipelineState state = gpu::kFullscreenState;
            state.blend = gpu::kBlendAdd;
            context.device().use(gpu::Pipeline{sprite, state});
            sprite_records.bind(context.device(), layout::kLensSpritesUnit);
            sprite->set("tangent", view.camera.tangent);
            sprite->set("blades", static_cast<float>(flare.blades));
            sprite->set("blade_rotation", flare.blade_rotation);
            context.device().draw_ids(6 * static_cast<int>(sprites.size()));
        });
    const TextureId sum = create_like(graph, "radiance with lens flare", view.radiance);
    add_fullscreen_pass(
        graph, "lens flare add",
        {sampled(view.radiance, layout::kSourceUnit), sampled(light, layout::kGlowUnit)},
        {discarded(sum)}, add,
        [](PassContext&, const gpu::Program& shader) { shader.set("strength", 1.0f); });
    view.radiance = sum;
}

}  // namespace limn
