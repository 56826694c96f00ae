#include "ecs/components/all.h"

#include "ecs/components/animation.h"
#include "ecs/components/attach.h"
#include "ecs/components/beam.h"
#include "ecs/components/billboard.h"
#include "ecs/components/buoyancy.h"
#include "ecs/components/camera.h"
#include "ecs/components/camera_lens.h"
#include "ecs/components/camera_path.h"
#include "ecs/components/caustics.h"
#include "ecs/components/crowd.h"
#include "ecs/components/crowd_pose.h"
#include "ecs/components/crowd_script.h"
#include "ecs/components/curvature_view.h"
#include "ecs/components/dazzle.h"
#include "ecs/components/deformers.h"
#include "ecs/components/env_probe.h"
#include "ecs/components/environment.h"
#include "ecs/components/flock.h"
#include "ecs/components/foot_plant.h"
#include "ecs/components/force_field.h"
#include "ecs/components/framing.h"
#include "ecs/components/fur.h"
#include "ecs/components/furrows.h"
#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/components/gltf_source.h"
#include "ecs/components/height_fog.h"
#include "ecs/components/height_image.h"
#include "ecs/components/ik.h"
#include "ecs/components/ink.h"
#include "ecs/components/input.h"
#include "ecs/components/key_track.h"
#include "ecs/components/lens_flare.h"
#include "ecs/components/lifetime.h"
#include "ecs/components/light.h"
#include "ecs/components/light_map.h"
#include "ecs/components/mesh_levels.h"
#include "ecs/components/mirror_caustic.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/motion_match.h"
#include "ecs/components/motor.h"
#include "ecs/components/motor_pose.h"
#include "ecs/components/move_intent.h"
#include "ecs/components/name.h"
#include "ecs/components/ocean.h"
#include "ecs/components/panorama_layer.h"
#include "ecs/components/particle_balls.h"
#include "ecs/components/particle_collider.h"
#include "ecs/components/particle_mesh.h"
#include "ecs/components/particle_surface.h"
#include "ecs/components/particles.h"
#include "ecs/components/path.h"
#include "ecs/components/point_mass.h"
#include "ecs/components/pose_keys.h"
#include "ecs/components/post.h"
#include "ecs/components/projector.h"
#include "ecs/components/puppet.h"
#include "ecs/components/ragdoll.h"
#include "ecs/components/relief_box.h"
#include "ecs/components/rendering.h"
#include "ecs/components/ripple.h"
#include "ecs/components/rotation_track.h"
#include "ecs/components/shading_comparison.h"
#include "ecs/components/shadow.h"
#include "ecs/components/shadow_volume.h"
#include "ecs/components/shoaling_waves.h"
#include "ecs/components/skin_pull.h"
#include "ecs/components/sound_player.h"
#include "ecs/components/speed_lines.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/tangent_frames.h"
#include "ecs/components/texture_combine.h"
#include "ecs/components/texture_feedback.h"
#include "ecs/components/texture_layers.h"
#include "ecs/components/texture_shade.h"
#include "ecs/components/time.h"
#include "ecs/components/trail.h"
#include "ecs/components/transform.h"
#include "ecs/components/twist_joints.h"
#include "ecs/components/vertex_offset.h"
#include "ecs/components/vignette.h"
#include "ecs/components/walk.h"
#include "ecs/components/water.h"
#include "ecs/components/water_detail.h"
#include "ecs/components/water_look.h"
#include "ecs/components/water_noise.h"
#include "ecs/components/water_ripples.h"
#include "ecs/components/water_spray.h"
#include "ecs/components/water_wake.h"
#include "ecs/components/water_walls.h"
#include "ecs/components/water_waves.h"
#include "ecs/components/weather.h"
#include "ecs/components/wrinkle.h"
#include "ecs/components/wrinkle_comparison.h"
#include "ecs/components/wrinkle_ladder.h"
#include "ecs/components/wrinkle_maps.h"
#include "ecs/components/wrinkle_response.h"
#include "ecs/hierarchy.h"

// Techniques: engine.type-registry

