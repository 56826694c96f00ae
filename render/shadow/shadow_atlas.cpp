#include "render/shadow/shadow_atlas.h"

#include "ecs/base/check.h"

#include <algorithm>
#include <bit>

namespace limn {

ShadowAtlas::ShadowAtlas(int size) : size_(size) {
    LIMN_CHECK(size > 0 && std::has_single_bit(static_cast<unsigned>(size)));
    free_.resize(static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(size))));
    free_.back().push_back({0, 0, size});
}

std::vector<AtlasRect>& ShadowAtlas::free_of(int size) {
    return free_[static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(size))) - 1];
}

std::optional<AtlasRect> ShadowAtlas::allocate(int size) {
    LIMN_CHECK(size > 0 && std::has_single_bit(static_cast<unsigned>(size)));
    if (size > size_) {
        return std::nullopt;
    }
    std::vector<AtlasRect>& free = free_of(size);
    if (free.empty()) {
        const std::optional<AtlasRect> parent = allocate(2 * size);
        if (!parent) {
            return std::nullopt;
        }
        // The first is taken from the back.
        for (int i = 3; i >= 0; --i) {
            free.push_back({parent->x + (i & 1) * size, parent->y + (i >> 1) * size, size});
        }
    }
    const AtlasRect rect = free.back();
    free.pop_back();
    return rect;
}

void ShadowAtlas::release(const AtlasRect& rect) {
    std::vector<AtlasRect>& free = free_of(rect.size);
    const int parent_mask = ~(2 * rect.size - 1);
    const auto is_sibling = [&](const AtlasRect& other) {
        return (other.x & parent_mask) == (rect.x & parent_mask)
               && (other.y & parent_mask) == (rect.y & parent_mask);
    };
    if (rect.size < size_ && std::count_if(free.begin(), free.end(), is_sibling) == 3) {
        std::erase_if(free, is_sibling);
        release({rect.x & parent_mask, rect.y & parent_mask, 2 * rect.size});
    } else {
        free.push_back(rect);
    }
}

void ShadowAtlas::grow() {
    const int old = size_;
    std::vector<AtlasRect>& whole = free_of(old);
    const bool unused = !whole.empty();  // only the root has this size
    if (unused) {
        whole.clear();
    } else {
        whole = {{old, old, old}, {0, old, old}, {old, 0, old}};
    }
    size_ = 2 * old;
    free_.emplace_back();
    if (unused) {
        free_.back().push_back({0, 0, size_});
    }
}

}  // namespace limn
