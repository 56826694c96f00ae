#pragma once

#include "ecs/components/camera_path.h"
#include "ecs/components/script.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"

namespace limn {

class World;

// The parts of a level that run by the clock: its events and the ways of its cameras.

/// Does what is due in this step. Exclusive, first in the frame: the systems behind it see the
/// world as the event left it. Without EventList or FrameTime nothing happens.
void run_events(World& world);

/// Puts every camera with a CameraPath where it belongs at the end of this step; before
/// update_transforms. A target is where it was at the end of the last step, and its position counts
/// as relative to the camera's parent: cameras that follow one should have none.
void update_camera_paths(
    Query<const CameraPath, Transform> cameras, Query<const WorldTransform> targets,
    Res<const FrameTime> time);

}  // namespace limn
