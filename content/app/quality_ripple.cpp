#include "content/app/quality_ripple.h"

#include "bench/oracles/ripple_oracle.h"
#include "content/app/stage.h"
#include "ecs/base/text.h"
#include "ecs/components/post.h"
#include "ecs/components/ripple.h"
#include "ecs/components/transform.h"
#include "render/develop.h"
#include "render/gpu/readback.h"
#include "render/graph/frame_graph.h"
#include "render/render_frame.h"
#include "render/render_view.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace limn {
namespace {

using glm::dvec2;
using glm::dvec3;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr const char* kField = "ripple.field";

/// Where a pixel looks instead: of its middle [px from below] and the distance of what it shows.
using ExactShift = std::function<dvec2(const dvec2&, double)>;

oracle::RippleCamera camera_of(const RenderView& view) {
    const Affine& pose = view.world_from_camera;
    const auto column = [&](int c) {
        return dvec3(pose.row[0][c], pose.row[1][c], pose.row[2][c]);
    };
    return {
        .eye = column(3),
        .right = column(0),
        .up = column(1),
        .forward = -column(2),
        .tangent = dvec2(view.tangent),
        .size = dvec2(view.width, view.height),
        .near = view.near};
}

struct Seen {
    gpu::ByteImage display;
    gpu::FloatImage radiance;
    gpu::FloatImage depth;
    gpu::FloatImage field;  ///< without pixels if nothing ripples
};

/// A level at one of its moments, to which ripples are added and taken away again.
class Court {
  public:
    Court(HeadlessRenderer& headless, Developer developer, Stage& stage, const RenderView& view)
        : headless_(headless), developer_(std::move(developer)), graph_(*headless.device),
          stage_(stage), view_(view), still_(look()) {}

    [[nodiscard]] World& world() { return stage_.world; }
    [[nodiscard]] oracle::RippleCamera camera() const { return camera_of(view_); }

    Seen look() {
        FrameGraph& graph = frame_graph(*headless_.renderer);
        graph.keep_named(kField);
        const FrameOutput out =
            render_frame(*headless_.renderer, stage_.world, view_, {.aovs = {"depth"}});
        graph.forget_named(kField);
        Seen seen = {
            gpu::read_bytes(*out.display),
            gpu::read_floats(*out.radiance),
            gpu::read_floats(*out.aovs[0].texture),
            {}};
        const TextureId field = graph.find(kField);
        if (field.valid() && graph.texture(field) != nullptr) {
            seen.field = gpu::read_floats(*graph.texture(field));
        }
        return seen;
    }

