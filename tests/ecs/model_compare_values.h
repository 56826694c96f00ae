#pragma once

#include "ecs/world.h"
#include "tests/ecs/model_components.h"
#include "tests/ecs/model_reference.h"

#include <doctest/doctest.h>

#include <string>

// What all comparisons with the reference need: a check, and whether a value is the one expected.

namespace limn::test::model {

/// A check that costs nothing while it holds: there are a hundred million of them.
inline void expect(bool holds, const char* what, int line = __builtin_LINE()) {
    if (!holds) {
        const std::string message = std::string(what) + ", line " + std::to_string(line);
        FAIL(message);
    }
}

class ComparedValues {
  public:
    ComparedValues(World& world, Reference& reference) : world_(world), reference_(reference) {}

  protected:
    template <typename T>
    void expect_value(const T& found, const Record& record) {
        const Value& expected = record.value(kind_of<T>());
        expect(read(found) == expected.number, "a component has another value");
        if constexpr ((bit(kind_of<T>()) & kLinks) != 0) {
            expect_entity(entity_in(found), expected.entity);
        }
    }

    void expect_entity(Entity found, Id expected) {
        if (expected != kNoId && !reference_.is_bound(expected)) {
            // Created and destroyed at one sync point: it had a handle that nobody was told.
            expect(!found.is_null() && !world_.alive(found), "a handle is of nobody ever");
            static_cast<void>(reference_.bind(expected, found));
        }
        expect(found == reference_.handle(expected), "a component names another entity");
    }

    World& world_;
    Reference& reference_;
};

}  // namespace limn::test::model
