#pragma once

#include "ecs/world_stats.h"

namespace limn {

struct HudStyle;
class Schedule;
class World;

// What the ECS is made of at this moment, a tab of the inspector: archetypes with how full their
// chunks are and where their components live, sparse sets, systems with the queries they run,
// queries asked elsewhere, and what sync points have done.

class StoragePanel {
  public:
    /// Into the current window. Figures are taken anew a few times a second.
    void draw(const HudStyle& style, const World& world, const Schedule& schedule);
    /// Another world: figures are taken at once.
    void reset() { taken_at_ = -1.0; }

  private:
    void draw_summary(const HudStyle& style) const;
    void draw_archetypes(const HudStyle& style) const;
    void draw_sparse_sets(const HudStyle& style) const;
    void draw_systems(const HudStyle& style) const;
    void draw_queries(const HudStyle& style) const;
    void draw_flushes(const HudStyle& style) const;

    WorldStats world_;
    ScheduleStats schedule_;
    double taken_at_ = -1.0;  // [s]
};

}  // namespace limn
