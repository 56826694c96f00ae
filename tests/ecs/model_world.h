#pragma once

#include "ecs/snapshot.h"
#include "tests/ecs/model_recorded.h"

#include <cstdint>
#include <memory>
#include <vector>

// A world and the reference, driven through random operations. An operation is one call that
// changes the world, or one recorded command.

namespace limn::test::model {

class ModelWorld : public ModelRecorded {
  public:
    using ModelRecorded::ModelRecorded;

    /// Continues until `operations` have been done.
    void run(std::uint64_t operations) {
        while (done_ < operations) {
            step();
            if (done_ >= compare_at_) {
                compare();
            }
            if (done_ >= steer_at_) {
                steer();
            }
        }
        compare();
    }

  private:
    // ---- one step
    void step() {
        const std::uint32_t choice = roll(1000);
        if (choice < 260) {
            change_population();
        } else if (choice < 480) {
            add();
        } else if (choice < 620) {
            remove();
        } else if (choice < 740) {
            write();
        } else if (choice < 780) {
            toggle();
        } else if (choice < 850) {
            reparent();
        } else if (choice < 852) {
            destroy_a_tree();
        } else if (choice < 900) {
            use_stale_handle();
        } else if (choice < 910) {
            spawn_directly();
        } else if (choice < 913) {
            make_template();
        } else if (choice < 916) {
            sweep();
        } else if (choice < 918) {
            save_or_restore();
        } else if (choice < 920) {
            run_systems();
        } else if (choice < 922) {
            change_all();
        } else if (choice < 960) {
            record_and_flush();
        } else {
            create();
        }
        if (roll(3000) == 0) {
            new_goal();
        }
    }

    void new_goal() {
        constexpr std::size_t kGoals[] = {0, 3, 60, 700, 1500, 2600};
        goal_ = kGoals[roll(std::size(kGoals))];
        if (chance(50)) {
            count("shrink");
            world_.shrink();
            compare();
        }
        if (goal_ == 0) {
            count("clear");
            world_.clear();
            reference_.clear();
            expect(world_.entity_count() == 0, "clear leaves entities");
        }
    }

    // ---- snapshots

    struct Saved {
        std::vector<std::byte> bytes;
        std::uint64_t hash = 0;
        SnapshotMark mark;
        Reference reference;
        std::vector<std::shared_ptr<const Template>> templates;
    };

    void save_or_restore() {
        if (saved_ == nullptr || chance(40)) {
            count("save");
            SnapshotMark mark;
            Result<std::vector<std::byte>> bytes = save_snapshot(world_, &mark);
            expect(bytes.ok(), "a snapshot fails");
            saved_ = std::make_unique<Saved>(
                Saved{std::move(*bytes), state_hash(world_), mark, reference_, templates_});
            return;
        }
        if (chance(50)) {
            save_difference();
            return;
        }
        count("restore");
        expect(restore_snapshot(world_, saved_->bytes).ok(), "a snapshot is refused");
        expect(state_hash(world_) == saved_->hash, "a restored world has another hash");
        reference_.restore(saved_->reference);
        templates_ = saved_->templates;
        compare();
    }

    /// Goes on from what was saved before, or from the last difference.
    void save_difference() {
        count("delta");
        SnapshotMark mark;
        const auto delta = save_delta(world_, saved_->mark, &mark);
        expect(delta.ok(), "a delta fails");
        auto whole = apply_delta(saved_->bytes, *delta);
        expect(whole.ok(), "a delta is refused");
        expect(*whole == *save_snapshot(world_), "a delta gives another snapshot");
        saved_ = std::make_unique<Saved>(
            Saved{std::move(*whole), state_hash(world_), mark, reference_, templates_});
    }

    // ---- around full chunks

    /// Brings an archetype, perhaps a team's, or a sparse set to 1024 k - 1, 1024 k and 1024 k + 1
    /// rows, and looks.
    void steer() {
        const bool sparse = steered_ % 5 == 4;
        const std::uint32_t chunks = 1 + steered_ / 5 % 3;
        steered_team_ = steered_ % 5 == 3 ? roll(kTeams) : kNoTeam;
        const auto size = [&] {
            return reference_.count([&](const Record& record) {
                return sparse ? record.has(Kind::Chosen) : is_whole(record);
            });
        };
        const std::size_t middle = std::size_t{chunks} * 1024;
        for (std::size_t target = middle - 1; target <= middle + 1; ++target) {
            for (std::size_t now = size(); now != target; now = size()) {
                for (std::size_t extra = now; extra > target; --extra) {
                    sparse ? remove_chosen() : shrink_whole();
                }
                if (now < target) {
                    sparse ? add_chosen(target - now) : grow_whole(target - now);
                }
            }
            compare();
        }
        ++steered_;
        steer_at_ = done_ + 9000;
        goal_ = 500;
    }

