#include "systems/animation/pose_system.h"

#include "ecs/base/jobs.h"
#include "ecs/base/rotation.h"
#include "ecs/components/placement.h"
#include "systems/animation/clip_jumps.h"
#include "systems/animation/clip_sampling.h"
#include "systems/animation/crowd_library.h"
#include "systems/animation/graph/graph_pose.h"
#include "systems/animation/ik/plant_feet.h"
#include "systems/animation/ik/pose_ik.h"
#include "systems/animation/matching/match_handover.h"
#include "systems/animation/matching/match_step.h"
#include "systems/animation/pose_levels.h"
#include "systems/animation/ragdoll/ragdoll_pose.h"
#include "systems/animation/twist_pose.h"
#include "systems/animation/walk/apply_motor_pose.h"
#include "systems/animation/walk/walk_pose.h"

#include <algorithm>
#include <map>
#include <utility>

// Techniques: char.morph-anim

namespace limn {

namespace {

constexpr std::size_t kPoseGrain = 16;   ///< characters per task; each takes some microseconds
constexpr std::size_t kCrowdGrain = 64;  ///< those of a crowd take less, and not all are due

bool is_below(const std::vector<std::uint16_t>& numbers, std::size_t count) {
    return std::all_of(
        numbers.begin(), numbers.end(), [count](std::uint16_t number) { return number < count; });
}

bool fits(const ClipData& clip, std::size_t joints, std::size_t weights) {
    return std::all_of(clip.sheets.begin(), clip.sheets.end(), [=](const ClipSheet& sheet) {
        return is_below(sheet.rotating, joints) && is_below(sheet.translating, joints)
               && is_below(sheet.scaling, joints) && is_below(sheet.morphing, weights);
    });
}

bool has_weights(const ClipData& clip, std::size_t weights) {
    return std::all_of(clip.sheets.begin(), clip.sheets.end(), [=](const ClipSheet& sheet) {
        return is_below(sheet.morphing, weights);
    });
}

/// Entities whose pose is cut in this step: those with a PoseCut, and those with a Teleport and
/// their descendants.
class Cuts {
  public:
    Cuts(
        const Query<const Transform, With<Teleport>>& teleports, const Query<const Parent>& parents,
        const Query<const PoseCut>& cuts)
        : teleports_(teleports), parents_(parents), cuts_(cuts), any_teleport_(!teleports.empty()),
          any_cut_(!cuts.empty()) {}

    [[nodiscard]] bool has(Entity entity) const {
        if (any_cut_ && cuts_.find<const PoseCut>(entity) != nullptr) {
            return true;
        }
        while (any_teleport_) {
            if (teleports_.find<const Transform>(entity) != nullptr) {
                return true;
            }
            const Parent* const parent = parents_.find<const Parent>(entity);
            if (parent == nullptr) {
                return false;
            }
            entity = parent->entity;
        }
        return false;
    }

