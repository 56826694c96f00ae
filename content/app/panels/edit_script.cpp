#include "content/app/panels/edit_script.h"

#include "content/app/panels/field_widgets.h"
#include "content/load/files/json_document.h"
#include "content/load/level/level_hints.h"
#include "content/load/level/set_value.h"
#include "ecs/any_component.h"
#include "ecs/base/text.h"
#include "ecs/components/name.h"
#include "ecs/components/surface.h"
#include "ecs/hierarchy.h"
#include "ecs/reflect.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

// Techniques: engine.editor-inspector

namespace limn {
namespace {

constexpr std::string_view kVerbs[] = {"set",   "add",       "remove", "cut",  "copy", "paste",
                                       "place", "duplicate", "delete", "undo", "redo"};

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    const std::size_t last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? "" : text.substr(first, last - first + 1);
}

/// The only living entity of this name.
Result<Entity> find_one(const World& world, std::string_view name) {
    std::vector<Entity> found;
    world.query<const Name>().each([&](Entity entity, const Name& candidate) {
        if (candidate.text == name) {
            found.push_back(entity);
        }
    });
    if (found.empty()) {
        return fail(
            "found {}, expected the name of an entity{}", in_quotes(name),
            did_you_mean(name, make_name_resolver(world).all("entity")));
    }
    if (found.size() > 1) {
        return fail("found {} entities named {}, expected one", found.size(), in_quotes(name));
    }
    return found.front();
}

/// Fails for what the file says in another way.
Status expect_own_fields(const ComponentInfo& info) {
    if (info.id == component_id<Parent>) {
        return fail("found the component parent, expected cut and paste");
    }
    return Done{};
}

/// A name that another entity of the level can have.
Status expect_new_name(const World& world, std::string_view name) {
    if (name.empty() || name.find_first_of(".[]") != std::string_view::npos) {
        return fail("found the name {}, expected one without . [ ]", in_quotes(name));
    }
    bool is_used = false;
    world.query<const Name>().each(
        [&](Entity, const Name& other) { is_used = is_used || other.text == name; });
    return is_used ? Status(fail("found a second {}, expected a new name", in_quotes(name)))
                   : Status(Done{});
}

/// What a set changes: the component of each entity, or one resource or material.
std::vector<Edit> read_targets(const World& world, const SetTarget& target) {
    std::vector<Edit> edits(std::max<std::size_t>(target.entities.size(), 1));
    for (std::size_t i = 0; i < edits.size(); ++i) {
        Edit& edit = edits[i];
        edit.part = target.part;
        edit.material = target.material;
        switch (target.part) {
        case LevelPart::Component:
            edit.entity = target.entities[i];
            edit.before = AnyComponent::read(world, edit.entity, *target.info);
            break;
        case LevelPart::Resource: {
            const void* const object = world.find_resource(target.info->id);
            edit.before =
                object != nullptr ? AnyComponent(*target.info, object) : AnyComponent(*target.info);
            break;
        }
        case LevelPart::Material:
            edit.before = AnyComponent(
                *target.info, &world.find_resource<Assets>()->materials[target.material]);
            break;
        case LevelPart::MotionGraph:
            break;  // only in files
        }
    }
    return edits;
}

Result<std::string> set_field_of(World& world, UndoStack& undo, std::string_view rest) {
    const std::size_t equals = rest.find('=');
    if (equals == std::string_view::npos) {
        return fail("found no =, expected set PATH = VALUE");
    }
    const std::string_view path = trimmed(rest.substr(0, equals));
    const SetTarget target = LIMN_TRY(find_set_target(world, path));
    LIMN_TRY(expect_own_fields(*target.info));
    if (target.info->id == component_id<Name>) {
        std::string_view name = trimmed(rest.substr(equals + 1));
        if (name.size() > 1 && name.front() == '"' && name.back() == '"') {
            name = name.substr(1, name.size() - 2);
        }
        if (target.entities.size() > 1) {
            return fail(
                "found {} entities for {}, expected one", target.entities.size(), in_quotes(path));
        }
        LIMN_TRY(expect_new_name(world, name));
    }
    std::vector<Edit> edits = read_targets(world, target);
    LIMN_TRY(set_value(world, path, trimmed(rest.substr(equals + 1))));
    std::vector<Edit> after = read_targets(world, target);
    bool joined = false;
    for (std::size_t i = 0; i < edits.size(); ++i) {
        if (edits[i].before.is_empty() && after[i].before.is_empty()) {
            continue;  // an entity of the name that lacks the component
        }
        edits[i].label = path;
        edits[i].after = std::move(after[i].before);
        edits[i].joined = std::exchange(joined, true);
        undo.record(std::move(edits[i]));
    }
    return std::string(path);
}

Result<std::string> add_or_remove(World& world, UndoStack& undo, std::string_view path, bool adds) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string_view::npos) {
        return fail("found {}, expected NAME.COMPONENT", in_quotes(path));
    }
    Edit edit;
    edit.entity = LIMN_TRY(find_one(world, path.substr(0, dot)));
    const std::string_view name = path.substr(dot + 1);
    const ComponentInfo* const info = find_component(name);
    if (info == nullptr || info->ops.construct_default == nullptr || is_internal(*info)) {
        return fail(
            "found the component {}, expected one of `limn components`{}", in_quotes(name),
            component_suggestion(name));
    }
    LIMN_TRY(expect_own_fields(*info));
    if (info->id == component_id<Name>) {
        return fail("found the component name, expected set {}.text = a new one", path);
    }
    edit.before = AnyComponent::read(world, edit.entity, *info);
    if (edit.before.is_empty() != adds) {
        return fail(
            "found {} {}, expected an entity {} it", adds ? "a" : "no", info->name,
            adds ? "without" : "with");
    }
    if (adds) {
        edit.after = AnyComponent(*info);
    }
    apply_edit_value(world, edit, edit.after);
    edit.label = fmt::format("{}: {} {}", path.substr(0, dot), adds ? "add" : "remove", info->name);
    undo.record(edit);
    return edit.label;
}

