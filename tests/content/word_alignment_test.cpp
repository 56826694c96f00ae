#include "content/speech/speech_track.h"
#include "content/speech/take_labels.h"
#include "content/speech/word_alignment.h"
#include "ecs/base/rng.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <dlfcn.h>
#include <string>
#include <vector>

namespace limn::word_alignment_test {
namespace {

constexpr double kTurn = 6.283185307179586;

/// A voice whose sounds last `lengths` [s]: vowels are low harmonics, each of its own color, "s" is
/// high noise, and anything else nearly silent.
Recording speak(const std::vector<Sound>& sounds, const std::vector<double>& lengths) {
    Recording voice;
    Random random(1, 2, 3, 4);
    float last = 0.0f;
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        const Phoneme& phoneme = phonemes()[sounds[i].phoneme];
        const auto count = static_cast<int>(lengths[i] * voice.rate);
        for (int k = 0; k < count; ++k) {
            const double time = static_cast<double>(voice.samples.size()) / voice.rate;
            const float noise = random.uniform() - 0.5f;
            double value = 20.0 * static_cast<double>(noise);
            if (phoneme.is_vowel) {
                for (int h = 1; h <= 8; ++h) {
                    const double color = 1.0 + 5.0 * (sounds[i].phoneme % 7) / 7.0;
                    value += 4000.0 / (1.0 + (h - color) * (h - color))
                             * std::sin(kTurn * 120.0 * h * time);
                }
            } else if (phoneme.viseme == Viseme::S) {
                value = 6000.0 * static_cast<double>(noise - last);
            }
            last = noise;
            voice.samples.push_back(static_cast<std::int16_t>(value));
        }
    }
    return voice;
}

std::vector<float> usual_durations(const std::vector<Sound>& sounds) {
    std::vector<float> usual;
    for (const SpeechSegment& segment : make_speech_track(sounds).segments) {
        if (segment.sound.phoneme != 0) {
            usual.push_back(segment.end - segment.start);
        }
    }
    return usual;
}

/// The synthesizer's library, which tells when it speaks each word; the program does not.
struct SpokenWords {
    Recording voice;
    std::vector<double> starts;  ///< of words [s]
};
SpokenWords* spoken = nullptr;

struct EspeakEvent {
    int type = 0;  ///< 0: the last one, 1: a word
    unsigned identifier = 0;
    int text = 0;
    int length = 0;
    int audio = 0;  ///< [ms]
    int sample = 0;
    void* user = nullptr;
    char name[8] = {};
};

int take_sound(short* samples, int count, EspeakEvent* event) {
    if (samples != nullptr) {
        spoken->voice.samples.insert(spoken->voice.samples.end(), samples, samples + count);
    }
    for (; event->type != 0; ++event) {
        if (event->type == 1) {
            spoken->starts.push_back(event->audio / 1000.0);
        }
    }
    return 0;
}

double quantile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace

TEST_CASE(
    "word alignment: ends of sounds are where the sound changes, however long they last"
    * technique("face.unit-generate")) {
    const std::vector<Sound> sounds = sounds_of_text("see two sad seats");
    std::vector<Sound> voiced;
    for (const Sound& sound : sounds) {
        if (sound.phoneme != 0) {
            voiced.push_back(sound);
        }
    }
    const std::vector<float> usual = usual_durations(sounds);
    REQUIRE(usual.size() == voiced.size());
    std::vector<double> lengths;
    for (std::size_t i = 0; i < usual.size(); ++i) {
        lengths.push_back(double{usual[i]} * (i % 3 == 0 ? 1.7 : i % 3 == 1 ? 0.6 : 1.0));
    }
    const Recording voice = speak(voiced, lengths);
    const std::vector<float> ends = align_sounds(voice, 0, voice.duration(), voiced, usual);
    REQUIRE(ends.size() == voiced.size());
    CHECK(ends.back() == voice.duration());
    double end = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        end += lengths[i];
        CAPTURE(i);
        CHECK(std::abs(double{ends[i]} - end) < 0.0125);
        CHECK((i == 0 || ends[i] > ends[i - 1]));
    }
    // Too short for its sounds: by their usual durations.
    const std::vector<float> hasty = align_sounds(voice, 0, 0.1f, voiced, usual);
    CHECK(std::ranges::is_sorted(hasty));
    CHECK(hasty.back() == 0.1f);
}