    /// What the picture would be: read between the four nearest pixels, of those behind `front`.
    [[nodiscard]] ColorImage shifted(const ExactShift& exact, double front) {
        std::vector<Vec4> texels;
        for (int y = kHeight - 1; y >= 0; --y) {  // bottom row first
            for (int x = 0; x < kWidth; ++x) {
                const dvec2 shift = exact(middle_of(x, y), still_.depth.at(x, y, 0));
                const dvec3 light = shift == dvec2(0)
                                        ? light_of(x, y)
                                        : light_at({x + shift.x, y - shift.y}, {x, y}, front);
                texels.emplace_back(Vec3(light), 1.0f);
            }
        }
        return developed(texels);
    }
    /// Largest distance of the field from the exact one [px].
    [[nodiscard]] double field_error(const Seen& seen, const ExactShift& exact) const {
        double worst = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const dvec2 found = {seen.field.at(x, y, 0), seen.field.at(x, y, 1)};
                const dvec2 shift = exact(middle_of(x, y), still_.depth.at(x, y, 0));
                worst = std::max(worst, glm::distance(found, shift));
            }
        }
        return worst;
    }
    /// Pixels nearer than `front` that are not as they were.
    [[nodiscard]] int changed_before(const Seen& seen, double front) const {
        int changed = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                bool same = true;
                for (int c = 0; c < 3; ++c) {
                    same = same && seen.radiance.at(x, y, c) == still_.radiance.at(x, y, c);
                }
                changed += !same && still_.depth.at(x, y, 0) < front ? 1 : 0;
            }
        }
        return changed;
    }
    [[nodiscard]] static ColorImage shown(const gpu::ByteImage& bytes) {
        ColorImage image = {kWidth, kHeight, {}};
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                image.pixels.push_back(
                    Vec3(bytes.at(x, y, 0), bytes.at(x, y, 1), bytes.at(x, y, 2)) / 255.0f);
            }
        }
        return image;
    }
    [[nodiscard]] ColorImage still() const { return shown(still_.display); }

  private:
    static dvec2 middle_of(int x, int y) { return {x + 0.5, kHeight - y - 0.5}; }
    [[nodiscard]] dvec3 light_of(int x, int y) const {
        const gpu::FloatImage& image = still_.radiance;
        return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
    }
    [[nodiscard]] dvec3 light_at(const dvec2& place, const IVec2& otherwise, double front) const {
        const dvec2 corner = glm::floor(place);
        const dvec2 share = place - corner;
        dvec3 sum(0);
        double total = 0;
        for (int i = 0; i < 4; ++i) {
            const int x = std::clamp(static_cast<int>(corner.x) + i % 2, 0, kWidth - 1);
            const int y = std::clamp(static_cast<int>(corner.y) + i / 2, 0, kHeight - 1);
            const double weight =
                (i % 2 == 1 ? share.x : 1 - share.x) * (i / 2 == 1 ? share.y : 1 - share.y);
            if (still_.depth.at(x, y, 0) > front) {
                sum += weight * light_of(x, y);
                total += weight;
            }
        }
        return total > 0 ? sum / total : light_of(otherwise.x, otherwise.y);
    }
    [[nodiscard]] ColorImage developed(const std::vector<Vec4>& texels) {
        gpu::Texture radiance(
            "radiance", {.format = GL_RGBA32F, .width = kWidth, .height = kHeight});
        radiance.upload<Vec4>(texels, GL_RGBA, GL_FLOAT);
        const auto* exposure = stage_.world.find_resource<Exposure>();
        graph_.begin_frame();
        const TextureId display = develop(
            graph_, developer_, exposure != nullptr ? *exposure : Exposure{}, std::nullopt,
            graph_.import("radiance", radiance));
        graph_.keep(display);
        graph_.execute();
        return shown(gpu::read_bytes(*graph_.texture(display)));
    }

    HeadlessRenderer& headless_;
    Developer developer_;
    FrameGraph graph_;
    Stage& stage_;
    RenderView view_;
    Seen still_;
};

/// Field, picture and what stands in front, of one ripple that is there while this runs.
void measure_one(
    Court& court, const std::string& name, Entity ripple, const ExactShift& exact, double front,
    QualityReport& report) {
    const Seen seen = court.look();
    court.world().destroy(ripple);
    QualityPicture picture = {name, Court::shown(seen.display), court.shifted(exact, front)};
    report.rows.push_back(
        {name + ": field, off by", court.field_error(seen, exact), QualityBound::AtMost, 0.25,
         "px"});
    report.rows.push_back(
        {name + ": as shown, beside the oracle", psnr(picture.oracle, picture.effect),
         QualityBound::AtLeast, 40, "dB"});
    report.rows.push_back(
        {name + ": the same without the ripple", psnr(picture.oracle, court.still()),
         QualityBound::None, 0, "dB"});
    report.rows.push_back(
        {name + ": pixels changed before it",
         static_cast<double>(court.changed_before(seen, front)), QualityBound::AtMost, 0, ""});
    report.pictures.push_back(std::move(picture));
}

