#pragma once

#include "ecs/base/field_type.h"
#include "ecs/base/result.h"
#include "ecs/base/type_name.h"
#include "ecs/entity.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace limn {

// Run-time type information of a component (or resource): its name, how to move, copy and destroy
// it, and its fields with documentation, unit, range and default. Declared once, after the
// component:
//
//     struct Spin {
//         Vec3 axis = {0, 1, 0};
//         float speed = 1;
//     };
//     LIMN_FIELDS(Spin) {
//         LIMN_FIELD(axis, "axis of the rotation");
//         LIMN_FIELD(speed, "angular speed", "rad/s", -100, 100);
//     }
//
// and used by level files, their schema, the inspector, snapshots, hashes and prefabs. Fields may
// be numbers, bool, enums (name the enumerators in .values), vectors and matrices, std::string,
// Entity, asset ids, structs with their own fields, and C arrays, std::array and std::vector
// of these. A type without them has no fields, but is still moved, copied and destroyed.
//
// component_id<T> is a plain load: types get their ids before main. register_component<T>()
// also makes the type known by name; ids depend on the program, names do not, so files use names.
// Type-erased access to fields is in ecs/field_access.h.

/// Documentation of a field for people. Numbers outside min .. max are rejected in files.
struct FieldMeta {
    const char* doc = "";
    const char* unit = "";
    double min = -std::numeric_limits<double>::infinity();
    double max = std::numeric_limits<double>::infinity();
    const char* values = "";  ///< names of the enumerators 0, 1, 2 ..., separated by one space
    bool color = false;       ///< linear RGB or RGBA
    /// Old names that files may still use, separated by spaces: of the field, and of enumerators as
    /// "old=new". find_field() and find_enumerator() warn about each once.
    const char* renamed = "";
};

/// Begins the list of the fields of Type, which is a function template that calls visit(name,
/// field, meta) for each field: visit_fields(Type&, visitor).
#define LIMN_FIELDS(Type)                                                                          \
    template <typename Visitor>                                                                    \
    void visit_fields([[maybe_unused]] Type& self, [[maybe_unused]] Visitor&& visit)
/// A field of it with the members of its FieldMeta, in order or designated: doc, unit, min, max ...
#define LIMN_FIELD(member, ...) visit(#member, self.member, ::limn::FieldMeta{__VA_ARGS__})

/// Multiplicity of a field.
enum class FieldShape : std::uint8_t {
    One,
    Array,  ///< `count` elements in place
    List,   ///< std::vector
};

/// Type-erased operations of std::vector<T>.
struct ListOps {
    std::size_t (*size)(const void* list) = nullptr;
    void* (*data)(void* list) = nullptr;
    void (*resize)(void* list, std::size_t size) = nullptr;  ///< new elements are value-initialized
};

struct FieldInfo {
    const char* name = "";
    FieldMeta meta;
    FieldType type = FieldType::Float;
    FieldShape shape = FieldShape::One;
    std::uint32_t offset = 0;              ///< in the enclosing struct [bytes]
    std::uint32_t size = 0;                ///< of one element [bytes]
    std::uint32_t count = 1;               ///< elements of an Array
    const char* asset = "";                ///< kind of an Asset: "mesh"
    ListOps list;                          ///< for a List
    std::vector<std::string_view> values;  ///< enumerator names of an Enum, in order
    std::vector<FieldInfo> fields;         ///< of a Struct
};

/// Dense, from 0, in unspecified order; differs from program to program.
using ComponentId = std::uint32_t;
inline constexpr ComponentId kMaxComponents = 4096;

/// How a component is stored.
enum class Storage : std::uint8_t {
    Table,   ///< in a column of the entity's archetype: fast to iterate
    Split,   ///< in one column per 4-byte scalar: fastest for kernels over single fields
    Sparse,  ///< in a separate sparse set: fast to add and remove
    Toggle,  ///< in a column, with an enable bit per row
    Shared,  ///< once per archetype: entities with equal values form a batch
};

