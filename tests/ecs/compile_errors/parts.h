#pragma once

#include "ecs/reflect.h"

// What the snippets of this folder go wrong with.

struct Position {
    float x = 0;
    float y = 0;
};
struct Velocity {
    float x = 0;
    float y = 0;
};
struct Burning {
    float heat = 0;
};
struct Hidden {};
struct FrameStep {
    float seconds = 0;
};

template <>
struct limn::ComponentTraits<Burning> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Sparse;
};

struct Drift {
    float x = 0;
    float y = 0;
};
template <>
struct limn::ComponentTraits<Drift> : limn::DefaultTraits {
    static constexpr Storage storage = Storage::Split;
};
