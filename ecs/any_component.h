#pragma once

#include "ecs/reflect.h"

namespace limn {

class World;

/// A type-erased value of a component or resource, such as a level or script holds before the
/// entity exists. Copies copy the value.
class AnyComponent {
  public:
    AnyComponent() = default;
    /// Default-constructed; the type must allow that.
    explicit AnyComponent(const ComponentInfo& info);
    /// A copy of `value`, whose type is `info`.
    AnyComponent(const ComponentInfo& info, const void* value);
    /// Moved from `value`; the type need not be copyable.
    [[nodiscard]] static AnyComponent take(const ComponentInfo& info, void* value);
    /// A copy of an entity's component, empty if it has none.
    [[nodiscard]] static AnyComponent
    read(const World& world, Entity entity, const ComponentInfo& info);
    AnyComponent(const AnyComponent& other);
    AnyComponent(AnyComponent&& other) noexcept;
    AnyComponent& operator=(AnyComponent other) noexcept;
    ~AnyComponent();

    [[nodiscard]] bool is_empty() const { return info_ == nullptr; }
    [[nodiscard]] const ComponentInfo& info() const { return *info_; }
    [[nodiscard]] void* data() { return data_; }  ///< null only if empty, even for a tag
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

/// Copies the field at `from`, with all its elements, to `to`.
void copy_field(const FieldInfo& field, void* to, const void* from);

}  // namespace limn
