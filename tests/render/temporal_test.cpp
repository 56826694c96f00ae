#include "ecs/components/rendering.h"
#include "ecs/components/time.h"
#include "render/graph/frame_graph.h"
#include "render/lens/temporal_pass.h"
#include "tests/near.h"
#include "tests/render/shutter_fixture.h"
#include "tests/technique.h"

#include <cmath>
#include <limits>

namespace limn::test::temporal_test {
namespace {

class Temporal : public Shutter {
  public:
    void smooth(bool on) {
        world.insert_resource(
            Rendering{.antialiasing = on ? Antialiasing::Temporal : Antialiasing::None});
    }
    /// Thin and slanted things of high contrast.
    void place_objects() {
        world.insert_resource(Environment{});
        for (int i = 0; i < 9; ++i) {
            const float x = -0.9f + 0.22f * static_cast<float>(i);
            const float gray = i % 2 == 0 ? 0.9f : 0.1f;
            const Quat lean = glm::angleAxis(0.08f * static_cast<float>(i), Vec3(0, 0, 1));
            place(
                square, unlit({gray, 0.5f, 1 - gray}),
                affine_from({x, 0, 0}, lean, {0.012f * static_cast<float>(i + 1), 0.8f, 1}));
        }
    }
    gpu::FloatImage after(int pictures) {
        gpu::FloatImage image;
        for (int i = 0; i < pictures; ++i) {
            image = picture();
        }
        return image;
    }
    /// The mean of as many images as the jitter has offsets.
    gpu::FloatImage mean() {
        return gpu::read_floats(
            *render_accumulated(shared_renderer(), world, front(), kTemporalSamples).radiance);
    }
};

/// Of radiance between 0 and 1 [dB].
double psnr_of(const gpu::FloatImage& a, const gpu::FloatImage& b) {
    double sum = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const Vec3 difference = rgb_at(a, x, y) - rgb_at(b, x, y);
            sum += static_cast<double>(glm::dot(difference, difference));
        }
    }
    return -10 * std::log10(sum / (3.0 * a.width * a.height));
}

}  // namespace

TEST_CASE_FIXTURE(
    Temporal, "temporal: switched off, it adds no pass, and the image is bit-identical") {
    place_objects();
    const gpu::FloatImage plain = picture();
    smooth(false);
    CHECK(picture().pixels == plain.pixels);
    CHECK_FALSE(frame_graph(shared_renderer()).was_run("temporal"));
    smooth(true);
    static_cast<void>(picture());
    CHECK(frame_graph(shared_renderer()).was_run("temporal"));
}

TEST_CASE_FIXTURE(
    Temporal, "temporal: a static scene converges to the mean of its jittered images"
                  * technique("post.temporal")) {
    place_objects();
    const gpu::FloatImage want = mean();
    const gpu::FloatImage plain = picture();
    smooth(true);
    const gpu::FloatImage found = after(64);
    CHECK(psnr_of(plain, want) < 26);
    CHECK(psnr_of(found, want) > 40);
}

TEST_CASE_FIXTURE(Temporal, "temporal: a static scene does not shimmer") {
    place_objects();
    smooth(true);
    gpu::FloatImage before = after(48);
    for (int i = 0; i < kTemporalSamples; ++i) {
        const gpu::FloatImage now = picture();
        CHECK(largest_difference(now, before) < 0.06f);
        CHECK(psnr_of(now, before) > 46);
        before = now;
    }
}

