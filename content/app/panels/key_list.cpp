#include "content/app/panels/key_list.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace limn {
namespace {

float at_of(const KeyPlot& plot, const Vec2& pointer) {
    return std::clamp((pointer.x - plot.corner.x) / plot.size.x, 0.0f, 1.0f);
}

float x_of(const KeyPlot& plot, float at) {
    return plot.corner.x + std::clamp(at, 0.0f, 1.0f) * plot.size.x;
}

void follow(const KeyPlot& plot, const Vec2& pointer, CurveKey& key) {
    key.at = at_of(plot, pointer);
    const float height = 1 - (pointer.y - plot.corner.y) / plot.size.y;
    key.value = plot.top * std::clamp(height, 0.0f, 1.0f);
}

void follow(const KeyPlot& plot, const Vec2& pointer, ColorKey& key) {
    key.at = at_of(plot, pointer);
}

CurveKey new_key(const KeyPlot& plot, const Vec2& pointer, const std::vector<CurveKey>& /*keys*/) {
    CurveKey key;
    follow(plot, pointer, key);
    return key;
}

ColorKey new_key(const KeyPlot& plot, const Vec2& pointer, const std::vector<ColorKey>& keys) {
    const float at = at_of(plot, pointer);
    const Vec4 color = sample_colors(keys, at);
    return {at, {color.x, color.y, color.z}, color.w};
}

float distance(const KeyPlot& plot, const CurveKey& key, const Vec2& pointer) {
    return glm::length(key_position(plot, key) - pointer);
}

float distance(const KeyPlot& plot, const ColorKey& key, const Vec2& pointer) {
    return std::abs(key_position(plot, key).x - pointer.x);
}

template <typename Key>
int hit(const KeyPlot& plot, const std::vector<Key>& keys, const Vec2& pointer) {
    int nearest = -1;
    float smallest = plot.pick_radius;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        const float away = distance(plot, keys[i], pointer);
        if (away <= smallest) {
            smallest = away;
            nearest = static_cast<int>(i);
        }
    }
    return nearest;
}

template <typename Key>
int sort(std::vector<Key>& keys, int followed) {
    std::vector<std::size_t> order(keys.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return keys[a].at < keys[b].at;
    });
    std::vector<Key> sorted;
    int moved = -1;
    for (const std::size_t i : order) {
        if (static_cast<int>(i) == followed) {
            moved = static_cast<int>(sorted.size());
        }
        sorted.push_back(keys[i]);
    }
    keys = std::move(sorted);
    return moved;
}

template <typename Key>
bool edit(const KeyPlot& plot, const KeyInput& input, std::vector<Key>& keys, int& selected) {
    const int count = static_cast<int>(keys.size());
    selected = selected < count ? selected : -1;
    const int under = hit(plot, keys, input.pointer);
    const int removed = input.right_clicked ? under : input.removes ? selected : -1;
    if (removed >= 0) {
        keys.erase(keys.begin() + removed);
        selected = -1;
        sort(keys, -1);
        return true;
    }
    if (input.double_clicked && under < 0 && keys.size() < kMaxEditedKeys) {
        keys.push_back(new_key(plot, input.pointer, keys));
        selected = sort(keys, count);
        return true;
    }
    if (input.pressed) {
        selected = under;
        return false;
    }
    if (!input.held || selected < 0) {
        return false;
    }
    Key& key = keys[static_cast<std::size_t>(selected)];
    const Vec2 before = key_position(plot, key);
    Key moved = key;
    follow(plot, input.pointer, moved);
    // A click need not hit the center of a key, and does not move it.
    if (glm::length(key_position(plot, moved) - before) < 1) {
        return false;
    }
    key = moved;
    selected = sort(keys, selected);
    return true;
}

}  // namespace

float plot_top(const std::vector<CurveKey>& keys) {
    float top = 1;
    for (const CurveKey& key : keys) {
        while (top < key.value && top < 1e6f) {
            top *= 2;
        }
    }
    return top;
}

Vec2 key_position(const KeyPlot& plot, const CurveKey& key) {
    const float height = std::clamp(key.value / plot.top, 0.0f, 1.0f);
    return {x_of(plot, key.at), plot.corner.y + (1 - height) * plot.size.y};
}

Vec2 key_position(const KeyPlot& plot, const ColorKey& key) {
    return {x_of(plot, key.at), plot.corner.y + plot.size.y};
}

int hit_key(const KeyPlot& plot, const std::vector<CurveKey>& keys, const Vec2& pointer) {
    return hit(plot, keys, pointer);
}

int hit_key(const KeyPlot& plot, const std::vector<ColorKey>& keys, const Vec2& pointer) {
    return hit(plot, keys, pointer);
}

int sort_keys(std::vector<CurveKey>& keys, int followed) {
    return sort(keys, followed);
}

int sort_keys(std::vector<ColorKey>& keys, int followed) {
    return sort(keys, followed);
}

bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<CurveKey>& keys, int& selected) {
    return edit(plot, input, keys, selected);
}

bool edit_keys(
    const KeyPlot& plot, const KeyInput& input, std::vector<ColorKey>& keys, int& selected) {
    return edit(plot, input, keys, selected);
}

}  // namespace limn
