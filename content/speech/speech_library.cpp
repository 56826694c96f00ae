#include "content/speech/speech_library.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "ecs/base/math.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
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

Result<SpeechRecording>
read_recording(const JsonValue& json, float rate, std::size_t channels, const std::string& file) {
    SpeechRecording recording;
    recording.text = json["text"].text;
    recording.sound_file = json["sound"].text;
    if (recording.sound_file.find('/') != std::string::npos) {
        return found(json["sound"], file, "the name of a .wav in the folder of the library");
    }
    recording.track = LIMN_TRY(read_sounds(json["sounds"], file));
    recording.motion.rate = rate;
    recording.motion.channels = channels;
    const JsonValue& samples = json["samples"];
    for (const JsonValue& sample : samples.items) {
        if (sample.items.size() != channels) {
            return found(sample, file, format_text("{} numbers", channels));
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

Status read_markers(const JsonValue& json, const std::string& file, SpeechLibrary& library) {
    for (const JsonValue& name : json["markers"].items) {
        if (name.kind != JsonKind::String) {
            return found(name, file, "the name of a marker");
        }
        library.markers.push_back(name.text);
    }
    for (const JsonValue& point : json["rest"].items) {
        Vec3 rest(0);
        const bool numbers =
            point.items.size() == 3 && std::ranges::all_of(point.items, [](const JsonValue& item) {
                return item.kind == JsonKind::Number;
            });
        for (std::size_t k = 0; numbers && k < 3; ++k) {
            rest[static_cast<int>(k)] = static_cast<float>(point.items[k].number);
        }
        if (!numbers || !is_finite(rest)) {
            return found(point, file, "three numbers");
        }
        library.rest.push_back(rest);
    }
    if (library.rest.size() != library.markers.size()) {
        const JsonValue& rest = json["rest"];
        return found(
            rest.at.line > 0 ? rest : json, file,
            format_text(
                "\"rest\" with the positions of the {} \"markers\"", library.markers.size()));
    }
    return Done{};
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
    LIMN_TRY(read_markers(json, file, library));
    for (const JsonValue& recording : json["recordings"].items) {
        library.recordings.push_back(
            LIMN_TRY(read_recording(recording, library.rate, library.channels(), file)));
    }
    return library;
}

Result<SpeechLibrary> load_speech_library(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    SpeechLibrary library = LIMN_TRY(
        parse_speech_library({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path));
    for (SpeechRecording& recording : library.recordings) {
        if (!recording.sound_file.empty()) {
            const std::string sound =
                std::filesystem::path(path).replace_filename(recording.sound_file).string();
            const std::vector<std::byte> wave = LIMN_TRY(read_file(sound));
            recording.sound = LIMN_TRY(parse_wave(wave, sound));
        }
    }
    return library;
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
        JsonValue object = json_object(
            {{"text", {}, json_of(std::string_view(recording.text))},
             {"sounds", {}, std::move(sounds)}});
        if (!recording.sound_file.empty()) {
            object.members.push_back(
                {"sound", {}, json_of(std::string_view(recording.sound_file))});
        }
        object.members.push_back({"samples", {}, std::move(samples)});
        recordings.items.push_back(std::move(object));
    }
    JsonValue object = json_object({{"rate", {}, json_of(library.rate)}});
    if (!library.markers.empty()) {
        JsonValue markers = json_array();
        JsonValue rest = json_array();
        for (std::size_t m = 0; m < library.markers.size(); ++m) {
            markers.items.push_back(json_of(std::string_view(library.markers[m])));
            JsonValue point = json_array();
            for (int k = 0; k < 3; ++k) {
                point.items.push_back(json_of(library.rest[m][k]));
            }
            rest.items.push_back(std::move(point));
        }
        object.members.push_back({"markers", {}, std::move(markers)});
        object.members.push_back({"rest", {}, std::move(rest)});
    }
    object.members.push_back({"recordings", {}, std::move(recordings)});
    return write_json(object);
}

SpeechRecording record_mouth(const std::string& text, const SpeechTrack& track, float rate) {
    SpeechRecording recording{.text = text, .track = track, .motion = {}};
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
