#include "ecs/base/rng.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/glow.h"
#include "render/lens/depth_of_field_pass.h"
#include "render/lens/window_depth.h"
#include "render/shaders/depth_of_field_gpu.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace limn::test::depth_of_field_test {
namespace {

constexpr float kNear = 0.1f;
constexpr float kFocus = 2.0f;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What a pixel shows: x to the right, y up.
struct PixelContent {
    Vec3 light = Vec3(0);
    float distance = kFocus;  ///< [m]
};
using Show = std::function<PixelContent(int x, int y)>;

/// A lens that images infinity, focused at kFocus, as a disc of `diameter` [px].
RenderView lens_view(int width, int height, float diameter, int blades = 0) {
    RenderView view = make_render_view(
        {.fov_y = 0.6f, .near = kNear}, {}, {}, {.width = width, .height = height});
    view.lens = {
        .aperture_radius = diameter * kFocus * view.tangent.y / static_cast<float>(height),
        .focus_distance = kFocus,
        .blades = blades,
        .max_blur = 0.25f};
    return view;
}

/// Distance whose circle is `diameter` [px] wide, negative before the focus, with that lens.
float distance_of(float diameter, float of_infinity) {
    return kFocus / (1 - diameter / of_infinity);
}

class Darkroom : public RenderTest {
  public:
    gpu::FloatImage photograph(const RenderView& view, const Show& show) {
        const int width = view.width;
        const int height = view.height;
        std::vector<Vec4> light;
        std::vector<float> depth;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const PixelContent seen = show(x, y);
                light.emplace_back(seen.light, 1.0f);
                depth.push_back(static_cast<float>(
                    reversed_depth(static_cast<double>(seen.distance), double(kNear))));
            }
        }
        gpu::Texture radiance("radiance", {.format = GL_RGBA32F, .width = width, .height = height});
        gpu::Texture depths(
            "depth", {.format = GL_DEPTH_COMPONENT32F, .width = width, .height = height});
        radiance.upload<Vec4>(light, GL_RGBA, GL_FLOAT);
        depths.upload<float>(depth, GL_DEPTH_COMPONENT, GL_FLOAT);
        FrameGraph& graph = shared_graph();
        graph.begin_frame();
        const TextureId out = draw_depth_of_field(
            graph, shared_pass(), view, graph.import("radiance", radiance),
            graph.import("depth", depths));
        graph.keep(out);
        graph.execute();
        return gpu::read_floats(*graph.texture(out));
    }

  private:
    static FrameGraph& shared_graph() {
        static FrameGraph graph(shared_device());
        return graph;
    }
    static DepthOfFieldPass& shared_pass() {
        static DepthOfFieldPass pass = *create_depth_of_field_pass(shared_device());
        return pass;
    }
};

/// Light at (x, y) from the left and the bottom.
float light_at(const gpu::FloatImage& image, int x, int y) {
    return image.at(x, image.height - 1 - y, 0);
}

/// Sum, centroid and second moment of an image's light.
struct Moments {
    double sum = 0;
    double x = 0;
    double y = 0;
    double variance = 0;  ///< along an axis [px^2]
};

Moments moments_of(const gpu::FloatImage& image) {
    Moments m;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double light = static_cast<double>(light_at(image, x, y));
            m.sum += light;
            m.x += light * (x + 0.5);
            m.y += light * (y + 0.5);
        }
    }
    m.x /= m.sum;
    m.y /= m.sum;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double light = static_cast<double>(light_at(image, x, y));
            m.variance += 0.5 * light * (square(x + 0.5 - m.x) + square(y + 0.5 - m.y)) / m.sum;
        }
    }
    return m;
}

/// Of the uniform disc with the same second moment, without what the pixel itself adds.
double diameter_of(const Moments& m) {
    return 4 * std::sqrt(std::max(m.variance - 1.0 / 12, 0.0));
}

constexpr float kAll = 48;  // diameter of infinity in most tests [px]

/// One pixel that shines, on a black wall `distance` away.
Show spark(float distance, int x0, int y0) {
    return [=](int x, int y) {
        return PixelContent{x == x0 && y == y0 ? Vec3(1000) : Vec3(0), distance};
    };
}

}  // namespace

