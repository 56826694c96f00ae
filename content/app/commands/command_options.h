#pragma once

#include "content/app/commands/command_values.h"
#include "content/load/model_view.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "render/gpu/device_caps.h"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace limn {

// Options that several commands have. Invalid values are wrong usage.

/// An option whose value `parse` checks; values that it rejects are wrong usage.
template <typename T, typename Parse>
CLI::Option*
add_parsed(CLI::App& app, const std::string& name, const std::string& doc, T& target, Parse parse) {
    CLI::Option* option = app.add_option_function<std::string>(
        name,
        [&target, parse, name](const std::string& text) {
            auto value = parse(text);
            if (!value) {
                const std::size_t dashes = name.find("--");  // none: a positional one
                throw CLI::ValidationError(
                    name.substr(dashes == std::string::npos ? 0 : dashes), value.error().message);
            }
            target = static_cast<T>(*std::move(value));
        },
        doc);
    return option;
}

/// An integer in min .. max.
template <typename T>
CLI::Option* add_integer(
    CLI::App& app, const std::string& name, const std::string& doc, T& target, std::int64_t min,
    std::int64_t max) {
    return add_parsed(
               app, name, doc, target,
               [min, max](const std::string& text) { return parse_integer(text, min, max); })
        ->type_name("N");
}

/// A number in min .. max.
template <typename T>
CLI::Option* add_number(
    CLI::App& app, const std::string& name, const std::string& doc, T& target, double min,
    double max) {
    return add_parsed(
               app, name, doc, target,
               [min, max](const std::string& text) { return parse_number(text, min, max); })
        ->type_name("X");
}

/// --size of an image.
CLI::Option* add_size(CLI::App& app, IVec2& size);

/// A name of a PNG file.
[[nodiscard]] Result<std::string> parse_png_path(const std::string& text);

/// --seed of all random numbers.
CLI::Option* add_seed(CLI::App& app, std::optional<std::uint64_t>& seed);

/// --set of fields, or an option `name` with the help `doc`; may be repeated.
void add_assignments(
    CLI::App& app, std::vector<Assignment>& assignments, const std::string& name = "--set",
    const std::string& doc = "change a field after loading");

/// --profile of the device, and --renderer.
void add_profile(CLI::App& app, std::optional<gpu::Profile>& profile, std::string& renderer);

/// --show of a technique.
CLI::Option* add_show(CLI::App& app, std::string& technique);

/// How a single model is displayed.
void add_model_view(CLI::App& app, ModelViewOptions& options);

}  // namespace limn
