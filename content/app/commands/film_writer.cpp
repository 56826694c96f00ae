#include "content/app/commands/film_writer.h"

#include "content/app/commands/image_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

extern char** environ;  // NOLINT: of POSIX

namespace limn {
namespace {

constexpr double kGifRate =
    50;  // delays of a GIF are hundredths of a second; viewers slow those below 2 down

struct FilmEnding {
    const char* text;
    FilmKind kind;
};
constexpr FilmEnding kFilmEndings[] = {
    {".mp4", FilmKind::Mp4},
    {".webm", FilmKind::WebM},
    {".mkv", FilmKind::Mkv},
    {".gif", FilmKind::Gif}};

/// Starts ffmpeg, found in PATH, with `input` as its standard input. 0 and errno where it cannot
/// be.
pid_t start_ffmpeg(std::vector<std::string> arguments, int input, const std::string& log) {
    arguments.insert(arguments.begin(), "ffmpeg");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (input >= 0) {
        posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    } else {
        posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    }
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(
        &actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    std::vector<char*> words;
    for (std::string& argument : arguments) {
        words.push_back(argument.data());
    }
    words.push_back(nullptr);
    pid_t process = 0;
    errno = posix_spawnp(&process, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    return errno == 0 ? process : 0;
}

bool has_ffmpeg() {
    const pid_t process = start_ffmpeg({"-version"}, -1, "/dev/null");
    int status = 1;
    return process > 0 && waitpid(process, &status, 0) == process && status == 0;
}

/// Constant rate factor of an encoder whose values are `best` at quality 100 and `worst` at 0.
std::string rate_factor(int quality, double best, double worst) {
    const double share = std::clamp(quality, 0, 100) / 100.0;
    return fmt::format("{:.0f}", worst + (best - worst) * share);
}

std::vector<std::string> encoder_options(FilmKind kind, const FilmSettings& settings) {
    const std::string to_video =
        "scale=in_range=full:out_range=limited:out_color_matrix=bt709:flags=bicubic+accurate_rnd"
        "+full_chroma_int+full_chroma_inp,format=yuv420p";
    std::vector<std::string> options;
    if (kind == FilmKind::Gif) {
        const std::string rate = settings.fps > kGifRate ? fmt::format("fps={},", kGifRate) : "";
        return {
            "-filter_complex",
            rate
                + "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=sierra2_4a",
            "-loop", "0"};
    }
    if (kind == FilmKind::WebM) {
        options = {"-c:v",      "libvpx-vp9", "-crf",      rate_factor(settings.quality, 10, 60),
                   "-b:v",      "0",          "-deadline", "good",
                   "-cpu-used", "4",          "-row-mt",   "1"};
    } else {
        options = {"-c:v",   "libx264", "-preset",
                   "medium", "-crf",    rate_factor(settings.quality, 12, 45)};
    }
    for (const char* const option :
         {"-vf", to_video.c_str(), "-color_range", "tv", "-colorspace", "bt709", "-color_primaries",
          "bt709", "-color_trc", "bt709"}) {
        options.emplace_back(option);
    }
    if (kind == FilmKind::Mp4) {
        options.insert(options.end(), {"-movflags", "+faststart"});
    }
    return options;
}

/// Of even size.
IVec2 encoded_size(const IVec2& size, FilmKind kind) {
    return kind == FilmKind::Gif ? size : IVec2((size.x + 1) / 2 * 2, (size.y + 1) / 2 * 2);
}

std::vector<std::string> ffmpeg_arguments(
    const std::string& out, FilmKind kind, const IVec2& size, int frames,
    const FilmSettings& settings) {
    const std::string rate = fmt::format("{:.9g}", settings.fps);
    std::vector<std::string> arguments = {
        "-hide_banner",
        "-loglevel",
        "error",
        "-y",
        "-f",
        "rawvideo",
        "-pixel_format",
        "rgb24",
        "-video_size",
        fmt::format("{}x{}", size.x, size.y),
        "-framerate",
        rate,
        "-i",
        "pipe:0"};
    if (!settings.sound.empty()) {
        arguments.insert(
            arguments.end(),
            {"-ss", fmt::format("{:.6f}", settings.sound_start), "-i", "file:" + settings.sound,
             "-map", "0:v", "-map", "1:a", "-af", "apad"});
        arguments.insert(
            arguments.end(), {"-c:a", kind == FilmKind::WebM ? "libopus" : "aac", "-b:a", "192k",
                              "-ar", "48000", "-t", fmt::format("{:.6f}", frames / settings.fps)});
    }
    const std::vector<std::string> encoder = encoder_options(kind, settings);
    arguments.insert(arguments.end(), encoder.begin(), encoder.end());
    arguments.push_back("file:" + out);
    return arguments;
}

std::string last_line(const std::string& file) {
    std::ifstream stream(file);
    std::string last;
    for (std::string line; std::getline(stream, line);) {
        last = line.empty() ? last : line;
    }
    return last;
}

}  // namespace

std::optional<FilmKind> film_kind(std::string_view path) {
    for (const FilmEnding& ending : kFilmEndings) {
        if (has_extension(path, ending.text)) {
            return ending.kind;
        }
    }
    return std::nullopt;
}

Status check_film(const std::string& path, const FilmSettings& settings) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code ignored;
    if (!folder.empty() && !std::filesystem::is_directory(folder, ignored)) {
        return fail("{}: found no folder {}, expected one", path, folder.string());
    }
    if (!settings.sound.empty() && film_kind(path) == FilmKind::Gif) {
        return fail("{}: found a GIF, expected .mp4, .webm or .mkv with --sound", path);
    }
    if (!settings.sound.empty() && !std::filesystem::is_regular_file(settings.sound, ignored)) {
        return fail("{}: found no such file, expected a sound", settings.sound);
    }
    if (!has_ffmpeg()) {
        return fail(
            "{}: found no program ffmpeg, which makes films; expected it to be installed (Debian: "
            "apt install ffmpeg)",
            path);
    }
    return Done{};
}

Result<std::unique_ptr<FilmWriter>> FilmWriter::open(
    const std::string& path, const IVec2& size, int frames, const FilmSettings& settings) {
    const std::optional<FilmKind> kind = film_kind(path);
    if (!kind) {
        return fail(
            "{}: found no film, expected a name that ends in .mp4, .webm, .mkv or .gif", path);
    }
    const std::filesystem::path place(path);
    std::unique_ptr<FilmWriter> film(new FilmWriter);
    film->path_ = path;
    film->size_ = size;
    const IVec2 encoded = encoded_size(size, *kind);
    film->row_bytes_.resize(
        std::size_t{3} * static_cast<std::size_t>(encoded.x) * static_cast<std::size_t>(encoded.y));
    const std::string hidden = fmt::format(".{}.{}.partial", place.stem().string(), getpid());
    film->partial_ = (place.parent_path() / (hidden + place.extension().string())).string();
    film->log_ = (place.parent_path() / (hidden + ".log")).string();
    std::array<int, 2> ends{};
    // A socket, not a pipe: a write to an encoder that has ended fails instead of raising a signal.
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return fail("{}: {}", path, std::strerror(errno));
    }
    film->pipe_ = ends[0];
    film->process_ = start_ffmpeg(
        ffmpeg_arguments(film->partial_, *kind, encoded, frames, settings), ends[1], film->log_);
    const int error = errno;
    close(ends[1]);
    if (film->process_ <= 0) {
        return fail("{}: ffmpeg: {}", path, std::strerror(error));
    }
    return film;
}

FilmWriter::~FilmWriter() {
    if (process_ > 0) {
        kill(process_, SIGKILL);
        (void)stop();
    }
}

Status FilmWriter::add(std::span<const std::uint8_t> rgba) {
    const auto width = static_cast<std::size_t>(size_.x);
    const auto height = static_cast<std::size_t>(size_.y);
    if (rgba.size() != 4 * width * height) {
        return fail(
            "{}: found a frame of {} bytes, expected {}x{} pixels", path_, rgba.size(), width,
            height);
    }
    const std::size_t encoded_width =
        row_bytes_.size() / 3 > width * height ? width + width % 2 : width;
    const std::size_t encoded_height = row_bytes_.size() / 3 / encoded_width;
    std::size_t at = 0;
    for (std::size_t y = 0; y < encoded_height; ++y) {
        for (std::size_t x = 0; x < encoded_width; ++x) {
            const std::size_t pixel = std::min(y, height - 1) * width + std::min(x, width - 1);
            for (std::size_t c = 0; c < 3; ++c) {
                row_bytes_[at++] = rgba[4 * pixel + c];
            }
        }
    }
    for (std::size_t sent = 0; sent < row_bytes_.size();) {
        const ssize_t count =
            send(pipe_, row_bytes_.data() + sent, row_bytes_.size() - sent, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) {
            continue;
        }
        if (count <= 0) {
            return stop();
        }
        sent += static_cast<std::size_t>(count);
    }
    return Done{};
}

Error FilmWriter::stop() {
    close(std::exchange(pipe_, -1));
    int status = 0;
    waitpid(std::exchange(process_, -1), &status, 0);
    const std::string said = last_line(log_);
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    std::filesystem::remove(log_, ignored);
    return fail("{}: ffmpeg failed: {}", path_, said.empty() ? "it printed no reason" : said);
}

Status FilmWriter::finish() {
    close(std::exchange(pipe_, -1));
    int status = 0;
    const bool ended = waitpid(process_, &status, 0) == process_;
    const bool is_whole = ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    process_ = -1;
    std::error_code error;
    if (is_whole) {
        std::filesystem::rename(partial_, path_, error);
    }
    const std::string said = is_whole && error ? error.message() : last_line(log_);
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    std::filesystem::remove(log_, ignored);
    if (!is_whole || error) {
        return fail("{}: ffmpeg failed: {}", path_, said.empty() ? "it printed no reason" : said);
    }
    return Done{};
}

}  // namespace limn
