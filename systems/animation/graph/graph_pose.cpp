#include "systems/animation/graph/graph_pose.h"

#include "systems/animation/graph/motion_pose.h"

#include <algorithm>

namespace limn {

bool sample_motion_graph(
    const Query<const MotionGraph, const MotionGraphState, Optional<const MotionStyle>>& graphs,
    const MotionGraphs* data, const MotionPlans* plans, const Assets& assets, Entity entity,
    SkeletonId skeleton, LocalPose& pose, std::span<float> weights, bool& is_cut) {
    const MotionGraph* const graph = graphs.find<const MotionGraph>(entity);
    const MotionPlan* const plan = graph != nullptr && plans != nullptr && data != nullptr
                                       ? plans->find(graph->graph, skeleton)
                                       : nullptr;
    if (plan == nullptr) {
        return false;
    }
    thread_local MotionPose motion;
    const MotionGraphState& state = *graphs.find<const MotionGraphState>(entity);
    const MotionContext context = {
        assets, assets.skeletons[skeleton.index],      data->graphs[graph->graph.index], *plan,
        *graph, graphs.find<const MotionStyle>(entity)};
    evaluate_motion(context, state, motion);
    pose = motion.joints;
    for (const std::uint16_t morph : plan->animated) {
        if (morph < weights.size()) {
            weights[morph] = motion.weights[morph];
        }
    }
    is_cut = is_cut || state.cut != 0;
    return true;
}

}  // namespace limn
