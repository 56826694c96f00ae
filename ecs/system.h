#pragma once

#include "ecs/base/type_name.h"
#include "ecs/system_param.h"

#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

// A system is a function over parts of the world:
//
//     void update_water(Query<const Water, WaterState> surfaces, Res<const FrameTime> time);
//
// Its parameter types declare what it may access (ecs/system_param.h). A System is such a function
// with its persistent state: the archetype list of each query, recorded commands, and when it last
// ran, which Changed compares with.

class System {
  public:
    /// Type-erased implementation, see SystemBody.
    class Body {
      public:
        virtual ~Body() = default;
        virtual void prepare(World& world) = 0;
        virtual void run(World& world, std::uint32_t version, std::uint32_t since) = 0;
        virtual CommandBuffer* commands() = 0;
        virtual void list_queries(std::vector<const QueryState*>& queries) const = 0;
    };

    System(std::string name, SystemAccess access, std::unique_ptr<Body> body)
        : name_(std::move(name)), access_(std::move(access)), body_(std::move(body)) {}

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] const SystemAccess& access() const { return access_; }

    /// Updates queries with new archetypes. Call before each run, while the structure does not
    /// change. Several systems may be prepared concurrently.
    void prepare(World& world) { body_->prepare(world); }
    /// Calls the function; commands are only recorded. `version` is from World::begin_run and
    /// ascends in system order. Systems whose accesses do not conflict may run concurrently. An
    /// exclusive one must run alone.
    void run(World& world, std::uint32_t version);
    /// The same for a caller who has locked the structure or, for an exclusive system, has checked
    /// that it is unlocked.
    void run_locked(World& world, std::uint32_t version);
    /// For apply_commands after the run; nullptr if the system takes no Commands.
    [[nodiscard]] CommandBuffer* commands() { return body_->commands(); }
    /// The queries among its parameters, in order.
    [[nodiscard]] std::vector<const QueryState*> queries() const {
        std::vector<const QueryState*> queries;
        body_->list_queries(queries);
        return queries;
    }

  private:
    std::string name_;
    SystemAccess access_;
    std::unique_ptr<Body> body_;
    std::uint32_t last_version_ = 0;
    std::uint32_t last_epoch_ = 0;  ///< WorldCore::epoch of its last run; 0: none
};

namespace detail {

template <typename F>
struct FunctionTraits : FunctionTraits<decltype(&F::operator())> {};
template <typename R, typename... Ps>
struct FunctionTraits<R (*)(Ps...)> {
    using Parameters = TypeList<Ps...>;
};
template <typename R, typename... Ps>
struct FunctionTraits<R (*)(Ps...) noexcept> : FunctionTraits<R (*)(Ps...)> {};
template <typename C, typename R, typename... Ps>
struct FunctionTraits<R (C::*)(Ps...)> : FunctionTraits<R (*)(Ps...)> {};
template <typename C, typename R, typename... Ps>
struct FunctionTraits<R (C::*)(Ps...) const> : FunctionTraits<R (*)(Ps...)> {};
template <typename C, typename R, typename... Ps>
struct FunctionTraits<R (C::*)(Ps...) noexcept> : FunctionTraits<R (*)(Ps...)> {};
template <typename C, typename R, typename... Ps>
struct FunctionTraits<R (C::*)(Ps...) const noexcept> : FunctionTraits<R (*)(Ps...)> {};

/// A function or a function object with one operator(), not a template.
template <typename F>
concept SystemFunction = std::is_pointer_v<F> || requires {
    &F::operator();
};

/// One-line errors for invalid parameters.
template <typename P>
struct ParameterCheck {
    using Value = std::remove_cvref_t<P>;
    static constexpr bool kIsGood = SystemParameter<P>;
    static constexpr bool kIsWorld = std::is_same_v<Value, World>;
    static constexpr bool kIsReference = SystemParameter<Value>;
    static_assert(kIsGood || !kIsWorld, "a system takes the World by reference");
    static_assert(
        kIsGood || !kIsReference,
        "a system takes Query, Res, Commands and the like by value, without &");
    static_assert(
        kIsGood || kIsWorld || kIsReference,
        "a parameter of a system is Query<..>, Res<T>, OptionalRes<T>, Commands, World& or const "
        "World&; components come through a Query");
};

template <typename... Ps>
SystemAccess access_of_parameters(TypeList<Ps...>) {
    static_assert(
        (int{0} + ... + int{std::is_same_v<Ps, Commands>}) <= 1,
        "a system takes Commands only once");
    SystemAccess access;
    if constexpr ((ParameterCheck<Ps>::kIsGood && ...)) {
        (SystemParam<Ps>::declare(access), ...);
    }
    access.normalize();
    return access;
}

/// The query of a parameter, or those of its members.
template <typename Param>
void append_queries(const Param& param, std::vector<const QueryState*>& queries) {
    if constexpr (requires { param.state.matches(); }) {
        queries.push_back(&param.state);
    } else if constexpr (requires { param.members; }) {
        std::apply(
            [&](const auto&... members) { (append_queries(members, queries), ...); },
            param.members);
    }
}

template <typename F, typename List>
class SystemBody;

template <typename F, typename... Ps>
class SystemBody<F, TypeList<Ps...>> final : public System::Body {
  public:
    explicit SystemBody(F function) : function_(std::move(function)) {}

    void prepare(World& world) override {
        std::apply([&](auto&... states) { (states.prepare(world), ...); }, states_);
    }
    void run(World& world, std::uint32_t version, std::uint32_t since) override {
        std::apply(
            [&](auto&... states) { function_(states.get(world, version, since)...); }, states_);
    }
    CommandBuffer* commands() override {
        CommandBuffer* found = nullptr;
        const auto look = [&](auto& state) {
            if constexpr (requires { state.buffer; }) {
                found = &state.buffer;
            }
        };
        std::apply([&](auto&... states) { (look(states), ...); }, states_);
        return found;
    }
    void list_queries(std::vector<const QueryState*>& queries) const override {
        std::apply([&](const auto&... states) { (append_queries(states, queries), ...); }, states_);
    }

  private:
    F function_;
    std::tuple<SystemParam<Ps>...> states_;
};

/// Its address identifies a type in SystemCache.
template <typename F>
inline constexpr char type_key = 0;

}  // namespace detail

/// Makes a system from a function or function object.
template <typename F>
[[nodiscard]] System make_system(std::string name, F function) {
    static_assert(
        detail::SystemFunction<F>, "a system is a function or a lambda without auto parameters");
    using Parameters = typename detail::FunctionTraits<F>::Parameters;
    return System(
        std::move(name), detail::access_of_parameters(Parameters{}),
        std::make_unique<detail::SystemBody<F, Parameters>>(std::move(function)));
}

/// The same, named after the function: make_system<update_water>().
template <auto function>
[[nodiscard]] System make_system() {
    return make_system(std::string(short_name(value_name<function>())), function);
}

/// What the system may access.
template <auto function>
[[nodiscard]] SystemAccess access_of() {
    return detail::access_of_parameters(
        typename detail::FunctionTraits<decltype(function)>::Parameters{});
}

/// Prepares, runs and applies the commands of one system.
void run_system(World& world, System& system);

/// The systems that World::run has run so far; they remember when they last ran.
struct SystemCache {
    /// nullptr if it has not run yet.
    static System* find(World& world, const void* type, const void* function);
    /// In the order of their first run.
    static std::vector<const System*> all(const World& world);
    static System& insert(World& world, const void* type, const void* function, System system);
};

}  // namespace limn
