#include "ecs/snapshot.h"

#include "ecs/any_component.h"
#include "ecs/base/hash.h"
#include "ecs/base/text.h"
#include "ecs/component_bytes.h"
#include "ecs/world.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <optional>

namespace limn {

namespace {

constexpr char kMagic[8] = {'L', 'I', 'M', 'N', 'S', 'N', 'A', 'P'};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderSize = 32;

// ---- saving
// ----------------------------------------------------------------------------------------

/// Archetypes that are one when what is not saved is left out.
struct SavedRows {
    std::vector<ComponentId> components;  ///< ascending
    std::vector<const Archetype*> parts;
};

std::vector<SavedRows> saved_rows(const World& world) {
    std::vector<SavedRows> all;
    std::map<std::vector<ComponentId>, std::size_t> places;
    for (const auto& archetype : world.archetypes()) {
        std::vector<ComponentId> components;
        for (const ComponentId id : archetype->components()) {
            if (component_info(id).saved) {
                components.push_back(id);
            }
        }
        const auto [place, is_new] = places.try_emplace(components, all.size());
        if (is_new) {
            all.push_back({components, {}});
        }
        all[place->second].parts.push_back(archetype.get());
    }
    return all;
}

/// The types of a snapshot, numbered in the order of their first use.
class NameTable {
  public:
    std::uint32_t add(ComponentId id) {
        const auto [place, is_new] =
            numbers_.try_emplace(id, static_cast<std::uint32_t>(ids_.size()));
        if (is_new) {
            ids_.push_back(id);
        }
        return place->second;
    }
    [[nodiscard]] std::uint32_t number(ComponentId id) const { return numbers_.at(id); }
    [[nodiscard]] const std::vector<ComponentId>& ids() const { return ids_; }

  private:
    std::map<ComponentId, std::uint32_t> numbers_;
    std::vector<ComponentId> ids_;
};

Status check_savable(const ComponentInfo& info) {
    if (!info.is_registered) {
        return fail(
            "component {}: not registered, so it cannot be saved; register it, or mark it as not "
            "saved",
            info.name);
    }
    if (!has_bytes(info)) {
        return fail(
            "component {}: no known bytes to save; give it visit_fields, or mark it as not saved",
            info.name);
    }
    return Done{};
}

void write_entities(std::span<const Entity> entities, ByteWriter& out) {
    out.bytes(entities.data(), entities.size_bytes());
}

void write_numbers(const std::vector<std::uint32_t>& numbers, ByteWriter& out) {
    out.value(static_cast<std::uint32_t>(numbers.size()));
    out.bytes(numbers.data(), numbers.size() * sizeof(std::uint32_t));
}

void write_resources(const World& world, ByteWriter& out) {
    std::vector<ComponentId> saved;
    for (const ComponentId id : world.resources()) {
        const ComponentInfo& info = component_info(id);
        if (info.is_resource && info.saved && has_bytes(info)) {
            saved.push_back(id);
        }
    }
    out.value(static_cast<std::uint32_t>(saved.size()));
    for (const ComponentId id : saved) {
        const ComponentInfo& info = component_info(id);
        out.text(info.name);
        out.value(layout_hash(info));
        write_values(info, world.find_resource(id), 1, out);
    }
}

/// Which rows are disabled: how many, and if any, a bit a row.
void write_disabled(const SavedRows& rows, ComponentId id, std::uint32_t count, ByteWriter& out) {
    std::vector<std::uint64_t> bits((count + 63) / 64);
    std::uint32_t disabled = 0;
    std::uint32_t first = 0;
    for (const Archetype* part : rows.parts) {
        const ToggleBits& toggle = *part->bits().toggle(id);
        for (std::uint32_t chunk = 0; chunk < part->chunk_count(); ++chunk) {
            disabled += toggle.chunks[chunk].disabled_count;
            toggle.chunks[chunk].disabled.for_each([&](std::uint32_t place) {
                const std::uint32_t row = first + chunk * kChunkRows + place;
                bits[row / 64] |= std::uint64_t{1} << row % 64;
            });
        }
        first += part->size();
    }
    out.value(disabled);
    if (disabled > 0) {
        out.bytes(bits.data(), bits.size() * sizeof(std::uint64_t));
    }
}

void write_rows(const SavedRows& rows, const NameTable& names, ByteWriter& out) {
    out.value(static_cast<std::uint32_t>(rows.components.size()));
    for (const ComponentId id : rows.components) {
        out.value(names.number(id));
    }
    std::uint32_t count = 0;
    for (const Archetype* part : rows.parts) {
        count += part->size();
    }
    out.value(count);
    for (const Archetype* part : rows.parts) {
        write_entities(part->entities(), out);
    }
    for (const ComponentId id : rows.components) {
        for (const Archetype* part : rows.parts) {
            if (const int column = part->column_of(id); column >= 0) {
                limn::write_rows(part->column(column), 0, part->size(), out);
            }
        }
        if (component_info(id).storage == Storage::Toggle) {
            write_disabled(rows, id, count, out);
        }
    }
}

void write_sparse(const SparseSet& set, const NameTable& names, ByteWriter& out) {
    out.value(names.number(set.info().id));
    out.value(set.size());
    write_entities(set.entities(), out);
    if (!set.info().is_tag) {
        write_values(set.info(), set.value(0), set.size(), out);
    }
}

// ---- restoring
// -------------------------------------------------------------------------------------

/// Reads a snapshot from front to back: first without a world, which checks everything, then with
/// one, which cannot fail any more. One code for both, so that neither forgets what the other
/// knows.
class SnapshotReader {
  public:
    SnapshotReader(std::span<const std::byte> payload, World* world)
        : in_(payload), world_(world) {}

