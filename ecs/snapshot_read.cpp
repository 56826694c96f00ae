#include "ecs/any_component.h"
#include "ecs/base/jobs.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/snapshot.h"
#include "ecs/snapshot_plan.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>

namespace limn {

namespace {

constexpr std::size_t kRowsReadPerTask = 4;

/// Contents of a section and location of its pieces.
struct ReadSection {
    SectionKind kind;
    const ComponentInfo* info = nullptr;
    std::uint32_t rows = 0;
    std::size_t first_piece = 0;
    std::uint64_t offset = 0;  ///< in the data [bytes]
    std::uint64_t size = 0;
};

struct ReadGroup {
    std::vector<ComponentId> components;      ///< ascending
    std::vector<const ComponentInfo*> infos;  ///< in the order of the file
    std::vector<AnyComponent> shared;         ///< ascending
    std::uint32_t rows = 0;
    std::size_t first_section = 0;
};

struct ReadSet {
    const ComponentInfo* info;
    std::size_t first_section;
};

/// Reads a snapshot in two steps: check() validates it completely, restore() then fills the world
/// and cannot fail.
class SnapshotReader {
  public:
    explicit SnapshotReader(const SnapshotParts& parts) : parts_(parts), in_(parts.head) {}

    Status check() {
        for (const auto step :
             {&SnapshotReader::read_names, &SnapshotReader::read_resources,
              &SnapshotReader::read_slots, &SnapshotReader::read_groups, &SnapshotReader::read_sets,
              &SnapshotReader::locate_sections, &SnapshotReader::check_slots,
              &SnapshotReader::check_groups, &SnapshotReader::check_sets,
              &SnapshotReader::check_values}) {
            if (Status status = (this->*step)(); !status) {
                return status;
            }
        }
        return Done{};
    }

    void restore(World& world) {
        restore_resources(world);
        world.begin_restore(image_);
        for (const ReadGroup& group : groups_) {
            restore_group(world, group);
        }
        for (const ReadSet& read : sets_) {
            SparseSet& set = world.restore_sparse(read.info->id, entities_of(read.first_section));
            if (!read.info->is_tag && set.size() > 0) {
                read_section(sections_[read.first_section + 1], set.value(0));
            }
        }
    }

  private:
    [[nodiscard]] Error cut_off(std::string_view where) const {
        return fail("{}: found the end or an invalid value at byte {}", where, in_.position());
    }

    // ---- the head
    // -----------------------------------------------------------------------------

    Status check_type(
        const ComponentInfo* info, std::string_view kind, std::string_view name,
        std::uint64_t layout) const {
        if (info == nullptr) {
            return fail("{} {}: unknown to this program", kind, name);
        }
        if (!info->saved || !is_serializable(*info) || info->ops.construct_default == nullptr) {
            return fail("{} {}: this program does not save this type", kind, name);
        }
        if (layout_hash(*info) != layout) {
            return fail("{} {}: was saved with different fields", kind, name);
        }
        return Done{};
    }

    /// Reads a list of distinct types.
    Status read_types(
        std::string_view kind, const ComponentInfo* (*find)(std::string_view),
        std::vector<const ComponentInfo*>& types) {
        const bool has_storage = find == find_component;
        const std::uint32_t count = in_.count(sizeof(std::uint32_t) + sizeof(std::uint64_t));
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::string_view name = in_.text();
            const auto layout = in_.value<std::uint64_t>();
            const auto storage = has_storage ? in_.value<std::uint32_t>() : 0;
            if (in_.failed()) {
                break;
            }
            const ComponentInfo* const info = find(name);
            if (Status status = check_type(info, kind, name, layout); !status) {
                return status;
            }
            if (has_storage && storage != static_cast<std::uint32_t>(saved_storage(*info))) {
                return fail("{} {}: was saved with a different storage", kind, name);
            }
            if (std::find(types.begin(), types.end(), info) != types.end()) {
                return fail("{} {}: listed twice", kind, name);
            }
            types.push_back(info);
        }
        return in_.failed() ? Status(cut_off(kind)) : Status(Done{});
    }

    Status read_names() { return read_types("component", find_component, names_); }

