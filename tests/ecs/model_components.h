#pragma once

#include "ecs/base/math.h"
#include "ecs/hierarchy.h"
#include "ecs/reflect.h"
#include "tests/ecs/model_reference.h"

#include <atomic>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

// The components of the model test, one per Kind of the reference, with every kind of storage; and
// how a value of each is made from, and read back to, what the reference knows of it.

namespace limn::test {

/// A number unique to each entity, so that the test finds the entities that commands have created.
struct ModelSerial {
    std::uint32_t number = 0;
};
struct ModelPlace {
    float x = 0, y = 0, z = 0;
};
struct ModelSpeed {
    double value = 0;
};
/// Owns memory.
struct ModelTitle {
    std::string text;
};
/// Counts its living instances.
struct ModelTally {
    static inline std::atomic<int> living = 0;
    int value = 0;
    ModelTally() { ++living; }
    explicit ModelTally(int v) : value(v) { ++living; }
    ModelTally(const ModelTally& other) : value(other.value) { ++living; }
    ModelTally(ModelTally&& other) noexcept : value(other.value) { ++living; }
    ModelTally& operator=(const ModelTally&) = default;
    ~ModelTally() { --living; }
};
struct ModelBadge {};
/// Names another entity, dead or alive.
struct ModelLink {
    Entity entity;
    std::uint32_t number = 0;
};
struct ModelWarmth {
    std::int32_t degrees = 0;
};
struct ModelMemo {
    std::string text;
};
struct ModelChosen {};
/// Split into four columns.
struct ModelPose {
    Vec3 at = {0, 0, 0};
    std::int32_t number = 0;
};
/// Can be disabled.
struct ModelLamp {
    std::int32_t watts = 0;
};
/// A tag that can be disabled.
struct ModelAwake {};
/// Kept once for all that are in it.
struct ModelTeam {
    std::uint32_t number = 0;
};

template <typename Visitor>
void visit_fields(ModelSerial& serial, Visitor&& visit) {
    visit("number", serial.number, {.doc = "its own"});
}
template <typename Visitor>
void visit_fields(ModelTitle& title, Visitor&& visit) {
    visit("text", title.text, {.doc = "short or long"});
}
template <typename Visitor>
void visit_fields(ModelTally& tally, Visitor&& visit) {
    visit("value", tally.value, {.doc = "any"});
}
template <typename Visitor>
void visit_fields(ModelLink& link, Visitor&& visit) {
    visit("entity", link.entity, {.doc = "any"});
    visit("number", link.number, {.doc = "any"});
}
template <typename Visitor>
void visit_fields(ModelMemo& memo, Visitor&& visit) {
    visit("text", memo.text, {.doc = "short or long"});
}

}  // namespace limn::test

template <>
struct limn::ComponentTraits<limn::test::ModelTally> : limn::DefaultTraits {
    static constexpr bool in_prefabs = false;
};
template <>
struct limn::ComponentTraits<limn::test::ModelWarmth> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<limn::test::ModelMemo> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<limn::test::ModelChosen> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

template <>
struct limn::ComponentTraits<limn::test::ModelPose> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
template <>
struct limn::ComponentTraits<limn::test::ModelLamp> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<limn::test::ModelAwake> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<limn::test::ModelTeam> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Shared;
};

namespace limn::test::model {

/// In the order of Kind.
using Components = std::tuple<
    ModelSerial, ModelPlace, ModelSpeed, ModelTitle, ModelTally, ModelBadge, ModelLink, Parent,
    ModelWarmth, ModelMemo, ModelChosen, ModelPose, ModelLamp, ModelAwake, ModelTeam>;
static_assert(std::tuple_size_v<Components> == kKinds);

/// The kinds that make_prefab leaves out.
inline constexpr Mask kNotInPrefabs = bit(Kind::Tally);

template <typename T, std::size_t I = 0>
[[nodiscard]] constexpr Kind kind_of() {
    if constexpr (std::is_same_v<std::tuple_element_t<I, Components>, T>) {
        return static_cast<Kind>(I);
    } else {
        return kind_of<T, I + 1>();
    }
}

/// Calls function.operator()<T>() for the component of the kind.
template <typename F>
void with_kind(Kind kind, F&& function) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (void)((static_cast<std::size_t>(kind) == I && (function.template operator()<std::tuple_element_t<I, Components>>(), true)) || ...);
    }
    (std::make_index_sequence<kKinds>{});
}

template <typename F>
void for_each_kind(F&& function) {
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (function.template operator()<std::tuple_element_t<I, Components>>(), ...);
    }
    (std::make_index_sequence<kKinds>{});
}

