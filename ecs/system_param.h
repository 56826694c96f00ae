#pragma once

#include "ecs/commands.h"
#include "ecs/query.h"
#include "ecs/resource.h"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace limn {

// What a system parameter gives access to, and how it is obtained from the world. A SystemParam
// lives as long as its System; prepare() and get() are called once per run.

struct SystemAccess {
    std::vector<ComponentId> reads;   ///< components, ascending, none of them in `writes`
    std::vector<ComponentId> writes;  ///< components, ascending
    std::vector<ComponentId> resource_reads;
    std::vector<ComponentId> resource_writes;
    bool commands = false;   ///< records structural changes
    bool reads_all = false;  ///< const World&: may read anything
    bool exclusive = false;  ///< World&: may change anything, including the structure

    /// Sorts, and removes from the reads what is also written.
    void normalize();
    /// Whether two systems must not run concurrently.
    [[nodiscard]] bool conflicts_with(const SystemAccess& other) const;
};

class World;

template <typename P>
struct SystemParam {};

namespace detail {

template <typename P>
concept SystemParameter = requires(SystemAccess& access) {
    SystemParam<P>::declare(access);
};

[[nodiscard]] WorldCore& core_of(World& world);
[[nodiscard]] ResourceSlot* find_resource_slot(World& world, ComponentId id);
[[nodiscard]] ResourceSlot& require_resource_slot(World& world, ComponentId id);

template <typename T>
void declare_resource(SystemAccess& access) {
    const ComponentId id = component_id<std::remove_const_t<T>>;
    (std::is_const_v<T> ? access.resource_reads : access.resource_writes).push_back(id);
}

}  // namespace detail

template <typename... Terms>
struct SystemParam<Query<Terms...>> {
    static void declare(SystemAccess& access) {
        for (const QueryTerm& term : detail::query_terms<Terms...>()) {
            switch (term.kind) {
            case TermKind::Write:
            case TermKind::OptionalWrite:
            case TermKind::TakeRows:
                access.writes.push_back(term.id);
                break;
            case TermKind::Read:
            case TermKind::OptionalRead:
            case TermKind::Changed:
                access.reads.push_back(term.id);
                break;
            case TermKind::With:
            case TermKind::Without:
            case TermKind::AnyOf:
                // The structure is fixed while systems run; enable bits are not.
                if (component_info(term.id).storage == Storage::Toggle) {
                    access.reads.push_back(term.id);
                }
                break;
            }
        }
    }
    void prepare(World& world) { state.update(detail::core_of(world)); }
    Query<Terms...> get(World& world, std::uint32_t version, std::uint32_t since) {
        return Query<Terms...>(detail::core_of(world), state, version, since);
    }
    QueryState state{detail::query_terms<Terms...>()};
};

template <typename T>
struct SystemParam<Res<T>> {
    static void declare(SystemAccess& access) { detail::declare_resource<T>(access); }
    void prepare(World&) {}
    Res<T> get(World& world, std::uint32_t version, std::uint32_t since) {
        return Res<T>(
            detail::require_resource_slot(world, component_id<std::remove_const_t<T>>), version,
            since);
    }
};

template <typename T>
struct SystemParam<OptionalRes<T>> {
    static void declare(SystemAccess& access) { detail::declare_resource<T>(access); }
    void prepare(World&) {}
    OptionalRes<T> get(World& world, std::uint32_t version, std::uint32_t) {
        return OptionalRes<T>(
            detail::find_resource_slot(world, component_id<std::remove_const_t<T>>), version);
    }
};

template <>
struct SystemParam<Commands> {
    static void declare(SystemAccess& access) { access.commands = true; }
    void prepare(World&) {}
    Commands get(World&, std::uint32_t, std::uint32_t) { return Commands(buffer); }
    CommandBuffer buffer;
};

template <>
struct SystemParam<World&> {
    static void declare(SystemAccess& access) { access.exclusive = true; }
    void prepare(World&) {}
    World& get(World& world, std::uint32_t, std::uint32_t) { return world; }
};

template <>
struct SystemParam<const World&> {
    static void declare(SystemAccess& access) { access.reads_all = true; }
    void prepare(World&) {}
    const World& get(World& world, std::uint32_t, std::uint32_t) { return world; }
};

}  // namespace limn
