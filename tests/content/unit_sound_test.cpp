#include "content/speech/speech_library.h"
#include "content/speech/take_labels.h"
#include "content/speech/unit_sound.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace limn::unit_sound_test {
namespace {

using test::near;

constexpr std::uint32_t kRate = 16000;
constexpr double kTurn = 6.283185307179586;

/// The color of a voice: that of each sound at its center, and in between on the way.
double color_at(const SpeechTrack& track, double time) {
    double color = 3.0;
    double last = 0.0;
    for (const SpeechSegment& segment : track.segments) {
        const double center = 0.5 * (segment.start + segment.end);
        const double next = 3.0 + segment.sound.phoneme % 5;
        if (time < center) {
            return color + (next - color) * (time - last) / (center - last);
        }
        color = next;
        last = center;
    }
    return color;
}

/// A voice: harmonics of a pitch, at full volume from the first sound to the last. `shift`: phase.
SpeechRecording record(const std::string& text, double pitch, double shift) {
    SpeechRecording recording = record_mouth(text, make_speech_track(sounds_of_text(text)), 60.0f);
    recording.sound.rate = kRate;
    const SpeechTrack& track = recording.track;
    const auto count = static_cast<std::size_t>(track.duration() * kRate);
    for (std::size_t i = 0; i < count; ++i) {
        const double time = static_cast<double>(i) / kRate;
        const double inside = std::min(
            time - double{track.segments[1].start}, double{track.segments.back().start} - time);
        const double rise = std::clamp(inside / 0.04, 0.0, 1.0);
        double sum = 0.0;
        for (int k = 1; k <= 12; ++k) {
            const double off = k - color_at(track, time);
            sum += std::exp(-0.3 * off * off) * std::sin(kTurn * k * (pitch * time + shift));
        }
        recording.sound.samples.push_back(
            static_cast<std::int16_t>(std::lround(6000.0 * rise * rise * (3 - 2 * rise) * sum)));
    }
    return recording;
}

/// The largest second difference: how sharply the sound bends.
int sharpest(const std::vector<std::int16_t>& samples, std::size_t begin, std::size_t end) {
    int largest = 0;
    for (std::size_t i = std::max<std::size_t>(begin, 1); i + 1 < std::min(end, samples.size());
         ++i) {
        largest =
            std::max(largest, std::abs(samples[i - 1] - 2 * int{samples[i]} + samples[i + 1]));
    }
    return largest;
}

struct Clock {
    std::vector<SpeechRecording> recordings{
        record("the time is now", 110, 0.0), record("exactly one", 117, 0.21),
        record("exactly two", 104, 0.4), record("in the morning", 122, 0.13)};
    std::vector<SpeechUnit> units = generate_units(recordings);

    struct Said {
        std::vector<SelectedUnit> selected;
        SpeechTrack track;
        Recording sound;
    };
    [[nodiscard]] Said say(const std::string& text) const {
        const SpeechTrack target = make_speech_track(sounds_of_text(text), 1.3f);
        Said said;
        const auto selected = select_units(target, units, recordings, 0.25f);
        REQUIRE(selected);
        said.selected = *selected;
        said.track = pace_by_units(target, said.selected, recordings);
        said.sound = join_sound(said.track, said.selected, recordings);
        return said;
    }
};

}  // namespace

TEST_CASE(
    "unit sound: a text that was recorded is the recording, sample by sample, at its pace"
    * technique("face.speech-fragments")) {
    const Clock clock;
    const Clock::Said said = clock.say("exactly one");
    const SpeechRecording& source = clock.recordings[1];
    REQUIRE(said.track.segments.size() == source.track.segments.size());
    for (std::size_t i = 1; i + 1 < said.track.segments.size(); ++i) {
        CHECK(
            said.track.segments[i].end - said.track.segments[i].start
            == near(source.track.segments[i].end - source.track.segments[i].start).epsilon(1e-4));
    }
    CHECK(said.sound.duration() == near(said.track.duration()).epsilon(1e-3));
    const auto sample = [](float time) {
        return static_cast<std::size_t>(std::lround(time * static_cast<float>(kRate)));
    };
    const std::size_t here = sample(said.track.segments[1].start);
    const std::size_t there = sample(source.track.segments[1].start);
    const std::size_t count = sample(source.track.segments.back().start) - there;
    for (std::size_t i = 100; i + 100 < count; ++i) {
        CHECK(said.sound.samples[here + i] == source.sound.samples[there + i]);
    }
}

