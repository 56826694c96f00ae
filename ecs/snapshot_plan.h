#pragma once

#include "ecs/base/bytes.h"
#include "ecs/base/result.h"
#include "ecs/snapshot_format.h"
#include "ecs/world.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

// The contents of a snapshot, section by section in file order, and the source of each piece in the
// world: common to snapshots and deltas.

enum class SectionKind : std::uint8_t {
    Resource,
    Generations,
    Links,
    Entities,  ///< of a group
    Values,    ///< of a component of a group
    Disabled,  ///< disabled rows of a toggled component of a group
    SetEntities,
    SetValues,
};

/// How a component is stored in a file, which must match the program.
enum class SavedStorage : std::uint32_t {
    Rows,     ///< in a group, whatever the layout of columns
    Toggled,  ///< in a group, with Disabled
    Set,
    Shared,  ///< once per group, in the head
};

[[nodiscard]] SavedStorage saved_storage(const ComponentInfo& info);

/// Data of one kind, in pieces of kPieceRows elements.
struct SnapshotSection {
    SectionKind kind;
    std::uint32_t owner = 0;              ///< index of the group or set, or id of the resource
    const ComponentInfo* info = nullptr;  ///< type of the values
    std::uint32_t rows = 0;               ///< number of elements
};

/// The rows of one archetype in a group.
struct GroupPart {
    const Archetype* archetype;
    std::uint32_t first_row;  ///< in the group
};

/// Archetypes with equal saved components.
struct SnapshotGroup {
    std::vector<ComponentId> components;  ///< saved ones, ascending
    std::vector<SharedValue> shared;      ///< values of shared components
    std::vector<GroupPart> parts;
    std::uint32_t rows = 0;
    std::size_t first_section = 0;  ///< index of its Entities section
};

/// Contents of a SnapshotMark: the directory of a snapshot, and where its rows came from.
struct SnapshotIndex {
    struct Section {
        std::uint32_t rows = 0;
        std::size_t first_piece = 0;
    };
    const World* world = nullptr;
    std::uint32_t version = 0;  ///< later changes have a newer one
    std::uint64_t epoch = 0;    ///< archetypes and versions are only comparable within one epoch
    SnapshotHeader header;
    std::vector<std::byte> head;
    std::vector<SnapshotPiece> pieces;
    std::vector<std::uint64_t> offsets;  ///< of the pieces in the data [bytes]
    std::vector<Section> sections;
    std::vector<std::uint32_t> first_rows;  ///< in its group, per archetype
    std::vector<ComponentId> resources;     ///< of the first sections
    std::vector<std::size_t> groups;        ///< first section of each group
    std::vector<std::size_t> sets;          ///< first section of each set
    std::uint32_t first_free = kNoLink;

    /// File offset of a piece's table entry [bytes].
    [[nodiscard]] std::uint64_t table_offset(std::size_t piece) const {
        return kSnapshotHeaderSize + header.head_size + piece * sizeof(SnapshotPiece);
    }
    [[nodiscard]] std::uint64_t data_offset(std::size_t piece) const {
        return kSnapshotHeaderSize + header.directory_size() + offsets[piece];
    }
};

class SnapshotPlan {
  public:
    /// Fails, naming the component, if one cannot be saved.
    [[nodiscard]] static Result<SnapshotPlan> make(const World& world);

    [[nodiscard]] std::span<const SnapshotSection> sections() const { return sections_; }
    [[nodiscard]] std::size_t piece_count() const;
    /// Lower bound of the size of all pieces [bytes].
    [[nodiscard]] std::size_t min_data_size() const;

    void write_head(ByteWriter& out) const;
    void write_piece(const SnapshotSection& section, std::uint32_t piece, ByteWriter& out) const;

    /// Index of the piece of `base` that this one is a later state of; kNoPiece if there is none.
    static constexpr std::size_t kNoPiece = ~std::size_t{0};
    [[nodiscard]] std::size_t
    earlier_piece(std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const;
    /// Whether the piece, which must have an earlier one, is known to be equal to it because
    /// nothing in it was written.
    [[nodiscard]] bool
    is_untouched(std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const;

    /// Everything except the header, the pieces and their offsets.
    [[nodiscard]] SnapshotIndex make_index(std::uint32_t version) const;

    /// Must be called before head and slots are written. Skips reading the slots if no entity was
    /// created or destroyed since `base`.
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
    /// Rows first .. end - 1 of the group, which may belong to several archetypes.
    void write_rows(
        const SnapshotSection& section, std::uint32_t first, std::uint32_t end,
        ByteWriter& out) const;
    void write_disabled(
        const SnapshotSection& section, std::uint32_t first, std::uint32_t end,
        ByteWriter& out) const;

    const World* world_;
    std::vector<ComponentId> names_;      ///< in the order of first use
    std::vector<std::uint32_t> numbers_;  ///< index in names_ by component; kUnnamed: none
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

/// Changes whenever earlier versions and archetype indices become invalid.
[[nodiscard]] std::uint64_t snapshot_epoch(const World& world);

/// Whether snapshots hold this resource.
[[nodiscard]] bool is_saved_resource(const ComponentInfo& info);

}  // namespace limn
