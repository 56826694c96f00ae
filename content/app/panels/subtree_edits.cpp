#include "content/app/panels/subtree_edits.h"

#include "content/app/panels/field_widgets.h"
#include "content/app/panels/undo.h"
#include "ecs/base/text.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/prefab.h"
#include "ecs/world.h"

#include <memory>
#include <utility>
#include <vector>

// Techniques: engine.cut-copy-paste
// Shown by `limn play pond`: engine.cut-copy-paste

namespace limn {
namespace {

void record_change(
    UndoStack& undo, Entity entity, AnyComponent before, AnyComponent after,
    const std::string& label, bool joined) {
    Edit edit;
    edit.entity = entity;
    edit.before = std::move(before);
    edit.after = std::move(after);
    edit.label = label;
    edit.joined = joined;
    undo.record(std::move(edit));
}

/// Where an entity was, to record its move.
class Departure {
  public:
    Departure(const World& world, Entity entity)
        : world_(world), entity_(entity), parent_(read<Parent>()), transform_(read<Transform>()) {}

    /// Records what has changed; `joined`: to the edit before.
    void record(UndoStack& undo, const std::string& label, bool joined) const {
        if (!parent_.is_empty() || world_.has<Parent>(entity_)) {
            record_change(undo, entity_, parent_, read<Parent>(), label, joined);
        }
        if (!transform_.is_empty() && !same_value(transform_, read<Transform>())) {
            record_change(undo, entity_, transform_, read<Transform>(), label, true);
        }
    }

  private:
    template <typename T>
    [[nodiscard]] AnyComponent read() const {
        return AnyComponent::read(world_, entity_, component_info<T>());
    }

    const World& world_;
    Entity entity_;
    AnyComponent parent_;
    AnyComponent transform_;
};

void record_tree(World& world, UndoStack& undo, Entity root, const std::string& label, bool made) {
    auto tree = std::make_shared<EditedTree>();
    tree->components = make_prefab(world, root);
    tree->entities = subtree_of(hierarchy(world), root);
    tree->made = made;
    Edit edit;
    edit.tree = std::move(tree);
    edit.label = label;
    undo.record(std::move(edit));
}

/// "" for a root of the level.
std::string under(const World& world, Entity parent) {
    return parent.is_null() ? std::string() : " under " + entity_label(world, parent);
}

/// Copies `entity` below `parent`. Returns the copy.
Result<Entity> copy_below(World& world, UndoStack& undo, Entity entity, Entity parent) {
    const Entity made = LIMN_TRY(copy_tree(world, entity));
    const std::string label = entity_label(world, made) + ": paste" + under(world, parent);
    record_tree(world, undo, made, label, true);
    if (!parent.is_null()) {
        const Departure move(world, made);
        LIMN_TRY(paste_tree(world, parent, made));
        move.record(undo, label, true);
    }
    return made;
}

}  // namespace

Result<std::string> SubtreeEditor::cut(World& world, UndoStack& undo, Entity entity) {
    if (!exists(world, entity)) {
        return fail("cut: nothing is selected");
    }
    const Departure move(world, entity);
    if (!parent_of(world, entity).is_null()) {  // otherwise it is a root already
        LIMN_TRY(cut_tree(world, entity, KeptPlace::World));
    }
    clipboard_ = {entity, true};
    const std::string label = entity_label(world, entity) + ": cut";
    move.record(undo, label, false);
    return label;
}

Result<std::string> SubtreeEditor::copy(const World& world, Entity entity) {
    if (!exists(world, entity)) {
        return fail("copy: nothing is selected");
    }
    clipboard_ = {entity, false};
    return entity_label(world, entity) + ": copied; paste it with Ctrl V";
}

Result<std::string>
SubtreeEditor::paste(World& world, UndoStack& undo, Entity parent, KeptPlace kept) {
    const Entity root = clipboard_.root;
    if (!exists(world, root)) {
        return fail("paste: nothing was cut or copied");
    }
    if (!parent.is_null() && !exists(world, parent)) {
        return fail("paste: found a destroyed entity, expected a living parent");
    }
    if (parent == root) {  // it is still selected
        parent = parent_of(world, root);
    }
    if (!clipboard_.is_cut) {
        pasted_ = LIMN_TRY(copy_below(world, undo, root, parent));
        return entity_label(world, pasted_) + ": pasted" + under(world, parent);
    }
    const Departure move(world, root);
    if (!parent.is_null()) {
        LIMN_TRY(paste_tree(world, parent, root, kept));
    }
    const std::string label = entity_label(world, root) + ": paste" + under(world, parent);
    move.record(undo, label, false);
    clipboard_ = {root, false};
    pasted_ = root;
    return label;
}

Result<std::string> SubtreeEditor::duplicate(World& world, UndoStack& undo, Entity entity) {
    if (!exists(world, entity)) {
        return fail("duplicate: nothing is selected");
    }
    pasted_ = LIMN_TRY(copy_below(world, undo, entity, parent_of(world, entity)));
    return entity_label(world, pasted_) + ": copied";
}

Result<std::string> SubtreeEditor::place(World& world, UndoStack& undo, const Prefab& prefab) {
    if (prefab.entities.empty()) {
        return fail("place: found an empty prefab, expected entities");
    }
    pasted_ = spawn_tree(world, prefab);
    const std::string label = entity_label(world, pasted_) + ": placed";
    record_tree(world, undo, pasted_, label, true);
    return label;
}

Result<std::string> SubtreeEditor::remove(World& world, UndoStack& undo, Entity entity) {
    if (!exists(world, entity)) {
        return fail("delete: nothing is selected");
    }
    const std::string label = entity_label(world, entity) + ": delete";
    AnyComponent parent = AnyComponent::read(world, entity, component_info<Parent>());
    const std::vector<Entity> entities = subtree_of(hierarchy(world), entity);
    record_tree(world, undo, entity, label, false);
    strip(world, entities);
    if (!parent.is_empty()) {
        record_change(undo, entity, std::move(parent), {}, label, true);
    }
    return label;
}

}  // namespace limn
