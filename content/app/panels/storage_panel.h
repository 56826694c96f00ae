#pragma once

#include "ecs/world_stats.h"

namespace limn {

struct HudStyle;
class Schedule;
class World;

// The inspector's tab of ECS storage: archetypes with the fill of their chunks and the storage of
// their components, sparse sets, systems with their queries, other queries, and sync point
// statistics.

class StoragePanel {
  public:
    /// Draws into the current window. Refreshes its figures a few times per second.
    void draw(const HudStyle& style, const World& world, const Schedule& schedule);
    /// For a new world: refreshes the figures at the next draw.
    void reset() { refreshed_at_ = -1.0; }

  private:
    void draw_summary(const HudStyle& style) const;
    void draw_archetypes(const HudStyle& style) const;
    void draw_sparse_sets(const HudStyle& style) const;
    void draw_systems(const HudStyle& style) const;
    void draw_queries(const HudStyle& style) const;
    void draw_flushes(const HudStyle& style) const;

    WorldStats world_;
    ScheduleStats schedule_;
    double refreshed_at_ = -1.0;  // [s]
};

}  // namespace limn
