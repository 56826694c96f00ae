#pragma once

#include "ecs/world.h"
#include "tests/ecs/model_compare.h"
#include "tests/ecs/model_components.h"
#include "tests/ecs/model_reference.h"

#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <span>
#include <string>
#include <vector>

// A world beside its reference, with what all random operations need: chance, a count of what has
// been done, observers that take down what they are told, and the comparison.

namespace limn::test::model {

class ModelRun {
  public:
    ModelRun(std::uint32_t seed, std::uint64_t compare_every)
        : random_(seed), compare_every_(compare_every) {
        register_components();
        world_.insert_resource(SiblingOrder{});
        for_each_kind([this]<typename T>() {
            constexpr std::size_t kKind = static_cast<std::size_t>(kind_of<T>());
            world_.on_add<T>([this](World& world, std::span<const Entity> entities) {
                hear<T>(world, entities, added_[kKind]);
            });
            world_.on_remove<T>([this](World& world, std::span<const Entity> entities) {
                hear<T>(world, entities, removed_[kKind]);
            });
        });
    }

    [[nodiscard]] const std::uint64_t& done() const { return done_; }
    [[nodiscard]] std::uint64_t comparisons() const { return comparisons_; }
    /// Row counts of archetypes at the times of comparison.
    [[nodiscard]] const std::set<std::uint32_t>& row_counts() const { return row_counts_; }
    /// Numbers of sparse values at the times of comparison.
    [[nodiscard]] const std::set<std::uint32_t>& sparse_counts() const { return sparse_counts_; }
    [[nodiscard]] const std::map<std::string, std::uint64_t>& counts() const { return counts_; }

  protected:
    [[nodiscard]] std::uint32_t roll(std::size_t sides) {
        return static_cast<std::uint32_t>(random_() % sides);
    }
    [[nodiscard]] bool chance(unsigned percent) { return roll(100) < percent; }

    void count(const char* what, std::uint64_t operations = 1) {
        done_ += operations;
        counts_[what] += operations;
    }

    // ---- choosing

    [[nodiscard]] Id any_living() {
        const std::vector<Id>& living = reference_.living();
        return living[roll(living.size())];
    }
    [[nodiscard]] Id any_dead() {
        const std::vector<Id>& dead = reference_.dead();
        return dead.empty() ? kNoId : dead[roll(dead.size())];
    }
    [[nodiscard]] Kind any_kind() { return static_cast<Kind>(roll(kKinds)); }

    /// What a link may name; `own` are to be preferred now and then.
    [[nodiscard]] Id any_link(const std::vector<Id>& own = {}) {
        if (!own.empty() && chance(30)) {
            return own[roll(own.size())];
        }
        const std::uint32_t choice = roll(10);
        if (choice == 0 || reference_.living().empty()) {
            return kNoId;
        }
        return choice == 1 ? any_dead() : bound_or_null(any_living());
    }
    /// Outside of its own recording nobody knows the entity yet.
    [[nodiscard]] Id bound_or_null(Id id) const {
        return id != kNoId && reference_.is_bound(id) ? id : kNoId;
    }

    [[nodiscard]] Value any_value(Kind kind, Id owner, const std::vector<Id>& own = {}) {
        Value value;
        if ((bit(kind) & kTags) != 0) {
            return value;
        }
        value.number = kind == Kind::Serial   ? next_serial_++
                       : kind == Kind::Parent ? roll(4)
                       : kind == Kind::Team   ? roll(kTeams)
                                              : roll(1'000'000);
        if ((bit(kind) & kLinks) != 0) {
            value.entity = any_link(own);
        }
        if (kind == Kind::Parent && value.entity != kNoId
            && reference_.is_below(value.entity, owner)) {
            value.entity = kNoId;  // written directly, a cycle would be closed
        }
        return value;
    }

    // ---- creating
    template <typename... Ts>
    void create_one(Value value) {
        const Id id = reference_.create();
        [[maybe_unused]] const Entity link = reference_.handle(value.entity);
        bind(id, world_.create(make<Ts>(value.number, link)...));
        (reference_.add(id, kind_of<Ts>(), known<Ts>(value)), ...);
    }

    /// What of a value the component keeps.
    template <typename T>
    static Value known(Value value) {
        constexpr Mask kBit = bit(kind_of<T>());
        const std::int64_t number = kBit == bit(Kind::Team) ? value.number % kTeams : value.number;
        return {(kBit & kTags) != 0 ? 0 : number, (kBit & kLinks) != 0 ? value.entity : kNoId};
    }

    void bind(Id id, Entity entity) {
        expect(reference_.bind(id, entity), "a handle is given out twice");
    }

    template <typename... Ts>
    void create_alike(std::size_t size, Value value) {
        const std::vector<Entity> entities =
            world_.create_many(size, make<Ts>(value.number, {})...);
        expect(entities.size() == size, "create_many gives another number");
        for (const Entity entity : entities) {
            const Id id = reference_.create();
            bind(id, entity);
            (reference_.add(id, kind_of<Ts>(), known<Ts>(value)), ...);
        }
    }

    // ---- looking

    template <typename T>
    void hear(const World& world, std::span<const Entity> entities, Told& told) {
        for (const Entity entity : entities) {
            expect(world.has<T>(entity), "an observer is told of an entity without the component");
            told.add(entity);
        }
    }

    void compare() {
        for (const auto& archetype : world_.archetypes()) {
            row_counts_.insert(archetype->size());
        }
        for (const SparseSet* set : world_.sparse_sets()) {
            sparse_counts_.insert(set->size());
        }
        expect(added_ == reference_.told_added(), "on_add was told something else");
        expect(removed_ == reference_.told_removed(), "on_remove was told something else");
        expect(
            static_cast<std::size_t>(ModelTally::living - tallies_before_)
                == reference_.count([](const Record& record) { return record.has(Kind::Tally); }),
            "values are lost or were never destroyed");
        comparison_.run(static_cast<unsigned>(comparisons_));
        ++comparisons_;
        compare_at_ = done_ + compare_every_;
    }

    World world_;
    Reference reference_;
    std::int64_t next_serial_ = 1;
    std::size_t goal_ = 500;  ///< of the population
    std::uint64_t done_ = 0;
    std::uint64_t comparisons_ = 0;
    std::uint64_t compare_at_ = 0;

  private:
    std::mt19937_64 random_;
    std::uint64_t compare_every_;
    std::map<std::string, std::uint64_t> counts_;
    std::set<std::uint32_t> row_counts_;
    std::set<std::uint32_t> sparse_counts_;
    std::array<Told, kKinds> added_ = {};
    std::array<Told, kKinds> removed_ = {};
    int tallies_before_ = ModelTally::living;
    Comparison comparison_{world_, reference_};
};

}  // namespace limn::test::model
