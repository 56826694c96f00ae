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

// The whole world as bytes, for save games, rollback and replay files; the difference between two
// such moments; and the world as one number, to find out whether two runs are the same.
//
//     SnapshotMark mark;
//     std::vector<std::byte> saved = save_snapshot(world, &mark).value();
//     schedule.run(world);
//     const std::vector<std::byte> delta = save_delta(world, mark, &mark).value();  // small
//     saved = apply_delta(saved, delta).value();  // what save_snapshot would have written
//
// Saved are all entities, with the handles they have and will be given; their components, in order;
// and the registered resources. ComponentTraits<T>::saved = false leaves a type out: what systems
// make anew (WaterState) or what lives elsewhere (objects on the GPU). Entities that differ only in
// such components are put side by side. Types are known by name and by the names and types of their
// fields, so a file outlives a change of ids, but not a change of a component.
//
// A column whose bytes are its value is copied as a whole, both ways. The file is cut into pieces
// of 1024 rows of a column with a checksum each; a delta holds the pieces that are new and says
// where the others stood. ecs/snapshot_format.h has the layout.

/// A moment of a world: what save_delta compares with. Made by save_snapshot, save_delta and
/// restore_snapshot; cheap to copy. Does not outlive the world.
struct SnapshotMark {
    std::shared_ptr<const SnapshotIndex> index;  ///< null: no moment
};

/// Fails, naming the component, when one that should be saved is not registered or has no known
/// bytes. `mark` becomes this moment.
[[nodiscard]] Result<std::vector<std::byte>>
save_snapshot(const World& world, SnapshotMark* mark = nullptr);

/// Makes the entities and the saved resources of `world` those of the snapshot; other resources and
/// all observers stay. Everything that was there is removed first (on_remove), then what is new is
/// added (on_add). A snapshot that is cut off, altered, or of another version or other components
/// changes nothing: all is checked before. Never takes much more memory than the world it
/// describes. `mark` becomes the moment of the snapshot, which observers may already have left.
[[nodiscard]] Status
restore_snapshot(World& world, std::span<const std::byte> bytes, SnapshotMark* mark = nullptr);

/// What changed since the moment `base` of this world, in chunks of 1024 rows; time and size are
/// those of what changed, but for some 16 bytes of work a chunk there is, and for the slots of all
/// entities if any came, went or moved. Changes are found by their versions, as Changed<T> finds
/// them: a reference taken before `base` and written after it escapes. Everything counts as changed
/// when the world was restored after `base`, or after 2^28 runs of systems. Fails as save_snapshot
/// does.
[[nodiscard]] Result<std::vector<std::byte>>
save_delta(const World& world, const SnapshotMark& base, SnapshotMark* mark = nullptr);

/// The snapshot that save_snapshot would have written when save_delta was called, byte for byte.
/// Knows no components. Fails when `delta` is altered or belongs to another snapshot than `base`.
/// Never takes more memory than base and delta together.
[[nodiscard]] Result<std::vector<std::byte>>
apply_delta(std::span<const std::byte> base, std::span<const std::byte> delta);

/// 64 bits of everything that snapshots save and of components that are not saved but hashed
/// (ComponentTraits<T>::hashed). Two worlds with the same rows in the same order have the same
/// hash, in whatever order archetypes came into being, for any number of threads and in every
/// program. Of a type without known bytes (no visit_fields, but padding or a destructor) only
/// counts who has it.
[[nodiscard]] std::uint64_t state_hash(const World& world);

}  // namespace limn
