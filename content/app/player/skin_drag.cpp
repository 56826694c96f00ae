#include "content/app/player/skin_drag.h"

#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/skin_pull.h"
#include "ecs/world.h"

// Techniques: face.pull

namespace limn {

bool is_pullable(const World& world, const Ray& ray) {
    if (world.query<const PullableSkin>().empty()) {
        return false;
    }
    const std::optional<Hit> hit = pick_entity(world, ray);
    if (!hit || world.find<PullableSkin>(hit->entity) != nullptr) {
        return hit.has_value();
    }
    const auto* const deformed = world.find<Deformed>(hit->entity);
    bool follows = false;
    world.query<const PullableSkin, const Deformed>().each(
        [&](const PullableSkin&, const Deformed& skin) {
            follows = follows || (deformed != nullptr && deformed->character == skin.character);
        });
    return follows && world.find<Deformers>(hit->entity) != nullptr;
}

void SkinDrag::follow(const World& world, const Ray& ray, bool left, bool blocked) {
    const bool begins = left_.begins(left);
    pulls_ = left && (begins ? !blocked && is_pullable(world, ray) : pulls_);
}

}  // namespace limn
