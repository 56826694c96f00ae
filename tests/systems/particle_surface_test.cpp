// Births on meshes, as they are deformed, along paths, and of pieces of meshes that fly apart.

#include "ecs/base/jobs.h"
#include "ecs/components/animation.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "systems/particles/mesh_volume.h"
#include "systems/particles/particle_mesh_system.h"
#include "tests/near.h"
#include "tests/systems/particle_emitters.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace limn::test::particle_surface_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Affine placed(const Vec3& at, const Vec3& scale = Vec3(1)) {
    return affine_from(at, Quat(1, 0, 0, 0), scale);
}

/// Two rectangles that face +y, at z = 0 .. 1: x from -1 to 0, bound to joint 0, and from 0 to 3,
/// bound to joint 1; and two triangles without area.
MeshData two_rectangles() {
    MeshData mesh;
    mesh.positions = {{-1, 0, 0}, {0, 0, 0}, {-1, 0, 1}, {0, 0, 1},
                      {0, 0, 0},  {3, 0, 0}, {0, 0, 1},  {3, 0, 1}};
    mesh.normals.assign(8, Vec3(0, 1, 0));
    mesh.tangents.assign(8, Vec4(1, 0, 0, 1));
    mesh.uvs.assign(8, Vec2(0));
    mesh.indices = {0, 0, 1, 0, 2, 1, 1, 2, 3, 4, 5, 5, 4, 6, 5, 5, 6, 7};
    mesh.skin.first = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    mesh.skin.joints = {0, 0, 0, 0, 1, 1, 1, 1};
    mesh.skin.weights.assign(8, 1.0f);
    return mesh;
}

/// A closed mesh from points at u and v, 0 .. 1: those at u = 0 and 1 are the same; at v = 0 and 1
/// they are the same as well or do not depend on u.
template <typename Point>
MeshData closed_mesh(std::uint32_t columns, std::uint32_t rows, Point&& point) {
    MeshData mesh;
    for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t column = 0; column < columns; ++column) {
            mesh.positions.push_back(point(
                static_cast<float>(column) / static_cast<float>(columns),
                static_cast<float>(row) / static_cast<float>(rows)));
            if (row < rows) {
                const std::uint32_t first = row * columns;
                const std::uint32_t next = (column + 1) % columns;
                const std::uint32_t quad[] = {
                    first + column,           first + next, first + columns + column,
                    first + columns + column, first + next, first + columns + next};
                mesh.indices.insert(mesh.indices.end(), std::begin(quad), std::end(quad));
            }
        }
    }
    return mesh;
}

Vec3 on_circle(float turns, float radius, float y) {
    return {radius * std::cos(2 * kPi * turns), y, radius * std::sin(2 * kPi * turns)};
}

/// Around the origin.
MeshData ball_mesh(float radius, std::uint32_t detail) {
    return closed_mesh(2 * detail, detail, [&](float u, float v) {
        const float ring = v == 0 || v == 1 ? 0 : radius * std::sin(kPi * v);
        return on_circle(u, ring, radius * std::cos(kPi * v));
    });
}

void append(MeshData& mesh, const MeshData& other, const Vec3& at) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& position : other.positions) {
        mesh.positions.push_back(position + at);
    }
    for (const std::uint32_t index : other.indices) {
        mesh.indices.push_back(first + index);
    }
}

/// From the origin to `size`, 12 triangles, those that face +y last.
MeshData box_mesh(const Vec3& size) {
    MeshData mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.push_back(size * Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
    }
    mesh.indices = {0, 1, 4, 1, 5, 4, 0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6,
                    0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5, 2, 6, 3, 3, 6, 7};
    return mesh;
}

/// From (-1, 0, -1) to (1, 1, 1), and from (0, 2, 0) to (1, 2.5, 1).
MeshData two_boxes() {
    MeshData mesh;
    append(mesh, box_mesh({2, 1, 2}), {-1, 0, -1});
    append(mesh, box_mesh({1, 0.5f, 1}), {0, 2, 0});
    return mesh;
}

/// Around the z axis by 90 degrees, so that x becomes y.
Affine quarter_turn() {
    return affine_from(Vec3(0), glm::angleAxis(0.5f * kPi, Vec3(0, 0, 1)), Vec3(1));
}

