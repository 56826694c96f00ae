#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limn {

// Films by the program ffmpeg: H.264 in MP4 and Matroska, VP9 in WebM, GIF. Frames go to it through
// a pipe; the film is written under a hidden name beside its own and renamed when it is whole.
//
// Colors are 4:2:0 of BT.709 in limited range, and tagged so; frames of odd size get their last
// column or row twice.

enum class FilmKind : std::uint8_t { Mp4, WebM, Mkv, Gif };

/// By the file name's extension in any case; none for others.
[[nodiscard]] std::optional<FilmKind> film_kind(std::string_view path);

struct FilmSettings {
    double fps = 60;    ///< frames per second, > 0
    int quality = 85;   ///< 0 .. 100: smallest file .. no visible loss
    std::string sound;  ///< a sound file that plays with the film, cut or padded to its length;
                        ///< empty: silent
    double sound_start = 0;  ///< what of the sound is left out before the film begins [s], >= 0
};

/// Fails, before anything is rendered, where the film cannot be made: no such folder, no ffmpeg, no
/// sound file, a GIF with sound.
[[nodiscard]] Status check_film(const std::string& path, const FilmSettings& settings);

class FilmWriter {
  public:
    /// Starts the encoder for `frames` frames of `size`.
    [[nodiscard]] static Result<std::unique_ptr<FilmWriter>>
    open(const std::string& path, const IVec2& size, int frames, const FilmSettings& settings);
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;
    /// Without finish(): stops the encoder, leaves nothing.
    ~FilmWriter();

    /// `rgba`: 4 bytes a pixel, sRGB, rows from top to bottom; alpha is ignored. Waits while the
    /// encoder is busy.
    [[nodiscard]] Status add(std::span<const std::uint8_t> rgba);

    /// Waits for the encoder and gives the film its name. Fails with the last line that ffmpeg
    /// printed.
    [[nodiscard]] Status finish();

  private:
    FilmWriter() = default;
    [[nodiscard]] Error stop();

    std::string path_;
    std::string partial_;  ///< the film while it is made
    std::string log_;      ///< what ffmpeg prints
    IVec2 size_ = {0, 0};
    std::vector<std::uint8_t> row_bytes_;  ///< a frame of even size, RGB
    int pipe_ = -1;
    int process_ = -1;
};

}  // namespace limn