struct DefaultTraits {
    static constexpr Storage storage = Storage::Table;
    static constexpr bool saved = true;       ///< part of snapshots
    static constexpr bool hashed = true;      ///< part of the state hash
    static constexpr bool in_prefabs = true;  ///< copied into prefabs, if saved
    static constexpr bool trivially_relocatable =
        false;  ///< may be moved by memcpy although not trivially copyable
    static constexpr bool tracks_rows = false;  ///< records which rows are written, for TakeRows
};

/// To override a default, specialize next to the component:
///     template <>
///     struct limn::ComponentTraits<WaterState> : DefaultTraits {
///         static constexpr bool saved = false;
///     };
template <typename T>
struct ComponentTraits : DefaultTraits {};

/// The kind of asset that an id type T refers to; nullptr if T is not an asset id. A component
/// header specializes it:
///     template <> inline constexpr const char* asset_kind<MeshId> = "mesh";
template <typename T>
inline constexpr const char* asset_kind = nullptr;

/// How type-erased values are compared.
enum class ValueBytes : std::uint8_t {
    All,     ///< bytewise: no padding
    Fields,  ///< by fields
    Opaque,  ///< not at all: padding, pointers or destructors, and no LIMN_FIELDS
};

/// Operations on arrays of `count` values; `destination` and `source` do not overlap.
struct ComponentOps {
    void (*construct_default)(void* destination, std::size_t count) =
        nullptr;  ///< null: not default-constructible
    void (*construct_copy)(void* destination, const void* source, std::size_t count) =
        nullptr;  ///< null: move-only
    void (*construct_move)(void* destination, void* source, std::size_t count) =
        nullptr;  ///< sources stay alive
    void (*relocate)(void* destination, void* source, std::size_t count) =
        nullptr;  ///< moves and destroys the sources
    void (*destroy)(void* first, std::size_t count) = nullptr;
};

/// What the compiler knows of a component.
struct ComponentType {
    std::uint32_t size = 0;   ///< [bytes]; 0 for tags
    std::uint32_t align = 1;  ///< [bytes]
    Storage storage = Storage::Table;
    bool is_tag = false;  ///< empty: present or not, no data
    bool trivially_copyable = false;
    bool trivially_relocatable = false;
    bool trivially_destructible = false;
    bool saved = true;
    bool hashed = true;
    bool in_prefabs = true;
    bool tracks_rows = false;
    ComponentOps ops;
};

/// One type of component or resource. Lives at a stable address until the program ends.
struct ComponentInfo : ComponentType {
    ComponentId id = 0;
    std::string name;            ///< "point_light"
    bool is_registered = false;  ///< can be found by name
    bool is_resource = false;    ///< registered as a resource
    ValueBytes value_bytes = ValueBytes::Opaque;
    bool has_entities = false;  ///< some field, at any depth, is an Entity
    std::vector<FieldInfo> fields;
    const void* defaults =
        nullptr;  ///< a default-constructed instance; null for types without fields
};

/// Whether each entity has its own contiguous value that can be written through a pointer.
[[nodiscard]] inline bool has_address(const ComponentInfo& info) {
    return info.storage != Storage::Split && info.storage != Storage::Shared;
}

/// The type with this id, which must exist.
[[nodiscard]] const ComponentInfo& component_info(ComponentId id);

/// Number of assigned ids.
[[nodiscard]] std::uint32_t component_count();

/// Registered components, by name; nullptr if there is none.
[[nodiscard]] const ComponentInfo* find_component(std::string_view name);
[[nodiscard]] const ComponentInfo* find_resource(std::string_view name);

/// All registered types, sorted by name.
[[nodiscard]] std::vector<const ComponentInfo*> all_components();
[[nodiscard]] std::vector<const ComponentInfo*> all_resources();

/// "" or " (did you mean point_light?)", to end a message about an unknown component or resource.
[[nodiscard]] std::string component_suggestion(std::string_view name);
[[nodiscard]] std::string resource_suggestion(std::string_view name);

template <>
inline constexpr FieldType field_type_of<float> = FieldType::Float;
template <>
inline constexpr FieldType field_type_of<double> = FieldType::Double;
template <>
inline constexpr FieldType field_type_of<std::string> = FieldType::String;
template <>
inline constexpr FieldType field_type_of<Entity> = FieldType::Entity;