/// One whose particles stay where they are born.
ParticleEmitter resting(float count) {
    ParticleEmitter emitter = burst(count);
    emitter.speed = 0;
    emitter.capacity = static_cast<std::uint32_t>(count);
    return emitter;
}

struct Surfaces : Emitters {
    Assets& assets() { return world.resource<Assets>(); }
    MeshId add_mesh(MeshData mesh) {
        assets().meshes.push_back(std::move(mesh));
        return {static_cast<std::uint32_t>(assets().meshes.size() - 1)};
    }
    Entity add_instance(MeshId mesh, const Affine& at) {
        return world.create(
            MeshInstance{.mesh = mesh, .material = {}}, WorldTransform{at},
            PreviousWorldTransform{at});
    }
    Entity emit(const ParticleEmitter& emitter, const ParticleSurface& surface) {
        const Entity entity = add(emitter, falling(0));
        world.add(entity, surface);
        return entity;
    }
    Vec3 position(std::size_t i, std::size_t which = 0) {
        const ParticlePool& all = pool(which);
        return {all.x[i], all.y[i], all.z[i]};
    }
    Vec3 velocity(std::size_t i) {
        const ParticlePool& all = pool();
        return {all.vx[i], all.vy[i], all.vz[i]};
    }
};

}  // namespace

TEST_CASE(
    "particle surface: births are even by the area that a mesh has in the world"
    * technique("particle.generation-shape")) {
    Surfaces scene;
    const Entity mesh =
        scene.add_instance(scene.add_mesh(two_rectangles()), placed({5, 6, 7}, {2, 1, 3}));
    scene.emit(resting(40000), {.entity = mesh});
    scene.run();
    REQUIRE(scene.pool().size() == 40000);
    std::vector<double> cells(64, 0);  // of 4 x 1 squares before scaling, 16 x 4 of them
    for (std::size_t i = 0; i < 40000; ++i) {
        const Vec3 local = (scene.position(i) - Vec3(5, 6, 7)) / Vec3(2, 1, 3);
        CHECK(std::abs(local.y) < 1e-6f);
        const auto column = static_cast<int>(std::floor((local.x + 1) * 4));
        const auto row = static_cast<int>(std::floor(local.z * 4));
        REQUIRE(column == std::clamp(column, 0, 15));
        REQUIRE(row == std::clamp(row, 0, 3));
        cells[static_cast<std::size_t>(4 * column + row)] += 1;
    }
    double chi_square = 0;
    for (const double count : cells) {
        chi_square += (count - 625) * (count - 625) / 625;
    }
    CHECK(chi_square > 30);  // 63 on average; one of 10,000 is outside
    CHECK(chi_square < 115);
}

TEST_CASE(
    "particle surface: births of a skinned mesh are where its pose has it in this step"
    * technique("particle.generation-shape")) {
    Surfaces scene;
    const Entity mesh = scene.add_instance(scene.add_mesh(two_rectangles()), placed({0, 0, 10}));
    SkinData skin;
    skin.joints = {0, 1};
    skin.joint_from_mesh = {Affine{}, Affine{}};
    scene.assets().skins.push_back(skin);
    scene.world.add(mesh, Deformed{.character = mesh, .skin = {0}});
    scene.world.add(mesh, Pose{.joints = {Affine{}, quarter_turn()}, .previous = {}});
    ParticleEmitter emitter = burst(2000);
    emitter.speed = 6;
    scene.emit(emitter, {.entity = mesh, .offset = 0.25f});
    scene.run();
    std::size_t turned = 0;
    for (std::size_t i = 0; i < 2000; ++i) {
        const Vec3 normal = scene.velocity(i) / 6.0f;
        const Vec3 born = scene.position(i) - scene.velocity(i) * kStep - 0.25f * normal;
        CHECK(born.z > 10);
        CHECK(born.z < 11);
        const bool upright = normal.x < -0.5f;  // what faced +y faces -x
        turned += upright ? 1 : 0;
        CHECK(glm::distance(normal, upright ? Vec3(-1, 0, 0) : Vec3(0, 1, 0)) < 1e-5f);
        CHECK(std::abs(upright ? born.x : born.y) < 1e-5f);
        CHECK((upright ? born.y : born.x + 1) > -1e-5f);
        CHECK((upright ? born.y / 3 : born.x + 1) < 1.00001f);
    }
    CHECK(static_cast<double>(turned) / 2000 == near(0.75).epsilon(0.04));

    // A pose of the next step moves the births of the next step.
    scene.world.get<Pose>(mesh).joints[0] = placed({0, 8, 0});
    scene.world.get<Pose>(mesh).joints[1] = placed({0, 8, 0});
    scene.emit(resting(100), {.entity = mesh});
    scene.run();
    for (std::size_t i = 0; i < 100; ++i) {
        CHECK(scene.position(i, 1).y == near(8));
    }
}

