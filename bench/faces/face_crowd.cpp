#include "bench/faces/face_crowd.h"

#include "bench/oracles/marked_head.h"
#include "content/make/head/head.h"
#include "ecs/base/jobs.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/faces/wrinkle_system.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace limn::bench {
namespace {

/// Muscles of smile and frown on both sides, the ring around the mouth and a box around the nose.
Deformers face_muscles(float contraction) {
    Deformers deformers;
    for (const float side : {-1.0f, 1.0f}) {
        deformers.muscles.push_back(
            {.attachment = {side * 0.058f, 0.004f, 0.04f},
             .insertion = {side * 0.026f, -0.036f, 0.092f},
             .angle = 0.6f,
             .full = 0.066f,
             .reach = 0.1f,
             .contraction = 0.2f * contraction});
        deformers.muscles.push_back(
            {.attachment = {side * 0.012f, 0.05f, 0.085f},
             .insertion = {side * 0.03f, 0.075f, 0.085f},
             .angle = 0.8f,
             .full = 0.03f,
             .reach = 0.05f,
             .contraction = 0.15f * contraction});
        deformers.muscles.push_back(
            {.attachment = {side * 0.03f, -0.075f, 0.06f},
             .insertion = {side * 0.026f, -0.04f, 0.09f},
             .angle = 0.6f,
             .full = 0.04f,
             .reach = 0.06f,
             .contraction = 0.15f * (1 - contraction)});
        deformers.muscles.push_back(
            {.attachment = {side * 0.03f, 0.11f, 0.06f},
             .insertion = {side * 0.03f, 0.07f, 0.085f},
             .angle = 0.7f,
             .full = 0.04f,
             .reach = 0.07f,
             .contraction = 0.1f * (1 - contraction)});
    }
    deformers.sphincters.push_back(
        {.center = {0, -0.036f, 0.09f},
         .right = {0.042f, 0, 0},
         .up = {0, 0.024f, 0},
         .depth = 0.04f,
         .contraction = 0.2f * contraction});
    Lattice box = {
        .origin = {-0.034f, -0.024f, 0.06f},
        .u = {0.068f, 0, 0},
        .v = {0, 0.075f, 0},
        .w = {0, 0, 0.09f},
        .offsets = std::vector<Vec3>(kLatticePoints, Vec3{0, 0, 0})};
    for (const std::size_t point : {37, 38, 41, 42, 53, 54}) {
        box.offsets[point] = {0, 0.01f * contraction, 0.02f};
    }
    deformers.lattices.push_back(std::move(box));
    return deformers;
}

WrinkleState measured_by(const MeshData& mesh, WrinkleDriver driver) {
    Assets assets;
    assets.meshes.push_back(mesh);
    WrinkleSurface surface;
    surface.driver = driver;
    for (const char* const region : {"forehead", "crows_feet", "nasolabial", "mouth_corner"}) {
        surface.resting.push_back({.region = region, .shortening = 0.2f});
    }
    return make_wrinkle_state(surface, {MeshId{0}, {}}, assets);
}

FaceCrowd make_crowd() {
    FaceCrowd crowd;
    crowd.mesh = make_head({});
    const MeshRig rig = make_head_rig({});
    crowd.skin = rig.skin;
    WrinkleState by_chord = measured_by(crowd.mesh, WrinkleDriver::Chord);
    crowd.chord = std::move(by_chord.rests);
    crowd.resting = std::move(by_chord.resting);
    crowd.strain = measured_by(crowd.mesh, WrinkleDriver::Strain).rests;
    crowd.markers = make_head({.part = HeadPartKind::Markers});
    crowd.on_markers = oracle::bind_to_markers(crowd.mesh, crowd.markers);
    const auto clip =
        std::ranges::find(rig.clips, std::string_view("expressions"), &ClipData::name);
    for (std::size_t i = 0; i < kCrowd; ++i) {
        CrowdMember& member = crowd.members.emplace_back();
        const float phase = static_cast<float>(i) / kCrowd;
        LocalPose pose = rig.skeleton.rest;
        member.morphs.weights.assign(crowd.mesh.morphs.size(), 0.0f);
        sample_clip(*clip, phase * clip->duration, pose, member.morphs.weights);
        member.pose.joints.resize(rig.skeleton.joints.size());
        compute_joint_matrices(rig.skeleton, pose, member.pose.joints);
        member.deformers.now = pack_deformers(face_muscles(phase));
        member.markers = crowd.markers.positions;
        add_morphs(crowd.markers.morphs, member.morphs.weights, {member.markers, {}, {}});
        member.deformed = crowd.mesh.positions;
        member.intensity.resize(crowd.mesh.positions.size());
    }
    deform_crowd(crowd, kCrowd);
    return crowd;
}

}  // namespace

FaceCrowd& face_crowd() {
    static FaceCrowd crowd = make_crowd();
    return crowd;
}

std::vector<CrowdFace> crowd_faces(FaceCrowd& crowd, std::size_t count) {
    std::vector<CrowdFace> faces;
    for (CrowdMember& member : std::span(crowd.members).first(count)) {
        const float age = static_cast<float>(faces.size()) / kCrowd;
        faces.push_back(
            {.deformed = member.deformed, .intensity = member.intensity, .resting_weight = age});
    }
    return faces;
}

void deform_crowd(FaceCrowd& crowd, std::size_t count) {
    parallel_for(count, 1, [&](std::size_t i, std::size_t) {
        CrowdMember& member = crowd.members[i];
        deform_positions(
            crowd.mesh, {}, &crowd.skin, &member.pose, &member.morphs, &member.deformers,
            member.deformed);
    });
}

void deform_crowd_scalar(FaceCrowd& crowd, std::size_t count) {
    parallel_for(count, 1, [&](std::size_t i, std::size_t) {
        CrowdMember& member = crowd.members[i];
        member.deformed = crowd.mesh.positions;
        const SkinnedVertices moved = {member.deformed, {}, {}};
        add_morphs(crowd.mesh.morphs, member.morphs.weights, moved);
        deform_points_scalar(member.deformers.now, member.deformed);
        std::vector<Affine> palette(crowd.skin.joints.size());
        compute_skin_palette(crowd.skin, member.pose.joints, palette);
        skin_linear_scalar(
            crowd.mesh.skin, palette, {member.deformed, {}, {}}, moved, 0, member.deformed.size());
    });
}

}  // namespace limn::bench
