#pragma once

#include "content/app/commands/headless.h"
#include "content/bake/image_compare.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// The parts of `limn-quality`, the program that `limn quality` starts: every effect of the engine
// compared with its oracle, as numbers with bounds that must hold (design 7) and as images. An
// effect is one file, bench/quality/<effect>_quality.cpp, which registers its measurement:
//
//     Status measure_frost(HeadlessRenderer& headless, QualityReport& report);
//     const RegisterQuality kRegistered("frost", "what it is compared with", measure_frost);

/// How a measured value is compared with its limit.
enum class QualityBound : std::uint8_t {
    AtMost,
    AtLeast,
    None,  ///< reported only
};

struct QualityRow {
    std::string name;  ///< what was measured, in words
    double found = 0;
    QualityBound bound = QualityBound::None;
    double limit = 0;
    std::string unit = {};  ///< "", "%", "dB", "px" ...
};

/// False if the bound is violated; NaN violates every bound.
[[nodiscard]] bool holds(const QualityRow& row);

/// The effect's image and the oracle's, of equal size, display-encoded. If the oracle's has no
/// pixels, the effect's image is shown alone, for inspection.
struct QualityImage {
    std::string title;
    ColorImage effect;
    ColorImage oracle = {};
};

struct QualityReport {
    std::vector<QualityRow> rows;
    std::vector<QualityImage> images;
    std::string html = {};  ///< additional sections of the page for this effect

    // Each adds one row.
    void at_most(std::string name, double found, double limit, std::string unit = {});
    void at_least(std::string name, double found, double limit, std::string unit = {});
    void inform(std::string name, double found, std::string unit = {});  ///< without a bound
};

/// Fails only if nothing could be measured.
using MeasureQuality = Status (*)(HeadlessRenderer& headless, QualityReport& report);

/// Measures a model that the user provides.
using MeasureFile = Status (*)(const std::string& path, QualityReport& report);

struct QualityEffect {
    std::string_view name;    ///< as on the command line
    std::string_view oracle;  ///< what it is compared with, in words
    MeasureQuality measure;
    MeasureFile measure_file = nullptr;  ///< null: accepts no models
};

/// Registers an effect; define one at namespace scope.
struct RegisterQuality {
    RegisterQuality(
        std::string_view name, std::string_view oracle, MeasureQuality measure,
        MeasureFile measure_file = nullptr);
};

/// All registered effects, by name.
[[nodiscard]] std::span<const QualityEffect> quality_effects();

/// An effect with its report.
struct MeasuredQuality {
    const QualityEffect* effect = nullptr;
    QualityReport report;
};

/// A text table, one line per row; violated bounds are marked.
[[nodiscard]] std::string quality_table(std::span<const MeasuredQuality> measured);
/// {"gl": ..., "effects": [{"name", "rows": [{"name", "found", "bound", "limit", "unit",
/// "holds"}]}]}
[[nodiscard]] std::string
quality_json(std::span<const MeasuredQuality> measured, std::string_view gl_renderer);
/// A self-contained page: numbers, then effect, oracle and difference side by side.
[[nodiscard]] Result<std::string>
quality_html(std::span<const MeasuredQuality> measured, std::string_view gl_renderer);

/// Escapes text for the content of an element or an attribute.
[[nodiscard]] std::string escape_html(std::string_view text);

/// An element with a display-encoded image in it, as PNG, above its caption.
[[nodiscard]] Result<std::string> image_tag(const ColorImage& image, std::string_view caption);

}  // namespace limn
