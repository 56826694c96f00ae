#include "render/gpu/framebuffer.h"
#include "render/gpu/shader_library.h"
#include "render/shaders/shadow_gpu.h"
#include "tests/near.h"
#include "tests/render/shadow_fixture.h"
#include "tests/technique.h"

#include <array>

namespace limn::test::shadow_filter_test {
namespace {

/// What the filters of lib/shadow.glsl make of a map of 8 x 8 texels, of which 1 is lit and 0 not.
class FilterTest : public RenderTest {
  public:
    FilterTest() : library_(device().caps(), files()) {}

    /// `soft`: the sixteen-fold filter, else 2x2 or, `hard`, the nearest texel. Whether or not the
    /// shader can filter otherwise, too.
    float lit(const std::array<float, 64>& map, Vec2 st, bool soft, bool hard = false) {
        const float lit_fraction = lit(map, st, soft, hard, {{"SHADOW_SOFT"}});
        const float same = lit(map, st, soft, hard, {{"SHADOW_SOFT"}, {"SHADOW_CONTACT"}});
        CHECK(lit_fraction == test::near(same).epsilon(1e-6));
        return lit_fraction;
    }

  private:
    float
    lit(const std::array<float, 64>& map, Vec2 st, bool soft, bool hard,
        const std::vector<gpu::ShaderDefine>& kinds) {
        std::vector<float> depths;
        for (const float texel : map) {
            depths.push_back(texel > 0 ? 0.25f : 0.75f);  // reversed: nearer is greater
        }
        atlas_.upload<float>(depths, GL_DEPTH_COMPONENT, GL_FLOAT);
        const auto program = library_.load(
            {.vertex = "fullscreen.vert", .fragment = "probe.frag", .defines = kinds});
        REQUIRE_MESSAGE(program.ok(), program.error().message);
        const gpu::Attachment attachment = {&result_};
        const gpu::Framebuffer framebuffer("probe", std::span(&attachment, 1));
        device().bind_framebuffer(framebuffer);
        device().use(gpu::Pipeline{*program, gpu::kFullscreenState});
        device().bind_texture(layout::kShadowAtlasUnit, atlas_);
        (*program)->set("st", st);
        (*program)->set("filter_kind", soft ? 2.0f : hard ? 0.0f : 1.0f);
        device().draw_fullscreen();
        return gpu::read_floats(result_).at(0, 0, 0);
    }

    static gpu::ShaderFiles files() {
        gpu::ShaderFiles files = gpu::ShaderFiles::standard();
        files.put(
            "probe.frag", "#version 450\n#include \"light_gpu.h\"\n#include \"lib/shadow.glsl\"\n"
                          R"(uniform vec2 st;
uniform float filter_kind;
layout(location = 0) out vec4 lit;
void main() {
    ShadowPoint p = ShadowPoint(st, 0.5, vec2(0.0), vec4(0.0, 0.0, 8.0, 8.0));
    lit = vec4(filtered_visibility(p, vec4(filter_kind, 1.0, 0.0, 2.0), vec2(0.0), true));
})");
        return files;
    }

    gpu::ShaderLibrary library_;
    gpu::Texture atlas_{"probe atlas", {.format = GL_DEPTH_COMPONENT32F, .width = 8, .height = 8}};
    gpu::Texture result_{"probe result", {.format = GL_RGBA32F, .width = 1, .height = 1}};
};

/// Lit from column `first` on.
std::array<float, 64> edge_at(int first) {
    std::array<float, 64> map{};
    for (int i = 0; i < 64; ++i) {
        map[static_cast<std::size_t>(i)] = i % 8 >= first ? 1.0f : 0.0f;
    }
    return map;
}

}  // namespace

TEST_CASE_FIXTURE(
    FilterTest, "shadow filter: the four comparisons of the book's figure give 0.75"
                    * technique("shadow.pcf")) {
    std::array<float, 64> map{};
    const char* rows[] = {"1110", "1110", "1100", "1100"};  // from the top
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            map[static_cast<std::size_t>((5 - y) * 8 + 2 + x)] = rows[y][x] == '1' ? 1.0f : 0.0f;
        }
    }
    CHECK(lit(map, {4, 4}, false) == test::near(0.75));
}

TEST_CASE_FIXTURE(
    FilterTest,
    "shadow filter: 2x2 comparisons are weighted bilinearly" * technique("shadow.pcf")) {
    std::array<float, 64> map{};
    map[3 * 8 + 3] = 1;  // one lit texel, its center at (3.5, 3.5)
    for (const float x : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
        for (const float y : {0.0f, 0.5f, 0.9f}) {
            CHECK(lit(map, {3.5f + x, 3.5f + y}, false) == test::near((1 - x) * (1 - y)));
        }
    }
    // At a corner of texels all four count the same: multiples of a quarter.
    CHECK(lit(map, {4, 4}, false) == test::near(0.25));
    map[3 * 8 + 4] = 1;
    CHECK(lit(map, {4, 4}, false) == test::near(0.5));
}