TEST_CASE_FIXTURE(
    Darkroom,
    "depth_of_field: a point becomes a disc of the right diameter that keeps all its light"
        * technique("post.circle-of-confusion")) {
    const RenderView view = lens_view(192, 192, kAll);
    for (const float diameter :
         {-44.0f, -30.0f, -20.0f, -12.0f, -7.0f, -3.0f, 2.0f, 4.5f, 9.0f, 16.0f, 26.0f, 40.0f}) {
        CAPTURE(diameter);
        const Moments m = moments_of(photograph(view, spark(distance_of(diameter, kAll), 93, 101)));
        CHECK(m.sum == test::near(1000).epsilon(0.01));
        CHECK(std::abs(diameter_of(m) - std::abs(double(diameter))) < 0.5);
        // At half resolution positions are exact to a pixel; highlights have their own.
        const double near = std::abs(diameter) > 24 ? 0.1 : 0.75;
        CHECK(std::abs(m.x - 93.5) < near);
        CHECK(std::abs(m.y - 101.5) < near);
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: a point in front of a surface with another blur is still a disc") {
    const RenderView view = lens_view(192, 192, kAll);
    for (const float diameter : {-30.0f, -12.0f, -3.5f, 2.5f, 3.5f, 16.0f, 40.0f}) {
        CAPTURE(diameter);
        const float distance = distance_of(diameter, kAll);
        const Moments m = moments_of(photograph(view, [&](int x, int y) {
            return x == 93 && y == 101 ? PixelContent{Vec3(1000), distance}
                                       : PixelContent{Vec3(0), kInfinity};
        }));
        CHECK(m.sum == test::near(1000).epsilon(0.01));
        CHECK(std::abs(diameter_of(m) - std::abs(double(diameter))) < 0.5);
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: right in front of the lens a point is a disc of maximum width") {
    const RenderView view = lens_view(192, 192, kAll);  // 432 px wide by the law, 0.2 m away
    const Moments m = moments_of(photograph(view, spark(0.2f, 96, 96)));
    CHECK(std::abs(diameter_of(m) - 0.25 * 192) < 0.5);
    CHECK(m.sum == test::near(1000).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: a lamp in front of a black sky keeps its light in every layer") {
    const RenderView view = lens_view(96, 96, 11);
    for (const float diameter :
         {-9.0f, -6.0f, -5.5f, -5.0f, -4.5f, -4.0f, 4.0f, 4.5f, 5.0f, 5.5f, 6.0f, 7.5f, 9.0f}) {
        CAPTURE(diameter);
        const float distance = distance_of(diameter, 11);
        const Moments m = moments_of(photograph(view, [&](int x, int y) {
            const bool lamp = x / 2 == 24 && y / 2 == 25;
            return lamp ? PixelContent{Vec3(250), distance} : PixelContent{Vec3(0), kInfinity};
        }));
        // Half of it gathered from the image, half from its half: each hides some of the other.
        const double most = std::abs(diameter) == 4.5f ? 0.05 : 0.02;
        CHECK(m.sum == test::near(1000).epsilon(most));
        const double own = 0.25;  // of 2 x 2 px
        const double found = 4 * std::sqrt(m.variance - 1.0 / 12 - own);
        CHECK(std::abs(found - std::abs(double(diameter))) < 0.75);
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: past a slightly blurred edge the background shows in every tile") {
    const RenderView view = lens_view(96, 96, kAll);
    // The outline slants through a border of tiles, at x = 48.
    const auto is_card = [](int x, int y) { return 8 * x + y < 8 * 48 + 40; };
    const gpu::FloatImage image = photograph(view, [&](int x, int y) {
        return is_card(x, y) ? PixelContent{Vec3(0), distance_of(-3.5f, kAll)}
                             : PixelContent{Vec3(1), kInfinity};
    });
    for (int y = 8; y < 88; ++y) {
        CAPTURE(y);
        float inside = 0;
        for (int x = 40; x < 56; ++x) {
            inside += is_card(x, y) ? light_at(image, x, y) : 0.0f;
        }
        CHECK(inside > 0.2f);
        CHECK(inside < 0.8f);
    }
}

TEST_CASE("depth_of_field: half-resolution kernels are as wide as circles less the tents") {
    const layout::FocusBlock block = make_focus_block(lens_view(64, 64, 14));
    for (int i = 3 * layout::kKernelStep; i < layout::kKernels; ++i) {
        CAPTURE(i);
        const float kernel = block.kernel[i / 2][2 * (i % 2)];
        double area = 0;
        double square_sum = 0;
        for (const Vec4& texel : block.texel) {
            const auto covered = std::clamp(double(kernel) + 0.5 - double(texel.z), 0.0, 1.0);
            area += covered;
            square_sum += covered * double(texel.x * texel.x + texel.y * texel.y);
        }
        CHECK(double(block.kernel[i / 2][2 * (i % 2) + 1]) == test::near(1 / area));
        const double radius = static_cast<double>(i) / layout::kKernelStep;
        const double tents = 1.5;  // [px^2]
        const double disc = 4 * (0.5 * square_sum / area) + tents;
        CHECK(std::abs(2 * std::sqrt(disc) - radius) < 0.1);
    }
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: the sky is blurred as a surface at infinity") {
    const RenderView view = lens_view(160, 160, 36);
    const Moments m = moments_of(photograph(view, spark(kInfinity, 80, 80)));
    CHECK(std::abs(diameter_of(m) - 36) < 0.5);
    CHECK(m.sum == test::near(1000).epsilon(0.01));
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: discs are even, round and crisp") {
    const RenderView view = lens_view(160, 160, kAll);
    for (const float diameter : {-40.0f, 40.0f}) {
        const gpu::FloatImage disc = photograph(view, spark(distance_of(diameter, kAll), 80, 80));
        const float even = 1000 / (kPi * square(20.0f));
        for (int i = 0; i < 64; ++i) {
            const float angle = 2 * kPi * static_cast<float>(i) / 64;
            const auto along = [&](float radius) {
                return light_at(
                    disc, static_cast<int>(80.5f + radius * std::cos(angle)),
                    static_cast<int>(80.5f + radius * std::sin(angle)));
            };
            for (const float radius : {0.0f, 6.0f, 12.0f, 17.5f}) {
                CHECK(along(radius) == test::near(even).epsilon(0.12));
            }
            CHECK(along(23.5f) < 0.12f * even);
        }
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: discs have the shape of the aperture, upright behind the focus") {
    const RenderView view = lens_view(160, 160, kAll, 3);  // a triangle that points to the right
    for (const float diameter : {-40.0f, 40.0f, -18.0f, 18.0f}) {
        CAPTURE(diameter);
        const gpu::FloatImage disc = photograph(view, spark(distance_of(diameter, kAll), 80, 80));
        const float radius = 0.5f * std::abs(diameter);
        const float side = diameter > 0 ? 1.0f : -1.0f;
        const auto at_right = [&](float x, float y) {
            return light_at(
                disc, static_cast<int>(std::floor(80.5f + side * radius * x)),
                static_cast<int>(std::floor(80.5f + radius * y)));
        };
        const float even = 1000 / (0.75f * std::sqrt(3.0f) * square(radius));
        CHECK(at_right(0.6f, 0) > 0.7f * even);    // toward the corner
        CHECK(at_right(-0.75f, 0) < 0.3f * even);  // beyond the side
        CHECK(at_right(-0.3f, 0.45f) > 0.7f * even);
        CHECK(at_right(0.5f, 0.5f) < 0.3f * even);
        CHECK(moments_of(disc).sum == test::near(1000).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: a sharp surface does not leak into a far background") {
    const RenderView view = lens_view(160, 160, kAll);
    const gpu::FloatImage image = photograph(view, [](int x, int y) {
        const bool card = x >= 60 && x < 100 && y >= 50 && y < 110;
        return card ? PixelContent{Vec3(1), kFocus} : PixelContent{Vec3(0), 40.0f};
    });
    float most = 0;
    for (int y = 0; y < 160; ++y) {
        for (int x = 0; x < 160; ++x) {
            const bool card = x >= 60 && x < 100 && y >= 50 && y < 110;
            most = std::max(most, card ? 0.0f : light_at(image, x, y));
            if (card) {
                CHECK(light_at(image, x, y) == 1.0f);
            }
        }
    }
    CHECK(most <= 2.0f / 255);
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: a far highlight does not shine through a sharp surface") {
    const RenderView view = lens_view(160, 160, kAll);
    const gpu::FloatImage image = photograph(view, [](int x, int y) {
        if (x < 80) {
            return PixelContent{Vec3(0), kFocus};
        }
        return PixelContent{x == 84 && y == 80 ? Vec3(1000) : Vec3(0), 100.0f};
    });
    for (int x = 40; x < 80; ++x) {
        CHECK(light_at(image, x, 80) == 0.0f);
    }
    CHECK(light_at(image, 90, 80) > 0.3f);
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: a near surface spreads over a sharp one") {
    const RenderView view = lens_view(160, 160, kAll);
    for (const float radius : {10.0f, 20.0f}) {
        const float near = distance_of(-2 * radius, kAll);
        const gpu::FloatImage image = photograph(view, [&](int x, int /*y*/) {
            return x < 80 ? PixelContent{Vec3(1), near} : PixelContent{Vec3(0), kFocus};
        });
        // Beside a straight edge a disc is covered as far as it lies beyond it.
        for (int x = 45; x < 115; ++x) {
            CAPTURE(x);
            const float t = std::clamp((80 - (static_cast<float>(x) + 0.5f)) / radius, -1.0f, 1.0f);
            const float covered = 0.5f + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
            CHECK(std::abs(light_at(image, x, 80) - covered) < 0.06f);
        }
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: the nearest surface covers those nearer to the focus") {
    const RenderView view = lens_view(160, 160, kAll);
    const float radius = 20;
    for (const float behind : {-3.0f, -4.5f, -6.0f, -9.0f}) {
        CAPTURE(behind);
        const gpu::FloatImage image = photograph(view, [&](int x, int /*y*/) {
            return x < 80 ? PixelContent{Vec3(1), distance_of(-2 * radius, kAll)}
                          : PixelContent{Vec3(0), distance_of(behind, kAll)};
        });
        for (int x = 84; x < 115; ++x) {
            CAPTURE(x);
            const float t = std::clamp((80 - (static_cast<float>(x) + 0.5f)) / radius, -1.0f, 1.0f);
            const float covered = 0.5f + (t * std::sqrt(1 - t * t) + std::asin(t)) / kPi;
            CHECK(std::abs(light_at(image, x, 80) - covered) < 0.06f);
        }
    }
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: a uniform image stays uniform at any depths") {
    for (const IVec2 size : {IVec2(128, 96), IVec2(97, 61), IVec2(7, 5), IVec2(16384, 4)}) {
        CAPTURE(size.x);
        RenderView view = lens_view(size.x, size.y, 14);
        view.lens.aperture_radius = std::max(view.lens.aperture_radius, 0.02f);
        Random random(3, 0, 0, 0);
        std::vector<float> at;
        for (int i = 0; i < 64; ++i) {
            at.push_back(random.uniform(0.5f, 12.0f));
        }
        if (!has_depth_of_field(view)) {
            continue;
        }
        const gpu::FloatImage image = photograph(view, [&](int x, int y) {
            return PixelContent{Vec3(0.5f), at[(x / 9 + 5 * (y / 9)) % 64]};
        });
        const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
        CHECK(*low >= 0.5f * 0.999f);
        CHECK(*high <= 1.0f);  // alpha
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            if (std::abs(image.pixels[i] - 0.5f) > 0.5e-3f) {
                FAIL_CHECK("pixel " << i / 4 << " is " << image.pixels[i]);
                break;
            }
        }
    }
}

TEST_CASE_FIXTURE(
    Darkroom,
    "depth_of_field: a table that approaches the camera shows nothing of the wall behind") {
    constexpr int kSide = 192;
    constexpr int kEdge = 160;  // of the table [px]
    const gpu::FloatImage image = photograph(lens_view(kSide, kSide, kAll), [&](int /*x*/, int y) {
        const float circle = 2 + 30.0f * static_cast<float>(kEdge - y) / kEdge;
        return y < kEdge ? PixelContent{Vec3(0.5f), distance_of(-circle, kAll)}
                         : PixelContent{Vec3(20)};
    });
    for (int y = 2; y < kEdge - 20; ++y) {
        CAPTURE(y);
        CHECK(light_at(image, kSide / 2, y) == near(0.5).epsilon(0.01));
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: surfaces in focus are bit-identical" * technique("post.dof-mip")) {
    Random random(5, 0, 0, 0);
    std::vector<Vec3> light(64 * 48);
    for (Vec3& one : light) {
        one = {random.uniform(0.0f, 9.0f), random.uniform(0.0f, 1.0f), random.uniform(0.0f, 1.0f)};
    }
    for (const FocusMethod method : {FocusMethod::Gather, FocusMethod::Mip}) {
        RenderView view = lens_view(64, 48, 40);
        view.lens.method = method;
        const gpu::FloatImage image = photograph(view, [&](int x, int y) {
            return PixelContent{light[y * 64 + x], kFocus};
        });
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                CHECK(light_at(image, x, y) == light[y * 64 + x].x);
            }
        }
    }
}

TEST_CASE_FIXTURE(Darkroom, "depth_of_field: NaN and infinite radiance do not spread") {
    const RenderView view = lens_view(96, 96, kAll);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity}) {
        const gpu::FloatImage image = photograph(view, [&](int x, int y) {
            return PixelContent{x == 40 && y == 40 ? Vec3(bad) : Vec3(0.25f), 50.0f};
        });
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 96; ++x) {
                CHECK(std::abs(light_at(image, x, y) - 0.25f) < 2e-3f);
            }
        }
    }
}

TEST_CASE("depth_of_field: a lens whose circles are no larger than a pixel adds no pass") {
    RenderView view = lens_view(640, 360, 20);
    CHECK(has_depth_of_field(view));
    view.lens.max_blur = 0;
    CHECK(!has_depth_of_field(view));
    view = lens_view(640, 360, 20);
    view.lens.aperture_radius = 0;
    CHECK(!has_depth_of_field(view));
    // At 2 m infinity is the widest; of what is near the camera the near plane is.
    view = lens_view(640, 360, 0.02f);
    CHECK(!has_depth_of_field(view));
    view = lens_view(640, 360, 0.9f);
    CHECK(has_depth_of_field(view));
}

TEST_CASE_FIXTURE(Scene, "depth_of_field: a pinhole adds no pass, and the image is bit-identical") {
    const MaterialId bright =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 0.5f, 0.25f, 1}});
    place(add(make_square()), bright, at({0.2f, -0.1f, 0}));
    RenderView view = look({0, 0, 3}, {0, 0, 0}, 61, 48);
    static_cast<void>(draw(view));
    const gpu::FloatImage pinhole = radiance(view);
    view.lens = {.aperture_radius = 1e-6f, .focus_distance = 1};
    CHECK(radiance(view).pixels == pinhole.pixels);
    CHECK(!frame_graph(shared_renderer()).was_run("focus.tiles"));
    view.lens.aperture_radius = 0.2f;
    CHECK(radiance(view).pixels != pinhole.pixels);
    CHECK(frame_graph(shared_renderer()).was_run("focus.compose"));
}