TEST_CASE(
    "word alignment: words of a synthesized voice are found to 10 ms in the median"
    * technique("face.unit-generate")) {
    void* const library = dlopen("libespeak-ng.so.1", RTLD_NOW);
    if (library == nullptr) {
        MESSAGE("skipped: libespeak-ng is not installed");
        return;
    }
    const auto find = [&](auto* type, const char* name) {
        return reinterpret_cast<decltype(type)>(dlsym(library, name));
    };
    using Initialize = int(int, int, const char*, int);
    using SetCallback = void(int (*)(short*, int, EspeakEvent*));
    using SetVoice = int(const char*);
    using SetParameter = int(int, int, int);
    using Synthesize =
        int(const void*, std::size_t, unsigned, int, unsigned, unsigned, unsigned*, void*);
    const int rate = find(static_cast<Initialize*>(nullptr), "espeak_Initialize")(2, 0, nullptr, 0);
    REQUIRE(rate > 0);
    find(static_cast<SetCallback*>(nullptr), "espeak_SetSynthCallback")(take_sound);
    std::vector<double> errors;
    std::vector<double> by_length;
    for (const char* const name : {"en", "en-us"}) {
        for (const int words_per_minute : {130, 170}) {
            for (const std::string text :
                 {"We saw the little dog by the old blue door this morning",
                  "She sells seven cheap fish at the market", "Keep both feet on the ground",
                  "My mother made a new lamp of yellow paper"}) {
                SpokenWords words;
                words.voice.rate = static_cast<std::uint32_t>(rate);
                spoken = &words;
                find(static_cast<SetVoice*>(nullptr), "espeak_SetVoiceByName")(name);
                find(static_cast<SetParameter*>(nullptr), "espeak_SetParameter")(
                    1, words_per_minute, 0);
                find(static_cast<Synthesize*>(nullptr), "espeak_Synth")(
                    text.c_str(), text.size() + 1, 0, 1, 0, 1, nullptr, nullptr);
                const auto track = find_labels(words.voice, text);
                REQUIRE(track);
                // What the text alone would say, in the same time.
                SpeechTrack plain = make_speech_track(sounds_of_text(text));
                fit_duration(
                    plain,
                    track->segments.back().start - track->segments.front().end + 2 * kSpeechMargin);
                const auto add = [&](const SpeechTrack& labels, float shift,
                                     std::vector<double>& into) {
                    std::size_t word = 0;
                    for (const SpeechSegment& segment : labels.segments) {
                        if (segment.sound.phoneme != 0 && segment.sound.starts_word) {
                            REQUIRE(word < words.starts.size());
                            const double start = double{segment.start} + double{shift};
                            into.push_back(std::abs(start - words.starts[word]));
                            ++word;
                        }
                    }
                    CHECK(word == words.starts.size());
                };
                add(*track, 0.0f, errors);
                const bool silence_first = track->segments.front().sound.phoneme == 0;
                add(plain, (silence_first ? track->segments.front().end : 0.0f) - kSpeechMargin,
                    by_length);
            }
        }
    }
    const double median = quantile(errors, 0.5);
    MESSAGE(
        "words: median error " << 1e3 * median << " ms, 90 % " << 1e3 * quantile(errors, 0.9)
                               << " ms; by the length of the text "
                               << 1e3 * quantile(by_length, 0.5) << " and "
                               << 1e3 * quantile(by_length, 0.9) << " ms");
    CHECK(errors.size() > 100);
    CHECK(median < 0.010);
    CHECK(quantile(errors, 0.9) < 0.070);
    CHECK(median < 0.4 * quantile(by_length, 0.5));
}

}  // namespace limn::word_alignment_test