TEST_CASE_FIXTURE(
    Temporal, "temporal: a disoccluded background keeps nothing of its occluder"
                  * technique("post.temporal")) {
    const Vec3 wall = {0.1f, 0.3f, 0.2f};
    bar(unlit(wall), -100, 200, 0, -1);
    const Entity mover = bar(unlit({1, 1, 1}), 8, 24, 0);
    smooth(true);
    static_cast<void>(after(20));
    world.get<PreviousWorldTransform>(mover).world = world.get<WorldTransform>(mover).world;
    world.get<WorldTransform>(mover).world.row[0].w += 24 / Shutter::kPerMeter;
    const gpu::FloatImage gone = picture();
    for (int x = 9; x < 30; ++x) {
        CAPTURE(x);
        CHECK(glm::distance(rgb_at(gone, x, 32), wall) < 2e-3f);
    }
    CHECK(gone.at(40, 32, 0) == test::near(1).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    Temporal,
    "temporal: a moving object that darkens leaves no ghost" * technique("post.temporal")) {
    // Faint stripes, so that a neighborhood has some variance.
    std::vector<Entity> stripes;
    std::vector<MaterialId> colors;
    for (int i = 0; i < 60; ++i) {
        colors.push_back(unlit({5, 5, 5}));
        const auto begin = static_cast<float>(-40 + 2 * i);
        stripes.push_back(bar(colors.back(), begin, begin + 2, 1.5f));
    }
    const auto step = [&] {
        for (const Entity entity : stripes) {
            auto& pose = world.get<WorldTransform>(entity).world;
            world.get<PreviousWorldTransform>(entity).world = pose;
            pose.row[0].w += 1.5f / Shutter::kPerMeter;
        }
        return picture();
    };
    smooth(true);
    for (int i = 0; i < 8; ++i) {
        static_cast<void>(step());
    }
    std::vector<MaterialId> dark;
    for (std::size_t i = 0; i < stripes.size(); ++i) {
        dark.push_back(unlit(Vec3(i % 2 == 0 ? 0.45f : 0.55f)));
        world.get<MeshInstance>(stripes[i]).material = dark.back();
    }
    const gpu::FloatImage now = step();
    for (int x = 20; x < 44; ++x) {
        CAPTURE(x);
        CHECK(now.at(x, 32, 0) < 0.65f);
        CHECK(now.at(x, 32, 0) > 0.4f);
    }
}

TEST_CASE_FIXTURE(Temporal, "temporal: a moving texture stays in place and smooth") {
    std::vector<Entity> bars;
    for (int i = 0; i < 12; ++i) {
        const auto begin = static_cast<float>(-30 + 11 * i);
        const Entity entity = bar(unlit({1, 0.8f, 0.3f}), begin, begin + 5.4f, 0);
        auto& pose = world.get<WorldTransform>(entity).world;
        pose = pose * affine_from({0, 0, 0}, glm::angleAxis(0.1f, Vec3(0, 0, 1)), Vec3(1));
        bars.push_back(entity);
    }
    smooth(true);
    for (int frame = 0; frame < 24; ++frame) {
        for (const Entity entity : bars) {
            auto& pose = world.get<WorldTransform>(entity).world;
            world.get<PreviousWorldTransform>(entity).world = pose;
            pose.row[0].w += 1.37f / Shutter::kPerMeter;
        }
        static_cast<void>(picture());
    }
    const gpu::FloatImage found = gpu::read_floats(
        *frame_graph(shared_renderer()).texture(frame_graph(shared_renderer()).find("temporal")));
    const gpu::FloatImage want = mean();
    smooth(false);
    const double rough = psnr_of(picture(), want);
    CAPTURE(rough);
    CHECK(psnr_of(found, want) > rough + 2);
}

TEST_CASE_FIXTURE(Temporal, "temporal: a cut, another size and another setting reset the history") {
    smooth(true);
    const Entity light = bar(unlit({1, 1, 1}), 0, 64, 0);
    world.insert_resource(FrameTime{.step = 0.1f, .time = 1});
    static_cast<void>(after(4));
    world.get<WorldTransform>(light).world = at({0, 0, 50});
    world.insert_resource(FrameTime{.step = 0.1f, .time = 9});
    CHECK(picture().at(32, 32, 0) == 0.0f);

    world.get<WorldTransform>(light).world = at({0, 0, 0});
    static_cast<void>(after(3));
    world.get<WorldTransform>(light).world = at({0, 0, 50});
    CHECK(radiance(front(48, 48)).at(24, 24, 0) == 0.0f);

    world.get<WorldTransform>(light).world = at({0, 0, 0});
    static_cast<void>(after(3));
    smooth(false);
    static_cast<void>(picture());
    world.get<WorldTransform>(light).world = at({0, 0, 50});
    smooth(true);
    CHECK(picture().at(32, 32, 0) == 0.0f);
}

TEST_CASE_FIXTURE(Temporal, "temporal: an edit after a cut shows at once, and converges") {
    place_objects();
    smooth(true);
    const auto paint = [&](const Vec4& color) {
        auto& assets = world.resource<Assets>();
        for (Material& material : assets.materials) {
            material.base_color = color;
        }
        ++assets.material_version;
    };
    const Vec4 before = {0.9f, 0.1f, 0.1f, 1};
    const Vec4 edited = {0.1f, 0.2f, 0.9f, 1};
    paint(edited);
    world.insert_resource(FrameTime{.step = 0.1f, .time = 9});  // a cut by itself
    const gpu::FloatImage want = picture();
    paint(before);
    static_cast<void>(after(40));
    paint(edited);
    cut(shared_renderer());
    CHECK(picture().pixels == want.pixels);
    const gpu::FloatImage found = after(64);
    CHECK(psnr_of(found, mean()) > 40);
}

TEST_CASE_FIXTURE(Temporal, "temporal: an image of one color keeps it, NaN becomes black") {
    bar(unlit({0.25f, 0.5f, 0.75f}), -100, 200, 7);
    smooth(true);
    const gpu::FloatImage found = after(5);
    CHECK(largest_difference(found, picture()) < 1e-6f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {nan, nan, nan}});
    world.clear();
    static_cast<void>(after(48));
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {0.5f, 0.5f, 0.5f}});
    const gpu::FloatImage healed = after(kTemporalSamples);
    CHECK(healed.at(32, 32, 1) == test::near(0.5).epsilon(0.05));
}

TEST_CASE_FIXTURE(Temporal, "temporal: motion vectors exclude the jitter") {
    place_objects();
    smooth(true);
    for (int i = 0; i < 5; ++i) {
        const gpu::FloatImage velocity = aov(front(), "velocity");
        for (int y = 0; y < velocity.height; ++y) {
            for (int x = 0; x < velocity.width; ++x) {
                CHECK(std::abs(velocity.at(x, y, 0)) + std::abs(velocity.at(x, y, 1)) < 1e-2f);
            }
        }
    }
}

}  // namespace limn::test::temporal_test
