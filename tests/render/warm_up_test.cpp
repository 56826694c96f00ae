// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
// clang-format on
#include "ecs/components/mesh_levels.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "ecs/components/time.h"
#include "ecs/components/water.h"
#include "ecs/components/water_look.h"
#include "render/gpu/shader_library.h"
#include "render/image.h"
#include "render/light/light_list.h"
#include "tests/render/scene_fixture.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <numbers>
#include <vector>

namespace limn::test::warm_up_test {
namespace {

/// A lit square, and a renderer of its own.
class WarmScene : public Scene {
  public:
    WarmScene() {
        place(add(make_square()), add(Material{}), at({0, 0, 0}));
        renderer_ = *create_renderer(shared_device());
    }
    /// Programs that a frame uses and a warm-up has not.
    std::size_t missing_from(const Vec3& eye, const Vec3& target) {
        gpu::ShaderLibrary& shaders = shared_device().shaders();
        const int needed = warm_up(*renderer_, world, look({0, 0, 3}, {0, 0, 0}));
        render_frame(*renderer_, world, look(eye, target));
        return shaders.loaded_count() - static_cast<std::size_t>(needed);
    }

    Renderer& renderer() { return *renderer_; }

  private:
    RendererPtr renderer_;
};

constexpr Vec3 kAway[] = {{0, 0, 9}, {0, 0, 20}};  // an eye, and what it looks at

struct SideViewEffect {
    static inline int draws = 0;
    static inline int warm_up_draws = 0;

