// The program that `limn quality` starts.

#include "bench/parse_arguments.h"
#include "bench/quality/quality.h"
#include "content/app/commands/command_values.h"
#include "content/app/commands/log_sink.h"
#include "content/app/commands/progress.h"
#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limn {
namespace {

struct QualityOptions {
    std::string effect;                   ///< empty = all
    std::string file;                     ///< a model for `effect`; empty = its own
    std::string json;                     ///< file to write; empty = none
    std::string html;                     ///< file to write; empty = none
    bool list = false;                    ///< print the names of the effects, measure none
    std::optional<gpu::Profile> profile;  ///< empty = by the device
};

/// All effects, or the one with that name.
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
            nearest.empty() ? "" : " (did you mean " + nearest + "?)");
    }
    return chosen;
}

/// Fails for an unknown effect, and for a file if the effect has its own scenes.
Status check_options(const QualityOptions& options) {
    const auto effects = LIMN_TRY(choose_effects(options.effect));
    if (!options.file.empty() && effects[0]->measure_file == nullptr) {
        return fail(
            "found the file {} for {}, expected none: it has its own scenes", options.file,
            effects[0]->name);
    }
    return Done{};
}

/// Prints the table and writes the files; then fails if a bound is violated.
Status measure(const QualityOptions& options) {
    const auto effects = LIMN_TRY(choose_effects(options.effect));
    HeadlessRenderer headless = LIMN_TRY(create_headless_renderer(options.profile));
    std::vector<MeasuredQuality> measured;
    std::size_t missed = 0;
    {
        Progress progress("effect", static_cast<int>(effects.size()));
        for (const QualityEffect* effect : effects) {
            QualityReport report;
            const Status status = options.file.empty() ? effect->measure(headless, report)
                                                       : effect->measure_file(options.file, report);
            if (!status) {
                return fail("{}: {}", effect->name, status.error().message);
            }
            for (const QualityRow& row : report.rows) {
                missed += holds(row) ? 0 : 1;
            }
            measured.push_back({effect, std::move(report)});
            progress.update(static_cast<int>(measured.size()));
        }
    }
    fmt::print("{}", quality_table(measured));
    const std::string& renderer = headless.device->caps().renderer;
    if (!options.json.empty()) {
        LIMN_TRY(write_file(options.json, quality_json(measured, renderer)));
    }
    if (!options.html.empty()) {
        const std::string page = LIMN_TRY(quality_html(measured, renderer));
        LIMN_TRY(write_file(options.html, page));
    }
    if (missed > 0) {
        return fail("limn quality: found {} numbers outside their bounds, expected none", missed);
    }
    return Done{};
}

int run(int argc, char** argv) {
    log_through_spdlog();
    CLI::App program("Compare the effects with their oracles", "limn quality");
    program.get_formatter()->column_width(28);
    QualityOptions options;
    program.add_option("effect", options.effect, "name of an effect; default: all")
        ->type_name("EFFECT");
    program
        .add_option(
            "file", options.file,
            "a model to measure: glTF or Wavefront for fakephong, a glTF face for wrinkles")
        ->type_name("FILE");
    program
        .add_option_function<std::string>(
            "--profile",
            [&options](const std::string& text) {
                const Result<gpu::Profile> profile = parse_profile(text);
                if (!profile) {
                    throw CLI::ValidationError("--profile", profile.error().message);
                }
                options.profile = *profile;
            },
            "render as on a GPU or as on software OpenGL; default: chosen by the device")
        ->type_name("gpu|software");
    program.add_option("--json", options.json, "write the results")->type_name("FILE");
    program.add_option("--html", options.html, "write a page with images")->type_name("FILE");
    program.add_flag("--list", options.list, "print the names of all effects, measure none");
    program.callback([&options] {
        if (const Status fits = check_options(options); !fits) {
            throw CLI::ValidationError(fits.error().message);
        }
    });
    std::string names;
    for (const QualityEffect& effect : quality_effects()) {
        names += fmt::format("  {:<12}vs {}\n", effect.name, effect.oracle);
    }
    program.footer(
        "Each value is printed with its bound; the exit status is 1 if a bound is violated.\n\n"
        "Effects:\n"
        + names
        + "\nExample:\n"
          "  limn quality --html quality.html\n"
          "  limn quality fakephong model.glb --html model.html\n"
          "  limn quality wrinkles face.glb --html face.html");
    if (const auto stop = bench::parse_arguments(program, "limn quality", argc, argv)) {
        return *stop;
    }
    if (options.list) {
        for (const QualityEffect& effect : quality_effects()) {
            fmt::print("{}\n", effect.name);
        }
        return 0;
    }
    const Status status = measure(options);
    if (!status) {
        fmt::print(stderr, "{}\n", one_line(status.error().message));
        return 1;
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}

}  // namespace
}  // namespace limn

int main(int argc, char** argv) {
    return limn::run(argc, argv);
}
