#pragma once

#include "render/instance_list.h"
#include "render/shadow/shadow_view.h"

#include <cstdint>
#include <span>

namespace limn {

class World;

// What casts shadows into a view: opaque and alpha-tested mesh instances without NoShadow that the
// view's pyramid and the light's reach touch. The camera does not count: what it does not see may
// well shade what it sees.

[[nodiscard]] CasterVolume make_caster_volume(const ShadowView& view);

/// A number for each volume that changes when a caster comes, goes, moves or changes its mesh,
/// shape, material or Inflate: equal numbers, equal map. The order of the casters does not count.
void sign_casters(
    const World& world, float alpha, const MeshPool& meshes, const MaterialPool& materials,
    const DeformedList& shapes, std::span<const CasterVolume> volumes,
    std::span<std::uint64_t> signatures);

}  // namespace limn
