#include "ecs/components/name.h"
#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace limn::test::render_frame_test {

TEST_CASE_FIXTURE(Scene, "render frame: an empty world is a black image of the requested size") {
    for (const IVec2& size : {IVec2(1, 1), IVec2(3, 200), IVec2(257, 65)}) {
        const FrameOutput out = draw(look({0, 0, 1}, {0, 0, 0}, size.x, size.y));
        const gpu::FloatImage image = gpu::read_floats(*out.radiance);
        CHECK(image.width == size.x);
        CHECK(image.height == size.y);
        for (const float value : image.pixels) {
            CHECK(value == 0);
        }
        CHECK(out.statistics.draws == 0);
    }
}

TEST_CASE("render frame: a world without any resource is drawn, too") {
    World world;
    const Affine pose = look_at({0, 0, 1}, {0, 0, 0});
    const FrameOutput out = render_frame(
        shared_renderer(), world, make_render_view({}, pose, pose, {.width = 8, .height = 8}));
    CHECK(out.display != nullptr);
}

TEST_CASE_FIXTURE(
    Scene, "render frame: AOVs are returned by name, in order, unknown ones are left out") {
    const FrameOutput out =
        draw(look({0, 0, 1}, {0, 0, 0}, 8, 8), {.aovs = {"velocity", "nonsense", "depth"}});
    REQUIRE(out.aovs.size() == 2);
    CHECK(out.aovs[0].name == "depth");
    CHECK(out.aovs[0].channels == 1);
    CHECK(out.aovs[1].name == "velocity");
    CHECK(out.aovs[1].channels == 2);
    for (const std::string_view name : aov_names()) {
        INFO(name);
        CHECK(aov_channels(name) > 0);
    }
    CHECK(aov_channels("normal") == 3);
    CHECK(aov_channels("nonsense") == 0);
}

TEST_CASE_FIXTURE(Scene, "render frame: velocity costs nothing unless requested") {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 8, 8);
    static_cast<void>(draw(view));
    CHECK(!frame_graph(shared_renderer()).find("gbuffer.velocity").valid());
    static_cast<void>(draw(view, {.aovs = {"velocity"}}));
    CHECK(frame_graph(shared_renderer()).find("gbuffer.velocity").valid());
}

TEST_CASE("render frame: another world's assets are detected, even at the same address") {
    // Worlds of the same shape one after the other: everything lies at the same addresses.
    for (const Vec3& color : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        Scene scene;
        MeshData mesh = make_square();
        if (color.z == 1) {
            for (Vec3& p : mesh.positions) {
                p *= 0.5f;
            }
        }
        Material material = {.shading = ShadingModel::Unlit, .base_color = Vec4(color, 1)};
        scene.place(scene.add(mesh), scene.add(material), at({0, 0, 0}));
        const gpu::FloatImage image = scene.radiance(scene.look({0, 0, 1}, {0, 0, 0}, 32, 32));
        CHECK(rgb_at(image, 16, 16) == color);
        CHECK(rgb_at(image, 2, 2) == (color.z == 1 ? Vec3(0) : color));
    }
}

TEST_CASE_FIXTURE(
    Scene, "render frame: assets that did not change are not uploaded again"
               * technique("engine.material-bind")) {
    ImageData image = {.name = "white", .width = 1, .height = 1, .pixels = {255, 255, 255, 255}};
    Material material;
    material.base_color_texture.image = add(image);
    place(add(make_square()), add(material), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 8, 8);
    static_cast<void>(draw(view));
    static_cast<void>(draw(view));
    const std::uint64_t deaths = gpu::deletion_count();
    static_cast<void>(draw(view));
    CHECK(gpu::deletion_count() == deaths);
}

TEST_CASE_FIXTURE(Scene, "render frame: assets that are added later are drawn") {
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 8, 8);
    place(
        add(make_square()), add(Material{.shading = ShadingModel::Unlit}),
        affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(3)));
    const Vec3 before = rgb_at(radiance(view), 4, 4);
    // Large enough for the vertex buffers to grow.
    place(
        add(make_ball(300)),
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 1, 0, 1}}),
        at({0, 0, -0.5f}));
    CHECK(rgb_at(radiance(view), 4, 4) == Vec3(0, 1, 0));
    CHECK(before != Vec3(0, 1, 0));
    CHECK(rgb_at(radiance(view), 0, 0) == before);  // what was there before is still right
}

