#pragma once

#include "ecs/schedule.h"
#include "tests/ecs/model_commands.h"
#include "tests/ecs/model_direct.h"

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

// Operations that come together at a sync point: commands, of one thread and of systems whose tasks
// record at the same time, and copies of prefabs.

namespace limn::test::model {

class ModelRecorded : public ModelDirect {
  public:
    ModelRecorded(std::uint32_t seed, std::uint64_t compare_every)
        : ModelDirect(seed, compare_every) {
        make_schedule();
    }

  protected:
    // ---- prefabs

    void make_template() {
        if (reference_.living().empty()) {
            return;
        }
        const Id root = any_living();
        const std::vector<Id> subtree = reference_.subtree(root);
        if (subtree.size() > 12) {
            return;
        }
        count("make_prefab");
        for (const Id id : subtree) {
            const Value value = any_value(Kind::Serial, id);  // to tell the copies apart
            world_.add(reference_.handle(id), make<ModelSerial>(value.number, {}));
            reference_.add(id, Kind::Serial, value);
        }
        auto made = std::make_shared<Template>();
        made->prefab = make_prefab(world_, reference_.handle(root));
        expect(made->prefab.entities.size() == subtree.size(), "a prefab has another size");
        for (std::size_t i = 0; i < subtree.size(); ++i) {
            Template::Member& member = made->members.emplace_back();
            const Record& record = reference_.at(subtree[i]);
            member.mask = record.mask & ~kNotInPrefabs & ~(i == 0 ? bit(Kind::Parent) : 0);
            member.disabled = record.disabled;
            member.values = record.values;
            for (const Kind kind : {Kind::Link, Kind::Parent}) {
                const Id named = record.value(kind).entity;
                const auto found = std::find(subtree.begin(), subtree.end(), named);
                if (named != kNoId && found != subtree.end()) {
                    member.inside[static_cast<std::size_t>(kind)] =
                        static_cast<std::uint32_t>(found - subtree.begin()) + 1;
                }
            }
        }
        templates_.push_back(std::move(made));
        if (templates_.size() > 6) {
            templates_.erase(templates_.begin());
        }
    }

    /// The copies in the reference, in the order of the template.
    std::vector<Id> copy_template(const Template& source, Id parent) {
        std::vector<Id> copies;
        for (std::size_t i = 0; i < source.members.size(); ++i) {
            copies.push_back(reference_.create());
        }
        for (std::size_t i = 0; i < copies.size(); ++i) {
            const Template::Member& member = source.members[i];
            for (std::size_t kind = 0; kind < kKinds; ++kind) {
                if ((member.mask >> kind & 1u) != 0) {
                    Value value = member.values[kind];
                    if (member.inside[kind] != 0) {
                        value.entity = copies[member.inside[kind] - 1];
                    }
                    reference_.add(copies[i], static_cast<Kind>(kind), value);
                    if ((member.disabled >> kind & 1u) != 0) {
                        reference_.set_enabled(copies[i], static_cast<Kind>(kind), false);
                    }
                }
            }
        }
        if (parent != kNoId) {
            reference_.add(copies.front(), Kind::Parent, {0, parent});
        }
        return copies;
    }

    /// Copies of copies would be more than can be looked at in time.
    [[nodiscard]] bool may_spawn() const {
        constexpr std::size_t kCrowd = 4000;
        return !templates_.empty() && reference_.living().size() < kCrowd;
    }

    void spawn_directly() {
        if (!may_spawn()) {
            return;
        }
        count("spawn");
        const auto source = templates_[roll(templates_.size())];
        const std::size_t number = roll(4);
        Id parent = any_link();
        parent = parent != kNoId && reference_.alive(parent) ? parent : kNoId;
        reference_.begin_batch();
        const std::vector<Entity> roots =
            spawn(world_, source->prefab, number, reference_.handle(parent));
        expect(roots.size() == number, "spawn gives another number of roots");
        for (const Entity root : roots) {
            copies_.push_back({copy_template(*source, parent), source});
            bind(copies_.back().ids.front(), root);
        }
        finish_batch();
    }

    // ---- commands

    /// Invents a command and makes the reference obey it. `own`: created by the same run of the
    /// same system.
    Planned plan(std::vector<Id>& own) {
        Planned planned;
        const std::uint32_t choice = roll(40);
        if (choice < 6 || reference_.living().empty()) {
            planned.op = choice % 2 == 0 ? Planned::Op::Create : Planned::Op::CreateMixed;
            plan_create(planned, own);
            return planned;
        }
        if (choice == 6 && may_spawn()) {
            plan_spawn(planned, own);
            return planned;
        }
        planned.kind = any_kind();
        if (choice == 7) {
            planned.op =
                static_cast<Planned::Op>(static_cast<unsigned>(Planned::Op::Destroy) + roll(5));
            planned.target = any_dead();
            planned.stranger = planned.target == kNoId || chance(30) ? any_stranger() : Entity{};
            planned.value = any_value(Kind::Speed, kNoId);
            return planned;
        }
        planned.target = plan_target(own);
        if (planned.target == kNoId) {
            planned.stranger = any_stranger();
            planned.op = Planned::Op::Destroy;
            return planned;
        }
        plan_change(planned, choice, own);
        return planned;
    }

