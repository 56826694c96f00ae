// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/env_probe.h"
#include "ecs/components/rendering.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "tests/support.h"

#include <glm/geometric.hpp>

#include <string>
#include <vector>

namespace limn::test::skin_draw_test {
namespace {

/// A bent tube in front of a wall, under a light with a shadow; or instead the mesh that the oracle
/// makes of it.
struct SkinPicture : SkinScene {
    SkinPicture() {
        world.insert_resource(Environment{.sky = SkyKind::Gradient, .visible = false});
        wall = place(add(make_square()), white, affine_from({0, 0.5f, -1}, {1, 0, 0, 0}, Vec3(3)));
        light = shine(PointLight{.intensity = 30, .radius = 15}, at({1.5f, 1.5f, 2}));
        world.add(light, Shadow{.method = ShadowMethod::Map, .resolution = 256, .detail = 0});
        Random random(1, 0, 0, 0);
        MeshData tube = make_tube(24, 12, 1);
        add_weights(tube, 5, 3, random);
        add_morphs(tube, 2, 2, 0.02f, random);
        mesh = add(std::move(tube));
        skin = add_skin(make_chain(5, 0.25f));
    }
    Pose bent(float angle) {
        Pose pose;
        Affine below;
        for (int j = 0; j < 5; ++j) {
            const Quat turn = rotation_about({0.2f, 0, 1}, j == 0 ? 0.0f : angle);
            below = below * affine_from({0, j == 0 ? 0.0f : 0.25f, 0}, turn, Vec3(1));
            pose.joints.push_back(below);
        }
        pose.previous = pose.joints;
        return pose;
    }
    Entity snake(float angle, MaterialId material, Skinning skinning = Skinning::Linear) {
        const Entity entity = pose(mesh, material, skin, bent(angle), skinning);
        world.add(entity, MorphWeights{.weights = {0.7f, -0.4f}, .previous = {0.7f, -0.4f}});
        return entity;
    }
    /// The same as a separate mesh.
    Entity baked(Entity entity) {
        MeshData copy = mesh_of(entity);
        const std::vector<oracle::SkinnedVertex> vertices = want(entity);
        copy.skin = {};
        copy.morphs.clear();
        copy.bounds = {};
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            copy.positions[i] = Vec3(vertices[i].position);
            copy.normals[i] = Vec3(vertices[i].normal);
            copy.tangents[i] = Vec4(Vec3(vertices[i].tangent), 1);
            grow(copy.bounds, copy.positions[i]);
        }
        const MaterialId material = world.get<MeshInstance>(entity).material;
        return place(add(std::move(copy)), material, world.get<WorldTransform>(entity).world);
    }
    /// Pixels in which the images differ by more than rounding explains.
    static int different(const gpu::FloatImage& a, const gpu::FloatImage& b, float most = 0.02f) {
        int count = 0;
        for (int y = 0; y < a.height; ++y) {
            for (int x = 0; x < a.width; ++x) {
                count += glm::length(rgb_at(a, x, y) - rgb_at(b, x, y)) > most ? 1 : 0;
            }
        }
        return count;
    }

    const RenderView view = look({0.3f, 0.8f, 1.4f}, {0, 0.5f, 0}, 96, 96);
    const MaterialId white = add(Material{.base_color = {0.8f, 0.8f, 0.8f, 1}});
    Entity wall;
    Entity light;
    MeshId mesh;
    SkinId skin;
};

}  // namespace