  private:
    const Query<const Transform, With<Teleport>>& teleports_;
    const Query<const Parent>& parents_;
    const Query<const PoseCut>& cuts_;
    bool any_teleport_;
    bool any_cut_;
};

template <typename T>
const T* find_asset(const std::vector<T>& assets, std::uint32_t index) {
    return index < assets.size() ? &assets[index] : nullptr;
}

/// The players of clips on a character, and the parameters of this step.
struct Playback {
    const ClipPlayer* player = nullptr;
    const MorphPlayer* morph_player = nullptr;
    bool is_cut = false;
    float step = 0;                         ///< [s]
    const CrowdPoseState* crowd = nullptr;  ///< from what it fades
    const ClipData* keys = nullptr;         ///< plays in place of the player's clip
};

/// Share of the clip that a crowd's character fades from: eases in and out.
float fade_share(const CrowdPoseState* crowd) {
    const float fade = crowd != nullptr ? std::clamp(crowd->fade, 0.0f, 1.0f) : 0.0f;
    return fade * fade * (3 - 2 * fade);
}

/// Joints and weights that jump in this step get no velocity. `pose`: null for an entity with
/// weights only.
void apply_jumps(
    const Assets& assets, const SkeletonData& skeleton, const Playback& playback, Pose* pose,
    MorphWeights* morph) {
    std::vector<float> joints;  // filled for the first clip that may jump, which is rare
    std::vector<float> weights;
    const auto find_jumps = [&](const auto& played, bool moves_joints) {
        const ClipData* const clip = moves_joints && playback.keys != nullptr
                                         ? playback.keys
                                         : find_asset(assets.clips, played.clip.index);
        const ClipStep step = clip_step(played, playback.step);
        if (clip == nullptr || !may_jump(*clip, step)) {
            return;
        }
        joints.resize(pose != nullptr ? skeleton.joints.size() : 0, kNoJump);
        weights.resize(morph != nullptr ? morph->weights.size() : 0, kNoJump);
        if (moves_joints && fits(*clip, joints.size(), weights.size())) {
            find_clip_jumps(*clip, step, joints, weights);
        } else if (!moves_joints && has_weights(*clip, weights.size())) {
            find_clip_jumps(*clip, step, {}, weights);
        }
    };
    if (playback.is_cut) {
        joints.resize(pose != nullptr ? skeleton.joints.size() : 0, 0.0f);
        weights.resize(morph != nullptr ? morph->weights.size() : 0, 0.0f);
    }
    if (playback.player != nullptr && !playback.is_cut) {
        find_jumps(*playback.player, true);
    }
    if (playback.morph_player != nullptr && !playback.is_cut) {
        for (const MorphAnimation& animation : playback.morph_player->animations) {
            find_jumps(animation, false);
        }
    }
    if (pose != nullptr) {
        const std::size_t posed = std::min(joints.size(), pose->joints.size());
        apply_joint_jumps(skeleton, std::span(joints).first(posed), *pose);
    }
    if (morph != nullptr) {
        apply_weight_jumps(weights, *morph);
    }
}

/// Makes the poses of the last step the previous ones, of the first `joints`. Returns whether there
/// was none.
bool begin_step(const SkeletonData& skeleton, std::size_t joints, Pose& pose, MorphWeights* morph) {
    const bool is_new = pose.joints.empty() || pose.joints.size() > skeleton.joints.size();
    if (pose.joints.size() != joints) {
        resize_pose(skeleton, joints, pose);
    }
    std::swap(pose.joints, pose.previous);
    pose.jumps.clear();
    if (morph != nullptr) {
        morph->previous = morph->weights;
        morph->jumps.clear();
    }
    return is_new;
}

/// After the joints were written.
void finish_step(
    const Assets& assets, const SkeletonData& skeleton, const Playback& playback, bool is_new,
    Pose& pose, MorphWeights* morph) {
    if (playback.morph_player != nullptr) {
        add_morph_animations(
            *playback.morph_player, assets.clips,
            morph != nullptr ? std::span<float>(morph->weights) : std::span<float>());
    }
    if (is_new) {
        pose.previous = pose.joints;
        if (morph != nullptr) {
            morph->previous = morph->weights;
        }
    } else {
        apply_jumps(assets, skeleton, playback, &pose, morph);
    }
}

/// What changes the local poses of characters.
class Modifiers {
  public:
    explicit Modifiers(const PoseModifiers& queries)
        : queries_(queries),
          any_(
              !queries.walks.empty() || !queries.plants.empty() || !queries.rigs.empty()
              || !queries.looks.empty() || !queries.reaches.empty() || !queries.ragdolls.empty()
              || !queries.twists.empty() || !queries.matches.empty()),
          any_graph_(!queries.graphs.empty()), any_keys_(!queries.keys.empty()),
          any_puppet_(!queries.puppets.empty()) {}

    [[nodiscard]] bool has(Entity entity) const {
        return (any_
                && (queries_.walks.contains(entity) || queries_.plants.contains(entity)
                    || queries_.rigs.contains(entity) || queries_.looks.contains(entity)
                    || queries_.reaches.contains(entity) || queries_.ragdolls.contains(entity)
                    || queries_.twists.contains(entity) || queries_.matches.contains(entity)))
               || (any_graph_ && queries_.graphs.contains(entity))
               || (any_keys_ && queries_.keys.contains(entity))
               || (any_puppet_ && queries_.puppets.contains(entity));
    }