TEST_CASE_FIXTURE(Scene, "render frame: accumulated samples smooth an edge to its coverage") {
    // The square covers the left 37.5 % of the column of pixels 16 .. 23: pixel 19 is half covered.
    const Material white = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
    place(add(make_square()), add(white), at({-1 + (19.5f / 16 - 1), 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    const gpu::FloatImage one =
        gpu::read_floats(*render_accumulated(shared_renderer(), world, view, 1).radiance);
    CHECK((one.at(19, 16, 0) == 0 || one.at(19, 16, 0) == 1));
    const FrameOutput out =
        render_accumulated(shared_renderer(), world, view, 64, {.aovs = {"emission"}});
    const gpu::FloatImage many = gpu::read_floats(*out.radiance);
    CHECK(many.at(18, 16, 0) == test::near(1));
    CHECK(many.at(19, 16, 0) == test::near(0.5).epsilon(0.06));
    CHECK(many.at(20, 16, 0) == test::near(0).scale(1));
    CHECK(gpu::read_floats(*out.aovs[0].texture).at(5, 16, 0) == test::near(1).epsilon(1e-3));
    CHECK(gpu::read_bytes(*out.display).width == 32);
}

TEST_CASE_FIXTURE(
    Scene, "render frame: a mean of what is displayed keeps the edges of lamps smooth") {
    const Material lamp = {
        .shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}, .emission = Vec3(49)};
    place(add(make_square()), add(lamp), at({-1 + (19.5f / 16 - 1), 0, 0}));
    world.insert_resource(Exposure{.ev = 1});
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    const auto mean = [&](SampleMean of) {
        return gpu::read_floats(
            *render_accumulated(shared_renderer(), world, view, 64, {}, of).radiance);
    };
    const gpu::FloatImage light = mean(SampleMean::Light);
    const gpu::FloatImage displayed = mean(SampleMean::Displayed);
    const float inside = light.at(18, 16, 0);
    const float covered = light.at(19, 16, 0) / inside;
    CHECK(covered == test::near(0.5).epsilon(0.06));
    CHECK(displayed.at(18, 16, 0) == test::near(inside).epsilon(1e-3));
    CHECK(displayed.at(20, 16, 0) == 0);
    // c / (1 + 2 c) is averaged.
    const float compressed = covered * inside / (1 + 2 * inside);
    CHECK(displayed.at(19, 16, 0) == test::near(compressed / (1 - 2 * compressed)).epsilon(1e-3));
}

TEST_CASE_FIXTURE(
    Scene, "render frame: the same world twice is the same image, bit for bit"
               * technique("engine.draw-frame, engine.main-loop")) {
    world.insert_resource(Environment{.sky = SkyKind::Studio});
    place(add(make_ball()), add(Material{.metalness = 1, .roughness = 0.2f}), at({0, 0, 0}));
    shine(PointLight{}, at({1, 1, 2}));
    const RenderView view = look({0, 0, 2}, {0, 0, 0});
    const gpu::ByteImage first = gpu::read_bytes(*draw(view).display);
    const gpu::ByteImage second = gpu::read_bytes(*draw(view).display);
    CHECK(first.pixels == second.pixels);
}

TEST_CASE("render view: sample positions fill the pixel evenly, one sample is its center") {
    CHECK(sample_jitter(0, 1) == Vec2(0));
    for (const int count : {16, 64, 256}) {
        Vec2 sum = {0, 0};
        int quadrants[4] = {};
        for (int i = 0; i < count; ++i) {
            const Vec2 j = sample_jitter(i, count);
            CHECK(std::abs(j.x) <= 0.5f);
            CHECK(std::abs(j.y) <= 0.5f);
            sum += j;
            ++quadrants[(j.x > 0 ? 1 : 0) + (j.y > 0 ? 2 : 0)];
        }
        CHECK(glm::length(sum / static_cast<float>(count)) < 0.08f);
        // Every column of `count` has about one: no two samples see the same edge.
        std::vector<float> xs;
        for (int i = 0; i < count; ++i) {
            xs.push_back(sample_jitter(i, count).x);
        }
        std::sort(xs.begin(), xs.end());
        for (std::size_t i = 1; i < xs.size(); ++i) {
            CHECK(xs[i] - xs[i - 1] > 0.2f / static_cast<float>(count));
            CHECK(xs[i] - xs[i - 1] < 4.0f / static_cast<float>(count));
        }
        for (const int n : quadrants) {
            CHECK(std::abs(n - count / 4) <= 2);
        }
    }
}

TEST_CASE("render view: cameras are found by name, else the first active one") {
    World world;
    CHECK(!find_camera(world));
    const Entity off = world.create(Camera{.active = false}, WorldTransform{}, Name{"off"});
    const Entity on = world.create(Camera{}, WorldTransform{}, Name{"on"});
    world.create(Camera{}, WorldTransform{});
    CHECK(find_camera(world) == on);
    CHECK(find_camera(world, "off") == off);
    CHECK(!find_camera(world, "none"));
}

TEST_CASE("render view: a scaled or sheared camera has the view of a rigid one") {
    const Affine pose = look_at({1, 2, 3}, {0, 0, 0});
    const Affine scaled = pose * affine_from({0, 0, 0}, {1, 0, 0, 0}, {3, 0.5f, 2});
    const RenderView a = make_render_view({}, pose, pose);
    const RenderView b = make_render_view({}, scaled, scaled);
    for (int i = 0; i < 4; ++i) {
        CHECK(glm::length(a.clip_from_world[i] - b.clip_from_world[i]) < 1e-5f);
    }
}

TEST_CASE_FIXTURE(
    Scene, "render frame: with a pinhole and no motion, any number of samples gives the same image"
               * technique("post.distributed-sampling")) {
    place(add(make_ball(12)), add(Material{}), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.7f)));
    shine(PointLight{.intensity = 7}, at({1, 1, 1}));
    world.insert_resource(Environment{});
    const RenderView view = look({0, 0, 1.5f}, {0, 0, 0}, 40, 32);
    static_cast<void>(draw(view));
    const gpu::FloatImage picture = radiance(view);
    const gpu::ByteImage shown = gpu::read_bytes(*draw(view).display);
    for (const int samples : {1, 4, 9, 16, 64}) {
        CAPTURE(samples);
        begin_accumulation(shared_renderer(), {40, 32}, SampleKind::Instant);
        for (int i = 0; i < samples; ++i) {
            const Vec2 lens = {std::cos(static_cast<float>(i)), std::sin(static_cast<float>(i))};
            accumulate(
                shared_renderer(), world, with_lens_sample(view, lens),
                1.0f / static_cast<float>(samples));
        }
        const FrameOutput mean = finish_accumulation(shared_renderer(), world, view);
        CHECK(gpu::read_bytes(*mean.display).pixels == shown.pixels);
        // A sum of floats rounds: by a unit in the last place a sample.
        CHECK(largest_difference(gpu::read_floats(*mean.radiance), picture) < 2e-6f);
    }
}

}  // namespace limn::test::render_frame_test