    Status read_resources() {
        if (Status status = read_types("resource", find_resource, resources_); !status) {
            return status;
        }
        for (const ComponentInfo* info : resources_) {
            sections_.push_back({SectionKind::Resource, info, 1});
        }
        return Done{};
    }

    Status read_slots() {
        const auto slots = in_.value<std::uint32_t>();
        free_count_ = in_.value<std::uint32_t>();
        first_free_ = in_.value<std::uint32_t>();
        if (in_.failed() || slots > EntityTable::kMaxEntities || free_count_ > slots) {
            return cut_off("slots");
        }
        sections_.push_back({SectionKind::Generations, nullptr, slots});
        sections_.push_back({SectionKind::Links, nullptr, slots});
        return Done{};
    }

    bool read_shared(ReadGroup& group) {
        for (const ComponentInfo* info : group.infos) {
            if (info->storage == Storage::Shared) {
                AnyComponent& value = group.shared.emplace_back(*info);
                if (!read_values(*info, value.data(), 1, in_)) {
                    return false;
                }
            }
        }
        std::sort(group.shared.begin(), group.shared.end(), [](const auto& a, const auto& b) {
            return a.info().id < b.info().id;
        });
        return true;
    }

    /// Key of a group: its components and the bytes of shared values.
    static std::vector<ComponentId> identity_of(const ReadGroup& group) {
        std::vector<ComponentId> identity = group.components;
        for (const AnyComponent& value : group.shared) {
            const std::uint8_t* const bytes = static_cast<const std::uint8_t*>(value.data());
            identity.insert(identity.end(), bytes, bytes + value.info().size);
        }
        return identity;
    }

    Status read_groups() {
        const std::uint32_t count = in_.count(2 * sizeof(std::uint32_t));
        std::map<std::vector<ComponentId>, bool> known;
        for (std::uint32_t i = 0; i < count; ++i) {
            ReadGroup group;
            const std::uint32_t components = in_.count(sizeof(std::uint32_t));
            for (std::uint32_t c = 0; c < components; ++c) {
                const auto number = in_.value<std::uint32_t>();
                if (number >= names_.size() || names_[number]->storage == Storage::Sparse) {
                    return fail("group {}: found component {} of {}", i, number, names_.size());
                }
                group.infos.push_back(names_[number]);
                group.components.push_back(names_[number]->id);
            }
            if (!in_.failed() && !read_shared(group)) {
                return cut_off("shared values");
            }
            group.rows = in_.value<std::uint32_t>();
            if (in_.failed() || group.rows > kMaxRows) {
                return cut_off("groups");
            }
            std::sort(group.components.begin(), group.components.end());
            if (std::adjacent_find(group.components.begin(), group.components.end())
                    != group.components.end()
                || !known.try_emplace(identity_of(group), true).second) {
                return fail("group {}: the group or one of its components appears twice", i);
            }
            group.first_section = sections_.size();
            sections_.push_back({SectionKind::Entities, nullptr, group.rows});
            for (const ComponentInfo* info : group.infos) {
                if (!info->is_tag && info->storage != Storage::Shared) {
                    sections_.push_back({SectionKind::Values, info, group.rows});
                }
                if (info->storage == Storage::Toggle) {
                    sections_.push_back({SectionKind::Disabled, info, group.rows});
                }
            }
            groups_.push_back(std::move(group));
        }
        return in_.failed() ? Status(cut_off("groups")) : Status(Done{});
    }

    Status read_sets() {
        const std::uint32_t count = in_.count(2 * sizeof(std::uint32_t));
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto number = in_.value<std::uint32_t>();
            const auto rows = in_.value<std::uint32_t>();
            if (in_.failed() || number >= names_.size() || rows > kMaxRows
                || names_[number]->storage != Storage::Sparse) {
                return fail("sparse set {}: found component {} of {}", i, number, names_.size());
            }
            const ComponentInfo* info = names_[number];
            if (std::any_of(sets_.begin(), sets_.end(), [info](const ReadSet& set) {
                    return set.info == info;
                })) {
                return fail("sparse set {}: component {} appears twice", i, info->name);
            }
            sets_.push_back({info, sections_.size()});
            sections_.push_back({SectionKind::SetEntities, nullptr, rows});
            if (!info->is_tag) {
                sections_.push_back({SectionKind::SetValues, info, rows});
            }
        }
        if (in_.failed() || in_.left() != 0) {
            return cut_off("sparse sets");
        }
        return Done{};
    }