    /// The pose that the character performs as a puppet; null: it does not.
    [[nodiscard]] const LocalPose* find_performed(Entity entity, std::size_t joints) const {
        const auto* const state =
            any_puppet_ ? queries_.puppets.find<const PuppetState>(entity) : nullptr;
        if (state == nullptr || !state->started) {
            return nullptr;
        }
        const LocalPose& pose = queries_.puppets.find<const PuppetBody>(entity)->pose;
        return pose.size() == joints ? &pose : nullptr;
    }

    /// The clip of the character's PoseKeys; null: it has none.
    [[nodiscard]] const ClipData* find_keys(Entity entity, SkeletonId skeleton) const {
        const auto* const state =
            any_keys_ ? queries_.keys.find<const PoseKeysState>(entity) : nullptr;
        return state != nullptr && state->skeleton == skeleton ? &state->clip : nullptr;
    }

    /// The pose of the character's motion graph; false: it has none.
    bool sample_graph(
        Entity entity, SkeletonId skeleton, const Assets& assets, LocalPose& pose,
        std::span<float> weights, bool& is_cut) const {
        return any_graph_
               && sample_motion_graph(
                   queries_.graphs, queries_.graph_data.get(), queries_.plans.get(), assets, entity,
                   skeleton, pose, weights, is_cut);
    }

    /// Whether motion matching has changed its pose without a blend.
    [[nodiscard]] bool is_cut(Entity entity) const {
        const auto* const state =
            any_ ? queries_.matches.find<const MotionMatchState>(entity) : nullptr;
        return state != nullptr && state->cut != 0;
    }

    /// Applies what the character has, in this order. `last`: joint matrices of the last step,
    /// empty in the first; `step` [s].
    void apply(
        Entity entity, const SkeletonData& skeleton, std::span<const Affine> last, float step,
        LocalPose& pose) const {
        if (!any_) {
            return;
        }
        MatchHandover* const handover = queries_.handovers.find<MatchHandover>(entity);
        const MatchPose* const match = queries_.matches.find<const MatchPose>(entity);
        const bool away =
            match != nullptr && queries_.matches.find<const MotionMatchState>(entity)->away != 0;
        if (match != nullptr && !away) {
            apply_match_pose(*match, pose);
        }
        if (const Walk* const walk = queries_.walks.find<const Walk>(entity)) {
            if (handover == nullptr || away) {
                apply_walk(
                    skeleton, *walk, *queries_.walks.find<const WalkState>(entity),
                    *queries_.walks.find<const WalkBody>(entity), pose);
            }
            if (const MotorPose* const motor = queries_.motor_poses.find<const MotorPose>(entity)) {
                apply_motor_pose(
                    skeleton, *motor, *queries_.motor_poses.find<const MotorPoseState>(entity),
                    *queries_.walks.find<const WalkBody>(entity), pose);
            }
            if (handover != nullptr) {
                step_handover(
                    skeleton, *queries_.walks.find<const WalkBody>(entity), away, step, *handover,
                    pose);
            }
        }
        if (const FootPlant* const plant = queries_.plants.find<const FootPlant>(entity)) {
            const FootContacts* const contacts = queries_.plants.find<const FootContacts>(entity);
            apply_foot_plant(skeleton, *plant, *contacts, pose);
        }
        if (const IkRig* const rig = queries_.rigs.find<const IkRig>(entity)) {
            apply_ik_rig(skeleton, *rig, *queries_.rigs.find<const IkGoals>(entity), last, pose);
        }
        if (const ReachGoal* const goal = queries_.reaches.find<const ReachGoal>(entity)) {
            apply_reach(skeleton, *goal, *queries_.reaches.find<const ReachState>(entity), pose);
        }
        if (const LookAt* const look = queries_.looks.find<const LookAt>(entity)) {
            apply_look_at(skeleton, *look, *queries_.looks.find<const Gaze>(entity), pose);
        }
        if (const RagdollState* const body = queries_.ragdolls.find<const RagdollState>(entity)) {
            apply_ragdoll(skeleton, *body, pose);
        }
        if (const TwistJoints* const twist = queries_.twists.find<const TwistJoints>(entity)) {
            const TwistLinks* const found = queries_.twists.find<const TwistLinks>(entity);
            apply_twist_joints(skeleton, found->links, twist->weight, pose);
        }
    }

