#include "systems/update_world.h"

#include "ecs/components/input.h"
#include "ecs/components/step_jumps.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/components/weather.h"
#include "systems/animation/clip_player_system.h"
#include "systems/animation/crowd_pose_system.h"
#include "systems/animation/deformer_system.h"
#include "systems/animation/driven_shapes_system.h"
#include "systems/animation/graph/graph_edit_system.h"
#include "systems/animation/graph/motion_graph_system.h"
#include "systems/animation/ik/foot_ground_system.h"
#include "systems/animation/ik/ik_goal_system.h"
#include "systems/animation/key_track_system.h"
#include "systems/animation/matching/motion_match_system.h"
#include "systems/animation/pose_keys_system.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/puppet/puppet_system.h"
#include "systems/animation/ragdoll/ragdoll_system.h"
#include "systems/animation/rotation_track_system.h"
#include "systems/animation/surface_binding_system.h"
#include "systems/animation/twist_joint_system.h"
#include "systems/animation/walk/crowd_script_system.h"
#include "systems/animation/walk/crowd_walk_system.h"
#include "systems/animation/walk/motor_pose_system.h"
#include "systems/animation/walk/walk_system.h"
#include "systems/attach_system.h"
#include "systems/autofocus_system.h"
#include "systems/characters/hero_system.h"
#include "systems/characters/loose_body_system.h"
#include "systems/characters/motor_system.h"
#include "systems/crowd/crowd_system.h"
#include "systems/crowd/crowd_visit_system.h"
#include "systems/crowd/flock_system.h"
#include "systems/env_probe_system.h"
#include "systems/faces/skin_pull_system.h"
#include "systems/faces/wrinkle_ladder_system.h"
#include "systems/faces/wrinkle_response_system.h"
#include "systems/faces/wrinkle_system.h"
#include "systems/faces/wrinkle_track_system.h"
#include "systems/fly_camera_system.h"
#include "systems/lens_control_system.h"
#include "systems/light/light_map_system.h"
#include "systems/light/sunlight_system.h"
#include "systems/mesh_level_system.h"
#include "systems/orbit_camera_system.h"
#include "systems/particles/beam_system.h"
#include "systems/particles/billboard_system.h"
#include "systems/particles/emitter_restart.h"
#include "systems/particles/gpu_particle_system.h"
#include "systems/particles/gpu_shapes.h"
#include "systems/particles/height_image_system.h"
#include "systems/particles/particle_balls_system.h"
#include "systems/particles/particle_mesh_system.h"
#include "systems/particles/particle_obstacles.h"
#include "systems/particles/particle_system.h"
#include "systems/particles/point_mass_system.h"
#include "systems/particles/trail_system.h"
#include "systems/path_system.h"
#include "systems/relief_box_system.h"
#include "systems/ripple_system.h"
#include "systems/script_system.h"
#include "systems/spin_system.h"
#include "systems/sway_system.h"
#include "systems/transform_system.h"
#include "systems/water/buoyancy_system.h"
#include "systems/water/ocean_system.h"
#include "systems/water/shoaling_system.h"
#include "systems/water/water_noise_system.h"
#include "systems/water/water_ripple_system.h"
#include "systems/water/water_spray_system.h"
#include "systems/water/water_touch.h"
#include "systems/water/water_wake_system.h"
#include "systems/water/water_wave_system.h"
#include "systems/water/weather_system.h"

#include <algorithm>
#include <iterator>

// Techniques: engine.animate, engine.main-loop, engine.object-step