TEST_CASE(
    "unit sound: joins have no clicks: the sound bends no more sharply than it does in between"
    * technique("face.fragment-blend, face.speech-fragments")) {
    const Clock clock;
    double clicks = 0.0;
    double smooth = 0.0;
    for (const char* const text :
         {"the time is one", "exactly two in the morning", "two is one", "now is exactly one"}) {
        const Clock::Said said = clock.say(text);
        REQUIRE(said.selected.size() > 1);
        int inside = 0;
        for (const SelectedUnit& one : said.selected) {
            const SpeechRecording& source = clock.recordings[one.unit.recording];
            const auto at = [&](float time) {
                return static_cast<std::size_t>(time * static_cast<float>(kRate));
            };
            inside = std::max(
                inside, sharpest(
                            source.sound.samples, at(unit_start(one.unit, source)),
                            at(unit_end(one.unit, source))));
        }
        CHECK(sharpest(said.sound.samples, 0, said.sound.samples.size()) <= 1.1 * inside);
        // Cut and pasted at the same times, it clicks.
        std::vector<std::int16_t> pasted(said.sound.samples.size(), 0);
        for (const SelectedUnit& one : said.selected) {
            const SpeechRecording& source = clock.recordings[one.unit.recording];
            const auto from =
                static_cast<std::size_t>(unit_start(one.unit, source) * static_cast<float>(kRate));
            const auto to = static_cast<std::size_t>(
                said.track.segments[one.at].start * static_cast<float>(kRate));
            const float length = unit_end(one.unit, source) - unit_start(one.unit, source);
            const auto count = static_cast<std::size_t>(length * static_cast<float>(kRate));
            for (std::size_t i = 0; i < count && to + i < pasted.size(); ++i) {
                pasted[to + i] = source.sound.samples[from + i];
            }
        }
        clicks += sharpest(pasted, 0, pasted.size());
        smooth += inside;
    }
    CHECK(clicks > 1.5 * smooth);
}

TEST_CASE(
    "unit sound: a track lasts as long as its units, and the joined sound as long as the track"
    * technique("face.align-resample, face.speech-fragments")) {
    const Clock clock;
    const Clock::Said said = clock.say("the time is exactly two");
    double sum = 0.0;
    for (const SelectedUnit& one : said.selected) {
        const SpeechRecording& source = clock.recordings[one.unit.recording];
        sum += unit_end(one.unit, source) - unit_start(one.unit, source);
    }
    const float margins =
        said.track.segments[1].start + said.track.duration() - said.track.segments.back().start;
    const bool has_diphones = std::ranges::any_of(
        said.selected, [](const SelectedUnit& one) { return one.unit.kind == UnitKind::Diphone; });
    REQUIRE_FALSE(has_diphones);
    CHECK(said.track.duration() - margins == near(sum).epsilon(1e-4));
    CHECK(said.sound.duration() == near(said.track.duration()).epsilon(1e-3));
}

TEST_CASE(
    "unit sound: without the sound of a recording, or with another rate, there is none"
    * technique("face.speech-fragments")) {
    Clock clock;
    clock.recordings[0].sound.samples.clear();
    CHECK(clock.say("the time is one").sound.samples.empty());
    clock = Clock();
    clock.recordings[1].sound.rate = 8000;
    CHECK(clock.say("the time is exactly one").sound.samples.empty());
}

TEST_CASE(
    "take labels: phrases are found between the pauses of a sound"
    * technique("face.unit-generate")) {
    const std::string text = "the time is now, exactly one.";
    Recording sound;
    sound.rate = kRate;
    const auto add = [&](double seconds, double volume) {
        for (int i = 0; i < static_cast<int>(seconds * kRate); ++i) {
            sound.samples.push_back(
                static_cast<std::int16_t>(volume * std::sin(kTurn * 150.0 * i / kRate)));
        }
    };
    for (const auto& [seconds, volume] : std::vector<std::pair<double, double>>{
             {0.3, 40}, {0.5, 9000}, {0.1, 30}, {0.4, 8000}, {0.35, 50}, {0.6, 9000}, {0.25, 20}}) {
        add(seconds, volume);
    }
    const Result<SpeechTrack> track = find_labels(sound, text);
    REQUIRE(track);
    std::vector<float> pauses;
    for (const SpeechSegment& segment : track->segments) {
        if (segment.sound.phoneme == 0) {
            pauses.push_back(segment.start);
            pauses.push_back(segment.end);
        }
    }
    const std::vector<double> expected = {0, 0.3, 1.3, 1.65, 2.25, 2.5};
    REQUIRE(pauses.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CHECK(std::abs(static_cast<double>(pauses[i]) - expected[i]) < 0.02);
    }
    CHECK(
        find_labels(sound, "one. two. three. four.").error().message
        == "found 3 stretches of sound between pauses, expected one for each of the 4 phrases of "
           "the text");
}

