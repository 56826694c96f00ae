#pragma once

#include "bench/oracles/image_compare.h"
#include "content/app/headless.h"
#include "ecs/base/result.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// What `limn quality` is made of: every effect of the engine beside its oracle, in numbers with the
// bounds that must hold (design 7) and in pictures. An effect is a function in
// content/app/quality_<effect>.cpp and a line of the table in quality.cpp.

/// How the number found is held against its limit.
enum class QualityBound : std::uint8_t {
    AtMost,
    AtLeast,
    None,  ///< told, not judged
};

struct QualityRow {
    std::string name;  ///< what was measured, in words
    double found = 0;
    QualityBound bound = QualityBound::None;
    double limit = 0;
    std::string unit = {};  ///< "", "%", "dB", "px" ...
};

/// False if the bound is not kept; numbers that are none (NaN) keep no bound.
[[nodiscard]] bool holds(const QualityRow& row);

/// The effect and what the oracle says, of equal size and as a screen shows them. An oracle without
/// pixels: the effect alone, to be looked at.
struct QualityPicture {
    std::string title;
    ColorImage effect;
    ColorImage oracle = {};
};

struct QualityReport {
    std::vector<QualityRow> rows;
    std::vector<QualityPicture> pictures;
};

/// Fails only where nothing could be measured.
using MeasureQuality = Result<QualityReport> (*)(HeadlessRenderer& headless);

struct QualityEffect {
    std::string_view name;    ///< as it is asked for
    std::string_view oracle;  ///< what it is held against, a sentence
    MeasureQuality measure;
};

/// All there are, in the order of the page.
[[nodiscard]] std::span<const QualityEffect> quality_effects();

/// A report with the effect it is of.
struct MeasuredQuality {
    const QualityEffect* effect = nullptr;
    QualityReport report;
};

/// For people: a line a row, those that do not hold marked.
[[nodiscard]] std::string quality_table(std::span<const MeasuredQuality> measured);
/// {"gl": ..., "effects": [{"name", "rows": [{"name", "found", "bound", "limit", "unit",
/// "holds"}]}]}
[[nodiscard]] std::string
quality_json(std::span<const MeasuredQuality> measured, std::string_view gl_renderer);
/// A page of its own: numbers, and effect, oracle and difference side by side.
[[nodiscard]] Result<std::string>
quality_html(std::span<const MeasuredQuality> measured, std::string_view gl_renderer);

}  // namespace limn
