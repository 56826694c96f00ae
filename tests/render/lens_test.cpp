#include "ecs/components/camera_lens.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/rendering.h"
#include "ecs/components/ripple.h"
#include "ecs/components/speed_lines.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "render/lens/thin_lens.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test::lens_test {
namespace {

/// Where the first pass whose name begins so is in the last frame; -1 if there is none.
int place_of(std::string_view begin) {
    const auto timings = frame_graph(shared_renderer()).timings();
    for (std::size_t i = 0; i < timings.size(); ++i) {
        if (timings[i].name.starts_with(begin)) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

/// All passes of the last frame, in order.
std::vector<std::string> passes() {
    std::vector<std::string> names;
    for (const PassTiming& timing : frame_graph(shared_renderer()).timings()) {
        names.emplace_back(timing.name);
    }
    return names;
}

constexpr MotionBlurMode kMotionBlurModes[] = {
    MotionBlurMode::Reconstruct, MotionBlurMode::Accumulate, MotionBlurMode::Camera,
    MotionBlurMode::Flow, MotionBlurMode::Stretch};

/// A bright ball that moves in front of a wall, in the view of a moving camera.
class Moving : public Scene {
  public:
    Moving() {
        world.insert_resource(FrameTime{.step = 0.1f});
        world.insert_resource(Environment{});
        place(add(make_square()), add(Material{}), affine_from({0, 0, -1}, {1, 0, 0, 0}, Vec3(4)));
        mover = place(
            add(make_ball(12)),
            add(Material{.shading = ShadingModel::Unlit, .base_color = {5, 4, 3, 1}}), pose(0));
        world.get<PreviousWorldTransform>(mover).world = pose(-0.3f);
    }
    static Affine pose(float x) { return affine_from({x, 0, 0}, {1, 0, 0, 0}, Vec3(0.4f)); }
    [[nodiscard]] RenderView seen(int width = 48, int height = 32) const {
        return make_render_view(
            {.fov_y = radians(90.0f), .near = 0.05f}, look_at({0, 0, 1}, {0, 0, 0}),
            look_at({0.1f, 0, 1}, {0, 0, 0}), {.width = width, .height = height});
    }
    Entity mover;
};

/// An effect of the lens: how it is asked for with a strength from 0, for nothing, to 1, and what
/// its passes are called.
struct LensEffect {
    std::string name;
    std::string pass;
    std::function<void(Moving&, RenderView&, float strength)> set;
};

std::vector<LensEffect> lens_effects() {
    std::vector<LensEffect> effects;
    for (const GlowKind kind : {GlowKind::Lens, GlowKind::Mask}) {
        effects.push_back(
            {kind == GlowKind::Lens ? "glow" : "glow by a mask", "glow",
             [kind](Moving& scene, RenderView&, float strength) {
                 scene.world.insert_resource(Glow{.kind = kind, .strength = strength});
             }});
    }
    effects.push_back({"glare", "glare", [](Moving& scene, RenderView&, float strength) {
                           scene.world.insert_resource(Glare{.strength = strength});
                       }});
    const Affine center = at({0, 0, -0.5f});
    effects.push_back({"shock ring", "ripple", [center](Moving& scene, RenderView&, float s) {
                           scene.world.create(
                               RippleRing{.age = 0.1f, .amplitude = 0.1f * s},
                               WorldTransform{center});
                       }});
    effects.push_back({"hot air", "ripple", [center](Moving& scene, RenderView&, float s) {
                           scene.world.create(
                               HeatHaze{.strength = 0.1f * s}, WorldTransform{center});
                       }});
    effects.push_back({"rain", "ripple", [](Moving& scene, RenderView&, float strength) {
                           scene.world.insert_resource(LensRain{.amount = strength});
                       }});
    effects.push_back({"screen ripple", "ripple", [](Moving& scene, RenderView&, float strength) {
                           scene.world.create(
                               ScreenRipple{.age = 0.25f, .amplitude = 0.05f * strength});
                       }});
    for (const MotionBlurMode mode : kMotionBlurModes) {
        effects.push_back(
            {"motion blur " + std::to_string(static_cast<int>(mode)), "motion",
             [mode](Moving& scene, RenderView&, float strength) {
                 scene.world.insert_resource(MotionBlur{.mode = mode, .shutter = 360 * strength});
             }});
    }
    for (const FocusMethod method : {FocusMethod::Gather, FocusMethod::Mip}) {
        effects.push_back(
            {method == FocusMethod::Gather ? "depth of field" : "depth of field by mips", "focus",
             [method](Moving&, RenderView& view, float strength) {
                 view.lens = {
                     .aperture_radius = 0.1f * strength,
                     .focus_distance = 0.5f,
                     .max_blur = 0.25f,
                     .method = method};
             }});
    }
    effects.push_back(
        {"anti-aliasing", "temporal", [](Moving& scene, RenderView&, float strength) {
             scene.world.insert_resource(Rendering{
                 .antialiasing = strength > 0 ? Antialiasing::Temporal : Antialiasing::None});
         }});
    effects.push_back({"speed lines", "speed lines", [](Moving& scene, RenderView&, float s) {
                           scene.world.add(
                               scene.mover,
                               SpeedLines{.count = static_cast<int>(100 * s), .min_speed = 1});
                       }});
    return effects;
}

void set_to(float& field, float number) {
    field = number;
}
void set_to(Vec2& field, float number) {
    field = Vec2(number);
}
void set_to(Vec4& field, float number) {
    field = Vec4(number);
}
void set_to(int& field, float number) {
    if (!std::isnan(number)) {
        field = static_cast<int>(std::clamp(number, -2e9f, 2e9f));
    }
}
template <typename Other>
void set_to(Other& /*field*/, float /*number*/) {}

bool is_finite_everywhere(const gpu::FloatImage& image) {
    return std::all_of(
        image.pixels.begin(), image.pixels.end(), [](float v) { return std::isfinite(v); });
}

/// Sets each field of `setting` to each of many numbers, and draws what `use` makes of it;
/// an entity that it makes is gone afterwards.
template <typename Setting, typename Use>
void try_numbers(const std::string& name, const Setting& setting, const Use& use) {
    Moving scene;
    int fields = 0;
    Setting counted = setting;
    visit_fields(counted, [&](std::string_view, auto&, const FieldMeta& = {}) { ++fields; });
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < fields; ++i) {
        for (const float number :
             {std::numeric_limits<float>::quiet_NaN(), kInfinity, 0.0f, -1.0f, 1e30f}) {
            Setting broken = setting;
            std::string field;
            int at = 0;
            visit_fields(
                broken, [&](std::string_view its_name, auto& value, const FieldMeta& = {}) {
                    if (at++ == i) {
                        field = its_name;
                        set_to(value, number);
                    }
                });
            CAPTURE(name);
            CAPTURE(field);
            CAPTURE(number);
            RenderView view = scene.seen(24, 16);
            const Entity made = use(scene, view, broken);
            CHECK(is_finite_everywhere(scene.radiance(view)));
            if (made != Entity{}) {
                scene.world.destroy(made);
            }
        }
    }
}

}  // namespace

TEST_CASE(
    "lens: the image is finite with any value of any setting" * technique("post.effect-pipeline")) {
    const auto resource = [](Moving& scene, RenderView&, const auto& setting) {
        scene.world.insert_resource(setting);
        return Entity{};
    };
    const auto component = [](Moving& scene, RenderView&, const auto& setting) {
        return scene.world.create(setting, WorldTransform{at({0, 0, -0.5f})});
    };
    try_numbers("glow", Glow{}, resource);
    try_numbers("glow by a mask", Glow{.kind = GlowKind::Mask}, resource);
    try_numbers("glare", Glare{.strength = 1}, resource);
    try_numbers("rain", LensRain{.amount = 1}, resource);
    try_numbers("shock ring", RippleRing{.age = 0.1f, .amplitude = 0.1f}, component);
    try_numbers("hot air", HeatHaze{.strength = 0.1f}, component);
    try_numbers("screen ripple", ScreenRipple{.age = 0.25f}, component);
    for (const MotionBlurMode mode : kMotionBlurModes) {
        try_numbers(
            "motion blur " + std::to_string(static_cast<int>(mode)), MotionBlur{.mode = mode},
            resource);
    }
    try_numbers(
        "speed lines", SpeedLines{.count = 10, .min_speed = 1},
        [](Moving& scene, RenderView&, const SpeedLines& lines) {
            scene.world.add(scene.mover, lines);
            return Entity{};
        });
    for (const FocusMethod method : {FocusMethod::Gather, FocusMethod::Mip}) {
        try_numbers(
            "lens", Lens{.f_number = 0.05f, .focus_distance = 0.5f, .method = method},
            [](Moving&, RenderView& view, const Lens& lens) {
                const Result<LensView> made = make_lens_view(lens, Camera{});
                view.lens = made ? *made : LensView{};
                return Entity{};
            });
    }
}

TEST_CASE(
    "lens: an effect that is off adds no pass, and the display image is bit-identical"
    * technique("post.effect-pipeline, post.glare-heat-haze")) {
    Moving plain;
    static_cast<void>(plain.draw(plain.seen()));  // what surrounds a scene is mirrored once
    const gpu::ByteImage without = gpu::read_bytes(*plain.draw(plain.seen()).display);
    const std::vector<std::string> bare = passes();
    for (const LensEffect& effect : lens_effects()) {
        CAPTURE(effect.name);
        Moving scene;
        RenderView view = scene.seen();
        effect.set(scene, view, 0);
        static_cast<void>(scene.draw(view));
        const gpu::ByteImage off = gpu::read_bytes(*scene.draw(view).display);
        CHECK(off.pixels == without.pixels);
        CHECK(passes() == bare);
        effect.set(scene, view, 1);
        static_cast<void>(scene.draw(view));
        CHECK(place_of(effect.pass) >= 0);
        CHECK(passes().size() > bare.size());
    }
}

TEST_CASE("lens: negative and NaN radiance becomes 0") {
    Moving plain;
    const gpu::FloatImage without = plain.radiance(plain.seen());
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const LensEffect& effect : lens_effects()) {
        for (const float bad : {-1.0f, nan}) {
            if (effect.name == "speed lines" || effect.name == "anti-aliasing") {
                continue;  // integers and enumerations
            }
            if (bad < 0 && (effect.name == "shock ring" || effect.name == "screen ripple")) {
                continue;  // of opposite phase
            }
            CAPTURE(effect.name);
            CAPTURE(bad);
            Moving scene;
            RenderView view = scene.seen();
            effect.set(scene, view, bad);
            CHECK(scene.radiance(view).pixels == without.pixels);
        }
    }
}

