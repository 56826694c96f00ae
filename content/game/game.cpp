#include "content/game/game.h"

#include "content/game/racer_system.h"
#include "content/game/sailing_system.h"
#include "content/game/stone_system.h"
#include "content/game/walker_system.h"
#include "content/game/wrinkle_trial_system.h"
#include "ecs/components/all.h"

namespace limn {

namespace {

bool has_driver(const World& world, Entity) {
    bool found = false;
    world.query<const Racer>().each([&](const Racer& racer) { found = found || racer.player; });
    return found;
}

bool has_sailor(const World& world, Entity camera) {
    bool found = false;
    world.query<const Sailboat>().each([&](const Sailboat& boat) {
        found = found || (boat.player && (boat.camera == Entity{} || boat.camera == camera));
    });
    return found;
}

bool has_walker(const World& world, Entity camera) {
    bool found = false;
    world.query<const Walker>().each([&](const Walker& walker) {
        found = found || walker.camera == Entity{} || walker.camera == camera;
    });
    return found;
}

void register_game_actions() {
    register_actions(
        {.title = "Drive",
         .actions =
             {{"accelerate", "accelerate, brake", {"W", "Up"}},
              {"brake", "accelerate, brake", {"S", "Down"}},
              {"steer_left", "steer", {"A", "Left"}},
              {"steer_right", "steer", {"D", "Right"}},
              {"boost", "boost", {"Shift"}}},
         .is_used = has_driver,
         .drives = true});
    register_actions(
        {.title = "Sail",
         .actions =
             {{"rudder_port", "rudder", {"A", "Left"}},
              {"rudder_starboard", "rudder", {"D", "Right"}},
              {"sheet_in", "sheet in, out", {"W", "Up"}},
              {"sheet_out", "sheet in, out", {"S", "Down"}},
              {"auto_trim", "trims itself", {"Shift"}}},
         .is_used = has_sailor,
         .drives = true,
         .turns = true});
    register_actions(
        {.title = "Walk",
         .actions =
             {{"walk_forward", "forward, back", {"W", "Up"}},
              {"walk_back", "forward, back", {"S", "Down"}},
              {"walk_left", "left, right; drag to look", {"A", "Left"}},
              {"walk_right", "left, right; drag to look", {"D", "Right"}},
              {"dive", "dive, rise", {"Q"}},
              {"rise", "dive, rise", {"E"}},
              {"run", "faster", {"Shift"}}},
         .is_used = has_walker,
         .drives = true,
         .turns = true});
}

}  // namespace

void register_game_components() {
    register_all_components();
    register_component<Racer>();
    register_component<RacerState>();
    register_component<SpeedView>();
    register_component<Sailboat>();
    register_component<SailboatState>();
    register_component<Boom>();
    register_component<Walker>();
    register_component<WalkerState>();
    register_component<Footing>();
    register_component<StoneThrower>();
    register_component<StoneThrowerState>();
    register_component<ThrownStone>();
    register_component<WrinkleTrial>();
    register_component<WrinkleTrialState>();
    register_game_actions();
}

void add_game_systems(SystemList& systems) {
    using enum Phase;
    using enum When;
    systems.add<add_racer_states>(Create, Both);
    systems.add<add_sailboat_states>(Create, Both);
    systems.add<add_walker_states>(Create, Both);
    systems.add<add_stone_throwers>(Create, Both);
    systems.add<add_wrinkle_trials>(Create, Both);
    systems.add<place_racers>(Move, AtStart);
    systems.add<update_racers>(Move);
    systems.add<update_speed_views>(Move);  // after racers: uses their current speed
    systems.add<update_wrinkle_trials>(Move, Both);
    systems.add<throw_stones>(Force);  // hits the current surface of the water
    systems.add<update_sailboats>(Force);
    systems.add<turn_booms>(Float);  // after floating bodies
    systems.add<update_walkers>(Float);
}

}  // namespace limn
