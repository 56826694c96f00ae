// Height fields and meshes as colliders on the GPU.

#include "ecs/components/animation.h"
#include "ecs/components/height_field.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particles.h"
#include "ecs/components/surface.h"
#include "ecs/components/water_noise.h"
#include "systems/particles/gpu_shapes.h"
#include "systems/particles/mesh_bvh.h"
#include "systems/water/water_noise_system.h"
#include "tests/near.h"
#include "tests/render/particle_executors.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace limn::test::gpu_shapes_test {
namespace {

const Vec3 kSource = {1, 2, 3};  // of the emitter

/// Particles that fall from a box over 3 x 3 m.
ParticleEmitter rain() {
    ParticleEmitter emitter = fountain();
    emitter.shape = EmitterShape::Box;
    emitter.size = {1.5f, 0.3f, 1.5f};
    emitter.speed = 1;
    return emitter;
}

/// Hills of noise below the emitter.
Entity add_hills(Executors& both, const NoiseSurface& noise) {
    HeightField field;
    fill_noise_field(noise, 0, field);
    const Affine at = affine_from({kSource.x, 0, kSource.z}, Quat(1, 0, 0, 0), Vec3(1));
    return both.world.create(
        ParticleCollider{.shape = ColliderShape::HeightField}, noise, std::move(field),
        WorldTransform{at}, PreviousWorldTransform{at});
}

constexpr NoiseSurface kHills = {
    .size = {6, 6}, .points = 65, .octaves = 2, .frequency = 0.5f, .amplitude = 0.6f};

Entity add_mesh(Executors& both, MeshData mesh, const Affine& at) {
    const MeshId id = both.add(std::move(mesh));
    return both.world.create(
        ParticleCollider{.shape = ColliderShape::Mesh}, MeshInstance{.mesh = id, .material = {}},
        WorldTransform{at}, PreviousWorldTransform{at});
}

/// How many of the particles are more than 1e-4 m from those of the CPU. A few may be: where one
/// meets an edge, or the step between two cells that a radius raises differently, rounding decides
/// which way it goes.
std::size_t count_apart(Executors& both) {
    const std::vector<GpuParticle> gpu = both.read();
    const ParticlePool& cpu = both.pool();
    REQUIRE(gpu.size() == cpu.size());
    REQUIRE(gpu.size() > 100);
    std::size_t apart = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        const Vec3 position = {cpu.x[i], cpu.y[i], cpu.z[i]};
        apart += glm::distance(Vec3(gpu[i].position_age), position) <= 1e-4f ? 0 : 1;
    }
    return apart;
}

/// A closed box with walls that face both ways.
MeshData make_walls(const Vec3& half) {
    MeshData mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.push_back(
            half
            * Vec3(
                (corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                (corner & 4) != 0 ? 1 : -1));
    }
    mesh.normals.assign(8, Vec3(0, 1, 0));
    mesh.tangents.assign(8, Vec4(1, 0, 0, 1));
    mesh.uvs.assign(8, Vec2(0));
    mesh.indices = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
    return mesh;
}

std::uint32_t word_of(float texel) {
    return std::bit_cast<std::uint32_t>(texel);
}

}  // namespace

TEST_CASE(
    "gpu shapes: particles land on a height field where those of the CPU do"
    * technique("particle.heightfield-collision, particle.constraints")) {
    for (const CollisionAction action :
         {CollisionAction::Bounce, CollisionAction::Stick, CollisionAction::Kill}) {
        for (const float radius : {0.0f, 0.03f}) {
            CAPTURE(static_cast<int>(action));
            CAPTURE(radius);
            Executors both(rain(), {});
            both.collide({.action = action, .bounce = 0.3f, .friction = 0.7f, .radius = radius});
            const Entity hills = add_hills(both, kHills);
            both.step(75);
            CHECK(count_apart(both) <= both.pool().size() / (radius > 0 ? 80 : 400));
            if (action == CollisionAction::Kill) {
                continue;
            }
            std::size_t landed = 0;  // none is below the surface
            const HeightField& field = both.world.get<const HeightField>(hills);
            for (const GpuParticle& one : both.read()) {
                const Vec3 at = Vec3(one.position_age) - Vec3(kSource.x, 0, kSource.z);
                const float low = field.low;
                CHECK(at.y > low - 1e-3f);
                landed += at.y < low + field.range ? 1 : 0;
            }
            CHECK(landed > 100);
        }
    }
}

