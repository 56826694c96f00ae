#include "systems/animation/surface_faces.h"

#include "ecs/base/check.h"
#include "ecs/base/jobs.h"
#include "ecs/base/triangle.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

// Techniques: face.soffd

namespace limn {
namespace {

constexpr std::size_t kFaceGrain = 64;  ///< points per task
/// Area of a face over the square of its longest edge below which it has no frame.
constexpr float kMinShape = 1e-6f;

Mat3 axes_of(const Affine& a) {
    return glm::transpose(Mat3(Vec3(a.row[0]), Vec3(a.row[1]), Vec3(a.row[2])));
}

Affine affine_of(const Mat3& axes, const Vec3& origin) {
    const Mat3 rows = glm::transpose(axes);
    return {{Vec4(rows[0], origin.x), Vec4(rows[1], origin.y), Vec4(rows[2], origin.z)}};
}

Affine inverse_of(const Affine& a) {
    const Mat3 inverse = glm::inverse(axes_of(a));
    return affine_of(inverse, -(inverse * transform_point(a, Vec3(0))));
}

/// A face and its ball, which bounds its distance from below.
struct FaceBall {
    Vec3 corner[3];
    Vec3 center;
    float radius;
    Vec3 normal;  ///< unit
};

std::vector<FaceBall>
make_balls(std::span<const Vec3> positions, std::span<const std::uint32_t> corners) {
    std::vector<FaceBall> balls;
    for (std::size_t i = 0; i + 3 <= corners.size(); i += 3) {
        FaceBall ball{
            {positions[corners[i]], positions[corners[i + 1]], positions[corners[i + 2]]},
            Vec3(0),
            0.0f,
            Vec3(0)};
        ball.center = (ball.corner[0] + ball.corner[1] + ball.corner[2]) / 3.0f;
        for (const Vec3& corner : ball.corner) {
            ball.radius = std::max(ball.radius, glm::distance(ball.center, corner));
        }
        ball.normal = normalize_or(
            glm::cross(ball.corner[1] - ball.corner[0], ball.corner[2] - ball.corner[0]), Vec3(0));
        balls.push_back(ball);
    }
    return balls;
}

float mean_edge(const std::vector<FaceBall>& balls) {
    double sum = 0;
    for (const FaceBall& ball : balls) {
        for (int k = 0; k < 3; ++k) {
            sum += static_cast<double>(glm::distance(ball.corner[k], ball.corner[(k + 1) % 3]));
        }
    }
    return static_cast<float>(sum / (3.0 * static_cast<double>(balls.size())));
}

struct Near {
    float distance = 0.0f;
    std::uint16_t face = 0;
    bool operator<(const Near& other) const {
        return distance != other.distance ? distance < other.distance : face < other.face;
    }
};

/// The `count` nearest faces, nearest first. A face that faces away from `normal`, or from nothing
/// if that is 0, is up to `away` farther.
void find_nearest(
    const Vec3& p, const Vec3& normal, float away, const std::vector<FaceBall>& balls,
    std::size_t count, std::vector<Near>& nearest) {
    nearest.clear();
    for (std::size_t f = 0; f < balls.size(); ++f) {
        const FaceBall& ball = balls[f];
        const bool full = nearest.size() == count;
        if (full && glm::distance(p, ball.center) - ball.radius > nearest.back().distance) {
            continue;
        }
        const float distance =
            distance_to_triangle(p, ball.corner[0], ball.corner[1], ball.corner[2]);
        const float turned =
            normal != Vec3(0) ? 0.5f * (1.0f - glm::dot(normal, ball.normal)) : 0.0f;
        const Near found = {
            std::sqrt(square(distance) + square(away * turned)), static_cast<std::uint16_t>(f)};
        if (full && !(found < nearest.back())) {
            continue;
        }
        if (full) {
            nearest.pop_back();
        }
        nearest.insert(std::upper_bound(nearest.begin(), nearest.end(), found), found);
    }
}

using Influences = std::vector<std::pair<std::uint16_t, float>>;

/// `nearest` has one more face than may have influence, if there is one.
Influences weigh(const std::vector<Near>& nearest, std::size_t count, float unit, float locality) {
    const auto weight = [&](const Near& face) {
        return face_weight(face.distance / unit, locality);
    };
    const std::size_t kept = std::min(count, nearest.size());
    const float rest = nearest.size() > count ? weight(nearest[count]) : 0.0f;
    Influences influences;
    float sum = 0.0f;
    for (std::size_t i = 0; i < kept; ++i) {
        influences.emplace_back(nearest[i].face, weight(nearest[i]) - rest);
        sum += influences.back().second;
    }
    if (!(sum > 0.0f)) {  // all at the distance of the dropped face
        for (auto& influence : influences) {
            influence.second = 1.0f;
        }
        sum = static_cast<float>(kept);
    }
    for (auto& influence : influences) {
        influence.second /= sum;
    }
    std::erase_if(influences, [](const auto& influence) { return !(influence.second > 1e-6f); });
    return influences;
}

}  // namespace

Affine face_frame(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = glm::cross(b - a, c - a);
    const float length = glm::length(normal);
    return affine_of(Mat3(b - a, c - a, length > 0.0f ? normal / std::sqrt(length) : Vec3(0)), a);
}

float face_weight(float distance, float locality) {
    return 1.0f / (1.0f + std::pow(distance, locality));
}

std::vector<std::uint32_t>
faces_with_area(std::span<const Vec3> positions, std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i + 3 <= indices.size(); i += 3) {
        const Vec3 a = positions[indices[i]];
        const Vec3 b = positions[indices[i + 1]];
        const Vec3 c = positions[indices[i + 2]];
        const float longest =
            std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        if (glm::length(glm::cross(b - a, c - a)) > kMinShape * square(longest)) {
            corners.insert(corners.end(), {indices[i], indices[i + 1], indices[i + 2]});
        }
    }
    return corners;
}

