#pragma once

#include "bench/oracles/skin_oracle.h"
#include "bench/oracles/skin_readback.h"
#include "ecs/base/rng.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "tests/render/scene_fixture.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace limn::test {

/// A tube of radius 0.2 about +y from 0 to `height`, open at both ends.
inline MeshData make_tube(int rings, int sectors, float height) {
    MeshData mesh;
    mesh.name = "tube";
    for (int i = 0; i <= rings; ++i) {
        const float y = height * static_cast<float>(i) / static_cast<float>(rings);
        for (int j = 0; j < sectors; ++j) {
            const float phi = 2 * kPi * static_cast<float>(j) / static_cast<float>(sectors);
            const Vec3 n = {std::sin(phi), 0, std::cos(phi)};
            mesh.positions.push_back(0.2f * n + Vec3(0, y, 0));
            mesh.normals.push_back(n);
            mesh.tangents.emplace_back(std::cos(phi), 0.0f, -std::sin(phi), 1.0f);
            mesh.uvs.emplace_back(phi, y);
        }
    }
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(i * sectors + j % sectors);
    };
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < sectors; ++j) {
            for (const std::uint32_t corner :
                 {index(i, j),
                  index(i, j + 1),
                  index(i + 1, j + 1),
                  index(i, j),
                  index(i + 1, j + 1),
                  index(i + 1, j)}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
    return mesh;
}

/// Each vertex follows `most` joints or fewer that are near its height, of `joints` spread over it.
inline void add_weights(MeshData& mesh, int joints, int most, Random& random) {
    mesh.skin = {};
    mesh.skin.first.push_back(0);
    for (const Vec3& p : mesh.positions) {
        const float share = (p.y - mesh.bounds.min.y) / (mesh.bounds.max.y - mesh.bounds.min.y);
        const int middle = static_cast<int>(share * static_cast<float>(joints - 1) + 0.5f);
        const int count = 1 + static_cast<int>(random.below(static_cast<std::uint32_t>(most)));
        std::vector<float> weights;
        float sum = 0;
        for (int i = 0; i < count; ++i) {
            weights.push_back(random.uniform(0.05f, 1.0f));
            sum += weights.back();
        }
        for (int i = 0; i < count; ++i) {
            const int joint =
                std::clamp(middle + (i + 1) / 2 * (i % 2 == 0 ? 1 : -1), 0, joints - 1);
            mesh.skin.joints.push_back(static_cast<std::uint16_t>(joint));
            mesh.skin.weights.push_back(weights[static_cast<std::size_t>(i)] / sum);
        }
        mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    }
}

/// Offsets at every `step`-th vertex, other ones for each target.
inline void
add_morphs(MeshData& mesh, int targets, std::uint32_t step, float size, Random& random) {
    for (int t = 0; t < targets; ++t) {
        MorphTarget& target = mesh.morphs.emplace_back();
        target.name = "target " + std::to_string(t);
        for (auto v = static_cast<std::uint32_t>(t) % step; v < mesh.positions.size(); v += step) {
            target.vertices.push_back(v);
            target.positions.push_back(size * random.direction());
            target.normals.push_back(0.3f * random.direction());
            target.tangents.push_back(0.3f * random.direction());
        }
    }
}

/// Joints `spacing` apart along +y, as they are when the mesh is bound to them.
inline SkinData make_chain(int joints, float spacing) {
    SkinData skin = {.name = "chain", .joints = {}, .joint_from_mesh = {}};
    for (int j = 0; j < joints; ++j) {
        skin.joints.push_back(static_cast<std::uint16_t>(j));
        skin.joint_from_mesh.push_back(at({0, -spacing * static_cast<float>(j), 0}));
    }
    return skin;
}

/// Every joint turned, moved and scaled a little relative to the one below.
inline std::vector<Affine>
random_joints(int joints, float spacing, float most_angle, bool scaled, Random& random) {
    std::vector<Affine> pose;
    Affine below;
    for (int j = 0; j < joints; ++j) {
        const Quat turn =
            rotation_about(random.direction(), random.uniform(-most_angle, most_angle));
        const Vec3 way = Vec3(0, j == 0 ? 0 : spacing, 0) + 0.02f * random.direction();
        const Affine joint = below * affine_from(way, turn, Vec3(1));
        const Vec3 scale = {
            random.uniform(0.5f, 1.6f), random.uniform(0.5f, 1.6f), random.uniform(0.5f, 1.6f)};
        pose.push_back(scaled ? joint * affine_from(Vec3(0), Quat(1, 0, 0, 0), scale) : joint);
        below = joint;
    }
    return pose;
}

/// Characters made by hand.
class SkinScene : public Scene {
  public:
    SkinId add_skin(SkinData skin) {
        auto& assets = world.resource<Assets>();
        assets.skins.push_back(std::move(skin));
        return {static_cast<std::uint32_t>(assets.skins.size() - 1)};
    }
    /// An entity that is its own character.
    Entity pose(
        MeshId mesh,
        MaterialId material,
        SkinId skin,
        Pose pose,
        Skinning skinning = Skinning::Linear) {
        const Entity entity = place(mesh, material, {});
        world.add(entity, std::move(pose));
        world.add(entity, Deformed{entity, skin, 0, skinning});
        return entity;
    }
    const MeshData& mesh_of(Entity entity) {
        return world.resource<Assets>().meshes[world.get<MeshInstance>(entity).mesh.index];
    }
    /// What the oracle says of an entity with its own pose.
    std::vector<oracle::SkinnedVertex> want(Entity entity, bool before = false) {
        const Deformed& deformed = world.get<Deformed>(entity);
        std::vector<glm::dmat4> matrices;
        if (deformed.skin.index != kNoAsset) {
            const Pose& its = world.get<Pose>(entity);
            matrices = oracle::skin_matrices(
                world.resource<Assets>().skins[deformed.skin.index],
                before ? its.previous : its.joints);
        }
        std::vector<float> weights;
        if (const auto* morphs = world.find<MorphWeights>(entity)) {
            weights = before ? morphs->previous : morphs->weights;
            weights.erase(weights.begin(), weights.begin() + deformed.first_morph);
        }
        return oracle::skin_vertices(mesh_of(entity), matrices, weights, deformed.skinning);
    }
};

/// Length of the diagonal of what the vertices stay within.
inline float size_of(const std::vector<Vec3>& positions) {
    Bounds box;
    for (const Vec3& p : positions) {
        grow(box, p);
    }
    return glm::length(box.max - box.min);
}

/// Largest distance from the oracle's positions, as a share of the box.
inline double
largest_error(const std::vector<Vec3>& got, const std::vector<oracle::SkinnedVertex>& want) {
    double largest = got.size() == want.size() ? 0.0 : INFINITY;
    for (std::size_t i = 0; i < got.size() && i < want.size(); ++i) {
        largest = std::max(largest, glm::distance(glm::dvec3(got[i]), want[i].position));
    }
    return largest / size_of(got);
}

}  // namespace limn::test