TEST_CASE("lens: each effect works in an image 16384 pixels wide") {
    for (const LensEffect& effect : lens_effects()) {
        CAPTURE(effect.name);
        Moving scene;
        RenderView view = scene.seen(16384, 16);
        effect.set(scene, view, 1);
        const gpu::FloatImage wide = scene.radiance(view);
        CHECK(wide.width == 16384);
        CHECK(is_finite_everywhere(wide));
        CHECK(place_of(effect.pass) >= 0);
    }
}

TEST_CASE("lens: the image is finite when objects move by NaN or a billion meters") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const LensEffect& effect : lens_effects()) {
        for (const float bad : {nan, std::numeric_limits<float>::infinity(), 1e9f, 1e30f}) {
            CAPTURE(effect.name);
            CAPTURE(bad);
            Moving scene;
            RenderView view = scene.seen();
            effect.set(scene, view, 4);  // a shutter of 1440 degrees, all else likewise
            scene.world.get<PreviousWorldTransform>(scene.mover).world.row[0] = Vec4(bad);
            static_cast<void>(scene.draw(view));
            CHECK(is_finite_everywhere(scene.radiance(view)));
        }
    }
}

TEST_CASE_FIXTURE(
    Scene, "lens: effects that are not requested have neither a pass nor a target"
               * technique("post.effect-pipeline")) {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    static_cast<void>(draw(look({0, 0, 1}, {0, 0, 0}, 32, 24)));
    CHECK(place_of("glow") == -1);
    CHECK(place_of("motion") == -1);
    CHECK(!frame_graph(shared_renderer()).find("radiance with glow").valid());
}

TEST_CASE_FIXTURE(
    Scene, "lens: the shutter comes before the glow, and both before the tone map"
               * technique("post.effect-pipeline")) {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    world.insert_resource(Rendering{.antialiasing = Antialiasing::Temporal});
    world.insert_resource(Glow{});
    world.insert_resource(Glare{});
    world.insert_resource(MotionBlur{});
    world.create(ScreenRipple{.age = 0.1f});
    RenderView view = look({0, 0, 1}, {0, 0, 0}, 32, 24);
    view.lens = {.aperture_radius = 0.2f, .focus_distance = 0.5f};
    static_cast<void>(draw(view));
    CHECK(place_of("temporal") > place_of("lights"));
    CHECK(place_of("ripple") > place_of("temporal"));
    CHECK(place_of("motion") > place_of("ripple"));
    CHECK(place_of("focus") > place_of("motion"));
    CHECK(place_of("glare") > place_of("focus"));
    CHECK(place_of("glow") > place_of("glare"));
    CHECK(place_of("tone map") > place_of("glow"));
}

}  // namespace limn::test::lens_test