// ---- text: 0 is empty, odd numbers are long
// -------------------------------------------------------

inline constexpr std::string_view kLongTail = " is a text too long to be kept inside of the string";

[[nodiscard]] inline std::string text_of(std::int64_t number) {
    std::string text = number != 0 ? std::to_string(number) : std::string();
    return number % 2 != 0 ? text.append(kLongTail) : text;
}

/// -1 for what text_of never gives.
[[nodiscard]] inline std::int64_t number_of(const std::string& text) {
    std::int64_t number = 0;
    const char* const end = text.data() + text.size();
    const char* const tail = std::from_chars(text.data(), end, number).ptr;
    const std::string_view rest(tail, static_cast<std::size_t>(end - tail));
    return rest == (number % 2 != 0 ? kLongTail : std::string_view()) ? number : -1;
}

// ---- values
// --------------------------------------------------------------------------------------

template <typename T>
[[nodiscard]] T make(std::int64_t number, Entity entity) {
    if constexpr (std::is_empty_v<T>) {
        return {};
    } else if constexpr (std::is_same_v<T, ModelSerial>) {
        return {static_cast<std::uint32_t>(number)};
    } else if constexpr (std::is_same_v<T, ModelPlace>) {
        const float x = static_cast<float>(number);
        return {x, 2 * x, -x};
    } else if constexpr (std::is_same_v<T, ModelSpeed>) {
        return {static_cast<double>(number)};
    } else if constexpr (std::is_same_v<T, ModelTally>) {
        return ModelTally(static_cast<int>(number));
    } else if constexpr (std::is_same_v<T, ModelWarmth>) {
        return {static_cast<std::int32_t>(number)};
    } else if constexpr (std::is_same_v<T, ModelPose>) {
        const float x = static_cast<float>(number);
        return {{x, 2 * x, -x}, static_cast<std::int32_t>(number)};
    } else if constexpr (std::is_same_v<T, ModelLamp>) {
        return {static_cast<std::int32_t>(number)};
    } else if constexpr (std::is_same_v<T, ModelTeam>) {
        return {static_cast<std::uint32_t>(number % kTeams)};
    } else if constexpr (std::is_same_v<T, ModelLink> || std::is_same_v<T, Parent>) {
        return {entity, static_cast<std::uint32_t>(number)};
    } else {
        return {text_of(number)};
    }
}

/// -1 for what make() never gives.
template <typename T>
[[nodiscard]] std::int64_t read(const T& value) {
    if constexpr (std::is_empty_v<T>) {
        return 0;
    } else if constexpr (
        std::is_same_v<
            T, ModelSerial> || std::is_same_v<T, ModelLink> || std::is_same_v<T, ModelTeam>) {
        return value.number;
    } else if constexpr (std::is_same_v<T, ModelPlace>) {
        return value.y == 2 * value.x && value.z == -value.x ? static_cast<std::int64_t>(value.x)
                                                             : -1;
    } else if constexpr (std::is_same_v<T, ModelSpeed>) {
        return static_cast<std::int64_t>(value.value);
    } else if constexpr (std::is_same_v<T, ModelTally>) {
        return value.value;
    } else if constexpr (std::is_same_v<T, ModelWarmth>) {
        return value.degrees;
    } else if constexpr (std::is_same_v<T, ModelPose>) {
        const float x = static_cast<float>(value.number);
        return value.at == Vec3(x, 2 * x, -x) ? value.number : -1;
    } else if constexpr (std::is_same_v<T, ModelLamp>) {
        return value.watts;
    } else if constexpr (std::is_same_v<T, Parent>) {
        return value.order;
    } else {
        return number_of(value.text);
    }
}

/// Null for components that name nobody.
template <typename T>
[[nodiscard]] Entity entity_in([[maybe_unused]] const T& value) {
    if constexpr (std::is_same_v<T, ModelLink> || std::is_same_v<T, Parent>) {
        return value.entity;
    } else {
        return {};
    }
}

/// Whether the function for enabling takes it.
template <typename T>
inline constexpr bool can_toggle = (bit(kind_of<T>()) & kToggles) != 0;
template <typename T>
inline constexpr bool has_address = !std::is_same_v<T, ModelPose>;
/// Whether it can be written where it is: a team is that of others too.
template <typename T>
inline constexpr bool is_written_in_place = has_address<T> && !std::is_same_v<T, ModelTeam>;

inline void register_components() {
    for_each_kind([]<typename T>() { register_component<T>(); });
    register_resource<SiblingOrder>();
}

}  // namespace limn::test::model
