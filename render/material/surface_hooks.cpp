#include "render/material/surface_hooks.h"

#include "ecs/base/check.h"
#include "ecs/components/surface.h"
#include "render/material/fur_hook.h"
#include "render/material/relief_hook.h"
#include "render/material/surface_features.h"
#include "render/material/wrinkle_hook.h"
#include "render/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace limn {
namespace {

constexpr const SurfaceHook* kSurfaceHooks[] = {
    &kReliefHook,
    &kWrinkleHook,
    &kFurHook,
};
static_assert(std::size(kSurfaceHooks) <= kMaxSurfaceHooks);

constexpr std::uint64_t kHookBits = 16;

/// Offset of a hook's bits in HookBits.
std::size_t first_bit(const SurfaceHook& hook) {
    const auto* const found = std::find(std::begin(kSurfaceHooks), std::end(kSurfaceHooks), &hook);
    LIMN_CHECK_NOTE(found != std::end(kSurfaceHooks), "the hook is not in the list");
    return kHookBits * static_cast<std::size_t>(found - std::begin(kSurfaceHooks));
}

/// The GLSL parameters of a hook point, and its arguments.
struct PointText {
    const char* name;
    const char* parameters;
    const char* arguments;
};
/// In the order of HookPoint.
constexpr PointText kPointTexts[] = {
    {"position", "inout vec3 position", "position"},
    {"vertex", "inout vec3 tangent, vec3 normal", "tangent, normal"},
    {"uv", "inout vec4 uv", "uv"},
    {"color", "inout vec4 color", "color"},
    {"normal", "inout vec3 normal", "normal"},
    {"sample", "inout SurfaceSample s, vec3 smooth_normal", "s, smooth_normal"},
};

/// With the maps that it reads, and their texture coordinates.
void add_hook(
    SurfaceFeatures& depth_only, const SurfaceFeatures& features, const SurfaceHook& hook,
    unsigned bits) {
    if (bits == 0) {
        return;
    }
    depth_only.hooks.set(hook, static_cast<std::uint16_t>(depth_only.hooks.of(hook) | bits));
    if (hook.maps != 0) {
        depth_only.maps.add(features.maps, hook.maps);
        depth_only.bits |= features.bits & (kUvMap | kUvMaps);
    }
}

}  // namespace

std::uint16_t HookBits::of(const SurfaceHook& hook) const {
    return static_cast<std::uint16_t>(bits_ >> first_bit(hook));
}

void HookBits::set(const SurfaceHook& hook, std::uint16_t bits) {
    const std::size_t first = first_bit(hook);
    bits_ = (bits_ & ~(std::uint64_t{0xffff} << first)) | std::uint64_t{bits} << first;
}

std::span<const SurfaceHook* const> surface_hooks() {
    return kSurfaceHooks;
}

HookBits material_hooks(const Material& material) {
    HookBits bits;
    for (const SurfaceHook* hook : kSurfaceHooks) {
        if (hook->of_material != nullptr) {
            bits.set(*hook, hook->of_material(material));
        }
    }
    return bits;
}

void add_hooks(SurfaceFeatures& features, const HookBits& instance) {
    for (const SurfaceHook* hook : kSurfaceHooks) {
        hook->add(features, instance.of(*hook));
    }
}

void add_moving_hooks(SurfaceFeatures& depth_only, const SurfaceFeatures& features) {
    for (const SurfaceHook* hook : kSurfaceHooks) {
        add_hook(depth_only, features, *hook, features.hooks.of(*hook) & hook->moving);
    }
}

bool is_off_mesh(const SurfaceFeatures& features) {
    return std::ranges::any_of(kSurfaceHooks, [&](const SurfaceHook* hook) {
        return (features.hooks.of(*hook) & hook->off_mesh) != 0;
    });
}

void add_off_mesh_hooks(SurfaceFeatures& depth_only, const SurfaceFeatures& features) {
    for (const SurfaceHook* hook : kSurfaceHooks) {
        const unsigned bits = features.hooks.of(*hook);
        add_hook(depth_only, features, *hook, (bits & hook->off_mesh) != 0 ? bits : 0u);
    }
}

void remove_off_mesh_hooks(SurfaceFeatures& features) {
    for (const SurfaceHook* hook : kSurfaceHooks) {
        const unsigned by_maps = hook->off_mesh | (hook->maps != 0 ? hook->moving : 0u);
        if ((features.hooks.of(*hook) & by_maps) != 0) {
            features.hooks.set(*hook, 0);
            features.maps.remove_all(hook->maps);
        }
    }
}

void add_hook_definitions(Variant& variant, const HookBits& hooks) {
    for (const SurfaceHook* hook : kSurfaceHooks) {
        const std::uint16_t bits = hooks.of(*hook);
        for (const HookDefinition& definition : hook->definitions) {
            variant.add_if((bits & definition.bit) != 0, definition.name);
        }
    }
}

std::string hooks_glsl(
    std::span<const SurfaceHook* const> hooks, const char* SurfaceHook::*file,
    std::span<const HookPoint> points) {
    std::string text;
    for (const SurfaceHook* hook : hooks) {
        if (hook->*file != nullptr) {
            text += fmt::format("#include \"{}\"\n", hook->*file);
        }
    }
    for (const HookPoint point : points) {
        const PointText& glsl = kPointTexts[static_cast<std::size_t>(point)];
        text += fmt::format("void hook_{}({}) {{\n", glsl.name, glsl.parameters);
        for (const SurfaceHook* hook : hooks) {
            if (std::find(hook->points.begin(), hook->points.end(), point) != hook->points.end()) {
                text += fmt::format("    {}_{}({});\n", hook->name, glsl.name, glsl.arguments);
            }
        }
        text += "}\n";
    }
    return text;
}

std::string position_hooks_glsl() {
    constexpr HookPoint kPoints[] = {HookPoint::Position};
    return hooks_glsl(kSurfaceHooks, &SurfaceHook::position_file, kPoints);
}

std::string vertex_hooks_glsl() {
    constexpr HookPoint kPoints[] = {HookPoint::Vertex};
    return hooks_glsl(kSurfaceHooks, &SurfaceHook::vertex_file, kPoints);
}

std::string surface_hooks_glsl() {
    constexpr HookPoint kPoints[] = {
        HookPoint::Uv, HookPoint::Color, HookPoint::Normal, HookPoint::Sample};
    return hooks_glsl(kSurfaceHooks, &SurfaceHook::surface_file, kPoints);
}

}  // namespace limn
