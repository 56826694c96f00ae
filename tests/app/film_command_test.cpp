// Films: what players are told about them, what they show, and how they fail. The test's own judge
// is ffprobe and ffmpeg.

#include "content/load/files/image_load.h"
#include "content/load/files/png_file.h"
#include "ecs/components/surface.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace limn::film_command_test {

using namespace limn::test;

namespace {

constexpr int kPatch = 16;  // side of a patch of the chart [pixels]
constexpr std::array<std::array<std::uint8_t, 3>, 8> kPatches = {
    {{0, 0, 0},
     {255, 255, 255},
     {255, 0, 0},
     {0, 255, 0},
     {0, 0, 255},
     {119, 119, 119},
     {200, 150, 90},
     {30, 60, 90}}};

/// A chart of patches, `width` pixels wide of which the last patch has what is left.
void write_chart(const std::string& path, int width = 8 * kPatch, int height = 2 * kPatch) {
    std::vector<std::uint8_t> pixels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (const std::uint8_t value :
                 kPatches[static_cast<std::size_t>(std::min(x / kPatch, 7))]) {
                pixels.push_back(value);
            }
        }
    }
    REQUIRE(write_png(path, width, height, 3, pixels).ok());
}

void write_charts(const TemporaryFolder& folder, int count) {
    for (int i = 0; i < count; ++i) {
        write_chart(folder.file(fmt::format("chart_{:03}.png", i)));
    }
}

/// What a shell command prints.
std::string shell(const std::string& command) {
    std::string text;
    FILE* const pipe = popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::array<char, 512> part{};
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe)) {
        text.append(part.data(), count);
    }
    pclose(pipe);
    return text;
}

std::string probe(const std::string& film, const std::string& entries) {
    return shell(fmt::format(
        "ffprobe -v error -count_frames -show_entries stream={} -of "
        "default=noprint_wrappers=1:nokey=1 '{}'",
        entries, film));
}

/// Largest difference of a patch's middle from its color, in the frame decoded as its tags say.
int chart_error(const TemporaryFolder& folder, const std::string& film) {
    const std::string decoded = folder.file("decoded.png");
    (void)shell(fmt::format(
        "ffmpeg -y -v error -i '{}' -vf scale=flags=accurate_rnd+full_chroma_int,format=rgb24 "
        "-frames:v 1 '{}'",
        film, decoded));
    const Result<ImageData> image = load_image(decoded, true);
    REQUIRE(image.ok());
    int worst = 0;
    for (std::size_t patch = 0; patch < kPatches.size(); ++patch) {
        const std::size_t x = patch * kPatch + kPatch / 2;
        const std::size_t at = 4 * (static_cast<std::size_t>(image->width) * kPatch + x);
        for (std::size_t c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(int{image->pixels[at + c]} - int{kPatches[patch][c]}));
        }
    }
    return worst;
}

/// A second of a tone, 8000 samples of 16 bits.
void write_tone(const std::string& path) {
    std::string bytes = "RIFF";
    const auto put = [&bytes](std::uint32_t value, int count) {
        for (int i = 0; i < count; ++i) {
            bytes.push_back(static_cast<char>(value >> 8 * i & 255));
        }
    };
    put(36 + 16000, 4);
    bytes += "WAVEfmt ";
    put(16, 4);
    put(1, 2);
    put(1, 2);
    put(8000, 4);
    put(16000, 4);
    put(2, 2);
    put(16, 2);
    bytes += "data";
    put(16000, 4);
    for (int i = 0; i < 8000; ++i) {
        put(static_cast<std::uint32_t>(static_cast<int>(9000 * std::sin(0.3 * i))), 2);
    }
    write_text(path, bytes);
}

std::vector<std::string>
read_frames(const TemporaryFolder& folder, const std::string& frames, int count) {
    std::vector<std::string> bytes;
    for (int i = 0; i < count; ++i) {
        bytes.push_back(read_text(folder.file(fmt::format("{}/frame_{:05}.png", frames, i))));
    }
    return bytes;
}

