#include "ecs/any_component.h"

#include "ecs/field_access.h"
#include "ecs/world.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <string>
#include <utility>

namespace limn {

namespace {

void* allocate(const ComponentInfo& info) {
    return ::operator new (std::max<std::size_t>(info.size, 1), std::align_val_t{info.align});
}

void deallocate(const ComponentInfo& info, void* data) {
    ::operator delete (data, std::align_val_t{info.align});
}

}  // namespace

AnyComponent::AnyComponent(const ComponentInfo& info) : info_(&info), data_(allocate(info)) {
    LIMN_CHECK_NOTE(info.ops.construct_default != nullptr, info.name.c_str());
    info.ops.construct_default(data_, 1);
}

AnyComponent::AnyComponent(const ComponentInfo& info, const void* value)
    : info_(&info), data_(allocate(info)) {
    LIMN_CHECK_NOTE(info.ops.construct_copy != nullptr, info.name.c_str());
    if (!info.is_tag) {  // `value` of a tag may not point to readable memory
        info.ops.construct_copy(data_, value, 1);
    }
}

AnyComponent AnyComponent::take(const ComponentInfo& info, void* value) {
    AnyComponent taken;
    taken.info_ = &info;
    taken.data_ = allocate(info);
    if (!info.is_tag) {
        info.ops.construct_move(taken.data_, value, 1);
    }
    return taken;
}

AnyComponent AnyComponent::read(const World& world, Entity entity, const ComponentInfo& info) {
    AnyComponent copy;
    void* const raw = allocate(info);
    if (world.read(entity, info.id, raw)) {
        copy.info_ = &info;
        copy.data_ = raw;
    } else {
        deallocate(info, raw);
    }
    return copy;
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
        deallocate(*info_, data_);
    }
}

void copy_field(const FieldInfo& field, void* to, const void* from) {
    const std::size_t count = element_count(field, from);
    if (field.shape == FieldShape::List) {
        field.list.resize(to, count);
    }
    for (std::size_t i = 0; i < count; ++i) {
        void* const target = element_ptr(field, to, i);
        const void* const source = element_ptr(field, from, i);
        if (field.type == FieldType::String) {
            *static_cast<std::string*>(target) = *static_cast<const std::string*>(source);
        } else if (field.type == FieldType::Struct) {
            for (const FieldInfo& inner : field.fields) {
                copy_field(inner, field_ptr(target, inner), field_ptr(source, inner));
            }
        } else {
            std::memcpy(target, source, field.size);
        }
    }
}

}  // namespace limn
