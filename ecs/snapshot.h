#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

class World;

// The whole world as bytes, for save games, rollback and replay files, and as one number, to find
// out whether two runs are the same.
//
// Saved are all entities, with the handles they have and will be given; their components, in order;
// and the registered resources. ComponentTraits<T>::saved = false leaves a type out: what systems
// make anew (WaterState) or what lives elsewhere (objects on the GPU). Entities that differ only in
// such components are put side by side. Types are known by name and by the names and types of their
// fields, so a file outlives a change of ids, but not a change of a component.
//
// Layout: 8 bytes "LIMNSNAP", u32 version, u32 zero, u64 size of the rest, u64 XXH64 of the rest;
// then names, resources, slots, archetypes and sparse sets as snapshot.cpp writes them,
// little-endian.

/// Fails, naming the component, when one that should be saved is not registered or has no known
/// bytes.
[[nodiscard]] Result<std::vector<std::byte>> save_snapshot(const World& world);

/// Makes the entities and the saved resources of `world` those of the snapshot; other resources and
/// all observers stay. Everything that was there is removed first (on_remove), then what is new is
/// added (on_add). A snapshot that is cut off, altered, or of another version or other components
/// changes nothing: all is checked before. Never takes much more memory than the world it
/// describes.
[[nodiscard]] Status restore_snapshot(World& world, std::span<const std::byte> bytes);

/// 64 bits of everything that snapshots save and of components that are not saved but hashed
/// (ComponentTraits<T>::hashed). Two worlds with the same rows in the same order have the same
/// hash, in whatever order archetypes came into being, for any number of threads and in every
/// program. Of a type without known bytes (no visit_fields, but padding or a destructor) only
/// counts who has it.
[[nodiscard]] std::uint64_t state_hash(const World& world);

}  // namespace limn