TEST_CASE(
    "gpu shapes: a surface that moves lifts the particles of both executors"
    * technique("particle.constraints")) {
    Executors both(rain(), {});
    both.collide({.bounce = 0, .friction = 0, .radius = 0});
    NoiseSurface noise = kHills;
    noise.speed = 0.7f;
    const Entity hills = add_hills(both, noise);
    for (int i = 0; i < 90; ++i) {
        fill_noise_field(
            noise, both.world.resource<FrameTime>().time, both.world.get<HeightField>(hills));
        both.step();
        if (i % 7 == 0) {
            (void)both.read();
        }
    }
    CHECK(count_apart(both) <= both.pool().size() / 100);
    // The same from the beginning, with the heights of each step.
    const std::vector<GpuParticle> before = both.read();
    both.pools = *GpuParticlePools::create(RenderTest::device());
    const std::vector<GpuParticle> after = both.read();
    REQUIRE(after.size() == before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
        CHECK(after[i].position_age == before[i].position_age);
    }
}

TEST_CASE(
    "gpu shapes: particles bounce off a mesh that turns where those of the CPU do"
    * technique("particle.collision-loop")) {
    for (const float radius : {0.0f, 0.03f}) {
        CAPTURE(radius);
        Executors both(rain(), {});
        both.collide({.bounce = 0.3f, .friction = 0.7f, .radius = radius});
        const Entity ball = add_mesh(both, make_ball(24), {});
        both.add_obstacle({.shape = ColliderShape::Plane}, {0, -1, 0});
        std::shared_ptr<const std::vector<Vec4>> shape;
        for (int i = 0; i < 60; ++i) {
            const Quat turn = glm::angleAxis(0.02f * static_cast<float>(i), Vec3(0.6f, 0.8f, 0));
            both.world.get<WorldTransform>(ball).world =
                affine_from({kSource.x, 0.3f, kSource.z}, turn, {1.5f, 0.8f, 1.2f});
            both.step();
            const GpuCollider& last = both.recorded().steps.back().colliders.back();
            CHECK(last.kind == GpuColliderKind::Mesh);
            CHECK((shape == nullptr || shape == last.shape));  // moved, not made again
            shape = last.shape;
        }
        CHECK(count_apart(both) <= both.pool().size() / 50);
    }
}

TEST_CASE("gpu shapes: a mesh that is deformed is hit where it is in each step") {
    Executors both(rain(), {});
    both.collide({.bounce = 0, .friction = 0.5f, .radius = 0.01f});
    MeshData mesh = make_square();
    MorphTarget& up = mesh.morphs.emplace_back();
    up.vertices = {0, 1, 2, 3};
    up.positions.assign(4, Vec3(0, 0, 1));
    const Quat flat = glm::angleAxis(-0.5f * kPi, Vec3(1, 0, 0));
    const Entity plate =
        add_mesh(both, mesh, affine_from({kSource.x, -0.5f, kSource.z}, flat, Vec3(2)));
    const Entity weights = both.world.create(MorphWeights{.weights = {0.0f}, .previous = {}});
    both.world.add(plate, Deformed{.character = weights, .skin = {}});
    for (int i = 0; i < 60; ++i) {
        both.world.get<MorphWeights>(weights).weights = {0.005f * static_cast<float>(i)};
        both.step();
    }
    CHECK(count_apart(both) == 0);
    for (const GpuParticle& one : both.read()) {
        const Vec3 at(one.position_age);
        const bool above = std::abs(at.x - kSource.x) < 1.9f && std::abs(at.z - kSource.z) < 1.9f;
        CHECK((!above || at.y > 0.09f));  // -0.5 + 0.6
    }
}

TEST_CASE("gpu shapes: at 60 m/s none gets out of a box of triangles, nor through a thin ridge") {
    const ParticleEmitter emitter = outburst(60);
    ParticleMotion motion;
    motion.gravity = 0;
    for (const float radius : {0.0f, 0.02f}) {
        Executors both(emitter, motion);
        both.collide({.bounce = 0.9f, .friction = 1, .radius = radius});
        const Quat turn = glm::normalize(Quat(0.9f, 0.2f, -0.3f, 0.1f));
        (void)add_mesh(both, make_walls(Vec3(2)), affine_from(kSource, turn, Vec3(1)));
        both.step(120);
        const std::vector<GpuParticle> gpu = both.read();
        REQUIRE(gpu.size() == 800);
        for (const GpuParticle& one : gpu) {
            const Vec3 offset = glm::abs(glm::conjugate(turn) * (Vec3(one.position_age) - kSource));
            CHECK(std::max({offset.x, offset.y, offset.z}) < 2.001f);
        }
    }
    // A ridge of 2 m, as wide as a cell, on flat ground.
    Executors both(emitter, motion);
    both.collide({.bounce = 0.5f, .friction = 1});
    const Entity field = add_hills(both, kHills);
    HeightField& heights = both.world.get<HeightField>(field);
    heights.height.assign(heights.height.size(), 0.0f);
    for (std::size_t j = 0; j < heights.points; ++j) {
        heights.height[j * heights.points + 44] = 9;
    }
    both.step(3);
    const float ridge = kSource.x - 3 + 44 * 6.0f / 64;
    std::size_t stopped = 0;
    for (const GpuParticle& one : both.read()) {
        const Vec3 at(one.position_age);
        if (at.y < 8 && std::abs(at.z - kSource.z) < 2.9f && at.x < kSource.x + 2.9f) {
            CHECK(at.x < ridge);
            stopped += at.x > ridge - 0.5f ? 1 : 0;
        }
    }
    CHECK(stopped > 0);
}

