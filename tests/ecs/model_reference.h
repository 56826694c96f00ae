#pragma once

#include "ecs/entity.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace limn::test::model {

// What a world should be, kept in maps: the plain half of the model test. It is written from the
// documentation of the ECS, uses nothing of it but Entity, and takes no trouble to be quick.
//
// An entity has an Id from the moment somebody asks for it; its handle follows once the world has
// given one out (bind). Changes of one sync point are made one after the other between begin_batch
// and end_batch, which sums up what observers should have been told.

enum class Kind : std::uint8_t {
    Serial,
    Place,
    Speed,
    Title,
    Tally,
    Badge,
    Link,
    Parent,
    Warmth,
    Memo,
    Chosen,
    Pose,
    Lamp,
    Awake,
    Team,
};
inline constexpr std::size_t kKinds = 15;

using Mask = std::uint32_t;  ///< a bit a kind
[[nodiscard]] constexpr Mask bit(Kind kind) {
    return Mask{1} << static_cast<unsigned>(kind);
}
inline constexpr Mask kSparseKinds = bit(Kind::Warmth) | bit(Kind::Memo) | bit(Kind::Chosen);
inline constexpr Mask kTags = bit(Kind::Badge) | bit(Kind::Chosen) | bit(Kind::Awake);
inline constexpr Mask kToggles = bit(Kind::Lamp) | bit(Kind::Awake);
inline constexpr Mask kLinks = bit(Kind::Link) | bit(Kind::Parent);

/// Entities share their teams, so there are few, from 0 on.
inline constexpr std::int64_t kTeams = 3;
inline constexpr std::int64_t kNoTeam = -1;

using Id = std::uint32_t;
inline constexpr Id kNoId = 0xffffffffu;

/// The meaning of a component.
struct Value {
    std::int64_t number = 0;
    Id entity = kNoId;  ///< of the kinds that name an entity
};

struct Record {
    Mask mask = 0;
    Mask disabled = 0;
    Mask changed = 0;                 ///< written or moved since forget_changes; not for teams
    std::int64_t old_team = kNoTeam;  ///< at forget_changes
    std::array<Value, kKinds> values = {};
    std::size_t position = 0;  ///< in the list of the living

    [[nodiscard]] bool has(Kind kind) const { return (mask & bit(kind)) != 0; }
    [[nodiscard]] bool is_enabled(Kind kind) const { return (seen() & bit(kind)) != 0; }
    /// What queries see.
    [[nodiscard]] Mask seen() const { return mask & ~disabled; }
    [[nodiscard]] bool matches(Mask required, Mask excluded) const {
        return (seen() & required) == required && (seen() & excluded) == 0;
    }
    /// The same, disabled or not.
    [[nodiscard]] bool is_made_of(Mask required, Mask excluded) const {
        return (mask & required) == required && (mask & excluded) == 0;
    }
    [[nodiscard]] std::int64_t team() const {
        return has(Kind::Team) ? value(Kind::Team).number : kNoTeam;
    }
    /// What queries must report. To be given the team one is in is no change.
    [[nodiscard]] Mask changed_and_seen() const {
        const Mask others = changed & ~bit(Kind::Team);
        return seen() & (others | (team() != old_team ? bit(Kind::Team) : 0));
    }
    [[nodiscard]] Value& value(Kind kind) { return values[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] const Value& value(Kind kind) const {
        return values[static_cast<std::size_t>(kind)];
    }
};

[[nodiscard]] inline std::uint64_t mix(std::uint64_t a, std::uint64_t b) {
    std::uint64_t x = a * 0x9e3779b97f4a7c15u + b;
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    x ^= x >> 29;
    return x * 0xd6e8feb86659fd93u;
}

/// What the observers of one component and event have been told.
struct Told {
    std::uint64_t count = 0;
    std::uint64_t sum = 0;  ///< of the entities, in any order

