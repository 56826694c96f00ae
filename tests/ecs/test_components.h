#pragma once

#include "ecs/reflect.h"

#include <memory>
#include <string>
#include <vector>

// Components of every kind, for the tests of the core.

namespace limn::test {

struct Position {
    float x = 0, y = 0, z = 0;
};
struct Velocity {
    float x = 0, y = 0, z = 0;
};
struct Mass {
    double value = 1;
};
struct Marked {};  // a tag
struct Frozen {};  // another

/// Owns memory: must be moved and destroyed properly.
struct Label {
    std::string text;
    std::vector<int> numbers;
};

/// Cannot be copied.
struct Owner {
    std::unique_ptr<int> value;
};

struct alignas(128) Wide {
    float values[32] = {};
};

/// Sparse, plain.
struct Heat {
    int degrees = 0;
};
/// Sparse, owns memory.
struct Note {
    std::string text;
};
/// Sparse tag.
struct Selected {};

/// Names another entity.
struct Target {
    Entity entity;
};
template <typename Visitor>
void visit_fields(Target& target, Visitor&& visit) {
    visit("entity", target.entity);
}

/// Counts its living instances.
struct Counted {
    static inline int living = 0;
    int value = 0;
    Counted() { ++living; }
    explicit Counted(int v) : value(v) { ++living; }
    Counted(const Counted& other) : value(other.value) { ++living; }
    Counted(Counted&& other) noexcept : value(other.value) { ++living; }
    Counted& operator=(const Counted&) = default;
    ~Counted() { --living; }
};

/// The same, sparse.
struct SparseCounted {
    Counted counted;
};

}  // namespace limn::test

template <>
struct limn::ComponentTraits<limn::test::Heat> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<limn::test::Note> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<limn::test::Selected> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
template <>
struct limn::ComponentTraits<limn::test::SparseCounted> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};
