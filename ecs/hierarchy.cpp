#include "ecs/hierarchy.h"

#include "ecs/base/log.h"

#include <algorithm>

// Techniques: engine.render-object

namespace limn {

namespace {

std::string name_of(Entity entity) {
    return format_text("entity {} v{}", entity.index, entity.generation);
}

}  // namespace

std::span<const Entity> Hierarchy::children_of(Entity entity) const {
    const std::uint32_t group = group_of(entity);
    if (group == kNoGroup) {
        return {};
    }
    return std::span<const Entity>(children_).subspan(
        groups_[group].first_node, groups_[group].count);
}

std::uint32_t Hierarchy::group_of(Entity parent) const {
    const std::uint32_t group =
        parent.index < group_of_slot_.size() ? group_of_slot_[parent.index] : kNoGroup;
    return group != kNoGroup && groups_[group].parent == parent ? group : kNoGroup;
}

bool Hierarchy::is_current(const World& world) const {
    if (!was_built_ || seen_epoch_ != world.core().epoch) {
        return false;
    }
    std::size_t rows = 0;
    for (const auto& archetype : world.archetypes()) {
        const int column = archetype->column_of(component_id<Parent>);
        if (column == kNoColumn) {
            continue;
        }
        rows += archetype->size();
        if (is_newer(archetype->newest_version(column), seen_version_)) {
            return false;
        }
    }
    return rows == seen_rows_
           && std::all_of(groups_.begin(), groups_.end(), [&world](const Group& group) {
                  return world.alive(group.parent);
              });
}

void Hierarchy::refresh(const World& world, std::uint32_t now) {
    if (is_current(world)) {
        return;
    }
    collect_links(world);
    do {
        group_links();
        walk_down();
    } while (nodes_.size() < links_.size() && break_cycle());

    ++version_;
    seen_version_ = now;
    seen_epoch_ = world.core().epoch;
    was_built_ = true;
}

void Hierarchy::collect_links(const World& world) {
    links_.clear();
    seen_rows_ = 0;
    for (const auto& archetype : world.archetypes()) {
        const int column = archetype->column_of(component_id<Parent>);
        if (column == kNoColumn) {
            continue;
        }
        const auto* const parents = reinterpret_cast<const Parent*>(archetype->column(column).data);
        const std::span<const Entity> children = archetype->entities();
        for (std::size_t row = 0; row < children.size(); ++row) {
            if (world.alive(parents[row].entity)) {
                links_.push_back({children[row], parents[row].entity, parents[row].order});
            }
        }
        seen_rows_ += children.size();
    }
    std::sort(links_.begin(), links_.end(), [](const Link& a, const Link& b) {
        if (a.parent.index != b.parent.index) {
            return a.parent.index < b.parent.index;
        }
        return a.order != b.order ? a.order < b.order : a.child.index < b.child.index;
    });
}

void Hierarchy::group_links() {
    groups_.clear();
    std::uint32_t slots = 0;
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
        if (groups_.empty() || groups_.back().parent != links_[i].parent) {
            groups_.push_back({links_[i].parent, i, 0, 0});
        }
        ++groups_.back().count;
        slots = std::max(slots, links_[i].parent.index + 1);
    }
    group_of_slot_.assign(slots, kNoGroup);
    for (std::uint32_t i = 0; i < groups_.size(); ++i) {
        group_of_slot_[groups_[i].parent.index] = i;
    }
}

void Hierarchy::add_children(std::uint32_t group, std::uint32_t parent_node, std::uint32_t depth) {
    Group& children = groups_[group];
    children.first_node = static_cast<std::uint32_t>(nodes_.size());
    for (std::uint32_t i = 0; i < children.count; ++i) {
        const Link& link = links_[children.first_link + i];
        nodes_.push_back({link.child, link.parent, parent_node, depth});
        children_.push_back(link.child);
    }
}

void Hierarchy::walk_down() {
    nodes_.clear();
    children_.clear();
    level_begin_.assign(1, 0);

    std::vector<bool> has_parent(group_of_slot_.size(), false);
    for (const Link& link : links_) {
        if (link.child.index < has_parent.size()) {
            has_parent[link.child.index] = true;
        }
    }
    for (std::uint32_t group = 0; group < groups_.size(); ++group) {  // ascending index of the root
        if (!has_parent[groups_[group].parent.index]) {
            add_children(group, HierarchyNode::kRoot, 1);
        }
    }
    std::uint32_t begin = 0;
    for (std::uint32_t depth = 1; begin < nodes_.size(); ++depth) {
        const auto end = static_cast<std::uint32_t>(nodes_.size());
        level_begin_.push_back(end);
        for (std::uint32_t node = begin; node < end; ++node) {
            if (const std::uint32_t group = group_of(nodes_[node].entity); group != kNoGroup) {
                add_children(group, node, depth + 1);
            }
        }
        begin = end;
    }
}

