#include "bench/oracles/skin_shapes.h"

#include "ecs/base/rotation.h"

#include <algorithm>

namespace limn::oracle {

MeshData make_tube(int rings, int sectors, float height) {
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
                 {index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i, j),
                  index(i + 1, j + 1), index(i + 1, j)}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    for (const Vec3& p : mesh.positions) {
        grow(mesh.bounds, p);
    }
    return mesh;
}

void add_weights(MeshData& mesh, int joints, int max_influences, Random& random) {
    mesh.skin = {};
    mesh.skin.first.push_back(0);
    for (const Vec3& p : mesh.positions) {
        const float height = (p.y - mesh.bounds.min.y) / (mesh.bounds.max.y - mesh.bounds.min.y);
        const int nearest = static_cast<int>(height * static_cast<float>(joints - 1) + 0.5f);
        const int count =
            1 + static_cast<int>(random.below(static_cast<std::uint32_t>(max_influences)));
        std::vector<float> weights;
        float sum = 0;
        for (int i = 0; i < count; ++i) {
            weights.push_back(random.uniform(0.05f, 1.0f));
            sum += weights.back();
        }
        for (int i = 0; i < count; ++i) {
            const int joint =
                std::clamp(nearest + (i + 1) / 2 * (i % 2 == 0 ? 1 : -1), 0, joints - 1);
            mesh.skin.joints.push_back(static_cast<std::uint16_t>(joint));
            mesh.skin.weights.push_back(weights[static_cast<std::size_t>(i)] / sum);
        }
        mesh.skin.first.push_back(static_cast<std::uint32_t>(mesh.skin.joints.size()));
    }
}

void add_morphs(MeshData& mesh, int targets, std::uint32_t step, float size, Random& random) {
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

SkinData make_chain(int joints, float spacing) {
    SkinData skin = {.name = "chain", .joints = {}, .joint_from_mesh = {}};
    for (int j = 0; j < joints; ++j) {
        skin.joints.push_back(static_cast<std::uint16_t>(j));
        skin.joint_from_mesh.push_back(
            affine_from({0, -spacing * static_cast<float>(j), 0}, {1, 0, 0, 0}, Vec3(1)));
    }
    return skin;
}

std::vector<Affine>
random_joints(int joints, float spacing, float max_angle, bool scaled, Random& random) {
    std::vector<Affine> pose;
    Affine below;
    for (int j = 0; j < joints; ++j) {
        const Quat turn = rotation_about(random.direction(), random.uniform(-max_angle, max_angle));
        const Vec3 offset = Vec3(0, j == 0 ? 0 : spacing, 0) + 0.02f * random.direction();
        const Affine joint = below * affine_from(offset, turn, Vec3(1));
        const Vec3 scale = {
            random.uniform(0.5f, 1.6f), random.uniform(0.5f, 1.6f), random.uniform(0.5f, 1.6f)};
        pose.push_back(scaled ? joint * affine_from(Vec3(0), Quat(1, 0, 0, 0), scale) : joint);
        below = joint;
    }
    return pose;
}

}  // namespace limn::oracle