  private:
    const PoseModifiers& queries_;
    bool any_;
    bool any_graph_;
    bool any_keys_;
    bool any_puppet_;
};

/// Blends in what a crowd's character played before.
void fade_from(
    const Assets& assets, const SkeletonData& skeleton, const CrowdPoseState* crowd,
    LocalPose& pose) {
    const float share = fade_share(crowd);
    const ClipData* const clip = share > 0 ? find_asset(assets.clips, crowd->from.index) : nullptr;
    if (clip == nullptr) {
        return;
    }
    thread_local LocalPose from;  // reused between characters
    sample_pose(skeleton, clip, crowd->from_time, from, {});
    for (std::size_t j = 0; j < pose.size(); ++j) {
        pose.rotations[j] = nlerp(pose.rotations[j], from.rotations[j], share);
        pose.translations[j] = glm::mix(pose.translations[j], from.translations[j], share);
    }
}

/// Samples the graph or the clip of one character that has a Pose, and applies its modifiers.
void step_character(
    const Assets& assets, Entity entity, SkeletonId id, Playback playback,
    const Modifiers& modifiers, Pose& pose, MorphWeights* morph) {
    thread_local LocalPose scratch;  // reused between characters
    const SkeletonData& skeleton = assets.skeletons[id.index];
    const bool is_new = begin_step(skeleton, skeleton.joints.size(), pose, morph);
    const std::span<float> weights =
        morph != nullptr ? std::span<float>(morph->weights) : std::span<float>();
    if (const LocalPose* const performed =
            modifiers.find_performed(entity, skeleton.joints.size())) {
        scratch = *performed;
        playback.player = nullptr;
    } else if (modifiers.sample_graph(entity, id, assets, scratch, weights, playback.is_cut)) {
        playback.player = nullptr;
    } else {
        const ClipPlayer* const player = playback.player;
        playback.keys = modifiers.find_keys(entity, id);
        const ClipData* const clip = playback.keys != nullptr ? playback.keys
                                     : player != nullptr
                                         ? find_asset(assets.clips, player->clip.index)
                                         : nullptr;
        sample_pose(skeleton, clip, player != nullptr ? player->time : 0.0f, scratch, weights);
        if (playback.keys == nullptr) {
            fade_from(assets, skeleton, playback.crowd, scratch);
        }
    }
    playback.is_cut = playback.is_cut || modifiers.is_cut(entity);
    modifiers.apply(
        entity, skeleton, is_new ? std::span<const Affine>() : pose.previous, playback.step,
        scratch);
    compute_joint_matrices(skeleton, scratch, pose.joints);
    finish_step(assets, skeleton, playback, is_new, pose, morph);
}

/// A character that keeps its pose in this step.
void hold_character(Pose& pose, MorphWeights* morph) {
    pose.previous = pose.joints;
    pose.jumps.clear();
    if (morph != nullptr) {
        morph->previous = morph->weights;
        morph->jumps.clear();
    }
}

/// The characters of a chunk; spans of what they do not have are empty.
struct CharacterSpans {
    std::span<const Entity> entities;
    std::span<const Skeleton> skeletons;
    std::span<const ClipPlayer> players;
    std::span<const MorphPlayer> morph_players;
    std::span<const CrowdPose> crowds;
    std::span<const CrowdPoseState> crowd_states;
    std::span<MorphWeights> morphs;
    std::span<Pose> poses;

    [[nodiscard]] MorphWeights* morph(std::size_t i) const {
        return morphs.empty() ? nullptr : &morphs[i];
    }
    [[nodiscard]] Playback playback(std::size_t i, const Cuts& cuts, float step) const {
        return {
            players.empty() ? nullptr : &players[i],
            morph_players.empty() ? nullptr : &morph_players[i],
            cuts.has(entities[i]),
            step,
            crowd_states.empty() ? nullptr : &crowd_states[i],
            nullptr};
    }
};

/// Poses characters of crowds: those of one skeleton that are due together.
class CrowdStepper {
  public:
    CrowdStepper(
        const CharacterSpans& all, const Assets& assets, const CrowdLibrary* library,
        const Cuts& cuts, const Modifiers& modifiers, const FrameTime& time)
        : all_(all), assets_(assets), library_(library), cuts_(cuts), modifiers_(modifiers),
          time_(time) {}

