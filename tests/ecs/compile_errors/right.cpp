// compiles
#include "ecs/schedule.h"
#include "ecs/world.h"
#include "tests/ecs/compile_errors/parts.h"

void blow(
    limn::Query<const Velocity, Position, limn::Optional<Burning>, limn::Without<Hidden>> all,
    limn::Res<FrameStep> step, limn::Commands commands) {
    all.each([&](limn::Entity entity, const Velocity& velocity, Position& position, Burning* fire) {
        position.x += velocity.x * step->seconds;
        if (fire != nullptr) {
            commands.remove<Burning>(entity);
        }
    });
}

void use(limn::World& world, limn::Schedule& schedule) {
    world.on_add<Position>([](limn::World&, std::span<const limn::Entity>) {});
    world.get<Position>(world.create(Position{}, Velocity{}, Hidden{})).x = 1;
    schedule.add<blow>();
    schedule.add("alone", [](limn::World&) {});
    std::as_const(world).query<const Position, limn::Changed<Position>>().chunks(
        [](limn::ChunkView, std::span<const Position>) {});
}
