#include "ecs/base/check.h"
#include "ecs/command_buffer.h"
#include "ecs/component_bytes.h"
#include "ecs/world_internals.h"

#include <algorithm>

namespace limn {

// A sync point in five steps:
//     order     all segments of all buffers, sorted by where they were recorded
//     resolve   placeholders become entities, in that order, so that handles do not depend on
//     threads fold      the commands of each entity become one change: where its row goes and which
//     values are new apply     on_remove, then the changes in the order of the entities' first
//     commands, then on_add

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// What commands say of a component that can be disabled.
enum class Enabling : std::uint8_t { Keep, Enable, Disable };

/// What becomes of one component of an entity.
struct Change {
    ComponentId component;
    void* value;       ///< new value; null: removed, or a tag
    bool is_present;   ///< after the change
    bool was_present;  ///< before
    bool was_removed;  ///< at some time in between
    Enabling enabling;
};

/// All commands of one entity.
struct Group {
    Entity entity;
    std::uint32_t first_command;
    std::uint32_t last_command;
    std::uint32_t first_change = 0;
    std::uint32_t change_count = 0;
    Archetype* target = nullptr;
    bool is_new = false;  ///< created in this flush
    bool is_destroyed = false;
};

struct Link {
    const Command* command;
    std::uint32_t next;  ///< command of the same entity
};

void destroy_value(ComponentId id, void* value) {
    if (value != nullptr) {
        component_info(id).ops.destroy(value, 1);
    }
}

}  // namespace

class CommandFlush {
  public:
    CommandFlush(World& world, std::span<CommandBuffer* const> buffers)
        : world_(world), buffers_(buffers), group_by_slot_(world.internals_->group_by_slot) {}

    void run() {
        for (CommandBuffer* buffer : buffers_) {
            collect(*buffer);
        }
        for (Group& group : groups_) {
            fold(group);
            group_by_slot_[group.entity.index] = kNone;
        }
        notify(ObserverEvent::Remove);
        for (const Group& group : groups_) {
            apply(group);
        }
        for (CommandBuffer* buffer : buffers_) {
            buffer->reset();
        }
        notify(ObserverEvent::Add);
    }

  private:
    struct Segment {
        std::uint32_t sequence;
        std::uint32_t chunk;
        CommandStream* stream;
        std::uint32_t begin;
        std::uint32_t end;
    };

    // ---- order and resolve
    // ------------------------------------------------------------------------