    void add(Entity entity) {
        ++count;
        sum += mix(entity.bits(), 7);
    }
    bool operator==(const Told&) const = default;
};

class Reference {
  public:
    [[nodiscard]] const std::map<Id, Record>& records() const { return records_; }
    [[nodiscard]] const std::vector<Id>& living() const { return living_; }
    /// Some that were destroyed, with handles that must be stale.
    [[nodiscard]] const std::vector<Id>& dead() const { return dead_; }
    [[nodiscard]] bool alive(Id id) const { return records_.contains(id); }
    [[nodiscard]] bool has(Id id, Kind kind) const {
        const auto found = records_.find(id);
        return found != records_.end() && found->second.has(kind);
    }
    [[nodiscard]] const Record& at(Id id) const { return records_.at(id); }
    [[nodiscard]] bool is_bound(Id id) const { return !handles_[id].is_null(); }
    /// Null for kNoId.
    [[nodiscard]] Entity handle(Id id) const { return id == kNoId ? Entity{} : handles_[id]; }
    /// kNoId: no living entity has this handle.
    [[nodiscard]] Id id_of(Entity entity) const {
        const auto found = ids_.find(entity);
        return found != ids_.end() ? found->second : kNoId;
    }

    // ---- changes
    // ------------------------------------------------------------------------------

    Id create() {
        const Id id = static_cast<Id>(handles_.size());
        handles_.emplace_back();
        records_[id].position = living_.size();
        living_.push_back(id);
        if (in_batch_) {
            touched_[id].is_new = true;
        }
        return id;
    }

    /// Whether no living entity has the handle.
    bool bind(Id id, Entity entity) {
        handles_[id] = entity;
        return !alive(id) || ids_.emplace(entity, id).second;
    }

    void destroy(Id id) {
        const auto found = records_.find(id);
        if (found == records_.end()) {
            return;
        }
        if (in_batch_) {
            touch(id);
        } else {
            tell(removed_, found->second.mask, handles_[id]);
        }
        living_[found->second.position] = living_.back();
        records_.at(living_.back()).position = found->second.position;
        living_.pop_back();
        records_.erase(found);
        if (!handles_[id].is_null()) {
            ids_.erase(handles_[id]);
            constexpr std::size_t kRemembered = 512;
            if (dead_.size() < kRemembered) {
                dead_.push_back(id);
            } else {
                dead_[id % kRemembered] = id;
            }
        }
    }

    /// Adds or replaces, and enables.
    void add(Id id, Kind kind, Value value) {
        if (!alive(id)) {
            return;
        }
        Record& record = records_.at(id);
        if (in_batch_) {
            touch(id);
        } else if (!record.has(kind)) {
            tell(added_, bit(kind), handles_[id]);
        }
        record.mask |= bit(kind);
        record.disabled &= ~bit(kind);
        record.changed |= bit(kind);
        record.value(kind) = value;
    }

    /// Replaces what is there.
    void set(Id id, Kind kind, Value value) {
        if (has(id, kind)) {
            records_.at(id).changed |= bit(kind);
            records_.at(id).value(kind) = value;
        }
    }

    /// Whether it was otherwise.
    bool set_enabled(Id id, Kind kind, bool enabled) {
        if (!has(id, kind) || at(id).is_enabled(kind) == enabled) {
            return false;
        }
        if (in_batch_) {
            touch(id);  // it may be undone before anybody sees it
        } else {
            records_.at(id).changed |= bit(kind);
        }
        records_.at(id).disabled ^= bit(kind);
        return true;
    }

    bool remove(Id id, Kind kind) {
        const bool present = has(id, kind);
        if (in_batch_ && alive(id)) {
            touch(id).removed |= bit(kind);
        } else if (present) {
            tell(removed_, bit(kind), handles_[id]);
        }
        if (present) {
            records_.at(id).mask &= ~bit(kind);
            records_.at(id).disabled &= ~bit(kind);
            records_.at(id).value(kind) = {};
        }
        return present;
    }

    void clear() {
        while (!living_.empty()) {
            destroy(living_.back());
        }
    }

    /// Everything is as it was in `saved`, but for what observers have been told.
    void restore(const Reference& saved) {
        clear();
        const auto added = added_;
        const auto removed = removed_;
        *this = saved;
        added_ = added;
        removed_ = removed;
        for (auto& [id, record] : records_) {
            tell(added_, record.mask, handles_[id]);
            record.changed = record.mask;
            record.old_team = kNoTeam;
        }
    }

    void forget_changes() {
        for (auto& [id, record] : records_) {
            record.changed = 0;
            record.old_team = record.team();
        }
    }

    // ---- a sync point
    // -------------------------------------------------------------------------

