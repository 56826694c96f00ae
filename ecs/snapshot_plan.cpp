#include "ecs/snapshot_plan.h"

#include "ecs/base/text.h"
#include "ecs/component_bytes.h"

#include <algorithm>
#include <map>

namespace limn {

namespace {

constexpr std::uint32_t kUnnamed = 0xffffffffu;

Status check_savable(const ComponentInfo& info) {
    if (!info.is_registered) {
        return fail(
            "component {}: not registered, so it cannot be saved; register it, or mark it as not "
            "saved",
            info.name);
    }
    if (!is_serializable(info)) {
        return fail(
            "component {}: cannot be serialized; give it LIMN_FIELDS, or mark it as not saved",
            info.name);
    }
    return Done{};
}

std::size_t min_element_size(const SnapshotSection& section) {
    switch (section.kind) {
    case SectionKind::Generations:
    case SectionKind::Links:
        return sizeof(std::uint32_t);
    case SectionKind::Entities:
    case SectionKind::SetEntities:
        return sizeof(Entity);
    case SectionKind::Disabled:
        return 0;
    case SectionKind::Resource:
    case SectionKind::Values:
    case SectionKind::SetValues:
        break;
    }
    return min_serialized_size(*section.info);
}

}  // namespace

SavedStorage saved_storage(const ComponentInfo& info) {
    return info.storage == Storage::Sparse   ? SavedStorage::Set
           : info.storage == Storage::Toggle ? SavedStorage::Toggled
           : info.storage == Storage::Shared ? SavedStorage::Shared
                                             : SavedStorage::Rows;
}

std::uint64_t snapshot_epoch(const World& world) {
    return std::uint64_t{world.core().epoch} << 32 | world.core().version_clamp_count;
}

bool is_saved_resource(const ComponentInfo& info) {
    return info.is_resource && info.saved && is_serializable(info);
}

// ---- contents
// ------------------------------------------------------------------------------------

Result<SnapshotPlan> SnapshotPlan::make(const World& world) {
    SnapshotPlan plan(world);
    plan.add_resources();
    plan.add_groups();
    plan.add_sets();
    plan.number_components();
    for (const ComponentId id : plan.names_) {
        if (Status status = check_savable(component_info(id)); !status) {
            return status.error();
        }
    }
    plan.list_sections();
    return plan;
}

void SnapshotPlan::add_resources() {
    for (const ComponentId id : world_->resources()) {
        if (is_saved_resource(component_info(id))) {
            resources_.push_back(id);
        }
    }
}

void SnapshotPlan::add_groups() {
    std::map<std::vector<ComponentId>, std::size_t> group_of;
    for (const auto& archetype : world_->archetypes()) {
        std::vector<ComponentId> components;
        for (const ComponentId id : archetype->components()) {
            if (component_info(id).saved) {
                components.push_back(id);
            }
        }
        std::vector<ComponentId> identity = components;
        std::vector<SharedValue> shared;
        for (const SharedValue& value : archetype->shared()) {
            if (component_info(value.component).saved) {
                shared.push_back(value);
                identity.push_back(value.key);
            }
        }
        const auto [found, is_new] = group_of.try_emplace(std::move(identity), groups_.size());
        if (is_new) {
            groups_.push_back({std::move(components), std::move(shared), {}});
        }
        SnapshotGroup& group = groups_[found->second];
        group.parts.push_back({archetype.get(), group.rows});
        group.rows += archetype->size();
    }
}

void SnapshotPlan::add_sets() {
    for (const SparseSet* set : world_->sparse_sets()) {
        if (set->info().saved) {
            sets_.push_back(set);
        }
    }
}

void SnapshotPlan::number_components() {
    numbers_.assign(component_count(), kUnnamed);
    const auto add = [this](ComponentId id) {
        if (numbers_[id] == kUnnamed) {
            numbers_[id] = static_cast<std::uint32_t>(names_.size());
            names_.push_back(id);
        }
    };
    for (const SnapshotGroup& group : groups_) {
        std::for_each(group.components.begin(), group.components.end(), add);
    }
    for (const SparseSet* set : sets_) {
        add(set->info().id);
    }
}

void SnapshotPlan::list_sections() {
    for (const ComponentId id : resources_) {
        sections_.push_back({SectionKind::Resource, id, &component_info(id), 1});
    }
    const std::uint32_t slots = world_->core().entities.slot_count();
    sections_.push_back({SectionKind::Generations, 0, nullptr, slots});
    sections_.push_back({SectionKind::Links, 0, nullptr, slots});
    for (std::uint32_t i = 0; i < groups_.size(); ++i) {
        SnapshotGroup& group = groups_[i];
        group.first_section = sections_.size();
        sections_.push_back({SectionKind::Entities, i, nullptr, group.rows});
        for (const ComponentId id : group.components) {
            const ComponentInfo& info = component_info(id);
            if (!info.is_tag && info.storage != Storage::Shared) {
                sections_.push_back({SectionKind::Values, i, &info, group.rows});
            }
            if (info.storage == Storage::Toggle) {
                sections_.push_back({SectionKind::Disabled, i, &info, group.rows});
            }
        }
    }
    for (std::uint32_t i = 0; i < sets_.size(); ++i) {
        const SparseSet& set = *sets_[i];
        first_of_set_.push_back(sections_.size());
        sections_.push_back({SectionKind::SetEntities, i, nullptr, set.size()});
        if (!set.info().is_tag) {
            sections_.push_back({SectionKind::SetValues, i, &set.info(), set.size()});
        }
    }
}

std::size_t SnapshotPlan::piece_count() const {
    std::size_t count = 0;
    for (const SnapshotSection& section : sections_) {
        count += pieces_of(section.rows);
    }
    return count;
}

std::size_t SnapshotPlan::min_data_size() const {
    std::size_t size = 0;
    for (const SnapshotSection& section : sections_) {
        size += section.rows * min_element_size(section);
    }
    return size;
}

// ---- serialization
// -------------------------------------------------------------------------------

void SnapshotPlan::read_slots(const SnapshotIndex* base) {
    if (base != nullptr && base->epoch == snapshot_epoch(*world_)
        && std::none_of(
            world_->archetypes().begin(), world_->archetypes().end(), [&](const auto& archetype) {
                return is_newer(archetype->newest_structure(), base->version);
            })) {
        first_free_ = base->first_free;
        return;
    }
    EntityTableImage image = world_->entity_image();
    generations_ = std::move(image.generations);
    links_.assign(generations_.size(), kNoLink);
    first_free_ = image.free_slots.empty() ? kNoLink : image.free_slots.front();
    for (std::size_t i = 0; i + 1 < image.free_slots.size(); ++i) {
        links_[image.free_slots[i]] = image.free_slots[i + 1];
    }
    has_slots_ = true;
}

void SnapshotPlan::write_head(ByteWriter& out) const {
    out.value(static_cast<std::uint32_t>(names_.size()));
    for (const ComponentId id : names_) {
        out.text(component_info(id).name);
        out.value(layout_hash(component_info(id)));
        out.value(static_cast<std::uint32_t>(saved_storage(component_info(id))));
    }
    out.value(static_cast<std::uint32_t>(resources_.size()));
    for (const ComponentId id : resources_) {
        out.text(component_info(id).name);
        out.value(layout_hash(component_info(id)));
    }
    out.value(world_->core().entities.slot_count());
    out.value(world_->core().entities.free_count());
    out.value(first_free_);
    out.value(static_cast<std::uint32_t>(groups_.size()));
    for (const SnapshotGroup& group : groups_) {
        out.value(static_cast<std::uint32_t>(group.components.size()));
        for (const ComponentId id : group.components) {
            out.value(numbers_[id]);
        }
        for (const SharedValue& value : group.shared) {
            write_values(component_info(value.component), value.value, 1, out);
        }
        out.value(group.rows);
    }
    out.value(static_cast<std::uint32_t>(sets_.size()));
    for (const SparseSet* set : sets_) {
        out.value(numbers_[set->info().id]);
        out.value(set->size());
    }
}

void SnapshotPlan::write_piece(
    const SnapshotSection& section, std::uint32_t piece, ByteWriter& out) const {
    const std::uint32_t first = piece * kPieceRows;
    const std::uint32_t count = rows_of_piece(section.rows, piece);
    switch (section.kind) {
    case SectionKind::Resource:
        write_values(*section.info, world_->find_resource(section.owner), 1, out);
        break;
    case SectionKind::Generations:
        LIMN_CHECK(has_slots_);
        out.bytes(generations_.data() + first, count * sizeof(std::uint32_t));
        break;
    case SectionKind::Links:
        LIMN_CHECK(has_slots_);
        out.bytes(links_.data() + first, count * sizeof(std::uint32_t));
        break;
    case SectionKind::Entities:
    case SectionKind::Values:
        write_rows(section, first, first + count, out);
        break;
    case SectionKind::Disabled:
        write_disabled(section, first, first + count, out);
        break;
    case SectionKind::SetEntities:
        out.bytes(sets_[section.owner]->entities().data() + first, count * sizeof(Entity));
        break;
    case SectionKind::SetValues:
        write_values(*section.info, sets_[section.owner]->value(first), count, out);
        break;
    }
}

namespace {

/// Calls call(archetype, row, count, row in the piece) for the archetypes of the group's rows
/// first .. end - 1.
template <typename Call>
void for_each_part(
    const SnapshotGroup& group, std::uint32_t first, std::uint32_t end, const Call& call) {
    for (const GroupPart& part : group.parts) {
        const std::uint32_t from = std::max(first, part.first_row);
        const std::uint32_t to = std::min(end, part.first_row + part.archetype->size());
        if (from < to) {
            call(*part.archetype, from - part.first_row, to - from, from - first);
        }
    }
}

}  // namespace

void SnapshotPlan::write_rows(
    const SnapshotSection& section, std::uint32_t first, std::uint32_t end, ByteWriter& out) const {
    const auto write = [&](const Archetype& rows, std::uint32_t row, std::uint32_t count,
                           std::uint32_t) {
        if (section.kind == SectionKind::Entities) {
            out.bytes(rows.entities().data() + row, count * sizeof(Entity));
        } else {
            limn::write_rows(rows.column(rows.column_of(section.info->id)), row, count, out);
        }
    };
    for_each_part(groups_[section.owner], first, end, write);
}

void SnapshotPlan::write_disabled(
    const SnapshotSection& section, std::uint32_t first, std::uint32_t end, ByteWriter& out) const {
    RowMask disabled{};
    const auto collect = [&](const Archetype& rows, std::uint32_t row, std::uint32_t count,
                             std::uint32_t offset) {
        const ToggleBits& toggle = *rows.bits().toggle(section.info->id);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (!toggle.is_enabled(row + i)) {
                disabled.set(offset + i);
            }
        }
    };
    for_each_part(groups_[section.owner], first, end, collect);
    if (disabled.any()) {
        out.bytes(disabled.words.data(), disabled_size(end - first));
    }
}