    void collect(CommandBuffer& buffer) {
        std::vector<Segment> segments;
        for (const auto& stream : buffer.streams_) {
            for (std::size_t i = 0; i < stream->segments.size(); ++i) {
                const CommandSegment& segment = stream->segments[i];
                const std::uint32_t end = i + 1 < stream->segments.size()
                                              ? stream->segments[i + 1].begin
                                              : static_cast<std::uint32_t>(stream->commands.size());
                segments.push_back(
                    {segment.sequence, segment.chunk, stream.get(), segment.begin, end});
            }
        }
        // Stable: segments of one place were recorded by one thread, in order.
        std::stable_sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
            return a.sequence != b.sequence ? a.sequence < b.sequence : a.chunk < b.chunk;
        });

        for (std::size_t i = 1; i < segments.size(); ++i) {
            LIMN_CHECK_NOTE(
                segments[i - 1].stream == segments[i].stream
                    || segments[i - 1].sequence != segments[i].sequence
                    || segments[i - 1].chunk != segments[i].chunk,
                "several threads recorded commands without par_chunks or par_each: no order is "
                "defined");
        }

        std::vector<std::vector<Entity>> created(buffer.streams_.size());
        for (const auto& stream : buffer.streams_) {
            created[stream->number].resize(stream->created);
        }
        for (const Segment& segment : segments) {
            for (std::uint32_t i = segment.begin; i < segment.end; ++i) {
                const Command& command = segment.stream->commands[i];
                if (command.op == CommandOp::Create) {
                    created[segment.stream->number][command.entity.index] =
                        world_.core_.entities.allocate();
                }
            }
        }
        const auto resolve = [&](Entity& entity) {
            if ((entity.generation & kPlaceholderBit) == 0) {
                return;
            }
            for (const auto& stream : buffer.streams_) {
                if (entity.generation == buffer.placeholder_generation(*stream)
                    && entity.index < stream->created) {
                    entity = created[stream->number][entity.index];
                    return;
                }
            }
            entity = {};  // of another run or system: names nothing
        };
        for (const Segment& segment : segments) {
            for (std::uint32_t i = segment.begin; i < segment.end; ++i) {
                Command& command = segment.stream->commands[i];
                resolve(command.entity);
                if (command.value != nullptr) {
                    const ComponentInfo& info = component_info(command.component);
                    if (info.has_entities) {
                        for_each_entity(info.fields, command.value, resolve);
                    }
                }
                link(command);
            }
        }
    }

    /// Puts the command behind the others of its entity.
    void link(const Command& command) {
        const bool is_new = command.op == CommandOp::Create;
        const std::uint32_t slot = command.entity.index;
        std::uint32_t group = slot < group_by_slot_.size() ? group_by_slot_[slot] : kNone;
        const bool is_known = group != kNone && groups_[group].entity == command.entity;
        if (!is_known && !is_new && !world_.alive(command.entity)) {
            destroy_value(command.component, command.value);
            return;
        }
        const std::uint32_t index = static_cast<std::uint32_t>(links_.size());
        links_.push_back({&command, kNone});
        if (is_known) {
            links_[groups_[group].last_command].next = index;
            groups_[group].last_command = index;
            return;
        }
        if (slot >= group_by_slot_.size()) {
            group_by_slot_.resize(world_.core_.entities.slot_count(), kNone);
        }
        group_by_slot_[slot] = static_cast<std::uint32_t>(groups_.size());
        Group made{command.entity, index, index};
        made.is_new = is_new;
        groups_.push_back(made);
    }

    // ---- fold
    // -------------------------------------------------------------------------------------

    [[nodiscard]] std::span<const Change> changes_of(const Group& group) const {
        return {changes_.data() + group.first_change, group.change_count};
    }

    void fold(Group& group) {
        group.first_change = static_cast<std::uint32_t>(changes_.size());
        for (std::uint32_t i = group.first_command; i != kNone; i = links_[i].next) {
            const Command& command = *links_[i].command;
            if (command.op == CommandOp::Create) {
                continue;
            }
            if (group.is_destroyed) {
                destroy_value(command.component, command.value);
            } else if (command.op == CommandOp::Destroy) {
                for (std::size_t k = group.first_change; k < changes_.size(); ++k) {
                    destroy_value(changes_[k].component, changes_[k].value);
                }
                changes_.resize(group.first_change);
                group.is_destroyed = true;
            } else {
                fold_component(group, command);
            }
        }
        group.change_count = static_cast<std::uint32_t>(changes_.size()) - group.first_change;
        if (!group.is_destroyed) {
            find_target(group);
        }
    }

    void fold_component(const Group& group, const Command& command) {
        Change* change = nullptr;
        for (std::size_t k = group.first_change; k < changes_.size(); ++k) {
            if (changes_[k].component == command.component) {
                change = &changes_[k];
            }
        }
        if (change == nullptr) {
            const bool present = !group.is_new && world_.has(group.entity, command.component);
            changes_.push_back(
                {command.component, nullptr, present, present, false, Enabling::Keep});
            change = &changes_.back();
        }
        const bool is_enabling =
            command.op == CommandOp::Enable || command.op == CommandOp::Disable;
        if ((command.op == CommandOp::Set || is_enabling) && !change->is_present) {
            destroy_value(command.component, command.value);
            return;
        }
        if (command.op != CommandOp::Set) {
            change->enabling =
                command.op == CommandOp::Disable ? Enabling::Disable : Enabling::Enable;
        }
        if (is_enabling) {
            return;
        }
        destroy_value(command.component, change->value);
        change->value = command.value;
        change->is_present = command.op != CommandOp::Remove;
        change->was_removed = change->was_removed || command.op == CommandOp::Remove;
    }

    /// The archetype with the components that the entity has afterwards. Entities in a row mostly
    /// change alike.
    void find_target(Group& group) {
        Archetype* source = source_of(group);
        const auto changes = changes_of(group);
        if (last_target_ != nullptr && last_source_ == source
            && std::equal(
                changes.begin(),
                changes.end(),
                last_changes_.begin(),
                last_changes_.end(),
                [](const Change& a, const Change& b) {
                    return a.component == b.component && a.is_present == b.is_present;
                })) {
            group.target = last_target_;
            return;
        }
        const auto present = source->components();
        std::vector<ComponentId> components(present.begin(), present.end());
        for (const Change& change : changes) {
            if (component_info(change.component).storage == Storage::Sparse) {
                continue;
            }
            const auto place =
                std::lower_bound(components.begin(), components.end(), change.component);
            const bool found = place != components.end() && *place == change.component;
            if (change.is_present && !found) {
                components.insert(place, change.component);
            } else if (!change.is_present && found) {
                components.erase(place);
            }
        }
        group.target = &world_.archetype_of(components);
        last_source_ = source;
        last_target_ = group.target;
        last_changes_.assign(changes.begin(), changes.end());
    }

    [[nodiscard]] Archetype* source_of(const Group& group) const {
        const std::uint32_t index =
            group.is_new ? 0 : world_.core_.entities.find(group.entity).archetype;
        return &world_.archetype(index);
    }

    // ---- apply
    // ------------------------------------------------------------------------------------

    void apply(const Group& group) {
        if (group.is_destroyed) {
            if (group.is_new) {
                world_.core_.entities.free(group.entity);
            } else {
                world_.destroy_now(group.entity, world_.core_.entities.find(group.entity));
            }
            return;
        }
        const std::uint32_t now = world_.core_.now();
        Archetype& target = *group.target;
        if (group.is_new) {
            world_.core_.entities.place(
                group.entity, target.index(), target.append(group.entity, now));
        } else if (Archetype* source = source_of(group); source != &target) {
            world_.move_row(
                group.entity, world_.core_.entities.find(group.entity), source->plan_to(target));
        }
        const std::uint32_t row = world_.core_.entities.find(group.entity).row;
        for (const Change& change : changes_of(group)) {
            const ComponentInfo& info = component_info(change.component);
            if (info.storage == Storage::Sparse) {
                apply_sparse(group.entity, change, now);
            } else if (change.is_present && change.value != nullptr) {
                const int column = target.column_of(change.component);
                if (info.storage == Storage::Split) {
                    scatter_values(&target.column(column), row, 1, change.value);
                    target.write_row(column, row, now);
                    continue;
                }
                void* place = target.column(column).at(row);
                if (change.was_present) {
                    info.ops.destroy(place, 1);
                    target.write_row(column, row, now);
                }
                relocate_values(info, place, change.value, 1);
            }
            if (change.is_present && change.enabling != Enabling::Keep) {
                target.set_enabled(change.component, row, change.enabling == Enabling::Enable, now);
            }
        }
    }

    void apply_sparse(Entity entity, const Change& change, std::uint32_t now) {
        if (!change.is_present && !change.was_present) {
            return;
        }
        SparseSet& set = world_.use_sparse_set(change.component);
        std::uint32_t position = set.find(entity);
        if (!change.is_present) {
            set.remove(position, now);
            return;
        }
        if (position == SparseSet::kAbsent) {
            position = set.append(entity, now);
        } else if (change.value != nullptr) {
            set.info().ops.destroy(set.value(position), 1);
            set.touch(position, now);
        }
        if (change.value != nullptr) {
            relocate_values(set.info(), set.value(position), change.value, 1);
        }
    }

    // ---- observers
    // --------------------------------------------------------------------------------

    void notify(ObserverEvent event) {
        for (std::size_t i = 0; i < world_.internals_->observers.size(); ++i) {
            const Observer& observer = *world_.internals_->observers[i];
            if (observer.event != event) {
                continue;
            }
            std::vector<Entity> entities;
            for (const Group& group : groups_) {
                const bool told = event == ObserverEvent::Remove ? loses(group, observer.component)
                                                                 : gains(group, observer.component);
                if (told) {
                    entities.push_back(group.entity);
                }
            }
            if (entities.empty()) {
                continue;
            }
            if (event == ObserverEvent::Remove) {
                const IterationGuard guard(world_.core_, IterationLock::Plain);
                observer.function(world_, entities);
            } else {
                observer.function(world_, entities);
            }
        }
    }

    [[nodiscard]] bool loses(const Group& group, ComponentId id) const {
        if (group.is_destroyed) {
            return !group.is_new && world_.has(group.entity, id);
        }
        const auto changes = changes_of(group);
        return std::any_of(changes.begin(), changes.end(), [&](const Change& change) {
            return change.component == id && change.was_present
                   && (!change.is_present || change.was_removed);
        });
    }

    /// Looks at the world too: an observer before this one may have undone it.
    [[nodiscard]] bool gains(const Group& group, ComponentId id) const {
        const auto changes = changes_of(group);
        return !group.is_destroyed
               && std::any_of(
                   changes.begin(),
                   changes.end(),
                   [&](const Change& change) {
                       return change.component == id && change.is_present
                              && (!change.was_present || change.was_removed);
                   })
               && world_.has(group.entity, id);
    }

    World& world_;
    std::span<CommandBuffer* const> buffers_;
    std::vector<std::uint32_t>& group_by_slot_;
    std::vector<Link> links_;
    std::vector<Group> groups_;
    std::vector<Change> changes_;
    Archetype* last_source_ = nullptr;
    Archetype* last_target_ = nullptr;
    std::vector<Change> last_changes_;
};

void apply_commands(World& world, std::span<CommandBuffer* const> buffers) {
    world.core().check_unlocked();
    CommandFlush(world, buffers).run();
}

}  // namespace limn
