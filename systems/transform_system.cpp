#include "systems/transform_system.h"

#include "ecs/base/jobs.h"
#include "systems/motion_kernels.h"

#include <algorithm>
#include <map>
#include <vector>

// Techniques: engine.object-step, engine.render-object

namespace limn {

namespace {

/// Work to do for a chunk.
enum class Work : std::uint8_t {
    None,     ///< at rest
    Settle,   ///< came to rest: previous = world
    Compute,  ///< something moved
};

/// Flags of an entity slot in this step.
enum : std::uint8_t { kMoved = 1 };

/// The jumps of one step: those requested, then also those of descendants.
class JumpTimes {
  public:
    /// Keeps the earliest jump.
    void add(Entity entity, float at) {
        const auto [found, added] = times_.try_emplace(entity, at);
        found->second = std::min(found->second, at);
    }
    [[nodiscard]] bool empty() const { return times_.empty(); }
    void add_descendants(std::span<const HierarchyNode> nodes) {
        for (const HierarchyNode& node : nodes) {  // parents first
            if (const auto found = times_.find(node.parent); found != times_.end()) {
                add(node.entity, found->second);
            }
        }
    }
    template <typename Visit>
    void each(Visit&& visit) const {
        for (const auto& [entity, at] : times_) {
            visit(entity, at);
        }
    }

  private:
    std::map<Entity, float> times_;
};

/// Flags by Entity::index; 0 if absent.
class SlotFlags {
  public:
    void set(Entity entity, std::uint8_t flags) {
        if (entity.index >= flags_.size()) {
            flags_.resize(entity.index + entity.index / 2 + 64, 0);
        }
        flags_[entity.index] |= flags;
    }
    [[nodiscard]] std::uint8_t get(Entity entity) const {
        return entity.index < flags_.size() ? flags_[entity.index] : std::uint8_t{0};
    }

  private:
    std::vector<std::uint8_t> flags_;
};

/// Components of a hierarchy node.
struct NodeBody {
    const Transform* local = nullptr;  ///< null: unchanged in this step
    const Affine* joint = nullptr;     ///< instead of `local`; null: not attached to a joint
    Affine* world = nullptr;
    Affine* previous = nullptr;
};

Work work_of(const ChunkView& chunk) {
    const std::uint32_t world = chunk.version<WorldTransform>();
    // Recomputing makes WorldTransform newer than all of its inputs; an input that is at least as
    // new changed later. Adding, removing or moving rows changes the version of all columns.
    const bool is_old = !is_newer(world, chunk.version<Transform>())
                        || (chunk.has<Parent>() && !is_newer(world, chunk.version<Parent>()));
    if (is_old) {
        return Work::Compute;
    }
    return is_newer(chunk.version<PreviousWorldTransform>(), world) ? Work::None : Work::Settle;
}

void settle(std::span<const WorldTransform> world, std::span<PreviousWorldTransform> previous) {
    for (std::size_t i = 0; i < world.size(); ++i) {
        previous[i].world = world[i].world;
    }
}

/// Updates the current and previous world matrix of one entity.
void step_body(const NodeBody& body, const Affine& world) {
    const bool fresh = body.previous->row[0] == Vec4(0);
    *body.previous = fresh ? world : *body.world;
    *body.world = world;
}

Affine local_matrix(const Transform& local) {
    return affine_from(local.position, local.rotation, local.scale);
}

/// The joints that entities are attached to. Their matrices may be sheared, which a Transform
/// cannot represent.
struct AttachedJoints {
    const Query<const JointAttachment>& attachments;
    const Query<const Pose>& poses;

