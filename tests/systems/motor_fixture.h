#pragma once

#include "ecs/components/all.h"
#include "ecs/components/motor.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/components/water.h"
#include "systems/update_world.h"

#include <array>
#include <utility>
#include <vector>

namespace limn::test {

/// Appends a box with sides facing outward.
inline void add_box(MeshData& mesh, const Vec3& low, const Vec3& high) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < 8; ++i) {
        mesh.positions.emplace_back(
            (i & 1) != 0 ? high.x : low.x, (i & 2) != 0 ? high.y : low.y,
            (i & 4) != 0 ? high.z : low.z);
    }
    constexpr std::array<std::uint32_t, 36> kIndices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6,
                                                        0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3,
                                                        0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    for (const std::uint32_t i : kIndices) {
        mesh.indices.push_back(first + i);
    }
}

inline MeshData make_box_mesh(const Vec3& low, const Vec3& high) {
    MeshData mesh;
    add_box(mesh, low, high);
    return mesh;
}

/// A plane y = 0 to walk on, and what is added.
struct MotorStage {
    World world;
    Schedule schedule = make_world_schedule();
    Entity person;

    explicit MotorStage(
        std::vector<MeshData> meshes = {}, const Transform& at = {},
        const CharacterMotor& motor = {}) {
        register_all_components();
        Assets assets;
        assets.meshes = std::move(meshes);
        const auto count = static_cast<std::uint32_t>(assets.meshes.size());
        world.insert_resource(std::move(assets));
        world.create(Transform{}, Walkable{});
        for (std::uint32_t i = 0; i < count; ++i) {
            world.create(Transform{}, MeshInstance{.mesh = {i}, .material = {}}, Walkable{});
        }
        person = world.create(at, motor, MoveIntent{});
    }
    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            step_world(world, schedule);
        }
    }
    void go(const Vec3& velocity) { world.get<MoveIntent>(person).velocity = velocity; }
    [[nodiscard]] Vec3 feet() { return world.get<const Transform>(person).position; }
    [[nodiscard]] const MotorState& state() { return world.get<const MotorState>(person); }
};

}  // namespace limn::test