namespace limn {

using enum Phase;
using enum When;

void add_object_systems(SystemList& systems) {
    systems.add<run_events>(Events);
    systems.add<end_lifetimes>(Events);
    systems.add<add_world_transforms>(Create);
    systems.add<add_env_probe_states>(Create, Both);
    systems.add<add_relief_box_states>(Create, Both);
    systems.add<add_light_map_states>(Create, Both);
    systems.add<update_attach>(Create, Both);
    systems.add<update_spins>(Move);
    systems.add<update_sways>(Move, Both);
    systems.add<update_ripples>(Move);
    systems.add<place_path_followers>(Move, AtStart);
    systems.add<update_path_followers>(Move);
    systems.add<add_world_transforms>(
        Place, AtStart);  // so late: until then nothing has a world transform
    systems.add<update_transforms>(Place, Both);
    systems.add<keep_input>(View);
    systems.add<update_env_probes>(Follow, Both);  // captures from the current position
    systems.add<update_sunlight>(Follow, Both);    // after everything that moves lights
    systems.add<update_light_maps>(Follow, Both);  // likewise
}

void add_animation_systems(SystemList& systems) {
    systems.add<add_poses>(Create, Both);
    systems.add<add_crowd_poses>(Create, Both);
    systems.add<add_pose_keys_states>(Create, Both);
    systems.add<release_pose_keys>(Create, Both);
    systems.add<add_skin_pulls>(Create, Both);
    systems.add<add_deformer_states>(Create, Both);
    systems.add<release_surface_bindings>(Create, Both);
    systems.add<add_surface_binding_states>(Create, Both);
    systems.add<bind_surfaces>(Move, Both);
    systems.add<add_rotation_track_states>(Create, Both);
    systems.add<prepare_rotation_tracks>(Move);
    systems.add<add_key_track_states>(Create, Both);
    systems.add<prepare_key_tracks>(Move);
    systems.add<update_key_tracks>(Move, Both);
    systems.add<update_skin_pulls>(Move);  // takes what is displayed: the previous pose
    systems.add<update_rotation_tracks>(Move, Both);
    systems.add<update_wrinkle_tracks>(Move, Both);
    systems.add<add_motion_states>(Create, Both);
    systems.add<apply_graph_edits>(Create, Both);
    systems.add<prepare_motion_plans>(Create, Both);
    systems.add<update_motion_graphs>(Move);
    systems.add<add_match_states>(Create, Both);
    systems.add<prepare_match_databases>(Create, Both);
    systems.add<advance_clips>(Animate);
    systems.add<fade_crowd_clips>(Animate);  // after clips: keeps their times
    systems.add<prepare_pose_keys>(Animate, Both);
    systems.add<advance_pose_keys>(Animate);
    systems.add<prepare_crowd_clips>(Animate, Both);
    systems.add<add_ik_states>(Create, Both);
    systems.add<add_twist_links>(Create, Both);
    systems.add<add_foot_contacts>(Create, Both);
    systems.add<add_walk_states>(Create, Both);
    systems.add<add_motor_poses>(Create, Both);
    systems.add<add_crowd_walks>(Create, Both);
    systems.add<add_puppet_states>(Create, Both);
    systems.add<update_walk_routes>(Animate);
    systems.add<update_motion_matching>(Animate, Both);  // after what sets intents
    systems.add<update_walks>(Animate, Both);            // after all that moves characters
    systems.add<update_motor_poses>(
        Animate, Both);                    // after walks: moves feet that are off the ground
    systems.add<update_puppets>(Animate);  // plays what was sent in earlier steps
    systems.add<update_foot_contacts>(Animate, Both);
    systems.add<update_ik_goals>(Animate, Both);
    systems.add<update_twist_links>(Animate, Both);
    systems.add<add_ragdoll_states>(Create, Both);
    systems.add<place_ragdolls>(Animate, Both);
    systems.add<update_poses>(Animate, Both);       // after clips: samples them at their new time
    systems.add<send_performances>(Animate, Both);  // after poses: sends them
    systems.add<update_driven_shapes>(Animate, Both);  // after poses: follows their weights
    systems.add<update_deformers>(Animate, Both);
    systems.add<update_surface_bindings>(Animate, Both);  // after what deforms the surfaces
    systems.add<update_attachments>(Animate, Both);
    systems.add<prepare_wrinkles>(Create, Both);
    systems.add<prepare_wrinkle_responses>(Create, Both);
    systems.add<update_wrinkle_channels>(Animate, Both);   // after poses: their clips' weights
    systems.add<update_wrinkle_responses>(Animate, Both);  // after poses: measures the skin
}

void add_character_systems(SystemList& systems) {
    systems.add<add_motor_states>(Create, Both);
    systems.add<add_loose_states>(Create, Both);
    systems.add<add_hero_states>(Create, Both);
    systems.add<update_heroes>(Move);
    systems.add<update_motors>(Move);       // before poses, which put the feet where they are now
    systems.add<return_lost_heroes>(Move);  // after motors, which find where it stands
    systems.add<update_loose_bodies>(Move);
}

void add_crowd_systems(SystemList& systems) {
    systems.add<add_crowd_states>(Create, Both);
    systems.add<add_crowd_visits>(Create, Both);
    systems.add<add_crowd_scripts>(Create, Both);
    systems.add<update_crowd_visits>(Move);
    systems.add<place_stand_ins>(Move);
    systems.add<update_crowd>(Move);  // before clips, whose speeds it sets
    systems.add<update_crowd_scripts>(Move, Both);
    systems.add<notice_characters>(Move);
    systems.add<update_flocks>(Move);
}

void add_water_systems(SystemList& systems) {
    systems.add<add_ripple_states>(Create, Both);
    systems.add<add_touch_parts>(Create, Both);
    systems.add<add_wave_tables>(Create, Both);
    systems.add<add_noise_fields>(Create, Both);
    systems.add<add_shoaling_states>(Create, Both);
    systems.add<add_height_images>(Create, Both);
    systems.add<add_spray_drops>(Create);
    systems.add<add_wake_states>(Create, Both);
    systems.add<add_floating_states>(Create, Both);
    systems.add<add_ocean_states>(Create, Both);
    systems.add<update_weather>(Move, Both);
    systems.add<age_wave_packets>(Waves);
    systems.add<update_noise_surfaces>(Waves, Both);
    systems.add<update_shoaling_waves>(Waves, Both);
    systems.add<update_height_images>(Waves, Both);
    systems.add<shape_height_meshes>(Waves, Both);
    systems.add<emit_wakes>(Waves);              // after aging: new rings get their exact age
    systems.add<fill_wave_tables>(Waves, Both);  // after aging and wakes
    systems.add<update_oceans>(Waves, Both);
    systems.add<update_ocean_foam>(Waves);  // after oceans: where waves break now
    systems.add<update_floating_bodies>(Float);
    systems.add<update_spray>(Follow);  // on the bodies where they are now; before particles
    systems.add<update_water_ripples>(Follow);  // uses current positions of bodies
}

void add_particle_systems(SystemList& systems) {
    systems.add<watch_emitter_seeds>(Events, AtStart);
    systems.add<update_billboards>(Events);
    systems.add<add_particle_pools>(Create, Both);
    systems.add<add_gpu_particles>(Create, Both);
    systems.add<add_particle_mesh_states>(Create, Both);
    systems.add<add_trail_states>(Create, Both);
    systems.add<add_beam_states>(Create, Both);
    systems.add<find_particle_obstacles>(Follow);
    systems.add<update_ragdolls>(Follow);  // likewise; posed in the next step
    systems.add<update_point_masses>(
        Follow);                            // what they hit is known now; they are there next step
    systems.add<update_particles>(Follow);  // after everything that moves emitters
    systems.add<update_particle_balls>(Follow);
    systems.add<record_gpu_particles>(Follow);
    systems.add<update_particle_meshes>(Follow);
    systems.add<update_trails>(Follow);  // after particles, which it follows
    systems.add<update_beams>(Follow);
}

void add_camera_systems(SystemList& systems) {
    systems.add<update_camera_paths>(Move, Both);
    systems.add<update_fly_cameras>(Move);
    systems.add<update_orbit_cameras>(View, Both);
    systems.add<update_autofocus>(View, Both);  // after everything that moves cameras
    systems.add<adjust_lenses>(View);
    systems.add<choose_pose_rates>(View, Both);  // likewise, for the next step
    systems.add<add_wrinkle_rungs>(Create, Both);
    systems.add<climb_wrinkle_ladders>(View, Both);
    systems.add<choose_mesh_levels>(View, Both);   // after everything that moves cameras
    systems.add<choose_pose_joints>(View, Both);   // after meshes: what they need
    systems.add<update_relief_boxes>(View, Both);  // likewise
}

namespace {

SystemList list_systems(AddSystems more) {
    SystemList systems;
    for (const AddSystems add :
         {add_object_systems, add_animation_systems, add_crowd_systems, add_character_systems,
          add_water_systems, add_particle_systems, add_camera_systems, more}) {
        if (add != nullptr) {
            add(systems);
        }
    }
    return systems;
}

template <typename T>
T& resource_or_default(World& world) {
    T* found = world.find_resource<T>();
    return found != nullptr ? *found : world.insert_resource(T{});
}

FrameTime& insert_resources(World& world) {
    resource_or_default<RandomSeed>(world);
    resource_or_default<Input>(world);
    resource_or_default<Assets>(world);
    resource_or_default<WeatherState>(world);
    resource_or_default<ParticleObstacles>(world);
    resource_or_default<GpuShapes>(world);
    resource_or_default<StepJumps>(world);
    resource_or_default<WalkableMeshes>(world);
    resource_or_default<RagdollRigs>(world);
    resource_or_default<CrowdWalkClips>(world);
    resource_or_default<CrowdLibrary>(world);
    resource_or_default<MotionGraphs>(world);
    resource_or_default<MotionPlans>(world);
    resource_or_default<MatchDatabases>(world);
    resource_or_default<CrowdMemory>(world);
    resource_or_default<LightMapOccluders>(world);
    return resource_or_default<FrameTime>(world);
}

}  // namespace

std::vector<SystemList::Entry> SystemList::in_order(When when) const {
    std::vector<Entry> chosen;
    std::copy_if(
        entries_.begin(), entries_.end(), std::back_inserter(chosen),
        [when](const Entry& entry) { return entry.when == when || entry.when == Both; });
    std::stable_sort(chosen.begin(), chosen.end(), [](const Entry& a, const Entry& b) {
        return a.phase < b.phase;
    });
    return chosen;
}

Schedule SystemList::make_schedule() const {
    Schedule schedule;
    Phase phase = Events;
    for (const Entry& entry : in_order(EachStep)) {
        if (phase < entry.phase && (phase == Create || phase == Force)) {
            schedule.sync();
        }
        phase = entry.phase;
        schedule.add(entry.make());
    }
    return schedule;
}

void SystemList::run_start(World& world) const {
    for (const Entry& entry : in_order(AtStart)) {
        System system = entry.make();
        run_system(world, system);
    }
}

Schedule make_world_schedule(AddSystems more) {
    return list_systems(more).make_schedule();
}

void start_world(World& world, AddSystems more) {
    insert_resources(world);
    list_systems(more).run_start(world);
}

void step_world(World& world, Schedule& schedule) {
    FrameTime& time = insert_resources(world);
    if (time.time > 0) {
        ++time.frame;
    }
    time.time = static_cast<double>(time.frame + 1) * static_cast<double>(time.step);
    schedule.run(world);
}

}  // namespace limn
