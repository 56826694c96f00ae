#include "bench/quality/characters_quality.h"
#include "content/make/models/creature.h"
#include "ecs/components/animation.h"
#include "ecs/components/motion_graph.h"
#include "ecs/components/surface.h"
#include "ecs/components/time.h"
#include "ecs/world.h"
#include "systems/animation/graph/inertial_offset.h"
#include "systems/update_world.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

// Techniques: char.blend

namespace limn::motion_graph_quality {
namespace {

constexpr float kStep = 1.0f / 9600;  ///< so short that accelerations do not count [s]

/// A fox that trots, then stands, by the event "halt".
MotionGraphData make_halting_graph(TransitionBlend blend, float duration) {
    MotionGraphData graph;
    graph.states = {
        {.name = "trot", .clips = {{{2}, {0, 0}, 0}}},
        {.name = "stand", .clips = {{{0}, {0, 0}, 0}}}};
    graph.transitions = {
        {.from = "trot", .event = "halt", .to = "stand", .duration = duration, .blend = blend}};
    return graph;
}

std::vector<Vec3> joint_positions(const World& world, Entity fox) {
    std::vector<Vec3> positions;
    for (const Affine& joint : world.get<const Pose>(fox).joints) {
        positions.push_back(transform_point(joint, Vec3(0)));
    }
    return positions;
}

struct BlendJump {
    double position = 0;  ///< off the way that the joint would have gone on [mm]
    double velocity = 0;  ///< change from one step to the next [m/s]
};

/// The largest jump of a joint in the step of the switch, of switches all over a cycle, between the
/// keys of the clip.
BlendJump measure_jump(const MeshRig& rig, TransitionBlend blend, float duration) {
    BlendJump largest;
    for (int i = 0; i < 24; ++i) {
        World world;
        Schedule schedule = make_world_schedule();
        Assets& assets = world.insert_resource(Assets{});
        assets.skeletons.push_back(rig.skeleton);
        assets.clips = rig.clips;
        world.insert_resource(FrameTime{.step = kStep});
        world.insert_resource(MotionGraphs{{make_halting_graph(blend, duration)}});
        const Entity fox = world.create(
            Transform{}, Skeleton{{0}},
            MotionGraph{.graph = {0}, .phase = (static_cast<float>(i) + 0.25f) / 24});
        start_world(world);
        std::vector<Vec3> shown[4];
        for (int k = 0; k < 4; ++k) {
            if (k == 2) {
                world.get<MotionGraph>(fox).events = {"halt"};
            }
            step_world(world, schedule);
            shown[k] = joint_positions(world, fox);
        }
        for (std::size_t j = 0; j < shown[0].size(); ++j) {
            const Vec3 before = shown[1][j] - shown[0][j];
            const Vec3 at_switch = shown[2][j] - shown[1][j];
            const Vec3 after = shown[3][j] - shown[2][j];
            const double off = static_cast<double>(glm::distance(at_switch, before));
            const double change = static_cast<double>(glm::distance(after, before));
            largest.position = std::max(largest.position, 1000 * off);
            largest.velocity = std::max(largest.velocity, change / static_cast<double>(kStep));
        }
    }
    return largest;
}

/// Largest difference from the published polynomial in double precision, of an amplitude of 1.
double polynomial_error() {
    double largest = 0;
    for (const double v : {0.0, -0.5, -3.0, -9.0, -40.0}) {
        constexpr double kDuration = 0.25;
        const double t1 = v < 0 ? std::min(kDuration, -5 / v) : kDuration;
        const double a0 = std::max(0.0, -(8 * v * t1 + 20) / (t1 * t1));
        const double a = -(a0 * t1 * t1 + 6 * v * t1 + 12) / (2 * std::pow(t1, 5));
        const double b = (3 * a0 * t1 * t1 + 16 * v * t1 + 30) / (2 * std::pow(t1, 4));
        const double c = -(3 * a0 * t1 * t1 + 12 * v * t1 + 20) / (2 * std::pow(t1, 3));
        for (int i = 0; i <= 200; ++i) {
            const double t = kDuration * i / 200;
            const double exact =
                t >= t1 ? 0 : ((((a * t + b) * t + c) * t + a0 / 2) * t + v) * t + 1;
            const float found = inertial_amplitude(
                1.0f, static_cast<float>(v), static_cast<float>(kDuration), static_cast<float>(t));
            largest = std::max(largest, std::abs(static_cast<double>(found) - exact));
        }
    }
    return largest;
}

Status measure_motion_graph(HeadlessRenderer& /*headless*/, QualityReport& report) {
    const MeshRig rig = make_creature_rig(CreatureShape{});
    const BlendJump cut = measure_jump(rig, TransitionBlend::Inertialize, 0);
    const BlendJump fade = measure_jump(rig, TransitionBlend::Crossfade, 0.25f);
    const BlendJump inertial = measure_jump(rig, TransitionBlend::Inertialize, 0.25f);
    report.inform("a trot is cut: jump of a joint", cut.position, "mm");
    report.at_most("a crossfade: jump of a joint", fade.position, 1, "mm");
    report.at_most("inertialization: jump of a joint", inertial.position, 1, "mm");
    report.inform("a crossfade: change of a joint's velocity", fade.velocity, "m/s");
    report.at_most("inertialization: change of a joint's velocity", inertial.velocity, 0.25, "m/s");
    report.at_most("inertialization: error of the amplitude of 1", polynomial_error(), 1e-5);
    return Done{};
}

const RegisterCharacterPart kMotionGraphPart("motion graph", measure_motion_graph);

}  // namespace
}  // namespace limn::motion_graph_quality