    void plan_create(Planned& planned, std::vector<Id>& own) {
        planned.target = reference_.create();
        planned.value = {static_cast<std::int64_t>(next_serial_++), any_link(own)};
        reference_.add(planned.target, Kind::Serial, {planned.value.number, kNoId});
        if (planned.op == Planned::Op::CreateMixed) {
            reference_.add(planned.target, Kind::Warmth, {planned.value.number, kNoId});
            reference_.add(planned.target, Kind::Title, {planned.value.number, kNoId});
            reference_.add(planned.target, Kind::Badge, {});
            reference_.add(planned.target, Kind::Team, {planned.value.number % kTeams, kNoId});
            reference_.add(planned.target, Kind::Link, planned.value);
        }
        own.push_back(planned.target);
        unbound_[planned.value.number] = planned.target;
    }

    void plan_spawn(Planned& planned, const std::vector<Id>& own) {
        planned.op = Planned::Op::Spawn;
        planned.spawned = templates_[roll(templates_.size())];
        planned.value.entity = any_link(own);
        Copy copy{copy_template(*planned.spawned, planned.value.entity), planned.spawned};
        planned.target = copy.ids.front();
        copies_.push_back(std::move(copy));
        fresh_root_ = planned.target;
    }

    [[nodiscard]] Id plan_target(const std::vector<Id>& own) {
        if (!own.empty() && chance(35)) {
            return own[roll(own.size())];
        }
        if (last_target_ != kNoId && chance(30)) {
            return bound_or_null(last_target_);
        }
        last_target_ = bound_or_null(any_living());
        return last_target_;
    }

    void plan_change(Planned& planned, std::uint32_t choice, const std::vector<Id>& own) {
        const Id target = planned.target;
        if (choice < 11) {
            planned.op = Planned::Op::Destroy;
            reference_.destroy(target);
            return;
        }
        if (planned.kind == Kind::Serial && !reference_.is_bound(target)) {
            planned.kind = Kind::Place;  // by its serial it will be found
        }
        planned.value = any_value(planned.kind, target, own);
        if ((bit(planned.kind) & kToggles) != 0 && chance(40)) {
            planned.op = chance(50) ? Planned::Op::Enable : Planned::Op::Disable;
            reference_.set_enabled(target, planned.kind, planned.op == Planned::Op::Enable);
        } else if (choice < 24) {
            planned.op = chance(80) ? Planned::Op::Add : Planned::Op::AddUntyped;
            reference_.add(target, planned.kind, planned.value);
        } else if (choice < 32) {
            planned.op = Planned::Op::Remove;
            reference_.remove(target, planned.kind);
        } else {
            planned.op = Planned::Op::Set;
            reference_.set(target, planned.kind, planned.value);
        }
    }

    /// A command, and what must follow it at once.
    void plan_into(std::vector<Planned>& plans, std::vector<Id>& own) {
        plans.push_back(plan(own));
        count("command");
        if (fresh_root_ != kNoId) {
            Planned mark;
            mark.target = fresh_root_;
            mark.value.number = static_cast<std::int64_t>(next_serial_++);
            reference_.add(mark.target, Kind::Serial, mark.value);
            unbound_[mark.value.number] = mark.target;
            plans.push_back(mark);
            count("command");
            fresh_root_ = kNoId;
        }
    }

    /// A placeholder of an earlier recording.
    [[nodiscard]] Entity any_stranger() {
        return strangers_.empty() ? Entity{5, 0x80000001u} : strangers_[roll(strangers_.size())];
    }

    void remember_strangers(const Recorder& recorder) {
        for (const auto& [id, placeholder] : recorder.placeholders()) {
            if (strangers_.size() < 64) {
                strangers_.push_back(placeholder);
            } else {
                strangers_[id % 64] = placeholder;
            }
        }
    }

    void record_and_flush() {
        reference_.begin_batch();
        std::vector<Planned> plans;
        std::vector<Id> own;
        const std::uint32_t number = 1 + roll(chance(5) ? 120 : 20);
        for (std::uint32_t i = 0; i < number; ++i) {
            plan_into(plans, own);
        }
        Recorder recorder{Commands(buffer_), reference_};
        for (const Planned& planned : plans) {
            recorder.record(planned);
        }
        CommandBuffer* const buffers[] = {&buffer_};
        apply_commands(world_, buffers);
        remember_strangers(recorder);
        finish_batch();
    }

    // ---- commands of systems

