#include "systems/animation/driven_shapes_system.h"

#include <algorithm>
#include <vector>

namespace limn {
namespace {

float tent(float weight, float peak) {
    const float rise = weight / peak;
    const float fall = peak < 1 ? (1 - weight) / (1 - peak) : 1;
    return std::clamp(std::min(rise, fall), 0.0f, 1.0f);
}

bool has_drivers(const MorphTarget& target) {
    return !target.drivers.empty();
}

/// `weights`: of a character; those of `targets` begin at `first`.
void drive(std::span<const MorphTarget> targets, std::size_t first, std::vector<float>& weights) {
    if (weights.size() <= first) {
        return;
    }
    const std::span<float> own = std::span(weights).subspan(first);
    for (std::size_t t = 0; t < std::min(targets.size(), own.size()); ++t) {
        if (has_drivers(targets[t])) {
            own[t] = driven_weight(targets[t].drivers, own);
        }
    }
}

/// Shapes jump with their drivers.
void drive_jumps(std::span<const MorphTarget> targets, std::size_t first, MorphWeights& morph) {
    if (morph.jumps.empty()) {
        return;
    }
    std::vector<float> before = morph.previous;
    for (const ValueJump<float>& jump : morph.jumps) {
        before[jump.index] = jump.before;
    }
    drive(targets, first, before);
    const float at = morph.jumps.front().at;
    for (std::size_t t = first; t < std::min(first + targets.size(), before.size()); ++t) {
        if (has_drivers(targets[t - first]) && before[t] != morph.previous[t]
            && std::ranges::find(morph.jumps, t, &ValueJump<float>::index) == morph.jumps.end()) {
            morph.jumps.push_back({static_cast<std::uint16_t>(t), at, before[t]});
        }
    }
    std::ranges::sort(morph.jumps, {}, &ValueJump<float>::index);
}

}  // namespace

float driven_weight(std::span<const ShapeDriver> drivers, std::span<const float> weights) {
    float product = 1;
    for (const ShapeDriver& driver : drivers) {
        const float weight = driver.target < weights.size() ? weights[driver.target] : 0.0f;
        product *= weight > 0 ? tent(weight, driver.peak) : 0.0f;  // NaN: 0
    }
    return product;
}

void update_driven_shapes(
    Query<const Deformed, const MeshInstance> meshes, Query<MorphWeights> faces,
    Res<const Assets> assets) {
    meshes.each([&](const Deformed& deformed, const MeshInstance& instance) {
        if (instance.mesh.index >= assets->meshes.size()) {
            return;
        }
        const std::span<const MorphTarget> targets = assets->meshes[instance.mesh.index].morphs;
        if (std::ranges::none_of(targets, has_drivers)) {
            return;
        }
        if (MorphWeights* const morph = faces.find<MorphWeights>(deformed.character)) {
            drive(targets, deformed.first_morph, morph->weights);
            drive(targets, deformed.first_morph, morph->previous);
            drive_jumps(targets, deformed.first_morph, *morph);
        }
    });
}

}  // namespace limn
