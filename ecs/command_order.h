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

// From what several threads recorded to a ChangeList, in three steps:
//     collect   all runs of all buffers, sorted by where they were recorded; the entities to create
//               get their handles in that order, which does not depend on threads, and placeholders
//               become those handles
//     locate    runs become pieces: neighboring commands for neighboring rows. A run over a whole
//               query is one piece; one over entities in any order is as many as it has commands
//     arrange   pieces sorted by row, those of one place in the order they were recorded in; where
//               they overlap, entities have several commands, which a plan folds into one change
// Commands for entities that are gone are dropped on the way.

class CommandOrder {
  public:
    explicit CommandOrder(WorldCore& core) : core_(core) {}

    void collect(std::span<CommandBuffer* const> buffers);
    /// `list` is empty.
    void arrange(ChangePlans& plans, ChangeList& list, FlushStats& stats);

  private:
    struct Segment {
        TaskScope place;
        CommandStream* stream;
        std::uint32_t first_run;
        std::uint32_t end_run;
    };
    /// Placeholders of a stream that became neighbors among the created.
    struct Creation {
        const CommandStream* stream;
        std::uint32_t placeholder;
        std::uint32_t number;  ///< in created_
    };
    struct Run {
        CommandRun commands;
        std::uint32_t key;      ///< commands before it
        std::uint32_t created;  ///< of Create: the first number in created_
        const CommandBuffer* buffer;
    };
    /// Neighboring commands of a run for neighboring rows.
    struct Piece {
        std::uint32_t archetype;  ///< kNoArchetype: `row` is a number in created_
        std::uint32_t row;
        std::uint32_t count;
        std::uint32_t run;
        std::uint32_t first;  ///< in the run

        [[nodiscard]] std::uint64_t begin() const { return std::uint64_t{archetype} << 32 | row; }
        [[nodiscard]] std::uint64_t end() const { return begin() + count; }
    };

    void collect(CommandBuffer& buffer);
    void resolve_fields(const Run& run);
    /// The entity of a placeholder as a number in created_; kNone if it names nothing.
    [[nodiscard]] std::uint32_t number_of(const CommandBuffer& buffer, Entity placeholder) const;
    void locate(std::uint32_t run);
    void locate_entities(std::uint32_t run);
    void add_piece(const Piece& piece);
    void sort_pieces();
    /// Gives the list the pieces from `at` on that overlap; returns where the next begins.
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
    std::vector<Creation> creations_;  ///< of the buffer that is being collected
    std::vector<Entity> created_;
    std::vector<Piece> pieces_;  ///< in the order of the commands
    bool is_sorted_ = true;      ///< they ascend and do not overlap
    std::uint64_t end_ = 0;      ///< of the last piece

    std::vector<std::uint64_t> order_;  ///< pieces by row; what is above 32 bits is the sort's
    std::vector<std::uint64_t> order_scratch_;
    std::vector<std::uint32_t> first_rows_;  ///< of archetypes, counted over all
    std::vector<std::uint32_t> active_;      ///< pieces with commands for the rows at hand
    std::vector<CommandKind> kinds_;
    std::vector<std::byte*> records_;
};

}  // namespace limn