    void make_schedule() {
        schedule_.set_always_parallel(true);
        schedule_.add("record in tasks", [this](Query<const ModelPlace> places, Commands commands) {
            places.par_each([this, commands](Entity entity, const ModelPlace&) {
                Recorder recorder{commands, reference_};
                record_row(recorder, plans_of_places_, entity);
            });
        });
        schedule_.add(
            "record in tasks of sparse values",
            [this](Query<const ModelWarmth> warm, Commands commands) {
                warm.par_each([this, commands](Entity entity, const ModelWarmth&) {
                    Recorder recorder{commands, reference_};
                    record_row(recorder, plans_of_warm_, entity);
                });
            });
        schedule_.add(
            "record in tasks of teams", [this](Query<const ModelTeam> teams, Commands commands) {
                teams.par_each([this, commands](Entity entity, const ModelTeam&) {
                    Recorder recorder{commands, reference_};
                    record_row(recorder, plans_of_teams_, entity);
                });
            });
        schedule_.add(
            "record one by one", [this](Query<const ModelTitle> titles, Commands commands) {
                Recorder recorder{commands, reference_};
                titles.each([&](Entity entity, const ModelTitle&) {
                    record_row(recorder, plans_of_titles_, entity);
                });
            });
    }

    using Plans = std::unordered_map<Entity, std::vector<Planned>>;

    static void record_row(Recorder& recorder, const Plans& plans, Entity entity) {
        const auto found = plans.find(entity);
        if (found != plans.end()) {
            for (const Planned& planned : found->second) {
                recorder.record(planned);
            }
        }
    }

    /// Plans for some of the entities in the order in which the query will come by.
    template <typename T>
    Plans plan_rows(bool share_placeholders) {
        std::vector<Entity> order;
        std::as_const(world_).query<const T>().each(
            [&](Entity entity, const T&) { order.push_back(entity); });
        Plans plans;
        std::vector<Id> own;
        for (std::size_t i = roll(20); i < order.size(); i += 1 + roll(order.size() / 10 + 1)) {
            if (!share_placeholders) {
                own.clear();
            }
            const std::uint32_t number = 1 + roll(4);
            for (std::uint32_t k = 0; k < number; ++k) {
                plan_into(plans[order[i]], own);
            }
        }
        return plans;
    }

    void run_systems() {
        reference_.begin_batch();
        plans_of_places_ = plan_rows<ModelPlace>(false);
        plans_of_warm_ = plan_rows<ModelWarmth>(false);
        plans_of_teams_ = plan_rows<ModelTeam>(false);
        plans_of_titles_ = plan_rows<ModelTitle>(true);
        schedule_.run(world_);
        finish_batch();
    }

    // ---- after a sync point

    struct Copy {
        std::vector<Id> ids;
        std::shared_ptr<const Template> source;
    };

    /// Finds out which handles the created entities were given.
    void finish_batch() {
        std::vector<std::pair<Entity, std::int64_t>> found;
        std::as_const(world_).query<const ModelSerial>().each(
            [&](Entity entity, const ModelSerial& serial) {
                if (reference_.id_of(entity) == kNoId) {
                    found.emplace_back(entity, serial.number);
                }
            });
        std::vector<std::pair<Entity, std::int64_t>> members;
        for (const auto& [entity, serial] : found) {
            const auto created = unbound_.find(serial);
            if (created != unbound_.end()) {
                bind(created->second, entity);
            } else {
                members.emplace_back(entity, serial);
            }
        }
        for (const auto& [entity, serial] : members) {
            bind_member(entity, serial);
        }
        for (const auto& [serial, id] : unbound_) {
            expect(!reference_.alive(id) || reference_.is_bound(id), "create made nothing");
        }
        reference_.end_batch();
        for (const Copy& copy : copies_) {
            for (const Id id : copy.ids) {
                expect(!reference_.alive(id) || reference_.is_bound(id), "a copy is incomplete");
                if (reference_.alive(id)) {
                    const Value serial = any_value(Kind::Serial, id);
                    world_.add(reference_.handle(id), make<ModelSerial>(serial.number, {}));
                    reference_.add(id, Kind::Serial, serial);
                }
            }
        }
        copies_.clear();
        unbound_.clear();
        last_target_ = kNoId;
    }

    /// An entity of a copy that is not its root: upwards is the root, its serial is the template's.
    void bind_member(Entity entity, std::int64_t serial) {
        Entity root = entity;
        const Copy* copy = nullptr;
        while (copy == nullptr) {
            root = parent_of(world_, root);
            expect(!root.is_null(), "an entity came from nowhere");
            const Id root_id = reference_.id_of(root);
            for (const Copy& candidate : copies_) {
                copy = root_id != kNoId && candidate.ids.front() == root_id ? &candidate : copy;
            }
        }
        for (std::size_t i = 0; i < copy->ids.size(); ++i) {
            const auto& values = copy->source->members[i].values;
            if (values[static_cast<std::size_t>(Kind::Serial)].number == serial) {
                bind(copy->ids[i], entity);
                return;
            }
        }
        expect(false, "a copy has an entity too many");
    }

    CommandBuffer buffer_;
    std::vector<std::shared_ptr<const Template>> templates_;

  private:
    Schedule schedule_;
    Plans plans_of_places_;
    Plans plans_of_warm_;
    Plans plans_of_teams_;
    Plans plans_of_titles_;
    Id last_target_ = kNoId;
    Id fresh_root_ = kNoId;  ///< of a copy, to be given a number
    std::vector<Entity> strangers_;
    std::map<std::int64_t, Id> unbound_;  ///< created at this sync point, by serial
    std::vector<Copy> copies_;            ///< spawned at this sync point
};

}  // namespace limn::test::model
