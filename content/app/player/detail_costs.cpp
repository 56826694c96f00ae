#include "content/app/player/detail_costs.h"

#include "ecs/components/surface.h"
#include "ecs/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace limn {

bool has_relief(const World& world) {
    const std::vector<Material>& materials = world.resource<Assets>().materials;
    return std::any_of(materials.begin(), materials.end(), [](const Material& material) {
        return material.detail > SurfaceDetail::ObjectNormal;
    });
}

void DetailCosts::add(DetailLimit limit, double ms, const IVec2& size, float dt) {
    used_ = used_ || limit != limit_;
    since_ = limit == limit_ ? since_ + dt : 0.0f;
    limit_ = limit;
    if (since_ >= kSettling && size.x > 0 && size.y > 0) {
        ns_[static_cast<std::size_t>(limit)] = ms * 1e6 / (static_cast<double>(size.x) * size.y);
    }
}

std::string DetailCosts::describe() const {
    if (!used_) {
        return {};
    }
    std::string text =
        fmt::format("surface detail: {}", kDetailLimitTexts[static_cast<std::size_t>(limit_)]);
    const double ns = ns_[static_cast<std::size_t>(limit_)];
    const double flat = ns_[static_cast<std::size_t>(DetailLimit::Flat)];
    if (ns > 0) {
        text += fmt::format(", {:.0f} ns per pixel", ns);
    }
    if (ns > 0 && flat > 0 && limit_ != DetailLimit::Flat) {
        text += fmt::format(", {:.2f} times flat", ns / flat);
    }
    return text;
}

}  // namespace limn
