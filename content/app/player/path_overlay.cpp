#include "content/app/player/path_overlay.h"

#include "content/app/player/world_lines.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/path.h"
#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>

namespace limn {
namespace {

constexpr Vec3 kPathColor = {0.35f, 0.85f, 1.0f};
constexpr Vec3 kCameraColor = {1.0f, 0.75f, 0.3f};
constexpr int kLinesPerPart = 24;

void draw_path(WorldLines& lines, const PathData& path) {
    const std::size_t parts = path.segments.size();
    for (std::size_t part = 0; part < parts; ++part) {
        const double begin = path.begins[part];
        const double length = path.begins[part + 1] - path.begins[part];
        Vec3 last = path_frame_at(path, begin).position;
        lines.draw_point(
            last, 3.5f, part == 0 ? fmt::format("{} 0", path.name) : std::to_string(part));
        for (int i = 1; i <= kLinesPerPart; ++i) {
            const double along = begin + length * i / kLinesPerPart;
            const bool at_end = part + 1 == parts && i == kLinesPerPart;
            const Vec3 next = path_frame_at(path, at_end && path.closed ? 0.0 : along).position;
            lines.draw_line(last, next);
            last = next;
        }
        if (part + 1 == parts && !path.closed) {
            lines.draw_point(last, 3.5f, std::to_string(parts));
        }
    }
}

void draw_camera_path(WorldLines& lines, const CameraPath& path) {
    for (std::size_t key = 0; key < path.keys.size(); ++key) {
        lines.draw_point(path.keys[key].position, 3.5f, fmt::format("{} s", path.keys[key].time));
        if (key + 1 == path.keys.size()) {
            break;
        }
        const double begin = path.keys[key].time;
        const double length = path.keys[key + 1].time - path.keys[key].time;
        Vec3 last = path.keys[key].position;
        for (int i = 1; i <= kLinesPerPart; ++i) {
            const Vec3 next = camera_pose(path, begin + length * i / kLinesPerPart).position;
            lines.draw_line(last, next);
            last = next;
        }
    }
}

}  // namespace

bool has_paths(const World& world) {
    const auto* const assets = world.find_resource<Assets>();
    return (assets != nullptr && !assets->paths.empty())
           || !world.query<const CameraPath>().empty();
}

void draw_path_overlay(const RenderView& view, const World& world) {
    if (const auto* const assets = world.find_resource<Assets>()) {
        WorldLines lines(view, kPathColor);
        for (const PathData& path : assets->paths) {
            draw_path(lines, path);
        }
    }
    WorldLines lines(view, kCameraColor);
    world.query<const CameraPath>().each(
        [&](Entity, const CameraPath& path) { draw_camera_path(lines, path); });
}

}  // namespace limn
