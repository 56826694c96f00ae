// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/fur.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "render/geometry/fur_list.h"
#include "tests/near.h"
#include "tests/render/shader_eval.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// Fur as shells: the cross-sections of strands, where shells are, how they are shaded and shadowed.

namespace limn::test::fur_test {
namespace {

constexpr int kPixels = 192;
constexpr float kHeight = 3;  // of the view [m]

/// Whether points of a 48 by 48 cell square are covered, and the brightness of the strands there.
std::vector<Vec4> strand_points(float height, float radius, float shortest, float wave) {
    constexpr int kSide = 288;
    std::vector<Vec4> inputs;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            inputs.emplace_back(
                48 * (static_cast<float>(x) + 0.5f) / kSide,
                48 * (static_cast<float>(y) + 0.5f) / kSide, 0, 0);
        }
    }
    return evaluate_shader(
        "#include \"lib/fur.glsl\"\n",
        fmt::format(
            "FurPoint p = fur_point(x.xy, {:.6f}, vec4({:.6f}, {:.6f}, {:.6f}, 0.0));"
            "y = vec4(p.covered ? 1.0 : 0.0, p.random.w, 0.0, 0.0);",
            height, radius, shortest, wave),
        inputs);
}

double covered(float height, float radius, float shortest, float wave) {
    const std::vector<Vec4> points = strand_points(height, radius, shortest, wave);
    double sum = 0;
    for (const Vec4& point : points) {
        sum += static_cast<double>(point.x);
    }
    return sum / static_cast<double>(points.size());
}

/// A white ball of radius 1 about the origin, with fur.
struct FurScene : Scene {
    MeshId ball = add(make_ball(64));
    MaterialId white = add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}});
    MaterialId red = add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 0, 0, 1}});

    /// Dense and without holes near the skin.
    static Fur plain(float length) {
        return {
            .length = length,
            .shells = 8,
            .density = 40,
            .thickness = 1.4f,
            .shortest = 1,
            .droop = 0,
            .wave = 0,
            .unruly = 0,
            .root = 1,
            .variation = 0};
    }
    Entity furry(const Fur& fur, MaterialId material) {
        const Entity entity = place(ball, material, at({0, 0, 0}));
        world.add(entity, fur);
        return entity;
    }
    RenderView flat_view(const Vec3& eye = {0, 0, 5}) {
        const Affine pose = look_at(eye, {0, 0, 0});
        return make_render_view(
            {.ortho_height = kHeight, .near = 0.05f}, pose, pose,
            {.width = kPixels, .height = kPixels});
    }
    /// Distance of the farthest pixel that is not black from the center [m].
    static double radius(const gpu::FloatImage& image) {
        double farthest = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                if (image.at(x, y, 0) > 0.01f) {
                    const double dx = x + 0.5 - 0.5 * kPixels;
                    const double dy = y + 0.5 - 0.5 * kPixels;
                    farthest = std::max(farthest, std::hypot(dx, dy));
                }
            }
        }
        return farthest * static_cast<double>(kHeight) / kPixels;
    }
};

/// Second moments of red about the mean.
struct Moments {
    double total = 0;
    double x = 0, y = 0;  ///< mean [px]
    double xx = 0, yy = 0;
};

Moments moments(const gpu::FloatImage& image) {
    Moments m;
    for (int pass = 0; pass < 2; ++pass) {
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                const double w = static_cast<double>(image.at(x, y, 0));
                if (pass == 0) {
                    m.total += w;
                    m.x += w * x;
                    m.y += w * y;
                } else {
                    m.xx += w * (x - m.x) * (x - m.x) / m.total;
                    m.yy += w * (y - m.y) * (y - m.y) / m.total;
                }
            }
        }
        if (pass == 0) {
            m.x /= m.total;
            m.y /= m.total;
        }
    }
    return m;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "fur: strands that do not overlap cover pi r^2 (1 - t) of a shell" * technique("shade.fur")) {
    const double radius = 0.24;
    for (const float t : {0.0f, 0.25f, 0.5f, 0.9f}) {
        const double law = 3.14159265 * radius * radius * (1 - static_cast<double>(t));
        for (const float wave : {0.0f, 1.0f}) {
            CAPTURE(t);
            CAPTURE(wave);
            CHECK(covered(t, 0.24f, 1, wave) == near(law).epsilon(0.03));
        }
    }
    CHECK(covered(1, 0.24f, 1, 0) == 0);
}

