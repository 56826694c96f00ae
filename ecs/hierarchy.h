#pragma once

#include "ecs/base/result.h"
#include "ecs/system_param.h"
#include "ecs/world.h"

#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Parents and children. A link is stored in the child, as its Parent; the children of each entity
// and the top-down order in which matrices are computed are derived from all links and cached in
// the resource Hierarchy, which is rebuilt when a link changed. So entities, level files, Commands
// and snapshots treat Parent like any other component:
//
//     world.create(Transform{}, Parent{lamp_post});
//     commands.add(entity, Parent{other});
//     set_parent(world, child, parent);              // appends to the children; rejects cycles
//     for (Entity child : children_of(world, lamp_post)) ...
//
// A link to a destroyed entity is ignored: its children become roots, and their Transform, which
// was relative to the parent, is relative to the world from then on. A cycle, which only a Parent
// written directly can create, is logged as an error and broken at its lowest entity.

struct Parent {
    Entity entity;
    std::uint32_t order = 0;  ///< among siblings; ties are ordered by entity index
};

LIMN_FIELDS(Parent) {
    LIMN_FIELD(entity, "the parent entity");
    LIMN_FIELD(order, "position among its siblings");
}

/// Resource: the next Parent::order that set_parent assigns.
struct SiblingOrder {
    std::uint32_t next = 1;
};

LIMN_FIELDS(SiblingOrder) {
    LIMN_FIELD(next, "order assigned to the next child");
}

/// An entity whose parent is alive.
struct HierarchyNode {
    static constexpr std::uint32_t kRoot = 0xffffffffu;

    Entity entity;
    Entity parent;
    std::uint32_t parent_node = kRoot;  ///< parent's index in nodes(); kRoot: the parent is a root
    std::uint32_t depth = 1;            ///< number of links up to the root
};

/// All links of a world in top-down order.
class Hierarchy {
  public:
    /// By ascending depth; siblings are adjacent and in order.
    [[nodiscard]] std::span<const HierarchyNode> nodes() const { return nodes_; }
    /// The nodes of one depth, 1 .. depth_count(), which are independent of each other.
    [[nodiscard]] std::span<const HierarchyNode> level(std::uint32_t depth) const {
        return std::span<const HierarchyNode>(nodes_).subspan(
            level_begin_[depth - 1], level_begin_[depth] - level_begin_[depth - 1]);
    }
    [[nodiscard]] std::uint32_t depth_count() const {
        return static_cast<std::uint32_t>(level_begin_.size()) - 1;
    }
    [[nodiscard]] std::span<const Entity> children_of(Entity entity) const;
    /// Incremented by every rebuild.
    [[nodiscard]] std::uint64_t version() const { return version_; }

    /// Rebuilds if a link changed or a parent was destroyed since the last call. Otherwise cheap:
    /// checks every archetype with Parent and every parent. Later writes must have versions newer
    /// than `now`.
    void refresh(const World& world, std::uint32_t now);

  private:
    struct Link {
        Entity child;
        Entity parent;
        std::uint32_t order;
    };
    /// The links to one parent.
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
    bool break_cycle();

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

/// The up-to-date Hierarchy resource, inserted if missing.
[[nodiscard]] const Hierarchy& hierarchy(World& world);

/// Makes `child` the last child of `parent`, or a root if `parent` is null. Fails, and changes
/// nothing, if one of them is destroyed or if `parent` is `child` or its descendant.
[[nodiscard]] Status set_parent(World& world, Entity child, Entity parent);

/// Null for roots and if the parent is destroyed.
[[nodiscard]] Entity parent_of(const World& world, Entity entity);
/// In order; valid until the next change of the hierarchy.
[[nodiscard]] std::span<const Entity> children_of(World& world, Entity entity);
/// Number of links up to the root.
[[nodiscard]] std::uint32_t depth_of(const World& world, Entity entity);
/// The entity and its descendants, parents before children, siblings in order.
[[nodiscard]] std::vector<Entity> subtree_of(const Hierarchy& hierarchy, Entity root);
/// Destroys the entity and its descendants, children first.
void destroy_tree(World& world, Entity root);

/// The hierarchy as a system parameter: `void update_transforms(HierarchyRef hierarchy, ...)`.
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
    static void declare(SystemAccess& access);
    static void prepare(World& world);
    [[nodiscard]] static HierarchyRef
    get(World& world, std::uint32_t version, std::uint32_t last_version);
};

}  // namespace limn
