#include "bench/oracles/skin_oracle.h"
#include "bench/oracles/skin_readback.h"
#include "bench/oracles/skin_shapes.h"
#include "bench/quality/quality_scene.h"
#include "ecs/base/rotation.h"
#include "ecs/components/animation.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "render/skinning/deformed_list.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace limn::skinning_quality {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kSamples = 4;
constexpr double kMaxPositionError = 1e-4;  // of the box (design 7)
constexpr double kMinRadius = 0.99;

/// A scene of mesh instances that are their own characters.
struct SkinStage : QualityScene {
    Entity pose(
        MeshId mesh, SkinId skin, Pose pose, Skinning skinning, MaterialId material = {},
        const Affine& where = {}) {
        const Entity entity = place(mesh, material, where);
        world.add(entity, std::move(pose));
        world.add(entity, Deformed{entity, skin, 0, skinning});
        return entity;
    }
    [[nodiscard]] const MeshData& mesh_of(Entity entity) const {
        return world.resource<Assets>().meshes[world.get<MeshInstance>(entity).mesh.index];
    }
    [[nodiscard]] std::vector<oracle::SkinnedVertex> exact(Entity entity) const {
        const auto& deformed = world.get<Deformed>(entity);
        std::vector<glm::dmat4> matrices;
        if (deformed.skin.index != kNoAsset) {
            const SkinData& skin = world.resource<Assets>().skins[deformed.skin.index];
            matrices = oracle::skin_matrices(skin, world.get<Pose>(entity).joints);
        }
        const auto* morphs = world.find<MorphWeights>(entity);
        const std::vector<float> none;
        return oracle::skin_vertices(
            mesh_of(entity), matrices, morphs != nullptr ? morphs->weights : none,
            deformed.skinning);
    }
};

/// Errors of an instance against the oracle.
struct SkinError {
    double position = 0;  ///< largest error, relative to the box's diagonal
    double normal = 0;    ///< largest angle [degrees]
    int outside = 0;      ///< vertices outside the culling box
};

SkinError compare(
    const SkinStage& stage, Entity entity, const oracle::SkinReadbackVertices& found,
    const Bounds& box) {
    const std::vector<oracle::SkinnedVertex> expected = stage.exact(entity);
    SkinError error;
    if (found.positions.size() != expected.size()) {
        return {.position = INFINITY, .normal = INFINITY};
    }
    Bounds around;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Vec3& p = found.positions[i];
        grow(around, p);
        error.position =
            std::max(error.position, glm::distance(glm::dvec3(p), expected[i].position));
        const double sine =
            glm::length(glm::cross(glm::dvec3(found.normals[i]), expected[i].normal));
        error.normal = std::max(error.normal, glm::degrees(std::asin(std::min(sine, 1.0))));
        const Vec3 slack = Vec3(1e-5f);
        const bool inside = glm::all(glm::lessThanEqual(box.min - slack, p))
                            && glm::all(glm::lessThanEqual(p, box.max + slack));
        error.outside += inside ? 0 : 1;
    }
    error.position /= glm::length(around.max - around.min);
    return error;
}

Entity
add_snake(SkinStage& stage, Skinning skinning, int joints, int max_influences, Random& random) {
    constexpr float kSpacing = 0.25f;
    MeshData tube = oracle::make_tube(4 * joints, 12, kSpacing * static_cast<float>(joints - 1));
    oracle::add_weights(tube, joints, max_influences, random);
    const bool scaled = skinning == Skinning::Linear;
    Pose pose;
    pose.joints = oracle::random_joints(joints, kSpacing, 0.7f, scaled, random);
    pose.previous = oracle::random_joints(joints, kSpacing, 0.7f, scaled, random);
    const SkinId skin = stage.add(oracle::make_chain(joints, kSpacing));
    return stage.pose(stage.add(std::move(tube)), skin, std::move(pose), skinning);
}

/// A tube whose second joint is rotated by `angle` about its axis; all vertices are weighted half
/// and half.
Entity add_twist(SkinStage& stage, Skinning skinning, float angle) {
    MeshData tube = oracle::make_tube(4, 24, 1);
    tube.skin.first.push_back(0);
    for (std::size_t i = 0; i < tube.positions.size(); ++i) {
        tube.skin.joints.insert(tube.skin.joints.end(), {0, 1});
        tube.skin.weights.insert(tube.skin.weights.end(), {0.5f, 0.5f});
        tube.skin.first.push_back(static_cast<std::uint32_t>(2 * (i + 1)));
    }
    Pose pose;
    pose.joints = {Affine{}, affine_from(Vec3(0), rotation_about({0, 1, 0}, angle), Vec3(1))};
    pose.previous = pose.joints;
    const SkinId skin = stage.add(oracle::make_chain(2, 0));
    return stage.pose(stage.add(std::move(tube)), skin, std::move(pose), skinning);
}

