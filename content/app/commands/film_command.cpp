#include "content/app/commands/film_command.h"

#include "content/app/commands/hdr_image.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/progress.h"
#include "content/app/commands/view_command.h"
#include "content/load/files/image_load.h"
#include "ecs/base/text.h"
#include "ecs/components/surface.h"
#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/gpu/readback.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

namespace limn {
namespace {

/// A frame as a display shows it: RGBA, rows from top to bottom.
struct FilmFrame {
    IVec2 size = {0, 0};
    std::vector<std::uint8_t> rgba;
};

/// Reads frames; has an OpenGL context as soon as one is to be tone mapped.
class FrameReader {
  public:
    Result<FilmFrame> read(const std::string& path) {
        if (has_extension(path, ".exr")) {
            return tone_map(path);
        }
        ImageData image = LIMN_TRY(load_image(path, true));
        if (image.format != PixelFormat::Rgba8) {
            return fail("{}: found more than 8 bits, expected 8, or an EXR", path);
        }
        return FilmFrame{{image.width, image.height}, std::move(image.pixels)};
    }

  private:
    Result<FilmFrame> tone_map(const std::string& path) {
        if (device_ == nullptr) {
            context_ = LIMN_TRY(gpu::create_headless_context());
            device_ = LIMN_TRY(gpu::Device::from_current_context());
        }
        const std::unique_ptr<HdrImage> hdr = LIMN_TRY(HdrImage::load(*device_, path));
        const gpu::ByteImage image = gpu::read_bytes(hdr->show(exposure_of_file(path)));
        FilmFrame frame = {{image.width, image.height}, {}};
        for (std::size_t i = 0; i < image.pixels.size();
             i += static_cast<std::size_t>(image.channels)) {
            frame.rgba.insert(
                frame.rgba.end(), {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2], 255});
        }
        return frame;
    }

    std::unique_ptr<gpu::Context> context_;
    std::unique_ptr<gpu::Device> device_;
};

/// The number of a file of the pattern.
std::optional<int> frame_number(const std::string& pattern, const std::string& path) {
    const std::size_t first = pattern.find('%');
    int number = 0;
    const auto parsed = std::from_chars(
        path.data() + std::min(first, path.size()), path.data() + path.size(), number);
    if (parsed.ec != std::errc() || number < 0 || numbered_path(pattern, number) != path) {
        return std::nullopt;
    }
    return number;
}

}  // namespace

Result<std::vector<std::string>>
find_frame_files(const std::string& pattern, const std::optional<FrameRange>& range) {
    const std::filesystem::path folder = std::filesystem::path(pattern).parent_path();
    std::vector<int> numbers;
    std::error_code error;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder.empty() ? "." : folder, error)) {
        const std::string path = (folder / entry.path().filename()).string();
        if (const std::optional<int> number = frame_number(pattern, path)) {
            numbers.push_back(*number);
        }
    }
    std::ranges::sort(numbers);
    if (numbers.empty()) {
        return fail("{}: found no such files, expected numbered images", pattern);
    }
    const FrameRange wanted = range.value_or(FrameRange{numbers.front(), numbers.back()});
    std::vector<std::string> files;
    for (int number = wanted.first; number <= wanted.last; ++number) {
        files.push_back(numbered_path(pattern, number));
        if (!std::ranges::binary_search(numbers, number)) {
            return fail(
                "{}: found no such file, expected all frames {}:{} (--frames A:B chooses some)",
                files.back(), wanted.first, wanted.last);
        }
    }
    return files;
}

Status make_film(
    const std::vector<std::string>& files, const std::string& out, const FilmSettings& settings,
    bool quiet) {
    FrameReader reader;
    std::unique_ptr<FilmWriter> film;
    IVec2 size = {0, 0};
    Progress progress("encoded frame", static_cast<int>(files.size()), !quiet);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const FilmFrame frame = LIMN_TRY(reader.read(files[i]));
        if (film == nullptr) {
            size = frame.size;
            film = LIMN_TRY(FilmWriter::open(out, size, static_cast<int>(files.size()), settings));
        }
        if (frame.size != size) {
            return fail(
                "{}: found {}x{}, expected {}x{} as the first frame", files[i], frame.size.x,
                frame.size.y, size.x, size.y);
        }
        LIMN_TRY(film->add(frame.rgba));
        progress.update(static_cast<int>(i + 1));
    }
    return film->finish();
}

Status check_film_options(const FilmOptions& options) {
    const Result<bool> numbered = has_frame_number(options.frames);
    if (!numbered) {
        return numbered.error();
    }
    if (!*numbered) {
        return fail("found \"{}\", expected %04d in it", options.frames);
    }
    LIMN_TRY(image_file_kind(options.frames));
    if (!film_kind(options.out)) {
        return fail("--out: found \"{}\", expected .mp4, .webm, .mkv or .gif", options.out);
    }
    return Done{};
}

Status run_film(const FilmOptions& options) {
    LIMN_TRY(check_film(options.out, options.film));
    const std::vector<std::string> files =
        LIMN_TRY(find_frame_files(options.frames, options.range));
    LIMN_TRY(make_film(files, options.out, options.film, options.quiet));
    if (!options.quiet) {
        fmt::print(
            "{}: {} frames, {:.3g} s\n", options.out, files.size(),
            static_cast<double>(files.size()) / options.film.fps);
    }
    return Done{};
}

}  // namespace limn