TEST_CASE_FIXTURE(
    SkinPicture,
    "skin_draw: a deformed mesh looks like the mesh of the oracle" * technique("char.skin-gpu")) {
    for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend}) {
        for (const LightMethod method :
             {LightMethod::Clustered, LightMethod::ObjectMajor, LightMethod::LightMajor}) {
            if (mode != AlphaMode::Opaque && method != LightMethod::Clustered) {
                continue;
            }
            world.insert_resource(Rendering{.lights = method});
            Material material = {.base_color = {0.7f, 0.3f, 0.2f, 1}};
            material.alpha_mode = mode;
            const MaterialId red = add(material);
            for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
                const gpu::FloatImage empty = radiance(view);
                const Entity entity = snake(0.4f, red, skinning);
                const gpu::FloatImage got = radiance(view);
                const gpu::FloatImage depth = aov(view, "depth");
                const gpu::FloatImage normal = aov(view, "normal");
                const Entity same = baked(entity);
                world.destroy(entity);
                CHECK(different(got, radiance(view)) <= 12);  // rounding, at edges
                CHECK(different(normal, aov(view, "normal")) <= 12);
                const gpu::FloatImage want_depth = aov(view, "depth");
                int deep = 0;
                for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
                    const float far = std::abs(depth.pixels[i] - want_depth.pixels[i]);
                    deep += far > 1e-3f ? 1 : 0;
                }
                CHECK(deep <= 12);
                CHECK(different(got, empty) > 400);  // and there is something to see
                world.destroy(same);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    SkinPicture, "skin_draw: a deformed mesh is displaced along its deformed normals"
                     * technique("tex.displacement")) {
    ImageData map = {.name = "map", .width = 4, .height = 4, .pixels = {}};
    for (int i = 0; i < 16; ++i) {
        map.pixels.insert(
            map.pixels.end(), {128, 128, 255, static_cast<std::uint8_t>(16 * (5 * i % 16))});
    }
    Material bumpy = {.base_color = {0.8f, 0.8f, 0.8f, 1}};
    bumpy.detail = SurfaceDetail::Displaced;
    bumpy.relief_texture = {.image = add(std::move(map))};
    bumpy.relief_depth = 0.1f;
    const Entity smooth = snake(0.5f, white);
    const gpu::FloatImage plain = radiance(view);
    world.destroy(smooth);
    const Entity entity = snake(0.5f, add(bumpy));
    const gpu::FloatImage got = radiance(view);
    const gpu::FloatImage velocity = aov(view, "velocity");
    const Entity same = baked(entity);
    world.destroy(entity);
    CHECK(different(got, radiance(view)) <= 12);
    CHECK(different(got, plain) > 200);
    // Nothing has moved since the previous frame.
    CHECK(largest_difference(velocity, aov(view, "velocity")) <= 0.02f);
    world.destroy(same);
}

TEST_CASE_FIXTURE(SkinPicture, "skin_draw: a deformed mesh inflates along its deformed normals") {
    const Inflate more = {.distance = 0.08f};
    const Entity entity = snake(0.5f, white);
    const gpu::FloatImage thin = radiance(view);
    world.add(entity, more);
    const gpu::FloatImage got = radiance(view);
    const Entity same = baked(entity);
    world.add(same, more);
    world.destroy(entity);
    CHECK(different(got, radiance(view)) <= 12);
    CHECK(different(got, thin) > 200);
}

TEST_CASE_FIXTURE(
    SkinPicture, "skin_draw: the shadow follows the pose, and is kept while it rests") {
    const Entity entity = snake(0.4f, white);
    radiance(view);
    const FrameOutput still = draw(view);
    CHECK(still.statistics.deformed == 0);
    CHECK(still.statistics.shadow_views_drawn == 0);
    world.get<Pose>(entity) = bent(-0.5f);
    const FrameOutput moved = draw(view);
    CHECK(moved.statistics.deformed == 1);
    CHECK(moved.statistics.shadow_views_drawn > 0);
    const gpu::FloatImage got = gpu::read_floats(*moved.radiance);
    baked(entity);
    world.destroy(entity);
    CHECK(different(got, radiance(view)) <= 12);
}