    void step(std::size_t begin, std::size_t end) const {
        thread_local std::vector<Due> due;
        for (std::size_t i = begin; i < end; ++i) {
            const SkeletonData* const skeleton =
                find_asset(assets_.skeletons, all_.skeletons[i].skeleton.index);
            if (skeleton == nullptr) {
                continue;
            }
            Playback playback = all_.playback(i, cuts_, time_.step);
            Pose& pose = all_.poses[i];
            const std::size_t joints = posed_joints(playback.crowd, *skeleton);
            if (!is_due(i, playback, has_joints(pose, joints, *skeleton))) {
                hold_character(pose, all_.morph(i));
                continue;
            }
            if (!all_.crowd_states.empty()) {  // what it plays since its last pose
                playback.step *= static_cast<float>(all_.crowd_states[i].interval);
            }
            const CrowdClip* const clip = find_clip(i, joints, playback, *skeleton);
            if (clip == nullptr) {
                step_character(
                    assets_, all_.entities[i], all_.skeletons[i].skeleton, playback, modifiers_,
                    pose, all_.morph(i));
                continue;
            }
            const bool is_new = begin_step(*skeleton, joints, pose, all_.morph(i));
            due.push_back({i, skeleton, clip, playback, is_new});
        }
        pose_alike(due);
        due.clear();
    }

  private:
    struct Due {
        std::size_t index;
        const SkeletonData* skeleton;
        const CrowdClip* clip;
        Playback playback;
        bool is_new;
    };

    [[nodiscard]] static bool
    has_joints(const Pose& pose, std::size_t joints, const SkeletonData& skeleton) {
        return pose.joints.size() >= joints && pose.joints.size() <= skeleton.joints.size();
    }

    [[nodiscard]] bool is_due(std::size_t i, const Playback& playback, bool has_pose) const {
        return !has_pose || playback.is_cut || all_.crowd_states.empty()
               || is_pose_due(all_.crowd_states[i], all_.entities[i], time_.frame);
    }

    [[nodiscard]] const CrowdClip* find_clip(
        std::size_t i, std::size_t joints, const Playback& playback,
        const SkeletonData& skeleton) const {
        if (library_ == nullptr || playback.player == nullptr || !all_.crowds[i].compressed
            || modifiers_.has(all_.entities[i])) {
            return nullptr;
        }
        const CrowdLibrary::Entry* const entry =
            library_->find(all_.skeletons[i].skeleton, playback.player->clip);
        const ClipData* const source = find_asset(assets_.clips, playback.player->clip.index);
        const MorphWeights* const morph = all_.morph(i);
        const bool fits = entry != nullptr && entry->clip != nullptr && source != nullptr
                          && entry->clip->joints == skeleton.joints.size()
                          && library_->find_rig(all_.skeletons[i].skeleton, joints) != nullptr
                          && has_weights(*source, morph != nullptr ? morph->weights.size() : 0);
        return fits ? entry->clip.get() : nullptr;
    }

    /// Poses those of one skeleton with as many joints together.
    void pose_alike(std::vector<Due>& due) const {
        const auto key = [this](const Due& each) {
            return std::pair(
                all_.skeletons[each.index].skeleton.index, all_.poses[each.index].joints.size());
        };
        std::sort(due.begin(), due.end(), [&key](const Due& a, const Due& b) {
            return std::pair(key(a), a.index) < std::pair(key(b), b.index);
        });
        for (std::size_t begin = 0; begin < due.size();) {
            std::size_t end = begin + 1;
            while (end < due.size() && key(due[end]) == key(due[begin])) {
                ++end;
            }
            pose_together(std::span(due).subspan(begin, end - begin));
            begin = end;
        }
    }

