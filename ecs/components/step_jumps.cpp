#include "ecs/components/step_jumps.h"

#include <algorithm>
#include <functional>

namespace limn {

const TransformJump* find_jump(const StepJumps* jumps, Entity entity) {
    if (jumps == nullptr || jumps->transforms.empty()) {
        return nullptr;
    }
    const auto found =
        std::ranges::lower_bound(jumps->transforms, entity, std::less<>(), &TransformJump::entity);
    return found != jumps->transforms.end() && found->entity == entity ? &*found : nullptr;
}

}  // namespace limn