SkinWeights bind_to_faces(
    std::span<const Vec3> points, std::span<const Vec3> normals, std::span<const Vec3> positions,
    std::span<const std::uint32_t> corners, float locality, std::size_t count) {
    LIMN_CHECK(normals.empty() || normals.size() == points.size());
    LIMN_CHECK(corners.size() >= 3 && corners.size() <= std::size_t{3} * 65536 && count > 0);
    const std::vector<FaceBall> balls = make_balls(positions, corners);
    const float unit = mean_edge(balls);
    std::vector<Influences> all(points.size());
    parallel_for(points.size(), kFaceGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<Near> nearest;
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 normal = normals.empty() ? Vec3(0) : normals[i];
            find_nearest(points[i], normal, kAway * unit, balls, count + 1, nearest);
            all[i] = weigh(nearest, count, unit, locality);
        }
    });
    SkinWeights skin;
    for (const Influences& influences : all) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        for (const auto& [face, weight] : influences) {
            skin.joints.push_back(face);
            skin.weights.push_back(weight);
        }
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    return skin;
}

SkinData make_face_skin(std::span<const Vec3> positions, std::span<const std::uint32_t> corners) {
    SkinData skin;
    skin.name = "faces";
    std::vector<Affine> frames(corners.size() / 3);
    compute_face_frames(positions, corners, frames);
    for (std::size_t f = 0; f < frames.size(); ++f) {
        skin.joints.push_back(static_cast<std::uint16_t>(f));
        skin.joint_from_mesh.push_back(inverse_of(frames[f]));
    }
    return skin;
}

void compute_face_frames(
    std::span<const Vec3> positions, std::span<const std::uint32_t> corners,
    std::span<Affine> frames) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
        frames[f] = face_frame(
            positions[corners[3 * f]], positions[corners[3 * f + 1]],
            positions[corners[3 * f + 2]]);
    }
}

}  // namespace limn
