#include "systems/animation/deformer_system.h"

#include <utility>
#include <vector>

namespace limn {

namespace {

struct CharacterTug {
    Entity character;
    Tug tug;
};

}  // namespace

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

void update_deformers(
    Query<const Deformers, DeformerState> deformers, Query<const Deformed> deformed,
    Query<const SkinPulls, const Deformed> pulled, Query<const PoseCut> cuts) {
    std::vector<CharacterTug> all;
    pulled.each([&](const SkinPulls& skin, const Deformed& deformed_skin) {
        for (const SkinPull& pull : skin.pulls) {
            all.push_back({deformed_skin.character, pull.tug});
        }
    });
    std::vector<Tug> tugs;
    deformers.each([&](Entity entity, const Deformers& controls, DeformerState& state) {
        tugs.clear();
        const Deformed* const deformed_skin =
            all.empty() ? nullptr : deformed.find<const Deformed>(entity);
        for (const CharacterTug& one : all) {
            if (deformed_skin != nullptr && deformed_skin->character == one.character) {
                tugs.push_back(one.tug);
            }
        }
        state.previous = std::move(state.now);
        state.now = pack_deformers(controls, tugs);
        if (state.previous.size() != state.now.size()
            || cuts.find<const PoseCut>(entity) != nullptr) {
            state.previous = state.now;
        }
    });
}

}  // namespace limn