namespace limn {

void register_all_components() {
    register_component<Name>();
    register_component<SoundPlayer>();
    register_component<FromGltf>();
    register_component<GltfSource>();
    register_component<Lifetime>();
    register_component<ForceField>();
    register_component<ParticleEmitter>();
    register_component<ParticleSource>();
    register_component<ParticleCollision>();
    register_component<ParticleCollider>();
    register_component<ParticleBalls>();
    register_component<ParticleMotion>();
    register_component<ParticleWrap>();
    register_component<ParticleLook>();
    register_component<ParticleLight>();
    register_component<ParticlePool>();
    register_component<ParticleMesh>();
    register_component<ParticleMeshState>();
    register_component<ParticleSurface>();
    register_component<PointMass>();
    register_component<AirDrag>();
    register_component<VariableMass>();
    register_component<Trail>();
    register_component<TrailState>();
    register_component<Billboard>();
    register_component<Beam>();
    register_component<BeamState>();
    register_component<Parent>();
    register_component<Transform>();
    register_component<WorldTransform>();
    register_component<PreviousWorldTransform>();
    register_component<Teleport>();
    register_component<Spin>();
    register_component<Sway>();
    register_component<MeshInstance>();
    register_component<MeshLevels>();
    register_component<BakedLight>();
    register_component<LightMap>();
    register_component<ReliefBox>();
    register_component<ReliefBoxState>();
    register_component<Inflate>();
    register_component<ToonOutline>();
    register_component<Fur>();
    register_component<SpeedLines>();
    register_component<Skeleton>();
    register_component<ClipPlayer>();
    register_component<Pose>();
    register_component<PoseKeys>();
    register_component<CrowdPose>();
    register_component<CrowdPoseState>();
    register_component<MoveIntent>();
    register_component<MotionGraph>();
    register_component<MotionGraphState>();
    register_component<MotionStyle>();
    register_component<MotionMatch>();
    register_component<MotionMatchState>();
    register_component<MatchHandover>();
    register_component<CharacterMotor>();
    register_component<MotorState>();
    register_component<MotorPose>();
    register_component<MotorPoseState>();
    register_component<Puppet>();
    register_component<PuppetState>();
    register_component<Hero>();
    register_component<HeroState>();
    register_component<LooseBody>();
    register_component<LooseState>();
    register_component<CrowdAgent>();
    register_component<CrowdGoal>();
    register_component<CrowdExit>();
    register_component<CrowdObstacle>();
    register_component<CrowdSpace>();
    register_component<CrowdState>();
    register_component<FlockParams>();
    register_component<Boid>();
    register_component<Walk>();
    register_component<WalkState>();
    register_component<WalkRoute>();
    register_component<WalkRouteState>();
    register_component<CrowdWalk>();
    register_component<CrowdScript>();
    register_component<CrowdScriptState>();
    register_component<CrowdPlace>();
    register_component<CrowdVisitor>();
    register_component<CrowdVisit>();
    register_component<CrowdStandIn>();
    register_component<PoseCut>();
    register_component<MorphWeights>();
    register_component<MorphPlayer>();
    register_component<Deformed>();
    register_component<VertexOffsetSkinning>();
    register_component<Deformers>();
    register_component<DeformerState>();
    register_component<PullableSkin>();
    register_component<SkinPulls>();
    register_component<ControlSurface>();
    register_component<SurfaceBinding>();
    register_component<SurfaceBindingState>();
    register_component<WrinkleSurface>();
    register_component<WrinkleMaps>();
    register_component<WrinkleLadder>();
    register_component<WrinkleRungs>();
    register_component<WrinkleResponse>();
    register_component<MeasuredWrinkles>();
    register_component<Furrows>();
    register_component<FurrowView>();
    register_component<WrinkleWeights>();
    register_component<WrinkleTrack>();
    register_component<JointAttachment>();
    register_component<IkRig>();
    register_component<LookAt>();
    register_component<TwistJoints>();
    register_component<Walkable>();
    register_component<FootPlant>();
    register_component<FootContacts>();
    register_component<Ragdoll>();
    register_component<RagdollState>();
    register_component<Gaze>();
    register_component<ReachGoal>();
    register_component<ReachState>();
    register_component<PathFollower>();
    register_component<RotationTrack>();
    register_component<KeyTrack>();
    register_component<Attach>();
    register_component<AttachPoints>();
    register_component<AttachState>();
    register_component<PointLight>();
    register_component<SpotLight>();
    register_component<DirectionalLight>();
    register_component<Sunlight>();
    register_component<LightPulse>();
    register_component<Shadow>();
    register_component<NoShadow>();
    register_component<Projector>();
    register_component<ShadowVolume>();
    register_component<EnvProbe>();
    register_component<EnvProbeState>();
    register_component<Ocean>();
    register_component<OceanFoam>();
    register_component<RippleRing>();
    register_component<HeatHaze>();
    register_component<ScreenRipple>();
    register_component<Water>();
    register_component<WaterLook>();
    register_component<TextureCombine>();
    register_component<TextureFeedback>();
    register_component<TextureLayers>();
    register_component<TextureShade>();
    register_component<WaterDetail>();
    register_component<WaterWaves>();
    register_component<WaterRipples>();
    register_component<RippleState>();
    register_component<WaterTouch>();
    register_component<WaterWall>();
    register_component<WakeEmitter>();
    register_component<WakeState>();
    register_component<NoiseSurface>();
    register_component<HeightImage>();
    register_component<ShoalingWaves>();
    register_component<SpraySource>();
    register_component<SprayObstacle>();
    register_component<Caustics>();
    register_component<MirrorCaustic>();
    register_component<Floating>();
    register_component<FloatingState>();
    register_component<Camera>();
    register_component<Lens>();
    register_component<Autofocus>();
    register_component<LensFlare>();
    register_component<Dazzle>();
    register_component<PanoramaLayer>();
    register_component<OrbitCamera>();
    register_component<FlyCamera>();
    register_component<CameraPath>();
    register_component<FramingState>();

    register_resource<SiblingOrder>();
    register_resource<FrameTime>();
    register_resource<RandomSeed>();
    register_resource<Input>();
    register_resource<Environment>();
    register_resource<Rendering>();
    register_resource<ShadingComparison>();
    register_resource<ScanlinePlot>();
    register_resource<WrinkleComparison>();
    register_resource<Exposure>();
    register_resource<Glow>();
    register_resource<Glare>();
    register_resource<Vignette>();
    register_resource<TangentFrames>();
    register_resource<CurvatureView>();
    register_resource<InkLines>();
    register_resource<Hatching>();
    register_resource<LensRain>();
    register_resource<HeightFog>();
    register_resource<Weather>();
    register_resource<WeatherState>();
    register_resource<MotionBlur>();

    register_engine_actions();
}

}  // namespace limn
