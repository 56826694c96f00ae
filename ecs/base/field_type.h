#pragma once

#include <cstdint>

namespace limn {

// The field types that reflection (ecs/reflect.h) supports. The library has no vector types of its
// own; to use yours, specialize next to the type
//
//     template <> inline constexpr FieldType field_type_of<Vec3> = FieldType::Vec3;
//
// It must have the layout documented at the enumerator. The engine's are in ecs/base/math.h.

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"  // gcc 12 warns that scoped enumerators shadow types
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
    Mat3,    ///< 9 floats, column-major
    Mat4,    ///< 16 floats, column-major
    Affine,  ///< 12 floats, rows of the upper 3x4 matrix
    String,  ///< std::string
    Enum,    ///< unsigned integer of `size` bytes, below values.size()
    Entity,
    Asset,   ///< std::uint32_t index; FieldInfo::asset names the kind
    Struct,  ///< its members are in FieldInfo::fields
};
#pragma GCC diagnostic pop

/// The FieldType that T alone determines; Struct if it does not.
template <typename T>
inline constexpr FieldType field_type_of = FieldType::Struct;

}  // namespace limn
