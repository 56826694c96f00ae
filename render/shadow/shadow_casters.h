#pragma once

#include "render/geometry/instance_list.h"
#include "render/shadow/shadow_view.h"

#include <cstdint>
#include <span>

namespace limn {

// The shadow casters of a view: opaque and alpha-tested mesh instances without NoShadow that touch
// the view's frustum and the light's range. Not culled by the camera: objects off screen may cast
// visible shadows.

[[nodiscard]] CasterVolume make_caster_volume(const ShadowView& view);

/// A hash for each volume that changes when a caster appears, disappears, moves or changes its
/// mesh, shape, material or Inflate: equal hashes, equal shadow map. The order of the casters does
/// not matter.
void hash_casters(
    RenderItems& items, std::span<const CasterVolume> volumes, std::span<std::uint64_t> signatures);

}  // namespace limn