    Status read() {
        for (const auto step :
             {&SnapshotReader::read_names,
              &SnapshotReader::read_resources,
              &SnapshotReader::read_slots,
              &SnapshotReader::read_archetypes,
              &SnapshotReader::read_sparse_sets}) {
            if (Status status = (this->*step)(); !status) {
                return status;
            }
        }
        if (in_.left() != 0) {
            return fail("{} bytes too many", in_.left());
        }
        if (world_ != nullptr) {
            world_->end_restore();
        }
        return Done{};
    }

  private:
    static constexpr std::size_t kLeastNameSize = sizeof(std::uint32_t) + sizeof(std::uint64_t);

    [[nodiscard]] Error cut_off(std::string_view where) const {
        return fail("{}: found the end or an impossible value at byte {}", where, in_.position());
    }

    Status check_type(
        const ComponentInfo* info,
        std::string_view kind,
        std::string_view name,
        std::uint64_t layout) {
        if (info == nullptr) {
            return fail("{} {}: unknown to this program", kind, name);
        }
        if (!info->saved || !has_bytes(*info) || info->ops.construct_default == nullptr) {
            return fail("{} {}: not of a kind that is saved", kind, name);
        }
        if (layout_hash(*info) != layout) {
            return fail("{} {}: was saved with other fields", kind, name);
        }
        return Done{};
    }

    Status read_names() {
        const std::uint32_t count = in_.count(kLeastNameSize);
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::string name(in_.text());
            const auto layout = in_.value<std::uint64_t>();
            if (in_.failed()) {
                break;
            }
            const ComponentInfo* const info = find_component(name);
            if (Status status = check_type(info, "component", name, layout); !status) {
                return status;
            }
            if (std::find(names_.begin(), names_.end(), info) != names_.end()) {
                return fail("component {}: named twice", name);
            }
            names_.push_back(info);
        }
        return in_.failed() ? Status(cut_off("names")) : Status(Done{});
    }

    Status read_resources() {
        const std::uint32_t count = in_.count(kLeastNameSize);
        std::vector<ComponentId> seen;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::string name(in_.text());
            const auto layout = in_.value<std::uint64_t>();
            if (in_.failed()) {
                return cut_off("resources");
            }
            const ComponentInfo* const info = find_resource(name);
            if (Status status = check_type(info, "resource", name, layout); !status) {
                return status;
            }
            if (std::find(seen.begin(), seen.end(), info->id) != seen.end()) {
                return fail("resource {}: named twice", name);
            }
            seen.push_back(info->id);
            AnyComponent value(*info);
            if (!read_values(*info, value.data(), 1, in_)) {
                return cut_off("resource " + name);
            }
            if (world_ != nullptr) {
                void* const place = world_->insert_default_resource(info->id);
                if (!info->is_tag) {
                    info->ops.destroy(place, 1);
                    info->ops.construct_move(place, value.data(), 1);
                }
            }
        }
        if (in_.failed()) {
            return cut_off("resources");
        }
        if (world_ != nullptr) {
            remove_other_resources(seen);
        }
        return Done{};
    }

