#pragma once

#include "ecs/change_list.h"
#include "ecs/command_buffer.h"
#include "ecs/flush_stats.h"
#include "ecs/world_core.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace limn {

// Converts the commands of several threads to a ChangeList, in three steps:
//     collect   sorts all runs of all buffers by where they were recorded; the entities to create
//               get their handles in that order, which does not depend on threads, and replace
//               their placeholders
//     locate    splits runs into pieces: consecutive commands for consecutive rows. A run over a
//               whole query is one piece; one over entities in any order has one per command
//     arrange   sorts pieces by row, those of one row in recording order; where they overlap,
//               entities have several commands, which a plan folds into one change
// Commands for entities that no longer exist are dropped.

class CommandOrder {
  public:
    explicit CommandOrder(WorldCore& core) : core_(core) {}

    void collect(std::span<CommandBuffer* const> buffers);
    /// `list` must be empty.
    void arrange(ChangePlans& plans, ChangeList& list, FlushStats& stats);

  private:
    struct Segment {
        TaskScope scope;
        CommandStream* stream;
        std::uint32_t first_run;
        std::uint32_t end_run;
    };
    /// Placeholders of a stream that are consecutive in created_.
    struct Creation {
        const CommandStream* stream;
        std::uint32_t placeholder;
        std::uint32_t number;  ///< index in created_
    };
    struct Run {
        CommandRun commands;
        std::uint32_t key;      ///< number of preceding commands
        std::uint32_t created;  ///< for Create: the first index in created_
        const CommandBuffer* buffer;
    };
    /// Consecutive commands of a run for consecutive rows.
    struct Piece {
        std::uint32_t archetype;  ///< kNoArchetype: `row` is an index in created_
        std::uint32_t row;
        std::uint32_t count;
        std::uint32_t run;
        std::uint32_t first;  ///< command in the run

        [[nodiscard]] std::uint64_t begin() const { return std::uint64_t{archetype} << 32 | row; }
        [[nodiscard]] std::uint64_t end() const { return begin() + count; }
    };

    void collect(CommandBuffer& buffer);
    void resolve_fields(const Run& run);
    /// Index in created_ of the entity of a placeholder; kNone if invalid.
    [[nodiscard]] std::uint32_t number_of(const CommandBuffer& buffer, Entity placeholder) const;
    void locate(std::uint32_t run);
    void locate_entities(std::uint32_t run);
    void add_piece(const Piece& piece);
    void sort_pieces();
    /// Adds the overlapping pieces from `at` on to the list; returns the index of the next piece.
    std::size_t fold_overlap(std::size_t at, FlushStats& stats);
    void emit(std::uint64_t begin, std::uint64_t end);
    [[nodiscard]] const Piece& piece(std::size_t position) const {
        return pieces_[is_sorted_ ? position : order_[position] & 0xffffffffu];
    }
    [[nodiscard]] Archetype* source_of(const Piece& piece) const;

    static constexpr std::uint32_t kNone = 0xffffffffu;

    WorldCore& core_;
    ChangePlans* plans_ = nullptr;
    ChangeList* list_ = nullptr;
    std::vector<Segment> segments_;
    std::vector<Run> runs_;
    std::vector<Creation> creations_;  ///< of the buffer being collected
    std::vector<Entity> created_;
    std::vector<Piece> pieces_;  ///< in the order of the commands
    bool is_sorted_ = true;      ///< pieces_ ascend and do not overlap
    std::uint64_t end_ = 0;      ///< of the last piece

    std::vector<std::uint64_t> order_;  ///< sort key in the upper 32 bits, piece index in the lower
    std::vector<std::uint64_t> order_scratch_;
    std::vector<std::uint32_t> first_rows_;  ///< global index of each archetype's first row
    std::vector<std::uint32_t> active_;      ///< pieces with commands for the current rows
    std::vector<CommandKind> kinds_;
    std::vector<std::byte*> records_;
};

}  // namespace limn
