#include "systems/particles/billboard_system.h"

#include "ecs/components/billboard.h"
#include "ecs/components/time.h"
#include "ecs/hierarchy.h"
#include "ecs/world.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

// Techniques: engine.billboard

namespace limn {

void update_billboards(World& world) {
    const auto* const time = std::as_const(world).find_resource<FrameTime>();
    const double step = time != nullptr ? static_cast<double>(time->step) : 0;
    std::vector<Entity> ended;
    world.query<Billboard, const ParticleLook>().each(
        [&](Entity entity, Billboard& billboard, const ParticleLook& look) {
            billboard.time += step;
            const std::uint32_t frames = std::max(look.columns, 1u) * std::max(look.rows, 1u);
            const std::optional<double> life = billboard_life(billboard, look.frame_rate, frames);
            if (life && billboard.time >= *life - 0.5 * step) {
                ended.push_back(entity);
            }
        });
    for (const Entity entity : ended) {
        if (world.alive(entity)) {  // not a descendant of another one
            destroy_tree(world, entity);
        }
    }
}

}  // namespace limn