TEST_CASE("particle surface: directions are about the normal, also where a mesh is mirrored") {
    for (const float scale : {1.0f, -1.0f}) {
        Surfaces scene;
        ParticleEmitter emitter = burst(5000);
        emitter.cone = 0.5f;
        const Entity entity = scene.emit(emitter, {});  // on the emitter's own mesh
        const MeshId mesh = scene.add_mesh(two_rectangles());
        scene.world.add(entity, MeshInstance{.mesh = mesh, .material = {}});
        scene.world.get<WorldTransform>(entity).world = placed(Vec3(0), {scale, 1, 1});
        scene.world.get<PreviousWorldTransform>(entity).world = placed(Vec3(0), {scale, 1, 1});
        scene.run();
        float widest = 1;
        double mean = 0;
        for (std::size_t i = 0; i < 5000; ++i) {
            const float y = scene.velocity(i).y;
            widest = std::min(widest, y);
            mean += static_cast<double>(y) / 5000;
        }
        CHECK(widest > std::cos(0.5001f));
        CHECK(widest < std::cos(0.49f));
        CHECK(mean == near((1 + std::cos(0.5)) / 2).epsilon(2e-3));
    }
}

TEST_CASE(
    "particle surface: births along a path are even by arc length"
    * technique("particle.generation-shape")) {
    Surfaces scene;
    PathShape shape;  // a tight bend, then far away: u runs unevenly
    shape.knots = {
        {.position = {0, 0, 0}, .after = {0.1f, 0, 0}},
        {.position = {1, 0, 1}, .before = {0, 0, -3}, .after = {0, 0.1f, 0}},
        {.position = {9, 4, 1}, .before = {-1, 0, 0}}};
    scene.assets().paths.push_back(*make_path(shape));
    const PathData path = scene.assets().paths[0];
    scene.emit(resting(20000), {.on = BirthSurface::Path, .path = {0}});
    const Affine at = placed({1, 2, 3});
    scene.world.get<WorldTransform>(scene.entities[0]).world = at;
    scene.world.get<PreviousWorldTransform>(scene.entities[0]).world = at;
    scene.run();
    REQUIRE(scene.pool().size() == 20000);
    constexpr std::size_t kParts = 20;
    constexpr std::size_t kFine = 4000;
    std::vector<Vec3> curve;
    for (std::size_t k = 0; k <= kFine; ++k) {
        const double fraction = static_cast<double>(k) / kFine;
        curve.push_back(
            transform_point(at, path_frame_at(path, fraction * path.length()).position));
    }
    std::vector<double> counts(kParts, 0);
    for (std::size_t i = 0; i < 20000; ++i) {
        const Vec3 position = scene.position(i);
        std::size_t nearest = 0;
        float distance = 1e9f;
        for (std::size_t k = 0; k <= kFine; ++k) {
            const float d = glm::dot(curve[k] - position, curve[k] - position);
            if (d < distance) {
                distance = d;
                nearest = k;
            }
        }
        REQUIRE(std::sqrt(distance) < 0.6f * path.length() / kFine);
        counts[std::min(nearest * kParts / kFine, kParts - 1)] += 1;
    }
    double chi_square = 0;
    for (const double count : counts) {
        chi_square += (count - 1000) * (count - 1000) / 1000;
    }
    CHECK(chi_square > 3);  // 19 on average
    CHECK(chi_square < 48);
}

TEST_CASE("particle surface: along a path +y of the shape is up and +z ahead") {
    Surfaces scene;
    PathShape shape;
    shape.knots = {{.position = {0, 0, 0}}, {.position = {0, 0, -4}}};
    scene.assets().paths.push_back(*make_path(shape));
    ParticleEmitter emitter = resting(500);
    emitter.shape = EmitterShape::Box;
    emitter.size = {0.5f, 0, 0};
    emitter.speed = 3;
    scene.emit(emitter, {.on = BirthSurface::Path, .path = {0}});
    scene.run();
    for (std::size_t i = 0; i < 500; ++i) {
        CHECK(glm::distance(scene.velocity(i), Vec3(0, 3, 0)) < 1e-5f);
        CHECK(std::abs(scene.position(i).x) < 0.5f);
        CHECK(scene.position(i).z == std::clamp(scene.position(i).z, -4.0f, 0.0f));
    }
}

