#pragma once

#include <cstdint>

namespace limn {

// What a field of a component can be, as reflection (ecs/reflect.h) knows it. The library has no
// vectors of its own: whoever has tells it, beside the type,
//
//     template <> inline constexpr FieldType field_type_of<Vec3> = FieldType::Vec3;
//
// and promises the layout that the enumerator describes. The engine's are in ecs/base/math.h.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // gcc 12 takes scoped enumerators for rivals of types
enum class FieldType : std::uint8_t {
    Bool,
    Int,   ///< signed, `size` bytes
    UInt,  ///< unsigned, `size` bytes
    Float,
    Double,
    Vec2,  ///< 2 floats: x y
    Vec3,
    Vec4,
    Quat,   ///< 4 floats: x y z w
    IVec2,  ///< 2 std::int32_t
    IVec3,
    Mat3,    ///< 9 floats, column by column
    Mat4,    ///< 16 floats, column by column
    Affine,  ///< 12 floats, rows of the upper 3x4 matrix
    String,  ///< std::string
    Enum,    ///< unsigned integer of `size` bytes, below values.size()
    Entity,
    Asset,   ///< std::uint32_t index; `asset` says of what
    Struct,  ///< `fields`
};
#pragma GCC diagnostic pop

/// What T is where its type alone says it; Struct: look closer.
template <typename T>
inline constexpr FieldType field_type_of = FieldType::Struct;

}  // namespace limn