TEST_CASE_FIXTURE(
    RenderTest, "fur: thick strands leave no hole at the skin; shorter ones thin the coat out"
                    * technique("shade.fur")) {
    CHECK(covered(0, 0.7f, 0.5f, 0) > 0.97);
    CHECK(covered(0, 0.24f, 0.3f, 0) == near(covered(0, 0.24f, 1, 0)).epsilon(1e-6));
    double last = 1;
    for (const float shortest : {1.0f, 0.7f, 0.4f}) {
        const double now = covered(0.5f, 0.24f, shortest, 0);
        CHECK(now < last);
        CHECK(now > 0);
        last = now;
    }
}

TEST_CASE_FIXTURE(
    RenderTest,
    "fur: cells are joined until they have one to two pixels" * technique("shade.fur")) {
    std::vector<Vec4> inputs;
    for (int i = 0; i < 400; ++i) {
        inputs.emplace_back(0.01f * static_cast<float>(i + 1), 0.005f, 0, 0);
    }
    const std::vector<Vec4> found = evaluate_shader(
        "#include \"lib/fur.glsl\"\n", "y = vec4(fur_scale(x.xy), 0.0, 0.0, 0.0);", inputs);
    for (std::size_t i = 0; i < found.size(); ++i) {
        const float joined = inputs[i].x * found[i].x;  // cells per pixel
        CAPTURE(inputs[i].x);
        CHECK(found[i].x <= 1);
        CHECK(joined <= 1.001f);
        CHECK(joined > (found[i].x < 1 ? 0.499f : 0));
    }
}

TEST_CASE("fur: shell i of k is offset by length i / k" * technique("shade.fur")) {
    const Fur fur = {.length = 0.6f, .shells = 12};
    for (int i = 0; i <= 12; ++i) {
        CHECK(shell_offset(fur, i) == near(0.05f * static_cast<float>(i)).epsilon(1e-6));
    }
}

TEST_CASE_FIXTURE(
    FurScene, "fur: the last shell is as far out as it should be" * technique("shade.fur")) {
    for (const int shells : {2, 4, 8}) {
        Fur fur = plain(0.4f);
        fur.shells = shells;
        const Entity entity = furry(fur, white);
        CAPTURE(shells);
        const double last = 1 + 0.4 * (shells - 1.0) / shells;
        const double found = radius(radiance(flat_view()));
        CHECK(found <= last + 0.008);  // half a pixel
        CHECK(found >= last - 0.02);
        world.destroy(entity);
    }
}

TEST_CASE_FIXTURE(FurScene, "fur: of length 0, it is the bare mesh" * technique("shade.fur")) {
    const Entity entity = furry(plain(0), white);
    const gpu::FloatImage none = radiance(flat_view());
    world.get<Fur>(entity).length = 0.2f;
    const gpu::FloatImage some = radiance(flat_view());
    world.remove<Fur>(entity);
    const gpu::FloatImage bare = radiance(flat_view());
    CHECK(largest_difference(none, bare) == 0);
    CHECK(largest_difference(some, bare) > 0.5f);
}

TEST_CASE_FIXTURE(
    FurScene,
    "fur: seen along strands, a dense coat has no hole to the skin" * technique("shade.fur")) {
    Fur fur = plain(0.2f);
    fur.density = 20;
    fur.material = white;
    furry(fur, red);
    const gpu::FloatImage image = radiance(flat_view());
    int skin = 0;
    int seen = 0;
    for (int y = 0; y < kPixels; ++y) {
        for (int x = 0; x < kPixels; ++x) {
            seen += image.at(x, y, 0) > 0.5f ? 1 : 0;
            skin += image.at(x, y, 0) > 0.5f && image.at(x, y, 1) < 0.5f ? 1 : 0;
        }
    }
    CHECK(seen > kPixels * kPixels / 3);
    CHECK(skin < seen / 50);
}

