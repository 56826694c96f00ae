#pragma once

#include "ecs/world.h"

#include <string>

/// Toggled components, and the same as plain ones, for the tests of toggles.
namespace toggle_test {

using namespace limn;

struct Body {
    int value = 0;
};
struct Chill {
    int value = 0;
};
/// The toggled components, and the same as plain ones.
struct Power {
    int value = 0;
};
struct Motto {
    std::string value;
};
struct Lit {};
struct PlainPower {
    int value = 0;
};
struct PlainMotto {
    std::string value;
};
struct PlainLit {};
/// In snapshots.
struct ToggledCharge {
    int value = 0;
};
struct ToggledSign {};

inline void register_toggled() {
    register_component<ToggledCharge>();
    register_component<ToggledSign>();
}

}  // namespace toggle_test

template <>
struct limn::ComponentTraits<toggle_test::Chill> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<toggle_test::Power> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::Motto> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::Lit> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::ToggledCharge> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
template <>
struct limn::ComponentTraits<toggle_test::ToggledSign> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Toggle;
};
