#include "content/speech/speech_library.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "ecs/base/math.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

// Techniques: face.speech-fragments

namespace limn {

namespace {

constexpr float kMaxRate = 1000.0f;
constexpr double kMaxPose = 10.0;

Error found(const JsonValue& value, const std::string& file, std::string_view expected) {
    return fail(
        "{}: found {}, expected {}", location_text(file, value.at), describe(value), expected);
}

Result<SpeechTrack> read_sounds(const JsonValue& sounds, const std::string& file) {
    SpeechTrack track;
    for (const JsonValue& item : sounds.items) {
        const JsonValue& name = item["name"];
        const JsonValue& end = item["end"];
        const int phoneme = name.kind == JsonKind::String ? find_phoneme(name.text) : -1;
        if (phoneme < 0) {
            return found(
                name.at.line > 0 ? name : item, file, "the name of a sound, as \"sil\" or \"ae\"");
        }
        const float start = track.duration();
        if (end.kind != JsonKind::Number || !(static_cast<float>(end.number) > start)) {
            return found(
                end.at.line > 0 ? end : item, file, format_text("an \"end\" after {} s", start));
        }
        Sound sound{.phoneme = static_cast<std::uint8_t>(phoneme)};
        sound.starts_word = item["word"].truth;
        track.segments.push_back({sound, start, static_cast<float>(end.number)});
    }
    const auto is_silent = [](const SpeechSegment& segment) { return segment.sound.phoneme == 0; };
    if (track.segments.size() < 3 || !is_silent(track.segments.front())
        || !is_silent(track.segments.back())) {
        return found(sounds, file, "sounds between two of \"sil\"");
    }
    return track;
}

Result<SpeechRecording> read_recording(const JsonValue& json, float rate, const std::string& file) {
    SpeechRecording recording;
    recording.text = json["text"].text;
    recording.track = LIMN_TRY(read_sounds(json["sounds"], file));
    recording.motion.rate = rate;
    recording.motion.channels = kMouthAxes;
    const JsonValue& samples = json["samples"];
    for (const JsonValue& sample : samples.items) {
        if (sample.items.size() != kMouthAxes) {
            return found(sample, file, format_text("{} numbers", kMouthAxes));
        }
        for (const JsonValue& value : sample.items) {
            if (value.kind != JsonKind::Number || std::abs(value.number) > kMaxPose) {
                return found(value, file, "a number from -10 to 10");
            }
            recording.motion.values.push_back(static_cast<float>(value.number));
        }
    }
    const float covered = static_cast<float>(recording.motion.size()) / rate;
    if (recording.track.duration() > covered) {
        return fail(
            "{}: found {} samples, which last {} s, expected them to cover the sounds, {} s",
            location_text(file, samples.at.line > 0 ? samples.at : json.at),
            recording.motion.size(), covered, recording.track.duration());
    }
    return recording;
}

}  // namespace

Result<SpeechLibrary> parse_speech_library(std::string_view text, const std::string& file) {
    const JsonValue json = LIMN_TRY(parse_json(text, file));
    SpeechLibrary library;
    const JsonValue& rate = json["rate"];
    library.rate = static_cast<float>(rate.number);
    if (rate.kind != JsonKind::Number || !(library.rate >= 1.0f && library.rate <= kMaxRate)) {
        return found(
            rate.at.line > 0 ? rate : json, file, "a \"rate\" from 1 to 1000 samples per second");
    }
    for (const JsonValue& recording : json["recordings"].items) {
        library.recordings.push_back(LIMN_TRY(read_recording(recording, library.rate, file)));
    }
    return library;
}

Result<SpeechLibrary> load_speech_library(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    return parse_speech_library({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

std::string write_speech_library(const SpeechLibrary& library) {
    JsonValue recordings = json_array();
    for (const SpeechRecording& recording : library.recordings) {
        JsonValue sounds = json_array();
        for (const SpeechSegment& segment : recording.track.segments) {
            JsonValue sound = json_object(
                {{"name", {}, json_of(phonemes()[segment.sound.phoneme].name)},
                 {"end", {}, json_of(segment.end)}});
            if (segment.sound.starts_word) {
                sound.members.push_back({"word", {}, json_of(true)});
            }
            sounds.items.push_back(std::move(sound));
        }
        JsonValue samples = json_array();
        for (std::size_t i = 0; i < recording.motion.size(); ++i) {
            JsonValue sample = json_array();
            for (const float value : recording.motion.row(i)) {
                sample.items.push_back(json_of(value));
            }
            samples.items.push_back(std::move(sample));
        }
        recordings.items.push_back(json_object(
            {{"text", {}, json_of(std::string_view(recording.text))},
             {"sounds", {}, std::move(sounds)},
             {"samples", {}, std::move(samples)}}));
    }
    return write_json(json_object(
        {{"rate", {}, json_of(library.rate)}, {"recordings", {}, std::move(recordings)}}));
}

SpeechRecording record_mouth(const std::string& text, const SpeechTrack& track, float rate) {
    SpeechRecording recording{text, track, {}};
    recording.motion.rate = rate;
    recording.motion.channels = kMouthAxes;
    const MouthTrack mouth = make_mouth_track(track);
    const auto count = static_cast<std::size_t>(std::ceil(track.duration() * rate)) + 1;
    for (std::size_t i = 0; i < count; ++i) {
        const MouthPose pose = mouth_at(mouth, static_cast<float>(i) / rate);
        recording.motion.values.insert(recording.motion.values.end(), pose.begin(), pose.end());
    }
    return recording;
}

MouthPose mouth_at(const SampledCurves& curves, float time) {
    MouthPose pose{};
    const float at = time * curves.rate;
    if (curves.size() > 0 && at >= 0.0f && at <= static_cast<float>(curves.size() - 1)) {
        const std::size_t i = std::min(static_cast<std::size_t>(at), curves.size() - 1);
        const std::size_t next = std::min(i + 1, curves.size() - 1);
        const float u = at - static_cast<float>(i);
        for (std::size_t axis = 0; axis < kMouthAxes; ++axis) {
            pose[axis] = glm::mix(curves.row(i)[axis], curves.row(next)[axis], u);
        }
    }
    return pose;
}

}  // namespace limn