TEST_CASE_FIXTURE(
    FurScene, "fur: the alpha of vertex colors scales its length" * technique("shade.fur")) {
    MeshData half = make_ball(64);
    for (const Vec3& p : half.positions) {
        half.colors.emplace_back(1, 1, 1, p.x > 0.3f ? 0.5f : p.x < -0.3f ? 0.0f : 1.0f);
    }
    const Entity entity = place(add(half), white, at({0, 0, 0}));
    Fur fur = plain(0.4f);
    fur.shells = 16;
    world.add(entity, fur);
    const gpu::FloatImage image = radiance(flat_view());
    // Along the middle row.
    int left = kPixels;
    int right = 0;
    for (int x = 0; x < kPixels; ++x) {
        if (image.at(x, kPixels / 2, 0) > 0.5f) {
            left = std::min(left, x);
            right = std::max(right, x + 1);
        }
    }
    const double pixel = static_cast<double>(kHeight) / kPixels;
    CHECK((0.5 * kPixels - left) * pixel == near(1.0).epsilon(0.02));
    CHECK((right - 0.5 * kPixels) * pixel == near(1.19).epsilon(0.04));
}

TEST_CASE_FIXTURE(
    FurScene,
    "fur: tips lean as far as they are combed, and toward the ground" * technique("shade.fur")) {
    // A square of side 2 that faces the eye: tips reach beyond its edges.
    const MeshId square = add(make_square());
    const auto extent = [&](const Vec3& comb, float droop, const Vec3& toward) {
        Fur fur = plain(0.3f);
        fur.shells = 16;
        fur.comb = comb;
        fur.droop = droop;
        const Entity entity = place(square, white, at({0, 0, 0}));
        world.add(entity, fur);
        const gpu::FloatImage image = radiance(flat_view());
        world.destroy(entity);
        double farthest = 0;
        for (int y = 0; y < kPixels; ++y) {
            for (int x = 0; x < kPixels; ++x) {
                if (image.at(x, y, 0) > 0.5f) {
                    const double to_right =
                        static_cast<double>(toward.x) * (x + 0.5 - 0.5 * kPixels);
                    const double up = static_cast<double>(toward.y) * (0.5 * kPixels - y - 0.5);
                    farthest = std::max(farthest, to_right + up);
                }
            }
        }
        return (farthest + 0.5) * static_cast<double>(kHeight) / kPixels;
    };
    const double tips = 1 + 0.3 * 0.9375 * 0.9375;  // of the last shell
    CHECK(extent({0, 0, 0}, 0, {1, 0, 0}) == near(1.0).epsilon(0.01));
    CHECK(extent({1, 0, 0}, 0, {1, 0, 0}) == near(tips).epsilon(0.01));
    CHECK(extent({1, 0, 0}, 0, {-1, 0, 0}) == near(1.0).epsilon(0.01));
    CHECK(extent({0, 1, 5}, 0, {0, 1, 0}) == near(tips).epsilon(0.01));  // only along the surface
    CHECK(extent({0, 0, 0}, 1, {0, -1, 0}) == near(tips).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    FurScene, "fur: its highlight lies across the strands and moves as they are combed"
                  * technique("shade.fur")) {
    const MaterialId satin = add(Material{
        .shading = ShadingModel::Strand,
        .base_color = {0, 0, 0, 1},
        .specular = {1, 1, 1},
        .shininess = 60});
    shine(DirectionalLight{.illuminance = kPi}, look_at({0, 0, 0}, {0, 0, -1}));
    const MaterialId black =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 0, 0, 1}});
    const auto highlight = [&](const Vec3& comb) {
        Fur fur = plain(0.1f);
        fur.shells = 12;
        fur.comb = comb;
        fur.material = satin;
        const Entity entity = furry(fur, black);
        const Moments m = moments(radiance(flat_view()));
        world.destroy(entity);
        return m;
    };
    const Moments along_x = highlight({6, 0, 0});
    const Moments along_y = highlight({0, 6, 0});
    const Moments opposite = highlight({-6, 0, 0});
    CHECK(along_x.yy > 1.5 * along_x.xx);
    CHECK(along_y.xx > 1.5 * along_y.yy);
    CHECK(along_x.xx == near(along_y.yy).epsilon(0.1));
    // Strands point away from the eye beyond their bend: highlights lie on both sides of the ball.
    CHECK(along_x.x - 0.5 * kPixels == near(0.5 * kPixels - opposite.x).epsilon(0.2));
}

