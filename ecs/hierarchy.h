#pragma once

#include "ecs/base/result.h"
#include "ecs/system_param.h"
#include "ecs/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Parents and children. A link is data of the child, its Parent; who the children of an entity are,
// and the order from the roots down in which matrices are computed, follows from all links and is
// kept in the resource Hierarchy, which is rebuilt when a link changed. So entities, level files,
// Commands and snapshots deal with Parent like with any component:
//
//     world.create(Transform{}, Parent{lamp_post});
//     commands.add(entity, Parent{other});
//     set_parent(world, child, parent);                  behind the children there are; refuses
//     cycles for (Entity child : children_of(world, lamp_post)) ...
//
// A link to an entity that is gone does not count: its children become roots, where they are. A
// cycle, which only a Parent written directly can close, is reported as an error in the log and
// opened at its lowest entity.

struct Parent {
    Entity entity;
    std::uint32_t order = 0;  ///< among siblings; equal ones are in the order of their index
};

template <typename Visitor>
void visit_fields(Parent& parent, Visitor&& visit) {
    visit("entity", parent.entity, {.doc = "whose child it is"});
    visit("order", parent.order, {.doc = "place among its siblings"});
}

/// Resource: the next Parent::order that set_parent gives.
struct SiblingOrder {
    std::uint32_t next = 1;
};

template <typename Visitor>
void visit_fields(SiblingOrder& order, Visitor&& visit) {
    visit("next", order.next, {.doc = "order of the next child"});
}

/// An entity with a parent that is alive.
struct HierarchyNode {
    static constexpr std::uint32_t kRoot = 0xffffffffu;

    Entity entity;
    Entity parent;
    std::uint32_t parent_node =
        kRoot;                ///< index of the parent in nodes(); kRoot: the parent has no parent
    std::uint32_t depth = 1;  ///< links up to the root
};

/// All links of a world, from the roots down.
class Hierarchy {
  public:
    /// Ascending depth; siblings side by side and in their order.
    [[nodiscard]] std::span<const HierarchyNode> nodes() const { return nodes_; }
    /// The nodes of one depth, 1 .. depth_count(): they do not depend on each other.
    [[nodiscard]] std::span<const HierarchyNode> level(std::uint32_t depth) const {
        return std::span<const HierarchyNode>(nodes_).subspan(
            level_begin_[depth - 1], level_begin_[depth] - level_begin_[depth - 1]);
    }
    [[nodiscard]] std::uint32_t depth_count() const {
        return static_cast<std::uint32_t>(level_begin_.size()) - 1;
    }
    [[nodiscard]] std::span<const Entity> children_of(Entity entity) const;
    /// Raised by every rebuild.
    [[nodiscard]] std::uint64_t version() const { return version_; }

    /// Rebuilds if a link, or the life of a parent, changed since the last call. Cheap if not: a
    /// look at every archetype with Parent and at every parent. `now`: what is written later has a
    /// later version.
    void refresh(const World& world, std::uint32_t now);

  private:
    struct Link {
        Entity child;
        Entity parent;
        std::uint32_t order;
    };
    /// Links of one parent.
    struct Group {
        Entity parent;
        std::uint32_t first_link;
        std::uint32_t count;
        std::uint32_t first_node;
    };
    static constexpr std::uint32_t kNoGroup = 0xffffffffu;

    [[nodiscard]] bool is_current(const World& world) const;
    [[nodiscard]] std::uint32_t group_of(Entity parent) const;
    void collect_links(const World& world);
    void group_links();
    void walk_down();
    void add_children(std::uint32_t group, std::uint32_t parent_node, std::uint32_t depth);
    bool open_cycle();

    std::vector<HierarchyNode> nodes_;
    std::vector<Entity> children_;  ///< entity of each node
    std::vector<std::uint32_t> level_begin_ = {0};
    std::vector<Group> groups_;
    std::vector<std::uint32_t> group_of_slot_;  ///< by entity index
    std::vector<Link> links_;
    std::uint64_t version_ = 0;
    std::uint32_t seen_version_ = 0;
    std::uint32_t seen_epoch_ = 0;
    std::size_t seen_rows_ = 0;
    bool was_built_ = false;
};

/// Up to date; inserted where there is none.
[[nodiscard]] const Hierarchy& hierarchy(World& world);

/// Makes `child` the last child of `parent`, or a root where `parent` is null. Fails, and changes
/// nothing, if one of them is gone or `parent` is `child` or below it.
[[nodiscard]] Status set_parent(World& world, Entity child, Entity parent);

/// Null for roots, and where the parent is gone.
[[nodiscard]] Entity parent_of(const World& world, Entity entity);
/// In order; good until the next change of the hierarchy.
[[nodiscard]] std::span<const Entity> children_of(World& world, Entity entity);
/// Links up to the root.
[[nodiscard]] std::uint32_t depth_of(const World& world, Entity entity);
/// The entity and everything below it, parents before children, siblings in order.
[[nodiscard]] std::vector<Entity> subtree_of(const Hierarchy& hierarchy, Entity root);
/// Destroys the entity and everything below it, children first.
void destroy_tree(World& world, Entity root);

/// The hierarchy as a parameter of a system: `void update_transforms(HierarchyRef hierarchy, ...)`.
/// Up to date when the system starts. Counts as reading Parent.
class HierarchyRef {
  public:
    explicit HierarchyRef(const Hierarchy& hierarchy) : hierarchy_(&hierarchy) {}
    const Hierarchy* operator->() const { return hierarchy_; }
    const Hierarchy& operator*() const { return *hierarchy_; }

  private:
    const Hierarchy* hierarchy_;
};

template <>
struct SystemParam<HierarchyRef> {
    static void declare(SystemAccess& access) {
        access.reads.push_back(component_id<Parent>);
        access.resource_writes.push_back(component_id<Hierarchy>);
    }
    void prepare(World& world) {
        if (world.find_resource<Hierarchy>() == nullptr) {
            world.insert_resource(Hierarchy{});
        }
    }
    HierarchyRef get(World& world, std::uint32_t version, std::uint32_t) {
        Hierarchy& present = world.resource<Hierarchy>();
        // Not this moment: the version of a system behind this one may have been given out already.
        present.refresh(world, version);
        return HierarchyRef(present);
    }
};

}  // namespace limn
