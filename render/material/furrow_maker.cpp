#include "render/material/furrow_maker.h"

#include "ecs/base/check.h"
#include "render/gpu/buffer.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/furrow_gpu.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <vector>

// Techniques: wrinkle.furrow.trace

namespace limn {
namespace {

constexpr float kThreads = 64;           // per work group
constexpr float kMaxRounds = 32768;      // loop iterations per dispatch; llvmpipe stops at 65,535
constexpr float kRoundsPerSegment = 48;  // not counting those over the pixels around it
constexpr int kMaxSegments = 1024;       // per dispatch

/// Layout of furrow_trace.comp.
struct Progress {
    std::uint32_t next = 0;
    std::uint32_t furrow = 0;
    std::uint32_t backward = 0;
    std::uint32_t segment = 0;
    Vec2 position = {0, 0};
    std::int32_t left = 0;
    std::int32_t unused = 0;
};

/// Segments that one dispatch may draw.
int segment_budget(const FurrowStyle& style) {
    const FurrowFunctions& f = style.functions;
    const auto largest = [](const Vec2& line) { return std::max(line.x, line.x + 2.0f * line.y); };
    const float radius =
        style.scale * (largest(f.length) + largest(f.density) + 2.0f * f.width) + 4.0f;
    return std::clamp(
        static_cast<int>(
            kMaxRounds / (kRoundsPerSegment + 2.0f * radius + radius * radius / kThreads)),
        1, kMaxSegments);
}

void set_image(const gpu::Program& program, const FurrowMap& map) {
    program.set("size", map.size);
    program.set("wraps", IVec2(map.wrap_s ? 1 : 0, map.wrap_t ? 1 : 0));
}

void set_style(const gpu::Program& program, const FurrowMap& map, const FurrowStyle& style) {
    const FurrowFunctions& f = style.functions;
    program.set("angle_length", Vec4(f.angle, f.length));
    program.set("density_limit", Vec4(f.density, f.limit));
    program.set("width_depth", Vec2(f.width, f.depth));
    program.set("scale", style.scale);
    program.set("literal_turn", style.literal_turn ? 1 : 0);
    const PhiloxKey first = furrow_turns(style, map.stream[0], 0, false, 0).key();
    const PhiloxKey second = furrow_turns(style, map.stream[1], 0, false, 0).key();
    program.set("first_key_x", first[0]);
    program.set("first_key_y", first[1]);
    program.set("second_key_x", second[0]);
    program.set("second_key_y", second[1]);
}

}  // namespace

Result<FurrowMaker> create_furrow_maker(gpu::Device& device) {
    return FurrowMaker{
        LIMN_TRY(device.shaders().load({.compute = "furrow_trace.comp"})),
        LIMN_TRY(device.shaders().load({.compute = "furrow_maps.comp"}))};
}

FurrowTextures make_furrow_textures(
    gpu::Device& device, const FurrowMaker& maker, const FurrowMap& map,
    std::span<const std::int32_t> cover, const FurrowStyle& style) {
    const auto pixels = static_cast<std::size_t>(map.size.x) * static_cast<std::size_t>(map.size.y);
    LIMN_CHECK(cover.size() == pixels && pixels > 0);
    const gpu::Buffer triangles =
        gpu::Buffer::of("furrow triangles", std::span<const FurrowTriangle>(map.triangles));
    const gpu::Buffer covered = gpu::Buffer::of("furrow cover", cover);
    const gpu::Buffer cells = gpu::Buffer::of(
        "furrow cells", std::span<const std::uint32_t>(std::vector<std::uint32_t>(2 * pixels)));
    const gpu::Buffer heights = gpu::Buffer::of(
        "furrow heights", std::span<const std::uint32_t>(std::vector<std::uint32_t>(
                              2 * pixels, std::bit_cast<std::uint32_t>(1.0f))));
    std::array<Progress, 2> now = {};
    const gpu::Buffer progress = gpu::Buffer::of("furrow progress", std::span<const Progress>(now));

    device.use(*maker.trace);
    set_image(*maker.trace, map);
    set_style(*maker.trace, map, style);
    maker.trace->set("triangle_count", static_cast<int>(map.triangles.size()));
    maker.trace->set("budget", segment_budget(style));
    device.bind_storage(layout::kFurrowTrianglesBinding, triangles);
    device.bind_storage(layout::kFurrowCoverBinding, covered);
    device.bind_storage(layout::kFurrowCellsBinding, cells);
    device.bind_storage(layout::kFurrowHeightsBinding, heights);
    device.bind_storage(layout::kFurrowProgressBinding, progress);
    const std::size_t starts = map.triangles.size() + pixels;
    const auto grows = [starts](const Progress& p) { return p.furrow != 0 || p.next < starts; };
    while (grows(now[0]) || grows(now[1])) {
        device.dispatch(2);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        progress.read(0, std::as_writable_bytes(std::span(now)));
    }

    FurrowTextures textures = {
        gpu::Texture(
            "furrow heights", {.format = GL_RGBA32F, .width = map.size.x, .height = map.size.y}),
        gpu::Texture(
            "furrow normals", {.format = GL_RGBA16F, .width = map.size.x, .height = map.size.y})};
    device.use(*maker.maps);
    set_image(*maker.maps, map);
    const PhiloxKey key = furrow_noise(style, 0).key();
    maker.maps->set("key_x", key[0]);
    maker.maps->set("key_y", key[1]);
    maker.maps->set("noise", style.noise);
    maker.maps->set("bump", style.bump);
    device.bind_image(layout::kFurrowHeightImage, textures.height, GL_WRITE_ONLY);
    device.bind_image(layout::kFurrowNormalImage, textures.normal, GL_WRITE_ONLY);
    device.dispatch_over(map.size.x, map.size.y, 8);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
    return textures;
}

}  // namespace limn
