#include "render/particles/particle_list.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

/// 0 for NaN.
float clamp_fraction(float value) {
    return std::min(std::max(0.0f, value), 1.0f);
}

/// Factors on the optical depth of red, green and blue; factor on the opacity.
Vec4 shadow_texel(const ParticleLook& look) {
    const Vec3& tint = look.shadow_tint;
    return {
        clamp_fraction(tint.x), clamp_fraction(tint.y), clamp_fraction(tint.z),
        clamp_fraction(look.shadow) * look.cover};
}

}  // namespace

LookRecord make_look_record(const ParticleLook& look, const LookLayers& layers) {
    LookRecord record{};
    record[0] = {look.size, look.size_spread, look.turn_spread, look.spin};
    record[1] = {look.spin_spread, look.stretch, look.softness, look.forward};
    record[2] = {look.emission, look.lit, look.cover, static_cast<float>(look.facing)};
    record[3] = {
        static_cast<float>(std::max(look.columns, 1u)), static_cast<float>(std::max(look.rows, 1u)),
        look.frame_rate, static_cast<float>(layers.image)};
    record[layout::kLookMore] = {
        static_cast<float>(look.frames), look.near_fade, look.far_fade, look.tumble};
    record[layout::kLookMore + 1] = {look.attenuation, look.fade};
    const PeriodicFunction& color_at = look.color_function;
    record[layout::kLookMore + 2] = {
        static_cast<float>(color_at.wave), color_at.base, color_at.amplitude, color_at.phase};
    record[layout::kLookMore + 3] = {color_at.frequency, look.color_spread};
    record[layout::kLookShadow] = shadow_texel(look);
    // A streak is blurred already.
    const bool is_streak = look.facing == ParticleFacing::Velocity && look.stretch != 0;
    record[layout::kLookMotion] = {
        static_cast<float>(layers.motion), look.motion_strength,
        is_streak ? 1.0f : clamp_fraction(look.velocity_cover),
        static_cast<float>(layers.negative_light)};
    record[layout::kLookFocus].x = clamp_fraction(look.velocity_cover);
    const bool at_center = look.lit_at == ParticleLitAt::Middle && look.lit > 0
                           && layers.negative_light < 0 && !is_point(record);
    record[layout::kLookFocus].y = at_center ? 1.0f : 0.0f;
    for (std::uint32_t i = 0; i < layout::kLookSamples; ++i) {
        const float at = static_cast<float>(i) / static_cast<float>(layout::kLookSamples - 1);
        record[layout::kLookSizes + i / 4][static_cast<int>(i % 4)] =
            sample_curve(look.size_curve, at);
        record[layout::kLookColors + i] = sample_colors(look.colors, at);
    }
    return record;
}

bool is_point(const LookRecord& look) {
    const float facing = look[2].w;
    return look[3].w < 0
           && (facing == static_cast<float>(ParticleFacing::Point)
               || facing == static_cast<float>(ParticleFacing::Pixels));
}

/// Factor on the diameter at its fraction of the life.
float size_factor(const ParticleInstance& instance, const LookRecord& look) {
    const float fraction = static_cast<float>(instance.look_and_life & 0xffffu) / 65535.0f;
    const float at = fraction * static_cast<float>(layout::kLookSamples - 1);
    const auto i = std::min(static_cast<std::uint32_t>(at), layout::kLookSamples - 2);
    const auto sample = [&](std::uint32_t n) {
        return look[layout::kLookSizes + n / 4][static_cast<int>(n % 4)];
    };
    return glm::mix(sample(i), sample(i + 1), at - static_cast<float>(i));
}

bool is_lit_at_center(const LookRecord& look) {
    return look[layout::kLookFocus].y > 0;
}

bool is_lit_at_corners(const LookRecord& look) {
    return look[2].y > 0 && !is_lit_at_center(look);
}

bool moves_pixels(const LookRecord& look) {
    return look[2].z > look[layout::kLookMotion].z;  // no opacity is above 1
}

float corner_radius(const ParticleInstance& instance, const LookRecord& look) {
    const float size = (look[0].x + look[0].y) * size_factor(instance, look);
    return 0.7072f * size;  // half the diagonal of the quad, however it is turned
}

float min_diameter(
    const ParticleInstance& instance, const LookRecord& look, const RenderView& view) {
    const float facing = look[2].w;
    const bool in_pixels = facing == static_cast<float>(ParticleFacing::Pixels);
    const bool tumbles = look[layout::kLookMore].w > 0;
    if (tumbles || !(in_pixels || facing == static_cast<float>(ParticleFacing::Camera))) {
        return 0;
    }
    const float size = (look[0].x - look[0].y) * size_factor(instance, look);
    const Affine& camera = view.world_from_camera;
    const Vec3 to_center = instance.position - transform_point(camera, Vec3(0));
    if (in_pixels) {
        const Vec4& fall = look[layout::kLookMore + 1];
        const float away = glm::length(to_center);
        return size / std::sqrt(std::max(fall.x + away * (fall.y + away * fall.z), 1e-12f));
    }
    const float ahead = glm::dot(to_center, transform_vector(camera, Vec3(0, 0, -1)));
    return size * static_cast<float>(view.height)
           / (2 * view.tangent.y * std::max(ahead, view.near));
}

void append_particles(
    const ParticlePool& pool, std::uint32_t look, float back,
    std::vector<ParticleInstance>& instances, const Vec3& observer) {
    const std::size_t before = instances.size();
    instances.resize(before + pool.size());
    const std::size_t packed = pack_particles(
        pool, {.look = look, .back = back, .observer = observer},
        std::span(instances).subspan(before));
    instances.resize(before + packed);
}

}  // namespace limn
