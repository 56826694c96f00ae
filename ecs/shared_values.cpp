#include "ecs/shared_values.h"

#include "ecs/base/hash.h"

#include <algorithm>
#include <cstring>

namespace limn {

namespace {

std::uint64_t hash_of(const ComponentInfo& info, const void* value) {
    return hash_bytes(value, info.size, info.id);
}

}  // namespace

void insert_shared(std::vector<SharedValue>& list, const SharedValue& value) {
    const auto position = std::find_if(list.begin(), list.end(), [&](const SharedValue& other) {
        return other.component > value.component;
    });
    list.insert(position, value);
}

std::uint32_t SharedValues::add(const ComponentInfo& info, const void* value) {
    const std::uint64_t hash = hash_of(info, value);
    if (const std::uint32_t known = find(info, value, hash); known != kUnknown) {
        return known;
    }
    const std::uint32_t key = size();
    Entry entry{info.id, hash, std::make_unique<std::byte[]>(info.size), {}};
    std::memcpy(entry.bytes.get(), value, info.size);
    entries_.push_back(std::move(entry));
    if (2 * entries_.size() > table_.size()) {
        table_.assign(std::max<std::size_t>(2 * table_.size(), 16), kUnknown);
        for (std::uint32_t i = 0; i < key; ++i) {
            insert(i);
        }
    }
    insert(key);
    return key;
}

std::uint32_t SharedValues::find(const ComponentInfo& info, const void* value) const {
    return find(info, value, hash_of(info, value));
}

std::uint32_t
SharedValues::find(const ComponentInfo& info, const void* value, std::uint64_t hash) const {
    if (table_.empty()) {
        return kUnknown;
    }
    for (std::size_t slot = hash & (table_.size() - 1); table_[slot] != kUnknown;
         slot = (slot + 1) & (table_.size() - 1)) {
        const Entry& entry = entries_[table_[slot]];
        if (entry.hash == hash && entry.component == info.id
            && std::memcmp(entry.bytes.get(), value, info.size) == 0) {
            return table_[slot];
        }
    }
    return kUnknown;
}

void SharedValues::insert(std::uint32_t key) {
    std::size_t slot = entries_[key].hash & (table_.size() - 1);
    while (table_[slot] != kUnknown) {
        slot = (slot + 1) & (table_.size() - 1);
    }
    table_[slot] = key;
}

void SharedValues::clear() {
    entries_.clear();
    table_.clear();
}

}  // namespace limn
