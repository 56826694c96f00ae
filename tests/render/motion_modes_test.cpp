#include "bench/oracles/motion_blur_oracle.h"
#include "ecs/base/rng.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"
#include "tests/render/shutter_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace limn::test::motion_modes_test {
namespace {

constexpr int kSize = Shutter::kSize;

/// A closed box from -1 to 1 along each axis, smooth at its corners: flat sides would tear apart.
MeshData make_block() {
    MeshData mesh;
    mesh.name = "block";
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            Vec3 normal(0);
            Vec3 u(0);
            normal[axis] = side;
            u[(axis + 1) % 3] = 1;
            const Vec3 v = glm::cross(normal, u);
            const auto base = static_cast<std::uint32_t>(mesh.positions.size());
            for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
                mesh.positions.push_back(normal + corner.x * u + corner.y * v);
                mesh.normals.push_back(glm::normalize(mesh.positions.back()));
            }
            for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) {
                mesh.indices.push_back(base + i);
            }
        }
    }
    mesh.bounds = {{-1, -1, -1}, {1, 1, 1}};
    return mesh;
}

/// The engine's own older methods of motion blur.
class OldShutter : public Shutter {
  public:
    void set_mode(MotionBlurMode mode, float shutter = 360) {
        world.insert_resource(
            MotionBlur{.mode = mode, .shutter = shutter, .samples = 64, .max_length = 1});
    }
    void set_time(double time) { world.insert_resource(FrameTime{.step = 0.1f, .time = time}); }
    /// In front of all there is, from now on or no more.
    void flash(bool on) {
        world.get<WorldTransform>(light).world = on ? at({0, 0, 0.1f}) : at({0, 0, 50});
    }
    float center_value() { return picture().at(kSize / 2, kSize / 2, 0); }

    Entity light = place(square, unlit({1, 1, 1}), at({0, 0, 50}));
};

}  // namespace

