// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/light.h"
#include "render/gpu/gl_object.h"
#include "render/gpu/shader_library.h"
#include "render/image.h"
#include "render/render_profile.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace limn::test::render_profile_test {
namespace {

constexpr std::array kKinds = {
    gpu::ObjectKind::Buffer, gpu::ObjectKind::Texture, gpu::ObjectKind::Framebuffer,
    gpu::ObjectKind::VertexArray, gpu::ObjectKind::Sampler};

std::vector<std::int64_t> live() {
    std::vector<std::int64_t> counts;
    for (const gpu::ObjectKind kind : kKinds) {
        counts.push_back(gpu::live_objects(kind));
    }
    return counts;
}

/// An effect from outside the library, which counts what is done with it.
struct CountingEffect {
    static inline int created = 0;
    static inline int drawn = 0;
    static inline int alive = 0;

    gpu::Texture texture{};

    static Result<CountingEffect> create(gpu::Device& device, const RenderSettings&) {
        LIMN_TRY(
            device.shaders().load({.vertex = "fullscreen.vert", .fragment = "accumulate.frag"}));
        ++created;
        ++alive;
        CountingEffect effect;
        effect.texture = gpu::Texture("counted", {});
        return effect;
    }
    CountingEffect() = default;
    CountingEffect(CountingEffect&& other) noexcept : texture(std::move(other.texture)) { ++alive; }
    CountingEffect& operator=(CountingEffect&&) = delete;
    ~CountingEffect() { --alive; }
    void draw(FrameGraph&, const FrameData&, ViewData&) { ++drawn; }
};

/// The plain image and an effect that counts, in front of the tone mapper.
std::span<const EffectEntry> counting_image() {
    static const std::vector<EffectEntry> image = [] {
        const std::span<const EffectEntry> plain = plain_image();
        std::vector<EffectEntry> entries(plain.begin(), plain.end());
        entries.insert(entries.end() - 1, effect<CountingEffect>(kMainViews));
        return entries;
    }();
    return image;
}

int tests_made = 0;

constexpr RenderProfile kProfiles[] = {
    {"impossible", "", [](const gpu::DeviceCaps&) { return false; },
     []() -> std::span<const EffectEntry> { throw std::runtime_error("loaded what cannot run"); }},
    {"counting", "",
     [](const gpu::DeviceCaps&) {
         ++tests_made;
         return true;
     },
     counting_image},
    {"plain", "", [](const gpu::DeviceCaps&) { return true; }, plain_image},
};

struct Stage : Scene {
    Stage() {
        place(add(make_square()), add(Material{.emission = Vec3(0.25f, 0.5f, 1)}), at({0, 0, 0}));
        world.create(PointLight{}, WorldTransform{at({0, 1, 2})});
    }
    [[nodiscard]] RenderView view() const { return look({0, 0, 1}, {0, 0, 0}, 32, 32); }
};

}  // namespace

TEST_CASE_FIXTURE(
    Stage,
    "render profile: one from outside the library is an entry of the list, and frees what it made"
        * technique("engine.render-profile")) {
    CountingEffect::created = CountingEffect::drawn = 0;
    const std::vector<std::int64_t> before = live();
    {
        ProfileSwitch profiles(device(), {}, kProfiles);
        CHECK(live() == before);  // nothing is loaded by itself
        CHECK(CountingEffect::created == 0);
        REQUIRE(profiles.load("counting").ok());
        CHECK(CountingEffect::created == 1);
        render_frame(profiles.renderer(), world, view());
        CHECK(CountingEffect::drawn == 1);
        CHECK(live() != before);
        profiles.reset();
        CHECK(live() == before);
        CHECK(CountingEffect::alive == 0);
        REQUIRE(profiles.load("counting").ok());
    }
    CHECK(live() == before);
}

TEST_CASE_FIXTURE(
    Stage, "render profile: the test of one changes nothing, and what cannot run is never loaded"
               * technique("engine.profile-select")) {
    tests_made = 0;
    const std::vector<std::int64_t> before = live();
    ProfileSwitch profiles(device(), {}, kProfiles);
    const std::vector<const RenderProfile*> available = profiles.available();
    CHECK(tests_made == 1);
    CHECK(live() == before);
    REQUIRE(available.size() == 2);
    CHECK(available[0]->name == std::string("counting"));
    CHECK(available[1]->name == std::string("plain"));
    const Status wrong = profiles.load("impossible");
    REQUIRE(!wrong.ok());
    CHECK(
        wrong.error().message
        == "found the renderer \"impossible\", expected one of counting plain");
    CHECK(profiles.loaded() == nullptr);
    REQUIRE(profiles.load().ok());
    CHECK(profiles.loaded() == available[0]);
    // A failure leaves what is loaded.
    CHECK(!profiles.load("nonsense").ok());
    CHECK(profiles.loaded() == available[0]);
    const Result<const RenderProfile*> none =
        find_profile(device().caps(), "", std::span(kProfiles).first(1));
    REQUIRE(!none.ok());
    CHECK(none.error().message.starts_with("found no way to render on "));
}

TEST_CASE_FIXTURE(
    Stage, "render profile: a switch within a frame takes effect in the next, and frees the old one"
               * technique("engine.profile-select")) {
    ProfileSwitch profiles(device(), {}, kProfiles);
    CHECK(!profiles.begin_frame().ok());  // nothing is loaded: drawing is refused
    REQUIRE(profiles.load("counting").ok());
    CHECK(!*profiles.begin_frame());
    Renderer* const renderer = &profiles.renderer();
    profiles.request("plain");
    CHECK(&profiles.renderer() == renderer);
    CHECK(profiles.loaded()->name == std::string("counting"));
    CHECK(CountingEffect::alive == 1);
    CHECK(*profiles.begin_frame());
    CHECK(profiles.loaded()->name == std::string("plain"));
    CHECK(CountingEffect::alive == 0);
    profiles.request("plain");
    CHECK(!*profiles.begin_frame());  // it is loaded already
    profiles.request("impossible");
    CHECK(!profiles.begin_frame().ok());
    CHECK(profiles.loaded()->name == std::string("plain"));
}

TEST_CASE_FIXTURE(
    Stage, "render profile: two that are loaded share their shaders"
               * technique("engine.render-profile")) {
    ProfileSwitch first(device(), {}, kProfiles);
    REQUIRE(first.load("plain").ok());
    render_frame(first.renderer(), world, view());
    const std::size_t programs = device().shaders().program_count();
    ProfileSwitch second(device(), {}, kProfiles);
    REQUIRE(second.load("plain").ok());
    const gpu::FloatImage image =
        gpu::read_floats(*render_frame(second.renderer(), world, view()).radiance);
    CHECK(device().shaders().program_count() == programs);
    CHECK(rgb_at(image, 16, 16).z > 0.5f);
}

TEST_CASE_FIXTURE(
    Stage, "render profile: a scene without lens effects is the same in plain and full"
               * technique("engine.render-profile")) {
    ProfileSwitch profiles(device());
    REQUIRE(profiles.load("full").ok());
    const gpu::FloatImage full =
        gpu::read_floats(*render_frame(profiles.renderer(), world, view()).radiance);
    REQUIRE(profiles.load("plain").ok());
    const gpu::FloatImage plain =
        gpu::read_floats(*render_frame(profiles.renderer(), world, view()).radiance);
    CHECK(largest_difference(full, plain) == 0);
}

}  // namespace limn::test::render_profile_test
