#include "render/fullscreen.h"
#include "render/graph/frame_graph.h"
#include "render/image.h"
#include "render/shaders/fog_gpu.h"
#include "render/shaders/fullscreen_gpu.h"
#include "tests/render/scene_fixture.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

namespace limn::test::effect_list_test {
namespace {

/// Doubles the radiance of what the camera sees: an effect that the library does not know.
struct DoubleEffect {
    const gpu::Program* copy = nullptr;
    gpu::Texture source{};

    static Result<DoubleEffect> create(gpu::Device& device, const RenderSettings&) {
        return DoubleEffect{LIMN_TRY(
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"}))};
    }
    void draw(FrameGraph& graph, const FrameData&, ViewData& view) {
        const TextureId doubled = create_like(graph, "doubled", view.radiance);
        add_fullscreen_pass(
            graph, "double", {sampled(view.radiance, layout::kSourceUnit)}, {discarded(doubled)},
            copy, [](PassContext&, const gpu::Program& program) { program.set("weight", 2.0f); });
        view.radiance = doubled;
    }
};

/// The standard image and one more effect, before everything that the lens does.
template <typename Effect>
std::vector<EffectEntry> image_with() {
    const std::span<const EffectEntry> standard = standard_image();
    std::vector<EffectEntry> image(standard.begin(), standard.end());
    image.insert(image.end() - 1, effect<Effect>(kMainViews));
    return image;
}

constexpr Vec3 kHaze = {0.25f, 0.5f, 1};

/// Publishes a fog that hides everything, but draws none.
struct HazeEffect {
    static inline bool publishes = false;

    static Result<HazeEffect> create(gpu::Device&, const RenderSettings&) { return HazeEffect{}; }
    bool prepare(const FrameData&, ViewData& view) {
        if (publishes) {
            layout::FogBlock block{};
            block.density = {1e3f, 1e-6f, 0, 0};
            block.ambient = Vec4(kHaze, 0);
            view.publish_block(layout::kFogBinding, block);
        }
        return true;
    }
};

}  // namespace

TEST_CASE_FIXTURE(Scene, "image: an effect from outside the library is one entry of the list") {
    place(add(make_square()), add(Material{.emission = Vec3(0.25f, 0.5f, 1)}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    const std::vector<EffectEntry> image = image_with<DoubleEffect>();
    const RendererPtr renderer =
        *create_renderer(shared_device(), {.full_float = true, .image = image});
    const Vec3 plain = rgb_at(radiance(view), 16, 16);
    const FrameOutput frame = render_frame(*renderer, world, view);
    const Vec3 doubled = rgb_at(gpu::read_floats(*frame.radiance), 16, 16);
    CHECK(plain.z > 0.5f);
    CHECK(doubled.x == 2 * plain.x);
    CHECK(doubled.y == 2 * plain.y);
    CHECK(doubled.z == 2 * plain.z);
    CHECK(frame_graph(*renderer).was_run("double"));
}

TEST_CASE_FIXTURE(
    Scene, "image: a block that an effect publishes is bound for all programs of this frame") {
    const Material glowing = {
        .shading = ShadingModel::Unlit, .alpha_mode = AlphaMode::Blend, .base_color = {1, 0, 0, 1}};
    place(add(make_square()), add(glowing), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 32);
    const std::vector<EffectEntry> image = image_with<HazeEffect>();
    const RendererPtr renderer =
        *create_renderer(shared_device(), {.full_float = true, .image = image});
    const auto draw = [&](bool publishes) {
        HazeEffect::publishes = publishes;
        return rgb_at(gpu::read_floats(*render_frame(*renderer, world, view).radiance), 16, 16);
    };
    const Vec3 clear = draw(false);
    CHECK(clear.x > 0.5f);
    CHECK(clear.z == 0);
    CHECK(glm::distance(draw(true), kHaze) < 1e-4f);
    CHECK(draw(false) == clear);
}

TEST_CASE(
    "image: passes are named by the scope of their view, so that times of views are separate") {
    FrameGraph graph(shared_device());
    graph.begin_frame();
    const TextureId a = graph.create({.name = "a", .width = 4, .height = 4});
    graph.begin_scope("mirror");
    graph.add_pass("clear", {}, {cleared(a)}, [](PassContext&) {});
    graph.end_scope();
    graph.add_pass("clear", {}, {cleared(a)}, [](PassContext&) {});
    graph.always_run();
    graph.keep(a);
    graph.execute();
    CHECK(graph.was_run("clear"));
    CHECK_FALSE(graph.was_run("mirror/clear"));  // its result is cleared again: culled
    CHECK(graph.to_text().find("mirror/clear") != std::string::npos);
}

namespace {

/// A texture that one pass writes and another may read.
struct TwoPasses {
    FrameGraph graph{shared_device()};
    const gpu::Program* copy = nullptr;
    TextureId first, second;

    TwoPasses() {
        copy = *shared_device().shaders().load(
            {.vertex = "fullscreen.vert", .fragment = "accumulate.frag"});
        graph.collect_hazards(true);
        graph.begin_frame();
        first = graph.create({.name = "first", .format = GL_RGBA32F, .width = 4, .height = 4});
        second = graph.create({.name = "second", .format = GL_RGBA32F, .width = 4, .height = 4});
        graph.add_pass("write", {}, {cleared(first, Vec4(1))}, [](PassContext&) {});
        graph.keep(first);
        graph.keep(second);
    }
    /// Draws into `second` what is at unit 0.
    void draw(PassContext& context) const {
        context.device().use(gpu::Pipeline{copy, gpu::kFullscreenState});
        copy->set("weight", 1.0f);
        context.device().draw_fullscreen();
    }
};

}  // namespace

TEST_CASE_FIXTURE(TwoPasses, "image: reading what a pass writes without declaring it is a hazard") {
    const gpu::Texture* written = nullptr;
    graph.add_pass("peek", {first}, {cleared(second)}, [&](PassContext& context) {
        written = &context.texture(first);
    });
    graph.add_pass("sneak", {}, {second}, [&](PassContext& context) {
        context.device().bind_texture(layout::kSourceUnit, *written);
        draw(context);
    });
    graph.execute();
    REQUIRE(graph.hazards().size() == 1);
    CHECK(graph.hazards()[0].find("pass sneak") != std::string::npos);
    CHECK(graph.hazards()[0].find("first") != std::string::npos);
}

TEST_CASE_FIXTURE(TwoPasses, "image: reading the texture that the pass draws to is a hazard") {
    graph.add_pass("feedback", {}, {cleared(second)}, [&](PassContext& context) {
        context.device().bind_texture(layout::kSourceUnit, context.texture(second));
        draw(context);
    });
    graph.execute();
    REQUIRE(graph.hazards().size() == 1);
    CHECK(graph.hazards()[0].find("while the pass draws to it") != std::string::npos);
}

TEST_CASE_FIXTURE(TwoPasses, "image: a declared read is no hazard") {
    graph.add_pass(
        "copy", {sampled(first, layout::kSourceUnit)}, {discarded(second)},
        [&](PassContext& context) { draw(context); });
    graph.execute();
    CHECK(graph.hazards().empty());
}

}  // namespace limn::test::effect_list_test