    /// Assigns pieces to sections; checks the size of sections with fixed-size elements.
    Status locate_sections() {
        std::size_t piece = 0;
        std::uint64_t offset = 0;
        for (ReadSection& section : sections_) {
            section.first_piece = piece;
            section.offset = offset;
            const std::size_t element = element_size(section.kind);
            for (std::uint32_t i = 0; i < pieces_of(section.rows); ++i, ++piece) {
                if (piece == parts_.pieces.size()) {
                    return fail("found {} pieces, expected more", piece);
                }
                const std::uint64_t size = parts_.pieces[piece].size;
                if (element != 0 && size != rows_of_piece(section.rows, i) * element) {
                    return fail("piece {}: found {} bytes", piece, size);
                }
                offset += size;
            }
            section.size = offset - section.offset;
        }
        if (piece != parts_.pieces.size()) {
            return fail("found {} pieces, expected {}", parts_.pieces.size(), piece);
        }
        return Done{};
    }

    /// Size of an element [bytes]; 0 if it varies.
    static std::size_t element_size(SectionKind kind) {
        switch (kind) {
        case SectionKind::Generations:
        case SectionKind::Links:
            return sizeof(std::uint32_t);
        case SectionKind::Entities:
        case SectionKind::SetEntities:
            return sizeof(Entity);
        case SectionKind::Resource:
        case SectionKind::Values:
        case SectionKind::Disabled:
        case SectionKind::SetValues:
            break;
        }
        return 0;
    }

    // ---- the data
    // -----------------------------------------------------------------------------

    [[nodiscard]] std::span<const std::byte> bytes_of(const ReadSection& section) const {
        return parts_.data.subspan(section.offset, section.size);
    }

    template <typename T>
    [[nodiscard]] std::vector<T> elements_of(const ReadSection& section) const {
        std::vector<T> elements(section.rows);
        ByteReader(bytes_of(section)).copy(elements.data(), section.size);
        return elements;
    }

    [[nodiscard]] std::vector<Entity> entities_of(std::size_t section) const {
        return elements_of<Entity>(sections_[section]);
    }

    enum class SlotUse : std::uint8_t { Unknown, Free, InGroup, InSet };

    Status check_slots() {
        const std::size_t section = resources_.size();
        image_.generations = elements_of<std::uint32_t>(sections_[section]);
        const std::vector<std::uint32_t> links = elements_of<std::uint32_t>(sections_[section + 1]);
        for (const std::uint32_t generation : image_.generations) {
            if ((generation & kPlaceholderBit) != 0) {
                return fail(
                    "slots: found generation {}, expected less than {}", generation,
                    kPlaceholderBit);
            }
        }
        uses_.assign(links.size(), SlotUse::Unknown);
        image_.free_slots.reserve(free_count_);
        std::uint32_t slot = first_free_;
        for (std::uint32_t i = 0; i < free_count_; ++i) {
            if (slot >= uses_.size() || uses_[slot] == SlotUse::Free) {
                return fail(
                    "slots: free slot {} appears twice or is not below the slot count {}", slot,
                    uses_.size());
            }
            uses_[slot] = SlotUse::Free;
            image_.free_slots.push_back(slot);
            slot = links[slot];
        }
        if (slot != kNoLink) {
            return fail("slots: the free list is longer than {}", free_count_);
        }
        for (std::size_t i = 0; i < links.size(); ++i) {
            if (links[i] != kNoLink && uses_[i] != SlotUse::Free) {
                return fail("slots: found a link in slot {}, which is not free", i);
            }
        }
        return Done{};
    }

    [[nodiscard]] bool is_handle(Entity entity) const {
        return entity.index < image_.generations.size()
               && image_.generations[entity.index] == entity.generation;
    }