TEST_CASE("particle surface: they inherit a fraction of the velocity of the surface") {
    Surfaces scene;
    const Entity mesh = scene.add_instance(scene.add_mesh(two_rectangles()), placed({0, 0, 0}));
    scene.world.get<WorldTransform>(mesh).world =
        affine_from(Vec3(0), glm::angleAxis(0.02f, Vec3(0, 1, 0)), Vec3(1));
    scene.emit(resting(300), {.entity = mesh, .inherit = 0.5f});
    scene.run();
    for (std::size_t i = 0; i < 300; ++i) {
        const Vec3 born = scene.position(i);
        CHECK(
            glm::distance(scene.velocity(i), glm::cross(Vec3(0, 0.6f, 0), born))
            < 0.02f * glm::length(born));
    }
}

TEST_CASE("particle surface: where nothing can be born, none is, and the clock counts them") {
    MeshData lines = two_rectangles();
    lines.indices = {0, 0, 1, 4, 5, 5};
    MeshData empty;
    MeshData broken = two_rectangles();
    broken.positions.assign(8, Vec3(kNan));
    MeshData wild = two_rectangles();
    wild.indices = {0, 1, 90, 8, 9, 10};
    for (const MeshData& data : {lines, empty, broken, wild}) {
        Surfaces scene;
        const Entity mesh = scene.add_instance(scene.add_mesh(data), placed(Vec3(0)));
        scene.emit(resting(100), {.entity = mesh});
        scene.run(2);
        CHECK(scene.pool().size() == 0);
        CHECK(scene.pool().clock.dropped == 100);
    }
    Surfaces scene;
    const Entity mesh = scene.add_instance(scene.add_mesh(two_rectangles()), placed(Vec3(0)));
    scene.emit(steady(600), {.entity = mesh});
    scene.run(2);
    CHECK(scene.pool().size() == 20);
    scene.world.destroy(mesh);
    scene.run(3);
    CHECK(scene.pool().size() == 20);
    CHECK(scene.pool().clock.dropped == 30);
    scene.emit(resting(7), {.on = BirthSurface::Path, .path = {3}});
    scene.emit(resting(8), {.on = BirthSurface::Pieces});
    scene.run();
    CHECK(scene.pool(1).clock.dropped == 7);
    CHECK(scene.pool(2).clock.dropped == 8);
}

TEST_CASE("particle surface: a triangle that is not finite is left out, the others are not") {
    MeshData mesh = two_rectangles();
    mesh.positions[7] = Vec3(kNan);  // of the last triangle
    Surfaces scene;
    scene.emit(
        resting(3000), {.entity = scene.add_instance(scene.add_mesh(mesh), placed(Vec3(0)))});
    scene.run();
    REQUIRE(scene.pool().size() == 3000);
    for (std::size_t i = 0; i < 3000; ++i) {
        const Vec3 born = scene.position(i);
        CHECK(born.x / 3 + born.z < 1.0001f);  // its neighbor's half of the rectangle
    }
}