    /// Saved kinds that the snapshot does not have were not there when it was made.
    void remove_other_resources(const std::vector<ComponentId>& kept) {
        const std::vector<ComponentId> present(
            world_->resources().begin(), world_->resources().end());
        for (const ComponentId id : present) {
            const ComponentInfo& info = component_info(id);
            const bool is_saved = info.is_resource && info.saved && has_bytes(info);
            if (is_saved && std::find(kept.begin(), kept.end(), id) == kept.end()) {
                world_->remove_resource(id);
            }
        }
    }

    std::vector<std::uint32_t> read_numbers() {
        std::vector<std::uint32_t> numbers(in_.count(sizeof(std::uint32_t)));
        in_.copy(numbers.data(), numbers.size() * sizeof(std::uint32_t));
        return numbers;
    }

    Status read_slots() {
        image_.generations = read_numbers();
        image_.free_slots = read_numbers();
        if (in_.failed() || image_.generations.size() > EntityTable::kMaxEntities) {
            return cut_off("slots");
        }
        for (const std::uint32_t generation : image_.generations) {
            if ((generation & kPlaceholderBit) != 0) {
                return fail(
                    "slots: found generation {}, expected less than {}",
                    generation,
                    kPlaceholderBit);
            }
        }
        slot_used_.assign(image_.generations.size(), false);
        for (const std::uint32_t slot : image_.free_slots) {
            if (slot >= slot_used_.size() || slot_used_[slot]) {
                return fail(
                    "slots: found free slot {} twice or beyond the {} there are",
                    slot,
                    slot_used_.size());
            }
            slot_used_[slot] = true;
        }
        if (world_ != nullptr) {
            world_->begin_restore(image_);
        }
        return Done{};
    }

    [[nodiscard]] bool is_handle(Entity entity) const {
        return entity.index < image_.generations.size()
               && image_.generations[entity.index] == entity.generation;
    }

    std::vector<Entity> read_entities() {
        std::vector<Entity> entities(in_.count(sizeof(Entity)));
        in_.copy(entities.data(), entities.size() * sizeof(Entity));
        return entities;
    }

    /// Into `first`; without a world, into one value after the other that nobody keeps.
    bool read_column(const ComponentInfo& info, void* first, std::size_t count) {
        if (world_ != nullptr) {
            return read_values(info, first, count, in_);
        }
        AnyComponent scratch(info);
        for (std::size_t i = 0; i < count; ++i) {
            if (!read_values(info, scratch.data(), 1, in_)) {
                return false;
            }
        }
        return true;
    }

    /// False: not what write_disabled writes of `count` rows.
    bool read_disabled(const ComponentInfo& info, Archetype* rows, std::size_t count) {
        const auto disabled = in_.value<std::uint32_t>();
        if (in_.failed() || disabled > count) {
            return false;
        }
        std::vector<std::uint64_t> bits(disabled > 0 ? (count + 63) / 64 : 0);
        in_.copy(bits.data(), bits.size() * sizeof(std::uint64_t));
        std::size_t found = 0;
        for (const std::uint64_t word : bits) {
            found += static_cast<std::size_t>(std::popcount(word));
        }
        const bool is_beyond = !bits.empty() && count % 64 != 0 && bits.back() >> count % 64 != 0;
        if (in_.failed() || found != disabled || is_beyond) {
            return false;
        }
        for (std::uint32_t row = 0; rows != nullptr && disabled > 0 && row < count; ++row) {
            if ((bits[row / 64] >> row % 64 & 1) != 0) {
                rows->bits().toggle(info.id)->set_enabled(row, false);
            }
        }
        return true;
    }

