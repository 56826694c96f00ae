#include "content/load/gltf/gltf_scene.h"
#include "content/load/model_view.h"
#include "content/load/scene_bounds.h"
#include "content/load/scene_load.h"
#include "content/make/models/shapes.h"
#include "ecs/components/all.h"
#include "ecs/components/animation.h"
#include "ecs/components/camera.h"
#include "ecs/components/environment.h"
#include "ecs/components/framing.h"
#include "ecs/components/light.h"
#include "ecs/components/post.h"
#include "ecs/components/shadow.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace limn::model_view_test {

using test::near;

namespace {

/// A world with a box of 1 m on the floor, as a file would give it.
struct Model {
    World world;

    Model() {
        register_all_components();
        world.insert_resource(Assets{});
        add_box({1, 1, 1}, {0, 0.5f, 0});
    }

    Entity add_box(const Vec3& size, const Vec3& at) {
        auto& assets = world.resource<Assets>();
        assets.meshes.push_back(make_box({.size = size}));
        assets.materials.push_back({});
        return world.create(
            Transform{.position = at},
            MeshInstance{
                .mesh = {static_cast<std::uint32_t>(assets.meshes.size() - 1)},
                .material = {static_cast<std::uint32_t>(assets.materials.size() - 1)}});
    }
    ModelView view(const std::string& backdrop = "studio", double turntable = 0) {
        Result<Backdrop> loaded = load_backdrop(backdrop);
        REQUIRE_MESSAGE(loaded.ok(), (loaded ? "" : loaded.error().message));
        return add_model_view(world, *std::move(loaded), turntable);
    }
};

const Bounds kUnit = {Vec3(-0.5f), Vec3(0.5f)};

/// How far out in an image the corners of a box are: 1 at its border. `turns`: at any angle about
/// its vertical axis.
float corner_extent(const Bounds& box, const Transform& camera, const Vec2& tangent, bool turns) {
    float extent = 0;
    for (int turn = 0; turn < (turns ? 50 : 1); ++turn) {
        const Quat rotation =
            glm::angleAxis(2 * kPi * static_cast<float>(turn) / 50, Vec3(0, 1, 0));
        for (int corner = 0; corner < 8; ++corner) {
            const Vec3 sides(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const Vec3 corner_ws = center(box) + rotation * (half_extent(box) * sides);
            const Vec3 p = glm::conjugate(camera.rotation) * (corner_ws - camera.position);
            CHECK(p.z < 0);
            extent = std::max(
                {extent, std::abs(p.x / p.z) / tangent.x, std::abs(p.y / p.z) / tangent.y});
        }
    }
    return extent;
}

}  // namespace

TEST_CASE("model view: the illuminance of lights is that of their closed forms") {
    register_all_components();
    {
        World world;
        world.create(Transform{}, DirectionalLight{.illuminance = 6830});
        CHECK(find_illuminance(world, kUnit) == near(6830));
    }
    {
        World world;  // far away: all points have the same distance
        world.create(
            Transform{.position = {0, 500, 0}}, PointLight{.intensity = 1e6f, .radius = 0});
        CHECK(find_illuminance(world, kUnit) == near(4).epsilon(1e-4));
    }
    {
        World world;  // the parent moves it twice as far away
        const Entity rig = world.create(Transform{.position = {0, 500, 0}, .scale = Vec3(2)});
        world.create(
            Transform{.position = {0, 250, 0}}, PointLight{.intensity = 1e6f, .radius = 0},
            Parent{rig});
        CHECK(find_illuminance(world, kUnit) == near(1).epsilon(1e-4));
    }
    {
        World world;  // beyond its radius, and switched off
        world.create(Transform{.position = {0, 500, 0}}, PointLight{.radius = 100});
        world.create(Transform{}, DirectionalLight{.enabled = false});
        CHECK(find_illuminance(world, kUnit) == 0);
    }
    for (const bool toward : {true, false}) {
        World world;  // a spot light shines along -z
        world.create(
            Transform{.position = {0, 0, toward ? 100.0f : -100.0f}},
            SpotLight{.intensity = 1e4f, .radius = 0});
        CHECK(find_illuminance(world, kUnit) == near(toward ? 1 : 0).epsilon(1e-3).scale(1));
    }
}

TEST_CASE("model view: exposure makes light of any unit equally bright") {
    for (const float lux : {0.01f, 1.0f, 6830.0f, 120000.0f}) {
        CAPTURE(lux);
        Model model;
        const Entity sun = model.world.create(Transform{}, DirectionalLight{.illuminance = lux});
        (void)model.view();
        const auto& exposure = model.world.resource<Exposure>();
        CHECK(lux * std::exp2(exposure.manual_ev) == near(2.4));
        CHECK(exposure.ev == 0);
        CHECK(exposure.meter_surfaces);
        CHECK(exposure.min_luminance == near(0.08 * lux / 3.14159265));
        CHECK(model.world.get<const DirectionalLight>(sun).illuminance == lux);
        CHECK(model.world.has<Shadow>(sun));
        CHECK(model.world.query<const DirectionalLight>().count() == 1);
    }
}

TEST_CASE("model view: a model that no light reaches is lit by the studio") {
    for (const bool out_of_reach : {false, true}) {
        Model model;
        if (out_of_reach) {
            model.world.create(Transform{.position = {0, 50, 0}}, PointLight{.radius = 10});
        }
        const ModelView view = model.view();
        CHECK(model.world.query<const DirectionalLight>().count() == 2);
        CHECK(model.world.resource<Exposure>().manual_ev == 0);
        CHECK(model.world.resource<Environment>().sky == SkyKind::Studio);
        // What was added is listed: camera, two lights, ground.
        CHECK(view.added.size() == 4);
    }
}

TEST_CASE("model view: a ground plane or a sky dome of the file is not what is framed") {
    Model plain;
    const Bounds alone = plain.view().subject;
    for (const float width : {3.0f, 500.0f}) {
        const bool dome = width > 100;
        CAPTURE(width);
        Model model;
        model.add_box({width, 0.01f, width}, {0.02f * width, -0.005f, 0});
        if (dome) {
            model.add_box({2000, 2000, 2000}, {0, 0, 0});
        }
        const ModelView view = model.view();
        CHECK(view.subject.min == alone.min);
        CHECK(view.subject.max == alone.max);
        CHECK(view.added.size() == 3);  // camera and two lights: no other ground is laid over it
    }
    CHECK(plain.world.resource<Assets>().meshes.size() == 2);
}

TEST_CASE("model view: what is framed has the file's morph weights, not those of the rest pose") {
    Model model;
    for (const Vec3& offset : {Vec3(9, 0, 0), Vec3(0, 4, 0)}) {
        MorphTarget target;
        target.vertices = {0};
        target.positions = {offset};
        model.world.resource<Assets>().meshes[0].morphs.push_back(target);
    }
    const Entity box = model.world.query<const MeshInstance>().single_entity();
    model.world.add(box, MorphWeights{.weights = {7, 0, 0.5f}, .previous = {}});
    model.world.add(box, Deformed{.character = box, .skin = {}, .first_morph = 1});
    const Vec3 corner = model.world.resource<Assets>().meshes[0].positions[0];
    const Bounds framed = model.view().subject;
    CHECK(framed.max.y == test::near(std::max(1.0f, corner.y + 0.5f + 2.0f)));
    CHECK(framed.max.x == test::near(0.5f));
}

TEST_CASE("model view: a table top, a lid and a crowd are part of the model") {
    const std::vector<Bounds> table = {
        {{-1, 0, -1}, {1, 0.7f, 1}}, {{-1.2f, 0.7f, -1.2f}, {1.2f, 0.72f, 1.2f}}};
    CHECK(find_scenery(table) == std::vector<bool>{false, false});
    const std::vector<Bounds> alone = {{{-5, 0, -5}, {5, 0, 5}}};
    CHECK(find_scenery(alone) == std::vector<bool>{false});
    std::vector<Bounds> crowd;
    for (int i = 0; i < 1000; ++i) {
        const float x = static_cast<float>(i);
        crowd.push_back({{x, 0, 0}, {x + 0.5f, 2, 1}});
    }
    CHECK(find_scenery(crowd) == std::vector<bool>(1000, false));
}

TEST_CASE("model view: the camera frames the subject, and its own ground lies below") {
    Model model;
    const ModelView view = model.view();
    const Transform place = model.world.get<const Transform>(view.camera);
    const Vec3 ahead = place.rotation * Vec3(0, 0, -1);
    CHECK(glm::dot(ahead, glm::normalize(center(view.subject) - place.position)) > 0.999f);
    const MeshData& ground = model.world.resource<Assets>().meshes.back();
    CHECK(ground.colors.front().w == 1);
    CHECK(ground.colors.back().w == 0);
    for (std::size_t i = 0; i < ground.indices.size(); i += 3) {  // seen from above
        const Vec3& a = ground.positions[ground.indices[i]];
        const Vec3& b = ground.positions[ground.indices[i + 1]];
        const Vec3& c = ground.positions[ground.indices[i + 2]];
        CHECK(glm::cross(b - a, c - a).y > 0);
    }
    const Transform floor = model.world.get<const Transform>(view.added.back());
    CHECK(floor.position.y < view.subject.min.y);
    CHECK(floor.position.y > view.subject.min.y - 0.01f);
}

TEST_CASE("model view: the key light reaches the front, and grazes what lies flat") {
    const auto toward_key = [](const Vec3& size) {
        Model model;
        auto& assets = model.world.resource<Assets>();
        assets.meshes[0] = make_box({.size = size});
        (void)model.view();
        Vec3 direction(0);
        model.world.query<const Transform, const DirectionalLight, const Shadow>().each(
            [&](const Transform& place, const DirectionalLight&, const Shadow&) {
                direction = place.rotation * Vec3(0, 0, 1);
            });
        return direction;
    };
    const Vec3 standing = toward_key({1, 1, 1});
    CHECK(standing.z > 0.15f);
    CHECK(standing.x > standing.z);  // from the side
    CHECK(standing.y > 0.5f);
    const Vec3 lying = toward_key({4, 0.1f, 4});
    CHECK(lying.y > 0.2f);
    CHECK(lying.y < 0.4f);
}

TEST_CASE("model view: a wide ground of the file fades to nothing, and is whole at the subject") {
    Model model;
    const Entity ground = model.add_box({2000, 0.01f, 2000}, {300, -0.005f, 0});
    const ModelView view = model.view();
    const auto& assets = model.world.resource<Assets>();
    const MeshInstance drawn = model.world.get<const MeshInstance>(ground);
    REQUIRE(view.meshes == 1);
    REQUIRE(view.materials == 1);
    CHECK(drawn.mesh.index == assets.meshes.size() - 1);
    CHECK(assets.materials[drawn.material.index].alpha_mode == AlphaMode::Blend);
    const MeshData& mesh = assets.meshes[drawn.mesh.index];
    const float radius = glm::length(half_extent(view.subject));
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        Vec3 p[3];
        float below = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.indices[i + k];
            p[k] = mesh.positions[vertex] + Vec3(300, -0.005f, 0);
            const float distance = glm::length(Vec2(p[k].x, p[k].z));
            const float opacity = mesh.colors[vertex].w;
            CHECK_FALSE((distance < radius && opacity < 0.95f));
            CHECK_FALSE((distance > 12.01f * radius && opacity > 0));
            below += mesh.normals[vertex].y;
        }
        if (below > 2.9f) {
            area += 0.5 * static_cast<double>(glm::cross(p[1] - p[0], p[2] - p[0]).y);
        }
    }
    // Nothing is missing of the disc that is seen.
    CHECK(area > static_cast<double>(kPi * square(12 * radius)));
    CHECK(mesh.indices.size() < 30'000);
}

