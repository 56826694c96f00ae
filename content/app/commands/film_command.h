#pragma once

#include "content/app/commands/command_values.h"
#include "content/app/commands/film_writer.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

/// `limn film`: makes a film of numbered images.
struct FilmOptions {
    std::string frames;               ///< a name with %04d
    std::string out;                  ///< .mp4, .webm, .mkv or .gif
    std::optional<FrameRange> range;  ///< empty: all that exist
    FilmSettings film;
    bool quiet = false;  ///< prints nothing but errors
};

/// The files of a range, or all that exist, in order. Fails with the first number that is missing.
[[nodiscard]] Result<std::vector<std::string>>
find_frame_files(const std::string& pattern, const std::optional<FrameRange>& range);

/// Makes a film of images of one size. PNGs are shown as they are, EXRs tone mapped as `limn view`
/// does.
[[nodiscard]] Status make_film(
    const std::vector<std::string>& files, const std::string& out, const FilmSettings& settings,
    bool quiet);

/// Errors are wrong usage.
[[nodiscard]] Status check_film_options(const FilmOptions& options);

[[nodiscard]] Status run_film(const FilmOptions& options);

}  // namespace limn
