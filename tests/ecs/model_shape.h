#pragma once

#include "ecs/query.h"
#include "tests/ecs/model_components.h"
#include "tests/ecs/model_reference.h"

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

// What a query asks of an entity, told by the terms of the query and judged by the reference.

namespace limn::test::model {

struct Shape {
    Mask required = 0;
    Mask excluded = 0;
    std::vector<Mask> any_of;     ///< at least one of each
    std::int64_t team = kNoTeam;  ///< that where() asks for, if it does

    [[nodiscard]] bool matches(const Record& record) const {
        return record.matches(required, excluded) && (team == kNoTeam || record.team() == team)
               && std::all_of(any_of.begin(), any_of.end(), [&](Mask group) {
                      return (record.mask & group) != 0;
                  });
    }
};

template <typename Term>
struct ShapeOf {
    static void add(Shape& shape) { shape.required |= bit(kind_of<std::remove_const_t<Term>>()); }
};
template <typename T>
struct ShapeOf<Optional<T>> {
    static void add(Shape&) {}
};
template <typename... Ts>
struct ShapeOf<With<Ts...>> {
    static void add(Shape& shape) { shape.required |= (Mask{0} | ... | bit(kind_of<Ts>())); }
};
template <typename... Ts>
struct ShapeOf<Changed<Ts...>> : ShapeOf<With<Ts...>> {};
template <typename... Ts>
struct ShapeOf<Without<Ts...>> {
    static void add(Shape& shape) { shape.excluded |= (Mask{0} | ... | bit(kind_of<Ts>())); }
};
template <typename... Ts>
struct ShapeOf<AnyOf<Ts...>> {
    static void add(Shape& shape) { shape.any_of.push_back((Mask{0} | ... | bit(kind_of<Ts>()))); }
};

/// Of query<Terms...>(), or of query<Terms...>().where(that team).
template <typename... Terms>
[[nodiscard]] Shape shape_of(std::int64_t team = kNoTeam) {
    Shape shape;
    (ShapeOf<Terms>::add(shape), ...);
    shape.team = team;
    return shape;
}

}  // namespace limn::test::model
