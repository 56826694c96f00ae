#include "bench/oracles/motion_blur_oracle.h"
#include "ecs/components/time.h"
#include "tests/render/shutter_fixture.h"

#include <set>

namespace limn::test {
namespace {

constexpr int kSize = Shutter::kSize;

/// The engine's own older methods of motion blur.
class OldShutter : public Shutter {
  public:
    void set_mode(MotionBlurMode mode, float shutter = 360) {
        world.insert_resource(
            MotionBlur{.mode = mode, .shutter = shutter, .samples = 64, .longest = 1});
    }
    void set_time(double time) { world.insert_resource(FrameTime{.step = 0.1f, .time = time}); }
    /// In front of all there is, from now on or no more.
    void flash(bool on) {
        world.get<WorldTransform>(light).world = on ? at({0, 0, 0.1f}) : at({0, 0, 50});
    }
    float middle() { return picture().at(kSize / 2, kSize / 2, 0); }

    Entity light = place(square, unlit({1, 1, 1}), at({0, 0, 50}));
};

}  // namespace

// ---- the mean of the last pictures

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: the mean of equal pictures is that picture, to the bit") {
    world.insert_resource(Environment{});
    bar(unlit({0.3f, 0.7f, 0.1f}), 10, 40, 0);
    set_mode(MotionBlurMode::Accumulate);
    const gpu::FloatImage plain = sharp();
    for (int i = 0; i < 7; ++i) {
        CHECK(picture().pixels == plain.pixels);
    }
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: a flash of one picture is a fifth of it in five pictures") {
    flash(true);
    const float full = middle();
    CHECK(full == doctest::Approx(1));
    flash(false);
    set_mode(MotionBlurMode::Accumulate);
    for (int i = 0; i < 5; ++i) {
        CHECK(middle() == 0.0f);
    }
    flash(true);
    CHECK(middle() == doctest::Approx(0.2f * full).epsilon(1e-6));
    flash(false);
    for (int i = 0; i < 4; ++i) {
        CHECK(middle() == doctest::Approx(0.2f * full).epsilon(1e-6));
    }
    CHECK(middle() == 0.0f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: at first it is the mean of the pictures that there are") {
    set_mode(MotionBlurMode::Accumulate);
    flash(true);
    CHECK(middle() == doctest::Approx(1));
    flash(false);
    CHECK(middle() == doctest::Approx(1.0 / 2));
    CHECK(middle() == doctest::Approx(1.0 / 3));
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: a cut, another size and another mode begin anew") {
    set_time(1);
    set_mode(MotionBlurMode::Accumulate);
    flash(true);
    CHECK(middle() == doctest::Approx(1));
    flash(false);
    set_time(5);
    CHECK(middle() == 0.0f);

    flash(true);
    static_cast<void>(middle());
    flash(false);
    CHECK(radiance(front(32, 32)).at(16, 16, 0) == 0.0f);

    flash(true);
    static_cast<void>(middle());
    flash(false);
    set_mode(MotionBlurMode::Reconstruct);
    static_cast<void>(middle());
    set_mode(MotionBlurMode::Accumulate);
    CHECK(middle() == 0.0f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: n moments of an edge that moves give steps of 1 / n") {
    const Entity edge = bar(unlit({1, 1, 1}), 8, 24, 0);
    const Affine pose = world.get<WorldTransform>(edge).world;
    const auto mean_of = [&](int count, double shutter) {
        oracle::MeanPicture mean;
        for (int i = 0; i < count; ++i) {
            Affine moved = pose;
            moved.row[0].w += static_cast<float>(
                32 * oracle::exposure_moment(i, count, shutter) / Shutter::kPerMeter);
            world.get<WorldTransform>(edge).world = moved;
            mean.add(picture());
        }
        return mean.mean();
    };
    world.get<WorldTransform>(edge).world = pose;
    CHECK(mean_of(1, 0).pixels == picture().pixels);
    std::set<int> quarters;
    const gpu::FloatImage mean = mean_of(4, 180);
    for (const double value : row_of(mean, 32, 0)) {
        CHECK(4 * value == doctest::Approx(std::round(4 * value)));
        quarters.insert(static_cast<int>(std::round(4 * value)));
    }
    CHECK(quarters == std::set<int>{0, 1, 2, 3, 4});
}

// ---- the spread of a point by the camera's motion

namespace {

/// From (0, 0, 1), after a step by which the plane z = 0 goes `way` [px] to the right.
RenderView stepped(float way) {
    const Affine now = look_at({0, 0, 1}, {0, 0, 0});
    Affine before = now;
    before.row[0].w += way / Shutter::kPerMeter;
    return make_render_view(
        {.fov_y = radians(90.0f)}, now, before, {.width = kSize, .height = kSize});
}

}  // namespace

TEST_CASE_FIXTURE(OldShutter, "motion camera: a camera that stands changes no bit") {
    world.insert_resource(Environment{});
    bar(unlit({0.3f, 0.7f, 0.1f}), 10, 40, 12);
    bar(unlit({0.9f, 0.2f, 0.1f}), 0, 50, 0, -3.7f);
    set_mode(MotionBlurMode::Camera);
    CHECK(picture().pixels == sharp().pixels);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion camera: a point becomes a line as long as its way, of the same light") {
    bar(unlit({0, 0, 0}), -200, 300, 0, -0.001f);
    bar(unlit({1, 1, 1}), 32, 33, 0);
    set_mode(MotionBlurMode::Camera);
    for (const float shutter : {360.0f, 180.0f}) {
        set_mode(MotionBlurMode::Camera, shutter);
        const gpu::FloatImage blurred = radiance(stepped(8));
        const double way = 8.0 * static_cast<double>(shutter) / 360;
        const std::vector<double> want = oracle::box_filter(row_of(sharp(stepped(8)), 32, 0), way);
        double energy = 0;
        for (int x = 0; x < kSize; ++x) {
            CAPTURE(x);
            CHECK(std::abs(blurred.at(x, 32, 0) - want[x]) < 1e-3);
            energy += blurred.at(x, 32, 0);
        }
        CHECK(energy == doctest::Approx(1).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(OldShutter, "motion camera: a picture of one color keeps it") {
    bar(unlit({0.4f, 0.5f, 0.6f}), -500, 600, 0);
    set_mode(MotionBlurMode::Camera);
    CHECK(largest_difference(radiance(stepped(23)), sharp()) < 1e-6f);
}

TEST_CASE_FIXTURE(OldShutter, "motion camera: a roll about the view axis leaves the middle alone") {
    constexpr int kOdd = 65;
    for (int i = 0; i < 16; ++i) {
        const float begin = 4.0f * static_cast<float>(i);
        bar(unlit({i % 2 == 0 ? 1.0f : 0.0f, 0.5f, 0.2f}), begin, begin + 4, 0);
    }
    Affine now = look_at({0, 0, 1}, {0, 0, 0});
    const Affine before =
        now * affine_from({0, 0, 0}, glm::angleAxis(0.4f, Vec3(0, 0, 1)), Vec3(1));
    const RenderView view =
        make_render_view({.fov_y = radians(90.0f)}, now, before, {.width = kOdd, .height = kOdd});
    set_mode(MotionBlurMode::Camera);
    const gpu::FloatImage blurred = radiance(view);
    const gpu::FloatImage plain = sharp(view);
    CHECK(rgb_at(blurred, 32, 32) == rgb_at(plain, 32, 32));
    CHECK(largest_difference(blurred, plain) > 0.2f);
}

}  // namespace limn::test