TEST_CASE_FIXTURE(SkinPicture, "skin_draw: a mesh outside the image casts its shadow into it") {
    const RenderView close = look({0, 0.5f, -0.2f}, {0, 0.5f, -1}, 48, 48);
    world.get<WorldTransform>(light).world = at({0, 0.5f, 3});
    const gpu::FloatImage lit = radiance(close);
    snake(0.1f, white);
    const FrameOutput shaded = draw(close);
    CHECK(shaded.statistics.deformed == 1);
    CHECK(shaded.statistics.visible_instances == 1);  // the wall
    CHECK(different(lit, gpu::read_floats(*shaded.radiance), 0.1f) > 50);
}

TEST_CASE_FIXTURE(
    SkinPicture, "skin_draw: a mesh that is moved out of the image by its pose is not computed") {
    world.remove<Shadow>(light);
    const Entity entity = snake(0.4f, white);
    CHECK(draw(view).statistics.visible_instances == 2);
    Pose far = bent(0.4f);
    for (Affine& joint : far.joints) {
        joint = at({50, 0, 0}) * joint;
    }
    world.get<Pose>(entity) = far;
    const FrameOutput gone = draw(view);
    CHECK(gone.statistics.visible_instances == 1);
    CHECK(gone.statistics.deformed == 0);
    // Its own transform does not matter, the positions of its vertices do.
    world.get<WorldTransform>(entity).world = at({-50, 0, 0});
    const FrameOutput back = draw(view);
    CHECK(back.statistics.visible_instances == 2);
    CHECK(back.statistics.deformed == 1);
}

TEST_CASE_FIXTURE(SkinPicture, "skin_draw: a hundred poses of one mesh are one draw") {
    world.remove<Shadow>(light);
    for (int i = 0; i < 100; ++i) {
        const Entity entity = snake(0.01f * static_cast<float>(i), white);
        world.get<WorldTransform>(entity).world = at({0.01f * static_cast<float>(i), 0, 0});
    }
    const FrameStatistics got = draw(view).statistics;
    CHECK(got.visible_instances == 101);
    CHECK(got.deformed == 100);
    CHECK(got.draws == 2);  // the wall, the hundred
}

TEST_CASE_FIXTURE(SkinPicture, "skin_draw: without a character the mesh is drawn at rest") {
    const Entity entity = snake(0.6f, white);
    const gpu::FloatImage bent_picture = radiance(view);
    world.get<Deformed>(entity).character = {};
    const gpu::FloatImage got = radiance(view);
    world.remove<Deformed>(entity);
    CHECK(got.pixels == radiance(view).pixels);
    CHECK(different(got, bent_picture) > 200);
    // NaN joints never reach the image.
    world.get<Pose>(entity).joints[4].row[0] = Vec4(NAN);
    world.add(entity, Deformed{entity, skin, 0, Skinning::Linear});
    CHECK(radiance(view).pixels == got.pixels);
}

TEST_CASE_FIXTURE(
    SkinPicture, "skin_draw: a light with shadow volumes gets a shadow map instead, logged once") {
    snake(0.4f, white);
    world.add(wall, NoShadow{});  // which is no closed mesh, either
    world.get<Shadow>(light).method = ShadowMethod::Map;
    const gpu::FloatImage want = radiance(view);
    world.get<Shadow>(light).method = ShadowMethod::Volume;
    const std::vector<std::string> messages = messages_of([&] {
        CHECK(radiance(view).pixels == want.pixels);
        (void)radiance(view);
    });
    int about = 0;
    for (const std::string& message : messages) {
        about += message.find("tube is deformed") != std::string::npos ? 1 : 0;
    }
    CHECK(about == 1);
}

TEST_CASE_FIXTURE(
    SkinPicture,
    "skin_draw: a probe captures the shape, and the main view does not compute it again") {
    const Entity entity = snake(0.4f, white);
    const Entity probe =
        world.create(EnvProbe{.resolution = 16}, WorldTransform{at({0, 0.5f, 1.0f})});
    const FrameStatistics got = draw(view).statistics;
    CHECK(got.probe_faces > 0);
    CHECK(got.deformed == 1);  // once for all faces and the image
    world.destroy(probe);
    world.destroy(entity);
}

}  // namespace limn::test::skin_draw_test
