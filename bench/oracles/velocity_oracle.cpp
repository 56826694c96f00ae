#include "bench/oracles/velocity_oracle.h"

#include "bench/oracles/skin_oracle.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace limn::oracle {

std::vector<glm::dvec3> corners_at(const World& world, Entity entity, double alpha) {
    const auto& assets = world.resource<Assets>();
    const auto* deformed = world.find<Deformed>(entity);
    std::vector<glm::dmat4> matrices;
    std::vector<float> weights;
    if (deformed != nullptr && deformed->skin.index != kNoAsset) {
        const auto& pose = world.get<Pose>(deformed->character);
        const SkinData& skin = assets.skins[deformed->skin.index];
        const std::vector<glm::dmat4> before = skin_matrices(skin, pose.previous);
        matrices = skin_matrices(skin, pose.joints);
        for (std::size_t j = 0; j < matrices.size(); ++j) {
            matrices[j] = before[j] + alpha * (matrices[j] - before[j]);
        }
    }
    const auto* morphs =
        deformed != nullptr ? world.find<MorphWeights>(deformed->character) : nullptr;
    for (std::size_t i = deformed != nullptr ? deformed->first_morph : 0;
         morphs != nullptr && i < morphs->weights.size(); ++i) {
        const double from = morphs->previous[i];
        weights.push_back(static_cast<float>(from + alpha * (double(morphs->weights[i]) - from)));
    }
    const Affine& now = world.get<WorldTransform>(entity).world;
    const auto* past = world.find<PreviousWorldTransform>(entity);
    const Affine& before = past != nullptr ? past->world : now;
    const Skinning skinning = deformed != nullptr ? deformed->skinning : Skinning::Linear;
    const MeshData& mesh = assets.meshes[world.get<MeshInstance>(entity).mesh.index];
    std::vector<glm::dvec3> corners;
    for (const SkinnedVertex& vertex : skin_vertices(mesh, matrices, weights, skinning)) {
        glm::dvec3& corner = corners.emplace_back();
        for (int r = 0; r < 3; ++r) {
            const glm::dvec4 from = before.row[r];
            const glm::dvec4 row = from + alpha * (glm::dvec4(now.row[r]) - from);
            corner[r] = glm::dot(row, glm::dvec4(vertex.position, 1));
        }
    }
    return corners;
}

VelocityOracle::VelocityOracle(const CameraMotion& motion)
    : motion_(motion), eye_(eye_at(motion.alpha)), previous_eye_(eye_at(motion.previous_alpha)) {}

VelocityOracle::Eye VelocityOracle::eye_at(double alpha) const {
    const auto column = [&](int c) {
        glm::dvec3 mixed;
        for (int r = 0; r < 3; ++r) {
            const double from = motion_.previous.row[r][c];
            mixed[r] = from + alpha * (double(motion_.current.row[r][c]) - from);
        }
        return mixed;
    };
    Eye eye;
    eye.position = column(3);
    eye.back = glm::normalize(column(2));
    eye.right = glm::normalize(glm::cross(column(1), eye.back));
    eye.up = glm::cross(eye.back, eye.right);
    return eye;
}

glm::dvec3 VelocityOracle::ray(const Eye& eye, double x, double y) const {
    const double half = std::tan(0.5 * double(motion_.camera.fov_y));
    const double px = 2 * half / motion_.height;  // square pixels
    const double right = (x - 0.5 * motion_.width) * px;
    const double down = (y - 0.5 * motion_.height) * px;
    return right * eye.right - down * eye.up - eye.back;
}

glm::dvec2 VelocityOracle::project(const Eye& eye, const glm::dvec3& direction) const {
    const double half = std::tan(0.5 * double(motion_.camera.fov_y));
    const double scale = motion_.height / (2 * half * glm::dot(direction, -eye.back));
    return {scale * glm::dot(direction, eye.right), -scale * glm::dot(direction, eye.up)};
}

void VelocityOracle::add(const World& world) {
    const auto& meshes = world.resource<Assets>().meshes;
    world.query<const MeshInstance>().each([&](Entity entity, const MeshInstance& instance) {
        const std::vector<glm::dvec3> now = corners_at(world, entity, motion_.alpha);
        const std::vector<glm::dvec3> before = corners_at(world, entity, motion_.previous_alpha);
        for (const std::uint32_t i : meshes[instance.mesh.index].indices) {
            corners_.push_back(now[i]);
            previous_corners_.push_back(before[i]);
        }
    });
}

std::optional<PixelMotion> VelocityOracle::at(double x, double y) const {
    const glm::dvec3 direction = ray(eye_, x, y);
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<PixelMotion> found;
    for (std::size_t i = 0; i < corners_.size(); i += 3) {
        const glm::dvec3 a = corners_[i] - eye_.position;
        const glm::dvec3 e1 = corners_[i + 1] - corners_[i];
        const glm::dvec3 e2 = corners_[i + 2] - corners_[i];
        // a + u e1 + v e2 = t direction, by Cramer's rule.
        const glm::dvec3 across = glm::cross(direction, e2);
        const double det = glm::dot(e1, across);
        if (det == 0) {
            continue;
        }
        const double u = glm::dot(-a, across) / det;
        const glm::dvec3 q = glm::cross(-a, e1);
        const double v = glm::dot(direction, q) / det;
        const double t = glm::dot(e2, q) / det;
        if (u < 0 || v < 0 || u + v > 1 || t < double(motion_.camera.near) || t >= nearest) {
            continue;
        }
        nearest = t;
        const glm::dvec3 was = previous_corners_[i]
                               + u * (previous_corners_[i + 1] - previous_corners_[i])
                               + v * (previous_corners_[i + 2] - previous_corners_[i]);
        found = PixelMotion{
            t, project(eye_, t * direction) - project(previous_eye_, was - previous_eye_.position)};
    }
    return found;
}

glm::dvec2 VelocityOracle::sky(double x, double y) const {
    const glm::dvec3 direction = ray(eye_, x, y);
    return project(eye_, direction) - project(previous_eye_, direction);
}

}  // namespace limn::oracle
