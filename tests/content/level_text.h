#pragma once

#include "content/load/level/level_load.h"
#include "ecs/components/all.h"
#include "ecs/components/name.h"
#include "ecs/world.h"

#include <doctest/doctest.h>

#include <string_view>
#include <utility>

namespace limn::test {

// Levels of a test's text, and what is in them.

inline Level parse(std::string_view text) {
    register_all_components();
    Result<Level> level = parse_level(text, "t.level.json");
    REQUIRE_MESSAGE(level.ok(), (level.ok() ? "" : level.error().message));
    return *std::move(level);
}

/// The level in a world, its assets made.
inline void spawn_into(World& world, std::string_view text) {
    Level level = parse(text);
    const Status status = load_level_assets(level, "");
    REQUIRE_MESSAGE(status.ok(), (status.ok() ? "" : status.error().message));
    (void)spawn_level(world, std::move(level));
}

inline Entity find_named(const World& world, std::string_view name) {
    Entity found;
    world.query<const Name>().each([&](Entity entity, const Name& candidate) {
        found = candidate.text == name ? entity : found;
    });
    REQUIRE_MESSAGE(!found.is_null(), name);
    return found;
}

template <typename T>
const T& named(const World& world, std::string_view name) {
    return world.get<T>(find_named(world, name));
}

}  // namespace limn::test