    void begin_batch() { in_batch_ = true; }
    /// All that were created in it and are alive have been bound.
    void end_batch() {
        in_batch_ = false;
        for (const auto& [id, before] : touched_) {
            const auto found = records_.find(id);
            if (before.is_new) {
                if (found != records_.end()) {
                    tell(added_, found->second.mask, handles_[id]);
                }
            } else if (found == records_.end()) {
                tell(removed_, before.mask, handles_[id]);
            } else {
                const Mask after = found->second.mask;
                found->second.changed |= before.disabled ^ found->second.disabled;
                tell(removed_, before.mask & (~after | before.removed), handles_[id]);
                tell(added_, after & (~before.mask | before.removed), handles_[id]);
            }
        }
        touched_.clear();
    }

    [[nodiscard]] const std::array<Told, kKinds>& told_added() const { return added_; }
    [[nodiscard]] const std::array<Told, kKinds>& told_removed() const { return removed_; }

    // ---- the hierarchy
    // ------------------------------------------------------------------------

    std::uint32_t next_order = 1;

    /// kNoId: a root.
    [[nodiscard]] Id parent_of(Id id) const {
        const auto found = records_.find(id);
        if (found == records_.end() || !found->second.has(Kind::Parent)) {
            return kNoId;
        }
        const Id parent = found->second.value(Kind::Parent).entity;
        return parent != kNoId && alive(parent) ? parent : kNoId;
    }
    /// Whether `id` is `above` or below it.
    [[nodiscard]] bool is_below(Id id, Id above) const {
        while (id != kNoId && id != above) {
            id = parent_of(id);
        }
        return id == above;
    }
    /// Of every parent, in their order.
    [[nodiscard]] std::map<Id, std::vector<Id>> children() const {
        std::map<Id, std::vector<Id>> children;
        for (const auto& [id, record] : records_) {
            const Id parent = record.has(Kind::Parent) ? parent_of(id) : kNoId;
            if (parent != kNoId) {
                children[parent].push_back(id);
            }
        }
        for (auto& [parent, siblings] : children) {
            std::sort(siblings.begin(), siblings.end(), [this](Id a, Id b) {
                const std::int64_t order_a = at(a).value(Kind::Parent).number;
                const std::int64_t order_b = at(b).value(Kind::Parent).number;
                return order_a != order_b ? order_a < order_b : handle(a).index < handle(b).index;
            });
        }
        return children;
    }
    /// Parents before children, siblings in order.
    [[nodiscard]] std::vector<Id> subtree(Id root) const {
        const std::map<Id, std::vector<Id>> children = this->children();
        std::vector<Id> subtree;
        std::vector<Id> stack = {root};
        while (!stack.empty()) {
            subtree.push_back(stack.back());
            stack.pop_back();
            if (const auto found = children.find(subtree.back()); found != children.end()) {
                stack.insert(stack.end(), found->second.rbegin(), found->second.rend());
            }
        }
        return subtree;
    }

    /// Those whose record is wanted.
    template <typename IsWanted>
    [[nodiscard]] std::size_t count(const IsWanted& is_wanted) const {
        return static_cast<std::size_t>(
            std::count_if(records_.begin(), records_.end(), [&](const auto& entry) {
                return is_wanted(entry.second);
            }));
    }

  private:
    struct Touched {
        Mask mask = 0;      ///< before
        Mask disabled = 0;  ///< before
        Mask removed = 0;   ///< at some time in between
        bool is_new = false;
    };

    Touched& touch(Id id) {
        const auto [found, is_first] = touched_.try_emplace(id);
        if (is_first) {
            found->second.mask = records_.at(id).mask;
            found->second.disabled = records_.at(id).disabled;
        }
        return found->second;
    }

    static void tell(std::array<Told, kKinds>& told, Mask mask, Entity entity) {
        for (std::size_t kind = 0; kind < kKinds; ++kind) {
            if ((mask >> kind & 1u) != 0) {
                told[kind].add(entity);
            }
        }
    }

    std::map<Id, Record> records_;
    std::unordered_map<Entity, Id> ids_;
    std::vector<Id> living_;
    std::vector<Id> dead_;
    std::vector<Entity> handles_;  ///< by Id
    std::map<Id, Touched> touched_;
    std::array<Told, kKinds> added_ = {};
    std::array<Told, kKinds> removed_ = {};
    bool in_batch_ = false;
};

}  // namespace limn::test::model