TEST_CASE_FIXTURE(Scene, "depth_of_field: glow comes after it, from the image through the lens") {
    place(add(make_square()), add(Material{.shading = ShadingModel::Unlit}), at({0, 0, 0}));
    world.insert_resource(Glow{.strength = 0.1f});
    RenderView view = look({0, 0, 3}, {0, 0, 0}, 64, 48);
    view.lens = {.aperture_radius = 0.3f, .focus_distance = 1};
    static_cast<void>(draw(view));
    std::vector<std::string> names;
    for (const PassTiming& timing : frame_graph(shared_renderer()).timings()) {
        names.emplace_back(timing.name);
    }
    const auto focus = std::find(names.begin(), names.end(), "focus.compose");
    const auto glow = std::find(names.begin(), names.end(), "glow");
    CHECK(focus != names.end());
    CHECK(glow != names.end());
    CHECK(focus < glow);
}

// ---- the cheapest kind (post.dof-mip)

TEST_CASE_FIXTURE(
    Darkroom,
    "depth_of_field: by mip levels, a uniform image stays uniform" * technique("post.dof-mip")) {
    RenderView view = lens_view(64, 64, 14);
    view.lens.method = FocusMethod::Mip;
    const gpu::FloatImage image = photograph(view, [](int x, int y) {
        return PixelContent{
            Vec3(0.5f), 0.6f + 0.1f * static_cast<float>(x) + 0.03f * static_cast<float>(y)};
    });
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            CHECK(light_at(image, x, y) == test::near(0.5f).epsilon(1e-5));
        }
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: by mip levels, a circle of 8 px is level 3 and keeps the mean"
                  * technique("post.dof-mip")) {
    RenderView view = lens_view(64, 64, 14);
    view.lens.method = FocusMethod::Mip;
    const float distance = distance_of(8, 14);
    const gpu::FloatImage image = photograph(view, [&](int x, int y) {
        return PixelContent{Vec3(x == 28 && y == 28 ? 64 : 0), distance};
    });
    // A texel of level 3 is 8 px wide and 1 here; around it a tent of bilinear reading.
    const auto tent = [](int x) {
        return std::max(1 - std::abs(static_cast<float>(x) + 0.5f - 28) / 8, 0.0f);
    };
    double sum = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            CHECK(std::abs(light_at(image, x, y) - tent(x) * tent(y)) < 2e-2f);
            sum += static_cast<double>(light_at(image, x, y));
        }
    }
    CHECK(std::abs(sum - 64) / (64 * 64) < 1.0 / 255);
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: by mip levels, a circle of less than a pixel is level 0"
                  * technique("post.dof-mip")) {
    RenderView view = lens_view(64, 64, 14);
    view.lens.method = FocusMethod::Mip;
    for (const float diameter : {0.9f, -0.9f}) {
        const float distance = distance_of(diameter, 14);
        const gpu::FloatImage image = photograph(view, [&](int x, int y) {
            return PixelContent{Vec3((x + y) % 2 == 0 ? 1 : 0), distance};
        });
        for (int x = 0; x < 64; ++x) {
            CHECK(light_at(image, x, 20) == ((x + 20) % 2 == 0 ? 1.0f : 0.0f));
        }
    }
}

