#include "systems/path_system.h"

#include <algorithm>
#include <cmath>

// Techniques: anim.arclength, anim.bezier-track

namespace limn {
namespace {

void place_on_path(const PathFollower& follower, const PathData& path, Transform& transform) {
    transform = transform_on_path(
        path_frame_at(path, follower.distance), follower.offset, follower.level, transform.scale);
}

const PathData* find_path(const Assets& assets, PathId id) {
    return id.index < assets.paths.size() ? &assets.paths[id.index] : nullptr;
}

}  // namespace

void update_path_followers(
    Query<PathFollower, Transform> followers, Res<const Assets> assets, Res<const FrameTime> time) {
    const auto step = static_cast<double>(time->step);
    followers.par_each([&assets = *assets, step](PathFollower& follower, Transform& transform) {
        const PathData* path = find_path(assets, follower.path);
        if (path == nullptr) {
            return;
        }
        const double length = path->length();
        double distance = follower.distance + static_cast<double>(follower.speed) * step;
        if (path->closed) {
            distance -= std::floor(distance / length)
                        * length;  // wrapped, so that precision does not degrade over time
        } else {
            distance = std::clamp(distance, 0.0, length);
        }
        follower.distance = distance;
        place_on_path(follower, *path, transform);
    });
}

void place_path_followers(
    Query<const PathFollower, Transform> followers, Res<const Assets> assets) {
    followers.each([&assets = *assets](const PathFollower& follower, Transform& transform) {
        if (const PathData* path = find_path(assets, follower.path)) {
            place_on_path(follower, *path, transform);
        }
    });
}

}  // namespace limn