// ---- comparison with an earlier snapshot
// ---------------------------------------------------------

SnapshotIndex SnapshotPlan::make_index(std::uint32_t version) const {
    SnapshotIndex index;
    index.world = world_;
    index.version = version;
    index.epoch = snapshot_epoch(*world_);
    index.first_free = first_free_;
    index.resources = resources_;
    index.sets = first_of_set_;
    index.first_rows.resize(world_->archetypes().size());
    for (const SnapshotGroup& group : groups_) {
        index.groups.push_back(group.first_section);
        for (const GroupPart& part : group.parts) {
            index.first_rows[part.archetype->index()] = part.first_row;
        }
    }
    std::size_t pieces = 0;
    for (const SnapshotSection& section : sections_) {
        index.sections.push_back({section.rows, pieces});
        pieces += pieces_of(section.rows);
    }
    return index;
}

/// Within an epoch archetypes and sets are only added, so groups and sets keep their indices.
std::size_t SnapshotPlan::earlier_section(std::size_t section, const SnapshotIndex& base) const {
    const SnapshotSection& wanted = sections_[section];
    switch (wanted.kind) {
    case SectionKind::Resource: {
        const auto found = std::find(base.resources.begin(), base.resources.end(), wanted.owner);
        return found == base.resources.end()
                   ? kNoPiece
                   : static_cast<std::size_t>(found - base.resources.begin());
    }
    case SectionKind::Generations:
    case SectionKind::Links:
        return base.resources.size() + (wanted.kind == SectionKind::Links ? 1 : 0);
    case SectionKind::Entities:
    case SectionKind::Values:
    case SectionKind::Disabled:
        return wanted.owner < base.groups.size()
                   ? base.groups[wanted.owner] + section - groups_[wanted.owner].first_section
                   : kNoPiece;
    case SectionKind::SetEntities:
    case SectionKind::SetValues:
        return wanted.owner < base.sets.size()
                   ? base.sets[wanted.owner] + section - first_of_set_[wanted.owner]
                   : kNoPiece;
    }
    return kNoPiece;
}

