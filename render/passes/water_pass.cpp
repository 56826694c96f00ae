#include "render/passes/water_pass.h"

#include "render/gpu/shader_library.h"
#include "render/water/foam_pattern.h"

#include <array>

namespace limn {

namespace {

constexpr unsigned kPatchesUnit = 0;
constexpr unsigned kBehindUnit = 5;
constexpr unsigned kReflectionMapUnit = 22;
constexpr unsigned kDetailMapUnit = 23;
constexpr unsigned kDetailWavesUnit = 24;
constexpr unsigned kDetailsUnit = 25;
constexpr unsigned kDistanceUnit = 26;
constexpr unsigned kFoamUnit = 29;
constexpr unsigned kFloorMapUnit = 27;
constexpr std::uint32_t kVelocityKey = 1u << 31;  ///< beside those of lighting_key
constexpr std::uint32_t kOceanKey = 1u << 30;
constexpr std::uint32_t kLooksKey = 1u << 29;
constexpr std::uint32_t kPlanarKey = 1u << 28;
constexpr std::uint32_t kUntracedKey = 1u << 27;
constexpr std::uint32_t kDetailKey = 1u << 26;
constexpr std::uint32_t kDetailMapKey = 1u << 25;
constexpr std::uint32_t kFromBelowKey = 1u << 24;
constexpr std::uint32_t kFloorMapKey = 1u << 23;
constexpr std::uint32_t kUnbentKey = 1u << 22;
constexpr std::uint32_t kAttributesKey = 1u << 21;
constexpr int kCells = layout::kWaterGrid;
constexpr int kSide = kCells + 1;
constexpr int kIndices = 6 * kCells * kCells;

/// Two triangles a cell, their diagonals in turn so that vertices that slide onto their neighbors
/// leave whole squares.
std::array<std::uint16_t, kIndices> grid_indices() {
    std::array<std::uint16_t, kIndices> indices{};
    std::size_t next = 0;
    for (int z = 0; z < kCells; ++z) {
        for (int x = 0; x < kCells; ++x) {
            const int a = z * kSide + x;
            const int corners[4] = {a, a + 1, a + kSide, a + kSide + 1};
            const bool turned = (x + z) % 2 != 0;
            const int order[2][6] = {{0, 2, 3, 0, 3, 1}, {0, 2, 1, 1, 2, 3}};
            for (const int corner : order[turned ? 1 : 0]) {
                indices[next++] = static_cast<std::uint16_t>(corners[corner]);
            }
        }
    }
    return indices;
}

/// What all waters of a frame ask for, as definitions and the key that tells them apart.
struct Variant {
    std::vector<gpu::ShaderDefine> defines;
    std::uint32_t key = 0;
};

/// Null where no water has any.
const gpu::Texture* detail_map(const FrameScene& scene, const WaterSurfaces& waters) {
    return scene.materials->find_image(waters.list.details.normal_map);
}

const gpu::Texture* floor_map(const FrameScene& scene, const WaterSurfaces& waters) {
    const WaterLook* look = waters.list.floor;
    return look != nullptr ? scene.materials->find_image(look->floor_map) : nullptr;
}

Variant
variant_of(const FrameScene& scene, const WaterSurfaces& waters, bool velocity, bool attributes) {
    Variant variant = {lighting_defines(scene), lighting_key(scene)};
    const auto add = [&](bool wanted, const char* name, std::uint32_t key) {
        if (wanted) {
            variant.defines.push_back({name});
            variant.key |= key;
        }
    };
    const WaterList& list = waters.list;
    add(velocity, "VELOCITY", kVelocityKey);
    add(attributes, "ATTRIBUTES", kAttributesKey);
    add(!waters.seas.empty(), "OCEAN", kOceanKey);
    add(list.looks, "LOOKS", kLooksKey);
    add(list.planar, "PLANAR", kPlanarKey);
    add(list.seen_from_below, "FROM_BELOW", kFromBelowKey);
    add(!list.traced, "UNTRACED", kUntracedKey);
    add(list.details.needed, "DETAIL", kDetailKey);
    add(detail_map(scene, waters) != nullptr, "DETAIL_MAP", kDetailMapKey);
    add(floor_map(scene, waters) != nullptr, "FLOOR_MAP", kFloorMapKey);
    add(!list.bent, "UNBENT", kUnbentKey);
    return variant;
}

void bind_details(gpu::Device& device, const WaterPass& pass, const FrameScene& scene) {
    const WaterSurfaces& waters = pass.surfaces;
    waters.details.bind(device, kDetailsUnit);
    if (const gpu::Texture* map = detail_map(scene, waters)) {
        device.bind_texture(kDetailMapUnit, *map, &pass.repeat);
    }
    if (waters.wave_tiles) {
        device.bind_texture(kDetailWavesUnit, waters.wave_tiles);
    }
}

void bind_foam(gpu::Device& device, WaterPass& pass) {
    if (!pass.foam) {
        constexpr int side = kFoamPatternSide;
        pass.foam =
            gpu::Texture("foam", {.format = GL_R8, .width = side, .height = side, .levels = 0});
        pass.foam.set_wrap(GL_REPEAT);
        int level = 0;
        for (const std::vector<std::uint8_t>& pattern : make_foam_pattern()) {
            pass.foam.upload(std::as_bytes(std::span(pattern)), level++);
        }
    }
    device.bind_texture(kFoamUnit, pass.foam);
}

/// Draws radiance and distance of the scene.
void draw_behind(
    PassContext& context, const WaterPass& pass, const FrameScene& scene, TextureId radiance,
    TextureId depth) {
    context.device().use(gpu::Pipeline{pass.behind, gpu::kFullscreenState});
    bind_view(context.device(), scene);
    context.bind_texture(0, radiance);
    context.bind_texture(1, depth);
    context.device().draw_fullscreen();
}

/// The scene as the water sees it.
struct Behind {
    TextureId radiance;
    TextureId distance;  ///< along the view axis [m], 0: nothing
};

Behind copy_behind(
    FrameGraph& graph, const WaterPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer) {
    const auto create = [&](const char* name, GLenum format) {
        return graph.create(
            {.name = name,
             .format = format,
             .width = scene.view.width,
             .height = scene.view.height});
    };
    const Behind behind = {
        create("behind water", scene.radiance_format), create("distance behind water", GL_R32F)};
    graph.add_pass(
        "behind water", {radiance, gbuffer.depth},
        {discarded(behind.radiance), discarded(behind.distance)},
        [&pass, &scene, radiance, gbuffer](PassContext& context) {
            draw_behind(context, pass, scene, radiance, gbuffer.depth);
        });
    return behind;
}

}  // namespace

Result<WaterPass> create_water_pass(gpu::Device& device) {
    WaterPass pass = {.surface = SurfacePrograms(device, "water.vert", "water.frag")};
    const Result<const gpu::Program*> behind =
        device.shaders().load({.vertex = "fullscreen.vert", .fragment = "water_behind.frag"});
    if (!behind) {
        return behind.error();
    }
    pass.behind = *behind;
    const std::array<std::uint16_t, kIndices> indices = grid_indices();
    pass.indices = gpu::Buffer::of("water grid", std::span<const std::uint16_t>(indices));
    pass.repeat = gpu::Sampler("water detail", {});
    pass.grid = gpu::VertexArray("water grid");
    pass.grid.set_indices(pass.indices);
    return pass;
}

void keep_reflection(
    FrameGraph& graph, WaterPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer) {
    const int width = scene.view.width;
    const int height = scene.view.height;
    if (!pass.reflection || pass.reflection.width() != width
        || pass.reflection.height() != height) {
        pass.reflection = gpu::Texture(
            "water reflection",
            {.format = GL_RGBA32F, .width = width, .height = height, .levels = 0});
    }
    const TextureId target = graph.import("water reflection", pass.reflection);
    graph.add_pass(
        "water reflection", {radiance, gbuffer.depth}, {target_level(discarded(target), 0)},
        [&pass, &scene, radiance, gbuffer](PassContext& context) {
            draw_behind(context, pass, scene, radiance, gbuffer.depth);
        });
    graph.add_pass("water reflection, blurred", {}, {image(target)}, [&pass](PassContext&) {
        pass.reflection.generate_mipmaps();
    });
}

TextureId draw_water(
    FrameGraph& graph, WaterPass& pass, const FrameScene& scene, TextureId radiance,
    const Gbuffer& gbuffer, bool attributes) {
    if (pass.surfaces.list.empty()) {
        return radiance;
    }
    const Behind behind = copy_behind(graph, pass, scene, radiance, gbuffer);
    const bool velocity = gbuffer.velocity.valid();
    const std::vector<Use> reads = lighting_reads(scene, {behind.radiance, behind.distance});
    std::vector<Use> writes = {radiance, gbuffer.depth};
    if (velocity) {
        writes.emplace_back(gbuffer.velocity);
    }
    if (attributes) {
        writes.emplace_back(gbuffer.surface);
    }
    graph.add_pass(
        "water", std::span<const Use>(reads), std::span<const Use>(writes),
        [&pass, &scene, behind, velocity, attributes](PassContext& context) {
            const Variant variant = variant_of(scene, pass.surfaces, velocity, attributes);
            const gpu::Program* program = pass.surface.get(0, variant.key, variant.defines);
            if (program == nullptr) {
                return;
            }
            gpu::Device& device = context.device();
            device.use(gpu::Pipeline{program, {.cull = GL_NONE}});
            bind_lighting(device, scene);
            pass.patches.bind(device, kPatchesUnit);
            bind_water_surfaces(device, pass.surfaces);
            context.bind_texture(kBehindUnit, behind.radiance);
            context.bind_texture(kDistanceUnit, behind.distance);
            if (!pass.surfaces.seas.empty()) {
                bind_foam(device, pass);
            }
            if (pass.surfaces.list.planar) {
                device.bind_texture(kReflectionMapUnit, pass.reflection);
            }
            if (pass.surfaces.list.details.needed) {
                bind_details(device, pass, scene);
            }
            if (const gpu::Texture* floor = floor_map(scene, pass.surfaces)) {
                device.bind_texture(kFloorMapUnit, *floor, &pass.repeat);
                program->set("floor_tile", pass.surfaces.list.floor->floor_tile);
            }
            device.bind_vertex_array(pass.grid);
            device.draw_indexed(
                GL_TRIANGLES, kIndices, GL_UNSIGNED_SHORT, 0, 0,
                static_cast<int>(pass.surfaces.list.patches.size()));
        });
    return radiance;
}

}  // namespace limn
