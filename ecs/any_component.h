#pragma once

#include "ecs/reflect.h"

namespace limn {

class World;

/// The value of a component or resource whose type is known at run time only: what a level or a
/// script keeps until there is an entity to give it to. Copies copy the value.
class AnyComponent {
  public:
    AnyComponent() = default;
    /// Default-constructed; the type must allow that.
    explicit AnyComponent(const ComponentInfo& info);
    /// A copy of `value`, whose type is `info`.
    AnyComponent(const ComponentInfo& info, const void* value);
    /// A copy of an entity's component, empty if it has none.
    [[nodiscard]] static AnyComponent
    read(const World& world, Entity entity, const ComponentInfo& info);
    AnyComponent(const AnyComponent& other);
    AnyComponent(AnyComponent&& other) noexcept;
    AnyComponent& operator=(AnyComponent other) noexcept;
    ~AnyComponent();

    [[nodiscard]] bool is_empty() const { return info_ == nullptr; }
    [[nodiscard]] const ComponentInfo& info() const { return *info_; }
    [[nodiscard]] void* data() { return data_; }  ///< never null unless empty, for a tag too
    [[nodiscard]] const void* data() const { return data_; }

    /// The value, whose type must be T.
    template <typename T>
    [[nodiscard]] T& as() {
        LIMN_CHECK(info_ == &component_info<T>());
        return *static_cast<T*>(data_);
    }
    template <typename T>
    [[nodiscard]] const T& as() const {
        LIMN_CHECK(info_ == &component_info<T>());
        return *static_cast<const T*>(data_);
    }

    /// From a value: AnyComponent::of(Transform{}).
    template <typename T>
    [[nodiscard]] static AnyComponent of(const T& value) {
        return AnyComponent(component_info<T>(), &value);
    }

  private:
    const ComponentInfo* info_ = nullptr;
    void* data_ = nullptr;
};

/// Makes the field at `to`, all elements of it, equal to that at `from`.
void copy_field(const FieldInfo& field, void* to, const void* from);

}  // namespace limn
