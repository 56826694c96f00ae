#include "content/make/models/sweep.h"

#include "content/make/models/surface_grid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace limn {
namespace {

constexpr int kMaxRows = 1 << 16;

/// A point of the profile with its normal; duplicated at a sharp edge.
struct ProfileVertex {
    Vec2 position;
    Vec2 normal;
    float along = 0;  ///< arc length along the profile [m]
};
/// A part of the profile without sharp edges inside.
using ProfileRun = std::vector<ProfileVertex>;

struct SweepFrame {
    Vec3 position;
    Vec3 right;
    Vec3 up;
    float distance = 0;  ///< [m]
};

Vec2 left_of(const Vec2& direction) {
    const float length = glm::length(direction);
    return length > 0.0f ? Vec2(-direction.y, direction.x) / length : Vec2(0, 1);
}

std::vector<Vec2> profile_points(const SweepShape& shape) {
    if (!(shape.radius > 0.0f)) {
        return shape.profile;
    }
    std::vector<Vec2> circle;
    for (int i = 0; i < shape.segments; ++i) {
        // Clockwise looking along the path, so that it faces outwards.
        const float angle =
            -2.0f * kPi * static_cast<float>(i) / static_cast<float>(shape.segments);
        circle.push_back(shape.radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return circle;
}

bool is_closed(const SweepShape& shape) {
    return shape.closed || shape.radius > 0.0f;
}

/// Splits the profile at sharp edges.
std::vector<ProfileRun> cut_profile(const SweepShape& shape, const std::vector<Vec2>& points) {
    const std::size_t count = points.size();
    const std::size_t edges = is_closed(shape) ? count : count - 1;
    std::vector<Vec2> normals;
    for (std::size_t i = 0; i < edges; ++i) {
        normals.push_back(left_of(points[(i + 1) % count] - points[i]));
    }
    // Whether the corner between two edges with these normals is smooth.
    const float min_cosine = std::cos(shape.radius > 0.0f ? kPi : shape.crease);
    const auto smooth = [&](const Vec2& before, const Vec2& after) {
        return glm::dot(before, after) >= min_cosine;
    };
    const auto mean = [](const Vec2& a, const Vec2& b) {
        const Vec2 sum = a + b;
        const float length = glm::length(sum);
        return length > 1e-6f ? sum / length : a;
    };
    std::vector<ProfileRun> runs;
    float along = 0.0f;
    for (std::size_t i = 0; i < edges; ++i) {
        const Vec2& normal = normals[i];
        const bool has_before = i > 0 || is_closed(shape);
        const Vec2& before = normals[(i + edges - 1) % edges];
        const bool joins = has_before && smooth(before, normal);
        if (i == 0 || !joins) {
            runs.emplace_back();
            runs.back().push_back({points[i], joins ? mean(before, normal) : normal, along});
        }
        along += glm::length(points[(i + 1) % count] - points[i]);
        const bool has_after = i + 1 < edges || is_closed(shape);
        const Vec2& after = normals[(i + 1) % edges];
        runs.back().push_back(
            {points[(i + 1) % count],
             has_after && smooth(normal, after) ? mean(normal, after) : normal, along});
    }
    return runs;
}

/// Frames along the path between the distances `from` and `to` [m].
std::vector<SweepFrame>
find_frames(const SweepShape& shape, const PathData& path, float from, float to) {
    const float wanted = std::ceil((to - from) / std::max(shape.step, 1e-3f));
    const int rows = std::clamp(static_cast<int>(std::min(wanted, 1e6f)), 1, kMaxRows);
    std::vector<SweepFrame> frames;
    for (int i = 0; i <= rows; ++i) {
        const float fraction = static_cast<float>(i) / static_cast<float>(rows);
        const float distance = i == rows ? to : from + fraction * (to - from);
        const PathFrame frame = path_frame_at(path, distance);
        frames.push_back({frame.position, glm::cross(frame.ahead, frame.up), frame.up, distance});
        if (shape.upright || i == 0) {
            continue;
        }
        // Double reflection (W. Wang et al., "Computation of Rotation Minimizing Frames", 2008):
        // reflect from row to row, then onto the new direction.
        const SweepFrame& last = frames[frames.size() - 2];
        const Vec3 last_ahead = glm::cross(last.up, last.right);
        const Vec3 direction = frame.position - last.position;
        const float squared = glm::dot(direction, direction);
        const auto mirror = [](const Vec3& v, const Vec3& across, float length) {
            return length > 0.0f ? v - across * (2.0f * glm::dot(across, v) / length) : v;
        };
        const Vec3 up = mirror(last.up, direction, squared);
        const Vec3 turn = frame.ahead - mirror(last_ahead, direction, squared);
        frames.back().up = glm::normalize(mirror(up, turn, glm::dot(turn, turn)));
        frames.back().right = glm::cross(frame.ahead, frames.back().up);
    }
    return frames;
}

/// A flat end cap: a fan about the centroid of the profile.
void append_cap(
    MeshData& mesh, const std::vector<Vec2>& points, const SweepFrame& frame, bool is_front) {
    const Vec3 ahead = glm::cross(frame.up, frame.right);
    const Vec3 normal = is_front ? ahead : -ahead;
    const Vec3 tangent = is_front ? -frame.right : frame.right;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    Vec2 centroid = {0, 0};
    for (const Vec2& point : points) {
        centroid += point / static_cast<float>(points.size());
    }
    const auto add = [&](const Vec2& point) {
        mesh.positions.push_back(frame.position + frame.right * point.x + frame.up * point.y);
        mesh.normals.push_back(normal);
        mesh.tangents.emplace_back(tangent, 1.0f);
        mesh.uvs.emplace_back(is_front ? -point.x : point.x, -point.y);
    };
    add(centroid);
    for (const Vec2& point : points) {
        add(point);
    }
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = first + 1 + i;
        const std::uint32_t b = first + 1 + (i + 1) % count;
        // Profiles run clockwise looking along the path.
        mesh.indices.insert(mesh.indices.end(), {first, is_front ? a : b, is_front ? b : a});
    }
}

void append_piece(
    MeshData& mesh, const SweepShape& shape, const std::vector<Vec2>& points,
    const std::vector<ProfileRun>& runs, const std::vector<SweepFrame>& frames, bool ends) {
    const int rows = static_cast<int>(frames.size()) - 1;
    for (const ProfileRun& run : runs) {
        const int columns = static_cast<int>(run.size()) - 1;
        append_grid(mesh, columns, rows, {}, [&](int i, int j) {
            const ProfileVertex& vertex = run[static_cast<std::size_t>(i)];
            const SweepFrame& frame = frames[static_cast<std::size_t>(rows - j)];
            const Vec2 along = {vertex.normal.y, -vertex.normal.x};
            return GridVertex{
                frame.position + frame.right * vertex.position.x + frame.up * vertex.position.y,
                frame.right * vertex.normal.x + frame.up * vertex.normal.y,
                frame.right * along.x + frame.up * along.y,
                {vertex.along, frames.back().distance - frame.distance}};
        });
    }
    if (ends && shape.caps && is_closed(shape) && points.size() >= 3) {
        append_cap(mesh, points, frames.front(), false);
        append_cap(mesh, points, frames.back(), true);
    }
}

PathData straight_path() {
    PathShape shape;
    shape.knots.resize(2);
    shape.knots[1].position = {0, 0, 10};
    return *make_path(shape);
}

}  // namespace

MeshData make_sweep(const SweepShape& shape, const Assets& assets) {
    const PathData path =
        shape.path.index < assets.paths.size() ? assets.paths[shape.path.index] : straight_path();
    MeshData mesh;
    const std::vector<Vec2> points = profile_points(shape);
    if (points.size() < 2) {
        return mesh;
    }
    const std::vector<ProfileRun> runs = cut_profile(shape, points);
    const float begin = std::min(shape.begin, path.length());
    const float end = shape.end > begin ? std::min(shape.end, path.length()) : path.length();
    const bool whole = path.closed && begin == 0.0f && end == path.length();
    if (!(shape.dash > 0.0f)) {
        append_piece(mesh, shape, points, runs, find_frames(shape, path, begin, end), !whole);
        return mesh;
    }
    const float period = std::max(shape.dash + shape.gap, 1e-3f * path.length());
    for (float at = begin; at < end; at += period) {
        const float to = std::min(at + shape.dash, end);
        append_piece(mesh, shape, points, runs, find_frames(shape, path, at, to), true);
    }
    return mesh;
}

}  // namespace limn