    void pose_together(std::span<const Due> due) const {
        thread_local std::vector<CrowdCharacter> characters;
        characters.clear();
        for (const Due& each : due) {
            const CrowdPoseState* const state = each.playback.crowd;
            const float share = fade_share(state);
            const CrowdLibrary::Entry* const from =
                share > 0 ? library_->find(all_.skeletons[each.index].skeleton, state->from)
                          : nullptr;
            characters.push_back(
                {.clip = each.clip,
                 .time = each.playback.player->time,
                 .next = from != nullptr ? from->clip.get() : nullptr,
                 .next_time = from != nullptr ? state->from_time : 0.0f,
                 .weight = share,
                 .joints = all_.poses[each.index].joints.data()});
        }
        pose_crowd(
            *library_->find_rig(
                all_.skeletons[due[0].index].skeleton, all_.poses[due[0].index].joints.size()),
            characters);
        for (const Due& each : due) {
            if (MorphWeights* const morph = all_.morph(each.index); morph != nullptr) {
                const ClipPlayer& player = *each.playback.player;
                sample_clip_weights(assets_.clips[player.clip.index], player.time, morph->weights);
            }
            finish_step(
                assets_, *each.skeleton, each.playback, each.is_new, all_.poses[each.index],
                all_.morph(each.index));
        }
    }

    const CharacterSpans& all_;
    const Assets& assets_;
    const CrowdLibrary* library_;
    const Cuts& cuts_;
    const Modifiers& modifiers_;
    const FrameTime time_;
};

/// The same for an entity with morph targets only.
void step_weights(const Assets& assets, const Playback& playback, MorphWeights& morph) {
    static const SkeletonData kNoJoints;
    const ClipPlayer* const player = playback.player;
    const MorphPlayer* const morph_player = playback.morph_player;
    const bool is_new = morph.previous.size() != morph.weights.size();
    morph.previous = morph.weights;
    morph.jumps.clear();
    if (player != nullptr) {
        LocalPose none;
        const ClipData* const clip = find_asset(assets.clips, player->clip.index);
        evaluate_pose(kNoJoints, clip, player->time, none, {}, morph.weights);
    }
    if (morph_player != nullptr) {
        add_morph_animations(*morph_player, assets.clips, morph.weights);
    }
    if (is_new) {
        morph.previous = morph.weights;
    } else {
        apply_jumps(assets, kNoJoints, playback, nullptr, &morph);
    }
}

}  // namespace

void add_poses(
    Query<const Skeleton, Without<Pose>> bare, Query<const Deformed, const MeshInstance> meshes,
    Query<const Deformed, const ControlSurface> surfaces,
    Query<const Deformed, const MeshLevels, With<MorphPlayer>> levels,
    Query<const MorphWeights> weights, Res<const Assets> assets, Commands commands) {
    if (bare.empty()) {
        return;
    }
    bare.each([&](Entity entity, const Skeleton&) { commands.add(entity, Pose{}); });
    std::map<Entity, std::size_t> counts;
    const auto count_targets = [&](const Deformed& deformed, MeshId id) {
        const MeshData* const mesh = find_asset(assets->meshes, id.index);
        if (mesh != nullptr && !mesh->morphs.empty()
            && bare.find<const Skeleton>(deformed.character) != nullptr
            && weights.find<const MorphWeights>(deformed.character) == nullptr) {
            std::size_t& count = counts[deformed.character];
            count = std::max(count, deformed.first_morph + mesh->morphs.size());
        }
    };
    meshes.each([&](const Deformed& deformed, const MeshInstance& instance) {
        count_targets(deformed, instance.mesh);
    });
    surfaces.each([&](const Deformed& deformed, const ControlSurface& surface) {
        count_targets(deformed, surface.mesh);
    });
    levels.each([&](const Deformed& deformed, const MeshLevels& each) {
        for (const MeshId mesh : each.meshes) {
            count_targets(deformed, mesh);
        }
    });
    for (const auto& [character, count] : counts) {
        commands.add(character, MorphWeights{std::vector<float>(count, 0.0f), {}});
    }
}

void update_poses(
    Query<
        const Skeleton, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        Optional<const CrowdPose>, Optional<const CrowdPoseState>, Optional<MorphWeights>, Pose>
        characters,
    Query<
        MorphWeights, Optional<const ClipPlayer>, Optional<const MorphPlayer>,
        AnyOf<ClipPlayer, MorphPlayer>, Without<Skeleton>>
        faces,
    Query<const Transform, With<Teleport>> teleports, Query<const Parent> parents,
    Query<const PoseCut> pose_cuts, PoseModifiers pose_modifiers, Res<const Assets> assets,
    OptionalRes<const FrameTime> time, OptionalRes<const CrowdLibrary> crowds, Commands commands) {
    const Cuts cuts(teleports, parents, pose_cuts);
    const Modifiers modifiers(pose_modifiers);
    const FrameTime now = time ? *time : FrameTime{.step = 0.0f};
    pose_cuts.each([&](Entity entity, const PoseCut&) { commands.remove<PoseCut>(entity); });
    characters.chunks(
        [&](ChunkView chunk, std::span<const Skeleton> skeletons,
            std::span<const ClipPlayer> players, std::span<const MorphPlayer> morph_players,
            std::span<const CrowdPose> crowd_poses, std::span<const CrowdPoseState> crowd_states,
            std::span<MorphWeights> morphs, std::span<Pose> poses) {
            const CharacterSpans all = {chunk.entities(), skeletons,    players, morph_players,
                                        crowd_poses,      crowd_states, morphs,  poses};
            if (!crowd_poses.empty()) {
                const CrowdStepper stepper(all, *assets, crowds.get(), cuts, modifiers, now);
                parallel_for(poses.size(), kCrowdGrain, [&](std::size_t begin, std::size_t end) {
                    stepper.step(begin, end);
                });
                return;
            }
            parallel_for(poses.size(), kPoseGrain, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) {
                    const SkeletonId skeleton = skeletons[i].skeleton;
                    if (skeleton.index < assets->skeletons.size()) {
                        step_character(
                            *assets, all.entities[i], skeleton, all.playback(i, cuts, now.step),
                            modifiers, poses[i], all.morph(i));
                    }
                }
            });
        });
    faces.each([&](Entity entity, MorphWeights& morph, const ClipPlayer* player,
                   const MorphPlayer* morph_player) {
        step_weights(*assets, {player, morph_player, cuts.has(entity), now.step}, morph);
    });
}

