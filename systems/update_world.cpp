#include "systems/update_world.h"

#include "ecs/components/input.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "systems/animation/clip_player_system.h"
#include "systems/animation/pose_system.h"
#include "systems/autofocus_system.h"
#include "systems/env_probe_system.h"
#include "systems/fly_camera_system.h"
#include "systems/lens_control_system.h"
#include "systems/orbit_camera_system.h"
#include "systems/path_system.h"
#include "systems/racer_system.h"
#include "systems/ripple_system.h"
#include "systems/script_system.h"
#include "systems/spin_system.h"
#include "systems/sway_system.h"
#include "systems/transform_system.h"
#include "systems/water/buoyancy_system.h"
#include "systems/water/ocean_system.h"
#include "systems/water/sailing_system.h"
#include "systems/water/walker_system.h"
#include "systems/water/water_noise_system.h"
#include "systems/water/water_ripple_system.h"
#include "systems/water/water_spray_system.h"
#include "systems/water/water_stone_system.h"
#include "systems/water/water_touch.h"
#include "systems/water/water_wake_system.h"
#include "systems/water/water_wave_system.h"
#include "systems/water/weather_system.h"

namespace limn {

Schedule make_world_schedule() {
    Schedule schedule;
    schedule.add<run_events>();  // first: everything else sees what the level wants now
    schedule.add<add_world_transforms>();
    schedule.add<add_env_probe_states>();
    schedule.add<add_poses>();
    schedule.add<add_ripple_states>();
    schedule.add<add_touch_parts>();
    schedule.add<add_wave_tables>();
    schedule.add<add_noise_fields>();
    schedule.add<add_spray_drops>();
    schedule.add<add_ocean_states>();
    schedule.sync();
    schedule.add<update_weather>();
    schedule.add<update_spins>();
    schedule.add<update_sways>();
    schedule.add<update_ripples>();
    schedule.add<update_path_followers>();
    schedule.add<update_racers>();
    schedule.add<age_wave_packets>();
    schedule.add<update_noise_surfaces>();
    schedule.add<emit_wakes>();        // after ages: new rings are as old as they are
    schedule.add<fill_wave_tables>();  // after ages
    schedule.add<update_oceans>();
    schedule.add<update_ocean_foam>();   // after oceans: where they break now
    schedule.add<update_speed_views>();  // after racers: as fast as they are now
    schedule.add<update_camera_paths>();
    schedule.add<update_fly_cameras>();
    schedule.add<advance_clips>();
    schedule.add<update_poses>();            // after clips: shows their new moment
    schedule.add<update_attachments>();      // after poses: hangs on the joints
    schedule.add<update_spray>();            // after all that moves water
    schedule.add<throw_stones>();            // after all that moves water: meets it as it is now
    schedule.add<update_sailboats>();        // after all that moves water
    schedule.add<update_floating_bodies>();  // after sailboats, which push theirs
    schedule.add<turn_booms>();
    schedule.add<update_walkers>();     // after all that moves water: wades in it as it is now
    schedule.add<update_transforms>();  // after all that move things: rendering reads the matrices
    schedule.add<update_water_ripples>();  // after transforms: bodies push where they are now
    schedule.add<update_env_probes>();     // after transforms: looks around from where it is now
    schedule.add<update_orbit_cameras>();  // after transforms: needs where its target is now
    schedule.add<update_autofocus>();      // after all cameras stand where they are seen from
    schedule.add<turn_lenses>();           // last: has the whole world
    return schedule;
}

namespace {

template <typename T>
T& resource_or_default(World& world) {
    T* found = world.find_resource<T>();
    return found != nullptr ? *found : world.insert_resource(T{});
}

}  // namespace

void start_world(World& world) {
    resource_or_default<FrameTime>(world);
    resource_or_default<RandomSeed>(world);
    resource_or_default<Input>(world);
    resource_or_default<Assets>(world);
    world.run(update_weather);
    world.run(update_sways);
    world.run(place_path_followers);
    world.run(place_racers);
    world.run(update_camera_paths);
    world.run(add_poses);
    world.run(update_poses);
    world.run(update_attachments);
    world.run(add_ocean_states);
    world.run(update_oceans);
    world.run(add_world_transforms);
    world.run(update_transforms);
    world.run(add_env_probe_states);
    world.run(add_ripple_states);
    world.run(add_touch_parts);
    world.run(add_wave_tables);
    world.run(fill_wave_tables);
    world.run(add_noise_fields);
    world.run(update_noise_surfaces);
    world.run(update_env_probes);
    world.run(update_orbit_cameras);
    world.run(update_autofocus);
}

void step_world(World& world, Schedule& schedule) {
    resource_or_default<RandomSeed>(world);
    resource_or_default<Input>(world);
    resource_or_default<Assets>(world);
    FrameTime& time = resource_or_default<FrameTime>(world);
    if (time.time > 0) {
        ++time.frame;
    }
    time.time = static_cast<double>(time.frame + 1) * static_cast<double>(time.step);
    schedule.run(world);
}

}  // namespace limn
