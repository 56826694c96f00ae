#pragma once

#include "ecs/commands.h"
#include "ecs/prefab.h"
#include "tests/ecs/model_components.h"
#include "tests/ecs/model_reference.h"

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

// Commands as the model test invents them: first as data, which the reference obeys in the order in
// which they will count; then recorded into the world's Commands, perhaps by several threads.

namespace limn::test::model {

/// A subtree as the reference knows it, beside the ECS's own.
struct Template {
    struct Member {
        Mask mask = 0;
        Mask disabled = 0;
        std::array<Value, kKinds> values = {};
        std::array<std::uint32_t, kKinds> inside =
            {};  ///< member + 1 that a link names; 0: as it says
    };
    std::vector<Member> members;  ///< the root first
    Prefab prefab;
};

/// A command to come.
struct Planned {
    enum class Op : std::uint8_t {
        Create,
        CreateMixed,
        Destroy,
        Add,
        AddUntyped,
        Set,
        Remove,
        Spawn,
        Enable,
        Disable,
    };

    Op op = Op::Add;
    Kind kind = Kind::Serial;
    Id target = kNoId;
    Value value;
    Entity stranger;  ///< not null: the target, a handle that never was one
    std::shared_ptr<const Template> spawned;
};

/// Records plans; knows the placeholders of one run of one system.
class Recorder {
  public:
    Recorder(Commands commands, const Reference& reference)
        : commands_(commands), reference_(reference) {}

    void record(const Planned& planned) {
        const Entity target =
            planned.stranger.is_null() ? handle(planned.target) : planned.stranger;
        const std::int64_t number = planned.value.number;
        const Entity link = handle(planned.value.entity);
        switch (planned.op) {
        case Planned::Op::Create:
            placeholders_[planned.target] = commands_.create(make<ModelSerial>(number, {}));
            break;
        case Planned::Op::CreateMixed:
            placeholders_[planned.target] = commands_.create(
                make<ModelWarmth>(number, {}), make<ModelSerial>(number, {}),
                make<ModelTitle>(number, {}), ModelBadge{}, make<ModelTeam>(number, {}),
                make<ModelLink>(number, link));
            break;
        case Planned::Op::Destroy:
            commands_.destroy(target);
            break;
        case Planned::Op::Add:
            with_kind(
                planned.kind, [&]<typename T>() { commands_.add(target, make<T>(number, link)); });
            break;
        case Planned::Op::AddUntyped:
            with_kind(planned.kind, [&]<typename T>() {
                const T value = make<T>(number, link);
                commands_.add_copy(target, component_id<T>, &value);
            });
            break;
        case Planned::Op::Set:
            with_kind(
                planned.kind, [&]<typename T>() { commands_.set(target, make<T>(number, link)); });
            break;
        case Planned::Op::Remove:
            with_kind(planned.kind, [&]<typename T>() { commands_.remove<T>(target); });
            break;
        case Planned::Op::Enable:
        case Planned::Op::Disable:
            with_kind(planned.kind, [&]<typename T>() {
                if constexpr (can_toggle<T>) {
                    commands_.set_enabled<T>(target, planned.op == Planned::Op::Enable);
                }
            });
            break;
        case Planned::Op::Spawn:
            placeholders_[planned.target] = spawn(commands_, planned.spawned->prefab, link);
            break;
        }
    }

    [[nodiscard]] const std::map<Id, Entity>& placeholders() const { return placeholders_; }

  private:
    [[nodiscard]] Entity handle(Id id) const {
        const auto found = placeholders_.find(id);
        return found != placeholders_.end() ? found->second : reference_.handle(id);
    }

    Commands commands_;
    const Reference& reference_;
    std::map<Id, Entity> placeholders_;
};

}  // namespace limn::test::model
