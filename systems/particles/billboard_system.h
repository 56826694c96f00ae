#pragma once

namespace limn {

class World;

/// Advances the time of each Billboard by a step, and destroys, with their children, those whose
/// frames do not loop and have all been shown (engine.billboard).
void update_billboards(World& world);

}  // namespace limn
