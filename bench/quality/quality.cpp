#include "bench/quality/quality.h"

#include <algorithm>
#include <utility>

namespace limn {
namespace {

/// Filled before main() begins.
std::vector<QualityEffect>& registered_effects() {
    static std::vector<QualityEffect> effects;
    return effects;
}

}  // namespace

RegisterQuality::RegisterQuality(
    std::string_view name, std::string_view oracle, MeasureQuality measure,
    MeasureFile measure_file) {
    auto& effects = registered_effects();
    const auto after =
        std::find_if(effects.begin(), effects.end(), [name](const QualityEffect& other) {
            return other.name > name;
        });
    effects.insert(after, {name, oracle, measure, measure_file});
}

std::span<const QualityEffect> quality_effects() {
    return registered_effects();
}

bool holds(const QualityRow& row) {
    switch (row.bound) {
    case QualityBound::AtMost:
        return row.found <= row.limit;
    case QualityBound::AtLeast:
        return row.found >= row.limit;
    case QualityBound::None:
        return true;
    }
    return false;
}

void QualityReport::at_most(std::string name, double found, double limit, std::string unit) {
    rows.push_back({std::move(name), found, QualityBound::AtMost, limit, std::move(unit)});
}

void QualityReport::at_least(std::string name, double found, double limit, std::string unit) {
    rows.push_back({std::move(name), found, QualityBound::AtLeast, limit, std::move(unit)});
}

void QualityReport::inform(std::string name, double found, std::string unit) {
    rows.push_back({std::move(name), found, QualityBound::None, 0, std::move(unit)});
}

}  // namespace limn