void update_attachments(
    Query<const JointAttachment, Transform> attached, Query<const Pose> poses,
    OptionalRes<StepJumps> jumps) {
    attached.par_each([&](const JointAttachment& attachment, Transform& transform) {
        const Pose* const pose = poses.find<const Pose>(attachment.character);
        if (pose != nullptr && attachment.joint < pose->joints.size()) {
            transform = decompose_affine(pose->joints[attachment.joint]);
        }
    });
    bool any = false;
    poses.each([&any](const Pose& pose) { any |= !pose.jumps.empty(); });
    if (!any || !jumps) {
        return;
    }
    attached.each([&](Entity entity, const JointAttachment& attachment, const Transform&) {
        const Pose* const pose = poses.find<const Pose>(attachment.character);
        const auto* const jump =
            pose != nullptr ? find_jump(pose->jumps, attachment.joint) : nullptr;
        if (jump != nullptr) {
            jumps->requests.push_back({entity, jump->at});
        }
    });
}

void add_morph_animations(
    const MorphPlayer& player, const std::vector<ClipData>& clips, std::span<float> weights) {
    const auto each_clip = [&](auto&& visit) {
        for (const MorphAnimation& animation : player.animations) {
            const ClipData* const clip = find_asset(clips, animation.clip.index);
            if (clip != nullptr && has_weights(*clip, weights.size())) {
                visit(animation, *clip);
            }
        }
    };
    each_clip([&](const MorphAnimation&, const ClipData& clip) {
        for (const ClipSheet& sheet : clip.sheets) {
            for (const std::uint16_t target : sheet.morphing) {
                weights[target] = 0.0f;
            }
        }
    });
    each_clip([&](const MorphAnimation& animation, const ClipData& clip) {
        add_morph_weights(clip, animation.time, animation.weight, weights);
    });
}

void sample_pose(
    const SkeletonData& skeleton, const ClipData* clip, float time, LocalPose& pose,
    std::span<float> weights) {
    pose.translations = skeleton.rest.translations;
    pose.rotations = skeleton.rest.rotations;
    pose.scales = skeleton.rest.scales;
    if (clip != nullptr && fits(*clip, pose.size(), weights.size())) {
        sample_clip(*clip, time, pose, weights);
    }
}

void evaluate_pose(
    const SkeletonData& skeleton, const ClipData* clip, float time, LocalPose& scratch,
    std::span<Affine> joints, std::span<float> weights) {
    sample_pose(skeleton, clip, time, scratch, weights);
    compute_joint_matrices(skeleton, scratch, joints);
}

}  // namespace limn
