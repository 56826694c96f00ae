// Particles that are meshes are drawn as entities with those meshes are.

#include "ecs/components/particle_mesh.h"
#include "ecs/components/shadow.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <vector>

namespace limn::test::particle_mesh_drawing_test {
namespace {

/// Balls and squares above a floor, in a sun that casts their shadows.
struct Debris : Scene {
    MeshId ball = add(make_ball(8));
    MeshId square = add(make_square());
    MaterialId paint = add(Material{.base_color = {0.8f, 0.3f, 0.1f, 1}});
    std::vector<MeshParticle> pieces;

    Debris() {
        const Quat down = glm::angleAxis(-kPi / 2, Vec3(1, 0, 0));
        place(square, paint, affine_from({0, -1, 0}, down, Vec3(6)));
        world.create(
            DirectionalLight{.illuminance = 3}, Shadow{},
            WorldTransform{affine_from({}, down, Vec3(1))});
        for (int i = 0; i < 40; ++i) {
            const auto n = static_cast<float>(i);
            const Quat turn = glm::angleAxis(n, glm::normalize(Vec3(1, n, 2)));
            const Vec3 position = {std::sin(3 * n), 0.02f * n, std::cos(5 * n)};
            MeshParticle piece;
            piece.key = static_cast<std::uint32_t>(i);
            piece.mesh = i % 3 == 0 ? square : ball;
            piece.now = affine_from(position, turn, Vec3(0.1f));
            piece.before = affine_from(position - Vec3(0.05f, 0.02f, 0), turn, Vec3(0.1f));
            pieces.push_back(piece);
        }
    }
    Entity emit() {
        ParticleMesh mesh;
        mesh.meshes = {ball, square};
        mesh.material = paint;
        return world.create(mesh, ParticleMeshState{pieces});
    }
    RenderView view() {
        RenderView from = look({0, 2, 4}, {0, 0, 0}, 96, 64);
        from.alpha = 0.25f;
        return from;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    Debris, "particle meshes: drawn as entities are, in one draw"
                * technique("engine.projectile-instances, particle.velocity")) {
    const FrameOutput bare = draw(view());
    const gpu::FloatImage empty = gpu::read_floats(*bare.radiance);
    const std::uint64_t floor_draws = bare.statistics.draws;

    std::vector<Entity> entities;
    for (const MeshParticle& piece : pieces) {
        entities.push_back(world.create(
            MeshInstance{piece.mesh, paint}, WorldTransform{piece.now},
            PreviousWorldTransform{piece.before}));
    }
    const FrameOutput by_entity = draw(view(), {.aovs = {"velocity"}});
    const gpu::FloatImage expected = gpu::read_floats(*by_entity.radiance);
    const gpu::FloatImage expected_motion = gpu::read_floats(*by_entity.aovs.at(0).texture);
    const std::uint64_t entity_draws = by_entity.statistics.draws;
    CHECK(largest_difference(expected, empty) > 0.1f);
    for (const Entity entity : entities) {
        world.destroy(entity);
    }

    const Entity emitter = emit();
    const FrameOutput by_particle = draw(view(), {.aovs = {"velocity"}});
    CHECK(largest_difference(gpu::read_floats(*by_particle.radiance), expected) == 0);
    CHECK(
        largest_difference(gpu::read_floats(*by_particle.aovs.at(0).texture), expected_motion)
        == 0);
    CHECK(by_particle.statistics.draws == entity_draws);
    CHECK(by_particle.statistics.draws <= floor_draws + 1);

    world.get<ParticleMeshState>(emitter).instances.clear();
    const FrameOutput none = draw(view());
    CHECK(largest_difference(gpu::read_floats(*none.radiance), empty) == 0);
    CHECK(none.statistics.draws == floor_draws);
}

TEST_CASE_FIXTURE(
    Debris, "particle meshes: thousands, and shadows only where they are wanted"
                * technique("engine.projectile-instances")) {
    std::vector<MeshParticle> many;
    for (int i = 0; i < 2500; ++i) {
        many.push_back(pieces[static_cast<std::size_t>(i) % pieces.size()]);
        const auto n = static_cast<float>(i);
        many.back().now = affine_from(
            {std::sin(n), 0.0005f * n, std::cos(1.7f * n)}, Quat(1, 0, 0, 0), Vec3(0.02f));
        many.back().before = many.back().now;
    }
    pieces = many;
    const Entity emitter = emit();
    CHECK(draw(view()).statistics.visible_instances == 2501);
    const gpu::FloatImage shadowed = radiance(view());
    world.add(emitter, NoShadow{});
    const gpu::FloatImage bright = radiance(view());
    double before = 0;
    double after = 0;
    for (std::size_t i = 0; i < bright.pixels.size(); ++i) {
        CHECK(bright.pixels[i] >= shadowed.pixels[i] - 1e-4f);
        before += static_cast<double>(shadowed.pixels[i]);
        after += static_cast<double>(bright.pixels[i]);
    }
    CHECK(after > before * 1.005);
}

}  // namespace limn::test::particle_mesh_drawing_test