bool leaves_no_trace(const TemporaryFolder& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        if (entry.path().filename().string().starts_with(".")) {
            return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("film: of each kind has all frames, the rate, the size and the tags, and the colors of a "
          "chart") {
    const TemporaryFolder folder;
    write_charts(folder, 7);
    for (const char* const ending : {"mp4", "webm", "mkv"}) {
        CAPTURE(ending);
        const std::string film = folder.file(fmt::format("chart.{}", ending));
        const ProgramRun run =
            run_limn(folder, {"film", "chart_%03d.png", "-o", film, "--fps", "24"});
        CHECK(run.err == "");
        CHECK(run.out.find("7 frames, 0.292 s") != std::string::npos);
        CHECK(probe(film, "nb_read_frames") == "7\n");
        CHECK(probe(film, "r_frame_rate") == "24/1\n");
        CHECK(probe(film, "width,height") == "128\n32\n");
        CHECK(
            probe(film, "color_range,color_space,color_transfer,color_primaries")
            == "tv\nbt709\nbt709\nbt709\n");
        CHECK(chart_error(folder, film) <= 2);
    }
    const std::string gif = folder.file("chart.gif");
    CHECK(run_limn(folder, {"film", "chart_%03d.png", "-o", gif, "--fps", "20"}).err == "");
    CHECK(probe(gif, "nb_read_frames") == "7\n");
    CHECK(probe(gif, "r_frame_rate") == "20/1\n");
    CHECK(chart_error(folder, gif) <= 4);
    CHECK(leaves_no_trace(folder));
}

TEST_CASE("film: odd sizes get their last column and row twice") {
    const TemporaryFolder folder;
    write_chart(folder.file("odd_0.png"), 8 * kPatch - 1, 2 * kPatch - 1);
    CHECK(run_limn(folder, {"film", "odd_%d.png", "-o", "odd.mp4", "--quality", "100"}).err == "");
    CHECK(probe(folder.file("odd.mp4"), "width,height") == "128\n32\n");
    CHECK(chart_error(folder, folder.file("odd.mp4")) <= 2);
}

TEST_CASE("film: quality trades size, a range chooses frames") {
    const TemporaryFolder folder;
    for (int i = 0; i < 3; ++i) {
        REQUIRE(run_limn(
                    folder, {"render", "gallery", "-o", fmt::format("f_{}.png", i), "--size",
                             "160x90", "--time", fmt::format("{}", i), "--quiet"})
                    .err.empty());
    }
    CHECK(run_limn(folder, {"film", "f_%d.png", "-o", "low.mp4", "--quality", "20"}).err == "");
    CHECK(
        run_limn(
            folder, {"film", "f_%d.png", "-o", "high.mp4", "--quality", "95", "--frames", "1:2"})
            .err
        == "");
    CHECK(
        2 * std::filesystem::file_size(folder.file("low.mp4"))
        < std::filesystem::file_size(folder.file("high.mp4")));
    CHECK(probe(folder.file("high.mp4"), "nb_read_frames") == "2\n");
}

TEST_CASE("film: sound begins with the film and is cut or padded to its length") {
    const TemporaryFolder folder;
    write_charts(folder, 12);
    write_tone(folder.file("tone.wav"));
    for (const char* const ending : {"mp4", "webm", "mkv"}) {
        for (const char* const fps : {"24", "6"}) {  // half a second, two seconds
            CAPTURE(ending);
            CAPTURE(fps);
            const std::string film = folder.file(fmt::format("sound.{}", ending));
            const ProgramRun run = run_limn(
                folder,
                {"film", "chart_%03d.png", "-o", film, "--fps", fps, "--sound", "tone.wav"});
            CHECK(run.err == "");
            const std::string seconds =
                shell("ffprobe -v error -show_entries format=duration -of csv=p=0 " + film);
            CHECK(std::abs(std::atof(seconds.c_str()) - 12 / std::atof(fps)) < 0.1);
            CHECK(probe(film, "codec_type").find("audio") != std::string::npos);
            CHECK(probe(film, "nb_read_frames").starts_with("12\n"));
        }
    }
}

TEST_CASE(
    "film: those of render and of a farm have the same sound of the scene, from their frames") {
    const TemporaryFolder folder;
    write_tone(folder.file("tone.wav"));
    write_text(folder.file("bell.level.json"), R"({
      "title": "A bell",
      "entities": [
        {"name": "bell", "sound_player": {"file": "tone.wav", "start": 0.5}},
        {"name": "eye", "camera": {}}
      ]
    })");
    const std::vector<std::string> rest = {"bell.level.json", "--frames", "4:9", "--fps", "10",
                                           "--size",          "32x18",    "-o"};
    const auto film = [&](std::vector<std::string> command, const std::string& name) {
        command.insert(command.end(), rest.begin(), rest.end());
        command.push_back(name);
        CHECK(run_limn(folder, command).exit_code == 0);
        CHECK(probe(folder.file(name), "codec_type").find("audio") != std::string::npos);
        return shell(
            fmt::format("ffmpeg -v error -i '{}' -f s16le -ac 1 -ar 8000 -", folder.file(name)));
    };
    const std::string rendered = film({"render"}, "one.mp4");
    const std::string farmed = film({"farm", "local"}, "two.mp4");
    CHECK(rendered.size() > 7000);  // half a second
    REQUIRE(farmed.size() == rendered.size());
    const auto sample = [](const std::string& sound, std::size_t i) {
        const auto low = static_cast<std::uint8_t>(sound[2 * i]);
        const auto high = static_cast<std::int8_t>(sound[2 * i + 1]);
        return 256 * high + low;
    };
    // The farm's sound goes on after the film, for frames that may be added: AAC looks ahead at it.
    constexpr std::size_t kLookAhead = 8000 / 20;
    int largest = 0;
    for (std::size_t i = 0; i + kLookAhead < farmed.size() / 2; ++i) {
        largest = std::max(largest, std::abs(sample(farmed, i) - sample(rendered, i)));
    }
    CHECK(largest < 200);
    // Silent until the bell, a tenth of a second after frame 4.
    const auto loudness = [&](double begin, double end) {
        int loudest = 0;
        const auto last = static_cast<std::size_t>(8000 * end);
        for (auto i = static_cast<std::size_t>(8000 * begin); i < last; ++i) {
            loudest = std::max(loudest, std::abs(sample(farmed, i)));
        }
        return loudest;
    };
    CHECK(loudness(0, 0.07) < 100);
    CHECK(loudness(0.15, 0.4) > 1000);
    CHECK(shell("ls -A " + folder.file("two.mp4.farm")).find("scene.wav") == std::string::npos);

    // Frames with gaps have no sound to go with.
    CHECK(
        run_limn(
            folder, {"farm", "local", "bell.level.json", "--frames", "0,4", "--size", "32x18", "-o",
                     "gap.mp4"})
            .exit_code
        == 0);
    CHECK(probe(folder.file("gap.mp4"), "codec_type").find("audio") == std::string::npos);
}

TEST_CASE("film: render makes one, and goes on where it was stopped with the same bits") {
    const TemporaryFolder folder;
    const std::vector<std::string> command = {"render",   "gallery", "-o",           "g.mp4",
                                              "--frames", "0:5",     "--fps",        "12",
                                              "--size",   "96x54",   "--keep-frames"};
    CHECK(run_limn(folder, command).err == "");
    const std::vector<std::string> whole = read_frames(folder, "g.mp4.frames", 6);
    CHECK(probe(folder.file("g.mp4"), "nb_read_frames") == "6\n");
    // As if stopped: one is missing, one damaged, one of another size, no film.
    std::filesystem::remove(folder.file("g.mp4"));
    std::filesystem::remove(folder.file("g.mp4.frames/frame_00002.png"));
    std::filesystem::resize_file(folder.file("g.mp4.frames/frame_00003.png"), 300);
    write_chart(folder.file("g.mp4.frames/frame_00005.png"));
    const ProgramRun again = run_limn(folder, command);
    CHECK(again.err == "");
    CHECK(again.out.find("3 of 6 frames are there already") != std::string::npos);
    CHECK(read_frames(folder, "g.mp4.frames", 6) == whole);
    CHECK(probe(folder.file("g.mp4"), "nb_read_frames") == "6\n");

    std::vector<std::string> other = command;
    other[7] = "24";
    other[6] = "--fps";
    const ProgramRun refused = run_limn(folder, other);
    CHECK(refused.exit_code == 1);
    CHECK(
        refused.err.find("found frames of another render (fps: 12), expected fps: 24")
        != std::string::npos);
    CHECK(read_frames(folder, "g.mp4.frames", 6) == whole);

    std::vector<std::string> last = command;
    last.pop_back();
    CHECK(run_limn(folder, last).err == "");
    CHECK_FALSE(std::filesystem::exists(folder.file("g.mp4.frames")));
    CHECK(leaves_no_trace(folder));
}

TEST_CASE("film: EXRs look as the PNGs of the same frames") {
    const TemporaryFolder folder;
    for (const char* const name : {"f_%d.exr", "f_%d.png"}) {
        REQUIRE(
            run_limn(
                folder, {"render", "gallery", "-o", name, "--frames", "0:1", "--size", "96x54",
                         "--average", "light", "--quiet"})
                .exit_code
            == 0);
        REQUIRE(run_limn(folder, {"film", name, "-o", std::string(name).substr(5) + ".mkv"})
                    .err.empty());
    }
    const std::string difference = shell(fmt::format(
        "ffmpeg -v error -i '{}' -i '{}' -filter_complex psnr=stats_file=- -f null - | head -n 1",
        folder.file("exr.mkv"), folder.file("png.mkv")));
    const std::size_t at = difference.find("psnr_avg:");
    REQUIRE(at != std::string::npos);
    const std::string psnr = difference.substr(at + 9);
    CHECK((psnr.starts_with("inf") || std::atof(psnr.c_str()) > 45));
}

TEST_CASE("film: has the sounds of its scene, from the time of its first frame") {
    const TemporaryFolder folder;
    write_tone(folder.file("tone.wav"));
    write_text(folder.file("heard.level.json"), R"({
        "resources": {"environment": {"sky": "uniform"}},
        "entities": [
            {"name": "bell", "sound_player": {"file": "tone.wav", "start": 0.5}},
            {"name": "lost", "sound_player": {"file": "lost.wav"}}
        ]})");
    const ProgramRun run = run_limn(
        folder, {"render", "heard.level.json", "-o", "heard.mkv", "--frames", "3:14", "--fps", "10",
                 "--size", "64x36", "--quiet"});
    CHECK(run.exit_code == 0);
    CHECK(run.err.find("sound: ") != std::string::npos);
    CHECK(run.err.find("lost.wav: found no such file, expected a sound") != std::string::npos);
    CHECK(leaves_no_trace(folder));
    // The film begins at 0.3 s: 0.2 s of silence, then the tone of 1 s.
    const auto loudness = [&](double from, double seconds) {
        const std::string text = shell(fmt::format(
            "ffmpeg -v info -ss {} -t {} -i '{}' -af volumedetect -f null - 2>&1 | sed -n "
            "'s/.*mean_volume: \\(.*\\) dB/\\1/p'",
            from, seconds, folder.file("heard.mkv")));
        return std::atof(text.c_str());
    };
    CHECK(loudness(0, 0.15) < -60);
    CHECK(loudness(0.3, 0.8) > -20);
}