    Status read_archetypes() {
        const std::uint32_t count = in_.count(2 * sizeof(std::uint32_t));
        std::map<std::vector<ComponentId>, bool> seen;
        for (std::uint32_t i = 0; i < count; ++i) {
            std::vector<const ComponentInfo*> infos;
            for (const std::uint32_t number : read_numbers()) {
                if (number >= names_.size() || names_[number]->storage == Storage::Sparse) {
                    return fail(
                        "archetype {}: found component {} of {} tables", i, number, names_.size());
                }
                infos.push_back(names_[number]);
            }
            std::vector<ComponentId> ids;
            for (const ComponentInfo* info : infos) {
                ids.push_back(info->id);
            }
            std::sort(ids.begin(), ids.end());
            if (std::adjacent_find(ids.begin(), ids.end()) != ids.end()
                || !seen.try_emplace(ids, true).second) {
                return fail("archetype {}: a component or the whole of it is there twice", i);
            }
            const std::vector<Entity> entities = read_entities();
            if (in_.failed() || entities.size() > kMaxRows) {
                return cut_off("archetypes");
            }
            for (const Entity entity : entities) {
                if (!is_handle(entity) || slot_used_[entity.index]) {
                    return fail(
                        "archetype {}: entity {} v{} is not alive or twice there",
                        i,
                        entity.index,
                        entity.generation);
                }
                slot_used_[entity.index] = true;
            }
            placed_.insert(placed_.end(), entities.begin(), entities.end());
            Archetype* const rows =
                world_ != nullptr ? &world_->restore_rows(ids, entities) : nullptr;
            for (const ComponentInfo* info : infos) {
                const bool is_read = rows != nullptr && !info->is_tag
                                         ? read_rows(
                                             rows->column(rows->column_of(info->id)),
                                             0,
                                             static_cast<std::uint32_t>(entities.size()),
                                             in_)
                                         : read_column(*info, nullptr, entities.size());
                if (!is_read
                    || (info->storage == Storage::Toggle
                        && !read_disabled(*info, rows, entities.size()))) {
                    return cut_off("component " + info->name);
                }
            }
        }
        if (in_.failed()) {
            return cut_off("archetypes");
        }
        std::sort(placed_.begin(), placed_.end());
        return Done{};
    }

    Status read_sparse_sets() {
        const std::uint32_t count = in_.count(2 * sizeof(std::uint32_t));
        std::vector<ComponentId> seen;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto number = in_.value<std::uint32_t>();
            if (in_.failed() || number >= names_.size()
                || names_[number]->storage != Storage::Sparse) {
                return fail("sparse set {}: found component {} of {}", i, number, names_.size());
            }
            const ComponentInfo& info = *names_[number];
            if (std::find(seen.begin(), seen.end(), info.id) != seen.end()) {
                return fail("sparse set {}: component {} is there twice", i, info.name);
            }
            seen.push_back(info.id);
            const std::vector<Entity> entities = read_entities();
            if (in_.failed()) {
                break;
            }
            std::vector<Entity> sorted = entities;
            std::sort(sorted.begin(), sorted.end());
            if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()
                || !std::includes(placed_.begin(), placed_.end(), sorted.begin(), sorted.end())) {
                return fail("component {}: an entity is not alive or twice there", info.name);
            }
            SparseSet* const set =
                world_ != nullptr ? &world_->restore_sparse(info.id, entities) : nullptr;
            void* const first =
                set != nullptr && !info.is_tag && !entities.empty() ? set->value(0) : nullptr;
            if (!read_column(info, first, entities.size())) {
                return cut_off("component " + info.name);
            }
        }
        return in_.failed() ? Status(cut_off("sparse sets")) : Status(Done{});
    }

    ByteReader in_;
    World* world_;
    std::vector<const ComponentInfo*> names_;
    EntityTableImage image_;
    std::vector<bool> slot_used_;
    std::vector<Entity> placed_;
};

Result<std::span<const std::byte>> payload_of(std::span<const std::byte> bytes) {
    ByteReader in(bytes);
    const std::span<const std::byte> magic = in.bytes(sizeof kMagic);
    if (in.failed() || std::memcmp(magic.data(), kMagic, sizeof kMagic) != 0) {
        return fail("no snapshot: it does not begin with LIMNSNAP");
    }
    const auto version = in.value<std::uint32_t>();
    in.value<std::uint32_t>();
    const auto size = in.value<std::uint64_t>();
    const auto checksum = in.value<std::uint64_t>();
    if (in.failed() || size != in.left()) {
        return fail("found {} bytes after the header, expected {}", in.left(), size);
    }
    if (version != kVersion) {
        return fail("found version {}, expected {}", version, kVersion);
    }
    const std::span<const std::byte> payload = in.bytes(size);
    if (hash_bytes(payload) != checksum) {
        return fail("altered: the checksum is wrong");
    }
    return payload;
}

