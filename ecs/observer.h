#pragma once

#include "ecs/entity.h"
#include "ecs/reflect.h"

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace limn {

class World;

// Callbacks for added and removed components, for example to create and free GPU objects.
//
// Observers are called in registration order, each with all entities of the operation at once: one
// for world.create, n for create_many, and for a sync point of Commands all entities that gained
// (lost) the component there, in the order of the commands.
//     on_add     after everything is in place; may change the structure. Skips entities that an
//                earlier observer destroyed or took the component from.
//     on_remove  before anything is removed: the component can still be read. Must not change
//                the structure.
// Replacing a value, enabling and disabling trigger neither. World::clear and the destructor of
// World call on_remove for everything left.

enum class ObserverEvent : std::uint8_t { Add, Remove };

/// A type-erased, move-only observer callback.
class ObserverFunction {
  public:
    template <typename F>
    explicit ObserverFunction(F function)
        : body_(new F(std::move(function)), [](void* body) { delete static_cast<F*>(body); }),
          call_([](void* body, World& world, std::span<const Entity> entities) {
              if constexpr (std::is_invocable_v<F&, World&, std::span<const Entity>>) {
                  (*static_cast<F*>(body))(world, entities);  // otherwise on_add reports the error
              }
          }) {}
    void operator()(World& world, std::span<const Entity> entities) const {
        call_(body_.get(), world, entities);
    }

  private:
    std::unique_ptr<void, void (*)(void*)> body_;
    void (*call_)(void*, World&, std::span<const Entity>);
};

struct Observer {
    ObserverEvent event;
    ComponentId component;
    ObserverFunction function;
};

}  // namespace limn