bool Hierarchy::break_cycle() {
    // Every unreached entity has a chain of parents that ends in a cycle. Ignore the link of the
    // lowest entity on a cycle in this hierarchy; its Parent component does not change.
    std::vector<Entity> reached = children_;
    std::sort(reached.begin(), reached.end());
    std::vector<Link> open;
    for (const Link& link : links_) {
        if (!std::binary_search(reached.begin(), reached.end(), link.child)) {
            open.push_back(link);
        }
    }
    std::sort(
        open.begin(), open.end(), [](const Link& a, const Link& b) { return a.child < b.child; });
    const auto link_of = [&open](Entity child) {
        return std::lower_bound(
            open.begin(), open.end(), child,
            [](const Link& link, Entity entity) { return link.child < entity; });
    };
    // After as many steps up as there are links we are on the cycle; walk around it once to find
    // its lowest entity.
    Entity on_cycle = open.front().child;
    for (std::size_t i = 0; i < open.size(); ++i) {
        on_cycle = link_of(on_cycle)->parent;
    }
    Entity lowest = on_cycle;
    for (Entity entity = link_of(on_cycle)->parent; entity != on_cycle;
         entity = link_of(entity)->parent) {
        lowest = std::min(lowest, entity);
    }
    log_error("hierarchy: {} is its own ancestor; it is treated as a root", name_of(lowest));
    std::erase_if(links_, [lowest](const Link& link) { return link.child == lowest; });
    return true;
}

const Hierarchy& hierarchy(World& world) {
    Hierarchy* present = world.find_resource<Hierarchy>();
    if (present == nullptr) {
        present = &world.insert_resource(Hierarchy{});
    }
    present->refresh(world, world.version());
    return *present;
}

Status set_parent(World& world, Entity child, Entity parent) {
    if (!world.alive(child)) {
        return fail("set_parent: the child, {}, does not exist", name_of(child));
    }
    if (parent.is_null()) {
        world.remove<Parent>(child);
        return Done{};
    }
    if (!world.alive(parent)) {
        return fail("set_parent: the parent, {}, does not exist", name_of(parent));
    }
    std::size_t steps = 0;
    for (Entity above = parent; !above.is_null(); above = parent_of(world, above)) {
        if (above == child) {
            return fail(
                "set_parent: {} cannot be the parent of {}: it is {}", name_of(parent),
                name_of(child), parent == child ? "the same entity" : "its descendant");
        }
        if (++steps > world.entity_count()) {
            return fail("set_parent: {} is already its own ancestor", name_of(parent));
        }
    }
    if (world.find_resource<SiblingOrder>() == nullptr) {
        world.insert_resource(SiblingOrder{});
    }
    world.add(child, Parent{parent, world.resource<SiblingOrder>().next++});
    return Done{};
}

Entity parent_of(const World& world, Entity entity) {
    const Parent* const link = world.find<Parent>(entity);
    return link != nullptr && world.alive(link->entity) ? link->entity : Entity{};
}

std::span<const Entity> children_of(World& world, Entity entity) {
    return world.alive(entity) ? hierarchy(world).children_of(entity) : std::span<const Entity>{};
}

std::uint32_t depth_of(const World& world, Entity entity) {
    std::uint32_t depth = 0;
    const std::size_t limit = world.entity_count();  // stops on cycles
    for (Entity above = parent_of(world, entity); !above.is_null() && depth < limit;
         above = parent_of(world, above)) {
        ++depth;
    }
    return depth;
}

std::vector<Entity> subtree_of(const Hierarchy& hierarchy, Entity root) {
    std::vector<Entity> subtree;
    std::vector<Entity> stack = {root};
    while (!stack.empty()) {
        const Entity entity = stack.back();
        stack.pop_back();
        subtree.push_back(entity);
        const std::span<const Entity> children = hierarchy.children_of(entity);
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            if (*child != root) {  // a broken cycle may lead back to the root
                stack.push_back(*child);
            }
        }
    }
    return subtree;
}

void destroy_tree(World& world, Entity root) {
    const std::vector<Entity> subtree = subtree_of(hierarchy(world), root);
    for (auto entity = subtree.rbegin(); entity != subtree.rend(); ++entity) {
        if (world.alive(*entity)) {  // an observer may have destroyed it already
            world.destroy(*entity);
        }
    }
}

void SystemParam<HierarchyRef>::declare(SystemAccess& access) {
    access.reads.push_back(component_id<Parent>);
    access.resource_writes.push_back(component_id<Hierarchy>);
}

void SystemParam<HierarchyRef>::prepare(World& world) {
    if (world.find_resource<Hierarchy>() == nullptr) {
        world.insert_resource(Hierarchy{});
    }
}

HierarchyRef
SystemParam<HierarchyRef>::get(World& world, std::uint32_t version, std::uint32_t /*last*/) {
    Hierarchy& present = world.resource<Hierarchy>();
    // Not World::version(): a later system's version may have been assigned already.
    present.refresh(world, version);
    return HierarchyRef(present);
}

}  // namespace limn
