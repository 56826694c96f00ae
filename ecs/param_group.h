#pragma once

#include "ecs/system_param.h"

#include <cstdint>
#include <tuple>
#include <type_traits>

namespace limn {

/// Several parameters of a system as one: `Group` is an aggregate of `Members`, in this order.
///
///     template <>
///     struct SystemParam<Meshes> : ParamGroup<Meshes, Query<const Mesh>, Res<const Assets>> {};
template <typename Group, typename... Members>
struct ParamGroup {
    static_assert(
        (!std::is_same_v<Members, Commands> && ...), "Commands is a parameter of its own");
    static void declare(SystemAccess& access) { (SystemParam<Members>::declare(access), ...); }
    void prepare(World& world) {
        std::apply([&](auto&... states) { (states.prepare(world), ...); }, members);
    }
    Group get(World& world, std::uint32_t version, std::uint32_t since) {
        return std::apply(
            [&](auto&... states) { return Group{states.get(world, version, since)...}; }, members);
    }
    std::tuple<SystemParam<Members>...> members;
};

}  // namespace limn
