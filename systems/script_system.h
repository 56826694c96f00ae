#pragma once

#include "ecs/components/camera_path.h"
#include "ecs/components/input.h"
#include "ecs/components/script.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"

namespace limn {

class World;

// The timed parts of a level: its events and camera paths.

/// Executes the events due in this step. Exclusive, first in the frame: all other systems see their
/// result. Does nothing without EventList or FrameTime.
void run_events(World& world);

/// At the end of a step: what is pressed now was pressed before the next.
void keep_input(Res<Input> input);

/// Destroys the entities whose Lifetime is over. Exclusive, after run_events.
void end_lifetimes(World& world);

/// Moves every camera with a CameraPath to its pose at the end of this step; before
/// update_transforms. Uses the target's position of the previous step, taken as relative to the
/// camera's parent: cameras with a target should have no parent.
void update_camera_paths(
    Query<const CameraPath, Transform> cameras, Query<const WorldTransform> targets,
    Res<const FrameTime> time, OptionalRes<StepJumps> jumps);

}  // namespace limn