namespace detail {

// Every file that names a component compiles what is templated below. So that is kept small: tables
// that the compiler fills in, and calls of functions that are compiled once.

/// Takes the next id. `type_name` with namespaces; `describe` fills in what depends on values of
/// the type: value_bytes, defaults and fields.
ComponentId add_component(
    const ComponentType& type, std::string_view type_name, void (*describe)(ComponentInfo&));
/// Stops the program if another type has the same name.
void name_component(ComponentId id, bool is_resource);

[[nodiscard]] std::vector<std::string_view> split_words(const char* words);

/// What a FieldInfo says of the type of a field.
struct FieldClass {
    FieldType type = FieldType::Float;
    FieldShape shape = FieldShape::One;
    std::uint32_t size = 0;
    std::uint32_t count = 1;
    const char* asset = "";
    ListOps list = {};
    void (*describe)(std::vector<FieldInfo>& fields) = nullptr;  ///< of a Struct
};
void add_field(
    std::vector<FieldInfo>& fields, const char* name, std::size_t offset, const FieldMeta& meta,
    const FieldClass& type);

struct AnyVisitor {
    template <typename F>
    void operator()(const char*, F&, const FieldMeta& = {}) const {}
};

template <typename T>
concept HasFields = requires(T& value, AnyVisitor visitor) {
    visit_fields(value, visitor);
};

template <typename... Ts>
inline constexpr bool all_different = true;
template <typename T, typename... Rest>
inline constexpr bool all_different<T, Rest...> = (!std::is_same_v<T, Rest> && ...)
                                                  && all_different<Rest...>;

template <typename T>
inline constexpr bool is_list = false;
template <typename T, typename Allocator>
inline constexpr bool is_list<std::vector<T, Allocator>> = true;
template <typename T>
inline constexpr bool is_std_array = false;
template <typename T, std::size_t N>
inline constexpr bool is_std_array<std::array<T, N>> = true;

template <typename T>
void describe_struct(std::vector<FieldInfo>& fields);

/// Of F, which is not an array or list.
template <typename F>
constexpr FieldClass element_class() {
    FieldClass type = {.size = sizeof(F)};
    if constexpr (std::is_same_v<F, bool>) {
        type.type = FieldType::Bool;
    } else if constexpr (std::is_enum_v<F>) {
        type.type = FieldType::Enum;
    } else if constexpr (std::is_integral_v<F>) {
        type.type = std::is_signed_v<F> ? FieldType::Int : FieldType::UInt;
    } else if constexpr (field_type_of<F> != FieldType::Struct) {
        type.type = field_type_of<F>;
    } else if constexpr (asset_kind<F> != nullptr) {
        static_assert(sizeof(F) == sizeof(std::uint32_t));
        type.type = FieldType::Asset;
        type.asset = asset_kind<F>;
    } else {
        static_assert(HasFields<F>, "a field of this type needs LIMN_FIELDS");
        type.type = FieldType::Struct;
        type.describe = describe_struct<F>;
    }
    return type;
}

template <typename T>
constexpr ListOps list_ops() {
    static_assert(
        !std::is_same_v<typename T::value_type, bool>,
        "std::vector<bool> does not store bools; use std::uint8_t");
    return {
        .size = [](const void* list) { return static_cast<const T*>(list)->size(); },
        .data = [](void* list) { return static_cast<void*>(static_cast<T*>(list)->data()); },
        .resize = [](void* list, std::size_t size) { static_cast<T*>(list)->resize(size); }};
}

template <typename F>
constexpr FieldClass field_class() {
    FieldClass type;
    if constexpr (is_list<F>) {
        type = element_class<typename F::value_type>();
        type.shape = FieldShape::List;
        type.list = list_ops<F>();
    } else if constexpr (std::is_array_v<F>) {
        static_assert(std::rank_v<F> == 1);
        type = element_class<std::remove_extent_t<F>>();
        type.shape = FieldShape::Array;
        type.count = std::extent_v<F>;
    } else if constexpr (is_std_array<F>) {
        type = element_class<typename F::value_type>();
        type.shape = FieldShape::Array;
        type.count = std::tuple_size_v<F>;
    } else {
        type = element_class<F>();
    }
    return type;
}
template <typename F>
inline constexpr FieldClass kFieldClass = field_class<F>();

struct DescribeVisitor {
    const void* base;
    std::vector<FieldInfo>& fields;

