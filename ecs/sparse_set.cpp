#include "ecs/sparse_set.h"

#include "ecs/base/check.h"

#include <algorithm>

namespace limn {

SparseSet::SparseSet(const ComponentInfo& info) {
    column_.info = &info;
    column_.size = info.size;
}

SparseSet::~SparseSet() {
    clear(0);
}

std::uint32_t SparseSet::append(Entity entity, std::uint32_t version) {
    if (entities_.data() == nullptr) {
        // Skewed differently from each other and from the columns of archetypes.
        const std::size_t position = 100 + 2 * std::size_t{column_.info->id};
        const std::size_t align = std::max<std::size_t>(kColumnAlign, column_.info->align);
        entities_ = VirtualRange(std::size_t{kMaxRows} * sizeof(Entity), skew_of(position));
        column_.range =
            VirtualRange(std::size_t{kMaxRows} * column_.size, skew_of(position + 1, align));
        column_.data = column_.range.data();
    }
    const std::uint32_t position = size_++;
    const std::size_t padded = (std::size_t{size_} + kRowPadding - 1) / kRowPadding * kRowPadding;
    entities_.commit(padded * sizeof(Entity));
    column_.range.commit(padded * column_.size);
    reinterpret_cast<Entity*>(entities_.data())[position] = entity;

    const std::uint32_t page = entity.index / kPageSize;
    if (page >= pages_.size()) {
        pages_.resize(page + 1);
    }
    if (pages_[page] == nullptr) {
        pages_[page] = std::make_unique_for_overwrite<std::uint32_t[]>(kPageSize);
        std::fill_n(pages_[page].get(), kPageSize, kAbsent);
    }
    pages_[page][entity.index % kPageSize] = position;

    if (position / kChunkRows >= column_.versions.size()) {
        column_.versions.push_back(version);
    }
    touch(position, version);
    return position;
}

void SparseSet::remove(std::uint32_t position, std::uint32_t version) {
    Entity* all = reinterpret_cast<Entity*>(entities_.data());
    if (!column_.info->trivially_destructible) {
        column_.info->ops.destroy(value(position), 1);
    }
    pages_[all[position].index / kPageSize][all[position].index % kPageSize] = kAbsent;
    touch(position, version);
    const std::uint32_t last = --size_;
    if (position != last) {
        relocate_values(*column_.info, value(position), value(last), 1);
        all[position] = all[last];
        pages_[all[position].index / kPageSize][all[position].index % kPageSize] = position;
        touch(last, version);
    }
}

void SparseSet::clear(std::uint32_t version) {
    if (size_ > 0 && !column_.info->trivially_destructible) {
        column_.info->ops.destroy(column_.data, size_);
    }
    std::fill(column_.versions.begin(), column_.versions.end(), version);
    column_.newest = version;
    pages_.clear();
    size_ = 0;
}

void SparseSet::shrink() {
    const std::size_t padded = (std::size_t{size_} + kRowPadding - 1) / kRowPadding * kRowPadding;
    entities_.shrink(padded * sizeof(Entity));
    column_.range.shrink(padded * column_.size);
    if (size_ == 0) {
        pages_.clear();
        pages_.shrink_to_fit();
    }
}

void SparseSet::clamp_versions(std::uint32_t oldest) {
    for (std::uint32_t& version : column_.versions) {
        version = newer_of(version, oldest);
    }
    column_.newest = newer_of(column_.newest, oldest);
}

std::size_t SparseSet::committed() const {
    std::size_t pages = 0;
    for (const auto& page : pages_) {
        pages += page != nullptr ? kPageSize * sizeof(std::uint32_t) : 0;
    }
    return entities_.committed() + column_.range.committed() + pages;
}

}  // namespace limn