// ---- hashing
// ---------------------------------------------------------------------------------------

/// A piece of a column to hash; pieces are hashed in any order and put together in theirs.
struct HashPiece {
    const ComponentInfo* info;  ///< nullptr: entities
    const std::byte* first;
    std::uint32_t count;
    const Column* lanes = nullptr;  ///< of a split component, whose rows begin at `row`
    std::uint32_t row = 0;
};

class StateHasher {
  public:
    /// Values of one component, or entities, in pieces of a chunk.
    void add_column(const ComponentInfo* info, const std::byte* first, std::uint32_t count) {
        const std::size_t size = info != nullptr ? info->size : sizeof(Entity);
        for (std::uint32_t row = 0; row < count; row += kChunkRows) {
            pieces_.push_back({info, first + row * size, std::min(count - row, kChunkRows)});
        }
        parts_.push_back({pieces_.size(), info != nullptr ? hash_text(info->name) : 0, false});
    }
    /// The same of an archetype.
    void add_rows(const Column& column, std::uint32_t count) {
        if (column.info->storage != Storage::Split) {
            add_column(column.info, column.data, count);
            return;
        }
        for (std::uint32_t row = 0; row < count; row += kChunkRows) {
            pieces_.push_back(
                {column.info, nullptr, std::min(count - row, kChunkRows), &column, row});
        }
        parts_.push_back({pieces_.size(), hash_text(column.info->name), false});
    }
    /// A component that is there, without a value.
    void add_presence(const ComponentInfo& info) {
        parts_.push_back({pieces_.size(), hash_text(info.name), false});
    }
    /// Which rows of a toggled component are disabled; nothing if none is.
    void add_disabled(const ComponentInfo& info, const ToggleBits& toggle, std::uint32_t chunks) {
        if (toggle.disabled_count() == 0) {
            return;
        }
        for (const ToggleChunk& chunk : std::span(toggle.chunks).first(chunks)) {
            static_assert(sizeof(RowMask) % sizeof(Entity) == 0);
            pieces_.push_back(
                {nullptr,
                 reinterpret_cast<const std::byte*>(&chunk.disabled),
                 sizeof(RowMask) / sizeof(Entity)});
        }
        parts_.push_back({pieces_.size(), hash_combine(hash_text(info.name), 1), false});
    }
    /// Ends an archetype, sparse set or resource: the columns since the last end belong together.
    void end_group() { parts_.back().ends_group = true; }

    [[nodiscard]] std::uint64_t finish() const {
        std::vector<std::uint64_t> hashes(pieces_.size());
        parallel_for(pieces_.size(), kPiecesPerTask, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const HashPiece& piece = pieces_[i];
                hashes[i] =
                    piece.lanes != nullptr
                        ? hash_rows(*piece.lanes, piece.row, piece.count, piece.count)
                    : piece.info != nullptr
                        ? hash_values(*piece.info, piece.first, piece.count, piece.count)
                        : hash_bytes(piece.first, piece.count * sizeof(Entity), piece.count);
            }
        });
        // Columns of a group, and groups, are added: their order, which follows from ids and
        // history, must not count.
        std::uint64_t total = 0;
        std::uint64_t group = 0;
        std::size_t piece = 0;
        for (const Part& part : parts_) {
            std::uint64_t column = part.name;
            for (; piece < part.end; ++piece) {
                column = hash_combine(column, hashes[piece]);
            }
            group += hash_combine(part.name, column);
            if (part.ends_group) {
                total += hash_combine(0, group);
                group = 0;
            }
        }
        return hash_combine(total, pieces_.size());
    }

  private:
    static constexpr std::size_t kPiecesPerTask = 4;

    struct Part {
        std::size_t end;  ///< of its pieces
        std::uint64_t name;
        bool ends_group;
    };
    std::vector<HashPiece> pieces_;
    std::vector<Part> parts_;
};

}  // namespace

