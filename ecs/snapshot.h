#pragma once

#include "ecs/base/result.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace limn {

class World;
struct SnapshotIndex;

// Serializes the whole world, for save games, rollback and replay files; computes deltas between
// two snapshots; and hashes the world, to check whether two runs are identical.
//
//     SnapshotMark mark;
//     std::vector<std::byte> saved = save_snapshot(world, &mark).value();
//     schedule.run(world);
//     const std::vector<std::byte> delta = save_delta(world, mark, &mark).value();  // small
//     saved = apply_delta(saved, delta).value();  // what save_snapshot would have written
//
// A snapshot has all entities, with current handles and the state of handle allocation; their
// components, in order; and the registered resources. ComponentTraits<T>::saved = false excludes a
// type: data that systems recreate (WaterState) or that lives elsewhere (GPU objects). Entities
// that differ only in such components are grouped together. Types are identified by name and by the
// names and types of their fields, so a file survives a change of ids, but not of a component.
//
// A column without padding is copied as a whole, both ways. The file is divided into pieces of 1024
// rows of a column, each with a checksum; a delta contains the changed pieces and the offsets of
// the others. ecs/snapshot_format.h has the layout.

/// A point in time of a world, as the base of save_delta. Made by save_snapshot, save_delta and
/// restore_snapshot; cheap to copy. Must not outlive the world.
struct SnapshotMark {
    std::shared_ptr<const SnapshotIndex> index;  ///< null: empty mark
};

/// Fails, naming the component, if one that should be saved is not registered or cannot be
/// serialized. Sets `mark` to this snapshot.
[[nodiscard]] Result<std::vector<std::byte>>
save_snapshot(const World& world, SnapshotMark* mark = nullptr);

/// Replaces the entities and the saved resources of `world` by those of the snapshot; other
/// resources and all observers stay. First everything is removed (on_remove), then the snapshot's
/// entities are added (on_add). A snapshot that is truncated, corrupt, or of a different version or
/// different components is rejected before anything changes. Memory use is bounded by about the
/// size of the world it describes. Sets `mark` to the snapshot, before on_add observers change the
/// world.
[[nodiscard]] Status
restore_snapshot(World& world, std::span<const std::byte> bytes, SnapshotMark* mark = nullptr);

/// What changed in this world since `base`, in chunks of 1024 rows. Time and size are proportional
/// to the changes, plus some 16 bytes of work per chunk and the slots of all entities if any was
/// added, removed or moved. Changes are detected by version, like Changed<T>: a write through a
/// reference obtained before `base` is missed. Everything counts as changed if the world was
/// restored after `base`, or after 2^28 runs of systems. Fails like save_snapshot.
[[nodiscard]] Result<std::vector<std::byte>>
save_delta(const World& world, const SnapshotMark& base, SnapshotMark* mark = nullptr);

/// The snapshot that save_snapshot would have written when save_delta was called, byte for byte.
/// Needs no component types. Fails if `delta` is corrupt or belongs to a different snapshot than
/// `base`. Never allocates more memory than base and delta together.
[[nodiscard]] Result<std::vector<std::byte>>
apply_delta(std::span<const std::byte> base, std::span<const std::byte> delta);

/// 64-bit hash of everything that snapshots save and of components that are not saved but hashed
/// (ComponentTraits<T>::hashed). Two worlds with the same rows in the same order have the same
/// hash, whatever the creation order of archetypes, the number of threads and the program. For
/// types that cannot be serialized (no LIMN_FIELDS, but padding or a destructor) only their
/// presence counts.
[[nodiscard]] std::uint64_t state_hash(const World& world);

}  // namespace limn
