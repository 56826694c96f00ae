#include "bench/oracles/ripple_oracle.h"
#include "bench/quality/quality_scene.h"
#include "ecs/components/ripple.h"
#include "ecs/components/transform.h"
#include "render/render_frame.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace limn::ripple_quality {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr const char* kField = "ripple.field";

/// Shift of a pixel's lookup [px, y up] by its center [px from the bottom left] and distance [m].
using ExactShift = std::function<dvec2(const dvec2&, double)>;

struct Rendered {
    gpu::ByteImage display;
    gpu::FloatImage radiance;
    gpu::FloatImage depth;
    gpu::FloatImage field;  ///< empty if nothing ripples
};

/// A level at a fixed time, to which ripples are added and removed again.
class RippleScene {
  public:
    RippleScene(HeadlessRenderer& headless, ToneMapper tone_mapper, LevelView level)
        : headless_(headless), bench_(*headless.device, std::move(tone_mapper)),
          level_(std::move(level)), still_(render()) {}

    [[nodiscard]] World& world() { return level_.stage->world; }
    [[nodiscard]] double time() const { return stage_time(*level_.stage); }
    [[nodiscard]] oracle::RippleCamera camera() const { return oracle::ripple_camera(level_.view); }

    Rendered render() {
        FrameGraph& graph = frame_graph(*headless_.renderer);
        graph.keep_named(kField);
        const FrameOutput out =
            render_frame(*headless_.renderer, world(), level_.view, {.aovs = {"depth"}});
        graph.forget_named(kField);
        Rendered rendered = {
            gpu::read_bytes(*out.display),
            gpu::read_floats(*out.radiance),
            gpu::read_floats(*out.aovs[0].texture),
            {}};
        const TextureId field = graph.find(kField);
        if (field.valid() && graph.texture(field) != nullptr) {
            rendered.field = gpu::read_floats(*graph.texture(field));
        }
        return rendered;
    }

    /// The expected image: bilinear reads of the unrippled one, only from pixels behind `front`.
    [[nodiscard]] ColorImage shifted(const ExactShift& exact, double front) {
        oracle::LightImage image = oracle::make_black_image(kWidth, kHeight);
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const dvec2 shift = exact(center_of(x, y), still_.depth.at(x, y, 0));
                image.pixels[y * kWidth + x] =
                    shift == dvec2(0) ? light_of(x, y)
                                      : light_at({x + shift.x, y - shift.y}, {x, y}, front);
            }
        }
        return bench_.display(image, level_.exposure);
    }
    /// Largest error of the shift field [px].
    [[nodiscard]] double field_error(const Rendered& rendered, const ExactShift& exact) const {
        double worst = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const dvec2 found = {rendered.field.at(x, y, 0), rendered.field.at(x, y, 1)};
                const dvec2 shift = exact(center_of(x, y), still_.depth.at(x, y, 0));
                worst = std::max(worst, glm::distance(found, shift));
            }
        }
        return worst;
    }
    /// Number of changed pixels nearer than `front`.
    [[nodiscard]] int changed_in_front(const Rendered& rendered, double front) const {
        int changed = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                bool same = true;
                for (int c = 0; c < 3; ++c) {
                    same = same && rendered.radiance.at(x, y, c) == still_.radiance.at(x, y, c);
                }
                changed += !same && still_.depth.at(x, y, 0) < front ? 1 : 0;
            }
        }
        return changed;
    }
    [[nodiscard]] ColorImage still() const { return color_image(still_.display); }

  private:
    static dvec2 center_of(int x, int y) { return {x + 0.5, kHeight - y - 0.5}; }
    [[nodiscard]] dvec3 light_of(int x, int y) const {
        const gpu::FloatImage& image = still_.radiance;
        return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
    }
    [[nodiscard]] dvec3 light_at(const dvec2& position, const IVec2& fallback, double front) const {
        const dvec2 corner = glm::floor(position);
        const dvec2 fraction = position - corner;
        dvec3 sum(0);
        double total = 0;
        for (int i = 0; i < 4; ++i) {
            const int x = std::clamp(static_cast<int>(corner.x) + i % 2, 0, kWidth - 1);
            const int y = std::clamp(static_cast<int>(corner.y) + i / 2, 0, kHeight - 1);
            const double weight = (i % 2 == 1 ? fraction.x : 1 - fraction.x)
                                  * (i / 2 == 1 ? fraction.y : 1 - fraction.y);
            if (still_.depth.at(x, y, 0) > front) {
                sum += weight * light_of(x, y);
                total += weight;
            }
        }
        return total > 0 ? sum / total : light_of(fallback.x, fallback.y);
    }

    HeadlessRenderer& headless_;
    ImageBench bench_;
    LevelView level_;
    Rendered still_;
};