TEST_CASE(
    "particle surface: births in a volume are even by volume, whatever encloses it"
    * technique("particle.mesh-volume")) {
    Surfaces scene;
    const MeshId mesh = scene.add_mesh(two_boxes());
    // Births are as even in the world as in the mesh.
    const Quat turn = glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 3)));
    const Affine at = affine_from(Vec3(5, 6, 7), turn, Vec3(2, 1, 3));
    scene.emit(
        resting(40000), {.on = BirthSurface::Volume, .entity = scene.add_instance(mesh, at)});
    scene.run();
    REQUIRE(scene.pool().size() == 40000);
    CHECK(scene.pool().clock.dropped == 0);
    // Cubes of 0.5 m: 32 in the first box, which reaches from -1 to 1 along x and z and from 0 to
    // 1 along y; 4 in the second, which is within the first one's grid but apart from it.
    std::vector<double> cells(36, 0);
    for (std::size_t i = 0; i < 40000; ++i) {
        const Vec3 local = glm::inverse(turn) * (scene.position(i) - Vec3(5, 6, 7)) / Vec3(2, 1, 3);
        const bool is_first = local.y < 1.5f;
        const Vec3 cube = glm::floor(2.0f * (local - (is_first ? Vec3(-1, 0, -1) : Vec3(0, 2, 0))));
        const Vec3 cubes = is_first ? Vec3(4, 2, 4) : Vec3(2, 1, 2);
        REQUIRE(cube == glm::clamp(cube, Vec3(0), cubes - 1.0f));
        const auto number =
            static_cast<std::size_t>(cube.x + cubes.x * (cube.y + cubes.y * cube.z));
        cells[(is_first ? 0 : 32) + number] += 1;
    }
    double chi_square = 0;
    for (const double count : cells) {
        chi_square += (count - 40000.0 / 36) * (count - 40000.0 / 36) / (40000.0 / 36);
    }
    CHECK(chi_square > 11);  // 35 on average; one of 10,000 is outside
    CHECK(chi_square < 76);
}

TEST_CASE(
    "particle surface: births in a ball have the moments of a ball"
    * technique("particle.mesh-volume")) {
    Surfaces scene;
    const MeshId mesh = scene.add_mesh(ball_mesh(2, 64));
    const Entity ball = scene.add_instance(mesh, placed({1, 0, 0}));
    ParticleEmitter emitter = resting(30000);
    emitter.speed = 3;
    emitter.cone = 0;
    scene.emit(emitter, {.on = BirthSurface::Volume, .entity = ball, .offset = 100});
    scene.run();
    REQUIRE(scene.pool().size() == 30000);
    Vec3 mean(0);
    double square = 0;
    for (std::size_t i = 0; i < 30000; ++i) {
        CHECK(glm::distance(scene.velocity(i), Vec3(0, 3, 0)) < 1e-5f);
        const Vec3 born = scene.position(i) - scene.velocity(i) * kStep - Vec3(1, 0, 0);
        REQUIRE(glm::length(born) < 2.0001f);
        mean += born / 30000.0f;
        square += static_cast<double>(glm::dot(born, born)) / 30000;
    }
    CHECK(glm::length(mean) < 0.03f);
    CHECK(square == near(0.6 * 4).epsilon(0.01));
}

TEST_CASE(
    "particle surface: a mesh that is open above or below has no volume, and none is born"
    * technique("particle.mesh-volume")) {
    MeshData pot = box_mesh({2, 1, 2});
    pot.indices.resize(30);  // without its lid
    MeshData bell = box_mesh({2, 1, 2});
    bell.indices.erase(bell.indices.begin(), bell.indices.begin() + 6);  // without its bottom
    for (const MeshData& data : {two_rectangles(), pot, bell}) {
        Surfaces scene;
        const Entity mesh = scene.add_instance(scene.add_mesh(data), placed(Vec3(0)));
        scene.emit(resting(200), {.on = BirthSurface::Volume, .entity = mesh});
        scene.run();
        CHECK(scene.pool().size() == 0);
        CHECK(scene.pool().clock.dropped == 200);
    }
}

TEST_CASE(
    "particle surface: bodies that overlap or have holes enclose what is in any of them"
    * technique("particle.mesh-volume")) {
    MeshData mesh = closed_mesh(192, 96, [](float u, float v) {
        const float tube = -2 * kPi * (v == 1 ? 0 : v);
        return on_circle(u, 1 + 0.4f * std::cos(tube), 0.4f * std::sin(tube));
    });
    append(mesh, ball_mesh(0.8f, 96), {1, 0.1f, 0});
    MeshVolume volume;
    REQUIRE(fill_mesh_volume(mesh.positions, mesh.indices, volume));
    Random random(5, 0, 0, 0);
    int inside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 point = {
            random.uniform(-1.5f, 2), random.uniform(-0.8f, 1), random.uniform(-1.5f, 1.5f)};
        const float from_torus = std::hypot(std::hypot(point.x, point.z) - 1, point.y) - 0.4f;
        const float distance = std::min(from_torus, glm::distance(point, Vec3(1, 0.1f, 0)) - 0.8f);
        if (std::abs(distance) > 2e-3f) {  // beside the facets
            CHECK(is_in_volume(volume, mesh.positions, mesh.indices, point) == (distance < 0));
            inside += distance < 0 ? 1 : 0;
        }
    }
    CHECK(inside > 4000);
}