TEST_CASE_FIXTURE(
    Darkroom, "depth_of_field: by mip levels, sharp surfaces leak, which gathering avoids") {
    RenderView view = lens_view(64, 64, 14);
    view.lens.method = FocusMethod::Mip;
    const gpu::FloatImage image = photograph(view, [](int x, int /*y*/) {
        return x < 32 ? PixelContent{Vec3(1), kFocus} : PixelContent{Vec3(0), 40.0f};
    });
    CHECK(light_at(image, 33, 32) > 0.2f);
}

// ---- depth buffers (post.linear-to-window-depth)

TEST_CASE(
    "depth_of_field: eye distance converts to window depth and back"
    * technique("post.linear-to-window-depth")) {
    CHECK(window_depth(1, 1, 100) == 0);
    CHECK(window_depth(100, 1, 100) == test::near(1));
    CHECK(window_depth(2, 1, 100) == test::near(0.505051).epsilon(1e-5));
    CHECK(window_depth(10, 1, 100) == test::near(0.909091).epsilon(1e-5));
    CHECK(window_depth(50, 1, 100) == test::near(0.989899).epsilon(1e-5));
    CHECK(window_depth(0, 1, 100) == 0);
    CHECK(window_depth(-3, 1, 100) == 0);
    double before = -1;
    double slope = 1e9;
    for (double e = 1; e < 100; e += 0.5) {
        const double depth = window_depth(e, 1, 100);
        CHECK(depth > before);
        if (before >= 0) {
            CHECK(depth - before < slope);  // concave
            slope = depth - before;
        }
        before = depth;
        CHECK(eye_distance_of(depth, 1, 100) == test::near(e).epsilon(1e-5));
        const double ndc = (100.0 + 1) / (100 - 1) - 2 * 100.0 / (100 - 1) / e;
        CHECK(depth == test::near(0.5 * ndc + 0.5).scale(1));
        CHECK(reversed_depth(e, 1, 100) == test::near(1 - depth));
    }
    // A source feeds the z of clip space, 0.0202 at 2 m, for the distance: nonsense.
    CHECK(window_depth(0.0202, 1, 100) == test::near(-48.99).epsilon(1e-3));
}

TEST_CASE(
    "depth_of_field: reversed depth without a far plane is the limit of the projection"
    * technique("post.linear-to-window-depth")) {
    const RenderView view = lens_view(64, 64, 10);
    for (const float z : {0.1f, 0.5f, 3.0f, 1000.0f}) {
        const Vec4 clip = view.clip_from_world * Vec4(0, 0, -z, 1);
        const double depth = reversed_depth(static_cast<double>(z), double(kNear));
        CHECK(static_cast<double>(clip.z / clip.w) == test::near(depth).epsilon(1e-5));
        CHECK(reversed_depth(static_cast<double>(z), double(kNear), 1e9) == test::near(depth));
    }
    CHECK(reversed_depth(-1, 0.1) == 1);
    CHECK(reversed_depth(static_cast<double>(kInfinity), 0.1) == 0);
}

}  // namespace limn::test::depth_of_field_test