TEST_CASE_FIXTURE(FilterTest, "shadow filter: the hard filter uses the nearest texel only") {
    std::array<float, 64> map{};
    map[3 * 8 + 3] = 1;
    CHECK(lit(map, {3.99f, 3.01f}, false, true) == 1);
    CHECK(lit(map, {4.01f, 3.5f}, false, true) == 0);
    CHECK(lit(map, {3.5f, 2.99f}, false, true) == 0);
}

TEST_CASE_FIXTURE(
    FilterTest,
    "shadow filter: all texels lit give exactly 1, none exactly 0" * technique("shadow.pcf")) {
    for (const bool soft : {false, true}) {
        for (const Vec2 st : {Vec2(4, 4), Vec2(3.3f, 4.9f), Vec2(4.5f, 2.25f)}) {
            CHECK(lit(edge_at(0), st, soft) == test::near(1).epsilon(1e-6));
            CHECK(lit(edge_at(8), st, soft) == 0);
        }
    }
}

TEST_CASE_FIXTURE(
    FilterTest, "shadow filter: sixteen 2x2 filters cross an edge in steps of 1 3 5 7 eighths"
                    * technique("shadow.soft-pcf")) {
    // At texel centers the weights along an axis are (1, 2, 2, 2, 1) / 8.
    const float want[] = {0, 0.125f, 0.375f, 0.625f, 0.875f, 1};
    for (int i = 0; i < 6; ++i) {
        CHECK(lit(edge_at(4), {1.5f + static_cast<float>(i), 4.5f}, true) == test::near(want[i]));
    }
    // Between them (1 - f, 1, 1, 1, f) / 4: linear, and never falling.
    float last = 0;
    for (float x = 1.5f; x < 6.5f; x += 0.125f) {
        const float now = lit(edge_at(4), {x, 4.3f}, true);
        CHECK(now >= last - 1e-6f);
        CHECK(now == test::near(std::clamp((x - 2) / 4, 0.0f, 1.0f)));
        last = now;
    }
}

TEST_CASE_FIXTURE(
    FilterTest, "shadow filter: one dark texel takes at most a sixteenth of the soft filter"
                    * technique("shadow.soft-pcf")) {
    // Weights of 64ths: corners 1, edges 2, inside 4.
    const int want[5] = {1, 2, 2, 2, 1};
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            std::array<float, 64> map = edge_at(0);
            map[static_cast<std::size_t>((2 + y) * 8 + 2 + x)] = 0;
            CHECK(1 - lit(map, {4.5f, 4.5f}, true) == test::near(want[x] * want[y] / 64.0));
        }
    }
}

// ---- contact hardening
// -------------------------------------------------------------------------------

TEST_CASE(
    "shadow filter: the penumbra's width follows from similar triangles (shadow.penumbra)"
    * technique("shadow.penumbra")) {
    CHECK(oracle::penumbra_width(1, 2, 3) == test::near(0.5));
    CHECK(oracle::penumbra_width(0, 2, 3) == 0);
    CHECK(oracle::penumbra_width(1, 3, 3) == 0);
    CHECK(oracle::penumbra_width(2, 2, 3) == test::near(2 * oracle::penumbra_width(1, 2, 3)));
    CHECK(oracle::penumbra_width(1, 2, 4) > oracle::penumbra_width(1, 2, 3));
    // Outer width of the shadow of an occluder of width 1, and its umbra.
    CHECK(1 * 3 / 2.0 + oracle::penumbra_width(1, 2, 3) == test::near(2.0));
    CHECK(1 * 3 / 2.0 - oracle::penumbra_width(1, 2, 3) == test::near(1.0));
}