TEST_CASE_FIXTURE(
    FurScene, "fur: forward and deferred shading show the same image" * technique("shade.fur")) {
    const MaterialId hair = add(Material{
        .shading = ShadingModel::Hair, .base_color = {0.6f, 0.4f, 0.2f, 1}, .roughness = 0.4f});
    shine(
        DirectionalLight{.illuminance = 2},
        look_at({0, 0, 0}, glm::normalize(Vec3(-1, -0.6f, -0.5f))));
    furry({.length = 0.2f, .shells = 8, .density = 30}, hair);
    const RenderView view = look({0, 0.4f, 1.6f}, {0, 0, 0}, 96, 96);
    const gpu::FloatImage deferred = radiance(view);
    REQUIRE(moments(deferred).total > 10);
    for (const LightMethod method : {LightMethod::ObjectMajor, LightMethod::LightMajor}) {
        world.insert_resource(Rendering{.lights = method});
        CAPTURE(static_cast<int>(method));
        const gpu::FloatImage forward = radiance(view);
        int different = 0;
        for (std::size_t i = 0; i < forward.pixels.size(); ++i) {
            different += std::abs(forward.pixels[i] - deferred.pixels[i]) > 5e-3f ? 1 : 0;
        }
        CHECK(different <= 8);
    }
}

TEST_CASE_FIXTURE(
    FurScene, "fur: it casts a shadow, darker where it is denser" * technique("shade.fur")) {
    const MaterialId paper = add(Material{
        .shading = ShadingModel::Blinn, .base_color = {1, 1, 1, 1}, .specular = {0, 0, 0}});
    place(add(make_square()), paper, affine_from({0, 0, -3}, {1, 0, 0, 0}, Vec3(4)));
    const Entity sun = shine(DirectionalLight{.illuminance = kPi}, at({0, 0, 4}));
    world.add(sun, Shadow{.resolution = 1024, .distance = 14});
    // Only the shadow is in view: the sun and the camera are on opposite sides of nothing else.
    const auto lit = [&](float thickness) {
        Fur fur = plain(0.4f);
        fur.density = 12;
        fur.shells = 16;
        fur.thickness = thickness;
        const Entity entity = furry(fur, white);
        if (thickness == 0) {
            world.remove<Fur>(entity);
        }
        const Affine pose = look_at({0, 0, -1.7f}, {0, 0, -3});
        const gpu::FloatImage image = radiance(make_render_view(
            {.ortho_height = kHeight, .near = 0.05f}, pose, pose,
            {.width = kPixels, .height = kPixels}));
        double sum = 0;
        int count = 0;
        for (int y = 0; y < kPixels; ++y) {
            for (int x = 0; x < kPixels; ++x) {
                const double r = std::hypot(x + 0.5 - 0.5 * kPixels, y + 0.5 - 0.5 * kPixels)
                                 * static_cast<double>(kHeight) / kPixels;
                if (r > 1.06 && r < 1.3) {
                    sum += static_cast<double>(image.at(x, y, 0));
                    ++count;
                }
            }
        }
        world.destroy(entity);
        return sum / count;
    };
    const double bare = lit(0);
    CHECK(bare == near(1.0).epsilon(0.02));
    double last = bare;
    for (const float thickness : {0.2f, 0.5f, 1.0f}) {
        const double now = lit(thickness);
        CAPTURE(thickness);
        CHECK(now < last - 0.03);
        last = now;
    }
    CHECK(last > 0.02);  // light still passes between strands
}

