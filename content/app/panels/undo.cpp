#include "content/app/panels/undo.h"

#include "ecs/components/surface.h"
#include "ecs/field_watch.h"
#include "ecs/world.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

bool apply_to_component(World& world, const Edit& edit, const AnyComponent& value) {
    if (!world.alive(edit.entity)) {
        return false;
    }
    if (value.is_empty()) {
        const AnyComponent& other = edit.before.is_empty() ? edit.after : edit.before;
        world.remove(edit.entity, other.info().id);
    } else {
        const ComponentId id = value.info().id;
        if (world.has(edit.entity, id)) {
            write_fields(world, edit.entity, value);
        } else {
            world.add_copy(edit.entity, id, value.data());
        }
    }
    return true;
}

bool apply_to_resource(World& world, const AnyComponent& value) {
    if (value.is_empty()) {
        return false;
    }
    const ComponentInfo& info = value.info();
    void* const resource = world.find_resource(info.id);
    if (resource == nullptr) {
        return false;
    }
    info.ops.destroy(resource, 1);
    info.ops.construct_copy(resource, value.data(), 1);
    return true;
}

bool apply_to_material(World& world, std::uint32_t index, const AnyComponent& value) {
    Assets* const assets = world.find_resource<Assets>();
    if (assets == nullptr || index >= assets->materials.size() || value.is_empty()) {
        return false;
    }
    assets->materials[index] = value.as<Material>();
    ++assets->material_version;
    return true;
}

/// Gives the entities their components, or takes all that they have; not those that were destroyed
/// since. False if the root was.
bool apply_tree(World& world, const EditedTree& tree, bool redo) {
    if (!world.alive(tree.entities.front())) {
        return false;
    }
    if (tree.made != redo) {
        strip(world, tree.entities);
        return true;
    }
    Prefab living = tree.components;
    for (std::size_t i = 0; i < tree.entities.size(); ++i) {
        if (!world.alive(tree.entities[i])) {
            living.entities[i] = {};
        }
    }
    fill(world, living, tree.entities);
    return true;
}

const ComponentInfo* edited_type(const Edit& edit) {
    const AnyComponent& value = edit.before.is_empty() ? edit.after : edit.before;
    return value.is_empty() ? nullptr : &value.info();
}

bool is_same_target(const Edit& a, const Edit& b) {
    return !a.tree && !b.tree && a.part == b.part && a.entity == b.entity
           && a.material == b.material && edited_type(a) == edited_type(b);
}

bool is_target(const Edit& edit, const LevelChange& change) {
    if (edit.tree) {
        return false;
    }
    return edit.part == change.part && edit.entity == change.entity
           && edit.material == change.material && edited_type(edit) == &change.now.info();
}

}  // namespace

bool exists(const World& world, Entity entity) {
    return world.alive(entity) && !world.components_of(entity).empty();
}

void strip(World& world, std::span<const Entity> entities) {
    for (const Entity entity : entities) {
        if (!world.alive(entity)) {
            continue;
        }
        for (const ComponentId id : world.components_of(entity)) {
            world.remove(entity, id);
        }
    }
}

void record_edit(
    World& world, UndoStack& undo, Edit edit, AnyComponent after, const std::string& what,
    std::string& last) {
    apply_edit_value(world, edit, after);
    edit.label = what;
    edit.after = std::move(after);
    if (last == what) {
        undo.extend(std::move(edit));
        return;
    }
    last = what;
    undo.record(std::move(edit));
}

bool apply_edit_value(World& world, const Edit& edit, const AnyComponent& value) {
    switch (edit.part) {
    case LevelPart::Component:
        return apply_to_component(world, edit, value);
    case LevelPart::Resource:
        return apply_to_resource(world, value);
    case LevelPart::Material:
        return apply_to_material(world, edit.material, value);
    case LevelPart::MotionGraph:
        break;  // only in files
    }
    return false;
}

void UndoStack::record(Edit edit) {
    ++revision_;
    edits_.resize(done_);
    edits_.push_back(std::move(edit));
    done_ = edits_.size();
}

void UndoStack::extend(Edit edit) {
    if (done_ == 0 || done_ < edits_.size() || !is_same_target(edits_.back(), edit)) {
        record(std::move(edit));
        return;
    }
    ++revision_;
    edits_.back().after = std::move(edit.after);
}

bool UndoStack::step(World& world, bool redo) {
    const std::size_t at = redo ? done_ : done_ - 1;
    const Edit& edit = edits_[at];
    const bool applied = edit.tree ? apply_tree(world, *edit.tree, redo)
                                   : apply_edit_value(world, edit, redo ? edit.after : edit.before);
    if (!applied) {
        const bool joined = edit.joined;
        edits_.erase(edits_.begin() + static_cast<std::ptrdiff_t>(at));
        if (!joined && at < edits_.size()) {
            edits_[at].joined = false;  // the next is now the first of its group
        }
    }
    done_ = redo && applied ? at + 1 : at;
    return applied;
}

std::string UndoStack::undo(World& world) {
    ++revision_;
    std::string label;
    for (bool more = true; more && done_ > 0;) {
        const bool joined = edits_[done_ - 1].joined;
        const std::string own = edits_[done_ - 1].label;
        if (step(world, false)) {
            label = own;
        }
        more = joined || label.empty();
    }
    return label;
}

std::string UndoStack::redo(World& world) {
    ++revision_;
    std::string label;
    while (done_ < edits_.size() && (label.empty() || edits_[done_].joined)) {
        const std::string own = edits_[done_].label;
        if (step(world, true) && label.empty()) {
            label = own;
        }
    }
    return label;
}

void UndoStack::adopt(std::span<const LevelChange> changes) {
    ++revision_;
    std::vector<Edit> kept;
    std::size_t done = 0;
    bool lost_first = false;  // of the group that is read
    for (std::size_t i = 0; i < edits_.size(); ++i) {
        Edit& edit = edits_[i];
        for (const LevelChange& change : changes) {
            if (is_target(edit, change)) {
                for (AnyComponent* const value : {&edit.before, &edit.after}) {
                    if (!value->is_empty()) {
                        adopt_change(change, *value);
                    }
                }
            }
        }
        const bool has_effect = edit.tree || edit.before.is_empty() || edit.after.is_empty()
                                || !same_value(edit.before, edit.after);
        if (has_effect) {
            edit.joined = edit.joined && !lost_first;
            kept.push_back(std::move(edit));
            done += i < done_ ? 1 : 0;
        }
        lost_first = !has_effect && (lost_first || !edit.joined);
    }
    edits_ = std::move(kept);
    done_ = done;
}

void UndoStack::clear() {
    ++revision_;
    edits_.clear();
    done_ = 0;
}

}  // namespace limn