Result<std::vector<std::byte>> save_snapshot(const World& world) {
    const std::vector<SavedRows> all_rows = saved_rows(world);
    NameTable names;
    for (const SavedRows& rows : all_rows) {
        for (const ComponentId id : rows.components) {
            names.add(id);
        }
    }
    std::vector<const SparseSet*> sets;
    for (const SparseSet* set : world.sparse_sets()) {
        if (set->info().saved) {
            sets.push_back(set);
            names.add(set->info().id);
        }
    }
    for (const ComponentId id : names.ids()) {
        if (Status status = check_savable(component_info(id)); !status) {
            return status.error();
        }
    }

    ByteWriter out;
    out.bytes(kMagic, sizeof kMagic);
    out.value(kVersion);
    out.value(std::uint32_t{0});
    out.value(std::uint64_t{0});  // size and
    out.value(std::uint64_t{0});  // checksum, known at the end

    out.value(static_cast<std::uint32_t>(names.ids().size()));
    for (const ComponentId id : names.ids()) {
        out.text(component_info(id).name);
        out.value(layout_hash(component_info(id)));
    }
    write_resources(world, out);
    const EntityTableImage image = world.entity_image();
    write_numbers(image.generations, out);
    write_numbers(image.free_slots, out);
    out.value(static_cast<std::uint32_t>(all_rows.size()));
    for (const SavedRows& rows : all_rows) {
        write_rows(rows, names, out);
    }
    out.value(static_cast<std::uint32_t>(sets.size()));
    for (const SparseSet* set : sets) {
        write_sparse(*set, names, out);
    }

    const std::size_t size = out.size() - kHeaderSize;
    out.patch(16, static_cast<std::uint64_t>(size));
    out.patch(24, hash_bytes(out.data() + kHeaderSize, size));
    return out.take();
}

Status restore_snapshot(World& world, std::span<const std::byte> bytes) {
    const Result<std::span<const std::byte>> payload = payload_of(bytes);
    if (!payload) {
        return fail("snapshot: {}", payload.error().message);
    }
    if (const Status status = SnapshotReader(*payload, nullptr).read(); !status) {
        return fail("snapshot: {}", status.error().message);
    }
    const Status done = SnapshotReader(*payload, &world).read();
    LIMN_CHECK(done.ok());
    return Done{};
}

std::uint64_t state_hash(const World& world) {
    StateHasher hasher;
    for (const auto& archetype : world.archetypes()) {
        if (archetype->size() == 0) {
            continue;
        }
        for (const ComponentId id : archetype->components()) {
            const ComponentInfo& info = component_info(id);
            if (!info.hashed) {
                continue;
            }
            const int column = archetype->column_of(id);
            if (column >= 0 && has_bytes(info)) {
                hasher.add_rows(archetype->column(column), archetype->size());
            } else {
                hasher.add_presence(info);
            }
            if (const ToggleBits* toggle = archetype->bits().toggle(id); toggle != nullptr) {
                hasher.add_disabled(info, *toggle, archetype->chunk_count());
            }
        }
        const std::span<const Entity> entities = archetype->entities();
        hasher.add_column(
            nullptr, reinterpret_cast<const std::byte*>(entities.data()), archetype->size());
        hasher.end_group();
    }
    for (const SparseSet* set : world.sparse_sets()) {
        const ComponentInfo& info = set->info();
        if (set->size() == 0 || !info.hashed) {
            continue;
        }
        if (!info.is_tag && has_bytes(info)) {
            hasher.add_column(&info, set->value(0), set->size());
        } else {
            hasher.add_presence(info);
        }
        hasher.add_column(
            nullptr, reinterpret_cast<const std::byte*>(set->entities().data()), set->size());
        hasher.end_group();
    }
    for (const ComponentId id : world.resources()) {
        const ComponentInfo& info = component_info(id);
        if (info.is_resource && info.hashed && has_bytes(info) && !info.is_tag) {
            hasher.add_column(&info, static_cast<const std::byte*>(world.find_resource(id)), 1);
            hasher.end_group();
        }
    }
    return hasher.finish();
}

}  // namespace limn
