#include "ecs/any_component.h"

#include <algorithm>
#include <new>
#include <utility>

namespace limn {

namespace {

void* allocate(const ComponentInfo& info) {
    return ::operator new (std::max<std::size_t>(info.size, 1), std::align_val_t{info.align});
}

}  // namespace

AnyComponent::AnyComponent(const ComponentInfo& info) : info_(&info), data_(allocate(info)) {
    LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
    info.ops.construct_default(data_, 1);
}

AnyComponent::AnyComponent(const ComponentInfo& info, const void* value)
    : info_(&info), data_(allocate(info)) {
    LIMN_CHECK_NOTE(info.ops.construct_copy != nullptr, info.name.c_str());
    info.ops.construct_copy(data_, value, 1);
}

AnyComponent::AnyComponent(const AnyComponent& other) {
    if (!other.is_empty()) {
        AnyComponent copy(*other.info_, other.data_);
        std::swap(info_, copy.info_);
        std::swap(data_, copy.data_);
    }
}

AnyComponent::AnyComponent(AnyComponent&& other) noexcept
    : info_(std::exchange(other.info_, nullptr)), data_(std::exchange(other.data_, nullptr)) {}

AnyComponent& AnyComponent::operator=(AnyComponent other) noexcept {
    std::swap(info_, other.info_);
    std::swap(data_, other.data_);
    return *this;
}

AnyComponent::~AnyComponent() {
    if (data_ != nullptr) {
        info_->ops.destroy(data_, 1);
        ::operator delete (data_, std::align_val_t{info_->align});
    }
}

}  // namespace limn
