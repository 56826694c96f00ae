#include "systems/animation/graph/motion_plan.h"

#include "ecs/base/log.h"
#include "ecs/base/rotation.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/pose_system.h"

#include <algorithm>
#include <cmath>
#include <string>

// Techniques: char.blend, char.motion-modify

namespace limn {

namespace {

constexpr float kShortestSegment = 1e-3f;  ///< of a cycle
constexpr int kMeanSamples = 32;

float fraction(float x) {
    return x - std::floor(x);
}

std::uint16_t joint_named(const SkeletonData& skeleton, const std::string& name) {
    const auto found = std::find(skeleton.joints.begin(), skeleton.joints.end(), name);
    return found == skeleton.joints.end()
               ? std::uint16_t{0xffff}
               : static_cast<std::uint16_t>(found - skeleton.joints.begin());
}

/// Fraction of the clip at which the joint touches down: where a contact begins that does not
/// continue one which ends there; < 0: nowhere.
float touchdown_of(const ClipData& clip, std::uint16_t joint) {
    constexpr float kGap = 1e-4f;  // [s]
    for (const ClipContact& contact : clip.contacts) {
        const bool continues =
            contact.begin < kGap
            && std::any_of(
                clip.contacts.begin(), clip.contacts.end(), [&](const ClipContact& other) {
                    return other.joint == joint && other.end > clip.duration - kGap;
                });
        if (contact.joint == joint && !continues) {
            return contact.begin / clip.duration;
        }
    }
    return -1.0f;
}

/// Largest number of joints and morph weights that a clip refers to.
void find_extent(const ClipData& clip, std::size_t& joints, std::size_t& morphs) {
    for (const ClipSheet& sheet : clip.sheets) {
        for (const auto* const list : {&sheet.rotating, &sheet.translating, &sheet.scaling}) {
            for (const std::uint16_t joint : *list) {
                joints = std::max<std::size_t>(joints, joint + 1u);
            }
        }
        for (const std::uint16_t morph : sheet.morphing) {
            morphs = std::max<std::size_t>(morphs, morph + 1u);
        }
    }
}

std::vector<Quat>
mean_rotations(const SkeletonData& skeleton, const ClipData& clip, std::size_t morphs) {
    std::vector<Quat> sums(skeleton.joints.size(), Quat(0, 0, 0, 0));
    LocalPose pose;
    std::vector<float> weights(morphs);
    for (int i = 0; i < kMeanSamples; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / kMeanSamples;
        sample_pose(skeleton, &clip, u * clip.duration, pose, weights);
        for (std::size_t j = 0; j < sums.size(); ++j) {
            sums[j] = sums[j] + to_same_hemisphere(sums[j], pose.rotations[j]);
        }
    }
    for (Quat& sum : sums) {
        sum = normalize_or_identity(sum);
    }
    return sums;
}

/// Checks clips of a graph against a skeleton.
class ClipFinder {
  public:
    ClipFinder(
        const MotionGraphData& graph, const SkeletonData& skeleton, const Assets& assets,
        MotionPlan& plan)
        : graph_(graph), skeleton_(skeleton), assets_(assets), plan_(plan) {}

    /// Null, with a warning, if it is missing or does not fit.
    const ClipData* find(ClipId id, const std::string& user) const {
        if (id.index >= assets_.clips.size()) {
            log_warn("motion graph {}: {} has no clip; it is the rest pose", graph_.name, user);
            return nullptr;
        }
        const ClipData& clip = assets_.clips[id.index];
        std::size_t joints = 0;
        std::size_t morphs = 0;
        find_extent(clip, joints, morphs);
        if (joints > skeleton_.joints.size()) {
            log_warn(
                "motion graph {}: {}: the clip {} animates {} joints, expected at most {}, those "
                "of the skeleton {}; it is the rest pose",
                graph_.name, user, clip.name, joints, skeleton_.joints.size(), skeleton_.name);
            return nullptr;
        }
        plan_.morphs = std::max(plan_.morphs, morphs);
        for (const ClipSheet& sheet : clip.sheets) {
            plan_.animated.insert(
                plan_.animated.end(), sheet.morphing.begin(), sheet.morphing.end());
        }
        return &clip;
    }

    std::uint16_t joint(const std::string& name, const std::string& user) const {
        const std::uint16_t found = joint_named(skeleton_, name);
        if (found == 0xffff) {
            log_warn(
                "motion graph {}: {}: found the joint {}, expected one of the skeleton {}",
                graph_.name, user, name, skeleton_.name);
        }
        return found;
    }

