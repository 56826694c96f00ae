#pragma once

#include "ecs/commands.h"
#include "ecs/components/animation.h"
#include "ecs/components/puppet.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/transform.h"
#include "ecs/query.h"
#include "ecs/resource.h"
#include "ecs/system.h"
#include "systems/animation/puppet/puppet_body.h"

namespace limn {

/// Adds PuppetState and PuppetBody to puppets that need them.
void add_puppet_states(
    Query<const Puppet, const Skeleton, Without<PuppetState>> states,
    Query<const Puppet, const Skeleton, Without<PuppetBody>> bodies, Commands commands);

/// Sends the poses that performers have now. After update_poses.
void send_performances(
    Query<const Puppet, const Skeleton, PuppetState, PuppetBody> puppets,
    Query<const Skeleton, const Pose, const Transform, Without<Puppet>> performers,
    Res<const Assets> assets, Res<const FrameTime> time, OptionalRes<const RandomSeed> seed);

/// Plays what has arrived in earlier steps; a puppet without packets is at rest. Before
/// update_poses.
void update_puppets(
    Query<const Puppet, const Skeleton, PuppetState, PuppetBody, Transform> puppets,
    Query<const Skeleton, Without<Puppet>> performers, Res<const Assets> assets,
    Res<const FrameTime> time);

/// One step of one puppet at the time `now` [s], without its performer: plays, filters, poses.
void step_puppet(
    const Puppet& puppet, const SkeletonData& skeleton, double now, float step, PuppetState& state,
    PuppetBody& body, Transform& transform);

}  // namespace limn
