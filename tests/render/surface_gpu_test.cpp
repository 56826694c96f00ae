// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/skin_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/surface_binding.h"
#include "render/skinning/deformed_list.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/deformer_system.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_binding_system.h"
#include "systems/animation/surface_patches.h"

#include <glm/geometric.hpp>

#include <vector>

namespace limn::test::surface_gpu_test {
namespace {

/// A tube that follows a coarse one, which a lattice bends.
struct SurfaceTest : SkinScene {
    Entity surface;
    Entity tube;

    void make(SurfaceMethod method) {
        surface = world.create(
            Transform{}, WorldTransform{}, ControlSurface{add(make_tube(5, 7, 1))},
            Deformers{
                .muscles = {},
                .sphincters = {},
                .lattices = {
                    {.origin = {-1, -0.5f, -1},
                     .u = {2, 0, 0},
                     .v = {0, 2, 0},
                     .w = {0, 0, 2},
                     .offsets = std::vector<Vec3>(kLatticePoints, Vec3(0))}}});
        SurfaceBinding binding;
        binding.surface = surface;
        binding.method = method;
        tube = world.create(
            Transform{}, WorldTransform{}, MeshInstance{add(make_tube(24, 24, 1)), gray}, binding);
        step({0, 0, 0});
    }
    void step(const Vec3& by) {
        world.get<Deformers>(surface).lattices[0].offsets[42] = by;
        world.get<Deformers>(surface).lattices[0].offsets[26] = -0.5f * by;
        world.run(add_deformer_states);
        world.run(add_surface_binding_states);
        world.run(bind_surfaces);
        world.run(update_deformers);
        world.run(update_surface_bindings);
    }
    oracle::SkinReadbackVertices read(float alpha = 1) {
        return gpu.run(world, std::vector<Entity>{tube}, alpha, 0)[0];
    }
    /// Largest of all distances, which must be as many.
    static float farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
        float most = a.size() == b.size() && !a.empty() ? 0.0f : INFINITY;
        for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
            most = std::max(most, glm::distance(a[i], b[i]));
        }
        return most;
    }

    oracle::SkinReadback gpu = *oracle::SkinReadback::create(device());
    const MaterialId gray = add(Material{});
};

}  // namespace

TEST_CASE_FIXTURE(
    SurfaceTest,
    "surface_gpu: a mesh on patches matches the CPU" * technique("face.bids-rebuild")) {
    make(SurfaceMethod::Patches);
    step({0.5f, 0.1f, 0.4f});
    step({0.9f, 0.5f, -0.3f});
    const auto& state = world.get<SurfaceBindingState>(tube);
    const MeshData& mesh = mesh_of(tube);
    const auto follow = [&](const std::vector<Vec4>& patches, SkinnedVertices to) {
        follow_patches(*state.anchors, patches, to.positions, to.normals, to.tangents);
    };
    std::vector<Vec3> positions = mesh.positions;
    std::vector<Vec3> normals = mesh.normals;
    std::vector<Vec4> tangents = mesh.tangents;
    follow(state.patches, {positions, normals, tangents});
    const oracle::SkinReadbackVertices got = read();
    CHECK(farthest(got.positions, positions) <= 1e-5f);
    CHECK(farthest(got.normals, normals) <= 1e-3f);
    CHECK(farthest(mesh.positions, positions) > 0.05f);
    for (const Vec3& p : got.positions) {
        const Bounds& box = gpu.shapes()[gpu.shapes().find(tube)].bounds;
        CHECK(glm::all(glm::lessThanEqual(box.min, p)));
        CHECK(glm::all(glm::lessThanEqual(p, box.max)));
    }

    std::vector<Vec3> before = mesh.positions;
    follow(state.previous_patches, {before, normals, tangents});
    CHECK(farthest(got.before, before) <= 1e-5f);
    CHECK(farthest(positions, before) > 0.02f);

    std::vector<Vec3> source;
    CHECK(deform_positions(
        mesh, world.get<Deformed>(tube), nullptr, nullptr, nullptr, nullptr, source,
        surface_shape(&state, state.patches)));
    CHECK(farthest(source, positions) <= 1e-7f);  // the sum of the weights is rounded
}

TEST_CASE_FIXTURE(
    SurfaceTest, "surface_gpu: a mesh bound to faces matches the CPU" * technique("face.soffd")) {
    make(SurfaceMethod::Faces);
    step({0.5f, 0.1f, 0.4f});
    step({0.9f, 0.5f, -0.3f});
    const auto& state = world.get<SurfaceBindingState>(tube);
    const MeshData& mesh = mesh_of(tube);
    const SkinData& skin = world.resource<Assets>().skins[state.skin.index];
    std::vector<Vec3> positions;
    CHECK(deform_positions(
        mesh, world.get<Deformed>(tube), &skin, &state.pose, nullptr, nullptr, positions));
    const oracle::SkinReadbackVertices got = read();
    CHECK(farthest(got.positions, positions) <= 1e-5f);
    CHECK(farthest(mesh.positions, positions) > 0.05f);
    Pose before;
    before.joints = state.pose.previous;
    CHECK(deform_positions(
        mesh, world.get<Deformed>(tube), &skin, &before, nullptr, nullptr, positions));
    CHECK(farthest(got.before, positions) <= 1e-5f);
    CHECK(farthest(got.positions, got.before) > 0.02f);
}

}  // namespace limn::test::surface_gpu_test