  private:
    const MotionGraphData& graph_;
    const SkeletonData& skeleton_;
    const Assets& assets_;
    MotionPlan& plan_;
};

/// Sets the joint and its descendants.
void mark_branch(
    const SkeletonData& skeleton, std::uint16_t top, std::uint8_t value,
    std::vector<std::uint8_t>& mask) {
    if (top == 0xffff) {
        return;
    }
    std::vector<std::uint8_t> inside(mask.size(), 0);
    for (std::size_t j = top; j < mask.size(); ++j) {
        const std::int32_t parent = skeleton.parents[j];
        inside[j] = j == top || (parent >= 0 && inside[static_cast<std::size_t>(parent)] != 0);
        mask[j] = inside[j] != 0 ? value : mask[j];
    }
}

MotionPlan::Layer
plan_layer(const GraphLayer& layer, const ClipFinder& finder, const SkeletonData& skeleton) {
    MotionPlan::Layer plan;
    const std::string user = "layer " + layer.name;
    const ClipData* const clip = finder.find(layer.clip, user);
    plan.fits = clip != nullptr;
    plan.is_whole = layer.joints.empty() && layer.without.empty();
    std::vector<std::uint8_t> mask(skeleton.joints.size(), layer.joints.empty() ? 1 : 0);
    for (const std::string& name : layer.joints) {
        mark_branch(skeleton, finder.joint(name, user), 1, mask);
    }
    for (const std::string& name : layer.without) {
        mark_branch(skeleton, finder.joint(name, user), 0, mask);
    }
    for (std::uint16_t j = 0; j < mask.size(); ++j) {
        if (mask[j] != 0) {
            plan.joints.push_back(j);
        }
    }
    std::size_t joints = 0;
    std::size_t morphs = 0;
    if (clip != nullptr) {
        find_extent(*clip, joints, morphs);
    }
    plan.weights.resize(morphs, 0.0f);
    sample_pose(skeleton, layer.from_rest ? nullptr : clip, 0.0f, plan.reference, plan.weights);
    return plan;
}

}  // namespace

const MotionPlan* MotionPlans::find(MotionGraphId graph, SkeletonId skeleton) const {
    for (const Entry& entry : entries) {
        if (entry.graph == graph && entry.skeleton == skeleton) {
            return entry.plan.get();
        }
    }
    return nullptr;
}

ClipCycle
make_clip_cycle(const ClipData& clip, std::span<const std::uint16_t> feet, std::size_t segments) {
    ClipCycle cycle;
    cycle.duration = clip.duration;
    cycle.marks.push_back(0.0f);
    bool in_order = clip.duration > 0.0f && feet.size() == segments;
    for (std::size_t i = 0; in_order && i < segments; ++i) {
        const float touchdown = touchdown_of(clip, feet[i]);
        if (i == 0) {
            cycle.offset = std::max(touchdown, 0.0f);
            in_order = touchdown >= 0.0f;
            continue;
        }
        const float mark = fraction(touchdown - cycle.offset);
        in_order = touchdown >= 0.0f && mark > cycle.marks.back() + kShortestSegment
                   && mark < 1.0f - kShortestSegment;
        cycle.marks.push_back(mark);
    }
    if (!in_order) {
        cycle.marks.resize(1);
        for (std::size_t i = 1; i < segments; ++i) {
            cycle.marks.push_back(static_cast<float>(i) / static_cast<float>(segments));
        }
    }
    cycle.marks.push_back(1.0f);
    return cycle;
}

float cycle_position(const ClipCycle& cycle, float phase, bool loop) {
    if (!loop || cycle.marks.size() < 2) {
        return phase;
    }
    const std::size_t segments = cycle.marks.size() - 1;
    const float scaled = phase * static_cast<float>(segments);
    const auto segment = std::min(static_cast<std::size_t>(std::max(scaled, 0.0f)), segments - 1);
    const float u = scaled - static_cast<float>(segment);
    return cycle.offset + cycle.marks[segment]
           + u * (cycle.marks[segment + 1] - cycle.marks[segment]);
}

float phase_at(const ClipCycle& cycle, float position, bool loop) {
    if (!loop || cycle.marks.size() < 2) {
        return std::clamp(position, 0.0f, 1.0f);
    }
    const float along = fraction(position - cycle.offset);
    const std::size_t segments = cycle.marks.size() - 1;
    std::size_t segment = 0;
    while (segment + 1 < segments && along >= cycle.marks[segment + 1]) {
        ++segment;
    }
    const float length = cycle.marks[segment + 1] - cycle.marks[segment];
    const float u = (along - cycle.marks[segment]) / length;
    return (static_cast<float>(segment) + u) / static_cast<float>(segments);
}

float time_at(const ClipCycle& cycle, float position, bool loop) {
    return cycle.duration * (loop ? fraction(position) : std::clamp(position, 0.0f, 1.0f));
}

MotionPlan
make_motion_plan(const MotionGraphData& graph, const SkeletonData& skeleton, const Assets& assets) {
    MotionPlan plan;
    const ClipFinder finder(graph, skeleton, assets, plan);
    std::vector<std::uint16_t> feet;
    for (const std::string& name : graph.feet) {
        feet.push_back(finder.joint(name, "feet"));
    }
    plan.feet = std::max<std::size_t>(feet.size(), 1);
    for (const GraphState& state : graph.states) {
        MotionPlan::State& planned = plan.states.emplace_back();
        for (const GraphClip& used : state.clips) {
            const ClipData* const clip = finder.find(used.clip, "state " + state.name);
            planned.fits.push_back(clip != nullptr ? 1 : 0);
            planned.cycles.push_back(
                clip != nullptr ? make_clip_cycle(*clip, feet, plan.feet) : ClipCycle{});
            planned.means.push_back(
                clip != nullptr ? mean_rotations(skeleton, *clip, plan.morphs)
                                : skeleton.rest.rotations);
        }
    }
    for (const GraphLayer& layer : graph.layers) {
        plan.layers.push_back(plan_layer(layer, finder, skeleton));
    }
    std::sort(plan.animated.begin(), plan.animated.end());
    plan.animated.erase(
        std::unique(plan.animated.begin(), plan.animated.end()), plan.animated.end());
    return plan;
}

}  // namespace limn