    Status check_groups() {
        for (std::size_t i = 0; i < groups_.size(); ++i) {
            for (const Entity entity : entities_of(groups_[i].first_section)) {
                if (!is_handle(entity) || uses_[entity.index] != SlotUse::Unknown) {
                    return fail(
                        "group {}: entity {} v{} is not alive or appears twice", i, entity.index,
                        entity.generation);
                }
                uses_[entity.index] = SlotUse::InGroup;
            }
        }
        return Done{};
    }

    Status check_sets() {
        for (const ReadSet& set : sets_) {
            const std::vector<Entity> entities = entities_of(set.first_section);
            for (const Entity entity : entities) {
                if (!is_handle(entity) || uses_[entity.index] != SlotUse::InGroup) {
                    return fail(
                        "component {}: entity {} v{} is not alive or appears twice", set.info->name,
                        entity.index, entity.generation);
                }
                uses_[entity.index] = SlotUse::InSet;
            }
            for (const Entity entity : entities) {
                uses_[entity.index] = SlotUse::InGroup;
            }
        }
        return Done{};
    }

    /// Validates every value by reading it into scratch memory.
    Status check_values() {
        for (const ReadSection& section : sections_) {
            if (section.info == nullptr) {
                continue;
            }
            std::atomic<bool> is_invalid = false;
            for_each_piece(
                section, [&](std::span<const std::byte> bytes, std::uint32_t, std::uint32_t count) {
                    const bool is_valid = section.kind == SectionKind::Disabled
                                              ? are_disabled_rows(bytes, count)
                                              : are_values(*section.info, bytes, count);
                    if (!is_valid) {
                        is_invalid.store(true, std::memory_order_relaxed);
                    }
                });
            if (is_invalid.load()) {
                return fail(
                    "{} {}: found an invalid value",
                    section.kind == SectionKind::Resource ? "resource" : "component",
                    section.info->name);
            }
        }
        return Done{};
    }

