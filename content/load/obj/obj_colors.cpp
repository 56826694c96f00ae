#include "content/load/obj/obj_colors.h"

#include "ecs/base/srgb.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace limn {

void ObjColors::add(std::size_t vertex, std::span<const float> numbers) {
    if (numbers.size() < 3 || numbers.size() > 5) {
        return;
    }
    if (numbers.size() == 5) {  // w r g b a
        numbers = numbers.subspan(1, 3);
    }
    Entry entry{static_cast<std::uint32_t>(vertex), {numbers[0], numbers[1], numbers[2]}};
    if (numbers.size() == 4) {
        entry.fourth = numbers[3];
        entry.has_fourth = true;
    }
    entries_.push_back(entry);
}

std::vector<Vec3> ObjColors::find_rgb() const {
    const bool weights = std::all_of(entries_.begin(), entries_.end(), [](const Entry& entry) {
        return !entry.has_fourth || entry.first.x == 1;
    });
    std::vector<Vec3> rgb;
    for (const Entry& entry : entries_) {
        rgb.push_back(
            entry.has_fourth && weights ? Vec3(entry.first.y, entry.first.z, entry.fourth)
                                        : entry.first);
    }
    return rgb;
}

std::vector<Vec3> ObjColors::decode(std::size_t count) const {
    if (entries_.empty()) {
        return {};
    }
    std::vector<Vec3> rgb = find_rgb();
    float largest = 0;
    bool are_whole = true;
    for (const Vec3& color : rgb) {
        for (int i = 0; i < 3; ++i) {
            largest = std::max(largest, color[i]);
            are_whole = are_whole && color[i] == std::round(color[i]);
        }
    }
    const float unit = are_whole && largest > 1 ? 255.0f : 1.0f;
    std::vector<Vec3> colors(count, Vec3(1));
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            colors[entries_[i].vertex][k] =
                linear_from_srgb(std::clamp(rgb[i][k] / unit, 0.0f, 1.0f));
        }
    }
    return colors;
}

}  // namespace limn