/// Measures field, image and unchanged foreground for one ripple, then destroys it.
void measure_one(
    RippleScene& scene, const std::string& name, Entity ripple, const ExactShift& exact,
    double front, QualityReport& report) {
    const Rendered rendered = scene.render();
    scene.world().destroy(ripple);
    QualityImage image = {name, color_image(rendered.display), scene.shifted(exact, front)};
    report.at_most(name + ": error of the field", scene.field_error(rendered, exact), 0.25, "px");
    report.at_least(
        name + ": display PSNR vs the oracle", psnr(image.oracle, image.effect), 40, "dB");
    report.inform(name + ": the same without the ripple", psnr(image.oracle, scene.still()), "dB");
    report.at_most(
        name + ": pixels changed in front of it",
        static_cast<double>(scene.changed_in_front(rendered, front)), 0);
    report.images.push_back(std::move(image));
}

void measure_rings(RippleScene& scene, QualityReport& report) {
    const oracle::RippleCamera camera = scene.camera();
    constexpr Vec3 kCenter = {0, 1.2f, 0};
    for (const float age : {0.1f, 0.3f, 0.6f}) {
        const RippleRing ring = {.age = age, .duration = 1.5f, .speed = 5, .amplitude = 0.04f};
        const oracle::RingWave wave = {
            .center = dvec3(kCenter),
            .radius = 5.0 * static_cast<double>(age),
            .wavelength = static_cast<double>(ring.wavelength),
            .amplitude = 0.04 * (1 - static_cast<double>(age) / 1.5)};
        measure_one(
            scene, fmt::format("ring, {} s", age),
            scene.world().create(ring, WorldTransform{affine_from(kCenter, {1, 0, 0, 0}, Vec3(1))}),
            [&](const dvec2& pixel, double distance) {
                return oracle::ring_shift(camera, wave, pixel, distance);
            },
            glm::dot(dvec3(kCenter) - camera.eye, camera.forward), report);
    }
}

void measure_hazes(RippleScene& scene, QualityReport& report) {
    const oracle::RippleCamera camera = scene.camera();
    const Affine pose = affine_from({-0.5f, 1.6f, -2}, {1, 0, 0, 0}, {3, 1.6f, 1.5f});
    for (const HazeShape shape : {HazeShape::Box, HazeShape::Ball}) {
        const bool ball = shape == HazeShape::Ball;
        const HeatHaze haze = {.shape = shape, .strength = 0.04f, .scale = 0.4f};
        const oracle::HotAir air = {
            .local_from_world = glm::inverse(glm::dmat4(to_mat4(pose))),
            .ball = ball,
            .shift = 0.04 * kHeight,
            .scale = 0.4,
            .raised = static_cast<double>(haze.rise) * scene.time() / 0.4,
            .seed = haze.seed};
        // In front of the whole region; the front of the box is nearer than that of the ball.
        const double front =
            glm::dot(dvec3(-0.5, 1.6, -2) - camera.eye, camera.forward) - (ball ? 3.2 : 3.6);
        measure_one(
            scene, ball ? "hot air, ball" : "hot air, box",
            scene.world().create(haze, WorldTransform{pose}),
            [&](const dvec2& pixel, double distance) {
                return oracle::haze_shift(camera, air, pixel, distance);
            },
            front, report);
    }
}

void measure_screen(RippleScene& scene, QualityReport& report) {
    const ScreenRipple ripple = {.center = {0.4f, 0.55f}, .age = 0.2f};
    const double radius = static_cast<double>(ripple.radius + ripple.radius_speed * ripple.age);
    const double amplitude = static_cast<double>(ripple.amplitude * ripple_fade(ripple));
    measure_one(
        scene, "screen", scene.world().create(ripple),
        [&](const dvec2& pixel, double) {
            const dvec2 size(kWidth, kHeight);
            return size
                   * oracle::screen_shift(pixel / size, dvec2(ripple.center), radius, amplitude);
        },
        0, report);
}

Status measure_ripple(HeadlessRenderer& headless, QualityReport& report) {
    RippleScene scene(
        headless, LIMN_TRY(create_tone_mapper(*headless.device)),
        LIMN_TRY(open_level_view("gallery", {kWidth, kHeight})));
    measure_rings(scene, report);
    measure_hazes(scene, report);
    measure_screen(scene, report);

    const Entity still = scene.world().create(
        RippleRing{.age = 0.3f, .amplitude = 0},
        WorldTransform{affine_from({0, 1, 0}, {1, 0, 0, 0}, Vec3(1))});
    report.at_most(
        "pixels changed by a ripple of zero strength",
        static_cast<double>(scene.changed_in_front(scene.render(), 1e30)), 0);
    scene.world().destroy(still);
    return Done{};
}

const RegisterQuality kRegistered("ripple", "analytic shifts in double precision", measure_ripple);

}  // namespace
}  // namespace limn::ripple_quality
