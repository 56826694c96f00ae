#pragma once

#include "ecs/base/bytes.h"
#include "ecs/base/result.h"
#include "ecs/snapshot_format.h"
#include "ecs/world.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// What of a world a snapshot holds, section by section in the order of the file, and where each
// piece of it comes from: the part that saving and deltas have in common.

enum class SectionKind : std::uint8_t {
    Resource,
    Generations,
    Links,
    Entities,  ///< of a group
    Values,    ///< of a component of a group
    Disabled,  ///< which rows are, of a toggled component of a group
    SetEntities,
    SetValues,
};

/// How the rows of a component are in a file: what a program must have in common with it.
enum class SavedStorage : std::uint32_t {
    Rows,     ///< of a group, in whatever columns
    Toggled,  ///< of a group, with Disabled
    Set,
    Shared,  ///< of a group, once, in the head
};

[[nodiscard]] SavedStorage saved_storage(const ComponentInfo& info);

/// Bytes of one kind, in pieces of kPieceRows elements.
struct SnapshotSection {
    SectionKind kind;
    std::uint32_t owner = 0;              ///< group or set; id of a resource
    const ComponentInfo* info = nullptr;  ///< of values
    std::uint32_t rows = 0;               ///< elements
};

/// Rows of one archetype in a group.
struct GroupPart {
    const Archetype* archetype;
    std::uint32_t first_row;  ///< in the group
};

/// Archetypes that are one when what is not saved is left out.
struct SnapshotGroup {
    std::vector<ComponentId> components;  ///< saved ones, ascending
    std::vector<SharedValue> shared;      ///< of those that are shared
    std::vector<GroupPart> parts;
    std::uint32_t rows = 0;
    std::size_t first_section = 0;  ///< its entities
};

/// Behind a SnapshotMark: the directory of a snapshot, and what its rows were.
struct SnapshotIndex {
    struct Section {
        std::uint32_t rows = 0;
        std::size_t first_piece = 0;
    };
    const World* world = nullptr;
    std::uint32_t version = 0;  ///< what changed later has a newer one
    std::uint64_t epoch = 0;    ///< of archetypes and versions; those of another mean nothing
    SnapshotHeader header;
    std::vector<std::byte> head;
    std::vector<SnapshotPiece> pieces;
    std::vector<std::uint64_t> offsets;  ///< of the pieces in the data [bytes]
    std::vector<Section> sections;
    std::vector<std::uint32_t> first_rows;  ///< of each archetype in its group
    std::vector<ComponentId> resources;     ///< of the first sections
    std::vector<std::size_t> groups;        ///< first section of each
    std::vector<std::size_t> sets;
    std::uint32_t first_free = kNoLink;

    /// Where a piece's line in the table is, from the front of the file [bytes].
    [[nodiscard]] std::uint64_t table_offset(std::size_t piece) const {
        return kSnapshotHeaderSize + header.head_size + piece * sizeof(SnapshotPiece);
    }
    [[nodiscard]] std::uint64_t data_offset(std::size_t piece) const {
        return kSnapshotHeaderSize + header.directory_size() + offsets[piece];
    }
};

class SnapshotPlan {
  public:
    /// Fails, naming the component, when one cannot be saved.
    [[nodiscard]] static Result<SnapshotPlan> make(const World& world);

    [[nodiscard]] std::span<const SnapshotSection> sections() const { return sections_; }
    [[nodiscard]] std::size_t piece_count() const;
    /// Of all pieces, where values have the least size they can have [bytes].
    [[nodiscard]] std::size_t least_data_size() const;

    void write_head(ByteWriter& out) const;
    void write_piece(const SnapshotSection& section, std::uint32_t piece, ByteWriter& out) const;

    /// The piece of `base` that this one is a later state of: its number; kNoPiece if there was
    /// none.
    static constexpr std::size_t kNoPiece = ~std::size_t{0};
    [[nodiscard]] std::size_t
    earlier_piece(std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const;
    /// Whether the piece that has an earlier one surely is the same: nothing of it was touched.
    [[nodiscard]] bool
    is_untouched(std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const;

    /// All but the header, the pieces and their offsets.
    [[nodiscard]] SnapshotIndex make_index(std::uint32_t version) const;

    /// Must be called before head and slots are written; `base`: if no entity came or went since,
    /// its slots are the same and not looked at.
    void read_slots(const SnapshotIndex* base);

  private:
    explicit SnapshotPlan(const World& world) : world_(&world) {}

    void add_resources();
    void add_groups();
    void add_sets();
    void number_components();
    void list_sections();
    [[nodiscard]] std::size_t earlier_section(std::size_t section, const SnapshotIndex& base) const;
    [[nodiscard]] bool is_same_rows(
        const SnapshotSection& section, std::uint32_t piece, const SnapshotIndex& base) const;
    /// Rows first .. end - 1 of the group, which may be those of several archetypes.
    void write_rows(
        const SnapshotSection& section, std::uint32_t first, std::uint32_t end,
        ByteWriter& out) const;
    void write_disabled(
        const SnapshotSection& section, std::uint32_t first, std::uint32_t end,
        ByteWriter& out) const;

    const World* world_;
    std::vector<ComponentId> names_;      ///< in the order of their first use
    std::vector<std::uint32_t> numbers_;  ///< in names_, by component; kUnnamed: not there
    std::vector<ComponentId> resources_;
    std::vector<SnapshotGroup> groups_;
    std::vector<const SparseSet*> sets_;
    std::vector<std::size_t> first_of_set_;
    std::vector<SnapshotSection> sections_;
    std::vector<std::uint32_t> generations_;
    std::vector<std::uint32_t> links_;
    std::uint32_t first_free_ = kNoLink;
    bool has_slots_ = false;
};

/// Changes when versions and numbers of archetypes of before mean nothing any more.
[[nodiscard]] std::uint64_t snapshot_epoch(const World& world);

/// Whether snapshots hold this resource.
[[nodiscard]] bool is_saved_resource(const ComponentInfo& info);

}  // namespace limn