TEST_CASE_FIXTURE(
    FurScene, "fur: from afar it has fewer shells and covers as much" * technique("shade.fur")) {
    Fur fur = plain(0.3f);
    fur.shells = 64;
    furry(fur, white);
    const auto shells = [&](float distance) {
        const Affine pose = look_at({0, 0, distance}, {0, 0, 0});
        return draw(make_render_view(
                        {.fov_y = radians(30.0f)}, pose, pose, {.width = 96, .height = 96}))
            .statistics.visible_instances;
    };
    CHECK(shells(1.6f) == 64);  // with the skin
    CHECK(shells(3) == 32);
    CHECK(shells(300) <= 9);
    CHECK(shells(300) >= 7);
}

TEST_CASE_FIXTURE(FurScene, "fur: the same image twice; a missing mesh draws nothing") {
    const Entity entity = furry({.length = 0.2f}, white);
    const gpu::FloatImage first = radiance(flat_view());
    CHECK(largest_difference(first, radiance(flat_view())) == 0);
    world.get<MeshInstance>(entity).mesh = {77};
    CHECK(moments(radiance(flat_view())).total == 0);
}

TEST_CASE_FIXTURE(
    RenderTest, "fur: a fin shows every strand edge-on, fewer as it is seen from above, then none"
                    * technique("shade.fur")) {
    std::vector<Vec4> inputs;
    for (int i = 0; i < 4000; ++i) {
        inputs.emplace_back(0.025f * (static_cast<float>(i) + 0.5f), 0, 0, 0);
    }
    const auto part = [&](float height, float facing) {
        double sum = 0;
        for (const Vec4& found : evaluate_shader(
                 "#include \"lib/fur.glsl\"\n",
                 fmt::format(
                     "y.x = fin_point(x.x, {:.6f}, vec4(0.24, 1.0, 0.0, 0.0), {:.6f}).covered ? "
                     "1.0 "
                     ": 0.0;",
                     height, facing),
                 inputs)) {
            sum += static_cast<double>(found.x);
        }
        return sum / static_cast<double>(inputs.size());
    };
    CHECK(part(0, 0.002f) == near(0.48).epsilon(0.03));  // their diameter
    CHECK(part(0.75f, 0.002f) == near(0.24).epsilon(0.05));
    CHECK(part(0, 0.3f) == near(0.24).epsilon(0.25));
    CHECK(part(0, -0.3f) == near(part(0, 0.3f)).epsilon(1e-6));
    CHECK(part(0, 0.61f) == 0);
    CHECK(part(1, 0.002f) == 0);
}

TEST_CASE("fur: texture coordinates are scaled to meters by their mean stretch") {
    MeshData square = make_square();  // side 2, uv 0 .. 1
    FurChart chart = find_fur_chart(square);
    CHECK_FALSE(chart.second);
    CHECK(chart.scale.x == near(2.0f).epsilon(1e-5));
    CHECK(chart.scale.y == near(2.0f).epsilon(1e-5));
    for (const Vec2& uv : square.uvs) {
        square.uvs1.push_back(uv * Vec2(4, 0.5f));
    }
    chart = find_fur_chart(square);
    CHECK(chart.second);
    CHECK(chart.scale.x == near(0.5f).epsilon(1e-5));
    CHECK(chart.scale.y == near(4.0f).epsilon(1e-5));
    CHECK(find_fur_chart({}).scale == Vec2(1, 1));
}

TEST_CASE("fur: equal coats share a number; when all are taken, others are bare") {
    Assets assets;
    assets.meshes = {make_square(), make_ball(8)};
    FurList list;
    Fur fur;
    CHECK(list.add(fur, {0}, assets) == 0);
    CHECK(list.add(fur, {0}, assets) == 0);
    fur.length = 0.5f;
    CHECK(list.add(fur, {0}, assets) == 1);
    CHECK(list.add(fur, {1}, assets) == 2);  // another scale
    CHECK_FALSE(list.add(fur, {2}, assets).has_value());
    for (int i = 0; i < 200; ++i) {
        fur.wave = 0.01f * static_cast<float>(i);
        list.add(fur, {0}, assets);
    }
    CHECK(list.records().size() == layout::kMaxFurs);
    fur.wave = 3.5f;
    CHECK_FALSE(list.add(fur, {0}, assets).has_value());
}

}  // namespace limn::test::fur_test
