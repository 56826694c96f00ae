// What passes read and write of the frame buffer: the bytes of formats, of levels and layers, and
// of what blends or tests depth without writing it.

#include "ecs/components/particles.h"
#include "ecs/components/time.h"
#include "render/gpu/texture.h"
#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/particle_fixture.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <array>
#include <string_view>
#include <vector>

namespace limn::test::frame_traffic_test {
namespace {

void nothing(PassContext&) {}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest, "frame traffic: floats cost four times the memory of bytes, depth of 16 bits half"
                    * technique("engine.opt-framebuffer")) {
    CHECK(gpu::format_info(GL_RGBA8).bytes == 4);
    CHECK(gpu::format_info(GL_RGBA16F).bytes == 8);
    CHECK(gpu::format_info(GL_RGBA32F).bytes == 16);
    CHECK(gpu::format_info(GL_R11F_G11F_B10F).bytes == 4);
    CHECK(gpu::format_info(GL_DEPTH_COMPONENT16).bytes == 2);
    CHECK(gpu::format_info(GL_DEPTH_COMPONENT24).bytes == 4);
    CHECK(gpu::format_info(GL_DEPTH_COMPONENT32F).bytes == 4);
    for (const GLenum format : {GL_RGBA8, GL_RGBA16F, GL_RGBA32F}) {
        CAPTURE(gpu::format_info(format).name);
        FrameGraph graph(device());
        graph.begin_frame();
        const TextureId image =
            graph.create({.name = "image", .format = format, .width = 30, .height = 20});
        graph.add_pass("draw", {}, {cleared(image)}, nothing);
        graph.keep(image);
        graph.execute();
        const auto bytes = static_cast<std::size_t>(600 * gpu::format_info(format).bytes);
        REQUIRE(graph.traffic().size() == 1);
        CHECK(graph.traffic()[0].written_bytes == bytes);
        REQUIRE(graph.targets().size() == 1);
        CHECK(graph.targets()[0].bytes == bytes);
        CHECK(graph.targets()[0].bytes_per_pixel == gpu::format_info(format).bytes);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "frame traffic: a pass counts what it attaches and reads, each level and layer once"
                    * technique("engine.opt-framebuffer")) {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId source =
        graph.create({.name = "source", .format = GL_RGBA8, .width = 16, .height = 8});
    const TextureId depth =
        graph.create({.name = "depth", .format = GL_DEPTH_COMPONENT16, .width = 32, .height = 32});
    const TextureId pyramid = graph.create(
        {.name = "pyramid", .format = GL_RGBA16F, .width = 32, .height = 32, .levels = 3});
    const TextureId cube = graph.create(
        {.name = "cube",
         .format = GL_R32F,
         .width = 16,
         .height = 16,
         .levels = 2,
         .target = GL_TEXTURE_CUBE_MAP});
    const TextureId unused = graph.create({.name = "unused", .format = GL_RGBA32F, .width = 64});
    const BufferId buffer = graph.create_buffer({.name = "buffer", .bytes = 1000});
    graph.add_pass("source", {}, {cleared(source)}, nothing);
    graph.add_pass("scene", {source}, {cleared(pyramid), cleared(depth)}, nothing);
    graph.add_pass("levels", {}, {image(pyramid)}, nothing);
    graph.add_pass("face", {depth}, {target_level(cleared(cube), 1, 4)}, nothing);
    graph.add_pass("list", {pyramid, depth_tested(depth)}, {buffer}, nothing);
    graph.always_run();
    graph.add_pass("never", {}, {cleared(unused)}, nothing);
    graph.keep(cube);
    for (const TextureId kept : {pyramid, depth}) {
        graph.keep(kept);
    }
    graph.execute();
    struct Expected {
        std::string_view pass;
        std::size_t read;
        std::size_t written;
    };
    constexpr std::size_t kSource = 16 * 8 * 4;
    constexpr std::size_t kDepth = 32 * 32 * 2;
    constexpr std::size_t kLevel = 32 * 32 * 8;
    constexpr std::size_t kLevels = (32 * 32 + 16 * 16 + 8 * 8) * 8;
    const std::vector<PassTraffic> traffic = graph.traffic();
    const auto find = [&](std::string_view name) {
        for (const PassTraffic& pass : traffic) {
            if (pass.name == name) {
                return pass;
            }
        }
        return PassTraffic{};
    };
    for (const Expected& expected :
         {Expected{"source", 0, kSource}, Expected{"scene", kSource, kLevel + kDepth},
          Expected{"levels", 0, kLevels}, Expected{"face", kDepth, 8 * 8 * 4},
          Expected{"list", kLevels + kDepth, 1000}, Expected{"never", 0, 0}}) {
        CAPTURE(expected.pass);
        CHECK(find(expected.pass).read_bytes == expected.read);
        CHECK(find(expected.pass).written_bytes == expected.written);
    }
    std::size_t all = 0;
    for (const TargetCost& target : graph.targets()) {
        all += target.bytes;
    }
    const std::size_t cube_bytes = std::size_t{6} * (16 * 16 + 8 * 8) * 4;
    CHECK(all == kSource + kDepth + kLevels + cube_bytes);
}

TEST_CASE_FIXTURE(
    Scene, "frame traffic: opaque surfaces do not blend, whatever their alpha"
               * technique("engine.opt-framebuffer")) {
    const MeshId square = add(make_square());
    Material front;
    front.shading = ShadingModel::Unlit;
    front.base_color = {0.25f, 0.5f, 1, 0.5f};
    Material back = front;
    back.base_color = {1, 0, 0, 1};
    place(square, add(back), at({0, 0, -0.25f}));
    place(square, add(front), at({0, 0, 0}));
    const Vec3 center = rgb_at(radiance(look({0, 0, 1}, {0, 0, 0})), 32, 32);
    for (int c = 0; c < 3; ++c) {
        CHECK(center[c] == near(front.base_color[c]).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(
    Scene, "frame traffic: particles that add light write no depth, and so hide none behind them"
               * technique("engine.opt-framebuffer")) {
    world.insert_resource(FrameTime{});
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0});
    const gpu::FloatImage depth = aov(view, "depth");
    ParticleLook look;
    look.size = 0.5f;
    look.colors = {{.at = 0, .color = {1, 1, 1}, .opacity = 1}};
    look.emission = 1;
    look.lit = 0;
    look.cover = 0;
    look.softness = 0;
    const auto brightness = [&](const std::vector<Vec3>& positions) {
        const Entity emitter = world.create(ParticleEmitter{}, look, pool_at(positions));
        const float center = rgb_at(radiance(view), 32, 32).x;
        CHECK(largest_difference(aov(view, "depth"), depth) == 0);
        world.destroy(emitter);
        return center;
    };
    const Vec3 near_one = {0, 0, 0.4f};
    const Vec3 far_one = {0, 0, 0.2f};
    const float none = brightness({{9, 9, 0}});
    const float sum = brightness({near_one}) + brightness({far_one}) - none;
    CHECK(sum > none + 0.5f);
    CHECK(brightness({near_one, far_one}) == near(sum).epsilon(1e-3));
    CHECK(brightness({far_one, near_one}) == near(sum).epsilon(1e-3));
}

}  // namespace limn::test::frame_traffic_test