Result<std::string> step(World& world, UndoStack& undo, bool back) {
    const std::string label = back ? undo.undo(world) : undo.redo(world);
    if (label.empty()) {
        return fail("found nothing to {}, expected an edit before it", back ? "undo" : "redo");
    }
    return fmt::format("{} {}", back ? "undo" : "redo", label);
}

}  // namespace

Result<std::string> EditScript::run(World& world, std::string_view line) {
    line = trimmed(line);
    if (line.empty() || line.front() == '#') {
        return std::string();
    }
    const std::string_view verb = line.substr(0, line.find_first_of(" \t"));
    const std::string_view rest = trimmed(line.substr(verb.size()));
    if (verb == "set") {
        return set_field_of(world, undo_, rest);
    }
    if (verb == "add" || verb == "remove") {
        return add_or_remove(world, undo_, rest, verb == "add");
    }
    if (verb == "undo" || verb == "redo") {
        return step(world, undo_, verb == "undo");
    }
    if (verb == "paste") {
        const Entity parent = rest.empty() ? Entity{} : LIMN_TRY(find_one(world, rest));
        return subtrees_.paste(world, undo_, parent);
    }
    if (verb == "place") {
        if (level_.path.empty()) {
            return fail("found no level, expected one with prefabs");
        }
        const Prefab prefab = LIMN_TRY(read_instance(world, level_, std::string(rest), Vec3(0)));
        return subtrees_.place(world, undo_, prefab);
    }
    if (verb != "cut" && verb != "copy" && verb != "duplicate" && verb != "delete") {
        return fail(
            "found {}, expected one of {}{}", in_quotes(verb),
            fmt::format("{}", fmt::join(kVerbs, ", ")), did_you_mean(verb, kVerbs));
    }
    const Entity entity = LIMN_TRY(find_one(world, rest));
    return verb == "cut"         ? subtrees_.cut(world, undo_, entity)
           : verb == "copy"      ? subtrees_.copy(world, entity)
           : verb == "duplicate" ? subtrees_.duplicate(world, undo_, entity)
                                 : subtrees_.remove(world, undo_, entity);
}

}  // namespace limn