TEST_CASE(
    "particle surface: every column of a closed mesh is closed, through its vertices too"
    * technique("particle.mesh-volume")) {
    const MeshData mesh = ball_mesh(1, 32);
    MeshVolume volume;
    REQUIRE(fill_mesh_volume(mesh.positions, mesh.indices, volume));
    for (const Vec3& vertex : mesh.positions) {
        const Vec3 below = {0.999f * vertex.x, 0, 0.999f * vertex.z};
        CHECK(is_in_volume(volume, mesh.positions, mesh.indices, below));
        const Vec3 exactly = {vertex.x, 0, vertex.z};
        if (std::hypot(vertex.x, vertex.z) < 0.98f) {
            CHECK(is_in_volume(volume, mesh.positions, mesh.indices, exactly));
        }
    }
}

TEST_CASE("particle surface: a position depends only on the number of the birth") {
    const auto positions = [](float rate, int steps, float life = 1000) {
        Surfaces scene;
        const Entity mesh = scene.add_instance(scene.add_mesh(two_rectangles()), placed(Vec3(0)));
        ParticleEmitter emitter = resting(10000);
        emitter.bursts.clear();
        emitter.rate = rate;
        emitter.life = life;
        emitter.seed = 3;
        scene.emit(emitter, {.entity = mesh});
        scene.run(steps);
        std::vector<Vec3> all;
        for (std::size_t i = 0; i < scene.pool().size(); ++i) {
            all.push_back(scene.position(i));
        }
        return all;
    };
    const std::vector<Vec3> slow = positions(600, 60);
    REQUIRE(slow.size() == 600);
    CHECK(slow == positions(6000, 6));
    CHECK(slow[0] != slow[1]);
    const std::vector<Vec3> last = positions(600, 60, 0.5f);  // the others are dead
    REQUIRE(last.size() == 300);
    CHECK(std::equal(last.begin(), last.end(), slow.end() - 300));
}

TEST_CASE("particle surface: threads do not change the bits of births") {
    const int threads = thread_count();
    std::vector<ParticlePool> expected;
    for (const int count : {1, 2, 3, 7}) {
        CAPTURE(count);
        set_thread_count(count);
        Surfaces scene;
        const MeshId mesh = scene.add_mesh(two_rectangles());
        for (int i = 0; i < 40; ++i) {  // more than one job has
            const Entity on = scene.add_instance(mesh, placed({static_cast<float>(i), 1, 2}));
            ParticleEmitter emitter = resting(50000);
            emitter.bursts.clear();
            emitter.rate = 6000;
            emitter.life = 0.2f;
            emitter.life_spread = 0.1f;
            scene.emit(emitter, {.entity = on, .offset = 0.1f});
        }
        scene.run(30);
        for (std::size_t i = 0; i < 40; ++i) {
            REQUIRE(scene.pool(i).size() > 1000);
            if (count == 1) {
                expected.push_back(scene.pool(i));
            }
            CHECK(same_bits(scene.pool(i), expected[i]));
        }
    }
    set_thread_count(threads);
}

namespace {

/// A mesh in three pieces, each a triangle.
MeshId add_pieces(Surfaces& scene) {
    const MeshId whole = scene.add_mesh({});
    for (const Vec3& center : {Vec3(1, 0, 0), Vec3(0, 2, 0), Vec3(0, 0, 0)}) {
        const MeshId own = scene.add_mesh(two_rectangles());
        scene.assets().meshes[whole.index].pieces.push_back({.center = center, .mesh = own});
    }
    return whole;
}

struct Exploding : Surfaces {
    Entity emitter;

    explicit Exploding(ParticleMesh mesh, float life = 2, const Affine& at = Affine{}) {
        ParticleEmitter settings = burst(3);
        settings.speed = 5;
        settings.life = life;
        emitter = emit(settings, {.on = BirthSurface::Pieces});
        mesh.meshes = {add_pieces(*this)};
        mesh.facing = ParticleMeshFacing::Emitter;
        world.add(emitter, mesh);
        world.get<WorldTransform>(emitter).world = at;
        world.get<PreviousWorldTransform>(emitter).world = at;
        world.run(add_particle_mesh_states);
    }
    const std::vector<MeshParticle>& step(int steps = 1) {
        for (int i = 0; i < steps; ++i) {
            run();
            world.run(update_particle_meshes);
        }
        return world.get<const ParticleMeshState>(emitter).instances;
    }
};

}  // namespace

