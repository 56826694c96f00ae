#include "ecs/base/jobs.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <functional>
#include <random>

namespace limn::test::instancing_test {
namespace {

struct CrowdScene : Scene {
    /// `count` little balls in a wall before the camera.
    void crowd(int count, MeshId mesh, MaterialId material) {
        const int side = static_cast<int>(std::ceil(std::sqrt(count)));
        for (int i = 0; i < count; ++i) {
            const float x = (static_cast<float>(i % side) + 0.5f) / static_cast<float>(side);
            const float y = (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side);
            entities.push_back(place(
                mesh, material,
                affine_from(
                    {2 * x - 1, 2 * y - 1, 0}, {1, 0, 0, 0},
                    Vec3(0.6f / static_cast<float>(side)))));
        }
    }
    std::vector<Entity> entities;  ///< of all crowds
    [[nodiscard]] RenderView view() const { return look({0, 0, 1.2f}, {0, 0, 0}, 128, 128); }
};

}  // namespace

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: ten thousand equal meshes are one draw"
                    * technique("engine.batching, shade.batching")) {
    crowd(10000, add(make_ball(4)), add(Material{}));
    const FrameOutput out = draw(view());
    CHECK(out.statistics.instances == 10000);
    CHECK(out.statistics.visible_instances == 10000);
    CHECK(out.statistics.draws == 1);
    CHECK(out.statistics.triangles == 10000 * 4 * 8 * 2);
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: meshes and materials without textures share a draw"
                    * technique("engine.batching, engine.material-bind, shade.batching")) {
    const MeshId ball = add(make_ball(4));
    const MeshId square = add(make_square());
    for (int i = 0; i < 20; ++i) {
        crowd(
            50, i % 2 == 0 ? ball : square, add(Material{.roughness = static_cast<float>(i) / 20}));
    }
    CHECK(draw(view()).statistics.draws == 1);
    // Another set of textures, the other winding, both sides and blending each need their own.
    crowd(10, ball, add(Material{.double_sided = true}));
    CHECK(draw(view()).statistics.draws == 2);
    place(ball, {0}, affine_from({0, 0, 0}, {1, 0, 0, 0}, {-0.1f, 0.1f, 0.1f}));
    CHECK(draw(view()).statistics.draws == 3);
    crowd(10, ball, add(Material{.alpha_mode = AlphaMode::Blend}));
    CHECK(draw(view()).statistics.draws == 4);
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: drawn together or separately, the image is the same"
                    * technique("engine.batching, shade.batching")) {
    // shade.batching: one state, then meshes and images of their own, then a state per object,
    // since images of different sizes are in different texture arrays.
    constexpr int kBalls = 36;
    const auto white = [&](int size = 1) {
        ImageData image;
        image.width = size;
        image.height = 1;
        image.pixels.assign(4 * static_cast<std::size_t>(size), 255);
        Material material;
        material.base_color_texture.image = add(std::move(image));
        return add(material);
    };
    shine(PointLight{}, at({0.5f, 0.5f, 1}));
    crowd(kBalls, add(make_ball(4)), white());
    const FrameOutput together = draw(view());
    const std::int64_t triangles = together.statistics.triangles;
    CHECK(together.statistics.draws == 1);
    CHECK(triangles == kBalls * 4 * 8 * 2);
    const gpu::FloatImage expected = gpu::read_floats(*together.radiance);
    for (const Entity ball : entities) {
        world.get<MeshInstance>(ball) = {add(make_ball(4)), white()};
    }
    CHECK(draw(view()).statistics.draws == 1);
    int size = 0;
    for (const Entity ball : entities) {
        world.get<MeshInstance>(ball) = {add(make_ball(4)), white(++size)};
    }
    const FrameOutput apart = draw(view());
    CHECK(apart.statistics.draws == kBalls);         // as many as there are states
    CHECK(apart.statistics.triangles == triangles);  // each drawn once
    CHECK(largest_difference(gpu::read_floats(*apart.radiance), expected) == 0);
}

