#include "content/app/commands/command_options.h"

#include "content/app/commands/image_file.h"
#include "render/render_profile.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace limn {

CLI::Option* add_size(CLI::App& app, IVec2& size) {
    return add_parsed(app, "--size", "of the image [px]", size, parse_size)
        ->type_name("WxH")
        ->default_str(fmt::format("{}x{}", size.x, size.y));
}

Result<std::string> parse_png_path(const std::string& text) {
    const Result<ImageFileKind> kind = image_file_kind(text);
    if (!kind || *kind != ImageFileKind::Png) {
        return Error{fmt::format("found \"{}\", expected a file name ending in .png", text)};
    }
    return text;
}

CLI::Option* add_seed(CLI::App& app, std::optional<std::uint64_t>& seed) {
    return add_integer(
        app, "--seed", "seed of all random numbers; overrides the level's", seed, 0,
        std::numeric_limits<std::int64_t>::max());
}

void add_assignments(
    CLI::App& app, std::vector<Assignment>& assignments, const std::string& name,
    const std::string& doc) {
    app.add_option_function<std::vector<std::string>>(
           name,
           [&assignments, name](const std::vector<std::string>& texts) {
               for (const std::string& text : texts) {
                   Result<Assignment> assignment = parse_assignment(text);
                   if (!assignment) {
                       throw CLI::ValidationError(name, assignment.error().message);
                   }
                   assignments.push_back(*std::move(assignment));
               }
           },
           doc + "; may be repeated")
        ->type_name("PATH=VALUE")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_profile(CLI::App& app, std::optional<gpu::Profile>& profile, std::string& renderer) {
    add_parsed(
        app, "--profile",
        "render as on a GPU or as on software OpenGL; default: chosen by the device", profile,
        parse_profile)
        ->type_name("gpu|software");
    std::string names;
    std::string docs;
    std::vector<std::string> known;
    for (const RenderProfile& each : render_profiles()) {
        known.emplace_back(each.name);
        names += fmt::format("{}{}", names.empty() ? "" : "|", each.name);
        docs += fmt::format("{}{}: {}", docs.empty() ? "" : "; ", each.name, each.doc);
    }
    app.add_option("--renderer", renderer, docs + "; default: the first that the device can run")
        ->type_name(names)
        ->check([names = std::vector<std::string>(known)](const std::string& text) {
            return std::ranges::find(names, text) != names.end()
                       ? std::string()
                       : fmt::format("found {}, expected one of {}", text, fmt::join(names, " "));
        });
}

CLI::Option* add_show(CLI::App& app, std::string& technique) {
    return app
        .add_option(
            "--show", technique,
            "show a technique of TECHNIQUES.md (`limn shows`); SCENE may be left out")
        ->type_name("ID");
}

void add_model_view(CLI::App& app, ModelViewOptions& options) {
    app.add_option(
           "--backdrop", options.backdrop,
           "of a model: studio, sky, gray, black, or an image, a panorama that lights it")
        ->type_name("NAME|IMAGE");
    add_number(
        app, "--turntable", "of a model: seconds per full turn", options.turntable, 0.1, 3600)
        ->type_name("SECONDS");
    app.add_option(
           "--variant", options.variant,
           "of a glTF model: a variant of its materials, which `limn info` lists")
        ->type_name("NAME");
    app.add_flag(
        "--wrinkles,!--no-wrinkles", options.wrinkles,
        "of a face from limn import: folds where its shapes compress the skin (default)");
    app.add_flag(
        "--strict", options.load.strict,
        "of a model: fail on a bad part, which otherwise is skipped with a warning");
}

}  // namespace limn
