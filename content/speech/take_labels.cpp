#include "content/speech/take_labels.h"

#include "content/load/files/json_document.h"
#include "content/speech/utterance.h"
#include "content/speech/word_alignment.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

// Techniques: face.unit-generate

namespace limn {
namespace {

constexpr float kFrame = 0.01f;     ///< of loudness [s]
constexpr float kQuiet = 0.05f;     ///< loudness of a pause, of the loudest frame
constexpr float kMinPause = 0.08f;  ///< shorter ones are closures within words [s]
constexpr float kMinSound = 1e-3f;  ///< [s]

/// A stretch of time [s].
struct Stretch {
    float begin = 0.0f;
    float end = 0.0f;
};

void append_sound(SpeechTrack& track, Sound sound, float end) {
    if (end - track.duration() > kMinSound) {
        track.segments.push_back({sound, track.duration(), end});
    }
}

/// The sounds in `stretch`, in proportion to their usual durations; silence before it.
void append_sounds(SpeechTrack& track, const std::vector<Sound>& sounds, const Stretch& stretch) {
    append_sound(track, {}, stretch.begin);
    const SpeechTrack usual = make_speech_track(sounds);
    float total = 0.0f;
    for (const SpeechSegment& segment : usual.segments) {
        total += segment.sound.phoneme != 0 ? segment.end - segment.start : 0.0f;
    }
    const float begin = track.duration();
    float done = 0.0f;
    for (const SpeechSegment& segment : usual.segments) {
        if (segment.sound.phoneme != 0) {
            done += segment.end - segment.start;
            append_sound(track, segment.sound, begin + (stretch.end - begin) * done / total);
        }
    }
}

/// The sounds that are heard in `stretch` of a recording; silence before it.
void append_heard(
    SpeechTrack& track, const Recording& recording, std::string_view text, const Stretch& stretch) {
    std::vector<Sound> sounds;
    std::vector<float> usual;
    for (const SpeechSegment& segment : make_speech_track(sounds_of_text(text)).segments) {
        if (segment.sound.phoneme != 0) {
            sounds.push_back(segment.sound);
            usual.push_back(segment.end - segment.start);
        }
    }
    append_sound(track, {}, stretch.begin);
    if (sounds.empty()) {
        return;  // spelled, but silent, as a lone "h"
    }
    const float begin = track.duration();
    const std::vector<float> ends = align_sounds(recording, begin, stretch.end, sounds, usual);
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        append_sound(track, sounds[i], ends[i]);
    }
}

/// The sounds of each word.
std::vector<std::vector<Sound>> words_of(std::string_view text) {
    std::vector<std::vector<Sound>> words;
    for (const Sound& sound : sounds_of_text(text)) {
        if (sound.phoneme == 0) {
            continue;
        }
        if (sound.starts_word || words.empty()) {
            words.emplace_back();
        }
        words.back().push_back(sound);
    }
    return words;
}

struct Label {
    Stretch stretch;
    std::string name;
    std::size_t line = 0;
};

Result<std::vector<Label>> read_labels(std::string_view text, const std::string& file) {
    std::vector<Label> labels;
    std::size_t line = 0;
    while (!text.empty()) {
        ++line;
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string row(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        std::erase(row, '\r');
        if (row.find_first_not_of(" \t") == std::string::npos) {
            continue;
        }
        char* rest = row.data();
        Label label;
        label.line = line;
        label.stretch.begin = std::strtof(rest, &rest);
        label.stretch.end = std::strtof(rest, &rest);
        label.name = rest;
        label.name.erase(0, label.name.find_first_not_of(" \t"));
        label.name.erase(label.name.find_last_not_of(" \t") + 1);
        const float last = labels.empty() ? 0.0f : labels.back().stretch.end;
        if (label.name.empty() || !(label.stretch.begin >= last - kMinSound)
            || !(label.stretch.end > label.stretch.begin + kMinSound)) {
            return fail(
                "{}:{}: found {}, expected a start from {} s on, a later end, and a label", file,
                line, in_quotes(row), last);
        }
        labels.push_back(std::move(label));
    }
    return labels;
}

/// Whether two lists have the same phonemes.
bool are_equal(const std::vector<Sound>& a, const std::vector<Sound>& b) {
    return std::ranges::equal(a, b, {}, &Sound::phoneme, &Sound::phoneme);
}

Result<SpeechTrack>
track_of_sounds(const std::vector<Label>& labels, const std::string& file, std::string_view text) {
    SpeechTrack track;
    for (const Label& label : labels) {
        const int phoneme = find_phoneme(label.name);
        if (phoneme < 0) {
            return fail(
                "{}:{}: found {}, expected the name of a sound, as \"sil\" or \"ae\"", file,
                label.line, in_quotes(label.name));
        }
        append_sound(track, {}, label.stretch.begin);
        Sound sound;
        sound.phoneme = static_cast<std::uint8_t>(phoneme);
        sound.starts_word = track.segments.empty() || track.segments.back().sound.phoneme == 0;
        append_sound(track, sound, label.stretch.end);
    }
    // Where they are those of the transcript, words begin where its words do.
    std::vector<Sound> spoken;
    for (const SpeechSegment& segment : track.segments) {
        if (segment.sound.phoneme != 0) {
            spoken.push_back(segment.sound);
        }
    }
    std::vector<Sound> written;
    for (const std::vector<Sound>& word : words_of(text)) {
        written.insert(written.end(), word.begin(), word.end());
    }
    if (are_equal(spoken, written)) {
        std::size_t i = 0;
        for (SpeechSegment& segment : track.segments) {
            segment.sound = segment.sound.phoneme != 0 ? written[i++] : segment.sound;
        }
    }
    return track;
}

Result<SpeechTrack>
track_of_words(const std::vector<Label>& labels, const std::string& file, std::string_view text) {
    const std::vector<std::vector<Sound>> words = words_of(text);
    SpeechTrack track;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        const std::vector<std::vector<Sound>> named = words_of(labels[i].name);
        if (i >= words.size() || named.size() != 1 || !are_equal(named[0], words[i])) {
            return fail(
                "{}:{}: found {}, expected word {} of the {} of the text {}", file, labels[i].line,
                in_quotes(labels[i].name), i + 1, words.size(), in_quotes(std::string(text)));
        }
        append_sounds(track, words[i], labels[i].stretch);
    }
    if (labels.size() != words.size()) {
        return fail(
            "{}: found labels of {} words, expected {}, one for each word of the text {}", file,
            labels.size(), words.size(), in_quotes(std::string(text)));
    }
    return track;
}

/// The audible stretches, with pauses between them.
std::vector<Stretch> audible_stretches(const Recording& sound) {
    const auto size = static_cast<std::size_t>(kFrame * static_cast<float>(sound.rate));
    std::vector<double> loudness;
    for (std::size_t first = 0; first < sound.samples.size();
         first += std::max<std::size_t>(size, 1)) {
        double sum = 0.0;
        const std::size_t end = std::min(first + size, sound.samples.size());
        for (std::size_t i = first; i < end; ++i) {
            sum += static_cast<double>(sound.samples[i]) * sound.samples[i];
        }
        loudness.push_back(
            std::sqrt(sum / static_cast<double>(std::max<std::size_t>(end - first, 1))));
    }
    const double loudest = loudness.empty() ? 0.0 : *std::ranges::max_element(loudness);
    std::vector<Stretch> stretches;
    for (std::size_t i = 0; i < loudness.size(); ++i) {
        if (!(loudness[i] > kQuiet * loudest)) {
            continue;
        }
        const float begin = kFrame * static_cast<float>(i);
        if (stretches.empty() || begin - stretches.back().end > kMinPause) {
            stretches.push_back({begin, begin});
        }
        stretches.back().end = begin + kFrame;
    }
    return stretches;
}

}  // namespace

