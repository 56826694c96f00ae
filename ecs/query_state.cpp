#include "ecs/query_state.h"

#include <algorithm>

namespace limn {

namespace {

bool is_required(TermKind kind) {
    return kind == TermKind::Read || kind == TermKind::Write || kind == TermKind::With
           || kind == TermKind::Changed || kind == TermKind::TakeRows;
}

bool has_data(TermKind kind) {
    return kind == TermKind::Read || kind == TermKind::Write || kind == TermKind::OptionalRead
           || kind == TermKind::OptionalWrite || kind == TermKind::TakeRows;
}

/// Whether the term skips disabled rows.
bool requires_enabled(TermKind kind) {
    return is_required(kind) && kind != TermKind::TakeRows;
}

/// Whether every group has a Changed term for which test(term) holds.
template <typename Test>
bool all_groups(
    const std::vector<std::uint8_t>& groups, const std::vector<QueryTerm>& terms,
    const Test& test) {
    return std::all_of(groups.begin(), groups.end(), [&](std::uint8_t group) {
        return std::any_of(terms.begin(), terms.end(), [&](const QueryTerm& term) {
            return term.kind == TermKind::Changed && term.group == group && test(term);
        });
    });
}

}  // namespace

bool detail::SharedKeys::are_in(const Archetype& archetype) const {
    const auto shared = archetype.shared();
    return std::all_of(keys_.begin(), keys_.begin() + count_, [&](std::uint32_t key) {
        return std::any_of(shared.begin(), shared.end(), [key](const SharedValue& value) {
            return value.key == key;
        });
    });
}

QueryState::QueryState(std::span<const QueryTerm> terms) : terms_(terms.begin(), terms.end()) {
    for (QueryTerm& term : terms_) {
        const Storage storage = component_info(term.id).storage;
        term.is_sparse = storage == Storage::Sparse;
        term.is_toggle = storage == Storage::Toggle;
        reads_shared_ = reads_shared_ || (storage == Storage::Shared && has_data(term.kind));
    }
    for (const QueryTerm& term : terms_) {
        if (term.kind != TermKind::Changed) {
            continue;
        }
        const bool any_sparse =
            std::any_of(terms_.begin(), terms_.end(), [&](const QueryTerm& other) {
                return other.kind == TermKind::Changed && other.group == term.group
                       && other.is_sparse;
            });
        std::vector<std::uint8_t>& groups = any_sparse ? sparse_groups_ : table_groups_;
        if (groups.empty() || groups.back() != term.group) {
            groups.push_back(term.group);
        }
    }
}

/// `if_sparse` is the result assumed for sparse components, which are checked per row.
bool QueryState::group_matches(
    const Archetype& archetype, std::uint8_t group, bool if_sparse) const {
    return std::any_of(terms_.begin(), terms_.end(), [&](const QueryTerm& term) {
        return term.kind == TermKind::AnyOf && term.group == group
               && (term.is_sparse ? if_sparse : archetype.has(term.id));
    });
}

bool QueryState::matches(const Archetype& archetype) const {
    return std::all_of(terms_.begin(), terms_.end(), [&](const QueryTerm& term) {
        if (term.is_sparse) {
            return true;  // checked per row
        }
        if (term.kind == TermKind::AnyOf) {
            return group_matches(archetype, term.group, true);
        }
        if (term.kind == TermKind::Without) {
            return term.is_toggle || !archetype.has(term.id);  // disabled rows match Without
        }
        return !is_required(term.kind) || archetype.has(term.id);
    });
}

void QueryState::extend(const WorldCore& core) {
    if (epoch_ != core.epoch || seen_ > core.archetypes.size()) {
        matches_.clear();
        match_of_.clear();
        seen_ = 0;
        epoch_ = core.epoch;
    }
    match_of_.resize(core.archetypes.size(), -1);
    for (; seen_ < core.archetypes.size(); ++seen_) {
        Archetype& archetype = *core.archetypes[seen_];
        if (!matches(archetype)) {
            continue;
        }
        QueryMatch match;
        match.archetype = &archetype;
        match.columns.fill(kNoColumn);
        std::size_t position = 0;
        for (const QueryTerm& term : terms_) {
            if (has_data(term.kind)) {
                match.columns[position++] = static_cast<std::int16_t>(archetype.column_of(term.id));
            }
        }
        match_of_[seen_] = static_cast<std::int32_t>(matches_.size());
        matches_.push_back(match);
    }
    if (reads_shared_) {
        sort_by_shared();
    }
}

void QueryState::sort_by_shared() {
    const auto key_of = [](const Archetype& archetype, ComponentId id) {
        const SharedValue* value = archetype.shared_value(id);
        return value != nullptr ? value->key : SharedValues::kUnknown;
    };
    std::sort(matches_.begin(), matches_.end(), [&](const QueryMatch& a, const QueryMatch& b) {
        for (const QueryTerm& term : terms_) {
            if (has_data(term.kind)) {
                const std::uint32_t left = key_of(*a.archetype, term.id);
                const std::uint32_t right = key_of(*b.archetype, term.id);
                if (left != right) {
                    return left < right;
                }
            }
        }
        return a.archetype->index() < b.archetype->index();
    });
    for (std::size_t i = 0; i < matches_.size(); ++i) {
        match_of_[matches_[i].archetype->index()] = static_cast<std::int32_t>(i);
    }
}

bool QueryState::archetype_changed(const Archetype& archetype, std::uint32_t since) const {
    return all_groups(table_groups_, terms_, [&](const QueryTerm& term) {
        return is_newer(archetype.newest_version_of(term.id), since);
    });
}

bool QueryState::chunk_changed(
    const Archetype& archetype, std::uint32_t chunk, std::uint32_t since) const {
    return all_groups(table_groups_, terms_, [&](const QueryTerm& term) {
        return is_newer(archetype.version_of(term.id, chunk), since);
    });
}

bool QueryState::row_changed(
    const WorldCore& core, const Archetype& archetype, std::uint32_t row,
    std::uint32_t since) const {
    return all_groups(sparse_groups_, terms_, [&](const QueryTerm& term) {
        if (!term.is_sparse) {
            return is_newer(archetype.version_of(term.id, row / kChunkRows), since);
        }
        const SparseSet* set = core.sparse_set(term.id);
        const std::uint32_t position = set->find(archetype.entities()[row]);
        return position != SparseSet::kAbsent && is_newer(set->version(position), since);
    });
}

bool QueryState::row_matches(
    const WorldCore& core, const Archetype& archetype, Entity entity) const {
    const auto has_sparse = [&](ComponentId id) {
        const SparseSet* set = core.sparse_set(id);
        return set != nullptr && set->has(entity);
    };
    return std::all_of(terms_.begin(), terms_.end(), [&](const QueryTerm& term) {
        if (term.kind == TermKind::AnyOf) {
            return !term.is_sparse || has_sparse(term.id)
                   || group_matches(archetype, term.group, false)
                   || std::any_of(terms_.begin(), terms_.end(), [&](const QueryTerm& other) {
                          return other.kind == TermKind::AnyOf && other.group == term.group
                                 && other.is_sparse && has_sparse(other.id);
                      });
        }
        const bool matters =
            term.is_sparse && (is_required(term.kind) || term.kind == TermKind::Without);
        if (!matters) {
            return true;
        }
        return has_sparse(term.id) == is_required(term.kind);
    });
}

bool QueryState::writes(ComponentId id) const {
    return std::any_of(terms_.begin(), terms_.end(), [id](const QueryTerm& term) {
        return term.id == id
               && (term.kind == TermKind::Write || term.kind == TermKind::OptionalWrite);
    });
}

EnabledRows
QueryState::enabled_rows(const Archetype& archetype, std::uint32_t chunk, RowMask& rows) const {
    const std::uint32_t size =
        std::min(archetype.size() - chunk * kChunkRows, std::uint32_t{kChunkRows});
    EnabledRows found = EnabledRows::All;
    const auto keep = [&](const auto& change) {
        if (found == EnabledRows::All) {
            rows = RowMask::first(size);
            found = EnabledRows::Some;
        }
        change();
    };
    for (const QueryTerm& term : terms_) {
        if (!term.is_toggle) {
            continue;
        }
        const ToggleBits* toggle = archetype.bits().toggle(term.id);
        if (toggle == nullptr) {
            continue;  // Without or Optional
        }
        const ToggleChunk& bits = toggle->chunks[chunk];
        if (requires_enabled(term.kind) && bits.disabled_count > 0) {
            if (bits.disabled_count == size) {
                return EnabledRows::None;
            }
            keep([&] { rows -= bits.disabled; });
        } else if (term.kind == TermKind::Without && bits.disabled_count < size) {
            if (bits.disabled_count == 0) {
                return EnabledRows::None;
            }
            keep([&] { rows &= bits.disabled; });
        }
    }
    return found == EnabledRows::Some && !rows.any() ? EnabledRows::None : found;
}

bool QueryState::row_enabled(const Archetype& archetype, std::uint32_t row) const {
    return std::all_of(terms_.begin(), terms_.end(), [&](const QueryTerm& term) {
        const bool matters =
            term.is_toggle && (requires_enabled(term.kind) || term.kind == TermKind::Without);
        return !matters || archetype.is_enabled(term.id, row) == (term.kind != TermKind::Without);
    });
}

const SparseSet* QueryState::leading_set(const WorldCore& core) const {
    for (const QueryTerm& term : terms_) {
        if (term.is_sparse && is_required(term.kind)) {
            return core.sparse_set(term.id);
        }
    }
    return nullptr;
}

}  // namespace limn