TEST_CASE_FIXTURE(CrowdScene, "instancing: invisible instances are not drawn") {
    const MeshId ball = add(make_ball(4));
    const MaterialId gray = add(Material{});
    crowd(100, ball, gray);
    for (int i = 0; i < 300; ++i) {
        place(ball, gray, at({0, 0, 10.0f + static_cast<float>(i)}));  // behind the camera
    }
    const FrameOutput out = draw(view());
    CHECK(out.statistics.instances == 400);
    CHECK(out.statistics.visible_instances == 100);
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: every instance has its own transform and material"
                    * technique("engine.material-bind, engine.multi-material")) {
    // A board of squares, each with the color of its cell.
    const MeshId square = add(make_square());
    constexpr int kCells = 40;
    for (int i = 0; i < kCells * kCells; ++i) {
        const auto x = static_cast<float>(i % kCells);
        const auto y = static_cast<float>(i / kCells);
        Material material = {.shading = ShadingModel::Unlit};
        material.base_color = {x / kCells, y / kCells, 0.5f, 1};
        const Vec3 corner = {(2 * x + 1) / kCells - 1, (2 * y + 1) / kCells - 1, 0};
        place(square, add(material), affine_from(corner, {1, 0, 0, 0}, Vec3(1.0f / kCells)));
    }
    const gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, 4 * kCells, 4 * kCells));
    for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
            const Vec3 color = rgb_at(image, 4 * x + 2, 4 * (kCells - 1 - y) + 2);
            CHECK(color.x == test::near(static_cast<float>(x) / kCells).epsilon(4e-3).scale(0.25));
            CHECK(color.y == test::near(static_cast<float>(y) / kCells).epsilon(4e-3).scale(0.25));
        }
    }
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: materials in one draw look the same as in separate draws"
                    * technique("engine.multi-material")) {
    constexpr int kMaterials = 9;
    const MeshId ball = add(make_ball(4));
    shine(PointLight{}, at({0.5, 0.5, 1}));
    crowd(36, ball, {});
    std::vector<MaterialId> materials;
    for (int i = 0; i < kMaterials; ++i) {
        const float x = static_cast<float>(i) / kMaterials;
        materials.push_back(
            add(Material{.base_color = {x, 1 - x, 0.5f, 1}, .roughness = 0.3f + 0.5f * x}));
    }
    const auto draw_materials = [&](int first, int last) {
        for (std::size_t i = 0; i < entities.size(); ++i) {
            const int material = static_cast<int>(i) % kMaterials;
            const bool drawn = material >= first && material <= last;
            world.get<MeshInstance>(entities[i]) = {
                drawn ? ball : MeshId{}, materials[static_cast<std::size_t>(material)]};
        }
        const FrameOutput out = draw(view());
        CHECK(out.statistics.draws == 1);
        return gpu::read_floats(*out.radiance);
    };
    const gpu::FloatImage together = draw_materials(0, kMaterials - 1);
    gpu::FloatImage sum = draw_materials(0, 0);
    for (int i = 1; i < kMaterials; ++i) {
        const gpu::FloatImage one = draw_materials(i, i);
        std::transform(
            one.pixels.begin(), one.pixels.end(), sum.pixels.begin(), sum.pixels.begin(),
            std::plus<>());
    }
    CHECK(largest_difference(together, sum) == 0);
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: the image has the same bits for any number of threads"
                    * technique("engine.batching, shade.batching")) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(-1, 1);
    const MeshId meshes[] = {add(make_ball(4)), add(make_square())};
    std::vector<MaterialId> materials;
    for (int i = 0; i < 9; ++i) {
        materials.push_back(add(Material{
            .alpha_mode = i > 6 ? AlphaMode::Blend : AlphaMode::Opaque,
            .base_color = {unit(random) * 0.5f + 0.5f, 0.5f, 0.5f, 0.5f}}));
    }
    for (int i = 0; i < 5000; ++i) {
        place(
            meshes[i % 2], materials[i % 9],
            affine_from(
                {unit(random), unit(random), unit(random) - 0.5f}, {1, 0, 0, 0}, Vec3(0.03f)));
    }
    shine(PointLight{}, at({0, 0, 1}));
    const int threads = thread_count();
    set_thread_count(1);
    const gpu::FloatImage one = radiance(view());
    set_thread_count(4);
    const gpu::FloatImage four = radiance(view());
    set_thread_count(threads);
    CHECK(one.pixels == four.pixels);
}

TEST_CASE_FIXTURE(CrowdScene, "instancing: invalid instances are not drawn and do no harm") {
    const MeshId ball = add(make_ball(4));
    const MaterialId gray = add(Material{});
    place(ball, gray, at({NAN, 0, 0}));
    place(ball, gray, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(INFINITY)));
    place({99}, gray, at({0, 0, 0}));
    place({}, gray, at({0, 0, 0}));
    place(add(MeshData{}), gray, at({0, 0, 0}));
    CHECK(draw(view()).statistics.visible_instances == 0);
    MeshData beyond = make_square();
    beyond.indices[3] = 4;
    place(add(beyond), gray, at({0, 0, 0}));
    CHECK(draw(view()).statistics.visible_instances == 0);
}

TEST_CASE_FIXTURE(
    CrowdScene, "instancing: an unknown material is magenta, none is gray"
                    * technique("engine.material-bind")) {
    const MeshId square = add(make_square());
    place(square, {77}, at({0, 0, 0}));
    CHECK(rgb_at(radiance(look({0, 0, 1}, {0, 0, 0})), 32, 32) == Vec3(1, 0, 1));
    world.clear();
    place(square, {}, at({0, 0, 0}));
    const Vec3 albedo = rgb_at(aov(look({0, 0, 1}, {0, 0, 0}), "albedo"), 32, 32);
    CHECK(albedo.x == test::near(0.8f).epsilon(1e-3));
}

}  // namespace limn::test::instancing_test