    static Result<SideViewEffect> create(gpu::Device&, const RenderSettings&) {
        return SideViewEffect{};
    }
    static void add_warm_up_views(const FrameData& frame, std::vector<RenderView>& views) {
        views.push_back(frame.camera);
    }
    void draw(FrameGraph&, const FrameData& frame, ViewData&) {
        ++(frame.warm_up ? warm_up_draws : draws);
    }
};

}  // namespace

TEST_CASE_FIXTURE(WarmScene, "warm-up: no light needs a program that depends on the camera") {
    shine(PointLight{.radius = 2}, at({0, 0, 1}));
    CHECK(missing_from(kAway[0], kAway[1]) == 0);
    shine(SpotLight{.radius = 2}, at({0, 0, 1}));
    CHECK(missing_from(kAway[0], kAway[1]) == 0);
}

TEST_CASE_FIXTURE(WarmScene, "warm-up: no shadow needs a program that depends on the camera") {
    for (const ShadowMethod method :
         {ShadowMethod::Map, ShadowMethod::Perspective, ShadowMethod::Volume,
          ShadowMethod::Hybrid}) {
        CAPTURE(static_cast<int>(method));
        const Entity lamp = shine(PointLight{.radius = 2}, at({0, 0, 1}));
        world.add(lamp, Shadow{.method = method});
        world.add(lamp, ShadowVolume{.kind = VolumeKind::PerTriangle});
        CHECK(missing_from(kAway[0], kAway[1]) == 0);
        CHECK(missing_from({0, 0, 1.5f}, {0, 0, 0}) == 0);
        world.destroy(lamp);
    }
}

TEST_CASE_FIXTURE(WarmScene, "warm-up: a light that is off may be switched on") {
    const Entity lamp = shine(SpotLight{.enabled = false}, at({0, 0, 1}));
    CHECK(any_light_off(world));
    const int needed = warm_up(renderer(), world, look({0, 0, 3}, {0, 0, 0}));
    world.get<SpotLight>(lamp).enabled = true;
    CHECK_FALSE(any_light_off(world));
    render_frame(renderer(), world, look({0, 0, 3}, {0, 0, 0}));
    CHECK(shared_device().shaders().loaded_count() == static_cast<std::size_t>(needed));
}

TEST_CASE_FIXTURE(WarmScene, "warm-up: a camera may dive, and a planar reflection may appear") {
    world.create(
        Water{.size = {4, 4}, .depth = 2}, WaterLook{.reflection = WaterReflection::Planar},
        WorldTransform{at({0, 0, 0})});
    for (const Vec3& eye : {Vec3(0.1f, 3, 1), Vec3(0.1f, -1, 1), Vec3(0.1f, -3, 1)}) {
        CAPTURE(eye.y);
        CHECK(missing_from(eye, {0, 0, 0}) == 0);
    }
}

TEST_CASE_FIXTURE(WarmScene, "warm-up: programs compiled later are counted") {
    const RenderView view = look({0, 0, 3}, {0, 0, 0});
    const int needed = warm_up(renderer(), world, view);
    CHECK(render_frame(renderer(), world, view).statistics.compiled == 0);
    place(
        add(make_square()), add(Material{.alpha_mode = AlphaMode::Mask, .double_sided = true}),
        at({0, 0, 1}));
    const FrameStatistics first = render_frame(renderer(), world, view).statistics;
    CHECK(shared_device().shaders().loaded_count() > static_cast<std::size_t>(needed));
    CHECK(first.programs == static_cast<int>(shared_device().shaders().program_count()));
    const FrameStatistics second = render_frame(renderer(), world, view).statistics;
    CHECK(second.compiled == 0);
    CHECK(second.programs == first.programs);
}

TEST_CASE_FIXTURE(Scene, "warm-up: an effect adds views, and is reset afterwards") {
    const std::span<const EffectEntry> standard = standard_image();
    std::vector<EffectEntry> image(standard.begin(), standard.end());
    image.push_back(effect<SideViewEffect>(kMainViews));
    const RendererPtr renderer = *create_renderer(shared_device(), {.image = image});
    const RenderView view = look({0, 0, 3}, {0, 0, 0});
    int reports = 0;
    warm_up(*renderer, world, view, [&](int done, int total) {
        CHECK(done == reports++);
        CHECK(total == 2);  // nothing to see from afar
    });
    CHECK(reports == 2);
    CHECK(SideViewEffect::warm_up_draws == 2);
    CHECK(SideViewEffect::draws == 0);
    render_frame(*renderer, world, view);
    CHECK(SideViewEffect::draws == 1);
}

TEST_CASE_FIXTURE(
    SkinScene, "warm-up: characters far away are drawn near, whose poses have too few joints") {
    const auto tube = [&](int joints) {
        Random random(7, 0, 0, 0);
        MeshData mesh = make_tube(4 * joints, 8, 0.25f * static_cast<float>(joints - 1));
        add_weights(mesh, joints, 4, random);
        return add(std::move(mesh));
    };
    const MeshId far = tube(2);
    const MeshId near = tube(5);
    const Pose few = {.joints = {Affine{}, Affine{}}, .previous = {Affine{}, Affine{}}};
    const Entity who = pose(far, add(Material{}), add_skin(make_chain(5, 0.25f)), few);
    world.add(who, MeshLevels{.meshes = {far, near}});
    const RendererPtr renderer = *create_renderer(shared_device());
    const RenderView view = look({0, 0, 3}, {0, 0, 0});
    CHECK(messages_of([&] { warm_up(*renderer, world, view); }).empty());
    CHECK(messages_of([&] { render_frame(*renderer, world, view); }).empty());
    world.get<MeshInstance>(who).mesh = near;  // now its pose is really too short
    CHECK(messages_of([&] { render_frame(*renderer, world, view); }).size() == 1);
}

TEST_CASE("warm-up: a light that is momentarily black by its pulse stays in the list") {
    World world;
    world.insert_resource(FrameTime{.time = 1.5 * std::numbers::pi});
    const Entity lamp = world.create(
        PointLight{}, WorldTransform{}, LightPulse{.function = {.base = 1, .amplitude = 3}});
    LightList list;
    collect_lights(world, 1, list);
    REQUIRE(list.records.size() == 1);
    CHECK(Vec3(list.records[0].color) == Vec3(0));
    world.get<PointLight>(lamp).intensity = 0;
    collect_lights(world, 1, list);
    CHECK(list.records.empty());
    collect_lights(world, 1, list, true);
    CHECK(list.records.size() == 1);
}

}  // namespace limn::test::warm_up_test