Result<SpeechTrack> parse_labels(
    std::string_view labels, const std::string& file, std::string_view text, float duration) {
    const std::vector<Label> all = LIMN_TRY(read_labels(labels, file));
    if (all.empty()) {
        return fail("{}: found no labels, expected a line for each word or sound", file);
    }
    SpeechTrack track = LIMN_TRY(
        all[0].name == "sil" ? track_of_sounds(all, file, text) : track_of_words(all, file, text));
    if (track.duration() > duration + 0.5f * kFrame) {
        return fail(
            "{}:{}: found an end at {} s, expected at most that of the recording, {} s", file,
            all.back().line, track.duration(), duration);
    }
    append_sound(track, {}, duration);
    return track;
}

Result<SpeechTrack> find_labels(const Recording& sound, std::string_view text) {
    std::vector<Stretch> stretches = audible_stretches(sound);
    const std::vector<std::string> phrases = phrases_of(text);
    if (stretches.size() < phrases.size()) {
        return fail(
            "found {} stretches of sound between pauses, expected one for each of the {} phrases "
            "of the text",
            stretches.size(), phrases.size());
    }
    while (stretches.size() > phrases.size()) {  // close the shortest pause
        std::size_t shortest = 1;
        for (std::size_t i = 2; i < stretches.size(); ++i) {
            const auto pause = [&](std::size_t k) {
                return stretches[k].begin - stretches[k - 1].end;
            };
            shortest = pause(i) < pause(shortest) ? i : shortest;
        }
        stretches[shortest - 1].end = stretches[shortest].end;
        stretches.erase(stretches.begin() + static_cast<std::ptrdiff_t>(shortest));
    }
    SpeechTrack track;
    for (std::size_t i = 0; i < phrases.size(); ++i) {
        append_heard(track, sound, phrases[i], stretches[i]);
    }
    append_sound(track, {}, sound.duration());
    return track;
}

}  // namespace limn