std::size_t SnapshotPlan::earlier_piece(
    std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const {
    if (base.epoch != snapshot_epoch(*world_)) {
        return kNoPiece;
    }
    const std::size_t earlier = earlier_section(section, base);
    if (earlier == kNoPiece || piece >= pieces_of(base.sections[earlier].rows)) {
        return kNoPiece;
    }
    return base.sections[earlier].first_piece + piece;
}

bool SnapshotPlan::is_untouched(
    std::size_t section, std::uint32_t piece, const SnapshotIndex& base) const {
    const SnapshotSection& wanted = sections_[section];
    const std::uint32_t earlier_rows = base.sections[earlier_section(section, base)].rows;
    if (rows_of_piece(earlier_rows, piece) != rows_of_piece(wanted.rows, piece)) {
        return false;
    }
    switch (wanted.kind) {
    case SectionKind::Resource:
        return !is_newer(world_->resource_version(wanted.owner), base.version);
    case SectionKind::Generations:
    case SectionKind::Links:
        return !has_slots_;
    case SectionKind::Entities:
    case SectionKind::Values:
    case SectionKind::Disabled:
        return is_same_rows(wanted, piece, base);
    case SectionKind::SetEntities:
    case SectionKind::SetValues:
        return !is_newer(sets_[wanted.owner]->version(piece * kPieceRows), base.version);
    }
    return false;
}

/// A piece of a group is unchanged if its rows are the same rows of the same archetypes as before
/// and have no newer version.
bool SnapshotPlan::is_same_rows(
    const SnapshotSection& section, std::uint32_t piece, const SnapshotIndex& base) const {
    const std::uint32_t begin = piece * kPieceRows;
    const std::uint32_t end = begin + rows_of_piece(section.rows, piece);
    bool is_same = true;
    const auto look = [&](const Archetype& rows, std::uint32_t row, std::uint32_t count,
                          std::uint32_t offset) {
        is_same = is_same && rows.index() < base.first_rows.size()
                  && base.first_rows[rows.index()] + row == begin + offset;
        for (std::uint32_t chunk = row / kChunkRows; chunk < chunks_of(row + count); ++chunk) {
            const std::uint32_t version = section.kind == SectionKind::Entities
                                              ? rows.structure_version(chunk)
                                              : rows.version_of(section.info->id, chunk);
            is_same = is_same && !is_newer(version, base.version);
        }
    };
    for_each_part(groups_[section.owner], begin, end, look);
    return is_same;
}

}  // namespace limn
