#include "systems/animation/deformer_system.h"

#include <utility>

namespace limn {

void add_deformer_states(
    Query<const Deformers, Without<DeformerState>> bare, Query<const Deformed> deformed,
    Commands commands) {
    bare.each([&](Entity entity, const Deformers&) {
        commands.add(entity, DeformerState{});
        if (deformed.find<const Deformed>(entity) == nullptr) {
            Deformed by_itself;
            by_itself.character = entity;
            commands.add(entity, by_itself);
        }
    });
}

void update_deformers(Query<const Deformers, DeformerState> deformers) {
    deformers.each([](const Deformers& controls, DeformerState& state) {
        state.previous = std::move(state.now);
        state.now = pack_deformers(controls);
        if (state.previous.size() != state.now.size()) {
            state.previous = state.now;
        }
    });
}

}  // namespace limn
