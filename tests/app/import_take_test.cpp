#include "content/app/commands/import_markers.h"
#include "content/load/files/atomic_file.h"
#include "content/sound/scene_sound.h"
#include "content/speech/speech_library.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

namespace limn::import_take_test {
namespace {

struct TakeMarker {
    std::string name;
    Vec3 rest;   ///< [mm]
    float drop;  ///< [mm], while it speaks
};

const std::vector<TakeMarker> kTakeMarkers = {
    {"chin", {0, -60, 90}, 12},
    {"upperlip", {0, -20, 100}, -2},
    {"lowerlip", {0, -35, 98}, 9},
    {"mouth_L", {25, -28, 85}, 3},
};

/// A second of 50 frames that speaks from 0.3 to 0.7 s.
std::string take_of(const std::vector<TakeMarker>& markers) {
    std::string text = fmt::format(
        "PathFileType\t4\t(X/Y/Z)\ttake.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
        "50\t50\t51\t{}\tmm\nFrame#\tTime",
        markers.size());
    for (const TakeMarker& marker : markers) {
        text += "\t" + marker.name + "\t\t";
    }
    text += "\n\t\tX1\tY1\tZ1\n\n";
    for (int f = 0; f <= 50; ++f) {
        const float t = static_cast<float>(f) / 50.0f;
        const float open = t > 0.3f && t < 0.7f ? std::sin(8.0f * (t - 0.3f)) : 0.0f;
        text += fmt::format("{}\t{}", f + 1, t);
        for (const TakeMarker& marker : markers) {
            text += fmt::format(
                "\t{}\t{}\t{}", marker.rest.x, marker.rest.y - open * marker.drop, marker.rest.z);
        }
        text += "\n";
    }
    return text;
}

void write_text(const std::string& path, const std::string& text) {
    REQUIRE(write_file(path, std::as_bytes(std::span(text))));
}

/// A hum from 0.3 to 0.7 s, in one channel or only in the left one of two.
SoundData hum(int channels) {
    SoundData sound{48000, channels, {}};
    for (int i = 0; i < 48000; ++i) {
        const float t = static_cast<float>(i) / 48000.0f;
        sound.samples.push_back(t > 0.3f && t < 0.7f ? 0.4f * std::sin(900.0f * t) : 0.0f);
        if (channels == 2) {
            sound.samples.push_back(0.0f);
        }
    }
    return sound;
}

}  // namespace

TEST_CASE(
    "import take: markers in another order and sound of two channels join a library"
    * technique("face.speech-fragments")) {
    const test::TemporaryFolder folder;
    ImportOptions options;
    options.kind = "markers";
    options.in = folder.file("take.trc");
    options.out = folder.file("take.glb");
    options.library = folder.file("said.json");
    options.text = "me";
    options.labels = folder.file("labels.txt");
    write_text(options.labels, "0.3\t0.7\tme\n");
    write_text(options.in, take_of(kTakeMarkers));
    REQUIRE(save_wave(hum(1), folder.file("take.wav")));
    REQUIRE(import_marker_take(options));
    write_text(
        options.in, take_of({kTakeMarkers[2], kTakeMarkers[0], kTakeMarkers[3], kTakeMarkers[1]}));
    REQUIRE(save_wave(hum(2), folder.file("take.wav")));
    REQUIRE(import_marker_take(options));

    const auto library = load_speech_library(options.library);
    REQUIRE(library);
    REQUIRE(library->recordings.size() == 2);
    const SpeechRecording& first = library->recordings[0];
    const SpeechRecording& second = library->recordings[1];
    CHECK(first.motion.values == second.motion.values);
    REQUIRE(first.sound.samples.size() == 48000);
    REQUIRE(second.sound.samples.size() == 48000);
    int largest = 0;
    for (std::size_t i = 0; i < 48000; ++i) {
        const int twice = 2 * second.sound.samples[i];
        largest = std::max(largest, std::abs(twice - first.sound.samples[i]));
    }
    CHECK(largest <= 2);
    // Other markers are refused by name.
    write_text(
        options.in, take_of({kTakeMarkers[0], kTakeMarkers[3], {"lowerlp", {0, -35, 98}, 9}}));
    const Status refused = import_marker_take(options);
    REQUIRE_FALSE(refused);
    CHECK(
        refused.error().message.find("\"lowerlp\" (did you mean lowerlip?)") != std::string::npos);
}

}  // namespace limn::import_take_test