TEST_CASE(
    "explode: each piece flies away from the blast at its speed, one at the blast anywhere"
    * technique("engine.explode")) {
    Exploding scene({}, 2, placed({10, 0, 0}));
    scene.step(12);
    REQUIRE(scene.pool().size() == 3);
    const float path = 5 * 12 * kStep;
    CHECK(glm::distance(scene.position(0), Vec3(11 + path, 0, 0)) < 1e-4f);
    CHECK(glm::distance(scene.position(1), Vec3(10, 2 + path, 0)) < 1e-4f);
    CHECK(glm::distance(scene.position(2), Vec3(10, 0, 0)) == near(path));
    // Elsewhere with another seed.
    Exploding other({}, 2, placed({10, 0, 0}));
    other.world.get<ParticleEmitter>(other.emitter).seed = 99;
    other.step(12);
    CHECK(glm::distance(scene.position(2), other.position(2)) > 0.01f);
    // Away from a blast elsewhere.
    Exploding aside({});
    aside.world.get<ParticleSurface>(aside.emitter).blast = {1, -3, 0};
    aside.step(12);
    CHECK(glm::distance(aside.position(0), Vec3(1, path, 0)) < 1e-4f);
}

TEST_CASE(
    "explode: at their birth the pieces lie where they lay in the whole"
    * technique("particle.mesh-particles")) {
    const Affine at =
        affine_from({3, 4, 5}, glm::angleAxis(0.7f, Vec3(0.6f, 0, 0.8f)), {2, 1, 0.5f});
    Exploding scene({.spin = 3, .spin_spread = 2}, 2, at);
    scene.world.get<ParticleEmitter>(scene.emitter).speed = 0;
    const std::vector<MeshParticle>& pieces = scene.step();
    REQUIRE(pieces.size() == 3);
    const MeshData& whole = scene.assets().meshes[0];
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(pieces[k].mesh == whole.pieces[k].mesh);
        CHECK(pieces[k].angle < 5.001f * kStep);
        // Turned by no more than a step does.
        const Vec3 corner(0.3f, -0.2f, 0.4f);
        const Vec3 expected = transform_point(at, whole.pieces[k].center + corner);
        CHECK(glm::distance(transform_point(pieces[k].now, corner), expected) < 0.08f);
    }
    Exploding still({.spin = 0, .spin_spread = 0}, 2, at);
    still.world.get<ParticleEmitter>(still.emitter).speed = 0;
    for (const MeshParticle& piece : still.step()) {
        const Vec3 corner(0.3f, -0.2f, 0.4f);
        const auto k = static_cast<std::size_t>(piece.mesh.index - 1);
        const Vec3 expected = transform_point(at, whole.pieces[k].center + corner);
        CHECK(glm::distance(transform_point(piece.now, corner), expected) < 1e-5f);
    }
}

TEST_CASE(
    "explode: pieces keep their size until they fade, shrink to nothing and are gone"
    * technique("engine.explode")) {
    Exploding scene({.spin_spread = 4, .fade = 0.5f}, 2);
    const auto size = [&](const std::vector<MeshParticle>& pieces) {
        return glm::length(transform_vector(pieces[0].now, Vec3(1, 0, 0)));
    };
    CHECK(size(scene.step(89)) == near(1));    // at 1.483 s
    CHECK(size(scene.step(16)) == near(0.5));  // at 1.75 s
    CHECK(size(scene.step(12)) == near(0.1).epsilon(1e-3));
    CHECK(scene.step(4).empty());
}

TEST_CASE("explode: a second blast releases the same pieces again" * technique("engine.explode")) {
    Exploding scene({});
    scene.world.get<ParticleEmitter>(scene.emitter).bursts[0].repeats = 1;
    const std::vector<MeshParticle>& pieces = scene.step(62);
    REQUIRE(pieces.size() == 6);
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(pieces[k].mesh == pieces[k + 3].mesh);
        CHECK(pieces[k].key != pieces[k + 3].key);
    }
}

}  // namespace limn::test::particle_surface_test
