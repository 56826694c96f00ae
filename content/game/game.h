#pragma once

#include "systems/update_world.h"

namespace limn {

// The rules of single levels: racers, sailboats, walkers, stones. The engine knows none of them.

/// Registers components and actions of the game, and those of the engine.
void register_game_components();

/// For make_world_schedule and start_world.
void add_game_systems(SystemList& systems);

}  // namespace limn