    /// Null if the character has no such joint.
    [[nodiscard]] const Affine* of(Entity entity) const {
        const auto& attachment = *attachments.find<const JointAttachment>(entity);
        const auto* const pose = poses.find<const Pose>(attachment.character);
        return pose != nullptr && attachment.joint < pose->joints.size()
                   ? &pose->joints[attachment.joint]
                   : nullptr;
    }
};

/// Maps entity slots to hierarchy nodes.
class NodeNumbers {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    explicit NodeNumbers(std::span<const HierarchyNode> nodes) {
        for (std::uint32_t i = 0; i < nodes.size(); ++i) {
            const std::uint32_t slot = nodes[i].entity.index;
            if (slot >= node_of_slot_.size()) {
                node_of_slot_.resize(slot + slot / 2 + 64, kNone);
            }
            node_of_slot_[slot] = i;
        }
    }
    /// kNone: a root, or a child whose parent was destroyed.
    [[nodiscard]] std::uint32_t of(Entity entity) const {
        return entity.index < node_of_slot_.size() ? node_of_slot_[entity.index] : kNone;
    }

  private:
    std::vector<std::uint32_t> node_of_slot_;
};

/// Whether a child became a root because its parent was destroyed, which changes none of its own
/// components.
bool has_new_orphan(
    const ChunkView& chunk, const NodeNumbers& numbers, std::span<const Transform> local,
    std::span<const WorldTransform> world) {
    const std::span<const Entity> entities = chunk.entities();
    for (std::size_t i = 0; i < entities.size(); ++i) {
        if (numbers.of(entities[i]) == NodeNumbers::kNone) {
            const Affine matrix = local_matrix(local[i]);
            if (!std::equal(matrix.row, matrix.row + 3, world[i].world.row)) {
                return true;
            }
        }
    }
    return false;
}

/// One chunk of children: collects the components of those that change, and updates those whose
/// parent was destroyed. `joints`: null if they are not attached to any. Returns whether anything
/// changes.
bool collect_children(
    std::span<const Entity> entities, const NodeNumbers& numbers, const SlotFlags& flags,
    bool compute, const AttachedJoints* joints, std::span<const Transform> local,
    std::span<WorldTransform> world, std::span<PreviousWorldTransform> previous,
    std::vector<NodeBody>& node_bodies) {
    const bool moves = compute || std::any_of(entities.begin(), entities.end(), [&](Entity entity) {
                           return (flags.get(entity) & kMoved) != 0;
                       });
    for (std::size_t i = 0; moves && i < entities.size(); ++i) {
        const Affine* const joint = joints != nullptr ? joints->of(entities[i]) : nullptr;
        const NodeBody body = {&local[i], joint, &world[i].world, &previous[i].world};
        const std::uint32_t node = numbers.of(entities[i]);
        const bool moved = (flags.get(entities[i]) & kMoved) != 0;
        if (node == NodeNumbers::kNone && compute) {
            step_body(body, local_matrix(local[i]));
        } else if (node != NodeNumbers::kNone && moved) {
            node_bodies[node] = body;
        } else {
            *body.previous = *body.world;
        }
    }
    return moves;
}

/// The jumps of this step, with descendants; forgets those of the previous one.
JumpTimes take_jumps(
    const Query<const Transform, With<Teleport>>& teleports, StepJumps* jumps,
    std::span<const HierarchyNode> nodes, Commands& commands) {
    JumpTimes times;
    teleports.each([&](Entity entity, const Transform&) {
        times.add(entity, 0.0f);
        commands.remove<Teleport>(entity);
    });
    if (jumps != nullptr) {
        for (const JumpRequest& request : jumps->requests) {
            times.add(request.entity, request.at);
        }
        jumps->requests.clear();
        jumps->transforms.clear();
    }
    if (!times.empty()) {
        times.add_descendants(nodes);
    }
    return times;
}

}  // namespace

void add_world_transforms(
    Query<const Transform, Without<WorldTransform>> bare,
    Query<const Transform, Without<PreviousWorldTransform>> without_past, Commands commands) {
    bare.each([&](Entity entity, const Transform&) { commands.add(entity, WorldTransform{}); });
    without_past.each(
        [&](Entity entity, const Transform&) { commands.add(entity, PreviousWorldTransform{}); });
}

void update_transforms(
    TransformVersions versions,
    Query<const Transform, WorldTransform, PreviousWorldTransform> bodies,
    Query<const WorldTransform> worlds, Query<const Transform, With<Teleport>> teleports,
    Query<const JointAttachment> attachments, Query<const Pose> poses, OptionalRes<StepJumps> jumps,
    HierarchyRef hierarchy, Commands commands) {
    const std::span<const HierarchyNode> nodes = hierarchy->nodes();
    const NodeNumbers numbers(nodes);
    SlotFlags flags;
    const JumpTimes jump_times = take_jumps(teleports, jumps.get(), nodes, commands);

    // The work for each chunk and, if there is a hierarchy, which entities move.
    std::vector<Work> work(versions.chunk_count(), Work::None);
    bool any = false;
    versions.chunks([&](ChunkView chunk, std::span<const Transform> local,
                        std::span<const WorldTransform> world,
                        std::span<const PreviousWorldTransform>) {
        Work& wanted = work[chunk.index()];
        wanted = work_of(chunk);
        if (wanted != Work::Compute && chunk.has<Parent>()
            && has_new_orphan(chunk, numbers, local, world)) {
            wanted = Work::Compute;
        }
        any = any || wanted != Work::None;
        if (!nodes.empty() && wanted == Work::Compute) {
            for (const Entity entity : chunk.entities()) {
                flags.set(entity, kMoved);
            }
        }
    });
    if (!any) {
        return;
    }
    for (const HierarchyNode& node : nodes) {
        flags.set(node.entity, flags.get(node.parent));
    }

    // Roots; collects the children that change.
    const AttachedJoints joints{attachments, poses};
    std::vector<NodeBody> node_bodies(nodes.size());
    bodies.par_chunks([&](ChunkView chunk, std::span<const Transform> local,
                          std::span<WorldTransform> world,
                          std::span<PreviousWorldTransform> previous) {
        const Work wanted = work[chunk.index()];
        if (chunk.has<Parent>()) {
            if (collect_children(
                    chunk.entities(), numbers, flags, wanted == Work::Compute,
                    chunk.has<JointAttachment>() ? &joints : nullptr, local, world, previous,
                    node_bodies)) {
                return;
            }
        } else if (wanted == Work::Compute) {
            compose_worlds(local, world, previous);
            return;
        }
        chunk.mark_unchanged<WorldTransform>();
        if (wanted == Work::Settle) {
            settle(world, previous);
        } else {
            chunk.mark_unchanged<PreviousWorldTransform>();
        }
    });

    // Children, level by level. Those of one level are independent.
    for (std::uint32_t depth = 1; depth <= hierarchy->depth_count(); ++depth) {
        const std::span<const HierarchyNode> level = hierarchy->level(depth);
        const std::size_t first = static_cast<std::size_t>(level.data() - nodes.data());
        parallel_for(level.size(), 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const NodeBody& body = node_bodies[first + i];
                if (body.local == nullptr) {
                    continue;
                }
                const HierarchyNode& node = level[i];
                const Affine local =
                    body.joint != nullptr ? *body.joint : local_matrix(*body.local);
                const Affine* above = node.parent_node != HierarchyNode::kRoot
                                          ? node_bodies[node.parent_node].world
                                          : nullptr;
                if (above == nullptr) {  // a root, or a parent that does not move
                    const auto* parent = worlds.find<const WorldTransform>(node.parent);
                    above = parent != nullptr ? &parent->world : nullptr;
                }
                step_body(body, above != nullptr ? *above * local : local);
            }
        });
    }

    // Entities that jumped have no velocity.
    jump_times.each([&](Entity entity, float at) {
        const auto* const world = worlds.find<const WorldTransform>(entity);
        auto* const previous = bodies.find<PreviousWorldTransform>(entity);
        if (world == nullptr || previous == nullptr) {
            return;
        }
        if (jumps) {
            jumps->transforms.push_back({entity, at, previous->world});
        }
        previous->world = world->world;
    });
}

}  // namespace limn
