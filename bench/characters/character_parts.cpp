#include "bench/characters/character_rows.h"

namespace limn::bench {

void add_clip_rows(CharacterBench& bench);
void add_chain_rows(CharacterBench& bench);
void add_vertex_rows(CharacterBench& bench);
void add_ik_rows(CharacterBench& bench);
void add_avoid_rows(CharacterBench& bench);
void add_match_rows(CharacterBench& bench);
void add_memory_rows(CharacterBench& bench);
void add_ragdoll_rows(CharacterBench& bench);
void add_world_rows(CharacterBench& bench);
void add_graph_rows(CharacterBench& bench);
void add_people_rows(CharacterBench& bench);
void add_level_rows(CharacterBench& bench);

std::span<const CharacterPart> character_parts() {
    static constexpr CharacterPart kParts[] = {
        {"clips", add_clip_rows},       // 1 .. 5: sampling, blending, joint matrices
        {"chain", add_chain_rows},      // 6 .. 8: all of it in one pass
        {"vertices", add_vertex_rows},  // 9
        {"ik", add_ik_rows},            // 10 .. 12
        {"match", add_match_rows},      // 13: motion matching
        {"avoid", add_avoid_rows},      // 14 .. 18: crowds
        {"memory", add_memory_rows},    // 20, 21
        {"world", add_world_rows},      // update_poses
        {"levels", add_level_rows},     // of detail of the skeleton
        {"graph", add_graph_rows},      // motion graphs
        {"ragdoll", add_ragdoll_rows}, {"people", add_people_rows},  // 19, 22: whole steps
    };
    return kParts;
}

}  // namespace limn::bench
