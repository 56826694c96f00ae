#include "ecs/record_layout.h"

#include <array>
#include <atomic>
#include <mutex>

namespace limn {

namespace {

struct OneComponent {
    ComponentId id;
    const ComponentId* ids[1];
    std::uint32_t offsets[1];
    RecordLayout layout;
};

using Table = std::array<std::atomic<const RecordLayout*>, kMaxComponents>;

/// Created on first use; lives as long as the program.
const RecordLayout& find_or_make(Table& table, ComponentId id, bool has_value) {
    if (const RecordLayout* made = table[id].load(std::memory_order_acquire); made != nullptr) {
        return *made;
    }
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    if (const RecordLayout* made = table[id].load(std::memory_order_relaxed); made != nullptr) {
        return *made;
    }
    const ComponentInfo& info = component_info(id);
    auto* one = new OneComponent{};
    one->id = id;
    one->ids[0] = &one->id;
    const bool is_empty = info.is_tag || !has_value;
    one->layout = {1, is_empty ? 0 : info.size, is_empty ? 1 : info.align, one->ids, one->offsets};
    table[id].store(&one->layout, std::memory_order_release);
    return one->layout;
}

constinit Table with_value = {};
constinit Table without_value = {};

}  // namespace

const RecordLayout& record_layout_of(ComponentId id) {
    return find_or_make(with_value, id, true);
}

const RecordLayout& key_layout_of(ComponentId id) {
    return find_or_make(without_value, id, false);
}

}  // namespace limn