TEST_CASE("film: what cannot be made is told in one line and leaves nothing") {
    const TemporaryFolder folder;
    write_charts(folder, 3);
    write_tone(folder.file("tone.wav"));
    const auto error_of = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "film");
        const ProgramRun run = run_limn(folder, std::move(arguments));
        CHECK(run.exit_code != 0);
        CHECK(count_lines(run.err) == 1);
        CHECK(leaves_no_trace(folder));
        return run.err;
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(error_of({"chart.png", "-o", "a.mp4"}), "expected %04d"));
    CHECK(has(error_of({"chart_%03d.png", "-o", "a.avi"}), "expected .mp4, .webm, .mkv or .gif"));
    CHECK(has(error_of({"none_%03d.png", "-o", "a.mp4"}), "found no such files"));
    CHECK(has(error_of({"chart_%03d.png", "-o", "none/a.mp4"}), "found no folder none"));
    CHECK(has(error_of({"chart_%03d.png", "-o", "a.gif", "--sound", "tone.wav"}), "found a GIF"));
    CHECK(
        has(error_of({"chart_%03d.png", "-o", "a.mp4", "--sound", "none.wav"}),
            "none.wav: found no such file"));
    CHECK(
        has(error_of({"chart_%03d.png", "-o", "a.mp4", "--frames", "0:4"}),
            "chart_003.png: found no such file"));
    write_text(folder.file("noise.wav"), "this is no sound");
    CHECK(
        has(error_of({"chart_%03d.png", "-o", "a.mp4", "--sound", "noise.wav"}),
            "a.mp4: ffmpeg failed: "));
    write_chart(folder.file("chart_002.png"), 64, 16);
    CHECK(
        has(error_of({"chart_%03d.png", "-o", "a.mp4"}),
            "chart_002.png: found 64x16, expected 128x32"));
    write_text(folder.file("chart_002.png"), "");
    CHECK(has(error_of({"chart_%03d.png", "-o", "a.mp4"}), "chart_002.png: "));
    CHECK_FALSE(std::filesystem::exists(folder.file("a.mp4")));

    const std::string path = std::getenv("PATH");
    setenv("PATH", folder.path().c_str(), 1);
    const std::string missing = error_of({"chart_%03d.png", "-o", "a.mp4"});
    setenv("PATH", path.c_str(), 1);
    CHECK(has(missing, "found no program ffmpeg"));
    const ProgramRun still = run_limn(folder, {"render", "gallery", "-o", "g.mp4"});
    CHECK(still.exit_code == 2);
    CHECK(has(still.err, "expected --frames with a film"));
}

}  // namespace limn::film_command_test