TEST_CASE("model view: a model far away is moved to the origin, one that is near is not") {
    for (const float x : {2.0f, 80000.0f}) {
        const test::TemporaryFolder folder;
        const std::string path = folder.file("far.obj");
        std::ofstream(path) << fmt::format("v {} 1 0\nv {} 1 0\nv {} 2 0\nf 1 2 3\n", x, x + 1, x);
        World world;
        const Result<LoadedScene> scene = load_scene(world, path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        const Vec3 middle = center(scene->model->subject);
        CHECK(middle.x == near(x > 100 ? 0 : 2.5).scale(1));
        CHECK(middle.y == near(x > 100 ? 0 : 1.5).scale(1));
        CHECK(2.0f * half_extent(scene->model->subject).y == near(1).epsilon(1e-4));
    }
}

TEST_CASE("model view: offsets of ten million meters that cancel leave the same view, to the bit") {
    const auto near_file = test::shared_report("20-far-away/near.gltf");
    const auto cancel_file = test::shared_report("20-far-away/cancel.gltf");
    if (!near_file || !cancel_file) {
        return;
    }
    World world;
    World other;
    const Result<LoadedScene> scene = load_scene(world, *near_file);
    const Result<LoadedScene> same = load_scene(other, *cancel_file);
    REQUIRE(scene.ok());
    REQUIRE(same.ok());
    CHECK(same->model->subject.min == scene->model->subject.min);
    CHECK(same->model->subject.max == scene->model->subject.max);
    CHECK(
        other.get<const Transform>(same->camera).position
        == world.get<const Transform>(scene->camera).position);
}

TEST_CASE("model view: a turntable turns the camera once in so many seconds") {
    Model model;
    const ModelView view = model.view("studio", 4);
    const Entity pivot = model.world.get<const Parent>(view.camera).entity;
    CHECK(model.world.get<const Spin>(pivot).speed * 4 == near(2.0 * static_cast<double>(kPi)));
    const SceneMatrices matrices(model.world);
    Model still;
    const ModelView other = still.view();
    const Vec3 middle = center(view.subject);
    const Vec3 turning = transform_point(matrices.of(view.camera), {0, 0, 0}) - middle;
    const Vec3 standing = still.world.get<const Transform>(other.camera).position - middle;
    CHECK(glm::dot(glm::normalize(turning), glm::normalize(standing)) > 0.99999f);
    CHECK(glm::length(turning) >= glm::length(standing));
}

TEST_CASE("model view: every corner of a box is in the image, of any shape, at any size") {
    for (const Vec3& size :
         {Vec3(1, 1, 1), Vec3(20, 1, 1), Vec3(1, 20, 1), Vec3(1, 1, 20), Vec3(10, 0, 10),
          Vec3(10, 10, 0), Vec3(0, 10, 10), Vec3(1e-4f, 3e-4f, 2e-4f), Vec3(7e4f, 2e4f, 1e5f)}) {
        CAPTURE(size.x);
        CAPTURE(size.y);
        CAPTURE(size.z);
        const Bounds box = {{2, 3, 4}, Vec3(2, 3, 4) + size};
        for (const bool turns : {false, true}) {
            const Camera lens{.fov_y = radians(35.0f)};
            const Framing framing = frame_bounds(box, lens.fov_y, 16.0f / 9.0f, turns);
            for (const float aspect : {0.25f, 0.5f, 0.75f, 1.0f, 4 / 3.0f, 16 / 9.0f, 4.0f}) {
                CAPTURE(aspect);
                const float up = std::tan(0.5f * fit_camera(lens, {framing.aspect}, aspect).fov_y);
                const float widest = corner_extent(box, framing.camera, {up * aspect, up}, turns);
                CHECK(widest < 0.95f);
                if (!turns) {  // and no smaller than it has to be
                    CHECK(widest > (aspect > 1.8f ? 0.3f : 0.45f));
                }
            }
        }
    }
}

TEST_CASE("model view: an image as wide as the framing is for has its field of view") {
    const Camera lens{.fov_y = radians(35.0f)};
    const FramingState wide{frame_bounds({Vec3(0), Vec3(20, 1, 1)}, lens.fov_y, 1.5f).aspect};
    CHECK(wide.aspect == near(1.5));
    CHECK(fit_camera(lens, wide, 1.51f).fov_y == lens.fov_y);
    CHECK(fit_camera(lens, wide, 1.0f).fov_y > lens.fov_y);
    // What is tall needs no wider view in an upright image.
    const FramingState tall{frame_bounds({Vec3(0), Vec3(1, 20, 1)}, lens.fov_y, 1.5f).aspect};
    CHECK(fit_camera(lens, tall, 0.5f).fov_y == lens.fov_y);
}

TEST_CASE("model view: whatever is chosen for a model scales with it") {
    const auto choose = [](float scale) {
        Model model;
        auto& assets = model.world.resource<Assets>();
        assets.meshes[0] = make_box({.size = Vec3(scale)});
        const Entity box = model.world.query<const MeshInstance>().single_entity();
        model.world.get<Transform>(box).position = {0, 0.5f * scale, 0};
        const ModelView view = model.view();
        std::vector<float> lengths = {
            model.world.get<const Camera>(view.camera).near,
            glm::length(model.world.get<const Transform>(view.camera).position),
            assets.meshes.back().bounds.max.x};
        model.world.query<const Shadow>().each(
            [&](const Shadow& shadow) { lengths.push_back(shadow.distance); });
        for (float& length : lengths) {
            length /= scale;
        }
        return lengths;
    };
    const std::vector<float> one = choose(1);
    CHECK(one.size() == 4);
    for (const float scale : {1e-4f, 1e-2f, 100.0f, 2e4f, 1e5f}) {
        CAPTURE(scale);
        const std::vector<float> other = choose(scale);
        for (std::size_t i = 0; i < one.size(); ++i) {
            CHECK(other[i] == near(one[i]).epsilon(1e-5));
        }
    }
}

TEST_CASE("model view: an OBJ millions of meters from its origin keeps its millimeters") {
    const test::TemporaryFolder folder;
    const auto load = [&](const char* vertices) {
        const std::string path = folder.file("far.obj");
        std::ofstream(path) << vertices << "f 1 2 3\n";
        World world;
        const Result<LoadedScene> scene = load_scene(world, path);
        REQUIRE_MESSAGE(scene.ok(), (scene ? "" : scene.error().message));
        return scene->model->subject;
    };
    const Bounds close = load("v 0 0 0\nv 1.125 0 0\nv 0 0.375 0.625\n");
    const Bounds far = load("v 1842022.25 10 -5173301.5\nv 1842023.375 10 -5173301.5\n"
                            "v 1842022.25 10.375 -5173300.875\n");
    CHECK(half_extent(far).x == near(half_extent(close).x));
    CHECK(half_extent(far).y == near(half_extent(close).y));
    CHECK(half_extent(far).z == near(half_extent(close).z));
}

TEST_CASE("scene bounds: what is attached to a joint is sheared before the first step, too") {
    World world;
    const Quat turned = glm::angleAxis(radians(45.0f), Vec3(0, 0, 1));
    Assets assets;
    SkeletonData skeleton;
    skeleton.joints = {"wide", "turned"};
    skeleton.parents = {-1, 0};
    skeleton.rest = {{Vec3(0), Vec3(0)}, {Quat(1, 0, 0, 0), turned}, {Vec3(2, 1, 1), Vec3(1)}};
    assets.skeletons.push_back(skeleton);
    world.insert_resource(std::move(assets));
    const Entity character = world.create(Transform{}, Skeleton{{0}});
    const Entity attached =
        world.create(Transform{}, Parent{character}, JointAttachment{character, 1});
    const Affine matrix = SceneMatrices(world).of(attached);
    const float half = std::sqrt(0.5f);
    const Vec3 corner = transform_point(matrix, {0.5f, -0.5f, 0});  // of a rhombus
    CHECK(glm::distance(corner, {2 * half, 0, 0}) < 1e-5f);
    CHECK(glm::distance(transform_point(matrix, {0.5f, 0.5f, 0}), {0, half, 0}) < 1e-5f);
}

TEST_CASE("model view: an unknown backdrop names those that exist") {
    const Result<Backdrop> none = load_backdrop("stduio");
    REQUIRE_FALSE(none.ok());
    CHECK(
        none.error().message
        == "--backdrop: found \"stduio\", expected studio, sky, gray, black or an image file");
    const Result<Backdrop> missing = load_backdrop("no/such.exr");
    REQUIRE_FALSE(missing.ok());
    CHECK(missing.error().message == "no/such.exr: no such file");
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("a.exr")) << "not an image";
    CHECK_FALSE(load_backdrop(folder.file("a.exr")).ok());
}

TEST_CASE("model view: formats that are not read are named, with what is") {
    World world;
    for (const char* const file : {"head.ply", "HEAD.FBX", "part.stl"}) {
        const Result<LoadedScene> scene = load_scene(world, file);
        REQUIRE_FALSE(scene.ok());
        CHECK(
            scene.error().message.find(
                "format not supported, expected a level, .gltf, .glb, .obj or .bvh")
            != std::string::npos);
    }
    const Result<LoadedScene> level =
        load_scene(world, "gallery", {.model = {.backdrop = "sky", .turntable = 0}});
    REQUIRE_FALSE(level.ok());
    CHECK(level.error().message.find("found a level, expected a model") != std::string::npos);
    const Result<LoadedScene> strict =
        load_scene(world, "gallery", {.model = {.load = {.strict = true}}});
    REQUIRE_FALSE(strict.ok());
    CHECK(strict.error().message.find("--strict") != std::string::npos);
}

}  // namespace limn::model_view_test