    void add_chosen(std::size_t missing) {
        if (missing > 64) {
            count("create_many");
            create_alike<ModelChosen>(missing - 32, {});
        } else {
            count("create");
            create_one<ModelChosen, ModelBadge>({});
        }
    }

    void remove_chosen() {
        count("remove");
        const Id id = first_with([](const Record& record) { return record.has(Kind::Chosen); });
        expect(world_.remove<ModelChosen>(reference_.handle(id)), "remove says something else");
        reference_.remove(id, Kind::Chosen);
    }

    /// Whether it is in the archetype that is brought to a size.
    [[nodiscard]] bool is_whole(const Record& record) const {
        constexpr Mask kWhole = bit(Kind::Place) | bit(Kind::Speed);
        const Mask rest = ~kWhole & ~kSparseKinds & ~bit(Kind::Team);
        return record.is_made_of(kWhole, rest) && record.team() == steered_team_;
    }

    void grow_whole(std::size_t missing) {
        const Value value{roll(1000), kNoId};
        if (steered_team_ != kNoTeam) {
            grow_team(missing, value);
            return;
        }
        const std::uint32_t way = roll(3);
        if (missing > 40) {
            count("create_many");
            create_alike<ModelSpeed, ModelPlace>(missing - roll(30), value);
        } else if (way == 0) {
            count("create");
            create_one<ModelPlace, ModelSpeed>(value);
        } else if (way == 1) {
            count("create");
            count("add");
            create_one<ModelPlace>(value);
            const Id id = reference_.living().back();
            world_.add(reference_.handle(id), make<ModelSpeed>(value.number, {}));
            reference_.add(id, Kind::Speed, value);
        } else {
            count("create");
            count("command");
            create_one<ModelPlace, ModelSpeed, ModelBadge>(value);
            const Id id = reference_.living().back();
            command([&](Commands commands) { commands.remove<ModelBadge>(reference_.handle(id)); });
            reference_.remove(id, Kind::Badge);
        }
    }

    /// Of one team, of which the others become members.
    void grow_team(std::size_t missing, Value value) {
        value.number = value.number * kTeams + steered_team_;
        const ModelTeam team = make<ModelTeam>(steered_team_, {});
        if (missing > 40) {
            count("create_many");
            create_alike<ModelSpeed, ModelTeam, ModelPlace>(missing - roll(30), value);
            return;
        }
        count("create");
        const std::uint32_t way = roll(3);
        if (way == 0) {
            create_one<ModelPlace, ModelSpeed>(value);
        } else {
            create_one<ModelPlace, ModelTeam, ModelSpeed>({value.number + way, kNoId});
        }
        const Id id = reference_.living().back();
        const Entity entity = reference_.handle(id);
        if (way == 1) {
            count("command");
            command([&](Commands commands) { commands.set(entity, team); });
        } else {
            count("add");
            world_.add(entity, team);
        }
        reference_.add(id, Kind::Team, {steered_team_, kNoId});
    }

    void shrink_whole() {
        const Id id = first_with([this](const Record& record) { return is_whole(record); });
        const Entity entity = reference_.handle(id);
        if (steered_team_ != kNoTeam && chance(50)) {
            const Value other{(steered_team_ + 1) % kTeams, kNoId};
            count("write");
            world_.set(entity, make<ModelTeam>(other.number, {}));
            reference_.set(id, Kind::Team, other);
            return;
        }
        switch (roll(3)) {
        case 0:
            count("destroy");
            world_.destroy(entity);
            reference_.destroy(id);
            break;
        case 1:
            count("command");
            command([&](Commands commands) { commands.destroy(entity); });
            reference_.destroy(id);
            break;
        default:
            count("command");
            command([&](Commands commands) { commands.add(entity, ModelBadge{}); });
            reference_.add(id, Kind::Badge, {});
        }
    }

    template <typename IsWanted>
    [[nodiscard]] Id first_with(const IsWanted& is_wanted) {
        const std::vector<Id>& living = reference_.living();
        const std::size_t start = roll(living.size());
        for (std::size_t i = 0; i < living.size(); ++i) {
            const Id id = living[(start + i) % living.size()];
            if (is_wanted(reference_.at(id))) {
                return id;
            }
        }
        return kNoId;
    }

    template <typename Record>
    void command(const Record& record) {
        record(Commands(buffer_));
        CommandBuffer* const buffers[] = {&buffer_};
        apply_commands(world_, buffers);
    }

    std::uint64_t steer_at_ = 5000;
    std::uint32_t steered_ = 0;
    std::int64_t steered_team_ = kNoTeam;
    std::unique_ptr<Saved> saved_;
};

}  // namespace limn::test::model