    template <typename F>
    void operator()(const char* name, F& field, const FieldMeta& meta = {}) const {
        const auto offset = reinterpret_cast<const char*>(&field) - static_cast<const char*>(base);
        add_field(fields, name, static_cast<std::size_t>(offset), meta, kFieldClass<F>);
    }
};

template <typename T>
void describe_struct(std::vector<FieldInfo>& fields) {
    T instance{};
    visit_fields(instance, DescribeVisitor{&instance, fields});
}

#if defined(__clang__)
/// Not a constant expression if T has padding, which the compiler refuses to read.
template <typename T>
consteval bool reads_all_bytes() {
    unsigned sum = 0;
    for (const unsigned char byte : std::bit_cast<std::array<unsigned char, sizeof(T)>>(T{})) {
        sum += byte;
    }
    return sum < 0xffffffffu;
}
template <typename T>
concept ReadsAllBytes = requires {
    typename std::bool_constant<reads_all_bytes<T>()>;
};
#endif

/// Whether every byte of a trivially copyable T is part of its value.
template <typename T>
bool has_no_padding() {
#if defined(__clang__)
    return ReadsAllBytes<T>;
#else
    alignas(T) unsigned char bytes[sizeof(T)];
    std::memset(bytes, 0xff, sizeof(T));
    __builtin_clear_padding(reinterpret_cast<T*>(bytes));
    for (const unsigned char byte : bytes) {
        if (byte != 0xff) {
            return false;
        }
    }
    return true;
#endif
}

template <typename T>
ValueBytes value_bytes_of() {
    if constexpr (std::is_empty_v<T>) {
        return ValueBytes::All;
    } else {
        if constexpr (std::is_trivially_copyable_v<T>) {
            if (has_no_padding<T>()) {
                return ValueBytes::All;
            }
        }
        return HasFields<T> ? ValueBytes::Fields : ValueBytes::Opaque;
    }
}

template <std::size_t size>
void copy_bytes(void* destination, const void* source, std::size_t count) {
    if (count > 0) {
        std::memcpy(destination, source, size * count);
    }
}
template <std::size_t size>
void move_bytes(void* destination, void* source, std::size_t count) {
    copy_bytes<size>(destination, source, count);
}

template <typename T>
constexpr ComponentOps component_ops() {
    ComponentOps ops;
    if constexpr (std::is_default_constructible_v<T>) {
        ops.construct_default = [](void* destination, std::size_t count) {
            std::uninitialized_value_construct_n(static_cast<T*>(destination), count);
        };
    }
    if constexpr (std::is_trivially_copyable_v<T>) {
        constexpr std::size_t kBytes = std::is_empty_v<T> ? 0 : sizeof(T);
        if constexpr (std::is_copy_constructible_v<T>) {
            ops.construct_copy = copy_bytes<kBytes>;
        }
        ops.construct_move = move_bytes<kBytes>;
        ops.relocate = move_bytes<kBytes>;
        ops.destroy = [](void*, std::size_t) {};
    } else {
        if constexpr (std::is_copy_constructible_v<T>) {
            ops.construct_copy = [](void* destination, const void* source, std::size_t count) {
                std::uninitialized_copy_n(
                    static_cast<const T*>(source), count, static_cast<T*>(destination));
            };
        }
        ops.construct_move = [](void* destination, void* source, std::size_t count) {
            std::uninitialized_move_n(static_cast<T*>(source), count, static_cast<T*>(destination));
        };
        ops.relocate = [](void* destination, void* source, std::size_t count) {
            std::uninitialized_move_n(static_cast<T*>(source), count, static_cast<T*>(destination));
            std::destroy_n(static_cast<T*>(source), count);
        };
        ops.destroy = [](void* first, std::size_t count) {
            std::destroy_n(static_cast<T*>(first), count);
        };
    }
    return ops;
}

/// Maximum size of a shared component. [bytes]
inline constexpr std::size_t kMaxSharedBytes = 256;
/// Maximum number of scalars of a split component.
inline constexpr std::size_t kMaxLanes = 64;

template <typename T>
inline constexpr bool can_be_split =
    !std::is_empty_v<T> && std::is_trivially_copyable_v<T> && alignof(T) == 4
    && sizeof(T) <= 4 * kMaxLanes;

struct SplitFieldVisitor {
    template <typename F>
    void operator()(const char*, F&, const FieldMeta& = {}) const {
        static_assert(
            alignof(F) == 4,
            "Storage::Split: every field must consist of 4-byte scalars (float, int, Vec3, Quat "
            "...); no bool, no double");
    }
};

template <typename T>
void check_storage() {
    if constexpr (ComponentTraits<T>::storage == Storage::Split) {
        static_assert(
            can_be_split<T>,
            "Storage::Split: the component must be trivially copyable and made of 4-byte scalars "
            "(float, int, Vec3, Quat ...), 1 to 64 of them");
        if constexpr (HasFields<T>) {
            T instance{};
            visit_fields(instance, SplitFieldVisitor{});
        }
    }
    if constexpr (ComponentTraits<T>::storage == Storage::Shared) {
        static_assert(
            !std::is_empty_v<
                T> && std::is_trivially_copyable_v<T> && alignof(T) <= alignof(std::max_align_t)
                && sizeof(T) <= kMaxSharedBytes,
            "Storage::Shared: the component must be trivially copyable, not empty, and at most 256 "
            "bytes; refer to larger data by an id");
        LIMN_CHECK_NOTE(
            has_no_padding<T>(),
            "Storage::Shared: values are compared bytewise, so there must be no padding");
    }
}

template <typename T>
constexpr ComponentType make_component_type() {
    using Traits = ComponentTraits<T>;
    static_assert(
        std::is_nothrow_move_constructible_v<T> && std::is_nothrow_destructible_v<T>,
        "a component is moved and destroyed without exceptions: give it a noexcept move "
        "constructor");
    static_assert(
        !Traits::tracks_rows
            || (!std::is_empty_v<T> && Traits::storage != Storage::Sparse
                && Traits::storage != Storage::Shared),
        "tracks_rows needs a component with a column of its own: not a tag, not Sparse, not "
        "Shared");
    return {
        .size = std::is_empty_v<T> ? 0 : sizeof(T),
        .align = alignof(T),
        .storage = Traits::storage,
        .is_tag = std::is_empty_v<T>,
        .trivially_copyable = std::is_trivially_copyable_v<T>,
        .trivially_relocatable = std::is_trivially_copyable_v<T> || Traits::trivially_relocatable,
        .trivially_destructible = std::is_trivially_destructible_v<T>,
        .saved = Traits::saved,
        .hashed = Traits::hashed,
        .in_prefabs = Traits::in_prefabs,
        .tracks_rows = Traits::tracks_rows,
        .ops = component_ops<T>()};
}
template <typename T>
inline constexpr ComponentType kComponentType = make_component_type<T>();

template <typename T>
void describe_component(ComponentInfo& info) {
    check_storage<T>();
    info.value_bytes = value_bytes_of<T>();
    if constexpr (HasFields<T>) {
        static_assert(
            std::is_default_constructible_v<T>,
            "a component with LIMN_FIELDS must be default-constructible");
        T* defaults = new T{};  // lives as long as the program
        info.defaults = defaults;
        visit_fields(*defaults, DescribeVisitor{defaults, info.fields});
    }
}

}  // namespace detail

/// The id of T, assigned before main.
template <typename T>
inline const ComponentId component_id =
    detail::add_component(detail::kComponentType<T>, type_name<T>(), detail::describe_component<T>);

template <typename T>
[[nodiscard]] const ComponentInfo& component_info() {
    return component_info(component_id<std::remove_cvref_t<T>>);
}

/// Makes T known by name: in level files, snapshots, the inspector. May be called again; stops if
/// two types have the same name.
template <typename T>
const ComponentInfo& register_component() {
    detail::name_component(component_id<T>, false);
    return component_info<T>();
}

/// The same for a resource: it is part of snapshots and hashes unless its ComponentTraits disable
/// that.
template <typename T>
const ComponentInfo& register_resource() {
    detail::name_component(component_id<T>, true);
    return component_info<T>();
}

}  // namespace limn
