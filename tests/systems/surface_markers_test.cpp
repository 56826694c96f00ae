#include "ecs/components/animation.h"
#include "ecs/components/surface_binding.h"
#include "ecs/world.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/surface_binding_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <vector>

namespace limn::surface_markers_test {
namespace {

/// A face of 41 x 41 vertices that performs a take of 5 x 5 markers, each a joint and a vertex of
/// the surface.
struct Take {
    static constexpr int kMarkers = 5;
    World world;
    Entity surface;
    Entity face;
    std::vector<Vec3> rest;  ///< of the markers

    static MeshData make_sheet(int n) {
        MeshData mesh;
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                const Vec2 at = Vec2(x, y) / static_cast<float>(n - 1) - 0.5f;
                mesh.positions.emplace_back(at, 0.3f * std::cos(3 * at.x) * std::cos(2 * at.y));
                mesh.normals.emplace_back(0, 0, 1);
                mesh.tangents.emplace_back(1, 0, 0, 1);
                mesh.uvs.push_back(at);
            }
        }
        const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * n + x); };
        for (int y = 0; y + 1 < n; ++y) {
            for (int x = 0; x + 1 < n; ++x) {
                for (const std::uint32_t v :
                     {at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1),
                      at(x, y + 1)}) {
                    mesh.indices.push_back(v);
                }
            }
        }
        return mesh;
    }

    [[nodiscard]] static Vec3 motion(std::size_t marker, float frame) {
        return 0.02f * frame * Vec3(std::sin(static_cast<float>(marker)), 0.5f, 1.0f);
    }

    Take() {
        Assets assets;
        assets.meshes = {make_sheet(41), make_sheet(kMarkers)};
        MeshData& markers = assets.meshes[1];
        rest = markers.positions;
        SkeletonData skeleton;
        skeleton.joints = {"take"};
        skeleton.parents = {-1};
        skeleton.rest.translations = {Vec3(0)};
        SkinData skin;
        ClipSheet sheet;
        sheet.times = {0, 0.1f, 0.2f};
        for (std::size_t m = 0; m < rest.size(); ++m) {
            const auto joint = static_cast<std::uint16_t>(m + 1);
            skeleton.joints.push_back("marker");
            skeleton.parents.push_back(0);
            skeleton.rest.translations.push_back(rest[m]);
            skin.joints.push_back(joint);
            skin.joint_from_mesh.push_back(affine_from(-rest[m], Quat(1, 0, 0, 0), Vec3(1)));
            sheet.translating.push_back(joint);
            markers.skin.first.push_back(static_cast<std::uint32_t>(m));
            markers.skin.joints.push_back(static_cast<std::uint16_t>(m));
            markers.skin.weights.push_back(1);
        }
        markers.skin.first.push_back(static_cast<std::uint32_t>(rest.size()));
        for (int f = 0; f < 3; ++f) {
            for (std::size_t m = 0; m < rest.size(); ++m) {
                sheet.translations.push_back(rest[m] + motion(m, static_cast<float>(f)));
            }
        }
        skeleton.rest.rotations.assign(rest.size() + 1, Quat(1, 0, 0, 0));
        skeleton.rest.scales.assign(rest.size() + 1, Vec3(1));
        ClipData clip;
        clip.duration = 0.2f;
        clip.sheets = {sheet};
        assets.skeletons = {skeleton};
        assets.skins = {skin};
        assets.clips = {clip};
        world.insert_resource(std::move(assets));
        // As a glTF file is spawned: the character, and its mesh below it.
        const Entity character = world.create(Skeleton{{0}}, ClipPlayer{{0}});
        surface = character;
        Deformed deformed;
        deformed.character = character;
        deformed.skin = {0};
        world.create(MeshInstance{{1}, {}}, deformed);
        SurfaceBinding binding;
        binding.surface = character;
        binding.method = SurfaceMethod::Patches;
        face = world.create(MeshInstance{{0}, {}}, binding);
    }

    std::vector<Vec3> shape_at(float time) {
        world.get<ClipPlayer>(surface).time = time;
        world.run(add_poses);
        world.run(add_surface_binding_states);
        world.run(bind_surfaces);
        world.run(update_poses);
        world.run(update_surface_bindings);
        const auto& state = world.get<SurfaceBindingState>(face);
        std::vector<Vec3> positions;
        CHECK(deform_positions(
            world.resource<Assets>().meshes[state.bound.index], world.get<Deformed>(face), nullptr,
            nullptr, nullptr, nullptr, positions, surface_shape(&state, state.patches)));
        return positions;
    }
};

}  // namespace

TEST_CASE(
    "markers: the mesh passes through each marker, in a frame and halfway to the next"
    * technique("face.mocap-drive")) {
    Take take;
    const std::vector<Vec3> start = take.shape_at(0);
    const MeshData& mesh = take.world.resource<Assets>().meshes[0];
    for (std::size_t v = 0; v < start.size(); ++v) {
        CHECK(glm::distance(start[v], mesh.positions[v]) < 1e-6f);
    }
    for (const float frame : {1.0f, 1.5f, 2.0f}) {
        const std::vector<Vec3> shape = take.shape_at(0.1f * frame);
        for (std::size_t m = 0; m < take.rest.size(); ++m) {
            const std::size_t v = m / 5 * 10 * 41 + m % 5 * 10;
            REQUIRE(mesh.positions[v] == take.rest[m]);
            CHECK(glm::distance(shape[v], take.rest[m] + Take::motion(m, frame)) < 1e-5f);
        }
    }
}

TEST_CASE(
    "markers: points between them move as well, without a jump between vertices"
    * technique("face.mocap-drive")) {
    Take take;
    const std::vector<Vec3> rest = take.shape_at(0);
    const std::vector<Vec3> shape = take.shape_at(0.2f);
    float most = 0.0f;
    for (std::size_t v = 0; v + 1 < shape.size(); ++v) {
        CHECK(glm::distance(shape[v], rest[v]) > 0.01f);
        if (v % 41 != 40) {
            most = std::max(most, glm::distance(shape[v + 1] - shape[v], rest[v + 1] - rest[v]));
        }
    }
    CHECK(most < 0.012f);  // neighboring markers, ten vertices apart, differ by up to 0.08
}

}  // namespace limn::surface_markers_test