TEST_CASE(
    "take labels: words or sounds from a file; wrong ones are named with their line"
    * technique("face.unit-generate")) {
    const Result<SpeechTrack> words =
        parse_labels("0.2\t0.6\texactly\n0.7\t1.1\tone\n", "take.txt", "exactly one", 1.5f);
    REQUIRE(words);
    CHECK(words->segments.front().end == near(0.2));
    CHECK(words->duration() == near(1.5));
    const auto starts = std::ranges::count_if(
        words->segments, [](const SpeechSegment& one) { return one.sound.starts_word; });
    CHECK(starts == 2);
    const Result<SpeechTrack> sounds =
        parse_labels("0 0.2 sil\n0.2 0.3 w\n0.3 0.4 ah\n0.4 0.5 n\n", "take.txt", "one", 0.8f);
    REQUIRE(sounds);
    REQUIRE(sounds->segments.size() == 5);
    CHECK(sounds->segments[1].sound.starts_word);
    CHECK(sounds->segments[2].start == near(0.3));
    const auto error = [](const std::string& labels) {
        const auto track = parse_labels(labels, "take.txt", "exactly one", 1.5f);
        return track ? "none" : track.error().message;
    };
    CHECK(error("0.2 0.6 exactly\n0.5 1.1 one\n").starts_with("take.txt:2: found"));
    CHECK(
        error("0.2 0.6 exactly\n0.7 1.1 two\n").find("expected word 2 of the 2")
        != std::string::npos);
    CHECK(error("0.2 0.6 exactly\n").find("found labels of 1 words") != std::string::npos);
    CHECK(
        error("0.2 0.6 exactly\n0.7 1.9 one\n").find("at most that of the recording")
        != std::string::npos);
    CHECK(error("0 0.2 sil\n0.2 0.3 qq\n").find("take.txt:2: found \"qq\"") != std::string::npos);
    CHECK(error("").find("found no labels") != std::string::npos);
}

TEST_CASE(
    "speech library: markers with their sound survive writing and reading"
    * technique("face.speech-fragments")) {
    SpeechLibrary library;
    library.rate = 50;
    library.markers = {"lip", "chin"};
    library.rest = {{0, -0.02f, 0.1f}, {0, -0.06f, 0.09f}};
    SpeechRecording recording = record("one", 110, 0);
    recording.motion = {50, 6, {}};
    for (int i = 0; i < 100; ++i) {
        for (int k = 0; k < 6; ++k) {
            recording.motion.values.push_back(0.001f * static_cast<float>(i * k));
        }
    }
    recording.sound_file = "clock-1.wav";
    library.recordings.push_back(recording);
    const std::string text = write_speech_library(library);
    const Result<SpeechLibrary> read = parse_speech_library(text, "clock.json");
    REQUIRE(read);
    CHECK(read->markers == library.markers);
    CHECK(read->rest[1] == library.rest[1]);
    CHECK(read->recordings[0].motion.values == recording.motion.values);
    CHECK(read->recordings[0].sound_file == "clock-1.wav");
    std::string wrong = text;
    wrong.replace(wrong.find("clock-1.wav"), 11, "../etc/x.wa");
    CHECK(
        parse_speech_library(wrong, "clock.json")
            .error()
            .message.find("in the folder of the library")
        != std::string::npos);
    wrong = text;
    wrong.replace(wrong.find("\"chin\""), 6, "\"chin\",\"jaw\"");
    CHECK(
        parse_speech_library(wrong, "clock.json").error().message.find("positions of the 3")
        != std::string::npos);
}

}  // namespace limn::unit_sound_test
