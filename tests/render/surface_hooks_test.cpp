#include "ecs/components/surface.h"
#include "render/geometry/surface_draws.h"
#include "render/gpu/shader_library.h"
#include "render/material/relief_hook.h"
#include "render/material/surface_features.h"
#include "render/material/wrinkle_hook.h"
#include "render/shaders/material_maps_gpu.h"
#include "tests/render/render_fixture.h"
#include "tests/render/shader_eval.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace limn::test::surface_hooks_test {
namespace {

constexpr HookPoint kAddPoints[] = {HookPoint::Color, HookPoint::Uv};
constexpr HookPoint kScalePoints[] = {HookPoint::Color};
constexpr SurfaceHook kAdd = {
    .name = "add", .points = kAddPoints, .definitions = {}, .add = nullptr};
constexpr SurfaceHook kScale = {
    .name = "scale", .points = kScalePoints, .definitions = {}, .add = nullptr};
constexpr HookPoint kBothPoints[] = {HookPoint::Color, HookPoint::Uv};

/// What the hook points make of 1, in the order of `hooks`.
Vec4 result_of(const std::vector<const SurfaceHook*>& hooks) {
    const std::string functions = R"(
void add_color(inout vec4 color) { color += 1.0; }
void scale_color(inout vec4 color) { color *= 3.0; }
void add_uv(inout vec4 uv) { uv += 0.5; }
)";
    return evaluate_shader(
        functions + hooks_glsl(hooks, &SurfaceHook::surface_file, kBothPoints),
        "vec4 a = x; hook_color(a); vec4 b = x; hook_uv(b); y = vec4(a.xy, b.xy);", {Vec4(1)})[0];
}

/// Of a material with a wrinkle map, drawn for an instance with these bits.
SurfaceFeatures features_for(unsigned instance) {
    SurfaceFeatures features;
    features.maps.set(layout::kWrinkleSlot, 2);
    HookBits bits;
    bits.set(kWrinkleHook, static_cast<std::uint16_t>(instance));
    add_hooks(features, bits);
    return features;
}

}  // namespace

TEST_CASE("surface hooks: a point calls each hook that has it, in the order of the list") {
    CHECK(result_of({&kAdd, &kScale}) == Vec4(6, 6, 1.5f, 1.5f));
    CHECK(result_of({&kScale, &kAdd}) == Vec4(4, 4, 1.5f, 1.5f));
    CHECK(result_of({&kScale}) == Vec4(3, 3, 1, 1));
    CHECK(result_of({}) == Vec4(1));
}

TEST_CASE("surface hooks: only skin that wrinkles reads its wrinkle map, and not for its strain") {
    CHECK_FALSE(features_for(0).maps.has(layout::kWrinkleSlot));
    const SurfaceFeatures plain = features_for(kWrinkled);
    CHECK(plain.maps.has(layout::kWrinkleSlot));
    CHECK(plain.hooks == HookBits{});
    const SurfaceFeatures strain = features_for(kWrinkled | kWrinkleView);
    CHECK_FALSE(strain.maps.has(layout::kWrinkleSlot));
    CHECK(strain.hooks.of(kWrinkleHook) == kWrinkleView);

    SurfaceFeatures without_map;
    HookBits blend;
    blend.set(kWrinkleHook, kWrinkled | kWrinkleBlend);
    add_hooks(without_map, blend);
    CHECK(without_map == SurfaceFeatures{});
}

TEST_CASE("surface hooks: depth and motion need only the bits that move vertices") {
    const SurfaceFeatures all =
        features_for(kWrinkled | kWrinkleBlend | kWrinkleFade | kWrinkleDisplaced);
    const SurfaceFeatures moving = moving_features(all);
    CHECK(moving.hooks.of(kWrinkleHook) == kWrinkleDisplaced);
    CHECK(moving.maps == MapUnits{});
    CHECK(moving_features(features_for(kWrinkled | kWrinkleBlend)) == SurfaceFeatures{});
}

TEST_CASE("surface hooks: depth and motion of displaced meshes need the map that moves them") {
    SurfaceFeatures features;
    features.maps.set(layout::kBaseColorSlot, 0);
    features.maps.set(layout::kReliefSlot, 1);
    features.bits = kUvMaps | kVertexColor;
    features.hooks = material_hooks(Material{.detail = SurfaceDetail::Displaced});
    add_hooks(features, {});
    CHECK(is_tessellated(features));
    const SurfaceFeatures moving = moving_features(features);
    CHECK(is_tessellated(moving));
    CHECK(moving.maps.unit(layout::kReliefSlot) == 1);
    CHECK_FALSE(moving.maps.has(layout::kBaseColorSlot));
    CHECK(moving.bits == kUvMaps);
    remove_off_mesh_hooks(features);
    CHECK_FALSE(is_tessellated(features));
    CHECK(features.maps.has(layout::kBaseColorSlot));
}

TEST_CASE("surface hooks: each bit of wrinkles is a definition of its own") {
    Variant variant;
    add_features(variant, features_for(kWrinkled | kWrinkleBlend | kWrinkleFlat));
    Variant expected("WRINKLE_BLEND");
    expected.add("WRINKLE_FLAT");
    expected.add("WRINKLE_MAP", 2);
    CHECK(variant == expected);
}

TEST_CASE_FIXTURE(
    RenderTest, "surface hooks: relief can shift coordinates, bend normals and mark samples") {
    static constexpr HookPoint kPoints[] = {
        HookPoint::Uv, HookPoint::Color, HookPoint::Normal, HookPoint::Sample};
    static constexpr SurfaceHook kRelief = {
        .name = "relief",
        .points = kPoints,
        .definitions = {},
        .surface_file = "lib/relief_surface.glsl",
        .add = nullptr};
    const SurfaceHook* const hooks[] = {&kWrinkleHook, &kRelief};
    gpu::ShaderFiles files = gpu::ShaderFiles::standard();
    files.put(
        "generated/surface_hooks.glsl", hooks_glsl(hooks, &SurfaceHook::surface_file, kPoints));
    files.put("lib/relief_surface.glsl", R"(#include "lib/view.glsl"
void relief_uv(inout vec4 uv) {
    vec3 bitangent = cross(normal_ws, tangent_ws.xyz) * tangent_ws.w;
    vec3 to_camera = view.ray_forward.xyz;
    float height = texture(material_maps[BASE_COLOR_MAP], map_texcoord(kBaseColorSlot)).a;
    uv.xy += height * vec2(dot(to_camera, tangent_ws.xyz), dot(to_camera, bitangent));
}
void relief_color(inout vec4 color) { color.a = 1.0; }
void relief_normal(inout vec3 normal) { normal.xy += dFdx(map_uv.xy); }
void relief_sample(inout SurfaceSample s, vec3 smooth_normal) {
    s.occlusion *= dot(s.normal_ws, smooth_normal);
}
)");
    gpu::ShaderLibrary library(device().caps(), files);
    for (const std::vector<gpu::ShaderDefine>& defines :
         {std::vector<gpu::ShaderDefine>{{"BASE_COLOR_MAP", "0"}},
          {{"BASE_COLOR_MAP", "0"}, {"NORMAL_MAP", "1"}, {"WRINKLE_MAP", "2"}}}) {
        const auto program =
            library.load({.vertex = "mesh.vert", .fragment = "gbuffer.frag", .defines = defines});
        CHECK_MESSAGE(program.ok(), (program ? "" : program.error().message));
    }
}

}  // namespace limn::test::surface_hooks_test