void measure_rings(Court& court, QualityReport& report) {
    const oracle::RippleCamera camera = court.camera();
    constexpr Vec3 kCenter = {0, 1.2f, 0};
    for (const float age : {0.1f, 0.3f, 0.6f}) {
        const RippleRing ring = {.age = age, .duration = 1.5f, .speed = 5, .amplitude = 0.04f};
        const oracle::RingWave wave = {
            .center = dvec3(kCenter),
            .radius = 5.0 * static_cast<double>(age),
            .wavelength = static_cast<double>(ring.wavelength),
            .amplitude = 0.04 * (1 - static_cast<double>(age) / 1.5)};
        measure_one(
            court, fmt::format("ring, {} s", age),
            court.world().create(ring, WorldTransform{affine_from(kCenter, {1, 0, 0, 0}, Vec3(1))}),
            [&](const dvec2& pixel, double distance) {
                return oracle::ring_shift(camera, wave, pixel, distance);
            },
            glm::dot(dvec3(kCenter) - camera.eye, camera.forward), report);
    }
}

void measure_hazes(Court& court, double time, QualityReport& report) {
    const oracle::RippleCamera camera = court.camera();
    const Affine pose = affine_from({-0.5f, 1.6f, -2}, {1, 0, 0, 0}, {3, 1.6f, 1.5f});
    for (const HazeShape shape : {HazeShape::Box, HazeShape::Ball}) {
        const bool ball = shape == HazeShape::Ball;
        const HeatHaze haze = {.shape = shape, .strength = 0.04f, .scale = 0.4f};
        const oracle::HotAir air = {
            .local_from_world = glm::inverse(glm::dmat4(to_mat4(pose))),
            .ball = ball,
            .shift = 0.04 * kHeight,
            .scale = 0.4,
            .raised = static_cast<double>(haze.rise) * time / 0.4,
            .seed = haze.seed};
        // In front of the whole region; the front of the box is nearer than that of the ball.
        const double front =
            glm::dot(dvec3(-0.5, 1.6, -2) - camera.eye, camera.forward) - (ball ? 3.2 : 3.6);
        measure_one(
            court, ball ? "hot air, ball" : "hot air, box",
            court.world().create(haze, WorldTransform{pose}),
            [&](const dvec2& pixel, double distance) {
                return oracle::haze_shift(camera, air, pixel, distance);
            },
            front, report);
    }
}

void measure_screen(Court& court, QualityReport& report) {
    const ScreenRipple ripple = {.center = {0.4f, 0.55f}, .age = 0.2f};
    const double radius = static_cast<double>(ripple.radius + ripple.radius_speed * ripple.age);
    const double amplitude = static_cast<double>(ripple.amplitude * ripple_fade(ripple));
    measure_one(
        court, "screen", court.world().create(ripple),
        [&](const dvec2& pixel, double) {
            const dvec2 size(kWidth, kHeight);
            return size
                   * oracle::screen_shift(pixel / size, dvec2(ripple.center), radius, amplitude);
        },
        0, report);
}

}  // namespace

Result<QualityReport> measure_ripple(HeadlessRenderer& headless) {
    Result<std::unique_ptr<Stage>> opened = open_stage("gallery");
    if (!opened) {
        return opened.error();
    }
    Stage& stage = **opened;
    static_cast<void>(advance_stage(stage, 1));
    const std::optional<Entity> camera = find_camera(stage.world);
    if (!camera) {
        return fail("level gallery: found no camera, expected one");
    }
    Result<Developer> developer = create_developer(*headless.device);
    if (!developer) {
        return developer.error();
    }
    Court court(
        headless, *std::move(developer), stage,
        make_render_view(stage.world, *camera, {.width = kWidth, .height = kHeight}));
    QualityReport report;
    measure_rings(court, report);
    measure_hazes(court, stage_time(stage), report);
    measure_screen(court, report);

    const Entity still = court.world().create(
        RippleRing{.age = 0.3f, .amplitude = 0},
        WorldTransform{affine_from({0, 1, 0}, {1, 0, 0, 0}, Vec3(1))});
    report.rows.push_back(
        {"pixels changed by a ripple of no strength",
         static_cast<double>(court.changed_before(court.look(), 1e30)), QualityBound::AtMost, 0,
         ""});
    court.world().destroy(still);
    return report;
}

}  // namespace limn
