#include "content/app/quality_command.h"

#include "content/app/progress.h"
#include "content/app/quality.h"
#include "content/load/atomic_file.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace limn {
namespace {

/// All effects, or the one of that name.
Result<std::vector<const QualityEffect*>> choose_effects(const std::string& name) {
    std::vector<const QualityEffect*> chosen;
    std::vector<std::string> names;
    for (const QualityEffect& effect : quality_effects()) {
        names.emplace_back(effect.name);
        if (name.empty() || effect.name == name) {
            chosen.push_back(&effect);
        }
    }
    if (chosen.empty()) {
        const std::string nearest = nearest_name(name, names);
        return fail(
            "found effect \"{}\", expected one of {}{}", name, join_text(names, " "),
            nearest.empty() ? "" : ", perhaps " + nearest);
    }
    return chosen;
}

}  // namespace

Status run_quality(const QualityOptions& options) {
    const auto effects = choose_effects(options.effect);
    if (!effects) {
        return effects.error();
    }
    Result<HeadlessRenderer> headless = create_headless_renderer();
    if (!headless) {
        return headless.error();
    }
    std::vector<MeasuredQuality> measured;
    std::size_t missed = 0;
    {
        Progress progress("effect", static_cast<int>(effects->size()));
        for (const QualityEffect* effect : *effects) {
            Result<QualityReport> report = effect->measure(*headless);
            if (!report) {
                return fail("{}: {}", effect->name, report.error().message);
            }
            for (const QualityRow& row : report->rows) {
                missed += holds(row) ? 0 : 1;
            }
            measured.push_back({effect, *std::move(report)});
            progress.update(static_cast<int>(measured.size()));
        }
    }
    fmt::print("{}", quality_table(measured));
    const std::string& renderer = headless->device->caps().renderer;
    if (!options.json.empty()) {
        const Status written = write_file(options.json, quality_json(measured, renderer));
        if (!written) {
            return written.error();
        }
    }
    if (!options.html.empty()) {
        const Result<std::string> page = quality_html(measured, renderer);
        if (!page) {
            return page.error();
        }
        const Status written = write_file(options.html, *page);
        if (!written) {
            return written.error();
        }
    }
    if (missed > 0) {
        return fail("limn quality: found {} numbers outside their bounds, expected none", missed);
    }
    return Done{};
}

}  // namespace limn