TEST_CASE_FIXTURE(
    ShadowTest,
    "shadow filter: contact hardening gives penumbras of the predicted width, within 15 %"
        * technique("shadow.penumbra")) {
    // A half plane above a floor, its edge at x = 0, under a lamp straight above the edge.
    put(make_plane({.size = {4, 4}}), {0, 0, 0});
    for (const auto& setup :
         {std::pair(1.0f, 0.3f), std::pair(0.5f, 0.3f), std::pair(1.5f, 0.15f)}) {
        const float height = setup.first;  // a lambda cannot capture a structured binding
        const float source = setup.second;
        const Entity screen = put(make_plane({.size = {2, 4}}), {-1, height, 0});
        const Entity lamp = shine(
            SpotLight{
                .radius = 0,
                .attenuation = {.falloff = Falloff::None},
                .inner_angle = radians(30.0f),
                .outer_angle = radians(30.0f)},
            look_at({0, 3, 0}, {0, 0, 0}));
        world.add(
            lamp, Shadow{
                      .filter = ShadowFilter::ContactHardening,
                      .resolution = 1024,
                      .source_size = source});
        // Seen from the side, under the half plane; one row of pixels across the edge.
        double sum = 0;
        double sum_x = 0;
        double sum_xx = 0;
        std::vector<std::pair<double, double>> profile;
        for (const Receiver& r : receivers(lamp, look({0.0f, 0.3f, 0.8f}, {0, 0, 0}, 160, 160))) {
            if (r.valid && r.position.y < 0.01 && std::abs(r.position.x) < 0.45) {
                profile.emplace_back(r.position.x, r.visibility);
            }
        }
        std::sort(profile.begin(), profile.end());
        REQUIRE(profile.size() > 500);
        // The lit fraction rises as the distribution of a disc's points along x, whose standard
        // deviation is a quarter of its width: measured from the slope of the fraction.
        const auto mean_over = [&](double from, double to) {
            double total = 0;
            int count = 0;
            for (const auto& [x, seen] : profile) {
                if (x >= from && x < to) {
                    total += seen;
                    ++count;
                }
            }
            return total / std::max(count, 1);
        };
        constexpr double kStep = 0.01;
        for (double x = -0.4; x < 0.4; x += kStep) {
            const double rise = mean_over(x, x + kStep) - mean_over(x - kStep, x);
            sum += rise;
            sum_x += rise * x;
            sum_xx += rise * x * x;
        }
        const double mean = sum_x / sum;
        const double width = 4 * std::sqrt(std::max(sum_xx / sum - mean * mean, 0.0));
        const double law = oracle::penumbra_width(source, 3 - height, 3);
        CAPTURE(height);
        CAPTURE(source);
        CAPTURE(mean);
        CHECK(sum == test::near(1).epsilon(0.05));
        CHECK(width / law == test::near(1).epsilon(0.15));
        world.destroy(screen);
        world.destroy(lamp);
    }
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow filter: below a thin bar contact hardening is dark at every pixel") {
    put(make_plane({.size = {4, 4}}), {0, 0, 0});
    put(make_box({.size = {0.06f, 0.01f, 3}}), {0, 0.1f, 0});
    put(make_box({.size = {0.3f, 0.3f, 0.3f}}), {1.5f, 4, 0});  // for a deep map: a wide search
    const Entity sun = shine(DirectionalLight{}, look_at({0, 1, 0}, {0, 0, 0}));
    world.add(
        sun, Shadow{
                 .filter = ShadowFilter::ContactHardening,
                 .resolution = 1024,
                 .source_size = 0.25f,
                 .cascades = 1,
                 .distance = 5});
    int count = 0;
    int lit = 0;
    for (const Receiver& r : receivers(sun, look({0.5f, 0.25f, 0}, {0, 0, 0}, 128, 128))) {
        // The penumbra is 2.5 cm wide on either side.
        if (r.valid && r.position.y < 0.001 && std::abs(r.position.x) < 0.01) {
            ++count;
            lit += r.visibility > 0.5 ? 1 : 0;
        }
    }
    CHECK(count > 100);
    CHECK(lit == 0);
}

TEST_CASE_FIXTURE(
    ShadowTest, "shadow filter: a source of size 0 has a hard edge, and no blocker means fully lit"
                    * technique("shadow.penumbra")) {
    put(make_plane({.size = {4, 4}}), {0, 0, 0});
    const Entity lamp = shine(
        SpotLight{.radius = 0, .inner_angle = radians(30.0f), .outer_angle = radians(30.0f)},
        look_at({0, 3, 0}, {0, 0, 0}));
    world.add(
        lamp,
        Shadow{.filter = ShadowFilter::ContactHardening, .resolution = 512, .source_size = 0.3f});
    const RenderView view = look({0.0f, 2, 1}, {0, 0, 0}, 64, 64);
    for (const Receiver& r : receivers(lamp, view)) {
        CHECK((!r.valid || r.visibility == test::near(1)));
    }
    put(make_plane({.size = {2, 4}}), {-1, 1, 0});
    world.get<Shadow>(lamp).source_size = 0;
    int between = 0;
    for (const Receiver& r : receivers(lamp, view)) {
        between += r.valid && r.visibility > 0.01 && r.visibility < 0.99 ? 1 : 0;
    }
    CHECK(between < 2 * 64);  // of 4096: a pixel or two a row
}

}  // namespace limn::test::shadow_filter_test