/// Smallest distance of a vertex from the axis, relative to rest.
double smallest_radius(const std::vector<Vec3>& positions) {
    float smallest = INFINITY;
    for (const Vec3& p : positions) {
        smallest = std::min(smallest, std::hypot(p.x, p.z));
    }
    return static_cast<double>(smallest) / 0.2;
}

void measure_vertices(oracle::SkinReadback& gpu, QualityReport& report) {
    int outside = 0;
    double normal = 0;
    const auto judge = [&](const SkinStage& stage, Entity entity) {
        const oracle::SkinReadbackVertices found =
            gpu.run(stage.world, std::vector<Entity>{entity})[0];
        const std::uint32_t index = gpu.shapes().find(entity);
        const Bounds box = index != DeformedList::kNone ? gpu.shapes()[index].bounds : Bounds{};
        gpu.forget();
        const SkinError error = compare(stage, entity, found, box);
        outside += error.outside;
        normal = std::max(normal, error.normal);
        return error.position;
    };
    for (const Skinning skinning : {Skinning::Linear, Skinning::DualQuaternion}) {
        const char* blend = skinning == Skinning::Linear ? "linear blend" : "dual quaternions";
        for (const int joints : {24, 300}) {
            Random random(1, static_cast<std::uint64_t>(joints), 0, 0);
            SkinStage stage;
            const Entity entity = add_snake(stage, skinning, joints, 8, random);
            report.at_most(
                fmt::format(
                    "{}, {} joints, up to 8 per vertex: largest error, of the box", blend, joints),
                judge(stage, entity), kMaxPositionError);
        }
    }
    report.at_most("largest angular error of a normal", normal, 0.02, "degrees");
    Random random(2, 0, 0, 0);
    SkinStage stage;
    const Entity entity = add_snake(stage, Skinning::Linear, 24, 4, random);
    auto& mesh = stage.world.resource<Assets>().meshes[0];
    oracle::add_morphs(mesh, 300, 3, 0.01f, random);
    MorphWeights morphs;
    for (int i = 0; i < 300; ++i) {
        morphs.weights.push_back(random.uniform(-0.5f, 1.0f));
    }
    stage.world.add(entity, morphs);
    report.at_most(
        "300 morph targets and 24 joints: largest error, of the box", judge(stage, entity),
        kMaxPositionError);
    report.at_most("vertices outside the culling boxes", static_cast<double>(outside), 0);
}

void measure_twist(oracle::SkinReadback& gpu, QualityReport& report) {
    double kept = INFINITY;
    for (const float angle : {30.0f, 60.0f, 90.0f, 120.0f, 150.0f, 179.0f}) {
        SkinStage stage;
        const Entity entity = add_twist(stage, Skinning::DualQuaternion, radians(angle));
        const oracle::SkinReadbackVertices found =
            gpu.run(stage.world, std::vector<Entity>{entity})[0];
        gpu.forget();
        kept = std::min(kept, smallest_radius(found.positions));
    }
    report.at_least(
        "radius left after a twist of 30 to 179 degrees, dual quaternions", kept, kMinRadius);
    SkinStage stage;
    const Entity entity = add_twist(stage, Skinning::Linear, radians(90.0f));
    report.inform(
        "the same at 90 degrees, linear blend (cos 45 degrees)",
        smallest_radius(gpu.run(stage.world, std::vector<Entity>{entity})[0].positions));
    gpu.forget();
}

void measure_frames(gpu::Device& device, oracle::SkinReadback& gpu, QualityReport& report) {
    Random random(3, 0, 0, 0);
    SkinStage stage;
    std::vector<Entity> herd;
    MeshData tube = oracle::make_tube(16, 8, 1);
    oracle::add_weights(tube, 5, 4, random);
    const MeshId mesh = stage.add(std::move(tube));
    const SkinId skin = stage.add(oracle::make_chain(5, 0.25f));
    for (int i = 0; i < 1000; ++i) {
        Pose pose;
        pose.joints = oracle::random_joints(5, 0.25f, 0.5f, false, random);
        pose.previous = pose.joints;
        herd.push_back(stage.pose(mesh, skin, std::move(pose), Skinning::Linear));
    }
    device.reset_stats();
    const std::vector<oracle::SkinReadbackVertices> first = gpu.run(stage.world, herd);
    report.at_most(
        "dispatches for 1000 poses of one mesh", static_cast<double>(device.stats().dispatches), 1);
    gpu.run(stage.world, herd);
    report.at_most(
        "meshes deformed again while all are at rest",
        static_cast<double>(gpu.shapes().work().instances), 0);
    for (const Entity entity : herd) {
        auto& pose = stage.world.get<Pose>(entity);
        pose.joints = oracle::random_joints(5, 0.25f, 0.5f, false, random);
    }
    const std::vector<oracle::SkinReadbackVertices> second = gpu.run(stage.world, herd);
    int different = 0;
    for (std::size_t i = 0; i < herd.size(); ++i) {
        different += second[i].before == first[i].positions ? 0 : 1;
    }
    report.at_most(
        "meshes whose previous positions differ in any bit from the last frame's",
        static_cast<double>(different), 0);
    gpu.forget();
}