// ---- the mean of the last images

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: the mean of equal images is bit-identical to them"
                    * technique("post.motion-blur-accumulation")) {
    world.insert_resource(Environment{});
    bar(unlit({0.3f, 0.7f, 0.1f}), 10, 40, 0);
    set_mode(MotionBlurMode::Accumulate);
    const gpu::FloatImage plain = sharp();
    for (int i = 0; i < 7; ++i) {
        CHECK(picture().pixels == plain.pixels);
    }
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: a flash of one frame is a fifth of it in five frames"
                    * technique("post.motion-blur-accumulation")) {
    flash(true);
    const float full = center_value();
    CHECK(full == test::near(1));
    flash(false);
    set_mode(MotionBlurMode::Accumulate);
    for (int i = 0; i < 5; ++i) {
        CHECK(center_value() == 0.0f);
    }
    flash(true);
    CHECK(center_value() == test::near(0.2f * full).epsilon(1e-6));
    flash(false);
    for (int i = 0; i < 4; ++i) {
        CHECK(center_value() == test::near(0.2f * full).epsilon(1e-6));
    }
    CHECK(center_value() == 0.0f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: at first it is the mean of the frames so far"
                    * technique("post.motion-blur-accumulation")) {
    set_mode(MotionBlurMode::Accumulate);
    flash(true);
    CHECK(center_value() == test::near(1));
    flash(false);
    CHECK(center_value() == test::near(1.0 / 2));
    CHECK(center_value() == test::near(1.0 / 3));
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: no residue remains of a very bright frame"
                    * technique("post.motion-blur-accumulation")) {
    // A sum that images are added to and taken from again would keep what it rounds off.
    set_mode(MotionBlurMode::Accumulate);
    const MaterialId dim = unlit({0.3f, 0.7f, 0.1f});
    const Entity bright = bar(dim, 10, 40, 0);
    auto& materials = world.resource<Assets>().materials;
    for (int i = 0; i < 40; ++i) {
        materials[dim.index].base_color.x = i % 3 == 0 ? 4e5f : 0.017f * static_cast<float>(i);
        world.get<MeshInstance>(bright).material = dim;
        static_cast<void>(picture());
    }
    materials[dim.index].base_color.x = 0.3f;
    for (int i = 0; i < 5; ++i) {
        static_cast<void>(picture());
    }
    CHECK(picture().pixels == sharp().pixels);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: a cut, another size and another mode reset it") {
    set_time(1);
    set_mode(MotionBlurMode::Accumulate);
    flash(true);
    CHECK(center_value() == test::near(1));
    flash(false);
    set_time(5);
    CHECK(center_value() == 0.0f);

    flash(true);
    static_cast<void>(center_value());
    flash(false);
    CHECK(radiance(front(32, 32)).at(16, 16, 0) == 0.0f);

    flash(true);
    static_cast<void>(center_value());
    flash(false);
    set_mode(MotionBlurMode::Reconstruct);
    static_cast<void>(center_value());
    set_mode(MotionBlurMode::Accumulate);
    CHECK(center_value() == 0.0f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion accumulation: n frames of a moving edge give steps of 1 / n"
                    * technique("post.motion-blur-accumulation")) {
    const Entity edge = bar(unlit({1, 1, 1}), 8, 24, 0);
    const Affine pose = world.get<WorldTransform>(edge).world;
    set_mode(MotionBlurMode::Accumulate);
    constexpr int kStep = 4;  // [px]
    for (int frame = 0; frame < 9; ++frame) {
        Affine moved = pose;
        moved.row[0].w += static_cast<float>(kStep * frame) / Shutter::kPerMeter;
        world.get<WorldTransform>(edge).world = moved;
        const std::vector<double> row = row_of(picture(), 32, 0);
        const int first = std::max(frame - 4, 0);  // of at most five
        std::set<int> levels;
        for (int x = 0; x < kSize; ++x) {
            int covered = 0;
            for (int i = first; i <= frame; ++i) {
                covered += x >= 8 + kStep * i && x < 24 + kStep * i ? 1 : 0;
            }
            CAPTURE(frame);
            CAPTURE(x);
            const double count = frame - first + 1;
            CHECK(row[static_cast<std::size_t>(x)] == test::near(covered / count).epsilon(1e-3));
            levels.insert(covered);
        }
        CHECK(levels.size() >= std::min<std::size_t>(frame + 2, 5));
    }
}

// ---- the spread of a point by the camera's motion

namespace {

/// View from (0, 0, 1), after a step that moves the plane z = 0 by `motion` [px] to the right.
RenderView stepped(float motion) {
    const Affine now = look_at({0, 0, 1}, {0, 0, 0});
    Affine before = now;
    before.row[0].w += motion / Shutter::kPerMeter;
    return make_render_view(
        {.fov_y = radians(90.0f)}, now, before, {.width = kSize, .height = kSize});
}

}  // namespace

TEST_CASE_FIXTURE(
    OldShutter, "motion camera: with a static camera the image is bit-identical"
                    * technique("post.motion-blur-camera-psf")) {
    world.insert_resource(Environment{});
    bar(unlit({0.3f, 0.7f, 0.1f}), 10, 40, 12);
    bar(unlit({0.9f, 0.2f, 0.1f}), 0, 50, 0, -3.7f);
    set_mode(MotionBlurMode::Camera);
    CHECK(picture().pixels == sharp().pixels);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion camera: a point becomes a line as long as its motion, with the same light"
                    * technique("post.motion-blur-camera-psf")) {
    bar(unlit({0, 0, 0}), -200, 300, 0, -0.001f);
    bar(unlit({1, 1, 1}), 32, 33, 0);
    set_mode(MotionBlurMode::Camera);
    for (const float shutter : {360.0f, 180.0f}) {
        set_mode(MotionBlurMode::Camera, shutter);
        const gpu::FloatImage blurred = radiance(stepped(8));
        const double motion = 8.0 * static_cast<double>(shutter) / 360;
        const std::vector<double> want =
            oracle::box_filter(row_of(sharp(stepped(8)), 32, 0), motion);
        double energy = 0;
        for (int x = 0; x < kSize; ++x) {
            CAPTURE(x);
            CHECK(std::abs(blurred.at(x, 32, 0) - want[x]) < 1e-3);
            energy += blurred.at(x, 32, 0);
        }
        CHECK(energy == test::near(1).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(
    OldShutter,
    "motion camera: an image of one color keeps it" * technique("post.motion-blur-camera-psf")) {
    bar(unlit({0.4f, 0.5f, 0.6f}), -500, 600, 0);
    set_mode(MotionBlurMode::Camera);
    CHECK(largest_difference(radiance(stepped(23)), sharp()) < 1e-6f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion camera: a roll about the view axis does not blur the center"
                    * technique("post.motion-blur-camera-psf")) {
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

// ---- along an optic flow

TEST_CASE(
    "motion flow: the offset is the motion times its cosine with the normal"
    * technique("post.motion-blur-optic-flow")) {
    // y = flow_offset(x.xyz, (0, 0, -2)), then with a motion of 0.
    const std::vector<Vec4> normals = {
        {0, 0, -1, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0.6f, 0, -0.8f, 0}, {0, 1, 0, 1}};
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/motion.glsl\"\n",
        "y.xyz = flow_offset(x.xyz, x.w > 0.5 ? vec3(0.0) : vec3(0.0, 0.0, -2.0));", normals);
    CHECK(Vec3(found[0]) == Vec3(0, 0, -2));                // ahead: the motion
    CHECK(Vec3(found[1]) == Vec3(0));                       // along: nothing
    CHECK(Vec3(found[2]) == Vec3(0, 0, 2));                 // behind: backward
    CHECK(glm::length(Vec3(found[3])) == test::near(1.6));  // never more than the motion
    CHECK(Vec3(found[4]) == Vec3(0));                       // no motion, no NaN

    Random random(4, 0, 0, 0);
    std::vector<Vec4> any;
    for (int i = 0; i < 500; ++i) {
        any.emplace_back(random.direction(), random.uniform(1e-6f, 40.0f));
    }
    const std::vector<Vec4> offsets = evaluate_shader(
        "#include \"lib/motion.glsl\"\n", "y.xyz = flow_offset(x.xyz, vec3(0.0, x.w, 0.0));", any);
    for (std::size_t i = 0; i < any.size(); ++i) {
        CHECK(glm::length(Vec3(offsets[i])) <= any[i].w * 1.000001f);
        CHECK(offsets[i].y == test::near(any[i].y * any[i].w).epsilon(1e-5));
    }
}

namespace {

/// A plate whose normal is tilted halfway toward its motion of `motion` [px], viewed from the
/// front.
void tilted_bar(OldShutter& scene, float motion) {
    const Quat tilt = glm::angleAxis(radians(60.0f), Vec3(0, 1, 0));
    const auto pose = [&](float x) { return affine_from({x, 0, 0}, tilt, {0.6f, 2, 1}); };
    const Entity entity = scene.place(scene.square, scene.unlit({1, 1, 1}), pose(0));
    scene.world.get<PreviousWorldTransform>(entity).world = pose(-motion / Shutter::kPerMeter);
}

}  // namespace

TEST_CASE_FIXTURE(
    OldShutter, "motion flow: a static object is bit-identical, and a uniform color is preserved"
                    * technique("post.motion-blur-optic-flow")) {
    world.insert_resource(Environment{});
    tilted_bar(*this, 0);
    set_mode(MotionBlurMode::Flow);
    CHECK(picture().pixels == sharp().pixels);
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}});
    tilted_bar(*this, 14);
    CHECK(largest_difference(picture(), sharp()) < 1e-3f);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion flow: the trailing edge blurs farther than the leading one"
                    * technique("post.motion-blur-optic-flow")) {
    tilted_bar(*this, 10);
    set_mode(MotionBlurMode::Flow);
    const std::vector<double> plain = row_of(sharp(), 32, 0);
    const std::vector<double> blurred = row_of(picture(), 32, 0);
    const auto is_bar = [](double v) { return v > 0.5; };
    const auto first = std::find_if(plain.begin(), plain.end(), is_bar) - plain.begin();
    const auto last =
        kSize - 1 - (std::find_if(plain.rbegin(), plain.rend(), is_bar) - plain.rbegin());
    REQUIRE(last - first > 12);
    int trailing = 0;
    int leading = 0;
    for (int i = 0; i < (last - first) / 2; ++i) {
        trailing += blurred[first + i] < 0.99 ? 1 : 0;
        leading += blurred[last - i] < 0.99 ? 1 : 0;
    }
    CHECK(leading >= 1);
    CHECK(trailing >= 2 * leading);
    CHECK(blurred[first] < 0.6);
    CHECK(blurred[last] < 0.8);  // what comes from ahead of it is dark
}

// ---- stretched geometry

TEST_CASE_FIXTURE(
    OldShutter, "motion stretch: two frames of a box give the coverage ramp of a bar"
                    * technique("post.motion-blur-stretch")) {
    const MeshId box = add(make_block());
    const float motion = 16;
    const auto pose = [](float x) {
        return affine_from({x, 0, 0}, {1, 0, 0, 0}, {12 / Shutter::kPerMeter, 1, 0.01f});
    };
    const Entity entity = place(box, unlit({1, 1, 1}), pose(-8 / Shutter::kPerMeter));
    world.insert_resource(MotionBlur{
        .mode = MotionBlurMode::Stretch, .shutter = 360, .samples = 10, .max_length = 1});
    static_cast<void>(picture());
    world.get<PreviousWorldTransform>(entity).world = pose(-8 / Shutter::kPerMeter);
    world.get<WorldTransform>(entity).world = pose(8 / Shutter::kPerMeter);
    const std::vector<double> row = row_of(picture(), 32, 0);
    // It was from 12 to 36 and is from 28 to 52.
    int steps = 0;
    for (int x = 0; x < kSize; ++x) {
        CAPTURE(x);
        const double want = oracle::stretch_coverage(x + 0.5, 12, 36, motion, 10);
        CHECK(std::abs(row[x] - want) <= 0.01);
        steps += want > 0.02 && want < 0.98 ? 1 : 0;
    }
    CHECK(steps > 30);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion stretch: a static object is bit-identical, and first frames are sharp"
                    * technique("post.motion-blur-stretch")) {
    world.insert_resource(Environment{});
    bar(unlit({0.3f, 0.7f, 0.1f}), 10, 40, 0);
    set_mode(MotionBlurMode::Stretch);
    CHECK(picture().pixels == sharp().pixels);
    CHECK(picture().pixels == sharp().pixels);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion stretch: without motion, a pixel is the mean of both frames"
                    * technique("post.motion-blur-stretch")) {
    const auto pose = [](float z) { return affine_from({0, 0, z}, {1, 0, 0, 0}, Vec3(0.5f)); };
    const Entity entity = place(add(make_ball(16)), unlit({1, 0.5f, 0}), pose(-1));
    set_mode(MotionBlurMode::Stretch);
    static_cast<void>(picture());
    world.get<MeshInstance>(entity).material = unlit({0, 0.5f, 0.25f});
    world.get<WorldTransform>(entity).world = pose(-0.9f);  // straight ahead
    const gpu::FloatImage mixed = picture();
    CHECK(glm::distance(rgb_at(mixed, 32, 32), Vec3(0.5f, 0.5f, 0.125f)) < 2e-3f);
    CHECK(rgb_at(mixed, 2, 32) == Vec3(0));
}

TEST_CASE_FIXTURE(OldShutter, "motion stretch: camera motion is included only on request") {
    place(add(make_ball(16)), unlit({1, 1, 1}), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.4f)));
    const auto row_with = [&](bool with_camera) {
        set_mode(MotionBlurMode::Stretch);
        world.resource<MotionBlur>().with_camera = with_camera;
        static_cast<void>(radiance(stepped(12)));
        return row_of(radiance(stepped(12)), 32, 0);
    };
    const std::vector<double> still = row_with(false);
    const std::vector<double> moved = row_with(true);
    const auto partly = [](const std::vector<double>& row) {
        return std::count_if(row.begin(), row.end(), [](double v) { return v > 0.02 && v < 0.98; });
    };
    CHECK(partly(moved) > partly(still) + 8);
}

TEST_CASE_FIXTURE(
    OldShutter, "motion stretch: a ball becomes the hull of its two positions"
                    * technique("post.motion-blur-stretch")) {
    const MeshId ball = add(make_ball(32));
    const auto pose = [](float x) { return affine_from({x, 0, 0}, {1, 0, 0, 0}, Vec3(0.3f)); };
    const Entity entity = place(ball, unlit({1, 1, 1}), pose(-0.2f));
    // From far away: as good as parallel.
    const Affine camera = look_at({0, 0, 30}, {0, 0, 0});
    const RenderView view = make_render_view(
        {.fov_y = 2 * std::atan(1.0f / 30)}, camera, camera, {.width = kSize, .height = kSize});
    set_mode(MotionBlurMode::Stretch);
    static_cast<void>(radiance(view));
    world.get<PreviousWorldTransform>(entity).world = pose(-0.2f);
    world.get<WorldTransform>(entity).world = pose(0.2f);
    const gpu::FloatImage blurred = radiance(view);
    for (int y = 0; y < kSize; ++y) {
        for (int x = 0; x < kSize; ++x) {
            const float px = (static_cast<float>(x) + 0.5f) / 32 - 1;
            const float py = (static_cast<float>(y) + 0.5f) / 32 - 1;
            const float beside = std::max(std::abs(px) - 0.2f, 0.0f);
            const float outside = std::hypot(beside, py) - 0.3f;  // of the capsule [m]
            CAPTURE(x);
            CAPTURE(y);
            if (outside > 0.045f) {
                CHECK(blurred.at(x, y, 0) == 0.0f);
            } else if (outside < -0.06f) {
                CHECK(blurred.at(x, y, 0) > 0.02f);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    OldShutter, "motion stretch: an object in front of the layer is unchanged"
                    * technique("post.motion-blur-stretch")) {
    const MeshId ball = add(make_ball(16));
    const auto pose = [](float x) { return affine_from({x, 0, -1}, {1, 0, 0, 0}, Vec3(0.6f)); };
    const Entity entity = place(ball, unlit({1, 1, 1}), pose(-0.5f));
    bar(unlit({0.2f, 0.1f, 0.7f}), 24, 40, 0);
    set_mode(MotionBlurMode::Stretch);
    static_cast<void>(picture());
    world.get<PreviousWorldTransform>(entity).world = pose(-0.5f);
    world.get<WorldTransform>(entity).world = pose(0.5f);
    const gpu::FloatImage blurred = picture();
    const gpu::FloatImage plain = sharp();
    for (int y = 0; y < kSize; ++y) {
        for (int x = 24; x < 40; ++x) {
            CHECK(rgb_at(blurred, x, y) == rgb_at(plain, x, y));
        }
    }
    CHECK(largest_difference(blurred, plain) > 0.2f);
}

}  // namespace limn::test::motion_modes_test
