#pragma once

#include "content/app/commands/command_entry.h"
#include "content/app/commands/film_command.h"
#include "content/app/commands/render_command.h"
#include "content/app/commands/view_command.h"

namespace limn {

// The options of commands that make images and films.

/// What `limn render` and `limn farm` have in common: scene, size, rate, samples, fields to set,
/// camera, film; not which frames, and where.
void add_render_options(CLI::App& app, RenderOptions& options);

[[nodiscard]] Command add_render(CLI::App& program, RenderOptions& options);
[[nodiscard]] Command add_film_command(CLI::App& program, FilmOptions& options);
[[nodiscard]] Command add_view(CLI::App& program, ViewOptions& options);

}  // namespace limn