    /// Calls call(bytes, first row, row count) for all pieces, on several threads.
    template <typename Call>
    void for_each_piece(const ReadSection& section, const Call& call) const {
        const std::uint32_t count = pieces_of(section.rows);
        std::vector<std::uint64_t> offsets;
        offsets.reserve(count);
        std::uint64_t offset = section.offset;
        for (std::uint32_t i = 0; i < count; ++i) {
            offsets.push_back(offset);
            offset += parts_.pieces[section.first_piece + i].size;
        }
        parallel_for(count, kRowsReadPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const auto piece = static_cast<std::uint32_t>(i);
                call(
                    parts_.data.subspan(offsets[i], parts_.pieces[section.first_piece + i].size),
                    piece * kPieceRows, rows_of_piece(section.rows, piece));
            }
        });
    }

    /// Whether the bytes are a mask of `count` rows with some bit set, or empty.
    static bool are_disabled_rows(std::span<const std::byte> bytes, std::uint32_t count) {
        RowMask beyond = mask_of(bytes);
        beyond -= RowMask::first(count);
        return bytes.empty()
               || (bytes.size() == disabled_size(count) && !beyond.any() && mask_of(bytes).any());
    }

    static RowMask mask_of(std::span<const std::byte> bytes) {
        RowMask mask{};
        std::memcpy(mask.words.data(), bytes.data(), std::min(bytes.size(), sizeof mask.words));
        return mask;
    }

    static bool
    are_values(const ComponentInfo& info, std::span<const std::byte> bytes, std::uint32_t count) {
        if (accepts_any_bytes(info)) {
            return bytes.size() == std::size_t{count} * info.size;
        }
        ByteReader in(bytes);
        AnyComponent scratch(info);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!read_values(info, scratch.data(), 1, in)) {
                return false;
            }
        }
        return in.left() == 0;
    }

    // ---- the world
    // ----------------------------------------------------------------------------

    void restore_group(World& world, const ReadGroup& group) const {
        std::size_t section = group.first_section;
        std::vector<const void*> shared;
        for (const AnyComponent& value : group.shared) {
            shared.push_back(value.data());
        }
        Archetype& rows = world.restore_rows(group.components, entities_of(section), shared);
        for (const ComponentInfo* info : group.infos) {
            if (!info->is_tag && info->storage != Storage::Shared) {
                Column& column = rows.column(rows.column_of(info->id));
                for_each_piece(
                    sections_[++section], [&](std::span<const std::byte> bytes, std::uint32_t first,
                                              std::uint32_t count) {
                        ByteReader in(bytes);
                        LIMN_CHECK(read_rows(column, first, count, in));
                    });
            }
            if (info->storage == Storage::Toggle) {
                ToggleBits& toggle = *rows.bits().toggle(info->id);
                for_each_piece(
                    sections_[++section],
                    [&](std::span<const std::byte> bytes, std::uint32_t first, std::uint32_t) {
                        mask_of(bytes).for_each(
                            [&](std::uint32_t row) { toggle.set_enabled(first + row, false); });
                    });
            }
        }
    }

    void read_section(const ReadSection& section, std::byte* values) const {
        for_each_piece(
            section,
            [&](std::span<const std::byte> bytes, std::uint32_t first, std::uint32_t count) {
                ByteReader in(bytes);
                LIMN_CHECK(read_values(
                    *section.info, values + std::size_t{first} * section.info->size, count, in));
            });
    }

    void restore_resources(World& world) const {
        // Saved resource types missing in the snapshot did not exist when it was made.
        const std::vector<ComponentId> present(world.resources().begin(), world.resources().end());
        for (const ComponentId id : present) {
            const ComponentInfo& info = component_info(id);
            if (is_saved_resource(info)
                && std::find(resources_.begin(), resources_.end(), &info) == resources_.end()) {
                world.remove_resource(id);
            }
        }
        for (std::size_t i = 0; i < resources_.size(); ++i) {
            auto* const value =
                static_cast<std::byte*>(world.insert_default_resource(resources_[i]->id));
            if (!resources_[i]->is_tag) {
                read_section(sections_[i], value);
            }
        }
    }

    const SnapshotParts& parts_;
    ByteReader in_;
    std::vector<const ComponentInfo*> names_;
    std::vector<const ComponentInfo*> resources_;
    std::vector<ReadSection> sections_;
    std::vector<ReadGroup> groups_;
    std::vector<ReadSet> sets_;
    std::uint32_t free_count_ = 0;
    std::uint32_t first_free_ = kNoLink;
    EntityTableImage image_;
    std::vector<SlotUse> uses_;
};

/// The mark of a world that was just restored. A valid snapshot may still differ from what saving
/// the world would write, if it was not made by save_snapshot; its mark then matches nothing.
SnapshotMark mark_of(const World& world, const SnapshotParts& parts) {
    SnapshotPlan plan = SnapshotPlan::make(world).value();
    plan.read_slots(nullptr);
    ByteWriter head;
    plan.write_head(head);
    SnapshotIndex index = plan.make_index(world.version());
    index.header = parts.header;
    index.head.assign(parts.head.begin(), parts.head.end());
    index.pieces = parts.pieces;
    std::uint64_t end = 0;
    for (const SnapshotPiece& piece : index.pieces) {
        index.offsets.push_back(end);
        end += piece.size;
    }
    if (!std::equal(parts.head.begin(), parts.head.end(), head.data(), head.data() + head.size())) {
        index.epoch = ~std::uint64_t{0};
    }
    return {std::make_shared<const SnapshotIndex>(std::move(index))};
}

}  // namespace

Status restore_snapshot(World& world, std::span<const std::byte> bytes, SnapshotMark* mark) {
    const Result<SnapshotParts> parts = open_snapshot(bytes);
    if (!parts) {
        return fail("snapshot: {}", parts.error().message);
    }
    SnapshotReader reader(*parts);
    if (const Status status = check_pieces(*parts); !status) {
        return fail("snapshot: {}", status.error().message);
    }
    if (const Status status = reader.check(); !status) {
        return fail("snapshot: {}", status.error().message);
    }
    reader.restore(world);
    if (mark != nullptr) {
        *mark = mark_of(world, *parts);
    }
    world.end_restore();
    return Done{};
}

}  // namespace limn