/// Renders tubes twisted and bent with both skinning methods, against meshes baked by the oracle.
void draw_tubes(HeadlessRenderer& headless, QualityReport& report) {
    SkinStage stage;
    stage.world.insert_resource(Environment{
        .sky = SkyKind::Gradient,
        .zenith = {0.3f, 0.45f, 0.8f},
        .horizon = {0.7f, 0.75f, 0.8f},
        .ground = {0.25f, 0.22f, 0.2f}});
    stage.add_light(
        DirectionalLight{.color = {1, 0.95f, 0.85f}, .illuminance = 2.5f},
        look_at({0, 0, 0}, {-0.4f, -0.7f, -0.8f}));
    const RenderView view =
        quality_view({0.05f, 0.6f, 2.4f}, {0.05f, 0.5f, 0}, kWidth, kHeight, 0.8f);
    const MaterialId clay = stage.add(
        Material{.double_sided = true, .base_color = {0.75f, 0.35f, 0.2f, 1}, .roughness = 0.6f});
    const SkinId skin = stage.add(oracle::make_chain(2, 0.5f));
    constexpr float kOffsets[] = {-1.35f, -0.75f, -0.1f, 0.85f};
    std::vector<Entity> tubes;
    for (int i = 0; i < 4; ++i) {
        const Skinning skinning = i % 2 == 0 ? Skinning::Linear : Skinning::DualQuaternion;
        MeshData tube = oracle::make_tube(48, 32, 1);
        tube.skin.first.push_back(0);
        for (const Vec3& p : tube.positions) {
            const float upper = glm::smoothstep(0.25f, 0.75f, p.y);
            tube.skin.joints.insert(tube.skin.joints.end(), {0, 1});
            tube.skin.weights.insert(tube.skin.weights.end(), {1 - upper, upper});
            tube.skin.first.push_back(static_cast<std::uint32_t>(tube.skin.joints.size()));
        }
        const Quat turn = i < 2 ? rotation_about({0, 1, 0}, radians(165.0f))
                                : rotation_about({0, 0, 1}, radians(-95.0f));
        Pose pose;
        pose.joints = {Affine{}, affine_from({0, 0.5f, 0}, turn, Vec3(1))};
        pose.previous = pose.joints;
        const Affine where = placed_at({kOffsets[i], 0, 0});
        tubes.push_back(
            stage.pose(stage.add(std::move(tube)), skin, std::move(pose), skinning, clay, where));
    }
    QualityImage image;
    image.title = "twist: linear, dual quaternions; bend: linear, dual quaternions";
    image.effect = displayed(stage.radiance(headless, view, kSamples));
    for (const Entity entity : tubes) {
        MeshData baked = stage.mesh_of(entity);
        const std::vector<oracle::SkinnedVertex> vertices = stage.exact(entity);
        baked.bounds = {};
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            baked.positions[v] = Vec3(vertices[v].position);
            baked.normals[v] = Vec3(vertices[v].normal);
            grow(baked.bounds, baked.positions[v]);
        }
        const Affine where = stage.world.get<WorldTransform>(entity).world;
        stage.world.destroy(entity);
        stage.place(stage.add(std::move(baked)), clay, where);
    }
    image.oracle = displayed(stage.radiance(headless, view, kSamples));
    report.at_least(
        "image of deformed tubes against meshes baked by the oracle",
        psnr(image.effect, image.oracle), 45, "dB");
    report.images.push_back(std::move(image));
}

Status measure_skinning(HeadlessRenderer& headless, QualityReport& report) {
    oracle::SkinReadback gpu = LIMN_TRY(oracle::SkinReadback::create(*headless.device));
    measure_vertices(gpu, report);
    measure_twist(gpu, report);
    measure_frames(*headless.device, gpu, report);
    draw_tubes(headless, report);
    return Done{};
}

const RegisterQuality
    kRegistered("skinning", "joints and morph targets in double precision", measure_skinning);

}  // namespace
}  // namespace limn::skinning_quality