TEST_CASE("gpu shapes: walking the nodes of a mesh meets each triangle once, and skips subtrees") {
    const MeshData ball = make_ball(40);
    const MeshBvh bvh = build_mesh_bvh(ball.positions, ball.indices);
    const MeshTexels made = make_mesh_texels(bvh);
    REQUIRE(made.nodes > 100);
    std::vector<std::uint32_t> found;
    const auto walk = [&](const Bounds& box) {
        found.clear();
        std::uint32_t visited = 0;
        for (std::uint32_t node = 0; node < made.nodes; ++visited) {
            const Vec4& low = made.texels[kShapeNodeTexels * node];
            const Vec4& high = made.texels[kShapeNodeTexels * node + 1];
            bool meets = true;
            for (int axis = 0; axis < 3; ++axis) {
                meets = meets && low[axis] <= box.max[axis] && high[axis] >= box.min[axis];
            }
            const std::uint32_t held = meets ? word_of(high.w) : 0;
            for (std::uint32_t t = 0; t < held % 8; ++t) {
                const std::size_t texel =
                    kShapeNodeTexels * made.nodes + kShapeTriangleTexels * (held / 8 + t);
                found.push_back(word_of(made.texels[texel].w));
            }
            node = meets ? node + 1 : word_of(low.w);
        }
        std::sort(found.begin(), found.end());
        return visited;
    };
    CHECK(walk({Vec3(-9), Vec3(9)}) == made.nodes);
    CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
    std::size_t in_leaves = 0;
    for (const MeshBvh::Leaf& leaf : bvh.leaves) {
        in_leaves += static_cast<std::size_t>(
            std::count_if(std::begin(leaf.triangle), std::end(leaf.triangle), [](std::uint32_t t) {
                return t != kNoTriangle;
            }));
    }
    CHECK(found.size() == in_leaves);
    CHECK(walk({Vec3(0.9f), Vec3(9)}) < made.nodes / 4);
    CHECK(walk({Vec3(5), Vec3(9)}) < 9);
    CHECK(found.empty());
}

TEST_CASE("gpu shapes: their memory is limited, at the cost of the oldest steps") {
    std::vector<GpuParticleStep> steps(10);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        GpuCollider collider{.kind = GpuColliderKind::Heights};
        collider.rows[0].x = static_cast<float>(i);
        collider.shape = std::make_shared<const std::vector<Vec4>>(100);
        steps[i].colliders = {{.kind = GpuColliderKind::Plane}, collider};
    }
    limit_shape_memory(4 * 100 * sizeof(Vec4), steps);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        CHECK(steps[i].colliders[1].rows[0].x == static_cast<float>(std::max<std::size_t>(i, 6)));
        CHECK(steps[i].colliders[0].shape == nullptr);
    }
    CHECK(steps[0].colliders[1].shape == steps[6].colliders[1].shape);
    CHECK(steps[7].colliders[1].shape != steps[6].colliders[1].shape);
}

TEST_CASE("gpu shapes: a new one is uploaded alone, where there is room for it") {
    const Scene scene;  // with a device
    const auto shape = [](std::size_t texels) {
        return std::make_shared<const std::vector<Vec4>>(texels);
    };
    const GpuShape a = shape(100);
    const GpuShape b = shape(50);
    const GpuShape c = shape(50);
    const GpuShape small = shape(40);
    GpuShapeList list;
    const auto show = [&](const std::vector<GpuShape>& shapes) {
        std::vector<std::uint32_t> places;
        list.begin_frame();
        for (const GpuShape& one : shapes) {
            places.push_back(list.find_or_add(one));
        }
        list.upload();
        return places;
    };
    using Places = std::vector<std::uint32_t>;
    CHECK(show({a, b}) == Places{0, 100});
    CHECK(list.uploaded() == 150);
    CHECK(show({a, b}) == Places{0, 100});
    CHECK(list.uploaded() == 150);
    CHECK(show({a, c}) == Places{0, 150});
    CHECK(list.uploaded() == 200);
    CHECK(show({a, c}) == Places{0, 150});  // b is gone
    CHECK(show({a, c, small}) == Places{0, 150, 100});
    CHECK(list.uploaded() == 240);
    CHECK(show({a, c, shape(500)}) == Places{0, 150, 200});  // the buffer grows
    CHECK(list.uploaded() == 240 + 100 + 50 + 40 + 500);
}

}  // namespace limn::test::gpu_shapes_test
